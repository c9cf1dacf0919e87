"""Exercises of lesson 3: what a method keeps."""

import numpy as np

from hoverslam_lib.checks.answers import array, compare, number, pair, repeatable, takes
from hoverslam_lib.checks.feedback import Wrong, exercise
from hoverslam_lib.integrators import METHODS
from hoverslam_lib.metrics import max_error, observed_order
from hoverslam_lib.oscillator import Oscillator
from hoverslam_lib.trajectory import integrate


def _lead(per_period):
    """Time [s] by which symplectic Euler is ahead after each period of the spring of 1 rad/s."""
    dt = 2 * np.pi / per_period
    return 2 * np.pi * (1 - dt / (2 * np.arcsin(dt / 2)))


@exercise(
    "3.1",
    "ahead of time",
    tests=2,
    hints=(
        "Two rules are in the lesson: how the lead grows with the time, and how the frequency is off for a given step.",
        "For the first number: which power of the step is in the error of the frequency? For the second: how long is "
        "half a period?",
        "Look at a single period: how much does the run gain in it with the steps of the table, how much with yours, "
        "and how much makes half a period?",
    ),
)
def running_ahead(milliseconds, periods):
    lead, table = _lead(20), 10e3 * _lead(60)
    half_ahead = np.pi / lead
    milliseconds, periods = number(milliseconds, "my_lead"), number(periods, "my_periods")
    if np.allclose((periods, milliseconds), (10e3 * lead, half_ahead), rtol=0.03):
        raise Wrong("Both numbers are right, in the wrong places: which one is the lead in ms?", "swapped")
    mistakes = {
        "wrong sign": (-10e3 * lead, "The size is right. Which sign has the lead in the table?"),
        "step unchanged": (table, "That is the lead in the table. It was made with 60 steps a period; here?"),
        "proportional to the step": (
            3 * table,
            "You let the lead grow in proportion to the step. Which power of the step does the frequency know?",
        ),
        "cube of the step": (
            27 * table,
            "Look again at the power of the step in the formula for the frequency.",
        ),
        "finer for coarser": (table / 9, "20 steps a period: are the steps longer or shorter than with 60?"),
        "a third": (table / 3, "20 steps a period: are the steps longer or shorter than with 60?"),
        "in seconds": (10 * lead, "Is that in milliseconds?"),
        "one period": (1e3 * lead, "That is the lead after one period. Asked is the lead after ten."),
    }
    _near(milliseconds, 10e3 * lead, "lead")
    compare(milliseconds, 10e3 * lead, "for the lead after 10 periods, in ms", mistakes, rtol=0.03)
    yield
    right = half_ahead
    mistakes = {
        "whole period": (2 * right, "Then it is a whole period ahead, and on the right side again."),
        "quarter": (right / 2, "Then it is a quarter of a period ahead, in the middle of the spring."),
        "half a second": (0.5 / lead, "Then it is half a second ahead. How long is half a period?"),
        "in tens": (right / 10, "Your lead was that of ten periods, not of one."),
        "in steps": (20 * right, "That is the number of steps. Asked are periods."),
        "in seconds": (2 * np.pi * right, "That is the time in seconds. Asked are periods."),
        "step unchanged": (np.pi / _lead(60), "With the step of the table, yes. And with 20 steps a period?"),
        "milliseconds for seconds": (right / 1000, "How many milliseconds is half a period?"),
    }
    _near(periods, right, "number of periods")
    compare(periods, right, "for the number of periods", mistakes, rtol=0.03)
    yield


def _near(got, right, name):
    if 0.03 < abs(got / right - 1) < 0.06:
        raise Wrong(f"Near, but the {name} is more than 3 % off. Have you rounded on the way?")


def _verlet(f, t, h, v, dt, *, first=0.5, second=0.5, place=1.0, early=0.0, time=1.0, move=1.0, old_v=False):
    """A push, a move and a push; the keywords make its usual slips."""
    half = v + first * dt * f(t + early * dt, h, v)
    new = h + move * dt * (v if old_v else half)
    return new, half + second * dt * f(t + time * dt, h + place * (new - h), half)


