"""A fingertip on any body: pad, sensor, thermostat and compliance as on the shipped gripper (assets/gripper.xml).

The fingertip's frame has its origin on the face that it is mounted on, x out of the pad, y across, z towards the wrist.
"""

# mujoco ships no type stubs for its compiled names
# pyright: reportAttributeAccessIssue=false

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import mujoco
import numpy as np

from thermograsp.errors import GripperError, unknown_name

from .faces import Face
from .gripper_file import compiled
from .gripper_fingers import SMALLEST_FACE, Pad, chosen_face, finger_of
from .gripper_hand import Hand, parts_of
from .gripper_mechanism import Mechanism

THICKNESS = 0.006  # m, from the face to the pad's front
_PAD = (0.003, 0.01, 0.01)  # m, half sizes
_THERMOSTAT, _SENSOR = (0.003, 0.0085, 0.0085), (0.0015, 0.0045, 0.0045)  # m, half sizes
_SENSOR_AT = 0.00455  # m, of its middle
_MASS, _INERTIA = 0.02, 2e-6  # kg, kg m2
_STIFFNESS, _DAMPING, _ARMATURE, _MOST = 0.5, 0.01, 5e-5, 0.2  # N m/rad, N m s/rad, kg m2, rad
_VISUAL, _PADS, _SITES = 1, 2, 4  # groups
_GREY, _COPPER, _WHITE = (0.30, 0.32, 0.35, 1), (0.72, 0.45, 0.30, 1), (0.93, 0.93, 0.91, 1)


@dataclass(frozen=True, slots=True)
class FingertipReport:
    """What was found and added. body: it sits on; geom: whose face, or "given". area: m2 of the flat face. place (3,) m
    and normal (3,): of its middle, in the body's frame. added: names of what the spec has besides."""

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
    tip = parent.add_body(
        name=f"tip_{name}",
        pos=origin,
        quat=quat,
        gravcomp=1,
        mass=_MASS,
        inertia=[_INERTIA] * 3,
        explicitinertial=True,
    )
    added = [f"tip_{name}"]
    if compliant:
        for kind, axis in (("pitch", (0, 1, 0)), ("yaw", (0, 0, 1))):
            tip.add_joint(
                name=f"tip_{name}_{kind}",
                type=mujoco.mjtJoint.mjJNT_HINGE,
                axis=axis,
                stiffness=[_STIFFNESS, 0, 0],
                damping=[_DAMPING, 0, 0],
                springref=0,
                frictionloss=0,
                armature=_ARMATURE,
                limited=mujoco.mjtLimited.mjLIMITED_TRUE,
                range=_range(parent),
            )
            added.append(f"tip_{name}_{kind}")
    box = mujoco.mjtGeom.mjGEOM_BOX
    # What default classes of the parent's file might say otherwise is said here.
    alone = {"contype": 0, "conaffinity": 0, "group": _VISUAL, "material": ""}
    tip.add_geom(
        name=f"pad_{name}",
        type=box,
        size=_PAD,
        pos=(_PAD[0], 0, 0),
        contype=1,
        conaffinity=0,
        condim=4,
        group=_PADS,
        rgba=_GREY,
        material="",
    )
    tip.add_geom(
        name=f"thermostat_{name}",
        type=box,
        size=_THERMOSTAT,
        pos=(-_THERMOSTAT[0], 0, 0),
        rgba=_COPPER,
        **alone,
    )
    tip.add_geom(name=f"sensor_{name}", type=box, size=_SENSOR, pos=(_SENSOR_AT, 0, 0), rgba=_WHITE, **alone)
    tip.add_site(name=f"pad_{name}", pos=(THICKNESS, 0, 0), size=(0.001, 0.001, 0.001), group=_SITES)
    return (*added, f"pad_{name}", f"thermostat_{name}", f"sensor_{name}")


def _range(parent: mujoco.MjsBody) -> tuple[float, float]:
    """Limits of the hinges in the unit of the body's own file."""
    most = float(np.degrees(_MOST)) if parent.compiler.degree else _MOST
    return -most, most


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
