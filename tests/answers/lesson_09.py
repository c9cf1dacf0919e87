"""Answers that students give to the exercises of lesson 9, beside those that its tables make."""

import numpy as np


def _bisection(height, early, late, halvings=31):
    for _ in range(halvings):
        middle = (early + late) / 2
        if height(middle) > 0:
            early = middle
        else:
            late = middle
    return (early + late) / 2


def _false_position(height, early, late):
    h_early, h_late = height(early), height(late)
    for _ in range(100):
        t = early - h_early * (late - early) / (h_late - h_early)
        h = height(t)
        if abs(h) < 1e-9:
            break
        if h > 0:
            early, h_early = t, h
        else:
            late, h_late = t, h
    return t


def _secant(height, early, late, most=10, near=1e-10):
    a, h_a, b, h_b = early, height(early), late, height(late)
    for _ in range(most):
        if abs(b - a) < near or h_a == h_b:
            break
        a, h_a, b = b, h_b, a - h_a * (b - a) / (h_b - h_a)
        h_b = height(b)
    return b


def _illinois(height, early, late):
    a, b, h_a, h_b, side = early, late, height(early), height(late), 0
    c = a
    for _ in range(10):
        last, c = c, (a * h_b - b * h_a) / (h_b - h_a)
        if abs(c - last) < 1e-10:
            break
        h = height(c)
        if h == 0:
            break
        if h * h_b > 0:
            b, h_b = c, h
            h_a, side = (h_a / 2 if side == -1 else h_a), -1
        else:
            a, h_a = c, h
            h_b, side = (h_b / 2 if side == 1 else h_b), 1
    return c


def _in_an_array(height, early, late):
    t, h = np.array([early, late]), np.array([height(early), height(late)])
    while t.size < 12 and h[-1] != 0 and abs(t[-1] - t[-2]) > 1e-11:
        t = np.append(t, t[-1] - h[-1] * np.diff(t)[-1] / np.diff(h)[-1])
        h = np.append(h, height(t[-1]))
    return t[-1]


def _spends(flights):
    """A good search that then asks for more heights than it needs."""

    def search(height, early, late):
        tried = []
        found = _secant(lambda t: tried.append(t) or height(t), early, late)
        for n in range(flights - len(tried)):
            height(early + (n + 1) / 9)
        return found

    return search


# exercise: what was answered, and the name of the mistake if it has one
WRONG = {
    "9.1": [(1147.0, None), (0, None), (20.13, "not rounded"), ("21 halvings", None)],
    "9.2": [((0.005, 0.014), None), ((None, 0.014), None), ((0.016, ...), None)],
    "9.3": [
        (lambda height, early, late: _bisection(height, early, late, 12), "bisection"),
        (_false_position, "one end never moves"),
        (lambda height, *ends: height(_secant(height, *ends, most=5)), "height returned"),
        (lambda height, early, late: _secant(height, early, late, near=1e-3), "stops too early"),
        (lambda height, early, late: (early + late) / 2, None),
        (lambda height, early, late: 60.211035517, None),
        (_spends(13), None),
    ],
}

RIGHT = {
    "9.1": [21.0, np.int64(21)],
    "9.2": [(0.0218, 0.0256), (np.float64(0.011), 0.022), (0.016, 0.01)],
    "9.3": [_illinois, _in_an_array, _spends(12)],
}
