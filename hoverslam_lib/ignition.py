"""When to ignite: the optimum of the equation, and tables of what other times lead to."""

import math
from bisect import bisect_right
from collections.abc import Iterable
from dataclasses import dataclass
from functools import cache, partial
from operator import itemgetter

import numpy as np

from hoverslam_lib import _validate
from hoverslam_lib._roots import bracketed_root
from hoverslam_lib.descent import (
    Descent,
    TooManyStepsError,
    coast,
    finish,
    fly,
    require_one_descent,
    step_for,
    stride,
    walk,
)
from hoverslam_lib.integrators import dop8, step_function
from hoverslam_lib.trajectory import rounding

NEAR_ZERO = 1e-6
"""A hover no further from the ground than this share of the height at the start is taken for one at the ground."""

MOST_TRIES = 80_000
"""Steps that a search may try before it gives up: a million evaluations of the forces, some seconds."""


class NoSoftLanding(ValueError):
    """No ignition time lands this booster softly.

    Attributes
    ----------
    reason : str
        "thrust" (not above the dry weight), "too late" (already at t = 0), "too weak" (to stop at the ground: a burn
        stops far above it or climbs away, or only below it), "tank" (too small) or "never comes down".
    amount : float
        By how much: the thrust that is missing [N], the depth below the ground at which a burn from t = 0 would stop
        [m] (inf: see `hover_height`), the height at which the latest burn that stops above the ground does so [m] (inf
        if it climbs away), the propellant that is missing [kg], the speed above escape speed [m/s].
    """

    def __init__(self, reason, amount, message):
        super().__init__(reason, amount, message)
        self.reason, self.amount = reason, amount

    def __str__(self):
        return self.args[2]


@dataclass(frozen=True)
class Ignition:
    """The ignition that brings the booster to rest at height 0.

    Attributes
    ----------
    t_ignite, h_ignite, v_ignite : float
        Time [s], height [m] and velocity [m/s] at ignition.
    t_touchdown : float
        [s].
    propellant_left : float
        At touchdown [kg].
    """

    t_ignite: float
    h_ignite: float
    v_ignite: float
    t_touchdown: float
    propellant_left: float


def hover_height(descent, t_ignite, *, dt=0.02, method="rk4"):
    """Signed height [m] at which a burn from t_ignite on comes to rest, the ground being ignored.

    Above 0 the booster stops too high; below 0 it crashes, and this is how much height was missing. It falls steadily
    as ignition gets later, also where the touchdown speed has jumps, so it is the number to search on. It is always
    defined while thrust exceeds the dry weight: only here, thrust stays on at dry mass when the tank is empty.

    Parameters
    ----------
    descent : Descent
    t_ignite : float
        [s], at least 0.
    dt : float
        Step size [s].
    method : str or callable
        A key of `METHODS`, or a step function.

    Returns
    -------
    float
        inf if the booster climbs away and never stops, -inf if it would stop deeper than the air or the planet can be
        continued below the ground, nan for an ignition after the impact.

    Raises
    ------
    NoSoftLanding
        If thrust does not exceed the dry weight.
    """
    require_one_descent(descent)
    dt = _validate.number("dt", dt, "s", above=0)
    t_ignite = _validate.number("t_ignite", t_ignite, "s", least=0)
    _validate.step_count(min(t_ignite, descent.shortest_fall()), dt)
    step = step_for(descent, method, dt)
    _require_thrust(descent)
    march = partial(walk, step, dt=dt)
    nodes, end = coast(descent, t_ignite, march)
    return math.nan if end == "ground" else _stop(descent, *nodes[-1], march)[1]


class FreeFall:
    """The fall that all flights of a descent begin with: computed once, then any number of ignitions is tried.

    Parameters
    ----------
    descent : Descent
    dt : float
        Step size [s].
    method : str or callable
        A key of `METHODS`, or a step function.

    Raises
    ------
    ValueError, TypeError
        As `fly`, with t_ignite = None.
    """

    def __init__(self, descent, *, dt=0.02, method="rk4"):
        self.flight = fly(descent, None, dt=dt, method=method)
        self.descent, self._dt, self._step = descent, float(dt), step_function(method)
        self._march = partial(walk, self._step, dt=self._dt)
        self._nodes = np.stack([self.flight.t, self.flight.h, self.flight.v], axis=1)

    def fly(self, t_ignite, controller=None):
        """Return the Flight that `fly` returns."""
        return finish(self.descent, t_ignite, *self._until(t_ignite), controller, dt=self._dt, step=self._step)

    def hover_height(self, t_ignite):
        """Return the height [m] that `hover_height` returns."""
        _require_thrust(self.descent)
        nodes, end = self._until(t_ignite)
        return math.nan if end == "ground" else _stop(self.descent, *nodes[-1].tolist(), self._march)[1]

    def _until(self, t_ignite):
        """What `coast` returns: the last step before t_ignite is taken anew, to end on it."""
        t_ignite = _validate.number("t_ignite", t_ignite, "s", least=0)
        i = int(np.searchsorted(self.flight.t, t_ignite - rounding(0.0, t_ignite, self._dt)))
        if i == len(self._nodes):
            return self._nodes, "ground"
        before = max(i - 1, 0)
        start = tuple(self._nodes[before].tolist())
        last, end = coast(self.descent, t_ignite, self._march, start)
        return np.concatenate([self._nodes[:before], last]), end


