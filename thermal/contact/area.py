"""Contact area of a fingertip and its share of the force, from normal force and geometry.

The pad is square and takes the force; the sensor's square face in its middle takes what presses on it. Flat on flat the
contact is the overlap, evenly pressed. A curved body sinks into the pad, an elastic (Winkler) foundation: pressure
is foundation modulus times local indentation over the pad's thickness (Johnson, Contact Mechanics, section 4.3), so

    sphere, radius R:   p = K (a^2 - r^2)/(2 R d),  F = pi K a^4/(4 R d)        while the contact radius a fits the pad
    cylinder, length l: p = K (a^2 - x^2)/(2 R d),  F = 2 K l a^3/(3 R d)       while the half width a fits the pad

with K the foundation modulus and d the pad's thickness; beyond that the contact is cut off at the pad's edges and the
same pressure is integrated over what is left. All functions work elementwise on arrays of any shape.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from thermograsp.errors import InvalidValueError, positive

_NEWTON_STEPS = 8  # the residual is convex and the start close: round-off after 5


@dataclass(frozen=True, slots=True)
class Pad:
    """A square silicone pad on a rigid back, a square sensor face in its middle.

    width: m, the pad's side. face: m, the sensor face's side. thickness: m (an estimate: as thick as the element it
    holds). youngs_modulus: Pa; 1.14 MPa is a Shore A hardness of 30 by Gent's relation (1958, Rubber Chem. Technol.
    31:896). compression_factor: of Gent & Lindley, 0.93 at that hardness (Lindley 1974, Engineering design with
    natural rubber).
    """

    width: float = 0.020
    face: float = 0.009
    thickness: float = 0.003
    youngs_modulus: float = 1.14e6
    compression_factor: float = 0.93

    def __post_init__(self) -> None:
        for name in ("width", "face", "thickness", "youngs_modulus", "compression_factor"):
            positive(f"pad: {name}", getattr(self, name))
        if self.face > self.width:
            raise InvalidValueError(f"pad: face {self.face:g} m is wider than the pad, {self.width:g} m")

    @property
    def foundation_modulus(self) -> float:
        """Pa, pressure per compressive strain: E (1 + 2 k S^2), S = width/(4 thickness) the shape factor.

        Rubber is incompressible and bulges only at the pad's free sides (Gent & Lindley 1959, Proc. Inst. Mech. Eng.
        173:111). For contacts much smaller than the pad this is an upper bound.
        """
        shape = self.width / (4 * self.thickness)
        return self.youngs_modulus * (1 + 2 * self.compression_factor * shape**2)


@dataclass(frozen=True, slots=True)
class ContactArea:
    """pad, face: m2 in contact on the whole pad (face included) and on the sensor's face. face_force: N on the face.
    Arrays of the force's shape."""

    pad: np.ndarray
    face: np.ndarray
    face_force: np.ndarray

    @property
    def face_pressure(self) -> np.ndarray:
        """Pa, mean over the contact on the face; 0 where nothing touches."""
        return np.divide(self.face_force, self.face, out=np.zeros_like(self.face), where=self.face > 0)


def flat_contact(
    pad: Pad,
    force: np.ndarray | float,
    size: tuple[float, float] = (np.inf, np.inf),
    offset: tuple[np.ndarray | float, np.ndarray | float] = (0.0, 0.0),
) -> ContactArea:
    """Flat on flat, sides parallel: the overlap at any force above 0.

    force: N, >= 0. size: m, the object's face. offset: m, its middle from the pad's along both sides (arrays as force).
    Raises InvalidValueError for a force or size that is none.
    """
    force = _force(force)
    for side in size:
        if not side > 0:
            raise InvalidValueError(f"size must be above 0 m, got {size!r}")
    on_pad = _overlap(pad.width, size[0], offset[0]) * _overlap(pad.width, size[1], offset[1])
    on_face = _overlap(pad.face, size[0], offset[0]) * _overlap(pad.face, size[1], offset[1])
    touching = (force > 0) & (on_pad > 0)
    share = np.divide(on_face, on_pad, out=np.zeros(np.broadcast(on_face, on_pad).shape), where=on_pad > 0)
    return ContactArea(
        pad=np.where(touching, on_pad, 0.0),
        face=np.where(touching, on_face, 0.0),
        face_force=np.where(touching, force * share, 0.0),
    )


