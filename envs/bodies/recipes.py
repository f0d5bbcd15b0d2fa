"""How the objects of the library are made: a recipe's parameters in, a solid out.

Lengths in m. A recipe's origin is where the fingers close on it along x; z points up.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping, Sequence
from types import MappingProxyType
from typing import Any, Literal, NamedTuple

import numpy as np

from thermograsp.errors import InvalidValueError, length, non_negative, positive, unknown_name

from .solids import (
    Triangles,
    cut,
    ellipsoid,
    joined,
    lofted,
    smoothed,
    turned,
    turned_with_handle,
)

Profile = Sequence[Sequence[float]]
Axis = Literal["x", "y", "z"]


class Solid(NamedTuple):
    """What a recipe makes. shape: box, cylinder or sphere of that size (x, y, z) m, or a mesh, its surface. hollow:
    profile (k, 2) of radius and height, m, of what can hold something, from its lowest point up."""

    shape: Literal["box", "cylinder", "sphere", "mesh"]
    size: tuple[float, float, float]
    surface: Triangles | None = None
    hollow: np.ndarray | None = None

    def room(self, level: float) -> float:
        """m3 of the hollow up to that share of its height. Raises InvalidValueError where there is none."""
        radius, height = self._filled(level)
        slices = radius[1:] ** 2 + radius[1:] * radius[:-1] + radius[:-1] ** 2
        return float(np.sum(math.pi / 3 * np.diff(height) * slices))

    def wetted(self, level: float) -> float:
        """m2 of wall and bottom that contents up to that share of the hollow's height touch."""
        radius, height = self._filled(level)
        slant = np.hypot(np.diff(radius), np.diff(height))
        return float(np.sum(math.pi * (radius[1:] + radius[:-1]) * slant))

    def _filled(self, level: float) -> tuple[np.ndarray, np.ndarray]:
        """Radii and heights of what is filled, from its lowest point to its surface."""
        if self.hollow is None:
            raise InvalidValueError("it has contents but is not hollow: make it a vessel or a shell")
        radius, height = self.hollow.T
        top = height[0] + level * (height[-1] - height[0])
        under = height < top
        return np.append(radius[under], np.interp(top, height, radius)), np.append(height[under], top)


def make(recipe: str, parameters: Mapping[str, Any]) -> Solid:
    """The solid. Raises UnknownNameError (recipe), InvalidValueError (parameters)."""
    if recipe not in RECIPES:
        raise unknown_name("recipe", recipe, RECIPES)
    try:
        return RECIPES[recipe](**parameters)
    except TypeError as error:
        raise InvalidValueError(f"recipe {recipe!r}: {error}") from None


def box(size: Sequence[float]) -> Solid:
    """A box of that size (x, y, z)."""
    return Solid("box", _size(size))


def cylinder(diameter: float, height: float) -> Solid:
    """A standing cylinder."""
    return Solid("cylinder", _size((diameter, diameter, height)))


def sphere(diameter: float) -> Solid:
    """A ball."""
    return Solid("sphere", _size((diameter,) * 3))


def ellipsoid_(size: Sequence[float]) -> Solid:
    """An ellipsoid with these full axes (x, y, z)."""
    return _mesh(ellipsoid(_size(size)))


def egg(length: float, width: float, taper: float) -> Solid:
    """An egg that lies along y; its radius at u in -1 .. 1 along its length is width/2 sqrt(1 - u^2) (1 - taper u)."""
    u = -np.cos(np.linspace(0.0, np.pi, 49))
    radius = width / 2 * np.sqrt(1 - u**2) * (1 - taper * u)
    radius[[0, -1]] = 0.0
    return _mesh(turned(np.stack([radius, length / 2 * u], axis=1)).along("y"))


def hollow_ball(diameter: float, wall: float) -> Solid:
    """A closed shell."""
    inside = positive("diameter - 2 wall (m)", diameter - 2 * wall)
    outer, inner = (ellipsoid((width, width, width)) for width in (diameter, inside))
    return _mesh(joined(outer, inner.flipped()))


def turned_(profile: Profile, smooth: bool = False, axis: Axis = "z") -> Solid:
    """Radii and heights from one end to the other, turned about an axis; the ends are closed flat. smooth: on a curve
    through the points. Lying, its middle is the origin."""
    points = _closed_ends(smoothed(_points(profile)) if smooth else _points(profile))
    if axis != "z":
        points[:, 1] -= points[:, 1].mean() if len(points) == 2 else (points[0, 1] + points[-1, 1]) / 2
    return _mesh(turned(points).along(axis))