def best_ignition(descent):
    """Find the ignition time that brings the booster to rest at height 0.

    The optimum of the equation, not of a step size: steps choose their own length, by an estimate of their error. While
    falling, the signed hover height falls strictly with the ignition time, so there is one root; a booster that starts
    upward may have more, and the latest is taken.

    Parameters
    ----------
    descent : Descent

    Returns
    -------
    Ignition

    Raises
    ------
    NoSoftLanding
        With its reason and by how much.
    ValueError
        If the search would take more than a million evaluations of the forces, as in a fall of years through dense air.
    """
    require_one_descent(descent)
    _require_thrust(descent)
    tries = iter(range(MOST_TRIES))
    # roughly first: most burns of a search only narrow it down
    coarse, fine = partial(stride, 1e-5, tries), partial(stride, 1e-12, tries)
    try:
        fall = _whole_fall(descent, fine)
        try:
            near = _solve(descent, fall, coarse)
        except NoSoftLanding:  # look more closely before believing it
            near = None
        found = _solve(descent, fall, fine, near)
    except TooManyStepsError as error:
        raise ValueError(_gave_up(descent, *error.node)) from None
    if found.propellant_left < -1e-9 * descent.booster.propellant_mass:  # a tank that is just right may miss a digit
        missing = -found.propellant_left
        burn_time = found.t_touchdown - found.t_ignite
        raise NoSoftLanding(
            "tank",
            missing,
            f"the tank is too small: the burn takes {burn_time:.4g} s, the tank is empty after "
            f"{descent.booster.burn_duration:.4g} s; {_validate.digits(missing)} kg of propellant are missing, "
            "and more to lift them",
        )
    return found


def ignition_table(t_ignite, *, dt, methods=("rk4", "symplectic_euler"), descent=None):
    """What becomes of each ignition time: the paper's Figures 7.7-7.9 for the right equation.

    Parameters
    ----------
    t_ignite : iterable of float
        Ignition times [s].
    dt : float
        Step size [s].
    methods : iterable of str
        Keys of `METHODS`.
    descent : Descent, optional
        The paper's, if left out.

    Returns
    -------
    pandas.DataFrame
        A row for each ignition time. Columns in two levels: the method, then "hover height [m]" (signed, see
        `hover_height`), "touchdown velocity [m/s]" (nan if there was no touchdown) and "outcome".
    """
    import pandas as pd

    descent = Descent() if descent is None else descent
    if not isinstance(t_ignite, Iterable) or isinstance(t_ignite, str):
        raise TypeError(f"t_ignite must be a collection of ignition times [s]; got {t_ignite!r}")
    if not isinstance(methods, Iterable) or isinstance(methods, str):
        raise TypeError(f"methods must be a collection of methods, such as ('rk4',); got {methods!r}")
    times, methods = list(t_ignite), list(methods)
    falls = [FreeFall(descent, dt=dt, method=method) for method in methods]
    rows = []
    for t in times:
        row = []
        for fall in falls:
            flight = fall.fly(t)
            v_touchdown = flight.touchdown[1] if flight.touchdown else math.nan
            row += [fall.hover_height(t), v_touchdown, flight.outcome]
        rows.append(row)
    quantities = ["hover height [m]", "touchdown velocity [m/s]", "outcome"]
    columns = pd.MultiIndex.from_product([methods, quantities])
    return pd.DataFrame(rows, index=pd.Index(times, name="t_ignite [s]"), columns=columns)


def _require_thrust(descent):
    booster = descent.booster
    weight = descent.weight(0.0, booster.dry_mass)
    missing = weight - booster.thrust
    if missing >= 0:
        short = f"{_validate.digits(missing)} N are missing" if missing else "it only equals it"
        if 1000 * booster.thrust > weight:
            short += f" (thrust is in N: did you mean {booster.thrust:g} kN = {1000 * booster.thrust:g} N?)"
        raise NoSoftLanding(
            "thrust", missing, f"thrust must exceed the dry weight on the ground, {weight:.6g} N: {short}"
        )


def _gave_up(descent, t, h, v):
    planet, lifts = descent.planet, descent.booster.thrust / descent.weight(0.0, descent.booster.dry_mass)
    air = f", air of {planet.surface_density:g} kg/m³ with a scale height of {planet.scale_height:g} m"
    return (
        f"no ignition time was found in {MOST_TRIES:,} steps: at t = {t:.4g} s, h = {h:.4g} m the booster still has "
        f"{v:.3g} m/s (start at {descent.height:g} m, thrust {lifts:.6g} dry weights"
        f"{air if planet.surface_density else ''}); start lower, with more thrust or in thinner air"
    )