def _overlap(width: float, size: float, offset: np.ndarray | float) -> np.ndarray:
    """m, length common to two centred intervals, the second shifted."""
    offset = np.asarray(offset, dtype=float)
    return np.maximum(
        np.minimum(width / 2, offset + size / 2) - np.maximum(-width / 2, offset - size / 2), 0.0
    )


def sphere_contact(pad: Pad, force: np.ndarray | float, radius: float) -> ContactArea:
    """A sphere, or a body of that mean radius of curvature (m), on the middle of the pad. force: N, >= 0.

    Raises InvalidValueError for a force or radius that is none.
    """
    force = _force(force)
    stiffness = pad.foundation_modulus / (2 * positive("radius (m)", radius) * pad.thickness)  # Pa/m2
    half = pad.width / 2
    u = _square_inverse(force / (stiffness * half**4))  # (a / half)^2
    square = u * half**2
    half_face = pad.face / 2
    return ContactArea(
        pad=half**2 * _square_area(u),
        face=half_face**2 * _square_area(square / half_face**2),
        face_force=stiffness * half_face**4 * _square_load(square / half_face**2),
    )


def cylinder_contact(
    pad: Pad, force: np.ndarray | float, radius: float, length: float = np.inf
) -> ContactArea:
    """A cylinder of that radius and length (m) along one side of the pad, over its middle. force: N, >= 0.

    Raises InvalidValueError for a force, radius or length that is none.
    """
    force = _force(force)
    if not length > 0:
        raise InvalidValueError(f"length must be above 0 m, got {length!r}")
    stiffness = pad.foundation_modulus / (2 * positive("radius (m)", radius) * pad.thickness)
    half, half_face = pad.width / 2, pad.face / 2
    on_pad, on_face = min(length, pad.width), min(length, pad.face)
    load = force / (stiffness * on_pad)  # m3, the integral of a^2 - x^2
    narrow = np.cbrt(0.75 * load)
    half_width_squared = np.where(narrow <= half, narrow**2, (load / half + 2 / 3 * half**2) / 2)
    across = np.minimum(np.sqrt(half_width_squared), half_face)
    return ContactArea(
        pad=on_pad * 2 * np.minimum(np.sqrt(half_width_squared), half),
        face=on_face * 2 * across,
        face_force=stiffness * on_face * 2 * (half_width_squared - across**2 / 3) * across,
    )


def _force(force: np.ndarray | float) -> np.ndarray:
    force = np.ascontiguousarray(force, dtype=float).reshape(np.shape(force))
    if not (np.isfinite(force) & (force >= 0)).all():
        raise InvalidValueError(f"force must be finite and >= 0 N, got {force.min():g} to {force.max():g}")
    return force


def _square_area(u: np.ndarray) -> np.ndarray:
    """Area common to a disc of radius sqrt(u) and the square of half width 1."""
    v = np.clip(u, 1.0, 2.0)
    cut = np.pi * v - 4 * (v * np.arccos(1 / np.sqrt(v)) - np.sqrt(v - 1))
    return np.where(u <= 1, np.pi * u, np.where(u >= 2, 4.0, cut))


def _square_load(u: np.ndarray) -> np.ndarray:
    """Integral of u - r^2 over that common area; its derivative by u is _square_area."""
    v = np.clip(u, 1.0, 2.0)
    root = np.sqrt(v - 1)
    cut = np.pi / 2 * v**2 - 2 * v**2 * np.arccos(1 / np.sqrt(v)) + 2 * root * v + 4 / 3 * root**3
    return np.where(u <= 1, np.pi / 2 * u**2, np.where(u >= 2, 4 * u - 8 / 3, cut))


def _square_inverse(load: np.ndarray) -> np.ndarray:
    """u at which _square_load(u) is the load."""
    u = np.maximum(np.sqrt(2 * load / np.pi), (load + 8 / 3) / 4)
    for _ in range(_NEWTON_STEPS):
        area = _square_area(u)
        u = u - np.divide(_square_load(u) - load, area, out=np.zeros_like(u), where=area > 0)
    return np.where(load <= np.pi / 2, np.sqrt(2 * load / np.pi), u)
