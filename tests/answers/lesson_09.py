"""Answers that students give to the exercises of lesson 9."""

import math

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


def _one_chord(height, early, late):
    return _chord(early, height(early), late, height(late))


def _keeps_the_bracket(height, early, late):
    h_early, h_late, t = height(early), height(late), None
    for _ in range(100):
        t = _chord(early, h_early, late, h_late)
        h = height(t)
        if abs(h) < 1e-9:
            break
        if h > 0:
            early, h_early = t, h
        else:
            late, h_late = t, h
    return t


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


def _flies_twice_as_often(height, early, late):
    for _ in range(9):
        if height(early) == height(late):
            break
        early, late = late, late - height(late) * (late - early) / (height(late) - height(early))
    return late


def _never_asks_when_to_stop(height, early, late):
    a, b = early, late
    h_a, h_b = height(a), height(b)
    for _ in range(10):
        a, h_a, b = b, h_b, b - h_b * (b - a) / (h_b - h_a)
        h_b = height(b)
    return b


def _height_of_the_best(height, early, late):
    return height(_secant(height, early, late, most=5))


def _creeps(height, early, late):
    while height(early) > 0:
        early += 1e-9
    return early


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


def _in_an_array(height, early, late):
    t, h = np.array([early, late]), np.array([height(early), height(late)])
    while t.size < 12 and h[-1] != 0 and abs(t[-1] - t[-2]) > 1e-11:
        t = np.append(t, t[-1] - h[-1] * np.diff(t)[-1] / np.diff(h)[-1])
        h = np.append(h, height(t[-1]))
    return t[-1]


# exercise: what was answered, and the name of the mistake if it has one
WRONG = {
    "9.1": [
        (20, "one short"),
        (22, "one too many"),
        (11, "to a metre"),
        (17, "to a centimetre"),
        (10, "a thousandth"),
        (14, "natural logarithm"),
        (13, "natural logarithm"),
        (16, "to a centimetre"),
        (7, "decimal logarithm"),
        (30, "the lesson's thirty"),
        (math.log2(1147 * 1000), "not rounded"),
        (1147000, None),
        (0, None),
        ("21 halvings", None),
    ],
    "9.2": [
        ((0.02, 0.014), "shot up"),
        ((0.014, 0.016), "swapped"),
        ((16, 14), "milliseconds"),
        ((0.014, 0.012), "never at rest"),
        ((0.016, 0.011), "no crash"),
        ((0.016, 0.017), "not hard enough"),
        ((0.005, 0.014), None),
        ((0.016, 0.05), None),
        ((None, 0.014), None),
    ],
    "9.3": [
        (_bisection, "bisection"),
        (lambda height, early, late: _bisection(height, early, late, 12), "bisection"),
        (_one_chord, "one chord only"),
        (_keeps_the_bracket, "one end never moves"),
        (_keeps_the_first, "one end never moves"),
        (_height_of_the_best, "height returned"),
        (_flies_twice_as_often, None),
        (_never_asks_when_to_stop, None),
        (_table, None),
        (_creeps, "never ends"),
        (lambda height, early, late: _secant(height, early, late, near=1e-3), None),
        (lambda height, early, late: (early + late) / 2, None),
        (lambda height, early, late: 60.211035517, None),
    ],
}

RIGHT = {
    "9.1": [21, 21.0, np.int64(21)],
    "9.2": [(0.0218, 0.0256), (np.float64(0.011), 0.022), (0.016, 0.01)],
    "9.3": [_secant, _illinois, _in_an_array],
}
