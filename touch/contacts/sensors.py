"""Contact sensors for engines that record no contacts: mujoco.batch and mujoco.rollout keep sensordata and no more.

`prepare` adds to a model's spec one net-force sensor a pair of a fingertip's geom and an object's geom, and the poses
of their bodies; `ThermalTouch(model, worlds=n).update(record)` reads them.

W: worlds, N: what a pad may meet (contacts.py).
"""

# mujoco ships no type stubs for its compiled names
# pyright: reportAttributeAccessIssue=false

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import NamedTuple

import mujoco
import numpy as np

from thermograsp.errors import InvalidValueError, MissingDependencyError

from ..scene import BodyShape, Fingertip, Objects, PadPlace, bodies, pads, rotation

_SENSOR = getattr(mujoco.mjtSensor, "mjSENS_CONTACT", None)  # from MuJoCo 3.3.5 on
_CONTACT = (19, 3, 1)  # found, force and pos; their net force; one slot
FORCE_AT, PLACE_AT = 1, 4
"""Of a contact sensor's numbers, where the force N on the object and its place m begin, in the world's frame."""
NAME = "thermograsp:touch:"
"""Of the sensors and of geoms that had no name."""


class SensorPlaces(NamedTuple):
    """Where sensordata holds what a touch needs. pairs: (P, 3) fingertip, number among what it may meet, address of
    the contact sensor. poses: (B, 3) body, addresses of position and quaternion. geoms: (G, 2) geom and body, of the
    objects; turns (G, 9) and offsets (G, 3) m: theirs in the body's frame. bodies: of the model, how many; size: of
    sensordata."""

    pairs: np.ndarray
    poses: np.ndarray
    geoms: np.ndarray
    turns: np.ndarray
    offsets: np.ndarray
    bodies: int
    size: int


def prepare(
    spec: mujoco.MjSpec,
    fingertips: Mapping[str, str | Fingertip],
    objects: Objects | None = None,
) -> mujoco.MjModel:
    """Adds to the spec the contact sensors that ThermalTouch.update reads from recorded sensordata, and returns the
    compiled model. Nothing else changes, but geoms without a name get one. Raises what ThermalTouch does, and
    MissingDependencyError below MuJoCo 3.3.5."""
    if _SENSOR is None:
        raise MissingDependencyError(
            f"contact sensors need MuJoCo 3.3.5 or newer, this is {mujoco.__version__}: pip install 'mujoco>=3.3.5', "
            "or give ThermalTouch.update an MjData"
        )
    if not isinstance(spec, mujoco.MjSpec):
        raise InvalidValueError(f"prepare takes a mujoco.MjSpec, got {type(spec).__name__}")
    if any(sensor.name.startswith(NAME) for sensor in spec.sensors):
        raise InvalidValueError(
            "this spec has its contact sensors already: begin with a new one, or prepare a copy"
        )
    model = spec.compile()
    shapes = bodies(model, objects, 24.0)
    found = pads(model, fingertips, shapes)
    named = {geom.id: geom for geom in spec.geoms}
    for pair in _pairs(found, shapes):
        names = []
        for number in pair:
            geom = named[number]
            if not geom.name:
                geom.name = f"{NAME}{number}"
            names.append(geom.name)
        sensor = spec.add_sensor(
            type=_SENSOR,
            objtype=mujoco.mjtObj.mjOBJ_GEOM,
            objname=names[0],
            reftype=mujoco.mjtObj.mjOBJ_GEOM,
            refname=names[1],
        )
        sensor.name, sensor.intprm[:3] = f"{NAME}{pair[0]}:{pair[1]}", _CONTACT
    owners = {body.id: body for body in spec.bodies}
    for number in _owners(found, shapes):
        body = owners[number]
        if not body.name:
            body.name = f"{NAME}{number}"
        for kind in ("FRAMEPOS", "FRAMEQUAT"):
            spec.add_sensor(
                name=f"{NAME}{kind.lower()}:{number}",
                type=getattr(mujoco.mjtSensor, f"mjSENS_{kind}"),
                objtype=mujoco.mjtObj.mjOBJ_XBODY,
                objname=body.name,
            )
    return spec.compile()


