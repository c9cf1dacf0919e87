"""Answers that students give to the exercises of lesson 5."""

import numpy as np

from hoverslam_lib.integrators import rk4


def _three_eighths(f, t, h, v, dt, *, time=2, velocity=3, weights=(1, 3, 3, 1), twice=False):
    third = dt / 3
    k1h, k1v = v, f(t, h, v)
    k2h = v + third * k1v
    k2v = f(t + third, h + third * k1h, k2h)
    k3h = v + dt * k2v - third * k1v
    k3v = f(t + time * third, h + dt * k2h - third * k1h, k3h)
    k4h = v + dt * (k1v - k2v + k3v)
    k4v = f(t + dt, h + dt * (k1h - k2h + k3h), (v, k2h, k3h, k4h)[velocity])
    if twice:
        k1v = f(t, h, v)
    h = h + dt / 8 * sum(w * k for w, k in zip(weights, (k1h, k2h, k3h, k4h), strict=True))
    v = v + dt / 8 * sum(w * k for w, k in zip(weights, (k1v, k2v, k3v, k4v), strict=True))
    return h, v


def _on_pairs(f, t, h, v, dt):
    """The same on the state as one array."""

    def slopes(t, y):
        return np.array([y[1], f(t, y[0], y[1])])

    y = np.array([h, v])
    k1 = slopes(t, y)
    k2 = slopes(t + dt / 3, y + dt * k1 / 3)
    k3 = slopes(t + 2 / 3 * dt, y - dt * k1 / 3 + dt * k2)
    k4 = slopes(t + dt, y + dt * k1 - dt * k2 + dt * k3)
    return y + dt * (k1 + 3 * k2 + 3 * k3 + k4) / 8


def _changes_v(f, t, h, v, dt):
    new = _three_eighths(f, t, h, v, dt)
    if isinstance(v, np.ndarray):
        v += new[1] - v
    return new


def _table(f, t, h, v, dt, A, b, *, when=True, slope=True, inner=True, last=False, own=True, twice=False):
    kh, kv = [], []
    for i in range(len(b)):
        v_i, h_i = v, h
        for j in range(i - 1 if last and i else 0, i):
            v_i = v_i + (dt if inner else 1) * A[i][j] * kv[j]
            h_i = h_i + (dt if inner else 1) * A[i][j] * kh[j]
        c = sum(A[i])
        kh.append(v_i if slope else v)
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


def _no_dt_at_the_end(f, t, h, v, dt, A, b):
    h_new, v_new = _table(f, t, h, v, dt, A, b)
    return h + (h_new - h) / dt, v + (v_new - v) / dt


def _for_floats_only(f, t, h, v, dt, A, b):
    h, v = _table(f, t, h, v, dt, A, b)
    return float(h), float(v)


# exercise: what was answered, and the name of the mistake if it has one
WRONG = {
    "5.1": [
        ((1350, 18, 28_700), "line of rkn4"),
        ((340, 18, 28_700), "line of dop8"),
        ((6500, 18, 28_700), "line of gauss4"),
        ((710, 18, 28_700), "steps"),
        ((9000, 18, 28_700), "line of 1e-10"),
        ((890, 18, 28_700), "line of 1e-6"),
        ((5000, 18, 28_700), None),
        ((-2800, 18, 28_700), None),
        ((2800, 0.055, 28_700), "upside down"),
        ((2800, 2.05, 28_700), "prices"),
        ((2800, 1.27, 28_700), "powers of ten"),
        ((2800, 44, 28_700), "same step"),
        ((2800, 100, 28_700), None),
        ((2800, 18, 5_100_000), "order 1"),
        ((2800, 18, 161_000), "order 2"),
        ((2800, 18, 12_000), "order 8"),
        ((2800, 18, 9_300), "as from 3 to 6 to 9, plus"),
        ((2800, 18, 5.6), "only the factor"),
        ((2800, 18, 60_000), None),
        ((2800, 18, None), None),
    ],
    "5.2": [
        (lambda *a: _three_eighths(*a, time=1, velocity=2), "unmended"),
        (lambda *a: _three_eighths(*a, time=1), "time"),
        (lambda *a: _three_eighths(*a, velocity=2), "velocity"),
        (lambda *a: _three_eighths(*a, velocity=0), "velocity of the start"),
        (lambda *a: _three_eighths(*a, velocity=1), None),
        (lambda *a: _three_eighths(*a, time=3), None),
        (lambda *a: _three_eighths(*a, weights=(1, 2, 2, 1)), None),
        (lambda *a: _three_eighths(*a, twice=True), "more looks"),
        (lambda *a: _three_eighths(*a)[::-1], None),
        (_changes_v, "changes its arguments"),
        (rk4, "classical"),
    ],
    "5.3": [
        (lambda *a: _table(*a, when=False), "time of the start"),
        (lambda *a: _table(*a, inner=False), "dt forgotten inside"),
        (lambda *a: _table(*a, last=True), "last slope only"),
        (lambda *a: _table(*a, own=False), "old v in f"),
        (lambda *a: _table(*a, slope=False), "slope of h is the old v"),
        (lambda *a: _table(*a, twice=True), "looks twice"),
        (_no_dt_at_the_end, None),
        (_for_floats_only, None),
        (lambda f, t, h, v, dt, A, b: rk4(f, t, h, v, dt), None),
        (lambda *a: _table(*a)[0], None),
    ],
}

RIGHT = {
    "5.1": [(2800, 18, 28_680), (np.int64(3000), 20.0, 30_000), (2500, 12, [27e3])],
    "5.2": [_three_eighths, _on_pairs, lambda *a: list(_three_eighths(*a))],
    "5.3": [_table, _table_on_arrays, lambda *a: np.array(_table(*a))],
}
