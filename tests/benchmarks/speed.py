"""Ratios of speed, measured side by side in one run: ``python tests/benchmarks/speed.py``."""

import subprocess
import sys
import time

import numpy as np
from scipy.integrate import solve_ivp
from scipy.optimize import brentq

from hoverslam_lib import Descent, best_ignition, fly

DESCENT = Descent()
BOOSTER = DESCENT.booster
T_IGNITE = 60.3  # a crash, so that both ways fly the same 72 s


def listing_way():
    """One flight as Listing 4 does it: tables built in every step, small arrays in loops, np.append for every row."""

    def acceleration(t, h, v):
        mass = BOOSTER.mass(t - T_IGNITE)
        total = -DESCENT.planet.gravity(h) + DESCENT.drag(h, v) / mass
        return total + BOOSTER.thrust / mass if t > T_IGNITE else total

    def step(t, h, v, dt):
        nodes = np.array([0, 0.25, 0.375, 12 / 13, 1.0])
        weights_h = np.array([253 / 2160, 0, 4352 / 12825, 2197 / 41040, -0.01])
        weights_v = np.array([25 / 216, 0, 1408 / 2565, 2197 / 4104, -0.2])
        rows_h = np.array(
            [
                [0, 0, 0, 0, 0],
                [1 / 32, 0, 0, 0, 0],
                [9 / 256, 9 / 256, 0, 0, 0],
                [27342 / 142805, -49266 / 142805, 82764 / 142805, 0, 0],
                [5 / 18, -2 / 3, 8 / 9, 0, 0],
            ]
        )
        rows_v = np.array(
            [
                [0, 0, 0, 0, 0],
                [0.25, 0, 0, 0, 0],
                [3 / 32, 9 / 32, 0, 0, 0],
                [1932 / 2197, -7200 / 2197, 7296 / 2197, 0, 0],
                [439 / 216, -8.0, 3680 / 513, -845 / 4104, 0],
            ]
        )
        stages = np.zeros(5)
        weighted_h = weighted_v = 0
        for i in range(5):
            sum_h = sum_v = 0
            for j in range(i):
                sum_h += rows_h[i][j] * stages[j]
                sum_v += rows_v[i][j] * stages[j]
            stages[i] = acceleration(t + nodes[i] * dt, h + v * nodes[i] * dt + dt * dt * sum_h, v + dt * sum_v)
            weighted_h += weights_h[i] * stages[i]
            weighted_v += weights_v[i] * stages[i]
        return h + dt * v + dt * dt * weighted_h, v + dt * weighted_v

    t, h, v, dt = 0.0, DESCENT.height, DESCENT.velocity, 0.02
    data = np.array([[t, h, v]])
    while h > 0 and v < 0:
        h, v = step(t, h, v, dt)
        t += dt
        data = np.append(data, [[t, h, v]], axis=0)
    return data


def brent_over_solve_ivp():
    """The optimum by Brent's method, each evaluation a whole flight by `solve_ivp` at rtol 1e-12."""

    def hover(t, y):
        return y[1]

    hover.terminal, hover.direction = True, 1
    settings = {"method": "DOP853", "rtol": 1e-12, "atol": 1e-9}
    coasting = DESCENT.acceleration()

    def missed_by(t_ignite):
        start = [DESCENT.height, DESCENT.velocity]
        fall = solve_ivp(lambda t, y: (y[1], coasting(t, *y)), (0, t_ignite), start, **settings)
        burning = DESCENT.acceleration(throttle=1.0, since=t_ignite)
        span = (t_ignite, t_ignite + BOOSTER.burn_duration)
        burn = solve_ivp(lambda t, y: (y[1], burning(t, *y)), span, fall.y[:, -1], events=hover, **settings)
        return burn.y[0, -1]

    return brentq(missed_by, 1.0, fly(DESCENT, None).t[-1], xtol=1e-11)


def import_time(package):
    code = f"import time; t = time.perf_counter(); import {package}; print(time.perf_counter() - t)"
    return min(float(subprocess.check_output([sys.executable, "-c", code])) for _ in range(7))


def shortest(rounds, *functions):
    """Shortest time of each function [s], run in turns: what else the machine does disturbs all of them alike."""
    times = [[] for _ in functions]
    for _ in range(rounds):
        for function, taken in zip(functions, times, strict=True):
            start = time.perf_counter()
            function()
            taken.append(time.perf_counter() - start)
    return [min(taken) for taken in times]


def main():
    ours, same_method, listing = shortest(
        20, lambda: fly(DESCENT, T_IGNITE), lambda: fly(DESCENT, T_IGNITE, method="rkn4"), listing_way
    )
    print(f"one flight, dt = 0.02 s: fly {1e3 * ours:.1f} ms, the listing's way {1e3 * listing:.0f} ms")
    print(f"    fly with rk4 is {listing / ours:.1f} times faster (wanted: 8)")
    print(f"    fly with the listing's own method, rkn4, is {listing / same_method:.1f} times faster")

    ours, brent = shortest(30, lambda: best_ignition(DESCENT), brent_over_solve_ivp)
    print(f"best ignition: ours {1e3 * ours:.1f} ms, Brent over solve_ivp {1e3 * brent:.0f} ms")
    print(f"    ours is {brent / ours:.1f} times faster (wanted: 20)")

    with_us, numpy_alone = import_time("hoverslam_lib"), import_time("numpy")
    print(f"import: numpy {numpy_alone:.3f} s, hoverslam_lib {with_us:.3f} s, {with_us - numpy_alone:.3f} s more")
    print("    (wanted: at most 0.1 s more)")


if __name__ == "__main__":
    main()
