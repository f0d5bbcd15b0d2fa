"""What a second process compiles while the first one reads and checks a mesh: what a mesh's contacts and networks need,
and then what any first step does (see ahead.py)."""

from __future__ import annotations

import numpy as np

from ...thermal import SolidPart, SurfacePatch, body_network, material, sensor
from ...thermal.kernels import Resolution, tip
from ...thermal.pressed import pressure_map
from ...thermal.surfaces import Solid
from ...thermal.unrolled import Face, Fineness, Place, local_cells
from . import ahead

_SIDE = 0.01  # m


def compile_ahead() -> None:
    """Calls the functions as for a mesh, but on little: one point of a pad, and a cube."""
    one, middle = np.ones(1), np.zeros(2)
    pressure_map(np.zeros(1), one, np.zeros((1, 2)), 1.0, 1.0, 1.0, 1.0, middle, np.zeros(1))
    body_network(_cube(), (SurfacePatch((0.0, 0.0, _SIDE / 2), (0.0, 0.0, 1.0), 4e-6),), cache=False)
    ahead.compile_ahead()
    _edge()


def _edge() -> None:
    """What a place over an edge needs."""
    stack, half = sensor("seed"), _SIDE / 2
    face = Face(np.array([0.0, half, half]), np.eye(3), np.zeros(2))
    place = Place(face, half, np.array([[half, half], [_SIDE, 0.0]]), _SIDE)
    one = tip(stack, ((0.0, stack.width),) * 2, Resolution(12, 3))
    cube = _cube()
    wet = [np.zeros(len(part.faces), bool) for part in cube.parts]
    local = local_cells(cube, wet, 0.0, place, one, Fineness(_SIDE, _SIDE))
    assert local is not None
    local.kernel(np.ones(1))


def _cube() -> Solid:
    corners = np.array([[i >> 2, i >> 1 & 1, i & 1] for i in range(8)], float)
    sides = [[0, 1, 3, 2], [4, 6, 7, 5], [0, 4, 5, 1], [2, 3, 7, 6], [0, 2, 6, 4], [1, 5, 7, 3]]
    faces = np.array([[a, *pair] for a, b, c, d in sides for pair in ((b, c), (c, d))])
    return Solid((SolidPart((corners - 0.5) * _SIDE, faces, material("glass")),))
