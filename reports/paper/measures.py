"""What is read off the ten curves: falls, spreads, order."""

from __future__ import annotations

import numpy as np

from thermograsp import thermal
from thermograsp.reports.paper.sweeps import MATERIALS, Sweep
from thermograsp.thermal.rungs import equivalent_slab

_ALIKE = 0.05  # spread of the ten curves over their mean up to which they pass for alike


def sample(sweep: Sweep, seconds: float) -> int:
    """Index of the sample nearest to that time."""
    return int(np.argmin(np.abs(sweep.t - seconds)))


def at(sweep: Sweep, seconds: float) -> np.ndarray:
    """Drops (10,) K at that time, which must be a sample."""
    return sweep.drop[:, sample(sweep, seconds)]


def fall_by(sweep: Sweep, seconds: float) -> np.ndarray:
    """(10,) part of its peak that each curve has lost by that time."""
    return 1 - at(sweep, seconds) / sweep.drop.max(axis=1)


def relative_spread(sweep: Sweep) -> np.ndarray:
    """(n,) largest less smallest drop of the ten over their mean; 0 before the touch begins."""
    mean = sweep.drop.mean(axis=0)
    return np.ptp(sweep.drop, axis=0) / np.maximum(mean, 1e-9)


def mean_difference(sweep: Sweep) -> np.ndarray:
    """(n,) K, mean over all pairs of materials."""
    pairs = np.abs(sweep.drop[:, None] - sweep.drop[None])
    count = len(MATERIALS)
    return pairs.sum(axis=(0, 1)) / (count * (count - 1))


def alike_until(sweep: Sweep) -> float:
    """s from which on the ten are apart by more than _ALIKE."""
    return float(sweep.t[np.argmax(relative_spread(sweep) > _ALIKE)])


def noise() -> float:
    """K rms a sample of a common converter on the preset's element."""
    return thermal.ADS1115.noise / thermal.sensor("seed").seebeck


def sensor_effusivity() -> float:
    """W s^0.5/(m2 K) of the element as one homogeneous layer."""
    return equivalent_slab(thermal.sensor("seed")).effusivity


def rows(*names: str) -> np.ndarray:
    """Indices of those materials."""
    return np.array([MATERIALS.index(name) for name in names])


def percent(values: np.ndarray, chosen: np.ndarray) -> str:
    """values (10,) of the chosen rows in %, e.g. "cotton 83 %"."""
    parts = []
    for row in chosen:
        value = 100 * values[row]
        parts.append(f"{MATERIALS[row].replace('_', ' ')} {value:.{0 if value >= 10 else 1}f} %")
    return ", ".join(parts)


def swaps(drops: np.ndarray) -> list[tuple[str, str]]:
    """Neighbours in effusivity whose drops (10,) stand the other way round."""
    return [(MATERIALS[i], MATERIALS[i + 1]) for i in np.flatnonzero(np.diff(drops) <= 0)]


def end_slope(sweep: Sweep) -> np.ndarray:
    """(10,) part of its drop that each curve has lost in the last second."""
    return at(sweep, sweep.t[-1] - 1) / sweep.drop[:, -1] - 1


def swap_time(sweep: Sweep) -> float:
    """s from which on plastic, of the smaller effusivity, is above rubber; NaN if never."""
    plastic, rubber = (sweep.drop[MATERIALS.index(name)] for name in ("plastic", "rubber"))
    late = sweep.t > 1.0
    above = (plastic > rubber)[late]
    return float(sweep.t[late][np.argmax(above)]) if above.any() else float("nan")


def rise_time(sweep: Sweep) -> np.ndarray:
    """(10,) s to 90 % of each curve's peak."""
    return sweep.t[np.argmax(sweep.drop >= 0.9 * sweep.drop.max(axis=1, keepdims=True), axis=1)]
