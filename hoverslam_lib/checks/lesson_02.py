"""Exercises of lesson 2: the simplest step."""

import numpy as np

from hoverslam_lib.checks.answers import array, compare, number, repeatable, takes
from hoverslam_lib.checks.feedback import Wrong, exercise
from hoverslam_lib.metrics import observed_order
from hoverslam_lib.oscillator import Oscillator
from hoverslam_lib.trajectory import integrate


@exercise(
    "2.1",
    "energy after n steps",
    tests=4,
    hints=(
        "Each step multiplies the energy by the same number.",
        "The number is in the lesson, for any ω. Which operation repeats a multiplication n times?",
    ),
)
def energy_factor(factor):
    takes(factor, "omega", "dt", "n")
    for omega, dt, n in ((2.0, 0.1, 3), (1.0, 0.1, 50), (3.0, 0.05, 200), (0.5, 0.2, 1)):
        growth = 1 + omega**2 * dt**2
        mistakes = {
            "dt not squared": ((1 + omega**2 * dt) ** n, "Nearly: look again at the power of dt in the law."),
            "omega not squared": ((1 + omega * dt**2) ** n, "Nearly: look again at the power of ω in the law."),
            "amplitude": (growth ** (n / 2), "That is by how much the swing grows. Energy goes with its square."),
            "added up": (1 + n * omega**2 * dt**2, "You add n times. Each step multiplies what the last one left."),
            "one step": (growth, "That is the factor of one step. What do n of them make?"),
            "one step too few": (growth ** (n - 1), "Count the steps once more: is there one missing?"),
            "growth alone": (growth**n - 1, "That is what is added. The factor is what all of it is multiplied by."),
            "per cent": (100 * growth**n, "A factor, please: 2 if the energy doubles, not 200."),
        }
        got = number(repeatable(factor, omega, dt, n))
        compare(got, growth**n, f"for ω = {omega:g} rad/s, dt = {dt:g} s, n = {n}", mistakes)
        yield


def _run(x, v, dt, n, *, new_x=False, new_v=False, sign=1, samples=None):
    """Positions of explicit Euler on the spring, or what its usual slips make of them."""
    xs = [x]
    for _ in range(n):
        a = -sign * x
        x_new = x + dt * v
        if new_x:
            a = -sign * x_new
        v_new = v + dt * a
        if new_v:
            x_new = x + dt * v_new
        x, v = x_new, v_new
        xs.append(x)
    return np.array(xs)[samples or slice(None)]


@exercise(
    "2.2",
    "two bugs in one loop",
    tests=4,
    hints=(
        "Do two steps by hand, from x = 3 and v = 0, and hold the list against them.",
        "Take the lines of the loop one by one: which x and which v does each of them use, the old or the new?",
    ),
)
def mended_run(run):
    takes(run, "x", "v", "dt", "n")
    for x, v, dt, n in ((3.0, -1.0, 0.1, 3), (3.0, 0.0, 0.1, 2), (1.0, -2.0, 0.2, 7), (0.5, 1.0, 0.05, 40)):
        got = repeatable(run, x, v, dt, n)
        if n > 1 and np.ndim(got) == 1 and len(got) == 2:
            raise Wrong("The list ends after one step: where does the `return` stand?", "return in the loop")
        length = len(got) if hasattr(got, "__len__") else None
        for samples, mistake, hint in (
            (slice(None, -1), "one step short", "The list ends one step too early: n steps make n + 1 samples."),
            (slice(1, None), "start is missing", "The list lacks the start: n steps make n + 1 samples."),
        ):
            if length == n and np.allclose(array(got, (n,)), _run(x, v, dt, n, samples=samples)):
                raise Wrong(hint, mistake)
        mistakes = {
            "push has the wrong sign": (
                _run(x, v, dt, n, sign=-1),
                "Your spring pushes the weight away. Which way does it pull?",
            ),
            "new x in the push": (
                _run(x, v, dt, n, new_x=True),
                "Your push is taken at the new x. Which x is explicit?",
            ),
            "new v in the move": (_run(x, v, dt, n, new_v=True), "You move with the new velocity: that is lesson 3."),
        }
        compare(array(got, (n + 1,), "the list"), _run(x, v, dt, n), f"for n = {n} steps from x = {x:g} m", mistakes)
        yield


@exercise(
    "2.3",
    "a better answer from two poor ones",
    tests=5,
    hints=(
        "Write the supposition down twice, for the coarse answer and for the fine one: two equations, two unknowns.",
        "With E for the exact answer: coarse = E + C·dt^p, and fine = E + C·(dt/2)^p. Which combination has no C?",
    ),
)
def extrapolated(combine):
    takes(combine, "coarse", "fine", "order")
    for coarse, fine, p in ((1.0, 2.5, 1), (5.0, 4.0, 3), (10.0, 10.5, 4)):
        right = (2**p * fine - coarse) / (2**p - 1)
        mistakes = {
            "swapped": ((2**p * coarse - fine) / (2**p - 1), "You trust the coarse answer more than the fine one."),
            "not divided": (
                2**p * fine - coarse,
                "Two equal answers must be left alone. Are yours, for 1, 1 and order 2?",
            ),
            "p for 2^p": (
                (p * fine - coarse) / (p - 1) if p > 1 else np.nan,
                "Halving dt divides the error by 2^p, not by p.",
            ),
            "mean": ((coarse + fine) / 2, "The mean lies between the two. The exact answer lies beyond the fine one."),
            "order 1 always": (2 * fine - coarse, "That is right for order 1. Where does the order come in?"),
        }
        got = number(repeatable(combine, coarse, fine, p))
        compare(got, right, f"for {coarse:g}, {fine:g} and order {p}", mistakes)
        yield
    both = repeatable(combine, np.array([1.0, 10.0]), np.array([2.0, 10.5]), 1)
    compare(array(both, (2,)), [3.0, 11.0], "for arrays")
    yield
    spring, sizes, errors = Oscillator(), np.array([0.1, 0.05, 0.025]), []
    for dt in sizes:
        ends = [
            integrate(spring.acceleration, 3.0, 0.0, dt=step, t_end=2.0, method="explicit_euler").h[-1]
            for step in (dt, dt / 2)
        ]
        errors.append(abs(number(combine(*ends, 1)) - spring.exact(2.0)[0]))
    compare(round(observed_order(sizes, errors)), 2, "on explicit Euler, whose order it should raise")
    yield
