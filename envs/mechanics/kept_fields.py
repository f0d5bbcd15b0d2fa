"""Fields of compiled models, kept by the objects that they were compiled of."""

from __future__ import annotations

from collections.abc import Mapping
from typing import NamedTuple

import numpy as np

from ..bodies import ObjectSpec

_BLOCK = 1 << 20  # bytes
_ALIGNED = 8  # bytes, of the widest number


class _Place(NamedTuple):
    """Where a field lies: from a byte of a block on."""

    name: str
    block: np.ndarray
    start: int
    dtype: np.dtype
    shape: tuple[int, ...]


class KeptFields:
    """The fields of the `most` models that were added last. They lie one behind another in a few large blocks. As
    arrays of their own they would be scattered over the memory that compiling a model takes and returns, 14 MB and more
    each time, and would keep all of it with this process: gigabytes where every episode draws a size."""

    def __init__(self, most: int) -> None:
        self._most = most
        self._places: dict[tuple[ObjectSpec, ...], tuple[_Place, ...]] = {}
        self._block = np.zeros(_BLOCK, np.uint8)
        self._taken = 0

    def __len__(self) -> int:
        return len(self._places)

    def __contains__(self, objects: tuple[ObjectSpec, ...]) -> bool:
        return objects in self._places

    def __getitem__(self, objects: tuple[ObjectSpec, ...]) -> dict[str, np.ndarray]:
        """By name; they are not to be written to."""
        return {place.name: _array(place) for place in self._places[objects]}

    def add(self, objects: tuple[ObjectSpec, ...], fields: Mapping[str, np.ndarray]) -> None:
        """Keeps copies of these; those that were added the longest ago go."""
        while len(self._places) >= self._most:
            del self._places[next(iter(self._places))]
        self._places[objects] = tuple(self._copied(name, values) for name, values in fields.items())

    def _copied(self, name: str, values: np.ndarray) -> _Place:
        if self._taken + values.nbytes > len(self._block):
            # The last block goes with the last model that has a field in it.
            self._block, self._taken = np.zeros(max(_BLOCK, values.nbytes), np.uint8), 0
        place = _Place(name, self._block, self._taken, values.dtype, values.shape)
        _array(place)[...] = values
        self._taken += -(-values.nbytes // _ALIGNED) * _ALIGNED
        return place


def _array(place: _Place) -> np.ndarray:
    return np.ndarray(place.shape, place.dtype, place.block.data, place.start)
