"""Lateral heat conduction in a body of constant cross-section, seen through a patch.

In a body with adiabatic sides the lateral and the axial coordinate separate. Lateral eigenfunctions are cosines on a
rectangle and Bessel functions on a disc; the product of their heat kernels over two patch cells is all that the
three-dimensional problem needs of the cross-section (Carslaw & Jaeger, Conduction of Heat in Solids, 2nd ed.,
sections 10.3 and 14.1).

C: patterns of the patch, M: lateral eigenfunctions, J: diffusion lengths squared.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cache

import numpy as np
from scipy.special import erf, j0, j1, jn_zeros

from .patch import Patch, RoundPatch, SquarePatch

_DIRECT, _MIRRORED = np.arange(-1, 2), np.arange(-2, 2)
"""Images nearer than heat goes in tau up to _COSINES_FROM W^2, in widths 2 W: beyond 2.7 W it is below round-off."""
_COSINES_FROM = 0.05  # tau / W^2 above which the cosine series is the shorter one


@dataclass(frozen=True, slots=True)
class Rectangle:
    """A rectangular cross-section. half_x, half_y: m, half widths of a rectangular cross-section, the patch in its
    middle."""

    half_x: float
    half_y: float

    @property
    def area(self) -> float:
        """m2."""
        return 4 * self.half_x * self.half_y

    @property
    def slowest(self) -> float:
        """Squared wave number 1/m2 of the longest eigenfunction that is not uniform and is even in both coordinates."""
        return (np.pi / max(self.half_x, self.half_y)) ** 2

    def modes(self, patch: Patch, kappa_max: float) -> tuple[np.ndarray, np.ndarray]:
        """Squared wave numbers (M,) 1/m2 up to kappa_max and overlaps (M, C) with the unit-norm patterns."""
        assert isinstance(patch, SquarePatch)
        kx, ox = _cosine_overlaps(patch.edges, self.half_x, kappa_max)
        ky, oy = _cosine_overlaps(patch.edges, self.half_y, kappa_max)
        ox, oy = ox @ patch.shapes, oy @ patch.shapes
        kappa2 = (kx[:, None] ** 2 + ky[None, :] ** 2).ravel()
        overlaps = np.einsum("mi,nj->mnij", ox, oy).reshape(len(kappa2), -1) @ patch.symmetrize
        keep = kappa2 <= kappa_max**2
        return kappa2[keep], overlaps[keep]

    def kernel(self, patch: Patch, tau: np.ndarray) -> np.ndarray:
        """(J, C, C): lateral heat kernel between the patterns at the diffusion lengths squared tau (J,) m2."""
        assert isinstance(patch, SquarePatch)
        shapes = patch.shapes
        x = y = shapes.T @ _strip_kernel(patch.edges, self.half_x, tau) @ shapes
        if self.half_y != self.half_x:
            y = shapes.T @ _strip_kernel(patch.edges, self.half_y, tau) @ shapes
        return _symmetric_products(x, y) if patch.square else _products(x, y)


@dataclass(frozen=True, slots=True)
class Disc:
    """A round cross-section. radius: m of a round cross-section, the patch in its middle."""

    radius: float

    @property
    def area(self) -> float:
        """m2."""
        return np.pi * self.radius**2

    @property
    def slowest(self) -> float:
        """Squared wave number 1/m2 of the longest eigenfunction that is not uniform and does not vary around."""
        return float(_bessel_zeros(1)[0] / self.radius) ** 2

    def modes(self, patch: Patch, kappa_max: float) -> tuple[np.ndarray, np.ndarray]:
        """Squared wave numbers (M,) 1/m2 up to kappa_max and overlaps (M, C) with the unit-norm patterns."""
        count = max(int(kappa_max * self.radius / np.pi) + 1, 2)
        return self._modes(patch, count)

    def _modes(self, patch: Patch, count: int) -> tuple[np.ndarray, np.ndarray]:
        assert isinstance(patch, RoundPatch)
        roots = np.concatenate(([0.0], _bessel_zeros(count)))
        kappa = roots / self.radius
        edges = patch.edges
        ring_area = np.pi * np.diff(edges**2)
        with np.errstate(divide="ignore", invalid="ignore"):
            antiderivative = 2 * np.pi * edges * j1(kappa[:, None] * edges) / kappa[:, None]
        antiderivative[0] = np.pi * edges**2
        norm = self.area * j0(roots) ** 2
        overlaps = np.diff(antiderivative, axis=1) / np.sqrt(ring_area) / np.sqrt(norm)[:, None]
        return kappa**2, overlaps @ patch.shapes

    def kernel(self, patch: Patch, tau: np.ndarray) -> np.ndarray:
        """(J, C, C): lateral heat kernel between the patterns at the diffusion lengths squared tau (J,) m2."""
        assert isinstance(patch, RoundPatch)
        finest = np.diff(patch.edges).min()
        count = int(min(40 * self.radius / finest, 20_000))
        kappa2, overlaps = self._modes(patch, count)
        rest = (
            np.eye(overlaps.shape[1]) - overlaps.T @ overlaps
        )  # what the finite series leaves of the identity
        kernel = np.zeros((len(tau), overlaps.shape[1], overlaps.shape[1]))
        for j, length2 in enumerate(tau):
            decay = np.exp(-kappa2 * length2)
            few = int(np.searchsorted(-decay, -1e-18)) or len(decay)
            kernel[j] = (overlaps[:few].T * decay[:few]) @ overlaps[:few] + rest * np.exp(
                -kappa2[-1] * length2
            )
        return kernel


Section = Rectangle | Disc


def _products(x: np.ndarray, y: np.ndarray) -> np.ndarray:
    """(J, L L, L L) of (J, L, L) along each axis."""
    patterns = x.shape[1] ** 2
    return (x[:, :, None, :, None] * y[:, None, :, None, :]).reshape(len(x), patterns, patterns)


def _symmetric_products(x: np.ndarray, y: np.ndarray) -> np.ndarray:
    """(J, C, C): the same between SquarePatch.symmetrize's patterns."""
    i, j = np.tril_indices(x.shape[1])
    weight = np.where(i == j, 0.5, np.sqrt(0.5))
    straight, crossed = np.ix_(i, i), np.ix_(i, j)

    def product(one: np.ndarray, other: np.ndarray) -> np.ndarray:
        return one[:, *straight] * other[:, *np.ix_(j, j)] + one[:, *crossed] * other[:, *np.ix_(j, i)]

    summed = 2 * product(x, y) if x is y else product(x, y) + product(y, x)
    return summed * np.outer(weight, weight)


