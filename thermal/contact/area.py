"""Contact area of a fingertip and its share of the force, from normal force and geometry.

The pad is square and takes the force; the sensor's square face in its middle takes what presses on it. Flat on flat the
contact is the overlap, evenly pressed. A curved body sinks into the pad, an elastic (Winkler) foundation: pressure
is foundation modulus times local indentation over the pad's thickness (Johnson, Contact Mechanics, section 4.3), so

    sphere, radius R:   p = K (a^2 - r^2)/(2 R d),  F = pi K a^4/(4 R d)        while the contact radius a fits the pad
    cylinder, length l: p = K (a^2 - x^2)/(2 R d),  F = 2 K l a^3/(3 R d)       while the half width a fits the pad

with K the foundation modulus and d the pad's thickness; beyond that, and where the body isn't over the pad's middle,
the contact is cut off at the pad's edges and the same pressure is integrated over what is left (round_bodies.py). The
springs on the sensor's face may be stiffer than those around it. All functions work elementwise on arrays of any shape.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from thermograsp.errors import InvalidValueError, positive

from .round_bodies import ball_on_pad, cylinder_on_pad


@dataclass(frozen=True, slots=True)
class Pad:
    """A square silicone pad on a rigid back, a square sensor face in its middle.

    width: m, the pad's side. face: m, the sensor face's side. thickness: m (an estimate: as thick as the element it
    holds). youngs_modulus: Pa; 1.14 MPa is a Shore A hardness of 30 by Gent's relation (1958, Rubber Chem. Technol.
    31:896). compression_factor: of Gent & Lindley, 0.93 at that hardness (Lindley 1974, Engineering design with
    natural rubber). face_stiffness: Pa/m of the springs on the sensor's face, None for those of the pad around it.
    sensor: m, the side of the sensor's whole face where a narrow pad bears only a part in its middle; None for all of
    it.
    """

    width: float = 0.020
    face: float = 0.009
    thickness: float = 0.003
    youngs_modulus: float = 1.14e6
    compression_factor: float = 0.93
    face_stiffness: float | None = None
    sensor: float | None = None

    def __post_init__(self) -> None:
        for name in ("width", "face", "thickness", "youngs_modulus", "compression_factor"):
            positive(f"pad: {name}", getattr(self, name))
        if self.face_stiffness is not None:
            positive("pad: face_stiffness (Pa/m)", self.face_stiffness)
        if self.face > self.width:
            raise InvalidValueError(f"pad: face {self.face:g} m is wider than the pad, {self.width:g} m")
        if self.sensor is not None and not self.sensor >= self.face:
            raise InvalidValueError(
                f"pad: sensor {self.sensor:g} m is narrower than what touches of it, {self.face:g} m"
            )

    @property
    def sensor_width(self) -> float:
        """m, the side of the sensor's face, all over which heat spreads on from what the pad bears of it."""
        return self.face if self.sensor is None else self.sensor

    @property
    def foundation_modulus(self) -> float:
        """Pa, pressure per compressive strain: E (1 + 2 k S^2), S = width/(4 thickness) the shape factor.

        Rubber is incompressible and bulges only at the pad's free sides (Gent & Lindley 1959, Proc. Inst. Mech. Eng.
        173:111). For contacts much smaller than the pad this is an upper bound.
        """
        shape = self.width / (4 * self.thickness)
        return self.youngs_modulus * (1 + 2 * self.compression_factor * shape**2)

    @property
    def face_ratio(self) -> float:
        """Stiffness of the springs on the sensor's face over that of those around it."""
        if self.face_stiffness is None:
            return 1.0
        return self.face_stiffness * self.thickness / self.foundation_modulus


@dataclass(frozen=True, slots=True)
class ContactArea:
    """The area of a contact and the force on the sensor's face. pad, face: m2 in contact on the whole pad (face
    included) and on the sensor's face. face_force: N on the face. Arrays of the force's shape."""

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
    ratio = pad.face_ratio
    bearing = on_pad + (ratio - 1) * on_face
    share = np.divide(ratio * on_face, bearing, out=np.zeros(np.shape(bearing)), where=on_pad > 0)
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


def sphere_contact(
    pad: Pad,
    force: np.ndarray | float,
    radius: float,
    offset: tuple[np.ndarray | float, np.ndarray | float] = (0.0, 0.0),
) -> ContactArea:
    """A sphere, or a body of that mean radius of curvature (m). force: N, >= 0. offset: m, its crown from the pad's
    middle along both sides (arrays as force).

    Raises InvalidValueError for a force or radius that is none.
    """
    force = _force(force)
    stiffness = pad.foundation_modulus / (2 * positive("radius (m)", radius) * pad.thickness)  # Pa/m2
    y, z = offset
    halves = pad.width / 2, pad.face / 2
    return _solved(ball_on_pad, stiffness, force / stiffness, pad.face_ratio, *halves, y, z)


def cylinder_contact(
    pad: Pad,
    force: np.ndarray | float,
    radius: float,
    length: float = np.inf,
    offset: tuple[np.ndarray | float, np.ndarray | float] = (0.0, 0.0),
) -> ContactArea:
    """A cylinder of that radius and length (m) along one side of the pad. force: N, >= 0. offset: m, its middle from
    the pad's along that side and across it (arrays as force).

    Raises InvalidValueError for a force, radius or length that is none.
    """
    force = _force(force)
    if not length > 0:
        raise InvalidValueError(f"length must be above 0 m, got {length!r}")
    stiffness = pad.foundation_modulus / (2 * positive("radius (m)", radius) * pad.thickness)
    along = tuple(_overlap(width, length, offset[0]) for width in (pad.width, pad.face))
    halves = pad.width / 2, pad.face / 2
    return _solved(cylinder_on_pad, stiffness, force / stiffness, pad.face_ratio, *halves, *along, offset[1])


def _solved(
    body: Callable[..., tuple[float, float, float, float]], stiffness: float, *numbers: object
) -> ContactArea:
    """Element by element: rows never mix."""
    every = np.broadcast_arrays(*(np.asarray(number, dtype=float) for number in numbers))
    found = [body(*row) for row in zip(*(each.ravel().tolist() for each in every), strict=True)]
    on_pad, on_face, load, _ = np.array(found, dtype=float).reshape(-1, 4).T.reshape(4, *every[0].shape)
    return ContactArea(on_pad, on_face, stiffness * load)


def _force(force: np.ndarray | float) -> np.ndarray:
    force = np.ascontiguousarray(force, dtype=float).reshape(np.shape(force))
    if not (np.isfinite(force) & (force >= 0)).all():
        raise InvalidValueError(f"force must be finite and >= 0 N, got {force.min():g} to {force.max():g}")
    return force
