"""Closed surfaces of everyday shapes as triangles: turned on a lathe, skinned over sections, with a handle.

A surface is (vertices (n, 3) m, triangles (m, 3)), counter-clockwise seen from outside. The same arguments give the
same bits. Circles become polygons of the circle's area, so that volumes of what is turned are those of the true solid.
"""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np

from thermograsp.errors import InvalidValueError

SEGMENTS = 144
"""Corners of a full circle: on a radius of 33 mm they are flat to 0.01 mm."""
_HANDLE_SEGMENTS = 6  # of the circle, that a handle is wide
_HANDLE_STATIONS = 24


class Triangles(NamedTuple):
    """A surface. vertices: (n, 3) m. faces: (m, 3), indices of corners."""

    vertices: np.ndarray
    faces: np.ndarray

    @property
    def volume(self) -> float:
        """m3 enclosed; below 0 where faces look inwards (divergence theorem)."""
        a, b, c = (self.vertices[self.faces[:, i]] for i in range(3))
        return float(np.einsum("ij,ij->", a, np.cross(b, c)) / 6)

    @property
    def extents(self) -> np.ndarray:
        """(3,) m, of the bounding box."""
        return np.ptp(self.vertices, axis=0)

    def outward(self) -> Triangles:
        """The same surface seen from outside."""
        return self if self.volume >= 0 else self.flipped()

    def flipped(self) -> Triangles:
        """The same surface seen from the other side."""
        return Triangles(self.vertices, self.faces[:, ::-1].copy())

    def along(self, axis: str) -> Triangles:
        """The same surface with its z axis turned to x or y, by a rotation."""
        order = {"z": (0, 1, 2), "x": (2, 0, 1), "y": (1, 2, 0)}[axis]
        return Triangles(self.vertices[:, order].copy(), self.faces)


def joined(*surfaces: Triangles) -> Triangles:
    """Several surfaces that do not touch, such as a wall's outside and, flipped, its inside."""
    counts = np.cumsum([0] + [len(surface.vertices) for surface in surfaces])
    return Triangles(
        np.concatenate([surface.vertices for surface in surfaces]),
        np.concatenate([surface.faces + first for surface, first in zip(surfaces, counts, strict=False)]),
    )


def turned(profile: np.ndarray, sides: int = 0) -> Triangles:
    """A profile (k, 2) of radius and height, m, turned about z. It leads from the axis to the axis, or is a closed loop
    off the axis, which makes a ring. sides: the widest points lie on a prism of so many sides instead of on a circle
    (6: a nut); their radius is half its width across flats."""
    vertices, faces, _ = _rings(profile, sides)
    return Triangles(vertices, faces).outward()


