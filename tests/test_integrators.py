"""The one-step methods: orders measured, coefficients read off and compared, implicit equations solved elsewhere."""

import math
from functools import cache

import numpy as np
import pytest
from scipy.integrate import solve_ivp
from scipy.integrate._ivp import dop853_coefficients as dop853

from hoverslam_lib import METHODS, _dop853, integrate, observed_order
from hoverslam_lib.integrators import dop8_and_error, step_function

KEYS = ["explicit_euler", "symplectic_euler", "implicit_euler", "rk4", "rkn4", "gauss4", "dop8"]
IMPLICIT = ["implicit_euler", "gauss4"]


def test_the_table_has_exactly_the_methods_of_the_design():
    assert list(METHODS) == KEYS
    assert [key for key in METHODS if METHODS[key].implicit] == IMPLICIT
    assert [METHODS[key].order for key in KEYS] == [1, 1, 1, 4, 4, 4, 8]


@pytest.mark.parametrize("method", ["rk5", "RK4", "", None, 4, ["rk4"]])
def test_an_unknown_method_is_refused_with_the_list_of_those_there_are(method):
    with pytest.raises(ValueError, match="there is no method") as caught:
        step_function(method)
    assert repr(method) in str(caught.value)
    assert all(key in str(caught.value) for key in KEYS)


# ---- order ------------------------------------------------------------------------------------------------------

# small enough for the asymptotic regime, large enough to stay clear of rounding
SCALAR_DT = {1: (1 / 512, 1 / 1024), 4: (1 / 64, 1 / 128), 8: (1 / 6, 1 / 12)}
PLANAR_DT = {1: (1 / 512, 1 / 1024), 4: (1 / 64, 1 / 128), 8: (1 / 12, 1 / 24)}


def assert_order(method, errors_at, dts):
    """errors_at(dt) → the errors of h and v in the max-norm over the run."""
    claim = METHODS[method].order
    for errors in zip(*map(errors_at, dts), strict=True):
        assert observed_order(dts, errors) == pytest.approx(claim, abs=0.5 if method == "dop8" else 0.1)


def logarithm(c):
    """ḧ = c/(1 + ct²) + c·exp(-h) - ḣ², whose solution is h = log(1 + ct²): f depends on t, h and v."""
    exp, log = (np.exp, np.log) if isinstance(c, np.ndarray) else (math.exp, math.log)

    def f(t, h, v):
        return c / (1 + c * t * t) + c * exp(-h) - v * v

    def exact(t):
        return log(1 + c * t * t), 2 * c * t / (1 + c * t * t)

    return f, exact


@pytest.mark.parametrize("c", [1.3, np.array([[0.6, 1.0], [1.3, 1.7]])], ids=["floats", "independent lanes"])
@pytest.mark.parametrize("method", KEYS)
def test_observed_order_equals_the_claim(method, c):
    f, exact = logarithm(c)

    def errors(dt):
        run = integrate(f, *exact(-1.0), dt=dt, t0=-1.0, t_end=3.0, method=method)
        h, v = (np.array(column) for column in zip(*map(exact, run.t), strict=True))
        return np.max(np.abs(run.h - h)), np.max(np.abs(run.v - v))

    assert_order(method, errors, SCALAR_DT[METHODS[method].order])


def orbit(t, h, v):
    """A planar orbit around a mass that pulsates, with drag: the components are coupled in h and in v."""
    return -(1 + 0.3 * math.sin(t)) * h / math.hypot(*h) ** 3 - 0.1 * math.hypot(*v) * v


@cache
def orbit_reference(steps):
    solution = solve_ivp(
        lambda t, y: np.concatenate([y[2:], orbit(t, y[:2], y[2:])]),
        (0, 3),
        [1.0, 0.0, 0.0, 1.1],
        method="DOP853",
        rtol=3e-14,
        atol=1e-15,
        t_eval=np.linspace(0, 3, steps + 1),
    )
    return solution.y[:2].T, solution.y[2:].T


@pytest.mark.parametrize("method", KEYS)
def test_observed_order_equals_the_claim_for_a_coupled_system(method):
    def errors(dt):
        run = integrate(orbit, [1.0, 0.0], [0.0, 1.1], dt=dt, t_end=3.0, method=method)
        h, v = orbit_reference(round(3 / dt))
        return np.max(np.abs(run.h - h)), np.max(np.abs(run.v - v))

    assert_order(method, errors, PLANAR_DT[METHODS[method].order])


