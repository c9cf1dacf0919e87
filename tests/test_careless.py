"""Careless and hostile calls: what is refused, by which exception, and what its sentence says.

A table for completeness: what a module's own tests try is not tried here again. The laws of physics that stand within
the loops, such as `Planet.gravity`, check nothing, for speed.
"""

import math
import os
import re
import threading
import tomllib
import warnings
from pathlib import Path

import matplotlib.pyplot as plt
import numpy as np
import pandas as pd
import pytest
import traitlets
from ipywidgets import FloatSlider
from packaging.requirements import Requirement
from packaging.specifiers import SpecifierSet
from scipy.integrate import RK45

from hoverslam_lib import (
    EARTH,
    FALCON_9,
    METHODS,
    Booster,
    Descent,
    FreeFall,
    Oscillator,
    Planet,
    animation,
    best_ignition,
    checks,
    course,
    data,
    fly,
    fly_all,
    hover_height,
    ignition_table,
    integrate,
    live,
    mape,
    max_error,
    nmae,
    observed_order,
    plotting,
    published,
    rmse,
    speed_after_fall,
)
from hoverslam_lib.checks import feedback, record, stopping
from hoverslam_lib.mission_control import MissionControl, stroke, try_out

ROOT = Path(__file__).parent.parent
PAPER = Descent()
HUGE = 10**400
"""A whole number that no float can hold."""


def spring(t, h, v):
    return -h


@pytest.fixture(scope="module")
def flown():
    return fly(PAPER, 60.2, dt=0.5)


@pytest.fixture(autouse=True)
def _nothing_left(tmp_path, monkeypatch):
    """Whatever is called: no file, no figure, no thread, no setting stays behind."""
    monkeypatch.chdir(tmp_path)
    monkeypatch.setattr(record.platformdirs, "user_data_dir", lambda name: str(tmp_path / "user"))

    def state():
        settings = np.geterr(), np.get_printoptions(), dict(plt.rcParams)
        return sorted(tmp_path.rglob("*")), plt.get_fignums(), threading.active_count(), os.getcwd(), settings

    before = state()
    yield
    assert state() == before


# ---- a value that is none -----------------------------------------------------------------------------------------

# what takes it, by its name in the message, and what is to be passed: one number [with its unit]
ONE_NUMBER = {
    "integrate t_end": (lambda x: integrate(spring, 1.0, 0.0, dt=0.1, t_end=x), "t_end", "[s]"),
    "integrate t0": (lambda x: integrate(spring, 1.0, 0.0, dt=0.1, t_end=1e9, t0=x), "t0", "[s]"),
    "integrate dt": (lambda x: integrate(spring, 1.0, 0.0, dt=x, t_end=1.0), "dt", "[s]"),
    "hover_height t_ignite": (lambda x: hover_height(PAPER, x), "t_ignite", "[s]"),
    "fly dt": (lambda x: fly(PAPER, 60.0, dt=x), "dt", "[s]"),
    "hover_height dt": (lambda x: hover_height(PAPER, 60.0, dt=x), "dt", "[s]"),
    "FreeFall dt": (lambda x: FreeFall(PAPER, dt=x), "dt", "[s]"),
    "ignition_table dt": (lambda x: ignition_table([60.0], dt=x), "dt", "[s]"),
    "fly_all dt": (lambda x: fly_all(PAPER, [60.0, 61.0], dt=x), "dt", "[s]"),
    "published.fly dt": (lambda x: published.fly(35.88, dt=x), "dt", "[s]"),
    "published.acceleration t_ignite": (published.acceleration, "t_ignite", "[s]"),
    "published.optimisation_table dt": (published.optimisation_table, "dt", "[s]"),
    "pace duration": (lambda x: animation.pace([1.0, 2.0], x), "duration", "[ms]"),
    "throttle": (
        lambda x: fly(PAPER, 60.0, dt=0.5, controller=lambda t, h, v, mass: x),
        "controller(t, h, v, mass)",
        "throttle",
    ),
    **{
        f"Oscillator {name}": (lambda x, name=name: Oscillator(**{name: x}), name, "")
        for name in ("stiffness", "mass", "x0", "v0")
    },
}
NO_NUMBER = {
    "None": None,
    "a string": "36",
    "bytes": b"36",
    "nan": math.nan,
    "nan of numpy": np.float64("nan"),
    "inf": math.inf,
    "a bool": True,
    "a complex number": 1j,
    "huge": HUGE,
    "empty": np.array([]),
    "a table": np.ones((2, 2)),
    "an array without axes": np.array(1.0),
    "a DataFrame": pd.DataFrame({"t": [1.0]}),
    "a class": float,
    "a function": spring,
}


