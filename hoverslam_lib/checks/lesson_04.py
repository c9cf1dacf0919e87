"""Exercises of lesson 4: a step that has to be solved."""

import math

import numpy as np

from hoverslam_lib.checks.answers import compare, number, pair, repeatable, takes
from hoverslam_lib.checks.feedback import Wrong, exercise
from hoverslam_lib.integrators import explicit_euler
from hoverslam_lib.oscillator import Oscillator


@exercise(
    "4.1",
    "three droplets in one wind",
    tests=2,
    hints=(
        "What does one step make of a difference, for explicit Euler, and for implicit Euler?",
        "First answer: one of the droplets sets the limit. Second: each step divides by a number made of λ and Δt.",
    ),
)
def mist(dt_ms, steps):
    slow, middle, fast = 20.0, 500.0, 4000.0
    right, mean = 2000 / fast, (slow + middle + fast) / 3
    mistakes = {
        "slowest droplet": (2000 / slow, "That step is stable for the slowest droplet. And for the other two?"),
        "mean rate": (2000 / mean, "A mean does not help: is this step stable for each of the three?"),
        "in seconds": (right / 1000, "The number is asked in milliseconds."),
        "gone in one step": (
            right / 2,
            "At this step the fastest difference is gone at once. May the step still be longer without making it grow?",
        ),
        "limit of Runge-Kutta": (2785.3 / fast, "That is the limit of another method. Asked is explicit Euler."),
    }
    compare(number(dt_ms, "my_step_ms"), right, "for the longest step", mistakes, rtol=2e-3)
    yield
    left, dt = 1e-3, 0.1
    needed = math.log(1 / left) / math.log(1 + slow * dt)
    mistakes = {
        "exact solution": (
            math.ceil(math.log(1 / left) / (slow * dt)),
            "That is how fast the true difference dies out. What does a step of implicit Euler make of it?",
        ),
        "one step short": (math.ceil(needed) - 1, "After so many steps a little more than a thousandth is left."),
        "not a whole number": (needed, "Steps come in whole numbers."),
        "divided by λΔt": (
            math.ceil(math.log(1 / left) / math.log(slow * dt)),
            "Fewer steps will do. By what exactly does a step of implicit Euler divide the difference?",
        ),
        "added up": (
            math.ceil((1 / left - 1) / (slow * dt)),
            "You add step upon step. Each step divides what the one before it has left.",
        ),
        "fastest droplet": (
            math.ceil(math.log(1 / left) / math.log(1 + fast * dt)),
            "So few would do for the fastest droplet. Asked is the slowest.",
        ),
    }
    compare(number(steps, "my_steps"), math.ceil(needed), "for the number of steps", mistakes, rtol=0, atol=0.02)
    yield


def _no_zero(solve, *arguments):
    """Whether `solve` says aloud that it has found nothing."""
    try:
        got = solve(*arguments)
    except ArithmeticError:
        return
    except Exception as error:
        raise Wrong(f"Where there is no solution it raises {type(error).__name__}, not ArithmeticError.") from None
    if isinstance(got, Exception) or (isinstance(got, type) and issubclass(got, Exception)):
        raise Wrong("It hands the error back like a number. How does Python sound an alarm?", "returns the error")
    raise Wrong("Where there is no solution, it comes back without a word. Who will notice?", "gives up in silence")


