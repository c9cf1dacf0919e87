"""The instructor's page without a browser: its buttons, its table, and what it flies."""

import base64
import io
import re

import matplotlib.pyplot as plt
import numpy as np
import pandas as pd
import pytest
import traitlets
from ipywidgets import Button
from matplotlib.text import Text
from screen import shown

from hoverslam_lib import EARTH, Descent, best_ignition, fly, hover_height, plotting, published
from hoverslam_lib.integrators import METHODS
from hoverslam_lib.mission_control import START, STEPS, Methods, MissionControl, stroke, try_out


@pytest.fixture(scope="module")
def page():
    with plt.rc_context():
        plotting.use_style()
        made = MissionControl()
    yield made
    made.live.close()


@pytest.fixture(autouse=True)
def _reset(page):
    page.clear()
    page.reset()


def test_reset_puts_every_control_back(page):
    page.live.set(t_ignite=10.003, planet="Moon", methods=("dop8", "rk4"), thrust=2.0)
    page.reset()
    assert {name: control.value for name, control in page.live.controls.items()} == START


def test_optimum_is_found_to_the_microsecond_for_the_descent_that_is_set(page):
    page.find()
    assert "soft landing" in page.live.text
    page.live.set(planet="Mars", thrust=9.0, drag=1.0)
    page.find()
    descent = page._descent(**page.live.values())
    t = page.live.controls["t_ignite"].value
    assert t == pytest.approx(best_ignition(descent).t_ignite, abs=1e-6)
    assert abs(hover_height(descent, t)) < 0.01


def test_papers_landing_on_one_click_whatever_was_set_and_a_browser_sends_back(page):
    page.live.set(t_ignite=1.0, planet="Moon", drag=1.0, thrust=9.0, moment=3)
    page.papers_landing()
    landing = page.live.text
    assert "comes to 0 m/s 2.6 m above the ground" in landing
    page.slider.value = 35.879999999999995
    page.live.controls["thrust"].value = 7.6000000000000005
    assert page.live.text == landing
    page.live.controls["drag"].value = 0.55
    assert "press Reset" in page.live.text


def test_ignition_is_dragged_on_the_sliders_grid_and_typed_as_it_is(page):
    number, slider = page.live.controls["t_ignite"], page.slider
    slider.value = 35.870000000000005
    assert number.value == 35.87
    assert slider.value == 35.870000000000005, "nothing is sent to the handle under the hand"
    number.value = 60.211036
    assert slider.value == 60.21
    slider.value = 60.21  # a browser sends back where it put the handle, perhaps a bit beside
    slider.value = 60.20999999999999
    assert number.value == 60.211036
    slider.value = 60.22
    slider.value = 60.21
    assert number.value == 60.21
    number.value = 95.5
    assert slider.value == slider.max
    assert "Ignition at 95.500000 s" in page.live.text
    number.value = -1.0
    assert page.live.text == "Not possible: t_ignite must be a finite number at least 0 [s]; got -1.0"


def test_dragging_draws_once_a_movement(page):
    pictures = []
    page.live.screen.observe(pictures.append, "moving")
    page.slider.value = 58.33
    page.live.controls["t_ignite"].value = 57.123456
    assert len(pictures) == 2


def test_no_soft_landing_is_explained_and_changes_nothing(page):
    page.live.set(thrust=0.2)
    page.find()
    assert "No soft landing: thrust must exceed" in page.live.screen.text
    assert page.live.controls["t_ignite"].value == START["t_ignite"]


def test_trial_is_what_fly_says():
    trial = try_out(Descent(), 60.3, 0.05, "rk4")
    flown = fly(Descent(), 60.3, dt=0.05)
    np.testing.assert_allclose(trial["v"], flown.v, atol=1e-9)
    np.testing.assert_allclose(trial["felt"], flown.felt_acceleration, rtol=1e-9)
    assert trial["thrust"].max() == 7.6e6
    assert trial["height"] == pytest.approx(hover_height(Descent(), 60.3, dt=0.05))


def test_published_trial_has_the_papers_landing_and_its_vanishing_mass():
    trial = try_out(Descent(), 35.88, 0.02, "rkn4", True)
    run = published.fly(35.88, dt=0.02)
    assert np.array_equal(trial["h"], run.h)
    assert trial["verdict"] == "comes to 0 m/s 2.6 m above the ground"
    assert trial["mass"].min() == pytest.approx(-7.4e3, abs=100)
    assert np.all(trial["thrust"][run.t > 36] == -7.6e3)
    # what is felt is what changes the velocity, gravity left out
    slope = np.gradient(run.v, run.t) + EARTH.gravity(run.h)
    middle = slice(1000, 1700)
    np.testing.assert_allclose(trial["felt"][middle], slope[middle], atol=1e-3)


