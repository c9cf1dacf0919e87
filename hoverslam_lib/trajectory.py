"""A run of a one-step method over an interval of time."""

import math
from dataclasses import dataclass

import numpy as np

from hoverslam_lib import _validate
from hoverslam_lib.integrators import step_function


@dataclass(frozen=True, eq=False)
class Trajectory:
    """The states that a method computed, the initial one included.

    Attributes
    ----------
    t : ndarray, shape (n + 1,)
        Time [s].
    h, v : ndarray, shape (n + 1,) or (n + 1, ...)
        Height [m] and velocity [m/s]; further axes are those of the initial values.
    """

    t: np.ndarray
    h: np.ndarray
    v: np.ndarray

    def to_frame(self):
        """The run as a pandas DataFrame, one row a sample, units in the headers."""
        import pandas as pd

        columns = {"t [s]": self.t}
        for name, unit, values in (("h", "m", self.h), ("v", "m/s", self.v)):
            if values.ndim == 1:
                columns[f"{name} [{unit}]"] = values
            else:
                for i, column in enumerate(values.reshape(len(values), -1).T):
                    columns[f"{name}{i} [{unit}]"] = column
        return pd.DataFrame(columns)


def time_grid(t0, t_end, dt):
    """Yield t0 + dt, t0 + 2·dt, … and last t_end itself, so that the last step is as long as is left.

    Each is later than the one before, also where dt is lost in the last digit of t0. A remainder that is `rounding`
    makes no step of its own. t_end may be infinite; after ten million steps the grid raises ValueError.
    """
    steps, most = (t_end - t0 - rounding(t0, t_end, dt)) / dt, _validate.MAX_STEPS
    t, i = t0, 1
    while i < steps:
        if i > most:
            _validate.step_count(i * dt, dt)
        before, t = t, t0 + i * dt
        if t > before:
            yield t
        i += 1
    if t_end > t0:
        yield t_end


def rounding(t0, t_end, dt):
    """What is no time between t0 and t_end [s]: a billionth of a step, or some last digits where those are more."""
    return max(1e-9 * dt, 2 * math.ulp(max(abs(t0), abs(t_end) if t_end < math.inf else 0.0)))


def integrate(f, h0, v0, *, dt, t_end, t0=0.0, method="rk4"):
    """Solve ḧ = f(t, h, ḣ) from t0 to t_end in steps of dt; the last is shortened to end on t_end.

    Parameters
    ----------
    f : callable
        ``f(t, h, v)`` → acceleration [m/s²], a float, or an array of the shape of h.
    h0, v0 : float or array_like
        Height [m] and velocity [m/s] at t0.
    dt : float
        Step size [s], greater than 0.
    t_end, t0 : float
        End and start [s].
    method : str or callable
        A key of `METHODS`, or a step function of one's own.

    Returns
    -------
    Trajectory

    Raises
    ------
    ValueError, TypeError
        If an argument is not finite, dt is not greater than 0, t_end lies before t0, the method is unknown, the run
        would take more than ten million steps, or f or a step function of one's own returns something else than it
        should.
    """
    dt = _validate.number("dt", dt, "s", above=0)
    t = t0 = _validate.number("t0", t0, "s")
    t_end = _validate.number("t_end", t_end, "s", least=t0)
    _validate.step_count(t_end - t0, dt)
    step = step_function(method)
    _validate.function("f", f, "t", "h", "v")
    h, v = _validate.state("h0", h0, "m"), _validate.state("v0", v0, "m/s")
    if np.shape(h) != np.shape(v):
        try:
            h, v = (x.copy() for x in np.broadcast_arrays(h, v))
        except ValueError:
            raise ValueError(
                f"h0 and v0 do not go together: their shapes are {np.shape(h)} and {np.shape(v)}"
            ) from None

    ts, hs, vs = [t], [h], [v]
    try:
        for t_next in time_grid(t0, t_end, dt):
            h, v = step(f, t, h, v, t_next - t)
            t = t_next
            ts.append(t)
            hs.append(h)
            vs.append(v)
        run = Trajectory(np.array(ts), np.array(hs), np.array(vs))
    except (TypeError, ValueError):
        for moment in ((ts[0], hs[0], vs[0]), (t, h, v)):
            _require_acceleration(f, *moment)
            require_state(step, f, *moment, dt)
        raise
    if np.iscomplexobj(run.v):
        t = next(t for t, v in zip(ts, vs, strict=True) if np.iscomplexobj(v))
        raise ValueError(f"from t = {t:g} s on v is a complex number: is a root of a negative number taken in f?")
    return run


def _require_acceleration(f, t, h, v):
    """Raise if it is f that spoils a step from (t, h, v)."""
    said = f(t, h, v)
    if np.asarray(said).dtype.kind not in "iufc" or np.shape(said) not in ((), np.shape(h)):
        shape = f"one number, or an array of shape {np.shape(h)}" if np.ndim(h) else "one number"
        missing = ": is a `return` missing?" if said is None else ""
        raise TypeError(f"f(t, h, v) must return the acceleration [m/s²], {shape}; got {said!r}{missing}") from None


def require_state(step, f, t, h, v, dt):
    """Raise if it is a step function of one's own that spoils a step from (t, h, v)."""
    made = step(f, t, h, v, dt)
    if not isinstance(made, tuple | list) or [np.shape(x) for x in made] != 2 * [np.shape(h)]:
        raise TypeError(f"the step function must return h and v, as they were given; got {made!r}") from None
