"""The sides from which a pad may meet a mesh or an ellipsoid, whose contacts have a table each.

Of a mesh they are the directions of its hull's faces, and where the pad is as seen there. MuJoCo presses a mesh's hull
on pads, so a pad that lies on a mesh looks against a face of its hull. Faces that look alike have one view, and a pad
belongs to the view that its normal is nearest to. It is turned there about the geom's middle, the shortest way: on a
ball that is the same place. Elsewhere what it touches has gone along the hull by radii of curvature in place of the
hull's distance from the middle, both times the sines of the angle, and so is the pad.

Of an ellipsoid they are radii. A pad that looks along the unit vector n, in the frame of the half axes a_i, touches
where the geometric mean R of the principal radii is a_1 a_2 a_3/h^2, with h^2 the sum of a_i^2 n_i^2: the Gaussian
curvature is h^4/(a_1 a_2 a_3)^2 where the tangent plane is h from the middle. With the radii R_i where the axes leave
it, 1/R is the sum of n_i^2/R_i. What touches is between the contacts of the two sides next to R, evenly by R^BY_RADIUS:
what balls conduct rises by their radius to powers of .5 to .84, of sides _APART within 2.5 % of that.

N: what a pad may meet.
"""

# mujoco ships no type stubs for its compiled names
# pyright: reportAttributeAccessIssue=false

from __future__ import annotations

import math
from collections.abc import Sequence
from functools import lru_cache
from itertools import pairwise
from types import ModuleType

import mujoco
import numpy as np

from thermograsp.compiled import njit

from ...thermal import Pad
from ...thermal.numerics import Array, as_integers, as_like, namespace_of
from ...thermal.pressed import height_map, map_heights, pressure_map, square_middles
from ..scene import hull_of, mesh_of

VIEW = 15
"""Of a view: three axes, the first into the mesh, and m along the others where the mesh begins, all in the geom's
frame; and (2, 2) m by which the hull's radii of curvature along the others are more than its distance from the
middle."""
_DISTINCT = math.cos(math.radians(35))  # views
_ALIKE = math.cos(math.radians(20))  # faces whose areas count together
_FEW, _FEWEST = 0.01, 0.002  # of the hull's area beside a flat face, and elsewhere
_BETWEEN = math.cos(
    math.radians(57)
)  # flat faces, which are level to pads that lean on the edges between them
_DIGITS = 3  # of a direction
_SAME, _EXACTLY = math.cos(math.radians(1)), math.cos(math.radians(0.1))  # of a face, and of one that is flat
_ROUND = math.cos(math.radians(35))  # faces that tell how round the hull is around a view
_BESIDE = (
    0.1  # of the view's own face, that such a face has at least: not the rounding of a flat face's edges
)
_FLAT = (
    math.sin(math.radians(0.6)) ** 2
)  # mean square of sines of their angles, below which they are one flat face
PAD, _POINTS, _PRESSED = Pad(), 40, 10.0
"""What comes to lie on a mesh: a pad, seen at so many points along its side, and N."""
_SLANT = 0.2  # most of a hull's face between crests
BY_RADIUS = 0.7
_APART = 4.0  # at most, the ratio of the radii of two sides of an ellipsoid that follow one another
_ONE_RADIUS = 1e-6  # relative difference, up to which two radii are one, in single precision too


def mesh_views(model: mujoco.MjModel, geom: int) -> np.ndarray:
    """(K, VIEW) of a mesh geom, those of the largest faces first."""
    vertices, faces = mesh_of(model, geom)
    return _views(vertices.tobytes(), faces.tobytes(), hull_of(model, geom).tobytes())


