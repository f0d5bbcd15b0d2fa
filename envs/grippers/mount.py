"""A gripper's bodies in our scene: under the lift, closing along x, palm up, driven along its way by one servo.

All its driven joints follow a slide joint, half the opening, by joint equalities, so that a force on the opening is the
force on either pad (virtual work) whatever linkage is between. Only the fingertips' pads collide, and only with
objects, as in assets/gripper.xml.
"""

# mujoco ships no type stubs for its compiled names
# pyright: reportAttributeAccessIssue=false

from __future__ import annotations

from typing import TYPE_CHECKING

import mujoco
import numpy as np

from ...assets import asset
from ...touch import rotation
from ..limits import MAX_FORCE, MAX_OPENING, PAD_SIDE
from .fingertip import add_fingertip
from .hand import parts_of

if TYPE_CHECKING:
    from .found import FoundGripper

DRIVE = "opening"
_REPLACED = ("palm", "rail", "badge")  # geoms of the shipped gripper
_MASS, _DAMPING = (
    0.1,
    120.0,
)  # kg felt at a pad for each driven joint, N s/m of half the opening: as the shipped one's
_FURTHEST = 0.1  # m, of a lever
_SOFT = {"solref": (0.005, 1.0), "solimp": (0.95, 0.99, 0.001, 0.5, 2.0)}
_VISUAL = 1
_DRAWN = 3  # groups from here on MuJoCo does not draw
_COLUMN = 0.01  # m to either side of the grasp centre
_SUNK = 0.0015  # m, of the arm in what it carries
_UNDRAWN = (
    int(mujoco.mjtGeom.mjGEOM_PLANE),
    int(mujoco.mjtGeom.mjGEOM_HFIELD),
    int(mujoco.mjtGeom.mjGEOM_SDF),
)


def mounted(gripper: FoundGripper) -> mujoco.MjSpec:
    """The scene without objects."""
    spec = mujoco.MjSpec.from_file(str(asset("gripper.xml")))
    for name in _REPLACED:
        spec.delete(spec.geom(name))
    for element in (spec.actuator("grip"), spec.equality("coupling"), spec.tendon("opening")):
        spec.delete(element)
    for name in ("finger_left", "finger_right"):
        spec.delete(spec.body(name))
    bodies = _Bodies(spec, gripper)
    for tip, place in zip(("left", "right"), gripper.closing.tips, strict=True):
        parent, origin, axes = bodies.frame(place.body, place.origin, place.axes)
        add_fingertip(parent, tip, origin, axes)
    _add_drive(spec, gripper)
    _put_arm(spec, bodies.base, bodies.corners())
    return spec


def palm_height(gripper: FoundGripper) -> float:
    """m, from the grasp centre up to what of the palm is straight above it; inf where nothing is."""
    spec = mujoco.MjSpec.from_file(str(asset("gripper.xml")))
    shape = _Bodies(spec, gripper).corners().reshape(-1, 3, 3)
    low, high = shape.min(axis=1), shape.max(axis=1)
    above = ((low < _COLUMN) & (high > -_COLUMN))[:, :2].all(axis=1) & (high[:, 2] > PAD_SIDE / 2)
    return max(float(low[above, 2].min()), PAD_SIDE / 2) if above.any() else np.inf


def joint_name(joint: int) -> str:
    """In our scenes, of a joint of the gripper's model."""
    return f"gripper_joint_{joint}"


