"""Exercises of lesson 12: errors that add up, a filter, and the course's project."""

from dataclasses import replace
from functools import cache

import numpy as np

from hoverslam_lib.checks.answers import compare, number, pair, repeatable, takes
from hoverslam_lib.checks.feedback import Wrong, exercise
from hoverslam_lib.descent import (
    CRASH,
    LANDING_BURN,
    OUT_OF_PROPELLANT,
    OUTCOMES,
    SOFT_LANDING,
    SOFT_SPEED,
    STOPPED_TOO_HIGH,
    advance,
    speed_after_fall,
)
from hoverslam_lib.ignition import best_ignition
from hoverslam_lib.integrators import rk4


@exercise(
    "12.1",
    "what a wind tunnel is worth",
    tests=2,
    hints=(
        "Errors that know nothing of each other add up by their squares. Only one of the seven has changed.",
        "For the second number: the share is the window over √(2π) times the width. What is one over it?",
    ),
)
def wind_tunnel(sigma_hover, one_in):
    shifts = {"thrust": 40, "drag": 234, "air": 119, "propellant": -19, "dh": 14, "dv": 35, "delay": -18}
    before = np.array(list(shifts.values()))
    after = np.array([shift / 2 if name == "drag" else shift for name, shift in shifts.items()])
    width, old = np.sqrt(np.sum(after**2)), np.sqrt(np.sum(before**2))
    without = np.sqrt(np.sum(after**2) - 117.0**2)
    mistakes = {
        "all of it halved": (old / 2, "You halve every error. The wind tunnel measures one."),
        "drag taken away": (without, "You leave the drag out. It is halved, not gone."),
        "half the drag taken away": (old - 117, "Widths do not subtract. What adds up instead?"),
        "added, not squared": (np.sum(np.abs(after)), "You add the sizes. How do errors in all directions add up?"),
        "square half": (np.sqrt(np.sum(before**2) - 234**2 / 2), "You halve the square. What is the square of a half?"),
        "no root": (width**2, "That is in m². What is still to do?"),
    }
    compare(number(sigma_hover, "the standard deviation"), width, "for the standard deviation", mistakes, rtol=1e-2)
    yield
    flights = np.sqrt(2 * np.pi) * width / 0.11
    mistakes = {
        "as before": (np.sqrt(2 * np.pi) * old / 0.11, "That is the lesson's number, with the old width."),
        "share": (1 / flights, "That is the share of soft landings. One in how many is it?"),
        "no bell": (width / 0.11, "Nearly: a bell curve has a factor in front of its width."),
        "two pi": (2 * np.pi * width / 0.11, "Nearly: look again at what stands under the root."),
    }
    compare(number(one_in, "the number of flights"), flights, "for the number of flights", mistakes, rtol=6e-2)
    yield


@exercise(
    "12.2",
    "a filter",
    tests=5,
    hints=(
        "Two things happen one after the other: go on to where the booster should be now, then mix with what is seen.",
        "Try a trust of 0, and a trust of 1. What should come out, and what does?",
    ),
)
def blended_look(blend):
    takes(blend, "h", "v", "a", "dt", "h_seen", "v_seen", "trust")
    for h, v, a, dt, h_seen, v_seen, trust in (
        (100.0, -20.0, 5.0, 0.5, 92.0, -17.0, 0.25),
        (800.0, -150.0, 12.0, 0.1, 784.0, -149.5, 0.1),
        (100.0, -20.0, 5.0, 0.5, 92.0, -17.0, 0.0),
    ):
        start, seen = np.array([h, v]), np.array([h_seen, v_seen])
        now = np.array([h + v * dt + a * dt**2 / 2, v + a * dt])
        mixed = now + trust * (seen - now)
        half, new_v = np.array([h + v * dt, now[1]]), np.array([h + now[1] * dt, now[1]])
        mistakes = {
            "trust upside down": (seen + trust * (now - seen), "With a trust of 0 the measurement should not count."),
            "nothing expected": (start + trust * (seen - start), "You mix with the old state. Time has passed since."),
            "no acceleration in h": (half + trust * (seen - half), "Look at h: the velocity changes on the way."),
            "new v in the move": (
                new_v + trust * (seen - new_v),
                "Look at h: it moves as if the velocity at the end had held all the time.",
            ),
            "only expected": (now, "Your measurements do not count."),
            "only h mixed": (np.array([mixed[0], now[1]]), "The velocity was measured, too."),
        }
        got = pair(repeatable(blend, h, v, a, dt, h_seen, v_seen, trust))
        compare(got, mixed, f"from {h:g} m, {v:g} m/s with a trust of {trust:g}", mistakes)
        yield
    compare(pair(blend(100.0, -20.0, 5.0, 0.5, 92.0, -17.0, 1.0)), (92.0, -17.0), "with a trust of 1")
    yield
    h, v, a, rng, offs = 900.0, -130.0, 9.0, np.random.default_rng(12), []
    at, fast = h + 3.0, v + 1.0
    for _ in range(120):
        h, v = h + v * 0.1 + a * 0.005, v + a * 0.1
        at, fast = pair(blend(at, fast, a, 0.1, h + rng.normal(0, 0.5), v + rng.normal(0, 0.2), 0.1))
        offs.append(at - h)
    if not np.std(offs[40:]) < 0.25:
        raise Wrong(f"Over 80 looks with a noise of 0.5 m, it is still off by {np.std(offs[40:]):.2f} m.", nudge=True)
    yield


