"""The life of a notebook.

``python -m hoverslam_lib.course refresh [LESSON…]`` executes lessons from top to bottom in a fresh kernel, cleans and
checks what they store. ``python -m hoverslam_lib.course copy FOLDER`` makes a student's working copy, without outputs,
that git leaves alone, or goes on with the one that is there; with ``--lesson 3`` it puts a fresh lesson beside the
edited one, with ``--for-teaching`` it keeps the outputs and adds what instructors need, with ``--withhold-solutions``
``checks.show_solution`` says there to ask the instructor, with ``--zip`` it makes one file of a new copy and of what
has to be installed for it. ``python -m hoverslam_lib.course book FOLDER`` makes pages that any browser shows, without a
network and without Python, and whose figures move; ``--withhold-solutions`` leaves out the solutions of the exercises
there. ``python -m hoverslam_lib.course collect FOLDER`` judges the copies that students returned, and runs their code
for it.
"""

import argparse
import os
import re
import statistics
import sys
import tempfile
import time
import zipfile
from importlib import metadata
from pathlib import Path

NOTEBOOKS = Path(__file__).resolve().parent.parent / "notebooks"
LONGEST_CELL = 15
LARGEST_FILE = 700_000
FOR_INSTRUCTORS = ("instructor_guide.md", "mission_control.ipynb")
TO_INSTALL = (
    *("environment.txt", "pyproject.toml", "LICENSE", "data/*.csv", "data/*.md"),
    *(f"hoverslam_lib/**/*.{kind}" for kind in ("py", "md", "css", "js", "mplstyle")),
)
"""What a copy needs beside it where nothing is installed."""
HANDED_OUT = r"## If you were given one file\n.*?(?=\n## )"
"""The README's section that is the README of a copy in one file."""


def lessons(names=()):
    """Paths of the notebooks, in order; `names` picks some: a number is that lesson, part of a name that notebook.

    Raises
    ------
    ValueError
        If a name fits no notebook or several, or the checkout is missing.
    """
    paths = sorted(NOTEBOOKS.glob("*.ipynb"))
    if not paths:
        raise ValueError(f"there are no notebooks in {NOTEBOOKS}: run this from a checkout of the course")
    return [_picked(name, paths) for name in names] or paths


def _picked(name, paths):
    """The one path that a number, a name, part of a name or a path of a notebook means."""
    wanted = Path(name).name.removesuffix(".ipynb").lower()
    if Path(name).parent.name not in ("", NOTEBOOKS.name):  # of another folder
        fitting = []
    elif re.fullmatch("[0-9]+", wanted):
        fitting = [path for path in paths if re.match(f"0*{int(wanted)}_", path.name)]
    else:
        fitting = [path for path in paths if path.stem == wanted] or [path for path in paths if wanted in path.stem]
    if len(fitting) == 1:
        return fitting[0]
    listed = ", ".join(path.stem for path in fitting or paths)
    raise ValueError(f"{name!r} means {'more than one of' if fitting else 'no lesson; there are'} {listed}")


def refresh(path):
    """Execute one notebook in a fresh kernel, clean it, write it if it changed, and return its `problems`.

    Raises
    ------
    nbclient.exceptions.CellExecutionError
        If a cell raises; the file is left as it was.
    """
    import nbformat
    from nbclient import NotebookClient
    from traitlets.config import Config

    notebook = _without_outputs(path)
    NotebookClient(
        notebook,
        kernel_name="python3",
        timeout=600,
        record_timing=False,
        coalesce_streams=True,
        resources={"metadata": {"path": str(path.parent)}},
        config=Config(KernelManager={"transport_encryption": "auto"}),  # else ipykernel warns that there is none
    ).execute()
    _clean(notebook)
    text = nbformat.writes(notebook) + "\n"
    if text != path.read_text(encoding="utf-8"):
        path.write_text(text, encoding="utf-8")
    return problems(path)


def _without_outputs(path):
    """A notebook as it is before anything is run."""
    import nbformat

    notebook = nbformat.read(path, as_version=4)
    for cell in notebook.cells:
        if cell.cell_type == "code":
            cell.outputs, cell.execution_count = [], None
    return notebook


