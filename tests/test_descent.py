import math
from contextlib import contextmanager
from dataclasses import FrozenInstanceError, replace

import numpy as np
import pytest
import referee
from scipy.optimize import brentq

from hoverslam_lib import (
    EARTH,
    FALCON_9,
    FALCON_9_LANDING_BURN,
    LANDING_BURN,
    MARS,
    METHODS,
    MOON,
    Booster,
    Descent,
    Planet,
    _validate,
    fly,
    hover_height,
    observed_order,
    speed_after_fall,
)
from hoverslam_lib.descent import (
    CRASH,
    OUT_OF_PROPELLANT,
    OUTCOMES,
    SOFT_LANDING,
    SOFT_SPEED,
    STOPPED_TOO_HIGH,
    StepTooLargeError,
    TooManyStepsError,
    advance,
    stride,
)

PAPER = Descent()
OPTIMUM = referee.best_ignition(PAPER, 60.0, 60.5)
SMALL_TANK = Descent(replace(FALCON_9, propellant_mass=8000.0))
ASCENDING = Descent(height=3e3, velocity=250.0)
# thrust between dry and initial weight: over the apex with the engine on, at 8.5 s for the best ignition at 4.73 s
ASCENDING_WEAK = Descent(replace(FALCON_9_LANDING_BURN, thrust=295e3, burn_rate=107.0), height=200.0, velocity=50.0)

CRASHES = [
    (PAPER, None),
    (PAPER, 60.3),  # a multiple of dt, as the paper has it
    (PAPER, 60.30517),
    (PAPER, OPTIMUM + 1.0),
    (PAPER, 65.123),
    (PAPER, 66.78),  # a thousandth of a second before the impact
    (PAPER, 70.0),  # after it
    (Descent(planet=MARS), 64.00371),
    (Descent(planet=MOON), 66.3),
    (LANDING_BURN, 17.3),
    (LANDING_BURN, 18.254321),
    (ASCENDING, None),
    (ASCENDING, 58.7),
    (ASCENDING_WEAK, 4.78),
]
BURNOUTS = [
    (PAPER, 0.0, "stopped too high"),
    (PAPER, 40.0, "stopped too high"),
    (PAPER, 60.2, "stopped too high"),
    (PAPER, 60.19317, "stopped too high"),
    (LANDING_BURN, 17.0, "stopped too high"),
    (SMALL_TANK, 40.0, "out of propellant"),
    (SMALL_TANK, 61.0033, "out of propellant"),
    (ASCENDING, 0.0, "out of propellant"),  # climbs all the way
    (ASCENDING, 30.123, "stopped too high"),
    (ASCENDING_WEAK, 2.0, "out of propellant"),
    (ASCENDING_WEAK, 4.7, "stopped too high"),
]


# ---- against the independent flight -------------------------------------------------------------------------------


@pytest.mark.parametrize(("descent", "t_ignite"), CRASHES)
def test_touchdown_is_that_of_the_independent_flight(descent, t_ignite):
    flight, (t, v) = fly(descent, t_ignite), referee.fly(descent, t_ignite).touchdown
    assert flight.outcome == "crash"
    assert flight.touchdown[0] == pytest.approx(t, rel=0, abs=1e-10)
    assert flight.touchdown[1] == pytest.approx(v, rel=0, abs=1e-8)
    assert flight.hover is None
    assert (flight.t[-1], flight.h[-1], flight.v[-1]) == (flight.touchdown[0], 0, flight.touchdown[1])


@pytest.mark.parametrize(("descent", "t_ignite", "outcome"), BURNOUTS)
def test_state_at_burnout_is_that_of_the_independent_flight(descent, t_ignite, outcome):
    flight, reference = fly(descent, t_ignite), referee.fly(descent, t_ignite)
    t, h, v = reference.burnout
    assert (flight.outcome, flight.touchdown) == (outcome, None)
    assert flight.t[-1] == t
    assert flight.h[-1] == pytest.approx(h, rel=0, abs=2e-8)
    assert flight.v[-1] == pytest.approx(v, rel=0, abs=5e-9)
    assert (flight.hover is None) == (reference.hover is None) == (outcome == "out of propellant")
    if flight.hover:
        assert flight.hover == pytest.approx(reference.hover, rel=0, abs=1e-8)


DT = np.array([0.2, 0.1, 0.05])


@pytest.mark.parametrize(
    ("descent", "t_ignite"),
    [(PAPER, 60.0), (PAPER, 60.01234), (PAPER, 59.777), (ASCENDING, 58.001), (LANDING_BURN, 17.1234)],
)
def test_hover_height_converges_with_order_4(descent, t_ignite):
    _, h = referee.hover(descent, t_ignite)
    errors = [abs(hover_height(descent, t_ignite, dt=dt) - h) for dt in DT]
    assert observed_order(DT, errors) == pytest.approx(4, abs=0.1)


@pytest.mark.parametrize(
    ("descent", "t_ignite"),
    [
        (PAPER, OPTIMUM + 1.0),  # one second late: at the optimum the touchdown speed has a square root
        (PAPER, 61.5),
        (PAPER, 65.12345),
        (LANDING_BURN, 18.2),
        (LANDING_BURN, 18.254321),
        (ASCENDING, None),
        (ASCENDING, 58.7),
    ],
)
def test_touchdown_converges_with_order_4(descent, t_ignite):
    _, v = referee.fly(descent, t_ignite).touchdown
    dts = 2 * DT  # at the smallest of DT some of these errors are rounding
    errors = [abs(fly(descent, t_ignite, dt=dt).touchdown[1] - v) for dt in dts]
    assert observed_order(dts, errors) == pytest.approx(4, abs=0.1)


@pytest.mark.parametrize(("descent", "t_ignite"), [(d, t) for d, t, _ in BURNOUTS if d is not ASCENDING_WEAK])
def test_state_at_burnout_converges_with_order_4(descent, t_ignite):
    _, h, _ = referee.fly(descent, t_ignite).burnout
    errors = [abs(fly(descent, t_ignite, dt=dt).h[-1] - h) for dt in DT]
    assert observed_order(DT, errors) == pytest.approx(4, abs=0.1)


