"""The step of many worlds as a pure function of arrays: NumPy, PyTorch, JAX."""

from .grasp import grasp_touch
from .made import fixed_touch, pad_poses
from .state import FixedTouchReading, FixedTouchState
from .step import FixedTouch

__all__ = [
    "FixedTouch",
    "FixedTouchReading",
    "FixedTouchState",
    "fixed_touch",
    "grasp_touch",
    "pad_poses",
]
