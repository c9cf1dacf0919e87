"""Independent flights: the same physics written out again, solved by SciPy's DOP853 near machine precision.

Nothing here calls the library's forces, methods or searches; of its dataclasses only the numbers are read. An event of
`solve_ivp` is only as good as its interpolant, so every end is found again by Brent's method over fresh integrations
of the last step. No dip can hide: the ground is looked for only between two changes of sign of v, where h is monotone.
"""

import math
from dataclasses import dataclass, field
from functools import cache
from itertools import pairwise

from scipy.integrate import solve_ivp
from scipy.optimize import brentq, minimize_scalar

G = 6.6743e-11
SETTINGS = {"method": "DOP853", "rtol": 5e-14, "atol": 1e-13}
A_LONG_TIME = 1e7


def felt_force(descent, h, v, throttle):
    """Thrust and drag together [N]."""
    booster, planet = descent.booster, descent.planet
    density = planet.surface_density * math.exp(-h / planet.scale_height) if planet.surface_density else 0.0
    drag = 0.5 * density * v**2 * booster.drag_coefficient * math.pi * booster.radius**2
    return throttle * booster.thrust - math.copysign(drag, v)


def initial_mass(descent):
    return descent.booster.dry_mass + descent.booster.propellant_mass


def equation(descent, throttle, mass, since=0.0, rate=None):
    """Right-hand side for (h, v) at one throttle; `mass` [kg] is that at the time `since`."""
    planet = descent.planet
    rate = throttle * descent.booster.burn_rate if rate is None else rate

    def rhs(t, y):
        h, v = y
        return v, felt_force(descent, h, v, throttle) / (mass - rate * (t - since)) - G * planet.mass / (
            planet.radius + h
        ) ** 2

    return rhs


def solve(rhs, node, t_end, stop=None, floor=-math.inf):
    """Mesh [(t, h, v), …] from a node on to t_end, or to where h (stop=0) or v (stop=1) becomes 0; and whether it did.

    A run that falls below `floor` ends at h = -inf.
    """
    t0, *y0 = node
    if t_end <= t0:
        return [node], False

    def crossing(t, y):
        return y[stop] if t > t0 and stop is not None else y0[stop or 0]

    def sinking(t, y):
        return y[0] - floor if floor > -math.inf else 1.0

    crossing.terminal = sinking.terminal = True
    run = solve_ivp(rhs, (t0, t_end), y0, events=(crossing, sinking), **SETTINGS)
    assert run.success, run.message
    mesh = [(float(t), float(h), float(v)) for t, h, v in zip(run.t, *run.y, strict=True)]
    if run.t_events[1].size:
        return [*mesh[:-1], (mesh[-1][0], -math.inf, -math.inf)], False
    if run.status == 0:
        return mesh, False

    before, (estimate, _, _) = mesh[-2], mesh[-1]
    if estimate - before[0] < 1e-6:  # over so short a step the interpolant is exact, and rounding leaves no bracket
        end = list(mesh[-1])
        end[1 + stop] = 0.0
        return [*mesh[:-1], tuple(end)], True
    width = 1e-3 * (estimate - before[0])  # the interpolant is far better than that
    low, high = max(estimate - width, before[0]), min(estimate + width, t_end)
    t = brentq(lambda t: run_on(rhs, before, t)[1 + stop], low, high, xtol=1e-13, rtol=1e-14)
    end = list(run_on(rhs, before, t))
    end[1 + stop] = 0.0
    return [*mesh[:-1], tuple(end)], True


def run_on(rhs, node, t):
    """The node at t, integrated from an earlier one."""
    if t <= node[0]:
        return node
    y = solve_ivp(rhs, (node[0], t), node[1:], **SETTINGS).y
    return t, float(y[0, -1]), float(y[1, -1])


@cache
def free_fall(descent):
    """Mesh of the fall to the ground with the engine off; the apex of an ascending start is in it."""
    rhs, mesh = equation(descent, 0.0, initial_mass(descent)), [(0.0, float(descent.height), float(descent.velocity))]
    if descent.velocity > 0:
        mesh, _ = solve(rhs, mesh[-1], A_LONG_TIME, stop=1)
    fall, landed = solve(rhs, mesh[-1], A_LONG_TIME, stop=0)
    assert landed
    return [*mesh[:-1], *fall]


def at_ignition(descent, t_ignite):
    before = [node for node in free_fall(descent) if node[0] <= t_ignite][-1]
    return run_on(equation(descent, 0.0, initial_mass(descent)), before, t_ignite)


def out_of_sight(planet):
    """How far below the ground its air, or its gravity, makes sense [m]."""
    return -2 * planet.scale_height if planet.surface_density else -planet.radius / 2


@cache
def hover(descent, t_ignite):
    """(t, h) where a full burn first stops falling, the ground ignored and thrust kept on at dry mass.

    (inf, inf) if it climbs without ever falling, h = -inf if it sinks out of sight.
    """
    booster, floor = descent.booster, out_of_sight(descent.planet)
    burning = equation(descent, 1.0, initial_mass(descent), since=t_ignite)
    dry = equation(descent, 1.0, booster.dry_mass, rate=0.0)
    t_empty = t_ignite + booster.propellant_mass / booster.burn_rate

    node = at_ignition(descent, t_ignite)
    if node[2] > 0:
        mesh, turned = solve(burning, node, t_empty, stop=1)
        if not turned:
            return math.inf, math.inf
        node = mesh[-1]
    if node[2] == 0:
        if burning(node[0], node[1:])[1] >= 0:
            return node[:2]
        node = (*node[:2], -1e-300)  # so that the start is not taken for the end
    mesh, turned = solve(burning, node, t_empty, stop=1, floor=floor)
    if not turned and mesh[-1][1] > floor:
        mesh, turned = solve(dry, mesh[-1], A_LONG_TIME, stop=1, floor=floor)
    return mesh[-1][:2]


