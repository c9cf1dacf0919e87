"""Many flights at once: each row is the flight that `fly` flies."""

import math
import os
import re
import signal
import subprocess
import sys
import time
import tracemalloc
from dataclasses import replace

import numpy as np
import pandas as pd
import pytest
import referee
import strategies
from hypothesis import given, settings
from hypothesis import strategies as st
from test_descent import BURNOUTS, CLIMBS, CRASHES, evaluations, short_walks  # noqa: F401 - a fixture

from hoverslam_lib import (
    EARTH,
    FALCON_9,
    LANDING_BURN,
    MARS,
    MOON,
    OUTCOMES,
    SOFT_SPEED,
    Booster,
    Descent,
    FreeFall,
    NoSoftLanding,
    Planet,
    best_ignition,
    ensemble,
    fly,
    fly_all,
    hover_height,
    speed_after_fall,
)
from hoverslam_lib.descent import StepTooLargeError, coast

PAPER = Descent()
HEADERS = ["outcome", "hover height [m]", "touchdown time [s]", "touchdown velocity [m/s]", "propellant left [kg]"]


def worlds(n, seed=0):
    """Landings of one engine whose numbers differ a little, and their ignition times."""
    normal = np.random.default_rng(seed).normal(size=(5, n))
    booster = replace(
        LANDING_BURN.booster,
        thrust=LANDING_BURN.booster.thrust * (1 + 0.01 * normal[0]),
        drag_coefficient=0.5 * (1 + 0.1 * normal[1]),
        propellant_mass=5_200.0 + 500.0 * normal[2],
    )
    descent = replace(LANDING_BURN, booster=booster, height=10e3 + 20.0 * normal[3])
    return descent, best_ignition(LANDING_BURN).t_ignite + 0.1 * normal[4]


def braking(t, h, v, mass):
    """Throttle for a stop at the ground, on while it falls: takes numbers and arrays."""
    wanted = mass * (v * v / (2 * np.maximum(h, 0.1)) + 9.8) / 845e3
    return np.where(np.less(v, 0), np.clip(wanted, 0.4, 1.0), 0.0)


def pulsed(t, h, v, mass):
    return 1.0 * (np.sin(1.7 * t + 1e-3 * h) > 0.2)


# ---- one by one ---------------------------------------------------------------------------------------------------


def row(descent, t_ignite, *, controller=None, **settings):
    """What `fly` and `hover_height` say of one flight, as a row of the table; and whether the last digit decides it.

    It does where the flight grazes the ground, or would be just soft, to a millionth of a metre.
    """
    law = None if controller is None else lambda *state: float(controller(*state))
    flight = fly(descent, t_ignite, controller=law, **settings)
    hover = height = flight.hover[1] if flight.hover else math.nan
    if law is None:
        try:
            height = hover_height(descent, t_ignite, **settings)
        except NoSoftLanding:
            height = math.nan
    left = flight.mass[-1] - descent.booster.dry_mass
    g = descent.planet.gravity(0.0)
    end = flight.touchdown[1] if flight.touchdown else speed_after_fall(descent.planet, flight.h[-1], flight.v[-1])
    from_edges = [hover, hover - SOFT_SPEED**2 / 2 / g, height, (abs(end) - SOFT_SPEED) * SOFT_SPEED / g]
    near = any(abs(metres) < 1e-6 for metres in from_edges)
    return (flight.outcome, height, *(flight.touchdown or (math.nan, math.nan)), left), near


def check_rows(table, rows, near):
    """Outcomes equal, heights to 1e-8 m, touchdowns to 1e-8 s and 1e-6 m/s, away from the edges between outcomes."""
    expected = pd.DataFrame(rows, columns=HEADERS)
    np.testing.assert_allclose(table[HEADERS[1]], expected[HEADERS[1]], rtol=0, atol=1e-8)
    sure = ~np.array(near, dtype=bool)
    assert table["outcome"][sure].astype(str).tolist() == expected["outcome"][sure].tolist()
    for header, tolerance in zip(HEADERS[2:], (1e-8, 1e-6, 1e-5), strict=True):
        np.testing.assert_allclose(table[header][sure], expected[header][sure], rtol=0, atol=tolerance, err_msg=header)


