"""A run of a method: its grid, its shapes, its table, and what it refuses."""

import math
import re
from itertools import islice

import numpy as np
import pytest

from hoverslam_lib import METHODS, integrate
from hoverslam_lib.trajectory import time_grid


def falling(t, h, v):
    return -9.81


def must_not_be_called(t, h, v):
    raise AssertionError("bad input must be refused before the run begins")


@pytest.mark.parametrize(
    ("dt", "t0", "t_end", "steps"),
    [
        (0.1, 0.0, 2.3, 23),  # int(2.3 / 0.1) is 22
        (0.1, 0.0, 0.3, 3),  # 0.3 / 0.1 is just below 3
        (0.1, 0.0, 0.1 + 0.2, 3),  # just above 3
        (5 * math.pi / 156, 0.0, 5 * math.pi, 156),  # 157 samples
        (0.3, 0.0, 1.0, 4),  # the last one shortened
        (0.3, -2.0, -1.0, 4),
        (0.02, 35.88, 36.88, 50),
        (5.0, 0.0, 1.0, 1),
        (0.1, 2.0, 2.0, 0),
    ],
)
def test_the_grid_has_the_right_number_of_steps_and_ends_exactly_on_t_end(dt, t0, t_end, steps):
    run = integrate(falling, 100.0, 0.0, dt=dt, t0=t0, t_end=t_end)
    assert run.t.shape == run.h.shape == run.v.shape == (steps + 1,)
    assert run.t[0] == t0
    assert run.t[-1] == t_end
    np.testing.assert_array_equal(run.t[1:-1], [t0 + i * dt for i in range(1, steps)])


def test_the_last_step_is_shortened_in_the_state_too():
    # Runge-Kutta 4 is exact for a parabola, so only a wrong length of step can be seen
    run = integrate(falling, 100.0, 3.0, dt=0.3, t0=5.0, t_end=6.0)
    s = np.array([0, 0.3, 0.6, 0.9, 1.0])
    np.testing.assert_allclose(run.v, 3 - 9.81 * s, rtol=0, atol=1e-14)
    np.testing.assert_allclose(run.h, 100 + 3 * s - 9.81 / 2 * s**2, rtol=0, atol=5e-14)


def test_f_is_given_the_time_that_the_grid_shows():
    # v' = 3t², exact for Runge-Kutta 4
    run = integrate(lambda t, h, v: 3 * t * t, 0.0, 1.0, dt=0.25, t0=1.0, t_end=2.1)
    np.testing.assert_allclose(run.v, run.t**3, rtol=1e-14)


def test_the_method_may_be_a_name_or_a_step_function_of_ones_own():
    def midpoint(f, t, h, v, dt):
        v_middle = v + dt / 2 * f(t, h, v)
        return h + dt * v_middle, v + dt * f(t + dt / 2, h + dt / 2 * v, v_middle)

    run = integrate(falling, 100.0, 0.0, dt=0.5, t_end=1.0, method=midpoint)
    np.testing.assert_allclose(run.h, [100, 100 - 9.81 / 8, 100 - 9.81 / 2], rtol=1e-15)
    euler = integrate(falling, 100.0, 0.0, dt=0.5, t_end=1.0, method="explicit_euler")
    np.testing.assert_allclose(euler.h, [100, 100, 100 - 9.81 / 4], rtol=1e-15)


@pytest.mark.parametrize(
    ("h0", "v0", "shape"),
    [
        (1, 2, ()),
        ([1, 2, 3], [0, 0, 0], (3,)),
        ([1.0, 2.0, 3.0], 0.5, (3,)),
        (1.0, np.ones((2, 2)), (2, 2)),
        ([[1.0], [2.0]], [0.0, 1.0, 2.0], (2, 3)),
    ],
)
@pytest.mark.parametrize("method", METHODS)
def test_shapes_are_those_of_the_initial_values(method, h0, v0, shape):
    run = integrate(lambda t, h, v: -h, h0, v0, dt=0.1, t_end=0.5, method=method)
    assert run.t.shape == (6,)
    assert run.h.shape == run.v.shape == (6, *shape)
    assert run.h.dtype == run.v.dtype == float
    np.testing.assert_array_equal(run.h[0], np.broadcast_to(h0, shape))
    np.testing.assert_array_equal(run.v[0], np.broadcast_to(v0, shape))


