import copy
import math
import pickle
import re
from dataclasses import asdict, replace
from functools import cache

import numpy as np
import pytest
import referee
from test_descent import evaluations, random_descents

from hoverslam_lib import (
    EARTH,
    FALCON_9,
    FALCON_9_LANDING_BURN,
    LANDING_BURN,
    MARS,
    MOON,
    Booster,
    Descent,
    FreeFall,
    Ignition,
    NoSoftLanding,
    Planet,
    best_ignition,
    fly,
    hover_height,
    ignition_table,
)
from hoverslam_lib._validate import digits
from hoverslam_lib.ignition import _near

PAPER = Descent()
VENUS = Planet(mass=4.867e24, radius=6.0518e6, surface_density=65.0, scale_height=15.9e3)
SLUG = replace(FALCON_9_LANDING_BURN, thrust=295e3, burn_rate=107.0)  # lifts the dry booster, not the full one
DESCENTS = {
    "paper": PAPER,
    "one engine": LANDING_BURN,
    "Mars": Descent(planet=MARS),
    "Moon": Descent(planet=MOON),
    "Moon, ascending": Descent(planet=MOON, height=10e3, velocity=300.0),
    "ascending": Descent(height=3e3, velocity=250.0),
    "ascending, one engine": Descent(FALCON_9_LANDING_BURN, height=3e3, velocity=250.0),
    "ignition before the apex": Descent(SLUG, height=200.0, velocity=50.0),
    "ignition after the apex": Descent(replace(SLUG, thrust=310e3), height=500.0, velocity=100.0),
    "dropped from 50 m": Descent(height=50.0, velocity=0.0),
    "dropped from 50 m, one engine": Descent(FALCON_9_LANDING_BURN, height=50.0, velocity=0.0),
    "dropped from 10 cm": Descent(height=0.1, velocity=0.0),
    "slow, from high up": Descent(height=150e3, velocity=-1.0),
    # a coarse step of their climb ends on the ground
    "light, ascending": Descent(Booster(20.0, 20.0, 0.2, 600.0, 0.5, 1.0), EARTH, 100.0, 200.0),
    "dense air": Descent(planet=VENUS),
    "dense air, one engine": Descent(FALCON_9_LANDING_BURN, VENUS),
    "dense air, little time": Descent(planet=replace(VENUS, surface_density=20.0), height=1e3, velocity=-30.0),
    # a burn shorter than a step of the fall, and air so thick that a long step of the fall blows up
    "parachute, one engine": Descent(
        replace(FALCON_9_LANDING_BURN, drag_coefficient=200.0), height=16e3, velocity=-50.0
    ),
    "dense air, more drag": Descent(replace(FALCON_9_LANDING_BURN, drag_coefficient=2.0), VENUS),
    "dense air, most drag": Descent(replace(FALCON_9, drag_coefficient=5.0), VENUS, height=16e3, velocity=-50.0),
    "dense air, ascending": Descent(replace(FALCON_9, drag_coefficient=5.0), VENUS, height=1.5e3, velocity=130.0),
}
TOLERANCE = {"paper": 1e-10}  # [s]; the others below
descents = pytest.mark.parametrize("name", DESCENTS)


found = cache(best_ignition)  # for tests of the same descent


@cache
def referee_ignition(descent):
    """Searched from the whole flight, without a hint from the library: the latest change of sign on a grid."""
    end = referee.free_fall(descent)[-1][0]
    low, high = 0.0, end
    while high - low > 1e-3 * end:  # the hover height falls wherever these are
        middle = (low + high) / 2
        low, high = (middle, high) if referee.hover(descent, middle)[1] >= 0 else (low, middle)
    return referee.best_ignition(descent, low, high)


# ---- the optimum --------------------------------------------------------------------------------------------------


