"""Solutions to the exercises of lesson 4."""

# %% 4.1 · three droplets in one wind
# the fastest droplet sets the limit, λ dt = 2; the slowest has λ dt = 2 too: each step divides by 3, and 3^7 > 1000
my_step_ms = 1000 * 2 / 4000
my_steps = 7


# %% 4.2 · three bugs in Newton's method
def my_newton(r, u):
    for _ in range(50):
        nudge = 1e-6 * (1 + abs(u))
        slope = (r(u + nudge) - r(u)) / nudge
        u = u - r(u) / slope  # the tangent meets zero on the other side
        if abs(r(u)) < 1e-12:  # a residual of -5 is not small
            return u
    raise ArithmeticError("no zero found in fifty turns")  # the last guess is no answer


# %% 4.3 · the mean of two slopes
def my_trapezoid(f, t, h, v, dt):
    before = f(t, h, v)

    def residual(u):  # the new height goes away first, as in implicit Euler
        return u - v - dt / 2 * (before + f(t + dt, h + dt / 2 * (v + u), u))

    u = v + dt * before
    for _ in range(50):
        r, nudge = residual(u), 1e-6 * (1 + abs(u))
        correction = r * nudge / (residual(u + nudge) - r)
        u = u - correction
        if abs(correction) <= 1e-12 * (abs(v) + abs(u)):
            return h + dt / 2 * (v + u), u
    raise ArithmeticError("Newton's method did not converge")
