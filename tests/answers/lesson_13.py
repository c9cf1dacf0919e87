"""Answers that students give to the exercises of lesson 13, beside those that its tables make."""

import math

import numpy as np

T, U, LOOK = 845e3, 2765.0, 0.1


def _throttle(a, h, v, mass):
    drag = 0.25 * 1.3 * math.exp(-h / 8400) * math.pi * 1.83**2 * v * v
    return (mass * (a + 9.798) - drag) / T


def _steady(h, v, mass, memory, v_td=1.0, least=0.01):
    return _throttle((max(-v, 0.0) ** 2 - v_td**2) / (2 * max(h, least)), h, v, mass)


def _wanted(h, gate=30.0, high=13.6, low=9.0, v_td=1.0):
    h = max(h, 0.0)
    at_gate = v_td**2 + 2 * low * gate
    return -math.sqrt(v_td**2 + 2 * low * h if h < gate else at_gate + 2 * high * (h - gate))


def _velocity(h, v, mass, memory, gain=2.0, gate=30.0, high=13.631, low=13.631, v_td=1.0):
    a, wanted = low if h < gate else high, _wanted(h, gate, high, low, v_td)
    return _throttle(a * v / wanted - gain * (v - wanted), h, v, mass)


def _filtered(law, trust=0.2, of_v=1.0, **numbers):
    """A law that remembers what it saw, and of the velocity what it commanded, too."""

    def remembers(h, v, mass, memory):
        if memory:
            a = (memory["throttle"] * T / mass) - 9.8
            v = memory["v"] + a * LOOK + of_v * (v - memory["v"] - a * LOOK)
            expected = memory["h"] + LOOK * (memory["v"] + v) / 2
            h = expected + trust * (h - expected)
        said = min(max(law(h, v, mass, memory, **numbers), 0.57), 1.0)
        memory.update(h=h, v=v, throttle=said)
        return said

    return remembers


def _gated(h, v, mass, memory, gate=30.0, a=9.0, v_td=1.0, gain=6.0):
    """Far up the steady law, aimed at a gate above the ground."""
    if h > gate + 1:
        return _throttle((v * v - v_td**2 - 2 * a * gate) / (2 * (h - gate)), h, v, mass)
    return _throttle(a + gain * (-math.sqrt(v_td**2 + 2 * a * max(h, 0.0)) - v), h, v, mass)


_seen = []


def _of_all_flights(h, v, mass, memory):
    _seen.append(h)
    return _velocity(np.mean(_seen[-3:]), v, mass, memory)


WRONG = {
    "13.1": [
        ((98, 1018), None),
        (("98 m/s", 1009), None),
        ((-98, 1009), None),
        ((98, "1 t"), None),
        ((98, 1028), "mass kept"),
        ((9.8, 1009), "one second"),
    ],
    "13.2": [
        (lambda h, g, high, low, v: -math.sqrt(v**2 + low * min(h, g) + high * max(h - g, 0)), "no two"),
        (lambda h, g, high, low, v: -math.sqrt(v**2 + 2 * low * min(h, g) + 2 * high * max(h - g, 0)), None),
        (lambda h, g, high, low, v: -math.sqrt(2 * low * h) if h < g else -math.sqrt(2 * high * h), None),
        (lambda h, g, high, low, v: -v if h < 0 else -np.sqrt(v**2 + 2 * (low if h < g else high) * h), None),
        (lambda h, g, high, low, v: (_wanted(h, g, high, low, v), low), None),
    ],
    "13.3": [
        (lambda h, v, mass, memory: 1.0 if v * v / 2 / (0.75 * T / mass - 9.8) >= h else 0.57, "on and off"),
        (lambda *a: _steady(*a, v_td=1.5), None),
        (lambda *a: _steady(*a, least=3.0), None),
        (_steady, "the steady law"),
        (lambda h, v, mass, memory: -v / 400, None),
        (lambda h, v, mass, memory: 0.7 + 0.01 * (-v - math.sqrt(2 * 10 * max(h, 0))), None),
        (lambda *a: _velocity(*a, gain=16.0), None),
        (_filtered(_velocity, trust=0.2, of_v=0.2, gain=3.0), None),
        (_of_all_flights, "remembers its last call"),
        (lambda h, v, mass, memory: memory["h"], None),
        (lambda h, v, mass, memory: math.sqrt(v), None),
        (lambda *a: 1e6 * _steady(*a), "stops too high"),
        (lambda h, v, mass, memory: print(0.7), None),
        (lambda *a: f"{_velocity(*a):.2f}", None),
    ],
}

RIGHT = {
    "13.1": [(98, 1009), (98.1, 1010), (np.float64(98), 29_000 * (1 - np.exp(-98 / U)))],
    "13.2": [lambda h, *a: _wanted(h, *a), lambda h, *a: np.array(_wanted(h, *a))],
    "13.3": [
        _filtered(_gated, trust=0.1, v_td=0.9),
        _filtered(_velocity, trust=0.1, gain=4.0, low=9.0, v_td=0.8),
        _filtered(_velocity, trust=0.1, low=9.0, v_td=0.9),
    ],
}
