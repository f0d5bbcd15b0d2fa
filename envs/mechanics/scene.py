"""The mechanical scene: a parallel gripper over a table and the objects it may touch.

World frame: z up, the table's top at z = 0, the fingers move along x. The gripper itself is assets/gripper.xml
or a user's (envs/grippers).
"""

# mujoco ships no type stubs for its compiled names
# pyright: reportAttributeAccessIssue=false

from __future__ import annotations

from collections.abc import Iterable, Sequence

import mujoco
import numpy as np

from thermograsp.errors import InvalidValueError

from ..bodies import MeshShape, ObjectSpec
from ..grippers import SHIPPED_GRIPPER, GripperModel
from ..limits import LATERAL_REACH, MAX_LATERAL_RATE, TIPS
from .solver_settings import SHIPPED, SolverSettings

PRIMITIVES = {
    "box": mujoco.mjtGeom.mjGEOM_BOX,
    "cylinder": mujoco.mjtGeom.mjGEOM_CYLINDER,
    "sphere": mujoco.mjtGeom.mjGEOM_SPHERE,
}
_MIDPOINT, _POWER = 0.5, 2.0  # of the impedance's rise with depth, MuJoCo's defaults
_TORSION, _ROLLING = 0.005, 0.0001  # m, MuJoCo's defaults; a flat patch has its torsion from its corners
_INSIDE = 2e-3  # m
_CUBE = ObjectSpec()
_COMPLIANCE = 1 / _CUBE.weight, float(np.mean(1 / np.linalg.eigvalsh(_CUBE.inertia[1])))  # 1/kg, 1/(kg m2)


def contact_sensor(tip: str, name: str) -> str:
    """Name of the sensor of fingertip `tip` touching object `name`."""
    return f"contact_{tip}_{name}"


def element_geom(tip: str, name: str) -> str:
    """Name of the geom of the element on object `name` that fingertip `tip` meets."""
    return f"{name}_element_{tip}"


def build_scene(
    objects: Sequence[ObjectSpec] = (ObjectSpec(),),
    *,
    library: Iterable[ObjectSpec] = (),
    settings: SolverSettings = SHIPPED,
    lateral: bool = False,
    gripper: GripperModel = SHIPPED_GRIPPER,
) -> mujoco.MjModel:
    """Compile gripper, table and objects; the gripper is down at the first object's grasp height.

    All else is that of `scene_spec`, whose result it compiles, but contacts of all objects are equally soft: MuJoCo
    would make those of heavier bodies stiffer, so that the opening would tell an object's mass (`soften_alike`)."""
    objects = tuple(objects)
    spec = scene_spec(objects, library=library, settings=settings, lateral=lateral, gripper=gripper)
    model = spec.compile()
    soften_alike(model, [item.name for item in objects])
    return model


def soften_alike(model: mujoco.MjModel, names: Iterable[str]) -> None:
    """Gives these bodies' contacts the compliance that those of `ObjectSpec()` have, a cube of .1 kg, whatever they
    weigh.

    MuJoCo regularises a contact with R = (1 - d)/d (w1 + w2), d its impedance and w the bodies' `body_invweight0`
    (documentation, "Computation: Constraint model"). At rest R f = k r, so that the depth r under a force f would go
    with 1/mass. What yields at a real touch is the pad, which is the same for all objects. `body_invweight0` of a free
    body has no other use.
    """
    for name in names:
        model.body_invweight0[model.body(name).id] = _COMPLIANCE


def refuse_overlap(model: mujoco.MjModel, data: mujoco.MjData, names: Sequence[str]) -> None:
    """Raises InvalidValueError where two of these bodies lie deeper in each other than objects that were placed at
    random may: MuJoCo would throw them off the table."""
    mujoco.mj_forward(model, data)
    body = {model.body(name).id: name for name in names}
    for contact in data.contact:
        owners = [body.get(int(model.geom_bodyid[geom])) for geom in contact.geom]
        if None not in owners and contact.dist < -_INSIDE:
            raise InvalidValueError(
                f"objects {owners[0]!r} and {owners[1]!r} of the scene lie {-1e3 * contact.dist:.1f} mm deep in each "
                "other: give them other positions"
            )