@pytest.mark.parametrize("t_ignite", [60.0, 60.01234, 59.777])
def test_dop8_converges_with_a_higher_order(t_ignite):
    _, h = referee.hover(PAPER, t_ignite)
    dt = np.array([2.0, 1.0])
    assert observed_order(dt, [abs(hover_height(PAPER, t_ignite, dt=x, method="dop8") - h) for x in dt]) > 7.5


@pytest.mark.parametrize("method", ["explicit_euler", "symplectic_euler", "implicit_euler"])
@pytest.mark.parametrize("t_ignite", [60.0, 60.01234])
def test_euler_methods_converge_with_order_1(method, t_ignite):
    _, h = referee.hover(PAPER, t_ignite)
    dt = np.array([0.02, 0.01, 0.005])
    errors = [abs(hover_height(PAPER, t_ignite, dt=x, method=method) - h) for x in dt]
    assert observed_order(dt, errors) == pytest.approx(1, abs=0.1)


def switched(t, h, v, mass):
    return 0.9 if t < 64.0 else 1.0 if t < 67.003 else 0.6


def braking(t, h, v, mass):
    """Just enough to stop at the ground, within limits: depends on the whole state."""
    wanted = mass * (v * v / (2 * max(h, 1.0)) + 9.81) / 7.6e6
    return min(max(wanted, 0.4), 1.0) if v < 0 else 0.0


def bouncing(t, h, v, mass):
    return 1.0 if v < -10 else 0.0  # stops, falls, stops again


def pulsed(t, h, v, mass):
    return float(int(t * 2) % 2)  # fully on, fully off


@pytest.mark.parametrize(
    ("controller", "descent", "t_ignite", "dt"),
    [
        (lambda t, h, v, mass: 0.8, PAPER, 59.0, 0.02),
        (lambda t, h, v, mass: 0.8, PAPER, 61.01234, 0.02),
        (switched, PAPER, 59.0, 0.1),
        (switched, PAPER, 61.01234, 0.02),
        (braking, PAPER, 59.123, 0.1),
        (braking, PAPER, 60.5, 0.02),
        (pulsed, PAPER, 57.3, 0.1),
        (pulsed, LANDING_BURN, 12.1, 0.1),
    ],
)
def test_throttled_flight_is_that_of_the_independent_flight(controller, descent, t_ignite, dt):
    flight = fly(descent, t_ignite, dt=dt, controller=controller)
    reference = referee.fly(descent, t_ignite, controller=controller, every=dt)
    assert bool(flight.touchdown) == bool(reference.touchdown)
    t, h, v, mass, _ = reference.mesh[-1]
    assert flight.t[-1] == pytest.approx(t, rel=0, abs=1e-8)
    assert flight.h[-1] == pytest.approx(h, rel=0, abs=1e-6)
    assert flight.v[-1] == pytest.approx(v, rel=0, abs=1e-6)
    assert flight.mass[-1] == pytest.approx(mass, rel=1e-10)
    assert (flight.hover is None) == (reference.hover is None)
    if flight.hover:
        assert flight.hover == pytest.approx(reference.hover, rel=0, abs=1e-6)


@pytest.mark.parametrize("t_ignite", [61.0, 61.01234])
def test_throttled_flight_converges_with_order_4(t_ignite):
    _, v = referee.fly(PAPER, t_ignite, controller=lambda *state: 0.8).touchdown
    errors = [abs(fly(PAPER, t_ignite, dt=dt, controller=lambda *state: 0.8).touchdown[1] - v) for dt in DT]
    assert observed_order(DT, errors) == pytest.approx(4, abs=0.1)


# ---- near the optimum ---------------------------------------------------------------------------------------------


@pytest.mark.parametrize("method", ["rk4", "dop8"])
@pytest.mark.parametrize("dt", [0.01, 0.02, 0.05, 0.1, 0.2, 0.5])
def test_near_the_optimum_every_flight_is_that_of_the_independent_one(dt, method):
    # a method's error moves the optimum; what is left after that shift must agree down to 1e-8 s
    own = brentq(
        lambda t: hover_height(PAPER, t, dt=dt, method=method), OPTIMUM - 1e-5, OPTIMUM + 1e-5, xtol=1e-13, rtol=1e-14
    )
    assert abs(own - OPTIMUM) < 5e-6 * dt**4 + 5e-12
    for late in (s * 10.0**-k for k in range(3, 9) for s in (1, -1)):
        flight = fly(PAPER, own + late, dt=dt, method=method)
        _, h = referee.hover(PAPER, OPTIMUM + late)
        assert np.all(flight.h >= 0)
        if late > 0:
            t, v = referee.fly(PAPER, OPTIMUM + late).touchdown
            assert flight.touchdown[1] == pytest.approx(v, rel=0, abs=3e-7 + 0.02 * dt**4)
            assert flight.touchdown[0] - (own - OPTIMUM) == pytest.approx(t, rel=0, abs=2e-9 + 1e-4 * dt**4)
            assert flight.hover is None
            assert np.all(flight.v < 0)
            assert flight.outcome == ("soft landing" if v >= -SOFT_SPEED else "crash")
        else:
            assert flight.hover[1] == pytest.approx(h, rel=0, abs=1e-10 + 5e-6 * dt**4)
            assert flight.outcome == ("soft landing" if h <= 0.2041 else "stopped too high")


# ---- what a flight says -------------------------------------------------------------------------------------------


SURFACE_GRAVITY = {EARTH: 9.79840, MARS: 3.72798, MOON: 1.62427}


def lit_for(descent, height, low, high):
    """Ignition time of the independent flight that hovers so high."""
    return brentq(lambda t: referee.hover(descent, t)[1] - height, low, high, xtol=1e-12, rtol=1e-14)


def check_soft_or_not(flight, reference):
    """The same ending as the independent one; where the engine ended above the ground, the fall is the last step."""
    assert flight.outcome == reference.outcome
    assert bool(flight.touchdown) == bool(reference.touchdown)
    assert bool(flight.hover) == bool(reference.hover)
    if flight.hover:
        assert flight.hover == pytest.approx(reference.hover, rel=0, abs=1e-6)
    check_consistent(flight)
    if flight.touchdown:
        assert flight.touchdown == pytest.approx(reference.touchdown, rel=1e-9, abs=1e-6)
        assert list(flight.throttle[-2:]) == [0, 0]
        assert flight.mass[-1] == flight.mass[-2] == pytest.approx(reference.mesh[-2][3], rel=1e-9)
        assert (flight.t[-2], flight.h[-2]) == pytest.approx(reference.mesh[-2][:2], rel=0, abs=1e-6)