@exercise(
    "4.2",
    "three bugs in Newton's method",
    tests=5,
    hints=(
        "Do one turn by hand for r(u) = 7 - u², from u = 5. Where should it go, and would it stop there?",
        "Look at three lines: where the new guess is made, where it decides to stop, and the very last.",
    ),
)
def mended_newton(newton):
    takes(newton, "r", "u")
    ball = -50.0, 0.5, 0.02  # v, dt, c

    def of_the_ball(u):
        v, dt, c = ball
        return u - v - dt * (-9.81 - c * abs(u) * u)

    v, dt, c = ball
    at_rest = (1 - math.sqrt(1 - 4 * c * dt * (v - 9.81 * dt))) / (2 * c * dt)
    cases = (
        (lambda u: 7 - u**2, 5.0, math.sqrt(7), 3.2, 6.8, "7 - u² from 5"),
        (lambda u: 30 - u**3, 4.0, 30 ** (1 / 3), 4 - 34 / 48, 4 + 34 / 48, "30 - u³ from 4"),
        (of_the_ball, v, at_rest, None, None, "a step of the ball"),
    )
    for r, start, zero, there, back, where in cases:
        seen = []

        def watched(u, r=r, seen=seen):
            seen.append(float(u))
            return r(u)

        def tried(r=watched, start=start):
            return newton(r, start)

        def came_by(place, seen=seen):
            return place is not None and any(math.isclose(u, place, rel_tol=1e-4) for u in seen)

        try:
            got = repeatable(tried)
        except ArithmeticError:
            got = None
        half = there and (start + there) / 2
        if came_by(half) and not came_by(there):
            raise Wrong(
                f"For {where}, your first turn goes to {half:.4g}: half as far as the tangent leads. What halves it?",
                "half a turn",
            )
        if came_by(back) and not came_by(there):
            raise Wrong(f"For {where}, your first turn leads away from the zero: to {back:.4g}.", "turned away")
        if got is None and not seen:
            raise Wrong("It never asks r for a value. Is there a `return`, and does the loop run?", nudge=True)
        if got is None and came_by(zero):
            raise Wrong(
                f"For {where}, it comes to the zero and does not stop there, or does not return it.", nudge=True
            )
        if got is None:
            raise Wrong(f"For {where}, there is a zero, and it does not find it.", nudge=True)
        mistakes = {}
        if there is not None:
            mistakes = {
                "a negative residual is small": (
                    there,
                    "It stops after one turn, far from the zero. Which residuals pass the test by which it stops?",
                )
            }
        compare(number(got), zero, f"for {where}", mistakes, rtol=1e-3)
        if not math.isclose(number(got), zero, rel_tol=1e-9):
            raise Wrong(
                f"For {where}, it comes near the zero, but not to nine digits. When does it stop, and with what?"
            )
        yield
    for r in (lambda u: u**2 + 1, lambda u: -1 - u**2):
        _no_zero(newton, r, 0.7)
        yield


def _zero(r, u):
    """Newton's method for the check's own use."""
    for _ in range(60):
        nudge = 1e-6 * (1 + abs(u))
        u = u - r(u) * nudge / (r(u + nudge) - r(u))
    return u


def _trapezoid(f, t, h, v, dt, *, at_end=0.5, moved=0.5, later=1.0, slopes=1.0, speeds=1.0):
    """The step, or what slips make of it: the share of the end in the slope and in the place, and the time there."""

    def place(u):
        return h + speeds * dt * ((1 - moved) * v + moved * u)

    def residual(u):
        mean = (1 - at_end) * f(t, h, v) + at_end * f(t + later * dt, place(u), u)
        return u - v - slopes * dt * mean

    u = _zero(residual, v + dt * f(t, h, v))
    return place(u), u


def _midpoint(f, t, h, v, dt):
    u = _zero(lambda u: u - v - dt * f(t + dt / 2, h + dt * (v + u) / 4, (v + u) / 2), v)
    return h + dt * (v + u) / 2, u


