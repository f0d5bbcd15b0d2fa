"""Right answers of an agent and of two posteriors after the same samples, and where the agent itself stops.

N: episodes, D: decisions of each, K: materials, W: contact times, n: samples.
"""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from thermograsp.bench.stopping.touches import RATE, Touched
from thermograsp.thermal import Identifier, TouchSetup

_NOISES = 3.0  # of a sample, the fitted posterior's smallest deviation in any direction
_STEADY = 1e-9  # s, for times that are equal but for rounding


def last_decisions(touched: Touched, windows: tuple[float, ...]) -> np.ndarray:
    """(N, W), each episode's last decision within so many seconds after the touch."""
    within = touched.contact[:, :, None] <= np.array(windows) + _STEADY
    return within.sum(axis=1) - 1


def answers(touched: Touched) -> np.ndarray:
    """(N, D) the agent's largest shares, also after it would have declared."""
    return touched.shares.argmax(axis=2)


def identified(
    touched: Touched,
    windows: tuple[float, ...],
    setup: TouchSetup,
    advance: Callable[[str, float], None],
) -> np.ndarray:
    """(N, W) the most probable material after `thermograsp identify`, from all samples up to the agent's last decision
    within each window. It finds the touch itself. advance: called with progress, in episodes."""
    identifier = Identifier(setup, touched.materials)
    named = np.empty((len(touched.truth), len(windows)), int)
    until = np.rint(touched.times[last_decisions(touched, windows)] * RATE).astype(int)
    for row, ends in enumerate(until.tolist()):
        identifier.reset()
        done = 0
        for at, end in enumerate(ends):
            fresh = np.arange(done, end)
            found = identifier.update((fresh + 1) / RATE, touched.voltage[row, done:end])
            named[row, at], done = int(np.argmax(found.probability)), end
        advance("identifying", 1)
    return named


def fitted(touched: Touched, examples: Touched, windows: tuple[float, ...], noise: float) -> np.ndarray:
    """(N, W) the most probable material where each one's samples are jointly normal, as in `examples`: a posterior that
    knows these contacts. A material without an example is never named. noise: V rms of a sample. Samples count from
    the start of the episode, as the agent's do."""
    ends = np.rint(touched.times[last_decisions(touched, windows)] * RATE).astype(int)  # (N, W)
    named = np.empty(ends.shape, int)
    for end in np.unique(ends).tolist():
        new, old = (each.voltage[:, :end].reshape(len(each.truth), -1) for each in (touched, examples))
        likely = np.stack(
            [
                _normal(new, old[examples.truth == material], _NOISES * noise)
                if (examples.truth == material).any()
                else np.full(len(new), -np.inf)
                for material in range(len(touched.materials))
            ],
            axis=1,
        )
        rows, columns = np.nonzero(ends == end)
        named[rows, columns] = likely.argmax(axis=1)[rows]
    return named


def fixed(touched: Touched) -> tuple[np.ndarray, np.ndarray]:
    """(D',) mean contact time and (D',) share of right answers of an agent that always stops at its first, second, ...
    decision after the touch."""
    first = (touched.contact <= 0).sum(axis=1)
    count = len(touched.times) - int(first.max())
    rows, at = np.arange(len(first))[:, None], first[:, None] + np.arange(count)
    right = answers(touched) == touched.truth[:, None]
    return touched.contact[rows, at].mean(axis=0), right[rows, at].mean(axis=0)


def declared(touched: Touched) -> tuple[float, float]:
    """Mean contact time and share of right answers where the agent itself declares, or at the last decision."""
    stops = touched.declares.copy()
    stops[:, -1] = True
    at, rows = stops.argmax(axis=1), np.arange(len(stops))
    right = answers(touched)[rows, at] == touched.truth
    return float(touched.contact[rows, at].mean()), float(right.mean())


def _normal(samples: np.ndarray, examples: np.ndarray, deviation: float) -> np.ndarray:
    """(N,) log density of samples (N, n) of a normal distribution with the examples' (M, n) mean and covariance, and
    `deviation` more in each direction. The covariance's rank is below M, so that its inverse needs M x M numbers."""
    mean = examples.mean(axis=0)
    centred = (examples - mean) / np.sqrt(max(len(examples) - 1, 1))
    _, scales, directions = np.linalg.svd(centred, full_matrices=False)
    centred_samples = samples - mean
    along = centred_samples @ directions.T
    variances = scales**2 + deviation**2
    rest = (centred_samples**2).sum(axis=1) - (along**2).sum(axis=1)
    missing = samples.shape[1] - len(scales)
    squares = (along**2 / variances).sum(axis=1) + rest / deviation**2
    return -(squares + np.log(variances).sum() + 2 * missing * np.log(deviation)) / 2
