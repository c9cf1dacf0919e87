"""Exercises of lesson 9: the ignition tables."""

from functools import cache
from math import ceil, exp, log, log2, log10

import numpy as np

from hoverslam_lib import published
from hoverslam_lib.checks.answers import compare, number, takes
from hoverslam_lib.checks.feedback import Wrong, exercise
from hoverslam_lib.descent import Descent
from hoverslam_lib.ignition import FreeFall


@cache
def _fall():
    return FreeFall(Descent(), dt=0.1)


@exercise(
    "9.1",
    "how many halvings",
    tests=2,
    hints=(
        "How far apart are the hover heights of 60 s and 61 s? And after one halving, and after n?",
        "Which power of 2 is as large as the number of millimetres between the two heights at the beginning?",
    ),
)
def halvings(count):
    n = number(count, "your answer")
    if n > 0 and n != round(n):
        raise Wrong("A number of halvings is a whole number: which of its two neighbours is enough?", "not rounded")
    if n < 1:
        raise Wrong("At least one halving will be needed: count again.")
    yield
    metres = (_fall().hover_height(60.2) - _fall().hover_height(60.3)) / 0.1
    right = ceil(log2(metres * 1000))

    def whole(x):
        return n if abs(n - x) < 1 else ceil(x)  # rounded up or down

    mistakes = {
        "one short": (right - 1, "Very near: work out how far apart the two heights are after so many halvings."),
        "one too many": (right + 1, "Enough, but is it the first time? Look one halving earlier."),
        "to a metre": (ceil(log2(metres)), "So many bring it down to a metre. What was asked for?"),
        "to a centimetre": (whole(log2(metres * 100)), "So many bring it down to a centimetre. What was asked for?"),
        "a thousandth": (
            ceil(log2(1000)),
            "So many divide by about a thousand. By how much must the difference of the heights be divided?",
        ),
        "natural logarithm": (whole(log(metres * 1000)), "Which logarithm belongs to halving?"),
        "decimal logarithm": (whole(log10(metres * 1000)), "Which logarithm belongs to halving?"),
        "the lesson's thirty": (30, "Thirty make the times a billionth of a second wide. How much height is that?"),
    }
    compare(n, right, "yet", mistakes)
    yield


LARGEST, SLOWEST, HEIGHT = 50.0, -70.0, 15.0


@exercise(
    "9.2",
    "forge a landing",
    tests=3,
    hints=(
        "Try many step sizes in a loop, and print the largest velocity for each.",
        "Go through 0.010, 0.011, … s; for a landing look for a largest velocity between 0 and 50 m/s.",
    ),
)
def forged(landing_dt, crash_dt):
    landing, crash = number(landing_dt, "the first step size"), number(crash_dt, "the second step size")
    for dt in (landing, crash):
        if 10 <= dt <= 30:
            raise Wrong(f"{dt:g} s are a long step: are those milliseconds?", "milliseconds")
        if not 0.01 <= dt <= 0.03:
            raise Wrong(f"A step of {dt:g} s is not between 0.01 s and 0.03 s.")
    yield
    lands, falls = (published.fly(35.87, dt=dt) for dt in (landing, crash))
    fastest, other = lands.v.max(), falls.v.max()
    if fastest < SLOWEST and 0 <= other <= LARGEST:
        raise Wrong("Are your two step sizes in the order that was asked for?", "swapped")
    said = f"With dt = {landing:g} s the largest velocity is {fastest:.4g} m/s"
    if fastest < 0:
        raise Wrong(f"{said}: it never comes to rest.", "never at rest", nudge=True)
    height, _ = published.listed(lands, at_rest=True)
    if fastest > LARGEST:
        raise Wrong(f"{said}. It does come to rest, and then it is shot up.", "shot up", nudge=True)
    if not height < HEIGHT:
        raise Wrong(f"{said}, but it comes to rest {height:.3g} m above the ground.")
    yield
    said = f"With dt = {crash:g} s the largest velocity is {other:.4g} m/s"
    if other >= 0:
        raise Wrong(f"{said}: that one comes to rest, too.", "no crash", nudge=True)
    if other > SLOWEST:
        raise Wrong(f"{said}: it gets slower than 70 m/s.", "not hard enough", nudge=True)
    yield


def _chords(f, a, b, which):
    """Where the first chords cross 0, if one end of the first (0 for a, 1 for b) is kept."""
    kept, other, found = ((a, b), (b, a))[which] + ([],)
    for _ in range(4):
        if f(other) == f(kept):
            break
        other -= f(other) * (other - kept) / (f(other) - f(kept))
        found.append(other)
    return found


@exercise(
    "9.3",
    "twelve flights, not thirty",
    tests=5,
    hints=(
        "A height says on which side a try is, and also how far off. Use both numbers, of two tries.",
        "A straight line through the two last tries crosses 0 somewhere: that is the next try.",
        "After each try forget the older one of the two. Stop when the last two agree, before you divide by 0.",
    ),
)
def twelve_flights(search):
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


def _one_search(search, name, height, early, late):
    tries, heights = [], []

    def counted(t):
        t = number(t, "the time that you try")
        if len(tries) > 1000:
            raise Wrong("It does not end: stopped after a thousand flights.", "never ends")
        tries.append(t)
        heights.append(height(t))
        return heights[-1]

    got = search(counted, early, late)
    new = list(dict.fromkeys(t for t in tries if t not in (early, late)))
    got = number(got)
    found = height(got - 1e-9) > 0 > height(got + 1e-9)
    if found and len(tries) <= 12:
        return
    spent = f"{len(tries)} flights" if len(tries) != 1 else "one flight"
    middle = (early + late) / 2
    if (
        len(new) > 1
        and np.isclose(new[0], middle, rtol=1e-13)
        and new[1] in ((early + middle) / 2, (middle + late) / 2)
    ):
        what = f"Halving takes {spent} on {name}, and the heights know more than their signs. What else do they tell?"
        raise Wrong(what, "bisection")
    for which in (0, 1):
        chords = _chords(height, early, late, which)
        if len(new) > 3 and np.allclose(new[:4], chords[:4], rtol=1e-13, atol=0):
            what = f"{spent} on {name}: one of your two times stays where it was. Which two tries know most?"
            raise Wrong(what, "one end never moves")
    if not found and np.isclose(got, _chords(height, early, late, 0)[:1], rtol=1e-13).any():
        raise Wrong(f"A good first try on {name}. Try again from there.", "one chord only")
    if not found and got in heights:
        raise Wrong("That is a height. When is it reached?", "height returned")
    if not found:
        raise Wrong(f"On {name} your time is not within 1e-9 s after {spent}.", nudge=True)
    raise Wrong(f"Found on {name}, but with {spent}: twelve are allowed.", nudge=True)
