"""Answers that students give to the exercises of lesson 6."""

import math

import numpy as np
from scipy.integrate import cumulative_trapezoid, trapezoid

from hoverslam_lib import Descent

descent = Descent()
booster, planet = descent.booster, descent.planet


def _wind(relative, half=0.5, density=planet.air_density, area=booster.area):
    """Drag with a given product of speeds."""
    return lambda h, v, w: -half * density(h) * booster.drag_coefficient * area * relative(v, w)


def _with_if(h, v, wind):
    if v > wind:
        return descent.drag(h, abs(v - wind))
    return -descent.drag(h, abs(v - wind))


def _by_math(h, v, wind):
    rho = planet.surface_density * math.exp(-h / planet.scale_height)
    return -0.5 * rho * booster.drag_coefficient * booster.area * abs(v - wind) * (v - wind)


def _by_mass_and_radius(GM, sign=-1):
    """Energy that is missing, with a GM of one's own."""

    def taken(flight):
        p = flight.descent.planet
        E = flight.mass * flight.v**2 / 2 + sign * GM(p) * flight.mass / (p.radius + flight.h)
        return E[0] - E

    return taken


def _energy(g=None, kinetic=0.5, of=None):
    """Energy that is missing, with a potential energy to choose."""

    def taken(flight):
        here = flight.descent.planet if of is None else of
        E = kinetic * flight.mass * flight.v**2
        if g is None:
            E = E - flight.mass * here.gravity(flight.h) * (here.radius + flight.h)
        else:
            E = E + flight.mass * (g(here, flight.h) if callable(g) else g) * flight.h
        return E[0] - E

    return taken


def _all_forces(flight):
    d = flight.descent
    return cumulative_trapezoid(
        (d.drag(flight.h, flight.v) - d.weight(flight.h, flight.mass)) * flight.v, flight.t, initial=0
    )


def _work(flight):
    return cumulative_trapezoid(-flight.descent.drag(flight.h, flight.v), flight.h, initial=0)


def _power(flight):
    taken = [0.0]
    power = [-flight.descent.drag(h, v) * v for h, v in zip(flight.h, flight.v, strict=True)]
    for i in range(1, len(power)):
        taken.append(taken[-1] + (power[i - 1] + power[i]) / 2 * (flight.t[i] - flight.t[i - 1]))
    return taken


def _weight_by_heights(flight):
    d = flight.descent
    change = cumulative_trapezoid(d.weight(flight.h, flight.mass), flight.h, initial=0)
    return 0.5 * flight.mass * (flight.v[0] ** 2 - flight.v**2) - change


def _own_mass(flight, of=None):
    m = booster.initial_mass
    p = of or flight.descent.planet
    E = m * flight.v**2 / 2 - m * p.gravity(flight.h) * (p.radius + flight.h)
    return E[0] - E


def _left(flight):
    p = flight.descent.planet
    up = flight.mass * (
        p.gravity(flight.h[-1]) * (p.radius + flight.h[-1]) - p.gravity(flight.h) * (p.radius + flight.h)
    )
    return flight.mass * flight.v**2 / 2 + up


def _changes_the_flight(flight):
    flight.v[:] = abs(flight.v)
    return _energy()(flight)


def _start(flight):
    p = flight.descent.planet
    return flight.mass[0] * (flight.v[0] ** 2 / 2 - p.gravity(flight.h[0]) * (p.radius + flight.h[0]))


def _sums(flight, y, x):
    total = [0.0]
    for i in range(len(x) - 1):
        total.append(total[-1] + y[i] * (x[i + 1] - x[i]))
    return total


