"""What lies beneath a face that is touched, unrolled into cells, and how heat fades there before it has gone far.

A face that is curved a little is unrolled: cells are along it and along the wall beneath, whatever else is there (rims,
feet, floors, handles, layers, contents).
"""

from .columns import Fineness, Place
from .filmed import filmed
from .local import LocalCells, LocalKernel, local_cells
from .overlap import overlapped
from .rays import Face
from .spread import Between, SensedPatch, Spread, sensed_patch, spread_beneath

__all__ = [
    "Between",
    "Face",
    "SensedPatch",
    "Fineness",
    "LocalCells",
    "LocalKernel",
    "Place",
    "Spread",
    "sensed_patch",
    "filmed",
    "local_cells",
    "overlapped",
    "spread_beneath",
]
