"""Answers that students give to the exercises of lesson 10."""

import numpy as np


def _friends(t, h, seconds):
    n = int(seconds / (t[1] - t[0]))
    return t[-n:], h[-n:]


def _one_more(t, h, seconds):
    n = int(seconds / (t[1] - t[0])) + 1
    return t[-n:], h[-n:]


def _mean_step(t, h, seconds):
    n = int(seconds / np.mean(np.diff(t))) + 1
    return t[-n:], h[-n:]


def _last_step(t, h, seconds):
    n = int(seconds / (t[-1] - t[-2])) + 1
    return t[-n:], h[-n:]


def _loop(t, h, seconds):
    rows = [(a, b) for a, b in zip(t, h, strict=True) if t[-1] - a <= seconds]
    return [a for a, _ in rows], [b for _, b in rows]


def _search(t, h, seconds):
    first = np.searchsorted(t, t[-1] - seconds, side="left")
    return np.array([t[first:], h[first:]])


def _overwrites(t, h, seconds):
    t -= t[-1] - seconds
    return t[t >= 0], h[t >= 0]


def _velocity(t0, h0, v0, t1, h1, v1, t, two=2, three=3, power=1, length=None):
    l, r = t1 - t0, h1 - h0  # noqa: E741
    s = (t - t0) / (length or l)
    dhds = l * v0 + two * s * (3 * r - 2 * l * v0 - l * v1) + three * s * s * (l * v0 + l * v1 - 2 * r)
    return dhds / l**power


def _height(t0, h0, v0, t1, h1, v1, t):
    l, r = t1 - t0, h1 - h0  # noqa: E741
    s = (t - t0) / l
    return h0 + s * (l * v0 + s * (3 * r - 2 * l * v0 - l * v1 + s * (l * v0 + l * v1 - 2 * r)))


def _by_small_difference(t0, h0, v0, t1, h1, v1, t):
    d = 1e-3
    return (_height(t0, h0, v0, t1, h1, v1, t + d) - _height(t0, h0, v0, t1, h1, v1, t)) / d


def _other_form(a, ha, va, b, hb, vb, t):
    # Hermite's basis, differentiated
    w = b - a
    s = (np.asarray(t) - a) / w
    return 6 * s * (1 - s) * (hb - ha) / w + (1 - s) * (1 - 3 * s) * va + s * (3 * s - 2) * vb


WRONG = {
    "10.1": [
        ((1 / 150, 901), "no such GIF"),
        ((0.0067, 901), "no such GIF"),
        ((0.008, 751), "too slow a rate"),
        ((0.004, 1501), "more frames than needed"),
        ((0.03, 201), "real time"),
        ((0.15, 41), "pace upside down"),
        ((6, 1001), "milliseconds"),
        ((0.006, 1000), "one frame short"),
        ((0.006, 201), "frames of real time"),
        ((0.006, 200), None),
        ((0.006, 901), None),
        ((0.005, 1201), None),
        (("0.006 s", 1001), None),
        ((0.006, None), None),
    ],
    "10.2": [
        (_friends, "nothing mended"),
        (_one_more, "still counts rows"),
        (lambda t, h, seconds: (t[t > t[-1] - seconds], h[t > t[-1] - seconds]), "boundary lost"),
        (lambda t, h, seconds: (t[t >= seconds], h[t >= seconds]), "keeps everything"),
        (lambda t, h, seconds: (t[t <= t[0] + seconds], h[t <= t[0] + seconds]), "first seconds"),
        (lambda t, h, seconds: (t[t <= t[-1] - seconds], h[t <= t[-1] - seconds]), "older rows"),
        (_mean_step, None),
        (_last_step, None),
        (lambda t, h, seconds: _friends(t, h, seconds + t[1] - t[0]), "still counts rows"),
        (lambda t, h, seconds: t[t >= t[-1] - seconds], None),
        (lambda t, h, seconds: (t >= t[-1] - seconds, h), None),
        (lambda t, h, seconds: (h[t >= t[-1] - seconds], t[t >= t[-1] - seconds]), None),
        (_overwrites, "changes its arguments"),
    ],
    "10.3": [
        (lambda *a: _velocity(*a, power=0), "per step"),
        (lambda *a: _velocity(*a, power=-1), "times the length"),
        (lambda t0, h0, v0, t1, h1, v1, t: v0 + (t - t0) / (t1 - t0) * (v1 - v0), "straight line"),
        (lambda t0, h0, v0, t1, h1, v1, t: np.interp(t, [t0, t1], [v0, v1]), "straight line"),
        (lambda t0, h0, v0, t1, h1, v1, t: (h1 - h0) / (t1 - t0), "mean velocity"),
        (lambda *a: _velocity(*a, two=1, three=1), "powers forgotten"),
        (lambda *a: _velocity(*a, length=1.0), "seconds for s"),
        (_height, "the height"),
        (lambda t0, h0, v0, t1, h1, v1, t: _velocity(t0, h0, v0, t1, h1, v1, t0 + t1 - t), None),
        (lambda t0, h0, v0, t1, h1, v1, t: (v0 + v1) / 2, None),
        (_by_small_difference, None),
        (lambda *a: _velocity(*a, three=2), None),
        (lambda *a: float(_velocity(*a)), None),
    ],
}

RIGHT = {
    "10.1": [(0.006, 1001), (6e-3, 1001.0), (np.float64(0.03) / 5, np.int64(1001))],
    "10.2": [
        _loop,
        _search,
        lambda t, h, seconds: (t[t[-1] - t <= seconds], h[t[-1] - t <= seconds]),
        lambda a, b, c: [a[np.flatnonzero(a >= a[-1] - c)], b[np.flatnonzero(a >= a[-1] - c)]],
    ],
    "10.3": [_velocity, _other_form],
}