def test_listing_4s_method_is_locally_one_order_better_in_height():
    f, exact = logarithm(1.3)
    dts = np.array([1 / 16, 1 / 32])
    h, v = np.array([METHODS["rkn4"].step(f, 0.3, *exact(0.3), dt) for dt in dts]).T
    h_exact, v_exact = np.array([exact(0.3 + dt) for dt in dts]).T
    assert observed_order(dts, abs(h - h_exact)) == pytest.approx(6, abs=0.2)
    assert observed_order(dts, abs(v - v_exact)) == pytest.approx(5, abs=0.2)


# ---- types and purity -------------------------------------------------------------------------------------------


@pytest.mark.parametrize("method", KEYS)
def test_floats_stay_python_floats(method):
    h, v = METHODS[method].step(logarithm(1.3)[0], 0.5, 0.3, 1.0, 0.1)
    assert type(h) is float
    assert type(v) is float


@pytest.mark.parametrize("shape", [(3,), (2, 3)])
@pytest.mark.parametrize("method", KEYS)
def test_arrays_keep_their_shape_and_are_not_written_to(method, shape):
    h, v = np.full(shape, 0.3), np.linspace(-1, 1, math.prod(shape)).reshape(shape)
    h_before, v_before = h.copy(), v.copy()
    h_new, v_new = METHODS[method].step(logarithm(np.array(1.3))[0], 0.5, h, v, 0.1)
    assert h_new.shape == v_new.shape == shape
    assert np.array_equal(h, h_before)
    assert np.array_equal(v, v_before)


# ---- the steps themselves ---------------------------------------------------------------------------------------


def test_euler_steps_by_hand():
    def f(t, h, v):
        return t + 10 * h + 100 * v

    # t = 1, h = 2, v = 3: f = 321; v_new = 3 + 0.5·321 = 163.5
    assert METHODS["explicit_euler"].step(f, 1.0, 2.0, 3.0, 0.5) == (3.5, 163.5)
    assert METHODS["symplectic_euler"].step(f, 1.0, 2.0, 3.0, 0.5) == (83.75, 163.5)


def tableau(step, stages):
    """Read a method's coefficients off: with h = v = 0 and dt = 1 a step is linear in the stages' accelerations.

    Returns nodes, matrix for heights, matrix for velocities, weights for the height, weights for the velocity.
    """
    nodes, g, a = np.zeros(stages), np.zeros((stages, stages)), np.zeros((stages, stages))
    weights = np.zeros((2, stages))
    for j in range(stages):
        calls = []

        def f(t, h, v, j=j, calls=calls):
            calls.append((t, h, v))
            return 1.0 if len(calls) == j + 1 else 0.0

        weights[:, j] = step(f, 0.0, 0.0, 0.0, 1.0)
        nodes, g[:, j], a[:, j] = np.array(calls).T
    return nodes, g, a, *weights


CLASSICAL = (
    np.array([0, 1 / 2, 1 / 2, 1]),
    np.array([[0, 0, 0, 0], [1 / 2, 0, 0, 0], [0, 1 / 2, 0, 0], [0, 0, 1, 0]]),
    np.array([1, 2, 2, 1]) / 6,
)
SCIPY_DOP853 = (dop853.C[:12], dop853.A[:12, :12], dop853.B)


@pytest.mark.parametrize(("method", "reference"), [("rk4", CLASSICAL), ("dop8", SCIPY_DOP853)])
def test_coefficients_are_those_of_the_first_order_method(method, reference):
    c, a, b = reference
    expected = c, a @ a, a, b @ a, b  # a Runge-Kutta method on (h, v)' = (v, f), written for h'' = f
    for found, wanted in zip(tableau(METHODS[method].step, len(c)), expected, strict=True):
        np.testing.assert_allclose(found, wanted, rtol=0, atol=1e-13)


def first_order_step(reference, f, t, h, v, dt):
    """One step of an explicit Runge-Kutta method on the system (h, v)' = (v, f)."""
    c, a, b = reference
    k = np.zeros((len(c), 2))
    for i in range(len(c)):
        h_stage, v_stage = (h, v) + dt * a[i] @ k
        k[i] = v_stage, f(t + c[i] * dt, h_stage, v_stage)
    return (h, v) + dt * b @ k


