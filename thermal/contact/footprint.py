"""What of a sensor's face an object touches, and with what force: a compiled function of a record, force and place.

A FOOTPRINT_LAW record holds a CONTACT_LAW's numbers and those that follow a pad anywhere on the object: boxes,
cylinders and spheres by closed forms (area.py), other bodies by a table over the force. `footprint` evaluates one row;
`conduction` also tells what the contact conducts, and the gas beside it (gas_beside.py).

A bare face of alumina does not sink in. Under a curved body it is a stiff spring, which takes nearly all of the force
where the body's crown is over it, and what the pad beside it leaves where the crown is not. With its force the contact
on it is Hertz's (rigid.py), a disc or a strip that is cut off at a face that is smaller; of a cylinder whose end is
over the face, the part on it takes its share of the length. What a disc conducts more than the gas between faces
without force would is in series with its constriction in both bodies, (1/k + 1/k')(1/a - 1/w)/4, w the radius of a disc
of the face's area: the rest of its heat is no more concentrated than that of the gas around it. Beside it the gap is
Hertz's.
"""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np

from thermograsp.compiled import njit
from thermograsp.errors import InvalidValueError, positive

from ..matter import Skin
from .area import ContactArea, Pad
from .fingertip import face_joint, skinned
from .gas_beside import beside_ball, beside_strip
from .law import CONTACT_LAW, CYLINDER, FLAT, SPHERE, cylinder_law, flat_law, solid_conduction, sphere_law
from .rough_faces import AIR, LAPPED_ALUMINA, Gas, Joint, Surface, gas_conductance, joint
from .round_bodies import ball_on_pad, cylinder_on_pad, disc_on_face

TABLE = 3
TABLE_FORCES = 0.01 * 3.0 ** np.arange(9)
"""N on the pad, (9,), at which a table is given."""
_FIRST, _STEP = math.log(0.01), math.log(3.0)