@lru_cache(maxsize=256)
def _views(vertex: bytes, face: bytes, triangle: bytes) -> np.ndarray:
    """mesh_views of a mesh and its hull's triangles."""
    vertices, faces = np.frombuffer(vertex).reshape(-1, 3), np.frombuffer(face, np.int64).reshape(-1, 3)
    triangles = np.frombuffer(triangle, np.int64).reshape(-1, 3)
    hull, outline = vertices[triangles], vertices[np.unique(triangles)]
    cross = np.cross(hull[:, 1] - hull[:, 0], hull[:, 2] - hull[:, 0])
    outward = (cross * (hull[:, 0] - vertices.mean(axis=0))).sum(axis=1)
    cross, middles = (cross * np.sign(outward)[:, None])[outward != 0], hull.mean(axis=1)[outward != 0]
    twice = np.linalg.norm(cross, axis=1)
    # flat faces keep their own direction, to what single precision leaves of it
    _, first, which = np.unique(
        np.round(cross / twice[:, None], _DIGITS), axis=0, return_index=True, return_inverse=True
    )
    directions, areas = cross[first] / twice[first, None], np.bincount(which.ravel(), weights=twice)
    chosen: list[np.ndarray] = []
    flat: list[np.ndarray] = []
    for n in np.argsort(-np.round(areas / areas.sum(), 6), kind="stable"):
        if all(directions[n] @ other < _DISTINCT for other in chosen):
            alike = areas[directions @ directions[n] > _ALIKE].sum()
            beside = any(directions[n] @ other > _BETWEEN for other in flat)
            if alike > (_FEW if beside else _FEWEST) * areas.sum():
                chosen.append(directions[n])
                if areas[directions @ directions[n] > _SAME].sum() > alike / 2:
                    flat.append(directions[n])
    views = []
    for direction in chosen:
        near = (directions @ direction > _ALIKE)[which.ravel()]
        middle = np.average(middles[near], axis=0, weights=twice[near])
        view = _view(outline, _lying(vertices, faces, -direction, middle))
        own = areas[directions @ direction > _EXACTLY].max()
        around = ((directions @ direction > _ROUND) & (areas > _BESIDE * own))[which.ravel()]
        radii = _radii(middles[around], cross[around], view[3:9].reshape(2, 3))
        away = (outline @ -view[:3]).max() * np.eye(2)
        views.append(np.concatenate((view, (radii - away).ravel())))
    found = np.array(views)
    found.flags.writeable = False
    return found


def _radii(middles: np.ndarray, cross: np.ndarray, axes: np.ndarray) -> np.ndarray:
    """(2, 2) m along two axes (2, 3): by how much the places of faces differ where their normals do, by least squares.
    middles (n, 3) m and cross (n, 3), outward, twice their areas."""
    if len(cross) == 0:
        return np.zeros((2, 2))
    twice = np.linalg.norm(cross, axis=1)
    places, sines = middles @ axes.T, cross @ axes.T / twice[:, None]
    weight = twice / twice.sum()
    places, sines = places - weight @ places, sines - weight @ sines
    found = np.linalg.solve((sines.T * weight) @ sines + _FLAT * np.eye(2), (sines.T * weight) @ places)
    values, turn = np.linalg.eigh((found + found.T) / 2)
    return (turn * np.maximum(values, 0.0)) @ turn.T


def _lying(vertices: np.ndarray, faces: np.ndarray, along: np.ndarray, middle: np.ndarray) -> np.ndarray:
    """(3,): the direction, near `along`, in which a pad looks that comes to lie on the mesh at `middle` (3,) m: on
    crests, whose hull has faces aslant between them."""
    axes = _across(along)
    places = square_middles(PAD.width, _POINTS)
    heights, cover, pressure = np.zeros((3, len(places)))
    map_heights(*height_map(vertices, faces, axes), np.stack([middle, *axes]), places, heights, cover)
    if not cover.any():
        return along
    heights -= heights[cover > 0].min()
    stiffness, area = PAD.foundation_modulus / PAD.thickness, (PAD.width / _POINTS) ** 2
    centre = cover @ places / cover.sum()
    _, tilt, other = pressure_map(
        heights, cover, places, area, stiffness, PAD.thickness, _PRESSED, centre, pressure
    )
    # the pad's plane is where depth + tilt y + other z of the mesh's heights are
    lain = axes[0] - tilt * axes[1] - other * axes[2]
    return lain / np.linalg.norm(lain) if math.hypot(tilt, other) < _SLANT else along


def _view(vertices: np.ndarray, along: np.ndarray) -> np.ndarray:
    """(11,) of a view along a unit vector, its other axes along the narrowest rectangle round the mesh."""
    _, aside, other = _across(along)
    angles = np.radians(np.arange(0, 90, 1.0))[:, None]
    first, second = (
        np.cos(angles) * aside + np.sin(angles) * other,
        np.cos(angles) * other - np.sin(angles) * aside,
    )
    areas = np.ptp(vertices @ first.T, axis=0) * np.ptp(vertices @ second.T, axis=0)
    best = int(np.argmin(np.round(areas / areas.min(), 6)))
    axes = np.stack([along, first[best], second[best]])
    return np.concatenate((axes.ravel(), (vertices @ axes[1:].T).min(axis=0)))


def _across(along: np.ndarray) -> np.ndarray:
    """(3, 3): a unit vector and two across it."""
    aside = np.eye(3)[np.argmin(abs(along))]
    aside = aside - (aside @ along) * along
    aside /= np.linalg.norm(aside)
    return np.stack([along, aside, np.cross(along, aside)])


