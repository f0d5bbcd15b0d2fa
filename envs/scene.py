"""The mechanical scene: a parallel gripper over a table and the objects it may touch.

World frame: z up, the table's top at z = 0, the fingers move along x. The gripper itself is assets/gripper.xml
or somebody's (gripper.py).
"""

# mujoco ships no type stubs for its compiled names
# pyright: reportAttributeAccessIssue=false

from __future__ import annotations

import math
from collections.abc import Iterable, Sequence
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, Literal

import mujoco
import numpy as np

from thermograsp.errors import InvalidValueError, celsius, finite, non_negative, positive, unknown_name

from ..thermal import Material, material
from .gripper_shipped import SHIPPED_GRIPPER, GripperModel
from .meshes import MeshShape, load_mesh
from .parts import Part, checked_size
from .reservoir import Reservoir
from .solver_settings import SHIPPED, SolverSettings

if TYPE_CHECKING:
    from .assembly import Assembly

TIPS = ("left", "right")
MAX_OPENING = 0.085  # m, between the pads
PAD_SIDE = 0.020  # m, the square pad that takes the force
CLEARANCE = 0.002  # m, least gap between pads (or fingers) and what they must not touch
REACH = 0.095  # m, from the grasp centre up to the palm
LATERAL_REACH = 0.06  # m, of the arm to either side along y
MAX_LATERAL_RATE = 0.1  # m/s
DEFAULT_MASS = 0.1  # kg
DEFAULT_FRICTION = 0.8

_SHAPES = ("box", "cylinder", "sphere", "mesh")
_GEOMS = {
    "box": mujoco.mjtGeom.mjGEOM_BOX,
    "cylinder": mujoco.mjtGeom.mjGEOM_CYLINDER,
    "sphere": mujoco.mjtGeom.mjGEOM_SPHERE,
}
_MIDPOINT, _POWER = 0.5, 2.0  # of the impedance's rise with depth, MuJoCo's defaults
_TORSION, _ROLLING = 0.005, 0.0001  # m, MuJoCo's defaults; a flat patch has its torsion from its corners


