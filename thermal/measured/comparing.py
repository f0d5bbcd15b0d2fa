"""How far predictions are off, beside how far touches are from one another.

All of drops below each touch's own temperature at START, from there to the record's end.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from .recordings import Recordings, drops_of

_DRAWS = 2000
_LEAST_RUNS = 3
_SHARE = 0.95


@dataclass(frozen=True, slots=True)
class Comparison:
    """How far predictions are from measured touches. touches: how many. mean_rms, mean_largest: K, of the mean curve's
    error. touch_rms, touch_largest: K, of the touches'. scatter: K rms of the measured touches about their mean. drawn:
    K rms by which the mean of as many runs drawn again (with replacement) differs from the mean, in 95 % of draws; nan
    for fewer than 3 runs."""

    label: str
    touches: int
    mean_rms: float
    mean_largest: float
    touch_rms: float
    touch_largest: float
    scatter: float
    drawn: float

    @property
    def ratio(self) -> float:
        """The touches' error over their scatter."""
        return self.touch_rms / self.scatter if self.scatter else np.inf


def compare(recordings: Recordings, curves: np.ndarray, rng: np.random.Generator) -> list[Comparison]:
    """One for each label. curves: (B, n) °C, predicted."""
    found = []
    for label in recordings.labels:
        chosen = recordings.label == label
        some = recordings.only(chosen)
        measured = some.drops
        error = measured - drops_of(some, curves[chosen])
        found.append(
            Comparison(
                label,
                len(error),
                _rms(error.mean(axis=0)),
                float(np.abs(error.mean(axis=0)).max()),
                _rms(error),
                float(np.abs(error).max()),
                _rms(measured - measured.mean(axis=0)),
                drawn_again(measured, some.run, rng),
            )
        )
    return found


def drawn_again(curves: np.ndarray, run: np.ndarray, rng: np.random.Generator) -> float:
    """K; see Comparison.drawn."""
    if len(np.unique(run)) < _LEAST_RUNS:
        return float("nan")
    return float(np.quantile([_rms(away) for away in _means_away(curves, run, rng)], _SHARE))


def drawn_apart(recordings: Recordings, others: Recordings, label: str, rng: np.random.Generator) -> float:
    """K rms by which the two means of a label would differ in 95 % of draws if all runs were alike: what a prediction
    of `others` from a fit on `recordings` may be off by for the draw of runs alone. nan for fewer than 3 runs."""
    away = []
    for some in (recordings, others):
        chosen = some.label == label
        if len(np.unique(some.run[chosen])) < _LEAST_RUNS:
            return float("nan")
        away.append(_means_away(some.drops[chosen], some.run[chosen], rng))
    return float(np.quantile([_rms(a - b) for a, b in zip(*away, strict=True)], _SHARE))


def _means_away(curves: np.ndarray, run: np.ndarray, rng: np.random.Generator) -> np.ndarray:
    """(draws, n): means of runs drawn with replacement, less the mean."""
    runs = np.unique(run)
    sums = np.array([curves[run == r].sum(axis=0) for r in runs])
    counts = np.array([np.sum(run == r) for r in runs])
    drawn = rng.integers(len(runs), size=(_DRAWS, len(runs)))
    return sums[drawn].sum(axis=1) / counts[drawn].sum(axis=1)[:, None] - curves.mean(axis=0)


def _rms(values: np.ndarray) -> float:
    return float(np.sqrt(np.mean(values**2)))
