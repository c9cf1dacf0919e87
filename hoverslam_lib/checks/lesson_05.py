"""Exercises of lesson 5: what accuracy costs."""

import math

import numpy as np

from hoverslam_lib.checks.answers import array, compare, number, pair, repeatable, takes
from hoverslam_lib.checks.feedback import Wrong, exercise
from hoverslam_lib.integrators import METHODS
from hoverslam_lib.metrics import max_error, observed_order
from hoverslam_lib.trajectory import integrate


def _pendulum(t, x, v):
    """The pushed pendulum, which moves as 2 cos t."""
    push = -2 * math.cos(t) + math.sin(2 * math.cos(t)) - 0.2 * math.sin(t)
    return -math.sin(x) - 0.1 * v + push


def _error(method, steps):
    run = integrate(_pendulum, 2.0, 0.0, dt=20 / steps, t_end=20.0, method=method)
    return max_error(2 * np.cos(run.t), run.h) / 2


def _read(got, right, within, where, mistakes):
    """Compare a number that was read off a figure: right if it is within a factor; mistakes within a tenth."""
    if got > 0 and abs(math.log(got / right)) <= math.log(within):
        return
    for mistake, (wrong, hint) in mistakes.items():
        if got > 0 and abs(math.log(got / wrong)) <= math.log(1.1):
            raise Wrong(hint, mistake)
    raise Wrong(f"Not right {where}: you read {got:g}.", nudge=True)


@exercise(
    "5.1",
    "reading work and precision",
    tests=3,
    hints=(
        "Both axes are logarithmic: halfway from one power of ten to the next is a factor of about 3, not of 5.",
        "Put a ruler on 1e-8, then on 1000 looks. The third needs the steepness: what does tenfold work buy?",
    ),
)
def reading(looks, ratio, far):
    def price(method, each, target, coarse, fine):
        """Looks for an error, between two points of a line."""
        errors = [math.log(_error(method, steps)) for steps in (coarse, fine)]
        share = (math.log(target) - errors[0]) / (errors[1] - errors[0])
        return each * coarse * (fine / coarse) ** share

    nine = price("rk4", 4, 1e-9, 640, 1280)
    right = price("rk4", 4, 1e-8, 640, 1280)
    another = "That is where another line passes. Which colour and style has rk4?"
    mistakes = {
        "line of rkn4": (price("rkn4", 5, 1e-8, 160, 320), another),
        "line of dop8": (price("dop8", 12, 1e-8, 28, 40), another),
        "line of gauss4": (6400, another),
        "steps": (right / 4, "Those are steps. How many looks are they?"),
        "line of 1e-6": (
            price("rk4", 4, 1e-6, 160, 320),
            "That buys an error of 1e-6. Count the grid lines once more.",
        ),
        "line of 1e-10": (nine * 10**0.25, "That buys an error of 1e-10. Count the grid lines once more."),
    }
    _read(number(looks, "the first answer"), right, 1.2, "for the looks of rk4", mistakes)
    yield
    errors = _error("rk4", 250), _error("rkn4", 200)
    prices = price("rk4", 4, 1e-6, 160, 320), price("rkn4", 5, 1e-6, 80, 160)
    mistakes = {
        "upside down": (errors[1] / errors[0], "Asked is how many times smaller: a number above 1."),
        "prices": (prices[0] / prices[1], "You compare what one error costs. Asked is what one price buys."),
        "powers of ten": (
            math.log10(errors[0] / errors[1]),
            "Those are the powers of ten between the two. What factor is that?",
        ),
        "same step": (
            _error("rk4", 200) / errors[1],
            "That is at the same step size. Asked is at the same number of looks.",
        ),
    }
    _read(number(ratio, "the second answer"), errors[0] / errors[1], 2, "for the two errors", mistakes)
    yield
    mistakes = {
        "order 1": (nine * 1e3, "So many it would take at order 1. How steep is the line of rk4?"),
        "order 2": (nine * 1e3**0.5, "So many it would take at order 2. How steep is the line of rk4?"),
        "order 8": (nine * 1e3**0.125, "So few would do at order 8. How steep is the line of rk4?"),
        "as from 3 to 6 to 9, plus": (
            nine + (nine - prices[0]),
            "You add what the last three digits cost. On such axes, equal ways are equal factors.",
        ),
        "only the factor": (1e3**0.25, "That is how many times as many. As many as what?"),
    }
    _read(number(far, "the third answer"), nine * 1e3**0.25, 1.25, "for the error of 1e-12", mistakes)
    yield


