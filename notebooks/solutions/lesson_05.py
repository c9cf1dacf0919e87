"""Solutions to the exercises of lesson 5."""

# %% 5.1 · reading work and precision
# the line of rk4 crosses 1e-8 a little before 3000; at 1000 looks the lines are some 1.3 powers of ten apart
my_looks = 2800
my_ratio = 18
# order 4: a thousand times more accurate costs 1000^(1/4) times as many looks as the 5100 for 1e-9
my_far_looks = 5100 * 1000**0.25


# %% 5.2 · order 4 on the spring, order 1 on the pendulum
def my_three_eighths(f, t, h, v, dt):
    k1h, k1v = v, f(t, h, v)
    k2h = v + dt / 3 * k1v
    k2v = f(t + dt / 3, h + dt / 3 * k1h, k2h)
    k3h = v + dt * (k2v - k1v / 3)
    k3v = f(
        t + 2 * dt / 3, h + dt * (k2h - k1h / 3), k3h
    )  # the third look is two thirds on: no spring can tell
    k4h = v + dt * (k1v - k2v + k3v)
    k4v = f(
        t + dt, h + dt * (k1h - k2h + k3h), k4h
    )  # at its own velocity: without friction nobody notices
    h_new = h + dt / 8 * (k1h + 3 * k2h + 3 * k3h + k4h)
    v_new = v + dt / 8 * (k1v + 3 * k2v + 3 * k3v + k4v)
    return h_new, v_new


# %% 5.3 · every explicit Runge-Kutta method at once
def my_step_from_table(f, t, h, v, dt, A, b):
    slopes_h, slopes_v = [], []
    for row in A:
        # strict=False: only so many slopes are known yet, and the rest of the row is zeros
        v_look = v + dt * sum(a * k for a, k in zip(row, slopes_v, strict=False))
        h_look = h + dt * sum(a * k for a, k in zip(row, slopes_h, strict=False))
        slopes_v.append(f(t + dt * sum(row), h_look, v_look))
        slopes_h.append(v_look)  # the slope of h is the velocity where one looks
    h_new = h + dt * sum(weight * k for weight, k in zip(b, slopes_h, strict=True))
    v_new = v + dt * sum(weight * k for weight, k in zip(b, slopes_v, strict=True))
    return h_new, v_new