def test_initial_arrays_are_neither_written_to_nor_kept():
    h0, v0 = np.ones(2), np.zeros(2)
    run = integrate(lambda t, h, v: -h, h0, v0, dt=0.1, t_end=0.2)
    np.testing.assert_array_equal(h0, 1)
    np.testing.assert_array_equal(v0, 0)
    h0[0] = 7
    assert run.h[0, 0] == 1


def test_a_frame_has_units_in_its_headers():
    frame = integrate(falling, 100.0, 0.0, dt=0.5, t_end=1.0).to_frame()
    assert list(frame.columns) == ["t [s]", "h [m]", "v [m/s]"]
    assert frame["v [m/s]"].tolist() == pytest.approx([0, -4.905, -9.81], rel=1e-14)
    assert frame["t [s]"].tolist() == [0, 0.5, 1]


def test_a_frame_of_arrays_has_a_column_for_each_component():
    frame = integrate(lambda t, h, v: 0 * h, [[1.0, 2.0]], [[3.0, 4.0]], dt=1.0, t_end=1.0).to_frame()
    assert list(frame.columns) == ["t [s]", "h0 [m]", "h1 [m]", "v0 [m/s]", "v1 [m/s]"]
    assert frame.iloc[1].tolist() == [1, 4, 6, 3, 4]


GOOD = {"h0": 100.0, "v0": 0.0, "dt": 0.1, "t_end": 1.0}


@pytest.mark.parametrize(
    ("name", "value", "error", "message"),
    [
        ("dt", math.nan, ValueError, r"greater than 0 \[s\]; got nan"),
        ("dt", math.inf, ValueError, r"finite.*\[s\]; got inf"),
        ("dt", 0, ValueError, r"greater than 0 \[s\]; got 0"),
        ("dt", -0.1, ValueError, r"greater than 0 \[s\]; got -0.1"),
        ("dt", "0.1", TypeError, r"number.*\[s\]; got '0.1' \(str\)"),
        ("dt", None, TypeError, r"number.*\[s\]; got None"),
        ("dt", True, TypeError, r"number.*\[s\]; got True"),
        ("dt", np.array(0.1), TypeError, r"number.*\[s\]; got array\(0.1\)"),
        ("dt", [0.1, 0.2], TypeError, r"number.*\[s\]; got \[0.1, 0.2\]"),
        ("t_end", -1.0, ValueError, r"at least 0 \[s\]; got -1.0"),
        ("t_end", math.nan, ValueError, r"finite.*\[s\]; got nan"),
        ("t_end", math.inf, ValueError, r"finite.*\[s\]; got inf"),
        ("t_end", "1", TypeError, r"number.*\[s\]; got '1'"),
        ("t0", math.nan, ValueError, r"finite.*\[s\]; got nan"),
        ("t0", -math.inf, ValueError, r"finite.*\[s\]; got -inf"),
        ("t0", np.zeros(2), TypeError, r"number.*\[s\]; got array"),
        ("h0", math.nan, ValueError, r"finite.*\[m\]; got nan"),
        ("h0", [1.0, math.inf], ValueError, r"finite.*\[m\]; got \[1.0, inf\]"),
        ("h0", "5", TypeError, r"number.*\[m\]; got '5'"),
        ("h0", ["a"], TypeError, r"number.*\[m\]; got \['a'\]"),
        ("h0", None, (TypeError, ValueError), r"\[m\]; got None"),
        ("h0", True, TypeError, r"number.*\[m\]; got True"),
        ("h0", 1j, TypeError, r"number.*\[m\]; got 1j"),
        ("h0", [[1.0], [1.0, 2.0]], TypeError, r"number.*\[m\]; got \[\[1.0\], \[1.0, 2.0\]\]"),
        ("v0", math.inf, ValueError, r"finite.*\[m/s\]; got inf"),
        ("v0", [math.nan], ValueError, r"finite.*\[m/s\]; got \[nan\]"),
        ("v0", "fast", TypeError, r"number.*\[m/s\]; got 'fast'"),
    ],
)
def test_bad_input_is_refused_with_name_value_unit_and_what_is_allowed(name, value, error, message):
    with pytest.raises(error, match=rf"^{name} must be .*{message}"):
        integrate(must_not_be_called, **{**GOOD, name: value})