def _turned(f, t, h, v, dt, *, old_v=False):
    """f asked for (h, v, t)."""
    half = v + dt / 2 * f(h, v, t)
    new = h + dt * half
    return new, half + dt / 2 * f(new, v if old_v else half, t + dt)


def _halved_move(f, t, h, v, dt):
    middle = h + dt / 2 * v
    new = v + dt * f(t + dt / 2, middle, v)
    return middle + dt / 2 * new, new


def _half_velocity(f, t, h, v, dt):
    half = v + dt / 2 * f(t, h, v)
    return h + dt * half, half


@exercise(
    "3.2",
    "a push in two halves",
    tests=6,
    hints=(
        "Three lines: a push, a move, a push. Do one step of the spring by hand, and hold yours against it.",
        "Each line uses what the line before it has made. Which h, v and time are there when the second push begins?",
        "Look at the two calls of f, one for each push: which time and which place does each need, and in which order?",
    ),
)
def verlet_step(step):
    takes(step, "f", "t", "h", "v", "dt")
    order = "In which order does f take time, position and velocity?"
    for name, f, t, h, v, dt in (
        ("the spring", lambda t, h, v: -4.3 * h, 0.7, 2.9, -1.3, 0.4),
        ("a force that also depends on time", lambda t, h, v: 3.1 * t - h**2, 1.1, 2.3, -1.7, 0.2),
    ):
        at = (f, t, h, v, dt)
        right = _verlet(*at)
        mistakes = {
            "one whole push": (METHODS["symplectic_euler"].step(*at), "That is symplectic Euler. Halve its push."),
            "explicit Euler": (METHODS["explicit_euler"].step(*at), "That is explicit Euler, lesson 2."),
            "old place": (
                _verlet(*at, place=0),
                "Your second push is taken at the place of the first. Where is the weight when it begins?",
            ),
            "place of the middle": (
                _verlet(*at, place=0.5),
                "Your second push is taken halfway through the move. Where is the weight when it begins?",
            ),
            "order of arguments": (_turned(*at), order),
            "order of arguments, old v": (_turned(*at, old_v=True), order),
            "two whole pushes": (_verlet(*at, first=1, second=1), "You push twice, for a whole step each."),
            "second push whole": (_verlet(*at, second=1), "For how long does your second push last?"),
            "first push whole": (_verlet(*at, first=1), "For how long does your first push last?"),
            "no second push": (_half_velocity(*at), "The position is right. Is the velocity pushed for a whole step?"),
            "half a move": (_verlet(*at, move=0.5), "Only the push is halved. For how long should the weight move?"),
            "old velocity": (
                _verlet(*at, old_v=True),
                "You move with the velocity of the start. Which one do you have when the move begins?",
            ),
            "move in two halves": (_halved_move(*at), "That is leapfrog too, but you halve the move. Halve the push."),
            "swapped": (right[::-1], "Both numbers are right, in the wrong order: a step returns (h, v)."),
            "time of the middle": (
                _verlet(*at, time=0.5),
                "That fits a spring. But what time is it when the second push begins, after the whole move?",
            ),
            "old time": (
                _verlet(*at, time=0),
                "That fits a spring. But what time is it when the second push begins?",
            ),
            "first push at the end": (
                _verlet(*at, early=1),
                "That fits a spring. But what time is it when the first push begins?",
            ),
            "first push in the middle": (
                _verlet(*at, early=0.5),
                "That fits a spring. But what time is it when the first push begins?",
            ),
        }
        compare(pair(repeatable(step, *at)), right, f"for {name}, one step of {dt:g} s", mistakes)
        yield
    corners = np.array([1.9, 2.1, 2.1, 1.9]), np.array([-0.1, -0.1, 0.1, 0.1])
    got = repeatable(step, _pendulum, 0.0, *corners, 0.3)
    compare(array(got, (2, 4)), _verlet(_pendulum, 0.0, *corners, 0.3), "for arrays")
    yield
    back = pair(step(_pendulum, 0.3, *step(_pendulum, 0.0, 2.0, 0.5, 0.3), -0.3))
    compare(back, (2.0, 0.5), "for a step forward and the same step back")
    yield
    spring = Oscillator(stiffness=4.0)
    sizes = spring.period / np.array([50, 100, 200])
    runs = [integrate(spring.acceleration, 3.0, 0.0, dt=dt, t_end=2 * spring.period, method=step) for dt in sizes]
    order = observed_order(sizes, [max_error(spring.exact(run.t)[0], run.h) for run in runs])
    compare(round(order), 2, "for the order of the position")
    yield
    order = observed_order(sizes, [max_error(spring.exact(run.t)[1], run.v) for run in runs])
    compare(round(order), 2, "for the order of the velocity")
    yield


