"""Sums over the lateral eigenfunctions of a cross-section between the patterns of two patches, at complex s.

Sum over m of O_m f(kappa_m) O_m', O the overlaps of the patterns with eigenfunction m. The overlaps are summed one by
one as far as the finest strip needs (some 1e5 wave numbers an axis). f, smooth in ln kappa, is evaluated at every one
of the first wave numbers and beyond them at nodes equally spaced in ln kappa, with cubic interpolation between: some
200 evaluations an axis, at an error of 1e-7. On rectangles it shares nothing with section.py, which it checks.

C: patterns of a patch, L: along one axis, S: samples of s, N: nodes of an axis.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from scipy.sparse import csr_matrix

from .patch import Patch, RoundPatch, SquarePatch
from .section import Disc, Section

_FIRST = 40  # wave numbers evaluated one by one
_SPACING = 0.05  # of the nodes beyond, in ln kappa
_REACH = 25.0  # largest wave number times the width of the finest strip
_SAMPLES = 4  # of s at a time, to bound the memory
_CHUNK = 50_000  # wave numbers at a time

Response = Callable[[np.ndarray, np.ndarray], np.ndarray]  # (s (S, 1), kappa2 (M,)) -> (S, M)


@dataclass(frozen=True, slots=True)
class LateralSum:
    """kappa2: (M,) 1/m2 at which a response is needed. places: in kappa2, of each pair of the axes' nodes on a
    rectangle, of each node on a disc. axes: products of overlaps, (N, L left, L right), of x and y on a rectangle, of
    the radius on a disc. left, right: (L**axes, C) patterns in terms of those of the axes."""

    kappa2: np.ndarray
    places: np.ndarray | slice
    axes: tuple[np.ndarray, ...]
    left: np.ndarray
    right: np.ndarray

    def __call__(self, response: Response, s: np.ndarray) -> np.ndarray:
        """(S, C left, C right) of the response at s (S,)."""
        parts = []
        for i in range(0, len(s), _SAMPLES):
            values = response(s[i : i + _SAMPLES, None], self.kappa2)[:, self.places]
            if np.iscomplexobj(values):  # products of real numbers, which are half as many
                parts.append(self._sum(np.real(values)) + 1j * self._sum(np.imag(values)))
            else:
                parts.append(self._sum(values))
        return np.concatenate(parts)

    def _sum(self, values: np.ndarray) -> np.ndarray:
        if len(self.axes) == 1:
            return np.tensordot(values, self.axes[0], axes=1)
        x, y = self.axes
        strips_left, strips_right = x.shape[1:]
        flat_x, flat_y = x.reshape(len(x), -1), y.reshape(len(y), -1)
        summed = flat_x.T @ (values.reshape(-1, len(x), len(y)) @ flat_y)
        cells = summed.reshape(-1, strips_left, strips_right, strips_left, strips_right).transpose(
            0, 1, 3, 2, 4
        )
        return self.left.T @ cells.reshape(-1, strips_left**2, strips_right**2) @ self.right


def lateral_sum(section: Section, left: Patch, right: Patch) -> LateralSum:
    """The sum over a section's eigenfunctions between the unit patterns of two patches."""
    if isinstance(section, Disc):
        assert isinstance(left, RoundPatch) and isinstance(right, RoundPatch)
        kappa_max = _REACH / min(np.diff(left.edges).min(), np.diff(right.edges).min())
        kappa2, over_left = section.modes(left, kappa_max)
        _, over_right = section.modes(right, kappa_max)
        kappa, products = _gathered(np.sqrt(kappa2), over_left, over_right)
        return LateralSum(
            kappa**2, slice(None), (products,), np.eye(over_left.shape[1]), np.eye(over_right.shape[1])
        )
    assert isinstance(left, SquarePatch) and isinstance(right, SquarePatch)
    kx, x = _along(section.half_x, left, right)
    if section.half_y == section.half_x:  # a response is the same where x and y change places
        lower = np.tril_indices(len(kx))
        places = np.empty((len(kx), len(kx)), int)
        places[lower] = places.T[lower] = np.arange(len(lower[0]))
        kappa2 = kx[lower[0]] ** 2 + kx[lower[1]] ** 2
        return LateralSum(kappa2, places.ravel(), (x, x), left.symmetrize, right.symmetrize)
    ky, y = _along(section.half_y, left, right)
    kappa2 = (kx[:, None] ** 2 + ky**2).ravel()
    return LateralSum(kappa2, slice(None), (x, y), left.symmetrize, right.symmetrize)


