"""Curved bodies on the bare face of a rigid sensor: what touches (Hertz), and the gas in the gap around it.

The laws of area.py press a soft pad; lapped alumina does not yield, and a steel ball of 20 mm radius at 10 N touches it
over a disc of 0.1 mm radius. With 1/E* = sum (1 - nu^2)/E and R the body's radius (Johnson, Contact Mechanics, sections
4.2 and 4.3):

    ball:      a^3 = 3 F R/(4 E*),        mean pressure F/(pi a^2)
    cylinder:  b^2 = 4 F R/(pi E* l),     mean pressure F/(2 b l)

There the conductance is that of rough faces at the mean pressure (within 0.5 % of its mean over Hertz's pressures: it
is nearly in proportion to pressure). Under a disc, what it is more than that of gas between faces without force, which
is no more concentrated than in the gas around, is in series with the constriction in both bodies, 1/(4 k a) each. None
is counted under a strip, whose constriction depends on the whole bodies, by the logarithm of their size. Around it lies
gas, in a gap of height d + g: d that of rough faces without pressure and the temperature jump (rough_faces.py), and
with x the distance over a or b

    ball:      g = a^2/(pi R) (sqrt(x^2 - 1) + (x^2 - 2) arccos(1/x))
    cylinder:  g = b^2/(2 R) (x sqrt(x^2 - 1) - arcosh x)

which are r^2/(2 R) without force, where the gas conducts 2 pi k R log(1 + w^2/(2 R d)) and 2 k l sqrt(2 R/d)
atan(w/sqrt(2 R d)) out to w. It is taken to conduct straight across, between faces of one temperature each. Roughness
above 0.05 a^2/R spreads the force over more than Hertz's area (Greenwood & Tripp 1967, J. Appl. Mech. 34:153), which
lessens the constriction: `solid` is then a lower bound, and `spots`, which does not depend on the area, an upper one.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from thermograsp.errors import InvalidValueError, non_negative, positive

from .rough_faces import AIR, Gas, Surface, contact_conductance, gas_conductance, joint

_NODES, _WEIGHTS = np.polynomial.legendre.leggauss(64)
_SMALL = 0.5  # of the face's or the body's half width, up to which a contact counts as small


@dataclass(frozen=True, slots=True)
class RigidContact:
    """A curved body on a rigid face. half_width: m, the radius of the disc or half the width of the strip that touches.
    pressure: Pa, mean over it. spots: W/K through the faces that touch, solid: the same with the constriction in both
    bodies. gas: W/K through the gap around them."""

    half_width: float
    pressure: float
    spots: float
    solid: float
    gas: float

    @property
    def conductance(self) -> float:
        """W/K in all."""
        return self.solid + self.gas


def rigid_sphere(
    face: Surface, body: Surface, force: float, radius: float, width: float, gas: Gas | None = AIR
) -> RigidContact:
    """A ball of that radius m on the middle of a square face of that width m, which counts as a disc of its area.
    force: N, >= 0. gas: None for vacuum. Raises InvalidValueError for values that are none, and for a
    contact that is not small."""
    load = non_negative("force (N)", force)
    reach = min(positive("width (m)", width) / math.sqrt(math.pi), positive("radius (m)", radius))
    touching = (3 * load * radius / (4 * _modulus(face, body))) ** (1 / 3)
    _require_small(touching, reach)
    mean_gap, conducting = _gap(face, body, gas)
    at, weights = _places(touching, reach, math.sqrt(2 * radius * mean_gap))
    around = conducting * float(weights @ (2 * math.pi * at / (mean_gap + _ball_gap(at, touching, radius))))
    if load == 0:
        return RigidContact(0.0, 0.0, 0.0, 0.0, around)
    area = math.pi * touching**2
    spots = _spots(face, body, load / area, gas) * area
    constriction = (1 / face.conductivity + 1 / body.conductivity) / (4 * touching)
    untouched = conducting / mean_gap * area
    more = spots - untouched
    return RigidContact(touching, load / area, spots, untouched + more / (1 + more * constriction), around)


def rigid_cylinder(
    face: Surface,
    body: Surface,
    force: float,
    radius: float,
    length: float,
    width: float,
    gas: Gas | None = AIR,
) -> RigidContact:
    """A cylinder of that radius and length m along a side of a square face of that width m, over its middle. force: N
    on what of it is on the face, >= 0. gas: None for vacuum. Raises InvalidValueError for values that are none, and for
    a contact that is not small."""
    load = non_negative("force (N)", force)
    reach = min(positive("width (m)", width) / 2, positive("radius (m)", radius))
    along = min(positive("length (m)", length), width)
    touching = math.sqrt(4 * load * radius / (math.pi * _modulus(face, body) * along))
    _require_small(touching, reach)
    mean_gap, conducting = _gap(face, body, gas)
    at, weights = _places(touching, reach, math.sqrt(2 * radius * mean_gap))
    around = conducting * float(weights @ (2 * along / (mean_gap + _cylinder_gap(at, touching, radius))))
    if load == 0:
        return RigidContact(0.0, 0.0, 0.0, 0.0, around)
    area = 2 * touching * along
    spots = _spots(face, body, load / area, gas) * area
    return RigidContact(touching, load / area, spots, spots, around)


def _places(start: float, end: float, scale: float) -> tuple[np.ndarray, np.ndarray]:
    """Places m from start to end and their weights m, for what changes over `scale` m or where it begins."""
    low, high = math.asinh(start / scale), math.asinh(end / scale)
    angle = low + (high - low) * (_NODES + 1) / 2
    return scale * np.sinh(angle), scale * np.cosh(angle) * (high - low) / 2 * _WEIGHTS


def _ball_gap(at: np.ndarray, touching: float, radius: float) -> np.ndarray:
    """m, between the faces at distances m from the middle."""
    if touching == 0:
        return at**2 / (2 * radius)
    x = at / touching
    return touching**2 / (math.pi * radius) * (np.sqrt(x * x - 1) + (x * x - 2) * np.arccos(1 / x))


def _cylinder_gap(at: np.ndarray, touching: float, radius: float) -> np.ndarray:
    """m, between the faces at distances m from the middle."""
    if touching == 0:
        return at**2 / (2 * radius)
    x = at / touching
    return touching**2 / (2 * radius) * (x * np.sqrt(x * x - 1) - np.arccosh(x))


def _require_small(touching: float, reach: float) -> None:
    if touching > _SMALL * reach:
        raise InvalidValueError(
            f"the contact would reach {1e3 * touching:.2g} mm to each side, where {1e3 * reach:.2g} mm are there: "
            "Hertz's law is of stiff bodies and small contacts; take sphere_contact or cylinder_contact, or less force"
        )


def _modulus(face: Surface, body: Surface) -> float:
    """Pa, Hertz's E*."""
    return 1 / sum((1 - one.poisson_ratio**2) / one.youngs_modulus for one in (face, body))


def _gap(face: Surface, body: Surface, gas: Gas | None) -> tuple[float, float]:
    """m between faces that touch without force, the temperature jump with it, and W/(m K) of the gas."""
    pair = joint(face, body, AIR if gas is None else gas)
    mean_gap = float(pair.gas_conductivity) / float(gas_conductance(pair, 0.0))
    return mean_gap, 0.0 if gas is None else gas.conductivity


def _spots(face: Surface, body: Surface, pressure: float, gas: Gas | None) -> float:
    """W/(m2 K) where the faces touch."""
    return float(contact_conductance(joint(face, body, gas, full_contact=True), pressure))
