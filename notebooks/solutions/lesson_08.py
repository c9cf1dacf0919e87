"""Solutions to the exercises of lesson 8."""

import numpy as np


# %% 8.1 · the judge as a function
def my_judge(coarse, middle, fine):
    # the exact value drops out of a change, and so does C out of the ratio of two: what stays is 2^p
    ratio = (middle - coarse) / (fine - middle)
    return np.log2(ratio), abs((fine - middle) / (ratio - 1))


# %% 8.2 · the tooth of any method
def my_tooth(theta, nodes, weights, a, dt):
    # only the looks after ignition see the engine; it really pushes for the rest of the step
    seen = sum(weight for node, weight in zip(nodes, weights, strict=True) if node > theta)
    return (seen - (1 - theta)) * a * dt


# %% 8.3 · mend the touchdown
def my_contact(h, v, a, dt):
    inside = v**2 - 2 * a * h
    if inside < 0:  # it turns above the ground; where the step ends says nothing about that
        return None
    # the first root, written so that a = 0 divides nothing by 0; if the divisor is not positive, it never comes down
    divisor = -v + inside**0.5
    if divisor <= 0 or 2 * h / divisor > dt:
        return None
    return 2 * h / divisor