@exercise(
    "4.3",
    "the mean of two slopes",
    tests=5,
    hints=(
        "Put your answer back into the two equations: which one does it not solve?",
        "Two lines of the lesson's implicit_euler know about the end of the step: the residual, and the return.",
    ),
)
def trapezoidal_step(step):
    takes(step, "f", "t", "h", "v", "dt")

    def pulled(t, h, v):
        return 2 + t**2 - 4 * h - 0.5 * abs(v) * v

    def braked(t, h, v):
        return math.sin(3 * t) - h**3 - 2 * v

    summed = "Your new height does not fit its equation: is it made with the mean of the two velocities?"
    for f, where, t, h, v, dt in (
        (pulled, "f = 2 + t² - 4h - ½|v|v", 1.0, 0.8, -2.0, 0.3),
        (braked, "f = sin 3t - h³ - 2v", 0.4, 1.5, 1.0, 0.2),
        (lambda t, h, v: 1000 * (math.cos(t) - v), "f = 1000(cos t - v)", 0.5, 0.1, 0.0, 0.1),
    ):
        where = f"for {where} at t = {t:g}, h = {h:g}, v = {v:g} with dt = {dt:g}"
        right_h, right_v = _trapezoid(f, t, h, v, dt)
        guess = v + dt * f(t, h, v)
        once = v + dt / 2 * (f(t, h, v) + f(t + dt, h + dt / 2 * (v + guess), guess))
        mistakes = {
            "implicit Euler": (_trapezoid(f, t, h, v, dt, at_end=1, moved=1), "That is implicit Euler's step still."),
            "the old return": (
                (h + dt * right_v, right_v),
                "Your new velocity solves its equation. Does your new height solve the other one?",
            ),
            "the old place": (
                _mixed(f, t, h, v, dt),
                "At the end of the step, where does f look? Your residual puts it where implicit Euler would.",
            ),
            "height by the new velocity": (
                _trapezoid(f, t, h, v, dt, moved=1),
                "The mean belongs in both equations. In which one is yours missing?",
            ),
            "time of the start": (_trapezoid(f, t, h, v, dt, later=0), "What time is it at the end of the step?"),
            "not halved": (_trapezoid(f, t, h, v, dt, slopes=2), "Is that the mean of the two slopes, or their sum?"),
            "height not halved": ((h + dt * (v + right_v), right_v), summed),
            "no height halved": (_trapezoid(f, t, h, v, dt, speeds=2), summed),
            "nothing halved": (
                _trapezoid(f, t, h, v, dt, slopes=2, speeds=2),
                "Are these the means, of the slopes and of the velocities, or their sums?",
            ),
            "swapped": ((right_v, right_h), "Are your two numbers in the order that was asked for?"),
            "mean place": (
                _midpoint(f, t, h, v, dt),
                "You take one slope, at a mean place. Asked is the mean of two slopes.",
            ),
            "not solved": (
                (h + dt / 2 * (v + once), once),
                "The new velocity stands on both sides. Is yours on the right the same as yours on the left?",
            ),
            "not solved, nor the height": (
                (h + dt / 2 * (v + guess), once),
                "The new velocity stands on both sides. Is yours on the right the same as yours on the left?",
            ),
            "mean of two steps": (
                np.mean([explicit_euler(f, t, h, v, dt), _trapezoid(f, t, h, v, dt, at_end=1, moved=1)], axis=0),
                "You take the mean of two finished steps. Each has a new velocity of its own; the equations have one.",
            ),
            "Heun": (
                (h + dt / 2 * (v + guess), v + dt / 2 * (f(t, h, v) + f(t + dt, h + dt * v, guess))),
                "That is one guess, put in once. Put your answer back into the two equations: does it solve them?",
            ),
        }
        got = pair(_watched(step, f, t, h, v, dt))
        compare(got, (right_h, right_v), where, mistakes, rtol=1e-8)
        yield
    spring = Oscillator(stiffness=4.0)
    h, v = 3.0, 0.0
    for _ in range(25):
        h, v = pair(step(spring.acceleration, 0.0, h, v, 0.7))
    kept = spring.energy(h, v) / spring.energy(3.0, 0.0)
    compare(kept, 1.0, "for the energy of a spring after 25 steps", rtol=1e-6)
    yield
    _no_zero(step, lambda t, h, v: 1 + v**2, 0.0, 0.0, 0.0, 1.0)
    yield


def _watched(step, f, t, h, v, dt):
    """What a step returns, unless it puts its answer in again and again and runs away."""
    seen = []

    def g(t, h, v):
        seen.append(v)
        return f(t, h, v)

    try:
        got = repeatable(step, g, t, h, v, dt)
        if np.all(np.abs(np.asarray(got, dtype=float)) < 1e6):
            return got
    except (ArithmeticError, TypeError, ValueError):
        got = None
    for u in (v, v + dt * f(t, h, v)):
        came_by = []
        for _ in range(3):
            u = v + dt / 2 * (f(t, h, v) + f(t + dt, h + dt / 2 * (v + u), u))
            came_by.append(any(abs(u - other) <= 1e-9 * abs(u) for other in seen))
        if all(came_by):
            raise Wrong(
                "You put the answer in again and again, and it runs away. What does Newton's method follow instead?",
                "answer put in again",
            )
    return repeatable(step, f, t, h, v, dt)


def _mixed(f, t, h, v, dt):
    """The place of implicit Euler in the residual, and the right height at the end."""
    _, u = _trapezoid(f, t, h, v, dt, moved=1)
    return h + dt / 2 * (v + u), u
