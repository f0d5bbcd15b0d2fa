"""The simulated plants: mechanics, heat and electronics of a batch of environments, and what may be drawn at random."""

from .config import SimulationConfig
from .pair import HOTTER, Goal, pair_plant
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
    "HOTTER",
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
    "pair_plant",
    "simulated_plant",
]
