"""Simple harmonic motion: the test problem of the paper's section 4, whose exact solution is known."""

from dataclasses import dataclass

import numpy as np

from hoverslam_lib import _validate


@dataclass(frozen=True)
class Oscillator:
    """A mass on a spring, ẍ = -(k/m)·x (eq. 4.1).

    Parameters
    ----------
    stiffness : float
        Spring constant k [N/m], greater than 0.
    mass : float
        m [kg], greater than 0.
    x0, v0 : float
        Displacement [m] and velocity [m/s] at t = 0.
    """

    stiffness: float = 1.0
    mass: float = 1.0
    x0: float = 3.0
    v0: float = 0.0

    def __post_init__(self):
        _validate.number("stiffness", self.stiffness, "N/m", above=0)
        _validate.number("mass", self.mass, "kg", above=0)
        _validate.number("x0", self.x0, "m")
        _validate.number("v0", self.v0, "m/s")

    @property
    def angular_frequency(self):
        """ω = √(k/m) [rad/s]."""
        return float(np.sqrt(self.stiffness / self.mass))

    @property
    def period(self):
        """2π/ω [s]."""
        return 2 * np.pi / self.angular_frequency

    def acceleration(self, t, x, v):
        """ẍ [m/s²] (eq. 4.1). It depends on x alone; t and v are there because every f(t, h, v) has them."""
        return -self.stiffness / self.mass * x

    def exact(self, t):
        """Displacement [m] and velocity [m/s] at time t [s], float or array: eq. 4.2 with the √(k/m) that it lacks."""
        w = self.angular_frequency
        x = self.x0 * np.cos(w * t) + self.v0 / w * np.sin(w * t)
        v = -self.x0 * w * np.sin(w * t) + self.v0 * np.cos(w * t)
        return x, v

    def energy(self, x, v):
        """Kinetic plus spring energy [J], constant along the exact solution."""
        return 0.5 * self.mass * v**2 + 0.5 * self.stiffness * x**2
