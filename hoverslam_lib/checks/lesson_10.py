"""Exercises of lesson 10: films of a flight."""

import numpy as np

from hoverslam_lib.checks.answers import array, compare, number, repeatable, takes
from hoverslam_lib.checks.feedback import Wrong, exercise
from hoverslam_lib.descent import Descent, fly
from hoverslam_lib.metrics import observed_order


@exercise(
    "10.1",
    "a film on paper",
    tests=2,
    hints=(
        "Begin with the time that a frame is shown: which times can a GIF store?",
        "From that time and the pace comes the spacing. For the number of frames, draw a short film of three spacings.",
    ),
)
def frame_budget(spacing, frames):
    flown, slowed = 6.0, 5
    shown = 0.03  # the longest whole number of hundredths that still makes 30 a second
    right = shown / slowed
    compare(
        number(spacing, "the spacing"),
        right,
        "for the spacing",
        {
            "no such GIF": (1 / 30 / slowed, "Exactly 30 a second is a rate that a GIF cannot have."),
            "too slow a rate": (0.04 / slowed, "That is 25 frames a second, and at least 30 are asked for."),
            "more frames than needed": (0.02 / slowed, "That is 50 frames a second. Can it be fewer?"),
            "real time": (shown, "With that spacing the film runs in real time."),
            "pace upside down": (shown * slowed, "That film would rush. A slow film needs its frames closer together."),
            "milliseconds": (1e3 * right, "Right digits: which unit is asked for?"),
        },
        rtol=1e-2,
    )
    yield
    count = number(frames, "the number of frames")
    mistakes = {
        "one frame short": (flown / right, "You have counted the spaces. How many frames do three spaces need?"),
        "frames of real time": (flown / shown + 1, "So many frames last 6 s for the viewer, too."),
    }
    compare(count, round(flown / right) + 1, "for the number of frames", mistakes)
    yield


def _kept(t, h, keep):
    return np.array([t[keep], h[keep]])


def _table(got):
    """Times and heights of an answer as an array of two rows."""
    if got is None:
        raise Wrong("The result is None: is a `return` missing?")
    try:
        times, heights = got
        times, heights = (np.atleast_1d(np.asarray(column, dtype=float)) for column in (times, heights))
    except (TypeError, ValueError):
        raise Wrong("The result should be two arrays: the times and the heights that are kept.") from None
    if times.ndim != 1 or times.shape != heights.shape:
        raise Wrong(f"Times and heights should be as many; their shapes are {times.shape} and {heights.shape}.")
    return array([times, heights], (2, len(times)))


@exercise(
    "10.2",
    "the last seconds, whatever the steps",
    tests=4,
    hints=(
        "Take t = 0, 1, 3, 4 s and the last 3 s, and do by hand what your lines do.",
        "No number of rows has to be known at all. Which question can you ask every row about its own time?",
    ),
)
def last_rows(cut):
    takes(cut, "t", "h", "seconds")
    uneven = 10 + np.array([-1.5, -1, -0.5, -0.375, -0.25, -0.125, 0, 0.5, 1, 1.25, 1.5, 1.75, 2, 2.125, 2.375, 2.5])
    flown = fly(Descent(), 61.0, dt=0.5)
    cases = (
        (uneven, 90 - 3 * uneven, 1.5, "with unequal steps"),
        (uneven, 90 - 3 * uneven, 0.25, "for less than one of the steps"),
        (np.arange(0, 5.25, 0.25), np.arange(21.0)[::-1], 9.0, "for more time than there is"),
        (flown.t, flown.h, 8.0, "for a flight of the library"),
    )
    for t, h, seconds, where in cases:
        n = int(seconds / (t[1] - t[0]))
        everything = _kept(t, h, t >= t[0])
        one_more = _kept(t, h, slice(max(len(t) - n - 1, 0), None))
        strict = _kept(t, h, t > t[-1] - seconds)
        mistakes = {
            "nothing mended": (_kept(t, h, slice(-n, None)), "That is what your friend's function gives."),
            "still counts rows": (one_more, "One bug is gone. But are all steps as long as the first?"),
            "boundary lost": (strict, "Look at the oldest row that may stay: is it there?"),
            "keeps everything": (everything, "Some rows are older than that. Where does the run end on its clock?"),
            "first seconds": (_kept(t, h, t <= t[0] + seconds), "These are the first seconds, not the last."),
            "older rows": (_kept(t, h, t <= t[-1] - seconds), "You keep what should go, and drop what should stay."),
        }
        got = _table(repeatable(cut, t, h, seconds))
        compare(got, _kept(t, h, t >= t[-1] - seconds), where, mistakes)
        yield


