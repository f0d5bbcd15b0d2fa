"""What a pad meets of a mesh, by force: the contact's area and the sensor's share, from how the mesh presses the pad.

The mesh is pressed on the pad's elastic foundation (thermal/pressed) with the force's centre in the middle of what of
it is before the pad, as pads that give way align themselves. Area counts where there is pressure and the mesh covers
the pad: the crests of a thread, the teeth of a gear, a face up to its edge.
"""

from __future__ import annotations

import math
from functools import lru_cache

import numpy as np

from thermograsp.compiled import njit

from ...thermal import ContactArea, Pad
from ...thermal.pressed import HeightMap, face_springs, map_heights, pressure_map, square_middles
from ..bodies import MeshShape, ObjectSpec
from .surface_height import mesh_map

_POINTS = 80  # along the pad's side, of the foundation
_FINER = 3  # times as many, of what is touched


def mesh_contact(pad: Pad, spec: ObjectSpec, forces: tuple[float, ...]) -> ContactArea | None:
    """What pads that close on a mesh along x, at its place and angle, touch at these forces N above 0, the mean of
    those of the two that meet it; None where neither does. Arrays (n,)."""
    height = spec.grasp_height - spec.size[2] / 2
    sides = (_side(pad, spec.geometry, spec.position, spec.yaw, height, forces, side) for side in (1, -1))
    touched = [side for side in sides if side is not None]
    if not touched:
        return None
    return ContactArea(*np.mean(touched, axis=0))


@lru_cache(maxsize=512)
def _side(
    pad: Pad,
    shape: MeshShape,
    position: tuple[float, float],
    yaw: float,
    height: float,
    forces: tuple[float, ...],
    side: int,
) -> np.ndarray | None:
    """(3, n): m2 on the pad, m2 on the face, N on the face, of the pad whose normal is along x, or against it; None
    where it meets nothing."""
    cos, sin = math.cos(yaw), math.sin(yaw)
    x, y = position
    normal = np.array([side * cos, -side * sin, 0.0])
    across = np.array([side * sin, side * cos, 0.0])
    middle = np.array([-x * cos - y * sin, x * sin - y * cos, height])
    frame = np.stack([middle, normal, across, (0.0, 0.0, 1.0)])
    height_map = mesh_map(shape, normal)
    places, surface, cover = _sampled(pad, frame, height_map, _POINTS)
    if not cover.any():
        return None
    area = (pad.width / _POINTS) ** 2
    _, stiffer = face_springs(pad, places, pad.width / _POINTS)
    springs = cover * stiffer
    stiffness = pad.foundation_modulus / pad.thickness
    centre = cover @ places / cover.sum()
    pressure = np.zeros(len(places))
    fine, heights, covered = _sampled(pad, frame, height_map, _POINTS * _FINER)
    pitch = pad.width / (_POINTS * _FINER)
    within, stiffer = face_springs(pad, fine, pitch)
    contacts = []
    for force in forces:
        depth, tilt, other = pressure_map(
            *(surface, springs, places, area, stiffness, pad.thickness, force, centre, pressure)
        )
        found = _touched(fine, heights, covered, within, stiffer, pad.face_ratio, depth, tilt, other)
        contacts.append([found[0] * pitch**2, found[1] * pitch**2, found[2] * force])
    return np.array(contacts).T


@njit(cache=True, error_model="numpy")
def _touched(places, heights, cover, within, stiffer, face_ratio, depth, tilt, other):
    """(points that touch, those on the face, the share of the force on it) of a surface sunk and tilted by so much."""
    whole, face, total, on_face = 0.0, 0.0, 0.0, 0.0
    for i in range(len(heights)):
        sunk = depth + tilt * places[i, 0] + other * places[i, 1] - heights[i]
        if sunk > 0.0:
            whole += cover[i]
            face += cover[i] * within[i]
            total += cover[i] * sunk * stiffer[i]
            on_face += cover[i] * sunk * face_ratio * within[i]
    return whole, face, on_face / total


def _sampled(
    pad: Pad, frame: np.ndarray, height_map: HeightMap, count: int
) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Places (n, 2) m, count^2 of the pad, and the mesh's heights m and coverage there."""
    places = square_middles(pad.width, count)
    height, cover = np.zeros(len(places)), np.zeros(len(places))
    map_heights(*height_map, frame, places, height, cover)
    return places, height, cover
