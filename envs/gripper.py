"""Any gripper in place of the shipped one: read, understood and mounted over the table."""

# mujoco ships no type stubs for its compiled names
# pyright: reportAttributeAccessIssue=false

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, field, fields, replace
from functools import cached_property
from typing import Any

import mujoco
import numpy as np

from thermograsp.errors import GripperError, InvalidValueError, positive

from .gripper_file import Source, compiled
from .gripper_fingers import Hand, Pad, named_pair, pairs
from .gripper_mechanism import Mechanism
from .gripper_mount import DRIVE, joint_name, mounted, palm_height
from .gripper_path import PARALLEL_AT, Closing, close, oppose, promising
from .scene import CLEARANCE, ObjectSpec

_DEGREE = 4  # of a joint's motion as a polynomial of the opening, the most that MuJoCo couples joints by
_FOLLOWED = 5e-4  # m, by which the opening may be off for that
_TRIED = 3  # pairs of fingers, the most promising ones
_WORTH = 0.02  # m of travel that weigh as much as a unit of cost
_SLACK = 0.004  # m beside the object on either side, at which a lone jaw's gripper is centred
_FLAT = 0.2  # rad, by which a pad gives way (fit_fingertip)
_MOST_FORCE = 40.0  # N


@dataclass(frozen=True, slots=True)
class ActuatorMap:
    """A closing actuator along the way. name; unit: m or rad, of its length. wide, narrow: its length at the widest and
    the narrowest opening. per_newton: its force (N or N m) for each newton on the pads. limit: of its force, inf for
    none."""

    name: str
    unit: str
    wide: float
    narrow: float
    per_newton: float
    limit: float


@dataclass(frozen=True, eq=False)
class Gripper:
    """A gripper of somebody's, with our fingertips on. name: of its file. palm, fingers: names of bodies. pads: of the
    geoms that they are mounted on, areas: m2 of these faces, wedges: degrees between face and fingertip. narrowest,
    widest: m, the opening. strongest: N. flat: m, the openings between which the pads lie flat on parallel faces.
    actuators: what closes it. polynomials: of each driven joint over half the opening, rising powers of m. model and
    closing: what all that follows from."""

    name: str
    palm: str
    fingers: tuple[str, str]
    pads: tuple[str, str]
    areas: tuple[float, float]
    wedges: tuple[float, float]
    narrowest: float
    widest: float
    strongest: float
    flat: tuple[float, float]
    actuators: tuple[ActuatorMap, ...]
    polynomials: dict[int, np.ndarray] = field(repr=False)
    model: mujoco.MjModel = field(repr=False)
    palm_body: int = field(repr=False)
    driven: frozenset[int] = field(repr=False)
    closing: Closing = field(repr=False)

    joints = (DRIVE, DRIVE)

    def __getstate__(self) -> dict[str, Any]:
        """All but what is made of it on demand: specs can't be copied that way."""
        return {one.name: getattr(self, one.name) for one in fields(self)}

    def scene(self) -> mujoco.MjSpec:
        """See GripperModel."""
        return self._scene.copy()

    @cached_property
    def _scene(self) -> mujoco.MjSpec:
        return mounted(self)

    @cached_property
    def reach(self) -> float:
        """m, from the grasp centre up to the palm, inf where that is not above it."""
        return palm_height(self)

    def wrist_at(self, item: ObjectSpec) -> np.ndarray:
        """See GripperModel. Raises InvalidValueError for an object that does not fit."""
        room = self.widest - CLEARANCE
        if item.width > room:
            raise InvalidValueError(
                f"object {item.name!r} is {1e3 * item.width:.1f} mm wide along x, {self.name} opens "
                f"{1e3 * self.widest:.1f} mm: make it at most {1e3 * room:.1f} mm or turn it (yaw)"
            )
        height = max(item.grasp_height, item.size[2] + CLEARANCE - self.reach)
        if item.elements and height != item.grasp_height:
            raise InvalidValueError(
                f"object {item.name!r} is {1e3 * item.size[2]:.1f} mm high, {self.name} reaches "
                f"{1e3 * self.reach:.0f} mm down: its pads miss the elements (mode O); make it lower"
            )
        touching, beside = self.centre(item.width), self.centre(item.width + 2 * _SLACK)
        return np.array([-beside[0], -touching[1], height - touching[2]])

    def centre(self, opening: float) -> np.ndarray:
        """(3,) m, the middle between the pads at that opening, from the wrist's frame."""
        way = self.closing
        return np.array([np.interp(opening, way.openings, way.centres[:, i]) for i in range(3)])

    def rest(self, model: mujoco.MjModel, opening: float) -> tuple[np.ndarray, np.ndarray]:
        """See GripperModel."""
        half = np.clip(opening, self.narrowest, self.widest) / 2
        places, values = [model.joint(DRIVE).qposadr[0]], [half]
        for joint, polynomial in self.polynomials.items():
            places.append(model.joint(joint_name(joint)).qposadr[0])
            values.append(np.polynomial.polynomial.polyval(half, polynomial))
        return np.array(places), np.array(values)

    def control(self, opening: float) -> dict[str, float]:
        """Lengths of the closing actuators (m or rad) at an opening (m) of the pads."""
        way = self.closing
        return {
            one.name: float(np.interp(opening, way.openings, way.controls[:, i]))
            for i, one in enumerate(self.actuators)
        }

    def actuator_limits(self, force: float) -> dict[str, float]:
        """N or N m by closing actuator, for `force` N on the pads."""
        return {one.name: force * abs(one.per_newton) for one in self.actuators}

    def document(self) -> dict[str, Any]:
        """The report for machines, SI units and degrees as the names say."""
        return {
            "name": self.name,
            "palm": self.palm,
            "fingers": self.fingers,
            "pads": self.pads,
            "areas_m2": self.areas,
            "wedges_deg": self.wedges,
            "narrowest_m": self.narrowest,
            "widest_m": self.widest,
            "flat_m": self.flat,
            "strongest_N": self.strongest,
            "reach_m": self.reach,
            "actuators": [
                {
                    "name": a.name,
                    "unit": a.unit,
                    "wide": a.wide,
                    "narrow": a.narrow,
                    "per_newton": a.per_newton,
                }
                for a in self.actuators
            ],
        }

    def __str__(self) -> str:
        lines = [
            f"{self.name}: palm {self.palm!r}, fingertips on {self.fingers[0]!r} and {self.fingers[1]!r}"
        ]
        for side, finger, pad, area, wedge in zip(
            ("left", "right"), self.fingers, self.pads, self.areas, self.wedges, strict=True
        ):
            where = "a given place" if pad == "given" else f"{1e6 * area:.0f} mm2 of geom {pad!r}"
            turned = f", turned by {wedge:.0f} degrees" if wedge > 0.5 else ""
            lines.append(f"  {side:5s} {finger}: {where}{turned}")
        lines.append(
            f"  opens {1e3 * self.narrowest:.1f} to {1e3 * self.widest:.1f} mm between the pads, flat on parallel "
            f"faces from {1e3 * self.flat[0]:.0f} to {1e3 * self.flat[1]:.0f} mm; up to {self.strongest:.3g} N; "
            + (f"{1e3 * self.reach:.0f} mm" if np.isfinite(self.reach) else "nothing")
            + " from the grasp up to the palm"
        )
        for one in self.actuators:
            lines.append(
                f"  actuator {one.name}: {one.wide:.4g} {one.unit} wide, {one.narrow:.4g} {one.unit} narrow, "
                f"{abs(one.per_newton):.3g} {'N' if one.unit == 'm' else 'N m'} for each newton"
            )
        return "\n".join(lines)


