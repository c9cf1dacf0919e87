"""Exercises of lesson 1: how wrong is a computed answer?"""

import numpy as np

from hoverslam_lib.checks.answers import array, compare, number, repeatable, takes
from hoverslam_lib.checks.feedback import Wrong, exercise
from hoverslam_lib.metrics import mape, nmae
from hoverslam_lib.oscillator import Oscillator
from hoverslam_lib.trajectory import integrate


def _steps(stiffness, x, v, dt, n, *, method="new v"):
    """State after n steps on a spring with a weight of 1 kg, by the recipe asked for or by its usual slips."""
    start = x
    for _ in range(n):
        if method == "old v":
            x, v = x + dt * v, v - dt * stiffness * x
        elif method == "move first":
            x = x + dt * v
            v = v - dt * stiffness * x
        else:
            v = v - dt * stiffness * (start if method == "old force" else x)
            x = x + dt * v
    return np.array([x, v])


@exercise(
    "1.1",
    "two steps by hand",
    tests=2,
    hints=(
        "Look at the acceleration of each step: which force, and which mass does it have to move?",
        "Write four lines, two a step: first the new velocity, then the new position. Each uses the line before it.",
        "Look at where each step begins: the second has a new acceleration, at the place where the first one ended.",
    ),
)
def two_steps_by_hand(x, v):
    got = np.array([number(x, "my_x"), number(v, "my_v")])
    start = (2.0, 1.0, 0.1)
    right = _steps(3.0, *start, 2)
    mistakes = {
        "old velocity": (
            _steps(3.0, *start, 2, method="old v"),
            "These are two steps of explicit Euler. With which velocity does the other recipe move the weight?",
        ),
        "move first": (
            _steps(3.0, *start, 2, method="move first"),
            "You move first, and push at the new place. Which of the two comes first in this recipe?",
        ),
        "force of the start": (
            _steps(3.0, *start, 2, method="old force"),
            "Both your steps have the same acceleration. Where is the weight when the second one begins?",
        ),
        "mass forgotten": (_steps(6.0, *start, 2), "Your spring pulls right. How heavy is what it has to pull?"),
        "other spring": (_steps(1.0, *start, 2), "That is the spring of the lesson. What are k and m here?"),
        "m over k": (_steps(1 / 3, *start, 2), "Does a stiffer spring pull more or less? And yours?"),
        "root of k over m": (
            _steps(np.sqrt(3), *start, 2),
            "The root of k/m is for the cosine. What stands in the equation for the acceleration?",
        ),
        "spring pushes": (_steps(-3.0, *start, 2), "Your spring pushes outward. Which sign has its force at x = 2 m?"),
        "one step": (_steps(3.0, *start, 1), "The first step is right. Now take one more from there."),
        "three steps": (_steps(3.0, *start, 3), "That is one step too many."),
        "swapped": (right[::-1], "Both numbers are right, in the wrong places: which one is the position?"),
        "sign lost": (right * (1, -1), "Both sizes are right. Which way does the weight move in the second step?"),
    }
    if 1e-4 < np.max(np.abs(got - right)) < 0.0055:
        raise Wrong("Very near, but four decimals are asked: round only what you hand in.")
    if not np.isclose(got[1], right[1], rtol=0, atol=1e-4):
        compare(got, right, "for the velocity", mistakes, rtol=0, atol=1e-4)
    yield
    if np.isclose(got[0], right[0] - start[0], rtol=0, atol=1e-4):
        raise Wrong("That is how far it is from where it started. Where is x = 0 on a spring?", "from the start")
    if not np.isclose(got[0], right[0], rtol=0, atol=1e-4):
        raise Wrong("The velocity is right. From which place, and with which velocity, does the last move go?")
    yield


def _friends(exact, computed, *, cancels=False, short=False, signed=False):
    """NMAE, with any of the friend's three bugs left in."""
    total = abs(np.sum(exact - computed)) if cancels else np.sum(np.abs(exact - computed))
    count = len(exact) - 1 if short else len(exact)
    largest = np.max(exact) if signed else np.max(np.abs(exact))
    return total / count / largest if count else np.nan


