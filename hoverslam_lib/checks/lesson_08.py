"""Exercises of lesson 8: switches and events."""

from math import log, log2, log10, sqrt

import numpy as np

from hoverslam_lib.checks.answers import compare, number, pair, repeatable, takes
from hoverslam_lib.checks.feedback import Wrong, exercise
from hoverslam_lib.integrators import rk4


@exercise(
    "8.1",
    "the judge as a function",
    tests=5,
    hints=(
        "Take the two changes. For order 4, the first would be sixteen times the second.",
        "The order: which power of 2 is their ratio? The error: the lesson divides a change by a number. Which change?",
    ),
)
def order_and_error(judge):
    takes(judge, "coarse", "middle", "fine")
    whole = "An order that was measured need not be a whole number: return it as it comes."
    for coarse, middle, fine in (
        (-3.0, -3.6, -3.61),
        (1.0, 9.0, 10.0),
        (35.0, 3.0, 2.0),
        (0.0, 5.0, 7.5),
        (13767.7, 13764.5, 13764.3),
    ):
        first, second = abs(middle - coarse), abs(fine - middle)
        ratio = first / second
        orders = {
            "ratio": (ratio, "That is how many times smaller the change gets. And which power of Δt does this?"),
            "natural logarithm": (log(ratio), "The order is a power of 2. Is that the base of your logarithm?"),
            "decimal logarithm": (log10(ratio), "The order is a power of 2. Is that the base of your logarithm?"),
            "upside down": (log2(1 / ratio), "Your order is negative: would smaller steps make the error larger?"),
            "rounded": (np.round(log2(ratio)), whole),
            "rounded down": (np.floor(log2(ratio)), whole),
            "root": (sqrt(ratio), "Test your order on a ratio of 16. Does it say what the lesson says?"),
        }
        errors = {
            "error of the middle run": (first / (ratio - 1), "That is an error, but of which of the three runs?"),
            "change": (second, "That is the change. By what did the lesson divide it?"),
            "divided by the ratio": (second / ratio, "Nearly: look again at what the lesson divides by, for order 4."),
            "order 4 always": (second / 15, "You divide as one does for order 4. Is the order 4 here?"),
            "negative": (-second / (ratio - 1), "The size of your error is right. Its sign was not asked for."),
            "one power too many": (second / (2 * ratio - 1), "Check your divisor with the lesson's, for order 4."),
        }
        order, error = pair(repeatable(judge, coarse, middle, fine), ("order", "error"))
        where = f"given {coarse:g}, {middle:g} and {fine:g}"
        if np.allclose((order, error), (second / (ratio - 1), log2(ratio))) and not np.isclose(order, error):
            raise Wrong("Are your two numbers in the order that was asked for?", "swapped")
        compare(order, log2(ratio), f"for the order, {where}", orders)
        compare(error, second / (ratio - 1), f"for the error, {where}", errors)
        yield


_METHODS = (
    ("Runge–Kutta 4", (0.0, 0.5, 0.5, 1.0), (1 / 6, 2 / 6, 2 / 6, 1 / 6)),
    ("the nodes 0, 1/3, 2/3 with the weights 1/4, 0, 3/4", (0.0, 1 / 3, 2 / 3), (0.25, 0.0, 0.75)),
    (
        "the nodes 0, 1/3, 2/3, 1 with the weights 1/8, 3/8, 3/8, 1/8",
        (0.0, 1 / 3, 2 / 3, 1.0),
        (1 / 8, 3 / 8, 3 / 8, 1 / 8),
    ),
    ("one node, 1/2, with the weight 1", (0.5,), (1.0,)),
)


@exercise(
    "8.2",
    "the tooth of any method",
    tests=6,
    hints=(
        "Which looks see the engine? What do their weights add up to? And what should the engine add?",
        "Take Runge–Kutta 4 and θ = 0.3 by hand: the looks at ½, ½ and 1 see it. Does yours give the lesson's formula?",
    ),
)
def tooth(error):
    takes(error, "theta", "nodes", "weights", "a", "dt")
    for (name, nodes, weights), theta, a, dt in zip(
        _METHODS * 2,
        (0.3, 0.8, 0.45, 0.1, 0.85),
        (130.0, 20.0, -9.0, 50.0, 70.0),
        (0.1, 0.5, 2.0, 0.02, 0.3),
        strict=False,
    ):
        nodes, weights = np.array(nodes), np.array(weights)
        seen, share, first = weights[nodes > theta].sum(), 1 - theta, theta == 0.3
        mistakes = {
            "exact minus computed": (
                a * dt * (share - seen) if first else np.nan,
                "The size is right, the sign is not. What minus what is the error, and for which part of the step?",
            ),
            "sign lost": (
                np.nan if first else a * dt * (share - seen),
                "The size is right. May an error be below 0 as well as above it?",
            ),
            "time before ignition": (a * dt * (seen - theta), "For which part of the step does the engine push?"),
            "looks that miss it": (a * dt * (1 - seen - share), "Which looks see the engine: before θ, or after it?"),
            "theta as a time": (
                a * (dt * seen - (dt - theta)),
                "θ is a share of the step, as the nodes are. How many seconds of the step are left after it?",
            ),
            "theta as a time for the looks": (
                a * dt * (weights[nodes > theta * dt].sum() - share),
                "Which looks come after ignition? θ and the nodes both count from 0 to 1.",
            ),
            "only what is added": (a * dt * seen, "That is what the method adds. What should the engine have added?"),
            "looks counted": (a * dt * (np.mean(nodes > theta) - share), "Does every look count the same?"),
            "dt missing": (a * (seen - share), "Check the unit: is that a velocity?"),
            "a missing": (dt * (seen - share), "Check the unit: is that a velocity?"),
        }
        got = number(repeatable(error, theta, nodes, weights, a, dt))
        compare(got, a * dt * (seen - share), f"for {name}, θ = {theta:g}, a = {a:g} m/s² and dt = {dt:g} s", mistakes)
        yield
    theta, a, dt = 0.62, 25.0, 0.4
    _, v = rk4(lambda t, h, v: a if t >= theta * dt else 0.0, 0.0, 0.0, 0.0, dt)
    got = number(error(theta, np.array(_METHODS[0][1]), np.array(_METHODS[0][2]), a, dt))
    compare(got, v - a * (1 - theta) * dt, "against a real step of rk4")
    yield


