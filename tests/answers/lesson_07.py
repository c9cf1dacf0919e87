"""Answers that students give to the exercises of lesson 7, beside those that its tables make."""

import math

import numpy as np

from hoverslam_lib import EARTH


def _balloon(g=EARTH.gravity, lift=1.0, drag=lambda v: -abs(v) * v, kilograms=1.0):
    """A balloon with a ledger of its own."""

    def acceleration(h, v, mass, volume, area):
        rho = EARTH.air_density(h)
        weight = g(h) * (mass if kilograms else 1.0)
        return (lift * rho * volume * g(h) - weight + 0.25 * rho * area * drag(v)) / mass

    return acceleration


def _by_times(h0, v0, g, a):
    lit = math.sqrt((v0**2 / g + 2 * h0) / (1 / g + 1 / a))
    return np.array([(lit + v0) / g, lit**2 / 2 / a])


def _from_the_speed_at_the_ground(h0, v0, g, a):
    speed = math.sqrt(v0**2 + 2 * g * h0)
    return (speed * math.sqrt(1 - g / a) + v0) / g, speed**2 / (2 * a)


def _by_search(h0, v0, g, a):
    low, high = 0.0, h0 + v0**2 / (2 * g)
    for _ in range(200):
        x = (low + high) / 2
        if v0**2 + 2 * g * (h0 - x) > 2 * a * x:
            low = x
        else:
            high = x
    return [(v0 + math.sqrt(v0**2 + 2 * g * (h0 - x))) / g, x]


# exercise: what was answered, and the name of the mistake if it has one
WRONG = {
    "7.1": [
        ((156.0, 205.0), "not in g"),
        ((152.9, 152.9), "not divided by the time"),
        ((9.6 / 1500, 7.3 / 1500), "upside down"),
        ((16.0, 16.0), None),
        ((6.2, 20.1), None),
        ((None, 21.0), None),
        ((16.0, ...), None),
        (("16 g", "21 g"), None),
    ],
    "7.2": [
        (_balloon(drag=lambda v: v), None),
        (_balloon(g=lambda h: 9.8), None),
        (_balloon(lift=0.0, drag=lambda v: 0.0), None),
        (_balloon(kilograms=0.0), "weight without mass"),
    ],
    "7.3": [
        (_from_the_speed_at_the_ground, "gravity counted twice"),
        (lambda h0, v0, g, a: _by_times(h0, v0, g, a + g), "gravity added"),
        (lambda h0, v0, g, a: _by_times(h0, v0, g, a)[0], None),
        (lambda h0, v0, g, a: (_by_times(h0, v0, g, a)[0], h0), None),
    ],
}

RIGHT = {
    "7.1": [(np.float64(15.2), np.float64(19.5)), (17.5, 22.5), (18, 18), (17.9, 18.1)],
    "7.2": [_balloon()],
    "7.3": [_by_times, _by_search],
}
