"""What Hypothesis draws: any booster above any planet, and ignitions that end in every way a flight can end."""

import math

import numpy as np
from hypothesis import HealthCheck, Phase, settings
from hypothesis import strategies as st

from hoverslam_lib import Booster, Descent, Planet, best_ignition, fly

settings.register_profile(
    "reproducible",
    derandomize=True,
    deadline=None,
    database=None,
    phases=[Phase.generate],  # a failure names its row at once; to shrink an ensemble to it takes minutes
    suppress_health_check=[HealthCheck.too_slow, HealthCheck.data_too_large],
)
settings.load_profile("reproducible")


def between(low, high):
    return st.floats(low, high, allow_subnormal=False)


def spread(low, high):
    """Over all orders of magnitude between two numbers."""
    return between(math.log(low), math.log(high)).map(math.exp)


@st.composite
def planets(draw):
    radius, gravity = draw(spread(1e6, 1e7)), draw(spread(1.5, 25.0))
    air = draw(st.one_of(st.just(0.0), spread(1e-3, 5.0), spread(1e-3, 5.0)))
    return Planet(gravity * radius**2 / 6.6743e-11, radius, air, draw(spread(4e3, 2e4)))


@st.composite
def boosters(draw, planet):
    """With 0.8 to twelve times the dry weight in thrust."""
    dry = draw(spread(1e3, 1e5))
    thrust = draw(spread(0.8, 12.0)) * dry * planet.gravity(0.0)
    shape = draw(between(0.1, 1.5)), math.sqrt(dry / draw(spread(1e3, 5e3)))
    return Booster(dry, dry * draw(spread(0.02, 2.0)), thrust / draw(spread(2e3, 4.5e3)), thrust, *shape)


@st.composite
def descents(draw):
    planet = draw(planets())
    velocity = draw(st.one_of(between(-800.0, -1.0), between(-50.0, -1.0), st.just(0.0), between(1.0, 200.0)))
    return Descent(draw(boosters(planet)), planet, draw(spread(10.0, 1e4)), velocity)


@st.composite
def low_descents(draw):
    """A few metres up, with propellant for some milliseconds to seconds: the tank runs dry just above the ground."""
    planet = draw(planets())
    dry = draw(spread(1e3, 1e5))
    thrust = draw(spread(1.1, 12.0)) * dry * planet.gravity(0.0)
    rate = thrust / draw(spread(2e3, 4.5e3))
    booster = Booster(dry, rate * draw(spread(1e-3, 1.0)), rate, thrust, 0.5, 1.0)
    return Descent(booster, planet, draw(spread(1e-2, 10.0)), draw(between(-5.0, 1.0)))


@st.composite
def flights(draw, *, near_best=True):
    """A descent and an ignition time: at any time of the fall, after it, at once, or near the best."""
    descent = draw(st.one_of(descents(), descents(), low_descents()))
    share = draw(st.one_of(st.just(0.0), between(0.0, 1.0), between(0.0, 1.0), between(1.0, 1.2)))
    late = draw(spread(1e-6, 1.0)) * draw(st.sampled_from([-1, 1]))
    try:
        if near_best and draw(st.booleans()):
            return descent, max(best_ignition(descent).t_ignite + late, 0.0)
    except ValueError:  # no ignition lands it softly
        pass
    return descent, float(share * fly(descent, None, dt=0.5, method="dop8").t[-1])


def stacked(descents):
    """One descent with columns, a row for each of the descents."""

    def columns(parts, names):
        return {name: np.array([getattr(part, name) for part in parts]) for name in names}

    booster = columns([d.booster for d in descents], Booster.__dataclass_fields__)
    planet = columns([d.planet for d in descents], Planet.__dataclass_fields__)
    return Descent(Booster(**booster), Planet(**planet), **columns(descents, ("height", "velocity")))
