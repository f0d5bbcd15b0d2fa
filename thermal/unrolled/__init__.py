"""What lies beneath a face that is touched, unrolled into cells, and how heat fades there before it has gone far.

A face that is curved a little is unrolled: cells are along it and along the wall beneath, whatever else is there (rims,
feet, floors, handles, layers, contents).
"""

from .columns import Fineness, Place
from .filmed import filmed
from .local import LocalKernel, local_kernel
from .rays import Face

__all__ = ["Face", "Fineness", "LocalKernel", "Place", "filmed", "local_kernel"]
