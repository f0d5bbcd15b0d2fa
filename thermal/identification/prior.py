"""Which objects are likely before anything is felt: effusivity, and heat capacity given effusivity.

Effusivity e is log-uniform over RANGE. A material without pores has a volumetric heat capacity near FULL whatever it
is made of; a light one is air and little of that. Conductivity k = LEAST + e^2/FULL says both: rho c = e^2/k. FULL and
LEAST are a least-squares fit to the 90 materials of the package's table, and SPREAD is its residual.
"""

from __future__ import annotations

import numpy as np

RANGE = (25.0, 4e4)
"""W s^0.5/(m2 K), from foams to copper."""
FULL = 2.48e6
"""J/(m3 K)."""
LEAST = 0.045
"""W/(m K)."""
SPREAD = 0.29
"""Standard deviation of log(rho c) given effusivity."""


def heat_capacity(effusivity: np.ndarray | float, deviation: np.ndarray | float = 0.0) -> np.ndarray | float:
    """J/(m3 K), that many standard deviations from the median of objects of that effusivity."""
    squared = np.square(effusivity)
    return squared / (LEAST + squared / FULL) * np.exp(SPREAD * np.asarray(deviation))


def draw_object(rng: np.random.Generator) -> tuple[float, float]:
    """(conductivity W/(m K), volumetric heat capacity J/(m3 K)) from the prior."""
    effusivity = float(np.exp(rng.uniform(*np.log(RANGE))))
    capacity = float(heat_capacity(effusivity, rng.standard_normal()))
    return effusivity**2 / capacity, capacity