@cache
def _bessel_zeros(count: int) -> np.ndarray:
    zeros = np.empty(count)
    exact = min(count, 200)
    zeros[:exact] = jn_zeros(1, exact)
    # McMahon's expansion (Abramowitz & Stegun 9.5.12) is at round-off from the 200th zero of J1 on.
    beta = (np.arange(exact + 1, count + 1) + 0.25) * np.pi
    zeros[exact:] = beta - 3 / (8 * beta) + 36 / (3 * (8 * beta) ** 3)
    return zeros


def _cosine_overlaps(edges: np.ndarray, half_width: float, kappa_max: float) -> tuple[np.ndarray, np.ndarray]:
    count = int(kappa_max * half_width / np.pi) + 1
    kappa = np.arange(count) * np.pi / half_width
    with np.errstate(divide="ignore", invalid="ignore"):
        antiderivative = np.sin(kappa[:, None] * edges) / kappa[:, None]
    antiderivative[0] = edges
    norm = np.where(np.arange(count) == 0, half_width, half_width / 2)
    return kappa, np.diff(antiderivative, axis=1) / np.sqrt(np.diff(edges)) / np.sqrt(norm)[:, None]


def _strip_kernel(edges: np.ndarray, half_width: float, tau: np.ndarray) -> np.ndarray:
    """(J, strips, strips): heat kernel of [0, half_width] with adiabatic ends, between unit-norm strips."""
    strips = len(edges) - 1
    kernel = np.empty((len(tau), strips, strips))
    late = tau > _COSINES_FROM * half_width**2
    if late.any():
        kappa, overlaps = _cosine_overlaps(edges, half_width, 7 / np.sqrt(_COSINES_FROM) / half_width)
        decay = np.exp(-(kappa**2) * tau[late, None])
        kernel[late] = np.einsum("tm,mi,mk->tik", decay, overlaps, overlaps)
    early = ~late
    if early.any():
        # Second antiderivative of twice the free heat kernel; its second differences are integrals over two strips. It
        # is symmetric in the strips, and linear, so that these are 0, where an image is far away.
        lengths = 2 * np.sqrt(tau[early])[:, None, None]
        i, j = np.tril_indices(len(edges))
        direct, mirror = edges[i] - edges[j], edges[i] + edges[j]
        primitive = _primitive(mirror[:, None] + 2 * half_width * _MIRRORED, lengths).sum(axis=-1)
        primitive -= _primitive(direct[:, None] + 2 * half_width * _DIRECT, lengths).sum(axis=-1)
        summed = np.empty((len(lengths), len(edges), len(edges)))
        summed[:, i, j] = summed[:, j, i] = primitive / 2
        double = np.diff(np.diff(summed, axis=1), axis=2)
        widths = np.diff(edges)
        kernel[early] = double / np.sqrt(np.outer(widths, widths))
    return kernel


def _primitive(distance: np.ndarray, length: np.ndarray) -> np.ndarray:
    distance, length = np.broadcast_arrays(distance, length)
    primitive = np.abs(distance)
    near = primitive < 6 * length  # beyond, the rest is below round-off
    spread, ratio = length[near], distance[near] / length[near]
    primitive[near] = distance[near] * erf(ratio) + spread / np.sqrt(np.pi) * np.exp(-(ratio**2))
    return primitive