@pytest.mark.parametrize("share", [1e-4, 0.05, 0.5, 0.9999, 1.0001, 2.0])
@pytest.mark.parametrize(
    ("descent", "low", "high"),
    [(PAPER, 60.0, 60.5), (Descent(planet=MARS), 60.0, 64.003), (Descent(planet=MOON), 60.0, 66.29)],
)
def test_a_hover_is_a_soft_landing_up_to_where_the_fall_from_it_is(descent, low, high, share):
    limit = 2.0**2 / 2 / SURFACE_GRAVITY[descent.planet]  # 0.20 m, 0.54 m, 1.23 m
    t_ignite = lit_for(descent, share * limit, low, high)
    flight = fly(descent, t_ignite, dt=0.05, method="dop8")
    assert flight.outcome == (SOFT_LANDING if share < 1.0 else STOPPED_TOO_HIGH)
    check_soft_or_not(flight, referee.fly(descent, t_ignite))
    if share < 1:
        assert flight.touchdown[1] == pytest.approx(-2.0 * math.sqrt(share), rel=1e-4, abs=1e-4)
        assert flight.hover == (flight.t[-2], flight.h[-2])


@pytest.mark.parametrize("share", [0.95, 1 - 1e-6, 1 + 1e-6, 1.5])
@pytest.mark.parametrize("velocity", [-1.8, -1.0, 0.6])  # the last still climbs when its tank is empty
@pytest.mark.parametrize("planet", SURFACE_GRAVITY)
def test_a_tank_empty_above_the_ground_is_a_soft_landing_if_the_fall_from_there_is(planet, velocity, share):
    booster = replace(FALCON_9, propellant_mass=2.0)  # a burn of 1.4 ms

    def descent(height):
        return Descent(booster, planet, height, velocity)

    def energy(height):
        _, h, v = referee.fly(descent(height), 0.0).burnout
        return v * v / 2 + h * 6.6743e-11 * planet.mass / planet.radius**2

    height = brentq(lambda height: energy(height) - share * 2.0**2 / 2, 3e-3, 5.0, xtol=1e-14)
    flight, reference = fly(descent(height), 0.0, dt=1e-3), referee.fly(descent(height), 0.0)
    check_soft_or_not(flight, reference)
    assert flight.outcome == (SOFT_LANDING if share < 1 else OUT_OF_PROPELLANT)
    if flight.touchdown:
        assert flight.hover is None
        assert flight.mass[-1] == booster.dry_mass


def test_the_engine_is_cut_at_the_first_hover_that_is_low_enough():
    def hops(t, h, v, mass):
        """Stop some 7 m up, fall, and brake again near the ground."""
        return 1.0 if t < 72.0 or (v < 0 and h < v * v / 300 - 0.02 * v) else 0.0

    flight = fly(PAPER, 60.205, controller=hops)
    stops = flight.h[1:][(flight.v[1:] == 0) & (flight.throttle[:-1] == 1)]
    assert len(stops) > 1
    assert np.all(stops[:-1] > 0.2041)
    assert flight.hover[1] == stops[-1] < 0.2041
    check_soft_or_not(flight, referee.fly(PAPER, 60.205, controller=hops, every=0.02))


def test_a_hover_on_the_ground_itself_ends_the_flight_there():
    def even(f, t, h, v, dt):
        """Braking with 2 m/s² whatever the forces are: from 4 m and -4 m/s exactly to rest on the ground."""
        return h + dt * v + dt * dt, v + 2 * dt

    flight = fly(Descent(height=4.0, velocity=-4.0), 0.0, dt=0.75, method=even)
    assert flight.outcome == SOFT_LANDING
    assert flight.touchdown == (2.0, 0.0)
    assert flight.hover == (2.0, 0.0)
    assert math.copysign(1.0, flight.v[-1]) == 1.0
    assert np.all(np.diff(flight.t) > 0)


def even(f, t, h, v, dt):
    """A step with -2 m/s², whatever the forces are, so that an apex falls exactly on the end of a step."""
    return h + dt * v - dt * dt, v - 2 * dt


@pytest.mark.parametrize(
    ("descent", "t_ignite", "method", "height"),
    [(Descent(height=1000.0, velocity=0.0), 0.0, "rk4", 1000.0), (Descent(height=1.0, velocity=4.0), 2.0, even, 5.0)],
)
def test_at_rest_on_ignition_it_hovers_there(descent, t_ignite, method, height):
    flight = fly(descent, t_ignite, dt=0.5, method=method)
    assert flight.hover == (t_ignite, height)
    assert method == even or flight.outcome == STOPPED_TOO_HIGH
    assert hover_height(descent, t_ignite, dt=0.5, method=method) == height
    weak = replace(descent, booster=replace(FALCON_9, thrust=500e3))  # below the weight: it falls on
    assert fly(weak, t_ignite, dt=0.5, method=method).hover != (t_ignite, height)


def test_a_controller_that_lights_the_engine_at_rest_hovers_there():
    asked = iter([0.0, 1.0])
    flight = fly(
        Descent(height=1.0, velocity=4.0), 1.5, dt=0.5, method=even, controller=lambda *state: next(asked, 0.5)
    )
    assert flight.hover == (2.0, 5.0)


def test_at_rest_low_enough_the_engine_is_cut_at_once():
    flight = fly(Descent(height=0.1, velocity=0.0), 0.0)
    assert flight.outcome == SOFT_LANDING
    assert flight.hover == (0.0, 0.1)
    assert flight.touchdown == pytest.approx((math.sqrt(0.2 / 9.7984), -math.sqrt(0.2 * 9.7984)), rel=1e-5)
    assert flight.mass[-1] == FALCON_9.initial_mass


LIGHT = Descent(Booster(20.0, 20.0, 0.2, 600.0, 0.5, 1.0), EARTH, 100.0, 200.0)


@pytest.mark.parametrize("t_ignite", [None, 0.0])
def test_a_climb_that_ends_on_the_ground_is_a_step_too_large(t_ignite):
    # rk4 with so long a step in thick air ends below the ground, and faster upward than it began
    with pytest.raises(StepTooLargeError, match=r"climb from t = .* ends on the ground: dt = 0.5 s is too large"):
        fly(LIGHT, t_ignite, dt=0.5)
    assert fly(LIGHT, t_ignite, dt=0.05).touchdown is None or fly(LIGHT, t_ignite, dt=0.05).touchdown[1] < 0


