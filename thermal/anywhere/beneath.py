"""What lies beneath a place on a body's surface: its depth there, its curvature, and where its face ends."""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from functools import cached_property
from operator import mul

import numpy as np

from thermograsp.compiled import njit

from ..meshes import ABOVE, PlacedPatch, place_patch
from ..surfaces import FACING, SurfacePatch, twice_areas

_FAR = 0.05  # m, from where on an end is not felt
_SAMPLES = (1.0, 1.3, 1.7, 2.2, 3.0, 4.0)  # half widths from the middle at which a face is looked for
_BEND = 0.6  # of the half width, where the surface's height tells its curvature
_ASIDE = np.array([1.1e-5, 0.7e-5])  # m, beside edges of triangles
_ALONG, _LEVEL = 0.95, 0.3  # cosine to a face's normal, and half widths from it, for a patch to be on it
FLAT = 1e-3  # 1/m, curvature below which a face is as flat
_EDGE = 1e-9  # of a triangle's side, that a line may lie beyond it
ROUND = 0.33  # curvature times half width, up to which its terms of second order serve
_UNSMOOTH = 0.08  # half widths, by which the surface may differ from its curvature's, as with large facets
_BEYOND, _ENDED = (
    1.5,
    0.5,
)  # half widths from the middle, and to the nearest surface there if the face has ended
_DEEP = 6e-3  # m, depth from which on no difference is felt before the body's modes take over
_UNEVEN = 0.15  # of the depth, by which it may differ around a place
_BASES = 0.5 * np.array(
    [[0, 0], [1, 0], [-1, 0], [0, 1], [0, -1], [1, 1], [1, -1], [-1, 1], [-1, -1]]
)  # half widths from the middle
_AROUND = 0.95 * np.array([[x, y] for x in (-1, 0, 1) for y in (-1, 0, 1) if x or y])  # half widths


@dataclass(frozen=True, eq=False)
class Beneath:
    """What lies beneath a place. depth: m. curvature: (2,) 1/m along its sides. ends: (2, 2) m along each side to where
    the face ends either way, negative where its middle lies beyond. plain: whether it is as a box there, bent a little:
    covered wholly, of one depth, and all of its other side wet or none. wet: whether contents wet that side. within:
    whether they wet the face itself."""

    placed: PlacedPatch
    depth: float
    curvature: np.ndarray
    ends: np.ndarray
    plain: bool
    wet: bool
    within: bool

    @cached_property
    def own(self) -> tuple[int, np.ndarray, np.ndarray] | None:
        """Where the place itself is on that box, as on_box has it."""
        return self.on_box(self.placed)

    @property
    def size(self) -> tuple[float, float, float]:
        """m of the box that stands for it."""
        x, y = self.ends.sum(axis=1)
        return float(x), float(y), self.depth

    def on_box(self, other: PlacedPatch) -> tuple[int, np.ndarray, np.ndarray] | None:
        """The face of that box on which a patch lies, as kernels.Patches has it, with its middle and half widths (2,) m
        there; None where it lies on no face. The curved face is unrolled."""
        # of numbers, as arrays of three take ten times as long
        half, depth, (sides, first, last, curvature) = other.half_width, self.depth, self._numbers
        away = (other.centre - self.placed.centre).tolist()
        looks = other.normal.tolist()
        offset = [sum(map(mul, side, away)) for side in sides]
        along = [sum(map(mul, side, looks)) for side in sides]
        wide = [half, half, half]
        arcs, level, facing = _unrolled(curvature, offset, along)
        if abs(level) < _LEVEL * half and facing > _ALONG:
            offset, along = [*arcs, level], [0.0, 0.0, 1.0]
        elif abs(level + depth) < _LEVEL * half and facing < -_ALONG:
            # as wide there as the wall's other side is shorter
            offset, along = [*arcs, level], [0.0, 0.0, -1.0]
            wide = [*(half / (1 - bend * depth) for bend in curvature), half]
        size = [first[0] + last[0], first[1] + last[1], depth]
        middle = [offset[0] + first[0], offset[1] + first[1], offset[2] + depth]
        axis = max(range(3), key=lambda k: abs(along[k]))
        far = along[axis] > 0
        if (
            abs(along[axis]) < _ALONG
            or abs(middle[axis] - (size[axis] if far else 0.0)) > _LEVEL * half
            or any(not 0 <= middle[k] <= size[k] for k in range(3) if k != axis)
        ):
            return None
        ends = [
            (max(middle[k] - reach, 0.0), min(middle[k] + reach, size[k]))
            for k, reach in zip((k for k in range(3) if k != axis), wide, strict=False)
        ]
        centre = np.array([(low + high) / 2 for low, high in ends])
        return 2 * axis + far, centre, np.array([(high - low) / 2 for low, high in ends])

    @cached_property
    def _numbers(self) -> tuple[list[list[float]], list[float], list[float], list[float]]:
        """The place's sides and normal; m to where its face ends, back and forth along its sides; their curvature."""
        axes = [*self.placed.sides.tolist(), self.placed.normal.tolist()]
        return axes, self.ends[:, 0].tolist(), self.ends[:, 1].tolist(), self.curvature.tolist()


