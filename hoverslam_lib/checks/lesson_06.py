"""Exercises of lesson 6: the forces on the booster."""

import math

import numpy as np

from hoverslam_lib.booster import FALCON_9, FALCON_9_LANDING_BURN
from hoverslam_lib.checks.answers import array, compare, number, repeatable, takes
from hoverslam_lib.checks.feedback import Wrong, exercise
from hoverslam_lib.descent import Descent, fly
from hoverslam_lib.planet import EARTH, MARS, MOON


def _terminal(h, mass):
    drag = 0.5 * EARTH.air_density(h) * FALCON_9.drag_coefficient * FALCON_9.area
    return math.sqrt(mass * EARTH.gravity(h) / drag)


@exercise(
    "6.1",
    "how terminal velocity scales",
    tests=3,
    hints=(
        "Which letters in the formula for the terminal velocity change, and do they stand under the root?",
        "Divide the formula for the new case by the one for 405 m/s: nearly everything cancels.",
    ),
)
def terminal_predictions(empty, high, height):
    full, dry, thin = FALCON_9.initial_mass, FALCON_9.dry_mass, EARTH.scale_height
    ground = _terminal(0.0, full)
    unsigned = "The size is right. But a terminal velocity has no minus sign here: the 405 m/s have none, either."
    mistakes = {
        "mass without the root": (ground * dry / full, "Half the mass, half the speed? Look where m stands."),
        "upside down": (ground * math.sqrt(full / dry), "Does an empty booster fall faster than a full one?"),
        "negative": (-_terminal(0.0, dry), unsigned),
        "mass does not matter": (ground, "Without air the mass would not matter. And with it?"),
        "mass of the propellant": (
            ground * math.sqrt(FALCON_9.propellant_mass / full),
            "With an empty tank, which mass is left: that of the propellant, or the other one?",
        ),
    }
    compare(number(empty, "my_empty"), _terminal(0.0, dry), "for the empty tank", mistakes, rtol=0.01)
    yield
    mistakes = {
        "density without the root": (ground * math.e, "The density falls by a factor e. And the speed?"),
        "upside down": (ground / math.sqrt(math.e), "Is a fall through thinner air slower?"),
        "negative": (-_terminal(thin, full), unsigned),
        "same as on the ground": (ground, "The air is thinner up there. Which letter of the formula is that?"),
        "empty tank": (_terminal(thin, dry), "The tank is full again in this question."),
    }
    compare(number(high, "my_high"), _terminal(thin, full), "one scale height up", mistakes, rtol=0.01)
    yield
    right = 2 * thin / 1000 * math.log(2)
    mistakes = {
        "half the density": (right / 2, "There the density is half as large. Is the terminal velocity twice as large?"),
        "negative": (-right, "The size is right. But is the air thinner below the ground?"),
        "in metres": (1000 * right, "The number is asked in kilometres."),
        "linear": (2 * thin / 1000, "The air does not thin out in a straight line."),
        "logarithm to base 10": (
            2 * thin / 1000 * math.log10(2),
            "Which logarithm undoes a power of e? In Python it is math.log.",
        ),
    }
    compare(number(height, "my_height_km"), right, "for the height", mistakes, rtol=0.01)
    yield


