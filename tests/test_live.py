"""Live figures without a browser: every control of every notebook, and the class behind them."""

import io
import math
from dataclasses import replace
from decimal import Decimal
from types import SimpleNamespace

import matplotlib.pyplot as plt
import nbformat
import numpy as np
import pytest
from ipywidgets import (
    HTML,
    FloatLogSlider,
    FloatRangeSlider,
    FloatSlider,
    FloatText,
    IntSlider,
    SelectionSlider,
)
from PIL import Image
from scipy.optimize import brentq
from screen import shown as screen_shows

from hoverslam_lib import FALCON_9, Descent, FreeFall, course, fly, live, published
from hoverslam_lib.live import Live, on_grid, verdict

NOTEBOOKS = [path for path in course.lessons() if "Live(" in path.read_text() or "MissionControl" in path.read_text()]


def pixels(screen):
    return screen_shows(screen).astype(int)


def drawn_anew(fig):
    """The figure as matplotlib draws it in one go, everything that moves included."""
    png = io.BytesIO()
    fig.savefig(png, format="png", dpi=fig.dpi)
    return np.asarray(Image.open(png).convert("RGB"), dtype=int)


@pytest.fixture
def shown(monkeypatch):
    """What is handed to the page."""
    bundles = []
    # with raw it is a bundle of formats; else IPython would show it as a dictionary
    monkeypatch.setattr(
        live, "display", lambda shown, raw: bundles.append(shown if raw else {"text/plain": str(shown)})
    )
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
        got, whole = pixels(dot.screen), drawn_anew(dot.fig)
        assert got.shape == whole.shape
        # over a spine the order of drawing shows, in a few pixels
        assert np.mean(np.any(np.abs(got - whole) > 8, axis=2)) < 1e-3
        assert dot.text == f"the dot is at {x:.1f}, 5.0"
        assert dot.screen.text == dot.text


def test_error_stands_in_place_and_the_control_stays_usable(dot):
    dot.controls["x"].value = 3.0
    before = pixels(dot.screen)
    dot.controls["x"].value = -2.0
    assert dot.text == "Not possible: x must be at least -1 m <really>"
    assert dot.screen.text == dot.text
    assert np.all(np.ptp(pixels(dot.screen)[50:250, 100:600], axis=2) < 8), "nothing that moves is drawn"
    dot.controls["x"].value = 3.0
    assert np.array_equal(pixels(dot.screen), before)


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
    assert made.screen.text == made.text
    assert "must return a sentence" in made.text
    made.close()


def test_set_draws_once(dot, monkeypatch):
    pictures = []
    dot.screen.observe(pictures.append, "moving")
    dot.set(x=1.0, y=2.0)
    assert len(pictures) == 1
    assert dot.text == "the dot is at 1.0, 2.0"
    dot.controls["y"].value = 3.0
    assert len(pictures) == 2, "controls are followed again"


def test_page_holds_a_still_with_its_numbers_and_the_widget_in_an_output_of_its_own(dot, shown):
    dot.show()
    still, widget = shown
    assert "hoverslam-live" in dot.widget._dom_classes, "by which its style and its page know it"
    assert 'alt="the dot is at 5.0, 5.0"' in still["text/html"]
    assert live.STILL in still["text/html"]
    assert still["text/plain"] == dot.text
    assert list(still) == ["text/html", "text/plain"]
    assert list(widget) == ["application/vnd.jupyter.widget-view+json"], "nothing that is compared or read aloud twice"


def test_stored_lesson_keeps_the_still_and_no_widget(dot, shown):
    dot.show()
    outputs = [nbformat.v4.new_output("display_data", data=dict(bundle)) for bundle in shown]
    notebook = nbformat.v4.new_notebook(cells=[nbformat.v4.new_code_cell("dot.show()", outputs=outputs)])
    course._clean(notebook)
    (kept,) = notebook.cells[0].outputs
    assert live.STILL in kept.data["text/html"]