@pytest.mark.parametrize("what", NO_NUMBER)
@pytest.mark.parametrize("call", ONE_NUMBER)
def test_what_is_no_number_is_refused_with_name_value_and_unit(call, what):
    function, name, unit = ONE_NUMBER[call]
    value = NO_NUMBER[what]
    with pytest.raises((ValueError, TypeError)) as caught:
        function(value)
    said = str(caught.value)
    assert said.startswith(f"{name} must be "), said
    assert unit in said
    assert isinstance(caught.value, ValueError) == (isinstance(value, (float, int)) and not isinstance(value, bool))


# ---- samples, and a number where two are wanted -------------------------------------------------------------------

NO_SAMPLES = [
    (None, TypeError, "must be a number or an array of numbers; got None"),
    ("36", TypeError, "must be a number or an array of numbers; got '36'"),
    (["1", "2"], TypeError, "must be a number or an array of numbers"),
    ([1.0, None], TypeError, "must be a number or an array of numbers"),
    ([1.0, 1j], TypeError, "must be a number or an array of numbers"),
    ([True, False], TypeError, "must be a number or an array of numbers"),
    ([[1.0], [1.0, 2.0]], TypeError, "must be a number or an array of numbers"),
    ([1.0, HUGE], TypeError, "must be a number or an array of numbers"),
    (spring, TypeError, "must be a number or an array of numbers"),
    (1.0, ValueError, r"must have the same shape; got .*\(\)"),
    (np.ones((2, 1)), ValueError, r"must have the same shape; got .*\(2, 1\)"),
    (pd.DataFrame({"x": [1.0, 2.0]}), ValueError, r"must have the same shape; got .*\(2, 1\)"),
]


@pytest.mark.parametrize(("given", "error", "message"), NO_SAMPLES)
@pytest.mark.parametrize("measure", [mape, nmae, rmse, max_error, observed_order, published.listing_2_mape])
def test_what_are_no_samples_is_refused_by_name(measure, given, error, message):
    first, second = ("dt", "error") if measure is observed_order else ("exact", "approx")
    with pytest.raises(error, match=rf"{first}( and {second})? {message}"):
        measure(given, [1.0, 2.0])
    with pytest.raises(error, match=rf"{second} {message}"):
        measure([1.0, 2.0], given)


def test_samples_may_be_of_any_kind_of_numbers():
    for kind in (list, tuple, np.array, pd.Series, lambda x: pd.Series(x, index=["a", "b"])):
        assert max_error(kind([1, 2]), kind([1.0, 2.5])) == 0.5
        assert published.listing_2_mape(kind([1, 2]), kind([1.0, 2.5])) == -0.125


# ---- the table ----------------------------------------------------------------------------------------------------


def no_return(t, h, v):
    t + h + v


def later_without(t, h, v):
    return -9.81 if t < 0.5 else None


def root_below(t, h, v):
    return h**0.5 - 9.81


def at_once(f=spring, h0=1.0, v0=0.0, **options):
    return integrate(f, h0, v0, **{"dt": 0.1, "t_end": 1.0} | options)


def framed(**options):
    with plotting.figure(**{"alt": "1 line"} | options):
        pass


def at(times, **options):
    return lambda flown: animation.landing_film(flown, times, **{"alt": "1 m"} | options)


GIVEN = "f(t, h, v) must return the acceleration [m/s²], "
PAIR = "the step function must return h and v, as they were given; got "
CHOOSE = "choose from explicit_euler, symplectic_euler, implicit_euler, rk4, rkn4, gauss4, dop8"

