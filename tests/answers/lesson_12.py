"""Answers that students give to the exercises of lesson 12."""

import math

import numpy as np

LOWEST = 108_300 / 190_000


def _drag(h, v):
    return 0.25 * 1.3 * math.exp(-h / 8400) * math.pi * 1.83**2 * v * v


def _throttle(a, h, v, mass):
    return min(max((mass * (a + 9.798) - _drag(h, v)) / 845e3, LOWEST), 1.0)


def _lessons(t, h, v, mass, v_td=1.0, least=0.01):
    return _throttle((max(-v, 0.0) ** 2 - v_td**2) / (2 * max(h, least)), h, v, mass)


def _switch(t, h, v, mass):
    return 1.0 if v * v / 2 / (0.75 * 845e3 / mass - 9.8) >= h else LOWEST


def _gated(t, h, v, mass, gate=60.0, a=10.0, end=1.3):
    if h > gate + 1:
        return (mass * ((v * v - end**2 - 2 * a * gate) / 2 / (h - gate) + 9.8) - _drag(h, v)) / 845e3
    off = math.sqrt(end**2 + 2 * a * abs(h)) + v
    return (mass * (a - 4 * off + 9.8) - _drag(h, v)) / 845e3


def _blend(h, v, a, dt, h_seen, v_seen, trust):
    he, ve = h + dt * (v + a * dt / 2), v + a * dt
    return (1 - trust) * he + trust * h_seen, (1 - trust) * ve + trust * v_seen


def _mix(a, b, trust):
    return a + trust * (b - a)


WRONG = {
    "12.1": [
        ((269, 6000), None),
        ((218, 1820), None),
        ((178, 0.4), None),
        (("178 m", 1480), None),
        ((133.7, 1480), "drag taken away"),
    ],
    "12.2": [
        (lambda h, v, a, dt, hs, vs, k: (_mix(h + v * dt - a * dt**2 / 2, hs, k), _mix(v - a * dt, vs, k)), None),
        (lambda h, v, a, dt, hs, vs, k: (h + k * hs, v + k * vs), None),
        (lambda h, v, a, dt, hs, vs, k: (h + v * dt + a * dt**2 / 2, _mix(v + a * dt, vs, k)), None),
        (lambda h, v, a, dt, hs, vs, k: ((h + hs) / 2, (v + vs) / 2), None),
        (lambda h, v, a, dt, hs, vs, k: _blend(h, v, a, dt, hs, vs, k)[0], None),
        (lambda h, v, a, dt, hs, vs, k: _blend(h, v, a, dt, hs, vs, k)[::-1], None),
    ],
    "12.3": [
        (_switch, "on and off"),
        (lambda *a: _lessons(*a, v_td=1.5), None),
        (lambda *a: _lessons(*a, least=3.0), None),
        (lambda t, h, v, mass: -v / 400, None),
        (lambda t, h, v, mass: 0.7 + 0.01 * (-v - math.sqrt(2 * 10 * max(h, 0))), None),
        (lambda t, h, v, mass: _lessons(t, h, v, mass) if h > 2 else LOWEST, None),
        (lambda t, h, v, mass: _lessons(t, h, v, 30e3), None),
        (lambda t, h, v, mass: 0.6 if h > 1000 else 0.8, None),
        (lambda t, h, v, mass: math.sqrt(v), None),
        (lambda *a: 1e6 * _lessons(*a), None),
        (lambda t, h, v, mass: print(0.7), None),
        (lambda t, h, v, mass: f"{_gated(t, h, v, mass):.2f}", None),
    ],
}

RIGHT = {
    "12.1": [(178, 1500), (np.sqrt(31_556), 1_450)],
    "12.2": [lambda *a: np.array(_blend(*a)), lambda *a: list(_blend(*a))],
    "12.3": [_gated, lambda *a: np.array([_gated(*a, gate=30.0)])],
}
