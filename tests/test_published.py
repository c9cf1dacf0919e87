"""The paper's printed numbers, reproduced; its faults, each against an equation written down here."""

import math
from itertools import chain, combinations

import numpy as np
import pandas as pd
import pytest
from scipy.integrate import solve_ivp

from hoverslam_lib import Trajectory, data, integrate, published
from hoverslam_lib.published import ALL_FAULTS, TIME_CAP, Fault

G, EARTH_MASS, EARTH_RADIUS = 6.6743e-11, 5.972167867791379e24, 6_378_100.0
AREA = math.pi * 1.83**2
BURN_DURATION = 30_000 / 1_480
COMBINATIONS = [set(some) for some in chain.from_iterable(combinations(Fault, n) for n in range(5))]
HEADLINE = {"t_ignite": 35.88, "dt": 0.02}


def names(faults):
    return "+".join(fault.name for fault in Fault if fault in faults) or "none"


# ---- Figures 7.7 to 7.9 -----------------------------------------------------------------------------------------

# the three speeds that do not come out as printed
NOT_REPRODUCED = {
    (0.05, 35.9, "rkn4"): -109.31,  # printed -116
    (0.05, 36.0, "rkn4"): -176.61,  # printed -181, which is -176.61 at dt = 0.1 s
    (0.05, 36.0, "symplectic_euler"): -162.66,  # printed -157
}


def printed_speeds(dt):
    """Speeds as text, because how many digits are printed matters."""
    cells = pd.read_csv(data.FOLDER / "optimisation_tables.csv", dtype=str)
    cells = cells[(cells["quantity"] == "velocity") & (cells["dt"] == str(dt))]
    return {(float(t), method): v for t, method, v in cells[["t_ignite", "method", "value"]].to_numpy()}


@pytest.mark.parametrize("dt", [0.02, 0.05, 0.1])
def test_every_printed_speed_comes_out_to_its_printed_digits_but_three(dt):
    table = published.optimisation_table(dt)
    speeds = printed_speeds(dt)
    assert set(table.index) == set(speeds)
    missed = {}
    for (t_ignite, method), text in speeds.items():
        row = table.loc[(t_ignite, method)]
        scale = 10 ** len(text.partition(".")[2])
        computed = row["v computed [m/s]"] * scale
        assert row["v printed [m/s]"] == float(text)
        assert row["v difference [m/s]"] == row["v computed [m/s]"] - float(text)
        if round(float(text) * scale) not in (round(computed), math.trunc(computed)):
            missed[dt, t_ignite, method] = round(row["v computed [m/s]"], 2)
    assert missed == {cell: v for cell, v in NOT_REPRODUCED.items() if cell[0] == dt}


@pytest.mark.parametrize("dt", [0.02, 0.05, 0.1])
def test_printed_heights_were_read_off_plots_to_within_20_m(dt):
    table = published.optimisation_table(dt)
    assert len(table) == 14
    assert (table["h computed [m]"] - table["h printed [m]"]).abs().max() < 20
    assert (table["h difference [m]"] == table["h computed [m]"] - table["h printed [m]"]).all()
    assert ((table["h printed [m]"] == 0) == (table["h computed [m]"] == 0)).all()


def test_a_figure_that_the_paper_does_not_have_is_refused():
    with pytest.raises(ValueError, match=r"0.02, 0.05 and 0.1 s; got 0.03"):
        published.optimisation_table(0.03)


def test_what_the_tables_list_of_a_run_by_hand():
    def run(h, v):
        return Trajectory(np.arange(4.0), np.array(h), np.array(v))

    bouncing = run([9.0, 5.0, 3.0, 4.0], [-4.0, -3.0, 1.0, 0.5])
    assert published.listed(bouncing) == (3, 1)  # the largest velocity and the height there
    assert published.listed(bouncing, at_rest=True) == (3.5, 0)  # three quarters of the way from 5 to 3
    crashing = run([9.0, 5.0, 3.0, -1.0], [-4.0, -3.0, -2.0, -1.0])
    assert published.listed(crashing) == (0, -1)  # the overshoot is printed as 0
    assert published.listed(crashing, at_rest=True) == (0, -1)


# ---- the headline -----------------------------------------------------------------------------------------------


