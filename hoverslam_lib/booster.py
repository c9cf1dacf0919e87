"""The booster: masses, engine and shape."""

import math
from dataclasses import dataclass

import numpy as np

from hoverslam_lib import _columns, _validate


@dataclass(frozen=True)
class Booster:
    """A booster whose engine burns at one rate with one thrust (eq. 1.2 and section 1.3 of the paper).

    Each number may be a column, an array with one number for each row of an ensemble; see `fly_all`.

    Parameters
    ----------
    dry_mass : float or ndarray, shape (n,)
        m_d [kg], greater than 0.
    propellant_mass : float or ndarray, shape (n,)
        m_p [kg] before ignition, greater than 0.
    burn_rate : float or ndarray, shape (n,)
        b, propellant used at full throttle [kg/s], greater than 0.
    thrust : float or ndarray, shape (n,)
        T at full throttle [N], greater than 0.
    drag_coefficient : float or ndarray, shape (n,)
        C_D, dimensionless, at least 0.
    radius : float or ndarray, shape (n,)
        Of the circular cross-section [m], greater than 0.
    """

    dry_mass: float
    propellant_mass: float
    burn_rate: float
    thrust: float
    drag_coefficient: float
    radius: float

    def __post_init__(self):
        _validate.number_or_column("dry_mass", self.dry_mass, "kg", above=0)
        _validate.number_or_column("propellant_mass", self.propellant_mass, "kg", above=0)
        _validate.number_or_column("burn_rate", self.burn_rate, "kg/s", above=0)
        _validate.number_or_column("thrust", self.thrust, "N", above=0)
        _validate.number_or_column("drag_coefficient", self.drag_coefficient, least=0)
        _validate.number_or_column("radius", self.radius, "m", above=0)
        _validate.one_length(_columns.columns(self))

    __eq__, __repr__ = _columns.equal, _columns.shown

    @property
    def area(self):
        """Cross-section A [m²]."""
        return math.pi * self.radius**2

    @property
    def initial_mass(self):
        """Dry mass and propellant together [kg]."""
        return self.dry_mass + self.propellant_mass

    @property
    def burn_duration(self):
        """Time at full throttle until the tank is empty [s]."""
        return self.propellant_mass / self.burn_rate

    def mass(self, burn_time):
        """Mass [kg] after burn_time [s] at full throttle, float or array: eq. 1.2, until the tank is empty."""
        duration = self.burn_duration
        floats = not np.ndim(burn_time) and not np.ndim(duration)
        burnt = min(max(burn_time, 0.0), duration) if floats else np.clip(burn_time, 0.0, duration)
        return self.initial_mass - self.burn_rate * burnt


FALCON_9 = Booster(
    dry_mass=27_200.0,
    propellant_mass=30_000.0,
    burn_rate=1_480.0,
    thrust=7.6e6,
    drag_coefficient=0.5,
    radius=1.83,
)
"""The paper's booster (sections 1.2-1.3, Listing 4), its 7 600 kN in SI units. That is nine engines at lift-off."""

FALCON_9_LANDING_BURN = Booster(
    dry_mass=27_200.0,
    propellant_mass=6_000.0,
    burn_rate=845e3 / (282 * 9.80665),
    thrust=845e3,
    drag_coefficient=0.5,
    radius=1.83,
)
"""The same booster on one engine.

Thrust of one Merlin 1D at sea level, 845 kN, and the diameter of 3.66 m: Falcon User's Guide, SpaceX, September 2021.
Burn rate from 282 s, the specific impulse at sea level that is commonly quoted for that engine. Dry mass and drag
coefficient are the paper's. What is left for the landing burn is not public: 6 t is a round number.
"""
