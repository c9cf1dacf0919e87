"""Answers that students give to the exercises of lesson 12, beside those that its tables make."""

import math

import numpy as np


def _chance(heights, window, reach):
    k = sum(abs(h) < reach for h in heights)
    p = k * window / (2 * reach * len(heights))
    return p, p / k**0.5


WRONG = {
    "12.1": [
        ((269, 6000), None),
        ((218, 1820), None),
        ((178, 0.4), None),
        (("178 m", 1480), None),
        ((133.7, 1480), "drag taken away"),
    ],
    "12.2": [
        (lambda p, confidence: math.ceil(math.log(1 - confidence, 10) / math.log(1 - p)), None),
        (lambda p, confidence: int(np.log(1 - confidence) / np.log(1 - p)), "rounded down"),
        (lambda p, confidence: math.ceil(-math.log(1 - confidence) / p), "logarithm for p"),
        (lambda p, confidence: int(math.log(1 - confidence) / math.log(1 - p)) + 1, "always up"),
        (lambda p, confidence: (1 - p) ** confidence, None),
    ],
    "12.3": [
        (lambda heights, window, reach: _chance(heights, reach, window), None),
        (lambda heights, window, reach: _chance(heights, window, reach)[::-1], None),
        (lambda heights, window, reach: _chance(heights[:5000], window, reach), None),
    ],
}

RIGHT = {
    "12.1": [(178, 1500), (np.sqrt(31_556), 1_450)],
    "12.2": [lambda p, confidence: next(n for n in range(1, 10_000) if (1 - p) ** n <= 1 - confidence)],
    "12.3": [_chance, lambda heights, window, reach: np.array(_chance(heights, window, reach))],
}
