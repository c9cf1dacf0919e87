"""Answers that students give to the exercises of lesson 8."""

import math

import numpy as np


def _ratio(coarse, middle, fine):
    return (coarse - middle) / (middle - fine)


def _error(coarse, middle, fine):
    return abs(middle - fine) / (_ratio(coarse, middle, fine) - 1)


def _judge(order=np.log2, error=_error):
    return lambda *results: (order(_ratio(*results)), error(*results))


def _judge_by_differences(a, b, c):
    change = np.abs(np.diff([a, b, c]))
    p = (np.log(change[0]) - np.log(change[1])) / np.log(2)
    return np.array([p, change[1] / (2**p - 1)])


def _seen(theta, nodes, weights):
    return sum(w for c, w in zip(nodes, weights, strict=True) if c >= theta)


def _tooth_of_a_step(theta, nodes, weights, a, dt):
    f = [a if place >= theta else 0.0 for place in nodes]
    v = dt * np.dot(weights, f)
    return v - a * (dt - theta * dt)


def _tooth_of_rk4(theta, nodes, weights, a, dt):
    return (theta - 1 / 6 if theta <= 0.5 else theta - 5 / 6) * a * dt


def _as_given(h, v, a, dt):
    if h + v * dt + a * dt**2 / 2 > 0:
        return None
    return (-v + (v**2 - 2 * a * h) ** 0.5) / a


def _first_root(h, v, a):
    if a == 0:
        return -h / v if v < 0 else None
    inside = v**2 - 2 * a * h
    return (-v - math.sqrt(inside)) / a if inside >= 0 else None


def _dip_missed(h, v, a, dt):
    return None if h + v * dt + a * dt**2 / 2 > 0 else _first_root(h, v, a)


def _later_root(h, v, a, dt):
    inside = v**2 - 2 * a * h
    if inside < 0 or a == 0:
        return _first_root(h, v, a)
    return next((s for s in ((-v + inside**0.5) / a, (-v - inside**0.5) / a) if 0 < s <= dt), None)


def _any_length(h, v, a, dt):
    s = _first_root(h, v, a)
    return s if s is not None and s > 0 else None


def _even_before(h, v, a, dt):
    s = _first_root(h, v, a)
    return s if s is not None and s <= dt else None


def _without_a_question(h, v, a, dt):
    if a == 0:
        return _first_root(h, v, a)
    return (-v - (v**2 - 2 * a * h) ** 0.5) / a


def _compares_with_complex(h, v, a, dt):
    s = _without_a_question(h, v, a, dt)
    return s if s <= dt else None


def _divides_by_zero(h, v, a, dt):
    inside = v**2 - 2 * a * h
    if inside < 0:
        return None
    s = (-v - inside**0.5) / a
    return s if 0 < s <= dt else None


def _divides_by_numpys_zero(h, v, a, dt):
    with np.errstate(all="ignore"):
        return _divides_by_zero(h, v, np.float64(a), dt)


def _looks_after(theta, nodes, weights, a, dt, *, ignition):
    return a * dt * (weights[nodes > ignition].sum() - (1 - theta))


def _by_math(h, v, a, dt):
    s = -h / v if a == 0 else (-v - math.sqrt(v**2 - 2 * a * h)) / a
    return s if 0 < s <= dt else None


def _without_the_half_or_the_end(h, v, a, dt):
    inside = v**2 - 4 * a * h
    if inside < 0:
        return None
    s = (-v - inside**0.5) / (2 * a) if a else _first_root(h, v, a)
    return s if s is not None and 0 < s <= dt else None


def _by_an_eighth(h, v, a, dt):
    s = (-v - (v**2 - 8 * a * h) ** 0.5) / (4 * a) if a else _first_root(h, v, a)
    return s if 0 < s <= dt else None


def _another_root(h, v, a, dt):
    inside = v**2 - 4 * a * h
    if inside < 0:
        return None
    return (-v + inside**0.5) / (2 * a) if a else _first_root(h, v, a)


def _smaller_root(h, v, a, dt):
    if a == 0:
        return _any_length(h, v, a, dt)
    inside = v**2 - 2 * a * h
    if inside < 0:
        return None
    s = min((-v - inside**0.5) / a, (-v + inside**0.5) / a)
    return s if s <= dt else None


def _sampled(h, v, a, dt):
    for s in np.linspace(0, dt, 1001):
        if h + v * s + a * s**2 / 2 <= 0:
            return s
    return None


def _straight_line(h, v, a, dt):
    s = dt * h / -(v * dt + a * dt**2 / 2)
    return s if s > 0 else None


def _without_the_half(h, v, a, dt):
    s = _first_root(h, v, 2 * a)
    return s if s is not None and 0 < s <= dt else _first_root(h, v, a)