@descents
def test_best_ignition_is_the_independent_one(name):
    descent = DESCENTS[name]
    optimum, t_ignite = found(descent), referee_ignition(descent)
    _, h, v = referee.at_ignition(descent, t_ignite)
    t_touchdown = referee.hover(descent, t_ignite)[0]
    booster = descent.booster
    tolerance = TOLERANCE.get(name, 1e-9)
    assert optimum.t_ignite == pytest.approx(t_ignite, rel=0, abs=tolerance)
    assert optimum.t_touchdown == pytest.approx(t_touchdown, rel=0, abs=2 * tolerance)
    assert optimum.h_ignite == pytest.approx(h, rel=0, abs=3e3 * tolerance)
    assert optimum.v_ignite == pytest.approx(v, rel=0, abs=1e2 * tolerance)
    left = booster.propellant_mass - booster.burn_rate * (t_touchdown - t_ignite)
    assert optimum.propellant_left == pytest.approx(left, rel=0, abs=3 * booster.burn_rate * tolerance)


@descents
@pytest.mark.parametrize("method", ["rk4", "dop8"])
def test_the_optimum_flown_is_a_soft_landing(name, method):
    descent = DESCENTS[name]
    optimum = found(descent)
    flight = fly(descent, optimum.t_ignite, method=method)
    assert flight.outcome == "soft landing"
    assert flight.touchdown[0] == pytest.approx(optimum.t_touchdown, abs=0.02)
    assert flight.mass[-1] - descent.booster.dry_mass == pytest.approx(
        optimum.propellant_left, abs=0.02 * descent.booster.burn_rate
    )


@descents
def test_the_hover_height_changes_sign_at_the_optimum(name):
    descent = DESCENTS[name]
    t_ignite = found(descent).t_ignite
    assert hover_height(descent, t_ignite - 1e-3) > 0 > hover_height(descent, t_ignite + 1e-3)


@pytest.mark.parametrize("height", [1.0, 20e3])
def test_best_ignition_on_an_airless_planet_of_no_mass_is_a_closed_form(height):
    # fall and burn without gravity: the burn takes h_burn, a number of the booster and the speed alone
    nowhere = Planet(mass=1e-3, radius=1e6, surface_density=0.0, scale_height=1e4)
    exhaust, v = 7.6e6 / 1_480, 100.0
    burn = 57_200 / 1_480 * (1 - math.exp(-v / exhaust))
    log = math.log1p(-1_480 * burn / 57_200)
    h_burn = v * burn - exhaust * (burn + (57_200 / 1_480 - burn) * log)
    descent = Descent(planet=nowhere, height=h_burn + height, velocity=-v)
    optimum = best_ignition(descent)
    assert optimum.t_ignite == pytest.approx(height / v, rel=0, abs=1e-11 * (1 + height / v))
    assert optimum.propellant_left == pytest.approx(30_000 - 1_480 * burn, rel=1e-11)


def test_the_scale_height_of_no_air_is_without_meaning():
    with evaluations() as counted:
        optimum = best_ignition(Descent(planet=replace(MOON, scale_height=50.0)))
    assert len(counted) < 2e4
    assert optimum.t_ignite == pytest.approx(best_ignition(Descent(planet=MOON)).t_ignite, rel=0, abs=1e-10)


# ---- no soft landing ----------------------------------------------------------------------------------------------


def burnt(propellant):
    """What the paper's booster burns on its best landing [kg] when it carries so much."""
    descent = Descent(replace(FALCON_9, propellant_mass=propellant))
    t_ignite = referee_ignition(descent)
    return 1_480 * (referee.hover(descent, t_ignite)[0] - t_ignite)


@pytest.fixture(scope="module")
def just_enough():
    """Propellant that is used up at touchdown [kg]."""
    return referee.brentq(lambda propellant: propellant - burnt(propellant), 7e3, 9e3, xtol=1e-9, rtol=1e-14)


@pytest.mark.parametrize("spare", [-3e-6, 1e-6, 1e-3, 1.0])  # the first is within rounding, a billionth of the tank
def test_a_tank_that_just_suffices_lands(just_enough, spare):
    descent = Descent(replace(FALCON_9, propellant_mass=just_enough + spare))
    optimum = best_ignition(descent)
    assert optimum.propellant_left == pytest.approx(just_enough + spare - burnt(just_enough + spare), rel=0, abs=1e-6)
    for method in ("rk4", "dop8"):
        assert fly(descent, optimum.t_ignite, method=method).outcome == "soft landing"


