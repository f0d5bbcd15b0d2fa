"""What fingertips feel of their contacts: heat, thermostats and electronics of a batch."""

from typing import TYPE_CHECKING

from thermograsp.doors import opened

if TYPE_CHECKING:
    from .ahead import start_compiling
    from .boxes import served_anywhere, served_in_the_middle
    from .cores import HeatedCores
    from .electronics import Electronics, ElectronicsState
    from .face_temperature import FaceTemperature, FaceTemperatureState
    from .heat import GraspHeat, HeatState, HeatStep
    from .rows import EVENTS
    from .scene_heat import SceneHeat, SceneHeatState, SceneHeatStep
    from .thermostats import Thermostats

__all__ = [
    "EVENTS",
    "Electronics",
    "ElectronicsState",
    "FaceTemperature",
    "FaceTemperatureState",
    "GraspHeat",
    "HeatState",
    "HeatStep",
    "HeatedCores",
    "SceneHeat",
    "SceneHeatState",
    "SceneHeatStep",
    "Thermostats",
    "served_anywhere",
    "served_in_the_middle",
    "start_compiling",
]

__getattr__ = opened(__name__)
