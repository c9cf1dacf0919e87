"""Beside the page of lesson 1: two measures that should disagree."""

import numpy as np

from hoverslam_lib.checks.answers import array
from hoverslam_lib.checks.feedback import Wrong
from hoverslam_lib.metrics import mape, nmae


def measures_disagree(*lists):
    """Judge three lists, of exact values and of what P and Q computed, by what the two measures say of them."""
    count = len(lists[0]) if np.ndim(lists[0]) == 1 else 0
    if not 2 <= count <= 10:
        raise Wrong("The exact values should be a list of 2 to 10 numbers.")
    exact, p, q = (array(*pair) for pair in zip(lists, 3 * [(count,)], ("my_exact", "my_p", "my_q"), strict=True))
    yield
    small, large = np.min(np.abs(exact)), np.max(np.abs(exact))
    if small == 0:
        raise Wrong(mistake="exact value of 0")
    if round(small, 9) < 0.01 or round(large, 9) > 3:
        raise Wrong(mistake="out of range", smallest=small, largest=large)
    yield
    if (p == exact).all() or (q == exact).all():
        raise Wrong(mistake="perfect method")
    if large - small < 1e-12:
        raise Wrong(mistake="equal values")
    times = mape(exact, q) / mape(exact, p), nmae(exact, p) / nmae(exact, q)
    if max(times) <= 0.1 + 1e-9:
        raise Wrong(mistake="wrong way round")
    if np.mean(np.abs(q / exact)) >= 9.99 * np.mean(np.abs(p / exact)) and np.sum(np.abs(p)) >= 9.99 * np.sum(
        np.abs(q)
    ):
        raise Wrong(mistake="errors for results")
    for name, factor in zip(("MAPE", "NMAE"), times, strict=True):
        if factor < 10 - 1e-8:
            raise Wrong(mistake=f"not by the {name}", nudge=True, mape=times[0], nmae=times[1])
        yield


measures_disagree.tests = 4