@pytest.mark.parametrize("path", NOTEBOOKS, ids=lambda path: path.stem)
def test_every_stored_live_figure_is_one_still_that_gives_way_to_the_widget(path):
    cells = [cell for cell in nbformat.read(path, as_version=4).cells if cell.cell_type == "code"]
    stills = [output.data["text/html"] for cell in cells for output in cell.outputs if live.STILL in str(output)]
    assert len(stills) == sum(cell.source.count(".show()") for cell in cells)
    for still in stills:
        assert still.startswith(f'{live._ONE_OF_TWO}<div class="hoverslam-still"><img alt="')


# ---- what a browser sends -------------------------------------------------------------------------------------------


SLIDERS = (
    ("0.5", "34", "0.01"),
    ("0.02", "2.1", "0.01"),
    ("0.2", "15", "0.1"),
    ("0", "90", "0.01"),
    ("-2500", "2500", "1"),
    ("0.05", "1", "0.1"),
)


@pytest.mark.parametrize(("low", "high", "step"), SLIDERS)
def test_every_place_of_a_slider_is_its_decimal_number_whatever_bit_a_browser_adds(low, high, step):
    slider = FloatSlider(min=float(low), max=float(high), step=float(step))
    for k in range(int((Decimal(high) - Decimal(low)) / Decimal(step)) + 1):
        exact = float(Decimal(low) + k * Decimal(step))
        counted = float(low) + k * float(step)
        for sent in (exact, counted, math.nextafter(exact, math.inf), math.nextafter(exact, -math.inf)):
            assert on_grid(sent, slider) == exact


def test_places_that_are_not_whole_steps():
    slider = FloatSlider(min=0, max=1, step=0.3)
    assert [on_grid(value, slider) for value in (0.94, 0.96, 1.0, 1.3, -2.0)] == [0.9, 1.0, 1.0, 1.0, 0.0]
    assert math.copysign(1, on_grid(-1e-17, FloatSlider(min=-0.3, max=0.3, step=0.1))) == 1
    assert on_grid(0.1234567, FloatSlider(min=0, max=1, step=None)) == 0.1234567


def test_update_gets_what_the_controls_stand_for():
    got = []
    fig, _ = plt.subplots()
    controls = {
        "t": FloatSlider(35.88, min=0, max=90, step=0.01),
        "dt": FloatLogSlider(0.1, min=-2.5, max=0, step=0.02),
        "between": FloatRangeSlider(value=(1, 2), min=0, max=9, step=0.1),
        "typed": FloatText(35.88),
        "n": IntSlider(3),
        "key": SelectionSlider(options=[0.1, 0.02], value=0.02),
    }
    made = Live(fig, lambda **values: got.append(values) or "text 1", **controls)
    made.set(
        t=35.879999999999995, dt=0.010000000000000002, between=(0.30000000000000004, 7.6000000000000005), typed=1 / 3
    )
    assert got[-1] == {"t": 35.88, "dt": 0.01, "between": (0.3, 7.6), "typed": 1 / 3, "n": 3, "key": 0.02}
    assert made.values() == got[-1]
    made.close()


def test_paper_lands_where_a_browser_sends_its_ignition_time_back():
    """One bit beside 35.88 is another run of the published program."""
    slider = FloatSlider(35.879999999999995, min=30, max=66, step=0.01)
    assert published.fly(slider.value, dt=0.02).v.max() != published.fly(35.88, dt=0.02).v.max()
    assert published.fly(on_grid(slider.value, slider), dt=0.02).v.max() == published.fly(35.88, dt=0.02).v.max()


def test_kernel_answers_when_it_is_asked_whether_it_is_there(dot, monkeypatch):
    sent = []
    monkeypatch.setattr(dot.screen, "send", sent.append)
    dot.screen._handle_custom_msg("are you there?", [])
    assert len(sent) == 1


def in_a_browser(made, width, height, ratio):
    """Say how much room there is, as a browser does."""
    room = {"width": width, "height": height, "font": 14, "ratio": ratio}
    made.screen._handle_custom_msg({"room": room}, [])


