"""Checks on what a caller passes in. Each message names the value, what is allowed and the unit."""

import math
from numbers import Real

import numpy as np

MAX_STEPS = 10_000_000
"""A run longer than this is taken for a slip in dt."""


def number(name, value, unit="", *, above=-math.inf, least=-math.inf, most=math.inf):
    """Return `value` as a finite float within the given limits, or raise."""
    limits = []
    if above > -math.inf:
        limits.append(f"greater than {above:g}")
    if least > -math.inf:
        limits.append(f"at least {least:g}")
    if most < math.inf:
        limits.append(f"at most {most:g}")
    allowed = " ".join(["a finite number", " and ".join(limits)]).strip()
    if unit:
        allowed += f" [{unit}]"
    if isinstance(value, bool) or not isinstance(value, Real):
        raise TypeError(f"{name} must be {allowed}; got {value!r} ({type(value).__name__})")
    result = float(value)
    if not (math.isfinite(result) and result > above and least <= result <= most):
        raise ValueError(f"{name} must be {allowed}; got {value!r}")
    return result


def state(name, value, unit=""):
    """Return a finite float, or a float array of finite numbers: an initial value of a run."""
    if isinstance(value, Real):
        return number(name, value, unit)
    try:
        result = np.array(value, dtype=float)
    except (TypeError, ValueError):
        raise TypeError(f"{name} must be a number or an array of numbers [{unit}]; got {value!r}") from None
    if not np.all(np.isfinite(result)):
        raise ValueError(f"{name} must be finite everywhere [{unit}]; got {value!r}")
    return result


def step_count(steps, dt):
    """Raise if a run of `steps` steps of `dt` seconds would be longer than MAX_STEPS."""
    if steps > MAX_STEPS:
        raise ValueError(
            f"dt = {dt:g} s would take {steps:,.0f} steps or more; at most {MAX_STEPS:,} are allowed: "
            f"use a dt of at least {dt * steps / MAX_STEPS:.1g} s"
        )