def fly_one_by_one(flights, **settings):
    """The flights that `fly` can fly with this step, their rows, and which are near an edge."""
    kept, rows, near = [], [], []
    for flight in flights:
        try:
            found = row(*flight, **settings)
        except StepTooLargeError:
            continue
        for collected, one in zip((kept, rows, near), (flight, *found), strict=True):
            collected.append(one)
    return kept, rows, near


def test_each_row_is_the_flight_that_fly_flies():
    seen = set()

    @settings(max_examples=20)
    @given(st.lists(strategies.flights(), min_size=4, max_size=12))
    def compare(flights):
        ways = [("rk4", None), ("symplectic_euler", None), ("implicit_euler", None), ("rk4", pulsed)]
        for method, controller in ways:
            how = {"dt": 0.25, "method": method, "controller": controller}
            kept, rows, near = fly_one_by_one(flights, **how)
            if kept:
                descents, times = zip(*kept, strict=True)
                check_rows(fly_all(strategies.stacked(descents), np.array(times), **how), rows, near)
            seen.update((outcome, controller is None) for outcome, *_ in rows)
            seen.update("after the impact" for end, height, *_ in rows if math.isnan(height) and end == "crash")
            seen.update("ascending" for descent, _ in kept if descent.velocity > 0)
            seen.update("no air" for descent, _ in kept if not descent.planet.surface_density)

    compare()
    ends = {(outcome, full) for outcome in OUTCOMES for full in (True, False)}
    assert seen == ends | {"after the impact", "ascending", "no air"}


@pytest.mark.parametrize("method", ["gauss4", "dop8", "rkn4", "explicit_euler"])
@pytest.mark.parametrize("controller", [None, braking])
def test_each_row_is_the_flight_that_fly_flies_with_the_other_methods_too(method, controller):
    descent, t_ignite = worlds(6)
    how = {"dt": 0.5, "method": method, "controller": controller}
    rows, near = zip(*(row(descent.rows(i), t, **how) for i, t in enumerate(t_ignite)), strict=True)
    check_rows(fly_all(descent, t_ignite, **how), rows, near)


def test_a_step_function_of_ones_own_flies_too():
    def midpoint(f, t, h, v, dt):
        a = f(t, h, v)
        a = f(t + dt / 2, h + dt / 2 * v, v + dt / 2 * a)
        return h + dt * (v + dt / 2 * a), v + dt * a

    descent, t_ignite = worlds(6)
    rows, near = zip(*(row(descent.rows(i), t, dt=0.1, method=midpoint) for i, t in enumerate(t_ignite)), strict=True)
    check_rows(fly_all(descent, t_ignite, method=midpoint), rows, near)


@pytest.mark.parametrize("dt", [0.02, 0.07, 5.0])
def test_where_only_the_ignition_differs_the_fall_is_shared(dt, monkeypatch):
    # on a node, next to one, within the last step before the impact, at it and after it
    impact = fly(PAPER, None, dt=dt).touchdown[0]
    t_ignite = np.array([0.0, 40.0, 2 * dt, 60.2, 60.21, 60.3, 66.7, impact - 1e-6, impact, impact + 1e-9, 70.0, 1e12])
    falls = []
    monkeypatch.setattr(ensemble, "coast", lambda *args, **kwargs: falls.append(1) or coast(*args, **kwargs))
    rows, near = zip(*(row(PAPER, t, dt=dt) for t in t_ignite), strict=True)
    near = np.array(near) | (abs(t_ignite - impact) < 1e-8)
    check_rows(fly_all(PAPER, t_ignite, dt=dt), rows, near)
    assert len(falls) == 1
    assert FreeFall(PAPER, dt=dt).fly(60.3).touchdown[1] == pytest.approx(rows[5][3], rel=1e-12)


def test_an_ascending_fall_is_shared_over_its_apex():
    descent = Descent(height=3e3, velocity=250.0)
    apex = float(fly(descent, None, dt=0.3).t[np.flatnonzero(fly(descent, None, dt=0.3).v == 0)[0]])
    t_ignite = np.array([0.0, 1.0, apex - 1e-9, apex, apex + 1e-9, 30.123, 58.7])
    rows, near = zip(*(row(descent, t, dt=0.3) for t in t_ignite), strict=True)
    check_rows(fly_all(descent, t_ignite, dt=0.3), rows, near)


