"""Moments at which heat kernels are known and transfer functions are told.

A kernel g(t) is taken at TIMES, equally spaced in ln t, where the trapezoidal rule for its Laplace transform converges
exponentially; what comes before the first is a geometric sum, since every strip is a half-space of its own then.
"""

from __future__ import annotations

import numpy as np

_SPACING = 0.7  # relative error exp(-pi^2 / spacing), 8e-7

TIMES = 3e-6 * np.exp(_SPACING * np.arange(33))
"""(T,) s, to four hours."""
MOMENTS = np.geomspace(1 / 600, 180, 22)
"""(S,) 1/s: real Laplace variables, from a fraction of a control step to ten minutes."""
OF_GRASP = slice(4, 20)
GRASP = MOMENTS[OF_GRASP]
"""From a control step to the minute that a grasp lasts, where networks of fixed rates are fitted."""
TO_MOMENTS = _SPACING * TIMES * np.exp(-MOMENTS[:, None] * TIMES)
"""(S, T): the transform at MOMENTS of a kernel at TIMES, less what comes before the first."""
TO_SLOPES = -TIMES * TO_MOMENTS
"""(S, T): its derivative by the Laplace variable; what comes before the first has none to speak of."""


def before(diffusivity: float) -> float:
    """Integral to the first time of 1 / sqrt(pi diffusivity t), as the rule has it. diffusivity: m2/s."""
    return float(_SPACING * np.sqrt(TIMES[0] / (np.pi * diffusivity)) / np.expm1(_SPACING / 2))


for _table in (TIMES, MOMENTS, TO_MOMENTS, TO_SLOPES):
    _table.setflags(write=False)
