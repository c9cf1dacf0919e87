"""Exercises of lesson 7: the hoverslam, flown twice."""

from functools import cache
from math import sqrt

import numpy as np

from hoverslam_lib import published
from hoverslam_lib.checks.answers import compare, number, pair, repeatable, takes
from hoverslam_lib.checks.feedback import Wrong, exercise
from hoverslam_lib.descent import Descent, fly
from hoverslam_lib.planet import EARTH


@cache
def _moments():
    """When each of the lesson's two flights passes through -2000 m/s and -500 m/s, after its fastest fall [s]."""
    found = []
    for run in (published.fly(35.88, dt=0.02), fly(Descent(), 60.2)):
        slower = slice(int(np.argmin(run.v)), int(np.flatnonzero(run.v > -100)[0]))
        found.append(np.interp([-2000.0, -500.0], run.v[slower], run.t[slower]))
    return found


@exercise(
    "7.1",
    "how hard they brake",
    tests=2,
    hints=(
        "On the steep part of each curve, when is v = -2000 m/s, and when is it -500 m/s?",
        "Divide the change of velocity by the time that it takes, and then by 9.81 m/s².",
    ),
)
def braking(printed, ledger):
    rates = [1500 / (end - start) / 9.81 for start, end in _moments()]
    if all(
        np.isclose(number(got, name), rate, rtol=0.15)
        for got, name, rate in zip(
            (printed, ledger), ("your first answer", "your second answer"), rates[::-1], strict=True
        )
    ):
        raise Wrong("Are your two numbers in the order that was asked for?", "swapped")
    for got, name, rate, (start, end) in zip(
        (printed, ledger), ("as printed", "by our ledger"), rates, _moments(), strict=True
    ):
        mistakes = {
            "not in g": (rate * 9.81, "That is in m/s². How many times 9.81 m/s² is it?"),
            "wrong sign": (-rate, "The velocity goes from -2000 to -500 m/s. Does it grow or fall?"),
            "upside down": ((end - start) / 1500, "That is seconds for each m/s: which of the two divides the other?"),
            "time since the start": (1500 / end / 9.81, "Which time does the change from -2000 to -500 m/s take?"),
        }
        compare(number(got), rate, f"for the flight {name}", mistakes, rtol=0.15)
        yield


def _balloon(h, v, mass, volume, area):
    """Weight, buoyancy and drag [N]."""
    rho, g = EARTH.air_density(h), EARTH.gravity(h)
    return -mass * g, rho * volume * g, -0.5 * rho * 0.5 * area * abs(v) * v


@exercise(
    "7.2",
    "a ledger for a balloon",
    tests=5,
    hints=(
        "Write the three forces down one by one, each in newtons and with its sign. What turns their sum into m/s²?",
        "Set two of the three forces to 0 in your mind, one after the other: does the third one point where it should?",
    ),
)
def balloon(acceleration):
    takes(acceleration, "h", "v", "mass", "volume", "area")
    for h, v, mass, volume, area in (
        (12e3, 6.0, 900.0, 4000.0, 300.0),
        (3e3, -7.0, 1500.0, 1100.0, 150.0),
        (20e3, -2.0, 300.0, 2500.0, 200.0),
        (0.0, 0.0, 500.0, 700.0, 90.0),
        (31e3, 4.0, 700.0, 30e3, 1200.0),
    ):
        weight, lift, drag = _balloon(h, v, mass, volume, area)
        ground = sum(_balloon(0.0, v, mass, volume, area))
        along = f"Your drag pushes the balloon on as it {'rises' if v > 0 else 'sinks'}: try both ways, up and down."
        mistakes = {
            "buoyancy down": ((weight - lift + drag) / mass, "Which way does the air carry a balloon at rest?"),
            "drag along the motion": ((weight + lift - drag) / mass, along),
            "force": (weight + lift + drag, "That is a force, in newtons. Which acceleration does it make?"),
            "no drag": ((weight + lift) / mass, "A balloon without drag. Which three forces are in your ledger?"),
            "no buoyancy": ((weight + drag) / mass, "That falls like a stone: which three forces are in your ledger?"),
            "buoyancy in kg": (
                (weight + lift / EARTH.gravity(h) + drag) / mass,
                "Check the unit of your buoyancy: is it newtons?",
            ),
            "air of the ground": (
                ground / mass,
                "You use the air and the gravity of the ground. Where is the balloon?",
            ),
            "linear in v": (
                (weight + lift + drag / (abs(v) or 1.0)) / mass,
                "Check the unit of your drag: is it newtons?",
            ),
            "factor missing": (
                (weight + lift + 2 * drag) / mass,
                "Your drag is too large: are both of its factors ½ in it?",
            ),
            "weight up": ((-weight + lift + drag) / mass, "Which way does your weight point?"),
            "weight without mass": (
                (weight / mass + lift + drag) / mass,
                "Check the unit of your weight: is it newtons?",
            ),
        }
        got = number(repeatable(acceleration, h, v, mass, volume, area))
        compare(got, (weight + lift + drag) / mass, f"at {h / 1e3:g} km with v = {v:g} m/s", mistakes)
        yield


