"""A pad's springs under a surface: how far a force pushes them in, and how much of the face, or of a ring around it,
then touches.

n: springs, the first C of which are looked at; the others help to bear the force.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np

from thermograsp.compiled import njit

from ..contact import FIRST_FORCE, FORCE_STEP, FORCES, Joint, Pad, Surface, face_joint, pad_joint
from ..matter import Material, Skin

_POINTS = 40  # along the pad's side
_FINER = 4  # times as many on the face
_LANES = 64
LEAST_RISE = 1e-15  # m, of a flat surface over a point
_STEPS = 50
_TOLERANCE = 1e-12  # of the force


@dataclass(frozen=True, slots=True)
class Ring:
    """Of a pad's front around the sensor's face: what lies between squares of the sides `inner` and `outer`, m. made:
    the pad's material."""

    made: Material
    inner: float
    outer: float


class Springs(NamedTuple):
    """places (n, 2) m, areas (n,) m2 and stiffness (n,) over that of those around the face. counted: C."""

    places: np.ndarray
    areas: np.ndarray
    stiffness: np.ndarray
    counted: int


def springs(pad: Pad, ring: Ring | None = None) -> Springs:
    """Of a pad with its skin's springs. Those on the face are closer together, and looked at unless a ring is given."""
    coarse, pitch = square_middles(pad.width, _POINTS), pad.width / _POINTS
    fine = square_middles(pad.face, _fine(pad))
    on_face = np.full(len(fine), pad.face**2 / len(fine)), np.full(len(fine), pad.face_ratio)
    rest = 1 - _within(coarse, pitch, pad.face)
    parts = [(fine, *on_face)]
    if ring is not None:
        seen = _within(coarse, pitch, ring.outer) - _within(coarse, pitch, ring.inner)
        rest -= seen
        parts.insert(0, (coarse, seen * pitch**2, np.ones(len(coarse))))
    some = rest > 0
    parts.append((coarse[some], rest[some] * pitch**2, np.ones(int(some.sum()))))
    places, areas, stiffness = map(np.concatenate, zip(*parts, strict=True))
    return Springs(places, areas, stiffness, len(parts[0][0]))


def on_face(pad: Pad, ring: Ring | None = None) -> tuple[int, int]:
    """From which of `springs` up to which are on the face."""
    first = 0 if ring is None else _POINTS**2
    return first, first + _fine(pad) ** 2


def _fine(pad: Pad) -> int:
    """Springs along the face's side."""
    return math.ceil(_FINER * _POINTS * pad.face / pad.width)


def square_middles(side: float, count: int) -> np.ndarray:
    """(count^2, 2) m from a square's middle: those of so many squares each way in it."""
    middles = (np.arange(count) + 0.5) * side / count - side / 2
    return np.stack([grid.ravel() for grid in np.meshgrid(middles, middles)], axis=1)


def _within(middles: np.ndarray, pitch: float, side: float) -> np.ndarray:
    """(n,) parts of the squares of that pitch m at those middles that lie in a square of that side m."""
    return np.clip((side / 2 - np.abs(middles)) / pitch + 0.5, 0.0, 1.0).prod(axis=1)


def loads(pad: Pad) -> np.ndarray:
    """(FORCES,) m3, the forces of a table over the stiffness of the springs around the face."""
    return np.exp(FIRST_FORCE + FORCE_STEP * np.arange(FORCES)) * (pad.thickness / pad.foundation_modulus)


def touching_joint(skin: Skin | None, body: Material, ring: Ring | None) -> Joint:
    """The faces that meet on the sensor's face, or on a ring around it."""
    other = Surface.of(body)
    return face_joint(skin, other) if ring is None else pad_joint(skin, ring.made, other)


@njit(cache=True, error_model="numpy")
def lowered(heights, cover):
    """Counts heights from the lowest that is covered: a light force's depth is little beside them."""
    least = np.inf
    for i in range(len(heights)):
        if cover[i] > 0.0:
            least = min(least, heights[i])
    heights -= least


