"""One-step methods for ḧ = f(t, h, ḣ), and the table `METHODS`.

Every method is a function ``step(f, t, h, v, dt) -> (h, v)``: the height [m] and the velocity [m/s] one step of dt [s]
later, as in the paper's eqs. 2.1-2.12. h and v are floats, or arrays of the same shape: then f returns an array too.
"""

import math
from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from hoverslam_lib import _dop853

MAX_ITERATIONS = 50


def explicit_euler(f, t, h, v, dt):
    """Explicit (forward) Euler, order 1: both updates use the old state. Eq. 2.6."""
    return h + dt * v, v + dt * f(t, h, v)


def symplectic_euler(f, t, h, v, dt):
    """Symplectic (semi-implicit) Euler, order 1: the height is updated with the new velocity. Eq. 2.7."""
    v_new = v + dt * f(t, h, v)
    return h + dt * v_new, v_new


def implicit_euler(f, t, h, v, dt):
    """Implicit (backward) Euler, order 1: both updates use the new state. Eqs. 2.8-2.9, for any f.

    Substituting h_new = h + dt·v_new leaves one unknown, v_new. Newton's method solves
    v_new - v - dt·f(t + dt, h + dt·v_new, v_new) = 0, with the slope from a small difference. Arrays are solved
    element by element.

    Raises
    ------
    ArithmeticError
        If Newton's method does not converge.
    """

    def residual(v_new):
        return v_new - v - dt * f(t + dt, h + dt * v_new, v_new)

    v_new = v + dt * f(t, h, v)
    before = math.inf
    for _ in range(MAX_ITERATIONS):
        r = residual(v_new)
        nudge = 1e-6 * (1 + abs(v_new))
        slope = (residual(v_new + nudge) - r) / nudge
        if np.any(slope == 0):
            break
        correction = r / slope
        v_new = v_new - correction
        size = abs(correction)
        if np.all(_settled(size, before, h, v, v_new, dt)):
            return h + dt * v_new, v_new
        before = size
    raise _not_converged("implicit_euler", t, dt)


def rk4(f, t, h, v, dt):
    """The classical Runge-Kutta method, order 4. Eqs. 2.11-2.12."""
    half = dt / 2
    k1h, k1v = v, f(t, h, v)
    k2h = v + half * k1v
    k2v = f(t + half, h + half * k1h, k2h)
    k3h = v + half * k2v
    k3v = f(t + half, h + half * k2h, k3h)
    k4h = v + dt * k3v
    k4v = f(t + dt, h + dt * k3h, k4h)
    return (
        h + dt / 6 * (k1h + 2 * k2h + 2 * k3h + k4h),
        v + dt / 6 * (k1v + 2 * k2v + 2 * k3v + k4v),
    )


def rkn4(f, t, h, v, dt):
    """The `Runge_Kutta` of the paper's Listing 4: a five-stage Nyström method on Fehlberg's nodes, order 4.

    The velocity weights are those of the fourth-order formula in RKF4(5). Terms are added in the listing's order, so
    that its digits come out.
    """
    f0 = f(t, h, v)
    f1 = f(t + 0.25 * dt, h + v * 0.25 * dt + dt * dt * (1 / 32 * f0), v + dt * (0.25 * f0))
    f2 = f(
        t + 0.375 * dt,
        h + v * 0.375 * dt + dt * dt * (9 / 256 * f0 + 9 / 256 * f1),
        v + dt * (3 / 32 * f0 + 9 / 32 * f1),
    )
    f3 = f(
        t + 12 / 13 * dt,
        h + v * (12 / 13) * dt + dt * dt * (27342 / 142805 * f0 + -49266 / 142805 * f1 + 82764 / 142805 * f2),
        v + dt * (1932 / 2197 * f0 + -7200 / 2197 * f1 + 7296 / 2197 * f2),
    )
    f4 = f(
        t + 1.0 * dt,
        h + v * 1.0 * dt + dt * dt * (5 / 18 * f0 + -2 / 3 * f1 + 8 / 9 * f2),
        v + dt * (439 / 216 * f0 + -8.0 * f1 + 3680 / 513 * f2 + -845 / 4104 * f3),
    )
    weighted_h = f0 * (253 / 2160) + f2 * (4352 / 12825) + f3 * (2197 / 41040) + f4 * -0.01
    weighted_v = f0 * (25 / 216) + f2 * (1408 / 2565) + f3 * (2197 / 4104) + f4 * -0.2
    return h + dt * v + dt * dt * weighted_h, v + dt * weighted_v


