"""Beside the page of lesson 11: runs on which detectors are tried, by what is to be said of them; most have a fault."""

import copy
from functools import cache

import numpy as np

from hoverslam_lib import published
from hoverslam_lib.checks.answers import digits, repeatable, takes
from hoverslam_lib.checks.feedback import Wrong
from hoverslam_lib.descent import LANDING_BURN, Descent, fly
from hoverslam_lib.trajectory import integrate


def _alarm(said):
    """What a detector says, as a bool."""
    if said is None:
        raise Wrong("Your detector says None, neither True nor False: is a `return` missing?")
    if np.size(said) != 1 or np.asarray(said).item() not in (True, False):
        raise Wrong(f"Your detector should say one True or False for the whole run; it says {digits(said)}.")
    return bool(said)


def _scored(detector, runs):
    """Yield once for each run that a detector judges right, up to the first that it does not; but count them all."""
    repeatable(detector, *next(iter(runs.values())))
    said = {what: _alarm(detector(*copy.deepcopy(arguments))) for what, arguments in runs.items()}
    sound = [what for what in runs if what.startswith("a sound run")]
    accused = sum(said[what] for what in sound)
    caught, faulty = sum(said.values()) - accused, len(runs) - len(sound)
    score = f"It catches {caught} of {faulty} faulty runs and accuses {accused} of {len(sound)} sound ones."
    named = {(faulty, len(sound)): "always an alarm", (0, 0): "never an alarm", (0, len(sound)): "True for sound"}
    if (caught, accused) in named:
        raise Wrong(mistake=named[caught, accused], score=score)
    for what in runs:
        if said[what] is (what in sound):
            raise Wrong(f"{score} It {'accuses' if said[what] else 'misses'} {what}.", nudge=True)
        yield


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
    some, rows = [0, 1, *range(50, quick.t.size, 50)], np.arange(weak.t.size)
    return {
        "a sound run with rows 0.02 s apart": (fine.t, fine.h, fine.v),
        "a run whose v has the wrong sign": (fine.t, fine.h, -fine.v),
        "a run whose columns have changed places": (fine.t, fine.v, fine.h),
        "a run whose height is in km": (coarse.t, coarse.h / 1e3, coarse.v),
        "a run whose velocity is in km/h": (weak.t, weak.h, 3.6 * weak.v),
        "a run whose clock goes wrong": (1.5 * weak.t, weak.h, weak.v),
        "a sound run with one engine": (weak.t, weak.h, weak.v),
        "a sound run with rows 0.5 s apart": (coarse.t, coarse.h, coarse.v),
        "a sound run of explicit Euler with rows 0.5 s apart": (slow.t, slow.h, slow.v),
        "a sound run of explicit Euler with rows 0.01 s apart": (quick.t, quick.h, quick.v),
        "a sound run that brakes hard between rows 0.5 s apart": (hard.t, hard.h, hard.v),
        "a sound run that goes up and comes down again": (up.t, up.h, up.v),
        "a sound run whose rows are not at equal steps": (quick.t[some], quick.h[some], quick.v[some]),
        "a run whose velocities come half a second late": (fine.t[25:], fine.h[25:], fine.v[:-25]),
        "a run in which one height is wrong by 40 m": (weak.t, weak.h - 40.0 * (rows == 400), weak.v),
        "a run whose velocity is too small by a tenth": (weak.t, weak.h, 0.9 * weak.v),
        "a run whose v changes its sign on the way": (weak.t, weak.h, np.where(rows < 440, weak.v, -weak.v)),
    }


def matching_columns(detector):
    """Judge a detector that knows nothing of boosters."""
    yield from _scored(takes(detector, "t", "h", "v"), _tables())


@cache
def _runs():
    """Runs of the nine-engine booster at several row spacings: the ignition time, t, h and v."""
    kilonewtons, subtracted, endless, upward = published.Fault
    airless = ": there is hardly any air up there, so what you find left over comes from your own sums"
    short = ", which breaks off half a second after its rest: a strong fault, and too short for a sum to grow large"
    found = {}
    for what, faults, t_ignite, dt, *more in (
        ("a sound run", (), 60.2, 0.05),
        ("a run with the thrust in kN", [kilonewtons], 35.88, 0.25),
        ("a run with the thrust subtracted", [subtracted], 35.88, 0.25),
        ("a run with an endless tank", [endless], 35.88, 0.25),
        ("a run with all four faults", published.ALL_FAULTS, 35.88, 0.25),
        ("a sound run", None, 60.21104, 0.05),
        ("a sound run", (), 35.83, 0.25),
        ("a sound run", (), 40.05, 0.2),
        ("a sound run", (), 62.0, 0.25),
        ("a sound run", None, 61.0, 0.5),
        ("a sound run", None, np.inf, 0.2),
        ("a sound run", None, 5.0, 0.5, airless),
        ("a run with drag that always points up", [upward], 35.88, 0.25),
        ("a run with drag that always points up", [upward], 35.88, 0.2),
        ("a run with drag that always points up", [upward], 60.2, 0.05, short),
    ):
        if faults is None:  # by the library, whose steps end on each switch
            run = fly(Descent(), t_ignite if t_ignite < np.inf else None, dt=dt)
        elif short in more:  # the same run, without the climb
            f = published.acceleration(t_ignite, faults)
            run = integrate(f, 150e3, -2000.0, dt=dt, t_end=72.5, method="rkn4")
        else:
            run = published.fly(t_ignite, dt=dt, faults=faults)
        lit = f"lit at {t_ignite:g} s" if t_ignite < np.inf else "never lit"
        found[f"{what}, {lit}, with rows {dt:g} s apart{''.join(more)}"] = t_ignite, run.t, run.h, run.v
    return found


def every_step_size(detector):
    """Judge a detector for the nine-engine booster."""
    yield from _scored(takes(detector, "t_ignite", "t", "h", "v"), _runs())


matching_columns.tests, every_step_size.tests = 17, 15
