"""Numerical inversion of Laplace transforms at many times with few samples of the transform.

One contour serves a window of times: the hyperbola s = mu (1 + sin(i u - phi)) with the parameters that Weideman and
Trefethen (Math. Comp. 76, 2007, section 4) found for transforms whose singularities lie on the negative real axis, as
those of heat conduction do. A window a decade long needs 20 samples for 7 digits and 30 for 10, however many times are
in it.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from functools import cache

import numpy as np

from thermograsp.errors import InvalidValueError

WINDOW = 10.0  # last over first time that share a contour
NODES = 20  # of a contour's upper half


def invert_many(transform: Callable[[np.ndarray], np.ndarray], t: np.ndarray) -> np.ndarray:
    """Inverse transform (n, ...) at t (n,) s, > 0, in any order.

    transform: s (NODES,) complex 1/s -> (NODES, ...), called once a window; as in laplace.invert it must be analytic
    off the negative real axis and real on the positive one. Error about 2e-7 of the largest |f| in the window.
    Raises InvalidValueError for times that are not finite and > 0.
    """
    values: np.ndarray | None = None
    for inside, s, weights in windows(t):
        sampled = transform(s)
        if values is None:
            values = np.zeros((len(inside), *sampled.shape[1:]))
        values[inside] = np.real(np.tensordot(weights, sampled, axes=1))
    assert values is not None
    return values


def windows(t: np.ndarray, nodes: int = NODES) -> Iterator[tuple[np.ndarray, np.ndarray, np.ndarray]]:
    """For each window of times t (n,) s: which are in it (n,), the samples s (nodes,) 1/s of its contour, and weights
    (times, nodes); the real part of their product with the transform at s is the inverse. Raises as invert_many."""
    t = np.asarray(t, float)
    if not (np.isfinite(t).all() and (t > 0).all()):
        raise InvalidValueError(f"times must be finite and > 0 s, got {t[~(np.isfinite(t) & (t > 0))][0]:g}")
    window = np.floor(np.log(t.max() / t) / np.log(WINDOW) * (1 - 1e-12)).astype(int)
    for index in np.unique(window):
        inside = window == index
        last = t[inside].max()
        s, weight = _hyperbola(nodes)
        yield inside, s / last, np.exp(np.outer(t[inside] / last, s)) * weight / last


@cache
def _hyperbola(nodes: int) -> tuple[np.ndarray, np.ndarray]:
    """s (nodes,) on the upper half for times WINDOW^-1 .. 1 s, and the weights of exp(s t) F(s)."""

    def reach(phi: np.ndarray) -> np.ndarray:
        return np.arccosh(((np.pi - 2 * phi) * WINDOW + 4 * phi - np.pi) / (4 * phi - np.pi) / np.sin(phi))

    phis = np.linspace(0.8, 1.5, 7001)
    phi = float(phis[np.argmax((np.pi**2 - 2 * np.pi * phis) / reach(phis))])  # fastest decay of the error
    longest = float(reach(np.array(phi)))
    step = longest / nodes
    mu = (4 * np.pi * phi - np.pi**2) * nodes / longest
    u = (np.arange(nodes) + 0.5) * step
    s = mu * (1 + np.sin(1j * u - phi))
    slope = 1j * mu * np.cos(1j * u - phi)
    return s, slope * step / (1j * np.pi)