@dataclass(frozen=True, slots=True)
class ObjectSpec:
    """One object on the table. Hashable; the frame is the centre of its bounding box.

    shape: box, cylinder (standing), sphere or mesh. size: m, full extents (x, y, z) in the object's frame; a mesh
    takes them from its file. mass: kg, or density: kg/m3 (at most one; neither means 0.1 kg). friction: sliding
    coefficient of every contact of the object (None: 0.8). position: m, (x, y) of its centre on the table, the
    gripper's is (0, 0). yaw: rad about z. rgba: 0..1. mesh, scale, pieces: see `load_mesh`. elements: (side,
    thickness) m of square plates without mass glued on where the pads meet it, None for none. temperature: °C at first,
    None for the scene's. reservoir: what keeps it hot or cold, None for nothing. material: a name or a Material whose
    density and friction hold where nothing else is said; environments take it where they are not told another one.
    parts: what of it is of other materials (T mode); it has a material of its own then and no density, its mass and
    inertia are those of all, and its friction is that of what the pads meet.
    Raises InvalidValueError, UnknownNameError (shape, material), or MeshError (file).
    """

    name: str = "object"
    shape: Literal["box", "cylinder", "sphere", "mesh"] = "box"
    size: tuple[float, float, float] = (0.04, 0.04, 0.04)
    mass: float | None = None
    density: float | None = None
    friction: float | None = None
    position: tuple[float, float] = (0.0, 0.0)
    yaw: float = 0.0
    rgba: tuple[float, float, float, float] = (0.55, 0.65, 0.75, 1.0)
    mesh: str | None = None
    scale: float = 1.0
    pieces: int = 1
    elements: tuple[float, float] | None = None
    temperature: float | None = None
    reservoir: Reservoir | None = None
    material: str | Material | None = None
    parts: tuple[Part, ...] = ()

    def __post_init__(self) -> None:
        if self.shape not in _SHAPES:
            raise unknown_name("shape", self.shape, _SHAPES)
        if (self.mesh is None) == (self.shape == "mesh"):
            raise InvalidValueError(
                f"shape {self.shape!r} with mesh {self.mesh!r}: give a file for shape 'mesh' only"
            )
        if self.mass is not None and self.density is not None:
            raise InvalidValueError(f"mass {self.mass} kg and density {self.density} kg/m3: give one of them")
        for field in ("mass", "density"):
            if getattr(self, field) is not None:
                positive(field, getattr(self, field))
        if self.friction is not None:
            non_negative("friction", self.friction)
        finite("yaw", self.yaw)
        for value in self.position:
            finite("position", value)
        set_ = object.__setattr__
        extents = self.geometry.extents if self.mesh else self.size
        set_(self, "size", checked_size(self.shape, extents))
        if self.temperature is not None:
            celsius("temperature", self.temperature)
        if self.material is not None:
            material(self.material)
        parts = tuple(self.parts) if isinstance(self.parts, Iterable) else (None,)
        if not all(isinstance(each, Part) for each in parts):
            raise InvalidValueError(f"parts {self.parts!r}: give a list of envs.Part(material, size=...)")
        set_(self, "parts", parts)
        if self.parts:
            if self.material is None or self.density is not None or self.elements:
                raise InvalidValueError(
                    f"parts in an object of material {self.material!r}, density {self.density} kg/m3 and elements "
                    f"{self.elements}: give the material that is around them, no density, and no elements"
                )
            _ = self.assembly  # checks them
        for value in self.elements or ():
            positive("elements (side, thickness)", value)
        if self.width > MAX_OPENING - CLEARANCE:
            raise InvalidValueError(
                f"object {self.name!r} is {1e3 * self.width:.1f} mm wide along x, the gripper opens "
                f"{1e3 * MAX_OPENING:.0f} mm: make it at most {1e3 * (MAX_OPENING - CLEARANCE):.0f} mm or turn it (yaw)"
            )

    @property
    def geometry(self) -> MeshShape:
        """The mesh's shape (cached by file). Raises InvalidValueError when the object has none."""
        if self.mesh is None:
            raise InvalidValueError(f"object {self.name!r} is a {self.shape}, not a mesh")
        return load_mesh(self.mesh, self.scale, self.pieces)

    @property
    def assembly(self) -> Assembly:
        """Its parts together, itself the first (cached)."""
        from .assembly import assembly  # nothing that parts need is loaded without them

        return assembly(self.shape, self.size, self.mesh, self.scale, self.pieces, self.parts)

    @property
    def materials(self) -> tuple[Material, ...]:
        """Its own, where it has one, and its parts'."""
        own = () if self.material is None else (material(self.material),)
        return (*own, *(part.made_of for part in self.parts))

    @property
    def touched_part(self) -> int:
        """What most of both pads' faces meet that close on it: 0 for its own material, else the number of a part."""
        if not self.parts:
            return 0
        cos, sin = math.cos(self.yaw), math.sin(self.yaw)
        x, y = self.position
        middle = np.array([-x * cos - y * sin, x * sin - y * cos, self.grasp_height - self.size[2] / 2])
        return self.assembly.touched(middle, np.array([cos, -sin, 0.0]), sum(self.size))

    @property
    def touched(self) -> Material | None:
        """The material of that, None where it has none."""
        return self.materials[self.touched_part] if self.material is not None else None

    @property
    def hulls(self) -> int:
        """Number of convex geoms."""
        return len(self.geometry.hulls) if self.mesh else 1

    @property
    def width(self) -> float:
        """m, extent along x (between the fingers) at this yaw; of the bounding box for a mesh."""
        glued = 2 * self.elements[1] if self.elements else 0.0
        if self.shape in ("sphere", "cylinder"):
            return self.size[0] + glued
        return (self.size[0] + glued) * abs(math.cos(self.yaw)) + self.size[1] * abs(math.sin(self.yaw))

    @property
    def element_places(self) -> np.ndarray:
        """(2, 3) m in the object's frame: the outer faces' middles of the left and the right element."""
        thickness = self.elements[1] if self.elements else 0.0
        height = self.grasp_height - self.size[2] / 2
        return np.array([[side * (self.size[0] / 2 + thickness), 0.0, height] for side in (-1, 1)])

    @property
    def volume(self) -> float:
        """m3."""
        x, y, z = self.size
        if self.shape == "mesh":
            return self.geometry.volume
        return x * y * z * {"box": 1.0, "cylinder": math.pi / 4, "sphere": math.pi / 6}[self.shape]

    @property
    def weight(self) -> float:
        """kg, the mass given or that of the density, given or the materials'; else 0.1."""
        if self.mass is not None:
            return self.mass
        if self.parts:
            return self.assembly.weight(self.materials)
        if self.density is not None:
            return self.density * self.volume
        return DEFAULT_MASS if self.material is None else material(self.material).density * self.volume

    @property
    def sliding_friction(self) -> float:
        """Of every contact: what is given, else that of the material that is touched, else 0.8."""
        if self.friction is not None:
            return self.friction
        touched = self.touched
        return DEFAULT_FRICTION if touched is None or touched.friction is None else touched.friction

    @property
    def inertia(self) -> tuple[np.ndarray, np.ndarray]:
        """Centre of mass (3,) m and inertia matrix about it (3, 3) kg m2, in the object's frame, of uniform
        materials."""
        if self.parts:
            centre, inertia = self.assembly.inertia(self.materials)
            return centre, self.weight / self.assembly.weight(self.materials) * inertia
        if self.shape == "mesh":
            shape = self.geometry
            return np.array(shape.centre_of_mass), self.weight * np.array(shape.unit_inertia)
        return np.zeros(3), self.weight * unit_inertia(self.shape, self.size)

    @property
    def pose(self) -> np.ndarray:
        """(7,) position of the centre in m and unit quaternion (w, x, y, z), resting on the table."""
        half = self.yaw / 2
        return np.array([*self.position, self.size[2] / 2, math.cos(half), 0.0, 0.0, math.sin(half)])

    @property
    def grasp_height(self) -> float:
        """m over the table of the grasp centre when the gripper is down.

        The middle of the side faces, but the pads stay off the table and the palm off the object's top.
        """
        lowest = PAD_SIDE / 2 + CLEARANCE
        return max(self.size[2] / 2, lowest, self.size[2] + CLEARANCE - REACH)


