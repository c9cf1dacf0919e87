"""Solutions to the exercises of lesson 6."""

import math

from hoverslam_lib import Descent

booster, planet = Descent().booster, Descent().planet  # as in the lesson

# %% 6.1 · how terminal velocity scales
# it goes with the root of m/ρ: that is all that changes, for g hardly does
my_empty = 405 * math.sqrt(27.2 / 57.2)
my_high = 405 * math.sqrt(math.e)
my_height_km = 8.4 * math.log(2**2)  # twice the speed needs a quarter of the density


# %% 6.2 · drag in a wind
def my_drag_in_wind(h, v, wind):
    relative = v - wind  # what the air feels of the booster; the ground does not come into it
    return (
        -0.5
        * planet.air_density(h)
        * booster.drag_coefficient
        * booster.area
        * abs(relative)
        * relative
    )


# %% 6.3 · what the air has taken
def my_energy_for_the_air(flight):
    here = flight.descent.planet
    # the weight is no loss: what it pays comes back as speed; what is missing from the sum has gone into the air
    potential = -flight.mass * here.gravity(flight.h) * (here.radius + flight.h)  # -GMm/(R + h)
    energy = 0.5 * flight.mass * flight.v**2 + potential
    return energy[0] - energy