def _clean(notebook):
    """Keep what is the same in every run: no versions, no timings, no random names of cells, no addresses of films."""
    notebook.metadata = {
        "kernelspec": {"display_name": "Python 3 (ipykernel)", "language": "python", "name": "python3"},
        "language_info": {"name": "python"},
    }
    notebook.nbformat, notebook.nbformat_minor = 4, 5
    for i, cell in enumerate(notebook.cells):
        tags = cell.metadata.get("tags")
        cell.metadata = {"tags": tags} if tags else {}
        cell["id"] = f"cell-{i:03d}"
        for output in cell.get("outputs", []):
            if "metadata" in output:
                output["metadata"] = {}
            data = output.get("data", {})
            data.pop("application/vnd.jupyter.widget-view+json", None)  # the still stays
            if "text/html" in data:
                data["text/html"] = re.sub(r"(data:image/gif;base64,[\w+/=]+)#\d+", r"\1", data["text/html"])
        if "outputs" in cell:
            cell.outputs = [output for output in cell.outputs if output.get("data") != {}]


def problems(path):
    """What is wrong with a stored notebook, as a list of sentences; an empty list if nothing is."""
    import nbformat

    found = []
    notebook = nbformat.read(path, as_version=4)
    if notebook.metadata.get("kernelspec", {}).get("name") != "python3":
        found.append("its kernel is not python3")
    if path.stat().st_size > LARGEST_FILE:
        found.append(f"it has {path.stat().st_size:,} bytes; {LARGEST_FILE:,} are allowed")
    code = [cell for cell in notebook.cells if cell.cell_type == "code"]
    if [cell.execution_count for cell in code] != list(range(1, len(code) + 1)):
        found.append("its execution counts are not 1, 2, 3 …: run it from top to bottom in a fresh kernel")
    for number, cell in enumerate(code, start=1):
        found += [f"cell [{number}] {problem}" for problem in _cell_problems(cell)]
    for cell in notebook.cells:
        if cell.cell_type == "markdown":
            found += [
                f"an image has no alternative text: {image}" for image in re.findall(r"!\[\]\([^)]*\)", cell.source)
            ]
    return found


def _cell_problems(cell):
    lines = [text for text in cell.source.splitlines() if text.strip()]
    if not lines:
        yield "is empty"
    if len(lines) > LONGEST_CELL:
        yield f"has {len(lines)} lines; {LONGEST_CELL} are allowed"
    if re.search(r"^\s*from\s+\S+\s+import\s+\*", cell.source, re.MULTILINE):
        yield "imports *"
    if re.search(
        r"\b(urllib|requests|urlopen|httpx|socket)\b|^\s*[!%]\s*(pip|conda|curl|wget)", cell.source, re.MULTILINE
    ):
        yield "uses the network"
    if lines and lines[-1].rstrip().endswith(";"):
        yield "ends in a semicolon"
    for output in cell.outputs:
        if output.output_type == "error" and "raises-exception" not in cell.metadata.get("tags", []):
            yield f"stores an error: {output.ename}"
        if output.get("name") == "stderr":
            yield f"stores a warning or other stderr: {output.text.strip()[:80]}"
        data = output.get("data", {})
        if any(kind.startswith("image/") for kind in data):
            yield "stores an image without alternative text: use plotting.show"
        if "application/vnd.jupyter.widget-view+json" in data:
            yield "stores a widget, which shows 'model not found' until it is run"
        for alt in _alternative_texts(data.get("text/html", "")):
            if not re.search(r"\d", alt):
                yield f"stores an image whose alternative text has no numbers: {alt!r}"


def _alternative_texts(html):
    """The alt of every <img> in a piece of HTML, empty where there is none."""
    for tag in re.findall(r"<img\b[^>]*>", html):
        alt = re.search(r'\balt="([^"]*)"', tag)
        yield alt.group(1) if alt else ""


