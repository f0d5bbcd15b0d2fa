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
    touched = [side for each in _both(pad, spec) if (side := _side(pad, each, forces)) is not None]
    if not touched:
        return None
    return ContactArea(*np.mean([side[:3] for side in touched], axis=0))


def is_mesh_contact(pad: Pad, spec: ObjectSpec) -> bool:
    """Whether either of those pads meets the mesh."""
    return any(_seen(each) is not None for each in _both(pad, spec))


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
    every = (_beside(pad, each, forces, sides) for each in _both(pad, spec))
    touched = np.mean([side for side in every if side is not None], axis=0)
    return AroundFace(touched[5:].reshape(len(sides), 2, len(forces)), touched[:5].T)


class _Closing(NamedTuple):
    """A pad of that width m that closes on a mesh along x (side 1), or against it (-1). position (2,) m and yaw rad of
    the mesh between the pads. height: m, the pads' middles above the mesh's."""

    width: float
    shape: MeshShape
    position: tuple[float, float]
    yaw: float
    height: float
    side: int


def _both(pad: Pad, spec: ObjectSpec) -> list[_Closing]:
    place = spec.position, spec.yaw, spec.grasp_height - spec.size[2] / 2
    return [_Closing(pad.width, spec.geometry, *place, side) for side in (1, -1)]


class _Seen(NamedTuple):
    """A mesh as a pad sees it. frame: (4, 3) the pad's middle m, normal and two axes. coarse, fine: heights (n,) m of
    the mesh at the places of _springs, and how far it covers them."""

    frame: np.ndarray
    coarse: tuple[np.ndarray, np.ndarray]
    fine: tuple[np.ndarray, np.ndarray]


@lru_cache(maxsize=8)
def _seen(closing: _Closing) -> _Seen | None:
    """None where the pad meets nothing."""
    width, shape, position, yaw, height, side = closing
    cos, sin = math.cos(yaw), math.sin(yaw)
    x, y = position
    normal = np.array([side * cos, -side * sin, 0.0])
    across = np.array([side * sin, side * cos, 0.0])
    middle = np.array([-x * cos - y * sin, x * sin - y * cos, height])
    frame, height_map = np.stack([middle, normal, across, (0.0, 0.0, 1.0)]), mesh_map(shape, normal)
    coarse = _sampled(width, frame, height_map, _POINTS)
    if not coarse[1].any():
        return None
    return _Seen(frame, coarse, _sampled(width, frame, height_map, _POINTS * _FINER))


def _sampled(
    width: float, frame: np.ndarray, height_map: HeightMap, count: int
) -> tuple[np.ndarray, np.ndarray]:
    """The mesh's heights m and coverage (n,) at count^2 places of a pad."""
    places = square_middles(width, count)
    height, cover = np.zeros(len(places)), np.zeros(len(places))
    map_heights(*height_map, frame, places, height, cover)
    return height, cover


class _Springs(NamedTuple):
    """Of a pad. places: (n, 2) m of so many squares each way. within, stiffer: as face_springs has them."""

    places: np.ndarray
    within: np.ndarray
    stiffer: np.ndarray


@lru_cache(maxsize=8)
def _springs(pad: Pad, count: int) -> _Springs:
    places = square_middles(pad.width, count)
    return _Springs(places, *face_springs(pad, places, pad.width / count))


@lru_cache(maxsize=16)
def _aligned(
    pad: Pad, closing: _Closing, forces: tuple[float, ...]
) -> list[tuple[float, float, float]] | None:
    """How a pad has aligned itself with a mesh at each of these forces N above 0: depth m and tilts along both axes.
    None where it meets nothing."""
    if (seen := _seen(closing)) is None:
        return None
    places, _, stiffer = _springs(pad, _POINTS)
    surface, cover = seen.coarse
    springs, area = cover * stiffer, (pad.width / _POINTS) ** 2
    stiffness = pad.foundation_modulus / pad.thickness
    centre = cover @ places / cover.sum()
    pressure = np.zeros(len(places))
    return [
        pressure_map(surface, springs, places, area, stiffness, pad.thickness, force, centre, pressure)
        for force in forces
    ]


@lru_cache(maxsize=512)
def _side(pad: Pad, closing: _Closing, forces: tuple[float, ...]) -> np.ndarray | None:
    """(3, n): m2 on the pad, m2 on the face, N on the face; None where the pad meets nothing."""
    seen, aligned = _seen(closing), _aligned(pad, closing, forces)
    if seen is None or aligned is None:
        return None
    pitch, springs = pad.width / (_POINTS * _FINER), _springs(pad, _POINTS * _FINER)
    contacts = []
    for force, sunk in zip(forces, aligned, strict=True):
        found = _touched(springs.places, *seen.fine, springs.within, springs.stiffer, pad.face_ratio, *sunk)
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
def _beside(
    pad: Pad, closing: _Closing, forces: tuple[float, ...], rings: tuple[float, ...]
) -> np.ndarray | None:
    """(5 + 2 R, n) of the same pad: AroundFace's lying, then m2 and N on each ring up to these outer sides m."""
    seen, aligned = _seen(closing), _aligned(pad, closing, forces)
    if seen is None or aligned is None:
        return None
    pitch, (fine, within, stiffer) = pad.width / (_POINTS * _FINER), _springs(pad, _POINTS * _FINER)
    away, on_face = np.abs(fine).max(axis=1), within > 0
    beside = [(away > inner / 2) & (away < outer / 2) for inner, outer in pairwise((pad.face, *rings))]
    outline = closing.shape.surface[0] @ seen.frame[2:].T
    spans = np.ptp(outline, axis=0) + pad.face
    place = (seen.frame[2:] @ seen.frame[0] - outline.min(axis=0) + pad.face / 2).tolist()
    y, z = fine[on_face].T
    powers, contacts = np.stack((np.ones(len(y)), y, z, y * y, y * z, z * z)), []
    heights, covered = seen.fine
    for force, (depth, tilt, other) in zip(forces, aligned, strict=True):
        sunk = depth + tilt * fine[:, 0] + other * fine[:, 1] - heights
        touched = np.where(sunk > 0, covered, 0.0)
        pressed, lies = touched * sunk * stiffer, np.zeros(5)
        moments = Moments(*(powers @ (touched * within)[on_face] * pitch**2).tolist())
        lie(moments, pitch**2, *place, spans, pad.face, pad.sensor_width, 0.0, lies)
        contact = [lies[4] / math.sqrt(moments.s) if moments.s > 0 else 1.0, *lies[:4]]
        for ring in beside:
            contact += [touched[ring].sum() * pitch**2, pressed[ring].sum() / pressed.sum() * force]
        contacts.append(contact)
    return np.array(contacts).T
