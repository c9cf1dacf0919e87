"""The paper's own programs re-expressed, slips included, so that its printed numbers come out and can be taken apart.

Source: "Mathematical Modeling of SpaceX's Falcon 9 Booster Hoverslam Landing". Nothing else in the library knows of
what is wrong here.
"""

import math
from dataclasses import dataclass
from enum import Enum

import numpy as np

from hoverslam_lib import _validate
from hoverslam_lib.booster import FALCON_9
from hoverslam_lib.data import load
from hoverslam_lib.descent import Descent, Flight
from hoverslam_lib.integrators import step_function
from hoverslam_lib.metrics import samples
from hoverslam_lib.oscillator import Oscillator
from hoverslam_lib.planet import EARTH
from hoverslam_lib.trajectory import Trajectory

TIME_CAP = 600.0
"""A run ends here [s] if it has not met the ground: some combinations of faults never come down."""


class Fault(Enum):
    """What the listing's equation does that a booster does not; each can be switched alone."""

    THRUST_IN_KILONEWTONS = "the thrust of 7 600 kN is written 7.6e3 beside masses in kg"
    THRUST_SUBTRACTED = "thrust is subtracted, so it points down"
    TANK_NEVER_EMPTY = "the engine burns propellant that is not there, and mass falls below the dry mass"
    DRAG_ALWAYS_UP = "drag points up whichever way the booster moves"


ALL_FAULTS = frozenset(Fault)


@dataclass(frozen=True, eq=False)
class PublishedRun(Trajectory):
    """A run of the paper's program.

    Attributes
    ----------
    mass : ndarray, shape (n + 1,)
        The mass that the equation divides by [kg]; below zero where the tank never empties and the engine burns on.
    """

    mass: np.ndarray


def _members(faults):
    try:
        faults = frozenset(faults)
    except TypeError:
        raise TypeError(f"faults must be a collection of Fault; got {faults!r}") from None
    if not faults <= ALL_FAULTS:
        raise ValueError(
            f"faults must be members of Fault: {', '.join(Fault.__members__)}; got {set(faults - ALL_FAULTS)}"
        )
    return faults


def _burning_and_mass(t, t_ignite, endless):
    """Does the engine push at t, and what is the mass [kg] then? `endless`: the tank never empties."""
    burn_time = t - t_ignite if t > t_ignite else 0
    if not endless and burn_time >= FALCON_9.burn_duration:
        return False, FALCON_9.dry_mass
    return t > t_ignite, FALCON_9.dry_mass + (FALCON_9.propellant_mass - FALCON_9.burn_rate * burn_time)


def acceleration(t_ignite, faults=ALL_FAULTS):
    """Return the listing's `hddot`, f(t, h, v) [m/s²], with the given faults; with none it is the right equation.

    As there, ignition is decided inside f, by t > t_ignite. Terms are added in the listing's order.

    Raises
    ------
    ValueError
        If something in `faults` is not a `Fault`.
    """
    faults = _members(faults)
    booster = FALCON_9
    thrust = 7.6e3 if Fault.THRUST_IN_KILONEWTONS in faults else booster.thrust
    if Fault.THRUST_SUBTRACTED in faults:
        thrust = -thrust
    always_up, endless = Fault.DRAG_ALWAYS_UP in faults, Fault.TANK_NEVER_EMPTY in faults
    coefficient, area, air_density = booster.drag_coefficient, booster.area, EARTH.air_density_law()
    t_ignite = _validate.number("t_ignite", t_ignite, "s", least=0)

    def f(t, h, v):
        burning, mass = _burning_and_mass(t, t_ignite, endless)
        try:
            density = air_density(h)
        except OverflowError:  # runs with faults can be thrown far below the ground
            density = math.inf
        drag = (1 / (2 * mass)) * (density * coefficient * area * v**2)
        if not always_up and v > 0:
            drag = -drag
        total = -EARTH.gravity(h) + drag
        return total + thrust / mass if burning else total

    return f


def fly(t_ignite, *, dt, method="rkn4", faults=ALL_FAULTS):
    """Fly the paper's descent as Listing 4 does: a fixed grid, no event located, ``while h > 0``.

    Parameters
    ----------
    t_ignite : float
        [s]
    dt : float
        Step size [s]; time is accumulated by ``t += dt``, and its rounding decides which step is lit first.
    method : str or callable
        "rkn4" is what the tables call Runge-Kutta.
    faults : iterable of Fault

    Returns
    -------
    PublishedRun
        Its last row is the overshoot below the ground, or the first one after `TIME_CAP`, or the last one with finite
        numbers.
    """
    dt = _validate.number("dt", dt, "s", above=0)
    _validate.step_count(TIME_CAP, dt)
    faults = _members(faults)
    f, step = acceleration(t_ignite, faults), step_function(method)
    start = Descent()
    t, h, v = 0.0, start.height, start.velocity
    rows = [(t, h, v)]
    while h > 0 and t < TIME_CAP:
        try:
            h, v = step(f, t, h, v, dt)
        except (OverflowError, ZeroDivisionError):
            break
        t += dt
        if not math.isfinite(h + v):
            break
        rows.append((t, h, v))
    t, h, v = (np.array(column) for column in zip(*rows, strict=True))
    endless = Fault.TANK_NEVER_EMPTY in faults
    return PublishedRun(t, h, v, np.array([_burning_and_mass(moment, t_ignite, endless)[1] for moment in t]))