@exercise(
    "1.2",
    "three bugs in one measure",
    tests=4,
    hints=(
        "Hold the function against the formula of the NMAE, sign by sign: each | | there, and what n counts.",
        "Try it by hand: exact values 1 and -2, computed 2 and -3. What should come out, and what does?",
        "Take the formula apart: the error of one sample, the number of samples, the divisor. Hold each against yours.",
    ),
)
def mended_nmae(function):
    takes(function, "exact", "computed")
    if function is nmae or "nmae" in getattr(getattr(function, "__code__", None), "co_names", ()):
        raise Wrong("Your answer asks the library's nmae. Write it out: the bugs are what this is about.")
    spring = Oscillator()
    run = integrate(spring.acceleration, 3.0, 0.0, dt=0.3, t_end=6.0, method="explicit_euler")
    for exact, computed, where in (
        (np.array([2.2, 2.9, -4.1, 1.3]), np.array([1.8, 3.8, -4.4, 1.95]), "for four samples"),
        (np.array([-3.0, -1.0, -0.5, -5.0]), np.array([-3.5, -1.2, -0.2, -4.0]), "for four negative exact values"),
        (np.array([-2.0]), np.array([-1.0]), "for a single sample, which is a sample too"),
        (spring.exact(run.t)[0], run.h, "for a run of explicit Euler"),
    ):
        right = nmae(exact, computed)
        got = number(repeatable(function, exact, computed))
        left = [
            bugs
            for bugs in np.ndindex(2, 2, 2)
            if sum(bugs) > 1 and np.isclose(got, _bugs(exact, computed, bugs), rtol=1e-9)
        ]
        if left and not np.isclose(got, right, rtol=1e-9):
            if sum(left[0]) == 3:
                raise Wrong("All three bugs are still in it.", "nothing mended")
            raise Wrong("One bug is mended, and two are left.", "two bugs left")
        mistakes = {
            "signs cancel": (
                _bugs(exact, computed, (1, 0, 0)),
                "What does it say of one error of +1 m and one of -1 m?",
            ),
            "steps for samples": (_bugs(exact, computed, (0, 1, 0)), "A mean of how many numbers is it?"),
            "one too many": (right * len(exact) / (len(exact) + 1), "A mean of how many numbers is it?"),
            "not divided by n": (right * len(exact), "You add the errors up. What makes a mean of their sum?"),
            "largest with its sign": (
                _bugs(exact, computed, (0, 0, 1)),
                "How large is the amplitude of the exact values 1, -4, 2?",
            ),
            "signed": (np.mean(exact - computed) / np.max(np.abs(exact)), "Can a mean error be less than nothing?"),
            "MAPE": (mape(exact, computed), "You divide each error by its own exact value. That is the MAPE."),
            "largest error": (
                np.max(np.abs(exact - computed)) / np.max(np.abs(exact)),
                "That is the largest error. Asked is the mean one.",
            ),
            "amplitude of the computed": (
                np.mean(np.abs(exact - computed)) / np.max(np.abs(computed)),
                "Your yardstick comes from the computed values. A bad run would bring its own.",
            ),
            "start for amplitude": (
                np.mean(np.abs(exact - computed)) / np.abs(exact[0]),
                "You measure by the first exact value. Is it the largest in size?",
            ),
            "last sample only": (
                np.abs(exact - computed)[-1] / len(exact) / np.max(np.abs(exact)),
                "When the loop is over, what is left of the first sample in your sum?",
            ),
            "per cent": (100 * right, "Asked is a fraction, not per cent."),
            "not scaled": (
                np.mean(np.abs(exact - computed)),
                "That is the mean error in metres. What is it measured by?",
            ),
        }
        compare(got, right, where, mistakes)
        yield


def _bugs(exact, computed, bugs):
    return _friends(exact, computed, cancels=bugs[0], short=bugs[1], signed=bugs[2])


@exercise(
    "1.3",
    "two measures disagree",
    tests=4,
    hints=(
        "Where does an error of 1 mm weigh more by the MAPE than by the NMAE?",
        "Two samples are enough, one with a large exact value and one with a small one. Let each method err in one.",
        "Suppose that P errs by p at one sample only, and Q by q at another. Write down both measures for both. What "
        "may q/p be?",
    ),
)
def measures_disagree(exact, p, q):
    count = _count(exact)
    if not 2 <= count <= 10:
        raise Wrong("The exact values should be a list of 2 to 10 numbers.")
    for name, values in (("my_p", p), ("my_q", q)):
        if _count(values) != count:
            raise Wrong(f"Every sample needs its result: is {name} a list of {count} numbers, as the exact values are?")
    exact = array(exact, (count,), "my_exact")
    p, q = array(p, (count,), "my_p"), array(q, (count,), "my_q")
    yield
    size = np.abs(exact)
    if (size == 0).any():
        raise Wrong("One of the exact values is 0. What is eq. 4.3 there?", "exact value of 0")
    if (size < 0.01 * (1 - 1e-9)).any() or (size > 3 * (1 + 1e-9)).any():
        raise Wrong(
            f"Exact values should be from 0.01 m to 3 m in size; yours go from {size.min():g} m to {size.max():g} m."
        )
    yield
    if (p == exact).all() or (q == exact).all():
        raise Wrong("A method without any error is the best by every measure: let both be wrong.", "perfect method")
    if np.ptp(size) < 1e-12:
        raise Wrong(
            "All your exact values are equally large. Then by what does each of the measures divide?", "equal values"
        )
    by_mape, by_nmae = mape(exact, q) / mape(exact, p), nmae(exact, p) / nmae(exact, q)
    if by_mape <= 0.1 * (1 + 1e-9) and by_nmae <= 0.1 * (1 + 1e-9):
        raise Wrong("The two do disagree, by enough. But which method should the MAPE like?", "wrong way round")
    if _apart(exact, exact + p, exact + q):
        raise Wrong(
            "Are these lists the results, or their errors? Asked is what P and Q computed.", "errors for results"
        )
    said = (
        f"By the MAPE, the error of Q is {by_mape:.3g} times that of P; by the NMAE, that of P is {by_nmae:.3g} times"
    )
    if by_mape < 10 * (1 - 1e-9):
        raise Wrong(f"{said} that of Q. The first is still below 10.", nudge=True)
    yield
    if by_nmae < 10 * (1 - 1e-9):
        raise Wrong(f"{said} that of Q. The second is still below 10.", nudge=True)
    yield


def _apart(exact, p, q):
    """Whether Q is ten times worse than P by the MAPE, and P than Q by the NMAE."""
    enough = 10 * (1 - 1e-9)
    return mape(exact, q) >= enough * mape(exact, p) and nmae(exact, p) >= enough * nmae(exact, q)


def _count(values):
    """How many entries a list has; 0 if it is none."""
    try:
        return 0 if isinstance(values, str) else len(values)
    except TypeError:
        return 0
