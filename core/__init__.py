"""Thermal touch for robot grasping: fingertips of any MuJoCo scene feel heat, and the same interface on hardware.

Importing the package registers its Gymnasium environments by string and loads neither MuJoCo nor a compiler, so
`gymnasium.make("thermograsp:thermograsp/Grasp-v0")` works and the import stays cheap. The environments come without
Gymnasium's wrappers: they refuse a step before a reset themselves, and what the checker sees is seen by the tests.
"""

import logging
from typing import TYPE_CHECKING

from gymnasium.envs.registration import register

from thermograsp.doors import opened

if TYPE_CHECKING:
    from thermograsp import wrappers
    from thermograsp.touch import Fingertip, ThermalBody, ThermalTouch

__all__ = ["Fingertip", "ThermalBody", "ThermalTouch", "wrappers"]

__getattr__ = opened(__name__)

__version__ = "0.2.0"

logging.getLogger(__name__).addHandler(logging.NullHandler())  # quiet until an application listens

register(
    id="thermograsp/Grasp-v0",
    entry_point="thermograsp.envs:GraspEnv",
    vector_entry_point="thermograsp.envs:GraspVectorEnv",
    order_enforce=False,
    disable_env_checker=True,
)

register(
    id="thermograsp/Identify-v0",
    entry_point="thermograsp.envs:IdentifyEnv",
    vector_entry_point="thermograsp.envs:IdentifyVectorEnv",
    order_enforce=False,
    disable_env_checker=True,
)

register(
    id="thermograsp/Sort-v0",
    entry_point="thermograsp.envs:SortEnv",
    vector_entry_point="thermograsp.envs:SortVectorEnv",
    order_enforce=False,
    disable_env_checker=True,
)

del register
