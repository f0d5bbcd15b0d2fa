"""Flat faces of rigid bodies: triangles of meshes, sides of boxes, ends of cylinders."""

# mujoco ships no type stubs for its compiled names
# pyright: reportAttributeAccessIssue=false

from __future__ import annotations

import math
from collections.abc import Iterable, Sequence
from dataclasses import dataclass

import mujoco
import numpy as np

_FACING = math.cos(math.radians(40))  # of a face's normal and the direction that it is to face
_FLATNESS = (  # rad and m off a face's plane, and m2 of the largest face for which no rounder ones are looked for
    (math.radians(2), 1e-4, 1e-4),
    (math.radians(10), 6e-4, 4e-5),
    (math.radians(20), 1.5e-3, 0.0),
)
_SEEDS = 24  # planes tried per geom, those of the most area
_RIM = 32  # corners that stand for a circle
_NEAR, _AMPLE = 0.5, 2e-4  # share of the best score, and m2, either of which makes a face large enough

_BOX = np.array(  # corners of its six sides, outwards by the right hand
    [
        [[1, -1, -1], [1, 1, -1], [1, 1, 1], [1, -1, 1]],
        [[-1, 1, -1], [-1, -1, -1], [-1, -1, 1], [-1, 1, 1]],
        [[1, 1, -1], [-1, 1, -1], [-1, 1, 1], [1, 1, 1]],
        [[-1, -1, -1], [1, -1, -1], [1, -1, 1], [-1, -1, 1]],
        [[-1, -1, 1], [1, -1, 1], [1, 1, 1], [-1, 1, 1]],
        [[-1, 1, -1], [1, 1, -1], [1, -1, -1], [-1, -1, -1]],
    ],
    float,
)


@dataclass(frozen=True, slots=True)
class Face:
    """A flat face. centre (3,) m and normal (3,), outwards, in its body's frame. area: m2. corners (n, 3) m: of its
    triangles. geom: the name of its geom, or its number where it has none."""

    centre: np.ndarray
    normal: np.ndarray
    area: float
    corners: np.ndarray
    geom: str

    def extent(self, direction: np.ndarray) -> float:
        """m from the centre to the furthest corner that way (a unit vector)."""
        return float(((self.corners - self.centre) @ direction).max())


def mesh_of(model: mujoco.MjModel, geom: int) -> tuple[np.ndarray, np.ndarray]:
    """(vertices (n, 3) m, triangles (m, 3)) of a mesh geom, in its frame."""
    mesh = int(model.geom_dataid[geom])
    first, count = model.mesh_vertadr[mesh], model.mesh_vertnum[mesh]
    vertices = model.mesh_vert[first : first + count].astype(float)
    first, count = model.mesh_faceadr[mesh], model.mesh_facenum[mesh]
    return vertices, model.mesh_face[first : first + count].astype(np.int64)


def hull_of(model: mujoco.MjModel, geom: int) -> np.ndarray:
    """(n, 3) numbers of a mesh geom's vertices, the triangles of its convex hull, with which MuJoCo has contacts. The
    model has none of a mesh that is only seen."""
    first = int(model.mesh_graphadr[model.geom_dataid[geom]])
    if first >= 0:
        points, count = (int(n) for n in model.mesh_graph[first : first + 2])
        first += 2 + 3 * points + 3 * count  # after the graph's addresses, points and edges
        return model.mesh_graph[first : first + 3 * count].reshape(-1, 3).astype(np.int64)
    from scipy.spatial import ConvexHull, QhullError  # which nothing else here needs

    vertices, faces = mesh_of(model, geom)
    try:
        return ConvexHull(vertices).simplices.astype(np.int64)
    except QhullError:  # it is flat
        return faces


def _hull(model: mujoco.MjModel, geom: int) -> np.ndarray:
    """(n, 3, 3) m: triangles of a mesh geom's convex hull, outwards, in its frame."""
    found = mesh_of(model, geom)[0][hull_of(model, geom)]
    normals = np.cross(found[:, 1] - found[:, 0], found[:, 2] - found[:, 0])
    inwards = np.einsum("ij,ij->i", normals, found.mean(axis=1) - found.mean(axis=(0, 1))) < 0
    return np.where(inwards[:, None, None], found[:, ::-1], found)