@pytest.mark.parametrize("short", [1e-3, 1.0, 1_000.0])
def test_a_tank_that_is_too_small_says_by_how_much(just_enough, short):
    descent = Descent(replace(FALCON_9, propellant_mass=just_enough - short))
    with pytest.raises(NoSoftLanding, match="the tank is too small") as caught:
        best_ignition(descent)
    assert " 0 kg" not in str(caught.value)
    carried = descent.booster.propellant_mass
    assert caught.value.reason == "tank"
    assert caught.value.amount == pytest.approx(burnt(carried) - carried, rel=0, abs=1e-6)
    assert 0.3 * short < caught.value.amount < short


def test_thrust_that_equals_the_dry_weight():
    with pytest.raises(NoSoftLanding, match=r"dry weight on the ground, 266516 N: it only equals it") as caught:
        best_ignition(Descent(replace(FALCON_9, thrust=PAPER.weight(0.0, FALCON_9.dry_mass))))
    assert caught.value.amount == 0


@pytest.mark.parametrize(
    ("descent", "message"),
    [
        (Descent(height=100.0, velocity=-40e3), "more than 16,800 m below the ground"),
        (Descent(planet=MOON, height=100.0, velocity=-40e3), "more than 868,700 m below the ground"),
        (Descent(height=100.0, velocity=-2000.0), r" [\d,]{5,6} m below the ground"),
    ],
)
def test_a_message_says_a_number_that_helps(descent, message):
    with pytest.raises(NoSoftLanding, match=message):
        best_ignition(descent)


@pytest.mark.parametrize(
    ("value", "said"),
    [(0.0, "0"), (4e-4, "0.0004"), (0.123456, "0.123"), (12.345, "12.3"), (999.7, "1,000"), (123456.7, "123,457")],
)
def test_digits_of_a_number_in_a_message(value, said):
    assert digits(value) == said


@pytest.mark.parametrize("missing", [1e-3, 100.0, 50e3])
def test_thrust_not_above_the_dry_weight(missing):
    weight = 27_200 * 6.6743e-11 * EARTH.mass / EARTH.radius**2
    descent = Descent(replace(FALCON_9, thrust=weight - missing))
    for search in (best_ignition, lambda descent: hover_height(descent, 60.0)):
        with pytest.raises(NoSoftLanding, match=r"thrust must exceed the dry weight.* N ") as caught:
            search(descent)
        assert caught.value.reason == "thrust"
        assert caught.value.amount == pytest.approx(missing, rel=1e-6)


@pytest.mark.parametrize(
    "descent",
    [
        Descent(height=100.0, velocity=-400.0),
        Descent(height=1e3, velocity=-2000.0),
        Descent(FALCON_9_LANDING_BURN, height=2e3, velocity=-350.0),
        Descent(planet=MOON, height=5e3, velocity=-2000.0),
        Descent(SLUG, height=5.0, velocity=10.0),  # ascending, and still too late
    ],
)
def test_too_late_already_at_the_start(descent):
    with pytest.raises(NoSoftLanding, match=r"too late already at t = 0.* m below the ground") as caught:
        best_ignition(descent)
    assert caught.value.reason == "too late"
    assert caught.value.amount == pytest.approx(-referee.hover(descent, 0.0)[1], rel=1e-9)


@pytest.mark.parametrize("depth", [1e-3, -1e-3])
def test_a_start_a_millimetre_too_low_is_too_late(depth):
    stop = referee.hover(Descent(height=5e3, velocity=-500.0), 0.0)[1]
    low = referee.brentq(lambda h: referee.hover(Descent(height=h, velocity=-500.0), 0.0)[1], 100.0, 5e3, xtol=1e-10)
    assert stop > 0
    descent = Descent(height=low - depth, velocity=-500.0)
    if depth < 0:
        assert best_ignition(descent).t_ignite == pytest.approx(1e-3 / 500, rel=0.2)
    else:
        with pytest.raises(NoSoftLanding) as caught:
            best_ignition(descent)
        assert caught.value.reason == "too late"
        assert caught.value.amount == pytest.approx(1e-3, rel=0.01)


@pytest.mark.parametrize(
    "descent", [Descent(velocity=12e3), Descent(planet=MOON, velocity=2400.0), Descent(height=1e3, velocity=20e3)]
)
def test_a_booster_above_escape_speed_never_comes_down(descent):
    escape = math.sqrt(2 * 6.6743e-11 * descent.planet.mass / (descent.planet.radius + descent.height))
    with pytest.raises(NoSoftLanding, match="never comes down.* m/s above escape") as caught:
        best_ignition(descent)
    assert caught.value.reason == "never comes down"
    assert caught.value.amount == pytest.approx(descent.velocity - escape, rel=1e-9)