CALLS = {
    # the equation
    "no f": (lambda: at_once(None), TypeError, "f must be a function of (t, h, v); got None"),
    "f called": (lambda: at_once(-9.81), TypeError, "f must be a function of (t, h, v); got -9.81"),
    "f of t and h": (lambda: at_once(lambda t, h: -h), TypeError, "takes 2 positional arguments but 3 were given"),
    "f without return": (lambda: at_once(no_return), TypeError, GIVEN + "one number; got None: is a `return` missing?"),
    "f that forgets": (
        lambda: at_once(later_without, method="explicit_euler"),
        TypeError,
        GIVEN + "one number; got None",
    ),
    "f of a string": (lambda: at_once(lambda t, h, v: "9"), TypeError, GIVEN + "one number; got '9'"),
    "f of a pair": (lambda: at_once(lambda t, h, v: (v, -h)), TypeError, GIVEN + "one number; got (0.0, -1.0)"),
    "f of an array": (
        lambda: at_once(lambda t, h, v: np.ones(2)),
        TypeError,
        GIVEN + "one number; got array([1., 1.])",
    ),
    "f of three for two": (
        lambda: at_once(lambda t, h, v: np.ones(3), [1.0, 2.0]),
        TypeError,
        GIVEN + "one number, or an array of shape (2,); got array([1., 1., 1.])",
    ),
    "a root": (
        lambda: at_once(root_below, 0.1),
        ValueError,
        "v is a complex number: is a root of a negative number taken",
    ),
    "f raises": (lambda: at_once(lambda t, h, v: 1 / 0), ZeroDivisionError, "division by zero"),
    "swapped": (
        lambda: integrate(1.0, spring, 0.0, dt=0.1, t_end=1.0),
        TypeError,
        "f must be a function of (t, h, v); got 1.0",
    ),
    "dt as a place": (lambda: integrate(spring, 1.0, 0.0, 0.1), TypeError, "takes 3 positional arguments but 4"),
    "wrong keyword": (lambda: at_once(h=0.1), TypeError, "unexpected keyword argument 'h'"),
    "t_end before t0": (lambda: at_once(t0=2.0), ValueError, "t_end must be a finite number at least 2 [s]; got 1.0"),
    "h0 of strings": (
        lambda: at_once(h0=["1"]),
        TypeError,
        "h0 must be a number or an array of numbers [m]; got ['1']",
    ),
    "h0 with nan": (lambda: at_once(h0=[1.0, math.nan]), ValueError, "h0 must be finite everywhere [m]"),
    # the method
    "a class": (lambda: at_once(method=RK45), ValueError, CHOOSE),
    "a class, flown": (lambda: fly(PAPER, 60.0, method=RK45), ValueError, CHOOSE),
    "a class, published": (lambda: published.fly(35.88, dt=0.5, method=RK45), ValueError, CHOOSE),
    "a row of METHODS": (lambda: at_once(method=METHODS["rk4"]), ValueError, CHOOSE),
    "f as the method": (lambda: at_once(method=spring), TypeError, "takes 3 positional arguments but 5 were given"),
    "step without return": (lambda: at_once(method=lambda f, t, h, v, dt: None), TypeError, PAIR + "None"),
    "step of one number": (lambda: at_once(method=lambda f, t, h, v, dt: h), TypeError, PAIR + "1.0"),
    "step of three": (lambda: at_once(method=lambda f, t, h, v, dt: (t, h, v)), TypeError, PAIR + "(0.0, 1.0, 0.0)"),
    "step of lists": (lambda: at_once(method=lambda f, t, h, v, dt: ([h], [v])), TypeError, PAIR + "([1.0], [0.0])"),
    "step without return, flown": (
        lambda: fly(PAPER, 60.0, method=lambda f, t, h, v, dt: None),
        TypeError,
        PAIR + "None",
    ),
    "step without return, hovering": (
        lambda: hover_height(PAPER, 60.0, method=lambda f, t, h, v, dt: None),
        TypeError,
        PAIR + "None",
    ),
    "step of one number, falling": (
        lambda: FreeFall(PAPER, method=lambda f, t, h, v, dt: h),
        TypeError,
        PAIR + "150000.0",
    ),
    # the descent
    "booster and planet swapped": (
        lambda: Descent(EARTH, FALCON_9),
        TypeError,
        "booster must be a Booster; got Planet(",
    ),
    "numbers left out": (lambda: Booster(27e3), TypeError, "missing 5 required positional arguments"),
    "unknown number": (lambda: Booster(weight=27e3), TypeError, "unexpected keyword argument 'weight'"),
    "a list for a column": (
        lambda: Planet([1.0, 2.0], 1.0, 1.0, 1.0),
        TypeError,
        "mass must be a finite number greater than 0 [kg]",
    ),
    "a DataFrame for a column": (lambda: Descent(height=pd.DataFrame({"h": [1.0, 2.0]})), TypeError, "height must be"),
    "mixed lengths": (
        lambda: Descent(height=np.ones(2), velocity=np.ones(3)),
        ValueError,
        "all columns must have the same number of rows: height has 2, velocity has 3",
    ),
    "flight swapped": (lambda: fly(60.0, PAPER), TypeError, "descent must be a Descent; got 60.0"),
    "step as a place": (lambda: fly(PAPER, 60.0, 0.02), TypeError, "takes 2 positional arguments but 3 were given"),
    "too fine a step": (lambda: fly(PAPER, 60.0, dt=1e-12), ValueError, "use a dt of at least 6.5e-06 s"),
    "a law of three": (
        lambda: fly(PAPER, 60.0, controller=lambda t, h, v: 1.0),
        TypeError,
        "takes 3 positional arguments but 4 were given",
    ),
    "a table of times": (lambda: fly_all(PAPER, np.ones((2, 2))), TypeError, "t_ignite must be a finite number"),
    "a best of two": (lambda: best_ignition(PAPER, 60.0), TypeError, "takes 1 positional argument but 2 were given"),
    "no methods": (
        lambda: ignition_table([60.0], dt=0.1, methods=None),
        TypeError,
        "methods must be a collection of methods, such as ('rk4',); got None",
    ),
    "g for a planet": (lambda: speed_after_fall(9.81, 2.0), TypeError, "planet must be a Planet; got 9.81"),
    # the paper's programs and the tables
    "no run": (lambda: published.listed(None), TypeError, "run must be a Trajectory or a Flight; got None"),
    "another table": (
        lambda: published.optimisation_table(0.03),
        ValueError,
        "for dt = 0.02, 0.05 and 0.1 s; got 0.03",
    ),
    "a table of data": (lambda: data.load(pd.DataFrame()), ValueError, "there is no table"),
    # drawing
    "unknown line": (lambda: plotting.line("rk5"), ValueError, f"there is no method 'rk5'; {CHOOSE}"),
    "no line": (lambda: plotting.line(["rk4"]), ValueError, f"there is no method ['rk4']; {CHOOSE}"),
    "unknown stroke": (lambda: stroke(None), ValueError, f"there is no method None; {CHOOSE}"),
    "no alt": (lambda: framed(alt=None), TypeError, "alt must be a text that says what the figure shows; got None"),
    "alt of a number": (lambda: framed(alt=3), TypeError, "alt must be a text"),
    "alt without words": (lambda: framed(alt=" \n"), ValueError, "alt must say what the figure shows"),
    "no title": (
        lambda: framed(title=None),
        ValueError,
        "title must be one text, or a list of 1, one for each of the axes",
    ),
    "a number on an axis": (lambda: framed(x=3), ValueError, "x must be one text, or a list of 1"),
    "too many names": (lambda: framed(y=("h [m]", "v [m/s]")), ValueError, "y must be one text, or a list of 1"),
    "no rows": (lambda: framed(nrows=0), ValueError, "Number of rows must be a positive integer"),
    "no figure": (lambda: plotting.show(None, alt="1 m"), TypeError, "fig must be a Figure; got None"),
    "no flight": (lambda: plotting.flight([1, 2], None), TypeError, "flown must be a Flight or a Trajectory; got None"),
    # live figures
    "live without a figure": (
        lambda: live.Live("fig", str, x=FloatSlider()),
        TypeError,
        "fig must be a Figure; got 'fig'",
    ),
    "no verdict": (lambda: live.verdict("crash", 0.0), TypeError, "flight must be a Flight; got 'crash'"),
    "mission control of nothing": (lambda: try_out(None, 60.0, 0.1, "rk4"), TypeError, "descent must be a Descent"),
}