def environment_problems():
    """What of environment.txt is missing here or does not fit, as a list of sentences; empty if all is well."""
    requirements = NOTEBOOKS.parent / "environment.txt"
    if not requirements.exists():
        return [f"there is no {requirements}: install the library from a checkout of the course"]
    found = []
    for name, low, high in re.findall(r"^([\w-]+)>=([\d.]+),<([\d.]+)$", requirements.read_text("utf-8"), re.MULTILINE):
        try:
            version = metadata.version(name)
        except metadata.PackageNotFoundError:
            found.append(f"{name} is missing")
            continue
        if not _numbers(low) <= _numbers(version) < _numbers(high):
            found.append(f"{name} {version} is installed; the course needs at least {low} and less than {high}")
    if found:
        found.append(f"To mend this, run in {requirements.parent}: {sys.executable} -m pip install -r environment.txt")
    return found


def _numbers(version):
    return tuple(int(number) for number in re.findall(r"\d+", version))


def copy(folder, lesson=None, for_teaching=False, withhold_solutions=False):
    """Make a working copy of the notebooks, or complete the one that is there; nothing that is there is overwritten.

    Parameters
    ----------
    folder : path
        Made if need be. A ``.gitignore`` in it keeps git away.
    lesson : str, optional
        Number or name: put a fresh copy of this lesson, under a new name, beside the one that is there.
    for_teaching : bool, optional
        Keep the outputs, which hold the answers to the predictions, and add the instructor's guide and mission control.
    withhold_solutions : bool, optional
        Leave a marker, `checks.WITHHELD`, at which ``checks.show_solution`` says to ask the instructor. Who looks into
        the library finds the solutions all the same.

    Returns
    -------
    list of Path
        What was written.

    Raises
    ------
    ValueError
        If the folder is no place for a copy, or `lesson` means none or several.
    OSError
        If the file system refuses.
    """
    return list(_copying(Path(folder), lesson, for_teaching, withhold_solutions))


def _copying(folder, lesson, for_teaching, withhold_solutions):
    """What `copy` writes, as soon as it is written."""
    sources = _sources(for_teaching)
    again = None if lesson is None else _picked(lesson, [path for path in sources if path.suffix == ".ipynb"])
    _check_place(folder, sources)
    folder.mkdir(parents=True, exist_ok=True)
    if not os.path.lexists(folder / ".gitignore"):
        (folder / ".gitignore").write_text("*\n", encoding="utf-8")
    for source in sources:
        target, n = folder / source.relative_to(NOTEBOOKS), 1
        while source == again and os.path.lexists(target):
            n += 1
            target = folder / f"{source.stem}_fresh_{n}.ipynb"
        if not os.path.lexists(target):
            yield _write(target, _content(source, for_teaching))
    if withhold_solutions:
        from hoverslam_lib.checks import WITHHELD

        if not os.path.lexists(folder / WITHHELD):
            yield _write(folder / WITHHELD, b"")


def _sources(for_teaching):
    """What belongs into a copy: only what is named here, so nothing that somebody left between the lessons."""
    found = [path for path in lessons() if re.fullmatch(r"\d\d_\w+", path.stem)]
    found += [NOTEBOOKS / name for name in ("glossary.md", *(FOR_INSTRUCTORS if for_teaching else ()))]
    found += [path for path in sorted((NOTEBOOKS / "images").glob("*.*")) if not path.name.startswith(".")]
    return [path for path in found if path.is_file()]


