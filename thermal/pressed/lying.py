"""Where a mesh's contact lies on the sensor's face, and how long it is."""

from __future__ import annotations

import math

import numpy as np

from thermograsp.compiled import njit

from ..contact import patch_ends, patch_offset

_WHOLE = 0.98  # of the face: what is longer covers it, to its points


def end(shares: np.ndarray, lengths: np.ndarray) -> None:
    """Where a contact vanishes it is a strip at both ends. shares: (forces, places, places, 4) and lengths the same way
    along the second axis, at places of which the first and the last touch nothing."""
    for end, beside in ((0, 1), (-1, -2)):
        lengths[:, end], shares[:, end] = lengths[:, beside], shares[:, beside]
        shares[:, end, :, 0], shares[:, end, :, 2] = 1.0, 1.0
    for end, beside in ((0, 1), (-1, -2)):
        shares[:, :, end], lengths[:, :, end] = shares[:, :, beside], 0.0
        shares[:, :, end, 1], shares[:, :, end, 3] = 1.0, 1.0


@njit(cache=True, error_model="numpy")
def lie(points, touching, square, aside, along, spans, face, least, found):
    """Writes a contact's shares and its length m to found (5,), by the moments of what of each point touches, m2; a
    point counts as a square of that area m2. aside, along: m, the pad's place. least: m, of the longer side."""
    s, sy, sz, syy, syz, szz = 0.0, 0.0, 0.0, 0.0, 0.0, 0.0
    for i in range(len(touching)):
        w, y, z = touching[i], points[i, 0], points[i, 1]
        s, sy, sz = s + w, sy + w * y, sz + w * z
        syy, syz, szz = syy + w * y * y, syz + w * y * z, szz + w * z * z
    if s == 0.0:
        return
    yy, zz, yz = syy / s - (sy / s) ** 2, szz / s - (sz / s) ** 2, syz / s - sy * sz / s**2
    middle, spread = (yy + zz) / 2, math.hypot((yy - zz) / 2, yz)
    most, least_moment = middle + spread + square / 12, max(middle - spread, 0.0)
    reach = math.sqrt(12 * most)  # m, its length if it is a strip
    thin = s / reach
    longer = math.sqrt(s * math.sqrt(most / (least_moment + min(square, thin * thin) / 12)))
    longer = max(min(longer, reach, face), math.sqrt(s))
    longer = max(longer, least)
    found[4] = longer if zz >= yy else s / longer
    for axis in range(2):
        length = found[4] if axis == 1 else s / found[4]
        pad, off = (along, sz / s) if axis == 1 else (aside, sy / s)
        pad -= spans[axis] / 2
        length = face if length > _WHOLE * face else length
        found[axis] = patch_offset(off, length, face)
        found[2 + axis] = patch_ends(pad + off, pad, length, spans[axis] - face, face)
