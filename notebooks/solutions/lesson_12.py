"""Solutions to the exercises of lesson 12."""

import numpy as np

# %% 12.1 · what a wind tunnel is worth
# squares add up; of the seven only the drag's is smaller, 234 m becomes 117 m
my_sigma_hover = (40**2 + 117**2 + 119**2 + 19**2 + 14**2 + 35**2 + 18**2) ** 0.5
# one over the share: the width of the bell over that of the window
my_one_in = (2 * np.pi) ** 0.5 * my_sigma_hover / 0.11


# %% 12.2 · a filter
def my_filter(h, v, a, dt, h_seen, v_seen, trust):
    # where it should be now, exactly for a steady acceleration: the old state is dt too old to be mixed
    h_expected = h + v * dt + a * dt**2 / 2
    v_expected = v + a * dt
    # what was seen only corrects the expectation, by the share that it is trusted
    return h_expected + trust * (h_seen - h_expected), v_expected + trust * (v_seen - v_expected)


# %% 12.3 · the project: a throttle law of your own
def my_throttle(t, h, v, mass):
    v_end, a_end, h_gate, gain = 1.3, 10.0, 30.0, 4.0
    if h > h_gate + 1:
        # far up the lesson's law, but aimed at a gate above the ground: it never divides by a small height
        v_gate_squared = v_end**2 + 2 * a_end * h_gate
        a = (v**2 - v_gate_squared) / (2 * (h - h_gate))
    else:
        # below the gate every height has its velocity. What is missing acts in proportion, so noise stays small
        v_wanted = -((v_end**2 + 2 * a_end * max(h, 0.0)) ** 0.5)
        a = a_end + gain * (v_wanted - v)
    # 845 kN and the plan's drag, k·exp(-h/8400)·v²; what is out of reach the engine clips by itself
    drag = 0.25 * 1.3 * np.exp(-h / 8400) * np.pi * 1.83**2 * v**2
    return (mass * (a + 9.8) - drag) / 845e3
