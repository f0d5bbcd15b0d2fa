"""Pads that are given as a part of a flat face. MuJoCo has the contacts of two faces at the corners of where they meet,
most of them off such a pad."""

# mujoco ships no type stubs for its compiled names
# pyright: reportAttributeAccessIssue=false

from __future__ import annotations

import warnings
from collections.abc import Sequence

import mujoco
import numpy as np

from ..faces import triangles
from ..fingertips import PadPlace

_MORE = 1e-3  # m beyond a pad's sides
_OFF = 1e-3  # m from a pad's plane, and
_ALONG = 0.999  # least cosine between the normals, of the face that it lies on


def warn_of_wide_faces(model: mujoco.MjModel, pads: Sequence[PadPlace]) -> None:
    """Warns the caller's caller of pads that lie on a wider face."""
    for pad in pads:
        for geom in pad.geoms:
            corners = _face(pad, triangles(model, geom, hull=True))
            if len(corners) and (np.abs(corners).max(axis=0) > pad.size / 2 + _MORE).any():
                small, wide = (
                    " x ".join(f"{1e3 * side:.3g}" for side in sides)
                    for sides in (pad.size, np.ptp(corners, axis=0))
                )
                warnings.warn(
                    f"fingertip {pad.label!r}: its pad of {small} mm is part of a face of {wide} mm, and contacts that "
                    "MuJoCo has at this face's ends are beside the pad and felt as nothing: give the size and the "
                    "position of the whole face, or give the pad a geom of its own that stands out",
                    RuntimeWarning,
                    stacklevel=3,
                )
                break


def _face(pad: PadPlace, corners: np.ndarray) -> np.ndarray:
    """(n, 2) m along the pad's y and z: of the triangles (m, 3, 3) m that lie in its plane."""
    cross = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    along = cross @ pad.axes[:, 0] > _ALONG * np.linalg.norm(cross, axis=1)
    places = (corners - pad.position) @ pad.axes
    flat = along & (np.abs(places[:, :, 0]) < _OFF).all(axis=1)
    return places[flat, :, 1:].reshape(-1, 2)
