"""The book without Sphinx, of one small lesson: what is recorded and kept, and what its pages are made of."""

import base64
import contextlib
import io
import json
import re
import subprocess
from pathlib import Path
from types import SimpleNamespace

import nbformat
import numpy as np
import pytest
from PIL import Image

from hoverslam_lib import book, checks, course, live

MOVES = """import matplotlib.pyplot as plt
from ipywidgets import FloatSlider
from hoverslam_lib.live import Live
open("left.txt", "w").close()
print("what nobody hears")
fig, ax = plt.subplots(figsize=(2, 1))
(point,) = ax.plot([], [], "o", animated=True)

def put(x):
    point.set_data([x], [0])
    return f"the point is at {x:g} m"

Live(fig, put, x=FloatSlider(1, min=0, max=2, step=1, description="x [m]")).show()"""
STILL = f'{live._ONE_OF_TWO}<div class="hoverslam-still"><img alt="1 m" width="200" style="max-width:100%" src="x">'
STILL += f"<p>the point is at 1 m <em>{live.STILL}</em></p></div>"
PICTURE = '<img alt="a line to 3 m" width="500" style="max-width:100%" src="x">'


def shows(html):
    return [nbformat.v4.new_output("display_data", data={"text/html": html, "text/plain": "1 m"})]


def code(source, html=None, *tags):
    outputs = shows(html) if html else []
    return nbformat.v4.new_code_cell(source, outputs=outputs, metadata={"tags": list(tags)})


def text(source, *tags):
    return nbformat.v4.new_markdown_cell(source, metadata={"tags": list(tags)} if tags else {})


@pytest.fixture
def lesson(tmp_path, monkeypatch):
    """A lesson 2 in a folder of its own, its recordings kept beside it."""
    monkeypatch.setattr(live.Live, "show", live.Live.show)  # which recording puts its own in the place of
    monkeypatch.setattr(book, "RECORDINGS", tmp_path / "kept")
    folder = tmp_path / "notebooks"
    (folder / "images").mkdir(parents=True)
    for name in ("glossary.md", "instructor_guide.md", "images/landing.png"):
        (folder / name).write_text(name)
    cells = [
        text("# 2 · A small lesson\n\nIt is short."),
        code("raise ValueError('on purpose')", None, "raises-exception"),
        code("points = [1, 3]", PICTURE),
        text("Look.\n\n**Predict.** How far is it?"),
        text("*I expect:*", "prediction"),
        code("print(4)", "<b>4 m</b>", "answer"),
        text("Four.\n\nNot five.\n\n## What follows"),
        code("print(5)", "<b>5 m</b>"),
        text("**Predict.** And now?"),
        text("Nothing.", "answer"),
        text("As was said.\n\n**Next:** more"),
        code(MOVES, STILL),
        code("def my_energy_factor(): ...\n\n\nchecks.energy_factor(my_energy_factor)"),
        code("raise RuntimeError('behind the last figure')"),
    ]
    nbformat.write(nbformat.v4.new_notebook(cells=cells), folder / "02_small.ipynb")
    return folder / "02_small.ipynb"


@pytest.fixture
def here(monkeypatch):
    """Workers in this process, where what is patched holds."""
    monkeypatch.setattr(book, "ProcessPoolExecutor", lambda **how: contextlib.nullcontext(SimpleNamespace(map=map)))


def recorded(path):
    name, record = re.fullmatch(r'hoverslam\.recordings\["(.+?)"\] = (.*);\n', path.read_text("utf-8")).groups()
    return name, json.loads(record)


def test_figures_are_recorded_by_the_cells_that_lead_to_them_and_kept(lesson, here, capsys, tmp_path):
    (tmp_path / "kept").mkdir()
    former = tmp_path / "kept" / "02_small-0-former.js"
    former.write_text("of an earlier version")
    before = Path.cwd()
    assert book.live_cells(lesson) == [11]
    names = book.record_all([lesson])
    assert capsys.readouterr().out == "[1/1] recorded 02_small\n"
    assert list(names) == ["02_small-0"]
    name, record = recorded(names["02_small-0"])
    assert name == "02_small-0"
    assert record["sentences"] == ["the point is at 0 m", "the point is at 1 m", "the point is at 2 m"]
    assert not former.exists()
    assert Path.cwd() == before
    assert not Path("left.txt").exists()
    assert book.record_all([lesson]) == names
    assert capsys.readouterr().out == "", "nothing is recorded twice"


def test_kept_recording_is_another_as_soon_as_what_leads_to_the_figure_is(lesson, monkeypatch):
    def key():
        (kept,) = book._kept(lesson).values()
        return kept.name

    def change(number, source):
        notebook = nbformat.read(lesson, as_version=4)
        notebook.cells[number].source = source
        nbformat.write(notebook, lesson)

    first = key()
    change(13, "behind the figure")
    change(8, "a text before it")
    assert key() == first
    change(2, "points = [1, 4]")
    second = key()
    assert second != first
    version = book.metadata.version
    monkeypatch.setattr(book.metadata, "version", lambda name: "99" if name == "matplotlib" else version(name))
    assert key() != second


