"""Answers that students give to the exercises of lesson 5, beside those that its tables make."""

import numpy as np

from hoverslam_lib.integrators import rk4


def _on_pairs(f, t, h, v, dt, weights=(1, 3, 3, 1)):
    """The same on the state as one array."""

    def slopes(t, y):
        return np.array([y[1], f(t, y[0], y[1])])

    y = np.array([h, v])
    k1 = slopes(t, y)
    k2 = slopes(t + dt / 3, y + dt * k1 / 3)
    k3 = slopes(t + 2 / 3 * dt, y - dt * k1 / 3 + dt * k2)
    k4 = slopes(t + dt, y + dt * k1 - dt * k2 + dt * k3)
    return y + dt / 8 * np.tensordot(weights, [k1, k2, k3, k4], 1)


def _table(f, t, h, v, dt, A, b, *, when=True, own=True):
    kh, kv = [], []
    for i in range(len(b)):
        v_i = v + sum(dt * A[i][j] * kv[j] for j in range(i))
        h_i = h + sum(dt * A[i][j] * kh[j] for j in range(i))
        kh.append(v_i)
        kv.append(f(t + sum(A[i]) * dt if when else t, h_i, v_i if own else v))
    return h + dt * sum(b[i] * kh[i] for i in range(len(b))), v + dt * sum(b[i] * kv[i] for i in range(len(b)))


def _table_on_arrays(f, t, h, v, dt, A, b):
    k = np.zeros((len(b), 2, *np.shape(h)))
    for i, c in enumerate(A.sum(axis=1)):
        y = np.array([h, v]) + dt * np.tensordot(A[i], k, 1)
        k[i] = y[1], f(t + dt * c, y[0], y[1])
    return tuple(np.array([h, v]) + dt * np.tensordot(b, k, 1))


# exercise: what was answered, and the name of the mistake if it has one
WRONG = {
    "5.1": [
        ((5000, 18, 28_700), "linear reading"),
        ((-2800, 18, 28_700), None),
        ((2800, 44, 28_700), "same step"),
        ((2800, 60, 28_700), None),
        ((2800, 18, 9_300), "as from 3 to 6 to 9, plus"),
        ((2800, 18, 60_000), None),
        ((2800, 18, None), None),
        ((..., 0.055, ...), "upside down"),
    ],
    "5.2": [
        (lambda *a: _on_pairs(*a, weights=(1, 2, 2, 1)), None),
        (lambda f, t, *a: _on_pairs(lambda s, h, v: f(t, h, v), t, *a), None),
        (lambda f, *a: (f(*a[:3]), _on_pairs(f, *a))[1], "more looks"),
        (lambda f, *a: (f(*a[:3]), f(*a[:3]), _on_pairs(f, *a))[2], None),
        (lambda f, t, h, v, dt: _on_pairs(f, t, h, v.__iadd__(0.1) if np.ndim(v) else v, dt), "changes its arguments"),
    ],
    "5.3": [
        (lambda *a: _table(*a, when=False), "time of the start"),
        (lambda *a: _table(*a, when=False, own=False), None),
        (lambda *a: tuple(map(float, _table(*a))), None),
        (lambda f, t, h, v, dt, A, b: rk4(f, t, h, v, dt), None),
        (lambda *a: _table(*a)[0], None),
    ],
}

RIGHT = {
    "5.1": [(np.int64(3000), 20.0, 30_000), (2500, 12, [27e3])],
    "5.2": [lambda *a: list(_on_pairs(*a))],
    "5.3": [_table_on_arrays, lambda *a: np.array(_table(*a))],
}
