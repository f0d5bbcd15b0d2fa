"""Reads a gripper and finds out how it closes: fingers, pads, the way, and what its actuators have to do."""

# mujoco ships no type stubs for its compiled names
# pyright: reportAttributeAccessIssue=false

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import replace

import mujoco
import numpy as np

from thermograsp.errors import GripperError, InvalidValueError, length

from ..limits import MAX_FORCE
from .file import Source, compiled
from .fingers import Pad, named_pair, of_one_hand, pairs
from .found import ActuatorMap
from .hand import Hand
from .mechanism import Mechanism
from .mounted import Gripper
from .opposition import oppose, promising
from .path import PARALLEL_AT, Closing, close

_DEGREE = 4  # of a joint's motion as a polynomial of the opening, the most that MuJoCo couples joints by
_FOLLOWED = 5e-4  # m, by which the opening may be off for that
_TRIED = 3  # pairs of fingers, the most promising ones
_WORTH = 0.02  # m of travel that weigh as much as a unit of cost
_FLAT = 0.2  # rad, by which a pad gives way (fit_fingertip)


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
    length("parallel_at (m)", parallel_at)
    if len(pads) != 2:
        raise InvalidValueError(f"pads {pads!r}: give two, None for one that is to be found")
    name, model = compiled(source)
    mechanism = Mechanism(model, actuators)
    hand = Hand(mechanism)
    chosen = [named_pair(hand, fingertips, pads)] if fingertips is not None else pairs(hand, pads)
    chosen = of_one_hand(hand, chosen)
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
    return _described(name, hand, way, polynomials)


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


def _described(name: str, hand: Hand, way: Closing, polynomials: dict[int, np.ndarray]) -> Gripper:
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
    strongest = min([MAX_FORCE, *(m.limit / abs(m.per_newton) for m in maps if abs(m.per_newton) > 1e-4)])
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