def require_sensors(model: mujoco.MjModel) -> None:
    """Raises InvalidValueError for a model whose sensors are switched off: their numbers stay 0."""
    if model.opt.disableflags & mujoco.mjtDisableBit.mjDSBL_SENSOR:
        raise InvalidValueError(
            "the model disables its sensors, and heat is read from them: take the flag sensor out of <option>, or "
            "update a ThermalTouch of one world after every step"
        )


def sensor_places(
    model: mujoco.MjModel, found: Sequence[PadPlace], shapes: Sequence[BodyShape]
) -> SensorPlaces:
    """Of a model that `prepare` has made. Raises InvalidValueError where a sensor is missing or all are off."""
    require_sensors(model)
    contacts, poses = {}, {}
    kinds, objects = mujoco.mjtSensor, mujoco.mjtObj
    for n in range(model.nsensor):
        kind, address = int(model.sensor_type[n]), int(model.sensor_adr[n])
        about, other = int(model.sensor_objid[n]), int(model.sensor_refid[n])
        if kind == _SENSOR:
            geoms = (
                model.sensor_objtype[n] == objects.mjOBJ_GEOM
                and model.sensor_reftype[n] == objects.mjOBJ_GEOM
            )
            if geoms and tuple(model.sensor_intprm[n, :3]) == _CONTACT:
                contacts[about, other] = address
        elif kind in (kinds.mjSENS_FRAMEPOS, kinds.mjSENS_FRAMEQUAT):
            if model.sensor_objtype[n] == objects.mjOBJ_XBODY and other < 0:
                poses[about, kind] = address
    wanted = list(_pairs(found, shapes))
    owners = _owners(found, shapes)
    missing = [pair for pair in wanted if pair not in contacts]
    missing += [body for body in owners if (body, int(kinds.mjSENS_FRAMEQUAT)) not in poses]
    if missing:
        raise InvalidValueError(
            "this model has no contact sensors for its fingertips and objects, which a record of sensordata needs: "
            "make it by thermograsp.touch.prepare(spec, fingertips, objects)"
        )
    tip_of = {geom: f for f, pad in enumerate(found) for geom in pad.geoms}
    of_objects = [geom for shape in shapes for geom in shape.geoms]
    number_of = {geom: number for number, geom in enumerate(of_objects)}
    number_of |= {piece: number_of[shape.geoms[0]] for shape in shapes for piece in shape.pieces}
    number_of |= {geom: len(of_objects) + f for geom, f in tip_of.items()}
    rows = [(tip_of[a], number_of[b], contacts[a, b]) for a, b in wanted]
    return SensorPlaces(
        np.array(rows, np.int64),
        np.array(
            [
                (b, poses[b, int(kinds.mjSENS_FRAMEPOS)], poses[b, int(kinds.mjSENS_FRAMEQUAT)])
                for b in owners
            ],
            np.int64,
        ),
        np.array([(geom, model.geom_bodyid[geom]) for geom in of_objects], np.int64),
        np.array([rotation(model.geom_quat[geom]).ravel() for geom in of_objects]),
        np.array([model.geom_pos[geom] for geom in of_objects], float),
        int(model.nbody),
        int(model.nsensordata),
    )


def _pairs(found: Sequence[PadPlace], shapes: Sequence[BodyShape]) -> list[tuple[int, int]]:
    """Geoms that may meet: of a fingertip and of an object, or of two fingertips."""
    of_objects = [geom for shape in shapes for geom in shape.touched]
    pairs = [(pad_geom, geom) for pad in found for pad_geom in pad.geoms for geom in of_objects]
    for f, pad in enumerate(found):
        pairs += [
            (pad_geom, geom) for other in found[f + 1 :] for pad_geom in pad.geoms for geom in other.geoms
        ]
    return pairs


def _owners(found: Sequence[PadPlace], shapes: Sequence[BodyShape]) -> list[int]:
    return sorted({pad.body for pad in found} | {shape.body for shape in shapes})
