"""The inverse of erfc where contact conductance needs it, also for tensors, which have no function of that name."""

from __future__ import annotations

import math

import numpy as np
from numpy.polynomial import Chebyshev
from scipy.special import erfcinv

from .namespace import Array, namespace_of

# erfc where mean planes are 4.75 and 2 standard deviations apart, the range of the conductance correlations
FARTHEST, NEAREST = math.erfc(4.75 / math.sqrt(2)), math.erfc(2 / math.sqrt(2))
LOW, HIGH = math.sqrt(-math.log(NEAREST)), math.sqrt(-math.log(FARTHEST))
_DEGREE = 16  # within 2e-14; each degree less costs a factor of 4

# erfc^-1(p) is nearly sqrt(-log p), so it is a smooth function of that, which runs from LOW to HIGH.
SERIES: tuple[float, ...] = tuple(
    Chebyshev.interpolate(lambda y: erfcinv(np.exp(-np.square(y))), _DEGREE, (LOW, HIGH)).coef.tolist()
)


def erfc_inverse(p: Array) -> Array:
    """erfc^-1, elementwise, from FARTHEST to NEAREST. SciPy's for NumPy; for tensors a Chebyshev series in
    sqrt(-log p), within 2e-14 relative in float64 and 1e-6 in float32, where the inverse erf of 1 - p would lose four
    digits."""
    xp = namespace_of(p)
    if xp is np:
        return erfcinv(p)
    t = (xp.sqrt(-xp.log(p)) - (LOW + HIGH) / 2) * (2 / (HIGH - LOW))
    total, last = 0.0 * t, 0.0 * t
    for coefficient in SERIES[:0:-1]:  # Clenshaw
        total, last = coefficient + 2 * t * total - last, total
    return SERIES[0] + t * total - last
