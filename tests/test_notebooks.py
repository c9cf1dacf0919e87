"""The notebooks and pages as files. What their cells compute is compared by nbval."""

import re

import nbformat
import pytest

from hoverslam_lib import course

NOTEBOOKS = course.lessons()
LESSONS = [path for path in NOTEBOOKS if path.name[0].isdigit()]
PAGES = [*NOTEBOOKS, *sorted(course.NOTEBOOKS.glob("*.md")), course.NOTEBOOKS.parent / "README.md"]


def prose(path):
    if path.suffix == ".md":
        return path.read_text(encoding="utf-8")
    cells = nbformat.read(path, as_version=4).cells
    return "\n\n".join(cell.source for cell in cells if cell.cell_type == "markdown")


def notebook(tmp_path, *cells, **metadata):
    """A notebook that is in order, but for the cells given."""
    first = nbformat.v4.new_code_cell("1 + 1", execution_count=1)
    kernel = {"kernelspec": {"name": "python3", "display_name": "Python 3", "language": "python"}}
    path = tmp_path / "lesson.ipynb"
    nbformat.write(nbformat.v4.new_notebook(cells=[first, *cells], metadata=kernel | metadata), path)
    return path


def code(source, count=2, **output):
    outputs = [nbformat.v4.new_output(**output)] if output else []
    return nbformat.v4.new_code_cell(source, execution_count=count, outputs=outputs)


@pytest.mark.parametrize("path", NOTEBOOKS, ids=lambda path: path.stem)
def test_notebook_is_stored_in_order(path):
    assert course.problems(path) == []


@pytest.mark.parametrize("path", LESSONS, ids=lambda path: path.stem)
def test_lesson_has_its_parts(path):
    text = prose(path)
    assert re.match(r"# \d+ · \S", text)
    for part in (r"\*\*The question of this lesson:\*\*", r"\*\*Time\*\* \d+ minutes", r"\*\*You need\*\*"):
        assert re.search(part, text), part
    for part in (r"\*\*Predict", "## What we learned", r"\*\*Common mistakes\.\*\*", r"\*\*Further reading\.\*\*"):
        assert re.search(part, text), part
    assert "(glossary.md)" in text.split("##")[0]


@pytest.mark.parametrize("path", NOTEBOOKS, ids=lambda path: path.stem)
def test_no_line_of_a_formula_or_sentence_is_taken_for_a_list(path):
    """Markdown makes a list item of a line that begins with a plus or minus, and a quotation of one with a >."""
    for cell in nbformat.read(path, as_version=4).cells:
        if cell.cell_type == "markdown":
            text = re.sub(r"\$\$.*?\$\$", "", cell.source, flags=re.DOTALL)
            lines = text.split("\n")
            for before, line in zip(lines, lines[1:], strict=False):
                assert not re.match(r" {0,3}>", line), line
                if re.match(r" {0,3}[-+*] ", line) and before.strip():
                    assert re.match(r"\s*([-+*]|\d+\.) |  ", before), line


@pytest.mark.parametrize("path", PAGES, ids=lambda path: path.name)
def test_every_link_to_a_file_leads_somewhere(path):
    links = re.findall(r"\]\((?!https?:|#)([^)#]+)[^)]*\)", prose(path))
    assert [link for link in links if not (path.parent / link).exists()] == []


BROKEN = {
    "15 are allowed": code("\n".join(f"a = {i}" for i in range(16))),
    "imports *": code("from math import *"),
    "network": code("import urllib.request"),
    "semicolon": code("1 + 1;"),
    "is empty": code("  "),
    "execution counts": code("1 + 1", count=7),
    "an error": code("1 / 0", output_type="error", ename="ZeroDivisionError", evalue="", traceback=[]),
    "stderr": code("1", output_type="stream", name="stderr", text="UserWarning"),
    "use plotting.show": code("1", output_type="display_data", data={"image/png": "iVBO"}),
    "has no numbers": code("1", output_type="display_data", data={"text/html": '<img alt="a line" src="x">'}),
    "has no numbers: ''": code("1", output_type="display_data", data={"text/html": '<img src="x">'}),
    "model not found": code(
        "1", output_type="display_data", data={"application/vnd.jupyter.widget-view+json": {"model_id": "0"}}
    ),
    "an image has no alternative text": nbformat.v4.new_markdown_cell("![](images/landing.png)"),
}


@pytest.mark.parametrize("problem", BROKEN)
def test_problem_is_found(tmp_path, problem):
    found = course.problems(notebook(tmp_path, BROKEN[problem]))
    assert len(found) == 1
    assert problem in found[0]
    assert not found[0].startswith("cell") or found[0].startswith("cell [2] ")


def test_kernel_and_size_are_checked(tmp_path):
    assert course.problems(notebook(tmp_path)) == []
    assert "kernel" in course.problems(notebook(tmp_path, kernelspec={"name": "ir", "display_name": "R"}))[0]
    assert "bytes" in course.problems(notebook(tmp_path, code("'" + "x" * 700_000 + "'")))[0]