# ---- the project -----------------------------------------------------------------------------------------------------

PLAN = replace(LANDING_BURN, booster=replace(LANDING_BURN.booster, propellant_mass=7_000.0))
LOWEST = 108_300 / 190_000
LOOK = 0.1
"""The law is asked every so often [s]."""
SIGMA = (0.01, 0.10, 0.05, 100.0, 20.0, 2.0, 0.05)
NOISE = (0.1, 0.05)
"""Of a measured height [m] and velocity [m/s]."""


@cache
def _worlds():
    """One world as planned, 30 that differ, 60 more for noisy eyes: the state of each at ignition, and the noise."""
    booster, rng = PLAN.booster, np.random.default_rng(20_151_222)
    weaker = replace(booster, thrust=0.7 * booster.thrust, burn_rate=0.7 * booster.burn_rate)
    errors = rng.normal(size=(91, len(SIGMA))) * SIGMA
    errors[0] = 0
    thrust, drag, air, propellant, dh, dv, delay = errors.T
    factor = booster.drag_coefficient * booster.area / 2 * PLAN.planet.surface_density * (1 + drag) * (1 + air)
    descents = [
        replace(
            PLAN,
            booster=replace(
                booster,
                thrust=(1 + thrust[i]) * booster.thrust,
                burn_rate=(1 + thrust[i]) * booster.burn_rate,
                drag_coefficient=(1 + drag[i]) * booster.drag_coefficient,
                propellant_mass=booster.propellant_mass + propellant[i],
            ),
            planet=replace(PLAN.planet, surface_density=(1 + air[i]) * PLAN.planet.surface_density),
        )
        for i in range(len(errors))
    ]
    mass = booster.initial_mass + propellant
    t = best_ignition(replace(PLAN, booster=weaker)).t_ignite + delay
    h, v = PLAN.height + dh, PLAN.velocity + dv
    for _ in range(100):
        h, v = rk4(_force(factor, 0.0, mass, 0.0), 0.0, h, v, t / 100)
    noise = rng.normal(size=(600, 2, len(errors))) * np.array(NOISE)[:, None]
    noise[:, :, :31] = 0
    return descents, factor, t, h, v, mass, noise


def _force(factor, thrust, mass, rate):
    """f(t, h, v) of many worlds at once; t is the time since its step began."""
    gravity, scale = PLAN.planet.gravity, PLAN.planet.scale_height

    def f(t, h, v):
        return (thrust - factor * np.exp(-h / scale) * abs(v) * v) / (mass - rate * t) - gravity(h)

    return f


def _asked(law, *measured):
    """What the law says for many states."""
    said = [law(*state) for state in zip(*(column.tolist() for column in measured), strict=True)]
    try:
        throttles = np.asarray(said, dtype=float)
    except (TypeError, ValueError):
        throttles = np.array([np.nan])
    if throttles.shape != (len(said),) or not np.isfinite(throttles).all() or isinstance(said[0], str):
        throttles = np.array([number(value, "the throttle") for value in said])
    return throttles