def scene_spec(
    objects: Sequence[ObjectSpec] = (ObjectSpec(),),
    *,
    library: Iterable[ObjectSpec] = (),
    settings: SolverSettings = SHIPPED,
    lateral: bool = False,
    gripper: GripperModel = SHIPPED_GRIPPER,
) -> mujoco.MjSpec:
    """Gripper, table and objects; the gripper is down at the first object's grasp height.

    Each object is a free body named after it, with explicit inertia, and has a contact sensor per fingertip
    (names: `contact_sensor`): number of contacts, net force of the tip on the object (world frame, N), and the
    force-weighted centroid (world frame, m). Sensors are ordered by tip, then by object.
    library: mesh objects whose files are compiled in besides, so that models with other objects from it
    have the same layout. settings: MuJoCo's solver and the softness of contacts. lateral: the arm also slides along y,
    by a servo like the lift's. gripper: another one than the shipped one (`load_gripper`).
    Raises InvalidValueError for no objects, a name that is given twice, empty or a body's of the gripper, or where the
    gripper cannot take the first one.
    """
    objects, library = tuple(objects), tuple(library)
    names = [o.name for o in objects]
    if not objects or len(set(names)) < len(names):
        raise InvalidValueError(f"objects {names}: give at least one and every name once")
    spec = gripper.scene()
    taken = {"", *(body.name for body in spec.bodies)}
    if not taken.isdisjoint(names):
        raise InvalidValueError(
            f"objects {names}: give every one a name of its own, none of {sorted(taken)}, which the scene has already"
        )
    settings.apply(spec.option)
    for shape in dict.fromkeys(o.geometry for o in (*library, *objects) if o.mesh):
        for name, (vertices, faces) in zip(_mesh_names(shape), shape.hulls, strict=True):
            spec.add_mesh(name=name, uservert=vertices.ravel(), userface=faces.ravel())
    _keep_hulls(spec, [item.geometry for item in library if item.mesh])
    for item in objects:
        _add_object(spec, item, settings)
    for tip in TIPS:
        for item in objects:
            _add_contact_sensor(spec, tip, item.name)
    spec.body("wrist").pos[:] = gripper.wrist_at(objects[0])
    if lateral:
        _add_slide(spec)
    return spec


def _add_slide(spec: mujoco.MjSpec) -> None:
    """The arm's way along y and its servo, with the lift's damping, stiffness and strength."""
    spec.body("wrist").add_joint(
        name="lateral",
        type=mujoco.mjtJoint.mjJNT_SLIDE,
        axis=(0, 1, 0),
        range=(-LATERAL_REACH, LATERAL_REACH),
        damping=spec.joint("lift").damping,
    )
    lift = spec.actuator("lift")
    servo = spec.add_actuator(
        name="lateral",
        trntype=mujoco.mjtTrn.mjTRN_JOINT,
        target="lateral",
        ctrlrange=(-MAX_LATERAL_RATE, MAX_LATERAL_RATE),
        actrange=(-LATERAL_REACH, LATERAL_REACH),
        forcerange=lift.forcerange,
    )
    servo.set_to_intvelocity(kp=lift.gainprm[0], kv=-lift.biasprm[2])


def _mesh_names(shape: MeshShape) -> list[str]:
    return [f"{shape.name}_{i}" for i in range(len(shape.hulls))]


def _keep_hulls(spec: mujoco.MjSpec, shapes: Sequence[MeshShape]) -> None:
    """Invisible users of the library's meshes that touch nothing: MuJoCo makes no hull of a mesh without a user."""
    names = [name for shape in dict.fromkeys(shapes) for name in _mesh_names(shape)]
    if not names:
        return
    shelf = spec.worldbody.add_body(name="library", pos=(0, 0, -2))
    for name in names:
        geom = shelf.add_geom(
            name=f"library_{name}", type=mujoco.mjtGeom.mjGEOM_MESH, contype=8, conaffinity=0
        )
        geom.meshname, geom.rgba, geom.group = name, (0, 0, 0, 0), 5