def test_kept_recording_is_another_with_another_library_but_not_with_another_command_line(
    lesson, monkeypatch, tmp_path
):
    (tmp_path / "hoverslam_lib").mkdir()
    monkeypatch.setattr(book, "PROJECT", tmp_path)
    keys = []
    for name in ("integrators.py", "style.mplstyle", "course.py", "collect.py", "notes.txt"):
        (tmp_path / "hoverslam_lib" / name).write_text("# changed")
        keys += book._kept(lesson).values()
    assert len(set(keys[:2])) == 2
    assert len(set(keys[1:])) == 1


def test_lesson_without_a_figure_needs_no_recording(tmp_path, monkeypatch, capsys):
    monkeypatch.setattr(book, "RECORDINGS", tmp_path / "kept")
    nbformat.write(nbformat.v4.new_notebook(cells=[code("1 / 0", PICTURE)]), tmp_path / "00_plain.ipynb")
    assert book.record_all([tmp_path / "00_plain.ipynb"]) == {}
    assert capsys.readouterr().out == ""


# ---- pages


def page(lesson, tmp_path, **how):
    how = {"unfold": False, "withhold_solutions": False} | how
    book._write_lesson(tmp_path / "page.ipynb", lesson, ["01_other-0", "02_small-0"], **how)
    return nbformat.read(tmp_path / "page.ipynb", as_version=4).cells


def test_page_folds_what_answers_a_prediction_and_has_help_under_its_exercises(lesson, tmp_path):
    cells = page(lesson, tmp_path)
    assert cells[0].source.startswith("# 2 · ")
    assert cells[1].source == book.WITHOUT_PYTHON
    hidden = [cell.source for cell in cells if "hide-output" in cell.metadata.get("tags", [])]
    assert hidden == ["print(4)"]
    folded = [cell.source for cell in cells if cell.source.startswith("<details>")]
    assert folded == [
        "<details><summary>Show what to make of it</summary>\n\nFour.\n\nNot five.\n\n</details>",
        "<details><summary>Show the answer</summary>\n\nNothing.\n\n</details>",
        "<details><summary>Show what to make of it</summary>\n\nAs was said.\n\n</details>",
        folded[-1],
    ]
    assert [cell.source for cell in cells if cell.source in ("## What follows", "**Next:** more")] != []
    exercise = checks.EXERCISES["2.1"]
    asked = next(n for n, cell in enumerate(cells) if "checks.energy_factor(" in cell.source)
    assert cells[asked + 1].source == folded[-1]
    assert all(f"- {hint}" in folded[-1] for hint in exercise.hints)
    assert f"```python\n{exercise.solution.strip()}\n```" in folded[-1]


def test_page_may_be_unfolded_and_withhold_solutions(lesson, tmp_path):
    sources = [cell.source for cell in page(lesson, tmp_path, unfold=True, withhold_solutions=True)]
    assert "Four.\n\nNot five.\n\n## What follows" in sources
    (folded,) = [source for source in sources if "<details>" in source]
    assert "Hints" in folded
    assert "Solution" not in folded


def test_page_has_the_recording_in_place_of_the_still_and_lets_a_wide_picture_scroll(lesson, tmp_path):
    outputs = [output.data["text/html"] for cell in page(lesson, tmp_path) for output in cell.get("outputs", [])]
    assert f'width="500" style="min-width:{0.72 * 500:.0f}px"' in outputs[0]
    (still,) = [html for html in outputs if "data-recording" in html]
    assert 'data-recording="02_small-0"' in still
    assert '<p role="status">the point is at 1 m</p>' in still
    assert 'alt="1 m"' in still
    assert "hoverslam-still" not in "".join(outputs)


def test_mission_control_is_a_page_without_help_and_contents(lesson, tmp_path):
    mission = lesson.with_name("mission_control.ipynb")
    lesson.rename(mission)
    book._write_lesson(tmp_path / "page.ipynb", mission, ["mission_control-0"], False, False)
    written = nbformat.read(tmp_path / "page.ipynb", as_version=4)
    assert written.metadata["html_theme.sidebar_secondary.remove"] is True
    assert [cell.source for cell in written.cells] == [c.source for c in nbformat.read(mission, as_version=4).cells]


WHOLE = {
    "<p>5 m/s and 10 000 of 3 men</p>": "<p>5&#160;m/s and 10&#160;000 of 3 men</p>",
    "<code>5 m</code><p>5 %.</p>": "<code>5 m</code><p>5&#160;%.</p>",
    '<img alt="5 m">': '<img alt="5 m">',
    "<p>7.8e-05 s</p>": '<p><span class="unbroken">7.8e-05</span>&#160;s</p>',
    "<style>a 5 m</style>": "<style>a 5 m</style>",
}
FORMULA = '<span class="math notranslate nohighlight">\\(x = 5\\)</span>'