def unit_inertia(shape: str, size: tuple[float, float, float]) -> np.ndarray:
    """(3, 3) m2 about its centre of a uniform kilogram: a box, cylinder or sphere of that size m."""
    x, y, z = (s * s for s in size)
    across, along = {
        "box": ((y + z) / 12, (x + y) / 12),
        "cylinder": (x / 16 + z / 12, x / 8),
        "sphere": (x / 10, x / 10),
    }[shape]
    second = (x + z) / 12 if shape == "box" else across
    return np.diag((across, second, along))


def scaled(spec: ObjectSpec, size: float = 1.0, *, mass: float = 1.0, friction: float = 1.0) -> ObjectSpec:
    """The object with its size, mass and friction times these factors. A larger one of given density or materials is
    heavier; one of given mass is not."""
    if size == mass == friction == 1.0:
        return spec
    extents = (
        {"scale": spec.scale * size} if spec.mesh else {"size": tuple(size * side for side in spec.size)}
    )
    heavier = {"density": spec.density * mass} if spec.density is not None else {"mass": spec.weight * mass}
    rougher = {"friction": spec.sliding_friction * friction}
    if spec.parts:
        extents |= {"scale": spec.scale * size, "parts": tuple(part.scaled(size) for part in spec.parts)}
        heavier = {"mass": spec.weight * mass * (1.0 if spec.mass is not None else size**3)}
    return replace(spec, **extents, **heavier, **rougher)


def placeless(spec: ObjectSpec) -> ObjectSpec:
    """The same object at the origin: what the compiled model depends on (the pose is state, heat is not its affair)."""
    return replace(spec, position=(0.0, 0.0), yaw=0.0, temperature=None, reservoir=None)


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

    Each object is a free body named after it, with explicit inertia, and has a contact sensor per fingertip
    (names: `contact_sensor`): number of contacts, net force of the tip on the object (world frame, N), and the
    force-weighted centroid (world frame, m). Sensors are ordered by tip, then by object.
    library: mesh objects whose files are compiled in besides, so that models with other objects from it
    have the same layout. settings: MuJoCo's solver and the softness of contacts. lateral: the arm also slides along y,
    by a servo like the lift's. gripper: another one than the shipped one (`load_gripper`).
    Raises InvalidValueError for no objects or a name given twice, or where the gripper cannot take the first one.
    """
    objects, library = tuple(objects), tuple(library)
    names = [o.name for o in objects]
    if not objects or len(set(names)) < len(names):
        raise InvalidValueError(f"objects {names}: give at least one and every name once")
    spec = gripper.scene()
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
    return spec.compile()


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
    moments, quat = _principal(inertia)
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
    x, y, z = (s / 2 for s in item.size)
    half = {"box": (x, y, z), "cylinder": (x, z, 0), "sphere": (x, 0, 0), "mesh": (0, 0, 0)}[item.shape]
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
            type=mujoco.mjtGeom.mjGEOM_MESH if mesh else _GEOMS[item.shape],
            size=half,
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


def _principal(inertia: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
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