FOOTPRINT_LAW = np.dtype(
    [
        # m of a cylinder
        ("length", "f8"),
        # of curved bodies: radius m, gap m of faces that touch without force, the temperature jump with it
        ("radius", "f8"),
        ("mean_gap", "f8"),
        # on a bare face: Hertz's modulus Pa, 0 on springs; m K/W, a disc's constriction times its radius
        ("modulus", "f8"),
        ("constriction", "f8"),
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
    return _followed(flat_law(pad, joint, size, across))


def cylinder_footprint(pad: Pad, joint: Joint, radius: float, length: float) -> np.void:
    """The law of a cylinder along z of that radius and length m; see area.cylinder_contact."""
    beside = {"radius": radius, "mean_gap": _mean_gap(joint)}
    return _followed(cylinder_law(pad, joint, radius, length), length=length, **beside)


def sphere_footprint(pad: Pad, joint: Joint, radius: float) -> np.void:
    """The law of a sphere of that radius m; see area.sphere_contact."""
    return _followed(sphere_law(pad, joint, radius), radius=radius, mean_gap=_mean_gap(joint))


def bare_footprint(
    pad: Pad,
    body: Surface,
    radius: float,
    length: float | None = None,
    *,
    face: Surface = LAPPED_ALUMINA,
    gas: Gas | None = AIR,
) -> np.void:
    """The law of a cylinder of that radius and length m, or of a sphere, on a rigid face that wears no skin. Faces with
    a skin yield: sphere_footprint and cylinder_footprint are theirs, with a pad of the skin's springs.

    gas: None for vacuum. A network's patch is the whole face, as heat passes gas all over it, and a disc's constriction
    counts down to it. Raises InvalidValueError for a size that is none."""
    pad, pair = bared(pad, face), joint(face, body, gas, full_contact=True)
    if length is not None:
        law = cylinder_footprint(pad, pair, positive("radius (m)", radius), positive("length (m)", length))
    else:
        law = sphere_footprint(pad, pair, positive("radius (m)", radius))
        law["constriction"] = (1 / face.conductivity + 1 / body.conductivity) / 4
    law["modulus"] = 1 / sum((1 - one.poisson_ratio**2) / one.youngs_modulus for one in (face, body))
    return law


def bared(pad: Pad, face: Surface = LAPPED_ALUMINA) -> Pad:
    """The pad with springs on the sensor's face as stiff as a column of it, as deep as the pad: a rigid face."""
    return replace(pad, face_stiffness=face.youngs_modulus / pad.thickness)


def round_footprint(
    pad: Pad, skin: Skin | None, body: Surface, radius: float, length: float | None = None
) -> np.void:
    """The law of a fingertip on a ball of that radius m, or on a cylinder of that length m. pad: its silicone; skin:
    over it, None for a bare face, which is rigid. Raises InvalidValueError for sizes that are none."""
    if skin is None:
        return bare_footprint(pad, body, radius, length)
    sheet, faces = skinned(pad, skin), face_joint(skin, body)
    if length is None:
        return sphere_footprint(sheet, faces, radius)
    return cylinder_footprint(sheet, faces, radius, length)


def table_footprint(pad: Pad, joint: Joint, contact: ContactArea) -> np.void:
    """The law of a body whose contact at TABLE_FORCES is known, (9,) each. Raises InvalidValueError for others."""
    if contact.face.shape != TABLE_FORCES.shape:
        raise InvalidValueError(f"a table needs {len(TABLE_FORCES)} forces, got {contact.face.shape}")
    law = _followed(flat_law(pad, joint, (pad.width, pad.width)), areas=contact.face)
    law["shape"], law["shares"] = TABLE, contact.face_force / TABLE_FORCES
    return law


def _mean_gap(joint: Joint) -> float:
    """m of gas between faces that touch without force, the temperature jump with it; 0 in vacuum."""
    if not joint.gas_conductivity:
        return 0.0
    return float(joint.gas_conductivity) / float(gas_conductance(replace(joint, flatness=0.0), 0.0))


def _followed(law: np.void, **numbers: float | np.ndarray) -> np.void:
    record = np.zeros(1, FOOTPRINT_LAW)
    for name in law.dtype.names or ():
        record[name] = law[name]
    for name, value in numbers.items():
        record[name] = value
    return record[0]


@njit(cache=True, error_model="numpy")
def footprint(law, force, place):
    """(area m2 on the face, its force N) at a normal force N > 0 on the pad.

    place: (3,) m, the pad's middle from the object's in the object's frame; of curved bodies what of it lies along the
    pad. Tables leave it aside."""
    area, load, _, _ = touched(law, force, place)
    return area, load


@njit(cache=True, error_model="numpy")
def conduction(law, force, place):
    """(area m2 on the face, W/K that it conducts, gas beside it with it) at a normal force N > 0 on the pad; see
    footprint. Gas conducts where nothing on the face touches, too."""
    area, load, square, hertz = touched(law, force, place)
    gas = beside(law, law.mean_gap, area, square, hertz, place)
    return area, solid_conduction(law, area, load) + gas


@njit(cache=True, error_model="numpy")
def gas_conduction(law, force, place):
    """W/K of the gas beside the contact; see conduction."""
    if law.mean_gap == 0.0:
        return 0.0
    area, _, square, hertz = touched(law, force, place)
    return beside(law, law.mean_gap, area, square, hertz, place)


@njit(cache=True, inner=True, error_model="numpy")
def beside(law, mean_gap, area, square, hertz, place):
    """W/K of the gas beside a curved contact of that area m2, whose half width has that square m2, where faces that
    touch without force are so far apart, m; 0 beside others. The rest: of touched."""
    if mean_gap <= 0.0:
        return 0.0
    off, half = math.sqrt(place[0] * place[0] + place[1] * place[1]), law.half_face
    if law.shape == SPHERE:
        gas = law.gas * beside_ball(square, hertz, mean_gap, law.radius, half, off, place[2])
        if hertz > 0.0 and area > 0.0:
            under, _ = disc_on_face(square, half, off, place[2])
            gas *= _share_beside(4 * half * half, area, under * math.pi * square)
        return gas
    if law.shape == CYLINDER:
        along = _common(half, law.length / 2, place[2])
        gas = law.gas * along * beside_strip(square, mean_gap, law.radius, half, off)
        if hertz > 0.0 and area > 0.0:
            gas *= _share_beside(2 * half * along, area, _common(half, math.sqrt(square), off) * along)
        return gas
    return 0.0


@njit(cache=True, inner=True, error_model="numpy", forceinline=True)
def _share_beside(whole, touched, under):
    """How much of the face is beside what touches, over what is not under the curve: Hertz's contact stays on the face
    where its middle would be near the edge or beyond it."""
    return max(whole - touched, 0.0) / (whole - under) if under < whole else 0.0


@njit(cache=True, inner=True, error_model="numpy")
def touched(law, force, place):
    """(area m2 on the face, its force N, of a curved contact the squares m2 of its half width and Hertz's)."""
    if law.shape == FLAT:
        if law.size[0] == 0.0:
            return law.area, force * law.share, 0.0, 0.0
        on_pad, on_face = _overlap(law, place)
        bearing = on_pad + (law.ratio - 1.0) * on_face
        return on_face, force * law.ratio * on_face / bearing if bearing > 0.0 else 0.0, 0.0, 0.0
    if law.shape == TABLE:
        area, load = _from_table(law, force)
        return area, load, 0.0, 0.0
    off = math.sqrt(place[0] * place[0] + place[1] * place[1])
    load = force / law.stiffness
    if law.shape == CYLINDER:
        on_pad = _common(law.half_pad, law.length / 2, place[2])
        along = _common(law.half_face, law.length / 2, place[2])
        _, area, part, square = cylinder_on_pad(
            load, law.ratio, law.half_pad, law.half_face, on_pad, along, off
        )
        load, hertz = law.stiffness * part, 0.0
        if law.modulus > 0.0 and along > 0.0:
            load *= min(along / min(law.length, 2 * law.half_face), 1.0)
            hertz = 4 * load * law.radius / (math.pi * law.modulus * along)
            width, held = math.sqrt(hertz), 1.0
            if width > law.half_face:
                share = law.half_face / width
                width, held = law.half_face, (3 - share * share) * share / 2
            area, load = 2 * width * along, load * held
            square = max(min(max(off - law.half_face, 0.0) ** 2, square), hertz)
        return area, load, square, hertz
    _, area, part, square = ball_on_pad(load, law.ratio, law.half_pad, law.half_face, off, place[2])
    load, hertz = law.stiffness * part, 0.0
    if law.modulus > 0.0:
        if load > 0.0:
            hertz = (0.75 * load * law.radius / law.modulus) ** (2 / 3)
            part, held = disc_on_face(hertz, law.half_face, 0.0, 0.0)
            area, load = math.pi * hertz * part, load * held
            away, aside = max(off - law.half_face, 0.0), max(abs(place[2]) - law.half_face, 0.0)
            square = max(min(away * away + aside * aside, square), hertz)
    return area, load, square, hertz


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
