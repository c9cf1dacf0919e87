"""Answers that students give to the exercises of lesson 4, beside those that its tables make."""

import numpy as np

from hoverslam_lib import integrators


def _newton(r, u, size=abs, turns=50, near=1e-12, error=ArithmeticError):
    for _ in range(turns):
        nudge = 1e-6 * (1 + abs(u))
        slope = (r(u + nudge) - r(u)) / nudge
        u = u - r(u) / slope
        if size(r(u)) < near:
            return u
    if error:
        raise error("no zero")
    return u


def _returns_the_error(r, u):
    try:
        return _newton(r, u)
    except ArithmeticError as error:
        return error


def _by_secants(r, guess):
    other = guess + 1e-4
    for _ in range(50):
        here, there = r(guess), r(other)
        step = here * (other - guess) / (there - here)
        guess, other = guess - step, guess
        if abs(step) <= 1e-12 * (1 + abs(guess)):
            return np.float64(guess)
    raise ArithmeticError


def _central(r, u):
    for _ in range(50):
        nudge = 1e-5 * (1 + abs(u))
        u = u - r(u) * 2 * nudge / (r(u + nudge) - r(u - nudge))
        if abs(r(u)) < 1e-12:
            return u
    raise ArithmeticError("no zero")


def _solved(f, t, h, v, dt, aloud=True):
    """By the function of the exercise before."""

    def residual(u):
        return u - v - dt * (f(t, h, v) + f(t + dt, h + dt / 2 * (v + u), u)) / 2

    u = _newton(residual, v + dt * f(t, h, v), near=1e-11, error=aloud and ArithmeticError)
    return h + dt / 2 * (v + u), u


def _again_and_again(f, t, h, v, dt, aloud=False):
    u = v
    for _ in range(100):
        old, u = u, v + dt / 2 * (f(t, h, v) + f(t + dt, h + dt / 2 * (v + u), u))
        if aloud and abs(u - old) < 1e-12:
            return h + dt / 2 * (v + u), u
    if aloud:
        raise ArithmeticError("not converged")
    return h + dt / 2 * (v + u), u


def _two_halves(f, t, h, v, dt):
    """Half a step of explicit Euler, and half a step of implicit Euler."""
    h, v = integrators.explicit_euler(f, t, h, v, dt / 2)
    return integrators.implicit_euler(f, t + dt / 2, h, v, dt / 2)


# exercise: what was answered, and the name of the mistake if it has one
WRONG = {
    "4.1": [
        ((1.33, 7), "mean rate"),
        ((0.696, 7), "limit of Runge-Kutta"),
        ((500, 7), None),
        ((0.5, 8), None),
        ((0.5, "seven"), None),
        ((..., 6), "one step short"),
    ],
    "4.2": [
        (lambda r, u: _newton(r, u, turns=2), None),
        (lambda r, u: print(_newton(r, u)), None),
        (lambda r, u: _newton(r, u, error=RuntimeError), None),
        (_returns_the_error, "returns the error"),
        (lambda r, u: u, None),
        (lambda r, u: _newton(r, u, size=lambda x: abs(u)), "never quite zero"),
        (lambda r, u: _newton(r, u, turns=10_000, error=None), "gives up in silence"),
        (lambda r, u: round(_newton(r, u), 4), None),
        (lambda r, u: _newton(r, u, near=1e-6), None),
    ],
    "4.3": [
        (_again_and_again, "answer put in again"),
        (lambda *a: _again_and_again(*a, aloud=True), "answer put in again"),
        (lambda *a: _solved(*a, aloud=False), "gives up in silence"),
        (lambda *a: _solved(*a)[1], None),
        (lambda f, t, h, v, dt: (h + dt * v, v + dt * f(t, h, v)), None),
    ],
}

RIGHT = {
    "4.1": [(np.float64(2 / 4.0), 7.0), ([0.5], np.int64(7))],
    "4.2": [_by_secants, _central, lambda r, u: np.array([_newton(r, u)])],
    "4.3": [_two_halves, lambda *a: np.array(_solved(*a)), lambda *a: list(_solved(*a))],
}