def test_a_velocity_of_exactly_zero_is_at_rest():
    t, h, v = np.array([0.0, 1.0, 2.0]), np.array([9.0, 7.0, 8.0]), np.array([-4.0, 0.0, 3.0])
    assert published.listed(Trajectory(t, h, v), at_rest=True) == (7.0, 0.0)


def test_a_table_is_in_the_order_of_its_times_and_methods():
    index = published.optimisation_table(0.1).index
    assert index.is_monotonic_increasing
    assert index.names == ["t_ignite [s]", "method"]


def test_the_landing_at_2_6_m_is_a_step_across_mass_zero():
    run = published.fly(**HEADLINE)
    i = int(np.searchsorted(run.t, 74.51))
    assert run.t[i : i + 2] == pytest.approx([74.52, 74.54], abs=1e-9)
    assert run.v[i : i + 2].round(1).tolist() == [-76.6, -1.6]
    assert run.mass[i : i + 2].round(1).tolist() == [12.8, -16.8]
    # at v = 0 there is no drag, so f shows the mass that it divides the thrust of 7 600 by
    f = published.acceleration(35.88)
    gravity = G * EARTH_MASS / EARTH_RADIUS**2
    stages = run.t[i] + 0.02 * np.array([0, 1 / 4, 3 / 8, 12 / 13, 1])
    masses = [-7600 / (f(t, 0.0, 0.0) + gravity) for t in stages]
    assert masses[0] == pytest.approx(12.8, abs=1e-6)
    assert masses[-1] == pytest.approx(-16.8, abs=1e-6)
    assert np.all(np.diff(masses) < 0)


def test_the_headlines_run_hovers_at_2_607_m_climbs_and_crashes():
    run = published.fly(**HEADLINE)
    (i,) = np.flatnonzero((run.v[:-1] < 0) & (run.v[1:] >= 0))
    assert run.t[i : i + 2] == pytest.approx([74.54, 74.56], abs=1e-9)
    assert np.interp(0, run.v[i : i + 2], run.h[i : i + 2]) == pytest.approx(2.607, abs=5e-4)
    assert run.h[i:].max() == pytest.approx(23.0, abs=0.05)
    assert run.t[-1] == pytest.approx(79.5, abs=1e-9)
    assert run.h[-2] > 0 > run.h[-1]
    assert run.v[-1] == pytest.approx(-20.0, abs=0.05)


@pytest.mark.parametrize(
    ("dt", "largest_velocity"),
    [(0.05, -61.1), (0.02, 12.5), (0.01, -76.5), (0.005, -66.8), (0.002, -53.8), (0.001, -56.9)],
)
def test_the_largest_velocity_does_not_converge(dt, largest_velocity):
    assert round(published.fly(35.88, dt=dt).v.max(), 1) == largest_velocity


def test_with_the_papers_own_equations_for_runge_kutta_the_headline_does_not_appear():
    assert round(published.fly(**HEADLINE, method="rk4").v.max(), 1) == -76.3


# ---- the faults -------------------------------------------------------------------------------------------------


def equation(t_ignite, faults):
    """f(t, h, v) with the given faults, as they are described: forces in N over a mass in kg."""

    def f(t, h, v):
        burnt = min(max(t - t_ignite, 0), math.inf if Fault.TANK_NEVER_EMPTY in faults else BURN_DURATION)
        mass = 57_200 - 1_480 * burnt
        thrust = 0.0
        if t > t_ignite and (t - t_ignite < BURN_DURATION or Fault.TANK_NEVER_EMPTY in faults):
            thrust = 7_600 if Fault.THRUST_IN_KILONEWTONS in faults else 7_600_000
        if Fault.THRUST_SUBTRACTED in faults:
            thrust = -thrust
        drag = 0.5 * 1.3 * math.exp(-h / 8_400) * 0.5 * AREA * v * v
        if v > 0 and Fault.DRAG_ALWAYS_UP not in faults:
            drag = -drag
        return (thrust + drag) / mass - G * EARTH_MASS / (EARTH_RADIUS + h) ** 2

    return f