def _unrolled(
    curvature: Sequence[float], offset: Sequence[float], along: Sequence[float]
) -> tuple[list[float], float, float]:
    """Of a point m from a place, along its sides and its normal: how far it is along the curved face (2,) m and above
    it, m, and the cosine between the face's normal there and a unit vector."""
    bends = [FLAT if abs(each) < FLAT else each for each in curvature]
    angles = [
        min(max(math.atan2(bend * aside, 1 + bend * offset[2]), -1.0), 1.0)
        for bend, aside in zip(bends, offset, strict=False)
    ]
    level = offset[2] + sum((1 - math.cos(angle)) / bend for angle, bend in zip(angles, bends, strict=True))
    outward = [*map(math.sin, angles), math.prod(map(math.cos, angles))]
    facing = sum(map(mul, outward, along)) / math.hypot(*outward)
    return [angle / bend for angle, bend in zip(angles, bends, strict=True)], level, facing


class _Column:
    """Heights m above a place at which lines along its normal leave and enter the body, beside it by (2,) m along its
    sides."""

    def __init__(self, triangles: np.ndarray, placed: PlacedPatch) -> None:
        local = (triangles - placed.centre) @ np.stack((*placed.sides, placed.normal)).T
        near = local[_within(local[:, :, :2], _SAMPLES[-1] * placed.half_width)]
        up = twice_areas(near)
        facing = FACING * np.linalg.norm(up, axis=1)  # 0 of triangles without area
        self._left = _Faces(near[up[:, 2] > facing])
        self._entered = _Faces(near[up[:, 2] < -facing])

    def tops(self, at: np.ndarray) -> np.ndarray:
        return self._left.heights(at)

    def bottoms(self, at: np.ndarray) -> np.ndarray:
        return self._entered.heights(at)


class _Faces:
    """Triangles (F, 3, 3) m seen along the third axis."""

    def __init__(self, triangles: np.ndarray) -> None:
        a, first, second = (
            triangles[:, 0],
            triangles[:, 1] - triangles[:, 0],
            triangles[:, 2] - triangles[:, 0],
        )
        across = first[:, 0] * second[:, 1] - first[:, 1] * second[:, 0]
        u, v = (second[:, 1], -second[:, 0]), (-first[:, 1], first[:, 0])
        shares = [each / across for each in (*u, *v)]
        self._table = np.stack((*a.T, *shares, first[:, 2], second[:, 2]), axis=1)

    def heights(self, at: np.ndarray) -> np.ndarray:
        found = np.empty(len(self._table))
        return found[: _heights(self._table, at[0], at[1], found)]


@njit(cache=True, error_model="numpy", short_loops=True)
def _heights(table, x, y, found):
    """Writes down the heights at which triangles are met, by rows of a corner, how two sides' shares of the way to a
    place rise along either axis, and how these sides rise. Returns how many there are."""
    count = 0
    for f in range(len(table)):
        along, aside = x - table[f, 0], y - table[f, 1]
        u = table[f, 3] * along + table[f, 4] * aside
        v = table[f, 5] * along + table[f, 6] * aside
        if u >= -_EDGE and v >= -_EDGE and u + v <= 1 + _EDGE:
            found[count] = table[f, 2] + u * table[f, 7] + v * table[f, 8]
            count += 1
    return count


