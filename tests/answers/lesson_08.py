"""Answers that students give to the exercises of lesson 8, beside those that its tables make."""

import math

import numpy as np

from hoverslam_lib import observed_order
from hoverslam_lib.integrators import rk4


def _judge(order=lambda a, b, c: np.log2((b - a) / (c - b)), power=2.0):
    """By an order, and the error from it."""

    def judge(a, b, c):
        p = order(a, b, c)
        return [p, abs(b - c) / (power**p - 1)]

    return judge


def _tooth_of_a_step(theta, nodes, weights, a, dt):
    f = [a if place >= theta else 0.0 for place in nodes]
    v = dt * np.dot(weights, f)
    if len(nodes) == 4 and nodes[1] == 0.5:
        _, v = rk4(lambda t, h, v: a if t >= theta * dt else 0.0, 0.0, 0.0, 0.0, dt)
    return v - a * (dt - theta * dt)


def _as_given(h, v, a, dt):
    if h + v * dt + a * dt**2 / 2 > 0:
        return None
    return (-v + (v**2 - 2 * a * h) ** 0.5) / a


def _first_root(h, v, a):
    if a == 0:
        return -h / v if v < 0 else None
    inside = v**2 - 2 * a * h
    return (-v - math.sqrt(inside)) / a if inside >= 0 else None


def _within(root):
    """What a formula for the first root makes of the step."""

    def contact(h, v, a, dt):
        s = root(h, v, a)
        return s if s is not None and 0 < s <= dt else None

    return contact


def _without_a_question(h, v, a):
    return -h / v if a == 0 and v else (-v - (v**2 - 2 * a * h) ** 0.5) / (a or 1)


def _by_math(h, v, a):
    return -h / v if a == 0 else (-v - math.sqrt(v**2 - 2 * a * h)) / a


def _divides_by_numpys_zero(h, v, a):
    with np.errstate(all="ignore"):
        return (-v - np.sqrt(max(v**2 - 2 * a * h, 0.0))) / np.float64(a) if v**2 >= 2 * a * h else None


def _sampled(h, v, a, dt):
    return next((s for s in np.linspace(0, dt, 1001) if h + v * s + a * s**2 / 2 <= 0), None)


def _solved(h, v, a, dt, smallest=0.0, slowest=0.0, late=1.0):
    """By the root of `inside`, if that is not too small, the divisor is not, either, and the moment not too late."""
    inside = v**2 - 2 * a * h
    if inside < smallest:
        return None
    divisor = inside**0.5 - v
    return 2 * h / divisor if divisor > slowest and 2 * h / divisor <= late * dt else None


def _by_search(h, v, a, dt):
    lowest = min(dt, -v / a) if a > 0 > v else 0.0 if a > 0 else dt
    if h + v * lowest + a * lowest**2 / 2 > 0:
        return None
    low, high = 0.0, lowest
    for _ in range(200):
        middle = (low + high) / 2
        if h + v * middle + a * middle**2 / 2 > 0:
            low = middle
        else:
            high = middle
    return np.float64(high)


# exercise: what was answered, and the name of the mistake if it has one
WRONG = {
    "8.1": [
        (_judge(lambda a, b, c: math.log((b - a) / (c - b))), "another logarithm"),
        (_judge(lambda a, b, c: math.log((b - a) / (c - b)) / math.log(4)), None),
        (_judge(power=4.0), None),
        (lambda a, b, c: _judge()(a, b, c)[0], None),
    ],
    "8.2": [
        (lambda th, c, b, a, dt: a * dt * ((c > th) - (1 - th)), None),
        (lambda th, c, b, a, dt: -abs(_tooth_of_a_step(th, c, b, a, dt)), None),
    ],
    "8.3": [
        (_as_given, "the wrong root"),
        (lambda h, v, a, dt: _first_root(h, v, a), "after the step"),
        (_within(_without_a_question), "no root"),
        (_within(_by_math), "no root"),
        (_within(_divides_by_numpys_zero), "a is 0"),
        (lambda h, v, a, dt: dt * h / -(v * dt + a * dt**2 / 2), "linear"),
        (_sampled, "moments tried"),
        (lambda h, v, a, dt: h + v * dt + a * dt**2 / 2 <= 0, None),
        (lambda *step: _solved(*step, smallest=0.1), None),
        (lambda *step: _solved(*step, smallest=-0.1), None),
        (lambda *step: _solved(*step, slowest=0.1), None),
        (lambda *step: _solved(*step, late=1.0001), None),
        (lambda *step: _solved(*step, late=0.9999), "the end left out"),
    ],
}

RIGHT = {
    "8.1": [_judge(), _judge(lambda a, b, c: observed_order([2, 1], np.abs(np.diff([a, b, c]))))],
    "8.2": [
        _tooth_of_a_step,
        lambda where, c, b, push, step: float(push * step * (b @ (c > where) - 1 + where)),
    ],
    "8.3": [_by_search, _within(_first_root)],
}