@pytest.mark.parametrize("method", ["rk4", "implicit_euler"])
@pytest.mark.parametrize("digits", range(-3, 4))
def test_time_goes_on_however_near_ignition_is_to_an_apex(method, digits):
    apex = fly(ASCENDING, None, dt=0.3, method=method)
    t_apex = float(apex.t[np.flatnonzero(apex.v == 0)[0]])
    t_ignite = t_apex + digits * math.ulp(t_apex)
    flight = fly(ASCENDING, t_ignite, dt=0.3, method=method)
    assert np.all(np.diff(flight.t) > 0)
    assert (flight.hover is None) == math.isinf(hover_height(ASCENDING, t_ignite, dt=0.3, method=method))


def test_time_goes_on_in_a_fall_whose_step_ends_a_hair_before_the_apex():
    def nearly(f, t, h, v, dt):
        return (h + v * dt, 1e-30) if v == 4 else even(f, t, h, v, dt)

    flight = fly(Descent(height=1.0, velocity=4.0), None, dt=0.5, method=nearly)
    assert flight.v[1] == 0
    assert np.all(np.diff(flight.t) > 0)


def test_a_soft_landing_without_an_engine():
    flight = fly(Descent(height=0.2, velocity=0.0), None)
    assert flight.outcome == SOFT_LANDING
    assert flight.touchdown[1] == pytest.approx(-math.sqrt(2 * 9.798 * 0.2), rel=1e-4)
    assert fly(Descent(height=0.21, velocity=0.0), None).outcome == CRASH


@pytest.mark.parametrize("v", [0.0, -1.5, 1.5])
@pytest.mark.parametrize("planet", SURFACE_GRAVITY)
def test_speed_after_fall_conserves_energy(planet, v):
    heights = np.array([0.0, 0.2, 2.6, 100.0])
    speeds = speed_after_fall(planet, heights, v)
    assert speeds**2 / 2 == pytest.approx(v * v / 2 + SURFACE_GRAVITY[planet] * heights, rel=2e-4)
    assert [speed_after_fall(planet, float(h), v) for h in heights] == speeds.tolist()
    assert type(speed_after_fall(planet, 2.6, v)) is float


def test_speed_after_fall_is_that_of_a_flight_without_air():
    descent = Descent(replace(FALCON_9, drag_coefficient=0.0), height=2.6, velocity=0.0)
    assert speed_after_fall(descent.planet, 2.6) == pytest.approx(-fly(descent, None).touchdown[1], rel=1e-6)
    with pytest.raises(ValueError, match=r"h must be at least 0 \[m\]; got -0.1"):
        speed_after_fall(descent.planet, -0.1)


@pytest.mark.parametrize(("depth", "outcome"), [(0.99, "soft landing"), (1.01, "crash")])
def test_two_metres_a_second_separate_soft_from_crash(depth, outcome):
    # v² = 2·a·depth, a = thrust/mass - g at touchdown
    burn = referee.hover(PAPER, OPTIMUM)[0] - OPTIMUM
    deceleration = 7.6e6 / (57_200 - 1_480 * burn) - 9.798
    limit = 2.0**2 / (2 * deceleration)
    t_ignite = brentq(lambda t: hover_height(PAPER, t) + depth * limit, 60.0, 60.5, xtol=1e-12)
    assert fly(PAPER, t_ignite).outcome == outcome


@pytest.mark.parametrize("t_ignite", [66.79, 70.0, 1e12])
def test_ignition_after_the_impact_is_a_crash_without_a_burn(t_ignite):
    flight, fall = fly(PAPER, t_ignite), fly(PAPER, None)
    assert flight.outcome == "crash"
    assert flight.touchdown == fall.touchdown
    assert np.all(flight.throttle == 0)
    assert np.all(flight.mass == PAPER.booster.initial_mass)


@pytest.mark.parametrize("t_ignite", [0.0, 40.0, 60.19317, 61.01234])
@pytest.mark.parametrize("dt", [0.02, 0.07, 5.0])
def test_steps_end_exactly_on_ignition_and_burnout(t_ignite, dt):
    flight = fly(PAPER, t_ignite, dt=dt)
    assert t_ignite in flight.t
    if flight.outcome == "stopped too high":
        assert flight.t[-1] == t_ignite + 30_000 / 1_480
        assert flight.mass[-1] == 27_200
    assert np.all(np.diff(flight.t) > 0)
    assert np.max(np.diff(flight.t)) <= dt * (1 + 1e-9)


def test_throttle_and_mass_follow_the_burn():
    flight = fly(PAPER, 60.3)
    lit = flight.t >= 60.3
    assert np.array_equal(flight.throttle, lit.astype(float))
    assert flight.mass == pytest.approx(57_200 - 1_480 * np.maximum(flight.t - 60.3, 0), rel=1e-14)


def test_mass_is_what_the_throttle_leaves():
    flight = fly(PAPER, 59.123, controller=braking, dt=0.1)
    burnt = np.concatenate(([0], np.cumsum(1_480 * flight.throttle[:-1] * np.diff(flight.t))))
    assert len(set(flight.throttle)) > 10
    assert flight.mass == pytest.approx(57_200 - burnt, rel=1e-12)
    assert flight.throttle[-1] == flight.throttle[-2]


def test_the_controller_is_asked_at_ignition_and_every_dt_after_it():
    asked = []

    def controller(*state):
        asked.append(state)
        return 0.9

    flight = fly(PAPER, 60.01234, dt=0.1, controller=controller)
    assert [state[0] for state in asked] == pytest.approx(60.01234 + 0.1 * np.arange(len(asked)), abs=1e-12)
    rows = list(zip(flight.t, flight.h, flight.v, flight.mass, strict=True))
    assert set(asked) <= set(rows)  # and is told the truth


def test_throttle_1_is_no_controller():
    plain, asked = fly(PAPER, 60.3), fly(PAPER, 60.3, controller=lambda *state: 1)
    assert plain.touchdown == asked.touchdown
    assert np.array_equal(plain.mass, asked.mass)


