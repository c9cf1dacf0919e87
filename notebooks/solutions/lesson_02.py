"""Solutions to the exercises of lesson 2."""


# %% 2.1 · energy after n steps
def my_energy_factor(omega, dt, n):
    # every step multiplies by 1 + ω²dt², so n steps multiply by its n-th power
    return (1 + omega**2 * dt**2) ** n


# %% 2.2 · two bugs in one loop
def my_run(x, v, dt, n):
    xs = [x]
    for _ in range(n):  # n steps, so n + 1 samples
        a = -x  # at the old x: taken after the move it would be at the new one
        x = x + dt * v
        v = v + dt * a
        xs.append(x)
    return xs


# %% 2.3 · a better answer from two poor ones
def my_extrapolation(coarse, fine, order):
    # exact = coarse + C·dt^p = fine + C·(dt/2)^p; without C:
    return (2**order * fine - coarse) / (2**order - 1)
