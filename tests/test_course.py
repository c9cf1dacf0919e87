"""Refreshing and copying notebooks."""

import re

import nbformat
import pytest

from hoverslam_lib import course

FIGURE = """
import matplotlib.pyplot as plt
from hoverslam_lib import plotting
plotting.use_style()
fig, ax = plt.subplots()
ax.plot([0, 1], [0, 1], **plotting.line("rk4"))
plotting.show(fig, alt="a line to 1")
"""


@pytest.fixture
def folder(tmp_path, monkeypatch):
    """A project with two small lessons, as an editor would leave them: not executed, with metadata of a machine."""
    notebooks = tmp_path / "notebooks"
    (notebooks / "solutions").mkdir(parents=True)
    (notebooks / "images").mkdir()
    (notebooks / "images" / "picture.png").write_bytes(b"png")
    (notebooks / "instructor_guide.md").write_text("answers")
    (notebooks / ".hoverslam_progress.json").write_text("the instructor's own")
    for name in ("01_first", "02_second"):
        cells = [nbformat.v4.new_markdown_cell("# 1"), nbformat.v4.new_code_cell("print('a')\nprint('b')")]
        cells.append(nbformat.v4.new_code_cell(FIGURE, metadata={"collapsed": True, "tags": ["kept"]}))
        metadata = {"language_info": {"name": "python", "version": "3.2.1"}}
        nbformat.write(nbformat.v4.new_notebook(cells=cells, metadata=metadata), notebooks / f"{name}.ipynb")
    monkeypatch.setattr(course, "NOTEBOOKS", notebooks)
    return notebooks


def test_refresh_executes_cleans_and_changes_nothing_the_second_time(folder):
    path = folder / "01_first.ipynb"
    assert course.problems(path) != []
    assert course.refresh(path) == []
    once = path.read_bytes()
    stored = nbformat.reads(once.decode(), as_version=4)
    assert [cell.execution_count for cell in stored.cells[1:]] == [1, 2]
    assert stored.cells[1].outputs[0].text == "a\nb\n"
    assert stored.cells[2].metadata == {"tags": ["kept"]}
    assert b"3.2.1" not in once
    assert 'alt="a line to 1"' in stored.cells[2].outputs[0].data["text/html"]
    assert course.refresh(path) == []
    assert path.read_bytes() == once


def test_refresh_of_a_lesson_that_raises_says_so_and_leaves_the_file(folder, capsys):
    path = folder / "02_second.ipynb"
    broken = nbformat.read(path, as_version=4)
    broken.cells.append(nbformat.v4.new_code_cell("1 / 0"))
    nbformat.write(broken, path)
    before = path.read_bytes()
    assert course.main(["refresh", "02"]) == 1
    assert path.read_bytes() == before
    assert "ZeroDivisionError" in capsys.readouterr().out


def test_refresh_picks_lessons_by_number_name_or_path(folder):
    assert [path.stem for path in course.lessons()] == ["01_first", "02_second"]
    for name in ("02", "02_second", "notebooks/02_second.ipynb"):
        assert [path.stem for path in course.lessons([name])] == ["02_second"]


def test_unknown_lesson_is_named_with_those_there_are(folder, capsys):
    assert course.main(["refresh", "77"]) == 2
    message = capsys.readouterr().err
    assert "'77'" in message
    assert "02_second" in message


def test_copy_is_left_alone_by_git_and_holds_no_solutions(folder, tmp_path):
    target = tmp_path / "mine"
    course.copy(target)
    names = {path.name for path in target.iterdir()}
    assert names == {".gitignore", "01_first.ipynb", "02_second.ipynb", "images"}
    assert (target / ".gitignore").read_text() == "*\n"


def test_copy_overwrites_nothing_and_puts_a_fresh_lesson_beside_the_edited_one(folder, tmp_path):
    target = tmp_path / "mine"
    course.main(["copy", str(target)])
    edited = target / "01_first.ipynb"
    edited.write_text("my work")
    course.main(["copy", str(target)])
    assert edited.read_text() == "my work"
    for expected in ("01_first_fresh_2.ipynb", "01_first_fresh_3.ipynb"):
        course.main(["copy", str(target), "--lesson", "01"])
        assert (target / expected).read_bytes() == (folder / "01_first.ipynb").read_bytes()
    assert edited.read_text() == "my work"


def test_printed_page_needs_no_network_and_no_script(folder, tmp_path, capsys):
    path = folder / "01_first.ipynb"
    lesson = nbformat.read(path, as_version=4)
    text = r"half is $\frac{1}{2}$ and $$a^2 = b_n$$ [next](02_second.ipynb) ![3](images/picture.png)"
    lesson.cells.append(nbformat.v4.new_markdown_cell(text))
    nbformat.write(lesson, path)
    course.refresh(path)
    assert course.main(["print", str(tmp_path / "pages"), "01"]) == 0
    page = (tmp_path / "pages" / "01_first.html").read_text(encoding="utf-8")
    assert page.count("<math ") == 2
    assert "<mfrac><mrow><mn>1</mn></mrow><mrow><mn>2</mn></mrow></mfrac>" in page
    assert 'display="block"' in page
    assert 'href="02_second.html"' in page
    assert 'alt="a line to 1"' in page
    assert "<script" not in page
    assert not re.search(r'(?:src|href)="(?!data:|#|02_second)', page)
    assert "1/1" in capsys.readouterr().out


@pytest.mark.parametrize("path", course.lessons(), ids=lambda path: path.stem)
def test_every_formula_of_the_course_can_be_printed(path):
    page = course.page(path)
    assert not re.search(r"formula-\d|\$[^<$\n]*\\[a-z]+[^<$\n]*\$|<mtext>\\|<mi>\\", page)
    assert not re.search(r'<(?:link|script|img)\b[^>]*(?:src|href)="https?:', page)
