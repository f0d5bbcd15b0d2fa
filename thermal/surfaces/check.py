"""Whether triangles enclose a body: edges that are open, and volume that is enclosed twice or inside out."""

from __future__ import annotations

import numpy as np

from .cut import enclosed

_CELLS = 48  # along the longest side


def open_edges(faces: np.ndarray, vertices: int) -> int:
    """How many edges of faces (F, 3) have no counterpart that runs the other way: 0 for a closed surface whose faces
    are all turned the same way. vertices: how many there are."""
    start, end = faces.ravel(), np.roll(faces, -1, axis=1).ravel()
    forth, back = np.sort(start * vertices + end), np.sort(end * vertices + start)
    if np.array_equal(forth, back):
        return 0
    values, counts = np.unique(np.concatenate((forth, back)), return_counts=True)
    forward = np.searchsorted(forth, values, side="right") - np.searchsorted(forth, values, side="left")
    return int(np.abs(2 * forward - counts).sum()) // 2


def wrongly_enclosed(triangles: np.ndarray) -> tuple[float, float]:
    """m3 of triangles (F, 3, 3) m that are enclosed more than once and that lie inside out, as far as the cells of a
    grid of 48 along the longest side show it. Surfaces that cross enclose some volume twice or inside out."""
    corners = triangles.reshape(-1, 3)
    low, high = corners.min(axis=0), corners.max(axis=0)
    length = (high - low).max() / _CELLS
    axes = [
        np.linspace(a, b, max(int(np.ceil((b - a) / length)), 1) + 1) for a, b in zip(low, high, strict=True)
    ]
    volumes, _ = enclosed(triangles, (axes[0], axes[1], axes[2]))
    x, y, z = (np.diff(axis) for axis in axes)
    cell = x[:, None, None] * y[:, None] * z
    return float(np.maximum(volumes - cell, 0.0).sum()), float(np.maximum(-volumes, 0.0).sum())