@pytest.mark.parametrize("call", CALLS)
def test_careless_call(call):
    function, error, message = CALLS[call]
    with pytest.raises(error, match=re.escape(message)):
        function()


FILMS = {
    "no flight": (lambda flown: animation.resample(None, [1.0]), TypeError, "flight must be a Flight; got None"),
    "no flight for instruments": (
        lambda flown: animation.readings(3.0, 1.0),
        TypeError,
        "flight must be a Flight; got 3.0",
    ),
    "strings": (at(["1", "2"]), TypeError, "times must be a number or an array of numbers [s]; got ['1', '2']"),
    "complex": (at([1j, 2j]), TypeError, "times must be a number or an array of numbers [s]"),
    "huge": (at([1.0, HUGE]), TypeError, "times must be a number or an array of numbers [s]"),
    "one number": (at(3.0), ValueError, "times must be one or more finite numbers [s], increasing; got array(3.)"),
    "a table": (at(np.ones((2, 2))), ValueError, "times must be one or more finite numbers [s], increasing"),
    "milliseconds": (
        at([60e3, 61e3]),
        ValueError,
        "times must lie within the flight, 0 to 80.4703 s; got 60000 to 61000 s (did you mean 60000 to 61000 ms?)",
    ),
    "minutes": (at([1000.0, 1e5]), ValueError, "got 1000 to 100000 s"),
    "no alt": (at([1.0], alt=None), TypeError, "alt must be a text that says what the film shows; got None"),
    "seconds a frame": (
        at([1.0], duration=0.04),
        ValueError,
        "duration must be a finite number at least 20 [ms]; got 0.04",
    ),
    "top at the ground": (
        lambda flown: animation.landing_stills(flown, [1.0], top=0.0),
        ValueError,
        "top must be a finite number greater than 0 [m]; got 0.0",
    ),
    "no top": (
        lambda flown: animation.landing_stills(flown, [1.0], top="2 km"),
        TypeError,
        "top must be a finite number",
    ),
    "one axis": (
        lambda flown: plotting.flight(None, flown),
        ValueError,
        "axes must be two, for the height and for the velocity",
    ),
}