TOO_WEAK = Descent(
    Booster(35e3, 37e3, 2.8, 36e3, 0.5, 0.2), Planet(1.5e20, 1e5, 0.0, 300.0), height=50e3, velocity=-10.0
)


def test_a_jump_of_the_hover_height_is_no_root():
    # gravity doubles on the way down: thrust holds the booster high up, and not further below
    with pytest.raises(NoSoftLanding, match=r"too weak.*lit up to 30.3641 s, .* m above it or higher") as caught:
        best_ignition(TOO_WEAK)
    assert caught.value.reason == "too weak"
    assert caught.value.amount > 10e3
    assert referee.hover(TOO_WEAK, 30.3641)[1] > 15e3
    assert referee.hover(TOO_WEAK, 30.3642)[1] < -10e3


def test_a_burn_that_lasts_for_hours_is_not_stepped_over():
    # it brakes by a millimetre a second each second, while the planet passes from far to near
    descent = Descent(
        Booster(2688.0, 5021.5, 0.06079, 933.776, 0.5, 1.0), Planet(2.783e21, 770e3, 0.0, 8e3), 468.7e3, -3.243
    )
    assert referee.hover(descent, 5.0)[1] > 400e3
    assert referee.hover(descent, 30.0)[1] == -math.inf
    with pytest.raises(NoSoftLanding) as caught:
        best_ignition(descent)
    assert caught.value.reason == "too weak"
    assert 1e3 < caught.value.amount < 400e3


@pytest.mark.parametrize("speed", [130.0, 200.0])
def test_a_burn_that_climbs_away_is_said_to(speed):
    # nearly all mass is dead weight: lighter than the thrust up there, heavier down here
    booster = Booster(35e3, 37e3, 1e-9, 36e3, 0.5, 0.2)
    descent = Descent(booster, Planet(1.5e20, 1e5, 0.0, 300.0), height=1e3, velocity=speed)
    with pytest.raises(NoSoftLanding, match=r"too weak.* the booster climbs away; .* it needs more thrust") as caught:
        best_ignition(descent)
    t = float(str(caught.value).split("lit up to ")[1].split(" ")[0])
    assert hover_height(descent, t * (1 - 1e-4)) == caught.value.amount == math.inf
    assert hover_height(descent, t * (1 + 1e-4)) < 0


def dry_weights(thrust, planet=EARTH, **booster):
    """The paper's booster with so many dry weights of thrust, and one digit more at least."""
    weight = 27_200 * planet.gravity(0.0)
    return replace(FALCON_9, thrust=max(thrust * weight, math.nextafter(weight, math.inf)), **booster)


HARDLY = [
    (Descent(dry_weights(1.0)), "too late"),
    (Descent(dry_weights(1.0), height=10.0, velocity=50.0), "too late"),
    (Descent(dry_weights(1.0, propellant_mass=1.0), height=10.0, velocity=0.0), "too weak"),
    (Descent(dry_weights(1.0, MOON), MOON, height=10.0, velocity=-1.0), "too late"),
    (Descent(dry_weights(1.0, MOON, propellant_mass=1e-3), MOON, height=10.0, velocity=50.0), "too weak"),
    (Descent(dry_weights(1.001, MOON, propellant_mass=1e-3), MOON, height=10.0, velocity=50.0), "tank"),
    (Descent(replace(FALCON_9, propellant_mass=1e-9)), "tank"),
    (Descent(planet=MOON, velocity=math.sqrt(2 * MOON.gravity(150e3) * (MOON.radius + 150e3))), "never comes down"),
]


@pytest.mark.parametrize(("descent", "reason"), HARDLY)
def test_every_refusal_has_numbers_that_are_numbers(descent, reason):
    with evaluations() as counted, pytest.raises(NoSoftLanding) as caught:
        best_ignition(descent)
    assert caught.value.reason == reason
    assert not re.search(r"\b(inf|nan|-?0|0\.00) ", str(caught.value))
    assert re.search("more thrust|propellant are missing|climb more slowly", str(caught.value))
    assert len(counted) < 2e5


