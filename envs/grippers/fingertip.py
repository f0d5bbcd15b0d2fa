"""A fingertip on any body: a copy of the shipped gripper's (assets/gripper.xml): pad, sensor, thermostat, compliance.

The fingertip's frame has its origin on the face that it is mounted on, x out of the pad, y across, z towards the wrist.
"""

# mujoco ships no type stubs for its compiled names
# pyright: reportAttributeAccessIssue=false

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cache

import mujoco
import numpy as np

from thermograsp.errors import GripperError, unknown_name

from ...assets import asset
from ...touch import Face
from .file import compiled
from .fingers import (
    SMALLEST_FACE,
    Pad,
    chosen_face,
    finger_of,
)
from .hand import Hand, parts_of
from .mechanism import Mechanism

_OF_JOINTS = ("type", "axis", "stiffness", "damping", "springref", "frictionloss", "armature")
_OF_GEOMS = ("type", "size", "pos", "contype", "conaffinity", "condim", "group")
_SHIPPED = "left"  # the fingertip of assets/gripper.xml that all others are copies of


@dataclass(frozen=True, slots=True)
class FingertipReport:
    """What was found and added. body: the body that carries the fingertip. geom: the geom that has the face, or
    "given". area: m2 of the flat face. place (3,) m and normal (3,): of the face's middle, in the body's frame. added:
    names of the elements that were added to the spec."""

    body: str
    geom: str
    area: float
    place: tuple[float, float, float]
    normal: tuple[float, float, float]
    added: tuple[str, ...]

    def __str__(self) -> str:
        place, normal = (", ".join(f"{v:.4g}" for v in row) for row in (self.place, self.normal))
        size = "a given place" if self.geom == "given" else f"{1e6 * self.area:.0f} mm2 of geom {self.geom!r}"
        return (
            f"fingertip on {self.body!r}: {size}, middle ({place}) m, looking along ({normal})\n"
            f"added: {', '.join(self.added)}"
        )


def fit_fingertip(
    spec: mujoco.MjSpec,
    body: str,
    *,
    name: str | None = None,
    pad: Pad | None = None,
    towards: str | Sequence[float] | None = None,
    up: Sequence[float] | None = None,
    compliant: bool = True,
) -> FingertipReport:
    """Mounts a fingertip on a body of a spec, which is changed.

    name: of the fingertip, the body's where not given. pad: where it goes: a geom's name, or a position (m) and normal
    in the body's frame; not given, the largest flat face that looks along the closing direction. towards: the body that
    this one closes on, or the closing direction in this body's frame; not given, from the actuators: towards the other
    fingers. up: z of the fingertip, in the body's frame; not given, from the face back to the body's origin.
    compliant: two hinges let the pad lie flat on what is turned by a few degrees.

    Added: the body `tip_NAME` with its hinges, geoms `pad_NAME` (which collides), `sensor_NAME` and `thermostat_NAME`,
    a site `pad_NAME` in the middle of the pad's face, and a contact sensor `contact_NAME`: number of contacts, net
    force N and its centre m, world frame, of the pad on whatever it touches.

    Raises UnknownNameError (body, geom, towards) and GripperError for a spec that does not compile or has no actuators
    where they are needed, for a body without a flat face that way, and for a name that is taken.
    """
    model = compiled(spec)[1]
    bodies = {model.body(b).name: b for b in range(model.nbody)}
    if body not in bodies:
        raise unknown_name("body", body, [known for known in bodies if known])
    face = _face(model, bodies, body, pad, towards)
    tip = name or body
    taken = [one for one in _names(tip) if _has(spec, one)]
    if taken:
        raise GripperError(
            f"name={tip!r}: the spec has {', '.join(map(repr, taken))} already; give another name"
        )
    axes = frame(face.normal, -face.centre if up is None else np.asarray(up, float))
    added = add_fingertip(spec.body(body), tip, face.centre, axes, compliant=compliant)
    _add_touch(spec, tip)
    place, normal = (tuple(float(v) for v in row) for row in (face.centre, face.normal))
    return FingertipReport(body, face.geom, face.area, place, normal, (*added, f"contact_{tip}"))  # pyright: ignore


