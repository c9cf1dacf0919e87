"""Solutions to the exercises of lesson 3."""

import numpy as np

# %% 3.1 · ahead of time
# The frequency is too high by the fraction dt²/24, so a step three times as long gains nine times as much time.
my_lead = 9 * 28.7
# Half a period is π s; the run gains my_lead milliseconds in every ten periods.
my_periods = 10 * 3141.6 / my_lead


# %% 3.2 · a push in two halves
def my_verlet(f, t, h, v, dt):
    half = v + dt / 2 * f(t, h, v)  # belongs to the middle of the move, which is why the order is 2
    h = h + dt * half
    return h, half + dt / 2 * f(t + dt, h, half)  # asked anew: the force has changed on the way


# %% 3.3 · a meter for area
def my_area_factor(step, f, x, v, dt):
    side = 1e-4  # small: only then does a curved force act like a straight one on the whole shape
    corners_x, corners_v = x + side * np.array([0, 1, 0]), v + side * np.array([0, 0, 1])
    new_x, new_v = step(f, 0.0, corners_x, corners_v, dt)
    # twice the area of the triangle, from its sides: differences, so no digits are lost far from the origin
    (p, q), (r, s) = np.diff(new_x), np.diff(new_v)
    return abs(p * s - q * r) / side**2