@njit(cache=True, error_model="numpy")
def rises(heights, cover, slopes):
    """Writes to slopes (C,) by how many m the surface rises over the square of each of the points, the gentler of the
    two ways along both axes: a point at the edge of a crest is on it."""
    side = round(math.sqrt(len(slopes)))
    for i in range(len(slopes)):
        slopes[i] = 0.0
        for step, at in ((1, i % side), (side, i // side)):
            least = np.inf
            if at > 0 and cover[i - step] > 0.0:
                least = abs(heights[i] - heights[i - step])
            if at < side - 1 and cover[i + step] > 0.0:
                least = min(least, abs(heights[i + step] - heights[i]))
            if least < np.inf:
                slopes[i] += least


class Near(NamedTuple):
    """Springs that may come to touch, the first of so many rows: their numbers, heights m, spring m2 (cover times
    stiffness) and slopes m, of rises."""

    number: np.ndarray
    height: np.ndarray
    spring: np.ndarray
    slope: np.ndarray


def no_springs(count: int) -> Near:
    """Room for so many."""
    return Near(np.zeros(count, np.int64), np.zeros(count), np.zeros(count), np.zeros(count))


@njit(cache=True, error_model="numpy")
def under(heights, cover, stiffness, slopes, near):
    """Fills near with the springs that lie under the surface; their count. cover: m2 of each point."""
    count = 0
    for i in range(len(heights)):
        if cover[i] > 0.0:
            near.number[count], near.height[count] = i, heights[i]
            near.spring[count], near.slope[count] = cover[i] * stiffness[i], max(slopes[i], LEAST_RISE)
            count += 1
    return count


@njit(cache=True, error_model="numpy")
def touched_less(near, count, depth):
    """The count of springs that touch at that depth m, or a lesser one: near is left with them."""
    left = 0
    for j in range(count):
        if near.height[j] - near.slope[j] / 2 < depth:
            near.number[left], near.height[left] = near.number[j], near.height[j]
            near.spring[left], near.slope[left] = near.spring[j], near.slope[j]
            left += 1
    return left


@njit(cache=True, error_model="numpy")
def borne(near, count, cover, load, deepest, touching):
    """(m by which the springs sink in, m2 of the C points that touches, its share of the load m3). Fills touching (C,)
    m2. near, count: of `under`. deepest: of depth_under."""
    depth = depth_under(near.height[:count], near.spring[:count], near.slope[:count], load, deepest)
    area, held = 0.0, 0.0
    touching[:] = 0.0
    for j in range(count):
        i = near.number[j]
        if i >= len(touching):
            break
        sunk, part = _sunk(depth - near.height[j], near.slope[j])
        touching[i] = cover[i] * part
        area += touching[i]
        held += near.spring[j] * sunk
    return depth, area, held / load


@njit(cache=True, inner=True, error_model="numpy")
def _sunk(sunk, slope):
    """(m by which a point's square has sunk in on the mean, the part of it that touches), where its middle has by so
    many m and the surface rises by `slope` over it, more than 0."""
    ahead = sunk + slope / 2
    part = ahead / slope
    part = part if part > 0.0 else 0.0
    part = part if part < 1.0 else 1.0
    more = ahead - slope
    return slope * part * part / 2 + (more if more > 0.0 else 0.0), part


@njit(cache=True, error_model="numpy")
def depth_under(heights, springs, slopes, load, deepest):
    """m at which springs m2 take the load, m3; -inf where there are none. slopes: (n,) of rises, more than 0. deepest:
    m at which they take at least that, inf where no such depth is known."""
    depth, whole, most = load, 0.0, 0.0
    for i in range(len(heights)):
        depth += springs[i] * heights[i]
        whole += springs[i]
        most = max(most, slopes[i])
    if whole == 0.0:
        return -np.inf
    depth = min(depth / whole + most / 2, deepest)  # if all pushed: at least as deep as it will be
    loads, rates = np.empty(_LANES), np.empty(_LANES)
    for _ in range(_STEPS):
        loads[:], rates[:] = 0.0, 0.0
        for first in range(0, len(heights), _LANES):
            at = slice(first, first + _LANES)
            height, spring, slope = heights[at], springs[at], slopes[at]
            for i in range(len(height)):  # sums that do not depend on each other are made side by side
                sunk, part = _sunk(depth - height[i], slope[i])
                loads[i] += spring[i] * sunk
                rates[i] += spring[i] * part
        wrong, rate = loads.sum() - load, rates.sum()
        if rate == 0.0 or abs(wrong) <= _TOLERANCE * load:
            break
        depth -= wrong / rate
    return depth