@pytest.mark.parametrize("faults", COMBINATIONS, ids=names)
def test_each_combination_of_faults_makes_the_equation_that_it_describes(faults):
    found, wanted = published.acceleration(40.0, faults), equation(40.0, faults)
    # before and at ignition, burning, just before and after the tank is empty, after the coded mass is negative
    for t in (0.0, 40.0, 41.0, 60.2, 60.3, 70.0, 80.0):
        for h in (0.0, 20e3, 150e3):
            for v in (-2000.0, -1.0, 0.0, 1.0, 900.0):
                assert found(t, h, v) == pytest.approx(wanted(t, h, v), rel=1e-12)


@pytest.mark.parametrize("dt", [0.5, 0.1, 0.05])
@pytest.mark.parametrize("t_ignite", [35.88, 60.0])
@pytest.mark.parametrize("faults", COMBINATIONS, ids=names)
def test_every_combination_of_faults_ends(faults, t_ignite, dt):
    run = published.fly(t_ignite, dt=dt, faults=faults)
    assert np.all(np.isfinite([run.t, run.h, run.v]))
    assert np.all(run.h[:-1] > 0)
    assert run.h[-1] <= 0 or run.t[-1] >= TIME_CAP
    assert run.t[-1] < TIME_CAP + dt
    burnt = np.clip(run.t - t_ignite, 0, math.inf if Fault.TANK_NEVER_EMPTY in faults else BURN_DURATION)
    assert run.mass == pytest.approx(57_200 - 1_480 * burnt, rel=1e-9, abs=1e-6)


@pytest.mark.parametrize(
    ("t_ignite", "dt", "faults"),
    [  # grids on which the mass of one step is so near 0 that the next one overflows: v² raises, or f becomes infinite
        (30.0, 0.125, ALL_FAULTS),
        (33.0, 0.125, ALL_FAULTS),
        (30.0, 0.5, {Fault.THRUST_IN_KILONEWTONS, Fault.TANK_NEVER_EMPTY}),
    ],
)
def test_a_run_whose_numbers_overflow_ends_with_its_last_finite_state(t_ignite, dt, faults):
    run = published.fly(t_ignite, dt=dt, faults=faults)
    assert np.all(np.isfinite([run.t, run.h, run.v]))
    assert run.t[-1] < TIME_CAP
    assert run.h[-1] > 0


@pytest.mark.parametrize("also", [set(), {Fault.DRAG_ALWAYS_UP}], ids=names)
@pytest.mark.parametrize("dt", [0.5, 0.1, 0.02])
def test_mending_the_thrust_but_not_the_tank_never_comes_down(dt, also):
    run = published.fly(60.0, dt=dt, faults={Fault.TANK_NEVER_EMPTY} | also)
    assert run.t[-1] >= TIME_CAP
    assert run.h[-1] > 1e6
    assert run.v[-1] > 0  # still climbing


def right_flight(t_ignite, t):
    """States at times t of the right physics: each phase on its own, to 1e-12."""
    f = equation(t_ignite, faults=set())
    ends = [0, t_ignite, t_ignite + BURN_DURATION, max(t)]
    state, found = [150e3, -2000.0], {}
    for start, end in zip(ends[:-1], ends[1:], strict=True):
        phase = solve_ivp(
            lambda t, y, a=start, b=end: [y[1], f(min(max(t, math.nextafter(a, b)), math.nextafter(b, a)), *y)],
            (start, end),
            state,
            method="DOP853",
            rtol=1e-12,
            atol=1e-8,
            dense_output=True,
        )
        state = phase.y[:, -1]
        found |= {time: phase.sol(time) for time in t if start <= time <= end}
    return found


@pytest.mark.parametrize("method", ["rkn4", "rk4"])
def test_without_faults_runs_converge_to_the_right_flight(method):
    # first order only: the grid straddles ignition. A second of ignition is 1 km of height at 70 s, 80 m/s of speed
    flight = right_flight(60.003, [70.0, 90.0])
    for dt in (0.1, 0.02, 0.005):
        run = published.fly(60.003, dt=dt, method=method, faults=())
        for t, (h, v), h_rate, v_rate in ((70.0, flight[70.0], 300, 15), (90.0, flight[90.0], 1500, 100)):
            i = int(np.argmin(abs(run.t - t)))
            assert run.t[i] == pytest.approx(t, abs=1e-8)
            assert run.h[i] == pytest.approx(h, abs=h_rate * dt)
            assert run.v[i] == pytest.approx(v, abs=v_rate * dt)