@pytest.mark.parametrize(("method", "reference"), [("rk4", CLASSICAL), ("dop8", SCIPY_DOP853)])
def test_a_step_is_that_of_the_first_order_method(method, reference):
    f, _ = logarithm(1.3)
    expected = first_order_step(reference, f, 0.4, 0.3, -1.0, 0.7)
    assert METHODS[method].step(f, 0.4, 0.3, -1.0, 0.7) == pytest.approx(expected, rel=2e-15)


# as the paper's Listing 4 prints them: a, g, b (its matrix for velocities), c and cd (its weights)
LISTING_4 = (
    np.array([0, 0.25, 0.375, 12 / 13, 1.0]),
    np.array(
        [
            [0, 0, 0, 0, 0],
            [1 / 32, 0, 0, 0, 0],
            [9 / 256, 9 / 256, 0, 0, 0],
            [27342 / 142805, -49266 / 142805, 82764 / 142805, 0, 0],
            [5 / 18, -2 / 3, 8 / 9, 0, 0],
        ]
    ),
    np.array(
        [
            [0, 0, 0, 0, 0],
            [0.25, 0, 0, 0, 0],
            [3 / 32, 9 / 32, 0, 0, 0],
            [1932 / 2197, -7200 / 2197, 7296 / 2197, 0, 0],
            [439 / 216, -8.0, 3680 / 513, -845 / 4104, 0],
        ]
    ),
    np.array([253 / 2160, 0, 4352 / 12825, 2197 / 41040, -0.01]),
    np.array([25 / 216, 0, 1408 / 2565, 2197 / 4104, -0.2]),
)


def test_rkn4_has_the_coefficients_of_listing_4_to_the_last_bit():
    for found, printed in zip(tableau(METHODS["rkn4"].step, 5), LISTING_4, strict=True):
        np.testing.assert_array_equal(found, printed)


def test_rkn4_meets_order_4_in_velocity_and_the_order_5_conditions_in_height():
    c, g, a, height, velocity = tableau(METHODS["rkn4"].step, 5)
    # each elementary weight with its integral over τ in (0, 1): of τ-powers for v, times (1 - τ) for h
    conditions = [
        (c**0, 1, 1 / 2),
        (c, 1 / 2, 1 / 6),
        (c**2, 1 / 3, 1 / 12),
        (a @ c, 1 / 6, 1 / 24),
        (c**3, 1 / 4, 1 / 20),
        (c * (a @ c), 1 / 8, 1 / 40),
        (a @ c**2, 1 / 12, 1 / 60),
        (a @ a @ c, 1 / 24, 1 / 120),
        (g @ c, 1 / 24, 1 / 120),
    ]
    np.testing.assert_allclose(a.sum(axis=1), c, atol=1e-15)
    np.testing.assert_allclose(g.sum(axis=1), c**2 / 2, atol=1e-15)
    for stages, for_v, for_h in conditions:
        assert velocity @ stages == pytest.approx(for_v, abs=1e-15)
        assert height @ stages == pytest.approx(for_h, abs=1e-15)
    assert abs(velocity @ c**4 - 1 / 5) > 1e-4  # no more than order 4


# ---- implicit methods -------------------------------------------------------------------------------------------

ROOT3 = math.sqrt(3)
IMPLICIT_TABLEAU = {
    "implicit_euler": (np.array([[1.0]]), np.array([1.0]), np.array([1.0])),
    "gauss4": (
        np.array([[1 / 4, 1 / 4 - ROOT3 / 6], [1 / 4 + ROOT3 / 6, 1 / 4]]),
        np.array([1 / 2, 1 / 2]),
        np.array([1 / 2 - ROOT3 / 6, 1 / 2 + ROOT3 / 6]),
    ),
}
# f, and how fast it pulls v or h towards the smooth solution [1/s]
EQUATIONS = {
    "smooth": (lambda t, h, v: math.cos(t) - h**3 - v * abs(v), 1),
    "stiff": (lambda t, h, v: -1e4 * (v - math.cos(t)), 1e4),
    "stiff cubic": (lambda t, h, v: -1e4 * (v**3 - math.cos(t)), 1e4),
    "stiff spring": (lambda t, h, v: -1e6 * (h - math.sin(t)) - 10 * v, 1e5),
}