TANKER, THIN_LAYER = replace(FALCON_9, propellant_mass=300e3), replace(EARTH, scale_height=0.3)
FAR_AND_SLOW = {  # what took minutes, or never ended, with steps of one length
    "from a million kilometres": Descent(TANKER, height=1e9, velocity=0.0),
    "air of decimetres": Descent(TANKER, THIN_LAYER),
    "air of decimetres, slow": Descent(TANKER, THIN_LAYER, height=20e3, velocity=-10.0),
    "no air, hardly any thrust": Descent(
        dry_weights(1.02, MOON, propellant_mass=100.0, burn_rate=0.02), MOON, height=10e3, velocity=-1.0
    ),
    "no air, next to no gravity": Descent(FALCON_9, Planet(1e12, 1e4, 0.0, 1e3), height=1e4, velocity=-1.0),
}


@pytest.mark.parametrize("name", FAR_AND_SLOW)
def test_an_answer_takes_few_evaluations_however_long_the_descent(name):
    descent = FAR_AND_SLOW[name]
    with evaluations() as counted:
        t_ignite = best_ignition(descent).t_ignite
    assert len(counted) < 2e4
    if descent.planet == THIN_LAYER:  # the last decimetres are slow: there is nothing but the engine to brake
        descent = replace(descent, planet=replace(THIN_LAYER, surface_density=0.0))
    near = 1e-9 * referee.free_fall(descent)[-1][0]
    assert referee.hover(descent, t_ignite - near)[1] > 0 > referee.hover(descent, t_ignite + near)[1]


def test_a_search_that_would_take_too_long_ends_and_says_what_to_change():
    syrup = Planet(mass=5.97e24, radius=6.378e6, surface_density=1e5, scale_height=1e6)
    descent = Descent(FALCON_9_LANDING_BURN, syrup, height=1e6, velocity=-10.0)
    with evaluations() as counted, pytest.raises(ValueError, match="no ignition time was found in 80,000") as caught:
        best_ignition(descent)
    for part in ("start at 1e+06 m", "thrust 3.17", "100000 kg/m³", "scale height of 1e+06 m", "start lower", "thin"):
        assert part in str(caught.value)
    assert not isinstance(caught.value, NoSoftLanding)
    assert len(counted) < 1.1e6


def test_no_soft_landing_survives_copy_and_pickle():
    error = NoSoftLanding("tank", 12.5, "the tank is too small")
    for twin in (copy.copy(error), pickle.loads(pickle.dumps(error))):
        assert (twin.reason, twin.amount, str(twin)) == ("tank", 12.5, "the tank is too small")


# ---- hover height and tables --------------------------------------------------------------------------------------


@pytest.mark.parametrize("name", ["paper", "one engine", "Moon", "ascending", "dense air, little time"])
def test_hover_height_is_the_independent_one(name):
    descent = DESCENTS[name]
    end = referee.free_fall(descent)[-1][0]
    apex = next(t for t, _, v in referee.free_fall(descent) if v <= 0)
    for t_ignite in np.linspace(apex, end, 7)[1:-1]:
        h = referee.hover(descent, t_ignite)[1]
        assert hover_height(descent, t_ignite) == pytest.approx(h, rel=1e-9, abs=1e-7)


@descents
def test_hover_height_falls_with_the_ignition_time_while_falling(name):
    descent = DESCENTS[name]
    fall = referee.free_fall(descent)
    apex = next(t for t, _, v in fall if v <= 0)
    times = np.linspace(apex, fall[-1][0] * (1 - 1e-9), 20)
    heights = [hover_height(descent, t, dt=max(0.05, fall[-1][0] / 1000)) for t in times]
    finite = [h for h in heights if h > -math.inf]
    assert np.all(np.diff(finite) < 0)
    assert heights[: len(finite)] == finite  # once it is out of sight it stays there


def test_hover_height_does_not_stop_with_the_tank():
    # thrust stays on at dry mass, here only
    descent = Descent(replace(FALCON_9, propellant_mass=8_000.0))
    h = referee.hover(descent, 60.0)[1]
    assert fly(descent, 60.0).outcome == "out of propellant"
    assert hover_height(descent, 60.0) == pytest.approx(h, rel=0, abs=1e-6)


