"""Ensembles: one flight for each row of a descent with columns, many at once.

The lanes of a block march in lock-step, each on the grid of its own flight, and retire as their flights end. The step
in which that happens is recorded, and all events of a phase are located together when it is over, by the same root
search on the step itself as in `fly`. Within a phase only a turn is located at once that the flight outlives.
"""

import itertools
import math
import sys
import time
from dataclasses import dataclass
from functools import partial

import numpy as np

from hoverslam_lib import _validate
from hoverslam_lib._roots import bracketed_roots
from hoverslam_lib.descent import (
    CRASH,
    LONG_WALK,
    OUT_OF_PROPELLANT,
    OUTCOMES,
    SOFT_LANDING,
    SOFT_SPEED,
    STOPPED_TOO_HIGH,
    Descent,
    StepTooLargeError,
    coast,
    end_of_walk,
    never_comes_down,
    speed_after_fall,
    walk,
)
from hoverslam_lib.integrators import step_function

BLOCK = 16_384
"""Flights that march together: the arrays of a step fit into the processor's cache."""

HEADERS = ("hover height [m]", "touchdown time [s]", "touchdown velocity [m/s]", "propellant left [kg]")


def fly_all(descent, t_ignite, *, dt=0.1, method="rk4", controller=None, progress=None):
    """Fly one flight for each row of the columns of a descent, and say what became of each.

    Row i is what `fly` and `hover_height` give for row i, to rounding, whatever the other rows are. Where only
    t_ignite is a column, the fall that all flights begin with is computed once.

    Parameters
    ----------
    descent : Descent
        Any of its numbers may be a column: an array of length n, or a pandas Series.
    t_ignite : float, array_like of shape (n,), or None
        Ignition time [s], at least 0, as in `fly`; may be a column.
    dt : float
        Step size [s], greater than 0.
    method : str or callable
        A key of `METHODS`, or a step function of one's own.
    controller : callable, optional
        ``controller(t, h, v, mass)`` → throttle in [0, 1], as in `fly`, but called with arrays: one number for each
        flight that is still under way. It must not remember anything of the flights. Of a law for numbers,
        ``np.vectorize(law, otypes=[float])`` makes one for arrays.
    progress : bool, optional
        Whether to print how far it is; if left out, only on a terminal.

    Returns
    -------
    pandas.DataFrame
        One row a flight, with the index of a pandas Series among the columns, else 0, 1, 2, …

        - "outcome": one of `OUTCOMES`, as a categorical
        - "hover height [m]": signed, as `hover_height`; nan where thrust does not exceed the dry weight. With a
          controller the height of `Flight.hover`, nan where the booster did not come to rest.
        - "touchdown time [s]", "touchdown velocity [m/s]": nan without a touchdown
        - "propellant left [kg]": at the end of the flight

    Raises
    ------
    ValueError, TypeError
        As `fly`, and with the row; also if columns differ in length or in their pandas index.
    """
    import pandas as pd

    if not isinstance(descent, Descent):
        raise TypeError(f"descent must be a Descent; got {descent!r}")
    if isinstance(t_ignite, list | tuple | range):
        t_ignite = np.array(t_ignite)
    if t_ignite is not None:
        _validate.number_or_column("t_ignite", t_ignite, "s", least=0)
    dt = _validate.number("dt", dt, "s", above=0)
    if controller is not None and not callable(controller):
        raise TypeError(f"controller must be a function of (t, h, v, mass); got {controller!r}")
    columns = descent.columns | ({"t_ignite": t_ignite} if _validate.is_column(t_ignite) else {})
    _validate.one_length(columns)
    index = _index(columns)
    n = len(index)
    t_ignite = np.broadcast_to(math.inf if t_ignite is None else np.asarray(t_ignite, dtype=float), n)
    solver = _Solver(step_function(method), dt, controller)
    fall = None if descent.columns or not n else _Fall(descent, t_ignite.max(), solver)

    table = _Table(np.zeros(n, dtype=np.int8), *np.full((4, n), math.nan))
    for start in _shown_progress(range(0, n, BLOCK), n, progress):
        block = slice(start, start + BLOCK)
        try:
            _fly_block(descent.rows(block), t_ignite[block], fall, solver, table.rows(block))
        except _InRow as failed:
            raise type(failed.error)(f"in row {index[start + failed.lane]}: {failed.error}") from None
    outcome = pd.Categorical.from_codes(table.outcome, categories=OUTCOMES)
    numbers = (table.height, table.time, table.velocity, table.left)
    return pd.DataFrame({"outcome": outcome, **dict(zip(HEADERS, numbers, strict=True))}, index=index)


