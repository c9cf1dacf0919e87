"""Answers that students give to the exercises of lesson 11, beside those that its tables make."""

import numpy as np

from hoverslam_lib import EARTH, FALCON_9


def _off(t, h, v):
    return np.diff(h) - np.diff(t) * (v[1:] + v[:-1]) / 2


def _steps(t, h, v, sure=200.0):
    for i in range(len(t) - 1):
        dt = t[i + 1] - t[i]
        if abs(h[i + 1] - h[i] - dt * (v[i] + v[i + 1]) / 2) > sure * dt * dt + 1e-6:
            return True
    return False


def _between(t, h, v):
    # the mean velocity lies between the two, but for what the acceleration can do in a step
    dt = np.diff(t)
    mean = np.diff(h) / dt
    low, high = np.minimum(v[1:], v[:-1]) - 300 * dt, np.maximum(v[1:], v[:-1]) + 300 * dt
    return not np.all((low - 1e-6 <= mean) & (mean <= high + 1e-6))


def _ledger(t_ignite, t, h, v, share=None, limit=1.0):
    """The lesson's, with its 0.03 s or with a share of each step."""
    middle, burn_end = (t[1:] + t[:-1]) / 2, t_ignite + FALCON_9.burn_duration
    lit = (middle > t_ignite) & (middle < burn_end)
    energy = v**2 / 2 - EARTH.gravity(0.0) * EARTH.radius**2 / (EARTH.radius + h)
    push = lit * FALCON_9.thrust / FALCON_9.mass(middle - t_ignite)
    left_over = np.diff(energy) - push * (v[1:] + v[:-1]) / 2 * np.diff(t)
    margin = 0.03 if share is None else share * np.diff(t)
    clear = np.minimum(abs(middle - t_ignite), abs(middle - burn_end)) > margin
    return left_over[clear & (left_over > 0)].sum() > limit


def _air(t_ignite, t, h, v, limit=0.05, share=1.5, start=False, floored=True):
    dt, mid, v_mid = np.diff(t), (t[1:] + t[:-1]) / 2, (v[1:] + v[:-1]) / 2
    end = t_ignite + FALCON_9.burn_duration
    lit = (mid > t_ignite) & (mid < end)
    at = t[:-1] if start else mid
    mass = FALCON_9.mass(at - t_ignite) if floored else FALCON_9.initial_mass
    a = np.diff(v) / dt + EARTH.gravity(h[1:]) - lit * FALCON_9.thrust / mass
    clear = np.minimum(abs(mid - t_ignite), abs(mid - end)) > share * dt
    return np.any((a * np.sign(v_mid))[clear] > limit)


def _momentum(t_ignite, t, h, v):
    mass, dt = FALCON_9.mass(t - t_ignite), np.diff(t)
    engine = FALCON_9.thrust / FALCON_9.burn_rate * np.log(mass[:-1] / mass[1:])
    air = np.diff(v) + EARTH.gravity((h[1:] + h[:-1]) / 2) * dt - engine
    whole = np.isclose(engine, 0) | np.isclose(mass[:-1] - mass[1:], FALCON_9.burn_rate * dt)
    return np.any(whole & (air * np.sign(v[1:] + v[:-1]) > 0.1 * dt))


def _rocket(t_ignite, t, h, v):
    u = FALCON_9.thrust / FALCON_9.burn_rate
    most = u * np.log(FALCON_9.initial_mass / FALCON_9.mass(t - t_ignite))
    return np.any(v > most + 1e-3) or np.any(v < v[0] - EARTH.gravity(0.0) * t - 1e-3)


def _g_load(t_ignite, t, h, v):
    return np.max(np.abs(np.diff(v) / np.diff(t) + 9.81)) > 30 * 9.81


def _spoils(t, h, v):
    said = _steps(t, h, v)
    h -= h[-1]
    return said


WRONG = {
    "11.1": [((25_824, 57.1), None), (("25.8 t", 0.93), None), ((25_333, 1.26), None), ((25_824, 929), None)],
    "11.2": [
        (lambda t, h, v: np.any(np.abs(_off(t, h, v)) > 300 * np.diff(t) ** 3 + 1e-6), None),
        (lambda t, h, v: np.any(np.abs(np.gradient(h, t) - v) > 5), None),
        (lambda t, h, v: np.any(np.abs(_off(t, h, v)) > 1.0), None),
        (lambda t, h, v: np.any(_off(t, h, v) > 300 * np.diff(t) ** 2), None),
        (lambda t, h, v: abs(_off(t, h, v).sum()) > 500, None),
        (lambda t, h, v: np.any(np.abs(_off(t, h, v)) > 0.05 * np.abs(np.diff(h)) + 0.01), None),
        (lambda t, h, v: np.any(np.abs(_off(t[1] * np.arange(t.size), h, v)) > 300 * t[1] ** 2), None),
        (lambda t, h, v: np.any(np.abs(_off(t, h, v)) > 300 * (t[1] - t[0]) ** 2), None),
        (lambda t, h, v: np.mean(np.abs(_off(t, h, v)) / np.diff(t) ** 2) > 300, None),
        (lambda t, h, v: bool(np.any(np.diff(h) * v[1:] < 0)), None),
        (lambda t, h, v: bool(np.max(np.abs(np.diff(h) / np.diff(t) - v[1:])) > 150 * np.diff(t)[0]), None),
        (lambda t, h, v: bool(np.any(np.abs(np.diff(v) / np.diff(t)) > 300)), None),
        (lambda t, h, v: np.abs(_off(t, h, v)) > 300 * np.diff(t) ** 2, None),
        (lambda t, h, v: _steps(t, h, v) or None, None),
        (lambda t, h, v: "ALARM", None),
        (_spoils, "changes its arguments"),
    ],
    "11.3": [
        (_ledger, None),
        (lambda *a: _ledger(*a, share=1.5), None),
        (lambda *a: _ledger(*a, share=0.5, limit=20.0), None),
        (lambda *a: _ledger(*a, share=0.5, limit=50.0), None),
        (lambda *a: _air(*a, limit=1.0), None),
        (lambda *a: _air(*a, share=0.1), None),
        (lambda *a: _air(*a, start=True), None),
        (lambda *a: _air(*a, floored=False), None),
        (lambda t_ignite, t, h, v: np.any(np.diff(v**2 / 2 + 9.81 * h) > 1), None),
        (lambda *a: _g_load(*a) or _rocket(*a), None),
    ],
}

RIGHT = {
    "11.1": [(25_800, 0.95), (7.6e6 / 30 / 9.81, 0.93), (np.float64(25_820), np.float64(0.925))],
    "11.2": [_steps, _between, lambda t, h, v: np.max(np.abs(_off(t, h, v)) / np.diff(t) ** 2) > 150],
    "11.3": [
        _air,
        _momentum,
        lambda t_ignite, t, h, v: _ledger(t_ignite, t, h, v, share=0.5, limit=120 * (t[1] - t[0])),
        lambda *a: _air(*a, limit=0.02, share=0.5),
        lambda *a: _air(*a, limit=0.1, share=1.0),
    ],
}
