"""Pressure under a pad from the object's shape: an elastic (Winkler) foundation under a rigid surface.

The pad is as many springs side by side, each of stiffness foundation modulus over thickness per area (see
thermal/contact/area.py). A surface of height h(y, z) over the pad's face, pressed in by `depth` and tilted, makes the
pressure

    p = stiffness max(0, depth + tilt_y y + tilt_z z - h)

and depth and tilts follow from the force and where it acts. They are where a convex function of the three, piecewise
quadratic, is least, so there is one map only; Newton's steps reach it to rounding. A constant or a slope added to h
changes nothing, so the object's pose need be known to first order only.

Kernels work on one pad; rows of a batch never mix.
"""

from __future__ import annotations

import numpy as np

from thermograsp.compiled import njit

from ..contact import Pad

_STEPS = 50
_SECANTS = 20
_TOLERANCE = 1e-11  # of the force, which must balance to that, or
_ROUND_OFF = 1e-15  # of what all springs would bear that are as deep as the surface is high
_NEARER = (1.0, 0.98, 0.95, 0.9, 0.8, 0.7, 0.6, 0.5, 0.4, 0.3, 0.2, 0.1, 0.0)
_RIDGE = 1e-3  # springs, added where those that push can't resist a tilt


def face_springs(
    pad: Pad, places: np.ndarray, sides: float | tuple[float, float]
) -> tuple[np.ndarray, np.ndarray]:
    """(n,) each: what of the points' rectangles lies on the sensor's face, and how much stiffer their springs are than
    those around it, by which pressure_map's cover counts. places (n, 2): m. sides: m, of a rectangle."""
    within = np.clip((pad.face / 2 - np.abs(places)) / sides + 0.5, 0.0, 1.0).prod(axis=1)
    return within, 1 + (pad.face_ratio - 1) * within


@njit(cache=True, short_loops=True, error_model="numpy")
def pressure_map(height, cover, places, area, stiffness, deepest, force, centre, out):
    """Writes the pressure, Pa, at each of n points into out (n,), where `force` N acts at `centre` (2,) m. Returns the
    depth, m, and the tilts by which the surface is pressed in; 0 where nothing is covered or pressed.

    height (n,): m, of the object's surface over the pad; cover (n,): share of the point's area, m2, over which there is
    a surface. places (n, 2): m, the points. stiffness: Pa/m. deepest: m.

    Where springs within `deepest` can't balance the force at its centre, because the surface isn't where the force is
    said to be, the centre moves to that of the untilted contact as far as it must. Where nothing is covered, the point
    nearest to the centre takes it all.
    """
    solution = np.zeros(3)
    scale = 0.0
    for i in range(len(height)):
        scale = max(scale, abs(places[i, 0]), abs(places[i, 1]))
        out[i] = 0.0
    if force <= 0.0:
        return 0.0, 0.0, 0.0
    least, most, covered = np.inf, -np.inf, 0.0
    for i in range(len(height)):
        if cover[i] > 0.0:
            least, most = min(least, height[i]), max(most, height[i])
            covered += cover[i]
    if covered == 0.0:
        nearest, away = 0, np.inf
        for i in range(len(height)):
            distance = (places[i, 0] - centre[0]) ** 2 + (places[i, 1] - centre[1]) ** 2
            if distance < away:
                nearest, away = i, distance
        out[nearest] = force / area
        return 0.0, 0.0, 0.0
    height = height - least  # a light force's depth is little beside them
    spring = stiffness * area
    enough = max(_TOLERANCE * force, _ROUND_OFF * spring * covered * (most - least))
    middle_y, middle_z = _untilted(height, cover, places, spring, force, enough, solution)
    flat = solution[0]
    furthest = _furthest(cover, places, middle_y, middle_z, centre)
    for share in _NEARER:
        if share >= furthest and share > 0.0:
            continue
        y = (middle_y + share * (centre[0] - middle_y)) / scale
        z = (middle_z + share * (centre[1] - middle_z)) / scale
        solution[0], solution[1], solution[2] = flat, 0.0, 0.0
        balanced = _balance(height, cover, places, scale, spring, force, enough, y, z, solution)
        if balanced and _depth(height, cover, places, scale, solution) <= deepest:
            break
        if share == 0.0:
            solution[0], solution[1], solution[2] = flat, 0.0, 0.0
    total = 0.0
    for i in range(len(height)):
        sunk = solution[0] + (solution[1] * places[i, 0] + solution[2] * places[i, 1]) / scale - height[i]
        if cover[i] > 0.0 and sunk > 0.0:
            out[i] = stiffness * cover[i] * sunk
            total += out[i]
    exact = force / (total * area)
    for i in range(len(height)):
        out[i] *= exact
    return solution[0] + least, solution[1] / scale, solution[2] / scale


@njit(cache=True, inner=True, error_model="numpy")
def _untilted(height, cover, places, spring, force, enough, solution):
    """Writes the depth at which the untilted surface takes the force, to `enough` N; the centre of that contact, m.
    height: m from the lowest."""
    depth, covered = 0.0, 0.0
    for i in range(len(height)):
        if cover[i] > 0.0:
            depth += cover[i] * height[i]
            covered += cover[i]
    depth = (depth + force / spring) / covered  # all springs push: at least as deep as it will be
    for _ in range(_STEPS):
        load, rate = 0.0, 0.0
        for i in range(len(height)):
            if cover[i] > 0.0 and height[i] < depth:
                load += cover[i] * (depth - height[i])
                rate += cover[i]
        wrong = load - force / spring
        if rate == 0.0 or abs(wrong) <= enough / spring:
            break
        depth = max(depth - wrong / rate, 0.0)
    y, z, load = 0.0, 0.0, 0.0
    for i in range(len(height)):
        if cover[i] > 0.0 and height[i] < depth:
            push = cover[i] * (depth - height[i])
            y, z, load = y + push * places[i, 0], z + push * places[i, 1], load + push
    solution[0] = depth
    return y / load, z / load


