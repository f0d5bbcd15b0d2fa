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
_FINE_ENOUGH = 2e-5  # m2, diffusivity times time, later than which cells are fine enough by themselves


class Line(NamedTuple):
    """Cells along an axis of a box of unit material. edges: (n + 1,) m. rates: (n,) 1/m2 of their modes, and waves:
    (n, n), these in the cells."""

    edges: np.ndarray
    rates: np.ndarray
    waves: np.ndarray

    def kernel(self, amounts: np.ndarray, others: np.ndarray, taus: np.ndarray) -> np.ndarray:
        """(T, k, l) 1/m of functions by others, of which these amounts (k, n) and (l, n) are in the cells."""
        fading = np.exp(-np.outer(taus, self.rates))
        return (amounts @ self.waves * fading[:, None]) @ (others @ self.waves).T


class Flows(NamedTuple):
    """Into a part of a box's upper face. covered: (2, 2) m along u and v, from where to where. values: (2, M, strips)
    of the patterns' functions along u and v, over NODES between these, the even one first."""

    covered: np.ndarray
    values: np.ndarray

    @property
    def jumps(self) -> np.ndarray:
        """(2, M, E) as box_kernel has them."""
        return -np.diff(np.pad(self.values, ((0, 0), (0, 0), (1, 1))), axis=2)

    def amounts(self, axis: int, edges: np.ndarray) -> np.ndarray:
        """(M, n) in cells along u or v."""
        low, high = self.covered[axis]
        return _integrals(self.values[axis], _strips(low, high), edges) / (high - low)


class BoxBeside(NamedTuple):
    """size: (3,) m. start: (2,) m of u and v where it begins. flows: into what of the patch is on its upper face.
    lines: of its cells. film: 1/m, at its lower face."""

    size: tuple[float, float, float]
    start: np.ndarray
    flows: Flows
    lines: tuple[Line, Line, Line]
    film: float

    def turn(self, taus: np.ndarray) -> np.ndarray:
        """(T, M, M) X, by which the kernel k of cells is X k X^T without their error, at taus m2."""
        taus = np.minimum(taus, _FINE_ENOUGH)
        exact, on_cells = self.exact(self.flows, taus), self.on_cells(self.flows, taus)
        # where patterns have faded, both would be singular
        least = _FADED * exact[:, :1, :1] * np.diag(np.arange(exact.shape[1]) > 0)
        factors = (np.linalg.cholesky(each + least) for each in (exact, on_cells))
        return next(factors) @ np.linalg.inv(next(factors))

    def exact(self, other: Flows, taus: np.ndarray) -> np.ndarray:
        """(T, M, M) 1/m3 of the patch by another's flows."""
        both = [self.flows] if other is self.flows else [self.flows, other]
        covered = np.array([each.covered for each in both])
        patches = Patches(
            np.full(len(both), 5), covered.mean(axis=2) - self.start, np.diff(covered, axis=2)[..., 0] / 2
        )
        jumps, count = np.array([each.jumps for each in both]), other.values.shape[1]
        found, _, port, _, _ = box_kernel(
            self.size, 1.0, 1.0, 0.0, patches, jumps, basis_terms(count), len(both), taus
        )
        found = (found + np.outer(port, port))[:, :count, -count:]
        return found * filmed(taus, self.size[2], self.film)[:, None, None] if self.film > 0 else found

    def on_cells(self, other: Flows, taus: np.ndarray) -> np.ndarray:
        """The same where it is cut into cells."""
        x, y = (
            line.kernel(self.flows.amounts(axis, line.edges), other.amounts(axis, line.edges), taus)
            for axis, line in enumerate(self.lines[:2])
        )
        deep = self.lines[2]
        top = np.eye(len(deep.rates))[-1:]
        later = y.copy()
        later[:, :1] = later[:, :, :1] = 0.0  # the even pattern is along the first axis
        found = x * y[:, :1, :1] + x[:, :1, :1] * later
        found[:, :, 1:] += x[:, :, :1] * y[:, :1, 1:]
        found[:, 1:] += x[:, :1] * y[:, 1:, :1]
        return deep.kernel(top, top, taus) * found


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
    lines = []
    for columns in along:
        start, stop = np.searchsorted(columns.edges, np.array(columns.face) + [-1e-9, 1e-9])
        lines.append(_line(columns.edges[start:stop], 0.0))
    start, stop = np.searchsorted(w, [-depth - 1e-4, 1e-9])
    deep = np.concatenate(([-depth], w[start + 1 : stop - 1], [0.0]))
    lines.append(_line(deep[np.append(True, np.diff(deep) > 0)], film))
    flows = flows_along(face, half, functions(tip), np.array([columns.covered for columns in along]))
    (u0, u1), (v0, v1) = (columns.face for columns in along)
    size = u1 - u0, v1 - v0, depth
    return BoxBeside(size, np.array([u0, v0]), flows, (lines[0], lines[1], lines[2]), film)


def flows_along(
    face: Face,
    half: float,
    values: np.ndarray,
    covered: np.ndarray,
    middle: tuple[float, float] = (0.0, 0.0),
) -> Flows:
    """Through a square of half a side m. values: (2, M, strips), functions' along u and v. covered: (2, 2) m of it
    along these. middle: m along the face, where the square is."""
    found = []
    for axis, each in enumerate(values):
        part = means(each, face.seen(_strips(*covered[axis]) - middle[axis], axis) / half)
        part[1:] -= (part[1:] @ np.diff(NODES) / 2)[:, None]
        found.append(part)
    return Flows(covered, np.array(found))


def _strips(low: float, high: float) -> np.ndarray:
    return (low + high) / 2 + (high - low) / 2 * NODES


def functions(tip: Tip) -> np.ndarray:
    """(2, M, strips) of the tip's patterns' functions along its two axes, the even one first: over NODES."""
    return basis_shares(tip.basis) @ FUNCTIONS


def means(values: np.ndarray, edges: np.ndarray) -> np.ndarray:
    """(M, n) over strips between edges, of functions (M, strips) that are even between NODES."""
    widths = np.diff(edges)
    return _integrals(values, NODES, edges) / np.where(widths > 0, widths, 1.0)


def _integrals(values: np.ndarray, strips: np.ndarray, edges: np.ndarray) -> np.ndarray:
    upto = np.zeros((len(values), len(strips)))
    np.cumsum(values * np.diff(strips), axis=1, out=upto[:, 1:])
    return np.diff([np.interp(edges, strips, row) for row in upto], axis=1)


def _line(edges: np.ndarray, film: float) -> Line:
    """film: 1/m at the first cell's end."""
    size = np.diff(edges)
    link = 2 / (size[1:] + size[:-1])
    matrix = np.diag(np.pad(link, (0, 1)) + np.pad(link, (1, 0))) - np.diag(link, 1) - np.diag(link, -1)
    if film > 0:
        matrix[0, 0] += 1 / (1 / film + size[0] / 2)
    root = 1 / np.sqrt(size)
    rates, turn = np.linalg.eigh(root[:, None] * matrix * root)
    return Line(edges, np.maximum(rates, 0.0), root[:, None] * turn)
