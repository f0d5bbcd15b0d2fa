"""Laws of contact: records of the numbers on which area and conductance of a fingertip's contact depend.

A CONTACT_LAW holds the numbers of the two faces and of a flat object; area.py and rough_faces.py stay the reference,
which it follows to 1e-9. A FOOTPRINT_LAW also holds those that follow a pad anywhere on the object: boxes, cylinders
and spheres by closed forms (area.py), other bodies by a table over the force. footprint.py evaluates both."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from thermograsp.errors import InvalidValueError, positive

from ..matter import Material, Skin
from .area import ContactArea, Pad, flat_contact
from .fingertip import beneath, face_joint, pad_joint, skinned
from .rough_faces import AIR, LAPPED_ALUMINA, Gas, Joint, Surface, gas_conductance, joint, solid_conductance

FLAT, CYLINDER, SPHERE, TABLE = range(4)
TABLE_FORCES = 0.01 * 3.0 ** np.arange(9)
"""N on the pad, (9,), at which a table is given."""
_ENDLESS = 80.0  # logarithm of W/(m2 K) or of Pa that nothing reaches, finite in 32 bits too

CONTACT_LAW = np.dtype(
    [
        # flat: m2 of the face in contact and its share of the force while the pad is at the middle; sizes m of the
        # object's face along two axes of its frame, 0 where the pad is always taken to be there
        ("area", "f8"),
        ("share", "f8"),
        ("size", "f8", (2,)),
        ("across", "i8", (2,)),
        # stiffness of the springs on the face over that of those around it
        ("ratio", "f8"),
        # curved, for footprints: Pa/m2 of a pad under a body of that radius, half widths m and, of a cylinder, lengths
        # m in contact
        ("stiffness", "f8"),
        ("half_pad", "f8"),
        ("half_face", "f8"),
        ("pad_length", "f8"),
        ("face_length", "f8"),
        # of a contact that presses unevenly: by how much its patch narrows, see spread.narrowing
        ("narrowing", "f8"),
        # beside what is round on both sides, or curved under a skin: m of the gas between faces that touch without
        # force, the temperature jump with it, 0 of none; and Beneath
        ("mean_gap", "f8"),
        ("straight", "f8"),
        ("deep", "f8"),
        ("series", "f8"),
        ("sheet", "f8"),
        ("thick", "f8"),
        # solid spots: h = exp(min(spot_scale + spot_power log p, spot_most))
        ("spot_scale", "f8"),
        ("spot_power", "f8"),
        ("spot_most", "f8"),
        # gas: the mean of gas / (roughness separation + jump + w) over 0 <= w <= flatness, separation by hardnesses Pa
        ("gas", "f8"),
        ("jump", "f8"),
        ("flatness", "f8"),
        ("roughness", "f8"),
        ("log_hardness", "f8"),
        ("log_elastic_hardness", "f8"),
        ("elastic_share", "f8"),
        ("shape", "i8"),
    ]
)
"""Of a row, what the conductance of a contact depends on besides force; flat_law and its like make one."""

FOOTPRINT_LAW = np.dtype(
    [
        # m of a cylinder
        ("length", "f8"),
        # m of curved bodies
        ("radius", "f8"),
        # on a bare face: Hertz's modulus Pa, 0 on springs; m K/W, a disc's constriction times its radius
        ("modulus", "f8"),
        ("constriction", "f8"),
        # at TABLE_FORCES: m2 of the face in contact, its share of the force; W/K where these do not tell, or 0
        ("areas", "f8", TABLE_FORCES.shape),
        ("shares", "f8", TABLE_FORCES.shape),
        ("conducts", "f8", TABLE_FORCES.shape),
        # last: numba takes a record that begins as another does for one of that kind
        *CONTACT_LAW.descr,
    ]
)
"""Of a row, what area and conductance of a contact depend on besides force and place."""


def flat_law(
    pad: Pad, joint: Joint, size: tuple[float, float], across: tuple[int, int] | None = None
) -> np.void:
    """The law of a flat object whose face is of that size m; see area.flat_contact. across: the axes of the object's
    frame along which the sizes lie, to follow a pad that leaves the face's middle; None for one that does not."""
    newton = flat_contact(pad, 1.0, size)
    law = _law(pad, joint, shape=FLAT, area=float(newton.face), share=float(newton.face_force))
    if across is not None:
        law["size"], law["across"] = size, across
    return law


def pad_law(
    pad: Pad,
    skin: Skin | None,
    around: Material,
    other: Surface,
    size: tuple[float, float],
    across: tuple[int, int],
) -> np.void:
    """The law by which what surrounds the sensor conducts to a flat object, `beside_face`'s to evaluate: its own
    surfaces, and its own pressure. pad: the springs; skin: over all of it, None for a bare one; around: the material
    around the sensor. other: the object's surface. size, across: as flat_law's. Raises InvalidValueError for materials
    without a surface."""
    return flat_law(skinned(pad, skin), pad_joint(skin, around, other), size, across)


