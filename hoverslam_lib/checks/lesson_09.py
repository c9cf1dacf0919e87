"""Beside the page of lesson 9: a forger's two flights, and a search that is watched."""

import sys
from functools import cache, partial
from math import exp

import numpy as np

from hoverslam_lib import published
from hoverslam_lib.checks.answers import number, takes
from hoverslam_lib.checks.feedback import Wrong, each
from hoverslam_lib.descent import Descent
from hoverslam_lib.ignition import FreeFall

LARGEST, SLOWEST, HEIGHT = 50.0, -70.0, 15.0


def forged(landing_dt, crash_dt):
    """Judge two step sizes by their flights."""
    try:
        yield from each([partial(_lands, landing_dt), partial(_crashes, crash_dt)])
    except Wrong:
        try:
            _lands(crash_dt)
            _crashes(landing_dt)
        except Wrong:
            pass
        else:
            raise Wrong(mistake="swapped") from None
        raise


forged.tests = 2


def _flown(dt, name):
    dt = number(dt, name)
    if 10 <= dt <= 30:
        raise Wrong(mistake="milliseconds", about=name, dt=dt)
    if not 0.01 <= dt <= 0.03:
        raise Wrong(f"A step of {dt:g} s is not between 0.01 s and 0.03 s.", about=name)
    return dt, published.fly(35.87, dt=dt)


def _lands(dt, name="my_landing_dt"):
    dt, run = _flown(dt, name)
    fastest, (height, _) = run.v.max(), published.listed(run, at_rest=True)
    if not 0 <= fastest <= LARGEST:
        raise Wrong(mistake="never at rest" if fastest < 0 else "shot up", nudge=True, about=name, dt=dt, v=fastest)
    if not height < HEIGHT:
        raise Wrong(f"With dt = {dt:g} s it comes to rest {height:.3g} m above the ground.", nudge=True, about=name)


def _crashes(dt, name="my_crash_dt"):
    dt, run = _flown(dt, name)
    fastest = run.v.max()
    if fastest > SLOWEST:
        raise Wrong(mistake="no crash" if fastest >= 0 else "not hard enough", nudge=True, about=name, dt=dt, v=fastest)


@cache
def _fall():
    return FreeFall(Descent(), dt=0.1)


def twelve_flights(search):
    """Judge a search by what it tries."""
    takes(search, "height", "early", "late")
    for name, height, early, late in (
        ("a curved height", lambda t: 400.0 * (exp(1.7 * (60.3 - t)) - 1), 60.0, 61.0),
        ("another one", lambda t: 900.0 - 4.0 * (t - 2.0) ** 3, 6.0, 11.0),
        ("a straight line", lambda t: -1147.0 * (t - 33.125), 33.0, 34.5),
        ("the library's hover height", _fall().hover_height, 60.0, 61.0),
        ("the library's, from further away", _fall().hover_height, 57.0, 61.5),
    ):
        _one_search(search, name, height, early, late)
        yield


twelve_flights.tests = 5


def _one_search(search, name, height, early, late):
    tries, heights = [], []

    def counted(t):
        tries.append(number(t, "the time that you try"))
        if len(tries) > 1000:
            raise Wrong(mistake="never ends")
        if sys._getframe(1).f_globals.get("__name__", "").startswith("scipy."):
            raise Wrong(mistake="a library's search")
        heights.append(height(t))
        return heights[-1]

    try:
        got = number(search(counted, early, late))
    except ZeroDivisionError:
        if len(heights) > 1 and heights[-1] == heights[-2]:
            raise Wrong(mistake="never asks when to stop", name=name) from None
        raise
    found = height(got - 1e-9) > 0 > height(got + 1e-9)
    if found and len(tries) <= 12:
        return
    spent = f"{len(tries)} flights" if len(tries) != 1 else "one flight"
    told = f"On {name} your time is not within 1e-9 s after {spent}."
    if found:
        told = f"Found on {name}, but with {spent}: twelve are allowed."
    mistake = _recognised(tries, heights, height, early, late, got, found)
    raise Wrong(told, mistake, nudge=not mistake, name=name, told=told)


def _recognised(tries, heights, height, early, late, got, found):
    """The name of a way of searching, by what is tried beside the two ends, and what comes out."""

    def same(some, others, most=1):
        return len(some) >= most <= len(others) and np.allclose(some[:most], others[:most], rtol=1e-13, atol=0)

    new = list(dict.fromkeys(t for t in tries if t not in (early, late)))
    middle, secants = (early + late) / 2, _chords(height, early, late)
    if any(same(new, [middle, (middle + end) / 2], 2) for end in (early, late)):
        return "bisection"
    if any(same(new, _chords(height, *ends, kept=True), 4) for ends in ((early, late), (late, early))):
        return "one end never moves"
    if found:
        return "height asked again" if len(set(tries)) <= 12 else None
    if same([got], secants):
        return "one chord only"
    if any(same([got], [h]) for h in heights):
        return "height returned"
    if any(same([got], [t]) for t in secants):
        return "too few turns" if len(tries) < 7 else "stops too early"
    return None


def _chords(f, a, b, kept=False):
    """Where chords cross 0: through the last two tries, as in the secant method, or with a as one end of them all."""
    found = []
    while len(found) < 10 and f(a) != f(b):
        a, b = (a if kept else b), b - f(b) * (b - a) / (f(b) - f(a))
        found.append(b)
    return found