def test_published_equation_on_another_planet_says_what_to_do(page):
    page.live.set(faults=True, planet="Moon")
    assert "press Reset" in page.live.text
    page.live.set(faults=True, planet="Earth")
    assert "m/s" in page.live.text


def test_trials_are_kept_listed_and_given_as_csv(page):
    page.keep()
    page.live.set(t_ignite=60.3, methods=("rk4", "dop8"))
    page.keep()
    frame = page.to_frame()
    assert list(frame["method"]) == ["rk4", "rk4", "dop8"]
    assert frame["hover height [m]"].tolist() == pytest.approx([12.7, -102, -102], rel=0.01)
    data = re.search(r"base64,([A-Za-z0-9+/=]+)", page.table.value).group(1)
    read = pd.read_csv(io.BytesIO(base64.b64decode(data)))
    pd.testing.assert_frame_equal(read, frame)
    for _ in range(10):
        page.keep()
    assert len(page.to_frame()) == 12
    page.clear()
    assert page.table.value == ""


def test_steps_are_round_and_nearly_even_on_a_logarithmic_scale():
    assert STEPS[0] == 0.005
    assert STEPS[-1] == 1.0
    assert 0.02 in STEPS
    ratios = np.diff(np.log(STEPS))
    assert ratios.max() < 0.35
    assert ratios.min() > 0.1


def test_moment_puts_the_dots_on_the_flight(page):
    page.live.set(moment=50)
    before, _, dot = page.lines["rk4"][0]
    (t,), (h,) = dot.get_data()
    trial = try_out(Descent(), 60.2, 0.02, "rk4")
    assert t == pytest.approx(trial["t"][-1] / 2, abs=0.02)
    assert h == pytest.approx(np.interp(t, trial["t"], trial["h"]) / 1e3)
    assert len(before.get_xdata()) == trial["end"]
    assert not page.lines["dop8"][0][0].get_visible(), "a method that is not chosen is not drawn"
    assert before.get_visible()
    assert (dot.get_marker(), dot.get_markersize()) == ("o", 7)


def test_each_panel_has_its_quantity_and_room_for_all_of_it(page):
    page.live.set(t_ignite=35.88, dt=0.02, methods=("rkn4",), faults=True)
    run = published.fly(35.88, dt=0.02)
    fig, lines = page.live.fig, page.lines["rkn4"]
    assert [ax.get_ylabel() for ax in fig.axes] == [
        *("height [km]", "velocity [m/s]", "velocity [m/s]", "mass [t]", "thrust [MN]", "felt [g]"),
    ]
    drawn = [before.get_ydata() for before, _, _ in lines]
    for n, values in enumerate((run.h / 1e3, run.v, run.v, run.mass / 1e3)):
        np.testing.assert_array_equal(drawn[n], values)
    right = try_out(Descent(), 60.2, 0.02, "rk4")
    page.live.set(**START)
    sound = [before.get_ydata() for before, _, _ in page.lines["rk4"]]  # up to its hover
    assert max(sound[4]) == pytest.approx(7.6)
    np.testing.assert_allclose(sound[5], right["felt"][: right["end"]] / 9.81, rtol=1e-12)
    drawn[5] = sound[5]  # the other has no bound where the mass passes zero
    for ax, *values in zip(fig.axes, drawn, sound, strict=True):
        values = np.concatenate(values)
        low, high = ax.get_ylim()
        assert low < min(values) <= max(values) < high, "a mass below zero has to be seen"
        assert high - low < 4 * np.ptp(values), "and not be lost"


def test_velocity_is_drawn_over_a_height_that_falls_on_a_logarithmic_axis(page):
    for n, ax in enumerate(page.live.fig.axes):
        over_height = n == 2
        assert ax.get_xscale() == ("log" if over_height else "linear")
        assert ax.get_xlabel() == ("height [m]" if over_height else "t [s]")
        assert ax.get_xlim() == ((2e5, 1e-3) if over_height else (0, 100))
    page.live.set(t_ignite=60.3)  # a crash, with a last row on the ground
    trial = try_out(Descent(), 60.3, 0.02, "rk4")
    line = page.lines["rk4"][2][0]
    np.testing.assert_array_equal(line.get_xdata()[:-1], trial["h"][:-1])
    assert line.get_xdata()[-1] == 1e-3, "the ground stands at the end of the axis"
    np.testing.assert_array_equal(line.get_ydata(), trial["v"])


