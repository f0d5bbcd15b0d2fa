"""The scene, and the batched mechanics of a gripper over a table on MuJoCo."""

from .batch import Mechanics, MechanicsState
from .contact_record import ContactRecord
from .kernel import Motion
from .scene import build_scene, element_geom, refuse_overlap, scene_spec
from .solver_settings import SHIPPED, SolverSettings

__all__ = [
    "SHIPPED",
    "ContactRecord",
    "Mechanics",
    "MechanicsState",
    "Motion",
    "SolverSettings",
    "build_scene",
    "element_geom",
    "refuse_overlap",
    "scene_spec",
]
