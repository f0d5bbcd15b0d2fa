"""Heat between two patches on one face that overlap, as the cells beneath one of them tell it.

These are fine at the one's ends and coarse in its middle, where the other may end. A box beside tells what they are too
coarse for: what one patch feels of the other on it, as it is and cut into the same cells.

M: patterns, T: times.
"""

from __future__ import annotations

import numpy as np

from ..kernels import Tip
from .box import flows_along, functions
from .local import flow_into
from .rays import Face
from .spread import Between, Spread

_LEVEL = 0.3  # half widths from a face, up to which a patch is on it
_ALONG = 0.95  # cosine between normals, likewise
_TURNED = 0.98  # cosine between sides, likewise


def overlapped(spread: Spread, other: Face, tip: Tip) -> Between | None:
    """Without the cells' error. other: middle and axes of another patch, as wide as the one beneath which cells are.
    None where it does not lie on the one's face, along its sides."""
    local = spread.local
    place, cells, beside = local.place, local.cells, local.beside
    at = place.face.located((other.centre - place.face.centre) @ place.face.axes.T)
    if not np.isfinite(at).all() or abs(at[2]) > _LEVEL * place.half:
        return None
    axes = other.axes @ _axes_at(place.face, at[:2]).T
    turned = bool(abs(axes[0, 1]) > abs(axes[0, 0]))
    if axes[2, 2] < _ALONG or abs(axes[0, int(turned)]) < _TURNED:
        return None
    values = functions(tip)[::-1] if turned else functions(tip)
    middle = float(at[0]), float(at[1])
    covered = []
    for axis, columns in enumerate(local.along):
        wide = place.face.along(place.half, axis)
        covered.append(np.clip(middle[axis] + np.array([-wide, wide]), *columns.face))
    if min(high - low for low, high in covered) <= 0:
        return None
    flows = flows_along(place.face, place.half, values, np.array(covered), middle)
    ports = flow_into(place, cells, local.along, values, middle)
    if not ports.any():
        return None
    sensed = np.einsum("nj,tni->tji", ports[spread.seen], spread.fields, optimize=True)
    at_its_port = spread.fields[..., 0] @ local.ports[spread.seen, 0]
    taus = local.diffusivity * spread.times
    share = at_its_port / beside.on_cells(beside.flows, taus)[:, 0, 0]
    missed = beside.exact(flows, taus) - beside.on_cells(flows, taus)
    return Between(sensed + share[:, None, None] * missed.transpose(0, 2, 1), 0.0)


def _axes_at(face: Face, along: np.ndarray) -> np.ndarray:
    """(3, 3) rows are directions of u, v and w at a place along a face."""
    angles = face.bend * along
    sides = np.stack((np.cos(angles), -np.sin(angles)), axis=1)
    u, v = (side[0] * face.axes[axis] + side[1] * face.axes[2] for axis, side in enumerate(sides))
    w = np.cross(u, v)
    return np.stack((u, v, w / np.linalg.norm(w)))
