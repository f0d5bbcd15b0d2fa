"""Thermal touch for robot grasping: a MuJoCo gripper whose fingertips feel heat, and the same interface on hardware.

Importing the package registers its Gymnasium environments by string and loads neither MuJoCo nor a compiler, so
`gymnasium.make("thermograsp:thermograsp/Grasp-v0")` works and the import stays cheap. The environments come without
Gymnasium's wrappers: they refuse a step before a reset themselves, and what the checker sees is seen by the tests.
"""

from gymnasium.envs.registration import register

__version__ = "0.1.0"

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
