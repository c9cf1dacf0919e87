"""Answers that students give to the exercises of lesson 4."""

import numpy as np

from hoverslam_lib import integrators


def _newton(r, u, sign=-1, size=abs, aloud=True, turns=50):
    for _ in range(turns):
        nudge = 1e-6 * (1 + abs(u))
        slope = (r(u + nudge) - r(u)) / nudge
        u = u + sign * r(u) / slope
        if size(r(u)) < 1e-12:
            return u
    if aloud:
        raise ArithmeticError("no zero")
    return u


def _as_it_is(x):
    return x


def _stops_early(r, u):
    for _ in range(50):
        u = u - r(u) * 1e-6 / (r(u + 1e-6) - r(u))
        if abs(r(u)) < 1e-6:
            return u
    raise ArithmeticError("no zero")


def _central(r, u):
    for _ in range(50):
        nudge = 1e-5 * (1 + abs(u))
        u = u - r(u) * 2 * nudge / (r(u + nudge) - r(u - nudge))
        if abs(r(u)) < 1e-12:
            return u
    raise ArithmeticError("no zero")


def _raises_always(r, u):
    for _ in range(50):
        slope = (r(u + 1e-6) - r(u)) / 1e-6
        u = u - r(u) / slope
        if abs(u) < 1e-12:
            return u
    raise ArithmeticError("no zero")


def _raises_another(r, u):
    try:
        return _newton(r, u)
    except ArithmeticError:
        raise RuntimeError("no zero") from None


def _returns_the_error(r, u):
    try:
        return _newton(r, u)
    except ArithmeticError as error:
        return error


def _by_the_correction(r, guess):
    for _ in range(50):
        here = r(guess)
        step = here * 1e-7 / (r(guess + 1e-7) - here)
        guess -= step
        if abs(step) <= 1e-12 * (1 + abs(guess)):
            return np.float64(guess)
    raise ArithmeticError


def _by_secants(r, u):
    other = u + 1e-4
    for _ in range(50):
        here, there = r(u), r(other)
        if abs(here) < 1e-13:
            return u
        u, other = u - here * (other - u) / (there - here), u
    raise ArithmeticError("fifty turns")


def _step(f, t, h, v, dt, *, place, slope, arrive, aloud=True):
    """A step solved by Newton's method, with the three lines that may be wrong."""
    f0 = f(t, h, v)

    def residual(u):
        return u - v - dt * slope(f0, lambda s, x: f(t + s * dt, x, u), place(h, v, u, dt))

    u = v + dt * f0
    for _ in range(50):
        nudge = 1e-6 * (1 + abs(u))
        correction = residual(u) * nudge / (residual(u + nudge) - residual(u))
        u -= correction
        if abs(correction) < 1e-12 * (1 + abs(u)):
            break
    else:
        if aloud:
            raise ArithmeticError("not converged")
    return arrive(h, v, u, dt), u


def _mean(h, v, u, dt):
    return h + dt / 2 * (v + u)


def _both(f0, at, place):
    return (f0 + at(1, place)) / 2


def _solved(*args, place=_mean, slope=_both, arrive=_mean, aloud=True):
    return _step(*args, place=place, slope=slope, arrive=arrive, aloud=aloud)


def _heun_mean(f, t, h, v, dt):
    guess = v + dt * f(t, h, v)
    return h + dt * (v + guess) / 2, v + dt / 2 * (f(t, h, v) + f(t + dt, h + dt / 2 * (v + guess), guess))


def _again_and_again(f, t, h, v, dt):
    u = v
    for _ in range(100):
        u = v + dt / 2 * (f(t, h, v) + f(t + dt, h + dt / 2 * (v + u), u))
    return h + dt / 2 * (v + u), u


def _again_and_again_aloud(f, t, h, v, dt):
    u = v + dt * f(t, h, v)
    for _ in range(50):
        old, u = u, v + dt / 2 * (f(t, h, v) + f(t + dt, h + dt / 2 * (v + u), u))
        if abs(u - old) < 1e-12:
            return h + dt / 2 * (v + u), u
    raise ArithmeticError("not converged")


def _midpoint(f, t, h, v, dt):
    from scipy.optimize import fsolve

    (u,) = fsolve(lambda u: u - v - dt * f(t + dt / 2, h + dt * (v + u[0]) / 4, (v + u[0]) / 2), v, xtol=1e-13)
    return h + dt * (v + u) / 2, u


def _two_halves(f, t, h, v, dt):
    """Half a step of explicit Euler, and half a step of implicit Euler."""
    h, v = integrators.explicit_euler(f, t, h, v, dt / 2)
    return integrators.implicit_euler(f, t + dt / 2, h, v, dt / 2)


def _by_scipy(f, t, h, v, dt):
    """Both equations at once, by someone else's solver."""
    from scipy.optimize import root

    def equations(new):
        x, u = new
        return [x - h - dt / 2 * (v + u), u - v - dt / 2 * (f(t, h, v) + f(t + dt, x, u))]

    found = root(equations, [h, v], tol=1e-13)
    if max(map(abs, equations(found.x))) > 1e-9:
        raise ArithmeticError("no solution")
    return found.x


# exercise: what was answered, and the name of the mistake if it has one
WRONG = {
    "4.1": [
        ((1.33, 7), "mean rate"),
        ((0.696, 7), "limit of Runge-Kutta"),
        ((1.0, 7), None),
        ((2000, 7), None),
        ((500, 7), None),
        ((0.5, 8), None),
        ((0.5, "seven"), None),
        ((..., 6), "one step short"),
    ],
    "4.2": [
        (lambda r, u: _newton(r, u, +1, _as_it_is, aloud=False), "turned away"),
        (lambda r, u: _newton(r, u, -1, _as_it_is), "a negative residual is small"),
        (lambda r, u: _newton(r, u, turns=2), None),
        (lambda r, u: print(_newton(r, u)), None),
        (_raises_another, None),
        (_returns_the_error, "returns the error"),
        (lambda r, u: u, None),
        (lambda r, u: (r(u), None)[1], None),
        (_raises_always, None),
        (lambda r, u: _newton(r, u, turns=10_000, aloud=False), "gives up in silence"),
        (lambda r, u: round(_newton(r, u), 4), None),
        (_stops_early, None),
    ],
    "4.3": [
        (_midpoint, "mean place"),
        (_heun_mean, "not solved, nor the height"),
        (_again_and_again, "answer put in again"),
        (_again_and_again_aloud, "answer put in again"),
        (lambda *a: _solved(*a, aloud=False), "gives up in silence"),
        (lambda *a: _solved(*a)[1], None),
        (lambda *a: _solved(*a)[::-1], "swapped"),
        (lambda f, t, h, v, dt: (h + dt * v, v + dt * f(t, h, v)), None),
    ],
}

RIGHT = {
    "4.1": [(0.5, 7), (np.float64(2 / 4.0), 7.0), ([0.5], np.int64(7))],
    "4.2": [_newton, _by_the_correction, _by_secants, _central, lambda r, u: np.array([_newton(r, u)])],
    "4.3": [_solved, _two_halves, _by_scipy, lambda *a: np.array(_solved(*a)), lambda *a: list(_solved(*a))],
}