def in_a_browser(page, width, height, font, ratio=1):
    """Say how much room there is, as a browser does."""
    room = {"width": width, "height": height, "font": font, "ratio": ratio}
    page.live.screen._handle_custom_msg({"room": room}, [])


@pytest.mark.parametrize(
    ("width", "height", "font", "columns"),
    [(960, 290, 14, 3), (960, 520, 14, 3), (1512, 670, 18, 3), (360, 504, 14, 2)],
)
def test_panels_fill_the_room_with_letters_of_the_pages_size_and_nothing_cut(page, width, height, font, columns):
    in_a_browser(page, width, height, font)
    fig = page.live.fig
    assert page.live.screen.size == [width, height]
    sizes = {text.get_fontsize() * fig.dpi / 72 for text in fig.findobj(Text)}
    assert min(sizes) == pytest.approx(font) == max(sizes)
    assert len({round(ax.get_position().x0, 6) for ax in fig.axes}) == columns
    boxes = [ax.get_tightbbox() for ax in fig.axes]
    for n, box in enumerate(boxes):
        assert box.x0 >= 0
        assert box.y0 >= 0
        assert box.x1 <= width
        assert box.y1 <= height + 1
        assert not any(box.overlaps(other) for other in boxes[:n])
    in_a_browser(page, width, height, font, ratio=2)
    assert page.live.screen.size == [2 * width, 2 * height]
    sharp = shown(page.live.screen)[::2, ::2].astype(int)
    in_a_browser(page, width, height, font)
    assert np.mean(np.abs(sharp - shown(page.live.screen)) > 64) < 0.1


def inside(widget):
    yield widget
    for child in getattr(widget, "children", ()):
        yield from inside(child)


def test_page_has_every_control_and_a_button_for_each_thing_that_it_can_do(page):
    there = list(inside(page.live.widget))
    assert set(page.live.controls.values()) | {page.slider, page.live.screen, page.table, page.play} <= set(there)
    buttons = {button.description: button for button in there if isinstance(button, Button)}
    assert list(buttons) == ["Reset", "The paper's landing", "Find the optimum", "Keep this trial", "Clear the table"]
    buttons["The paper's landing"].click()
    assert "comes to 0 m/s 2.6 m above the ground" in page.live.text
    buttons["Keep this trial"].click()
    assert len(page.to_frame()) == 1
    buttons["Find the optimum"].click()
    assert page.live.controls["t_ignite"].value == 60.211036
    buttons["Clear the table"].click()
    assert page.to_frame().empty
    buttons["Reset"].click()
    assert page.live.values() == START


def test_browser_is_told_which_methods_are_chosen_and_how_each_looks():
    assert {"value", "looks", "description"} <= set(Methods().keys)


def test_methods_are_chosen_in_their_order_and_drawn_as_everywhere(page):
    methods = page.live.controls["methods"]
    page.live.set(methods=("dop8", "explicit_euler"))
    assert methods.value == ("explicit_euler", "dop8")
    for look in methods.looks:
        assert f'stroke="{plotting.line(look["key"])["color"]}"' in look["mark"]
    dashes = [re.search('dasharray="(.*?)"', stroke(key, width=2)).group(1) for key in METHODS]
    assert dashes[:4] == ["7.4 3.2", "12 3 3 3", "2.4 2", ""]
    assert len(set(dashes)) == len(METHODS)
    with pytest.raises(traitlets.TraitError, match="got 'rk5'"):
        methods.value = ("rk5",)


def test_each_verdict_is_one_line_marked_by_its_method_and_a_refusal_has_none(page):
    page.live.set(methods=("rk4", "explicit_euler"), dt=0.1)
    screen = page.live.screen
    lines = screen.text.splitlines()
    assert [line.partition(":")[0] for line in lines[:-1]] == ["Explicit Euler", "Runge–Kutta 4"]
    assert screen.marks == [stroke("explicit_euler"), stroke("rk4")]
    assert lines[-1] == "Ignition at 60.200000 s, dt = 0.1 s."
    assert max(map(len, lines)) < 80
    page.live.set(methods=())
    assert screen.text == "Not possible: choose at least one method"
    assert screen.marks == []
