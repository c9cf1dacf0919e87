"""What the tests in a browser share."""

import shutil

import driver
import nbformat
import pytest

from hoverslam_lib import book, course

pytest.register_assert_rewrite("figures")

DOT = """
import time
import matplotlib.pyplot as plt
from ipywidgets import FloatSlider
from hoverslam_lib.live import Live

calls, figures = [], []


def dot(name, pause=0):
    fig, ax = plt.subplots(figsize=(4, 2))
    ax.set(xlim=(0, 10), ylim=(-1, 1))
    (point,) = ax.plot([], [], "o", animated=True)

    def put(x):
        time.sleep(pause)
        calls.append(x)
        point.set_data([x], [0])
        return f"{name} is at {x:.2f}."

    made = Live(fig, put, x=FloatSlider(5, min=0, max=10, step=0.01, description=f"{name} [m]"))
    figures.append(made)
    return made
"""
SCRATCH = {
    "twice": [DOT, "dot('one').show()", "dot('two').show()\ndot('three').show()"],
    "slow": [DOT, "dot('slow', pause=0.08).show()"],
}


@pytest.fixture(scope="module")
def folder(tmp_path_factory):
    """A copy of the notebooks, without their texts and what follows their last live figure, and the scratch ones."""
    copy = tmp_path_factory.mktemp("browser") / "notebooks"
    shutil.copytree(course.NOTEBOOKS, copy)
    for path in course.lessons():
        for last in book.live_cells(path)[-1:]:
            notebook = nbformat.read(path, as_version=4)
            notebook.cells = [
                cell
                for cell in notebook.cells[: last + 1]
                if cell.cell_type == "code" or path.stem == "mission_control"
            ]
            nbformat.write(notebook, copy / path.name)
    for name, cells in SCRATCH.items():
        notebook = nbformat.v4.new_notebook(cells=[nbformat.v4.new_code_cell(source) for source in cells])
        notebook.metadata.kernelspec = {"name": "python3", "display_name": "Python 3", "language": "python"}
        nbformat.write(notebook, copy / f"{name}.ipynb")
    return copy


@pytest.fixture(scope="module")
def chromium():
    try:
        with driver.browser() as browser:
            yield browser
    except driver.NoBrowser as missing:
        pytest.skip(str(missing))
