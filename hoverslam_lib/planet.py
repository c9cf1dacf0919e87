"""The planet: its gravity and its air."""

import math
from dataclasses import dataclass

import numpy as np

from hoverslam_lib import _validate

GRAVITATIONAL_CONSTANT = 6.6743e-11
"""G [m³/(kg·s²)], CODATA 2018."""


@dataclass(frozen=True)
class Planet:
    """A round planet with air whose density falls exponentially.

    Parameters
    ----------
    mass : float
        [kg], greater than 0.
    radius : float
        [m], greater than 0.
    surface_density : float
        Density of the air at h = 0 [kg/m³]; 0 for a planet without air.
    scale_height : float
        Height over which the density falls by a factor e [m], greater than 0.
    """

    mass: float
    radius: float
    surface_density: float
    scale_height: float

    def __post_init__(self):
        _validate.number("mass", self.mass, "kg", above=0)
        _validate.number("radius", self.radius, "m", above=0)
        _validate.number("surface_density", self.surface_density, "kg/m³", least=0)
        _validate.number("scale_height", self.scale_height, "m", above=0)

    def gravity(self, h):
        """Gravitational acceleration at height h [m]: positive, m/s² (first term of eq. 1.1)."""
        r = self.radius + h
        return GRAVITATIONAL_CONSTANT * self.mass / (r * r)

    def air_density(self, h):
        """Density of the air at height h [m]: kg/m³ (`rho_air` of Listings 1 and 4)."""
        if not self.surface_density:
            return 0.0 * h
        exp = np.exp if isinstance(h, np.ndarray) else math.exp
        return self.surface_density * exp(-h / self.scale_height)


EARTH = Planet(mass=5.972167867791379e24, radius=6_378_100.0, surface_density=1.3, scale_height=8_400.0)
"""The paper's Earth (Listings 1 and 4; mass and radius as astropy's nominal constants)."""

MARS = Planet(mass=6.4171e23, radius=3_389_500.0, surface_density=0.020, scale_height=11_100.0)
"""NASA Mars Fact Sheet (NSSDCA): mass, volumetric mean radius, surface density about 0.020 kg/m³, scale height."""

MOON = Planet(mass=7.346e22, radius=1_737_400.0, surface_density=0.0, scale_height=10e3)
"""NASA Moon Fact Sheet (NSSDCA): mass, volumetric mean radius. No air: the scale height is without meaning."""
