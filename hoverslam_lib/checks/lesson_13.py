"""Beside the page of lesson 13: the worlds of the project, and the pilot that asks a law."""

import zlib
from dataclasses import replace
from functools import cache, partial

import numpy as np

from hoverslam_lib.checks.answers import number, repeatable, takes, told_apart
from hoverslam_lib.checks.feedback import Wrong
from hoverslam_lib.descent import LANDING_BURN, SOFT_LANDING, STOPPED_TOO_HIGH, Descent, coast, fly, walk
from hoverslam_lib.ignition import best_ignition
from hoverslam_lib.integrators import rk4

PLAN = replace(LANDING_BURN, booster=replace(LANDING_BURN.booster, propellant_mass=7_000.0))
LOWEST = 108_300 / 190_000
LOOK = 0.1
"""The law is asked every so often [s]."""
SIGMA = (0.01, 0.10, 0.05, 100.0, 20.0, 2.0, 0.05)
NOISE = (0.25, 0.1)
"""Of a measured height [m] and velocity [m/s]."""
SETS, FLIGHTS = 4, 50
"""So many sets of so many flights with noise."""


def wilson(successes, n):
    """The lowest and the highest share that so many of n speak for, with a confidence of 95 % (Wilson 1927)."""
    z = 1.959963984540054
    middle, spread = successes + z**2 / 2, z * (successes * (n - successes) / n + z**2 / 4) ** 0.5
    return (middle - spread) / (n + z**2), (middle + spread) / (n + z**2)


ASKED = next(k for k in range(SETS * FLIGHTS) if wilson(k, SETS * FLIGHTS)[0] > 0.9)
"""So many of them are to be soft: that is 189 of 200."""


def throttle_for(a, h, v, mass):
    """As in the lesson: the throttle that makes the acceleration a, by the plan's numbers."""
    return (mass * (a + PLAN.planet.gravity(0.0)) - PLAN.drag(h, v)) / PLAN.booster.thrust


@cache
def _lit():
    return best_ignition(replace(PLAN, booster=_scaled(PLAN.booster, 0.7)))


def _scaled(booster, share):
    return replace(booster, thrust=share * booster.thrust, burn_rate=share * booster.burn_rate)


def _world(errors):
    """A world as it is when the engine is lit."""
    thrust, drag, air, propellant, dh, dv, delay = errors
    booster = replace(
        _scaled(PLAN.booster, 1 + thrust),
        drag_coefficient=(1 + drag) * PLAN.booster.drag_coefficient,
        propellant_mass=PLAN.booster.propellant_mass + propellant,
    )
    planet = replace(PLAN.planet, surface_density=(1 + air) * PLAN.planet.surface_density)
    whole = Descent(booster, planet, PLAN.height + dh, PLAN.velocity + dv)
    _, h, v = coast(whole, _lit().t_ignite + delay, partial(walk, rk4, dt=2.0))[0][-1]
    return replace(whole, height=h, velocity=v)


def _midpoint(f, t, h, v, dt):
    """Half the price of Runge-Kutta 4; in steps of `LOOK` as many land softly, with every law tried."""
    a = f(t, h, v)
    a = f(t + dt / 2, h + dt / 2 * v, v + dt / 2 * a)
    return h + dt * (v + dt / 2 * a), v + dt * a


def _pilot(law, noise, commands):
    """The lesson's autopilot, which notes what the law answers."""
    looks, mass, rate, memory = iter(noise.tolist()), PLAN.booster.initial_mass, PLAN.booster.burn_rate * LOOK, {}

    def pilot(t, h, v, true_mass):
        nonlocal mass
        dh, dv = next(looks)
        said = number(law(h + dh, v + dv, mass, memory), "the throttle")
        throttle = min(max(said, LOWEST), 1.0)
        mass -= throttle * rate
        commands.add(said)
        return throttle

    return pilot


def _outcomes(law, rng, n, noise, commands):
    """How n flights end, in worlds that differ from the plan if there is a generator."""
    found = []
    for _ in range(n):
        world = _world(rng.normal(size=len(SIGMA)) * SIGMA if rng else np.zeros(len(SIGMA)))
        seen = rng.normal(size=(600, 2)) * NOISE if noise else np.zeros((600, 2))
        pilot = _pilot(law, seen, commands)
        found.append(fly(world, 0.0, dt=LOOK, method=_midpoint, controller=pilot).outcome)
    return found


def _steady(h, v, mass):
    return throttle_for((max(-v, 0.0) ** 2 - 1) / (2 * max(h, 0.01)), h, v, mass)


def _velocity(h, v, mass):
    a = (_lit().v_ignite ** 2 - 1) / (2 * _lit().h_ignite)
    v_w = -np.sqrt(1 + 2 * a * max(h, 0.0))
    return throttle_for(a * v / v_w - 2.0 * (v - v_w), h, v, mass)


STATES = ((3000.0, -300.0, 33e3), (700.0, -115.0, 31e3), (6.0, -8.0, 29e3), (0.3, -2.5, 29e3))


def pilot_project(law):
    """Judge a throttle law by its flights; each version of it meets worlds of its own."""
    takes(law, "h", "v", "mass", "memory")
    said = np.array([number(repeatable(law, *state, {}), "the throttle") for state in STATES])
    if said.min() >= 20 and said.max() <= 100:
        raise Wrong(mistake="in per cent")
    mistake = None
    for name, lessons in (("the steady law", _steady), ("the velocity law", _velocity)):
        if np.allclose(*np.clip([said, [lessons(*state) for state in STATES]], LOWEST, 1.0), rtol=1e-3):
            mistake = name
    yield
    commands, rng = set(), np.random.default_rng(zlib.crc32(told_apart(law).encode()))
    flown = partial(_outcomes, law, commands=commands)

    yield from _enough("As planned, without errors", flown(None, 1, False), 1, 1, None, commands)
    yield from _enough("With errors, and perfect eyes", flown(rng, 30, False), 30, 24, None, commands)
    ends, most = [], SETS * FLIGHTS
    while len(ends) < most and len(ends) - ends.count(SOFT_LANDING) <= most - ASKED:
        ends += flown(rng, FLIGHTS, True)
    yield from _enough("With errors, and noisy eyes", ends, most, ASKED, mistake, commands)


def _enough(what, ends, most, asked, mistake, commands):
    """Yield if enough landed softly, else raise `Wrong` with the count, its interval, and what became of the others."""
    soft, n = ends.count(SOFT_LANDING), len(ends)
    if soft >= asked:
        yield
        return
    low, high = wilson(soft, n)
    others = ", ".join(f"{ends.count(end)} × {end}" for end in sorted({*ends} - {SOFT_LANDING}))
    score = f"{what}: {soft} of {n} land softly ({low:.0%} to {high:.0%}), "
    score += f"{asked} of {most} are asked for; {others}."
    if n == 1:
        score = f"{what}: {ends[0]}."
    limited = {*np.clip(list(commands), LOWEST, 1.0)}
    if len(commands) == 1:
        mistake = "constant throttle"
    elif limited == {LOWEST, 1.0}:
        mistake = "on and off"
    elif ends.count(STOPPED_TOO_HIGH) > (n - soft) / 2:
        mistake = mistake or "stops too high"
    raise Wrong(score, mistake, nudge=not mistake, score=score)


pilot_project.tests, pilot_project.seconds = 4, 30.0
