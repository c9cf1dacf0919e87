"""Exercises of lesson 11: numbers of an audit, and detectors."""

from collections import namedtuple
from functools import cache

import numpy as np

from hoverslam_lib import published
from hoverslam_lib.booster import FALCON_9
from hoverslam_lib.checks.answers import compare, number, repeatable, takes
from hoverslam_lib.checks.feedback import Wrong, exercise
from hoverslam_lib.descent import LANDING_BURN, Descent, fly
from hoverslam_lib.published import ALL_FAULTS
from hoverslam_lib.trajectory import integrate


@exercise(
    "11.1",
    "what detector 5 sees, and when",
    tests=2,
    hints=(
        "An accelerometer feels the engine, not gravity. Force is mass times acceleration, in N, kg and m/s².",
        "For the mass: to which mass does that force give 30 · 9.81 m/s²? For the time: from when on is it counted?",
        "For the time: how many kilograms lie between the dry mass and yours, and how many go in a second?",
    ),
)
def thirty_g(mass, seconds):
    b = FALCON_9
    right = b.thrust / (30 * 9.81)
    compare(
        number(mass, "the mass"),
        right,
        "for the mass",
        {
            "kN for N": (right / 1e3, "A booster lighter than a suitcase? Look at the unit of the thrust."),
            "gravity added": (b.thrust / (31 * 9.81), "You add the weight. Does an accelerometer feel it?"),
            "gravity subtracted": (b.thrust / (29 * 9.81), "You subtract the weight. Does an accelerometer feel it?"),
            "30 m/s^2": (b.thrust / 30, "That is the mass for 30 m/s². How much is 30 g?"),
            "dry mass": (b.dry_mass, "At the dry mass the engine makes 28.5 g, says the lesson. The line is at 30."),
        },
        rtol=5e-3,
    )
    yield
    late = (b.dry_mass - right) / b.burn_rate
    mistakes = {
        "since ignition": ((b.initial_mass - right) / b.burn_rate, "That is counted from ignition. What is asked?"),
        "before, not after": (-late, "Is your mass reached before the tank should be dry, or after?"),
        "mass alone": (
            right / b.burn_rate,
            "So long lasts all of that mass. How much was burnt since the tank was dry?",
        ),
    }
    compare(number(seconds, "the time"), late, "for the time", mistakes, rtol=2e-2)
    yield


# ---- judging a detector ----------------------------------------------------------------------------------------------

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


def _scored(detector, cases, groups):
    """Yield once for each group that a detector judges right; cases of the later groups are only counted."""
    first = cases[groups[0][0]]
    repeatable(detector, *first.arguments)
    said = {name: _alarm(detector(*(np.copy(a)[()] for a in case.arguments))) for name, case in cases.items()}
    faulty = [name for name, case in cases.items() if case.faulty]
    sound = [name for name in cases if name not in faulty]
    caught, accused = sum(said[name] for name in faulty), sum(said[name] for name in sound)
    score = f"It catches {caught} of {len(faulty)} faulty runs and accuses {accused} of {len(sound)} sound ones."
    if caught == len(faulty) and accused == len(sound):
        raise Wrong(f"{score} An alarm that never stops says nothing.", "always an alarm")
    if caught == 0 and accused == 0:
        raise Wrong(f"{score} Silence is no detector: does your limit ever trip?", "never an alarm")
    if caught == 0 and accused == len(sound):
        raise Wrong(f"{score} It knows them all: which way round is True?", "True for sound")
    for group in groups:
        for name in group:
            case = cases[name]
            if said[name] != case.faulty:
                verb = "It misses" if case.faulty else "It accuses"
                raise Wrong(f"{score} {verb} {case.what}.", nudge=True)
        yield


