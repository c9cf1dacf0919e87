"""The book: the lessons as pages for any browser, whose live figures move without a kernel.

Text and pictures are the stored outputs, which the tests compare; only the cells that lead to a live figure are
executed, to record it. Sphinx, MyST-NB and sphinx-book-theme make the pages (``pip install -e '.[book]'``).
"""

import base64
import contextlib
import hashlib
import io
import os
import re
import shutil
import subprocess
import sys
import tempfile
from concurrent.futures import ProcessPoolExecutor
from html import escape
from importlib import metadata
from importlib.util import find_spec
from multiprocessing import get_context
from pathlib import Path

import nbformat
from PIL import Image

from hoverslam_lib import checks, recording

HERE = Path(__file__).parent
PROJECT = HERE.parent.parent
RECORDINGS = PROJECT / ".recordings"
"""Recorded figures are kept here, by what they depend on."""

SMALLEST = 0.72
"""A figure shrinks to this share of its width and then scrolls: its smallest text, 9 points, has 9 pixels there."""

PARTS = {"The methods": "0[0-5]", "The booster": "0[6-9]|1[01]", "Beyond the paper": "1[2-9]"}


WITHOUT_PYTHON = """*Without Python:* write your guess down where it says **Predict**, then unfold the answer below it;
move the figures; do the exercises on paper, with the hints that are folded under them."""

UNIT = r"(?:[%°tJ]|[kcmµ]?m|m?s|k?g|[kM]?N|rad)(?:/(?:s|m|kg)[²³]?)?(?![\w/])"
"""What stands behind a number and a space."""

FORMULA = r'<span class="math notranslate nohighlight">[^<]*</span>'

NO_TEXT = rf"{FORMULA}|<(?:script|style|title)\b.*?</(?:script|style|title)>|<[^>]*>"

NO_PROSE = rf"<(?:pre|code)\b.*?</(?:pre|code)>|{NO_TEXT}"


GOES_ON = r"\n\n(?=##|\*\*(?:Predict|Further reading|Next)\b)"
"""Where a text that takes a prediction up ends, and the lesson goes on."""


def build(paths, folder, *, for_students=False, unfold=False, withhold_solutions=False):
    """Make the book.

    Parameters
    ----------
    paths : list of Path
        The notebooks, in their order, from one folder, which holds the glossary, the guide and the images too.
    folder : path
        For the pages; a book that is there is replaced.
    for_students : bool, optional
        Leave out the instructor's guide.
    unfold : bool, optional
        Show the answers to the predictions at once, instead of when asked for.
    withhold_solutions : bool, optional
        Leave out the solutions of the exercises.

    Raises
    ------
    ValueError
        If `folder` holds something else than a book, or Sphinx has a warning about a page.
    """
    if find_spec("sphinx") is None:
        raise ModuleNotFoundError("sphinx is missing", name="sphinx")
    folder = Path(folder)
    if folder.exists() and any(folder.iterdir()) and not (folder / "_static" / "recorded.js").exists():
        raise ValueError(f"{folder} holds other files and no book: name a new folder")
    folder.mkdir(parents=True, exist_ok=True)  # what the file system refuses, it refuses before the work
    names = record_all(paths)
    with tempfile.TemporaryDirectory() as scratch:
        source, made = Path(scratch, "source"), Path(scratch, "made")
        source.mkdir()
        _write_source(source, paths, names, for_students)
        for path in paths:
            _write_lesson(source / path.name, path, names, unfold, withhold_solutions)
        # apart from this process, because Sphinx and its themes warn Python of what they will change
        command = [sys.executable, "-m", "sphinx", "-q", "-W", "--keep-going", "-c", HERE, source, made]
        told = subprocess.run([*map(str, command)], capture_output=True, text=True, check=False)
        if told.returncode:
            raise ValueError(f"Sphinx cannot make the book:\n{told.stderr.strip()}")
        for page in made.glob("*.html"):
            text = page.read_text(encoding="utf-8")
            page.write_text(_with_stills(_unbroken(text), made), encoding="utf-8")
        (made / "recordings").mkdir()
        for name, kept in names.items():
            shutil.copyfile(kept, made / "recordings" / f"{name}.js")
        for needless in (".buildinfo", ".doctrees", "_sources", "objects.inv"):
            _remove(made / needless)
        _remove(folder)
        shutil.copytree(made, folder)


def _remove(path):
    if path.is_dir():
        shutil.rmtree(path)
    else:
        path.unlink(missing_ok=True)


# ---- recordings


