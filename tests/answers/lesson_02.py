"""Answers that students give to the exercises of lesson 2, beside those that its tables make."""

import numpy as np


def _run(x, v, dt, n):
    xs = [x]
    for _ in range(n):
        x, v = x + dt * v, v - dt * x
        xs.append(x)
    return xs


def _in_an_array(x, v, dt, n):
    xs = np.full(n + 1, x)
    for i in range(n):
        xs[i + 1], v = xs[i] + dt * v, v - dt * xs[i]
    return tuple(xs)


# exercise: what was answered, and the name of the mistake if it has one
WRONG = {
    "2.1": [
        (lambda omega, dt, n: np.exp(n * omega**2 * dt**2), None),
        (lambda omega, dt, n: print((1 + omega**2 * dt**2) ** n), None),
        (lambda omega, dt, n: (1 + omega**2 * dt) ** n - 1, None),
    ],
    "2.2": [
        (lambda x, v, dt, n: _run(x, v, dt, n)[:-1], "one step short"),
        (lambda x, v, dt, n: _run(x, v, dt, n + 1)[1:], None),
        (lambda x, v, dt, n: None, None),
    ],
    "2.3": [
        (lambda coarse, fine, order: fine, None),
        (lambda coarse, fine, order: fine - coarse / 2**order, "minus 1 forgotten"),
        (lambda coarse, fine, order: fine + (fine - coarse) / (order**2 - 1), "p^2 for 2^p"),
        (lambda coarse, fine, order: float((2**order * fine - coarse) / (2**order - 1)), None),
    ],
}

RIGHT = {
    "2.1": [lambda w, step, count: np.prod(np.full(count, 1 + (w * step) ** 2))],
    "2.2": [_in_an_array, lambda x, v, dt, n: np.array(_run(x, v, dt, n))],
    "2.3": [lambda a, b, p: np.asarray(b) + (np.asarray(b) - a) / (2.0**p - 1)],
}