def turned_with_handle(
    profile: np.ndarray, low: float, high: float, thickness: float, reach: float
) -> Triangles:
    """The same with a handle on the +y side, from height low to high (the middles of its ends), m. thickness: m, in the
    plane of its bow. reach: m from the outer wall to the handle's middle line. The profile begins at the bottom of the
    outside, which is vertical or nearly where the handle meets it."""
    half = thickness / 2
    levels = (low - half, low + half, high - half, high + half)
    profile = _with_levels(np.asarray(profile, float), levels)
    vertices, faces, first = _rings(profile, 0)
    rings = [first[_outer_at(profile, level)] for level in levels]
    middle = SEGMENTS // 4  # the corner on +y
    columns = np.arange(middle - _HANDLE_SEGMENTS // 2, middle + _HANDLE_SEGMENTS // 2 + 1)
    faces = _without_patches(faces, [rings[0], rings[2]], [rings[1], rings[3]], columns)
    # A loop around a patch: along its lower edge and back along its upper one.
    lower = np.concatenate([rings[0] + columns, (rings[1] + columns)[::-1]])
    upper = np.concatenate([rings[3] + columns, (rings[2] + columns)[::-1]])
    across = vertices[lower, 0]
    edge = np.where(np.arange(len(lower)) < len(columns), -half, half)
    wall = 0.5 * (vertices[lower, 1].mean() + vertices[upper, 1].mean())
    bow = []
    for turn in np.linspace(0.0, math.pi, _HANDLE_STATIONS + 2)[1:-1]:
        y = wall + reach * math.sin(turn) - edge * math.sin(turn)
        z = (low + high) / 2 - (high - low) / 2 * math.cos(turn) + edge * math.cos(turn)
        bow.append(np.stack([across, y, z], axis=1))
    count = len(vertices)
    loops = [lower, *(count + len(lower) * k + np.arange(len(lower)) for k in range(len(bow))), upper]
    sides = [_band(a, b, closed=True) for a, b in zip(loops, loops[1:], strict=False)]
    return Triangles(np.concatenate([vertices, *bow]), np.concatenate([faces, *sides])).outward()


def skinned(loops: np.ndarray) -> Triangles:
    """A skin over k loops of m corners (k, m, 3), m, closed by flat fans at both ends."""
    count, corners = loops.shape[:2]
    ring = np.arange(corners)
    bands = [_band(ring + corners * i, ring + corners * (i + 1), closed=True) for i in range(count - 1)]
    last = corners * (count - 1)
    middles = np.stack([loops[0].mean(axis=0), loops[-1].mean(axis=0)])
    first_fan = _fan(count * corners, ring[::-1])
    last_fan = _fan(count * corners + 1, ring + last)
    vertices = np.concatenate([loops.reshape(-1, 3), middles])
    return Triangles(vertices, np.concatenate([*bands, first_fan, last_fan])).outward()


def lofted(sections: np.ndarray, roundness: float = 2.0) -> Triangles:
    """A skin over sections (k, 4) along y: place y, width along x, height along z and the height of its middle, m. Each
    is the superellipse |2x/w|^roundness + |2z/h|^roundness = 1 (2: an ellipse)."""
    angle = 2 * np.pi * (np.arange(SEGMENTS) + 0.5) / SEGMENTS
    x, z = (np.sign(f) * np.abs(f) ** (2 / roundness) / 2 for f in (np.cos(angle), np.sin(angle)))
    area = np.abs(np.sum(x * np.roll(z, -1) - z * np.roll(x, -1))) / 2
    fit = math.sqrt(_superellipse(roundness) / area)
    loops = [
        np.stack([w * fit * x, np.full(SEGMENTS, y), m + h * fit * z], axis=1) for y, w, h, m in sections
    ]
    return skinned(np.array(loops))


def cut(outline: np.ndarray, thickness: float) -> Triangles:
    """A plate of that thickness m along x. outline: (k, 3) along y: place y, lowest and highest z, m."""
    half = thickness / 2
    loops = [[[-half, y, a], [half, y, a], [half, y, b], [-half, y, b]] for y, a, b in outline]
    return skinned(np.array(loops, float))


def ellipsoid(size: tuple[float, float, float]) -> Triangles:
    """An ellipsoid with these full axes (x, y, z), m, and the volume of the true one."""
    angle = np.linspace(0.0, np.pi, SEGMENTS // 3 + 1)
    profile = np.stack([np.sin(angle), -np.cos(angle)], axis=1) / 2
    profile[[0, -1], 0] = 0.0
    unit = turned(profile)
    fit = (math.pi / 6 / unit.volume) ** (1 / 3)
    return Triangles(unit.vertices * fit * np.asarray(size), unit.faces)


def smoothed(profile: np.ndarray) -> np.ndarray:
    """(P, 2) at least 40 points on a curve through the profile's that never overshoots them (monotone cubics over the
    chord length; Fritsch & Carlson 1980, SIAM J. Numer. Anal. 17:238)."""
    from scipy.interpolate import PchipInterpolator

    steps = np.linalg.norm(np.diff(profile, axis=0), axis=1)
    chord = np.concatenate([[0.0], np.cumsum(steps)])
    at = np.unique(np.concatenate([np.linspace(0.0, chord[-1], 40), chord]))
    curve = PchipInterpolator(chord, profile)(at)
    curve[:, 0] = np.where(curve[:, 0] < 1e-9, 0.0, curve[:, 0])
    return curve


def _superellipse(roundness: float) -> float:
    """Area of |2x|^n + |2z|^n = 1."""
    n = roundness
    return math.gamma(1 + 1 / n) ** 2 / math.gamma(1 + 2 / n)


def _rings(profile: np.ndarray, sides: int) -> tuple[np.ndarray, np.ndarray, list[int]]:
    """Vertices, faces, and each profile point's first vertex; a point on the axis is one vertex, others SEGMENTS."""
    profile = np.asarray(profile, float)
    angle = 2 * np.pi * np.arange(SEGMENTS) / SEGMENTS
    step = 2 * np.pi / SEGMENTS
    circle = np.stack([np.cos(angle), np.sin(angle)], axis=1)
    round_, prism = circle * math.sqrt(step / math.sin(step)), circle
    if sides:
        flat = 2 * np.pi / sides
        if SEGMENTS % (2 * sides):
            raise InvalidValueError(f"{sides} sides: give a number of which {SEGMENTS // 2} is a multiple")
        prism = circle / np.cos((angle + flat / 2) % flat - flat / 2)[:, None]  # a flat on +x
    vertices, faces, first = [], [], []
    count, widest = 0, profile[:, 0].max()
    for r, z in profile:
        first.append(count)
        around = prism if sides and r == widest else round_
        ring = np.column_stack([r * around, np.full(SEGMENTS, z)]) if r > 0 else np.array([[0.0, 0.0, z]])
        vertices.append(ring)
        count += len(ring)
    ring = np.arange(SEGMENTS)
    pairs = list(zip(range(len(profile) - 1), range(1, len(profile)), strict=True))
    if profile[0, 0] > 0:  # a loop
        pairs.append((len(profile) - 1, 0))
    for i, j in pairs:
        if profile[i, 0] > 0 and profile[j, 0] > 0:
            faces.append(_band(first[i] + ring, first[j] + ring, closed=True))
        elif profile[j, 0] > 0:
            faces.append(_fan(first[i], (first[j] + ring)[::-1]))
        elif profile[i, 0] > 0:
            faces.append(_fan(first[j], first[i] + ring))
    return np.concatenate(vertices), np.concatenate(faces), first


def _band(a: np.ndarray, b: np.ndarray, closed: bool) -> np.ndarray:
    """Triangles between two rows of vertices of one length."""
    if closed:
        a, b = np.append(a, a[0]), np.append(b, b[0])
    first = np.stack([a[:-1], a[1:], b[1:]], axis=1)
    second = np.stack([a[:-1], b[1:], b[:-1]], axis=1)
    return np.concatenate([first, second])


def _fan(middle: int, ring: np.ndarray) -> np.ndarray:
    return np.stack([np.full(len(ring), middle), ring, np.roll(ring, -1)], axis=1)


def _with_levels(profile: np.ndarray, levels: tuple[float, ...]) -> np.ndarray:
    """The profile with points at these heights of its outside, and none in between an end's two."""
    top = int(np.argmax(profile[:, 1]))
    outside, rest = profile[: top + 1], profile[top + 1 :]
    rising = outside[1:]  # the first is on the axis
    between = [(levels[0], levels[1]), (levels[2], levels[3])]
    kept = [point for point in rising if not any(low <= point[1] <= high for low, high in between)]
    added = [(np.interp(level, rising[:, 1], rising[:, 0]), level) for level in levels]
    ordered = sorted((tuple(point) for point in [*kept, *added]), key=lambda point: point[1])
    return np.concatenate([outside[:1], np.array(ordered), rest])


def _outer_at(profile: np.ndarray, level: float) -> int:
    """Index of the first point, on the way up, at that height."""
    return int(np.flatnonzero(profile[:, 1] == level)[0])


def _without_patches(
    faces: np.ndarray, below: list[int], above: list[int], columns: np.ndarray
) -> np.ndarray:
    """The faces but those of the bands from the rings `below` to `above` within the columns."""
    for low, high in zip(below, above, strict=True):
        inside = np.isin(faces, np.concatenate([low + columns, high + columns])).all(axis=1)
        faces = faces[~inside]
    return faces
