"""Checks on what a caller passes in. Each message names the value, what is allowed and the unit."""

import math
from numbers import Real

import numpy as np

MAX_STEPS = 10_000_000
"""A run longer than this is taken for a slip in dt."""


def number(name, value, unit="", *, above=-math.inf, least=-math.inf, most=math.inf):
    """Return `value` as a finite float within the given limits, or raise."""
    if type(value) is float and math.isfinite(value) and value > above and least <= value <= most:
        return value  # at once: a flight asks for its throttle in every step
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
    try:
        result = float(value)
    except OverflowError:
        result = math.inf
    if not (math.isfinite(result) and result > above and least <= result <= most):
        raise ValueError(f"{name} must be {allowed}; got {value!r}")
    return result


def is_column(value):
    """Whether a value is an array of one axis: a number for each row of an ensemble."""
    return getattr(value, "ndim", 0) == 1


def number_or_column(name, value, unit="", **limits):
    """Raise unless `value` is what `number` lets pass, or a column of such numbers (an array, a pandas Series)."""
    if not is_column(value):
        number(name, value, unit, **limits)
        return
    numbers = np.asarray(value)
    if numbers.dtype.kind not in "iuf":
        raise TypeError(f"{name} must be a column of finite numbers; got one of {numbers.dtype}")
    good = np.isfinite(numbers)
    for limit, within in (("above", np.greater), ("least", np.greater_equal), ("most", np.less_equal)):
        if limit in limits:
            good &= within(numbers, limits[limit])
    if not good.all():
        row = int(np.argmin(good))
        label = value.index[row] if hasattr(value, "iloc") else row
        number(f"{name} in row {label}", numbers[row].item(), unit, **limits)


def one_length(columns):
    """Raise unless all columns, given by name, have as many rows."""
    if len({len(column) for column in columns.values()}) > 1:
        rows = ", ".join(f"{name} has {len(column)}" for name, column in columns.items())
        raise ValueError(f"all columns must have the same number of rows: {rows}")


def array(name, value, unit=""):
    """Return a new float array, or raise unless `value` is a number or an array of numbers, finite or not."""
    try:
        result = np.array(value)
    except ValueError:  # rows of different lengths
        result = np.array(None)
    if result.dtype.kind not in "iuf":
        raise TypeError(f"{name} must be a number or an array of numbers{f' [{unit}]' if unit else ''}; got {value!r}")
    return result.astype(float)


def state(name, value, unit=""):
    """Return a finite float, or a float array of finite numbers: an initial value of a run."""
    if isinstance(value, Real):
        return number(name, value, unit)
    result = array(name, value, unit)
    if not np.all(np.isfinite(result)):
        raise ValueError(f"{name} must be finite everywhere [{unit}]; got {value!r}")
    return result


def instance(name, value, *kinds):
    """Raise unless `value` is of one of these classes."""
    if not isinstance(value, kinds):
        raise TypeError(f"{name} must be a {' or a '.join(kind.__name__ for kind in kinds)}; got {value!r}")


def function(name, value, *arguments):
    """Raise unless `value` can be called."""
    if not callable(value):
        raise TypeError(f"{name} must be a function of ({', '.join(arguments)}); got {value!r}")


def alternative_text(alt, what):
    """The text on one line, or raise unless it is one that says something."""
    if not isinstance(alt, str):
        raise TypeError(f"alt must be a text that says what the {what} shows; got {alt!r}")
    if not alt.strip():
        raise ValueError(f"alt must say what the {what} shows")
    return " ".join(alt.split())


def step_count(duration, dt):
    """Raise if a run of `duration` seconds in steps of `dt` would take more than MAX_STEPS steps."""
    steps, least = duration / dt, duration / MAX_STEPS
    if steps > MAX_STEPS:
        unit = 10.0 ** (math.floor(math.log10(least)) - 1)  # of the second digit, to round up to
        count = f"{steps:,.0f}" if steps < 1e15 else f"{steps:.1e}" if math.isfinite(steps) else "countless"
        raise ValueError(
            f"dt = {dt:g} s would take {count} steps or more; at most {MAX_STEPS:,} are allowed: "
            f"use a dt of at least {math.ceil(least / unit * (1 - 1e-9)) * unit:.2g} s"
        )


def digits(value):
    """A number for a message: three significant digits, and never fewer than stand before the point."""
    return f"{value:,.0f}" if abs(value) >= 999.5 else f"{value:.3g}"