@pytest.mark.parametrize("call", FILMS)
def test_careless_film(flown, call):
    function, error, message = FILMS[call]
    with pytest.raises(error, match=re.escape(message)):
        function(flown)


# ---- controls -----------------------------------------------------------------------------------------------------


@pytest.fixture
def figure():
    fig, _ = plt.subplots()
    yield fig
    plt.close(fig)


@pytest.mark.parametrize(
    ("update", "controls", "message"),
    [
        (None, {"x": FloatSlider()}, "update must be a function of (x); got None"),
        (str, {"x": 1.0}, "x must be a control of ipywidgets, such as a FloatSlider; got 1.0"),
        (str, {"x": (0, 10)}, "x must be a control of ipywidgets"),
    ],
)
def test_what_no_figure_can_follow_is_refused_and_leaves_the_figure(figure, update, controls, message):
    with pytest.raises(TypeError, match=re.escape(message)):
        live.Live(figure, update, **controls)
    assert plt.fignum_exists(figure.number)


@pytest.fixture
def two(figure):
    sliders = {name: FloatSlider(1.0, min=0.0, max=2.0, step=0.1) for name in "xy"}
    made = live.Live(figure, lambda x, y: f"{x:.1f} and {y:.1f}", **sliders)
    yield made
    made.close()


@pytest.mark.parametrize(
    ("values", "error", "message", "text"),
    [
        ({"x": 0.5, "z": 1.0}, ValueError, "there is no control 'z'; there are x, y", "1.0 and 1.0"),
        ({"x": 0.5, "y": "b"}, traitlets.TraitError, "expected a float, not the str 'b'", "0.5 and 1.0"),
        ({"x": 0.5, "y": None}, traitlets.TraitError, "expected a float, not the NoneType", "0.5 and 1.0"),
    ],
)
def test_figure_shows_where_its_controls_are_whatever_is_refused(two, values, error, message, text):
    with pytest.raises(error, match=message):
        two.set(**values)
    assert two.text == text
    two.controls["x"].value = 1.5
    assert two.text == f"1.5 and{text[7:]}", "and follows them"


