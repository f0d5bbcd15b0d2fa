"""What a pad meets of a mesh, by force: the contact's area and the sensor's share, from how the mesh presses the pad.

The mesh is pressed on the pad's elastic foundation (thermal/pressed) with the force's centre in the middle of what of
it is before the pad, as pads that give way align themselves. Area counts where there is pressure and the mesh covers
the pad: the crests of a thread, the teeth of a gear, a face up to its edge.
"""

from __future__ import annotations

import math
from functools import lru_cache
from itertools import pairwise
from typing import NamedTuple

import numpy as np

from thermograsp.compiled import njit

from ...thermal import ContactArea, Pad
from ...thermal.pressed import (
    HeightMap,
    Moments,
    face_springs,
    lie,
    map_heights,
    pressure_map,
    square_middles,
)
from ..bodies import MeshShape, ObjectSpec
from .surface_height import mesh_map

_POINTS = 80  # along the pad's side, of the foundation
_FINER = 3  # times as many, of what is touched


def mesh_contact(pad: Pad, spec: ObjectSpec, forces: tuple[float, ...]) -> ContactArea | None:
    """What pads that close on a mesh along x, at its place and angle, touch at these forces N above 0, the mean of
    those of the two that meet it; None where neither does. Arrays (n,)."""
    touched = [side for side in map(_side, _both(pad, spec, forces)) if side is not None]
    if not touched:
        return None
    return ContactArea(*np.mean([side[:3] for side in touched], axis=0))


class AroundFace(NamedTuple):
    """What the same pads touch of a mesh around the sensor's face, and where the face's contact lies. rings: (R, 2, n)
    m2 and N of each ring. lying: (n, 5) how long the contact is over the root of its area, and the shares by which it
    lies at an end of the face and of the mesh (thermal/contact/patch_place.py)."""

    rings: np.ndarray
    lying: np.ndarray


def around_face(
    pad: Pad, spec: ObjectSpec, forces: tuple[float, ...], sides: tuple[float, ...]
) -> AroundFace:
    """sides: (R,) m, the outer sides of rings around the face."""
    every = (_beside(closing, sides) for closing in _both(pad, spec, forces))
    touched = np.mean([side for side in every if side is not None], axis=0)
    return AroundFace(touched[5:].reshape(len(sides), 2, len(forces)), touched[:5].T)


class _Closing(NamedTuple):
    """A pad that closes on a mesh along x (side 1), or against it (-1), with these forces N above 0. position (2,) m
    and yaw rad of the mesh between the pads. height: m, the pads' middles above the mesh's."""

    pad: Pad
    shape: MeshShape
    position: tuple[float, float]
    yaw: float
    height: float
    forces: tuple[float, ...]
    side: int


def _both(pad: Pad, spec: ObjectSpec, forces: tuple[float, ...]) -> list[_Closing]:
    place = spec.position, spec.yaw, spec.grasp_height - spec.size[2] / 2
    return [_Closing(pad, spec.geometry, *place, forces, side) for side in (1, -1)]


class _Aligned(NamedTuple):
    """A pad that has aligned itself with a mesh. frame: (4, 3) its middle m, normal and two axes. fine: (n, 2) m, its
    places. heights: (n,) m of the mesh, and covered. sunk: of each force, depth m and tilts along both axes."""

    frame: np.ndarray
    fine: np.ndarray
    heights: np.ndarray
    covered: np.ndarray
    sunk: list[tuple[float, float, float]]

    def touched(self, force: int) -> tuple[np.ndarray, np.ndarray]:
        """(n,) how far the mesh has sunk in, m, and where it touches, at the force of that number."""
        depth, tilt, other = self.sunk[force]
        sunk = depth + tilt * self.fine[:, 0] + other * self.fine[:, 1] - self.heights
        return sunk, np.where(sunk > 0, self.covered, 0.0)


@lru_cache(maxsize=8)
def _aligned(closing: _Closing) -> _Aligned | None:
    """None where the pad meets nothing."""
    pad, shape, position, yaw, height, forces, side = closing
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
    sunk = [
        pressure_map(surface, springs, places, area, stiffness, pad.thickness, force, centre, pressure)
        for force in forces
    ]
    return _Aligned(frame, *_sampled(pad, frame, height_map, _POINTS * _FINER), sunk)


@lru_cache(maxsize=512)
def _side(closing: _Closing) -> np.ndarray | None:
    """(3, n): m2 on the pad, m2 on the face, N on the face; None where the pad meets nothing."""
    pad, forces, aligned = closing.pad, closing.forces, _aligned(closing)
    if aligned is None:
        return None
    pitch = pad.width / (_POINTS * _FINER)
    within, stiffer = face_springs(pad, aligned.fine, pitch)
    contacts = []
    for force, sunk in zip(forces, aligned.sunk, strict=True):
        found = _touched(
            *(aligned.fine, aligned.heights, aligned.covered, within, stiffer, pad.face_ratio, *sunk)
        )
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


@lru_cache(maxsize=512)
def _beside(closing: _Closing, rings: tuple[float, ...]) -> np.ndarray | None:
    """(5 + 2 R, n) of the same pad: AroundFace's lying, then m2 and N on each ring up to these outer sides m."""
    pad, shape, forces, aligned = closing.pad, closing.shape, closing.forces, _aligned(closing)
    if aligned is None:
        return None
    pitch, fine = pad.width / (_POINTS * _FINER), aligned.fine
    within, stiffer = face_springs(pad, fine, pitch)
    away, on_face = np.abs(fine).max(axis=1), within > 0
    beside = [(away > inner / 2) & (away < outer / 2) for inner, outer in pairwise((pad.face, *rings))]
    seen = shape.surface[0] @ aligned.frame[2:].T
    spans = np.ptp(seen, axis=0) + pad.face
    place = (aligned.frame[2:] @ aligned.frame[0] - seen.min(axis=0) + pad.face / 2).tolist()
    y, z = fine[on_face].T
    powers, contacts = np.stack((np.ones(len(y)), y, z, y * y, y * z, z * z)), []
    for number, force in enumerate(forces):
        sunk, touched = aligned.touched(number)
        pressed, lies = touched * sunk * stiffer, np.zeros(5)
        moments = Moments(*(powers @ (touched * within)[on_face] * pitch**2).tolist())
        lie(moments, pitch**2, *place, spans, pad.face, 0.0, lies)
        contact = [lies[4] / math.sqrt(moments.s) if moments.s > 0 else 1.0, *lies[:4]]
        for ring in beside:
            contact += [touched[ring].sum() * pitch**2, pressed[ring].sum() / pressed.sum() * force]
        contacts.append(contact)
    return np.array(contacts).T


def _sampled(
    pad: Pad, frame: np.ndarray, height_map: HeightMap, count: int
) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Places (n, 2) m, count^2 of the pad, and the mesh's heights m and coverage there."""
    places = square_middles(pad.width, count)
    height, cover = np.zeros(len(places)), np.zeros(len(places))
    map_heights(*height_map, frame, places, height, cover)
    return places, height, cover
