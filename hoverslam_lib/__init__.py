"""Numerical integration, taught by landing a Falcon 9 booster. SI units; h up, v negative while falling."""

from hoverslam_lib.booster import FALCON_9, FALCON_9_LANDING_BURN, Booster
from hoverslam_lib.descent import LANDING_BURN, OUTCOMES, SOFT_SPEED, Descent, Flight, fly, speed_after_fall
from hoverslam_lib.ensemble import fly_all
from hoverslam_lib.ignition import FreeFall, Ignition, NoSoftLanding, best_ignition, hover_height, ignition_table
from hoverslam_lib.integrators import METHODS, Method
from hoverslam_lib.metrics import mape, max_error, nmae, observed_order, rmse
from hoverslam_lib.oscillator import Oscillator
from hoverslam_lib.planet import EARTH, MARS, MOON, Planet
from hoverslam_lib.trajectory import Trajectory, integrate

__all__ = [
    "EARTH",
    "FALCON_9",
    "FALCON_9_LANDING_BURN",
    "LANDING_BURN",
    "MARS",
    "METHODS",
    "MOON",
    "OUTCOMES",
    "SOFT_SPEED",
    "Booster",
    "Descent",
    "Flight",
    "FreeFall",
    "Ignition",
    "Method",
    "NoSoftLanding",
    "Oscillator",
    "Planet",
    "Trajectory",
    "best_ignition",
    "fly",
    "fly_all",
    "hover_height",
    "ignition_table",
    "integrate",
    "mape",
    "max_error",
    "nmae",
    "observed_order",
    "rmse",
    "speed_after_fall",
]

__version__ = "1.1.0"
