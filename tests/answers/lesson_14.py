"""Answers that students give to the exercises of lesson 14, beside those that its tables make."""

import math
from dataclasses import replace

import numpy as np

from hoverslam_lib import FALCON_9_LANDING_BURN

ours = replace(FALCON_9_LANDING_BURN, propellant_mass=3_800.0)


def _braking(h, w, drag):
    """Deceleration by the drag [m/s²] at the total speed w."""
    theta = 288.15 - 0.0065 * h
    rho, c = 1.225 * (theta / 288.15) ** 4.25588, 20.0468 * np.sqrt(theta)
    return 0.5 * rho * drag(abs(w) / c) * math.pi * 1.83**2 * w**2 / 31e3


def _slanted(formula):
    """f of a formula for the vertical acceleration by s, v and the braking at a speed."""
    return lambda drag, s: lambda t, h, v: formula(s, v, lambda w: _braking(h, w, drag))


# exercise: what was answered, and the name of the mistake if it has one
WRONG = {
    "14.1": [
        ((0.91, 1.45, 0), "weight forgotten"),
        ((1.6, 1.77, 0), "upside down"),
        ((1.6, 1.45, -5), None),
        ((1604, 1449, 0), None),
        ((0.0016, 0.00145, 0), "mass in tonnes"),
        ((1.6, 1.4, 0), "one digit"),
        ((1.604, 1.449, None), None),
    ],
    "14.2": [
        (lambda t, v, h: (h[0] - h[-1]) / (t[-1] - t[0]) / np.mean(v), "first and last height"),
        (lambda t, v, h: np.mean(-np.polyfit(t, h, 1)[0] / v), None),
        (lambda t, v, h: -np.polyfit(t, h, 1) / np.mean(v), None),
        (lambda t, v, h: -np.polyfit(h, t, 1)[0] / np.mean(v), None),
        (lambda t, v, h: -np.polyfit(t, h, 2)[1] / v[0], None),
        (lambda t, v, h: np.rad2deg(np.arccos(-np.polyfit(t, h, 1)[0] / v.mean())), "an angle"),
        (lambda t, v, h: 0.9, None),
        (lambda t, v, h: None, None),
    ],
    "14.3": [
        (_slanted(lambda s, v, braking: braking(v) - 9.8), "straight down"),
        (_slanted(lambda s, v, braking: s * (braking(v / s) - 9.8)), "whole weight"),
        (_slanted(lambda s, v, braking: s * braking(v / s) - s**2 * 9.81), "another g"),
        (_slanted(lambda s, v, braking: s * 9.8 - braking(v / s)), "along the path"),
        (_slanted(lambda s, v, braking: (braking(v / s) - s * 9.8) / s), "divided by the share"),
        (_slanted(lambda s, v, braking: braking(v / s) - s**2 * 9.8), "whole drag"),
        (lambda drag, s: 0.0, None),
        (lambda drag, s: _slanted(lambda s, v, braking: braking(v))(drag, s)(0.0, 8e3, -400.0), None),
        (lambda drag, s: None, None),
    ],
}

RIGHT = {
    "14.1": [(1.6, 1.45, 0), (1.5969, 1.4424, 0.0), (np.float64(1.61), [1.44], -0.01)],
    "14.2": [
        lambda t, v, h: -np.polynomial.Polynomial.fit(t, h, 1).convert().coef[1] / v.mean(),
        lambda t, v, h: -np.cov(t, h)[0, 1] / np.var(t, ddof=1) / (sum(v) / len(v)),
    ],
    "14.3": [
        _slanted(lambda s, v, braking: s * braking(v / s) - s**2 * 9.8),
        _slanted(lambda s, v, braking: -s * (s * 9.8 - braking(-v / s))),
        _slanted(lambda s, v, braking: s * braking(v / s) - s**2 * 9.80),
    ],
}