def _face(
    model: mujoco.MjModel,
    bodies: dict[str, int],
    body: str,
    pad: Pad | None,
    towards: str | Sequence[float] | None,
) -> Face:
    number = bodies[body]
    if towards is not None and not isinstance(towards, str):
        way = np.asarray(towards, float)
        if way.shape != (3,) or not np.isfinite(way).all() or not np.linalg.norm(way) > 0:
            raise GripperError(f"towards {towards!r}: give a body's name, or a direction (x, y, z)")
        parts = parts_of(model, [number], number)
        face = chosen_face(parts, pad, way / np.linalg.norm(way), body)
    elif pad is not None and not isinstance(pad, str):
        face = chosen_face([], pad, np.zeros(3), body)
    else:
        hand = Hand(Mechanism(model))
        if towards is not None and towards not in bodies:
            raise unknown_name("body", towards, [known for known in bodies if known])
        others = [bodies[towards]] if towards is not None else hand.others(number)
        found = [finger for other in others if (finger := finger_of(hand, number, other, pad)) is not None]
        face = max(found, key=lambda finger: finger.approach).face if found else None
    if face is None or face.area < SMALLEST_FACE:
        raise GripperError(
            f"body {body!r} has no flat face of {1e6 * SMALLEST_FACE:g} mm2 towards the closing direction: say where "
            "the pad is (pad=(position, normal) in its frame, m)"
        )
    return face


def _names(tip: str) -> tuple[str, ...]:
    """Of what a fingertip of that name adds."""
    kinds = ("tip_{}", "tip_{}_pitch", "tip_{}_yaw", "pad_{}", "thermostat_{}", "sensor_{}", "contact_{}")
    return tuple(kind.format(tip) for kind in kinds)


def _has(spec: mujoco.MjSpec, name: str) -> bool:
    lists = (spec.bodies, spec.joints, spec.geoms, spec.sites, spec.sensors)
    return any(one.name == name for kind in lists for one in kind)


def frame(normal: np.ndarray, up: np.ndarray) -> np.ndarray:
    """(3, 3), columns x along the normal, y, and z as near to `up` as can be."""
    z = up - (up @ normal) * normal
    if np.linalg.norm(z) < 1e-6 * max(float(np.linalg.norm(up)), 1e-6):
        z = np.eye(3)[int(np.argmin(np.abs(normal)))]
        z = z - (z @ normal) * normal
    z = z / np.linalg.norm(z)
    return np.stack([normal, np.cross(z, normal), z], axis=1)


def add_fingertip(
    parent: mujoco.MjsBody, name: str, origin: np.ndarray, axes: np.ndarray, *, compliant: bool = True
) -> tuple[str, ...]:
    """Adds the fingertip's body to another, with its frame there: origin (3,) m, axes (3, 3). Returns its names."""
    quat = np.zeros(4)
    mujoco.mju_mat2Quat(quat, np.ascontiguousarray(axes).ravel())
    shipped = _shipped().body(f"tip_{_SHIPPED}")
    tip = parent.add_body(
        name=_renamed(shipped, name),
        pos=origin,
        quat=quat,
        gravcomp=shipped.gravcomp,
        mass=shipped.mass,
        inertia=shipped.inertia,
        explicitinertial=True,
    )
    added = [tip.name]
    # What default classes of the parent's file might say otherwise is said here.
    for joint in shipped.joints if compliant else ():
        tip.add_joint(
            name=_renamed(joint, name),
            limited=mujoco.mjtLimited.mjLIMITED_TRUE,
            range=np.degrees(joint.range) if parent.compiler.degree else joint.range,
            **{what: getattr(joint, what) for what in _OF_JOINTS},
        )
        added.append(_renamed(joint, name))
    for geom in shipped.geoms:
        colour = geom.rgba if geom.contype == 0 else _shipped().material(geom.material).rgba
        tip.add_geom(
            name=_renamed(geom, name),
            rgba=colour,
            material="",
            **{what: getattr(geom, what) for what in _OF_GEOMS},
        )
        added.append(_renamed(geom, name))
    for site in shipped.sites:
        tip.add_site(name=_renamed(site, name), pos=site.pos, size=site.size, group=site.group)
    return tuple(added)


def thickness() -> float:
    """m, from the face that a fingertip is mounted on to its pad's front."""
    return float(_shipped().site(f"pad_{_SHIPPED}").pos[0])


@cache
def _shipped() -> mujoco.MjSpec:
    """The scene with the shipped gripper, which is only read."""
    return mujoco.MjSpec.from_file(str(asset("gripper.xml")))


def _renamed(part: mujoco.MjsBody | mujoco.MjsJoint | mujoco.MjsGeom | mujoco.MjsSite, name: str) -> str:
    return part.name.replace(_SHIPPED, name, 1)


def _add_touch(spec: mujoco.MjSpec, name: str) -> None:
    fields = ("FOUND", "FORCE", "POS")
    data = sum(1 << int(getattr(mujoco.mjtConDataField, f"mjCONDATA_{field}")) for field in fields)
    net_force, one_slot = 3, 1
    spec.add_sensor(
        name=f"contact_{name}",
        type=mujoco.mjtSensor.mjSENS_CONTACT,
        objtype=mujoco.mjtObj.mjOBJ_BODY,
        objname=f"tip_{name}",
        intprm=[data, net_force, one_slot],
    )
