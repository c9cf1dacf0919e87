"""The planet: its gravity and its air."""

import math
from dataclasses import dataclass

import numpy as np

from hoverslam_lib import _columns, _validate

GRAVITATIONAL_CONSTANT = 6.6743e-11
"""G [m³/(kg·s²)], CODATA 2018."""


@dataclass(frozen=True)
class Planet:
    """A round planet with air whose density falls exponentially.

    Each number may be a column, an array with one number for each row of an ensemble; see `fly_all`.

    Parameters
    ----------
    mass : float or ndarray, shape (n,)
        [kg], greater than 0.
    radius : float or ndarray, shape (n,)
        [m], greater than 0.
    surface_density : float or ndarray, shape (n,)
        Density of the air at h = 0 [kg/m³]; 0 for a planet without air.
    scale_height : float or ndarray, shape (n,)
        Height over which the density falls by a factor e [m], greater than 0.
    """

    mass: float
    radius: float
    surface_density: float
    scale_height: float

    def __post_init__(self):
        _validate.number_or_column("mass", self.mass, "kg", above=0)
        _validate.number_or_column("radius", self.radius, "m", above=0)
        _validate.number_or_column("surface_density", self.surface_density, "kg/m³", least=0)
        _validate.number_or_column("scale_height", self.scale_height, "m", above=0)
        _validate.one_length(_columns.columns(self))

    __eq__, __repr__ = _columns.equal, _columns.shown

    def gravity(self, h):
        """Gravitational acceleration at height h [m]: positive, m/s² (first term of eq. 1.1)."""
        r = self.radius + h
        return GRAVITATIONAL_CONSTANT * self.mass / (r * r)

    def air_density(self, h):
        """Density of the air at height h [m]: kg/m³ (`rho_air` of Listings 1 and 4)."""
        return self.air_density_law()(h)

    def air_density_law(self):
        """Return `air_density` as a function of h that has looked up what does not change: it is called often."""
        if type(self).air_density is not Planet.air_density:  # a planet with an air of its own
            return self.air_density
        surface_density, scale_height = self.surface_density, self._scale_height

        def air_density(h):
            x = -h / scale_height
            exp = math.exp if isinstance(x, float) else np.exp
            return surface_density * exp(x)

        return air_density

    @property
    def deepest(self):
        """How far the air, and the planet itself, can be continued below the ground [m], negative."""
        depth = np.minimum(2 * self._scale_height, self.radius / 2)
        return -depth if np.ndim(depth) else -float(depth)

    @property
    def _scale_height(self):
        """That of the air; inf where there is none, so that its density is 0 at any height."""
        if _validate.is_column(self.surface_density):
            return np.where(self.surface_density > 0, self.scale_height, math.inf)
        return self.scale_height if self.surface_density else math.inf


EARTH = Planet(mass=5.972167867791379e24, radius=6_378_100.0, surface_density=1.3, scale_height=8_400.0)
"""The paper's Earth (Listings 1 and 4; mass and radius as astropy's nominal constants)."""

MARS = Planet(mass=6.4171e23, radius=3_389_500.0, surface_density=0.020, scale_height=11_100.0)
"""NASA Mars Fact Sheet (NSSDCA): mass, volumetric mean radius, surface density about 0.020 kg/m³, scale height."""

MOON = Planet(mass=7.346e22, radius=1_737_400.0, surface_density=0.0, scale_height=10e3)
"""NASA Moon Fact Sheet (NSSDCA): mass, volumetric mean radius. No air: the scale height is without meaning."""
