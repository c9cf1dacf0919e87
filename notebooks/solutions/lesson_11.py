"""Solutions to the exercises of lesson 11."""

import numpy as np

from hoverslam_lib import EARTH, FALCON_9

# %% 11.1 · what detector 5 sees, and when
# what is felt is the force of the engine over the mass, in N and kg: gravity is not felt
my_mass = 7.6e6 / (30 * 9.81)
# the tank should be dry at 27 200 kg; from there on the program goes on burning
my_seconds = (27_200 - my_mass) / 1_480


# %% 11.2 · a detector that needs no booster
def my_detector(t, h, v):
    length = np.diff(t)
    # with the mean velocity the distance is right if v changes evenly; it cannot change by more than 300·length, so
    # no velocity in the step is further from the mean than that. And it grows with the step as it must.
    off = np.abs(np.diff(h) - length * (v[1:] + v[:-1]) / 2)
    return bool(np.any(off > 300 * length**2 + 1e-6))


# %% 11.3 · a detector for every step size
def my_air_detector(t_ignite, t, h, v):
    length, middle = np.diff(t), (t[1:] + t[:-1]) / 2
    h_mid, v_mid = (h[1:] + h[:-1]) / 2, (v[1:] + v[:-1]) / 2
    burn_end = t_ignite + FALCON_9.burn_duration
    lit = (middle > t_ignite) & (middle < burn_end)
    push = lit * FALCON_9.thrust / FALCON_9.mass(middle - t_ignite)
    # what gravity and engine leave over is the air; it may only act against the motion. In the middle of a step the
    # difference quotient errs by the square of the step only, so a limit that is safe is still far below a fault
    air = np.diff(v) / length + EARTH.gravity(h_mid) - push
    # a step that holds a switch, or touches one, is half lit: how long that is depends on the step
    clear = np.minimum(np.abs(middle - t_ignite), np.abs(middle - burn_end)) > 1.5 * length
    return bool(np.any((air * np.sign(v_mid))[clear] > 0.05))