@exercise(
    "7.3",
    "a hoverslam on paper",
    tests=5,
    hints=(
        "Call the ignition height x. How fast is it there after the fall? From how fast can it stop over x?",
        "At constant acceleration, v² changes by twice the acceleration times the distance. Use it once for each part.",
    ),
)
def paper_hoverslam(ignite):
    takes(ignite, "h0", "v0", "g", "a")
    for h0, v0, g, a in (
        (2000.0, -50.0, 1.6, 5.0),
        (900.0, 20.0, 9.8, 14.0),
        (500.0, 0.0, 3.7, 6.0),
        (150e3, -2000.0, 9.5, 90.0),
        (40.0, -1.0, 0.1, 0.3),
    ):

        def fallen(x, h0=h0, v0=v0, g=g):
            """Velocity and time of a fall to the height x."""
            v = -sqrt(max(v0**2 + 2 * g * (h0 - x), 0.0))
            return v, (v0 - v) / g

        x = (v0**2 + 2 * g * h0) / (2 * (a + g))
        v, t = fallen(x)
        energy = v0**2 + 2 * g * h0
        x_ground, x_more, x_rest = energy / (2 * a), energy / (2 * a + 4 * g), g * h0 / (a + g)
        mistakes = {
            "gravity counted twice": (
                (fallen(x_ground)[1], x_ground),
                "That suits the speed that it would have at the ground, or a brake of a - g. Which two are at work?",
            ),
            "gravity added": (
                (fallen(x_more)[1], x_more),
                "Your brake is stronger than a. Read again what a contains.",
            ),
            "height fallen": (((v0 - v) / g, h0 - x), "Your time is right. Is your height counted from the ground?"),
            "before the start": (
                ((v0 + v) / g, x),
                "The height is right. Your time lies before the start: which root?",
            ),
            "starts at rest": ((sqrt(2 * (h0 - x_rest) / g), x_rest), "Yours falls from rest. Where does v0 come in?"),
            "sign of v0": (((-v0 - v) / g, x), "The height is right. In the time, look at the sign of v0."),
            "start forgotten in the time": (
                (-v / g, x),
                "The height is right. Which velocity does the fall begin with?",
            ),
            "time of the braking": ((-v / a, x), "The height is right. Your time is that of the braking."),
            "time of the landing": (
                ((v0 - v) / g - v / a, x),
                "The height is right. Your time is that of the landing.",
            ),
            "swapped": ((x, t), "Are your two numbers in the order that was asked for?"),
        }
        got = pair(repeatable(ignite, h0, v0, g, a), ("t_ignite", "h_ignite"))
        v_lit, h_lit = v0 - g * got[0], h0 + v0 * got[0] - g * got[0] ** 2 / 2
        above = h_lit - v_lit**2 / (2 * a)
        stops = f"braked from that time on it stops at h = {above:.4g} m"
        if abs(above) < 1e-6 * h0:
            stops = "the time lands it, but the height is another"
        compare(got, (t, x), f"for h0 = {h0:g} m, v0 = {v0:g} m/s ({stops})", mistakes)
        yield
