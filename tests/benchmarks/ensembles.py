"""Ratios of speed, and memory, of ensembles, measured side by side: ``python tests/benchmarks/ensembles.py``.

The loop that `fly_all` is compared with needs numba, which nothing else here does: install it by hand, best in an
environment of its own (``pip install "numba>=0.62,<1"``). The loop is serial, as one writes for a compiler, flies
the same worlds with the same events, and is checked to give the same table. All times are CPU times; each ratio is the
median over rounds in which the rivals take turns.
"""

import math
import subprocess
import sys
import time
from dataclasses import replace
from pathlib import Path
from statistics import median

import numba
import numpy as np

from hoverslam_lib import LANDING_BURN, Descent, FreeFall, best_ignition, fly, fly_all
from hoverslam_lib.planet import GRAVITATIONAL_CONSTANT

PLAN = replace(LANDING_BURN, booster=replace(LANDING_BURN.booster, propellant_mass=7_000.0))
ROUNDS = 5
ONE_BY_ONE = 150
"""Flights that are flown one by one: enough to know what one costs."""


def landings(n, seed=12):
    """Dispersed landings of the one-engine plan: the descent with columns, and the ignition times."""
    thrust, drag, air, propellant, dh, dv, delay = np.random.default_rng(seed).normal(size=(7, n))
    booster = replace(
        PLAN.booster,
        thrust=PLAN.booster.thrust * (1 + 0.01 * thrust),
        burn_rate=PLAN.booster.burn_rate * (1 + 0.01 * thrust),
        drag_coefficient=PLAN.booster.drag_coefficient * (1 + 0.10 * drag),
        propellant_mass=PLAN.booster.propellant_mass + 100.0 * propellant,
    )
    planet = replace(PLAN.planet, surface_density=PLAN.planet.surface_density * (1 + 0.05 * air))
    descent = Descent(booster, planet, PLAN.height + 20.0 * dh, PLAN.velocity + 2.0 * dv)
    return descent, best_ignition(PLAN).t_ignite + 0.05 * delay


# ---- the serial loop ----------------------------------------------------------------------------------------------


@numba.njit
def step(t, h, v, dt, p):
    """One step of rk4. p: thrust, burn rate, mass at t = 0, ½·C_D·A, surface density, scale height, G·M, radius."""
    half = dt / 2
    k1 = acceleration(t, h, v, p)
    v2 = v + half * k1
    k2 = acceleration(t + half, h + half * v, v2, p)
    v3 = v + half * k2
    k3 = acceleration(t + half, h + half * v2, v3, p)
    v4 = v + dt * k3
    k4 = acceleration(t + dt, h + dt * v3, v4, p)
    return h + dt / 6 * (v + 2 * v2 + 2 * v3 + v4), v + dt / 6 * (k1 + 2 * k2 + 2 * k3 + k4)


@numba.njit
def acceleration(t, h, v, p):
    thrust, rate, mass, drag_area, density, scale_height, gm, radius = p
    drag = drag_area * density * math.exp(-h / scale_height) * abs(v) * v
    r = radius + h
    return (thrust - drag) / (mass - rate * t) - gm / (r * r)


@numba.njit
def event(t, h, v, length, which, p, ga, gb):
    """Where in a step h (which = 0) or v (which = 1) is 0: Chandrupatla's method, as in the library."""
    if ga == 0:
        return 0.0
    if gb == 0:
        return length
    xtol = 1e-14 * length
    a, b, ga, gb = length, 0.0, gb, ga
    fraction = min(max(ga / (ga - gb), 0.01), 0.99)
    while True:
        x = a + fraction * (b - a)
        gx = step(t, h, v, x, p)[which]
        if (gx < 0) == (ga < 0):
            c, gc = a, ga
        else:
            b, c, gb, gc = a, b, ga, gb
        a, ga = x, gx
        best, g_best = (a, ga) if abs(ga) < abs(gb) else (b, gb)
        smallest = max(xtol, 4.4e-16 * best) / abs(b - a) if a != b else 1.0
        if g_best == 0 or smallest > 0.5:
            return best
        fraction = 0.5
        xi, phi = (a - b) / (c - b), (ga - gb) / (gc - gb)
        if phi**2 < xi and (1 - phi) ** 2 < 1 - xi:
            fraction = ga / (gb - ga) * gc / (gb - gc) + (c - a) / (b - a) * ga / (gc - ga) * gb / (gc - gb)
        fraction = min(max(fraction, smallest), 1 - smallest)


