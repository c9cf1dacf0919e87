"""Answers that students give to the exercises of lesson 1."""

import numpy as np

from hoverslam_lib import mape, nmae


def _as_it_was(exact, computed):
    total = 0.0
    for A, F in zip(exact, computed):  # noqa: B905 (as the friend wrote it)
        total += A - F
    return abs(total) / (len(exact) - 1) / max(exact)


def _last_sample_only(exact, computed):
    for A, F in zip(exact, computed, strict=True):
        total = abs(A - F)
    return total / len(exact) / np.max(np.abs(exact))


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
        ((2.14, -0.23), "old velocity"),
        ((2.137, -0.2711), "move first"),
        ((1.8412, -1.388), "mass forgotten"),
        ((2.1392, 0.592), "other spring"),
        ((2.1797, 0.8636), "m over k"),
        ((2.0949, 0.2959), "root of k over m"),
        ((2.3848, 2.248), "spring pushes"),
        ((2.04, 0.4), "one step"),
        ((1.93704, -0.81764), "three steps"),
        ((-0.212, 2.0188), "swapped"),
        ((2.02, -0.2), "force of the start"),
        ((2.0188, 0.212), "sign lost"),
        ((0.0188, -0.212), "from the start"),
        ((2.08, -0.212), None),
        ((2.019, -0.21), None),
        ((1.2, -5.0), None),
        ((np.nan, -0.212), None),
        ((2.0612, -0.212), None),
        ((2.02, -0.21), None),
        (("2.0188 m", "-0.212 m/s"), None),
        ((2.0188, None), None),
    ],
    "1.2": [
        (lambda e, c: np.abs(np.sum(e - c)) / len(e) / np.max(np.abs(e)), "signs cancel"),
        (lambda e, c: np.sum(np.abs(e - c)) / (len(e) - 1) / np.max(np.abs(e)), "steps for samples"),
        (lambda e, c: np.mean(np.abs(e - c)) / max(e), "largest with its sign"),
        (lambda e, c: np.mean(np.abs(e - c)) / abs(max(e)), "largest with its sign"),
        (lambda e, c: sum(abs(e - c)) / (len(e) - 1) / max(e), "two bugs left"),
        (lambda e, c: abs(sum(e - c)) / len(e) / max(e), "two bugs left"),
        (lambda e, c: abs(sum(e - c)) / (len(e) - 1) / max(abs(e)), "two bugs left"),
        (_as_it_was, "nothing mended"),
        (lambda e, c: np.sum(e - c) / len(e) / np.max(np.abs(e)), "signed"),
        (mape, "MAPE"),
        (lambda e, c: np.max(np.abs(e - c)) / np.max(np.abs(e)), "largest error"),
        (lambda e, c: np.mean(np.abs(e - c)) / np.max(np.abs(c)), "amplitude of the computed"),
        (lambda e, c: 100 * np.mean(np.abs(e - c)) / np.max(np.abs(e)), "per cent"),
        (lambda e, c: np.mean(np.abs(e - c)), "not scaled"),
        (lambda e, c: sum(abs(e - c)) / max(abs(e)), "not divided by n"),
        (lambda e, c: sum(abs(e - c)) / (len(e) + 1) / max(abs(e)), "one too many"),
        (lambda e, c: sum(abs(e - c)) / len(e) / e[0], "start for amplitude"),
        (nmae, None),
        (lambda e, c: nmae(e, c), None),
        (lambda e, c: sum(abs(e - c)) / max(e), None),
        (lambda e, c: sum(abs(e - c)), None),
        (lambda e, c: abs(sum(e - c)) / (len(e) + 1) / max(abs(e)), None),
        (lambda e, c: np.mean(np.abs(e - c)) / abs(e[-1]), None),
        (lambda e, c: np.mean(np.abs(e - c)) / (np.max(e) - np.min(e)), None),
        (lambda e, c: np.sum(np.abs(e - c)) / np.sum(np.abs(e)), None),
        (_last_sample_only, "last sample only"),
        (_in_place, "changes its arguments"),
        (lambda e, c: np.abs(e - c) / np.max(np.abs(e)), None),
        (lambda e, c: print(np.mean(np.abs(e - c)) / np.max(np.abs(e))), None),
        (lambda e, c: np.mean(np.abs(e - c)) / np.ptp(e) * 2, None),
        (lambda e, c: np.sqrt(np.mean((e - c) ** 2)) / np.max(np.abs(e)), None),
    ],
    "1.3": [
        (([3.0, 0.01], [3.0, 0.02], [3.2, 0.01]), "wrong way round"),
        (([3.0, 0.0], [3.2, 0.0], [3.0, 0.01]), "exact value of 0"),
        (([3.0, 0.01], [3.0, 0.01], [3.0, 0.02]), "perfect method"),
        (([3.0, 0.01], [3.2, 0.01], [3.0, 0.01]), "perfect method"),
        (([3.0, -3.0], [3.2, -3.0], [3.0, -3.01]), "equal values"),
        (([3.0, 0.01], [0.3, 0.0], [0.0, 0.01]), "errors for results"),
        (([3.0, 0.01], [3.2, 0.01], [3.0, 0.2]), None),
        (([3.0, 0.01], [3.2, 0.01], [3.0, 0.011]), None),
        (([3.0, 1.0], [3.1, 1.0], [3.0, 1.1]), None),
        (([3.0, 1e-6], [3.1, 1e-6], [3.0, 2e-6]), None),
        (([300.0, 1.0], [310.0, 1.0], [300.0, 1.5]), None),
        (([3.0, 0.01], [3.2], [3.0, 0.02]), None),
        ((3.0, 3.2, 3.01), None),
        ((np.array(3.0), np.array(3.2), np.array(3.01)), None),
        (([3.0], [3.2], [3.01]), None),
        (([3.0, 0.01], [3.2, 0.02], [3.02, 0.03]), None),
        (("3, 0.01", "3.2, 0.01", "3, 0.02"), None),
        (([3.0, 0.01], [3.2, 0.01], None), None),
        (([3.0, 0.01], [3.2, float("nan")], [3.0, 0.02]), None),
    ],
}

RIGHT = {
    "1.1": [
        (2.0188, -0.212),
        (np.float64(2.01880), np.array(-0.2120)),
        (np.array([2.0188]), -0.21200000000000008),
    ],
    "1.2": [
        _with_an_index,
        lambda u, w: np.abs(u - w).mean() / np.abs(u).max(),
        lambda u, w: np.linalg.norm(w - u, 1) / (u.size * np.linalg.norm(u, np.inf)),
        lambda u, w: np.array([np.mean(np.abs((w - u) / max(np.abs(u))))]),
    ],
    "1.3": [
        ([3.0, 0.01], [3.2, 0.01], [3.0, 0.02]),
        ((-3.0, 0.01), (-2.7, 0.01), (-3.0, -0.01)),
        (np.array([3.0, 2.0, 0.01]), np.array([3.3, 2.0, 0.01]), np.array([3.0, 2.0, 0.025])),
        ([3, 0.01], [2, 0.01], [3, 0.06]),
        ([3, 0.01], [6, 0.01], [3, 0.31]),
    ],
}
