"""Area and conductance of a fingertip's contact as one compiled function of the normal force, for many rows at once.

The laws are those of area.py and rough_faces.py, which stay the reference: a row holds one object's numbers, and
`contact` evaluates them in the order of their formulas, to 1e-9. Rows never mix.
"""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np

from thermograsp.compiled import njit

from ..numerics import (
    FARTHEST,
    FAST,
    HIGH,
    LOW,
    NEAREST,
    SERIES,
)
from .area import Pad, flat_contact
from .patch_place import NARROW, patch_ends, patch_offset
from .rough_faces import Joint, solid_conductance

FLAT, CYLINDER, SPHERE = range(3)

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

# Mean planes' distance over roughness, sqrt(2) erfc^-1(x), in powers of where sqrt(-log x) is between LOW and HIGH; the
# series' first terms, good to 1e-11.
LOG_LEAST, LOG_MOST = math.log(FARTHEST), math.log(NEAREST)
SEPARATION = math.sqrt(2) * np.polynomial.chebyshev.cheb2poly(SERIES[:13])
_ENDLESS = 80.0  # logarithm of W/(m2 K) or of Pa that nothing reaches, finite in 32 bits too


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


@njit(cache=True, inner=True, error_model="numpy")
def _overlap(law, place):
    """(area m2 on the face, its share of the force) of a flat object. place: see contact."""
    if law.size[0] == 0:
        return law.area, law.share
    on_pad, on_face = 1.0, 1.0
    for side in range(2):
        axis = law.across[side]
        offset, half = abs(place[axis]), law.size[side] / 2
        on_pad *= max(min(law.half_pad, half - offset) + min(law.half_pad, half + offset), 0.0)
        on_face *= max(min(law.half_face, half - offset) + min(law.half_face, half + offset), 0.0)
    bearing = on_pad + (law.ratio - 1.0) * on_face
    return on_face, law.ratio * on_face / bearing if on_pad > 0 else 0.0


@njit(cache=True, error_model="numpy", fastmath=FAST, forceinline=True)
def contact(law, force, place):
    """(area m2 on the face, its force N) of a flat object at a normal force N > 0 on the pad; not numbers of others,
    which footprints and tables know. place: (3,) m, the pad's middle from the object's in the object's frame, which
    laws of a fixed place leave aside."""
    if law.shape != FLAT:
        return math.nan, math.nan
    area, share = _overlap(law, place)
    return area, force * share


@njit(cache=True, error_model="numpy")
def flat_patch(law, area, place, shares):
    """m, the second side of a flat contact of that area m2 on the face; fills shares (4,) by which it lies at an end of
    the face along both sides, and at an end of the object (patch_place.py). place: as contact's."""
    width = 2 * law.half_face
    for side in range(4):
        shares[side] = 0.0
    if law.size[0] == 0 or area >= width * width * NARROW:
        return math.sqrt(area)
    length = 0.0
    for side in range(2):
        pad, size = place[law.across[side]], law.size[side]
        low, high = max(-law.half_face, -pad - size / 2), min(law.half_face, size / 2 - pad)
        length = high - low
        shares[side] = patch_offset((low + high) / 2, length, width)
        shares[2 + side] = patch_ends(pad + (low + high) / 2, pad, length, size, width)
    return length


@njit(cache=True, error_model="numpy", fastmath=FAST, forceinline=True)
def conductance(law, pressure):
    """W/(m2 K) at a pressure Pa > 0, solid spots and gas together."""
    log_pressure = math.log(pressure)
    solid = math.exp(min(law.spot_scale + law.spot_power * log_pressure, law.spot_most))
    share, separation = law.elastic_share, 0.0
    if share < 1.0:
        separation += (1 - share) * _separation(log_pressure + math.log(2.0) - law.log_hardness)
    if share > 0.0:
        separation += share * _separation(log_pressure + math.log(4.0) - law.log_elastic_hardness)
    gap = law.roughness * separation + law.jump
    if law.flatness > 0.0:
        return solid + law.gas / law.flatness * math.log1p(law.flatness / gap)
    return solid + law.gas / gap


@njit(cache=True, error_model="numpy")
def solid_conduction(law, area, load):
    """W/K of an area m2 of the face under a force N on it; law: a FOOTPRINT_LAW.

    Conductance is that of the mean pressure. Under a curved body pressure varies, and the sum over places is within
    2.5 % of this, as the spots conduct nearly in proportion to pressure and the gas nearly without it."""
    if area <= 0.0:
        return 0.0
    conducts = conductance(law, load / area) * area
    if law.constriction > 0.0:
        more = math.sqrt(math.pi / area) - 0.5 * math.sqrt(math.pi) / law.half_face
        if more > 0.0:
            gas = law.gas / law.mean_gap * area if law.mean_gap > 0.0 else 0.0  # between faces without force
            conducts = gas + (conducts - gas) / (1.0 + (conducts - gas) * law.constriction * more)
    return conducts


@njit(cache=True, inner=True, error_model="numpy", fastmath=FAST, forceinline=True)
def _separation(log_share):
    y = math.sqrt(-min(max(log_share, LOG_LEAST), LOG_MOST))
    z = (2 * y - LOW - HIGH) / (HIGH - LOW)
    total = 0.0
    for i in range(len(SEPARATION) - 1, -1, -1):
        total = total * z + SEPARATION[i]
    return total