def tube(outer: float, inner: float, length: float, axis: Axis = "z", sides: int = 0) -> Solid:
    """A tube of these diameters; sides: a prism outside, its flats that far apart, such as a nut."""
    if not 0 < inner < outer:
        raise InvalidValueError(f"tube: inner diameter {inner} m must be above 0 and below outer, {outer} m")
    half = length / 2
    ring = turned(
        np.array([[inner / 2, -half], [outer / 2, -half], [outer / 2, half], [inner / 2, half]]), sides
    )
    return _mesh(ring.along(axis))


def vessel(
    profile: Profile, wall: float, base: float | None = None, handle: Mapping[str, float] | None = None
) -> Solid:
    """A vessel, open at the top. profile: of its outside, from the bottom's rim up. base: thickness of the bottom (the
    wall's where nothing is said). handle: low, high, thickness, reach, see solids.turned_with_handle."""
    outside = np.concatenate([[[0.0, 0.0]], _points(profile)])
    inside = _inset(outside, wall, wall if base is None else base)
    steep = np.diff(outside[-2:], axis=0)[0]
    inside[-1] = (outside[-1, 0] - wall * math.hypot(*steep) / steep[1], outside[-1, 1])
    whole = np.concatenate([outside, inside[::-1]])
    made = turned_with_handle(whole, **handle) if handle else turned(whole)
    return _mesh(made, inside)


def shell(profile: Profile, wall: float) -> Solid:
    """Closed on all sides, such as a can. profile: of its outside, from the bottom's rim to the top's."""
    outside = _closed_ends(_points(profile))
    inside = _inset(outside, wall, wall)
    return _mesh(joined(turned(outside), turned(inside).flipped()), inside)


def lofted_(sections: Sequence[Sequence[float]], roundness: float = 2.0) -> Solid:
    """See solids.lofted."""
    return _mesh(lofted(np.array(sections, float), roundness))


def cut_(outline: Sequence[Sequence[float]], thickness: float) -> Solid:
    """See solids.cut."""
    return _mesh(cut(np.array(outline, float), thickness))


RECIPES: Mapping[str, Callable[..., Solid]] = MappingProxyType(
    {
        "box": box,
        "cylinder": cylinder,
        "sphere": sphere,
        "ellipsoid": ellipsoid_,
        "egg": egg,
        "hollow_ball": hollow_ball,
        "turned": turned_,
        "tube": tube,
        "vessel": vessel,
        "shell": shell,
        "lofted": lofted_,
        "cut": cut_,
    }
)


def _size(size: Sequence[float]) -> tuple[float, float, float]:
    x, y, z = (length("size (m)", side) for side in size)
    return x, y, z


def _mesh(surface: Triangles, hollow: np.ndarray | None = None) -> Solid:
    x, y, z = surface.extents.tolist()
    return Solid("mesh", (x, y, z), surface, hollow)


def _points(profile: Profile) -> np.ndarray:
    points = np.array(profile, float)
    if points.ndim != 2 or points.shape[1] != 2 or len(points) < 2:
        raise InvalidValueError(f"profile must list two or more [radius, height], got {profile!r}")
    for radius in points[:, 0]:
        non_negative("radius (m)", float(radius))
    return points


def _closed_ends(points: np.ndarray) -> np.ndarray:
    """With flat ends from the axis and back to it."""
    first = [[0.0, points[0, 1]]] if points[0, 0] > 0 else []
    last = [[0.0, points[-1, 1]]] if points[-1, 0] > 0 else []
    return np.concatenate([np.reshape(first, (-1, 2)), points, np.reshape(last, (-1, 2))])


def _inset(outside: np.ndarray, wall: float, base: float) -> np.ndarray:
    """The profile moved inwards: its first piece, the bottom, by base, the others by wall."""
    along = np.diff(outside, axis=0)
    normals = np.stack([along[:, 1], -along[:, 0]], axis=1) / np.linalg.norm(along, axis=1)[:, None]
    depths = np.full(len(along), positive("wall (m)", wall))
    depths[0] = positive("base (m)", base)
    inside = [outside[0] - depths[0] * normals[0]]
    for k in range(1, len(outside) - 1):
        pair = normals[k - 1 : k + 1]
        if abs(np.linalg.det(pair)) > 1e-3:
            inside.append(outside[k] - np.linalg.solve(pair, depths[k - 1 : k + 1]))
        else:
            inside.append(outside[k] - depths[k] * normals[k])
    inside.append(outside[-1] - depths[-1] * normals[-1])
    moved = np.array(inside)
    if not (moved[1:-1, 0] > 0).all():
        raise InvalidValueError(f"a wall of {wall} m leaves no hollow in {outside.tolist()}")
    return moved
