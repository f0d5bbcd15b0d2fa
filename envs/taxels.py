"""The old name of what thermograsp.envs.footprint holds. It goes with version 0.3."""

import warnings

from .footprint import Taxels

__all__ = ["Taxels"]

warnings.warn(
    "thermograsp.envs.taxels is now thermograsp.envs.footprint: import from there",
    DeprecationWarning,
    stacklevel=2,
)