@pytest.mark.parametrize("equation", EQUATIONS)
@pytest.mark.parametrize("method", IMPLICIT)
def test_an_implicit_step_solves_its_equations(method, equation):
    a, b, c = IMPLICIT_TABLEAU[method]
    f, rate = EQUATIONS[equation]
    t, h, v, dt = 0.2, 0.1, 0.3, 0.1

    def residual(h_new, v_new):
        """Stage accelerations K that give this step, and how far they are from f at their own stages [m/s]."""
        gained = np.array([v_new - v, h_new - h - dt * v])
        weights = np.array([dt * b, dt * dt * b @ a])
        k = np.linalg.lstsq(weights, gained)[0]
        np.testing.assert_allclose(weights @ k, gained, rtol=1e-13)
        stages = zip(t + c * dt, h + c * dt * v + dt * dt * a @ a @ k, v + dt * a @ k, strict=True)
        return max(abs(k - [f(*stage) for stage in stages])) / (1 / dt + rate)

    step = METHODS[method].step
    assert residual(*step(f, t, h, v, dt)) < 2e-14
    lanes = step(np.vectorize(f), t, np.array([h, 5.0]), np.array([v, -1.0]), dt)
    assert residual(*np.transpose(lanes)[0]) < 2e-14


@pytest.mark.parametrize(("method", "error"), [("implicit_euler", 2e-4), ("gauss4", 0.02)])
def test_an_implicit_method_follows_a_stiff_equation_at_large_steps(method, error):
    # the solution is v = cos t + O(1e-4); dt is 2 000 times the limit of explicit Euler
    run = integrate(lambda t, h, v: -1e4 * (v - math.cos(t)), 0.0, 1.0, dt=0.4, t_end=8.0, method=method)
    assert np.max(np.abs(run.v - np.cos(run.t))) < error


@pytest.mark.parametrize("dt", [0.01, 0.1])
@pytest.mark.parametrize("method", IMPLICIT)
def test_an_implicit_method_follows_a_mass_on_a_spring_until_it_hangs_still(method, dt):
    # at rest at h = v = 0 large terms cancel, and the correction never falls below their rounding
    run = integrate(lambda t, h, v: 9.81 - 981 * (0.01 + h) - 20 * v, 1e-3, 0.0, dt=dt, t_end=30.0, method=method)
    assert max(abs(run.h[-1]), abs(run.v[-1])) < 1e-12


def exponential(t, h, v):
    """With dt = 10 s from v = 1 m/s neither method's equations have a solution."""
    return np.exp(v) if isinstance(v, np.ndarray) else math.exp(v)


@pytest.mark.parametrize("v", [1.0, np.array([1.0, -30.0])], ids=["float", "array"])
@pytest.mark.parametrize("method", IMPLICIT)
def test_newtons_method_says_when_it_cannot_converge(method, v):
    with pytest.raises(ArithmeticError, match=rf"{method}.*did not converge.*t = 2 s.*dt = 10 s.*smaller dt"):
        METHODS[method].step(exponential, 2.0, 0.0 * v, v, 10.0)


@pytest.mark.parametrize("v", [1.0, np.array([1.0, 2.0])], ids=["float", "array"])
def test_newtons_method_says_so_where_its_slope_is_zero(v):
    # v_new - v - dt·(v_new + 1) does not depend on v_new when dt = 1 s
    with pytest.raises(ArithmeticError, match=r"implicit_euler.*did not converge.*t = 0 s.*dt = 1 s.*smaller dt"):
        METHODS["implicit_euler"].step(lambda t, h, v: v + 1, 0.0, 0.0 * v, v, 1.0)


def test_the_estimate_of_the_error_is_that_of_dop853():
    def row(pairs):
        return np.array([dict(pairs).get(j, 0.0) for j in range(12)])

    assert row(_dop853.E5) == pytest.approx(dop853.E5[:12], rel=1e-15, abs=0)
    assert row(_dop853.B) - row(_dop853.B3) == pytest.approx(dop853.E3[:12], rel=1e-14, abs=1e-16)
    # it shrinks with the step to the eighth or faster
    _, _, *estimates = zip(*(dop8_and_error(lambda t, h, v: -h, 0.0, 3.0, 0.0, dt) for dt in (1.0, 0.5)), strict=True)
    assert min(np.log2(large / small) for large, small in estimates) > 7.3