def gauss4(f, t, h, v, dt):
    """The two-stage Gauss-Legendre method, an implicit Runge-Kutta method of order 4 (Hairer et al. I, section II.7).

    The unknowns are the accelerations a1 and a2 at the two Gauss points. Newton's method solves for both, with slopes
    from small differences and a 2×2 system. Arrays are solved element by element.

    Raises
    ------
    ArithmeticError
        If Newton's method does not converge.
    """
    r = math.sqrt(3) / 6
    t1, t2 = t + (0.5 - r) * dt, t + (0.5 + r) * dt
    w12, w21 = 0.25 - r, 0.25 + r  # the matrix of the method is ((1/4, w12), (w21, 1/4))
    q11, q12, q21, q22 = 1 / 16 + w12 * w21, w12 / 2, w21 / 2, w21 * w12 + 1 / 16  # and its square

    a1 = a2 = f(t, h, v)
    before = math.inf
    for _ in range(MAX_ITERATIONS):
        h1 = h + (0.5 - r) * dt * v + dt * dt * (q11 * a1 + q12 * a2)
        h2 = h + (0.5 + r) * dt * v + dt * dt * (q21 * a1 + q22 * a2)
        v1 = v + dt * (a1 / 4 + w12 * a2)
        v2 = v + dt * (w21 * a1 + a2 / 4)
        f1, f1_h, f1_v = _slopes(f, t1, h1, v1)
        f2, f2_h, f2_v = _slopes(f, t2, h2, v2)
        # Newton: (identity - d(f1, f2)/d(a1, a2)) · correction = (f1 - a1, f2 - a2)
        m11 = 1 - dt * (dt * q11 * f1_h + f1_v / 4)
        m12 = -dt * (dt * q12 * f1_h + w12 * f1_v)
        m21 = -dt * (dt * q21 * f2_h + w21 * f2_v)
        m22 = 1 - dt * (dt * q22 * f2_h + f2_v / 4)
        r1, r2 = f1 - a1, f2 - a2
        determinant = m11 * m22 - m12 * m21
        if np.any(determinant == 0):
            break
        c1 = (m22 * r1 - m12 * r2) / determinant
        c2 = (m11 * r2 - m21 * r1) / determinant
        a1, a2 = a1 + c1, a2 + c2
        size = dt * (abs(c1) + abs(c2))
        if np.all(_settled(size, before, h, v, v1, dt)):
            # h and v from the accelerations alone: the weights are 1/2, those for h are (1/2 - c)·w
            return (
                h + dt * v + dt * dt / 2 * ((0.5 + r) * a1 + (0.5 - r) * a2),
                v + dt / 2 * (a1 + a2),
            )
        before = size
    raise _not_converged("gauss4", t, dt)


def dop8(f, t, h, v, dt):
    """The eighth-order formula of Dormand and Prince, twelve stages, at a fixed step (coefficients: `_dop853`)."""
    dh, dv = _weighted(_dop853.B, *_dop8_stages(f, t, h, v, dt))
    return h + dt * dh, v + dt * dv


