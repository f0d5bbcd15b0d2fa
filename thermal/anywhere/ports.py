"""A sensor's face as ports of a body: the element under a square contact, patterns of flow, and the modes by them.

N: cells, M: patterns, R: modes.
"""

from __future__ import annotations

import numpy as np

from ..kernels import FUNCTIONS, NODES, Resolution, Tip, tip
from ..matter import SensorStack
from ..meshes import BodyModes, PatchPatterns, PlacedPatch, patch_on_grid

LEVEL = Resolution(12, 3, slowest=3e-3)


def centred_tip(stack: SensorStack, area: float) -> Tip:
    """The sensor's element under a square contact of m2 in the middle of its face."""
    low = (stack.width - min(area**0.5, stack.width)) / 2
    side = low, stack.width - low
    return tip(stack, (side, side), LEVEL)


def face_patterns(one: Tip) -> PatchPatterns:
    """The tip's, by their integrals from the middle."""
    half = len(NODES) // 2
    edges = NODES[half:]
    flows = np.concatenate(
        (np.zeros((len(FUNCTIONS), 1)), np.cumsum(FUNCTIONS[:, half:] * np.diff(edges), axis=1)), axis=1
    )
    first = np.concatenate((one.basis[: len(FUNCTIONS)].T @ flows, np.zeros((0, len(edges)))))
    second = one.basis[len(FUNCTIONS) :].T @ flows[1:]
    sums = first.T[:, None] * edges[None, :, None] + edges[:, None, None] * second.T[None]
    return PatchPatterns(edges, sums)


def seen_by_face(
    modes: BodyModes, triangles: np.ndarray, placed: PlacedPatch, patterns: PatchPatterns
) -> np.ndarray:
    """(M, R) of the modes by a patch's patterns, at the surface: a field that is level at the wall is a parabola from
    there to the first two nodes."""
    return seen_on_grid(modes, patch_on_grid(modes.grid, triangles, placed, patterns).shares, placed.normal)


def seen_on_grid(modes: BodyModes, shares: np.ndarray, normal: np.ndarray) -> np.ndarray:
    """(M, R) of the modes by flows across that normal, spread over the cells of their grid by shares (N, M)."""
    grid = modes.grid
    cells = np.flatnonzero(shares.any(axis=1))
    each = shares[cells]
    seen = each.T @ modes.fields[cells]
    for axis, along in enumerate(normal):
        inward = grid.neighbours[cells, 2 * axis + (0 if along > 0 else 1)]
        touches = inward >= 0
        rise = modes.fields[cells[touches]] - modes.fields[inward[touches]]
        seen += along**2 / 8 * each[touches].T @ rise
    return seen
