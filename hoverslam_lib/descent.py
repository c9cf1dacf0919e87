"""The descent of a booster, and the flight that an ignition time makes of it."""

import math
from contextlib import suppress
from dataclasses import dataclass
from functools import cached_property, partial

import numpy as np

from hoverslam_lib import _columns, _validate
from hoverslam_lib._roots import bracketed_root
from hoverslam_lib.booster import FALCON_9, FALCON_9_LANDING_BURN, Booster
from hoverslam_lib.integrators import dop8, dop8_and_error, step_function
from hoverslam_lib.planet import EARTH, Planet
from hoverslam_lib.trajectory import require_state, time_grid

SOFT_SPEED = 2.0
"""Touching down at this speed or slower is a soft landing [m/s]."""

SOFT_LANDING, CRASH = "soft landing", "crash"
STOPPED_TOO_HIGH, OUT_OF_PROPELLANT = "stopped too high", "out of propellant"
OUTCOMES = (SOFT_LANDING, CRASH, STOPPED_TOO_HIGH, OUT_OF_PROPELLANT)
"""What can become of a flight."""

LONG_WALK = 100_000
"""After so many steps a walk looks ahead, with as many evaluations of the forces at most, whether it ends."""


@dataclass(frozen=True)
class Descent:
    """A booster above a planet, before anything is said of its engine.

    Its numbers, and those of booster and planet, may be columns: arrays of one length, with one number for each row
    of an ensemble. `fly` flies one descent, `fly_all` all rows. Two descents are equal if all their numbers are; one
    with columns has no hash.

    Parameters
    ----------
    booster : Booster
    planet : Planet
    height : float or ndarray, shape (n,)
        h at t = 0 [m], greater than 0.
    velocity : float or ndarray, shape (n,)
        v = dh/dt at t = 0 [m/s], negative while falling.
    """

    booster: Booster = FALCON_9
    planet: Planet = EARTH
    height: float = 150e3
    velocity: float = -2000.0

    def __post_init__(self):
        for name, kind in (("booster", Booster), ("planet", Planet)):
            if not isinstance(getattr(self, name), kind):
                raise TypeError(f"{name} must be a {kind.__name__}; got {getattr(self, name)!r}")
        _validate.number_or_column("height", self.height, "m", above=0)
        _validate.number_or_column("velocity", self.velocity, "m/s")
        _validate.one_length(self.columns)

    __eq__, __repr__ = _columns.equal, _columns.shown

    @cached_property
    def columns(self):
        """Those of the numbers that are columns: a dictionary of name, as ``booster.thrust``, and column."""
        parts = (("booster.", self.booster), ("planet.", self.planet), ("", self))
        return {prefix + name: column for prefix, part in parts for name, column in _columns.columns(part).items()}

    def rows(self, which):
        """The descent of some rows of the columns, given as a slice or an array of their numbers.

        Of one row, given its number, it is a descent of floats, as `fly` takes it; without columns it is this one.
        """
        if not self.columns:
            return self
        booster, planet = _columns.rows(self.booster, which), _columns.rows(self.planet, which)
        return _columns.rows(self, which, booster=booster, planet=planet)

    def drag(self, h, v):
        """Force of the air [N] at height h [m] and velocity v [m/s], upward positive: it opposes the motion."""
        return -self._drag_area * self.planet.air_density(h) * abs(v) * v

    def weight(self, h, mass):
        """Weight [N] of a mass [kg] at height h [m]: positive; it acts downward."""
        return mass * self.planet.gravity(h)

    def acceleration(self, *, throttle=0.0, mass=None, since=0.0):
        """Return f(t, h, v) [m/s²] for one phase of the flight: a time in which the throttle does not change.

        This is the sum of the forces, each with its own sign, over the mass: f = (thrust + drag - weight) / mass.

        Parameters
        ----------
        throttle : float
            0 for the engine off (the default), 1 for full thrust.
        mass : float, optional
            At the time `since` [kg]; the mass with a full tank if it is left out.
        since : float
            When the phase begins [s]. From then on the mass falls by throttle·burn_rate each second.
        """
        thrust, rate = throttle * self.booster.thrust, throttle * self.booster.burn_rate
        mass = self.booster.initial_mass if mass is None else mass
        # this is where a flight spends its time: drag is written out, and what does not change is looked up once
        drag_area, density, gravity = self._drag_area, self.planet.air_density_law(), self.planet.gravity

        def coasting(t, h, v):
            return -drag_area * density(h) * abs(v) * v / mass - gravity(h)

        def burning(t, h, v):
            return (thrust - drag_area * density(h) * abs(v) * v) / (mass - rate * (t - since)) - gravity(h)

        return burning if _validate.is_column(throttle) or throttle else coasting

    def acceleration_when_dry(self):
        """Return f(t, h, v) [m/s²] at full thrust and at the dry mass, which stays: see `hover_height`."""
        thrust, mass, drag_area = self.booster.thrust, self.booster.dry_mass, self._drag_area
        density, gravity = self.planet.air_density_law(), self.planet.gravity
        return lambda t, h, v: (thrust - drag_area * density(h) * abs(v) * v) / mass - gravity(h)

    @cached_property
    def _drag_area(self):
        return 0.5 * self.booster.drag_coefficient * self.booster.area

    def escapes(self, h, v):
        """Whether a booster that coasts upward can never turn round, for certain.

        The air above takes at most ½·C_D·A·ρ·H·v² of its energy, H being the scale height.
        """
        lost = self._drag_area * self.planet.air_density(h) * self.planet.scale_height / self.booster.initial_mass
        return (v > 0) & (v * v * (0.5 - lost) >= self.planet.gravity(h) * (self.planet.radius + h))

    def shortest_fall(self):
        """A time before which no flight can end on the ground [s]: no air, and gravity everywhere as strong as there.

        Of an ascent only the fall from the start on counts, because air can make the rest as short as it likes.
        """
        down = (abs(self.velocity) - self.velocity) / 2
        fall = 2 * self.height / (down + (down**2 + 2 * self.planet.gravity(0.0) * self.height) ** 0.5)
        escapes = self.escapes(self.height, self.velocity)
        return np.where(escapes, math.inf, fall) if _validate.is_column(escapes) else math.inf if escapes else fall


