"""Answers that students give to the exercises of lesson 9."""

import numpy as np


def _bisection(height, early, late, halvings=31):
    for _ in range(halvings):
        middle = (early + late) / 2
        if height(middle) > 0:
            early = middle
        else:
            late = middle
    return (early + late) / 2


def _chord(t1, h1, t2, h2):
    return t1 - h1 * (t2 - t1) / (h2 - h1)


def _keeps_the_first(height, early, late):
    h_early, t = height(early), late
    for _ in range(40):
        h = height(t)
        if abs(h) < 1e-9:
            break
        t = _chord(early, h_early, t, h)
    return t


def _secant(height, early, late, most=10, near=1e-10):
    a, h_a, b, h_b = early, height(early), late, height(late)
    for _ in range(most):
        if abs(b - a) < near or h_a == h_b:
            break
        a, h_a, b = b, h_b, _chord(a, h_a, b, h_b)
        h_b = height(b)
    return b


def _height_of_the_best(height, early, late):
    return height(_secant(height, early, late, most=5))


def _table(height, early, late):
    times = np.linspace(early, late, 12)
    return times[np.argmin([abs(height(t)) for t in times])]


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


def _finds_a_root(height, early, late):
    from scipy.optimize import root_scalar

    return root_scalar(height, bracket=(early, late), method="toms748", xtol=1e-10).root


def _in_an_array(height, early, late):
    t, h = np.array([early, late]), np.array([height(early), height(late)])
    while t.size < 12 and h[-1] != 0 and abs(t[-1] - t[-2]) > 1e-11:
        t = np.append(t, t[-1] - h[-1] * np.diff(t)[-1] / np.diff(h)[-1])
        h = np.append(h, height(t[-1]))
    return t[-1]


# exercise: what was answered, and the name of the mistake if it has one
WRONG = {
    "9.1": [(1147.0, None), (0, None), (20.13, "not rounded"), ("21 halvings", None)],
    "9.2": [
        ((0.005, 0.014), None),
        ((0.016, 0.05), None),
        ((None, 0.014), None),
        ((0.016, ...), None),
    ],
    "9.3": [
        (lambda height, early, late: _bisection(height, early, late, 12), "bisection"),
        (_keeps_the_first, "one end never moves"),
        (_height_of_the_best, "height returned"),
        (_table, None),
        (lambda height, early, late: _secant(height, early, late, near=1e-3), "stops too early"),
        (lambda height, early, late: _secant(height, early, late, most=4), "too few turns"),
        (_finds_a_root, "a library's search"),
        (lambda height, early, late: (early + late) / 2, None),
        (lambda height, early, late: 60.211035517, None),
    ],
}

RIGHT = {
    "9.1": [21, 21.0, np.int64(21)],
    "9.2": [(0.0218, 0.0256), (np.float64(0.011), 0.022), (0.016, 0.01)],
    "9.3": [_secant, _illinois, _in_an_array],
}
