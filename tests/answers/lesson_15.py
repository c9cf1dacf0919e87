"""Answers that students give to the exercises of lesson 15, beside those that its tables make."""

import numpy as np


def _rule(dt, error, q):
    return float(np.clip(0.9 * dt * error ** (-1 / (q + 1)), dt / 5, 10 * dt))


def _until_it_fits(pair, slopes, t, y, t_end, tolerance, dt):
    """With an inner loop that repeats a step until it is accepted."""
    ts, ys = [t], [y]
    while ts[-1] < t_end:
        while True:
            dt = min(dt, t_end - ts[-1])
            new, estimate = pair(slopes, ts[-1], ys[-1], dt)
            error = max(abs(estimate)) / tolerance
            tried, dt = dt, dt * np.clip(0.9 * max(error, 1e-9) ** (-1 / 3), 0.2, 5)
            if error <= 1:
                break
        ts.append(ts[-1] + tried)
        ys.append(new)
    return [[t, h, v] for t, (h, v) in zip(ts, ys, strict=True)]


def _times_alone(*arguments):
    return [row[0] for row in _until_it_fits(*arguments)]


def _as_a_pair(step, order, f, t, h, v, t_end, tolerance, dt, extrapolate=False):
    """Two half steps against one, by the program for pairs."""
    rows, state = [(t, h, v)], np.array([h, v])
    while t < t_end:
        dt = min(dt, t_end - t)
        one = np.array(step(f, t, *state, dt))
        two = np.array(step(f, t + dt / 2, *step(f, t, *state, dt / 2), dt / 2))
        off = (two - one) / (2**order - 1)
        error = np.abs(off).max() / tolerance
        if error <= 1:
            t, state = t + dt, two + off if extrapolate else two
            rows.append((t, *state))
        dt *= np.clip(0.9 * max(error, 1e-9) ** (-1 / (order + 1)), 0.2, 5)
    return np.array(rows)


# exercise: what was answered, and the name of the mistake if it has one
WRONG = {
    "15.1": [
        (lambda dt, error, q: 0.9 * dt / error ** (1 / (q + 1)), "no limits"),
        (lambda dt, error, q: dt if error <= 1 else dt / 2, None),
    ],
    "15.2": [(_times_alone, None), (lambda *arguments: _until_it_fits(*arguments)[1:], "the start is missing")],
    "15.3": [(lambda *arguments: _as_a_pair(*arguments, extrapolate=True), "corrected")],
}

RIGHT = {"15.1": [_rule], "15.2": [_until_it_fits], "15.3": [_as_a_pair]}
