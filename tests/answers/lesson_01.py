"""Answers that students give to the exercises of lesson 1, beside those that its tables make."""

import numpy as np

from hoverslam_lib import mape, nmae


def _in_place(exact, computed):
    exact -= computed
    return np.mean(np.abs(exact)) / np.max(np.abs(exact + computed))


def _with_an_index(a, b):
    largest, total = 0, 0
    for i in range(len(a)):
        total = total + abs(b[i] - a[i])
        if abs(a[i]) > largest:
            largest = abs(a[i])
    return total / (largest * len(a))


# exercise: what was answered, and the name of the mistake if it has one
WRONG = {
    "1.1": [
        ((2.0949, 0.2959), "root of k over m"),
        ((1.2, -5.0), None),
        ((np.nan, -0.212), None),
        (("2.0188 m", "-0.212 m/s"), None),
        ((2.0188, None), None),
        ((2.04, ...), None),
        ((..., -0.21), "rounded"),
    ],
    "1.2": [
        (lambda e, c: sum(abs(e - c)) / (len(e) - 1) / max(e), "two bugs left"),
        (mape, "MAPE"),
        (lambda e, c: 100 * nmae(e, c), "the library's"),
        (lambda e, c: sum(abs(e - c)) / max(e), None),
        (lambda e, c: sum(abs(e - c)), None),
        (_in_place, "changes its arguments"),
        (lambda e, c: np.abs(e - c) / np.max(np.abs(e)), None),
        (lambda e, c: print(np.mean(np.abs(e - c)) / np.max(np.abs(e))), None),
    ],
    "1.3": [
        (([3.0, 0.01], [3.2], [3.0, 0.02]), None),
        ((3.0, 3.2, 3.01), None),
        ((np.array(3.0), np.array(3.2), np.array(3.01)), None),
        (([3.0], [3.2], [3.01]), None),
        (("3, 0.01", "3.2, 0.01", "3, 0.02"), None),
        (([3.0, 0.01], [3.2, 0.01], None), None),
        (([3.0, 0.01], [3.2, float("nan")], [3.0, 0.02]), None),
        (([3.0, 0.01], [3.3, 0.001], [0.03, 0.08]), "not by the MAPE"),
        (([3.0, 0.01], [3.3, 0.001], [0.35, 0.2]), "not by the NMAE"),
        (([3.0, 0.01], [0.3, 0.0], [0.0, 0.03]), "errors for results"),
    ],
}

RIGHT = {
    "1.1": [(np.float64(2.01880), np.array(-0.2120)), (np.array([2.0188]), -0.21200000000000008)],
    "1.2": [
        _with_an_index,
        lambda u, w: np.linalg.norm(w - u, 1) / (u.size * np.linalg.norm(u, np.inf)),
        lambda u, w: np.array([np.mean(np.abs((w - u) / max(np.abs(u))))]),
    ],
    "1.3": [
        ((-3.0, 0.01), (-2.7, 0.01), (-3.0, -0.01)),
        (np.array([3.0, 2.0, 0.01]), np.array([3.3, 2.0, 0.01]), np.array([3.0, 2.0, 0.025])),
        ([3, 0.01], [2, 0.01], [3, 0.06]),
        ([3, 0.01], [6, 0.01], [3, 0.31]),
    ],
}