def zipped(folder, for_teaching=False, withhold_solutions=False):
    """Make one file to hand out, ``FOLDER.zip``: a new copy with the library and what pip asks for; always the same.

    Parameters
    ----------
    folder : path
        The name of the folder that is in the file.
    for_teaching, withhold_solutions : bool, optional
        As for `copy`.

    Returns
    -------
    Path
        The file.

    Raises
    ------
    ValueError
        If the file is there already, or the place is in the course's own folders.
    OSError
        If the file system refuses.
    """
    folder, project = Path(folder), NOTEBOOKS.parent
    if folder.name in ("", ".."):
        raise ValueError(f"{folder} is no name for a file: choose one, such as my_course")
    target = folder.with_name(f"{folder.name.removesuffix('.zip')}.zip")
    if os.path.lexists(target):
        raise ValueError(f"{target} is there already and left as it is: name another")
    _check_place(target, [])
    with tempfile.TemporaryDirectory() as scratch:
        made = Path(scratch, target.stem)
        copy(made, for_teaching=for_teaching, withhold_solutions=withhold_solutions)
        for source in (path for pattern in TO_INSTALL for path in project.glob(pattern)):
            (made / source.relative_to(project)).parent.mkdir(parents=True, exist_ok=True)
            (made / source.relative_to(project)).write_bytes(source.read_bytes())
        readme = (project / "README.md").read_text(encoding="utf-8")
        title, section = readme.partition("\n")[0], re.search(HANDED_OUT, readme, re.DOTALL).group()
        (made / "README.md").write_text(f"{title}\n\n{section}", encoding="utf-8", newline="\n")
        packed = Path(scratch, target.name)
        with zipfile.ZipFile(packed, "w", zipfile.ZIP_DEFLATED) as file:
            for path in sorted(path for path in made.rglob("*") if path.is_file()):
                member = zipfile.ZipInfo(path.relative_to(scratch).as_posix())  # of 1980, so no clock is in it
                member.external_attr = 0o644 << 16
                file.writestr(member, path.read_bytes(), zipfile.ZIP_DEFLATED)
        target.parent.mkdir(parents=True, exist_ok=True)
        return _write(target, packed.read_bytes())


def _check_place(folder, sources):
    """Refuse a folder in which a copy would do harm."""
    place = Path(os.path.realpath(folder))
    if place.exists() and not place.is_dir():
        raise ValueError(f"{folder} is a file: name a folder")
    project = NOTEBOOKS.parent
    if any(_same(place, parent) for parent in (project, *project.parents)):
        raise ValueError(f"{folder} holds the course itself: name a new folder, such as {folder / 'my_course'}")
    for own in (NOTEBOOKS, *(project / name for name in ("hoverslam_lib", "data", "tests"))):
        if any(_same(parent, own) for parent in (place, *place.parents)):
            raise ValueError(f"{folder} is in the course's own folder {own}: name one outside of it")
    names = set(os.listdir(place)) if place.exists() else set()
    ignored = ".gitignore" in names and (place / ".gitignore").read_text(encoding="utf-8").strip() == "*"
    if names and not ignored and names.isdisjoint(path.name for path in sources if path.suffix == ".ipynb"):
        raise ValueError(f"{folder} holds other files and no copy: name a new folder, such as {folder / 'my_course'}")


def _same(one, other):
    """Whether two paths are one folder, also where the file system knows it under several names."""
    return one.exists() and other.exists() and one.samefile(other)


def _content(source, for_teaching):
    if for_teaching or source.suffix != ".ipynb":
        return source.read_bytes()
    import nbformat

    return (nbformat.writes(_without_outputs(source)) + "\n").encode()


def _write(target, content):
    """Write a file whole or not at all: what a full disk cut short would be taken for the student's own later."""
    target.parent.mkdir(exist_ok=True)
    part = target.with_name(f".{target.name}.part")
    try:
        part.write_bytes(content)
        return part.rename(target)
    finally:
        part.unlink(missing_ok=True)


def main(arguments=None):
    """Command line: see the module's docstring. Returns the exit code."""
    parser = argparse.ArgumentParser(prog="python -m hoverslam_lib.course", description="The life of a notebook.")
    commands = parser.add_subparsers(dest="command", required=True)
    refreshing = commands.add_parser("refresh", help="execute lessons, clean and check what they store")
    refreshing.add_argument("lesson", nargs="*", help="number or name; all lessons if left out")
    copying = commands.add_parser("copy", help="make a working copy that git leaves alone, or go on with the one there")
    copying.add_argument("folder")
    copying.add_argument("--lesson", help="number or name: a fresh copy of this lesson beside the edited one")
    copying.add_argument("--for-teaching", action="store_true", help="with outputs, guide and mission control")
    copying.add_argument("--withhold-solutions", action="store_true", help="show_solution says to ask the instructor")
    copying.add_argument("--zip", action="store_true", help="one file to hand out, FOLDER.zip, with all it needs")
    booking = commands.add_parser("book", help="make pages for any browser, whose figures move without Python")
    booking.add_argument("folder")
    booking.add_argument("--for-students", action="store_true", help="without the instructor's guide")
    booking.add_argument("--open", action="store_true", help="show the answers to the predictions at once")
    booking.add_argument("--withhold-solutions", action="store_true", help="without the solutions of the exercises")
    collecting = commands.add_parser("collect", help="judge returned copies: runs the students' code, see the guide")
    collecting.add_argument("folder", help="a folder or a zip a student in it; the tables are written there too")
    collecting.add_argument("lesson", nargs="*", help="number or name; all lessons if left out")
    options = parser.parse_args(arguments)
    run = {"refresh": _refresh_all, "copy": _copy_all, "book": _make_book, "collect": _collect_all}
    try:
        return run[options.command](options)
    except ValueError as error:
        print(error, file=sys.stderr)
    except OSError as error:
        place = f" {error.filename}" if error.filename else ""
        print(f"cannot use{place}: {error.strerror}; choose a place where you may write", file=sys.stderr)
    return 2


