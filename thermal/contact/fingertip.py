"""What of a fingertip touches: its pad with the skin that it wears, and the faces that meet."""

from __future__ import annotations

import math
from dataclasses import replace
from typing import NamedTuple

from ..matter import Material, Skin
from ..numerics import Array
from .area import Pad
from .rough_faces import LAPPED_ALUMINA, THERMOSTAT_FACE, Joint, Surface, joint

_SECONDS = 1.0
_DEEPEST = 0.8e-3, 3e-3  # m, that heat has come until then: beneath a face on which it spreads, and at most


class Beneath(NamedTuple):
    """What heat meets on both sides of a contact, see spread.py. straight, deep: m2 K/W of both bodies, as deep as it
    comes beneath a whole face and beneath a part of it. series: m K/W, the reciprocal of their conductivities in
    series, between which it spreads. sheet, thick: m2 K/W of a skin, and m; heat spreads in it at the edge of what
    touches only. Numbers, or arrays of one shape."""

    straight: Array
    deep: Array
    series: Array
    sheet: Array
    thick: Array


def beneath(body: Material | Surface, skin: Skin | None = None) -> Beneath:
    """Of a body under a sensor's face, which wears that skin or is bare. A surface that does not know its body's
    diffusivity counts as one that conducts heat fast."""
    depth = math.inf if body.diffusivity is None else math.sqrt(body.diffusivity * _SECONDS)
    series = 1 / LAPPED_ALUMINA.conductivity + 1 / body.conductivity
    straight, deep = (min(depth, deepest) * series for deepest in _DEEPEST)
    if skin is None:
        return Beneath(straight, deep, series, 0.0, 0.0)
    return Beneath(straight, deep, series, skin.resistance, skin.thickness)


def skinned(pad: Pad, skin: Skin | None) -> Pad:
    """The pad under a skin, whose springs are in series with the silicone's around the sensor and alone on its face,
    which is rigid. Without a skin the pad itself, whose springs are the same all over."""
    if skin is None:
        return pad
    pad_stiffness = pad.foundation_modulus / pad.thickness
    softer = skin.stiffness / (skin.stiffness + pad_stiffness)
    return replace(pad, youngs_modulus=softer * pad.youngs_modulus, face_stiffness=skin.stiffness)


def in_series(one: Pad, other: Pad) -> Pad:
    """Two pads that press each other as one does a rigid body: the springs of both are in series, and what bears, and
    each face, are no wider than the narrower one's."""
    soft = _in_series(*(pad.foundation_modulus / pad.thickness for pad in (one, other)))
    firm = _in_series(*(pad.face_ratio * pad.foundation_modulus / pad.thickness for pad in (one, other)))
    both = replace(
        one, width=min(one.width, other.width), face=min(one.face, other.face), face_stiffness=firm
    )
    return replace(both, youngs_modulus=one.youngs_modulus * soft * both.thickness / both.foundation_modulus)


def _in_series(one: float, other: float) -> float:
    return one * other / (one + other)


def touching(skin: Skin | None) -> Surface:
    """The sensor's face, or the skin's."""
    return LAPPED_ALUMINA if skin is None else Surface.of(skin.made_of)


def face_joint(skin: Skin | None, other: Surface) -> Joint:
    """The faces of a fingertip and of what it touches. Under a skin spots conduct no more than at full contact."""
    return joint(touching(skin), other, full_contact=skin is not None)


def pad_joint(skin: Skin | None, pad: Material, other: Surface) -> Joint:
    """The faces of the pad of that material around a sensor, or of the skin over both, and of what it touches. Both are
    soft: spots conduct no more than at full contact. Raises InvalidValueError for a pad without a surface."""
    front = Surface.of(pad if skin is None else skin.made_of)
    return joint(front, other, full_contact=True)


def element_joint(other: Surface = THERMOSTAT_FACE) -> Joint:
    """The faces of an element that is glued on an object and of what touches it, a thermostat (O mode)."""
    return joint(LAPPED_ALUMINA, other)