def _at_rest(h, v, a, dt):
    return -v / a if a else _first_root(h, v, a)


def _by_formula(h, v, a, dt):
    s = _first_root(h, v, a)
    return None if s is None or s <= 0 or s > dt else s


def _by_all_roots(h, v, a, dt):
    roots = np.roots([a / 2, v, h])
    real = sorted(x.real for x in roots if abs(x.imag) < 1e-12 and 0 < x.real <= dt)
    return real[0] if real else None


def _by_cases(h, v, a, dt):
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
        (_judge(order=lambda r: r), "ratio"),
        (_judge(order=math.log), "natural logarithm"),
        (_judge(order=math.log10), "decimal logarithm"),
        (_judge(order=lambda r: np.log2(1 / r)), "upside down"),
        (_judge(order=math.sqrt), "root"),
        (_judge(order=lambda r: round(np.log2(r))), "rounded"),
        (_judge(order=lambda r: int(np.log2(r))), "rounded down"),
        (_judge(error=lambda c, m, f: abs(c - m) / (_ratio(c, m, f) - 1)), "error of the middle run"),
        (_judge(error=lambda c, m, f: abs(m - f)), "change"),
        (_judge(error=lambda c, m, f: abs(m - f) / _ratio(c, m, f)), "divided by the ratio"),
        (_judge(error=lambda c, m, f: abs(m - f) / 15), "order 4 always"),
        (_judge(error=lambda c, m, f: -abs(m - f) / (_ratio(c, m, f) - 1)), "negative"),
        (_judge(error=lambda c, m, f: abs(m - f) / (2 * _ratio(c, m, f) - 1)), "one power too many"),
        (lambda c, m, f: _judge()(c, m, f)[::-1], "swapped"),
        (lambda c, m, f: _judge()(c, m, f)[0], None),
        (_judge(order=lambda r: 4.0), None),
        (_judge(error=lambda c, m, f: (m - f) / (_ratio(c, m, f) - 1)), "negative"),
    ],
    "8.2": [
        (lambda *x: -_tooth_of_a_step(*x), "exact minus computed"),
        (lambda th, c, b, a, dt: a * dt * (_seen(th, c, b) - th), "time before ignition"),
        (lambda th, c, b, a, dt: a * dt * (1 - _seen(th, c, b) - (1 - th)), "looks that miss it"),
        (lambda th, c, b, a, dt: a * dt * _seen(th, c, b), "only what is added"),
        (lambda th, c, b, a, dt: a * dt * (np.mean(c > th) - (1 - th)), "looks counted"),
        (lambda th, c, b, a, dt: a * (_seen(th, c, b) - (1 - th)), "dt missing"),
        (lambda th, c, b, a, dt: dt * (_seen(th, c, b) - (1 - th)), "a missing"),
        (lambda *x: _looks_after(*x, ignition=x[0] * x[4]), "theta as a time for the looks"),
        (lambda *x: _looks_after(*x, ignition=x[0] / x[4]), None),
        (lambda th, c, b, a, dt: a * (dt * _seen(th, c, b) - (dt - th)), "theta as a time"),
        (_tooth_of_rk4, None),
        (lambda th, c, b, a, dt: a * dt * ((c > th) - (1 - th)), None),
        (lambda th, c, b, a, dt: abs(_tooth_of_a_step(th, c, b, a, dt)), "sign lost"),
    ],
    "8.3": [
        (_as_given, "the wrong root"),
        (_dip_missed, "dip missed"),
        (_later_root, "the wrong root"),
        (_any_length, "after the step"),
        (_even_before, "before the step"),
        (_without_a_question, "no root"),
        (_compares_with_complex, "no root"),
        (_by_math, "no root"),
        (_without_the_half_or_the_end, "half forgotten"),
        (_another_root, None),
        (_by_an_eighth, None),
        (lambda h, v, a, dt: (-v - (v**2 - 8 * a * h) ** 0.5) / a, None),
        (_smaller_root, "the wrong root"),
        (_sampled, None),
        (_divides_by_zero, None),
        (_divides_by_numpys_zero, "a is 0"),
        (_straight_line, "linear"),
        (_without_the_half, "half forgotten"),
        (_at_rest, "lowest point"),
        (lambda h, v, a, dt: -_by_cases(h, v, a, dt), "negative"),
        (lambda h, v, a, dt: h + v * dt + a * dt**2 / 2 <= 0, None),
    ],
}

RIGHT = {
    "8.1": [_judge(), _judge_by_differences],
    "8.2": [
        _tooth_of_a_step,
        lambda where, c, b, push, step: float(push * step * (b @ (c > where) - 1 + where)),
    ],
    "8.3": [_by_cases, _by_all_roots, _by_formula],
}