def triangles(model: mujoco.MjModel, geom: int, hull: bool = False) -> np.ndarray:
    """(n, 3, 3) m: a geom's triangles in its body's frame, none for what is round everywhere. hull: of meshes those of
    their convex hulls."""
    kind, size = model.geom_type[geom], model.geom_size[geom]
    if kind == mujoco.mjtGeom.mjGEOM_MESH:
        found = _hull(model, geom) if hull else np.take(*mesh_of(model, geom), axis=0)
    elif kind == mujoco.mjtGeom.mjGEOM_BOX:
        sides = _BOX * size
        found = np.concatenate([sides[:, [0, 1, 2]], sides[:, [0, 2, 3]]])
    elif kind == mujoco.mjtGeom.mjGEOM_CYLINDER:
        angles = np.linspace(0.0, 2 * np.pi, _RIM, endpoint=False)
        rim = np.stack([size[0] * np.cos(angles), size[0] * np.sin(angles), np.full(_RIM, size[1])], axis=1)
        top = np.stack([np.tile([0.0, 0.0, size[1]], (_RIM, 1)), rim, np.roll(rim, -1, axis=0)], axis=1)
        found = np.concatenate([top, top[:, [0, 2, 1]] * (1, 1, -1)])
    else:
        return np.zeros((0, 3, 3))
    return found @ rotation(model.geom_quat[geom]).T + model.geom_pos[geom]


def rotation(quat: np.ndarray) -> np.ndarray:
    """(3, 3) of a quaternion (w, x, y, z)."""
    matrix = np.zeros(9)
    mujoco.mju_quat2Mat(matrix, np.asarray(quat, float))
    return matrix.reshape(3, 3)


def frame(normal: np.ndarray) -> np.ndarray:
    """(3, 3) of a unit vector: columns the normal, y and z, along the body's axes where it can be."""
    z = np.eye(3)[2] if abs(normal[2]) < 0.9 else np.eye(3)[0]
    z = z - (z @ normal) * normal
    z = z / np.linalg.norm(z)
    return np.stack([normal, np.cross(z, normal), z], axis=1)


def flat_faces(parts: Iterable[tuple[str, np.ndarray]], direction: np.ndarray) -> list[Face]:
    """Each part's largest flat face that looks along `direction` (unit vector). parts: geom's name, triangles (n, 3, 3)
    m. Nearly flat ones where none is flat, such as on the balls of fingers."""
    parts, found = list(parts), []
    for angle, uneven, enough in _FLATNESS:
        faces = (_face_of(name, shape, direction, math.cos(angle), uneven) for name, shape in parts)
        found = [face for face in faces if face is not None]
        if max((face.area for face in found), default=0.0) >= enough:
            break
    return found


def largest_face(faces: Sequence[Face], direction: np.ndarray) -> Face | None:
    """The outermost of those that are half as large as the largest, or half as large as our pad, since it is what
    touches first. None for none."""
    if not faces:
        return None
    scores = [face.area * float(face.normal @ direction) for face in faces]
    enough = min(_NEAR * max(scores), _AMPLE)
    fit = [face for face, score in zip(faces, scores, strict=True) if score >= enough]
    return max(fit, key=lambda face: (round(float(face.centre @ direction), 5), face.area))


def _face_of(name: str, shape: np.ndarray, direction: np.ndarray, flat: float, uneven: float) -> Face | None:
    """One geom's largest flat face that way. flat: the least cosine of its normals. uneven: m."""
    cross = np.cross(shape[:, 1] - shape[:, 0], shape[:, 2] - shape[:, 0])
    twice = np.linalg.norm(cross, axis=1)
    facing = (cross @ direction > _FACING * twice) & (twice > 0)
    if not facing.any():
        return None
    shape, twice = shape[facing], twice[facing]
    normals, areas, middles = cross[facing] / twice[:, None], twice / 2, shape.mean(axis=1)
    offsets = np.einsum("ij,ij->i", normals, middles)
    bins = np.concatenate([np.round(normals * 8), np.round(offsets / 1e-3)[:, None]], axis=1)
    _, which = np.unique(bins, axis=0, return_inverse=True)
    which = which.ravel()
    totals = np.bincount(which, weights=areas)
    best, most = None, 0.0
    for seed in np.argsort(-totals)[:_SEEDS]:
        facet = which == seed
        normal = (areas[facet, None] * normals[facet]).sum(axis=0)
        normal /= np.linalg.norm(normal)
        offset = np.average(middles[facet] @ normal, weights=areas[facet])
        facet = (normals @ normal > flat) & (np.abs(middles @ normal - offset) < uneven)
        score = areas[facet].sum() * (normal @ direction)
        if score > most:
            best, most = facet, score
    if best is None:
        return None
    weights, corners = areas[best], shape[best].reshape(-1, 3)
    normal = (weights[:, None] * normals[best]).sum(axis=0)
    normal /= np.linalg.norm(normal)
    centre = np.average(middles[best], axis=0, weights=weights)
    return Face(centre, normal, float(weights.sum()), corners, name)
