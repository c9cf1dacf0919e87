import math

import numpy as np
import pytest

from hoverslam_lib._roots import bracketed_root, bracketed_roots


def counted(g):
    def count(x):
        count.calls += 1
        return g(x)

    count.calls = 0
    return count


def find(g, a, b, **options):
    """Root and the number of evaluations, those at the ends not counted."""
    g = counted(g)
    ga, gb = g(a), g(b)
    root = bracketed_root(g, a, b, ga, gb, **options)
    return root, g.calls - 2


ORDINARY = [
    (lambda x: x - 0.3, 0.0, 1.0, 0.3),
    (lambda x: math.cos(x) - x, 0.0, 1.0, 0.7390851332151607),
    (lambda x: x**3 - 2 * x - 5, 2.0, 3.0, 2.0945514815423265),
    (lambda x: 1 - x, 0.0, 1e9, 1.0),
    (lambda x: -1 + 1e-3 * x, 0.0, 1e6, 1000.0),
    (lambda x: 1e-300 * (x - 0.7), 0.0, 1.0, 0.7),
    (lambda x: 1e300 * (x - 0.7), 0.0, 1.0, 0.7),
]
HARD = [
    (lambda x: math.exp(50 * x) - math.exp(35), 0.0, 1.0, 0.7),  # steep
    (lambda x: math.expm1(-800 * (x - 0.01)), 0.0, 0.9, 0.01),  # steep at one end, flat at the other
    (lambda x: (x - 0.4) ** 9, 0.0, 1.0, 0.4),  # flat around the root
    (lambda x: math.atan(1e8 * (x - 0.123)), 0.0, 1.0, 0.123),  # nearly a jump
    (lambda x: math.copysign(1, x - 0.123), 0.0, 1.0, 0.123),  # a jump
    (lambda x: math.copysign(abs(x - 0.6) ** 0.1, x - 0.6), 0.0, 1.0, 0.6),  # vertical
    (lambda x: math.sqrt(x) - 1e-4, 0.0, 1.0, 1e-8),
    (lambda x: (x - 0.5) ** 2 - 1e-14, 0.5, 1.0, 0.5 + 1e-7),  # nearly a double root
    (lambda x: (0.5 - x) * ((x - 0.5) ** 2 + 1e-20), 0.0, 1.3, 0.5),  # nearly a triple root
    (lambda x: math.inf if x < 0.25 else 0.3 - x, 0.0, 1.0, 0.3),
    (lambda x: math.inf if x < 0.3 else -math.inf, 0.0, 1.0, 0.3),
    (lambda x: 0.3 - x if x < 0.35 else -math.inf, 0.0, 1.0, 0.3),
]


@pytest.mark.parametrize(("g", "a", "b", "root"), ORDINARY)
def test_ordinary_roots_take_few_evaluations(g, a, b, root):
    found, calls = find(g, a, b)
    assert found == pytest.approx(root, rel=1e-15)
    assert calls <= 10


@pytest.mark.parametrize(("g", "a", "b", "root"), HARD)
def test_hard_roots_are_found_too(g, a, b, root):
    found, calls = find(g, a, b, xtol=1e-15)
    assert found == pytest.approx(root, rel=0, abs=4e-15)
    assert calls <= 65


@pytest.mark.parametrize(("g", "a", "b", "root"), ORDINARY + HARD)
def test_the_order_and_the_sign_do_not_matter(g, a, b, root):
    found, _ = find(g, a, b, xtol=1e-13)
    assert find(g, b, a, xtol=1e-13)[0] == pytest.approx(found, rel=1e-12, abs=1e-12)
    assert find(lambda x: -g(x), a, b, xtol=1e-13)[0] == pytest.approx(found, rel=1e-12, abs=1e-12)


@pytest.mark.parametrize("end", [2.0, 5.0])
def test_a_root_at_an_end_costs_nothing(end):
    assert find(lambda x: x - end, 2.0, 5.0) == (end, 0)


@pytest.mark.parametrize(("g", "a", "b", "root"), ORDINARY + HARD)
def test_g_is_never_asked_outside_the_bracket(g, a, b, root):
    def inside(x):
        assert a <= x <= b
        return g(x)

    assert a <= bracketed_root(inside, a, b, g(a), g(b), xtol=1e-12) <= b


@pytest.mark.parametrize("xtol", [1e-3, 1e-6, 1e-9])
def test_xtol_is_met_and_saves_evaluations(xtol):
    found, calls = find(lambda x: math.copysign(1, x - 0.123), 0.0, 1.0, xtol=xtol)
    assert abs(found - 0.123) <= 2 * xtol
    assert calls <= 2 + math.log2(1 / xtol)


def test_it_is_far_better_than_bisection():
    assert find(lambda x: math.exp(x) - 20, -2.0, 10.0)[1] <= 14


@pytest.mark.parametrize(("ga", "gb"), [(1.0, 2.0), (-1.0, -1e-9), (math.inf, 1.0), (-math.inf, -math.inf)])
def test_the_same_sign_at_both_ends_is_an_error(ga, gb):
    with pytest.raises(ValueError, match=r"same sign at both ends: g\(2\) = .*, g\(3\) = "):
        bracketed_root(lambda x: x, 2.0, 3.0, ga, gb)


def test_many_roots_at_once_are_those_found_one_by_one():
    cases = ORDINARY + HARD + [(lambda x: x - 0.5, 0.5, 1.0, 0.5), (lambda x: x - 0.5, 0.0, 0.5, 0.5)]
    gs, a, b, roots = zip(*cases, strict=True)

    def g(x):
        return np.array([one(float(each)) for one, each in zip(gs, x, strict=True)])

    a, b = np.array(a), np.array(b)
    found = bracketed_roots(g, a, b, g(a), g(b), xtol=1e-15)
    one_by_one = [find(*case[:3], xtol=1e-15)[0] for case in cases]
    assert found.tolist() == pytest.approx(one_by_one, rel=0, abs=4e-15)
    assert found.tolist() == pytest.approx(list(roots), rel=1e-14, abs=4e-15)


def test_a_root_does_not_depend_on_those_found_beside_it():
    targets = np.linspace(0.01, 0.99, 50)

    def roots_of(targets):
        def g(x):
            return x**3 - targets

        zero, one = np.zeros_like(targets), np.ones_like(targets)
        return bracketed_roots(g, zero, one, g(zero), g(one))

    together = roots_of(targets)
    assert [roots_of(targets[i : i + 1])[0] for i in range(50)] == together.tolist()
    assert roots_of(np.array([])).size == 0


def test_first_guess_is_that_of_a_straight_line():
    asked = []

    def line(x):
        asked.append(x)
        return 3.0 - x

    assert bracketed_root(line, 0.0, 4.0, 3.0, -1.0) == pytest.approx(3.0)
    assert asked[0] == pytest.approx(3.0)
    one = len(asked)
    found = bracketed_roots(line, np.zeros(2), np.full(2, 4.0), np.full(2, 3.0), np.full(2, -1.0))
    assert found == pytest.approx(3.0)
    assert asked[one] == pytest.approx(3.0)