@pytest.mark.parametrize("html", WHOLE)
def test_numbers_hold_together_and_with_their_units_in_prose(html):
    assert book._unbroken(html) == WHOLE[html]


def test_formula_holds_together_with_its_unit_and_what_closes_the_sentence():
    assert book._unbroken(f"<p>so ({FORMULA} m/s), and</p>") == (
        f'<p>so <span class="unbroken">({FORMULA} m/s),</span> and</p>'
    )


def film(*colours):
    frames, packed = [Image.new("RGB", (4, 4), colour) for colour in colours], io.BytesIO()
    frames[0].save(packed, format="gif", save_all=True, append_images=frames[1:], duration=40)
    return packed.getvalue()


def test_film_has_its_last_picture_beside_it_until_it_is_stopped(tmp_path):
    (tmp_path / "landing.gif").write_bytes(film("red", "blue"))
    inside = base64.b64encode(film("red", "lime")).decode()
    films = f'<img alt="a" src="landing.gif"> <img alt="b" src="data:image/gif;base64,{inside}#1">'
    made = book._with_stills(f'<p>{films}</p><img src="line.png">', tmp_path)
    assert made.count('<img class="still" hidden ') == 2
    stills = re.findall(r'<img class="still" hidden alt="(.)" src="data:image/png;base64,([^"#]*)', made)
    assert [name for name, _ in stills] == ["a", "b"]
    last = [np.array(Image.open(io.BytesIO(base64.b64decode(data))).convert("RGB"))[0, 0] for _, data in stills]
    assert np.argmax(last[0]) == 2
    assert np.argmax(last[1]) == 1


# ---- the whole


@pytest.fixture
def sphinx(monkeypatch):
    """What Sphinx would be given, and pages in its place: of each source its name, with a number and a unit."""
    given = {}

    def run(command, **how):
        source, made = Path(command[-2]), Path(command[-1])
        given.update({path.name: path.read_text("utf-8", "replace") for path in source.rglob("*") if path.is_file()})
        (made / "_static").mkdir(parents=True)
        (made / "_static" / "recorded.js").touch()
        (made / "_sources").mkdir()
        (made / "objects.inv").touch()
        for path in source.glob("*.*"):
            (made / f"{path.stem}.html").write_text(f"<p>{path.stem} is 5 m</p>")
        return subprocess.CompletedProcess(command, given.get("status", 0), "", "WARNING: no such page\n")

    monkeypatch.setattr(book, "find_spec", lambda name: name)
    monkeypatch.setattr(book, "subprocess", SimpleNamespace(run=run))
    return given


def test_book_has_a_page_for_each_lesson_and_takes_the_place_of_a_former_one(lesson, here, sphinx, tmp_path):
    target = tmp_path / "a" / "book"
    book.build([lesson], target)
    names = {path.relative_to(target).as_posix() for path in target.rglob("*") if path.is_file()}
    pages = {"02_small.html", "glossary.html", "index.html", "instructor_guide.html", "prediction_sheet.html"}
    assert names == pages | {"_static/recorded.js", "recordings/02_small-0.js"}
    assert (target / "02_small.html").read_text("utf-8") == "<p>02_small is 5&#160;m</p>"
    assert recorded(target / "recordings" / "02_small-0.js")[0] == "02_small-0"
    assert ":caption: The methods\n\n02_small\n```" in sphinx["index.md"]
    assert "instructor_guide" in sphinx["index.md"]
    assert "## 2 · A small lesson\n\n**Predict.** How far is it?" in sphinx["prediction_sheet.md"]
    sphinx.clear()
    (target / "02_small.html").write_text("old")
    book.build([lesson], target, for_students=True)
    assert (target / "02_small.html").read_text("utf-8") != "old"
    assert not (target / "instructor_guide.html").exists()
    assert "instructor_guide" not in sphinx["index.md"]


def test_book_is_not_made_where_something_else_is_or_with_a_page_that_sphinx_warns_of(lesson, here, sphinx, tmp_path):
    with pytest.raises(ValueError, match="notebooks holds other files and no book: name a new folder"):
        book.build([lesson], lesson.parent)
    sphinx["status"] = 1
    with pytest.raises(ValueError, match="Sphinx cannot make the book:\nWARNING: no such page"):
        book.build([lesson], tmp_path / "book")
    assert list((tmp_path / "book").iterdir()) == []


def test_command_says_what_is_missing_for_a_book(monkeypatch, capsys, tmp_path):
    monkeypatch.setattr(book, "find_spec", lambda name: None)
    assert course.main(["book", str(tmp_path / "book")]) == 2
    said = capsys.readouterr().err
    assert "pip install" in said
    assert "book" in said
    assert not (tmp_path / "book").exists()
