"""How well curves of the library explain the samples of a touch, all that is unknown but the object integrated out.

Samples are S (difference * B(t) c + offset) + noise, c a curve's coefficients. Offset, touch time and slow deviations
of real curves enter linearly with normal priors, so they are integrated out once for all curves (Woodbury), and what
is left of any number of samples is a few independent numbers. Then, for each object, the difference of temperature,
the contact resistance and the heat capacity are integrated out about their most probable values (Laplace), the
resistance within its limits by quadrature. The curve is nearly linear in the resistance where the data leave it
uncertain, and where they do not, the range that counts is narrow.

P: objects, Q: independent numbers, r: basis functions, n: samples.
"""

from __future__ import annotations

from dataclasses import dataclass, fields

import numpy as np

from .climb import climb
from .library import CurveTable

_FAINTEST = 0.01  # standard deviations that a direction must be able to show at all
_EARLIEST, _WAVE = 0.02, 0.5  # s, e-folds, of slow deviations
_QUADRATURE = np.polynomial.legendre.leggauss(40)
_PRIOR_SAMPLES = 100.0  # of noise that the data sheet's value is worth


@dataclass(frozen=True, slots=True)
class Evidence:
    """What samples say about a curve, as a few independent numbers. rows: (Q, r) and data: (Q,): log p(samples | curve)
    = const - |data - difference * rows @ c|^2 / 2, differences in K. noise: K rms of a sample, as it was found.
    samples: how many there were."""

    rows: np.ndarray
    data: np.ndarray
    noise: float
    samples: int

    def __add__(self, other: Evidence) -> Evidence:
        """Of two independent sensors that feel the same curve."""
        rows, data = np.concatenate((self.rows, other.rows)), np.concatenate((self.data, other.data))
        turn, triangle = np.linalg.qr(rows)
        noise = float(np.hypot(self.noise, other.noise) / np.sqrt(2))
        return Evidence(triangle, turn.T @ data, noise, self.samples + other.samples)


def slow_deviations(since: np.ndarray, size: float, horizon: float) -> np.ndarray:
    """(n, m) K: bumps in the logarithm of the time since (n,) s after the touch, of which random multiples add up to
    deviations of `size` K rms that change over half an e-fold of time. That is how curves of reduced models deviate."""
    centres = np.arange(np.log(_EARLIEST), np.log(horizon) + _WAVE, _WAVE)
    offset = (np.log(np.maximum(since, 1e-9))[:, None] - centres) / _WAVE
    bumps = np.exp(-(offset**2)) * (since[:, None] > 0)
    return bumps * (size / np.sqrt(np.sqrt(np.pi / 2)))


def gather(
    basis: np.ndarray, typical: np.ndarray, kelvin: np.ndarray, noise: float, nuisances: np.ndarray
) -> Evidence:
    """What samples say about any curve. basis: (n, r) at the samples. typical: (r,) K, size of its coefficients in
    curves. kelvin: (n,) their voltages over the Seebeck coefficient. noise: K rms that is expected of a sample.
    nuisances: (n, m) K, one standard deviation of what else may be in them.

    The noise is found from what neither curves nor nuisances can explain, together with what is expected."""
    known = np.hstack((basis, nuisances))
    fit = np.linalg.lstsq(known, kelvin, rcond=1e-9)
    left = kelvin - known @ fit[0]
    free = max(len(kelvin) - int(fit[2]), 0)
    variance = (_PRIOR_SAMPLES * noise**2 + left @ left) / (_PRIOR_SAMPLES + free)
    spread = nuisances / np.sqrt(variance)
    whitened_basis, whitened_data = basis / np.sqrt(variance), kelvin / np.sqrt(variance)
    # What the nuisances explain is taken out: C^-1 = 1 - N (1 + N^T N)^-1 N^T, by singular values of N.
    directions, size_of, _ = np.linalg.svd(spread, full_matrices=False)
    shrink = size_of**2 / (1 + size_of**2)
    inside, projected = directions.T @ whitened_basis, directions.T @ whitened_data
    matrix = whitened_basis.T @ whitened_basis - (inside.T * shrink) @ inside
    vector = whitened_basis.T @ whitened_data - (inside.T * shrink) @ projected
    weights, turn = np.linalg.eigh(matrix * np.outer(typical, typical))
    kept = weights > _FAINTEST**2
    root, turn = np.sqrt(weights[kept]), turn[:, kept]
    rows = root[:, None] * turn.T / typical
    return Evidence(rows, (turn.T @ (vector * typical)) / root, float(np.sqrt(variance)), len(kelvin))


