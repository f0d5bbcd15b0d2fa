"""A box beside cells: its kernel as it is, and cut into the same cells, which tells what these are too coarse for.

M: patterns, T: times.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from ..kernels import FUNCTIONS, NODES, Patches, Tip, basis_shares, basis_terms, box_kernel
from .columns import Columns
from .filmed import filmed
from .rays import Face

_FADED = 1e-4  # of the even pattern's kernel, below which that of others is not told
_TOLD = 2e-5  # m2, diffusivity times time, later than which cells are fine enough by themselves


class Line(NamedTuple):
    """Cells along an axis of a box of unit material. rates: (n,) 1/m2 of their modes. seen: (k, n) of these by k
    functions."""

    rates: np.ndarray
    seen: np.ndarray

    def kernel(self, taus: np.ndarray) -> np.ndarray:
        """(T, k, k) 1/m."""
        return np.einsum(
            "ir,tr,jr->tij", self.seen, np.exp(-np.outer(taus, self.rates)), self.seen, optimize=True
        )


class BoxBeside(NamedTuple):
    """size: (3,) m. patches: the one, on its upper face. jumps: (1, 2, M, E) as box_kernel has them. lines: of its
    cells. film: 1/m, at its lower face."""

    size: tuple[float, float, float]
    patches: Patches
    jumps: np.ndarray
    lines: tuple[Line, Line, Line]
    film: float

    def turn(self, taus: np.ndarray) -> np.ndarray:
        """(T, M, M) X, by which the kernel k of cells is X k X^T without their error, at taus m2."""
        taus = np.minimum(taus, _TOLD)
        terms = basis_terms(self.jumps.shape[2])
        exact, _, port, _, _ = box_kernel(self.size, 1.0, 1.0, 0.0, self.patches, self.jumps, terms, 1, taus)
        exact += np.outer(port, port)
        if self.film > 0:
            exact *= filmed(taus, self.size[2], self.film)[:, None, None]
        # where patterns have faded, both would be singular
        least = _FADED * exact[:, :1, :1] * np.diag(np.arange(exact.shape[1]) > 0)
        factors = (np.linalg.cholesky(each + least) for each in (exact, self._on_cells(taus)))
        return next(factors) @ np.linalg.inv(next(factors))

    def _on_cells(self, taus: np.ndarray) -> np.ndarray:
        x, y, z = (line.kernel(taus) for line in self.lines)
        other = y.copy()
        other[:, :1] = other[:, :, :1] = 0.0  # the even pattern is along the first axis
        cross = np.zeros_like(x)
        cross[:, :, 1:] = x[:, :, :1] * y[:, :1, 1:]
        return z * (x * y[:, :1, :1] + cross + cross.transpose(0, 2, 1) + x[:, :1, :1] * other)


def box_beside(
    face: Face,
    half: float,
    along: tuple[Columns, Columns],
    w: np.ndarray,
    tip: Tip,
    depth: float,
    film: float,
) -> BoxBeside:
    """Below a patch of half a side m. w: edges of cells, the face's 0 among them. film: 1/m, at that depth m."""
    depth = min(depth, -float(w[0]))
    values, lines = [], []
    for axis, columns in enumerate(along):
        low, high = columns.covered
        strips = (low + high) / 2 + (high - low) / 2 * NODES
        even = means(functions(tip)[axis], face.seen(strips, axis) / half)
        even[1:] -= (even[1:] @ np.diff(NODES) / 2)[:, None]
        values.append(even)
        edges = columns.edges
        start, stop = np.searchsorted(edges, np.array(columns.face) + [-1e-9, 1e-9])
        edges = edges[start:stop]
        amounts = _integrals(even, strips, edges) / (high - low)
        lines.append(_line(edges, amounts, 0.0))
    start, stop = np.searchsorted(w, [-depth - 1e-4, 1e-9])
    deep = np.concatenate(([-depth], w[start + 1 : stop - 1], [0.0]))
    deep = deep[np.append(True, np.diff(deep) > 0)]
    lines.append(_line(deep, np.eye(len(deep) - 1)[-1:], film))
    spans = [columns.face for columns in along]
    covered = np.array([columns.covered for columns in along])
    patches = Patches(
        np.array([5]),
        (covered.mean(axis=1) - [low for low, _ in spans])[None],
        (np.diff(covered)[:, 0] / 2)[None],
    )
    (u0, u1), (v0, v1) = spans
    jumps = -np.diff(np.pad(np.array(values), ((0, 0), (0, 0), (1, 1))), axis=2)
    return BoxBeside((u1 - u0, v1 - v0, depth), patches, jumps[None], (lines[0], lines[1], lines[2]), film)


def functions(tip: Tip) -> np.ndarray:
    """(2, M, strips) of the tip's patterns' functions along its two axes, the even one first: over NODES."""
    return basis_shares(tip.basis) @ FUNCTIONS


def means(values: np.ndarray, edges: np.ndarray) -> np.ndarray:
    """(M, n) over strips between edges, of functions (M, strips) that are even between NODES."""
    widths = np.diff(edges)
    return _integrals(values, NODES, edges) / np.where(widths > 0, widths, 1.0)


def _integrals(values: np.ndarray, strips: np.ndarray, edges: np.ndarray) -> np.ndarray:
    upto = np.cumsum(np.pad(values * np.diff(strips), ((0, 0), (1, 0))), axis=1)
    return np.diff([np.interp(edges, strips, row) for row in upto], axis=1)


def _line(edges: np.ndarray, amounts: np.ndarray, film: float) -> Line:
    """amounts: (k, n) of k functions in each cell. film: 1/m at the first cell's end."""
    size = np.diff(edges)
    link = 2 / (size[1:] + size[:-1])
    matrix = np.diag(np.pad(link, (0, 1)) + np.pad(link, (1, 0))) - np.diag(link, 1) - np.diag(link, -1)
    if film > 0:
        matrix[0, 0] += 1 / (1 / film + size[0] / 2)
    root = 1 / np.sqrt(size)
    rates, turn = np.linalg.eigh(root[:, None] * matrix * root)
    return Line(np.maximum(rates, 0.0), amounts @ (root[:, None] * turn))
