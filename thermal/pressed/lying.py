"""Where a mesh's contact lies on the sensor's face, and how long it is."""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np

from thermograsp.compiled import njit

from ..contact import patch_ends, patch_offset

_ALIKE = 1e-9  # of the moment, by which neither axis is the longer one
_WHOLE = 0.98  # of the face: what is longer covers it, to its points


def end(shares: np.ndarray, lengths: np.ndarray, *, bordering: bool) -> None:
    """Where a contact vanishes it is a strip at both ends: of the mesh, and of the sensor's face unless the pad is
    narrower and it is not bordering on them. shares: (forces, places, places, 4) and lengths the same way along the
    second axis, at places of which the first and the last touch nothing."""
    for end, beside in ((0, 1), (-1, -2)):
        lengths[:, end], shares[:, end] = lengths[:, beside], shares[:, beside]
        shares[:, end, :, 2] = 1.0
        if bordering:
            shares[:, end, :, 0] = 1.0
    for end, beside in ((0, 1), (-1, -2)):
        shares[:, :, end], lengths[:, :, end] = shares[:, :, beside], 0.0
        shares[:, :, end, 3] = 1.0
        if bordering:
            shares[:, :, end, 1] = 1.0


class Moments(NamedTuple):
    """Of what points of the face touch: m2, m3 along both axes, and m4 along both and across."""

    s: float
    y: float
    z: float
    yy: float
    yz: float
    zz: float


@njit(cache=True, inner=True, error_model="numpy")
def mixed(one, a, other, b):
    """Moments of a times the one and b times the other."""
    return Moments(
        a * one.s + b * other.s,
        a * one.y + b * other.y,
        a * one.z + b * other.z,
        a * one.yy + b * other.yy,
        a * one.yz + b * other.yz,
        a * one.zz + b * other.zz,
    )


@njit(cache=True, error_model="numpy")
def lie(moments, square, aside, along, spans, face, sensor, least, found):
    """Writes a contact's shares and its length m to found (5,), by its moments; a point counts as a square of that area
    m2. aside, along: m, the pad's place. face: m, what it bears of the sensor's face, which is sensor m wide. least: m,
    of the longer side."""
    s, y, z = moments.s, moments.y, moments.z
    if s == 0.0:
        return
    yy, zz, yz = moments.yy / s - (y / s) ** 2, moments.zz / s - (z / s) ** 2, moments.yz / s - y * z / s**2
    middle, spread = (yy + zz) / 2, math.hypot((yy - zz) / 2, yz)
    most, least_moment = middle + spread + square / 12, max(middle - spread, 0.0)
    reach = math.sqrt(12 * most)  # m, its length if it is a strip
    thin = s / reach
    longer = math.sqrt(s * math.sqrt(most / (least_moment + min(square, thin * thin) / 12)))
    longer = max(min(longer, reach, face), math.sqrt(s))
    longer = max(longer, least)
    found[4] = longer if yy - zz <= _ALIKE * most else s / longer
    for axis in range(2):
        length = found[4] if axis == 1 else s / found[4]
        pad, off = (along, z / s) if axis == 1 else (aside, y / s)
        pad -= spans[axis] / 2
        length = face if length > _WHOLE * face else length
        found[axis] = patch_offset(off, length, sensor)
        found[2 + axis] = patch_ends(pad + off, pad, length, spans[axis] - face, sensor)