def test_a_free_fall_is_an_ensemble_too():
    descent, _ = worlds(5)
    table = fly_all(descent, None)
    assert table["touchdown time [s]"].tolist() == pytest.approx(
        [fly(descent.rows(i), None, dt=0.1).touchdown[0] for i in range(5)], abs=1e-9
    )
    assert table["hover height [m]"].isna().all()
    assert (table["propellant left [kg]"] == descent.booster.propellant_mass).all()


@pytest.mark.parametrize("t_ignite", [0.0, 20.0])
def test_faster_than_it_could_escape_and_yet_held_back_by_the_air(t_ignite):
    descent = Descent(FALCON_9, EARTH, 1.0, 12e3)
    flight, reference = fly(descent, t_ignite), referee.fly(descent, t_ignite)
    assert flight.outcome == reference.outcome
    assert (flight.t[-1], flight.h[-1], flight.v[-1]) == pytest.approx(reference.burnout, rel=1e-7)
    several = replace(descent, height=np.array([1.0, 2.0]))
    rows, near = zip(*(row(several.rows(i), t_ignite, dt=0.02) for i in range(2)), strict=True)
    check_rows(fly_all(several, t_ignite, dt=0.02), rows, near)


def test_faster_than_it_could_escape_it_comes_down_again():
    descent = Descent(FALCON_9, EARTH, 1.0, 12e3)
    t, _, v = referee.free_fall(descent)[-1]
    how = {"dt": 0.2, "method": "dop8"}
    assert fly(descent, None, **how).touchdown == pytest.approx((t, v), rel=1e-9)
    table = fly_all(replace(descent, height=np.array([1.0, 1.0])), None, **how)
    assert table["touchdown time [s]"].tolist() == pytest.approx([t, t], rel=1e-9)
    assert table["touchdown velocity [m/s]"].tolist() == pytest.approx([v, v], rel=1e-9)


@pytest.mark.parametrize("planet", [EARTH, MARS, MOON])
def test_a_tank_that_runs_dry_just_above_the_ground_too_fast(planet):
    booster = replace(FALCON_9, propellant_mass=40.0)  # 27 ms, or some 7 m/s
    descent = Descent(booster, planet, 0.3, np.array([-12.0, -11.0, -10.0, -8.0, -2.0]))
    rows, near = zip(*(row(descent.rows(i), 0.0, dt=0.01) for i in range(5)), strict=True)
    for i, found in enumerate(rows):
        reference = referee.fly(descent.rows(i), 0.0)
        assert found[0] == reference.outcome
        if found[0] == "out of propellant":
            assert 0 < reference.burnout[1] < 0.3
            flight = fly(descent.rows(i), 0.0, dt=0.01)
            assert (flight.t[-1], flight.h[-1], flight.v[-1]) == pytest.approx(reference.burnout, abs=1e-8)
    assert [found[0] for found in rows].count("out of propellant") >= 2
    check_rows(fly_all(descent, 0.0, dt=0.01), rows, near)


# ---- against the independent flight -------------------------------------------------------------------------------


def of_referee(cases):
    """The cases as one descent with columns, and the independent flights."""
    descents, times = zip(*cases, strict=True)
    return strategies.stacked(descents), np.array(times), [referee.fly(*case) for case in cases]


def test_touchdowns_are_those_of_the_independent_flights():
    cases = [case for case in CRASHES if case[1] is not None]
    descent, t_ignite, references = of_referee(cases)
    table = fly_all(descent, t_ignite, dt=0.02)
    t, v = zip(*(flight.touchdown for flight in references), strict=True)
    assert (table["outcome"] == "crash").all()
    np.testing.assert_allclose(table["touchdown time [s]"], t, rtol=0, atol=1e-10)
    np.testing.assert_allclose(table["touchdown velocity [m/s]"], v, rtol=0, atol=1e-8)
    left = [flight.mesh[-1][3] - one.booster.dry_mass for flight, (one, _) in zip(references, cases, strict=True)]
    np.testing.assert_allclose(table["propellant left [kg]"], left, rtol=0, atol=1e-6)


def test_hover_heights_are_those_of_the_independent_flights():
    cases = [case[:2] for case in BURNOUTS] + [(PAPER, 60.3), (LANDING_BURN, 17.3)]
    descent, t_ignite, references = of_referee(cases)
    table = fly_all(descent, t_ignite, dt=0.02)
    assert table["outcome"].tolist() == [flight.outcome for flight in references]
    heights = [referee.hover(*case)[1] for case in cases]
    np.testing.assert_allclose(table["hover height [m]"], heights, rtol=0, atol=2e-8)
    assert table["touchdown time [s]"].isna().tolist() == [flight.touchdown is None for flight in references]


