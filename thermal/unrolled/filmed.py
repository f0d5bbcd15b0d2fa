"""How much less heat stays at one side of a layer whose other side has a film.

T: times.
"""

from __future__ import annotations

import numpy as np
from scipy.optimize import brentq

_TERMS = 12
_EARLY = 0.02  # of the depth's square


def filmed(taus: np.ndarray, depth: float, film: float) -> np.ndarray:
    """(T,) of the kernel of a layer whose other side is adiabatic, where a film is there (Carslaw & Jaeger, Conduction
    of Heat in Solids, 2nd ed., section 3.9): both at the side that is touched, at taus m2. depth: m. film: 1/m, its
    conductance W/(m2 K) over the conductivity."""
    free, held = np.ones(len(taus)), np.zeros(len(taus))
    biot = film * depth
    for n in range(_TERMS):
        low, high = n * np.pi, (n + 0.5) * np.pi
        root = float(brentq(lambda b: b * np.sin(b) - biot * np.cos(b), low, high))  # pyright: ignore[reportArgumentType]
        held += np.exp(-((root / depth) ** 2) * taus) * 2 / (1 + np.sin(2 * root) / (2 * root))
        if n:
            free += 2 * np.exp(-((n * np.pi / depth) ** 2) * taus)
    early = taus < _EARLY * depth**2  # before anything comes back from there
    return np.where(early, 1.0, held / free)
