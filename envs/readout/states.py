"""States of fingertips as records of arrays, one row a fingertip: copied, and read and written by environments."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import fields
from typing import Any, TypeVar

import numpy as np

State = TypeVar("State")


def fingertip_rows(environments: Sequence[int]) -> np.ndarray:
    """(B, 2) the rows of the environments' fingertips."""
    return np.array([[2 * row, 2 * row + 1] for row in environments], int)


def arrays_of(state: Any) -> list[np.ndarray]:
    """The arrays of a dataclass's fields, not copied."""
    return [getattr(state, field.name) for field in fields(state)]


def copied(state: State) -> State:
    """The same state with an array of its own in every field, to be written to."""
    return type(state)(*(array.copy() for array in arrays_of(state)))
