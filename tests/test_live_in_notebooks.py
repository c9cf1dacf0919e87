"""Every control of every live figure in the notebooks, without a browser."""

import gc
import itertools
import re
import sys

import matplotlib.pyplot as plt
import nbformat
import numpy as np
import pytest
from ipywidgets import Checkbox, Dropdown, FloatLogSlider, FloatSlider, FloatText, IntSlider, SelectionSlider
from test_guide import settings
from test_live import NOTEBOOKS, drawn_anew, live_widgets, pixels

from hoverslam_lib import book, plotting, recording
from hoverslam_lib.live import Live
from hoverslam_lib.mission_control import Methods

POSITIONS = 40
"""At random, of each figure; tests/browser reads what the book records, more than 3 000 places."""


@pytest.fixture(params=NOTEBOOKS, ids=lambda path: path.stem, scope="module")
def lesson(request, tmp_path_factory):
    """The live figures of a notebook, with its cells run down to the last of them, in this process."""
    found = []
    patch = pytest.MonkeyPatch()
    patch.setattr(Live, "show", lambda self: found.append(self))
    patch.setattr("IPython.display.display", lambda *args, **kwargs: None)
    patch.setattr(plotting, "show", lambda fig, alt: plt.close(fig))  # these pictures are no matter here
    patch.chdir(tmp_path_factory.mktemp("notebook"))
    with plt.rc_context():
        namespace = {"display": lambda *args, **kwargs: None, "__name__": "__main__"}
        for cell in nbformat.read(request.param, as_version=4).cells[: book.live_cells(request.param)[-1] + 1]:
            if cell.cell_type == "code" and "raises-exception" not in cell.metadata.get("tags", []):
                exec(compile(cell.source, request.param.name, "exec"), namespace)
        yield found
    patch.undo()
    plt.close("all")


def range_of(control):
    """Every corner of a control, and a function that draws a random position."""
    if isinstance(control, FloatLogSlider):
        low, high = control.base**control.min, control.base**control.max
        return [low, high], lambda rng: float(np.exp(rng.uniform(np.log(low), np.log(high))))
    if isinstance(control, FloatSlider):
        return [control.min, control.max], lambda rng: float(rng.uniform(control.min, control.max))
    if isinstance(control, FloatText):
        return [0.0, 90.0], lambda rng: float(rng.uniform(0, 90))
    if isinstance(control, IntSlider):
        return [control.min, control.max], lambda rng: int(rng.integers(control.min, control.max + 1))
    if isinstance(control, Checkbox):
        return [False, True], lambda rng: bool(rng.integers(2))
    if isinstance(control, Methods):
        keys = [value for _, value in control.options]
        return [(), tuple(keys)], lambda rng: tuple(k for k in keys if rng.integers(len(keys)) < 2)
    assert isinstance(control, SelectionSlider | Dropdown), control
    return [control.options[0], control.options[-1]], lambda rng: control.options[rng.integers(len(control.options))]


def corners(made):
    ranges = {name: range_of(control)[0] for name, control in made.controls.items()}
    every = [dict(zip(ranges, corner, strict=True)) for corner in itertools.product(*ranges.values())]
    if len(every) <= 32:
        return every
    return [every[i] for i in np.random.default_rng(0).choice(len(every), 32, replace=False)]


def positions(made, n, seed=1):
    rng = np.random.default_rng(seed)
    for _ in range(n):
        yield {name: range_of(control)[1](rng) for name, control in made.controls.items()}


EXPECTED_REFUSALS = ("choose at least one method", "the published equation knows the paper's booster")


def check(made):
    assert "nan" not in made.text.split()
    if made.text.startswith("Not possible: "):
        assert any(reason in made.text for reason in EXPECTED_REFUSALS), made.text
    assert any(digit in made.text for digit in "0123456789") or made.text.startswith("Not possible")


def test_notebook_has_a_live_figure_with_places_for_the_book(lesson):
    assert lesson
    for made in lesson:
        assert recording.positions(made)


def test_score_of_the_guide_finds_its_places_in_the_book_and_what_they_say(lesson, request):
    for label, position, quoted in settings(request.node.callspec.params["lesson"].stem):
        made, name = next(
            (made, name)
            for made in lesson
            for name, control in made.controls.items()
            if re.fullmatch(rf"{label}( \[s\])?", control.description or control.tooltip)
        )
        places = recording.positions(made)
        made.set(**{other: values[0] for other, values in places.items() if len(values) == 1})
        wanted = {"on": True}.get(position) or float(position)
        assert wanted in places[name], (label, position)
        made.set(**{name: wanted})
        for sentence in quoted:
            assert sentence in made.text


def test_every_corner_and_many_positions(lesson):
    for made in lesson:
        for n, values in enumerate(itertools.chain(corners(made), positions(made, POSITIONS))):
            made.set(**values)
            check(made)
            if n % 40 == 0:
                got, whole = pixels(made.screen), drawn_anew(made.fig)
                differ = np.mean(np.any(np.abs(got - whole) > 8, axis=2))
                assert differ < 0.01 or made.text.startswith("Not possible"), (values, differ)


def test_same_position_gives_the_same_picture_and_text_again(lesson):
    for made in lesson:
        seen = []
        for values in positions(made, 6, seed=2):
            made.set(**values)
            seen.append((values, made.text, made.screen.moving))
        for values, text, picture in reversed(seen):
            made.set(**values)
            assert made.text == text
            assert made.screen.moving == picture


def test_neither_memory_nor_figures_grow(lesson):
    for made in lesson:
        start = {name: control.value for name, control in made.controls.items()}
        widgets, figures = len(live_widgets()), plt.get_fignums()
        moves = list(positions(made, 6, seed=3))
        blocks = []
        for _ in range(4):  # the first rounds fill what the notebook itself keeps
            for values in moves:
                made.set(**values)
            gc.collect()
            blocks.append(sys.getallocatedblocks())
        assert blocks[-1] - blocks[1] < 1000
        assert len(live_widgets()) == widgets
        assert plt.get_fignums() == figures
        made.set(**start)