def _index(columns):
    """The pandas index of the columns, or a new one."""
    import pandas as pd

    given = [(name, column.index) for name, column in columns.items() if isinstance(column, pd.Series)]
    for name, index in given[1:]:
        if not index.equals(given[0][1]):
            raise ValueError(f"the columns {given[0][0]} and {name} differ in their pandas index")
    return given[0][1] if given else pd.RangeIndex(len(next(iter(columns.values()), [0])))


def _shown_progress(starts, n, shown):
    """Yield the starts; print how far it is where that is asked for, else on a terminal and if it takes long."""
    begun = time.monotonic()
    for start in starts:
        if shown or (shown is None and sys.stderr.isatty() and time.monotonic() - begun > 1):
            print(f"\rfly_all: {start:,} of {n:,} flights", end="", file=sys.stderr, flush=True)
            shown = True
        yield start
    if shown:
        print(f"\rfly_all: {n:,} of {n:,} flights", file=sys.stderr)


class _InRow(Exception):
    """An error in one lane of a block."""

    def __init__(self, lane, error):
        super().__init__(lane, error)
        self.lane, self.error = int(lane), error


@dataclass
class _Table:
    """What became of each flight, column by column."""

    outcome: np.ndarray  # place in OUTCOMES
    height: np.ndarray
    time: np.ndarray
    velocity: np.ndarray
    left: np.ndarray

    def rows(self, which):
        return _Table(*(column[which] for column in vars(self).values()))

    def end(self, lanes, hovered):
        """Flights that end with an empty tank above the ground."""
        stopped, out = OUTCOMES.index(STOPPED_TOO_HIGH), OUTCOMES.index(OUT_OF_PROPELLANT)
        self.outcome[lanes], self.left[lanes] = np.where(hovered, stopped, out), 0.0

    def touch_down(self, lanes, t, v, left):
        soft, crash = OUTCOMES.index(SOFT_LANDING), OUTCOMES.index(CRASH)
        self.outcome[lanes] = np.where(abs(v) <= SOFT_SPEED, soft, crash)
        self.time[lanes], self.velocity[lanes], self.left[lanes] = t, v, left

    def fall(self, lanes, planet, t, h, v, left):
        """Where the engine ends above the ground: those touch down whose fall from there is soft, a mask."""
        speed = speed_after_fall(planet, h, v)
        soft = speed <= SOFT_SPEED
        t_ground = t + (v + speed) / planet.gravity(0.0)
        self.touch_down(lanes[soft], t_ground[soft], 0.0 - speed[soft], left[soft])
        return soft


@dataclass(frozen=True)
class _Solver:
    """How the equations are solved: the settings that all flights share."""

    method: object
    dt: float
    controller: object = None

    def step(self, f, t, h, v, length):
        """One step of all lanes; numbers that overflow are found by whoever looks at the result."""
        with np.errstate(all="ignore"):
            return self.method(f, t, h, v, length)

    def part(self, f, t, h, v, s):
        """A part of a step, which may have no length: an implicit method would divide by zero."""
        h_end, v_end = self.step(f, t, h, v, np.where(s > 0, s, self.dt))
        return np.where(s > 0, h_end, h), np.where(s > 0, v_end, v)

    def turn(self, f, t, h, v, length, v_end):
        """How long after the start of a step v is 0 [s], and the height there [m]."""
        s = bracketed_roots(lambda s: self.step(f, t, h, v, s)[1], 0.0, length, v, v_end, xtol=1e-14 * length)
        return s, self.part(f, t, h, v, s)[0]

    def ground(self, f, t, h, v, length, h_end, lanes):
        """How long after the start of a step h is 0 [s], and the velocity there [m/s]."""
        s = bracketed_roots(lambda s: self.step(f, t, h, v, s)[0], 0.0, length, h, h_end)
        _, v_end = self.part(f, t, h, v, s)
        self.require(v_end <= 0, lanes, "a climb ends on the ground")
        return s, v_end

    def past_turns(self, f, turned, t, h, v, length, h_end, v_end):
        """Divide the steps of some lanes at their turns.

        f is the acceleration of these lanes alone; all the rest is of the whole block, and what is returned too: the
        length of the first part of each step, the start (t, h, v, length) of its last part, and the end of that.
        """
        s, top = self.turn(f, t, h[turned], v[turned], length[turned], v_end[turned])
        t, h, v, first, last, h_end, v_end = (np.array(x) for x in (t + 0 * h, h, v, length, length, h_end, v_end))
        t[turned], h[turned], v[turned], first[turned], last[turned] = t[turned] + s, top, 0.0, s, last[turned] - s
        h_end[turned], v_end[turned] = self.part(f, t[turned], top, np.zeros_like(top), last[turned])
        return first, (t, h, v, last), h_end, v_end

    def require(self, good, lanes, what):
        if not good.all():
            error = StepTooLargeError(f"{what}: dt = {self.dt:g} s is too large for this method")
            raise _InRow(lanes[np.argmin(good)], error)