def test_picture_is_drawn_in_the_pixels_of_the_screen(dot):
    (height, width), text = pixels(dot.screen).shape[:2], dot.text
    grounds = []
    dot.screen.observe(grounds.append, "ground")
    in_a_browser(dot, width, height, 1)
    assert grounds == [], "nothing to draw anew"
    for shown_width, ratio in ((width, 2), (width / 2, 3), (width, 1.25)):
        in_a_browser(dot, shown_width, height * shown_width / width, ratio)
        for x in (5.0, 2.3):
            dot.controls["x"].value = x
            got, whole = pixels(dot.screen), drawn_anew(dot.fig)
            assert got.shape == whole.shape
            assert got.shape[1] == round(shown_width * ratio)
            assert np.mean(np.any(np.abs(got - whole) > 8, axis=2)) < 1e-3
    assert len(grounds) == 3
    dot.controls["x"].value = 5.0
    assert dot.text == text
    in_a_browser(dot, width, height, 1)
    assert np.all(np.abs(pixels(dot.screen) - drawn_anew(dot.fig)) < 8)


def test_no_picture_is_larger_than_time_allows(dot):
    in_a_browser(dot, 3000, 2250, 2)
    height, width = pixels(dot.screen).shape[:2]
    assert 0.98 < height * width / live.MOST_PIXELS < 1.02


def test_still_is_as_wide_as_the_figure_however_dense_the_screen(dot, shown):
    width = pixels(dot.screen).shape[1]
    in_a_browser(dot, width, 300, 2)
    dot.show()
    assert f'width="{width}"' in shown[0]["text/html"]


def test_arrow_keys_are_told_of_where_a_pixel_is_many_steps():
    fig, _ = plt.subplots()
    sliders = {
        "a": FloatSlider(1, min=0, max=40, step=0.01, description="ignition, our ledger [s]"),
        "b": FloatSlider(1, min=0, max=2, step=0.01, description="dt [s]"),
        "c": FloatLogSlider(0.1, min=-2, max=0, step=0.001, description="z"),
        "d": IntSlider(1, min=0, max=5000, description="n"),
    }
    made = Live(fig, lambda **values: "text 1", **sliders)
    (hint,) = (child.value for child in made.widget.children if isinstance(child, HTML))
    assert hint == "Arrow keys step by 0.01 s (ignition, our ledger), 1 (n)."
    made.close()
    made = Live(plt.figure(), lambda b: "text 1", b=FloatSlider(1, min=0, max=2, step=0.01, description="dt [s]"))
    assert not any(isinstance(child, HTML) for child in made.widget.children)
    made.close()


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


def test_cell_run_again_closes_its_own_former_figures_and_no_other(monkeypatch, shown):
    monkeypatch.setattr(live, "_SHOWN", {})

    def show(cell, run):
        parent = {"metadata": {"cellId": cell} if cell else {}, "header": {"msg_id": run}}
        monkeypatch.setattr(live, "get_ipython", lambda: SimpleNamespace(get_parent=lambda: parent))
        fig, _ = plt.subplots()
        made.append(Live(fig, lambda x: "text 1", x=FloatSlider(1.0)))
        made[-1].show()
        return [figure.screen.comm is not None for figure in made]

    made = []
    for cell, run in (("a", "1"), ("a", "1"), ("b", "2"), (None, "3")):
        assert all(show(cell, run))  # two of one run, one of another cell, one outside of any cell
    assert show("a", "4") == [False, False, True, True, True]
    assert show("a", "5") == [False, False, True, True, False, True]
    assert show(None, "6") == [False, False, True, True, False, True, True]
    for figure in made:
        figure.close()


def live_widgets():
    from ipywidgets.widgets.widget import _instances

    return _instances


def test_verdict_leads_with_the_hover_height():
    fall = FreeFall(Descent(), dt=0.1)

    def said(t, **how):
        return verdict(fall.fly(t), fall.hover_height(t), **how)

    assert said(60.2) == "stopped 12.7 m too high, and with the engine cut there, a crash with 15.8 m/s"
    assert said(60.211) == "soft landing with 0.90 m/s, engine cut at hover height +0.041 m"
    assert said(60.21104).startswith("soft landing with 1.")
    assert "cut" not in said(60.21104)
    assert said(60.2, brief=True) == "stopped 12.7 m too high; cut there, a crash with 15.8 m/s"
    assert said(60.211, brief=True) == "soft landing with 0.90 m/s, cut at hover height +0.041 m"
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