def speed_after_fall(planet, h, v=0.0):
    """Speed at which a booster touches down that falls without engine and without air: √(v² + 2·g·h).

    This is what becomes of a booster whose engine is cut, or whose tank is empty, a little above the ground. g is
    that of the ground; from there to some hundred metres neither the air nor the change of g matters much.

    Parameters
    ----------
    planet : Planet
    h : float or ndarray
        Height at which the fall begins [m], at least 0.
    v : float or ndarray
        Velocity there [m/s], upward or downward.

    Returns
    -------
    float or ndarray
        [m/s], not negative.

    Raises
    ------
    ValueError, TypeError
        If h is below 0, or `planet` is no Planet.
    """
    if not isinstance(planet, Planet):
        raise TypeError(f"planet must be a Planet; got {planet!r}")
    if np.any(np.less(h, 0)):
        raise ValueError(f"h must be at least 0 [m]; got {h!r}")
    squared = v * v + 2 * planet.gravity(0.0) * h
    return np.sqrt(squared) if isinstance(squared, np.ndarray) else math.sqrt(squared)


class StepTooLargeError(ValueError):
    """A step is so large that its numbers overflow, or that it ends on the ground going up."""


class TooManyStepsError(ValueError):
    """A walk does not end within the steps that it was given; `.node` is how far it has come."""

    def __init__(self, node):
        super().__init__("too many steps: t = {:g} s, h = {:g} m, v = {:g} m/s".format(*node))
        self.node = node


LANDING_BURN = Descent(FALCON_9_LANDING_BURN, EARTH, height=10e3, velocity=-350.0)
"""One engine needs a slower start than the paper's: round numbers, like those on the screen of a landing webcast."""


