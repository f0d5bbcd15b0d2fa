"""What lies beneath a face that is touched, unrolled into cells, and how heat spreads there before it has gone far.

A face that is curved a little is unrolled: cells are along it and along the wall beneath it, whatever else is there
(rims, feet, floors, handles, layers, contents).
"""

from .cells import Part
from .filmed import filmed
from .local import Fineness, LocalKernel, local_kernel
from .rays import Face

__all__ = ["Face", "Fineness", "LocalKernel", "Part", "filmed", "local_kernel"]