def ellipsoid_radii(size: Sequence[float]) -> list[float]:
    """m of the sides of an ellipsoid of these half axes m: the first three where its axes leave it, then others between
    those that are far apart."""
    radii: list[float] = []
    for axis in range(3):
        along, first, second = np.roll(size, -axis)
        radius = float(first * second / along)
        radii.append(
            next((each for each in radii if math.isclose(each, radius, rel_tol=_ONE_RADIUS)), radius)
        )
    for low, high in pairwise(sorted(radii)):
        steps = math.ceil(math.log(high / low) / math.log(_APART) - _ONE_RADIUS)
        radii += [low * (high / low) ** (n / steps) for n in range(1, steps)]
    return radii


def stacked_views(
    model: mujoco.MjModel, geoms: Sequence[int], others: int
) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """(views (N, A, VIEW) of meshes, their number (N,), radii (N, A) m of the sides of ellipsoids, else 0) of geoms
    and, behind them, of others that are neither; A at least 3."""
    found = [
        mesh_views(model, geom)
        if model.geom_type[geom] == mujoco.mjtGeom.mjGEOM_MESH
        else np.zeros((0, VIEW))
        for geom in geoms
    ]
    rounded = [
        ellipsoid_radii(model.geom_size[geom].tolist())
        if model.geom_type[geom] == mujoco.mjtGeom.mjGEOM_ELLIPSOID
        else []
        for geom in geoms
    ]
    counts = np.array([*map(len, found), *[0] * others], np.int64)
    most = max(3, *counts, *map(len, rounded))
    views, radii = np.zeros((len(counts), most, VIEW)), np.zeros((len(counts), most))
    for g, (each, of_sides) in enumerate(zip(found, rounded, strict=True)):
        views[g, : len(each)], radii[g, : len(of_sides)] = each, of_sides
    return views, counts, radii


@njit(cache=True, borrows=True, error_model="numpy")
def viewed(views, count, normal, place, half_face):
    """(number of the view, m along its two axes from where the face begins to meet the mesh, at least 0). normal (3,)
    and middle, place (3,) m, of the pad in the geom's frame."""
    best, most = 0, -2.0
    for k in range(count):
        cosine = views[k, 0] * normal[0] + views[k, 1] * normal[1] + views[k, 2] * normal[2]
        if cosine > most:
            best, most = k, cosine
    view = views[best]
    # about the axis c = normal x direction: p + c x p + c x (c x p)/(1 + cosine)
    c0 = normal[1] * view[2] - normal[2] * view[1]
    c1 = normal[2] * view[0] - normal[0] * view[2]
    c2 = normal[0] * view[1] - normal[1] * view[0]
    p0, p1, p2 = c1 * place[2] - c2 * place[1], c2 * place[0] - c0 * place[2], c0 * place[1] - c1 * place[0]
    more = 1 / (1 + most)
    q0 = place[0] + p0 + more * (c1 * p2 - c2 * p1)
    q1 = place[1] + p1 + more * (c2 * p0 - c0 * p2)
    q2 = place[2] + p2 + more * (c0 * p1 - c1 * p0)
    across = view[3] * normal[0] + view[4] * normal[1] + view[5] * normal[2]
    other = view[6] * normal[0] + view[7] * normal[1] + view[8] * normal[2]
    aside = view[3] * q0 + view[4] * q1 + view[5] * q2 + view[11] * across + view[12] * other
    along = view[6] * q0 + view[7] * q1 + view[8] * q2 + view[13] * across + view[14] * other
    return best, max(aside - view[9] + half_face, 0.0), max(along - view[10] + half_face, 0.0)


def array_viewed(views: Array, normal: Array, place: Array, half_face: Array) -> tuple[Array, Array, Array]:
    """viewed as a pure function of arrays: NumPy, PyTorch, JAX. views: (G, A, VIEW), of what is no mesh 0; normal and
    place: (..., G, 3); half_face: (..., G). Returns (..., G) each."""
    xp = namespace_of(place)
    cosines = (views[..., :3] * normal[..., None, :]).sum(-1)
    known = (views[..., :3] * views[..., :3]).sum(-1) > 0
    cosines = xp.where(known, cosines, 0.0 * cosines - 2.0)
    best = cosines.argmax(-1)
    geoms, most = views.shape[:2]
    first = as_integers(as_like(np.arange(geoms) * most, place))
    view = views.reshape((geoms * most, VIEW))[best + first]
    axis, aside, along = view[..., :3], view[..., 3:6], view[..., 6:9]
    turn = _cross(xp, normal, axis)
    once = _cross(xp, turn, place)
    cosine = (axis * normal).sum(-1)
    seen = place + once + _cross(xp, turn, once) / (1 + cosine)[..., None]
    across, other = (aside * normal).sum(-1), (along * normal).sum(-1)
    first = (aside * seen).sum(-1) + view[..., 11] * across + view[..., 12] * other
    second = (along * seen).sum(-1) + view[..., 13] * across + view[..., 14] * other
    return (
        best,
        (first - view[..., 9] + half_face).clip(0.0, None),
        (second - view[..., 10] + half_face).clip(0.0, None),
    )


