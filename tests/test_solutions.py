"""Every notebook with its exercises solved, in a kernel of its own: they run, and every check answers ✔.

This takes a minute; it is done where ``SOLVED=1`` is set, as in ``.ci/run``.
"""

import os
import re

import nbformat
import pytest
from nbclient import NotebookClient
from test_checks import LESSONS, cells_of, solutions


@pytest.mark.skipif(not os.environ.get("SOLVED"), reason="slow: set SOLVED=1 to run every notebook with its solutions")
@pytest.mark.parametrize("path", LESSONS, ids=lambda path: path.stem)
def test_every_check_answers_done_when_its_stub_is_replaced_by_the_solution(path, tmp_path):
    notebook = nbformat.read(path, as_version=4)
    solved = solutions(int(path.name[:2]))
    numbers = {cell.id: number for number, cell in cells_of(path)}
    for cell in notebook.cells:
        if cell.id in numbers:
            call = re.search(r"^checks\.\w+\(.*", cell.source, re.MULTILINE | re.DOTALL).group()
            cell.source = f"{solved[numbers[cell.id]]}\n\n\n{call}"
    NotebookClient(
        notebook, kernel_name="python3", timeout=300, resources={"metadata": {"path": str(tmp_path)}}
    ).execute()
    said = {numbers[cell.id]: cell.outputs[-1].data["text/plain"] for cell in notebook.cells if cell.id in numbers}
    assert {number: text for number, text in said.items() if not text.startswith("✔")} == {}
    assert len(said) == len(numbers)