@dataclass(frozen=True, slots=True)
class ProjectedCurves:
    """A table of curves in the coordinates of an evidence. curves: (N, C, H, Q), what the evidence's Q independent
    numbers would be for each curve of the table, per K of first difference."""

    evidence: Evidence
    table: CurveTable
    curves: np.ndarray

    def nodes(self, difference: tuple[float, float]) -> tuple[np.ndarray, np.ndarray]:
        """Of each object and heat capacity, the node of resistance that explains the data best: its misfit and its
        resistance m2 K/W, (N, C). difference: K, mean and standard deviation of its prior."""
        mean, deviation = difference
        power = np.einsum("nchq,nchq->nch", self.curves, self.curves) + deviation**-2
        match = self.curves @ self.evidence.data + mean / deviation**2
        gain = match**2 / power
        best = np.argmax(gain, axis=2)
        first, spacing = self.table.log_resistance
        capacity = (np.arange(gain.shape[1]) - (gain.shape[1] - 1) / 2) * self.table.capacity_step
        misfit = capacity**2 - np.take_along_axis(gain, best[:, :, None], axis=2)[:, :, 0]
        return misfit, np.exp(first + spacing * best)


def project(evidence: Evidence, table: CurveTable) -> ProjectedCurves:
    """The table's curves in the evidence's coordinates."""
    return ProjectedCurves(evidence, table, table.coefficients @ evidence.rows.T)


@dataclass(frozen=True, slots=True)
class Explained:
    """How well P objects explain the evidence: log_evidence, and the most probable difference (K), resistance (m2 K/W)
    and heat capacity (standard deviations of its prior), each (P,). difference_variance: (P,) K2. misfit: (P,) twice
    the negative log posterior there, up to what is common to all."""

    log_evidence: np.ndarray
    difference: np.ndarray
    difference_variance: np.ndarray
    resistance: np.ndarray
    capacity: np.ndarray
    misfit: np.ndarray

    def __getitem__(self, chosen: np.ndarray) -> Explained:
        return Explained(*(getattr(self, field.name)[chosen] for field in fields(self)))


def explain(
    projected: ProjectedCurves,
    index: np.ndarray,
    start: tuple[np.ndarray, np.ndarray],
    difference: tuple[float, float],
    limits: tuple[float, float],
) -> Explained:
    """The objects at index (P,) along the table; a number between two nodes is an object between them. start: heat
    capacity and resistance (P,) to begin from. difference: K, mean and standard deviation. limits: m2 K/W, of a
    log-uniform resistance."""
    capacity, resistance = (np.asarray(one, float) for one in start)
    axes = (*projected.table.log_resistance, projected.table.capacity_step)
    misfit, point, gradient, curvature = climb(
        projected.curves,
        axes,
        projected.evidence.data,
        difference,
        limits,
        np.asarray(index, float),
        capacity,
        np.clip(resistance, *limits),
    )
    inverse = np.linalg.inv(curvature)
    move = np.einsum("pkl,pl->pk", inverse, gradient)
    least = misfit - np.einsum("pk,pk->p", move, gradient)
    top, mass = _within(point[:, 1] * (1 + move[:, 2]), point[:, 1] * np.sqrt(inverse[:, 2, 2]), limits)
    inner = np.linalg.det(curvature[:, :2, :2])
    scale = np.log(difference[1]) + np.log(np.log(limits[1] / limits[0]))
    log_evidence = -least / 2 - np.log(inner) / 2 + top + np.log(mass) - scale
    return Explained(log_evidence, point[:, 2], inverse[:, 0, 0], point[:, 1], point[:, 0], misfit)


def _within(
    centre: np.ndarray, width: np.ndarray, limits: tuple[float, float]
) -> tuple[np.ndarray, np.ndarray]:
    """(log of the scale, integral over it) of exp(-((R - centre)/width)^2/2)/R within the limits, (P,) each."""
    nearest = np.clip(centre, *limits)
    reach = 8 * width**2 / np.hypot(width, centre - nearest)
    begin, end = np.maximum(nearest - reach, limits[0]), np.minimum(nearest + reach, limits[1])
    nodes, weights = _QUADRATURE
    at = (begin + end)[:, None] / 2 + (end - begin)[:, None] / 2 * nodes
    exponent = -(((at - centre[:, None]) / width[:, None]) ** 2) / 2
    top = exponent.max(axis=1)
    return top, (end - begin) / 2 * ((np.exp(exponent - top[:, None]) / at) @ weights)
