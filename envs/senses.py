"""The old name of what thermograsp.envs.spaces holds. It goes with version 0.3."""

import warnings

from .spaces import SIZE, Senses

__all__ = ["SIZE", "Senses"]

warnings.warn(
    "thermograsp.envs.senses is now thermograsp.envs.spaces: import from there",
    DeprecationWarning,
    stacklevel=2,
)