def load_gripper(
    source: Source | Gripper,
    *,
    fingertips: Sequence[str] | None = None,
    actuators: Sequence[str] | None = None,
    pads: Sequence[Pad | None] = (None, None),
    parallel_at: float = PARALLEL_AT,
) -> Gripper:
    """Reads a gripper and finds out how it closes.

    source: an MJCF file or a mujoco.MjSpec; a whole robot will do. fingertips: the two bodies, or parts of two digits'
    names such as ("thumb", "index"), that carry one; not given, the two that oppose each other best. actuators: those
    that close it; not given, all. pads: where each fingertip goes, see `fit_fingertip`. parallel_at: m, the opening at
    which the fingertips are parallel, where they turn as they close.
    Raises GripperError for what cannot grasp, and UnknownNameError for a name that is none.
    """
    if isinstance(source, Gripper):
        return source
    positive("parallel_at (m)", parallel_at)
    if len(pads) != 2:
        raise InvalidValueError(f"pads {pads!r}: give two, None for one that is to be found")
    name, model = compiled(source)
    mechanism = Mechanism(model, actuators)
    hand = Hand(mechanism)
    chosen = [named_pair(hand, fingertips, pads)] if fingertips is not None else pairs(hand, pads)
    best = promising(hand, chosen, parallel_at)[:_TRIED]
    options = sorted((oppose(hand, pair, parallel_at) for pair in best), key=lambda one: one.cost)
    ways, refused = [], []
    for option in options:
        try:
            way, polynomials = _smooth(hand, close(hand, option))
            ways.append((option.cost - float(np.ptp(way.openings)) / _WORTH, way, polynomials))
        except GripperError as error:
            refused.append(error)
    if not ways:
        raise refused[0]
    _, way, polynomials = min(ways, key=lambda one: one[0])
    return _told(name, hand, way, polynomials)


