"""What the page draws: the geoms of a MuJoCo model as plain data, and the poses of its bodies."""

# mujoco ships no type stubs for its compiled names
# pyright: reportAttributeAccessIssue=false

from __future__ import annotations

from typing import Any

import mujoco
import numpy as np

from thermograsp.envs.limits import TIPS
from thermograsp.envs.mechanics import element_geom

_KINDS = {
    mujoco.mjtGeom.mjGEOM_BOX: "box",
    mujoco.mjtGeom.mjGEOM_CYLINDER: "cylinder",
    mujoco.mjtGeom.mjGEOM_SPHERE: "sphere",
    mujoco.mjtGeom.mjGEOM_MESH: "mesh",
}
_DEFAULT_RGBA = (0.5, 0.5, 0.5, 1.0)  # of a geom that takes its material's, MuJoCo's rule
_GLOSS = 0.3
_PADS = frozenset(f"pad_{tip}" for tip in TIPS)
_SEEN_THROUGH = 0.3  # alpha of the pads, which hide the sensors behind them
_LEFT_OUT = ("pedestal",)


def shapes_of(model: mujoco.MjModel, objects: tuple[str, ...]) -> list[dict[str, Any]]:
    """The visible geoms but the floor: kind, body (its index), place (3,) m and turn (w, x, y, z) in the body's frame,
    size (3,) m as MuJoCo has it, colour (3,) sRGB in 0..1, gloss and alpha 0..1, part (the name by which a temperature
    colours it; an object's geoms have the object's), and for a mesh its triangles' corners, vertices (3 n) m."""
    elements = {element_geom(tip, name) for tip in TIPS for name in objects}
    shapes = []
    for at in range(model.ngeom):
        geom = model.geom(at)
        kind = _KINDS.get(int(geom.type[0]))
        rgba, gloss = np.array(geom.rgba), _GLOSS
        if geom.matid[0] >= 0:
            gloss = float(model.mat_specular[geom.matid[0]])
            if np.allclose(rgba, _DEFAULT_RGBA):
                rgba = model.mat_rgba[geom.matid[0]]
        if kind is None or rgba[3] == 0 or geom.name in _LEFT_OUT:
            continue
        body = model.body(geom.bodyid[0]).name
        shape: dict[str, Any] = {
            "kind": kind,
            "body": int(geom.bodyid[0]),
            "place": _short(geom.pos),
            "turn": _short(geom.quat),
            "size": _short(geom.size),
            "colour": _short(rgba[:3]),
            "gloss": gloss,
            "alpha": _SEEN_THROUGH if geom.name in _PADS else 1.0,
            "part": body if body in objects and geom.name not in elements else geom.name,
        }
        if kind == "mesh":
            shape["vertices"] = _corners(model, int(geom.dataid[0]))
        shapes.append(shape)
    return shapes


def poses_of(model: mujoco.MjModel, data: mujoco.MjData) -> list[list[float]]:
    """Position m and quaternion (w, x, y, z) of every body, for the data's qpos."""
    mujoco.mj_kinematics(model, data)
    return np.round(np.hstack((data.xpos, data.xquat)), 6).tolist()


def _corners(model: mujoco.MjModel, mesh: int) -> list[float]:
    first, count = int(model.mesh_vertadr[mesh]), int(model.mesh_vertnum[mesh])
    face, faces = int(model.mesh_faceadr[mesh]), int(model.mesh_facenum[mesh])
    corners = model.mesh_vert[first : first + count][model.mesh_face[face : face + faces]]
    return _short(corners.ravel())


def _short(values: np.ndarray) -> list[float]:
    return np.round(np.asarray(values, float), 6).tolist()