def test_an_end_before_the_start_is_refused():
    with pytest.raises(ValueError, match=r"^t_end must be .*at least 2 \[s\]; got 1.5"):
        integrate(must_not_be_called, 0.0, 0.0, dt=0.1, t0=2.0, t_end=1.5)


def test_shapes_that_do_not_go_together_are_refused_by_name():
    with pytest.raises(ValueError, match=r"h0.*v0.*\(2,\).*\(3,\)"):
        integrate(must_not_be_called, np.zeros(2), np.zeros(3), dt=0.1, t_end=1.0)


def test_an_unknown_method_is_refused_with_the_list_of_those_there_are():
    with pytest.raises(ValueError, match="there is no method 'euler'") as caught:
        integrate(must_not_be_called, 0.0, 0.0, dt=0.1, t_end=1.0, method="euler")
    assert all(key in str(caught.value) for key in METHODS)


def test_too_many_steps_are_refused_at_once_and_counted():
    with pytest.raises(ValueError, match=r"dt = 1e-12 s .*2,500,000,000,000 steps.*at most 10,000,000"):
        integrate(must_not_be_called, 0.0, 0.0, dt=1e-12, t_end=2.5)


@pytest.mark.parametrize("dt", [1e-9, 1e-310])
@pytest.mark.parametrize("t_end", [1.0, 1.44, 9.4])
def test_the_dt_that_is_advised_instead_is_one_that_is_allowed(dt, t_end):
    with pytest.raises(ValueError, match="use a dt of at least") as caught:
        integrate(must_not_be_called, 0.0, 0.0, dt=dt, t_end=t_end)
    advised = float(re.search(r"at least (\S+) s$", str(caught.value)).group(1))
    assert 5_000_000 <= t_end / advised <= 10_000_000


@pytest.mark.parametrize("method", METHODS)
@pytest.mark.parametrize(("t0", "dt", "steps"), [(1000.0, 1e-5, 3), (1e6, 1e-7, 5), (1e9, 1e-5, 7), (-1000.0, 1e-5, 3)])
def test_no_step_is_without_length_where_time_is_late(t0, dt, steps, method):
    # the last digit of t0 is more than a billionth of a step
    run = integrate(lambda t, h, v: -h, 1.0, 0.0, dt=dt, t0=t0, t_end=t0 + steps * dt, method=method)
    assert np.all(np.diff(run.t) > 0)
    assert len(run.t) == steps + 1
    assert run.t[-1] == t0 + steps * dt


@pytest.mark.parametrize("method", METHODS)
def test_a_step_that_is_lost_in_the_last_digit_of_time_is_left_out(method):
    run = integrate(lambda t, h, v: -h, 1.0, 0.0, dt=1e-14, t0=1000.0, t_end=1000.0 + 1e-12, method=method)
    assert np.all(np.diff(run.t) > 0)
    assert run.t[-1] == 1000.0 + 1e-12


@pytest.mark.parametrize(("t0", "t_end"), [(0.0, 0.7), (60.0, 61.3), (-2.0, 0.0), (1e8, 1e8 + 1.0), (3.0, math.inf)])
def test_a_grid_is_strictly_increasing_and_ends_on_its_end(t0, t_end):
    grid = list(islice(time_grid(t0, t_end, 0.1), 20))
    assert np.all(np.diff([t0, *grid]) > 0)
    assert len(grid) == (20 if t_end == math.inf else math.ceil((t_end - t0) / 0.1 - 1e-6))
    assert t_end == math.inf or grid[-1] == t_end


def test_there_is_no_grid_where_there_is_no_time():
    assert list(time_grid(5.0, 5.0, 0.1)) == list(time_grid(5.0, 4.0, 0.1)) == []
