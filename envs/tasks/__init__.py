"""Tasks: the meaning of actions, reward, success and the end of an episode."""

from .grasp import LIFTED, TOUCHING, GraspTask
from .identify import DECLARES, IdentifyTask
from .sort import SortTask
from .stakes import STAKES, force_window
from .task import Outcome, Task, cleared, stopped

__all__ = [
    "DECLARES",
    "LIFTED",
    "STAKES",
    "TOUCHING",
    "GraspTask",
    "IdentifyTask",
    "Outcome",
    "SortTask",
    "Task",
    "cleared",
    "force_window",
    "stopped",
]