def test_hover_height_at_the_limits():
    assert math.isnan(hover_height(PAPER, 66.79))  # after the impact
    assert hover_height(Descent(height=3e3, velocity=250.0), 10.0) == math.inf  # climbs away
    assert hover_height(Descent(velocity=0.0, height=80.0), 0.0) == 80.0  # never falls
    weak = Descent(replace(FALCON_9, thrust=268e3, burn_rate=20.0), MOON, height=10.0, velocity=-2000.0)
    weak = replace(weak, booster=replace(weak.booster, thrust=45e3))
    assert hover_height(weak, 0.0, dt=0.5) == -math.inf  # half-way to the centre


def test_ignition_table_has_a_row_a_time_and_three_columns_a_method():
    times = [59.0, 60.0, 60.3, 61.01234, 66.79]
    table = ignition_table(times, dt=0.02)
    assert list(table.index) == times
    assert table.index.name == "t_ignite [s]"
    quantities = ["hover height [m]", "touchdown velocity [m/s]", "outcome"]
    assert list(table.columns) == [(m, q) for m in ("rk4", "symplectic_euler") for q in quantities]
    rk4 = table["rk4"]
    assert list(rk4["outcome"]) == ["stopped too high"] * 2 + ["crash"] * 3
    for t in times[:4]:
        h = referee.hover(PAPER, t)[1]
        assert rk4["hover height [m]"][t] == pytest.approx(h, rel=0, abs=1e-8)
        assert (h < 0) == (rk4["outcome"][t] == "crash")
        touchdown = referee.fly(PAPER, t).touchdown
        expected = touchdown[1] if touchdown else math.nan
        assert rk4["touchdown velocity [m/s]"][t] == pytest.approx(expected, rel=0, abs=1e-8, nan_ok=True)
    assert math.isnan(rk4["hover height [m]"][66.79])
    assert rk4["touchdown velocity [m/s]"][66.79] == pytest.approx(referee.fly(PAPER, None).touchdown[1], rel=1e-11)


def test_ignition_table_of_another_descent_and_any_iterable():
    table = ignition_table((t for t in (17.0, 17.5)), dt=0.1, methods=("dop8",), descent=LANDING_BURN)
    for t in (17.0, 17.5):
        assert table["dop8", "hover height [m]"][t] == pytest.approx(referee.hover(LANDING_BURN, t)[1], abs=1e-9)


# ---- any booster, any planet --------------------------------------------------------------------------------------


@pytest.mark.parametrize("seed", range(10, 13))
def test_best_ignition_of_any_descent_is_the_independent_one(seed):
    for descent in random_descents(seed, 12):
        with evaluations() as counted:
            try:
                optimum = best_ignition(descent)
            except NoSoftLanding as error:
                optimum = error
        assert len(counted) < 2e4
        fall = referee.free_fall(descent)
        if isinstance(optimum, Ignition) or optimum.reason == "tank":
            t_ignite = referee_ignition(descent)
            t_touchdown = referee.hover(descent, t_ignite)[0]
            booster = descent.booster
            left = booster.propellant_mass - booster.burn_rate * (t_touchdown - t_ignite)
            tolerance = 1e-10 * (1 + t_touchdown)
            if isinstance(optimum, Ignition):
                assert optimum.t_ignite == pytest.approx(t_ignite, rel=0, abs=tolerance)
                assert fly(descent, optimum.t_ignite, dt=0.05, method="dop8").outcome == "soft landing"
            else:
                assert optimum.amount == pytest.approx(-left, rel=0, abs=5 * booster.burn_rate * tolerance)
        else:
            assert optimum.reason == "too late"
            times = np.linspace(0, fall[-1][0], 8)[:-1]
            assert max(referee.hover(descent, t)[1] for t in times) < 0


# ---- bad input ----------------------------------------------------------------------------------------------------


@pytest.mark.parametrize("descent", ["Falcon", FALCON_9, None])
@pytest.mark.parametrize("call", [best_ignition, lambda d: hover_height(d, 60.0), lambda d: fly(d, 60.0)])
def test_what_is_no_descent_is_refused(call, descent):
    with pytest.raises(TypeError, match="descent must be a Descent; got"):
        call(descent)