def _at(places, column):
    return column[places] if np.ndim(column) else np.full(len(places), column)


class _Steps:
    """Steps in which something happens, recorded until all are looked at together."""

    def __init__(self):
        self._recorded = []

    def __bool__(self):
        return bool(self._recorded)

    def record(self, which, *columns):
        """Keep some lanes of a block, given as a mask; a column may be one number for all."""
        places = np.flatnonzero(which)
        if places.size:
            self._recorded.append([_at(places, column) for column in columns])

    def together(self):
        return [np.concatenate(columns) for columns in zip(*self._recorded, strict=True)]


# ---- one phase, in which the throttle does not change -------------------------------------------------------------


def _falling(descent):
    return descent.acceleration()


def _burning(descent):
    return descent.acceleration(throttle=1.0)


def _dry(descent):
    return descent.acceleration_when_dry()


@dataclass
class _Ends:
    """How a phase ends for each lane."""

    s: np.ndarray  # after so many seconds
    h: np.ndarray
    v: np.ndarray
    touch_s: np.ndarray  # when it meets the ground, nan if it does not
    touch_v: np.ndarray
    stopped: np.ndarray  # whether it ends because the fall stops
    sunk: np.ndarray  # whether it ends because it is below its floor


class _March:
    """Lanes that march through a phase until each has had its time, is below its floor, or, if `stops`, falls no more.

    `phase` makes the acceleration of a descent, with t counted from the start of the phase.
    """

    def __init__(self, phase, descent, lanes, h, v, duration, floor, solver, *, stops, ground=True):
        n = len(lanes)
        self._phase, self._whole, self._lanes, self._solver, self._stops = phase, descent, lanes, solver, stops
        self._halts, self._crossings = _Steps(), _Steps()
        self._descent, self._place, self._above = descent, np.arange(n), np.full(n, ground)
        self._h, self._v, self._duration, self._floor = h, v, duration, floor
        never = np.full(n, math.nan)
        self.ends = _Ends(np.zeros(n), h.copy(), v.copy(), never, never.copy(), *np.zeros((2, n), dtype=bool))

    def run(self):
        f, h, v, ends, dt = self._phase(self._descent), self._h, self._v, self.ends, self._solver.dt
        lowest = self._floor.max(initial=-math.inf)
        if self._stops and np.any(v == 0):
            ends.stopped = (v == 0) & (f(0.0, h, v) >= 0)  # at rest, and thrust is not below weight
        gone = ends.stopped | (self._duration <= 0)
        for k in itertools.count():
            if gone.any():
                self._keep(np.flatnonzero(~gone))
                f, lowest = self._phase(self._descent), self._floor.max(initial=-math.inf)
            if not self._place.size:
                break
            t, h, v = k * dt, self._h, self._v
            if k == LONG_WALK:
                self._look_ahead(t)
            _validate.step_count(t, dt)
            ending = self._duration - t <= dt * (1 + 1e-9)
            length = np.where(ending, self._duration - t, dt) if ending.any() else dt
            self._h, self._v = self._solver.step(f, t, h, v, length)
            quiet = length is dt and v.max() < 0 and self._v.max() < 0 and self._h.min() > lowest
            if quiet and not (self._above & (self._h <= 0)).any():
                gone = ending  # nothing happens, to nobody
            else:
                gone = self._look(t, h, v, np.broadcast_to(length, h.shape)) | ending
                self._end(np.flatnonzero(gone), t + length)
        self._locate()
        return ends

    def _keep(self, which):
        self._descent = self._descent.rows(which)
        for name in ("_place", "_above", "_h", "_v", "_duration", "_floor"):
            setattr(self, name, getattr(self, name)[which])

    def _look_ahead(self, t):
        """Raise if the highest lane would take too many steps, as `walk` does."""
        i = int(np.argmax(self._h))
        h, v, end, floor = (float(column[i]) for column in (self._h, self._v, self._duration, self._floor))
        f = self._phase(self._descent.rows(i))
        if not (v > 0 and f(t, h, 0.0) > 0):  # else it climbs to the end
            end = end_of_walk(f, (t, h, v), end, floor)
        _validate.step_count(end, self._solver.dt)

    def _look(self, t, h, v, length):
        """Record what happens to whom in a step; return whose march is over."""
        solver, start = self._solver, (t, h, v, length)
        solver.require(np.isfinite(self._h + self._v), self._lanes[self._place], "the numbers overflow")
        stop, turned = (v < 0) & (self._v >= 0), (v > 0) & (self._v <= 0)
        if not self._stops:
            stop, turned = np.zeros_like(stop), stop | turned
        if turned.any():
            which = np.flatnonzero(turned)
            f = self._phase(self._descent.rows(which))
            first, start, self._h, self._v = solver.past_turns(f, which, *start, self._h, self._v)
            dips = turned & self._above & (start[1] < 0)
            self._crossings.record(dips, self._place, t, h, v, first, start[1])
            self._above &= ~dips
        self._halts.record(stop, self._place, *start, self._v, self._above)
        crosses = self._above & (self._h <= 0) & ~stop
        self._crossings.record(crosses, self._place, *start, self._h)
        self._above = self._above & ~crosses
        self._require_return()
        sunk = ((start[1] <= self._floor) | (self._h <= self._floor)) & ~stop
        if sunk.any():
            self.ends.sunk[self._place[sunk]] = True
        return stop | sunk

    def _require_return(self):
        if np.any(self._duration == math.inf) and np.any(self._v > 0):
            lost = (self._duration == math.inf) & self._descent.escapes(self._h, self._v)
            if lost.any():
                i = int(np.argmax(lost))
                raise _InRow(self._lanes[self._place[i]], never_comes_down(self._h[i], self._v[i]))

    def _end(self, gone, t):
        there = self._place[gone]
        self.ends.s[there] = _at(gone, t)
        self.ends.h[there], self.ends.v[there] = self._h[gone], self._v[gone]

    def _locate(self):
        """Find when and where the recorded stops and crossings of the ground are."""
        solver, ends = self._solver, self.ends
        if self._halts:
            place, t, h, v, length, v_end, above = self._halts.together()
            s, top = solver.turn(self._phase(self._whole.rows(place)), t, h, v, length, v_end)
            ends.s[place], ends.h[place], ends.v[place], ends.stopped[place] = t + s, top, 0.0, True
            self._crossings.record(above & (top < 0), place, t, h, v, s, top)
        if self._crossings:
            place, t, *step = self._crossings.together()
            f = self._phase(self._whole.rows(place))
            s, ends.touch_v[place] = solver.ground(f, t, *step, self._lanes[place])
            ends.touch_s[place] = t + s


