"""MuJoCo scenes, the simulated plant, tasks and the Gymnasium environments.

What reads other grippers is imported when it is first asked for; the shipped one does not need it.
"""

from __future__ import annotations

from importlib import import_module
from typing import TYPE_CHECKING, Any

from .actions import action_of, action_space, command_of, sliding_action_of
from .contact_record import ContactRecord
from .grasp import BatchState, GraspBatch
from .grasp_env import GraspEnv, GraspVectorEnv
from .grasp_task import GraspTask
from .identify_env import IdentifyEnv, IdentifyVectorEnv
from .identify_task import IdentifyTask
from .library import ObjectPreset, library_object, load_objects, objects
from .mechanics import Mechanics, MechanicsState
from .meshes import MeshShape, load_mesh
from .observation import observation_space
from .parts import Part
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
from .render import Renderer, Window
from .reservoir import Reservoir, ice, water
from .scene import ObjectSpec, build_scene
from .simulated_batch import PlantState
from .simulated_plant import SimulatedPlant
from .simulation_config import SimulationConfig
from .solver_settings import SolverSettings
from .sort_env import SortEnv, SortVectorEnv
from .sort_task import SortTask
from .stakes import STAKES, force_window
from .things import Thing

if TYPE_CHECKING:
    from .fingertip import FingertipReport, fit_fingertip
    from .gripper import Gripper
    from .gripper_load import load_gripper

_LATER = {
    "FingertipReport": "fingertip",
    "fit_fingertip": "fingertip",
    "Gripper": "gripper",
    "load_gripper": "gripper_load",
}


def __getattr__(name: str) -> Any:
    if name not in _LATER:
        raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
    value = getattr(import_module(f".{_LATER[name]}", __name__), name)
    globals()[name] = value
    return value


__all__ = [
    "EVERYTHING",
    "STAKES",
    "BatchState",
    "ContactRecord",
    "Delay",
    "FingertipReport",
    "Friction",
    "Gain",
    "GraspBatch",
    "GraspEnv",
    "GraspTask",
    "GraspVectorEnv",
    "Gripper",
    "IdentifyEnv",
    "IdentifyTask",
    "IdentifyVectorEnv",
    "Mass",
    "Mechanics",
    "MechanicsState",
    "MeshShape",
    "Noise",
    "ObjectPreset",
    "ObjectSpec",
    "ObjectTemperature",
    "Offset",
    "Part",
    "PlantState",
    "Renderer",
    "Reservoir",
    "Roughness",
    "SimulatedPlant",
    "SimulationConfig",
    "Size",
    "SolverSettings",
    "SortEnv",
    "SortTask",
    "SortVectorEnv",
    "ThermostatError",
    "Thing",
    "Window",
    "action_of",
    "action_space",
    "build_scene",
    "command_of",
    "fit_fingertip",
    "force_window",
    "ice",
    "library_object",
    "load_gripper",
    "load_mesh",
    "load_objects",
    "objects",
    "observation_space",
    "sliding_action_of",
    "water",
]