def _add_object(spec: mujoco.MjSpec, item: ObjectSpec, settings: SolverSettings) -> None:
    com, inertia = item.inertia
    moments, quat = principal(inertia)
    pose = item.pose
    body = spec.worldbody.add_body(
        name=item.name,
        pos=pose[:3],
        quat=pose[3:],
        mass=item.weight,
        ipos=com,
        inertia=moments,
        iquat=quat,
        explicitinertial=True,
    )
    body.add_freejoint(name=f"{item.name}_free")
    # They meet the pads (1), the other objects (2) and the table (4); their own contact settings hold.
    contact: dict = {
        "contype": 2,
        "conaffinity": 7,
        "priority": 1,
        "condim": 4,
        "friction": (item.sliding_friction, _TORSION, _ROLLING),
        "solref": settings.solref,
        "solimp": (*settings.solimp, _MIDPOINT, _POWER),
    }
    meshes = _mesh_names(item.geometry) if item.mesh else [None]
    for i, mesh in enumerate(meshes):
        geom = body.add_geom(
            name=f"{item.name}_{i}",
            type=mujoco.mjtGeom.mjGEOM_MESH if mesh else PRIMITIVES[item.shape],
            size=half_sizes(item),
            rgba=item.rgba,
            material="matter",
            **contact,
        )
        if mesh:
            geom.meshname = mesh
    if item.elements:
        side, thickness = item.elements
        for tip, place in zip(TIPS, item.element_places, strict=True):
            body.add_geom(
                name=element_geom(tip, item.name),
                type=mujoco.mjtGeom.mjGEOM_BOX,
                pos=place - np.sign(place) * (thickness / 2, 0.0, 0.0),
                size=(thickness / 2, side / 2, side / 2),
                rgba=item.rgba,
                material="matter",
                **contact,
            )


def half_sizes(item: ObjectSpec) -> tuple[float, float, float]:
    """m, as MuJoCo tells a geom of that shape; zeros of a mesh."""
    x, y, z = (side / 2 for side in item.size)
    return {"box": (x, y, z), "cylinder": (x, z, 0.0), "sphere": (x, 0.0, 0.0), "mesh": (0.0,) * 3}[
        item.shape
    ]


def principal(inertia: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Principal moments and the rotation of their axes, never the identity.

    MuJoCo stores the mass matrix of a body with aligned axes more sparsely; objects of one batch need one layout.
    """
    moments, axes = np.linalg.eigh(inertia)
    if np.linalg.det(axes) < 0:
        axes[:, 0] *= -1
    if np.trace(axes) > 2.999:
        moments, axes = np.roll(moments, 1), np.roll(axes, 1, axis=1)
    quat = np.zeros(4)
    mujoco.mju_mat2Quat(quat, axes.ravel())
    return moments, quat


def _add_contact_sensor(spec: mujoco.MjSpec, tip: str, name: str) -> None:
    data = sum(
        1 << int(bit)
        for bit in (
            mujoco.mjtConDataField.mjCONDATA_FOUND,
            mujoco.mjtConDataField.mjCONDATA_FORCE,
            mujoco.mjtConDataField.mjCONDATA_POS,
        )
    )
    net_force, one_slot = 3, 1
    spec.add_sensor(
        name=contact_sensor(tip, name),
        type=mujoco.mjtSensor.mjSENS_CONTACT,
        objtype=mujoco.mjtObj.mjOBJ_BODY,
        objname=f"tip_{tip}",
        reftype=mujoco.mjtObj.mjOBJ_BODY,
        refname=name,
        intprm=[data, net_force, one_slot],
    )