@njit(cache=True, inner=True, error_model="numpy")
def _furthest(cover, places, y, z, centre):
    """The share of the way from (y, z) to the centre beyond which no point of the surface lies in that direction."""
    along_y, along_z = centre[0] - y, centre[1] - z
    whole = along_y * along_y + along_z * along_z
    if whole == 0.0:
        return np.inf
    most = 0.0
    for i in range(len(cover)):
        if cover[i] > 0.0:
            most = max(most, (places[i, 0] - y) * along_y + (places[i, 1] - z) * along_z)
    return most / whole


@njit(cache=True, inner=True, error_model="numpy")
def _balance(height, cover, places, scale, spring, force, enough, y, z, solution):
    """Newton's steps to depth and tilts (times scale) in solution (3,) under a force at y, z (in units of scale), with
    an exact search along each. Returns whether force and moments balance."""
    gradient, hessian = np.zeros(3), np.zeros((3, 3))
    step, trial = np.zeros(3), np.zeros(3)
    _sums(height, cover, places, scale, spring, force, y, z, solution, gradient, hessian)
    for _ in range(_STEPS):
        wrong = max(abs(gradient[0]), abs(gradient[1]), abs(gradient[2]))
        if wrong <= enough:
            return True
        if not _solve(hessian, gradient, step):
            for k in range(3):
                hessian[k, k] += _RIDGE * spring
            if not _solve(hessian, gradient, step):
                return False
        slope = -(gradient[0] * step[0] + gradient[1] * step[1] + gradient[2] * step[2])
        length, low, high = 1.0, 0.0, np.inf
        below, above = slope, 0.0
        for _ in range(_SECANTS):
            for k in range(3):
                trial[k] = solution[k] - length * step[k]
            _sums(height, cover, places, scale, spring, force, y, z, trial, gradient, hessian)
            here = -(gradient[0] * step[0] + gradient[1] * step[1] + gradient[2] * step[2])
            if abs(here) <= 0.5 * abs(slope):
                break
            if here > 0.0:
                high, above, below = length, here, 0.5 * below
            else:
                low, below, above = length, here, 0.5 * above
            length = 4.0 * length if high == np.inf else low + (high - low) * below / (below - above)
        for k in range(3):
            solution[k] = trial[k]
    return False


@njit(cache=True, inner=True, error_model="numpy")
def _sums(height, cover, places, scale, spring, force, y, z, at, gradient, hessian):
    """Writes what force and moments (in units of scale) lack, and their derivatives."""
    s, sy, sz, syy, syz, szz, push, push_y, push_z = 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0
    for i in range(len(height)):
        if cover[i] > 0.0:
            u, v = places[i, 0] / scale, places[i, 1] / scale
            sunk = at[0] + at[1] * u + at[2] * v - height[i]
            if sunk > 0.0:
                w = cover[i]
                s, sy, sz = s + w, sy + w * u, sz + w * v
                syy, syz, szz = syy + w * u * u, syz + w * u * v, szz + w * v * v
                w *= sunk
                push, push_y, push_z = push + w, push_y + w * u, push_z + w * v
    gradient[0], gradient[1], gradient[2] = (
        spring * push - force,
        spring * push_y - force * y,
        spring * push_z - force * z,
    )
    hessian[0, 0], hessian[0, 1], hessian[0, 2] = spring * s, spring * sy, spring * sz
    hessian[1, 1], hessian[1, 2], hessian[2, 2] = spring * syy, spring * syz, spring * szz


@njit(cache=True, inner=True, error_model="numpy")
def _solve(a, b, x):
    """x = a^-1 b of a symmetric matrix given by its upper triangle, by Cholesky; False where it is singular."""
    floor = 1e-13 * a[0, 0]
    if not a[0, 0] > 0.0:
        return False
    l00 = np.sqrt(a[0, 0])
    l10, l20 = a[0, 1] / l00, a[0, 2] / l00
    d = a[1, 1] - l10 * l10
    if not d > floor:
        return False
    l11 = np.sqrt(d)
    l21 = (a[1, 2] - l20 * l10) / l11
    d = a[2, 2] - l20 * l20 - l21 * l21
    if not d > floor:
        return False
    l22 = np.sqrt(d)
    p = b[0] / l00
    q = (b[1] - l10 * p) / l11
    r = (b[2] - l20 * p - l21 * q) / l22
    x[2] = r / l22
    x[1] = (q - l21 * x[2]) / l11
    x[0] = (p - l10 * x[1] - l20 * x[2]) / l00
    return True


@njit(cache=True, inner=True, error_model="numpy")
def _depth(height, cover, places, scale, at):
    """m, the deepest spring."""
    deepest = 0.0
    for i in range(len(height)):
        if cover[i] > 0.0:
            sunk = at[0] + (at[1] * places[i, 0] + at[2] * places[i, 1]) / scale - height[i]
            deepest = max(deepest, sunk)
    return deepest