class _Bodies:
    """The gripper's palm and moving links as bodies of the scene, by their numbers in the gripper's model."""

    def __init__(self, spec: mujoco.MjSpec, gripper: FoundGripper) -> None:
        self.spec, self.gripper, self.model = spec, gripper, gripper.model
        model = self.model
        self._data = mujoco.MjData(model)
        mujoco.mj_kinematics(model, self._data)
        self._meshes: dict[int, str] = {}
        way = gripper.closing
        # Of the palm's frame in the wrist's.
        origin, axes = self._place(gripper.palm_body)
        self._turn, self._shift = way.axes.T @ axes, way.axes.T @ (origin - way.centre)
        kept = _subtree(model, gripper.palm_body)
        trunk = self._fixed()
        mass = float(sum(model.body_mass[b] for b in trunk))
        self._bodies = {
            gripper.palm_body: spec.body("wrist").add_body(
                name="gripper",
                pos=self._shift,
                quat=_quat(self._turn),
                gravcomp=1,
                mass=max(mass, 1e-3),
                inertia=[1e-3] * 3,
                explicitinertial=True,
            )
        }
        for body in trunk:
            self._add_geoms(self._bodies[gripper.palm_body], body, *self._from_palm(body))
        for body in kept:
            if body not in trunk:
                self._add(body)

    def _place(self, body: int) -> tuple[np.ndarray, np.ndarray]:
        return self._data.xpos[body], self._data.xmat[body].reshape(3, 3)

    def _fixed(self) -> list[int]:
        """The bodies that stand still with the palm: of its subtree, and those that carry it without a joint."""
        model, palm = self.model, self.gripper.palm_body
        trunk, body = [], palm
        while body and not model.body_jntnum[body]:
            body = model.body_parentid[body]
            if body and model.body_weldid[body] == model.body_weldid[palm]:
                trunk.append(int(body))
        found = set(trunk)
        for body in _subtree(model, palm):
            at = body
            while at != palm and at not in self.gripper.driven:
                at = int(model.body_parentid[at])
            if at == palm:
                found.add(body)
        found.add(palm)
        return sorted(found)

    def _from_palm(self, body: int) -> tuple[np.ndarray, np.ndarray]:
        origin, axes = self._place(self.gripper.palm_body)
        offset, rotated = self._place(body)
        return axes.T @ (offset - origin), axes.T @ rotated

    def _add(self, body: int) -> None:
        model = self.model
        parent = int(model.body_parentid[body])
        while parent not in self._bodies:  # it stands still with the palm
            parent = self.gripper.palm_body
        (origin, axes), (offset, rotated) = self._place(parent), self._place(body)
        added = self._bodies[parent].add_body(
            name=f"gripper_{body}_{model.body(body).name}",
            pos=axes.T @ (offset - origin),
            quat=_quat(axes.T @ rotated),
            gravcomp=1,
            mass=model.body_mass[body],
            ipos=model.body_ipos[body],
            iquat=model.body_iquat[body],
            inertia=model.body_inertia[body],
            explicitinertial=True,
        )
        self._bodies[body] = added
        self._add_geoms(added, body, np.zeros(3), np.eye(3))
        for joint in range(model.body_jntadr[body], model.body_jntadr[body] + model.body_jntnum[body]):
            if joint in self.gripper.polynomials:
                self._add_joint(added, joint)

    def _add_joint(self, body: mujoco.MjsBody, joint: int) -> None:
        model, gripper = self.model, self.gripper
        slope = np.polynomial.polynomial.polyder(gripper.polynomials[joint])
        rate = float(np.abs(np.polynomial.polynomial.polyval(gripper.closing.openings / 2, slope)).mean())
        slides = model.jnt_type[joint] == mujoco.mjtJoint.mjJNT_SLIDE
        lever = min(1 / max(rate, 1e-9), 1.0 if slides else _FURTHEST)
        body.add_joint(
            name=joint_name(joint),
            type=mujoco.mjtJoint.mjJNT_SLIDE if slides else mujoco.mjtJoint.mjJNT_HINGE,
            pos=model.jnt_pos[joint],
            axis=model.jnt_axis[joint],
            ref=model.qpos0[model.jnt_qposadr[joint]],
            armature=_MASS * lever**2,
        )

    def _add_geoms(self, to: mujoco.MjsBody, body: int, offset: np.ndarray, rotated: np.ndarray) -> None:
        """What is to be seen of a body; of one that has geoms for looks, only these."""
        model = self.model
        first, count = model.body_geomadr[body], model.body_geomnum[body]
        drawn = [
            g
            for g in range(first, first + count)
            if model.geom_type[g] not in _UNDRAWN and model.geom_group[g] < _DRAWN
        ]
        looks = [g for g in drawn if not model.geom_contype[g] and not model.geom_conaffinity[g]]
        for geom in looks or drawn:
            material = model.geom_matid[geom]
            added = to.add_geom(
                name=f"gripper_geom_{geom}",
                type=mujoco.mjtGeom(int(model.geom_type[geom])),
                size=model.geom_size[geom],
                pos=offset + rotated @ model.geom_pos[geom],
                quat=_quat(rotated @ rotation(model.geom_quat[geom])),
                rgba=model.mat_rgba[material] if material >= 0 else model.geom_rgba[geom],
                contype=0,
                conaffinity=0,
                group=_VISUAL,
            )
            if model.geom_type[geom] == mujoco.mjtGeom.mjGEOM_MESH:
                added.meshname = self._mesh(int(model.geom_dataid[geom]))

    def _mesh(self, mesh: int) -> str:
        if mesh not in self._meshes:
            model = self.model
            first, count = model.mesh_vertadr[mesh], model.mesh_vertnum[mesh]
            vertices = model.mesh_vert[first : first + count]
            first, count = model.mesh_faceadr[mesh], model.mesh_facenum[mesh]
            faces = model.mesh_face[first : first + count]
            self._meshes[mesh] = name = f"gripper_mesh_{mesh}"
            self.spec.add_mesh(
                name=name,
                uservert=vertices.ravel(),
                userface=faces.ravel(),
                inertia=mujoco.mjtMeshInertia.mjMESH_INERTIA_SHELL,
            )
        return self._meshes[mesh]

    @property
    def base(self) -> np.ndarray:
        """(3,) m, the palm's origin in the wrist's frame."""
        return self._shift

    def frame(
        self, body: int, origin: np.ndarray, axes: np.ndarray
    ) -> tuple[mujoco.MjsBody, np.ndarray, np.ndarray]:
        """The scene's body that a place on one of the gripper's belongs to, and the place in its frame."""
        if body in self._bodies:
            return self._bodies[body], origin, axes
        offset, rotated = self._from_palm(body)
        return self._bodies[self.gripper.palm_body], offset + rotated @ origin, rotated @ axes

    def corners(self) -> np.ndarray:
        """(3 n, 3) m: of the n triangles of what stands still, in the wrist's frame."""
        palm = self.gripper.palm_body
        found = [shape.reshape(-1, 3) for _, shape in parts_of(self.model, self._fixed(), palm)]
        return np.concatenate(found) @ self._turn.T + self._shift if found else np.zeros((0, 3))


