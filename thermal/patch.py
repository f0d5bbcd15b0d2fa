"""Contact patches cut into cells of constant heat flux, graded toward the edge where the flux is nearly singular."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

CELLS_PER_HALF_SIDE = 9
GRADING = 0.47


def graded_edges(half_width: float, cells: int = CELLS_PER_HALF_SIDE, grading: float = GRADING) -> np.ndarray:
    """Cell boundaries (cells + 1,) m from the middle to the edge, each cell `grading` of the one before."""
    widths = grading ** np.arange(cells)
    edges = np.concatenate(([0.0], np.cumsum(widths)))
    return half_width * edges / edges[-1]


@dataclass(frozen=True, slots=True)
class SquarePatch:
    """A square patch in the middle of a face, cut into products of strips.

    half_width: m. Only flux patterns with the square's own symmetry are kept (those a centred press excites on a
    square cross-section); with square=False the two axes are kept apart (rectangular cross-sections).
    """

    half_width: float
    square: bool = True

    @property
    def area(self) -> float:
        """m2."""
        return 4 * self.half_width**2

    @property
    def edges(self) -> np.ndarray:
        """m, along one half side."""
        return graded_edges(self.half_width)

    @property
    def symmetrize(self) -> np.ndarray:
        """(strips * strips, C): orthonormal patterns in terms of the products of unit-norm strips."""
        n = CELLS_PER_HALF_SIDE
        if not self.square:
            return np.eye(n * n)
        columns = []
        for i in range(n):
            for j in range(i + 1):
                column = np.zeros((n, n))
                column[i, j] = column[j, i] = 1.0
                columns.append(column.ravel() / np.linalg.norm(column))
        return np.stack(columns, axis=1)

    @property
    def uniform(self) -> np.ndarray:
        """(C,): the uniform pattern of mean square 1 over the patch, a unit vector."""
        widths = np.diff(self.edges)
        strips = np.sqrt(widths / self.half_width)
        return self.symmetrize.T @ np.kron(strips, strips)

    @property
    def rings(self) -> np.ndarray:
        """(C, strips): concentric square rings, each a unit vector, the innermost first."""
        n = CELLS_PER_HALF_SIDE
        widths = np.diff(self.edges)
        cell = np.sqrt(np.outer(widths, widths))
        index = np.maximum.outer(np.arange(n), np.arange(n))
        columns = [np.where(index == ring, cell, 0.0).ravel() for ring in range(n)]
        return self.symmetrize.T @ np.stack([c / np.linalg.norm(c) for c in columns], axis=1)


@dataclass(frozen=True, slots=True)
class RoundPatch:
    """A round patch in the middle of a round face, cut into rings. radius: m."""

    radius: float

    @property
    def area(self) -> float:
        """m2."""
        return np.pi * self.radius**2

    @property
    def edges(self) -> np.ndarray:
        """m, radii."""
        return graded_edges(self.radius)

    @property
    def uniform(self) -> np.ndarray:
        """(C,): the uniform pattern of mean square 1 over the patch, a unit vector."""
        return np.sqrt(np.diff(self.edges**2)) / self.radius

    @property
    def rings(self) -> np.ndarray:
        """(C, C): the cells themselves."""
        return np.eye(len(self.edges) - 1)


Patch = SquarePatch | RoundPatch