def _smooth(hand: Hand, way: Closing) -> tuple[Closing, dict[int, np.ndarray]]:
    """Each driven joint as a polynomial of half the opening, over as much of the way as these are exact for."""
    mechanism, model, joints = hand.mechanism, hand.model, hand.joints()
    first, last = 0, len(way.openings)
    while last - first >= _DEGREE + 1:
        half, postures = way.openings[first:last] / 2, way.qpos[first:last]
        fits = {
            joint: np.polynomial.Polynomial.fit(half, postures[:, model.jnt_qposadr[joint]], _DEGREE)
            .convert()
            .coef
            for joint in joints
        }
        fits = {joint: np.pad(coef, (0, _DEGREE + 1 - len(coef))) for joint, coef in fits.items()}
        off = []
        for opening, qpos in zip(way.openings[first:last], postures, strict=True):
            posture = qpos.copy()
            for joint, coef in fits.items():
                posture[model.jnt_qposadr[joint]] = np.polynomial.polynomial.polyval(opening / 2, coef)
            mechanism.show(posture)
            spots = []
            for tip in way.tips:
                origin, axes = mechanism.place(tip.body)
                spots.append(origin + axes @ tip.front)
            off.append(abs(float((spots[1] - spots[0]) @ way.axes[:, 0]) - opening))
        if max(off) < _FOLLOWED:
            part = {
                name: getattr(way, name)[first:last]
                for name in ("openings", "qpos", "controls", "centres", "tilt")
            }
            return replace(way, **part), fits
        if way.openings[last - 1] - way.parallel > way.parallel - way.openings[first]:
            last -= 1
        else:
            first += 1
    raise GripperError(
        "the joints do not follow the opening smoothly: name the closing actuators, or other fingertips"
    )


def _told(name: str, hand: Hand, way: Closing, polynomials: dict[int, np.ndarray]) -> Gripper:
    mechanism, model = hand.mechanism, hand.model
    used = sorted({number for finger in way.fingers for number in finger.moves})
    at = int(np.argmin(np.abs(way.openings - way.parallel)))
    maps = []
    for number in used:
        coordinate = mechanism.coordinates[number]
        rate = _rate(mechanism, way, way.controls[at], number)
        wide, narrow = float(way.controls[-1, number]), float(way.controls[0, number])
        maps.append(
            ActuatorMap(
                coordinate.name, coordinate.unit, wide, narrow, rate, _limit(model, coordinate.number)
            )
        )
    strongest = min([_MOST_FORCE, *(m.limit / abs(m.per_newton) for m in maps if abs(m.per_newton) > 1e-4)])
    flat = way.openings[way.tilt < _FLAT]
    left, right = way.fingers
    return Gripper(
        name,
        model.body(hand.palm).name,
        (left.name, right.name),
        (left.face.geom, right.face.geom),
        (left.face.area, right.face.area),
        (math.degrees(way.wedges[0]), math.degrees(way.wedges[1])),
        float(way.openings[0]),
        float(way.openings[-1]),
        strongest,
        (float(flat.min()), float(flat.max())),
        tuple(maps),
        polynomials,
        model,
        hand.palm,
        frozenset(hand.moving),
        way,
    )


def _rate(mechanism: Mechanism, way: Closing, values: np.ndarray, number: int) -> float:
    """m of opening per unit of a coordinate, the others still: by virtual work its force for each newton."""
    coordinate = mechanism.coordinates[number]
    step = 1e-4 * (coordinate.high - coordinate.low)
    ends = []
    for sign in (-1, 1):
        moved = values.copy()
        moved[number] += sign * step
        mechanism.pose(moved)
        spots = [
            origin + axes @ tip.front for tip in way.tips for origin, axes in [mechanism.place(tip.body)]
        ]
        ends.append(float((spots[1] - spots[0]) @ way.axes[:, 0]))
    return (ends[1] - ends[0]) / (2 * step)


def _limit(model: mujoco.MjModel, actuator: int) -> float:
    """N or N m that the actuator exerts at most."""
    limits = [np.inf]
    if model.actuator_forcelimited[actuator]:
        limits.append(float(np.abs(model.actuator_forcerange[actuator]).max()))
    direct = model.actuator_biastype[actuator] == mujoco.mjtBias.mjBIAS_NONE
    if direct and model.actuator_ctrllimited[actuator]:
        gain = abs(float(model.actuator_gainprm[actuator, 0]))
        limits.append(gain * float(np.abs(model.actuator_ctrlrange[actuator]).max()))
    return min(limits)