@numba.njit
def fly_serially(columns, t_ignite, dt, found):
    """The flights of `landings`, one after the other: outcome, hover height, touchdown time and speed, propellant."""
    for i in range(len(t_ignite)):
        thrust, rate, dry, propellant, drag_area, density, scale_height, gm, radius, h, v = columns[i]
        p = (0.0, 0.0, dry + propellant, drag_area, density, scale_height, gm, radius)
        t, end, crossed = 0.0, t_ignite[i], False
        outcome, height, t_down, v_down, left = 3, math.nan, math.nan, math.nan, propellant
        k = 0
        while t < end:
            t_next = end if end - k * dt <= dt * (1 + 1e-9) else (k + 1) * dt
            h_end, v_end = step(t, h, v, t_next - t, p)
            if h_end <= 0:
                s = event(t, h, v, t_next - t, 0, p, h, h_end)
                v_down, t_down, crossed = step(t, h, v, s, p)[1], t + s, True
                break
            t, h, v, k = t_next, h_end, v_end, k + 1
        if not crossed:
            p = (thrust, rate, dry + propellant, drag_area, density, scale_height, gm, radius)
            t, k, end = 0.0, 0, propellant / rate
            while True:
                if t >= end:  # with thrust and dry mass from here on, as for the hover height
                    if not crossed and left == propellant:
                        left = 0.0
                    p = (thrust, 0.0, dry, drag_area, density, scale_height, gm, radius)
                    t, k, end = 0.0, 0, math.inf
                length = end - k * dt if end - k * dt <= dt * (1 + 1e-9) else dt
                h_end, v_end = step(t, h, v, length, p)
                if v_end >= 0:
                    s = event(t, h, v, length, 1, p, v, v_end)
                    height = step(t, h, v, s, p)[0]
                    if not crossed and height < 0:
                        e = event(t, h, v, s, 0, p, h, height)
                        v_down, crossed = step(t, h, v, e, p)[1], True
                        t_down, left = t_ignite[i] + t + e, propellant - rate * (t + e)
                    elif not crossed:
                        g = gm / (radius * radius)
                        speed = math.sqrt(2 * g * height)
                        outcome, left = 2, 0.0
                        if speed <= 2.0:
                            v_down, t_down, crossed = -speed, t_ignite[i] + t + s + speed / g, True
                            left = propellant - rate * (t + s)
                    break
                if not crossed and h_end <= 0:
                    e = event(t, h, v, length, 0, p, h, h_end)
                    v_down, crossed = step(t, h, v, e, p)[1], True
                    t_down, left = t_ignite[i] + t + e, propellant - rate * (t + e)
                if h_end < -2 * scale_height:
                    height = -math.inf
                    break
                h, v, k = h_end, v_end, k + 1
                t = end if length < dt else k * dt
        if crossed:
            outcome = 0 if -v_down <= 2.0 else 1
        found[i, 0], found[i, 1], found[i, 2], found[i, 3], found[i, 4] = outcome, height, t_down, v_down, left


def for_the_loop(descent, n):
    booster, planet = descent.booster, descent.planet
    numbers = (
        *(booster.thrust, booster.burn_rate, booster.dry_mass, booster.propellant_mass),
        *(0.5 * booster.drag_coefficient * booster.area, planet.surface_density, planet.scale_height),
        *(GRAVITATIONAL_CONSTANT * planet.mass, planet.radius, descent.height, descent.velocity),
    )
    return np.array(np.broadcast_arrays(*numbers, np.zeros(n))[:-1]).T.copy()


def check_same(table, found):
    numbers = table.iloc[:, 1:].to_numpy()
    assert (table["outcome"].cat.codes.to_numpy() == found[:, 0]).all()
    np.testing.assert_allclose(numbers[:, 0], found[:, 1], rtol=0, atol=1e-8)
    np.testing.assert_allclose(numbers[:, 1:], found[:, 2:], rtol=0, atol=1e-5)


# ---- measuring ----------------------------------------------------------------------------------------------------


def times(*rivals):
    """CPU time of each rival [s] in each round."""
    rounds = []
    for _ in range(ROUNDS):
        taken = []
        for rival in rivals:
            start = time.process_time()
            rival()
            taken.append(time.process_time() - start)
        rounds.append(taken)
    return rounds