@pytest.mark.parametrize(
    ("given", "error", "message"),
    [
        ({"faults": ["THRUST_SUBTRACTED"]}, ValueError, r"faults must be members of Fault.*THRUST_SUBTRACTED"),
        ({"faults": "all"}, ValueError, r"faults must be members of Fault"),
        ({"faults": {Fault.THRUST_SUBTRACTED, 3}}, ValueError, r"faults must be members of Fault.*got \{3\}"),
        ({"faults": None}, (TypeError, ValueError), r"faults must be .*None"),
        ({"faults": Fault.THRUST_SUBTRACTED}, (TypeError, ValueError), r"faults must be .*THRUST_SUBTRACTED"),
        ({"dt": 0}, ValueError, r"dt must be .*greater than 0 \[s\]; got 0"),
        ({"dt": -0.02}, ValueError, r"dt must be .*greater than 0 \[s\]; got -0.02"),
        ({"dt": math.nan}, ValueError, r"dt must be .*\[s\]; got nan"),
        ({"dt": "0.02"}, TypeError, r"dt must be .*\[s\]; got '0.02'"),
        ({"dt": 1e-6}, ValueError, r"dt = 1e-06 s .*600,000,000 steps"),
        ({"t_ignite": -1.0}, ValueError, r"t_ignite must be .*at least 0 \[s\]; got -1.0"),
        ({"t_ignite": math.inf}, ValueError, r"t_ignite must be .*\[s\]; got inf"),
        ({"t_ignite": [35.88]}, TypeError, r"t_ignite must be .*\[s\]; got \[35.88\]"),
        ({"method": "rk5"}, ValueError, r"no method 'rk5'; choose from .*rkn4"),
    ],
)
def test_bad_input_is_refused(given, error, message):
    with pytest.raises(error, match=message):
        published.fly(**{**HEADLINE, **given})


# ---- Listings 2 and 3 -------------------------------------------------------------------------------------------

PRINTED_MAPE = {
    "rk4": 7.183196393916714e-09,
    "symplectic_euler": 2.2736460451955488e-06,
    "explicit_euler": 0.005631552584641939,
    "implicit_euler": 0.0034736158245725255,
}


@pytest.mark.parametrize("method", PRINTED_MAPE)
def test_listing_3_comes_out_of_listing_2s_loops_to_every_digit(method):
    x, _ = published.oscillator_runs()[method]
    exact = 3 * np.cos(published.oscillator_time())
    assert x.shape == exact.shape == (157,)
    assert published.listing_2_mape(exact, x) == PRINTED_MAPE[method]


@pytest.mark.parametrize("method", PRINTED_MAPE)
def test_listing_3_comes_out_of_the_librarys_methods_to_eight_digits(method):
    run = integrate(lambda t, x, v: -x, 3.0, 0.0, dt=5 * math.pi / 156, t_end=5 * math.pi, method=method)
    assert len(run.t) == 157
    x = run.v if method == "explicit_euler" else run.h  # Listing 2's explicit Euler hands back (v, x)
    exact = 3 * math.cos(5 * math.pi)
    assert (exact - x[-1]) / exact / 157 == pytest.approx(PRINTED_MAPE[method], rel=1e-11)


def test_listing_2s_explicit_euler_compares_velocity_with_position():
    x, v = published.oscillator_runs()["explicit_euler"]
    assert (x[0], v[0]) == (0, 3)
    exact = 3 * np.cos(published.oscillator_time())
    assert published.listing_2_mape(exact, v) == pytest.approx(-7.60e-3, abs=5e-6)


def test_listing_2s_implicit_euler_has_its_velocity_mirrored():
    x, v = published.oscillator_runs()["implicit_euler"]
    right = integrate(lambda t, x, v: -x, 3.0, 0.0, dt=5 * math.pi / 156, t_end=5 * math.pi, method="implicit_euler")
    np.testing.assert_allclose(x, right.h, rtol=0, atol=1e-13)
    np.testing.assert_allclose(v, -right.v, rtol=0, atol=1e-13)


def test_listing_2s_mape_is_of_the_last_sample_alone_by_hand():
    assert published.listing_2_mape(np.array([9.0, 9.0, -4.0]), np.array([0.0, 0.0, -3.0])) == 1 / 12
    assert published.listing_2_mape(np.array([2.0]), np.array([5.0])) == -1.5
