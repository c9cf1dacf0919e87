"""Beside the page of lesson 4: what Newton's method does on its way, and what a step does where it cannot be solved."""

import math

import numpy as np

from hoverslam_lib.checks.answers import number, repeatable, takes
from hoverslam_lib.checks.feedback import Wrong


def without_solution(solve, *arguments):
    """What `solve` does where there is no solution, in words."""
    try:
        got = solve(*arguments)
    except Exception as error:
        return "an ArithmeticError" if isinstance(error, ArithmeticError) else f"a {type(error).__name__}"
    if isinstance(got, Exception) or (isinstance(got, type) and issubclass(got, Exception)):
        return "an error that is handed back"
    return "no word"


def mended_newton(newton):
    """Judge Newton's method by where it looks."""
    takes(newton, "r", "u")
    v, dt, c = -50.0, 0.02, 0.02
    at_rest = (1 - math.sqrt(1 - 4 * c * dt * (v - 9.81 * dt))) / (2 * c * dt)
    for r, start, zero, there, where in (
        (lambda u: 7 - u**2, 5.0, math.sqrt(7), 3.2, "7 - u² from 5"),
        (lambda u: 30 - u**3, 4.0, 30 ** (1 / 3), 4 - 34 / 48, "30 - u³ from 4"),
        (lambda u: u - v - dt * (-9.81 - c * abs(u) * u), v, at_rest, math.nan, "a step of the ball"),
    ):
        seen = []

        def watched(u, r=r, seen=seen):
            seen.append(float(u))
            return r(u)

        try:
            got = repeatable(lambda r=watched, start=start: newton(r, start))
        except ArithmeticError:
            got = None
        _first_turn(seen, start, there, where, got)
        if got is None and any(math.isclose(u, zero, rel_tol=1e-4) for u in seen):
            what = f"For {where}, it comes to the zero and does not stop there, or does not return it."
            raise Wrong(what, nudge=True)
        if got is None:
            raise Wrong(f"For {where}, there is a zero, and it does not find it.", nudge=True)
        if math.isclose(number(got), there, rel_tol=1e-3):
            raise Wrong(mistake="a negative residual is small")
        if not math.isclose(number(got), zero, rel_tol=1e-3):
            raise Wrong(f"Not right for {where}: it gives {number(got):.6g}.", nudge=True)
        if not math.isclose(number(got), zero, rel_tol=1e-9):
            what = f"For {where}, it comes near the zero, but not to nine digits. When does it stop, and with what?"
            raise Wrong(what)
        yield
    for r in (lambda u: u**2 + 1, lambda u: -1 - u**2):
        does = without_solution(newton, r, 0.7)
        if does == "no word":
            raise Wrong(mistake="gives up in silence")
        if does == "an error that is handed back":
            raise Wrong(mistake="returns the error")
        if does != "an ArithmeticError":
            raise Wrong(f"Where there is no solution it raises {does}, not an ArithmeticError.")
        yield


mended_newton.tests = 5


def _first_turn(seen, start, there, where, got):
    """Raise `Wrong` if the first turn from `start` leads elsewhere than there, or is the only one."""

    def came_by(place):
        return any(math.isclose(u, place, rel_tol=1e-4) for u in seen)

    half, back = (start + there) / 2, 2 * start - there
    if not seen:
        raise Wrong("It never asks r for a value. Is there a `return`, and does the loop run?", nudge=True)
    if came_by(half) and not came_by(there):
        raise Wrong(mistake="half a turn", where=where, place=half)
    if came_by(back) and not came_by(there):
        raise Wrong(mistake="turned away", where=where, place=back)
    if got is None and came_by(there) and all(np.isclose(u, (start, there), rtol=1e-4).any() for u in seen):
        raise Wrong(mistake="raises in the loop", where=where)


def on_the_droplet(step):
    """for f = 1000(cos t - v) at t = 0.5, h = 0.1, v = 0 with dt = 0.1"""
    try:
        got = repeatable(step, lambda t, h, v: 1000 * (math.cos(t) - v), 0.5, 0.1, 0.0, 0.1)
    except ArithmeticError:
        return "no end"
    # the equation is linear: whoever follows a slope is there in one turn, and only putting in again runs away
    return "no end" if np.shape(got) == (2,) and np.max(np.abs(got)) > 1e6 else got
