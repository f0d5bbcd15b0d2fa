"""MuJoCo scenes, the simulated plant, tasks and the Gymnasium environments."""

from .actions import action_of, action_space, command_of, sliding_action_of
from .fit_fingertip import FingertipReport, fit_fingertip
from .grasp import BatchState, GraspBatch
from .grasp_env import GraspEnv, GraspVectorEnv
from .grasp_task import GraspTask
from .gripper import Gripper, load_gripper
from .identify_env import IdentifyEnv, IdentifyVectorEnv
from .identify_task import IdentifyTask
from .library import ObjectPreset, library_object, objects
from .mechanics import ContactRecord, Mechanics, MechanicsState
from .meshes import MeshShape, load_mesh
from .observation import observation_space
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
from .scene import ObjectSpec, build_scene
from .simulated_plant import PlantState, SimulatedPlant
from .simulation_config import SimulationConfig
from .solver_settings import SolverSettings
from .sort_env import SortEnv, SortVectorEnv
from .sort_task import SortTask
from .stakes import STAKES, force_window
from .things import Thing

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
    "PlantState",
    "Renderer",
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
    "library_object",
    "load_gripper",
    "load_mesh",
    "objects",
    "observation_space",
    "sliding_action_of",
]
