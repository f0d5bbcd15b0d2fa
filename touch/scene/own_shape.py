"""Objects whose heat flows in their own shape: closed meshes, and several geoms that are fused to one body."""

# mujoco ships no type stubs for its compiled names
# pyright: reportAttributeAccessIssue=false

from __future__ import annotations

import logging
from collections.abc import Mapping, Sequence
from dataclasses import replace
from functools import lru_cache
from importlib.util import find_spec

import mujoco
import numpy as np

from thermograsp.errors import InvalidValueError, MeshError, MissingDependencyError, ThermograspError
from thermograsp.errors import install as how_to_install
from thermograsp.notice import busy

from ...thermal import Material, Solid, SolidPart
from .bodies import BodyShape
from .faces import mesh_of, rotation
from .fingertips import PadPlace
from .names import geom_label

_LOG = logging.getLogger(__name__)
_DIGITS = 7  # of a corner's m, of which a model has single precision
_OVERLAP = (
    2e-6  # m, by which geoms grow on all sides to be fused, as such that are side by side have gaps otherwise
)
_AROUND, _BALL = 64, 3  # sides of a round geom, and how often those of an icosahedron are halved

_ANY = Material("any", 1.0, 1.0, 1.0)

Surface = tuple[np.ndarray, np.ndarray]


def own_shapes(
    model: mujoco.MjModel, shapes: Sequence[BodyShape], pads: Sequence[PadPlace]
) -> tuple[BodyShape, ...]:
    """The objects, those that are meshes or several geoms with the solids that their heat flows in. A warning says
    which of these stay boxes, and why."""
    alike = len({(pad.stack, pad.surround) for pad in pads}) == 1
    if not alike:
        warn_of_boxes(model, shapes, "its fingertips have different sensors, skins or pads")
    for shape in shapes:
        if shape.contents is not None and any(pad.surround is not None for pad in pads):
            raise InvalidValueError(
                f"object {shape.name!r}: its contents do not go with a pad around a sensor, whose heat is known on "
                "empty objects: leave surround= of the fingertips out"
            )
    return tuple(_own(model, shape) if alike and _has_own(model, shape) else shape for shape in shapes)


def warn_of_boxes(model: mujoco.MjModel, shapes: Sequence[BodyShape], why: str) -> None:
    """Says of which objects the heat flows in boxes where their own shape might have been taken."""
    for shape in shapes:
        if _has_own(model, shape):
            _keep_box(shape, why)


def _has_own(model: mujoco.MjModel, shape: BodyShape) -> bool:
    """Whether a box would leave out thin walls: a round geom that stands alone is as thick as its box."""
    mesh = mujoco.mjtGeom.mjGEOM_MESH
    return len(shape.geoms) > 1 or all(model.geom_type[geom] == mesh for geom in shape.geoms)


def _keep_box(shape: BodyShape, why: str) -> None:
    """Says so, or raises InvalidValueError where that would be no vessel."""
    message = f"object {shape.name!r}: its heat flows in a box of its volume and proportions: {why}"
    if shape.contents is not None:
        raise InvalidValueError(f"{message}. A box has no hollow for its contents")
    _LOG.warning(message)


def _own(model: mujoco.MjModel, shape: BodyShape) -> BodyShape:
    from ...thermal.meshes import body_modes  # nothing that meshes need is loaded without them

    turn, offset = np.eye(3), np.zeros(3)
    if len(shape.geoms) == 1:
        (geom,) = shape.geoms
        turn, offset = rotation(model.geom_quat[geom]), model.geom_pos[geom]
        if model.geom_type[geom] == mujoco.mjtGeom.mjGEOM_MESH:
            # in its file's axes, along which its walls are, not in those of inertia
            turn = turn @ rotation(model.mesh_quat[int(model.geom_dataid[geom])]).T
    try:
        with busy(f"how heat spreads in object {shape.name!r}, once for its shape"):
            parts = {geom_label(model, geom): _surface(model, geom, offset, turn) for geom in shape.geoms}
            vertices, faces = next(iter(parts.values())) if len(parts) == 1 else _fused(parts)
            low, high = vertices.min(axis=0), vertices.max(axis=0)
            middle = (low + high) / 2
            solid = Solid((SolidPart(*_welded(vertices - middle, faces), shape.material),))
            body_modes(solid)
    except ThermograspError as error:
        _keep_box(shape, f"it is no closed body in one piece: {error}")
        return shape
    size = high - low
    return replace(shape, size=size, extent=size, centre=offset + turn @ middle, axes=turn, solid=solid)