def _three_eighths(f, t, h, v, dt, *, third=2 / 3, last="own"):
    """Kutta's other method, or what half a mending leaves of it: the time of look 3, the velocity in look 4."""
    k1h, k1v = v, f(t, h, v)
    k2h = v + dt / 3 * k1v
    k2v = f(t + dt / 3, h + dt / 3 * k1h, k2h)
    k3h = v + dt * (k2v - k1v / 3)
    k3v = f(t + third * dt, h + dt * (k2h - k1h / 3), k3h)
    k4h = v + dt * (k1v - k2v + k3v)
    k4v = f(t + dt, h + dt * (k1h - k2h + k3h), {"own": k4h, "third": k3h, "start": v}[last])
    return h + dt / 8 * (k1h + 3 * k2h + 3 * k3h + k4h), v + dt / 8 * (k1v + 3 * k2v + 3 * k3v + k4v)


def _counted(f):
    def g(t, h, v):
        g.calls += 1
        return f(t, h, v)

    g.calls = 0
    return g


@exercise(
    "5.2",
    "order 4 on the spring, order 1 on the pendulum",
    tests=5,
    hints=(
        "On which of t, h, v does the spring's acceleration depend, and on which the pendulum's?",
        "Go through the four calls of f, one argument after the other, beside the table: time, place, velocity.",
    ),
)
def mended_three_eighths(step):
    takes(step, "f", "t", "h", "v", "dt")
    for f, where, t, h, v, dt in (
        (lambda t, h, v: t**2 - 2 * h - 0.3 * v * abs(v), "t² - 2h - 0.3|v|v", 1.0, 0.7, -2.0, 0.3),
        (lambda t, h, v: math.cos(5 * t) - h**3 - v, "cos 5t - h³ - v", 0.4, 1.2, 1.5, 0.25),
        (_pendulum, "the pushed pendulum", 2.0, 1.0, 1.0, 0.2),
    ):
        mistakes = {
            "unmended": (_three_eighths(f, t, h, v, dt, third=1 / 3, last="third"), "Both bugs are still in it."),
            "time": (
                _three_eighths(f, t, h, v, dt, third=1 / 3),
                "One bug is gone. Now read every first argument of f.",
            ),
            "velocity": (
                _three_eighths(f, t, h, v, dt, last="third"),
                "One bug is gone. Now read every last argument of f.",
            ),
            "velocity of the start": (
                _three_eighths(f, t, h, v, dt, last="start"),
                "With which velocity does the booster arrive where the fourth look is taken?",
            ),
            "classical": (METHODS["rk4"].step(f, t, h, v, dt), "That is the classical method. Asked is this one."),
        }
        g = _counted(f)
        got = pair(repeatable(step, g, t, h, v, dt))
        compare(got, _three_eighths(f, t, h, v, dt), f"for {where}", mistakes)
        if g.calls != 8:  # called twice
            raise Wrong("Right, but at another price: a step should take four looks.", "more looks")
        yield
    h, v = np.array([0.5, 1.0]), np.array([-1.0, 2.0])

    def damped(t, h, v):
        return t - h - 0.1 * v * abs(v)

    got = repeatable(step, damped, 0.5, h, v, 0.2)
    compare(array(got, (2, 2), "the result"), _three_eighths(damped, 0.5, h, v, 0.2), "for arrays")
    yield
    sizes = 2.0 / np.array([10, 20, 40])
    runs = [integrate(_pendulum, 2.0, 0.0, dt=dt, t_end=2.0, method=step) for dt in sizes]
    errors = [max_error(2 * np.cos(run.t), run.h) for run in runs]
    compare(round(observed_order(sizes, errors)), 4, "for its order on the pushed pendulum")
    yield