@dataclass(frozen=True, eq=False, repr=False)
class Flight:
    """What became of a descent.

    Attributes
    ----------
    descent : Descent
    t_ignite : float or None
        [s]; None for a free fall.
    t, h, v, mass : ndarray, shape (n,)
        Time [s], height [m], velocity [m/s] and mass [kg] at the end of each step, the start first.
    throttle : ndarray, shape (n,)
        From each of these times on, in [0, 1]; the last repeats the one before it, unless the engine was cut there.
    outcome : str
        One of `OUTCOMES`: "soft landing" (touched down at `SOFT_SPEED` or slower), "crash", "stopped too high"
        (hovered, too high for a soft fall from there, then climbed until the tank was empty) or "out of propellant"
        (the tank was empty too high for a soft fall, without a hover).
    touchdown : tuple of float or None
        (t, v) [s, m/s].
    hover : tuple of float or None
        (t, h) [s, m] where v changed from - to + with the engine on, or where the engine came on at rest and thrust
        was not below weight: where it was cut for a soft fall, else the first time.
    """

    descent: Descent
    t_ignite: float | None
    t: np.ndarray
    h: np.ndarray
    v: np.ndarray
    mass: np.ndarray
    throttle: np.ndarray
    outcome: str
    touchdown: tuple | None = None
    hover: tuple | None = None

    @cached_property
    def felt_acceleration(self):
        """What an accelerometer on board reads, (thrust + drag)/mass, from each of the times on [m/s²], shape (n,)."""
        return self._felt(self.throttle, slice(None))

    @cached_property
    def peak_acceleration(self):
        """Largest felt acceleration at the ends of the steps, before and after each change of throttle [m/s²]."""
        before = self._felt(self.throttle[:-1], slice(1, None))
        return float(max(np.max(np.abs(self.felt_acceleration)), np.max(np.abs(before))))

    def _felt(self, throttle, at):
        thrust = throttle * self.descent.booster.thrust
        return (thrust + self.descent.drag(self.h[at], self.v[at])) / self.mass[at]

    def to_frame(self):
        """The flight as a pandas DataFrame, one row a step, units in the headers."""
        import pandas as pd

        return pd.DataFrame(
            {
                "t [s]": self.t,
                "h [m]": self.h,
                "v [m/s]": self.v,
                "mass [kg]": self.mass,
                "throttle": self.throttle,
                "felt acceleration [m/s²]": self.felt_acceleration,
            }
        )

    def __repr__(self):
        parts = []
        if self.hover:
            parts.append(f"hover {self.hover[1]:.3f} m above the ground at {self.hover[0]:.3f} s")
        if self.touchdown:
            parts.append(f"touchdown with {self.touchdown[1]:.3f} m/s at {self.touchdown[0]:.3f} s")
        else:
            parts.append(f"tank empty at {self.t[-1]:.3f} s, h = {self.h[-1]:.1f} m, v = {self.v[-1]:.1f} m/s")
        return f"<Flight: {self.outcome}; {'; '.join(parts)}>"


def fly(descent, t_ignite, *, dt=0.02, method="rk4", controller=None):
    """Fly a descent: fall freely until t_ignite, then burn until the ground is reached or the tank is empty (§1.4).

    The engine is cut at the first hover from which the fall to the ground is soft, `speed_after_fall` being at most
    `SOFT_SPEED`; a tank that is empty so low ends softly too. That fall is the last of the flight's steps, and follows
    the same formula.

    Steps have the length dt, but one ends exactly on ignition, where v changes sign, where the tank is empty and at
    the ground, so that within a step f is smooth and the method keeps its order.

    Parameters
    ----------
    descent : Descent
    t_ignite : float or None
        Ignition time [s], at least 0; None for a free fall. Ignition after the impact is a crash without a burn.
    dt : float
        Step size [s], greater than 0.
    method : str or callable
        A key of `METHODS`, or a step function of one's own.
    controller : callable, optional
        ``controller(t, h, v, mass)`` → throttle in [0, 1], asked at ignition and every dt after it, and held in
        between. Without one the throttle is 1.

    Returns
    -------
    Flight

    Raises
    ------
    ValueError, TypeError
        If an argument is not allowed, if the flight would take more than ten million steps, if dt is so large that
        the numbers overflow or a climb ends on the ground, or if the booster never comes down.
    """
    require_one_descent(descent)
    if _validate.is_column(t_ignite):
        raise TypeError("t_ignite must be one time [s]; got a column: `fly_all` flies one flight a row")
    if t_ignite is not None:
        t_ignite = _validate.number("t_ignite", t_ignite, "s", least=0)
    dt = _validate.number("dt", dt, "s", above=0)
    t_coast = math.inf if t_ignite is None else t_ignite
    at_least = min(descent.shortest_fall(), t_coast + descent.booster.burn_duration)
    if at_least < math.inf:
        _validate.step_count(at_least, dt)
    step = step_for(descent, method, dt)
    coasted, end = coast(descent, t_coast, partial(walk, step, dt=dt))
    if end == "space":
        raise never_comes_down(*coasted[-1][1:])
    return finish(descent, t_ignite, np.array(coasted), end, controller, dt=dt, step=step)


