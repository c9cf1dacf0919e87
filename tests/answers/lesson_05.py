"""Answers that students give to the exercises of lesson 5."""

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


def _table(f, t, h, v, dt, A, b, *, when=True, own=True, twice=False):
    kh, kv = [], []
    for i in range(len(b)):
        v_i, h_i, c = v, h, sum(A[i])
        for j in range(i):
            v_i = v_i + dt * A[i][j] * kv[j]
            h_i = h_i + dt * A[i][j] * kh[j]
        kh.append(v_i)
        if twice:
            f(t + c * dt, h_i, v_i)
        kv.append(f(t + c * dt if when else t, h_i, v_i if own else v))
    return h + dt * sum(b[i] * kh[i] for i in range(len(b))), v + dt * sum(b[i] * kv[i] for i in range(len(b)))


def _table_on_arrays(f, t, h, v, dt, A, b):
    places = A.sum(axis=1)
    k = np.zeros((len(b), 2, *np.shape(h)))
    for i, c in enumerate(places):
        y = np.array([h, v]) + dt * np.tensordot(A[i], k, 1)
        k[i] = y[1], f(t + dt * c, y[0], y[1])
    return tuple(np.array([h, v]) + dt * np.tensordot(b, k, 1))


def _zeros(f, t, h, v, dt, A, b):
    kh, kv = np.zeros(len(b)), np.zeros(len(b))
    for i, row in enumerate(A):
        kh[i] = v + dt * np.dot(row, kv)
        kv[i] = f(t + row.sum() * dt, h + dt * np.dot(row, kh), kh[i])
    return h + dt * np.dot(b, kh), v + dt * np.dot(b, kv)


def _for_floats_only(f, t, h, v, dt, A, b):
    h, v = _table(f, t, h, v, dt, A, b)
    return float(h), float(v)


# exercise: what was answered, and the name of the mistake if it has one
WRONG = {
    "5.1": [
        ((1350, 18, 28_700), "line of rkn4"),
        ((340, 18, 28_700), "line of dop8"),
        ((710, 18, 28_700), "steps"),
        ((5000, 18, 28_700), "linear reading"),
        ((-2800, 18, 28_700), None),
        ((2800, 44, 28_700), "same step"),
        ((2800, 60, 28_700), None),
        ((2800, 100, 28_700), None),
        ((2800, 18, 5_100_000), "order 1"),
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
        (rk4, "classical"),
    ],
    "5.3": [
        (lambda *a: _table(*a, when=False), "time of the start"),
        (lambda *a: _table(*a, twice=True), "looks twice"),
        (lambda *a: _table(*a, when=False, own=False), None),
        (_zeros, "room for numbers only"),
        (_for_floats_only, None),
        (lambda f, t, h, v, dt, A, b: rk4(f, t, h, v, dt), None),
        (lambda *a: _table(*a)[0], None),
    ],
}

RIGHT = {
    "5.1": [(2800, 18, 28_680), (np.int64(3000), 20.0, 30_000), (2500, 12, [27e3])],
    "5.2": [_on_pairs, lambda *a: list(_on_pairs(*a))],
    "5.3": [_table, _table_on_arrays, lambda *a: np.array(_table(*a))],
}