def _roots(h, v, a):
    """Where h + v·s + ½a·s² is 0, in order of time."""
    if a == 0:
        return [-h / v] if v else []
    inside = v**2 - 2 * a * h
    return sorted([(-v - sqrt(inside)) / a, (-v + sqrt(inside)) / a]) if inside >= 0 else []


@exercise(
    "8.3",
    "mend the touchdown",
    tests=6,
    hints=(
        "Sketch h against s for these numbers, and mark on it the s that is asked for.",
        "Three questions: does it ever reach 0? When first? Is that within the step? And a may be 0, too.",
    ),
)
def first_contact(contact):
    takes(contact, "h", "v", "a", "dt")
    for cases in (
        ((5.0, -40.0, 60.0, 0.3), (8.0, -52.1, 181.0, 0.5), (60.0, -52.1, 5.0, 1.0)),
        ((5.24, -52.1, 181.0, 0.5), (5.24, -52.1, 181.0, 0.2)),  # a dip within the step, and half of it
        ((3.0, -20.0, -9.8, 0.5), (2.0, 3.0, -9.8, 2.0), (3.0, -20.0, -9.8, 0.1)),
        ((2.0, -10.0, 0.0, 0.5), (2.0, -10.0, 0.0, 0.1)),
        ((1.0, 20.0, 10.0, 0.5), (2.0, 10.0, 0.0, 0.5), (2.0, 0.0, 0.0, 0.5)),  # never
        ((7.0, -30.0, 60.0, 1.5), (12.0, -30.0, 12.0, 4.0), (50.0, 0.0, -1.6, 9.0)),
    ):
        for h, v, a, dt in cases:
            _one_contact(contact, h, v, a, dt)
        yield


def _one_contact(contact, h, v, a, dt):
    roots = _roots(h, v, a)
    where = f"for h = {h:g} m, v = {v:g} m/s, a = {a:g} m/s² and dt = {dt:g} s"
    right = next((s for s in roots if 0 < s <= dt), None)
    try:
        got = repeatable(contact, h, v, a, dt)
        rootless = isinstance(got, complex) or (isinstance(got, float) and np.isnan(got))
    except (TypeError, ValueError) as error:  # a comparison with a complex number, or math.sqrt
        rootless = any(word in str(error) for word in ("complex", "math domain", "nonnegative"))
        if not rootless:
            raise
        got = 0j
    if rootless and v**2 < 2 * a * h:
        raise Wrong(f"The number under your root is negative {where}: what does that say about the flight?", "no root")
    if isinstance(got, complex):
        raise Wrong(f"The number under your root is negative {where}: should it be?", nudge=True)
    if right is None:
        if got is None:
            return
        got = number(got)
        if got > dt and np.isclose(got, roots).any():
            raise Wrong(f"It gives {got:.4g} s {where}: is that within the step?", "after the step")
        if got < 0 and np.isclose(got, roots).any():
            raise Wrong(f"It gives {got:.4g} s {where}: has that moment not gone by?", "before the step")
        raise Wrong(f"Within the step the height stays above 0 {where}, and yet it gives {got:.4g} s.", nudge=True)
    if got is None:
        if h + v * dt + a * dt**2 / 2 > 0:
            raise Wrong(f"A crash is missed {where}: what happens between the two samples?", "dip missed")
        if a == 0:
            raise Wrong(f"It gives None {where}: what is left of the equation when a is 0?", "a is 0")
        raise Wrong(f"It gives None {where}, but at the end of that step the height is not above 0.", nudge=True)
    wrong = [s for s in roots if s != right] or [np.nan]
    mistakes = {
        "the wrong root": (
            wrong[0],
            f"At {wrong[0]:.4g} s the height is 0 {where}. Is it 0 before, or is that outside the step?",
        ),
        "negative": (-right, "The moment comes after the beginning of the step: look at your signs."),
        "linear": (dt * h / -(v * dt + a * dt**2 / 2), "That is a straight line between the two samples."),
        "lowest point": (-v / a if a else np.nan, "That is where the velocity is 0. And the height?"),
        "half forgotten": ((_roots(h, v, 2 * a) or [np.nan])[0], "Is the ½ of ½as² in your equation?"),
    }
    try:
        compare(number(got), right, where, mistakes)
    except Wrong as wrong:
        if wrong.mistake is None and np.isclose(number(got), right, rtol=0.01):
            raise Wrong(f"{number(got):.4g} s is near {where}, but not exact: can the equation be solved?") from None
        raise