def _cross(xp: ModuleType, one: Array, other: Array) -> Array:
    x, y, z = (one[..., k] for k in range(3))
    u, v, w = (other[..., k] for k in range(3))
    return xp.stack([y * w - z * v, z * u - x * w, x * v - y * u], -1)


@njit(cache=True, borrows=True, error_model="numpy")
def next_sides(radii, normal):
    """(numbers of the sides of an ellipsoid with the next smaller and the next larger radius, and the share of the
    second). radii: (A,) m; normal: (3,) of the pad in the geom's frame."""
    bent = 0.0
    for k in range(3):
        bent += normal[k] * normal[k] / radii[k]
    radius, below, above = (1 + _ONE_RADIUS) / bent, -1, -1
    for k in range(len(radii)):
        if radii[k] > radius:
            if above < 0 or radii[k] < radii[above]:
                above = k
        elif radii[k] > 0 and (below < 0 or radii[k] > radii[below]):
            below = k
    if below < 0 or above < 0:
        return max(below, above), max(below, above), 0.0
    least = radii[below]
    share = ((1 / bent / least) ** BY_RADIUS - 1) / ((radii[above] / least) ** BY_RADIUS - 1)
    return below, above, min(max(share, 0.0), 1.0)


@njit(cache=True, borrows=True, error_model="numpy")
def between_sides(share, one, other, shares, others):
    """What touches between two sides: W/K, m2 and m of each, of the second by that share. Fills shares (4,), with those
    of the second: they count by area, and patches stay as long for their breadth."""
    less = 1 - share
    area = less * one[1] + share * other[1]
    for n in range(4):
        both = less * one[1] * shares[n] + share * other[1] * others[n]
        shares[n] = both / area if area > 0 else 0.0
    long = math.sqrt(less * one[2] * one[2] + share * other[2] * other[2])
    return less * one[0] + share * other[0], area, long


def array_next_sides(radii: Array, normal: Array) -> tuple[Array, Array, Array]:
    """next_sides as a pure function of arrays: NumPy, PyTorch, JAX. radii: (G, A) m, 0 of what is no ellipsoid; normal:
    (..., G, 3). Returns (..., G) each, no share of what is no ellipsoid."""
    xp = namespace_of(normal)
    of_axes, there = radii[:, :3], radii > 0
    bent = (normal * normal / xp.where(of_axes > 0, of_axes, 1.0 + of_axes)).sum(-1)
    radius, every = ((1 + _ONE_RADIUS) / bent)[..., None], radii + 0.0 * bent[..., None]
    larger, smaller = every > radius, (every <= radius) & there
    below = xp.where(smaller, every, 0.0 * every).argmax(-1)
    above = xp.where(larger, 1 / xp.where(larger, every, 1.0 + every), 0.0 * every).argmax(-1)
    inside = larger.any(-1) & smaller.any(-1)
    below = xp.where(smaller.any(-1), below, above)
    numbers = as_integers(as_like(np.arange(radii.shape[0]) * radii.shape[1], normal))
    flat = radii.reshape(-1)
    least, most = flat[below + numbers], flat[above + numbers]
    one = 1.0 + 0.0 * bent
    least, most = xp.where(inside, least, one), xp.where(inside, most, 2 * one)
    share = ((1 / bent / least) ** BY_RADIUS - 1) / ((most / least) ** BY_RADIUS - 1)
    return below, xp.where(inside, above, below), xp.where(inside, share.clip(0.0, 1.0), 0.0 * one)


def array_between_sides(
    share: Array, one: Sequence[Array], other: Sequence[Array], shares: Array, others: Array
) -> tuple[Array, Array, Array, Array]:
    """between_sides as a pure function of arrays of the share's shape, shares (..., 4); those come last."""
    xp = namespace_of(share)
    less = 1 - share
    first, second = less * one[1], share * other[1]
    area = first + second
    over = xp.where(area > 0, area, 1.0 + 0.0 * area)[..., None]
    square = less * one[2] * one[2] + share * other[2] * other[2]
    # the root of 0 has no gradient
    long = xp.where(square > 0, xp.where(square > 0, square, 1.0 + square) ** 0.5, 0.0 * square)
    both = (first[..., None] * shares + second[..., None] * others) / over
    return less * one[0] + share * other[0], area, long, both
