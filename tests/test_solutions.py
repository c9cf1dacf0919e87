"""Every notebook with its exercises solved: ``python tests/test_solutions.py FOLDER`` writes them.

``.ci/run`` tests them in place of the stored ones where it repeats the tests with the oldest versions: there every
check has to answer ✔, and every other cell to give its stored output.
"""

import ast
import builtins
import re
import sys
from pathlib import Path

import nbformat
import pytest
from test_checks import LESSONS, cells_of, solutions

from hoverslam_lib import course


def solved(path):
    """A notebook with the solution in place of each stub; where a check does not answer ✔, its cell raises."""
    notebook = nbformat.read(path, as_version=4)
    numbers = {cell.id: number for number, cell in cells_of(path)}
    answers = solutions(int(path.name[:2])) if numbers else {}
    for cell in notebook.cells:
        if cell.id in numbers:
            call = re.search(r"^checks\.\w+\(.*", cell.source, re.MULTILINE | re.DOTALL).group()
            verdict = f"said = {call}\nassert repr(said).startswith('✔'), said"
            cell.source, cell.outputs = f"{answers[numbers[cell.id]]}\n\n\n{verdict}", []
    return notebook


@pytest.mark.parametrize("path", LESSONS, ids=lambda path: path.stem)
def test_solution_stands_in_place_of_each_stub_and_nothing_else_is_changed(path):
    stubs = {cell.id: cell.source for _, cell in cells_of(path)}
    stored, cells = nbformat.read(path, as_version=4).cells, solved(path).cells
    assert [cell for cell in cells if cell.id not in stubs] == [cell for cell in stored if cell.id not in stubs]
    for cell in cells:
        if cell.id in stubs:
            assert "your code here" not in cell.source
            assert "your answer here" not in cell.source
            assert "startswith('✔')" in cell.source


@pytest.mark.parametrize("path", LESSONS, ids=lambda path: path.stem)
def test_solution_uses_no_name_that_its_lesson_does_not_know(path):
    known = set(dir(builtins))
    for cell in solved(path).cells:
        if cell.cell_type != "code":
            continue
        names = [node for node in ast.walk(ast.parse(cell.source)) if isinstance(node, ast.Name)]
        if "startswith('✔')" in cell.source:
            own = bound(cell.source)
            assert {name.id for name in names} <= known | own, cell.source
        known |= bound(cell.source)


def bound(source):
    """Every name that a cell gives a meaning to, inside its functions or outside."""
    names = set()
    for node in ast.walk(ast.parse(source)):
        if isinstance(node, ast.Name) and isinstance(node.ctx, ast.Store):
            names.add(node.id)
        elif isinstance(node, ast.alias):
            names.add((node.asname or node.name).split(".")[0])
        elif isinstance(node, ast.arg):
            names.add(node.arg)
        elif isinstance(node, (ast.FunctionDef, ast.ClassDef)):
            names.add(node.name)
    return names


def test_cell_raises_where_the_check_is_not_content(monkeypatch, tmp_path):
    monkeypatch.chdir(tmp_path)
    cell = next(cell for cell in solved(LESSONS[0]).cells if "startswith" in cell.source)
    scope = {}
    exec("from hoverslam_lib import checks", scope)
    exec(cell.source, scope)
    with pytest.raises(AssertionError, match="✘"):
        exec(re.sub(r"return .*", "return 0.0", cell.source), scope)


if __name__ == "__main__":
    folder = Path(sys.argv[1])
    folder.mkdir(parents=True, exist_ok=True)
    for lesson in course.lessons():
        nbformat.write(solved(lesson), folder / lesson.name)