# ---- a block of flights -------------------------------------------------------------------------------------------


class _Fall:
    """The nodes of the one fall that flights begin with which differ in their ignition alone."""

    def __init__(self, descent, t_end, solver):
        nodes, end = coast(descent, t_end, partial(walk, solver.method, dt=solver.dt))
        if end == "space":
            raise never_comes_down(*nodes[-1][1:])
        self._nodes = np.array(nodes).T

    def before(self, t_ignite):
        """The last node before each ignition: t, h, v; after the impact the impact, where the march ends at once."""
        return self._nodes[:, np.maximum(np.searchsorted(self._nodes[0], t_ignite) - 1, 0)]


def _column(value, n):
    return np.broadcast_to(np.asarray(value, dtype=float), n)


def _fly_block(descent, t_ignite, fall, solver, table):
    """Fly all flights of a block, and write what becomes of them into the table."""
    n, planned = len(t_ignite), (0.0, descent.height, descent.velocity)
    least = np.minimum(descent.shortest_fall(), t_ignite + descent.booster.burn_duration)
    _validate.step_count(np.max(least, where=np.isfinite(least), initial=0.0), solver.dt)
    t, h, v = fall.before(t_ignite) if fall else (_column(x, n) for x in planned)
    phase = _falling, descent, np.arange(n), h, v, t_ignite - t, np.zeros(n)
    ends = _March(*phase, solver, stops=False).run()
    landed = np.isfinite(ends.touch_s)
    full = _column(descent.booster.propellant_mass, n)[landed]
    table.touch_down(landed, (t + ends.touch_s)[landed], ends.touch_v[landed], full)
    lit = np.flatnonzero(~landed)
    ignition = descent.rows(lit), lit, t_ignite[lit], ends.h[lit], ends.v[lit]
    if solver.controller is None:
        _burn(*ignition, solver, table)
    else:
        _Steered(*ignition, solver, table).run()


