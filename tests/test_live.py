"""Live figures without a browser: every control of every notebook, and the class behind them."""

import gc
import io
import itertools
import math
import os
import sys
from dataclasses import replace

import matplotlib.pyplot as plt
import nbformat
import numpy as np
import pytest
from ipywidgets import Checkbox, Dropdown, FloatLogSlider, FloatSlider, IntSlider, SelectionSlider, SelectMultiple
from PIL import Image
from scipy.optimize import brentq

from hoverslam_lib import FALCON_9, Descent, FreeFall, course, fly, live
from hoverslam_lib.live import Live, verdict

POSITIONS = int(os.environ.get("LIVE_POSITIONS", "100"))
NOTEBOOKS = [path for path in course.lessons() if "Live(" in path.read_text() or "MissionControl" in path.read_text()]


def pixels(png):
    return np.asarray(Image.open(io.BytesIO(png)).convert("RGB"), dtype=int)


def drawn_anew(fig):
    """The figure as matplotlib draws it in one go, everything that moves included."""
    png = io.BytesIO()
    fig.savefig(png, format="png", dpi=fig.dpi)
    return pixels(png.getvalue())


@pytest.fixture
def shown(monkeypatch):
    """What is handed to the page."""
    bundles = []
    monkeypatch.setattr(live, "display", lambda bundle, raw: bundles.append(bundle))
    return bundles


@pytest.fixture
def dot():
    """A dot at (x, y) with the picture's sentence; it raises below -1."""
    fig, ax = plt.subplots()
    ax.set(xlim=(0, 10), ylim=(0, 10))
    (point,) = ax.plot([], [], "o", markersize=20, animated=True)

    def put(x, y):
        if x < -1:
            raise ValueError("x must be at least -1 m <really>")
        point.set_data([x], [y])
        return f"the dot is at {x:.1f}, {y:.1f}"

    sliders = {name: FloatSlider(5, min=-5, max=15, step=0.1, description=f"{name} [m]") for name in "xy"}
    made = Live(fig, put, **sliders)
    yield made
    made.close()


def test_picture_is_what_matplotlib_draws(dot):
    for x in (5.0, 2.3, 0.0, 9.9):
        dot.controls["x"].value = x
        got, whole = pixels(dot.picture.value), drawn_anew(dot.fig)
        assert got.shape == whole.shape
        # over a spine the order of drawing shows, in a few pixels
        assert np.mean(np.any(np.abs(got - whole) > 8, axis=2)) < 1e-3
        assert dot.text == f"the dot is at {x:.1f}, 5.0"
        assert dot.message.text == dot.text


def test_error_stands_in_place_and_the_control_stays_usable(dot):
    dot.controls["x"].value = 3.0
    before = dot.picture.value
    dot.controls["x"].value = -2.0
    assert dot.text == "Not possible: x must be at least -1 m <really>"
    assert dot.message.text == dot.text
    assert np.all(np.ptp(pixels(dot.picture.value)[50:250, 100:600], axis=2) < 8), "nothing that moves is drawn"
    dot.controls["x"].value = 3.0
    assert dot.picture.value == before


@pytest.mark.parametrize("error", [KeyError("x"), ZeroDivisionError(), RuntimeError(""), TypeError("no")])
def test_whatever_an_update_raises_is_shown(error):
    fig, _ = plt.subplots()

    def fail(x):
        raise error

    made = Live(fig, fail, x=FloatSlider(1.0))
    assert made.text.startswith("Not possible: ")
    assert len(made.text) > len("Not possible: ")
    made.close()


def test_update_without_a_sentence_is_told_so():
    fig, _ = plt.subplots()
    made = Live(fig, lambda x: None, x=FloatSlider(1.0))
    assert made.message.text == made.text
    assert "must return a sentence" in made.text
    made.close()


def test_set_draws_once(dot, monkeypatch):
    pictures = []
    dot.picture.observe(lambda change: pictures.append(change), "value")
    dot.set(x=1.0, y=2.0)
    assert len(pictures) == 1
    assert dot.text == "the dot is at 1.0, 2.0"
    dot.controls["y"].value = 3.0
    assert len(pictures) == 2, "controls are followed again"


def test_page_holds_the_widget_and_a_still_with_its_numbers(dot, shown):
    dot.show()
    (bundle,) = shown
    assert "application/vnd.jupyter.widget-view+json" in bundle
    assert 'alt="the dot is at 5.0, 5.0"' in bundle["text/html"]
    assert live.STILL in bundle["text/html"]
    assert bundle["text/plain"] == dot.text


def test_controls_have_labels_that_are_not_cut(dot):
    for control in dot.controls.values():
        assert control.tooltip == control.description
        assert control.style.description_width == "11em"