# ---- the table ----------------------------------------------------------------------------------------------------


def bits(table):
    return [table["outcome"].cat.codes.tolist()] + [
        table[header].to_numpy().view(np.int64).tolist() for header in HEADERS[1:]
    ]


@pytest.mark.parametrize(("method", "controller"), [("rk4", None), ("symplectic_euler", None), ("rk4", braking)])
def test_the_bits_do_not_depend_on_blocks_and_order(method, controller, monkeypatch):
    descent, t_ignite = worlds(150)
    how = {"dt": 0.5, "method": method, "controller": controller}
    whole = fly_all(descent, t_ignite, **how)
    for size in (1, 7, 64):
        monkeypatch.setattr(ensemble, "BLOCK", size)
        assert bits(fly_all(descent, t_ignite, **how)) == bits(whole)
    order = np.random.default_rng(1).permutation(150)
    shuffled = fly_all(descent.rows(order), t_ignite[order], **how)
    assert bits(shuffled) == bits(whole.iloc[order])


def test_the_bits_do_not_depend_on_blocks_and_order_where_the_fall_is_shared(monkeypatch):
    t_ignite = np.linspace(58.0, 67.0, 40)
    whole = fly_all(PAPER, t_ignite)
    monkeypatch.setattr(ensemble, "BLOCK", 7)
    assert bits(fly_all(PAPER, t_ignite)) == bits(whole)
    assert bits(fly_all(PAPER, t_ignite[::-1])) == bits(whole[::-1])


@pytest.mark.parametrize("n", [0, 1, 15, 16, 17])
def test_any_number_of_rows_makes_a_table(n, monkeypatch):
    descent, t_ignite = worlds(17)
    whole = fly_all(descent, t_ignite, dt=0.5)
    monkeypatch.setattr(ensemble, "BLOCK", 16)
    first = slice(0, n)
    table = fly_all(descent.rows(first), t_ignite[first], dt=0.5)
    assert bits(table) == bits(whole[first])
    assert table.columns.tolist() == HEADERS
    assert table["outcome"].dtype == pd.CategoricalDtype(OUTCOMES)
    assert table.index.equals(pd.RangeIndex(n))


def test_one_flight_is_a_table_of_one_row():
    assert fly_all(PAPER, 60.3)["touchdown velocity [m/s]"].tolist() == [
        pytest.approx(fly(PAPER, 60.3, dt=0.1).touchdown[1], abs=1e-9)
    ]


def test_the_index_is_that_of_a_pandas_column():
    names = pd.Index(["b", "a", "c"], name="world")
    thrust = pd.Series([845e3, 850e3, 840e3], index=names)
    descent = replace(LANDING_BURN, booster=replace(LANDING_BURN.booster, thrust=thrust))
    table = fly_all(descent, np.array([17.0, 17.5, 18.0]), dt=0.5)
    assert table.index.equals(names)
    assert (
        table["hover height [m]"].tolist()
        == fly_all(descent.rows(slice(0, 3)), [17.0, 17.5, 18.0], dt=0.5)["hover height [m]"].tolist()
    )
    with pytest.raises(ValueError, match="booster.thrust and t_ignite differ in their pandas index"):
        fly_all(descent, pd.Series([17.0, 17.5, 18.0]))


def test_memory_grows_by_the_result_alone(monkeypatch):
    monkeypatch.setattr(ensemble, "BLOCK", 2_000)

    def peak(blocks):
        descent = Descent(height=np.linspace(5.0, 6.0, blocks * 2_000), velocity=-20.0)
        tracemalloc.start()
        fly_all(descent, 0.0)
        most = tracemalloc.get_traced_memory()[1]
        tracemalloc.stop()
        return most

    peak(1)
    assert peak(20) - peak(2) < 1.1 * 18 * 2_000 * (2 * 4 * 8 + 2)  # the table, and once more while it is made


# ---- columns ------------------------------------------------------------------------------------------------------


