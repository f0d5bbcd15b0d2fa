"""Surfaces from mesh files. Small defects are repaired, with a warning that names them; other files are refused."""

from __future__ import annotations

import warnings
from pathlib import Path

import numpy as np

from thermograsp.errors import MeshError

from ...thermal.surfaces import open_edges, wrongly_enclosed
from .solids import Triangles

FORMATS = (".stl", ".obj", ".ply", ".glb")
MOST_BYTES = 256 * 2**20
MOST_FACES = 500_000
_FARTHEST = 1e6  # of a coordinate, in units of the file
_TWICE = 1e-3  # of the volume that may be enclosed twice or inside out


def read_surface(path: str) -> Triangles:
    """The closed surface in a file, in the file's units, outward, every corner once.

    Faces without area or given twice are left out, faces turned the wrong way and surfaces inside out are turned round,
    each with a RuntimeWarning. Raises MeshError for a missing, foreign, broken, empty or huge file, and for surfaces
    that are open, flat, not finite, or cross themselves.
    """
    vertices, faces = _parsed(path, _file(path))
    _check_vertices(path, vertices, faces)
    vertices, faces = _merged(vertices, faces)
    faces = _without_doubles(path, faces)
    if not min(np.ptp(vertices[faces.ravel()], axis=0)) > 0:
        size = " x ".join(f"{s:g}" for s in np.ptp(vertices[faces.ravel()], axis=0))
        raise MeshError(f"{path}: encloses no volume, extents {size}; give a solid, not a sheet")
    faces = _turned_alike(path, faces, len(vertices))
    surface = Triangles(vertices, faces)
    box = float(np.prod(surface.extents))
    if not abs(surface.volume) > 1e-6 * box:
        raise MeshError(
            f"{path}: encloses no volume ({surface.volume:.3g} units3); give a solid, not a sheet"
        )
    if surface.volume < 0:
        _warn(path, "its surface was inside out and has been turned round")
        surface = surface.outward()
    _check_crossing(path, surface)
    return surface


def _file(path: str) -> Path:
    file = Path(path)
    if file.suffix.lower() not in FORMATS:
        raise MeshError(f"{path}: unknown mesh format {file.suffix!r}; use one of {', '.join(FORMATS)}")
    if not file.is_file():
        raise MeshError(f"{path}: no such file (looked in {file.resolve().parent})")
    size = file.stat().st_size
    if size == 0:
        raise MeshError(f"{path}: is empty; export it again")
    if size > MOST_BYTES:
        raise MeshError(
            f"{path}: {size / 2**20:.0f} MiB, more than {MOST_BYTES / 2**20:.0f}; simplify it, 50,000 faces are plenty"
        )
    return file


def _parsed(path: str, file: Path) -> tuple[np.ndarray, np.ndarray]:
    import trimesh

    try:
        with np.errstate(all="ignore"):
            mesh = trimesh.load_mesh(file, process=False)
            vertices, faces = np.array(mesh.vertices, float), np.array(mesh.faces, np.int64)
    except Exception as error:  # noqa: BLE001
        # trimesh raises whatever its parsers do
        raise MeshError(f"{path}: cannot be read as {file.suffix}: {error}") from error
    if faces.ndim != 2 or len(faces) == 0:
        raise MeshError(f"{path}: has no faces; export a surface mesh")
    if len(faces) > MOST_FACES:
        raise MeshError(
            f"{path}: {len(faces):,} faces, more than {MOST_FACES:,}; simplify it, 50,000 are plenty"
        )
    if faces.min() < 0 or faces.max() >= len(vertices):
        raise MeshError(f"{path}: a face refers to corner {faces.max()} of {len(vertices)}; export it again")
    return vertices, faces


def _check_vertices(path: str, vertices: np.ndarray, faces: np.ndarray) -> None:
    finite = np.isfinite(vertices).all(axis=1)
    if not finite.all():
        bad = int((~finite).sum())
        raise MeshError(f"{path}: {bad} of {len(vertices)} vertices are not finite; export it again")
    farthest = float(np.abs(vertices[faces.ravel()]).max())
    if farthest > _FARTHEST:
        raise MeshError(
            f"{path}: a vertex lies {farthest:.3g} units from the origin; move the object there and export it again"
        )


