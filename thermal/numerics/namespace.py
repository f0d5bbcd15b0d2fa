"""Arrays of NumPy, PyTorch or JAX by one code.

Most of what is computed on arrays of any of them needs operators and methods only, which the three share; this is for
the rest.
"""

from __future__ import annotations

import sys
from types import ModuleType
from typing import Any

import numpy as np

from thermograsp.errors import InvalidValueError

Array = Any
"""A numpy.ndarray, torch.Tensor or jax.Array; of one kind, dtype and device in any one call."""


def namespace_of(array: Array) -> ModuleType:
    """numpy, torch or jax.numpy: where the functions for that array are. Numbers belong to numpy."""
    if isinstance(array, np.ndarray):
        return np
    if hasattr(array, "__array_namespace__"):
        return array.__array_namespace__()
    return sys.modules["torch"] if type(array).__module__.partition(".")[0] == "torch" else np


def as_like(values: np.ndarray | float, like: Array) -> Array:
    """The numbers as an array of like's kind, dtype and device. Raises InvalidValueError where like does not hold
    floating-point numbers. JAX puts them where it puts constants, from where they follow what they are used with."""
    kind = getattr(like, "dtype", type(like).__name__)
    if "float" not in str(kind) or not hasattr(like, "dtype"):
        raise InvalidValueError(f"arrays must be floating point, got {kind}: convert to float32 or float64")
    xp = namespace_of(like)
    if xp is not np and not hasattr(like, "__array_namespace__"):
        return xp.asarray(values, dtype=like.dtype, device=like.device)
    return xp.asarray(values, dtype=like.dtype)


def as_integers(values: Array) -> Array:
    """Whole numbers as integers that may index, of the library's own kind."""
    return values.long() if hasattr(values, "long") else values.astype(int)