BAD_HOVERS = [
    ({"t_ignite": -1.0}, ValueError, r"t_ignite must be a finite number at least 0 \[s\]; got -1"),
    ({"t_ignite": math.nan}, ValueError, "t_ignite"),
    ({"t_ignite": math.inf}, ValueError, "t_ignite"),
    ({"t_ignite": None}, TypeError, "t_ignite"),
    ({"t_ignite": np.array([59.0, 60.0])}, TypeError, "t_ignite"),
    ({"dt": 0}, ValueError, r"dt must be a finite number greater than 0 \[s\]; got 0"),
    ({"dt": math.nan}, ValueError, "dt"),
    ({"dt": "0.1"}, TypeError, "dt"),
    ({"dt": 1e-7}, ValueError, "600,000,000 steps or more; at most 10,000,000"),
    ({"method": "euler"}, ValueError, "'euler'.*explicit_euler.*dop8"),
]


@pytest.mark.parametrize(("changed", "error", "message"), BAD_HOVERS)
def test_bad_input_to_hover_height(changed, error, message):
    arguments = {"t_ignite": 60.0} | changed
    with evaluations() as counted, pytest.raises(error, match=message):
        hover_height(PAPER, arguments.pop("t_ignite"), **arguments)
    assert len(counted) < 10


def test_a_burn_of_too_many_steps_is_refused_before_it_is_flown():
    with evaluations() as counted, pytest.raises(ValueError, match="at most 10,000,000"):
        hover_height(Descent(height=10.0, velocity=-40.0), 0.0, dt=1e-8)
    assert len(counted) < 6e5


BAD_TABLES = [
    ({"t_ignite": 60.0}, TypeError, "t_ignite"),
    ({"t_ignite": [60.0, -1.0]}, ValueError, r"t_ignite must be a finite number at least 0 \[s\]"),
    ({"t_ignite": ["60"]}, TypeError, "t_ignite"),
    ({"dt": 0.0}, ValueError, r"dt must be a finite number greater than 0 \[s\]"),
    ({"methods": ("rk5",)}, ValueError, "'rk5'.*explicit_euler.*dop8"),
    ({"methods": "rk4"}, TypeError, r"methods must be a collection of methods, such as \('rk4',\); got 'rk4'"),
    ({"descent": FALCON_9}, TypeError, "descent must be a Descent"),
]


@pytest.mark.parametrize(("changed", "error", "message"), BAD_TABLES)
def test_bad_input_to_ignition_table(changed, error, message):
    arguments = {"t_ignite": [60.0], "dt": 0.1} | changed
    with pytest.raises(error, match=message):
        ignition_table(arguments.pop("t_ignite"), **arguments)


@pytest.mark.parametrize("empty", [{"t_ignite": []}, {"methods": ()}])
def test_an_empty_table_is_empty_or_refused_by_name(empty):
    arguments = {"t_ignite": [60.0], "dt": 0.1} | empty
    try:
        table = ignition_table(arguments.pop("t_ignite"), **arguments)
    except ValueError as error:
        assert next(iter(empty)) in str(error)  # noqa: PT017
    else:
        assert table.size == 0


@pytest.mark.parametrize("method", ["explicit_euler", "symplectic_euler", "rk4", "gauss4"])
@pytest.mark.parametrize(
    "descent", [Descent(), Descent(planet=MOON), Descent(height=30e3, velocity=700.0), LANDING_BURN], ids=range(4)
)
def test_shared_fall_leads_to_the_same_flights(descent, method):
    dt = 0.25
    fall = FreeFall(descent, dt=dt, method=method)
    end = fall.flight.t[-1]
    turn = fall.flight.t[np.argmax(fall.flight.h)]
    random = np.random.default_rng(4).uniform(0, end, 40)
    for t in [0.0, dt, dt + 1e-12, 3 * dt - 1e-12, turn, turn + 1e-3, *random, 0.999 * end, end, end + 1.0]:
        flown, anew = fall.fly(t), fly(descent, t, dt=dt, method=method)
        assert flown.outcome == anew.outcome
        for name in ("t", "h", "v", "mass", "throttle"):
            np.testing.assert_allclose(getattr(flown, name), getattr(anew, name), rtol=1e-13, atol=1e-9)
        assert flown.t[-1] == pytest.approx(anew.t[-1], abs=1e-9)
        again = hover_height(descent, t, dt=dt, method=method)
        np.testing.assert_allclose(fall.hover_height(t), again, rtol=1e-12, atol=1e-7)