def step_for(descent, method, dt):
    """The step function of a method; one of one's own is tried, so that what is wrong with it is said by name."""
    step = step_function(method)
    if callable(method):
        with suppress(OverflowError):  # dt is too large for it: who takes the steps says so
            require_state(step, descent.acceleration(), 0.0, float(descent.height), float(descent.velocity), dt)
    return step


def never_comes_down(h, v):
    """The error of a free fall that has no end."""
    return ValueError(f"the booster never comes down: at h = {h:.0f} m it still climbs at {v:.0f} m/s")


def require_one_descent(descent):
    """Raise unless `descent` is a Descent without columns."""
    if not isinstance(descent, Descent):
        raise TypeError(f"descent must be a Descent; got {descent!r}")
    if descent.columns:
        names = ", ".join(descent.columns)
        raise TypeError(f"descent must be one descent; got columns ({names}): `fly_all` flies one flight a row")


def finish(descent, t_ignite, coasted, end, controller=None, *, dt, step):
    """Return the Flight that begins with a fall, its nodes an array of shape (n, 3); see `coast` and `fly`."""
    if controller is not None and not callable(controller):
        raise TypeError(f"controller must be a function of (t, h, v, mass); got {controller!r}")
    landed, hover = end == "ground", None
    if landed:
        burnt = [(*coasted[-1].tolist(), descent.booster.initial_mass, 0.0)]
    else:
        burnt, landed, hover = _burn(descent, *coasted[-1].tolist(), controller, dt=dt, step=step)
    fallen = np.empty((len(coasted) - 1, 5))
    fallen[:, :3], fallen[:, 3:] = coasted[:-1], (descent.booster.initial_mass, 0.0)
    t, h, v, mass, throttle = np.concatenate([fallen, burnt]).T
    if landed:
        outcome = SOFT_LANDING if abs(v[-1]) <= SOFT_SPEED else CRASH
    else:
        outcome = OUT_OF_PROPELLANT if hover is None else STOPPED_TOO_HIGH
    touchdown = (float(t[-1]), float(v[-1])) if landed else None
    return Flight(descent, t_ignite, t, h, v, mass, throttle, outcome, touchdown, hover)


def coast(descent, t_end, march, start=None):
    """Fall freely to t_end or to the ground, whichever comes first; `start` is a node to begin at.

    ``march(f, start, t_end)`` takes the steps: `walk` with its method and dt, or `stride`.

    Returns
    -------
    nodes : list of tuple
        (t, h, v) [s, m, m/s] at the end of each step, the start first.
    end : str
        What the last of them is: "time" (t_end), "ground", or "space", from where it never comes down.
    """
    f, nodes = descent.acceleration(), []
    start = start or (0.0, float(descent.height), float(descent.velocity))
    for t, h, v, event in march(f, start, t_end):
        if nodes and t == nodes[-1][0]:  # the step was shorter than the last digit of t
            nodes.pop()
        nodes.append((t, h, v))
        if event == "ground":
            return nodes, "ground"
        if v > 0 and t_end == math.inf and descent.escapes(h, v):
            return nodes, "space"
    return nodes, "time"


