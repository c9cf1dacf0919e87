"""Solutions to the exercises of lesson 7."""

from hoverslam_lib import EARTH

# %% 7.1 · how hard they brake
# read off the picture: as printed from about 60.8 s to 70.4 s, our ledger from about 61.9 s to 69.2 s
my_printed_braking = 1500 / (70.4 - 60.8) / 9.81
my_ledger_braking = 1500 / (69.2 - 61.9) / 9.81


# %% 7.2 · a ledger for a balloon
def my_balloon(h, v, mass, volume, area):
    weight = -mass * EARTH.gravity(h)
    # the air around would hold up air in the balloon's place: so it pushes up with the weight of that air
    buoyancy = EARTH.air_density(h) * volume * EARTH.gravity(h)
    drag = -0.5 * EARTH.air_density(h) * 0.5 * area * abs(v) * v  # against the motion, up or down
    return (weight + buoyancy + drag) / mass


# %% 7.3 · a hoverslam on paper
def my_paper_hoverslam(h0, v0, g, a):
    # at the ignition height x the fall has v² = v0² + 2g(h0 - x), and braking over x needs v² = 2ax; so
    x = (v0**2 + 2 * g * h0) / (2 * (a + g))
    v = -((2 * a * x) ** 0.5)  # it comes down, so the negative root
    return (v0 - v) / g, x