def _along(half_width: float, left: SquarePatch, right: SquarePatch) -> tuple[np.ndarray, np.ndarray]:
    finest = min(np.diff(left.edges).min(), np.diff(right.edges).min())
    kappa = np.arange(int(_REACH / finest * half_width / np.pi) + 1) * np.pi / half_width
    over_left = _overlaps(kappa, half_width, left)
    return _gathered(kappa, over_left, over_left if right == left else _overlaps(kappa, half_width, right))


def _overlaps(kappa: np.ndarray, half_width: float, patch: SquarePatch) -> np.ndarray:
    """(M, L): of unit-norm cosines on [0, half_width] with the patch's patterns along an axis."""
    middle, half = (patch.edges[1:] + patch.edges[:-1]) / 2, np.diff(patch.edges) / 2
    scaled = patch.shapes * np.sqrt(2 * half)[:, None]
    overlaps = np.empty((len(kappa), scaled.shape[1]))
    for start in range(0, len(kappa), _CHUNK):
        k = kappa[start : start + _CHUNK, None]
        # integral of cos(kappa x) over a strip, as a product so that narrow strips lose no digits
        overlaps[start : start + _CHUNK] = (np.cos(k * middle) * np.sinc(k * half / np.pi)) @ scaled
    return overlaps / np.sqrt(np.where(kappa == 0, half_width, half_width / 2))[:, None]


def _gathered(kappa: np.ndarray, left: np.ndarray, right: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Nodes (N,) and the products of overlaps (N, left, right) that interpolation hands to each."""
    if len(kappa) <= _FIRST + 4:
        return kappa, left[:, :, None] * right[:, None, :]
    beyond = kappa[_FIRST:]
    nodes = log_nodes(beyond[0], beyond[-1], _SPACING)
    far = np.zeros((len(nodes), left.shape[1] * right.shape[1]))
    for start in range(0, len(beyond), _CHUNK):
        part = slice(start, start + _CHUNK)
        a, b = left[_FIRST:][part], right[_FIRST:][part]
        products = (a[:, :, None] * b[:, None, :]).reshape(len(a), -1)
        far += from_nodes(nodes, beyond[part]).T @ products
    near = left[:_FIRST, :, None] * right[:_FIRST, None, :]
    products = np.concatenate((near, far.reshape(-1, left.shape[1], right.shape[1])))
    return np.concatenate((kappa[:_FIRST], nodes)), products


def log_nodes(low: float, high: float, spacing: float) -> np.ndarray:
    """(N,) from low to high, equally spaced in the logarithm by at most that, four of them at least."""
    return np.geomspace(low, high, max(int(np.ceil(np.log(high / low) / spacing)) + 1, 4))


def from_nodes(nodes: np.ndarray, at: np.ndarray) -> csr_matrix:
    """(M, N) of the cubic interpolation from log_nodes (N,) to places `at` (M,) between them."""
    count = len(nodes)
    place = np.log(at / nodes[0]) * (count - 1) / np.log(nodes[-1] / nodes[0])
    first = np.clip(place.astype(int) - 1, 0, count - 4)
    x = place - first
    weights = np.stack(
        (
            -(x - 1) * (x - 2) * (x - 3) / 6,
            x * (x - 2) * (x - 3) / 2,
            -x * (x - 1) * (x - 3) / 2,
            x * (x - 1) * (x - 2) / 6,
        ),
        axis=1,
    )
    rows = np.arange(len(at) + 1) * 4
    return csr_matrix(
        (weights.ravel(), (first[:, None] + np.arange(4)).ravel(), rows), shape=(len(at), count)
    )