def test_live_figure_leaves_no_open_figure_and_close_frees_its_widgets():
    plt.close("all")
    before = len(live_widgets())
    for _ in range(3):
        fig, ax = plt.subplots()
        (point,) = ax.plot([1], [1], animated=True)
        made = Live(fig, lambda x: "text 1", x=FloatSlider(1.0))
        assert plt.get_fignums() == []
        made.close()
    assert len(live_widgets()) == before


def live_widgets():
    from ipywidgets.widgets.widget import _instances

    return _instances


def test_verdict_leads_with_the_hover_height():
    fall = FreeFall(Descent(), dt=0.1)

    def said(t):
        return verdict(fall.fly(t), fall.hover_height(t))

    assert said(60.2) == "stopped 12.7 m too high, and with the engine cut there, a crash with 15.8 m/s"
    assert said(60.211) == "soft landing with 0.90 m/s, engine cut at hover height +0.041 m"
    assert said(60.21104).startswith("soft landing with 1.")
    assert "cut" not in said(60.21104)
    assert "hover height +0.00" in said(60.211035)
    assert said(60.3).startswith("hover height −102 m, 188.4 m/s too fast")
    assert said(20.0) == "stopped 91.52 km too high"
    assert "too fast at the ground" in said(99.0)
    assert "nan" not in said(99.0)


def test_verdict_says_numbers_that_help():
    fall = FreeFall(Descent(), dt=0.1)
    t = brentq(lambda t: fall.hover_height(t) - 999.7, 59.0, 60.2)
    assert verdict(fall.fly(t), 999.7) == "stopped 1.00 km too high"
    t = brentq(lambda t: fall.fly(t).touchdown[1] + 2.004, 60.21104, 60.2112)
    assert verdict(fall.fly(t), fall.hover_height(t)).endswith("m, 0.004 m/s too fast at the ground")
    short = replace(FALCON_9, propellant_mass=2.0)
    for velocity, said in ((-1.0, "-0.6"), (-0.37, "0.0"), (-30.0, "-30")):
        empty = fly(Descent(short, height=0.5, velocity=velocity), 0.0)
        assert verdict(empty, 0.5).startswith("tank empty 0.")
        assert verdict(empty, 0.5).endswith(f"m above the ground, at {said} m/s")


def test_verdict_says_how_a_flight_ended_softly():
    low = Descent(height=0.1, velocity=0.0)
    assert verdict(fly(low, None), math.nan) == "soft landing with 1.40 m/s"
    short = replace(FALCON_9, propellant_mass=2.0)
    empty = fly(Descent(short, height=0.05, velocity=-1.0), 0.0)
    assert verdict(empty, 0.0481) == "soft landing with 1.17 m/s, tank empty, hover height +0.048 m"


# ---- every control of every notebook ------------------------------------------------------------------------------


@pytest.fixture(params=NOTEBOOKS, ids=lambda path: path.stem, scope="module")
def lesson(request, tmp_path_factory):
    """The live figures of a notebook, with all its cells run, in this process."""
    found = []
    patch = pytest.MonkeyPatch()
    patch.setattr(Live, "show", lambda self: found.append(self))
    patch.setattr("IPython.display.display", lambda *args, **kwargs: None)
    patch.chdir(tmp_path_factory.mktemp("notebook"))
    with plt.rc_context():
        namespace = {"display": lambda *args, **kwargs: None, "__name__": "__main__"}
        for cell in nbformat.read(request.param, as_version=4).cells:
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
    if isinstance(control, IntSlider):
        return [control.min, control.max], lambda rng: int(rng.integers(control.min, control.max + 1))
    if isinstance(control, Checkbox):
        return [False, True], lambda rng: bool(rng.integers(2))
    if isinstance(control, SelectMultiple):
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


def test_notebook_has_a_live_figure(lesson):
    assert lesson


def test_every_corner_and_many_positions(lesson):
    for made in lesson:
        for n, values in enumerate(itertools.chain(corners(made), positions(made, POSITIONS))):
            made.set(**values)
            check(made)
            if n % 40 == 0:
                got, whole = pixels(made.picture.value), drawn_anew(made.fig)
                differ = np.mean(np.any(np.abs(got - whole) > 8, axis=2))
                assert differ < 0.01 or made.text.startswith("Not possible"), (values, differ)


def test_same_position_gives_the_same_picture_and_text_again(lesson):
    for made in lesson:
        seen = []
        for values in positions(made, 6, seed=2):
            made.set(**values)
            seen.append((values, made.text, made.picture.value))
        for values, text, picture in reversed(seen):
            made.set(**values)
            assert made.text == text
            assert made.picture.value == picture


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