def test_a_turn_without_thrust_is_no_hover():
    # explicit Euler with so long a step in thick air throws the falling booster upward, with the engine off
    venus = Planet(mass=4.867e24, radius=6.0518e6, surface_density=65.0, scale_height=15.9e3)
    descent = Descent(planet=venus, height=20e3, velocity=-300.0)
    flight = fly(descent, 0.0, dt=5.0, method="explicit_euler", controller=lambda *state: 0.0)
    turn = np.flatnonzero(flight.v == 0)
    assert turn.size == 1
    assert flight.v[turn[0] - 1] < 0 < flight.h[turn[0]]
    assert flight.hover is None


def test_of_several_hovers_the_first_is_reported():
    flight = fly(PAPER, 60.0, dt=0.1, controller=bouncing)
    assert np.count_nonzero((flight.v == 0) & (flight.throttle == 1)) > 1
    assert flight.hover == pytest.approx(referee.fly(PAPER, 60.0, controller=bouncing, every=0.1).hover, abs=1e-5)


def test_a_step_is_not_split_by_rounding():
    t_ignite = math.nextafter(3 * 0.1, 1.0)  # one unit in the last place after the third step
    flight = fly(PAPER, t_ignite, dt=0.1)
    assert flight.t[3] == t_ignite
    assert np.count_nonzero(flight.t <= t_ignite) == 4


@pytest.mark.parametrize(("descent", "t_ignite"), [(ASCENDING, None), (ASCENDING, 30.123), (ASCENDING_WEAK, 4.7)])
def test_a_step_ends_on_the_apex_in_air(descent, t_ignite):
    flight = fly(descent, t_ignite, dt=0.3)
    apex = np.flatnonzero(flight.v == 0)
    assert apex.size >= 1
    t, h = next((t, h) for t, h, v, *_ in referee.fly(descent, t_ignite).mesh if v == 0)
    assert (flight.t[apex[0]], flight.h[apex[0]]) == pytest.approx((t, h), rel=1e-8)


@pytest.mark.parametrize(
    ("descent", "t_ignite"),
    [
        (PAPER, None),  # at touchdown
        (PAPER, 40.0),  # at burnout
        (PAPER, 60.19317),  # within the burn
        (PAPER, 60.211),  # just before the engine is cut
        (PAPER, 66.0),  # at ignition
        (LANDING_BURN, None),
        (Descent(planet=MOON), 66.0),
        (ASCENDING, 30.123),
    ],
)
def test_peak_acceleration_is_that_of_the_independent_flight(descent, t_ignite):
    assert fly(descent, t_ignite).peak_acceleration == pytest.approx(
        referee.peak_acceleration(descent, t_ignite), rel=1e-6
    )


def test_peak_acceleration_sees_the_instant_before_the_engine_is_cut():
    # the controller cuts the engine at 64 s: the last full thrust is felt at the end of that step, not at its start
    flight = fly(PAPER, 62.0, dt=0.5, controller=lambda t, h, v, mass: 1.0 if t < 64.0 else 0.0)
    cut = int(np.argmax(flight.t == 64.0))
    felt = referee.felt_force(PAPER, flight.h[cut], flight.v[cut], 1.0) / flight.mass[cut]
    assert flight.throttle[cut] == 0
    assert felt > max(flight.felt_acceleration)
    assert flight.peak_acceleration == pytest.approx(felt, rel=1e-12)


def test_felt_acceleration_is_thrust_and_drag_over_mass():
    flight = fly(PAPER, 60.3)
    expected = [
        referee.felt_force(PAPER, h, v, throttle) / mass
        for h, v, mass, throttle in zip(flight.h, flight.v, flight.mass, flight.throttle, strict=True)
    ]
    assert flight.felt_acceleration == pytest.approx(np.array(expected), rel=1e-12, abs=1e-12)


def test_to_frame_has_a_row_a_step_and_units_in_the_headers():
    flight = fly(PAPER, 60.3)
    frame = flight.to_frame()
    assert list(frame.columns) == [
        "t [s]",
        "h [m]",
        "v [m/s]",
        "mass [kg]",
        "throttle",
        "felt acceleration [m/s²]",
    ]
    for column, values in zip(frame, (flight.t, flight.h, flight.v, flight.mass, flight.throttle), strict=False):
        assert np.array_equal(frame[column], values)


# ---- closed forms -------------------------------------------------------------------------------------------------


@pytest.mark.parametrize(("height", "velocity"), [(150e3, -2000.0), (1000.0, 0.0), (20e3, 300.0)])
def test_energy_is_conserved_in_a_fall_without_air(height, velocity):
    v = fly(Descent(planet=MOON, height=height, velocity=velocity), None).touchdown[1]
    gm, r = 6.6743e-11 * 7.346e22, 1_737_400.0
    assert v == pytest.approx(-math.sqrt(velocity**2 + 2 * gm * (1 / r - 1 / (r + height))), rel=1e-12)


@pytest.mark.parametrize("t_ignite", [1.0, 2.34567])
def test_burn_in_empty_space_follows_the_rocket_equation(t_ignite):
    nowhere = Planet(mass=1.0, radius=1e6, surface_density=0.0, scale_height=1e4)
    booster = Booster(1_000.0, 4_000.0, 200.0, 500e3, 0.5, 1.0)
    start = Descent(booster, nowhere, height=50e3, velocity=-1_000.0)
    flight = fly(start, t_ignite)
    exhaust, m0, rate = 2_500.0, 5_000.0, 200.0
    assert flight.outcome == SOFT_LANDING  # where nothing weighs anything, a fall from any height is soft
    burn = (flight.t >= t_ignite) & (flight.t <= flight.hover[0])
    s = flight.t[burn] - t_ignite
    log = np.log(m0 / (m0 - rate * s))
    v = -1_000 + exhaust * log
    h = 50e3 - 1_000 * (t_ignite + s) + exhaust * (s - (m0 / rate - s) * log)
    assert flight.v[burn] == pytest.approx(v, rel=0, abs=1e-8)
    assert flight.h[burn] == pytest.approx(h, rel=0, abs=1e-7)
    assert flight.hover[0] == pytest.approx(t_ignite + (m0 / rate) * (1 - math.exp(-1_000 / exhaust)), abs=1e-9)


# ---- any booster, any planet, any step ----------------------------------------------------------------------------