def _cubic_velocity(t0, h0, v0, t1, h1, v1, t, *, line=1.0, square=3.0, twice=2.0):
    length, rise = t1 - t0, h1 - h0
    s = (t - t0) / length
    first, second, third = length * v0, 3 * rise - length * (2 * v0 + v1), length * (v0 + v1) - 2 * rise
    return (line * first + twice * s * second + square * s**2 * third) / length


@exercise(
    "10.3",
    "the velocity between two rows",
    tests=5,
    hints=(
        "What must come out at the two rows? Try t = t0 and t = t1.",
        "Multiply the cubic out in powers of s, and differentiate by s. Then: how fast does s run, per second?",
    ),
)
def velocity_between(velocity):
    takes(velocity, "t0", "h0", "v0", "t1", "h1", "v1", "t")
    rows = ((2.0, 50.0, -20.0, 2.5, 44.0, -11.0, 2.125), (0.0, 9.0, -2.0, 4.0, -3.0, 1.5, 3.0))
    for row in rows:
        t0, h0, v0, t1, h1, v1, t = row
        length, s = t1 - t0, (t - t0) / (t1 - t0)
        right = _cubic_velocity(*row)
        rise, second = h1 - h0, 3 * (h1 - h0) - length * (2 * v0 + v1)
        third = length * (v0 + v1) - 2 * rise
        d = t - t0
        mistakes = {
            "per step": (
                length * right,
                "At the rows it should be v0 and v1. Is it? You differentiate by s, not by t.",
            ),
            "times the length": (length**2 * right, "Is s long or short when a second passes? You went the wrong way."),
            "straight line": (v0 + s * (v1 - v0), "A straight line from v0 to v1 knows nothing of the heights."),
            "mean velocity": (rise / length, "That is the same at every t. What is it at t0?"),
            "powers forgotten": (
                _cubic_velocity(*row, square=1.0, twice=1.0),
                "Nearly: what does the derivative of s² have in front of it, and that of s³?",
            ),
            "seconds for s": (
                (length * v0 + 2 * d * second + 3 * d**2 * third) / length,
                "Which values does s run through between the rows? Yours is a time in seconds.",
            ),
            "the height": (h0 + s * (length * v0 + s * (second + s * third)), "That is the height at t."),
        }
        compare(number(repeatable(velocity, *row)), right, f"between the rows at {t0:g} s and {t1:g} s", mistakes)
        yield
    row = rows[0][:6]
    ends = [number(velocity(*row, end)) for end in (row[0], row[3])]
    compare(ends, [row[2], row[5]], "at the two rows themselves")
    yield
    times = np.array([2.0, 2.2, 2.3, 2.5])
    got = array(repeatable(velocity, *row, times), (4,))
    compare(got, _cubic_velocity(*row, times), "for an array of times")
    yield
    sizes, errors = np.array([0.4, 0.2, 0.1]), []
    for dt in sizes:
        t0, t1, t = 1.0, 1.0 + dt, 1.0 + 0.3 * dt
        errors.append(abs(number(velocity(t0, np.cos(t0), -np.sin(t0), t1, np.cos(t1), -np.sin(t1), t)) + np.sin(t)))
    compare(round(observed_order(sizes, np.maximum(errors, 1e-300))), 3, "for the order on a spring")
    yield
