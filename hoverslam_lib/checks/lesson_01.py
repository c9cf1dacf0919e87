"""Beside the page of lesson 1: two measures that should disagree."""

import numpy as np

from hoverslam_lib.checks.answers import array
from hoverslam_lib.checks.feedback import Wrong
from hoverslam_lib.metrics import mape, nmae

ROUNDING = 1 - 1e-9


def measures_disagree(exact, p, q):
    """Judge three lists by what the two measures say of them."""
    count = len(exact) if np.ndim(exact) == 1 else 0
    if not 2 <= count <= 10:
        raise Wrong("The exact values should be a list of 2 to 10 numbers.")
    named = zip((exact, p, q), ("my_exact", "my_p", "my_q"), strict=True)
    exact, p, q = (array(values, (count,), name) for values, name in named)
    yield
    size = np.abs(exact)
    if (size == 0).any():
        raise Wrong(mistake="exact value of 0")
    if size.min() < 0.01 * ROUNDING or size.max() > 3 / ROUNDING:
        raise Wrong(mistake="out of range", smallest=size.min(), largest=size.max())
    yield
    if (p == exact).all() or (q == exact).all():
        raise Wrong(mistake="perfect method")
    if np.ptp(size) < 1e-12:
        raise Wrong(mistake="equal values")
    by_mape, by_nmae = _apart(exact, p, q)
    if max(by_mape, by_nmae) <= 0.1 / ROUNDING:
        raise Wrong(mistake="wrong way round")
    if min(_apart(exact, exact + p, exact + q)) >= 10 * ROUNDING:
        raise Wrong(mistake="errors for results")
    for measure, times in (("MAPE", by_mape), ("NMAE", by_nmae)):
        if times < 10 * ROUNDING:
            raise Wrong(mistake=f"not by the {measure}", nudge=True, mape=by_mape, nmae=by_nmae)
        yield


measures_disagree.tests = 4


def _apart(exact, p, q):
    """How many times worse Q is than P by the MAPE, and P than Q by the NMAE."""
    with np.errstate(divide="ignore", invalid="ignore"):
        return np.divide(mape(exact, q), mape(exact, p)), np.divide(nmae(exact, p), nmae(exact, q))
