"""Which of a file's labels a touch is of, from its heated sensor alone or with the passive one.

Each label's hypothesis is its sample at a temperature that is not known: a room's, normal, or a cooled one's, uniform.
A touch's features are its drops at some times; they deviate from the prediction normally, with the covariance of the
residuals of touches whose label is known (those the sensor was fitted on). Readings are linear in the sample's
temperature, so the evidence is a sum over a grid of it. The passive sensor's own structure is not modelled: it falls
by some share, uniform between _SHARES, of the way to a sample that is not at its own temperature.

B: touches, L: labels, q: features.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np

from thermograsp.errors import InvalidValueError

from ..stack import HeatedStack, touch_curves
from .predicting import COLDEST, Touched, as_touches, passive_temperature
from .recordings import Recordings, drops_of

_TIMES = (0.25, 0.5, 1.0, 1.5, 2.0, 3.0, 4.0, 5.0, 6.0, 7.0)  # s
_ROOM = (22.5, 1.0)  # °C, mean and standard deviation
_WARMEST = 18.0  # °C of what was cooled
_SHARES = (0.1, 1.0)  # of the way that the passive sensor goes
_PASSIVE_NOISE = 0.3  # K, of what it moves by on a sample at the room's temperature
_FLOOR = 0.02  # K of a feature that the model may be off, beside the residuals'
_GRID = 77


@dataclass(frozen=True, slots=True)
class Confusion:
    """How often touches of each material are sorted as which. labels: of rows (true) and columns (said). table: (L, L)
    touches."""

    labels: tuple[str, ...]
    table: np.ndarray

    @property
    def right(self) -> float:
        """Share of the touches."""
        return float(np.trace(self.table) / self.table.sum())


def sort_touches(
    recordings: Recordings,
    stack: HeatedStack,
    touched: Mapping[str, Touched],
    known: np.ndarray,
    *,
    passive: bool,
) -> np.ndarray:
    """(B, L) probabilities of the labels, all equal beforehand. known: (B,) mask of touches whose residuals give the
    covariance, from labels without a free temperature. Raises InvalidValueError where
    too few are known."""
    times = [time for time in _TIMES if time <= recordings.t[-1] + 1e-9]
    columns = np.array([int(np.argmin(np.abs(recordings.t[recordings.start :] - time))) for time in times])
    measured = recordings.drops[:, columns]
    hypotheses = {
        label: [
            drops_of(
                recordings,
                touch_curves(
                    stack, [what.sample], as_touches(recordings, np.full(len(measured), degrees))
                ).recorded,
            )[:, columns]
            for degrees in (0.0, 1.0)
        ]
        for label, what in touched.items()
    }
    precision = np.linalg.inv(_covariance(recordings, measured, hypotheses, touched, known))
    moved = recordings.passive[:, -1] - passive_temperature(recordings)
    logs = []
    for label, what in touched.items():
        grid, prior = _temperatures(what)
        at_zero, at_one = hypotheses[label]
        away = measured[:, None] - at_zero[:, None] - grid[:, None] * (at_one - at_zero)[:, None]
        evidence = np.log(prior) - 0.5 * np.einsum("bgq,qr,bgr->bg", away, precision, away)
        if passive:
            evidence = evidence + _passive_evidence(moved, passive_temperature(recordings), grid)
        logs.append(np.logaddexp.reduce(evidence, axis=1))
    logs = np.array(logs).T
    return np.exp(logs - np.logaddexp.reduce(logs, axis=1)[:, None])


def confusion(recordings: Recordings, labels: Sequence[str], probability: np.ndarray) -> Confusion:
    """The most probable label against the true one."""
    likeliest = np.asarray(labels)[probability.argmax(axis=1)]
    table = [[int(np.sum((recordings.label == a) & (likeliest == b))) for b in labels] for a in labels]
    return Confusion(tuple(labels), np.array(table))


def _covariance(
    recordings: Recordings,
    measured: np.ndarray,
    hypotheses: Mapping[str, Sequence[np.ndarray]],
    touched: Mapping[str, Touched],
    known: np.ndarray,
) -> np.ndarray:
    residuals = []
    for label, (at_zero, at_one) in hypotheses.items():
        where = touched[label].temperature
        if where == "free":
            continue
        chosen = known & (recordings.label == label)
        degrees = (
            passive_temperature(recordings) if where == "passive" else np.full(len(chosen), float(where))
        )
        residuals.append((measured - at_zero - degrees[:, None] * (at_one - at_zero))[chosen])
    rows = np.concatenate(residuals) if residuals else np.empty((0, measured.shape[1]))
    if len(rows) < 2 * measured.shape[1]:
        raise InvalidValueError(
            f"{len(rows)} touches of known temperature are too few for a covariance of {measured.shape[1]} features"
        )
    return rows.T @ rows / len(rows) + _FLOOR**2 * np.eye(measured.shape[1])


def _temperatures(what: Touched) -> tuple[np.ndarray, np.ndarray]:
    """Grid of °C and weights that sum to 1."""
    if what.temperature == "free":
        return np.linspace(COLDEST, _WARMEST, _GRID), np.full(_GRID, 1 / _GRID)
    mean, deviation = _ROOM if what.temperature == "passive" else (float(what.temperature), _ROOM[1])
    grid = np.linspace(mean - 3 * deviation, mean + 3 * deviation, _GRID)
    weights = np.exp(-(((grid - mean) / deviation) ** 2) / 2)
    return grid, weights / weights.sum()


def _passive_evidence(moved: np.ndarray, passive: np.ndarray, grid: np.ndarray) -> np.ndarray:
    """(B, G) log density of the passive sensor's change of `moved` (B,) K, which began at `passive` (B,) °C."""
    shares = np.linspace(*_SHARES, 19)
    way = shares * (grid - passive[:, None])[..., None]
    return np.logaddexp.reduce(-(((moved[:, None, None] - way) / _PASSIVE_NOISE) ** 2) / 2, axis=-1)