@cache
def _tables():
    """Sound tables of t, h and v, and faulty ones."""
    fine = fly(Descent(), 60.2, dt=0.02)
    coarse = fly(Descent(), 60.2, dt=0.5)
    weak = fly(LANDING_BURN, 17.0, dt=0.05)
    one, nine = (descent.acceleration(throttle=1.0) for descent in (LANDING_BURN, Descent()))
    euler = integrate(one, 3400.0, -397.0, dt=0.5, t_end=17.0, method="explicit_euler")
    hard = integrate(nine, 14e3, -2300.0, dt=0.5, t_end=10.0)
    up = integrate(lambda t, h, v: -9.81, 1.0, 40.0, dt=0.25, t_end=8.0)
    uneven = np.union1d([1, 2, 4, *range(0, fine.t.size, 23)], range(3010, 3200))
    sound = {
        "fine": (fine, "a sound run with rows 0.02 s apart"),
        "coarse": (coarse, "a sound run with rows 0.5 s apart"),
        "weak": (weak, "a sound run with one engine"),
        "euler": (euler, "a sound run of explicit Euler with rows 0.5 s apart"),
        "burn": (hard, "a sound run that brakes hard between rows 0.5 s apart"),
        "up": (up, "a sound run that goes up and comes down again"),
    }
    cases = {name: Case(False, (r.t, r.h, r.v), what) for name, (r, what) in sound.items()}
    cases["uneven"] = Case(
        False, (fine.t[uneven], fine.h[uneven], fine.v[uneven]), "a sound run whose rows are not at equal steps"
    )
    one_row, part = weak.h.copy(), weak.v.copy()
    one_row[400] -= 40.0
    part[440:] *= -1
    faults = {
        "mirrored": ((fine.t, fine.h, -fine.v), "a run whose v has the wrong sign"),
        "swapped": ((fine.t, fine.v, fine.h), "a run whose columns have changed places"),
        "unit": ((coarse.t, coarse.h / 1e3, coarse.v), "a run whose height is in km"),
        "per hour": ((weak.t, weak.h, 3.6 * weak.v), "a run whose velocity is in km/h"),
        "late": ((fine.t[25:], fine.h[25:], fine.v[:-25]), "a run whose velocities come half a second late"),
        "clock": ((1.5 * weak.t, weak.h, weak.v), "a run whose clock goes wrong"),
        "one row": ((weak.t, one_row, weak.v), "a run in which one height is wrong by 40 m"),
        "slower": ((weak.t, weak.h, 0.9 * weak.v), "a run whose velocity is too small by a tenth"),
        "part": ((weak.t, weak.h, part), "a run whose v changes its sign on the way"),
    }
    return cases | {name: Case(True, arguments, what) for name, (arguments, what) in faults.items()}


@exercise(
    "11.2",
    "a detector that needs no booster",
    tests=4,
    hints=(
        "How far must the booster come between two rows, if its velocity goes from the one value to the other?",
        "Within a step of Δt the velocity changes by at most 300 m/s² · Δt. So how far off can the distance be?",
        "Judge every step by itself, by its own length, and either sign; one bad step is an alarm.",
    ),
)
def matching_columns(detector):
    takes(detector, "t", "h", "v")
    groups = (
        ("fine", "mirrored", "swapped"),
        ("unit", "per hour", "clock", "weak"),
        ("coarse", "euler", "burn", "up", "uneven"),
        ("late", "one row", "slower", "part"),
    )
    yield from _scored(detector, _tables(), groups)


FAULTS = {
    "THRUST_IN_KILONEWTONS": "the thrust in kN",
    "THRUST_SUBTRACTED": "the thrust subtracted",
    "TANK_NEVER_EMPTY": "an endless tank",
    "DRAG_ALWAYS_UP": "drag that always points up",
    "all": "all four faults",
}


@cache
def _runs():
    """Sound runs of the paper's booster at several row spacings, and runs with the four faults."""
    cases = {}
    for t_ignite, dt in ((35.83, 0.25), (40.05, 0.2), (60.2, 0.05), (62.0, 0.25)):
        run = published.fly(t_ignite, dt=dt, faults=())
        what = f"a sound run, lit at {t_ignite:g} s, with rows {dt:g} s apart"
        cases[f"sound {t_ignite} {dt}"] = Case(False, (t_ignite, run.t, run.h, run.v), what)
    for t_ignite, dt in ((60.21104, 0.05), (61.0, 0.5)):
        run = fly(Descent(), t_ignite, dt=dt)
        what = f"a sound run of the library, lit at {t_ignite:g} s, with rows {dt:g} s apart"
        cases[f"library {t_ignite} {dt}"] = Case(False, (t_ignite, run.t, run.h, run.v), what)
    run = fly(Descent(), None, dt=0.2)
    cases["free fall"] = Case(False, (np.inf, run.t, run.h, run.v), "a free fall, never lit")
    alone = [frozenset({fault}) for fault in published.Fault]
    for dt, faults in (*((0.25, chosen) for chosen in (*alone, ALL_FAULTS)), *((0.2, alone[i]) for i in (0, 3))):
        run = published.fly(35.88, dt=dt, faults=faults)
        name = "all" if len(faults) > 1 else next(iter(faults)).name
        what = f"a run with {FAULTS[name]}, lit at 35.88 s, with rows {dt:g} s apart"
        cases[f"{name} {dt}"] = Case(True, (35.88, run.t, run.h, run.v), what)
    return cases


@exercise(
    "11.3",
    "a detector for every step size",
    tests=4,
    hints=(
        "What is left of Δv/Δt when gravity and the engine are taken away is the air. What may the air never do?",
        "Take mass and gravity in the middle of each step. Which steps must be left out, and how many seconds is that?",
        "Whatever your limit is: which error does it allow for, and does that grow with the length of a step?",
    ),
)
def every_step_size(detector):
    takes(detector, "t_ignite", "t", "h", "v")
    cases = _runs()
    names = {
        kind: [name for name in cases if name.startswith(kind)]
        for kind in ("sound", "library", "free", "THRUST", "TANK", "DRAG", "all")
    }
    groups = (
        ["sound 60.2 0.05", "library 60.21104 0.05", *names["THRUST"]],
        names["TANK"] + names["all"],
        names["sound"] + names["library"] + names["free"],
        names["DRAG"],
    )
    yield from _scored(detector, cases, groups)