def _surface(model: mujoco.MjModel, geom: int, offset: np.ndarray, turn: np.ndarray) -> Surface:
    """A geom's, in a frame at that offset (3,) m and turn (3, 3) in its body's. Raises MeshError where it has none."""
    kind, size, kinds = model.geom_type[geom], model.geom_size[geom], mujoco.mjtGeom
    if kind == kinds.mjGEOM_MESH:
        vertices, faces = mesh_of(model, geom)
    elif kind in (kinds.mjGEOM_PLANE, kinds.mjGEOM_HFIELD):
        raise MeshError("one of its geoms has no volume")
    else:
        vertices, faces = _primitive(int(kind), tuple(size.tolist()))
    placed = vertices @ rotation(model.geom_quat[geom]).T + model.geom_pos[geom]
    return np.round((placed - offset) @ turn, _DIGITS), faces  # or flat faces would be a little crooked


@lru_cache(maxsize=256)
def _primitive(kind: int, size: tuple[float, float, float]) -> Surface:
    """Of a box or a round geom, a polyhedron of its volume. Round ones are made large: trimesh leaves small triangles
    out, without which they are not closed."""
    import trimesh

    kinds, (a, b, c) = mujoco.mjtGeom, size
    if kind == kinds.mjGEOM_BOX:
        made, volume = trimesh.creation.box((2 * a, 2 * b, 2 * c)), 8 * a * b * c
    elif kind == kinds.mjGEOM_CYLINDER:
        made, volume = trimesh.creation.cylinder(1.0, 1.0, sections=_AROUND), 2 * np.pi * a * a * b
        made.apply_scale((a, a, 2 * b))
    elif kind == kinds.mjGEOM_CAPSULE:
        made = trimesh.creation.capsule(2 * b / a, 1.0, count=[_AROUND // 2, _AROUND])
        made.apply_translation(-made.bounds.mean(axis=0))
        made.apply_scale(a)
        volume = np.pi * a * a * (2 * b + 4 / 3 * a)
    else:
        radii = (a, a, a) if kind == kinds.mjGEOM_SPHERE else size
        made, volume = trimesh.creation.icosphere(_BALL), 4 / 3 * np.pi * np.prod(radii)
        made.apply_scale(radii)
    return np.asarray(made.vertices) * (volume / made.volume) ** (1 / 3), np.asarray(made.faces)


def _fused(parts: Mapping[str, Surface]) -> Surface:
    """The surface of all geoms together, by name. Raises MissingDependencyError, and MeshError where one is not
    closed."""
    import trimesh

    if find_spec("manifold3d") is None:
        raise MissingDependencyError(f"geoms are fused by manifold3d: {how_to_install('mesh')}")
    grown = []
    for label, (vertices, faces) in parts.items():
        low, high = vertices.min(axis=0), vertices.max(axis=0)
        try:
            SolidPart(*_welded(vertices, faces), _ANY)  # raises where it is not closed
        except MeshError as error:
            raise MeshError(f"geom {label}: {error}") from error
        middle = (low + high) / 2
        grown.append(trimesh.Trimesh(middle + (vertices - middle) * (1 + 2 * _OVERLAP / (high - low)), faces))
    found = trimesh.boolean.union(grown, engine="manifold")
    return np.round(np.asarray(found.vertices), _DIGITS), np.asarray(found.faces)


def _welded(vertices: np.ndarray, faces: np.ndarray) -> Surface:
    """Corners at the same place as one, without the faces that are none then."""
    distinct, which = np.unique(vertices, axis=0, return_inverse=True)
    faces = which.ravel()[faces]
    a, b, c = faces.T
    return distinct, faces[(a != b) & (b != c) & (c != a)]