def best_ignition(descent, low, high):
    """The ignition time between two others whose hover is at height 0, by Brent's method."""
    return brentq(lambda t: max(hover(descent, t)[1], -1e9), low, high, xtol=1e-13, rtol=1e-14)


@dataclass
class Flight:
    outcome: str = ""
    touchdown: tuple | None = None  # (t, v)
    hover: tuple | None = None  # (t, h)
    burnout: tuple | None = None  # (t, h, v)
    mesh: list = field(default_factory=list)  # (t, h, v, mass, throttle)


def soft_fall(descent, t, h, v):
    """(t, v) of a touchdown after a fall in empty space at the gravity of the ground, if it is soft."""
    g = G * descent.planet.mass / descent.planet.radius**2
    if v * v + 2 * g * h > 2.0**2:
        return None
    apex = h + v * v / (2 * g)  # reached at t + v/g: later if it rises, earlier if it falls already
    return t + v / g + math.sqrt(2 * apex / g), -math.sqrt(2 * g * apex)


def fly(descent, t_ignite, *, controller=None, every=math.inf):
    """A whole flight; the controller is asked at ignition and then `every` s.

    It ends at the ground or at burnout, or with a soft fall from there or from a hover.
    """
    booster, flight = descent.booster, Flight()
    fall, mass = free_fall(descent), initial_mass(descent)
    if t_ignite is None or t_ignite >= fall[-1][0]:
        flight.mesh = [(*node, mass, 0.0) for node in fall]
        flight.touchdown = fall[-1][0], fall[-1][2]
        flight.outcome = "soft landing" if fall[-1][2] >= -2 else "crash"
        return flight

    flight.mesh = [(*node, mass, 0.0) for node in fall if node[0] < t_ignite]
    node, asked = at_ignition(descent, t_ignite), 0
    while True:
        throttle = controller(*node, mass) if controller else 1.0
        asked += 1
        rate, since, mass_then = throttle * booster.burn_rate, node[0], mass
        t_empty = since + (mass - booster.dry_mass) / rate if rate else math.inf
        t_end = min(t_ignite + asked * every, t_empty, A_LONG_TIME)
        rhs = equation(descent, throttle, mass, since)
        while node[0] < t_end:
            falling = node[2] < 0 or (node[2] == 0 and rhs(node[0], node[1:])[1] < 0)
            if node[2] == 0 and not falling and throttle > 0:
                flight.touchdown = soft_fall(descent, *node)
                if flight.touchdown or flight.hover is None:
                    flight.hover = node[:2]
                if flight.touchdown:
                    flight.mesh.append((*node, mass_then - rate * (node[0] - since), throttle))
                    return ended_softly(flight)
            start = (*node[:2], node[2] or math.copysign(1e-300, -falling))
            mesh, _ = solve(rhs, start, t_end, stop=1, floor=out_of_sight(descent.planet))
            landed = falling and mesh[-1][1] <= 0
            if landed:
                mesh, _ = solve(rhs, start, mesh[-1][0], stop=0)
            flight.mesh += [(*n, mass_then - rate * (n[0] - since), throttle) for n in mesh]
            node = mesh[-1]
            if landed:
                flight.touchdown = node[0], node[2]
                flight.outcome = "soft landing" if node[2] >= -2 else "crash"
                return flight
        mass = mass_then - rate * (node[0] - since)
        if node[0] >= t_empty:
            flight.burnout = node
            flight.touchdown = soft_fall(descent, *node)
            if flight.touchdown:
                return ended_softly(flight)
            flight.outcome = "stopped too high" if flight.hover else "out of propellant"
            return flight


def ended_softly(flight):
    t, v = flight.touchdown
    flight.outcome = "soft landing"
    flight.mesh[-1] = *flight.mesh[-1][:4], 0.0
    flight.mesh.append((t, 0.0, v, flight.mesh[-1][3], 0.0))
    return flight


def peak_acceleration(descent, t_ignite):
    """Largest felt acceleration [m/s²] of a flight at full thrust, also between the points of the mesh."""
    mesh = fly(descent, t_ignite).mesh

    def felt(h, v, mass, throttle):
        return abs(felt_force(descent, h, v, throttle)) / mass

    peaks = [felt(*node[1:]) for node in mesh]
    for (t, h, v, mass, throttle), after in pairwise(mesh):
        if (
            after[4] == throttle
            and after[0] > t
            and max(felt(h, v, mass, throttle), felt(*after[1:])) > 0.9 * max(peaks)
        ):
            rate = throttle * descent.booster.burn_rate
            rhs = equation(descent, throttle, mass, since=t)
            found = minimize_scalar(
                lambda s, t=t, h=h, v=v, mass=mass, throttle=throttle, rate=rate, rhs=rhs: (
                    -felt(*run_on(rhs, (t, h, v), s)[1:], mass - rate * (s - t), throttle)
                ),
                bounds=(t, after[0]),
                method="bounded",
            )
            peaks.append(-found.fun)
    return max(peaks)