@exercise(
    "6.2",
    "drag in a wind",
    tests=4,
    hints=(
        "Sit on the booster and hold your hand out: how fast does the air come, and from where?",
        "Try three cases: no wind; booster and air at the same velocity; the booster at rest in an updraught.",
    ),
)
def drag_in_wind(drag):
    takes(drag, "h", "v", "wind")
    k = 0.5 * FALCON_9.drag_coefficient * FALCON_9.area
    cases = (
        (1000.0, -300.0, 40.0, "h = 1000 m, v = -300 m/s, wind = 40 m/s"),
        (2500.0, 60.0, -25.0, "h = 2500 m, v = 60 m/s, wind = -25 m/s"),
        (500.0, 10.0, 35.0, "h = 500 m, v = 10 m/s, wind = 35 m/s"),
        (
            np.array([0.0, 9e3]),
            np.array([-90.0, 20.0]),
            np.array([-130.0, 15.0]),
            "the arrays h = [0, 9000], v = [-90, 20], wind = [-130, 15]",
        ),
    )
    for h, v, w, where in cases:
        rho, against = EARTH.air_density(h), v - w
        mistakes = {
            "always up": (k * rho * against**2, "Does the air still push upward when the booster climbs through it?"),
            "pushes along": (
                k * rho * abs(against) * against,
                "Yours pushes a booster that falls in still air farther down.",
            ),
            "wind ignored": (-k * rho * abs(v) * v, "The same as in still air: where does the wind come in?"),
            "wind added": (
                -k * rho * abs(v + w) * (v + w),
                "A booster that moves just as the air does: what drag has it in reality, and in your formula?",
            ),
            "one factor still": (
                -k * rho * abs(v) * against,
                "Two factors of the formula are a speed. Is the same speed meant in both?",
            ),
            "two drags": (
                -k * rho * (abs(v) * v - abs(w) * w),
                "You take two drags apart. But there is one air, and it comes with one speed.",
            ),
            "without the half": (-2 * k * rho * abs(against) * against, "Just twice too much: which factor is lost?"),
            "an acceleration": (
                -k * rho * abs(against) * against / FALCON_9.initial_mass,
                "That is an acceleration. Asked is the force.",
            ),
            "air of the ground": (
                -k * EARTH.surface_density * abs(against) * against,
                "The density is that of the ground. How high is the booster?",
            ),
            "no area": (
                -k * rho * abs(against) * against / FALCON_9.area,
                "An audit of the dimensions finds what is missing: is yours a force?",
            ),
            "radius not squared": (
                -k * rho * abs(against) * against / FALCON_9.radius,
                "An audit of the dimensions finds what is missing: is your area in m²?",
            ),
            "circumference": (
                -k * rho * abs(against) * against * 2 / FALCON_9.radius,
                "An audit of the dimensions finds what is wrong: is your area in m²?",
            ),
        }
        try:
            got = repeatable(drag, h, v, w)
        except (TypeError, ValueError) as error:
            if np.ndim(h) == 0:
                raise
            raise Wrong(
                f"For arrays it raises {type(error).__name__}: {error}. Is something in it made for single numbers "
                "only, such as `math.exp` or an `if`? NumPy has the like for arrays: `np.exp`, `np.where`."
            ) from None
        got = array(got, np.shape(h)) if np.ndim(h) else number(got)
        compare(got, -k * rho * abs(against) * against, f"for {where}", mistakes)
        yield


def _energies(flight, planet, mass):
    """Kinetic and potential energy [J] of a flight, were they those of this planet and this mass."""
    return mass * flight.v**2 / 2, -mass * planet.gravity(flight.h) * (planet.radius + flight.h)


def _running(y, x):
    """Integral of y from the first sample to each, by trapezoids."""
    return np.concatenate(([0.0], np.cumsum((y[1:] + y[:-1]) / 2 * np.diff(x))))