def random_descents(seed, count):
    """Boosters from 1 t to 100 t with one to twelve times their dry weight of thrust, on bodies from moons to Venus."""
    rng = np.random.default_rng(seed)

    def draw(low, high):
        return float(np.exp(rng.uniform(np.log(low), np.log(high))))

    for _ in range(count):
        radius, gravity, dry = draw(1e6, 1e7), draw(1.0, 25.0), draw(1e3, 1e5)
        air = draw(1e-3, 5.0) if rng.random() < 0.75 else 0.0
        planet = Planet(gravity * radius**2 / 6.6743e-11, radius, air, draw(4e3, 2e4))
        thrust = draw(1.05, 12) * dry * gravity
        shape = draw(0.1, 1.5), math.sqrt(dry / draw(1e3, 5e3))
        booster = Booster(dry, dry * draw(0.05, 2.0), thrust / draw(2e3, 4.5e3), thrust, *shape)
        velocity = rng.choice([-draw(1, 2000), -draw(1, 300), 0.0, draw(1, 300)])
        yield Descent(booster, planet, height=draw(10, 1e5), velocity=float(velocity))


def check_consistent(flight):
    t, h, v, mass = flight.t, flight.h, flight.v, flight.mass
    dry, full = flight.descent.booster.dry_mass, flight.descent.booster.initial_mass
    assert all(np.all(np.isfinite(x)) for x in (t, h, v, mass, flight.throttle, flight.felt_acceleration))
    assert math.isfinite(flight.peak_acceleration)
    assert np.all(np.diff(t) > 0)
    assert np.all(h >= 0)
    assert np.all((mass >= dry * (1 - 1e-12)) & (mass <= full))
    assert flight.outcome in OUTCOMES
    assert (flight.touchdown is None) == (flight.outcome in ("stopped too high", "out of propellant"))
    if flight.touchdown:
        assert flight.touchdown == (t[-1], v[-1])
        assert h[-1] == 0
        assert v[-1] <= 0
        assert (flight.outcome == "soft landing") == (abs(v[-1]) <= SOFT_SPEED)
    else:
        assert mass[-1] == dry
        assert (flight.hover is None) == (flight.outcome == "out of propellant")


@pytest.mark.parametrize("method", ["rk4", "explicit_euler", "symplectic_euler", "implicit_euler"])
@pytest.mark.parametrize("seed", range(2))
def test_any_descent_ends_soon_and_consistently(method, seed):
    rng = np.random.default_rng(seed)
    for descent in random_descents(seed, 30):
        end = referee.free_fall(descent)[-1][0]
        # 0.02 s to 0.2 s would be finer than a test needs on the longest of these falls
        dt = max(0.05, end / 500)
        with evaluations() as counted:
            check_consistent(fly(descent, end * rng.uniform(0, 1.05), dt=dt, method=method))
        assert len(counted) < 3e5


@pytest.mark.parametrize("seed", range(2))
def test_any_descent_meets_the_independent_flight(seed):
    rng = np.random.default_rng(seed)
    for descent in random_descents(seed, 12):
        t_ignite = referee.free_fall(descent)[-1][0] * rng.uniform(0.5, 1)
        reference = referee.fly(descent, t_ignite)
        flight = fly(descent, t_ignite, dt=0.05, method="dop8")
        t, h, v, *_ = reference.mesh[-1]
        assert bool(flight.touchdown) == bool(reference.touchdown)
        assert flight.t[-1] == pytest.approx(t, rel=1e-11, abs=1e-9)
        assert flight.h[-1] == pytest.approx(h, rel=1e-10, abs=1e-7)
        assert flight.v[-1] == pytest.approx(v, rel=1e-9, abs=1e-7)


@pytest.mark.parametrize("method", METHODS)
@pytest.mark.parametrize("dt", [1.0, 5.0, 20.0])
@pytest.mark.parametrize("descent", [PAPER, LANDING_BURN, ASCENDING, Descent(planet=MOON)])
def test_a_large_step_gives_a_flight_or_says_that_it_is_too_large(descent, dt, method):
    for t_ignite in (None, 0.0, 0.3 * dt, 17.2, 59.0, 66.0):
        try:
            flight = fly(descent, t_ignite, dt=dt, method=method)
        except ValueError as error:
            assert "overflow" in str(error)  # noqa: PT017
        else:
            check_consistent(flight)


# ---- forces and bad input -----------------------------------------------------------------------------------------


def test_drag_opposes_the_motion():
    assert PAPER.drag(1e3, -300.0) == pytest.approx(referee.felt_force(PAPER, 1e3, -300.0, 0.0), rel=1e-14)
    assert PAPER.drag(1e3, 300.0) == -PAPER.drag(1e3, -300.0) < 0
    h, v = np.array([0.0, 5e3]), np.array([-10.0, 20.0])
    assert PAPER.drag(h, v) == pytest.approx([PAPER.drag(0.0, -10.0), PAPER.drag(5e3, 20.0)], rel=1e-14)


def test_weight_is_positive_and_falls_with_height():
    gm = 6.6743e-11 * 5.972167867791379e24
    assert PAPER.weight(0.0, 1_000.0) == pytest.approx(1_000 * gm / 6_378_100**2, rel=1e-14)
    assert PAPER.weight(150e3, 1_000.0) == pytest.approx(1_000 * gm / 6_528_100**2, rel=1e-14)


BAD_DESCENTS = [
    ({"height": 0.0}, ValueError, r"height must be .*greater than 0.*\[m\]"),
    ({"height": -1.0}, ValueError, r"height must be .*greater than 0.*\[m\]"),
    ({"height": math.nan}, ValueError, "height"),
    ({"height": "150e3"}, TypeError, "height"),
    ({"height": [1.0, 2.0]}, TypeError, "height"),
    ({"height": np.array([[1.0, 2.0]])}, TypeError, "height"),
    ({"velocity": math.inf}, ValueError, r"velocity must be a finite number \[m/s\]; got inf"),
    ({"velocity": None}, TypeError, "velocity"),
    ({"booster": "FALCON_9"}, TypeError, "booster must be a Booster"),
    ({"planet": FALCON_9}, TypeError, "planet must be a Planet"),
]


@pytest.mark.parametrize(("arguments", "error", "message"), BAD_DESCENTS)
def test_bad_descent(arguments, error, message):
    with pytest.raises(error, match=message):
        Descent(**arguments)