def dop8_and_error(f, t, h, v, dt):
    """What `dop8` returns, and estimates of its error in h [m] and in v [m/s] (Hairer et al. I, section II.10).

    They are made of the differences to formulas of order 5 and 3 with the same stages, so as to shrink with dt as the
    error of order 8 does.
    """
    stages = _dop8_stages(f, t, h, v, dt)
    dh, dv = _weighted(_dop853.B, *stages)
    h5, v5 = _weighted(_dop853.E5, *stages)
    h3, v3 = _weighted(_dop853.B3, *stages)
    h_error = dt * h5 * h5 / ((h5**2 + (0.1 * (dh - h3)) ** 2) ** 0.5 or 1.0)
    v_error = dt * v5 * v5 / ((v5**2 + (0.1 * (dv - v3)) ** 2) ** 0.5 or 1.0)
    return h + dt * dh, v + dt * dv, h_error, v_error


def _dop8_stages(f, t, h, v, dt):
    velocities, accelerations = [], []
    for node, row in _dop853.STAGES:
        dh = dv = 0.0
        for j, a in row:
            dh = dh + a * velocities[j]
            dv = dv + a * accelerations[j]
        v_stage = v + dt * dv
        velocities.append(v_stage)
        accelerations.append(f(t + node * dt, h + dt * dh, v_stage))
    return velocities, accelerations


def _weighted(row, velocities, accelerations):
    dh = dv = 0.0
    for j, a in row:
        dh = dh + a * velocities[j]
        dv = dv + a * accelerations[j]
    return dh, dv


def _slopes(f, t, h, v):
    """f and its partial derivatives by h and v, from small differences."""
    value = f(t, h, v)
    dh, dv = 1e-6 * (1 + abs(h)), 1e-6 * (1 + abs(v))
    return value, (f(t, h + dh, v) - value) / dh, (f(t, h, v + dv) - value) / dv


def _settled(size, before, h, v, v_new, dt):
    """Whether a correction of the velocity is lost in rounding, or will be after one more iteration.

    Where large terms cancel in f, only this shows it: the correction is tiny and has stopped shrinking.
    """
    small = size <= 1e-12 * (abs(v) + abs(v_new)) + 1e-15 * abs(h) / dt
    stalled = (2 * size >= before) & (size <= 1e-12 * (1 + abs(v_new)))
    return small | stalled


def _not_converged(name, t, dt):
    return ArithmeticError(
        f"{name}: Newton's method did not converge in {MAX_ITERATIONS} iterations at t = {t:g} s with dt = {dt:g} s; "
        "use a smaller dt"
    )


@dataclass(frozen=True)
class Method:
    """A row of `METHODS`.

    Attributes
    ----------
    step : callable
        ``step(f, t, h, v, dt) -> (h, v)``.
    order : int
        The order of accuracy that the method claims; the tests measure it.
    title : str
        Its name in prose.
    implicit : bool
        Whether a step solves an equation.
    """

    step: Callable
    order: int
    title: str
    implicit: bool = False


METHODS = {
    "explicit_euler": Method(explicit_euler, 1, "Explicit Euler"),
    "symplectic_euler": Method(symplectic_euler, 1, "Symplectic Euler"),
    "implicit_euler": Method(implicit_euler, 1, "Implicit Euler", implicit=True),
    "rk4": Method(rk4, 4, "Runge–Kutta 4"),
    "rkn4": Method(rkn4, 4, "Runge–Kutta–Nyström (Listing 4)"),
    "gauss4": Method(gauss4, 4, "Gauss–Legendre 4", implicit=True),
    "dop8": Method(dop8, 8, "Dormand–Prince 8"),
}


def step_function(method):
    """The step function of a method: of a key of `METHODS`, or `method` itself if it is a step function already.

    Raises
    ------
    ValueError
        If there is no such method; the message lists those there are.
    """
    if callable(method) and not isinstance(method, type):
        return method
    if isinstance(method, str) and method in METHODS:
        return METHODS[method].step
    raise ValueError(f"there is no method {method!r}; choose from {', '.join(METHODS)}, or pass a step function")