def _burn(descent, lanes, t, h, v, solver, table):
    """Burn at full thrust: the hover height, and what becomes of the flight on the way there."""
    n, booster = len(lanes), descent.booster
    strong = _column(booster.thrust, n) > descent.weight(0.0, booster.dry_mass)
    floor = np.where(strong, descent.planet.deepest, 0.0)  # without a hover height, the ground ends it
    phase = _burning, descent, lanes, h, v, _column(booster.burn_duration, n), floor
    ends = _March(*phase, solver, stops=True).run()
    table.height[lanes[strong]] = _hover_heights(descent, lanes, ends, floor, solver)[strong]

    def burnt(s):
        return _column(booster.propellant_mass, n) - _column(booster.burn_rate, n) * s

    down = np.isfinite(ends.touch_s)
    table.touch_down(lanes[down], (t + ends.touch_s)[down], ends.touch_v[down], burnt(ends.touch_s)[down])
    up = np.flatnonzero(~down)
    left = np.where(ends.stopped, burnt(ends.s), 0.0)
    table.end(lanes[up], ends.stopped[up])
    table.fall(lanes[up], descent.rows(up).planet, (t + ends.s)[up], ends.h[up], ends.v[up], left[up])


def _hover_heights(descent, lanes, ends, floor, solver):
    """The hover height of each lane after its burn: see `hover_height`."""
    heights = np.where(ends.stopped, ends.h, np.where(ends.sunk, -math.inf, math.inf))
    dry = np.flatnonzero(~ends.stopped & ~ends.sunk & (ends.v <= 0) & (floor < 0))
    forever = np.full(len(dry), math.inf)
    phase = _dry, descent.rows(dry), lanes[dry], ends.h[dry], ends.v[dry], forever, floor[dry]
    ends = _March(*phase, solver, stops=True, ground=False).run()
    heights[dry] = np.where(ends.stopped, ends.h, -math.inf)
    return heights