def beneath(triangles: np.ndarray, patch: SurfacePatch, walls: np.ndarray | None = None) -> Beneath:
    """triangles: (F, 3, 3) m of the body. walls: (F, 3, 3) m of those that contents wet. Raises MeshError where the
    patch meets no surface."""
    # a place's rays leave its middle by half a side at most
    sides = np.linalg.svd(patch.direction[None])[2][1:]
    close = _within((triangles - np.array(patch.centre)) @ sides.T, 2 * patch.half_width)
    placed = place_patch(triangles[close], patch, np.eye(3))
    column, half = _Column(triangles, placed), placed.half_width

    def heights(offset: np.ndarray) -> np.ndarray:
        return column.tops(_ASIDE + offset)

    def near(offset: np.ndarray) -> np.ndarray:
        """(0 or 1,) m, the height that is nearest to the place's, within half a side."""
        found = heights(offset)
        found = found[np.abs(found) < half]
        return found[np.argsort(np.abs(found))[:1]]

    # where the very middle is beyond an edge, a place beside it that is not
    base = next((half * place for place in _BASES if len(near(half * place))), np.zeros(2))
    level = near(base) if base.any() else np.zeros(1)
    curvature, ends = np.zeros(2), np.full((2, 2), _FAR)
    for n, along in enumerate(np.eye(2)):
        found = [near(base + sign * _BEND * half * along) for sign in (-1.0, 1.0)]
        if not base.any() or (not base[n] and all(map(len, found))):
            for height in np.concatenate(found) - level:  # of a circle's arc
                curvature[n] -= height / ((_BEND * half) ** 2 + height**2)
        for k, sign in enumerate((-1.0, 1.0)):

            def is_inside(u: float, n: int = n, way: np.ndarray = sign * along) -> bool:
                found = heights(base + u * way) - level + curvature[n] * u * u / 2
                return bool(len(found)) and float(np.abs(found).min()) < 0.2 * u

            ends[n, k] = _end(is_inside, half) + sign * base[n]

    def thickness(offset: np.ndarray) -> float:
        """m from the surface down to the next; 0 where it is not within half a side of the place's height."""
        above, below = heights(offset), column.bottoms(_ASIDE + offset)
        if not len(above) or abs(top := above[np.argmin(np.abs(above))]) > half:
            return 0.0
        return float(np.min(top - below[below < top - ABOVE], initial=_FAR))

    def bent(offset: np.ndarray) -> float:
        """m from the curved face to the surface."""
        found = heights(offset) + curvature @ offset**2 / 2
        return float(np.min(np.abs(found), initial=np.inf))

    depth = thickness(base)
    around = [thickness(half * offset) for offset in _AROUND]
    even = np.abs(np.minimum(around, _DEEP) - min(depth, _DEEP)).max() <= _UNEVEN * min(depth, _DEEP)
    smooth = all(bent(half * offset) <= _UNSMOOTH * half for offset in _AROUND)
    # just beyond, a face goes on or ends, but does not bend down
    beyond = [bent(_BEYOND * half * way) / half for way in (*np.eye(2), *-np.eye(2))]
    smooth &= all(far <= _UNSMOOTH * _BEYOND or far >= _ENDED for far in beyond)
    wet, within = [False], False
    behind = None if walls is None else _Column(walls, placed)
    if behind is not None:
        within = any(len(near(at)) and _wet(near(at), behind.tops(_ASIDE + at), 0.0) for at in half * _AROUND)
    if behind is not None and depth < _DEEP:
        middle_and_around = zip([np.zeros(2), *half * _AROUND], [depth, *around], strict=True)
        wet = [_wet(heights(at), behind.bottoms(_ASIDE + at), thick) for at, thick in middle_and_around]
    plain = (
        even
        and smooth
        and not within
        and not base.any()
        and ends.min() >= half
        and np.abs(curvature).max() * half <= ROUND
    )
    return Beneath(placed, depth, curvature, ends, bool(plain) and all(wet) == any(wet), all(wet), within)


def _wet(tops: np.ndarray, walls: np.ndarray, thickness: float) -> bool:
    """Whether one of the walls' heights is where a body of that thickness below its top ends."""
    if not len(tops) or not len(walls):
        return False
    under = tops[np.argmin(np.abs(tops))] - thickness
    return float(np.abs(walls - under).min()) < ABOVE


def _within(along: np.ndarray, reach: float) -> np.ndarray:
    """Which of triangles (F, 3, 2) m come within reach of 0 along both axes."""
    return np.all((along.min(axis=1) <= reach) & (along.max(axis=1) >= -reach), axis=1)


def _end(is_inside: Callable[[float], bool], half: float) -> float:
    low = 0.0
    for share in _SAMPLES:
        high = share * half
        if not is_inside(high):
            for _ in range(8):
                middle = (low + high) / 2
                low, high = (middle, high) if is_inside(middle) else (low, middle)
            return low
        low = high
    return _FAR
