"""Answers that students give to the exercises of lesson 3, beside those that its tables make."""

import numpy as np


def _area(x, v):
    return abs(np.sum(x * np.roll(v, -1) - np.roll(x, -1) * v)) / 2


def _by_a_square(step, f, x, v, dt, *, side=1e-3, corners=((0, 1, 1, 0), (0, 0, 1, 1)), shifted=True):
    xs, vs = x + side * np.array(corners[0]), v + side * np.array(corners[1])
    new_x, new_v = step(f, 0.0, xs, vs, dt)
    if shifted:
        xs, vs, new_x, new_v = (corners - corners[0] for corners in (xs, vs, new_x, new_v))
    return _area(new_x, new_v) / _area(xs, vs)


def _by_differences(step, f, x, v, dt, d=1e-5):
    def slope(dx, dv):
        ahead, behind = step(f, 0, x + d * dx, v + d * dv, dt), step(f, 0, x - d * dx, v - d * dv, dt)
        return (np.array(ahead) - np.array(behind)) / (2 * d)

    return np.abs(np.linalg.det([slope(1, 0), slope(0, 1)]))


def _verlet(f, t, h, v, dt):
    a = f(t, h, v)
    h_new = h + v * dt + a * dt**2 / 2
    return h_new, v + dt * (a + f(t + dt, h_new, v)) / 2


# exercise: what was answered, and the name of the mistake if it has one
WRONG = {
    "3.1": [
        ((86.1, 365), "proportional to the step"),
        ((258.3, 19.3), "half a second"),
        ((..., 365), "proportional to the step"),
        ((121.6, 258.3), "swapped"),
        ((287, 109), None),
        ((258.3, 125), None),
        ((258.3, float("inf")), None),
        (("258 ms", 121), None),
    ],
    "3.2": [
        (lambda f, t, h, v, dt: _verlet(f, t, h.__iadd__(0.1) if np.ndim(h) else h, v, dt), "changes its arguments"),
        (lambda f, t, h, v, dt: (h + dt * (v + dt / 4 * f(t, h, v)), v + dt / 2 * f(t, h, v)), None),
        (lambda f, t, h, v, dt: _verlet(f, t, h, v, dt)[0], None),
    ],
    "3.3": [
        (lambda *at: 2 * _by_differences(*at), "twice the area"),
        (lambda *at: _by_a_square(*at, side=1.0), None),
        (lambda *at: _by_a_square(*at, side=0.1), None),
        (lambda *at: _by_a_square(*at, side=0.005, shifted=False), None),
        (lambda *at: _by_a_square(*at, corners=((0, 1, 1, 0), (0, 1, 0, 1))), None),
        (lambda *at: _by_a_square(*at, shifted=False), None),
        (lambda *at: _by_a_square(*at, side=1e-14), None),
        (lambda *at: _by_differences(*at, d=1e-8), None),
        (lambda step, f, x, v, dt: 1 + 5 * dt**2, None),
        (lambda step, f, x, v, dt: _by_a_square(step, f, 0.0, 0.0, dt), "at the origin"),
        (lambda step, f, x, v, dt: step(f, 0.0, x, v, dt), None),
    ],
}

RIGHT = {
    "3.1": [(260.2, 120.75), (np.float64(258.0), np.int64(121)), (np.array([262]), 120)],
    "3.2": [
        lambda *at: np.array(_verlet(*at)),
        lambda f, t, x, u, d: (
            x + d * (u + d / 2 * f(t, x, u)),
            u + d / 2 * f(t, x, 0) + d / 2 * f(t + d, x + d * (u + d / 2 * f(t, x, 0)), 0),
        ),
    ],
    "3.3": [_by_differences, lambda *at: [_by_a_square(*at, side=1e-6)], _by_a_square],
}