@pytest.mark.parametrize(("x", "text"), [(5.0, "2.0"), (-5.0, "0.0"), (math.inf, "2.0"), (math.nan, "nan")])
def test_value_outside_a_slider_is_the_nearest_in_it(two, x, text):
    two.set(x=x)
    assert two.text == f"{text} and 1.0"


@pytest.fixture(scope="module")
def page():
    made = MissionControl()
    yield made
    made.live.close()


NOT_POSSIBLE = {
    "before the start": ({"t_ignite": -5.0}, r"t_ignite must be a finite number at least 0 \[s\]; got -5.0"),
    "never": ({"t_ignite": math.inf}, r"t_ignite must be a finite number at least 0 \[s\]; got inf"),
    "no time": ({"t_ignite": math.nan}, r"t_ignite must be a finite number at least 0 \[s\]; got nan"),
    "no thrust": ({"thrust": math.nan}, r"thrust must be a finite number greater than 0 \[N\]; got nan"),
    "no method": ({"methods": ()}, "choose at least one method"),
    "the paper on Mars": ({"planet": "Mars", "faults": True}, "press Reset"),
}


@pytest.mark.parametrize("case", NOT_POSSIBLE)
def test_page_says_what_is_not_possible_keeps_no_trial_of_it_and_comes_back(page, case):
    values, message = NOT_POSSIBLE[case]
    page.live.set(**values)
    assert re.fullmatch(f"Not possible: .*{message}", page.live.text)
    page.keep()
    assert page.trials == []
    page.reset()
    assert page.slider.value == 60.2
    assert page.live.text.endswith("Ignition at 60.200000 s, dt = 0.02 s.")
    page.keep()
    assert len(page.trials) == 1
    page.clear()


@pytest.mark.parametrize(
    "values",
    [{"t_ignite": "soon"}, {"t_ignite": None}, {"dt": 0.0}, {"planet": "Venus"}, {"methods": "rk4"}, {"faults": "yes"}],
    ids=repr,
)
def test_what_a_control_cannot_hold_is_refused_and_nothing_moves(page, values):
    before = page.live.values(), page.live.text
    with pytest.raises(traitlets.TraitError):
        page.live.set(**values)
    assert (page.live.values(), page.live.text) == before


# ---- exercises ----------------------------------------------------------------------------------------------------


def forgets(*given):
    pass


def prints(*given):
    print("noise")


def of_strings(*given):
    return "36"


def warns(*given):
    warnings.warn("careful", stacklevel=1)


def of_a_huge_number(*given):
    return HUGE


def waits(*given):
    threading.Event().wait(60)


def fails(*given):
    raise RuntimeError("mine")


# an answer, and what is said of it where a number is wanted, and where a function is
ANSWERS = {
    "None": (None, "should be one number; it is None", "should be a function of"),
    "a string": ("36", "should be one number; it is '36'", "should be a function of"),
    "nan": (math.nan, "is nan, which is not a finite number", "should be a function of"),
    "huge": (HUGE, "should be one number; it is 1000", "should be a function of"),
    "a bool": (True, "should be one number; it is True", "should be a function of"),
    "complex": (1j, "should be one number; it is 1j", "should be a function of"),
    "two numbers": ([1.0, 2.0], "should be one number; it holds 2 numbers", "should be a function of"),
    "none at all": (np.array([]), "should be one number; it holds 0 numbers", "should be a function of"),
    "a DataFrame": (pd.DataFrame(), "should be one number; it holds", "should be a function of"),
    "a class": (object, "should be one number; it is <class 'object'>", "raised TypeError"),
    "no return": (prints, "is a function: are the brackets of a call missing?", "None"),
    "strings": (of_strings, "is a function: are the brackets of a call missing?", "'36'"),
    "a huge number": (of_a_huge_number, "is a function: are the brackets of a call missing?", "1000"),
    "raises": (fails, "is a function: are the brackets of a call missing?", "raised RuntimeError: mine in line"),
    "warns": (warns, "is a function: are the brackets of a call missing?", "None|careful"),
    "waits": (waits, "is a function: are the brackets of a call missing?", "was stopped after"),
}