def _pendulum(t, angle, rate):
    return -np.sin(angle)


def _ripples(t, x, v):
    return -0.3 * np.sin(50 * x)


def _fall(t, h, v):
    return -9.81 + 0.05 * v**2


def _thin_air(t, h, v):
    return -9.81 + 1e-4 * v**2


@exercise(
    "3.3",
    "a meter for area",
    tests=6,
    hints=(
        "Let one step carry the corners of a shape, and compare areas. If that is right for the spring only: how large "
        "is your shape, and where is it?",
        "Make the shape small, but not so small that rounding shows: what if its side is a thousandth?",
        "Two arrays hold the corners of a shape a thousandth wide, one their x, one their v. What does `step` make of "
        "them, and `area` of that?",
    ),
)
def area_factor(meter):
    takes(meter, "step", "f", "x", "v", "dt")
    explicit, symplectic, implicit = (
        METHODS[key].step for key in ("explicit_euler", "symplectic_euler", "implicit_euler")
    )
    for name, step, f, x, v, dt, right in (
        ("explicit Euler on a spring", explicit, lambda t, x, v: -5 * x, 3.0, 1.0, 0.4, 1.8),
        (
            "explicit Euler on a force that is strongly curved",
            explicit,
            _ripples,
            0.64 * np.pi,
            -1.0,
            0.3,
            2.35,
        ),
        ("symplectic Euler on the pendulum", symplectic, _pendulum, 2.0, 0.0, 1.5, 1.0),
        ("symplectic Euler on a fall with drag, where f depends on v", symplectic, _fall, 40.0, -8.0, 0.25, 0.8),
        ("implicit Euler on a spring", implicit, lambda t, x, v: -5 * x, -1.0, 0.5, 0.4, 1 / 1.8),
    ):
        mistakes = {
            "before over after": (1 / right, "That is the area before over the area after."),
            "lengths": (np.sqrt(right), "That is by how much lengths grow, on average. Asked is the area."),
            "growth only": (right - 1, "For a step that keeps the area, is your number 0? Asked is the factor."),
            "squared": (right**2, "Your factor is the square of the right one. Did you take two steps?"),
        }
        got = repeatable(meter, step, f, x, v, dt)
        if isinstance(got, float) and not np.isfinite(got):
            raise Wrong(
                f"At x = {x:.4g}, v = {v:g} your meter gives no number: was something divided by 0? Does your shape "
                "have an area there, and do its corners go round it in order?"
            )
        got = number(got)
        compare(got, right, f"for {name}", mistakes, rtol=1e-3, atol=0)
        yield
    for h in (149.9e3, 150e3, 150.1e3):
        got = repeatable(meter, symplectic, _thin_air, h, -2300.0, 0.5)
        if np.size(got) != 1 or not np.isclose(got, 0.77, rtol=1e-3, atol=0):
            raise Wrong(
                "All that is right near the origin, but not at 150 km and -2300 m/s. A number is stored to 16 digits: "
                "what is left of tiny differences between large ones, or between their products? Does an area change "
                "when its shape is shifted?"
            )
    yield