def test_descents_with_columns_compare_to_one_bool_and_have_no_hash():
    descent, _ = worlds(3)
    again, _ = worlds(3)
    other = replace(descent, booster=replace(descent.booster, thrust=descent.booster.thrust + [0.0, 0.0, 1e-9]))
    assert (descent == again) is True
    assert (descent == other) is False
    assert (descent == LANDING_BURN) is False
    assert (descent == descent.rows(slice(0, 2))) is False
    assert descent != "descent"
    assert replace(LANDING_BURN) == LANDING_BURN
    assert hash(LANDING_BURN) == hash(replace(LANDING_BURN))
    with pytest.raises(TypeError, match="unhashable"):
        hash(descent)


def test_a_descent_shows_the_shape_of_its_columns():
    descent, _ = worlds(3)
    assert "thrust=<column, shape (3,)>" in repr(descent)
    assert "height=<column, shape (3,)>, velocity=-350.0" in repr(descent)
    assert "[" not in repr(descent)
    assert repr(Descent(height=5.0)).endswith("height=5.0, velocity=-2000.0)")


def test_a_row_of_a_descent_is_a_descent_of_plain_floats():
    descent, _ = worlds(3)
    one = descent.rows(2)
    assert not one.columns
    assert type(one.height) is type(one.booster.thrust) is float
    assert one.height == descent.height[2]
    assert list(descent.columns) == [
        "booster.propellant_mass",
        "booster.thrust",
        "booster.drag_coefficient",
        "height",
    ]


def test_what_a_descent_says_of_its_columns_it_says_of_each_row():
    descents = [LANDING_BURN, PAPER, Descent(planet=MOON, height=1e3), Descent(planet=MARS)]
    columns = strategies.stacked(descents)
    h, v = np.array([10.0, 1e3, 5.0, 2e3]), np.array([-5.0, 20.0, -3.0, 1.0])
    for ask in (
        lambda d, h, v: d.drag(h, v),
        lambda d, h, v: d.weight(h, d.booster.mass(3.0)),
        lambda d, h, v: d.acceleration(throttle=0.5, since=1.0)(4.0, h, v),
        lambda d, h, v: d.planet.air_density(100.0),
        lambda d, h, v: d.booster.area * d.booster.burn_duration,
    ):
        one_by_one = [ask(*each) for each in zip(descents, h.tolist(), v.tolist(), strict=True)]
        np.testing.assert_allclose(ask(columns, h, v), one_by_one, rtol=1e-13)


BAD_COLUMNS = [
    (Booster, "thrust", [1.0, math.nan, 2.0], "thrust in row 1 must be a finite number greater than 0 [N]; got nan"),
    (Booster, "dry_mass", [1.0, 2.0, -1.0], "dry_mass in row 2 must be a finite number greater than 0 [kg]; got -1.0"),
    (Planet, "surface_density", [-1, 0, 0], "surface_density in row 0 must be a finite number at least 0 [kg/m³]"),
    (Descent, "height", [0.0, 1.0, 1.0], "height in row 0 must be a finite number greater than 0 [m]; got 0.0"),
    (Descent, "velocity", [0.0, 1.0, math.inf], "velocity in row 2 must be a finite number [m/s]; got inf"),
]


@pytest.mark.parametrize(("cls", "name", "column", "message"), BAD_COLUMNS)
def test_a_bad_number_in_a_column_is_refused_with_its_row(cls, name, column, message):
    good = {Booster: FALCON_9, Planet: EARTH, Descent: PAPER}[cls]
    with pytest.raises(ValueError, match=re.escape(message)):
        replace(good, **{name: np.array(column)})
    with pytest.raises(ValueError, match=f"{name} in row [xyz] must be"):
        replace(good, **{name: pd.Series(column, index=["x", "y", "z"])})


def test_columns_that_do_not_go_together_say_so():
    with pytest.raises(ValueError, match="same number of rows: thrust has 2, radius has 3"):
        replace(FALCON_9, thrust=np.ones(2), radius=np.ones(3))
    with pytest.raises(ValueError, match="same number of rows: mass has 2, radius has 3"):
        replace(EARTH, mass=np.full(2, 6e24), radius=np.full(3, 6e6))
    with pytest.raises(ValueError, match="same number of rows: booster.thrust has 2, height has 3"):
        Descent(replace(FALCON_9, thrust=np.full(2, 1e6)), height=np.ones(3))
    with pytest.raises(ValueError, match="same number of rows: height has 3, t_ignite has 2"):
        fly_all(Descent(height=np.ones(3)), [1.0, 2.0])
    with pytest.raises(TypeError, match="height must be a column of finite numbers"):
        Descent(height=np.array(["1", "2"]))


