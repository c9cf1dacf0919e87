"""Beside the page of lesson 11: runs on which detectors are tried."""

from collections import namedtuple
from functools import cache

import numpy as np

from hoverslam_lib import published
from hoverslam_lib.checks.answers import repeatable, takes
from hoverslam_lib.checks.feedback import Wrong
from hoverslam_lib.descent import LANDING_BURN, Descent, fly
from hoverslam_lib.trajectory import integrate

Case = namedtuple("Case", "faulty arguments what")
"""A run, whether it has a fault, and what to say of it if it is judged wrong."""


def _alarm(said):
    """What a detector says, as a bool."""
    if said is None:
        raise Wrong("Your detector says None, neither True nor False: is a `return` missing?")
    if isinstance(said, str | bytes) or callable(said):
        raise Wrong("Your detector should say True or False.")
    said = np.asarray(said)
    if said.size != 1:
        raise Wrong(f"One True or False for the whole run, please; yours has the shape {said.shape}.")
    if said.dtype != bool and said.item() not in (0, 1):
        raise Wrong(f"Your detector should say True or False; it says {said.item()!r}.")
    return bool(said.item())


def _scored(detector, groups):
    """Yield once for each group of cases that a detector judges right; those of the later groups are only counted."""
    cases = [case for group in groups for case in group]
    repeatable(detector, *cases[0].arguments)
    said = {case.what: _alarm(detector(*(np.copy(a)[()] for a in case.arguments))) for case in cases}
    faulty = [case.what for case in cases if case.faulty]
    sound = [case.what for case in cases if not case.faulty]
    caught, accused = sum(said[what] for what in faulty), sum(said[what] for what in sound)
    score = f"It catches {caught} of {len(faulty)} faulty runs and accuses {accused} of {len(sound)} sound ones."
    if caught in (0, len(faulty)) and accused in (0, len(sound)) and (caught > 0) == (accused > 0):
        raise Wrong(mistake="always an alarm" if caught else "never an alarm", score=score)
    if caught == 0 and accused == len(sound):
        raise Wrong(mistake="True for sound", score=score)
    for group in groups:
        for case in group:
            if said[case.what] != case.faulty:
                raise Wrong(f"{score} It {'misses' if case.faulty else 'accuses'} {case.what}.", nudge=True)
        yield


def _sound(run, what):
    return Case(False, (run.t, run.h, run.v), f"a sound run {what}")


def _bad(t, h, v, what):
    return Case(True, (t, h, v), f"a run {what}")


@cache
def _tables():
    """Tables of t, h and v, in the order in which they get harder."""
    fine, coarse = (fly(Descent(), 60.2, dt=dt) for dt in (0.02, 0.5))
    weak = fly(LANDING_BURN, 17.0, dt=0.05)
    one, nine = (descent.acceleration(throttle=1.0) for descent in (LANDING_BURN, Descent()))
    slow = integrate(one, 3400.0, -397.0, dt=0.5, t_end=17.0, method="explicit_euler")
    quick = integrate(nine, 14e3, -2300.0, dt=0.01, t_end=10.0, method="explicit_euler")
    hard = integrate(nine, 14e3, -2300.0, dt=0.5, t_end=10.0)
    up = integrate(lambda t, h, v: -9.81, 1.0, 40.0, dt=0.25, t_end=8.0)
    some = np.union1d([1, 2, 4, *range(0, fine.t.size, 23)], range(3010, 3200))
    one_row, part = weak.h.copy(), weak.v.copy()
    one_row[400] -= 40.0
    part[440:] *= -1
    return (
        (
            _sound(fine, "with rows 0.02 s apart"),
            _bad(fine.t, fine.h, -fine.v, "whose v has the wrong sign"),
            _bad(fine.t, fine.v, fine.h, "whose columns have changed places"),
        ),
        (
            _bad(coarse.t, coarse.h / 1e3, coarse.v, "whose height is in km"),
            _bad(weak.t, weak.h, 3.6 * weak.v, "whose velocity is in km/h"),
            _bad(1.5 * weak.t, weak.h, weak.v, "whose clock goes wrong"),
            _sound(weak, "with one engine"),
        ),
        (
            _sound(coarse, "with rows 0.5 s apart"),
            _sound(slow, "of explicit Euler with rows 0.5 s apart"),
            _sound(quick, "of explicit Euler with rows 0.01 s apart"),
            _sound(hard, "that brakes hard between rows 0.5 s apart"),
            _sound(up, "that goes up and comes down again"),
            Case(False, (fine.t[some], fine.h[some], fine.v[some]), "a sound run whose rows are not at equal steps"),
        ),
        (
            _bad(fine.t[25:], fine.h[25:], fine.v[:-25], "whose velocities come half a second late"),
            _bad(weak.t, one_row, weak.v, "in which one height is wrong by 40 m"),
            _bad(weak.t, weak.h, 0.9 * weak.v, "whose velocity is too small by a tenth"),
            _bad(weak.t, weak.h, part, "whose v changes its sign on the way"),
        ),
    )


def matching_columns(detector):
    """Judge a detector that knows nothing of boosters."""
    yield from _scored(takes(detector, "t", "h", "v"), _tables())


matching_columns.tests = 4


@cache
def _runs():
    """Runs of the paper's booster at several row spacings, sound ones and some with faults."""

    def run(t_ignite, dt, *faults, what="", flown=None):
        flown = flown or published.fly(t_ignite, dt=dt, faults=faults)
        what = f"a {what and 'run with ' + what or 'sound run'}, lit at {t_ignite:g} s, with rows {dt:g} s apart"
        return Case(bool(faults), (t_ignite, flown.t, flown.h, flown.v), what)

    kilonewtons, subtracted, endless, upward = published.Fault
    landing, late = fly(Descent(), 60.21104, dt=0.05), fly(Descent(), 61.0, dt=0.5)
    return (
        (
            run(60.2, 0.05),
            run(60.21104, 0.05, flown=landing),
            run(35.88, 0.25, kilonewtons, what="the thrust in kN"),
            run(35.88, 0.2, kilonewtons, what="the thrust in kN"),
            run(35.88, 0.25, subtracted, what="the thrust subtracted"),
        ),
        (
            run(35.88, 0.25, endless, what="an endless tank"),
            run(35.88, 0.25, *published.Fault, what="all four faults"),
        ),
        (
            *(run(t_ignite, dt) for t_ignite, dt in ((35.83, 0.25), (40.05, 0.2), (62.0, 0.25))),
            run(61.0, 0.5, flown=late),
            run(np.inf, 0.2, flown=fly(Descent(), None, dt=0.2)),
        ),
        (
            run(35.88, 0.25, upward, what="drag that always points up"),
            run(35.88, 0.2, upward, what="drag that always points up"),
        ),
    )


def every_step_size(detector):
    """Judge a detector for the nine-engine booster."""
    yield from _scored(takes(detector, "t_ignite", "t", "h", "v"), _runs())


every_step_size.tests = 4