def _subtree(model: mujoco.MjModel, top: int) -> list[int]:
    """The body and all that hang on it, parents first."""
    inside = {top}
    for body in range(top + 1, model.nbody):
        if model.body_parentid[body] in inside:
            inside.add(body)
    return sorted(inside)


def _add_drive(spec: mujoco.MjSpec, gripper: FoundGripper) -> None:
    """Half the opening as a joint, what follows it, and the servo of the shipped gripper on it."""
    body = spec.body("wrist").add_body(
        name="drive", gravcomp=1, mass=1e-3, inertia=[1e-6] * 3, explicitinertial=True
    )
    body.add_joint(
        name=DRIVE,
        type=mujoco.mjtJoint.mjJNT_SLIDE,
        axis=(1, 0, 0),
        limited=mujoco.mjtLimited.mjLIMITED_TRUE,
        range=(gripper.narrowest / 2, gripper.widest / 2),
        damping=[_DAMPING, 0, 0],
        armature=2 * _MASS,
        solref_limit=_SOFT["solref"],
        solimp_limit=_SOFT["solimp"],
    )
    for joint, polynomial in gripper.polynomials.items():
        coefficients = polynomial.copy()
        coefficients[0] -= gripper.model.qpos0[gripper.model.jnt_qposadr[joint]]
        data = np.zeros(12)
        data[:5] = coefficients
        spec.add_equality(
            name=f"gripper_follow_{joint}",
            type=mujoco.mjtEq.mjEQ_JOINT,
            objtype=mujoco.mjtObj.mjOBJ_JOINT,
            name1=joint_name(joint),
            name2=DRIVE,
            data=data,
            **_SOFT,
        )
    stiffness = 4000.0
    spec.add_actuator(
        name="grip",
        trntype=mujoco.mjtTrn.mjTRN_JOINT,
        target=DRIVE,
        gear=(2, 0, 0, 0, 0, 0),
        dyntype=mujoco.mjtDyn.mjDYN_INTEGRATOR,
        gaintype=mujoco.mjtGain.mjGAIN_FIXED,
        biastype=mujoco.mjtBias.mjBIAS_AFFINE,
        gainprm=[stiffness] + [0] * 9,
        biasprm=[0, -stiffness] + [0] * 8,
        actearly=True,
        ctrlrange=(-0.1, 0.1),
        actrange=(-0.015, MAX_OPENING),
        forcerange=(-MAX_FORCE, MAX_FORCE),
    )


def _put_arm(spec: mujoco.MjSpec, base: np.ndarray, corners: np.ndarray) -> None:
    """The arm goes on top of the gripper's corners (n, 3) m, over its palm's origin (3,) m where that is beneath."""
    if not len(corners):
        return
    low, high = corners.min(axis=0), corners.max(axis=0)
    inside = (low[:2] <= base[:2]).all() and (base[:2] <= high[:2]).all()
    x, y = base[:2] if inside else (low + high)[:2] / 2
    flange, arm = spec.geom("flange"), spec.geom("arm")
    beneath = corners[np.hypot(corners[:, 0] - x, corners[:, 1] - y) < flange.size[0]]
    top = beneath[:, 2].max() if len(beneath) else high[2]
    flange.pos = (x, y, top + flange.size[1] - _SUNK)
    arm.pos = (x, y, top + 2 * flange.size[1] - 2 * _SUNK + arm.size[1])


def _quat(matrix: np.ndarray) -> np.ndarray:
    quat = np.zeros(4)
    mujoco.mju_mat2Quat(quat, np.ascontiguousarray(matrix).ravel())
    return quat
