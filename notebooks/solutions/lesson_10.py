"""Solutions to the exercises of lesson 10."""

# %% 10.1 · a film on paper
# A GIF stores whole hundredths of a second: 0.04 s is only 25 frames a second, so 0.03 s. Slowed five times, a fifth
# of that passes in the flight.
my_spacing = 0.03 / 5
# n spaces have n + 1 ends
my_frames = 6 / 0.006 + 1


# %% 10.2 · the last seconds, whatever the steps
def my_last_rows(t, h, seconds):
    # ask each row for its own time: no length of a step, no number of rows
    keep = t >= t[-1] - seconds
    return t[keep], h[keep]


# %% 10.3 · the velocity between two rows
def my_velocity(t0, h0, v0, t1, h1, v1, t):
    length, rise = t1 - t0, h1 - h0
    s = (t - t0) / length
    # h(s) = h0 + first·s + second·s² + third·s³
    first = length * v0
    second = 3 * rise - 2 * length * v0 - length * v1
    third = length * v0 + length * v1 - 2 * rise
    # by the chain rule dh/dt = dh/ds · ds/dt, and s passes 1 in `length` seconds
    return (first + 2 * second * s + 3 * third * s**2) / length
