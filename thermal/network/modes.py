"""Patch modes: the few heat-flux patterns over a contact that its thermal network needs.

Conduction is self-adjoint, so the error in temperature is quadratic in the error of the flux pattern and a handful of
patterns serves every conductance and every moment of one geometry. The first is the uniform one; the others are the
leading singular vectors of the patterns that arise over decades of frequency and conductance.

C: patterns of the contact patch, P: modes.
"""

from __future__ import annotations

import numpy as np

from ..plates import BodySamples, Geometry

_ROUND_OFF = 1e-12  # of a flux of size 1, which need not be at right angles to the uniform pattern
_CONDUCTANCES = (1e3, 1e4, 1e5, 1e9)  # W/(m2 K)


def patch_modes(geometry: Geometry, bodies: dict[str, BodySamples], s: np.ndarray, count: int) -> np.ndarray:
    """Orthonormal modes (C, count), the uniform one first. bodies: sampled at s (S,)."""
    uniform = geometry.patch.uniform
    even = bodies["even"]
    pole = np.outer(uniform, uniform)[None] * geometry.patch.area / even.capacity / s[:, None, None]
    both = even.impedance.value + pole
    # One fingertip alone sees the mean of the even and the odd body, two at once the even one.
    touched_bodies = [both] + [
        (both + body.impedance.value) / 2 for name, body in bodies.items() if name == "odd"
    ]
    sensor = bodies["sensor"].impedance.value if "sensor" in bodies else 0.0
    identity = np.eye(len(uniform))
    patterns = []
    for touched in touched_bodies:
        for conductance in _CONDUCTANCES:
            flux = np.linalg.solve(touched + sensor + identity / conductance, uniform)
            other = flux - np.outer(flux @ uniform, uniform)
            patterns.append(other / np.linalg.norm(flux, axis=1, keepdims=True))
    left, sizes, _ = np.linalg.svd(np.concatenate(patterns).T, full_matrices=False)
    modes = np.column_stack((uniform, left[:, : count - 1]))
    arisen = 1 + int(np.sum(sizes[: count - 1] > _ROUND_OFF))
    if arisen < count:  # as on an object that is no wider than the contact: any others at right angles do
        others, _ = np.linalg.qr(np.column_stack((modes[:, :arisen], np.eye(len(uniform)))))
        modes[:, arisen:] = others[:, arisen:count]
    return modes
