"""The compiled contact law as a pure function of arrays: NumPy, PyTorch, JAX.

What law.py's `contact` and `conductance` compute, without a branch on data, so that it runs on any device and can be
traced. Every array has the records' leading axes.
"""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np

from ..numerics import HIGH, LOW, Array, as_like, namespace_of
from .footprint import LOG_LEAST, LOG_MOST, SEPARATION
from .law import CYLINDER
from .patch_place import NARROW, array_patch_ends, array_patch_offset

_COEFFICIENTS = tuple(SEPARATION[::-1].tolist())  # highest power first, as numbers that compilers can see
_LEAST_FORCE = 1e-9  # N, of a contact that is apart: any at which the law has a value


class ArrayLaws(NamedTuple):
    """CONTACT_LAW records as arrays, (...) each but for sizes (..., 2) m. select: (..., 2, 3), 1 at the axes that
    `across` names. cylinder: 1 for laws of cylinders, else 0; follows: 1 for a flat law that follows its pad."""

    area: Array
    share: Array
    size: Array
    select: Array
    ratio: Array
    half_pad: Array
    half_face: Array
    narrowing: Array
    mean_gap: Array
    straight: Array
    deep: Array
    series: Array
    sheet: Array
    thick: Array
    spot_scale: Array
    spot_power: Array
    spot_most: Array
    gas: Array
    jump: Array
    flatness: Array
    roughness: Array
    log_hardness: Array
    log_elastic_hardness: Array
    elastic_share: Array
    cylinder: Array
    follows: Array

    def at(self, index: Array) -> ArrayLaws:
        """The laws of the given indices along the first axis."""
        return ArrayLaws(*(table[index] for table in self))


def array_laws(records: np.ndarray, like: Array) -> ArrayLaws:
    """CONTACT_LAW records in the kind, dtype and device of the array `like`, which holds floating-point numbers."""
    columns = {name: records[name] for name in ArrayLaws._fields if name in (records.dtype.names or ())}
    columns["select"] = np.eye(3)[records["across"]]
    columns["cylinder"] = (records["shape"] == CYLINDER).astype(float)
    columns["follows"] = (records["size"][..., 0] > 0).astype(float)
    return ArrayLaws(*(as_like(columns[name], like) for name in ArrayLaws._fields))


def array_contact(laws: ArrayLaws, force: Array, place: Array) -> tuple[Array, Array]:
    """(area m2 on the face, its force N) of flat objects at normal forces N on the pads, of the laws' shape; those not
    above 0 count as none. place: (..., 3) m, the pad's middle from the object's in the object's frame. What it gives of
    curved ones means nothing: array_curved_contact is theirs."""
    xp = namespace_of(force)
    pressed = force.clip(_LEAST_FORCE, None)
    offset = abs((laws.select * place[..., None, :]).sum(-1))
    half = laws.size / 2

    def covered(reach: Array) -> Array:
        sides = xp.minimum(reach, half - offset) + xp.minimum(reach, half + offset)
        return sides.clip(0.0, None).prod(-1)

    on_pad, on_face = covered(laws.half_pad[..., None]), covered(laws.half_face[..., None])
    bearing = on_pad + (laws.ratio - 1.0) * on_face
    part = laws.ratio * on_face / xp.where(on_pad > 0, bearing, on_pad + 1.0)
    area = xp.where(laws.follows > 0, on_face, laws.area)
    carried = xp.where(laws.follows > 0, part, laws.share) * pressed
    touching = force > 0
    return area * touching, carried * touching


def array_flat_patch(laws: ArrayLaws, area: Array, place: Array, width: Array) -> tuple[Array, Array]:
    """flat_patch on objects: m, and shares (..., 4), as a pure function of arrays. area: m2, of the laws' shape; place:
    (..., 3) m; width: m of the sensors' faces."""
    xp = namespace_of(area)
    half = laws.half_face[..., None]
    pad, size = (laws.select * place[..., None, :]).sum(-1), laws.size
    low, high = xp.maximum(-half, -pad - size / 2), xp.minimum(half, size / 2 - pad)
    length, middle = high - low, (low + high) / 2
    covers = (laws.follows > 0) & (area < width * width * NARROW)
    face = width[..., None] + 0.0 * length
    offset = array_patch_offset(middle, length, face)
    ends = array_patch_ends(pad + middle, pad, length, size, face)
    shares = xp.where(covers[..., None], xp.concatenate((offset, ends), -1), 0.0 * area[..., None])
    some = area > 0  # the root of 0 has no slope
    side = xp.where(some, xp.where(some, area, 1.0 + 0.0 * area) ** 0.5, 0.0 * area)
    return xp.where(covers, length[..., 1], side), shares


def array_conductance(laws: ArrayLaws, pressure: Array) -> Array:
    """W/(m2 K) at pressures Pa > 0 of the laws' shape, solid spots and gas together."""
    xp = namespace_of(pressure)
    log_pressure = xp.log(pressure)
    solid = xp.exp(xp.minimum(laws.spot_scale + laws.spot_power * log_pressure, laws.spot_most))
    plastic = _separation(log_pressure + (math.log(2.0) - laws.log_hardness))
    elastic = _separation(log_pressure + (math.log(4.0) - laws.log_elastic_hardness))
    separation = (1 - laws.elastic_share) * plastic + laws.elastic_share * elastic
    gap = laws.roughness * separation + laws.jump
    widens = laws.flatness / gap
    mean = xp.where(widens > 0, xp.log1p(widens) / xp.where(widens > 0, widens, 1 + widens), 1 + widens)
    return solid + laws.gas / gap * mean


def _separation(log_share):
    y = (-log_share.clip(LOG_LEAST, LOG_MOST)) ** 0.5
    z = (2 * y - (LOW + HIGH)) / (HIGH - LOW)
    total = 0.0 * z
    for coefficient in _COEFFICIENTS:
        total = total * z + coefficient
    return total
