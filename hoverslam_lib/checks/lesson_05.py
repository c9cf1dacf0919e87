"""Beside the page of lesson 5: the pushed pendulum, and counted looks."""

import math

import numpy as np

from hoverslam_lib.metrics import max_error
from hoverslam_lib.trajectory import integrate


def pendulum(t, x, v):
    "the pushed pendulum"  # which moves as 2 cos t
    push = -2 * math.cos(t) + math.sin(2 * math.cos(t)) - 0.2 * math.sin(t)
    return -math.sin(x) - 0.1 * v + push


def rubbed(t, h, v):
    "t² - 2h - 0.3|v|v"
    return t**2 - 2 * h - 0.3 * v * abs(v)


def error(method, dt, t_end=20.0):
    """Largest error of the pushed pendulum, as a share of its amplitude."""
    run = integrate(pendulum, 2.0, 0.0, dt=dt, t_end=t_end, method=method)
    return max_error(2 * np.cos(run.t), run.h) / 2


def looks(step, *arguments):
    """How often a step asks for f."""
    calls = []
    step(lambda *at: calls.append(at) or rubbed(*at), *arguments)
    return len(calls)