def _merged(vertices: np.ndarray, faces: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Every corner once: STL repeats them with each face. Corners within 1e-8 of the size are one."""
    used, faces = np.unique(faces, return_inverse=True)
    vertices = vertices[used]
    grain = max(float(np.ptp(vertices, axis=0).max()) * 1e-8, 1e-300)
    _, first, number = np.unique(np.round(vertices / grain), axis=0, return_index=True, return_inverse=True)
    return vertices[first], number.reshape(-1)[faces].reshape(-1, 3)


def _without_doubles(path: str, faces: np.ndarray) -> np.ndarray:
    a, b, c = faces.T
    pointed = (a == b) | (b == c) | (c == a)
    if pointed.any():
        _warn(path, f"{int(pointed.sum())} faces without area have been left out")
        faces = faces[~pointed]
    lowest = np.argmin(faces, axis=1)
    turned = np.stack([faces[np.arange(len(faces)), (lowest + i) % 3] for i in range(3)], axis=1)
    once = np.sort(np.unique(turned, axis=0, return_index=True)[1])
    if len(once) < len(faces):
        _warn(path, f"{len(faces) - len(once)} faces given twice have been left out")
        faces = faces[once]
    if not len(faces):
        raise MeshError(f"{path}: none of its faces has an area; export it again")
    return faces


def _turned_alike(path: str, faces: np.ndarray, vertices: int) -> np.ndarray:
    """The faces of a closed surface with neighbours turned the same way. Raises MeshError where it is open."""
    if open_edges(faces, vertices) == 0:
        return faces
    start, end = faces, np.roll(faces, -1, axis=1)
    edges = np.stack((np.minimum(start, end), np.maximum(start, end)), axis=-1).reshape(-1, 2)
    _, edge, counts = np.unique(edges, axis=0, return_inverse=True, return_counts=True)
    edge = edge.reshape(-1)
    loose = int((counts % 2).sum())
    if loose:
        raise MeshError(
            f"{path}: not closed (watertight): {loose} of {len(counts)} edges have a face on one side only, so it "
            "has no volume or mass; close its holes, e.g. with trimesh.repair.fill_holes or Blender's 3D Print toolbox"
        )
    if counts.max() > 2:
        raise MeshError(
            f"{path}: {int((counts > 2).sum())} edges join more than two faces that are not turned alike; unite "
            "or separate the surfaces that meet there"
        )
    flip = _flips((start > end).reshape(-1), edge, len(counts), len(faces))
    if flip is None:
        raise MeshError(f"{path}: has one side only, like a Klein bottle, and so no inside; give a solid")
    _warn(path, f"{int(flip.sum())} faces were turned the wrong way and have been turned round")
    return np.where(flip[:, None], faces[:, ::-1], faces)


def _flips(backward: np.ndarray, edge: np.ndarray, edges: int, faces: int) -> np.ndarray | None:
    """Which faces to turn so that two that share an edge run along it in opposite ways, the fewer of each piece; None
    where nothing serves. backward: (3 F,) way of each face's edges, edge: (3 F,) their numbers, each there twice."""
    from scipy.sparse import coo_array
    from scipy.sparse.csgraph import connected_components

    order = np.argsort(edge, kind="stable").reshape(edges, 2)
    left, right = order[:, 0] // 3, order[:, 1] // 3
    same = backward[order[:, 0]] == backward[order[:, 1]]  # one of the two must turn
    # Every face as it is and turned: what must go together is linked.
    at, other = np.concatenate((left, left + faces)), np.concatenate((right, right + faces))
    other = np.where(np.tile(same, 2), (other + faces) % (2 * faces), other)
    links = coo_array((np.ones(len(at)), (at, other)), shape=(2 * faces, 2 * faces))
    _, piece = connected_components(links, directed=False)
    as_is, turned = piece[:faces], piece[faces:]
    if np.any(as_is == turned):
        return None
    flip = np.zeros(faces, bool)
    for one in np.unique(np.minimum(as_is, turned)):
        in_piece = (as_is == one) | (turned == one)
        turn = turned[in_piece] == one
        flip[in_piece] = turn if turn.sum() <= turn.size / 2 else ~turn
    return flip


def _check_crossing(path: str, surface: Triangles) -> None:
    twice, inside_out = wrongly_enclosed(surface.vertices[surface.faces])
    if inside_out > _TWICE * surface.volume:
        raise MeshError(
            f"{path}: {100 * inside_out / surface.volume:.2g} % of it is inside out: a piece's faces look inward, or "
            "its surface crosses itself; turn the faces or unite the surfaces (Blender: Recalculate Outside; Boolean, "
            "union)"
        )
    if twice > _TWICE * surface.volume:
        raise MeshError(
            f"{path}: crosses itself, {100 * twice / surface.volume:.2g} % of its volume is enclosed twice; unite its "
            "surfaces (Blender: Boolean, union; trimesh: trimesh.boolean.union)"
        )


def _warn(path: str, what: str) -> None:
    warnings.warn(f"{path}: {what}", RuntimeWarning, stacklevel=4)