@pytest.mark.parametrize("ask", [fly, hover_height, lambda descent, t: best_ignition(descent)])
def test_what_takes_one_descent_points_to_fly_all(ask):
    with pytest.raises(TypeError, match=r"got columns \(height\): `fly_all` flies one flight a row"):
        ask(Descent(height=np.array([1e3, 2e3])), 10.0)


# ---- bad input ----------------------------------------------------------------------------------------------------

BAD_ENSEMBLES = [
    ({"descent": "Falcon"}, TypeError, "descent must be a Descent"),
    ({"t_ignite": np.array([1.0, math.nan, 2.0])}, ValueError, r"t_ignite in row 1 must be .* \[s\]; got nan"),
    ({"t_ignite": [1.0, 2.0, -1.0]}, ValueError, "t_ignite in row 2"),
    ({"t_ignite": "60"}, TypeError, "t_ignite"),
    ({"dt": 0.0}, ValueError, "dt"),
    ({"dt": 1e-7}, ValueError, "at most 10,000,000 are allowed"),
    ({"method": "rk5"}, ValueError, "there is no method 'rk5'"),
    ({"controller": 0.8}, TypeError, "controller must be a function"),
]


@pytest.mark.parametrize(("changed", "error", "message"), BAD_ENSEMBLES)
def test_bad_ensemble(changed, error, message):
    arguments = {"descent": Descent(height=np.array([1e5, 1.5e5, 1.2e5])), "t_ignite": 60.0} | changed
    with pytest.raises(error, match=message):
        fly_all(arguments.pop("descent"), arguments.pop("t_ignite"), **arguments)


def test_what_fly_refuses_is_refused_with_its_row():
    ascents = Descent(velocity=pd.Series([-2000.0, 12e3], index=["down", "away"]))
    with pytest.raises(ValueError, match="in row away: the booster never comes down: at h = .* it still climbs"):
        fly_all(ascents, None)
    light = Descent(Booster(20.0, 20.0, 0.2, 600.0, 0.5, 1.0), EARTH, 100.0, np.array([0.0, 200.0]))
    with pytest.raises(StepTooLargeError, match=r"in row 1: a climb ends on the ground: dt = 0.5 s is too large"):
        fly_all(light, None, dt=0.5)
    with pytest.raises(StepTooLargeError, match=r"in row 1: (a climb ends on the ground|the numbers overflow): dt"):
        fly_all(light, 0.0, dt=0.5)
    with pytest.raises(StepTooLargeError, match=r"in row 0: the numbers overflow: dt = 0.5 s is too large"):
        fly_all(replace(light, velocity=np.array([-200.0, -50.0])), 0.0, dt=0.5)


# ---- controllers --------------------------------------------------------------------------------------------------


def law_for_numbers(t, h, v, mass):
    return 1 if h < 500 else 0.7


def test_a_law_for_numbers_gets_a_sentence_that_says_so():
    descent, t_ignite = worlds(4)
    with pytest.raises(ValueError, match="truth value of an array") as caught:
        fly_all(descent, t_ignite, controller=law_for_numbers)
    assert "np.vectorize(law, otypes=[float])" in caught.value.__notes__[0]
    vectorized = np.vectorize(law_for_numbers, otypes=[float])
    rows, near = zip(
        *(row(descent.rows(i), t, dt=0.1, controller=law_for_numbers) for i, t in enumerate(t_ignite)), strict=True
    )
    check_rows(fly_all(descent, t_ignite, controller=vectorized), rows, near)


def test_a_law_whose_first_answer_is_a_whole_number_is_not_cut_to_whole_numbers():
    with pytest.raises(TypeError, match=r"whole numbers.*np.vectorize\(law, otypes=\[float\]\)"):
        fly_all(Descent(height=np.array([450.0, 900.0]), velocity=-50.0), 0.0, controller=np.vectorize(law_for_numbers))


def test_what_a_law_raises_reaches_its_author():
    class Mine(Exception):
        pass

    def law(t, h, v, mass):
        raise Mine("mine")

    with pytest.raises(Mine, match="mine"):
        fly_all(*worlds(3), controller=law)


