"""MuJoCo scenes, the simulated plant, tasks and the Gymnasium environments.

What reads other grippers is imported when it is first asked for; the shipped one does not need it.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

from thermograsp.doors import opened

from ..thermal import Reservoir, ice, water
from .bodies import (
    MeshShape,
    ObjectPreset,
    ObjectSpec,
    Part,
    library_object,
    load_mesh,
    load_objects,
    objects,
)
from .footprint import GraspBody
from .gym import (
    BatchState,
    GraspBatch,
    GraspEnv,
    GraspVectorEnv,
    IdentifyEnv,
    IdentifyVectorEnv,
    SortEnv,
    SortVectorEnv,
    TouchEnv,
    TouchVectorEnv,
    VectorState,
)
from .mechanics import ContactRecord, Mechanics, MechanicsState, SolverSettings, build_scene
from .pictures import Renderer, Window
from .plant import (
    EVERYTHING,
    Delay,
    Friction,
    Gain,
    Mass,
    Noise,
    ObjectTemperature,
    Offset,
    PlantState,
    Roughness,
    SimulatedPlant,
    SimulationConfig,
    Size,
    ThermostatError,
)
from .spaces import (
    Observer,
    action_of,
    action_space,
    command_of,
    observation_space,
    sliding_action_of,
)
from .tasks import STAKES, GraspTask, IdentifyTask, Outcome, SortTask, Task, force_window

if TYPE_CHECKING:
    from .footprint import Taxels
    from .grippers import FingertipReport, Gripper, GripperModel, fit_fingertip, load_gripper

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
    "GripperModel",
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
    "Observer",
    "Offset",
    "Outcome",
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
    "Task",
    "Taxels",
    "ThermostatError",
    "GraspBody",
    "TouchEnv",
    "TouchVectorEnv",
    "VectorState",
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

__getattr__ = opened(__name__, renamed={"Thing": "GraspBody"})  # until 0.3