def _flown(law, which):
    """What becomes of the worlds: as `descent.fly` does it, with a step a look, and all worlds at once."""
    descents, factor, t, h, v, mass, noise = _worlds()
    ends, alive = np.full(len(descents), "", dtype=object), np.arange(len(descents))[which]
    t, h, v, mass, factor = (column[alive] for column in (t, h, v, mass, factor))
    booster = PLAN.booster
    thrust = np.array([descents[i].booster.thrust for i in alive])
    rate = np.array([descents[i].booster.burn_rate for i in alive])
    guess, commands = np.full(len(alive), booster.initial_mass), set()
    for look in noise:
        said = _asked(law, t, h + look[0, alive], v + look[1, alive], guess)
        u = np.clip(said, LOWEST, 1.0)  # what the engine can do
        if len({throttle for _, throttle in commands}) < 3:
            commands |= set(zip(said.tolist(), u.tolist(), strict=True))
        h_new, v_new = rk4(_force(factor, u * thrust, mass, u * rate), 0.0, h, v, LOOK)
        mass_new = mass - u * rate * LOOK
        for j in np.flatnonzero((h_new <= 0) | (v_new >= 0) | (mass_new <= booster.dry_mass)):
            f = descents[alive[j]].acceleration(throttle=float(u[j]), mass=float(mass[j]))
            _, end_h, end_v, event = advance(rk4, f, 0.0, float(h[j]), float(v[j]), LOOK)
            if speed_after_fall(PLAN.planet, end_h, end_v) <= SOFT_SPEED:
                ends[alive[j]] = SOFT_LANDING
            else:
                ends[alive[j]] = {"ground": CRASH, "turn": STOPPED_TOO_HIGH, None: OUT_OF_PROPELLANT}[event]
        going = ends[alive] == ""
        t, h, v, mass = (column[going] for column in (t + LOOK, h_new, v_new, mass_new))
        guess = (guess - u * booster.burn_rate * LOOK)[going]
        factor, thrust, rate, alive = (column[going] for column in (factor, thrust, rate, alive))
        if not len(alive):
            break
    return ends[which], commands


def _lesson_law(h, v, mass):
    a = (max(-v, 0.0) ** 2 - 1) / (2 * max(h, 0.01))
    return np.clip((mass * (a + PLAN.planet.gravity(0.0)) - PLAN.drag(h, v)) / PLAN.booster.thrust, LOWEST, 1.0)


def _enough(ends, asked, what, commands, lesson):
    """Raise `Wrong` unless so many landings are soft; else nothing."""
    count = {kind: int(np.sum(ends == kind)) for kind in OUTCOMES}
    if count[SOFT_LANDING] >= asked:
        return
    others = ", ".join(f"{n} × {kind}" for kind, n in count.items() if n and kind != SOFT_LANDING)
    score = f"{what}, {count['soft landing']} of {len(ends)} land softly, {asked} are asked for; {others}."
    if len(ends) == 1:
        score = f"{what}, it ends like this: {ends[0]}."
    if len({said for said, _ in commands}) == 1:
        raise Wrong(f"{score} Your law commands the same, whatever it sees.", "constant throttle")
    if {throttle for _, throttle in commands} == {LOWEST, 1.0}:
        raise Wrong(f"{score} It commands the lowest or full thrust, nothing in between.", "on and off")
    if lesson:
        raise Wrong(f"{score} It does what the lesson's law does: where does that one divide?", "the lesson's law")
    raise Wrong(score, nudge=True)


@exercise(
    "12.3",
    "the project: a throttle law of your own",
    tests=4,
    hints=(
        "Fly it yourself in a few worlds and plot the throttle: what happens in the last 30 m, and is it needed?",
        "Far up, 0.1 m is nothing; at 1 m it is a lot. Which of your operations makes much of a small error there?",
        "Near the ground, think of a velocity wanted at each height, and act in proportion to what is missing.",
    ),
)
def throttle_project(law):
    takes(law, "t", "h", "v", "mass")
    states = (
        (15.0, 3000.0, -300.0, 33e3),
        (25.0, 700.0, -115.0, 31e3),
        (39.0, 6.0, -8.0, 29e3),
        (40.0, 0.3, -2.5, 29e3),
    )
    said = np.array([number(repeatable(law, *state), "the throttle") for state in states])
    if said.min() >= 20 and said.max() <= 100:
        raise Wrong("A throttle is a share: full thrust is 1.", "in per cent")
    lesson = np.allclose(np.clip(said, LOWEST, 1.0), [_lesson_law(*state[1:]) for state in states], rtol=1e-6)
    yield
    for which, asked, what in (
        (slice(0, 1), 1, "As planned, without errors"),
        (slice(1, 31), 27, "With errors, and perfect eyes"),
        (slice(31, 91), 58, "With errors, and noise in what it sees"),
    ):
        ends, commands = _flown(law, which)
        _enough(ends, asked, what, commands, lesson)
        yield