@pytest.mark.parametrize(
    ("law", "error", "message"),
    [
        (lambda t, h, v, mass: np.where(h < 700, 1.5, 0.5), ValueError, "in row 2: .*at most 1.*got 1.5"),
        (lambda t, h, v, mass: math.nan, ValueError, "in row 0: controller"),
        (lambda t, h, v, mass: None, TypeError, "must return a number for each flight"),
        (lambda t, h, v, mass: h < 700, TypeError, "must return a number for each flight"),
        (lambda t, h, v, mass: np.ones(2), TypeError, r"array of shape \(3,\)"),
        (lambda t, h, v, mass: np.subtract(h, 1.0, out=h), ValueError, "read-only"),
    ],
)
def test_a_bad_throttle_is_refused(law, error, message):
    with pytest.raises(error, match=message):
        fly_all(Descent(height=np.array([900.0, 800.0, 600.0]), velocity=-50.0), 0.0, controller=law)


def test_a_law_is_asked_at_ignition_and_every_dt_after_it_of_those_under_way():
    asked = []

    def law(t, h, v, mass):
        asked.append((t.copy(), h.copy(), mass.copy()))
        return 0.9

    descent = Descent(FALCON_9, EARTH, np.array([2e3, 115.0]), -100.0)
    table = fly_all(descent, np.array([2.0, 1.0]), dt=0.1, controller=law)
    assert asked[0][0].tolist() == [2.0, 1.0]
    assert asked[0][2].tolist() == [57_200.0] * 2
    for i, (t, _, mass) in enumerate(asked):
        assert t - asked[0][0][: len(t)] == pytest.approx(0.1 * i, abs=1e-12)
        assert mass == pytest.approx(57_200 - 0.9 * 1_480 * 0.1 * i, rel=1e-12)
    under_way = [len(t) for t, *_ in asked]
    assert under_way == sorted(under_way, reverse=True)
    assert set(under_way) == {1, 2}
    assert table["outcome"].tolist() == ["stopped too high", "crash"]


# ---- while it runs ------------------------------------------------------------------------------------------------


def test_progress_is_printed_where_it_is_asked_for(capsys, monkeypatch):
    descent, t_ignite = worlds(5)
    monkeypatch.setattr(ensemble, "BLOCK", 2)
    fly_all(descent, t_ignite, dt=0.5)
    assert capsys.readouterr() == ("", "")
    fly_all(descent, t_ignite, dt=0.5, progress=True)
    out, err = capsys.readouterr()
    assert out == ""
    assert err.split("\r")[1:] == [f"fly_all: {done} of 5 flights" for done in (0, 2, 4)] + [
        "fly_all: 5 of 5 flights\n"
    ]


@pytest.mark.usefixtures("short_walks")
@pytest.mark.parametrize(
    ("descent", "t_ignite", "dt", "steps"),
    [
        (Descent(velocity=np.array([-300.0, 10.9e3])), None, 20.0, r"20,77\d"),  # falls, after a long way up
        (Descent(velocity=np.array([-300.0, 10.9e3])), 150e3, 5.0, "30,000"),  # climbs when it is lit
        (replace(CLIMBS, velocity=np.array([-1.0, 1.0])), 0.0, 140.0, r"21,42\d"),  # lit while it climbs
    ],
)
def test_flights_that_would_take_too_many_steps_are_refused_before_they_are_flown(descent, t_ignite, dt, steps):
    with evaluations() as counted, pytest.raises(ValueError, match=f"would take {steps} steps or more"):
        fly_all(descent, t_ignite, dt=dt)
    assert len(counted) < 5 * 1_000 + 1_100


@pytest.mark.skipif(os.name == "nt", reason="Windows sends no SIGINT to one process")
def test_it_can_be_interrupted_at_once():
    code = (
        "import signal; signal.signal(signal.SIGINT, signal.default_int_handler); "  # where a shell has it ignored
        "import numpy as np; from hoverslam_lib import *; "
        "fly_all(Descent(height=np.linspace(1e5, 2e5, 2_000_000)), 60.0, dt=0.02, progress=True)"
    )
    process = subprocess.Popen([sys.executable, "-c", code], stderr=subprocess.PIPE, text=True)
    assert process.stderr.read(5) == "\nfly_"  # \r, as text
    time.sleep(0.5)
    sent = time.monotonic()
    process.send_signal(signal.SIGINT)
    _, err = process.communicate(timeout=20)
    assert "KeyboardInterrupt" in err
    assert time.monotonic() - sent < 5
