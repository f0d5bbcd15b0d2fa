"""Patterns of heat flux over a square patch, as a mesh's grid asks for them: their means over any rectangle."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from ..network import SHIFTS, patch_modes
from ..plates import Geometry, SquarePatch, sample_bodies


@dataclass(frozen=True, slots=True, eq=False)
class PatchPatterns:
    """Patterns of heat flux over a square patch, by their integrals. edges: (T + 1,) 0 .. 1, strips along a half side
    of 1. sums: (T + 1, T + 1, M), each pattern's integral from the middle to the strips' corners, of a quarter that is
    mirrored to the other three. Over the patch a pattern's mean square is 1 and the first one is 1 everywhere."""

    edges: np.ndarray
    sums: np.ndarray

    @property
    def count(self) -> int:
        """M."""
        return self.sums.shape[2]

    def means(self, low: np.ndarray, high: np.ndarray) -> np.ndarray:
        """(n, M) over rectangles with corners low and high (n, 2), in half sides from the middle."""
        corners = np.stack((low, high))
        total = np.zeros((len(low), self.count))
        for i, j in np.ndindex(2, 2):
            total += (1 if i == j else -1) * self._integral(corners[i, :, 0], corners[j, :, 1])
        return total / np.prod(high - low, axis=1)[:, None]

    def _integral(self, u: np.ndarray, v: np.ndarray) -> np.ndarray:
        """(n, M) from the middle to (u, v), counted as the coordinates' signs are."""
        strips = len(self.edges) - 2
        i, a = self._within(np.abs(u), strips)
        j, b = self._within(np.abs(v), strips)
        s = self.sums
        amount = (
            s[i, j] * ((1 - a) * (1 - b))[:, None]
            + s[i + 1, j] * (a * (1 - b))[:, None]
            + s[i, j + 1] * ((1 - a) * b)[:, None]
            + s[i + 1, j + 1] * (a * b)[:, None]
        )
        return np.sign(u * v)[:, None] * amount

    def _within(self, x: np.ndarray, last: int) -> tuple[np.ndarray, np.ndarray]:
        """Strip and the share of it at x (n,)."""
        strip = np.clip(np.searchsorted(self.edges, x, side="right") - 1, 0, last)
        return strip, (x - self.edges[strip]) / np.diff(self.edges)[strip]


def uniform_pattern() -> PatchPatterns:
    """The uniform one alone."""
    ends = np.array([0.0, 1.0])
    return PatchPatterns(ends, np.outer(ends, ends)[:, :, None])


def learned_patterns(geometry: Geometry, count: int) -> PatchPatterns:
    """The patterns that `count` modes of a geometry's square contact are; see modes.py."""
    patch = geometry.patch
    assert isinstance(patch, SquarePatch)
    modes = patch_modes(geometry, sample_bodies(geometry, SHIFTS), SHIFTS, count)
    edges = patch.edges / patch.half_width
    # of the patterns along one axis, whose mean square over the half side is 1
    integrals = patch.shapes * np.sqrt(np.diff(edges))[:, None]
    sums = np.concatenate((np.zeros((1, integrals.shape[1])), np.cumsum(integrals, axis=0)))
    products = (patch.symmetrize @ modes).reshape(sums.shape[1], sums.shape[1], count)
    return PatchPatterns(edges, np.einsum("ta,abm,ub->tum", sums, products, sums, optimize=True))