# exercise: what was answered, and the name of the mistake if it has one
WRONG = {
    "6.1": [
        ((192.6, 668, 11.64), "mass without the root"),
        ((587, 668, 11.64), "upside down"),
        ((405, 668, 11.64), "mass does not matter"),
        ((293, 668, 11.64), "mass of the propellant"),
        ((202, 668, 11.64), None),
        ((-279, 668, 11.64), "negative"),
        ((279, -668, 11.64), "negative"),
        ((279, 668, -11.64), "negative"),
        ((279, 1101, 11.64), "density without the root"),
        ((279, 246, 11.64), "upside down"),
        ((279, 405, 11.64), "same as on the ground"),
        ((279, 461, 11.64), "empty tank"),
        ((279, 668, 5.82), "half the density"),
        ((279, 668, 11_645), "in metres"),
        ((279, 668, 16.8), "linear"),
        ((279, 668, 5.06), "logarithm to base 10"),
        ((279, 668, 8.4), None),
        ((279, 668, None), None),
    ],
    "6.2": [
        (_wind(lambda v, w: -((v - w) ** 2)), "always up"),
        (_wind(lambda v, w: -abs(v - w) * (v - w)), "pushes along"),
        (_wind(lambda v, w: abs(v) * v), "wind ignored"),
        (_wind(lambda v, w: abs(v + w) * (v + w)), "wind added"),
        (_wind(lambda v, w: abs(v) * (v - w)), "one factor still"),
        (_wind(lambda v, w: abs(v - w) * v), "one factor still"),
        (_wind(lambda v, w: abs(v) * v + abs(w) * w), None),
        (_wind(lambda v, w: abs(v) * v - abs(w) * w), "two drags"),
        (_wind(lambda v, w: abs(v - w) * (v - w), half=1), "without the half"),
        (_wind(lambda v, w: abs(v - w) * (v - w), density=lambda h: 1.3), "air of the ground"),
        (_wind(lambda v, w: abs(v - w) * (v - w), area=1), "no area"),
        (_wind(lambda v, w: abs(v - w) * (v - w), area=2 * booster.area / booster.radius), "circumference"),
        (_wind(lambda v, w: abs(v - w) * (v - w), area=math.pi * booster.radius), "radius not squared"),
        (_wind(lambda v, w: v - w), None),
        (_wind(lambda v, w: (v - w) ** 2), "pushes along"),
        (lambda h, v, w: descent.drag(h, v - w) / booster.initial_mass, "an acceleration"),
        (_with_if, None),
        (_by_math, None),
    ],
    "6.3": [
        (lambda flight: -_energy()(flight), "negative"),
        (lambda flight: cumulative_trapezoid(flight.descent.drag(flight.h, flight.v), flight.h, initial=0), "negative"),
        (_left, "what is left"),
        (lambda flight: flight.mass * (flight.v[0] ** 2 - flight.v**2) / 2, "kinetic energy alone"),
        (_by_mass_and_radius(lambda p: p.gravity(0.0) * p.radius), "kinetic energy alone"),
        (lambda flight: -_all_forces(flight), "kinetic energy alone"),
        (_by_mass_and_radius(lambda p: 6.6743e-11 * p.mass, sign=1), "sign of the potential energy"),
        (_energy(kinetic=0), "no kinetic energy"),
        (_energy(lambda p, h: p.gravity(h)), "g of the place times h"),
        (_energy(9.81), "flat g"),
        (_energy(9.80665), "flat g"),
        (_energy(lambda p, h: p.gravity(0.0)), "flat g of the ground"),
        (
            lambda flight: cumulative_trapezoid(flight.descent.drag(flight.h, flight.v), flight.t, initial=0),
            "force over time",
        ),
        (_energy(kinetic=1), "without the half"),
        (_all_forces, "all forces"),
        (_energy(of=planet), "the notebook's planet"),
        (_own_mass, "the notebook's mass"),
        (lambda flight: _own_mass(flight, of=planet), "the notebook's booster"),
        (
            lambda flight: -cumulative_trapezoid(descent.drag(flight.h, flight.v) * flight.v, flight.t, initial=0),
            "the notebook's drag",
        ),
        (lambda flight: _energy()(flight)[-1], "last sample only"),
        (lambda flight: -trapezoid(flight.descent.drag(flight.h, flight.v), flight.h), "last sample only"),
        (lambda flight: cumulative_trapezoid(-flight.descent.drag(flight.h, flight.v), flight.h), None),
        (_changes_the_flight, "changes its arguments"),
        (lambda flight: flight.descent.drag(flight.h, flight.v), None),
        (lambda flight: 0 * flight.t, None),
        (lambda flight: -_energy()(flight) + _start(flight), "what is left, counted from infinity"),
        (lambda flight: _sums(flight, -flight.descent.drag(flight.h, flight.v), flight.h), "force of the old sample"),
        (
            lambda flight: _sums(flight, -flight.descent.drag(flight.h, flight.v) * flight.v, flight.t),
            "power of the old sample",
        ),
    ],
}

RIGHT = {
    "6.1": [(279.2, 667.7, 11.64), (np.float64(280), 667, 8.4 * math.log(4)), (278.0, [669], 11.67)],
    "6.2": [
        _wind(lambda v, w: abs(v - w) * (v - w)),
        _wind(lambda v, w: np.sign(v - w) * (w - v) ** 2),
        lambda h, v, w: descent.drag(h, v - w),
        lambda h, v, w: np.float64(0.25) * (w - v) * abs(w - v) * planet.air_density(h) * math.pi * 1.83**2,
    ],
    "6.3": [_energy(), _work, _power, _weight_by_heights, _by_mass_and_radius(lambda p: 6.67e-11 * p.mass)],
}