BAD_FLIGHTS = [
    ({"descent": "Falcon"}, TypeError, "descent must be a Descent; got 'Falcon'"),
    ({"descent": FALCON_9}, TypeError, "descent must be a Descent"),
    ({"t_ignite": -1e-9}, ValueError, r"t_ignite must be a finite number at least 0 \[s\]; got -1e-09"),
    ({"t_ignite": math.nan}, ValueError, "t_ignite"),
    ({"t_ignite": math.inf}, ValueError, "t_ignite"),
    ({"t_ignite": "60"}, TypeError, "t_ignite"),
    ({"t_ignite": True}, TypeError, "t_ignite"),
    ({"t_ignite": np.array([60.0])}, TypeError, "t_ignite must be one time .*column: `fly_all` flies"),
    ({"descent": Descent(height=np.array([1e3, 2e3]))}, TypeError, r"columns \(height\): `fly_all` flies"),
    ({"t_ignite": [59.0, 60.0]}, TypeError, "t_ignite"),
    ({"dt": 0.0}, ValueError, r"dt must be a finite number greater than 0 \[s\]; got 0"),
    ({"dt": -0.02}, ValueError, r"dt .* greater than 0 \[s\]"),
    ({"dt": math.nan}, ValueError, "dt"),
    ({"dt": math.inf}, ValueError, "dt"),
    ({"dt": np.array([0.1, 0.2])}, TypeError, "dt"),
    ({"dt": None}, TypeError, "dt"),
    ({"dt": 10**400}, ValueError, "dt"),
    ({"method": "rk5"}, ValueError, "'rk5'.*explicit_euler, symplectic_euler, implicit_euler, rk4, rkn4, gauss4, dop8"),
    ({"method": None}, ValueError, "choose from explicit_euler"),
    ({"method": ["rk4"]}, ValueError, "choose from explicit_euler"),
    ({"controller": 0.8}, TypeError, "controller must be a function"),
    ({"controller": lambda t, h, v, mass: 1.5}, ValueError, "controller.* at least 0 and at most 1.*throttle.*got 1.5"),
    ({"controller": lambda t, h, v, mass: -0.1}, ValueError, "controller"),
    ({"controller": lambda t, h, v, mass: math.nan}, ValueError, "controller"),
    ({"controller": lambda t, h, v, mass: None}, TypeError, "controller"),
    ({"descent": Descent(velocity=12e3), "t_ignite": None}, ValueError, "never comes down"),
]


@pytest.mark.parametrize(("changed", "error", "message"), BAD_FLIGHTS)
def test_bad_flight(changed, error, message):
    arguments = {"descent": PAPER, "t_ignite": 60.0} | changed
    with pytest.raises(error, match=message):
        fly(arguments.pop("descent"), arguments.pop("t_ignite"), **arguments)


@pytest.mark.parametrize(
    ("t_ignite", "dt", "steps"), [(60.0, 1e-6, 64_734_741), (None, 1e-6, 64_734_741), (0.0, 1e-6, 20_270_270)]
)
def test_a_step_too_small_is_refused_at_once(t_ignite, dt, steps):
    refusal = rf"dt = 1e-06 s would take {steps:,} steps or more; at most 10,000,000"
    with evaluations() as counted, pytest.raises(ValueError, match=refusal):
        fly(PAPER, t_ignite, dt=dt)
    assert len(counted) < 10


@pytest.mark.parametrize("dt", [1e-300, 5e-324])
def test_an_absurd_step_gets_a_readable_message(dt):
    with pytest.raises(ValueError, match="dt") as error:
        fly(PAPER, 60.0, dt=dt)
    assert len(str(error.value)) < 300
    assert "at least inf" not in str(error.value)


def test_a_dense_ascent_is_not_taken_for_longer_than_it_is():
    # air shortens an ascent: some 13 s, not the half hour of a throw without air
    venus = Planet(4.867e24, 6.0518e6, 1_000.0, 15.9e3)
    descent = Descent(planet=venus, height=10.0, velocity=9_000.0)
    assert referee.free_fall(descent)[-1][0] < 20
    assert fly(descent, None, dt=2e-4).outcome == "crash"


SMALL = Planet(mass=1.5e20, radius=100e3, surface_density=1.0, scale_height=1e3)


@pytest.mark.parametrize(("faster", "air_holds_it"), [(1.1, True), (1.25, True), (1.3, False), (1.45, False)])
def test_air_holds_a_booster_that_starts_above_escape_speed(faster, air_holds_it):
    # of v² this air takes 1 - exp(-½) = 39 %, so that 1.28 times escape speed is enough
    booster, gm = Booster(1_000.0, 1_000.0, 10.0, 30e3, 1.0, math.sqrt(1 / math.pi)), 6.6743e-11 * SMALL.mass
    descent = Descent(booster, SMALL, height=1e-3, velocity=faster * math.sqrt(2 * gm / SMALL.radius))
    if air_holds_it:
        assert fly(descent, None, dt=0.5, method="dop8").touchdown == pytest.approx(
            referee.free_fall(descent)[-1][::2], rel=1e-7
        )
    else:
        with pytest.raises(ValueError, match="never comes down"):
            fly(descent, None, dt=0.5)
        up = referee.solve(referee.equation(descent, 0.0, 2_000.0), (0.0, 1e-3, descent.velocity), 1e4)[0]
        assert up[-1][2] > math.sqrt(2 * gm / (SMALL.radius + up[-1][1]))


@pytest.mark.parametrize("height", [1e-4, 4e-3, 9.9e-3, 11e-3])
@pytest.mark.parametrize("velocity", [-5.0, -2.5])
def test_a_tank_empty_just_above_the_ground_and_fast_is_no_landing(height, velocity):
    booster = replace(FALCON_9, propellant_mass=2.0)  # a burn of 1.4 ms
    h_empty = referee.fly(Descent(booster, EARTH, 1.0, velocity), 0.0).burnout[1]
    descent = Descent(booster, EARTH, 1.0 - h_empty + height, velocity)
    flight = fly(descent, 0.0, dt=1e-3)
    assert flight.outcome == referee.fly(descent, 0.0).outcome == OUT_OF_PROPELLANT
    assert flight.touchdown is None
    assert flight.h[-1] == pytest.approx(height, abs=1e-6)
    assert flight.v[-1] < -SOFT_SPEED