@exercise(
    "6.3",
    "what the air has taken",
    tests=4,
    hints=(
        "Two ways lead there: the energy that the booster still has, or the work of one force, step by step.",
        "Make both and compare them: where they part, one of them is wrong. And what must come out without air?",
    ),
)
def energy_for_the_air(taken):
    takes(taken, "flight")
    for descent, where in (
        (Descent(), "the fall of the lesson"),
        (Descent(FALCON_9_LANDING_BURN, MARS, 120e3, -1500.0), "a lighter booster on Mars"),
        (Descent(FALCON_9_LANDING_BURN, EARTH, 30e3, 500.0), "the lighter booster on Earth, thrown up at 500 m/s"),
        (Descent(FALCON_9_LANDING_BURN, MOON, 100e3, -100.0), "a fall on the Moon"),
    ):
        flight = fly(descent, None, dt=0.1)
        mass, planet = flight.mass, descent.planet
        kinetic, potential = _energies(flight, planet, mass)
        right = kinetic[0] + potential[0] - kinetic - potential
        scale = kinetic[0] + potential[0] + mass[0] * planet.gravity(0.0) * planet.radius
        close = 2e-4 * scale
        drag = descent.drag(flight.h, flight.v)
        flat = "Your gravity is the same at every height: over so many kilometres that shows."
        others = "One of these is not this flight's own: planet, booster, mass. Is something taken from the notebook?"
        mistakes = {
            "negative": (-right, "The size is right. Is it positive when the air has taken something?"),
            "what is left": (kinetic - potential[-1] + potential, "That is what is left to the booster."),
            "what is left, counted from infinity": (kinetic + potential, "That is what is left to the booster."),
            "kinetic energy alone": (
                kinetic[0] - kinetic,
                "That is, at least very nearly, what the energy of motion has lost. But the weight changes that, too.",
            ),
            "sign of the potential energy": (
                kinetic[0] - kinetic - (potential[0] - potential),
                "Far up the potential energy is larger than near the ground. Is yours?",
            ),
            "no kinetic energy": (potential[0] - potential, "There is a second energy, the one of motion."),
            "g of the place times h": (
                kinetic[0] - kinetic + _lost(mass * planet.gravity(flight.h) * flight.h),
                "You take the local g for the whole way down. But the weight changes on the way, does it not?",
            ),
            "flat g": (kinetic[0] - kinetic + _lost(mass * 9.81 * flight.h), flat),
            "flat g of the ground": (kinetic[0] - kinetic + _lost(mass * planet.gravity(0.0) * flight.h), flat),
            "without the half": (
                2 * (kinetic[0] - kinetic) + potential[0] - potential,
                "Which factor stands in the energy of motion?",
            ),
            "all forces": (
                _running((drag - descent.weight(flight.h, mass)) * flight.v, flight.t),
                "That is the work of all forces together. Asked is what the air alone has taken.",
            ),
            "force of the old sample": (
                np.concatenate(([0.0], np.cumsum(-drag[:-1] * np.diff(flight.h)))),
                "Nearly. Each stretch counts with the force at its beginning. How did the lesson integrate?",
            ),
            "power of the old sample": (
                np.concatenate(([0.0], np.cumsum(-(drag * flight.v)[:-1] * np.diff(flight.t)))),
                "Nearly. Each step counts with the power at its beginning. How did the lesson integrate?",
            ),
            "the notebook's planet": (_lost(sum(_energies(flight, EARTH, mass))), others),
            "the notebook's mass": (_lost(sum(_energies(flight, planet, FALCON_9.initial_mass))), others),
            "the notebook's booster": (_lost(sum(_energies(flight, EARTH, FALCON_9.initial_mass))), others),
            "the notebook's drag": (-_running(Descent().drag(flight.h, flight.v) * flight.v, flight.t), others),
        }
        got = repeatable(taken, flight)
        if np.ndim(got) == 0 and got is not None and math.isclose(number(got), right[-1], abs_tol=close):
            raise Wrong("That is the last sample. Asked is one number for each sample.", "last sample only")
        got, momentum = array(got, right.shape), _running(drag, flight.t)
        # by a scale of its own: beside these energies it is next to nothing
        if momentum[-1] > 0 and np.allclose(got, momentum, rtol=0, atol=1e-3 * momentum[-1]):
            raise Wrong(
                "A force summed over time is a momentum. Over what is it summed for an energy?", "force over time"
            )
        if not np.allclose(got, right, rtol=0, atol=7e-4 * scale):  # a G of three digits will do
            compare(got, right, f"for {where}", mistakes, rtol=0, atol=close)
        yield


def _lost(energy):
    return energy[0] - energy