def _refresh_all(options):
    from nbclient.exceptions import CellExecutionError

    failed = 0
    paths = lessons(options.lesson)
    for n, path in enumerate(paths, start=1):
        print(f"[{n}/{len(paths)}] {path.name} ", end="", flush=True)
        start = time.perf_counter()
        try:
            found = refresh(path)
        except CellExecutionError as error:
            found = [f"a cell raises, and the file is left as it was:\n{error}"]
        print(f"{time.perf_counter() - start:.0f} s;", _size(path), "" if found else "; ok")
        for problem in found:
            print(f"    {problem}")
        failed += bool(found)
    return 1 if failed else 0


def _size(path):
    """For the author's eye: how long the cells are, and how much of the page is text."""
    import nbformat

    cells = nbformat.read(path, as_version=4).cells
    code = [cell.source for cell in cells if cell.cell_type == "code"]
    text = sum(len(cell.source.split()) for cell in cells if cell.cell_type == "markdown")
    lines = [sum(bool(line.strip()) for line in source.splitlines()) for source in code]
    share = text / sum(len(source.split()) for source in code)
    median = statistics.median(lines)
    return f"{len(code)} code cells, median {median:.0f} lines; {share:.1f} words of text to one of code"


def _make_book(options):
    try:
        from hoverslam_lib import book

        wanted = {"for_students": options.for_students, "unfold": options.open}
        book.build(lessons(), options.folder, withhold_solutions=options.withhold_solutions, **wanted)
    except ModuleNotFoundError as error:
        raise ValueError(f"{error.name} is missing: run pip install -e '.[book]' in {NOTEBOOKS.parent}") from None
    print(f"wrote {Path(options.folder, 'index.html')}")
    return 0


def _copy_all(options):
    if options.zip and options.lesson:
        raise ValueError("--lesson goes on with a copy that is there, and --zip makes a new one: choose one of them")
    if options.zip:
        print(f"wrote {zipped(options.folder, options.for_teaching, options.withhold_solutions)}")
        return 0
    written = 0
    for path in _copying(Path(options.folder), options.lesson, options.for_teaching, options.withhold_solutions):
        print(f"wrote {path}", flush=True)
        written += 1
    if not written:
        print(f"{options.folder} is complete and left as it is; --lesson and a number put a fresh lesson beside yours")
    return 0


def _collect_all(options):
    from hoverslam_lib import collect

    folder, start = Path(options.folder), time.perf_counter()
    number = len(collect.returned(folder))
    all_of_them = [path for path in lessons() if re.match(r"\d\d_", path.name)]
    asked = [path for path in lessons(options.lesson) if path in all_of_them]
    for n, result in enumerate(collect.collect(folder, all_of_them, asked), start=1):
        counts = ", ".join(f"{result.count(mark)} {mark}" for mark in "✔✘○")
        print(f"[{n}/{number}] {result.student}: {counts} ({time.perf_counter() - start:.0f} s)", flush=True)
    print(f"wrote {' and '.join(str(folder / name) for name in collect.TABLES)}")
    return 0


if __name__ == "__main__":
    sys.stdout.reconfigure(errors="backslashreplace")  # a name of a folder that the terminal cannot show is no error
    sys.exit(main())
