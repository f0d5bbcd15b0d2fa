"""The best that any method can do: the posterior of the very model that drew the touches, by brute force.

For each material thousands of conductances, for each the likelihood of all samples one by one; the difference of
temperature and the offset are normal and enter linearly, so they are integrated in closed form. Nothing is projected,
linearised or interpolated beyond a spline between neighbouring conductances. Shares no code with the identifier.
"""

from __future__ import annotations

import numpy as np
from scipy.interpolate import CubicSpline
from scipy.special import logsumexp

from thermograsp.bench.identify.touches import Touches, conductance_nodes, times
from thermograsp.thermal import SensorStack

_CONDUCTANCES = 3000


def exact_posterior(touches: Touches, seconds: float, curves: np.ndarray) -> np.ndarray:
    """(N, M) probabilities from the first `seconds`. curves: (M, H, n) of pressed()."""
    count = len(times(seconds))
    setup = touches.setup
    assert isinstance(setup.stack, SensorStack)
    seebeck = setup.stack.seebeck
    mean, deviation = setup.difference
    variance = (setup.chain.noise**2 + setup.chain.resolution**2 / 12) / seebeck**2
    offset = (setup.chain.offset / seebeck) ** 2
    samples = touches.voltage[:, :count] / seebeck  # (N, n) K
    nodes = np.log(conductance_nodes(setup))
    fine = np.linspace(nodes[0], nodes[-1], _CONDUCTANCES)
    # (a, b) = a.b/v - (a.1)(1.b)/v^2 / (1/o + n/v): the inner product once the offset is integrated out
    weight = 1 / (1 / offset + count / variance) / variance**2
    likely = np.zeros((len(samples), len(curves)))
    for k, table in enumerate(curves):
        curve = CubicSpline(nodes, table[:, :count])(fine)  # (F, n)
        sums = curve.sum(axis=1)
        power = (curve**2).sum(axis=1) / variance - weight * sums**2 + deviation**-2
        match = samples @ curve.T / variance - weight * np.outer(samples.sum(axis=1), sums)
        match += mean / deviation**2
        likely[:, k] = logsumexp((match**2 / power - np.log(power)) / 2, axis=1)
    total = np.asarray(logsumexp(likely, axis=1))
    return np.exp(likely - total[:, None])