def _burn(descent, t, h, v, controller, *, dt, step):
    """Burn from (t, h, v) until the ground is reached or the tank is empty: nodes, landed, hover."""
    booster = descent.booster
    mass, throttle, hover, nodes = booster.initial_mass, None, None, []
    for t_next in (math.inf,) if controller is None else time_grid(t, math.inf, dt):
        asked = 1.0 if controller is None else _ask(controller, t, h, v, mass)
        if asked != throttle:
            throttle, rate, since, mass_then = asked, asked * booster.burn_rate, t, mass
            f = descent.acceleration(throttle=throttle, mass=mass, since=since)
            t_empty = since + (mass - booster.dry_mass) / rate if rate else math.inf
        if controller is None and v > 0 and f(t, h, 0.0) > 0:  # it climbs until the tank is empty
            _validate.step_count(t_empty - t, dt)
        start = t, h, v
        for t, h, v, event in walk(step, f, start, min(t_next, t_empty), dt=dt):
            if nodes and t == nodes[-1][0]:  # asked anew there, or the step was shorter than the last digit of t
                nodes.pop()
            mass = mass_then - rate * (t - since)
            nodes.append((t, h, v, mass, throttle))
            if event == "ground":
                return nodes, True, hover
            if event == "stop" and throttle > 0:
                if fall := _soft_fall(descent.planet, t, h, v, mass):
                    return nodes[:-1] + fall, True, (t, h)
                hover = hover or (t, h)
                if controller is None:  # from here it climbs until the tank is empty
                    _validate.step_count(t_empty - t, dt)
        if t >= t_empty:
            fall = _soft_fall(descent.planet, t, h, v, booster.dry_mass)
            return nodes[:-1] + (fall or [(t, h, v, booster.dry_mass, throttle)]), bool(fall), hover


def _soft_fall(planet, t, h, v, mass):
    """The nodes of a fall with the engine off to the ground, this one first; none if it would not end softly."""
    speed = speed_after_fall(planet, h, v)
    if speed > SOFT_SPEED:
        return []
    t_ground = t + (v + speed) / planet.gravity(0.0)
    ground = (t_ground, 0.0, 0.0 - speed, mass, 0.0)
    # time stands still where the fall is shorter than the last digit of t
    return [(t, h, v, mass, 0.0), ground] if t_ground > t else [ground]


def walk(step, f, start, t_end, *, dt, ground=0.0):
    """Walk a phase of a flight, one acceleration f, in steps of dt from the node start = (t, h, v) to t_end.

    Yields
    ------
    t, h, v : float
        The start, then the end of each step, or of the parts that events divide it into [s, m, m/s].
    event : str or None
        As `advance` returns; "stop" too for a start at rest from which it does not fall.

    Raises
    ------
    ValueError
        If it would take more than ten million steps.
    """
    t, h, v = start
    yield t, h, v, "stop" if v == 0 and f(t, h, v) >= 0 else None
    for part_end in (min(t_end, t + LONG_WALK * dt), t_end):
        for t_next in time_grid(t, part_end, dt) if part_end - t > dt else (part_end,):
            while t < t_next:
                s, h, v, event = advance(step, f, t, h, v, t_next - t, ground=ground)
                t = t_next if event is None else min(t + s, t_next)
                yield t, h, v, event
        if t < t_end:
            _validate.step_count(end_of_walk(f, (t, h, v), t_end, ground) - start[0], dt)


