"""The simulated plants: mechanics, heat and electronics of a batch of environments, and what may be drawn at random."""

from .config import SimulationConfig
from .pair import Goal
from .randomization import (
    EVERYTHING,
    Delay,
    Friction,
    Gain,
    Mass,
    Noise,
    ObjectTemperature,
    Offset,
    Roughness,
    Size,
    ThermostatError,
)
from .simulated import PlantState, SimulatedPlant, simulated_plant
from .truth import Truth

__all__ = [
    "EVERYTHING",
    "Delay",
    "Friction",
    "Gain",
    "Goal",
    "Mass",
    "Noise",
    "ObjectTemperature",
    "Offset",
    "PlantState",
    "Roughness",
    "SimulatedPlant",
    "SimulationConfig",
    "Size",
    "ThermostatError",
    "Truth",
    "simulated_plant",
]