class _Steered:
    """Lanes that burn as the controller says, from ignition to the end of their flights."""

    def __init__(self, descent, lanes, t, h, v, solver, table):
        self._descent, self._lanes, self._t, self._h, self._v = descent, lanes, t, h, v
        self._mass = _column(descent.booster.initial_mass, len(lanes))
        self._place, self._whole = np.arange(len(lanes)), (descent, lanes)
        self._solver, self._table, self._crossings = solver, table, _Steps()

    def run(self):
        dt, ignition = self._solver.dt, self._t
        for k in itertools.count():
            if not self._place.size:
                break
            _validate.step_count(k * dt, dt)
            self._t = ignition[self._place] + k * dt
            gone = self._step()
            if gone.any():
                keep = np.flatnonzero(~gone)
                self._descent = self._descent.rows(keep)
                for name in ("_lanes", "_place", "_h", "_v", "_mass"):
                    setattr(self, name, getattr(self, name)[keep])
        self._locate()

    def _step(self):
        """One step at one throttle; return whose flight is over."""
        descent, h, v, mass, solver = self._descent, self._h, self._v, self._mass, self._solver
        throttle = _throttles(solver.controller, self._t, h, v, mass, self._lanes)
        f = descent.acceleration(throttle=throttle, mass=mass)
        rate, dry_mass = throttle * descent.booster.burn_rate, descent.booster.dry_mass
        lasts = np.divide(mass - dry_mass, rate, out=np.full(rate.shape, math.inf), where=rate > 0)
        empty, length = lasts <= solver.dt, np.minimum(lasts, solver.dt)

        self._h, self._v = solver.step(f, 0.0, h, v, length)
        solver.require(np.isfinite(self._h + self._v), self._lanes, "the numbers overflow")
        start, stop = (0.0, h, v, length), (v < 0) & (self._v >= 0)
        gone = self._hover((v == 0) & (throttle > 0) & (f(0.0, h, v) >= 0), 0.0, h, mass)
        turned = (stop | ((v > 0) & (self._v <= 0))) & ~gone
        if turned.any():
            which = np.flatnonzero(turned)
            f = descent.rows(which).acceleration(throttle=throttle[which], mass=mass[which])
            first, start, self._h, self._v = solver.past_turns(f, which, *start, self._h, self._v)
            dips = turned & (start[1] < 0)
            self._crossings.record(dips, self._place, self._t, throttle, mass, 0.0, h, v, first, start[1])
            gone |= dips
            gone |= self._hover(stop & (throttle > 0) & ~gone, first, start[1], mass - rate * first)
        crosses = (self._h <= 0) & ~gone
        self._crossings.record(crosses, self._place, self._t, throttle, mass, *start, self._h)
        gone |= crosses
        self._mass = mass - rate * length
        self._run_dry(np.flatnonzero(empty & ~gone), length)
        return gone | empty

    def _hover(self, hovering, s, h, mass):
        """Note who hovers, s after the start of the step; return who then falls softly, the engine cut."""
        landed = np.zeros_like(hovering)
        if hovering.any():
            which = np.flatnonzero(hovering)
            t, h, mass = self._t[which] + np.broadcast_to(s, hovering.shape)[which], h[which], mass[which]
            descent, lanes, heights = self._descent.rows(which), self._lanes[which], self._table.height
            soft = self._table.fall(lanes, descent.planet, t, h, 0.0 * h, mass - descent.booster.dry_mass)
            heights[lanes] = np.where(soft | np.isnan(heights[lanes]), h, heights[lanes])
            landed[which[soft]] = True
        return landed

    def _run_dry(self, which, length):
        lanes, t = self._lanes[which], self._t[which] + length[which]
        self._table.end(lanes, np.isfinite(self._table.height[lanes]))
        self._table.fall(
            lanes, self._descent.rows(which).planet, t, self._h[which], self._v[which], np.zeros(len(which))
        )

    def _locate(self):
        """Find when and where the recorded crossings of the ground are."""
        if self._crossings:
            descent, lanes = self._whole
            place, now, throttle, mass, *step = self._crossings.together()
            booster = descent.rows(place).booster
            f = descent.rows(place).acceleration(throttle=throttle, mass=mass)
            s, v = self._solver.ground(f, *step, lanes[place])
            s = step[0] + s
            left = mass - throttle * booster.burn_rate * s - booster.dry_mass
            self._table.touch_down(lanes[place], now + s, v, left)


def _throttles(controller, t, h, v, mass, lanes):
    """Ask the controller, and check what it says."""
    state = [x.view() for x in (t, h, v, mass)]
    for x in state:
        x.flags.writeable = False
    try:
        said = controller(*state)
    except (TypeError, ValueError) as error:
        error.add_note(
            "fly_all calls the controller with arrays, a number for each flight. If it is a law for numbers, "
            "np.vectorize(law, otypes=[float]) makes one for arrays of it."
        )
        raise
    throttle, name = np.asarray(said), "controller(t, h, v, mass)"
    if isinstance(controller, np.vectorize) and throttle.dtype.kind in "iu":
        raise TypeError(
            f"{name} returned whole numbers, because the first of them was one: np.vectorize(law, otypes=[float])"
        )
    if throttle.dtype.kind not in "iuf" or throttle.shape not in ((), h.shape):
        raise TypeError(f"{name} must return a number for each flight, an array of shape {h.shape}; got {said!r}")
    good = np.broadcast_to((throttle >= 0) & (throttle <= 1), h.shape)
    if not good.all():
        lane = int(np.argmin(good))
        try:
            _validate.number(name, float(np.broadcast_to(throttle, h.shape)[lane]), "throttle", least=0, most=1)
        except ValueError as error:
            raise _InRow(lanes[lane], error) from None
    return np.array(np.broadcast_to(throttle, h.shape), dtype=float)
