"""Answers that students give to the exercises of lesson 10, beside those that its table makes."""

import numpy as np


def _loop(t, h, seconds):
    rows = [(a, b) for a, b in zip(t, h, strict=True) if t[-1] - a <= seconds]
    return [a for a, _ in rows], [b for _, b in rows]


def _search(t, h, seconds):
    first = np.searchsorted(t, t[-1] - seconds, side="left")
    return np.array([t[first:], h[first:]])


def _overwrites(t, h, seconds):
    t -= t[-1] - seconds
    return t[t >= 0], h[t >= 0]


def _height(t0, h0, v0, t1, h1, v1, t):
    w = t1 - t0
    s = (t - t0) / w
    up, out, back = s * s * (3 - 2 * s), s * (1 - s) ** 2, s * s * (s - 1)
    return h0 + up * (h1 - h0) + w * (out * v0 + back * v1)


def _by_difference(before, after):
    def velocity(*row):
        *rows, t = row
        return (_height(*rows, t + after) - _height(*rows, t - before)) / (before + after)

    return velocity


def _by_basis(a, ha, va, b, hb, vb, t):
    # Hermite's basis, differentiated
    w = b - a
    s = (np.asarray(t) - a) / w
    return 6 * s * (1 - s) * (hb - ha) / w + (1 - s) * (1 - 3 * s) * va + s * (3 * s - 2) * vb


WRONG = {
    "10.1": [
        ((0.0067, 901), "no such GIF"),
        ((0.005, 1201), None),
        (("0.006 s", 1001), None),
        ((0.006, None), None),
    ],
    "10.2": [
        (lambda t, h, seconds: (t[-int(seconds / (t[1] - t[0])) :], h), None),
        (lambda t, h, seconds: (t >= t[-1] - seconds, h), None),
        (lambda t, h, seconds: {"t": t, "h": h}, None),
        (lambda t, h, seconds: None, None),
        (_overwrites, "changes its arguments"),
    ],
    "10.3": [
        (_by_difference(0, 1e-3), None),
        (_by_difference(1e-3, 1e-3), None),
        (lambda *a: -_by_basis(*a), None),
    ],
}

RIGHT = {
    "10.1": [(6e-3, 1001.0), (np.float64(0.03) / 5, np.int64(1001))],
    "10.2": [
        _loop,
        _search,
        lambda a, b, c: [a[np.flatnonzero(a >= a[-1] - c)], b[np.flatnonzero(a >= a[-1] - c)]],
    ],
    "10.3": [_by_basis],
}
