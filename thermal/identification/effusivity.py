"""The posterior of an object's effusivity, whatever it is made of.

The density is wide (a metal felt for half a second) or a thousand times narrower (glass for four), so its nodes are
laid again and again where it is, each object starting from its neighbour's answer.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from scipy.interpolate import CubicSpline

from . import prior as prior
from .evidence import (
    Evidence,
    Explained,
    ProjectedCurves,
    explain,
    project,
)
from .library import CurveLibrary

_NODES = 33
_DEPTH = 14.0  # nats below the top that still count
_ENOUGH = 13  # nodes above that depth
_ZOOMS = 5
_FINE = 801


@dataclass(frozen=True, slots=True)
class EffusivityPosterior:
    """The probability density of an object's effusivity after a touch. effusivity: (n,) W s^0.5/(m2 K). density: (n,)
    of its natural logarithm, integrates to 1. log_evidence: of any object of the prior. difference: K, mean and
    standard deviation. misfit: of the best object, as in Explained."""

    effusivity: np.ndarray
    density: np.ndarray
    log_evidence: float
    difference: tuple[float, float]
    misfit: float

    def quantiles(self, shares: np.ndarray | list[float]) -> np.ndarray:
        """W s^0.5/(m2 K) below which the effusivity lies with those probabilities."""
        x = np.log(self.effusivity)
        steps = np.diff(x) * (self.density[1:] + self.density[:-1]) / 2
        total = np.concatenate(([0.0], np.cumsum(steps)))
        return np.exp(np.interp(shares, total / total[-1], x))

    @property
    def median(self) -> float:
        """W s^0.5/(m2 K)."""
        return float(self.quantiles([0.5])[0])

    def interval(self, level: float = 0.9) -> tuple[float, float]:
        """The interval with equal probabilities on both sides that holds the effusivity with probability `level`."""
        low, high = self.quantiles([(1 - level) / 2, (1 + level) / 2])
        return float(low), float(high)


def effusivity_posterior(
    evidence: Evidence, library: CurveLibrary, difference: tuple[float, float], limits: tuple[float, float]
) -> EffusivityPosterior:
    """Under the prior of identify_prior. difference: K, mean and standard deviation. limits: m2 K/W of the contact
    resistance."""
    axis = library.log_effusivity
    spacing = axis[1] - axis[0]
    projected = project(evidence, library.objects)
    x, index, start = axis, *_starts(projected, difference)
    found = explain(projected, index, start, difference, limits)
    found = _best(found, index, len(x))
    for _ in range(_ZOOMS):
        inside = np.flatnonzero(found.log_evidence > found.log_evidence.max() - _DEPTH)
        if len(inside) >= _ENOUGH:
            break
        finer = np.linspace(x[max(inside[0] - 1, 0)], x[min(inside[-1] + 1, len(x) - 1)], _NODES)
        right = np.clip(np.searchsorted(x, finer), 1, len(x) - 1)
        both = np.concatenate((right - 1, right))
        start = found.capacity[both], found.resistance[both]
        again = explain(projected, np.tile((finer - axis[0]) / spacing, 2), start, difference, limits)
        x, found = finer, _best(again, np.tile(np.arange(_NODES), 2), _NODES)
    return _density(x, found)


def prior_posterior(difference: tuple[float, float]) -> EffusivityPosterior:
    """What is known without a curve."""
    effusivity = np.exp(np.linspace(np.log(prior.RANGE[0]), np.log(prior.RANGE[1]), _FINE))
    density = np.full(_FINE, 1 / np.log(prior.RANGE[1] / prior.RANGE[0]))
    return EffusivityPosterior(effusivity, density, 0.0, difference, 0.0)


def _starts(
    projected: ProjectedCurves, difference: tuple[float, float]
) -> tuple[np.ndarray, tuple[np.ndarray, np.ndarray]]:
    """Index (P,) of objects, and heat capacities and resistances to begin from: of each object every heat capacity that
    is better than its neighbours, for there may be more than one answer."""
    misfit, resistance = projected.nodes(difference)
    padded = np.pad(misfit, ((0, 0), (1, 1)), constant_values=np.inf)
    chosen = (misfit <= padded[:, :-2]) & (misfit < padded[:, 2:])
    index, node = np.nonzero(chosen)
    order = np.argsort(misfit[chosen], kind="stable")
    index, node = index[order], node[order]
    capacity = (node - (misfit.shape[1] - 1) / 2) * projected.table.capacity_step
    return index, (capacity, resistance[index, node])


def _best(found: Explained, owner: np.ndarray, count: int) -> Explained:
    """Of each of `count` owners the answer of the highest evidence."""
    order = np.lexsort((found.log_evidence, owner))
    last = np.searchsorted(owner[order], np.arange(count), side="right") - 1
    return found[order[last]]


def _density(x: np.ndarray, found: Explained) -> EffusivityPosterior:
    top = found.log_evidence.max()
    relative = np.maximum(found.log_evidence - top, -60.0)
    fine = np.linspace(x[0], x[-1], _FINE)
    density = np.exp(np.minimum(CubicSpline(x, relative)(fine), 1.0))
    mass = np.trapezoid(density, fine)
    weights = np.exp(relative) / np.exp(relative).sum()
    mean = float(weights @ found.difference)
    variance = weights @ (found.difference_variance + found.difference**2) - mean**2
    log_evidence = float(top + np.log(mass / np.log(prior.RANGE[1] / prior.RANGE[0])))
    deviation = float(np.sqrt(variance))
    return EffusivityPosterior(
        np.exp(fine), density / mass, log_evidence, (mean, deviation), float(found.misfit.min())
    )
