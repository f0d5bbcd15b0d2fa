"""The Gymnasium environments, single and vector."""

from .batch import BatchState, GraspBatch
from .grasp import GraspEnv, GraspVectorEnv
from .identify import IdentifyEnv, IdentifyVectorEnv
from .single import TouchEnv
from .sort import SortEnv, SortVectorEnv
from .vector import TouchVectorEnv, VectorState

__all__ = [
    "BatchState",
    "GraspBatch",
    "GraspEnv",
    "GraspVectorEnv",
    "IdentifyEnv",
    "IdentifyVectorEnv",
    "SortEnv",
    "SortVectorEnv",
    "TouchEnv",
    "TouchVectorEnv",
    "VectorState",
]
