"""Heat of a batch of grasps: from forces and places of every substep to the fingertips' temperature drops."""

from typing import TYPE_CHECKING

from thermograsp.doors import opened

if TYPE_CHECKING:
    from .ahead import start_compiling
    from .boxes import served_anywhere, served_in_the_middle
    from .field_heat import FieldHeat, FieldHeatState, FieldScenes
    from .heat import GraspHeat, HeatState, HeatStep
    from .rows import NEW_PATCH, OVER_TEMPERATURE
    from .scene_heat import SceneHeat, SceneHeatState, SceneHeatStep

__all__ = [
    "NEW_PATCH",
    "OVER_TEMPERATURE",
    "GraspHeat",
    "HeatState",
    "HeatStep",
    "FieldHeat",
    "FieldHeatState",
    "FieldScenes",
    "SceneHeat",
    "SceneHeatState",
    "SceneHeatStep",
    "served_anywhere",
    "served_in_the_middle",
    "start_compiling",
]

__getattr__ = opened(__name__)