def record_all(paths):
    """Record the live figures of notebooks, those that are not kept already.

    Parameters
    ----------
    paths : iterable of Path

    Returns
    -------
    dict of str to Path
        The script of each figure, by its name, such as "03_symplectic_euler-0".
    """
    RECORDINGS.mkdir(exist_ok=True)
    wanted = {path: _kept(path) for path in paths}
    missing = [path for path, kept in wanted.items() if not all(file.exists() for file in kept.values())]
    # a process each: a lesson may leave matplotlib, the folder or the names of its own cells in any state
    with ProcessPoolExecutor(mp_context=get_context("spawn")) as workers:
        for n, path in enumerate(workers.map(_record, missing), start=1):
            print(f"[{n}/{len(missing)}] recorded {path.stem}", flush=True)
    return {name: file for kept in wanted.values() for name, file in kept.items()}


def _kept(path):
    """The files of a notebook's recordings: their names change with whatever the figures depend on."""
    cells = live_cells(path)
    if not cells:
        return {}
    digest = hashlib.sha256()
    for cell in nbformat.read(path, as_version=4).cells[: cells[-1] + 1]:
        if cell.cell_type == "code":
            digest.update(cell.source.encode())
    for pattern in ("hoverslam_lib/*.py", "hoverslam_lib/*.mplstyle", "data/*.csv"):
        for file in sorted(PROJECT.glob(pattern)):
            if file.name not in ("course.py", "collect.py"):
                digest.update(file.read_bytes())
    for package in ("numpy", "matplotlib", "pillow", "ipywidgets"):
        digest.update(metadata.version(package).encode())
    key = digest.hexdigest()[:16]
    return {f"{path.stem}-{n}": RECORDINGS / f"{path.stem}-{n}-{key}.js" for n in range(len(cells))}


def live_cells(path):
    """Numbers of the cells of a notebook that show a live figure, known by its still; counted from 0, a list of int."""
    cells = nbformat.read(path, as_version=4).cells
    return [n for n, cell in enumerate(cells) if any("hoverslam-still" in text for text in _html(cell))]


def _html(cell):
    return [output.get("data", {}).get("text/html", "") for output in cell.get("outputs", [])]


def _record(path):
    """Run a notebook up to its last live figure and keep what its figures show."""
    from hoverslam_lib.live import Live

    shown = []
    Live.show = lambda live: shown.append(recording.record(live))
    kept, cells = _kept(path), nbformat.read(path, as_version=4).cells[: live_cells(path)[-1] + 1]
    names, before = {"__name__": "__main__"}, Path.cwd()
    with tempfile.TemporaryDirectory() as scratch, contextlib.redirect_stdout(io.StringIO()):
        os.chdir(scratch)
        try:
            for cell in cells:
                if cell.cell_type == "code" and "raises-exception" not in cell.metadata.get("tags", []):
                    exec(compile(cell.source, path.name, "exec"), names)
        finally:
            os.chdir(before)
    for former in RECORDINGS.glob(f"{path.stem}-*.js"):
        former.unlink()
    for (name, file), recorded in zip(kept.items(), shown, strict=True):
        file.write_text(recording.script(name, recorded), encoding="utf-8")
    return path


# ---- pages


def _write_source(source, paths, names, for_students):
    """What is no lesson, as Sphinx is to see it."""
    notebooks = paths[0].parent
    for name in ("glossary.md", *([] if for_students else ["instructor_guide.md"])):
        shutil.copyfile(notebooks / name, source / name)
    shutil.copytree(notebooks / "images", source / "images")
    (source / "prediction_sheet.md").write_text(prediction_sheet(paths), encoding="utf-8")
    (source / "index.md").write_text(_index(paths, for_students), encoding="utf-8")


def _write_lesson(target, path, names, unfold, withhold_solutions):
    """A notebook as Sphinx is to see it."""
    notebook = nbformat.read(path, as_version=4)
    live = iter(name for name in names if name.rpartition("-")[0] == path.stem)
    for cell in notebook.cells:
        _put_recordings(cell, live)
    if path.stem == "mission_control":
        notebook.metadata["html_theme.sidebar_secondary.remove"] = True
    else:
        cells = notebook.cells if unfold else _folded(notebook.cells)
        title, *others = _with_help(cells, withhold_solutions)
        notebook.cells = [title, nbformat.v4.new_markdown_cell(WITHOUT_PYTHON), *others]
    nbformat.write(notebook, target)


def _put_recordings(cell, live):
    """Put what moves in the place of a live figure's still, and let other pictures scroll where they are narrow."""
    for output in cell.get("outputs", []):
        html = output.get("data", {}).get("text/html")
        if html is None:
            continue
        if "hoverslam-still" in html:
            html = _recorded(next(live), html)
        output["data"]["text/html"] = re.sub(r'<img ([^>]*?)width="(\d+)" style="max-width:100%"', _scrolling, html)


def _recorded(name, still):
    image, sentence = re.search(r"(<img .*?>)<p>(.*?) <em>", still, re.DOTALL).groups()
    return (
        f'<div class="hoverslam-recorded" data-recording="{escape(name)}">'
        f'<div class="hoverslam-controls"></div><p role="status">{sentence}</p>{image}</div>'
    )


