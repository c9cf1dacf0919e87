"""Answers that students give to the exercises of lesson 7."""

import math

import numpy as np

from hoverslam_lib import EARTH


def _balloon(weight=1.0, lift=1.0, drag=lambda v: -abs(v) * v, coefficient=0.5, divide=True, ground=False):
    """A balloon with a ledger of its own."""

    def acceleration(h, v, mass, volume, area):
        at = 0.0 if ground else h
        rho, g = EARTH.air_density(at), EARTH.gravity(at)
        force = -weight * mass * g + lift * rho * volume * g + 0.5 * rho * coefficient * area * drag(v)
        return force / mass if divide else force

    return acceleration


def _as_a_dictionary(h, v, mass, volume, area):
    dynamic_pressure = EARTH.air_density(h) * v**2 / 2
    book = {
        "buoyancy": (volume * EARTH.air_density(h) - mass) * EARTH.gravity(h),
        "drag": -math.copysign(dynamic_pressure * 0.5 * area, v),
    }
    return sum(book.values()) / mass


def _with_buoyancy_in_kg(h, v, mass, volume, area):
    drag = -0.25 * EARTH.air_density(h) * area * abs(v) * v
    return (volume * EARTH.air_density(h) + drag) / mass - EARTH.gravity(h)


def _with_the_weight_of_a_kilogram(h, v, mass, volume, area):
    drag = -0.25 * EARTH.air_density(h) * area * abs(v) * v
    return (volume * EARTH.air_density(h) * EARTH.gravity(h) + drag - EARTH.gravity(h)) / mass


def _with_constant_gravity(h, v, mass, volume, area):
    drag = -0.25 * EARTH.air_density(h) * area * abs(v) * v
    return (volume * EARTH.air_density(h) * 9.8 + drag) / mass - 9.8


def _height(h0, v0, g, a):
    return (v0**2 + 2 * g * h0) / (2 * (a + g))


def _fall(x, h0, v0, g):
    return (v0 + math.sqrt(v0**2 + 2 * g * (h0 - x))) / g


def _braking_with_less(h0, v0, g, a):
    x = _height(h0, v0, g, a - g)
    return _fall(x, h0, v0, g), x


def _from_the_speed_at_the_ground(h0, v0, g, a):
    speed = math.sqrt(v0**2 + 2 * g * h0)
    x = speed**2 / (2 * a)
    return (speed * math.sqrt(1 - g / a) + v0) / g, x


def _at_constant_speed(h0, v0, g, a):
    x = v0**2 / (2 * a)
    return (h0 - x) / max(abs(v0), 1.0), x


def _time_of_the_landing(h0, v0, g, a):
    lit, x = _by_times(h0, v0, g, a)
    return lit + math.sqrt(2 * x / a), x


def _by_times(h0, v0, g, a):
    lit = math.sqrt((v0**2 / g + 2 * h0) / (1 / g + 1 / a))
    return np.array([(lit + v0) / g, lit**2 / 2 / a])


def _by_search(h0, v0, g, a):
    low, high = 0.0, h0 + v0**2 / (2 * g)
    for _ in range(200):
        x = (low + high) / 2
        if v0**2 + 2 * g * (h0 - x) > 2 * a * x:
            low = x
        else:
            high = x
    return [_fall(x, h0, v0, g), x]


# exercise: what was answered, and the name of the mistake if it has one
WRONG = {
    "7.1": [
        ((156.0, 205.0), "not in g"),
        ((16.0, 205.0), "not in g"),
        ((152.9, 152.9), "not divided by the time"),
        ((21.0, 16.0), "swapped"),
        ((9.6 / 1500, 7.3 / 1500), "upside down"),
        ((1500 / 70.3 / 9.81, 1500 / 69.2 / 9.81), "time since the start"),
        ((16.0, 16.0), None),
        ((6.2, 20.1), None),
        ((None, 21.0), None),
        ((16.0, ...), None),
        (("16 g", "21 g"), None),
    ],
    "7.2": [
        (_balloon(drag=lambda v: abs(v) * v), "drag along the motion"),
        (_balloon(drag=lambda v: v), None),
        (_balloon(lift=0.0, divide=False), None),
        (_with_buoyancy_in_kg, "buoyancy in kg"),
        (_with_the_weight_of_a_kilogram, "weight without mass"),
        (_with_constant_gravity, None),
    ],
    "7.3": [
        (_braking_with_less, "gravity counted twice"),
        (_from_the_speed_at_the_ground, "gravity counted twice"),
        (_time_of_the_landing, "time of the landing"),
        (lambda h0, v0, g, a: _by_times(h0, v0, g, a + g), "gravity added"),
        (lambda h0, v0, g, a: (2 * v0 / g - _by_times(h0, v0, g, a)[0], _height(h0, v0, g, a)), "before the start"),
        (_at_constant_speed, None),
        (lambda h0, v0, g, a: _by_times(h0, v0, g, a)[0], None),
        (lambda h0, v0, g, a: (_by_times(h0, v0, g, a)[0], h0), None),
    ],
}

RIGHT = {
    "7.1": [
        (16, 21),
        (np.float64(15.2), np.float64(19.5)),
        (17.5, 22.5),
        (18, 18.5),
        (18, 18),
        (17.9, 18.1),
        (18.2, 18.8),
    ],
    "7.2": [_balloon(), _as_a_dictionary],
    "7.3": [_by_times, _by_search],
}
