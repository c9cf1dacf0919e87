"""Answers that students give to the exercises of lesson 6, beside those that its tables make."""

import math

import numpy as np
from scipy.integrate import cumulative_trapezoid, trapezoid

from hoverslam_lib import Descent

descent = Descent()
booster, planet = descent.booster, descent.planet


def _wind(relative):
    """Drag with a given product of speeds."""
    return lambda h, v, w: -0.5 * planet.air_density(h) * booster.drag_coefficient * booster.area * relative(v, w)


def _by_mass_and_radius(GM, kinetic=0.5):
    """Energy that is missing, with a GM of one's own."""

    def taken(flight):
        p = flight.descent.planet
        E = kinetic * flight.mass * flight.v**2 - GM(p) * flight.mass / (p.radius + flight.h)
        return E[0] - E

    return taken


def _work(flight):
    return cumulative_trapezoid(-flight.descent.drag(flight.h, flight.v), flight.h, initial=0)


def _weight_by_heights(flight):
    change = cumulative_trapezoid(flight.descent.weight(flight.h, flight.mass), flight.h, initial=0)
    return 0.5 * flight.mass * (flight.v[0] ** 2 - flight.v**2) - change


def _changes_the_flight(flight):
    flight.v[:] = abs(flight.v)
    return _work(flight)


# exercise: what was answered, and the name of the mistake if it has one
WRONG = {
    "6.1": [
        ((202, 668, 11.64), None),
        ((193, 668, 11.64), "mass without the root"),
        ((279, 668, 8.4), None),
        ((279, 668, None), None),
    ],
    "6.2": [
        (_wind(lambda v, w: -((v - w) ** 2)), "always up"),
        (_wind(lambda v, w: abs(v) * (v + w)), None),
        (lambda h, v, w: descent.drag(h, v - w) if v > w else -descent.drag(h, w - v), "an if"),
        (lambda h, v, w: sum(descent.drag(h, v - w)) if np.ndim(h) else descent.drag(h, v - w), None),
        (lambda h, v, w: None, None),
    ],
    "6.3": [
        (_by_mass_and_radius(lambda p: p.gravity(0.0) * p.radius), "kinetic energy alone"),
        (_by_mass_and_radius(lambda p: 6.67e-11 * p.mass, kinetic=0.4), None),
        (lambda flight: -trapezoid(flight.descent.drag(flight.h, flight.v), flight.h), "last sample only"),
        (lambda flight: np.concatenate(([0.0], _work(flight))), None),
        (_changes_the_flight, "changes its arguments"),
        (lambda flight: flight.descent.drag(flight.h, flight.v), None),
        (lambda flight: 0 * flight.t, None),
        (lambda flight: "62 %", None),
        (lambda flight: None, None),
    ],
}

RIGHT = {
    "6.1": [(np.float64(280), 667, 8.4 * math.log(4)), (278.0, [669], 11.67)],
    "6.2": [
        _wind(lambda v, w: np.sign(v - w) * (w - v) ** 2),
        lambda h, v, w: descent.drag(h, v - w),
        lambda h, v, w: np.float64(0.25) * (w - v) * abs(w - v) * planet.air_density(h) * math.pi * 1.83**2,
    ],
    "6.3": [
        _work,
        lambda flight: list(_work(flight)),
        _weight_by_heights,
        _by_mass_and_radius(lambda p: 6.67e-11 * p.mass),
    ],
}