def end_of_walk(f, node, t_end, ground):
    """When a walk ends that has come to a node, nearly; a time before that if it does not show in a few steps."""
    with suppress(TooManyStepsError):
        for t, h, v, event in stride(1e-6, iter(range(LONG_WALK // 12)), f, node, t_end, ground=ground):  # noqa: B007
            if event in ("stop", "ground"):
                break
    for_good = v > 0 and (t_end == math.inf or f(t, h, 0.0) > 0)  # it may climb so: who walks sees that in time
    return node[0] if for_good else t


def stride(tolerance, tries, f, start, t_end, *, ground=0.0):
    """Do what `walk` does, by `dop8`, in steps that choose their own length.

    The error of each step is estimated to be at most `tolerance`, as a share of the largest h and v so far (or 1 m and
    1 m/s). Each step that is tried takes one of `tries`, an iterator.

    Raises
    ------
    TooManyStepsError
        If there are no more tries.
    """
    t, h, v = start
    a, h_most, v_most = f(t, h, v), 1.0, 1.0
    yield t, h, v, "stop" if v == 0 <= a else None
    dt = (1 + abs(v)) / (1e-9 + 4 * abs(a))  # v changes by a quarter
    for _ in tries:
        dt, h_most, v_most = min(dt, t_end - t), max(h_most, abs(h)), max(v_most, abs(v))
        try:
            h_end, v_end, h_error, v_error = dop8_and_error(f, t, h, v, dt)
            if isinstance(h_end + v_end, complex):  # a look was where the power law of somebody's air has no value
                raise ArithmeticError
            if v < 0 <= v_end or v > 0 >= v_end:  # drag, ∝ |v|·v, is not smooth there: the step must end on it
                dt = _turn(f, t, h, v, dt, v_end)
                h_end, v_end, h_error, v_error = dop8_and_error(f, t, h, v, dt)
                v_end = 0.0
            error = max(h_error / h_most, v_error / v_most) / tolerance
        except ArithmeticError:
            error = math.inf
        if error <= 1:
            s, h, v, event = advance(dop8, f, t, h, v, dt, ground=ground, end=(h_end, v_end))
            t = t_end if s == t_end - t else t + s
            yield t, h, v, event
            if t == t_end:
                return
        dt *= max(0.2, 0.8 * max(error, 1e-4) ** (-1 / 8))  # as it is proportional to dt⁸; 2.5 times as long at most
    raise TooManyStepsError((t, h, v))


def _turn(f, t, h, v, dt, v_end):
    """How long after the start of a step of `dop8` v is 0 [s]: by Newton's method, or by a safe one if that fails."""
    s = dt * v / (v - v_end)
    for _ in range(6):
        h_s, v_s = dop8(f, t, h, v, s)
        correction = v_s / f(t + s, h_s, v_s)
        s -= correction
        if abs(correction) < 1e-8 * dt and 0 < s <= dt:  # the next would be its square
            return s
    return bracketed_root(lambda s: dop8(f, t, h, v, s)[1], 0.0, dt, v, v_end, xtol=1e-14 * dt)


def advance(step, f, t, h, v, dt, *, ground=0.0, end=None):
    """Take one step of dt, or the part of it up to the first event; `end` is (h, v) after the step, if it is known.

    The length of a shortened step is found by a bracketed root search on the step itself: no interpolant, so the
    method keeps its order. Where v changes sign, the search is for that turn first, because between two points above
    the ground the turn may lie below it.

    Returns
    -------
    length : float
        Of the step taken [s].
    h, v : float
        State at its end [m, m/s].
    event : str or None
        "stop" (of a fall) or "apex" (of a climb): v has changed sign and is 0 now; "ground": h is 0 now; or None.

    Raises
    ------
    StepTooLargeError
        If the numbers overflow, or if the step ends on the ground going up.
    """

    try:
        h_end, v_end = end or step(f, t, h, v, dt)
    except OverflowError:
        h_end = v_end = math.inf
    if not -math.inf < h_end + v_end < math.inf:
        raise StepTooLargeError(f"the numbers overflow at t = {t:g} s: dt = {dt:g} s is too large for this method")
    turns = v < 0 <= v_end or v > 0 >= v_end
    if not turns and h_end > ground:
        return dt, h_end, v_end, None

    known = {0.0: (h, v), dt: (h_end, v_end)}

    def to(s):
        return known.get(s) or step(f, t, h, v, s)

    end = dt
    if turns:
        end = bracketed_root(lambda s: to(s)[1], 0.0, dt, v, v_end, xtol=1e-14 * dt)
        h_end, _ = to(end)
        if h_end >= ground:
            return end, h_end, 0.0, "stop" if v < 0 else "apex"
    end = bracketed_root(lambda s: to(s)[0] - ground, 0.0, end, h - ground, h_end - ground)
    v_end = to(end)[1]
    if v_end > 0:
        raise StepTooLargeError(
            f"a climb from t = {t:g} s ends on the ground: dt = {dt:g} s is too large for this method"
        )
    return end, ground, v_end, "ground"


def _ask(controller, t, h, v, mass):
    return _validate.number("controller(t, h, v, mass)", controller(t, h, v, mass), "throttle", least=0, most=1)