def against(name, n, ours, one_by_one, loop=None, wanted=""):
    """Print what n flights cost all at once, and how many times as long they take one by one and in the loop."""
    rounds = times(ours, one_by_one, *([loop] if loop else []))
    each = median(1e6 * r[0] / n for r in rounds)
    faster = median((r[1] / ONE_BY_ONE) / (r[0] / n) for r in rounds)
    text = f"{name:<52} {each:7.1f} µs  {faster:6.0f} ×"
    if loop:
        text += f"  {median(r[0] / r[2] for r in rounds):6.2f}"
    print(f"{text:<80} {wanted}", flush=True)


def dispersed(dt, n, wanted):
    descent, t_ignite = landings(n)
    worlds = [(descent.rows(i), float(t_ignite[i])) for i in range(ONE_BY_ONE)]
    columns, found = for_the_loop(descent, n), np.empty((n, 5))
    fly_serially(columns, t_ignite, dt, found)
    table = fly_all(descent, t_ignite, dt=dt)
    check_same(table, found)
    against(
        f"{n:,} dispersed landings, dt = {dt} s",
        n,
        lambda: fly_all(descent, t_ignite, dt=dt),
        lambda: [fly(*world, dt=dt) for world in worlds],
        lambda: fly_serially(columns, t_ignite, dt, found),
        wanted,
    )
    return table


def shared_fall():
    t_ignite = np.linspace(58.0, 66.0, 10_000)
    fall, sample = FreeFall(Descent(), dt=0.02), t_ignite[:: len(t_ignite) // ONE_BY_ONE][:ONE_BY_ONE].tolist()
    against(
        "10,000 ignition times, one fall, dt = 0.02 s",
        len(t_ignite),
        lambda: fly_all(Descent(), t_ignite, dt=0.02),
        lambda: [fall.fly(t) for t in sample],
        wanted="at least 60 ×",
    )


def steered():
    def law(t, h, v, mass):
        wanted = mass * (v * v / (2 * np.maximum(h, 0.1)) + 9.8) / 845e3
        return np.clip(wanted, 0.57, 1.0)

    def law_for_numbers(t, h, v, mass):
        return min(max(mass * (v * v / (2 * max(h, 0.1)) + 9.8) / 845e3, 0.57), 1.0)

    n = 20_000
    descent, t_ignite = landings(n)
    worlds = [(descent.rows(i), float(t_ignite[i])) for i in range(ONE_BY_ONE)]
    against(
        "20,000 landings with a law for arrays, dt = 0.1 s",
        n,
        lambda: fly_all(descent, t_ignite, controller=law),
        lambda: [fly(*world, dt=0.1, controller=law_for_numbers) for world in worlds],
        wanted="at least 25 ×",
    )


def megabytes(n):
    """In a process of its own: memory above the inputs at the most [MB], and CPU time a flight [µs]."""
    descent, t_ignite = landings(n)
    fly_all(descent.rows(slice(0, 100)), t_ignite[:100])
    Path("/proc/self/clear_refs").write_text("5")  # the peak counts from here on
    before, start = resident("VmRSS"), time.process_time()
    fly_all(descent, t_ignite)
    print(resident("VmHWM") - before, 1e6 * (time.process_time() - start) / n)


def resident(kind):
    """Memory of this process, of Linux [MB]: what is resident (VmRSS), or the most that was (VmHWM)."""
    status = Path("/proc/self/status").read_text()
    return int(status.split(kind + ":")[1].split()[0]) / 1024


def main():
    print(f"{'':<52} {'a flight':>10}  {'one by one':>8} {'of numba':>8}")
    coarse = dispersed(0.5, 50_000, "at least 35 ×, at most 1.6")
    dispersed(0.1, 50_000, "at least 45 ×, at most 1.1")
    shared_fall()
    steered()
    fine = fly_all(*landings(50_000), dt=0.05)
    both = (coarse["outcome"] == "crash") & (fine["outcome"] == "crash")
    off = (coarse["touchdown velocity [m/s]"] - fine["touchdown velocity [m/s]"])[both].abs().max()
    print(f"touchdown speeds with dt = 0.5 s are off by at most {off:.1e} m/s (wanted: 1e-3)")
    for n in (10_000, 100_000, 1_000_000):
        code = f"import ensembles; ensembles.megabytes({n})"
        said = subprocess.check_output([sys.executable, "-c", code], cwd=sys.path[0], text=True)
        memory, each = (float(x) for x in said.split())
        print(f"{n:>9,} landings, dt = 0.1 s: {each:.1f} µs a flight, {memory:.0f} MB above the inputs (wanted: 200)")


if __name__ == "__main__":
    main()
