"""The error measures, against values worked out by hand."""

import pytest

from hoverslam_lib import mape, max_error, nmae, observed_order, rmse

EXACT, APPROX = [4.0, -2.0, 1.0], [3.0, -1.0, 3.0]  # absolute errors 1, 1, 2


@pytest.mark.parametrize(
    ("metric", "by_hand"),
    [
        (mape, (1 / 4 + 1 / 2 + 2 / 1) / 3),
        (nmae, (1 + 1 + 2) / 3 / 4),
        (rmse, ((1 + 1 + 4) / 3) ** 0.5),
        (max_error, 2.0),
    ],
)
def test_metric_equals_the_value_worked_out_by_hand(metric, by_hand):
    result = metric(EXACT, APPROX)
    assert result == pytest.approx(by_hand, rel=1e-15)
    assert type(result) is float
    assert metric(EXACT, EXACT) == 0


def test_largest_amplitude_may_be_negative():
    assert nmae([-8.0, 2.0], [-8.0, 4.0]) == pytest.approx(1 / 8, rel=1e-15)


@pytest.mark.parametrize("metric", [nmae, rmse, max_error])
def test_measures_with_a_unit_or_an_amplitude_admit_zero_crossings(metric):
    assert metric([0.0, 2.0], [1.0, 2.0]) > 0


def test_mape_refuses_exact_zeros_and_names_the_sample():
    with pytest.raises(ValueError, match=r"mape.*sample 1.*nmae"):
        mape([1.0, 0.0, 2.0], [1.0, 1.0, 2.0])


def test_nmae_refuses_an_exact_solution_that_is_zero_throughout():
    with pytest.raises(ValueError, match=r"nmae.*max_error"):
        nmae([0.0, 0.0], [1.0, 1.0])


@pytest.mark.parametrize("metric", [mape, nmae, rmse, max_error, observed_order])
@pytest.mark.parametrize(
    ("a", "b", "message"),
    [
        ([1.0, 2.0], [1.0], r"same shape; got \(2,\) and \(1,\)"),
        ([[1.0, 2.0]], [1.0, 2.0], r"same shape; got \(1, 2\) and \(2,\)"),
        ([], [], "no samples"),
    ],
)
def test_samples_must_match(metric, a, b, message):
    with pytest.raises(ValueError, match=message):
        metric(a, b)


@pytest.mark.parametrize(("dt", "error"), [([0.1, 0.05], [8.0, 1.0]), ([0.4, 0.2, 0.1], [128.0, 16.0, 2.0])])
def test_observed_order_is_the_slope_of_a_power_law(dt, error):
    assert observed_order(dt, error) == pytest.approx(3, rel=1e-14)


def test_observed_order_of_three_values_is_the_least_squares_slope():
    # log2: x = 2, 1, 0 and y = 3, 1, 1, so the slope is (1·3 - 1·1) / (1 + 1)
    assert observed_order([4.0, 2.0, 1.0], [8.0, 2.0, 2.0]) == pytest.approx(1, rel=1e-14)


@pytest.mark.parametrize(
    ("dt", "error", "message"),
    [
        ([0.1], [1.0], "two different values"),
        ([0.1, 0.1], [1.0, 2.0], "two different values"),
        ([[0.1, 0.2]], [[1.0, 2.0]], "two different values"),
        ([0.1, 0.2], [0.0, 1.0], "greater than 0"),
        ([-0.1, 0.2], [1.0, 1.0], "greater than 0"),
        ([0.1, 0.2], [float("nan"), 1.0], "greater than 0"),
    ],
)
def test_observed_order_refuses_what_has_no_slope(dt, error, message):
    with pytest.raises(ValueError, match=message):
        observed_order(dt, error)