@pytest.mark.parametrize("t_ignite", [60.211, 60.2110345])
def test_shared_fall_ends_as_softly(t_ignite):
    flown, anew = FreeFall(PAPER).fly(t_ignite), fly(PAPER, t_ignite)
    assert flown.outcome == anew.outcome == "soft landing"
    assert flown.hover == pytest.approx(anew.hover, rel=1e-12, abs=1e-9)
    assert flown.touchdown == pytest.approx(anew.touchdown, rel=1e-6)
    assert len(flown.t) == len(anew.t)


def test_shared_fall_takes_a_controller_and_refuses_what_fly_refuses():
    def half(t, h, v, mass):
        return 0.5

    fall = FreeFall(LANDING_BURN, dt=0.1)
    assert fall.fly(20.0, half).throttle[-1] == 0.5
    for bad in (-1.0, math.nan, "now", [1.0]):
        with pytest.raises((ValueError, TypeError), match="t_ignite"):
            fall.fly(bad)
    with pytest.raises(TypeError, match="controller"):
        fall.fly(20.0, 0.5)
    with pytest.raises(ValueError, match="never comes down"):
        FreeFall(Descent(velocity=20e3))


@pytest.mark.parametrize(
    ("careless", "asked"),
    [
        (Descent(replace(FALCON_9, thrust=7605.0)), "did you mean 7605 kN = 7.605e+06 N?"),
        (Descent(height=150.0), "did you mean 150 km?"),
    ],
)
def test_a_refusal_asks_whether_a_unit_was_meant(careless, asked):
    with pytest.raises(NoSoftLanding, match=re.escape(asked)):
        best_ignition(careless)


HARDLY_KILONEWTONS = PAPER.weight(0.0, FALCON_9.dry_mass) / 1000  # a thousand times that is no more than the weight


@pytest.mark.parametrize(
    "hopeless",
    [
        Descent(replace(FALCON_9, thrust=20.0)),
        Descent(replace(FALCON_9, thrust=HARDLY_KILONEWTONS)),
        Descent(height=1.5e3),
        Descent(height=1.0, velocity=-3e3),
    ],
)
def test_a_refusal_does_not_ask_where_the_unit_would_not_help(hopeless):
    with pytest.raises(NoSoftLanding) as caught:
        best_ignition(hopeless)
    assert "did you mean" not in str(caught.value)


def test_an_air_that_ends_somewhere_is_no_hindrance():
    """A step that is tried may look far above the start, where a power of a negative number is complex."""

    class Standard(Planet):
        def air_density(self, h):
            return 1.225 * (1 - 0.0065 * h / 288.15) ** 4.25588

    booster = replace(FALCON_9_LANDING_BURN, dry_mass=29e3, propellant_mass=5e3, drag_coefficient=0.8)
    descent = Descent(booster, Standard(**asdict(EARTH)), 4.8e3, -318.0)
    best = best_ignition(descent)
    assert hover_height(descent, best.t_ignite, dt=0.01, method="dop8") == pytest.approx(0, abs=1e-8)


def test_bracket_near_a_root_reaches_to_its_other_side_or_there_is_none():
    def lit(t, slope=-8.0):
        """(h, v, t_stop, hover height) of a burn lit at t, which stops at 0 if t is 61 s."""
        return 500.0, -10.0, 99.0, slope * (t - 61.0)

    from_before = _near(lit, 60.9, 100.0)
    assert from_before == pytest.approx((60.9, 62.5, 0.8, -12.0))
    from_behind = _near(lit, 61.1, 100.0)
    assert from_behind == pytest.approx((61.1, 59.5, -0.8, 12.0))
    assert _near(lit, 60.9, 60.95) is None, "the fall ends before"
    assert _near(lambda t: lit(t, 8.0), 60.9, 100.0) is None
    assert _near(lambda t: (500.0, 0.0, 99.0, 1.0), 60.9, 100.0) is None, "at rest there is no telling how far to go"