def cylinder_law(pad: Pad, joint: Joint, radius: float, length: float) -> np.void:
    """The law of a cylinder of that radius and length m; see area.cylinder_contact."""
    lengths = {"pad_length": min(length, pad.width), "face_length": min(length, pad.face)}
    return _law(pad, joint, shape=CYLINDER, stiffness=_stiffness(pad, radius), **lengths)


def sphere_law(pad: Pad, joint: Joint, radius: float) -> np.void:
    """The law of a sphere of that radius m; see area.sphere_contact."""
    return _law(pad, joint, shape=SPHERE, stiffness=_stiffness(pad, radius))


def _stiffness(pad: Pad, radius: float) -> float:
    return pad.foundation_modulus / (2 * radius * pad.thickness)


def _law(pad: Pad, joint: Joint, **numbers: float) -> np.void:
    law = np.zeros(1, CONTACT_LAW)
    scale, higher = solid_conductance(replace(joint, solid_most=np.inf), np.array([1.0, np.e]))
    numbers |= {
        "ratio": pad.face_ratio,
        "half_pad": pad.width / 2,
        "half_face": pad.face / 2,
        "spot_scale": float(np.log(scale)),
        "spot_power": float(np.log(higher / scale)),
        "spot_most": min(float(np.log(joint.solid_most)), _ENDLESS),
        "gas": float(joint.gas_conductivity),
        "jump": float(joint.jump),
        "flatness": float(joint.flatness),
        "roughness": float(joint.roughness),
        "log_hardness": min(float(np.log(joint.hardness)), _ENDLESS),
        "log_elastic_hardness": float(np.log(joint.elastic_hardness)),
        "elastic_share": float(joint.elastic_share),
    }
    for name, value in numbers.items():
        law[name] = value
    return law[0]


def flat_footprint(
    pad: Pad, joint: Joint, size: tuple[float, float], across: tuple[int, int] | None = None
) -> np.void:
    """The law of a flat object; see flat_law."""
    return _followed(flat_law(pad, joint, size, across))


def cylinder_footprint(pad: Pad, joint: Joint, radius: float, length: float) -> np.void:
    """The law of a cylinder along z of that radius and length m; see area.cylinder_contact."""
    beside = {"radius": radius, "mean_gap": mean_gap(joint)}
    return _followed(cylinder_law(pad, joint, radius, length), length=length, **beside)


def sphere_footprint(pad: Pad, joint: Joint, radius: float) -> np.void:
    """The law of a sphere of that radius m; see area.sphere_contact."""
    return _followed(sphere_law(pad, joint, radius), radius=radius, mean_gap=mean_gap(joint))


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
    law["modulus"] = _contact_modulus(face, body)
    return law


def _contact_modulus(face: Surface, body: Surface) -> float:
    """Pa, Hertz's."""
    return 1 / sum((1 - one.poisson_ratio**2) / one.youngs_modulus for one in (face, body))


def face_footprint(pad: Pad, skin: Skin | None, body: Surface) -> np.void:
    """The law of a sensor's face on a body of any shape whose area of contact and force are told from elsewhere: what
    solid_conduction takes, with the gap of faces that touch without force. pad: its silicone; skin: over it, None for a
    bare face, which is rigid."""
    if skin is not None:
        pair = face_joint(skin, body)
        return _followed(flat_law(skinned(pad, skin), pair, (pad.width, pad.width)), mean_gap=mean_gap(pair))
    pair = joint(LAPPED_ALUMINA, body, AIR, full_contact=True)
    numbers = {
        "mean_gap": mean_gap(pair),
        "modulus": _contact_modulus(LAPPED_ALUMINA, body),
        "constriction": (1 / LAPPED_ALUMINA.conductivity + 1 / body.conductivity) / 4,
    }
    return _followed(flat_law(bared(pad), pair, (pad.width, pad.width)), **numbers)


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
        law = sphere_footprint(sheet, faces, radius)
    else:
        law = cylinder_footprint(sheet, faces, radius, length)
    below = beneath(body, skin)
    for name, value in below._asdict().items():
        law[name] = value
    return law


def table_footprint(
    pad: Pad, joint: Joint, contact: ContactArea, conducts: np.ndarray | None = None
) -> np.void:
    """The law of a body whose contact at TABLE_FORCES is known, (9,) each. conducts: (9,) W/K, None for what the areas
    and their forces conduct. Raises InvalidValueError for others."""
    if contact.face.shape != TABLE_FORCES.shape:
        raise InvalidValueError(f"a table needs {len(TABLE_FORCES)} forces, got {contact.face.shape}")
    law = _followed(flat_law(pad, joint, (pad.width, pad.width)), areas=contact.face)
    law["shape"], law["shares"] = TABLE, contact.face_force / TABLE_FORCES
    if conducts is not None:
        # told by the force on the pad
        law["conducts"], law["shares"] = conducts, 1.0
    return law


def mean_gap(joint: Joint) -> float:
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