def _scrolling(match):
    attributes, width = match[1], int(match[2])
    return f'<img {attributes}width="{width}" style="min-width:{SMALLEST * width:.0f}px"'


def _folded(cells):
    """Cells with folded away what answers a prediction: the outputs from there on, and the text that takes them up."""
    answering = False
    for cell in cells:
        answer = "answer" in cell.metadata.get("tags", [])
        answering = answering or answer
        if answering and cell.cell_type == "code":
            if cell.outputs:
                cell.metadata["tags"] = [*cell.metadata.get("tags", []), "hide-output"]
        elif answering:
            yield from _folded_text(cell, "Show the answer" if answer else "Show what to make of it")
            answering = answer
            continue
        yield cell


def _folded_text(cell, summary):
    taken_up, *rest = re.split(GOES_ON, f"\n\n{cell.source}", maxsplit=1)
    if taken_up:
        yield nbformat.v4.new_markdown_cell(_details(summary, taken_up))
    if rest:
        yield nbformat.v4.new_markdown_cell(rest[0])


def _details(summary, text):
    return f"<details><summary>{summary}</summary>\n\n{text.strip()}\n\n</details>"


def _with_help(cells, withhold_solutions):
    """Cells with hints and solution folded under each exercise."""
    exercises = {exercise.name: exercise for exercise in checks.EXERCISES.values()}
    for cell in cells:
        yield cell
        called = re.findall(r"\bchecks\.(\w+)\(", cell.source) if cell.cell_type == "code" else []
        for exercise in (exercises[name] for name in called if name in exercises):
            folded = [_details("Hints", "\n".join(f"- {hint}" for hint in exercise.hints))]
            if not withhold_solutions:
                folded.append(_details("Solution", f"```python\n{exercise.solution.strip()}\n```"))
            yield nbformat.v4.new_markdown_cell("\n\n".join(folded))


def _unbroken(page):
    """A page whose lines end neither between a number or a formula and what belongs to it, nor inside a number."""
    whole = '<span class="unbroken">{}</span>'
    page = _put(page, rf"(?<=\d) (?={UNIT}|\d{{3}}\b)", "&#160;", NO_PROSE)
    page = _put(page, r"\b\d[\d.]*e-\d+", whole, NO_TEXT)
    return re.sub(rf"[(“]*{FORMULA}(?: {UNIT})?[)”.,;:?!]*", lambda found: whole.format(found[0]), page)


def _put(page, pattern, text, kept):
    """Put a text in the place of what matches a pattern, which it may name {}, outside of what is kept."""
    return re.sub(rf"(?s)({kept})|{pattern}", lambda found: found[1] or text.format(found[0]), page)


def _with_stills(text, folder):
    """A page with the last picture beside each of its films, hidden until the film is stopped."""

    def beside(film):
        source = re.search(r'src="(.*?)(?:#\d+)?"', film[0])[1]
        data = (
            base64.b64decode(source.partition(",")[2]) if source.startswith("data:") else (folder / source).read_bytes()
        )
        with Image.open(io.BytesIO(data)) as frames:
            frames.seek(frames.n_frames - 1)
            last = io.BytesIO()
            frames.convert("RGB").quantize(256, dither=Image.Dither.NONE).save(last, "png", optimize=True)
        picture = f"data:image/png;base64,{base64.b64encode(last.getvalue()).decode('ascii')}"
        return film[0] + film[0].replace(source, picture).replace("<img ", '<img class="still" hidden ', 1)

    return re.sub(r'<img [^>]*src="(?:data:image/gif|[^"]*\.gif")[^>]*>', beside, text)


def prediction_sheet(paths):
    """The predictions that lessons ask for, each with room to write: Markdown that prints as one page a lesson."""
    pages = [(HERE / "prediction_sheet.md").read_text(encoding="utf-8")]
    for path in paths:
        cells = nbformat.read(path, as_version=4).cells
        asked = [cell.source.strip().split("\n\n")[-1] for cell in cells if "**Predict" in cell.source]
        if asked:
            title = cells[0].source.partition("\n")[0]
            pages.append("\n\n".join([f"#{title}", *(f'{text}\n\n<div class="write"></div>' for text in asked)]))
    return "\n\n".join(pages) + "\n"


def _index(paths, for_students):
    groups = {part: [p.stem for p in paths if re.match(pattern, p.name)] for part, pattern in PARTS.items()}
    others = ["glossary", "prediction_sheet", *([] if for_students else ["instructor_guide"]), "mission_control"]
    groups["Beside the lessons"] = others
    trees = [
        "\n".join(["```{toctree}", ":maxdepth: 1", f":caption: {part}", "", *names, "```"])
        for part, names in groups.items()
        if names
    ]
    return (HERE / "index.md").read_text(encoding="utf-8") + "\n\n".join(trees) + "\n"