def _by_table(f, t, h, v, dt, A, b, *, timely=True, moving=True, scaled=True, all_slopes=True, own=True):
    """One explicit Runge-Kutta step, or what its usual slips make of it."""
    kh, kv = [], []
    for i, row in enumerate(A):
        mix = range(i) if all_slopes else range(max(i - 1, 0), i)
        to_h, to_v = sum(row[j] * kh[j] for j in mix), sum(row[j] * kv[j] for j in mix)
        ahead = dt if scaled else 1
        v_look = v + ahead * to_v
        when = t + dt * sum(row) if timely else t
        kv.append(f(when, h + ahead * to_h, v_look if own else v))
        kh.append(v_look if moving else v)
    total_h = sum(weight * k for weight, k in zip(b, kh, strict=True))
    total_v = sum(weight * k for weight, k in zip(b, kv, strict=True))
    return h + dt * total_h, v + dt * total_v


TABLES = {
    "Kutta's 3/8": ([[0, 0, 0, 0], [1 / 3, 0, 0, 0], [-1 / 3, 1, 0, 0], [1, -1, 1, 0]], [1 / 8, 3 / 8, 3 / 8, 1 / 8]),
    "Kutta's third-order": ([[0, 0, 0], [0.5, 0, 0], [-1, 2, 0]], [1 / 6, 2 / 3, 1 / 6]),
    "the classical": (
        [[0, 0, 0, 0], [0.5, 0, 0, 0], [0, 0.5, 0, 0], [0, 0, 1, 0]],
        [1 / 6, 1 / 3, 1 / 3, 1 / 6],
    ),
    "explicit Euler's": ([[0]], [1]),
}


@exercise(
    "5.3",
    "every explicit Runge-Kutta method at once",
    tests=5,
    hints=(
        "Keep two lists, the slopes of h and of v found so far. Each row mixes them to go to its look.",
        "Do explicit Euler by hand, then midpoint: which numbers of A and b are used, where, and times what?",
        "For one look, write down three things before you call f: when it is, where, and how fast.",
    ),
)
def step_from_table(step):
    takes(step, "f", "t", "h", "v", "dt", "A", "b")

    def f(t, h, v):
        return t**2 - 2 * h - 0.3 * v * abs(v)

    for title, (rows, weights) in TABLES.items():
        A, b = np.array(rows, dtype=float), np.array(weights, dtype=float)
        for t, h, v, dt in ((1.0, 0.7, -2.0, 0.3), (0.2, -1.0, 3.0, 0.15)):
            arguments = t, h, v, dt, A, b
            mistakes = {
                "time of the start": (
                    _by_table(f, *arguments, timely=False),
                    "What time is it at each look? Yours are all taken at the beginning.",
                ),
                "slope of h is the old v": (
                    _by_table(f, *arguments, moving=False),
                    "Is the slope of h the same at every look?",
                ),
                "dt forgotten inside": (
                    _by_table(f, *arguments, scaled=False),
                    "Check the units on the way to a look: slope times what is a distance?",
                ),
                "last slope only": (
                    _by_table(f, *arguments, all_slopes=False),
                    "Your row uses only the slope of the look before. Which numbers of the row do you skip?",
                ),
                "old v in f": (
                    _by_table(f, *arguments, own=False),
                    "With which velocity do you call f? It should be that of the look.",
                ),
            }
            g = _counted(f)
            got = pair(repeatable(step, g, *arguments))
            compare(got, _by_table(f, *arguments), f"for {title} table", mistakes)
            if g.calls != 2 * len(b):
                raise Wrong(
                    f"Right, but with {g.calls // 2} looks; the table has {len(b)} rows. Keep what a look has found.",
                    "looks twice",
                )
        yield
    A, b = (np.array(part, dtype=float) for part in TABLES["Kutta's third-order"])
    h, v = np.array([0.5, 1.0]), np.array([-1.0, 2.0])
    got = repeatable(step, f, 0.5, h, v, 0.2, A, b)
    compare(array(got, (2, 2), "the result"), _by_table(f, 0.5, h, v, 0.2, A, b), "for h and v that are arrays")
    yield