@pytest.mark.parametrize("what", ANSWERS)
def test_every_check_answers_whatever_it_is_given(what, capsys, monkeypatch):
    limit = 0.05 if what == "waits" else 10.0
    monkeypatch.setattr(feedback, "TIME_LIMIT", limit)
    answer, as_number, as_function = ANSWERS[what]
    for number, check in checks.EXERCISES.items():
        monkeypatch.setattr(check.judge, "seconds", limit, raising=False)
        check.tries.clear()
        said = check(*[answer] * len(check.answers)).text
        assert "\n" not in said
        if number in ("1.3", "4.2"):  # one wants lists, the other takes what goes wrong for no solution
            assert said.startswith("✘ ")
            continue
        assert said.startswith("✘ 0 of "), (number, said)
        assert re.search(as_function if "def " in check.solution else as_number, said), (number, said)
    assert capsys.readouterr() == ("", "")


def test_every_check_says_how_it_is_called():
    for number, check in checks.EXERCISES.items():
        names = ", ".join(check.answers)
        for given in (len(check.answers) + 1, len(check.answers) - 1):
            said = check(*[1.0] * given).text
            assert said.endswith(f"Please call it as in the lesson: checks.{check.name}({names})"), number


@pytest.mark.skipif(not hasattr(stopping.signal, "setitimer"), reason="no timer of signals")
@pytest.mark.parametrize("pause", [1e-2, 1e-3])
def test_no_alarm_is_left_however_often_it_rings(pause, monkeypatch):
    monkeypatch.setattr(stopping, "PAUSE", pause)

    def endless():
        while True:
            pass

    for _ in range(30):
        with pytest.raises(stopping.TimeIsUp):
            stopping.limited(endless, 1e-4)
        assert stopping.signal.getitimer(stopping.signal.ITIMER_REAL) == (0.0, 0.0)


@pytest.mark.parametrize("number", ["99.1", None, 2.1, "", "solution"])
def test_solution_of_no_exercise_is_a_sentence(number):
    assert re.match(r"There is no exercise|my_|def ", checks.show_solution(number).text)


# ---- the command line, and what is installed ----------------------------------------------------------------------


@pytest.mark.parametrize(
    ("command", "message"),
    [
        (["copy", ".", "--zip"], r"\. is no name for a file: choose one, such as my_course"),
        (["copy", "..", "--zip"], r"\.\. is no name for a file: choose one"),
        (["copy", "", "--zip"], "is no name for a file: choose one"),
        (["copy", "new", "--lesson", ""], "'' means more than one of"),
        (["collect", "file"], "file holds no returned copies: name a folder"),
        (["collect", "nowhere"], "nowhere holds no returned copies: name a folder"),
    ],
    ids=repr,
)
def test_command_that_cannot_be_done_is_a_sentence_and_does_nothing(command, message, capsys):
    assert course.main(command) == 2
    said = capsys.readouterr()
    assert said.out == ""
    assert re.fullmatch(rf".*{message}.*\n", said.err)


@pytest.mark.parametrize(
    "command", [[], ["nothing"], ["copy"], ["copy", "a", "b"], ["copy", "a", "--lessons", "1"]], ids=repr
)
def test_command_that_does_not_exist_tells_those_that_do(command, capsys):
    with pytest.raises(SystemExit) as caught:
        course.main(command)
    assert caught.value.code == 2
    assert "usage: python -m hoverslam_lib.course" in capsys.readouterr().err


def test_an_older_python_is_told_so_before_anything_is_downloaded():
    lines = (ROOT / "environment.txt").read_text("utf-8").splitlines()
    first = Requirement(next(line for line in lines if line and not line.startswith("#")))
    wanted = tomllib.loads((ROOT / "pyproject.toml").read_text("utf-8"))["project"]["requires-python"]
    for version in ("3.8", "3.9", "3.10", "3.11", "3.12", "3.13", "3.14", "3.15"):
        refused = first.marker.evaluate({"python_version": version})
        assert refused != SpecifierSet(wanted).contains(version)
    assert f"needs-Python-{wanted.removeprefix('>=')}-or-newer" in first.url
