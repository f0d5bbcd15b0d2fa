"""What of a sensor's face an object touches, and with what force: a compiled function of a record, force and place.

A FOOTPRINT_LAW record holds a CONTACT_LAW's numbers and those that follow a pad anywhere on the object: boxes,
cylinders and spheres by closed forms (area.py), other bodies by a table over the force. `footprint` evaluates one row.
"""

from __future__ import annotations

import math

import numpy as np

from thermograsp.compiled import njit
from thermograsp.errors import InvalidValueError

from .area import ContactArea, Pad
from .law import CONTACT_LAW, CYLINDER, FLAT, SPHERE, cylinder_law, flat_law, sphere_law
from .rough_faces import Joint
from .round_bodies import ball_on_pad, cylinder_on_pad

TABLE = 3
TABLE_FORCES = 0.01 * 3.0 ** np.arange(9)
"""N on the pad, (9,), at which a table is given."""
_FIRST, _STEP = math.log(0.01), math.log(3.0)

FOOTPRINT_LAW = np.dtype(
    [
        # stiffness of the springs on the face over that of those around it; length m of a cylinder
        ("ratio", "f8"),
        ("length", "f8"),
        # at TABLE_FORCES: m2 of the face in contact, its share of the force
        ("areas", "f8", TABLE_FORCES.shape),
        ("shares", "f8", TABLE_FORCES.shape),
        # last: numba takes a record that begins as another does for one of that kind
        *CONTACT_LAW.descr,
    ]
)
"""Of a row, what area and conductance of a contact depend on besides force and place."""


def flat_footprint(
    pad: Pad, joint: Joint, size: tuple[float, float], across: tuple[int, int] | None = None
) -> np.void:
    """The law of a flat object; see flat_law."""
    return _followed(pad, flat_law(pad, joint, size, across))


def cylinder_footprint(pad: Pad, joint: Joint, radius: float, length: float) -> np.void:
    """The law of a cylinder along z of that radius and length m; see area.cylinder_contact."""
    return _followed(pad, cylinder_law(pad, joint, radius, length), length=length)


def sphere_footprint(pad: Pad, joint: Joint, radius: float) -> np.void:
    """The law of a sphere of that radius m; see area.sphere_contact."""
    return _followed(pad, sphere_law(pad, joint, radius))


def table_footprint(pad: Pad, joint: Joint, contact: ContactArea) -> np.void:
    """The law of a body whose contact at TABLE_FORCES is known, (9,) each. Raises InvalidValueError for others."""
    if contact.face.shape != TABLE_FORCES.shape:
        raise InvalidValueError(f"a table needs {len(TABLE_FORCES)} forces, got {contact.face.shape}")
    law = _followed(pad, flat_law(pad, joint, (pad.width, pad.width)), areas=contact.face)
    law["shape"], law["shares"] = TABLE, contact.face_force / TABLE_FORCES
    return law


def _followed(pad: Pad, law: np.void, **numbers: float | np.ndarray) -> np.void:
    record = np.zeros(1, FOOTPRINT_LAW)
    for name in law.dtype.names or ():
        record[name] = law[name]
    for name, value in {"ratio": pad.face_ratio, **numbers}.items():
        record[name] = value
    return record[0]


@njit(cache=True, error_model="numpy")
def footprint(law, force, place):
    """(area m2 on the face, its force N) at a normal force N > 0 on the pad.

    place: (3,) m, the pad's middle from the object's in the object's frame; of curved bodies what of it lies along the
    pad. Tables leave it aside."""
    if law.shape == FLAT:
        if law.size[0] == 0.0:
            return law.area, force * law.share
        on_pad, on_face = _overlap(law, place)
        bearing = on_pad + (law.ratio - 1.0) * on_face
        return on_face, force * law.ratio * on_face / bearing if bearing > 0.0 else 0.0
    if law.shape == CYLINDER:
        on_pad = _common(law.half_pad, law.length / 2, place[2])
        on_face = _common(law.half_face, law.length / 2, place[2])
        off = math.sqrt(place[0] * place[0] + place[1] * place[1])
        load = force / law.stiffness
        _, area, part = cylinder_on_pad(load, law.ratio, law.half_pad, law.half_face, on_pad, on_face, off)
        return area, law.stiffness * part
    if law.shape == SPHERE:
        off = math.sqrt(place[0] * place[0] + place[1] * place[1])
        load = force / law.stiffness
        _, area, part = ball_on_pad(load, law.ratio, law.half_pad, law.half_face, off, place[2])
        return area, law.stiffness * part
    return _from_table(law, force)


@njit(cache=True, inner=True, error_model="numpy", forceinline=True)
def _overlap(law, place):
    """(m2 on the pad, m2 on the face) under a flat object."""
    on_pad, on_face = 1.0, 1.0
    for side in range(2):
        offset, half = place[law.across[side]], law.size[side] / 2
        on_pad *= _common(law.half_pad, half, offset)
        on_face *= _common(law.half_face, half, offset)
    return on_pad, on_face


@njit(cache=True, inner=True, error_model="numpy", forceinline=True)
def _common(half, other, offset):
    """m, that two intervals of these half widths have in common, their middles that far apart."""
    off = abs(offset)
    return max(min(half, other - off) + min(half, other + off), 0.0)


@njit(cache=True, inner=True, error_model="numpy", forceinline=True)
def _from_table(law, force):
    """Between two forces the area is a power of the force, and below the first as between the first two."""
    last = len(law.areas) - 2
    at = (math.log(force) - _FIRST) / _STEP
    k = min(max(int(math.floor(at)), 0), last)
    part = min(at - k, 1.0)
    low, high = law.areas[k], law.areas[k + 1]
    if low > 0.0:
        area = low * (high / low) ** part
    else:
        area = high * max(part, 0.0)
    share = law.shares[k] + max(part, 0.0) * (law.shares[k + 1] - law.shares[k])
    return area, share * force
