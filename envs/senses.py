"""The old name of what thermograsp.envs.spaces holds. It goes with version 0.3."""

import warnings

from .spaces import SIZE, Senses, arm_waits

__all__ = ["SIZE", "Senses", "arm_waits"]

warnings.warn(
    "thermograsp.envs.senses is now thermograsp.envs.spaces: import from there",
    DeprecationWarning,
    stacklevel=2,
)
