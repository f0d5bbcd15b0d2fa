"""When a recorded curve began: the touch in a stream of samples.

The onset is where the voltage leaves what offset and noise allow. The touch lies before it, by as much as the first
rise is slow; it is where the samples around the onset are most likely under a normal distribution of curves that has
the library's second moments.
"""

from __future__ import annotations

import numpy as np

from .library import CurveLibrary

SETTLED = 0.4  # s after the onset; later samples tell no more about the touch
FOUND_WITHIN = 5e-3  # s, standard deviation that a touch which was found is given
OPENING = (0.02, 0.04)
"""s before and after a touch that was found, in which a grasp's contact opens: how is not known."""
_BEFORE = 0.3  # s before the onset in which the touch is looked for
_STEP = 5e-3  # s
_IN_A_ROW = 3


def onset(kelvin: np.ndarray, noise: float, offset: float) -> int | None:
    """Index of the first of three samples in a row beyond 3 offset + 6 noise, all K; None where there is none."""
    beyond = np.abs(kelvin) > 3 * offset + 6 * noise
    run = beyond[: len(beyond) - _IN_A_ROW + 1].copy()
    for k in range(1, _IN_A_ROW):
        run &= beyond[k : len(beyond) - _IN_A_ROW + 1 + k]
    return int(np.argmax(run)) if run.any() else None


def find_touch(
    library: CurveLibrary,
    t: np.ndarray,
    kelvin: np.ndarray,
    first: int,
    noise: float,
    offset: float,
    scale: float,
) -> float:
    """s of the touch, with its onset at sample `first`. kelvin: (n,) at t (n,) s. noise, offset: K. scale: K, rms of
    the difference of temperature."""
    near = (t >= t[first] - 2 * _BEFORE) & (t <= t[first] + SETTLED)
    times, values = t[near], kelvin[near]
    root = library.spread * scale
    tried = np.arange(t[first] - _BEFORE, t[first] + _STEP / 2, _STEP)
    likely = np.array(
        [_log_likelihood(library.basis(times - touch) @ root, values, noise, offset) for touch in tried]
    )
    best = int(np.clip(np.argmax(likely), 1, len(tried) - 2))
    left, middle, right = likely[best - 1 : best + 2]
    bend = left - 2 * middle + right
    shift = 0.5 * (left - right) / bend if bend < 0 else 0.0
    return float(tried[best] + _STEP * np.clip(shift, -1.0, 1.0))


def smooth_curve(
    library: CurveLibrary, since: np.ndarray, kelvin: np.ndarray, noise: float, scale: float
) -> tuple[np.ndarray, np.ndarray]:
    """The curve through the samples kelvin (n,) at since (n,) s after the touch, whatever it is of: K and K/s (n,)."""
    root = library.spread * scale
    basis = library.basis(since)
    seen = basis @ root / noise
    weights = np.linalg.solve(seen.T @ seen + np.eye(seen.shape[1]), seen.T @ (kelvin / noise))
    return basis @ (root @ weights), library.basis_rate(since) @ (root @ weights)


def _log_likelihood(spread: np.ndarray, values: np.ndarray, noise: float, offset: float) -> float:
    """Of values (n,) that are normal with covariance spread spread^T + offset^2 + noise^2."""
    wide = np.column_stack((spread, np.full(len(values), offset))) / noise
    projected = wide.T @ values / noise
    matrix = np.eye(wide.shape[1]) + wide.T @ wide
    sign_free = np.linalg.slogdet(matrix)[1]
    return float(projected @ np.linalg.solve(matrix, projected) - sign_free) / 2