def _whole_fall(descent, march):
    nodes, end = coast(descent, math.inf, march)
    if end == "space":
        h = descent.height
        excess = descent.velocity - math.sqrt(2 * descent.planet.gravity(h) * (descent.planet.radius + h))
        faster = f"{_validate.digits(excess)} m/s above" if excess > 0 else "at"
        message = f"the booster never comes down: it starts {faster} escape speed; let it climb more slowly"
        raise NoSoftLanding("never comes down", excess, message)
    return nodes


def _solve(descent, fall, march, near=None):
    """The optimum, given the fall and a way to take the steps of a burn: roughly, or from one near it to all digits."""
    t_end, close = fall[-1][0], 1e-13 if near else 1e-6  # a tenth of what the steps are good for
    f = descent.acceleration()

    @cache
    def lit(t_ignite):
        """State at ignition, with one partial step from the stored fall, and where a burn from there stops."""
        t, h, v = fall[bisect_right(fall, t_ignite, key=itemgetter(0)) - 1]
        h, v = dop8(f, t, h, v, t_ignite - t)
        return h, v, *_stop(descent, t_ignite, h, v, march)

    def missed_by(t_ignite):
        h = lit(t_ignite)[-1]
        return 0.0 if abs(h) < close * descent.height else h

    bracket = _near(lit, near.t_ignite, t_end) if near else None
    bracket = bracket or _bracket(missed_by, fall, descent.planet.deepest)
    t_ignite = bracketed_root(missed_by, *bracket, xtol=close * t_end)
    if near and abs(missed_by(t_ignite)) > NEAR_ZERO * descent.height:  # steep, or no root but a jump
        t_ignite = bracketed_root(missed_by, *bracket)
        if abs(missed_by(t_ignite)) > NEAR_ZERO * descent.height:
            # next to the jump rounding decides on which side a burn ends: look before it, further if need be
            before = (missed_by(max(t_ignite - s * t_end, 0.0)) for s in (1e-12, 1e-9, 1e-6))
            raise _too_weak(t_ignite, next((height for height in before if height > 0), bracket[2]))
    h, v, t_touchdown, _ = lit(t_ignite)
    left = descent.booster.propellant_mass - descent.booster.burn_rate * (t_touchdown - t_ignite)
    return Ignition(t_ignite, h, v, t_touchdown, left)


def _too_weak(t_ignite, height):
    """The stop jumps where gravity, which grows on the way down, just outweighs the thrust."""
    stops = f"stops {_validate.digits(height)} m above it or higher" if height < math.inf else "climbs away"
    return NoSoftLanding(
        "too weak",
        height,
        f"the engine is too weak to stop at the ground: lit up to {t_ignite:.6g} s, the booster {stops}; lit later, "
        "it does not stop above it; it needs more thrust",
    )


def _near(lit, t, t_end):
    """A narrow bracket with t near one end, if there is one: what `_bracket` returns, or None.

    A second later the hover is some v lower. Drag that takes most of the speed makes it less, hence the factor.
    """
    _, v, _, g = lit(t)
    other = min(max(t - 20 * g / v, 0.0), t_end) if v else t
    g_other = lit(other)[-1]
    return (t, other, g, g_other) if g * g_other <= 0 else None


def _bracket(missed_by, fall, deepest):
    """Two ignition times between which the hover height changes sign, and the hover heights there."""
    high, g_high = fall[-1][0], missed_by(fall[-1][0])
    t_top = next(t for t, _, v in fall if v <= 0)
    for t in sorted({t_top * k / 8 for k in range(9)}, reverse=True):  # back from the top, through an ascent if any
        g = missed_by(t)
        if g >= 0:
            return t, high, g, g_high
        high, g_high = t, g
    depth = _validate.digits(-g_high) if g_high > -math.inf else f"more than {_validate.digits(-deepest)}"
    start = fall[0][1]
    asked = f" (height is in m: did you mean {start:g} km?)" if start < 1000 and -g_high < 1000 * start else ""
    raise NoSoftLanding(
        "too late",
        -g_high,
        f"too late already at t = 0: a burn from the start on would stop {depth} m below the ground; "
        f"start higher or slower, or with more thrust{asked}",
    )


def _stop(descent, t, h, v, march):
    """When and where a full burn from (t, h, v) comes to rest, the ground ignored: (t, h). See `hover_height`."""
    deepest, t_empty = descent.planet.deepest, t + descent.booster.burn_duration
    burning, dry = descent.acceleration(throttle=1.0, since=t), descent.acceleration_when_dry()
    for f, t_end in ((burning, t_empty), (dry, math.inf)):
        for t, h, v, event in march(f, (t, h, v), t_end, ground=deepest):  # noqa: B020
            if event == "stop":
                return t, h
            if event == "ground":
                return t, -math.inf
            if v > 0 and f(t, h, 0.0) > 0:  # it climbs, and thrust outweighs it, ever more so
                return math.inf, math.inf
