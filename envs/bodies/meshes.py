"""Objects from mesh files: STL, OBJ, PLY and GLB through trimesh."""

from __future__ import annotations

import hashlib
from dataclasses import dataclass, field
from functools import lru_cache
from pathlib import Path

import numpy as np

from thermograsp.compiled import compile_beside
from thermograsp.errors import MeshError, MissingDependencyError, install, positive

from ...thermal.contact import gas_around
from ...thermal.surfaces import crossed_above
from .mesh_files import FORMATS, read_surface

SMALLEST = 0.005  # m, along the shortest extent
LARGEST = 0.083  # m, that fits between the pads (85 mm) with 1 mm on either side
_VOXELS = 50_000  # of the decomposition: a ring in 12 pieces is 4 % too thick and takes about a second
_UNITS = ((0.001, "millimetres"), (0.01, "centimetres"), (0.0254, "inches"))


@dataclass(frozen=True, slots=True)
class MeshShape:
    """A solid read from a file, scaled to metres, its bounding box centred on the origin.

    origin: m, that of the file's coordinates in the shape's frame. extents: m, (x, y, z); x is the thickness between
    the fingers at yaw 0. volume: m3. centre_of_mass: m.
    unit_inertia: m2, (3, 3) about the centre of mass, for a mass of 1 kg of uniform density.
    hulls: (vertices (n, 3) m, triangles (m, 3)) of the convex pieces that collide. surface: the same of the solid
    itself, outward, its cavities included.
    Two shapes are equal when file, scale and pieces are.
    """

    path: str
    scale: float
    pieces: int
    origin: tuple[float, float, float] = field(compare=False)
    extents: tuple[float, float, float] = field(compare=False)
    volume: float = field(compare=False)
    centre_of_mass: tuple[float, float, float] = field(compare=False)
    unit_inertia: tuple[tuple[float, float, float], ...] = field(compare=False)
    hulls: tuple[tuple[np.ndarray, np.ndarray], ...] = field(compare=False, repr=False)
    surface: tuple[np.ndarray, np.ndarray] = field(compare=False, repr=False)

    @property
    def name(self) -> str:
        """Name of the assets made of it, which no other shape has, not one of a file of the same name elsewhere."""
        others = repr((self.path, self.scale, self.pieces)).encode()
        return f"{Path(self.path).stem}_{hashlib.sha256(others).hexdigest()[:16]}"


@lru_cache(maxsize=64)
def load_mesh(path: str, scale: float = 1.0, pieces: int = 1) -> MeshShape:
    """Read a closed mesh; lengths in the file times `scale` are metres.

    pieces: most convex pieces to collide with. 1 collides with the convex hull, which fills holes and
    hollows; more decompose the solid (V-HACD, needs the package vhacdx). Mass and inertia are the true solid's.
    Results are cached by path, scale and pieces; a file that changed is not read again.
    What is mended is told by a RuntimeWarning; see read_surface. Raises MeshError (a file or surface that cannot serve,
    a size that does not fit the gripper) or InvalidValueError.
    """
    import trimesh

    positive("scale", scale)
    if pieces < 1 or int(pieces) != pieces:
        raise MeshError(f"pieces {pieces}: give a whole number, 1 for the convex hull")
    compile_beside("thermograsp.envs.sensing.mesh_ahead", gas_around.called(), crossed_above)
    surface = read_surface(str(path))
    mesh = trimesh.Trimesh(surface.vertices * scale, surface.faces, process=False)
    _check_size(path, mesh.extents, scale)
    origin = -mesh.bounds.mean(axis=0)
    mesh.apply_translation(origin)
    return MeshShape(
        path=str(path),
        scale=float(scale),
        pieces=int(pieces),
        origin=_triple(origin),
        extents=_triple(mesh.extents),
        volume=float(mesh.volume),
        centre_of_mass=_triple(mesh.center_mass),
        unit_inertia=tuple(_triple(row) for row in mesh.moment_inertia / mesh.mass),
        hulls=_hulls(mesh, int(pieces)),
        surface=(np.array(mesh.vertices, float), np.array(mesh.faces, np.int64)),
    )


def _triple(values: np.ndarray) -> tuple[float, float, float]:
    x, y, z = (float(v) for v in values)
    return x, y, z


def _check_size(path: str, extents: np.ndarray, scale: float) -> None:
    across = min(extents[0], extents[1])

    def fits(factor: float, smallest: float = SMALLEST) -> bool:
        return factor * min(extents) >= smallest and factor * across <= LARGEST

    if fits(1.0):
        return
    shown = " x ".join(f"{1e3 * e:.4g}" for e in extents)
    advice = [f"scale {scale * f:g} (a file in {unit})" for f, unit in _UNITS if fits(f, 2 * SMALLEST)]
    if not advice and fits(0.04 / across):
        advice.append(f"scale {scale * 0.04 / across:.3g} (40 mm wide)")
    raise MeshError(
        f"{path}: {shown} mm at scale {scale:g} does not fit the gripper ({1e3 * SMALLEST:.0f} mm at least, "
        f"{1e3 * LARGEST:.0f} mm at most between the fingers); try {' or '.join(advice) or 'another object'}"
    )


def _hulls(mesh, pieces: int) -> tuple[tuple[np.ndarray, np.ndarray], ...]:
    if pieces == 1:
        parts = [mesh.convex_hull]
    else:
        try:
            parts = [
                _hull(part) for part in mesh.convex_decomposition(maxConvexHulls=pieces, resolution=_VOXELS)
            ]
        except ImportError as error:
            raise MissingDependencyError(
                f"convex pieces need vhacdx: {install('mesh')}, or use pieces=1"
            ) from error
    return tuple((np.array(p.vertices, dtype=float), np.array(p.faces, dtype=np.int32)) for p in parts)


def _hull(part):
    """trimesh 5 gives meshes or keyword dictionaries, depending on the entry point."""
    import trimesh

    return part.convex_hull if hasattr(part, "convex_hull") else trimesh.Trimesh(**part).convex_hull


__all__ = ["FORMATS", "MeshShape", "load_mesh"]