# ---- steps that choose their own length ---------------------------------------------------------------------------


@pytest.mark.parametrize("tolerance", [1e-6, 1e-9, 1e-12])
@pytest.mark.parametrize("descent", [PAPER, LANDING_BURN, Descent(planet=MOON), ASCENDING, Descent(height=1e7)])
def test_a_stride_falls_as_the_independent_flight_does(descent, tolerance):
    mesh = referee.free_fall(descent)
    nodes = []
    for node in stride(tolerance, iter(range(1000)), descent.acceleration(), mesh[0], math.inf):
        nodes.append(node)
        if node[3] == "ground":
            break
    assert nodes[-1][:3] == pytest.approx(mesh[-1], rel=100 * tolerance, abs=1e-9)
    if descent is ASCENDING:
        top = next(node for node in mesh if node[2] == 0)
        assert next(node for node in nodes if node[3] == "apex")[:3] == pytest.approx(top, rel=100 * tolerance)


def test_a_stride_is_as_long_as_it_may_be():
    def tried(descent, tolerance):
        tries = iter(range(1000))
        *_, end = stride(tolerance, tries, descent.acceleration(), (0.0, 150e3, -2000.0), 60.0)
        assert end[0] == 60.0
        return next(tries)

    assert tried(Descent(planet=MOON), 1e-12) < 10
    assert 2 * tried(PAPER, 1e-5) < tried(PAPER, 1e-12) < 40


def test_a_stride_ends_when_its_tries_do():
    with pytest.raises(TooManyStepsError, match=r"too many steps: t = .* s, h = .* m, v = .* m/s") as caught:
        list(stride(1e-12, iter(range(9)), PAPER.acceleration(), (0.0, 150e3, -2000.0), math.inf))
    t, h, v = caught.value.node
    assert 1 < t < 60
    assert (h, v) == pytest.approx(referee.at_ignition(PAPER, t)[1:], rel=1e-11)


# ---- flights that would not end -----------------------------------------------------------------------------------


@contextmanager
def evaluations():
    """Counts evaluations of the forces: a list that grows by one with each."""
    counted, gravity = [], Planet.gravity
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(Planet, "gravity", lambda planet, h: counted.append(h) or gravity(planet, h))
        yield counted


@pytest.fixture
def short_walks(monkeypatch):
    """Walks may have twenty thousand steps, and look ahead after a thousand."""
    monkeypatch.setattr(_validate, "MAX_STEPS", 20_000)
    for module in ("descent", "ensemble"):
        monkeypatch.setattr(f"hoverslam_lib.{module}.LONG_WALK", 1_000)


THICK = Planet(mass=4.867e24, radius=6.0518e6, surface_density=65.0, scale_height=15.9e3)
FAR = Descent(planet=MOON, height=1e7, velocity=0.0)
CLIMBS = Descent(replace(FALCON_9, thrust=7e5, burn_rate=0.01), MOON, height=1e3, velocity=-1.0)
BRAKED = Descent(planet=THICK, height=1e3, velocity=-1000.0)  # by the air, in a fraction of what the engine would take


@pytest.mark.usefixtures("short_walks")
@pytest.mark.parametrize(
    ("run", "lasts"),
    [
        (lambda dt: fly(Descent(planet=THICK), None, dt=dt), lambda: referee.free_fall(Descent(planet=THICK))[-1][0]),
        (lambda dt: fly(FAR, None, dt=dt), lambda: referee.free_fall(FAR)[-1][0]),  # where gravity is weak
        (lambda dt: hover_height(BRAKED, 0.0, dt=dt), lambda: referee.hover(BRAKED, 0.0)[0]),
        (lambda dt: fly(Descent(velocity=10.9e3), 1.9e5, dt=dt), lambda: 1.9e5),  # it climbs still
    ],
)
def test_a_walk_looks_ahead_whether_it_ends_within_the_steps_allowed(run, lasts):
    lasts = lasts()
    run(lasts / 19_000)
    with evaluations() as counted, pytest.raises(ValueError, match=r"take 20,9\d\d steps or more; at most 20,000"):
        run(lasts / 20_990)
    assert len(counted) < 4 * 1_000 + 1_100


@pytest.mark.usefixtures("short_walks")
@pytest.mark.parametrize("velocity", [-1.0, 1.0])
def test_a_burn_that_climbs_until_the_tank_is_empty_is_refused_before_it_is_flown(velocity):
    fly(replace(CLIMBS, velocity=velocity), 0.0, dt=160.0)
    with evaluations() as counted, pytest.raises(ValueError, match=r"would take 21,42\d steps or more"):
        fly(replace(CLIMBS, velocity=velocity), 0.0, dt=140.0)
    assert len(counted) < 200


def test_a_fall_from_very_high_is_refused_before_it_is_flown():
    with (
        evaluations() as counted,
        pytest.raises(ValueError, match=r"would take [0-9,]{10} steps or more") as caught,
    ):
        fly(Descent(height=1e9), None)
    steps = float(str(caught.value).split("take ")[1].split(" ")[0].replace(",", ""))
    assert steps == pytest.approx(referee.free_fall(Descent(height=1e9))[-1][0] / 0.02, rel=1e-3)
    assert len(counted) < 6e5


def test_too_late_an_ignition_on_the_way_out_is_refused_at_once():
    # it meets no ground before, so it would coast all the way to t_ignite
    with evaluations() as counted, pytest.raises(ValueError, match="at most 10,000,000"):
        fly(Descent(velocity=12e3), 1e9, dt=1.0)
    assert len(counted) < 10


def test_ignition_at_the_end_of_time_is_a_crash_without_a_burn():
    assert fly(PAPER, 1e308).outcome == "crash"


@pytest.mark.parametrize("v", [1e-9, 0.5, 3.0])
def test_step_that_climbs_and_ends_on_the_ground_is_too_large_however_slow_it_is(v):
    with pytest.raises(StepTooLargeError, match="a climb from t = 2 s ends on the ground: dt = 0.5 s is too large"):
        advance(lambda f, t, h, v, dt: (h - 10 * dt, v), None, 2.0, 1.0, v, 0.5)


def test_flight_stays_as_it_was_flown():
    flown = fly(Descent(), 60.2, dt=0.5)
    for name in ("descent", "outcome", "v"):
        with pytest.raises(FrozenInstanceError):
            setattr(flown, name, "changed")
