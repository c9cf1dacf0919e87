"""Beside the page of lesson 12: a filter among noise, and the worlds of the project."""

from dataclasses import replace
from functools import cache

import numpy as np

from hoverslam_lib.checks.answers import number, repeatable, takes
from hoverslam_lib.checks.feedback import Wrong
from hoverslam_lib.descent import LANDING_BURN, SOFT_LANDING, Descent, coast, fly
from hoverslam_lib.ignition import best_ignition
from hoverslam_lib.integrators import rk4

PLAN = replace(LANDING_BURN, booster=replace(LANDING_BURN.booster, propellant_mass=7_000.0))
LOWEST = 108_300 / 190_000
LOOK = 0.1
"""The law is asked every so often [s]."""
SIGMA = (0.01, 0.10, 0.05, 100.0, 20.0, 2.0, 0.05)
NOISE = (0.1, 0.05)
"""Of a measured height [m] and velocity [m/s]."""


def calmer(blend):
    """Over 80 looks with a noise of 0.5 m: whether it is off by less than 0.25 m"""
    h, v, a, rng, offs = 900.0, -130.0, 9.0, np.random.default_rng(12), []
    at, fast = h + 3.0, v + 1.0
    for _ in range(120):
        h, v = h + v * 0.1 + a * 0.005, v + a * 0.1
        at, fast = blend(at, fast, a, 0.1, h + rng.normal(0, 0.5), v + rng.normal(0, 0.2), 0.1)
        offs.append(at - h)
    return bool(np.std(offs[40:]) < 0.25)


@cache
def worlds():
    """One world as planned, 30 that differ, 60 more for noisy eyes: descent from ignition on, ignition [s], noise."""
    rng = np.random.default_rng(20_151_222)
    errors = rng.normal(size=(91, len(SIGMA))) * SIGMA
    errors[0] = 0
    noise = rng.normal(size=(600, 2, len(errors))) * np.array(NOISE)[:, None]
    noise[:, :, :31] = 0
    t = best_ignition(replace(PLAN, booster=_scaled(PLAN.booster, 0.7))).t_ignite
    found = []
    for i, (thrust, drag, air, propellant, dh, dv, delay) in enumerate(errors):
        booster = replace(
            _scaled(PLAN.booster, 1 + thrust),
            drag_coefficient=(1 + drag) * PLAN.booster.drag_coefficient,
            propellant_mass=PLAN.booster.propellant_mass + propellant,
        )
        planet = replace(PLAN.planet, surface_density=(1 + air) * PLAN.planet.surface_density)
        whole = Descent(booster, planet, PLAN.height + dh, PLAN.velocity + dv)
        _, h, v = coast(whole, t + delay, dt=2.0, step=rk4)[0][-1]
        found.append((replace(whole, height=h, velocity=v), t + delay, noise[:, :, i].T))
    return found


def _midpoint(f, t, h, v, dt):
    """Half the price of Runge-Kutta 4; in steps of `LOOK` as many land softly, with every law tried."""
    a = f(t, h, v)
    a = f(t + dt / 2, h + dt / 2 * v, v + dt / 2 * a)
    return h + dt * (v + dt / 2 * a), v + dt * a


def _scaled(booster, share):
    return replace(booster, thrust=share * booster.thrust, burn_rate=share * booster.burn_rate)


def _pilot(law, t_ignite, noise, commands):
    """A controller that asks the law what it sees, and notes what it answers."""
    looks, guess, rate = zip(*noise.tolist(), strict=True), PLAN.booster.initial_mass, PLAN.booster.burn_rate * LOOK

    def pilot(t, h, v, mass):
        nonlocal guess
        dh, dv = next(looks)
        said = number(law(t_ignite + t, h + dh, v + dv, guess), "the throttle")
        throttle = min(max(said, LOWEST), 1.0)
        guess -= throttle * rate
        commands.add(said)
        return throttle

    return pilot


def _lesson_law(h, v, mass):
    a = (max(-v, 0.0) ** 2 - 1) / (2 * max(h, 0.01))
    return np.clip((mass * (a + PLAN.planet.gravity(0.0)) - PLAN.drag(h, v)) / PLAN.booster.thrust, LOWEST, 1.0)


def throttle_project(law):
    """Judge a throttle law by its flights."""
    takes(law, "t", "h", "v", "mass")
    states = ((3000.0, -300.0, 33e3), (700.0, -115.0, 31e3), (6.0, -8.0, 29e3), (0.3, -2.5, 29e3))
    said = np.array([number(repeatable(law, 40.0, *state), "the throttle") for state in states])
    if said.min() >= 20 and said.max() <= 100:
        raise Wrong(mistake="in per cent")
    lesson = np.allclose(np.clip(said, LOWEST, 1.0), [_lesson_law(*state) for state in states], rtol=1e-6)
    yield
    for which, asked, what in (
        (slice(0, 1), 1, "As planned, without errors"),
        (slice(1, 31), 27, "With errors, and perfect eyes"),
        (slice(31, 91), 58, "With errors, and noise in what it sees"),
    ):
        commands = set()
        outcomes = [
            fly(descent, 0.0, dt=LOOK, method=_midpoint, controller=_pilot(law, t_ignite, noise, commands)).outcome
            for descent, t_ignite, noise in worlds()[which]
        ]
        soft = outcomes.count(SOFT_LANDING)
        if soft < asked:
            others = ", ".join(f"{outcomes.count(end)} × {end}" for end in sorted({*outcomes} - {SOFT_LANDING}))
            score = f"{what}, {soft} of {len(outcomes)} land softly, {asked} are asked for; {others}."
            mistake = "the lesson's law" if lesson else None
            if {*np.clip(list(commands), LOWEST, 1.0)} == {LOWEST, 1.0}:
                mistake = "on and off"
            if len(commands) == 1:
                mistake = "constant throttle"
            raise Wrong(score, mistake, nudge=not mistake, score=score)
        yield


throttle_project.tests = 4