def listed(run, *, at_rest=False):
    """What the tables list of a run: the largest velocity, called "Min hdot", and the height there.

    Parameters
    ----------
    run : Trajectory or Flight
    at_rest : bool
        Where the tables say "hdot = 0": the height where v first changes sign, on a straight line between two rows.

    Returns
    -------
    h, v : float
        [m], [m/s]; a height below the ground is 0, as printed.
    """
    _validate.instance("run", run, Trajectory, Flight)
    if at_rest:
        rising = np.flatnonzero((run.v[:-1] < 0) & (run.v[1:] >= 0))
        if rising.size:
            i = rising[0]
            share = run.v[i] / (run.v[i] - run.v[i + 1])
            return float(run.h[i] + share * (run.h[i + 1] - run.h[i])), 0.0
    fastest = int(np.argmax(run.v))
    return float(max(run.h[fastest], 0.0)), float(run.v[fastest])


def optimisation_table(dt):
    """Figure 7.7, 7.8 or 7.9 computed anew, beside what is printed there.

    Parameters
    ----------
    dt : float
        0.02, 0.05 or 0.1 [s].

    Returns
    -------
    pandas.DataFrame
        A row for each ignition time and method, with height [m] and velocity [m/s] as printed, as computed, and their
        difference.

    Raises
    ------
    ValueError
        If the paper has no table for this dt.
    """
    import pandas as pd

    dt, printed = _validate.number("dt", dt, "s"), load("optimisation_tables")
    if dt not in set(printed["dt"]):
        raise ValueError(f"the paper has tables for dt = 0.02, 0.05 and 0.1 s; got {dt!r}")
    cells = printed[printed["dt"] == dt].pivot(index=["t_ignite", "method"], columns="quantity", values="value")
    rows = []
    for (t_ignite, method), cell in cells.sort_index(ascending=[True, True]).iterrows():
        h, v = listed(fly(t_ignite, dt=dt, method=method), at_rest=cell["velocity"] == 0)
        rows.append(
            {
                "t_ignite [s]": t_ignite,
                "method": method,
                "h printed [m]": cell["height"],
                "h computed [m]": h,
                "h difference [m]": h - cell["height"],
                "v printed [m/s]": cell["velocity"],
                "v computed [m/s]": v,
                "v difference [m/s]": v - cell["velocity"],
            }
        )
    return pd.DataFrame(rows).set_index(["t_ignite [s]", "method"])


# ---- Listing 2: the four methods on simple harmonic motion ------------------------------------------------------


SAMPLES = 157
"""Samples in Listing 2, so 156 steps, of 5π/156 s."""


def oscillator_time():
    """Listing 2's samples: t [s], shape (157,), from 0 to 5π."""
    return np.linspace(0, 5 * np.pi, SAMPLES)


def oscillator_runs():
    """Listing 2's four runs of x'' = -x from x = 3 m at rest, as its `main` receives them.

    Two slips come along. Its explicit Euler hands back (v, x) where (x, v) is expected. The matrix of its implicit
    Euler has the wrong sign for the order in which it holds the state, so v comes out mirrored.

    Returns
    -------
    dict of str to tuple of ndarray
        For each method, what the listing calls x and v, shape (157,).
    """
    dt = 5 * np.pi / (SAMPLES - 1)
    spring = Oscillator()
    runs = {}
    for method in ("rk4", "symplectic_euler", "explicit_euler"):
        step = step_function(method)
        rows = [(spring.x0, spring.v0)]
        for _ in range(SAMPLES - 1):
            rows.append(step(spring.acceleration, 0.0, *rows[-1], dt))
        runs[method] = tuple(np.array(column) for column in zip(*rows, strict=True))
    runs["explicit_euler"] = runs["explicit_euler"][::-1]

    x, v = [spring.x0], [spring.v0]
    for _ in range(SAMPLES - 1):
        # elimination in the matrix I - dt·[[0, 1], [-1, 0]], state in the order (v, x)
        x_new = (x[-1] - dt * v[-1]) / (1 + dt * dt)
        v.append(v[-1] + dt * x_new)
        x.append(x_new)
    runs["implicit_euler"] = np.array(x), np.array(v)
    return runs


def listing_2_mape(exact, approx):
    """What Listing 2 prints as MAPE: its loop overwrites its result, so the last sample alone counts, signed, over n.

    Parameters
    ----------
    exact, approx : ndarray, shape (n,)

    Returns
    -------
    float
        Dimensionless.
    """
    exact, approx = samples(exact=exact, approx=approx)
    return float(1 / len(exact) * ((exact[-1] - approx[-1]) / exact[-1]))
