"""What a sensor's face and the pad around it touch of a mesh, and what that conducts.

A face with a skin sinks in on its springs. A bare one of lapped alumina does not: a mesh's crests lie on it, what of
them is within the faces' roughness of the highest touches, on springs as stiff as a column of alumina. Spots conduct
there and constrict the heat where they are small. Gas conducts beside what touches over the gap, place by place. Two
patches of even conductance stand for both, as they do under a ball (thermal/contact/spread.py).

Under a crest the rigid face bears nearly all of the force. A flat face meets it flush with the pad, whose springs are
then taken as the same all over, as they are for boxes (thermal/contact/area.py). In between, the share that touches of
what the mesh covers of the face tells how flat that is.

A soft mesh gives way further than its roughness. What lies less than h below its highest point touches then, A in all,
and bears (8/3) E* h sqrt(A/pi), or pi/2 E* h per length of a line: Hertz's laws, in which h is a^2/(2 R) and A is not
told by the radius. Its gap is Hertz's, too. As under a ball (thermal/contact/footprint.py) a crown's contact stays on
the face, up to the face's size.
"""

from __future__ import annotations

import math
from typing import Any, NamedTuple

import numpy as np

from thermograsp.compiled import njit

from ..contact import (
    FIRST_FORCE,
    FORCE_STEP,
    FORCES,
    Pad,
    conductance,
    constricted,
    disc_on_face,
    two_flows,
    widened,
)
from .height_map import HeightMap, map_heights
from .lying import Moments, lie, mixed
from .springs import (
    LEAST_RISE,
    Ring,
    borne,
    loads,
    lowered,
    no_springs,
    on_face,
    rises,
    springs,
    touched_less,
    under,
)

_AROUND = 1e-3  # m, within which a crown's curvature is told
_LINE, _COMPACT = 0.1, 0.25
"""Breadth over length of a contact up to which it is a line, which constricts no heat here, and from which it does so
as a disc."""
_FEW = 1e-6  # of what both conduct: less is no contact
_SPOT = 8 / 3  # times Hertz's modulus, the radius and the height of what touches: the force on a spot
_STEPS, _CLOSE = 40, 1e-3  # at most, to a height that is known to that share
_CURVED = 1e-3  # of the face: what touches less is no flat face
_FEWEST = 30  # points
_UPRIGHT = 1e-9  # of a point, by which all paraboloids that fit points in a line are told apart
_FLATTEST = 0.5  # m, of the radii of crowns
_UNLIKE = 0.1  # of the squares of the heights' differences, that a paraboloid leaves at most


class Seen(NamedTuple):
    """A mesh along one direction as `pressed` takes it. seen: its heights; begin (2,), places (2, PLACES) and spans
    (2,) m: as PressedView has them. some: (2, 2) from which of the places to before which."""

    seen: HeightMap
    begin: np.ndarray
    places: np.ndarray
    spans: np.ndarray
    some: np.ndarray

    def room(self, width: int) -> np.ndarray:
        """(FORCES, rows, columns, width) zeros."""
        rows, columns = np.diff(self.some)[:, 0].tolist()
        return np.zeros((FORCES, rows, columns, width))


def pressed(pad: Pad, ring: Ring | None, law: np.void, where: Seen) -> np.ndarray:
    """(FORCES, rows, columns, 2): m2 that touch of the sensor's face, or of a ring around it, and their share of the
    force. pad: with its springs. law: of face_footprint; a bare face is rigid."""
    touched = where.room(2)
    _press(*_arguments(pad, ring, law, where), (0.0, 0.0), touched)
    return touched


def conducted(pad: Pad, law: np.void, resistance: float, series: float, where: Seen) -> np.ndarray:
    """(FORCES, rows, columns, 10) of the sensor's face: the shares by which what conducts lies at an end of the face
    along both axes, and of the mesh (thermal/contact/patch_place.py); m, how long the patches of the contact and of the
    gas are along the second axis; W/K of both; m2 of the patches. pad, law: as pressed has them. resistance,
    series: m2 K/W and m K/W of both bodies (thermal/contact/spread.py)."""
    found = where.room(10)
    _press(*_arguments(pad, None, law, where), (resistance, series), found)
    return found


def _arguments(pad: Pad, ring: Ring | None, law: np.void, where: Seen) -> tuple[Any, ...]:
    forces = np.exp(FIRST_FORCE + FORCE_STEP * np.arange(FORCES))
    found = springs(pad, ring)
    room = no_springs(len(found.places)), no_springs(len(found.places))
    of_pad = *found, np.array(on_face(pad, ring)), loads(pad), forces, *room
    return (
        *where.seen,
        where.begin,
        where.places,
        where.some,
        where.spans,
        pad.face,
        pad.sensor_width,
        ring is None,
        *of_pad,
        law,
    )


@njit(cache=True, error_model="numpy", nogil=True)
def _press(
    axes, corner, height, shares, pitch, begin, places, some, spans, face, sensor, of_face, points, areas, stiffness,
    counted, span, loads, forces, near, soft, law, bodies, found,
):  # fmt: skip
    """Fills found, of `pressed` or `conducted`. of_face: whether the face is looked at, or a ring. span: from which of
    the points up to which are on the face. loads: m3, forces N over the stiffness of springs around the face.
    near, soft: room."""
    frame, rigid = np.zeros((4, 3)), law.modulus > 0.0
    frame[1:] = axes
    heights, cover, even = np.zeros(len(points)), np.zeros(len(points)), np.ones(len(points))
    slopes, touching, beside = np.zeros(len(points)), np.zeros(counted), np.zeros(counted)
    no_crown = 0.0, 0.0, 0.0
    first = 1 if of_face else 0  # a face touches nothing at the ends
    last = places.shape[1] - first
    for a in range(max(some[0, 0], first), min(some[0, 1], last)):
        for b in range(max(some[1, 0], first), min(some[1, 1], last)):
            at = found[:, a - some[0, 0], b - some[1, 0]]
            for k in range(3):
                frame[0, k] = (begin[0] + places[0, a]) * axes[1, k] + (begin[1] + places[1, b]) * axes[2, k]
            map_heights(axes, corner, height, shares, pitch, frame, points, heights, cover)
            cover *= areas
            if cover[:counted].max() == 0.0:
                continue
            lowered(heights, cover)
            shape = _crown(points, heights, cover, counted, law) if rigid and of_face else no_crown
            if rigid:
                for i in range(len(points)):
                    heights[i] = max(heights[i] - law.roughness, 0.0)
            rises(heights, cover, slopes[:counted])
            crown = _crown(points, heights, cover, counted, law) if rigid and of_face else no_crown
            covered = cover[span[0] : span[1]].sum()
            count = under(heights, cover, stiffness, slopes, near)
            evenly = under(heights, cover, even, slopes, soft) if rigid else 0
            depth, soft_depth = np.inf, np.inf
            for n in range(len(loads) - 1, -1, -1):
                depth, area, share = borne(near, count, cover, loads[n], depth, touching)
                count = touched_less(near, count, depth)
                flat = _touches(near, count, cover, depth, span) / covered if rigid and covered > 0.0 else 0.0
                if flat > _CURVED:
                    soft_depth, _, softly = borne(soft, evenly, cover, loads[n], soft_depth, beside)
                    evenly = touched_less(soft, evenly, soft_depth)
                else:
                    softly = share
                if found.shape[3] == 2:
                    at[n, 0], at[n, 1] = area, share + flat * (softly - share)
                else:
                    where = areas[0], places[0, a], places[1, b], spans, face, sensor
                    load = share * forces[n], softly * forces[n]
                    what = heights, cover, slopes, depth, touching, beside
                    _conduct(
                        points,
                        near,
                        count,
                        what,
                        area,
                        load,
                        where,
                        law,
                        bodies,
                        crown,
                        shape,
                        flat,
                        at[n],
                    )
                    if n + 1 < len(loads):
                        _no_more(at[n], at[n + 1])


@njit(cache=True, error_model="numpy")
def _touches(near, count, cover, depth, span):
    """m2 of the face, covered by springs that touch in the middle."""
    found = 0.0
    for j in range(count):
        if span[0] <= near.number[j] < span[1] and near.height[j] < depth:
            found += cover[near.number[j]]
    return found


@njit(cache=True, error_model="numpy")
def _conduct(points, near, count, what, area, load, where, law, bodies, crown, shape, flat, row):
    """Fills a row of `conducted`. near, count: the springs that touch. what: (n,) heights m, cover m2, slopes m; m, by
    which springs sink in; (C,) m2 of the contact at each point; (C,), room. where: what `lie` takes after the moments,
    without a least length. load: N on a rigid face and on one like the pad. crown, shape: of _crown, within the
    roughness and without it. flat: the share of what the mesh covers of the face that touches. Heat is constricted here
    from the patch in whose gas it spreads to the contact: not where the two are one, under a flush face."""
    heights, cover, slopes, depth, touching, beside = what
    resistance, series = bodies
    face, found, rigid = where[-2], np.zeros(5), law.modulus > 0.0
    least, round, touches = 0.0, 0.0, _contact_moments(points, near, count, touching)
    gaps, free, given, of_line, long = heights, 1.0, 0.0, 0.0, 0.0
    curved, stiffly, load = min(flat, 1.0), load[0], load[0] + flat * (load[1] - load[0])
    if area > 0.0:
        lie(touches, *where, 0.0, found)
        row[4] = found[4]
    if rigid and area > 0.0:
        long = max(row[4], area / row[4])
        round, hertz = min(area / row[4] ** 2, row[4] ** 2 / area), area
        soft = heights, cover, slopes, max(depth, 0.0), area, long, shape, law
        sunk, whole, curved, rounder, load = _softly(soft, round, flat, stiffly, load)
        if sunk > soft[3]:
            given, round = 1.0 - (soft[3] + law.roughness) / (sunk + law.roughness), rounder
            area, most = _touch_at(heights, cover, slopes, sunk, touching), cover[: len(touching)].sum()
            touches, hertz, depth = _all_moments(points, touching), area, sunk
            if shape[0] > 0.0:
                of_line = long if round <= _LINE else 0.0
                hertz, held = _on_rigid(shape, of_line, area, whole, sunk, law)
                hertz = min(hertz, most)
                load *= held + curved * (1.0 - held)
                if of_line == 0.0:
                    gaps = _hertz_gaps(heights[: len(touching)], sunk, given, law.roughness)
            else:
                lie(touches, *where, 0.0, found)
                long = max(found[4], area / found[4])
                round = area / long**2
            free = (most - hertz) / (most - area) if area < hertz else 1.0
        elif crown[0] > 0.0:
            hertz, round = _hertz(crown, load, long, law.modulus)
            hertz = min(hertz, cover[: len(touching)].sum() if _at_edge(crown[2], law) else area)
        if hertz != area:
            touching *= hertz / area
            touches = mixed(touches, hertz / area, touches, 0.0)
            area = hertz
        least = min(long, face) * (1.0 - _compact(round))
    solid = 0.0
    if area > 0.0:
        solid = conductance(law, load / area) * area
        solid = constricted(law, area, solid, law.constriction * _compact(round) * (1.0 - curved))
        lie(touches, *where, least, found)
        row[4] = found[4]
    gas, less, around = 0.0, 0.0, touches
    if law.mean_gap > 0.0:
        gap = law.mean_gap - depth, law.mean_gap, law.gas * resistance
        less, around = _beside(points, gaps, cover, touching, gap, beside)
        conducts = law.gas * free
        gas, less, around = conducts * around.s, conducts * less, mixed(around, conducts, around, 0.0)
    total, wide, whole = solid + gas, area, area
    freely = gas
    if gas > 0.0 or (given > 0.0 and law.mean_gap > 0.0):
        # what would flow under the contact without force is as wide as beside a constricted one, and no less where all
        # of a body that gives way has come to touch
        freely, row[5] = min(gas + law.gas / law.mean_gap * area, total), row[4]
    if gas > 0.0:
        rest = max(face * face - area, 0.0)
        wide += min(gas * less * resistance / (gas - less), rest) if gas > less else rest
        whole = wide
        if not rigid:
            wide = area + (wide - area) * gas / freely
        elif of_line > 0.0:
            # what gives way without constricting heat spreads as under a skin
            wide = area + (wide - area) * (1.0 - given * (1.0 - gas / freely))
        lie(mixed(around, wide / gas, around, 0.0), *where, least, found)
        row[5] = found[4]
    small = area
    if total > 0.0:
        patch = ((total - freely) * area + freely * wide) / total
        # of a line, whose constriction is not told yet
        apart = (1.0 - _compact(round)) * (1.0 - min(curved, 1.0))
        if rigid and gas > 0.0 and area > 0.0 and apart > 0.0 and total - freely > _FEW * total:
            flows = two_flows(total - freely, freely, area, whole, resistance, series, min(long, face))
            if flows > patch:
                patch += apart * (flows - patch)
                small, wide = widened(total - freely, freely, area, whole, patch)
        one, other = solid / area if area > 0.0 else 0.0, 1.0 if gas > 0.0 else 0.0
        lie(mixed(touches, patch / total * one, around, patch / total * other), *where, least, found)
    row[:4] = found[:4]
    row[6], row[7], row[8], row[9] = total - freely, freely, small, wide


@njit(cache=True, error_model="numpy")
def _contact_moments(points, near, count, touching):
    """Moments of what touches."""
    s, y, z, yy, yz, zz = 0.0, 0.0, 0.0, 0.0, 0.0, 0.0
    for j in range(count):
        i = near.number[j]
        if i >= len(touching):
            break
        w, at, along = touching[i], points[i, 0], points[i, 1]
        s, y, z = s + w, y + w * at, z + w * along
        yy, yz, zz = yy + w * at * at, yz + w * at * along, zz + w * along * along
    return Moments(s, y, z, yy, yz, zz)


@njit(cache=True, error_model="numpy")
def _all_moments(points, touching):
    """Moments of what touches, of all points of the face."""
    s, y, z, yy, yz, zz = 0.0, 0.0, 0.0, 0.0, 0.0, 0.0
    for i in range(len(touching)):
        w, at, along = touching[i], points[i, 0], points[i, 1]
        s, y, z = s + w, y + w * at, z + w * along
        yy, yz, zz = yy + w * at * at, yz + w * at * along, zz + w * along * along
    return Moments(s, y, z, yy, yz, zz)


@njit(cache=True, error_model="numpy")
def _softly(soft, round, flat, stiffly, load):
    """(m and m2 of _given_way, how flat what touches counts, its breadth over its length, N on the face) of a body that
    may give way. soft: of _given_way, but for the force and whether it is a line. round, flat: as roughness and springs
    have them. stiffly, load: N that a rigid face bears, and one of that flatness."""
    shape, depth, law, counts = soft[6], soft[3], soft[7], min(flat, 1.0)
    if shape[0] == 0.0:
        sunk, whole = _given_way(soft, round <= _LINE, load)
        return sunk, whole, counts, round, load
    _, rounder = _hertz(shape, load, soft[5], law.modulus)
    sunk, whole = _given_way(soft, rounder <= _LINE, stiffly)
    if sunk > depth and flat > _CURVED:
        # a crown is the less flat the further it has given way
        less = (depth + law.roughness) / (sunk + law.roughness)
        softer = stiffly + less * (load - stiffly)
        sunk, whole = _given_way(soft, rounder <= _LINE, softer)
        if sunk > depth:
            return sunk, whole, counts * less, rounder, softer
    return sunk, whole, counts, rounder, load


@njit(cache=True, error_model="numpy")
def _given_way(soft, line, load):
    """(m by which a body is flattened, less its roughness; m2 of the pad that a spot touches then); the depth and 0 m2
    where springs and roughness are more than that. soft: (n,) heights m, cover m2 and slopes m; the depth m, m2 of the
    face that touches then, m that this is long; of _crown; the law. line: whether it is one. load: N."""
    heights, cover, slopes, depth, area, long, shape, law = soft
    rough, modulus = law.roughness, law.modulus
    low = depth + rough
    if line:
        return max(load / (math.pi / 2 * modulus * long) - rough, depth), 0.0
    curved, level, whole = math.sqrt(shape[0] * shape[1]), low, 0.0
    high = 2 * load / (_SPOT * modulus * math.sqrt(area / math.pi))
    if curved > 0.0:
        whole = math.pi * (0.75 * load / (curved * modulus)) ** (2 / 3)
        level = _as_sphere(whole * curved / (2 * math.pi), curved)
        if whole < math.pi * _AROUND**2:
            return (level - rough, whole) if level > low else (depth, 0.0)
    if high <= low:
        return depth, 0.0
    level = min(max(level, low), high)
    for _ in range(_STEPS):
        whole = _touched_at(heights, cover, slopes, level - rough)
        bears = _SPOT * modulus * math.sqrt(whole / math.pi) * _as_paraboloid(level, curved)
        if bears < load:
            low = level
        elif level == low:
            return depth, 0.0
        else:
            high = level
        further = level * (load / bears) ** (2 / 3)  # exactly so under a paraboloid
        if not low < further < high:
            further = (low + high) / 2
        close = abs(further - level) <= _CLOSE * level
        level = further
        if close:
            break
    return (level - rough, whole) if level - rough > depth else (depth, 0.0)


@njit(cache=True, inner=True, error_model="numpy")
def _as_paraboloid(height, curved):
    """m, of a paraboloid of that curvature 1/m, as wide as a sphere is at that height m: Hertz's laws are of one."""
    return height * max(1.0 - curved * height / 2, 0.5)


@njit(cache=True, inner=True, error_model="numpy")
def _as_sphere(height, curved):
    """The reverse, no higher than the sphere's middle."""
    return (1.0 - math.sqrt(max(1.0 - 2 * curved * height, 0.0))) / curved


@njit(cache=True, error_model="numpy")
def _touched_at(heights, cover, slopes, depth):
    """m2 of all springs at that depth m."""
    area = 0.0
    for i in range(len(heights)):
        area += cover[i] * min(max((depth - heights[i]) / max(slopes[i], LEAST_RISE) + 0.5, 0.0), 1.0)
    return area


@njit(cache=True, error_model="numpy")
def _touch_at(heights, cover, slopes, depth, touching):
    """m2 of the face at that depth m. Fills touching (C,) m2."""
    for i in range(len(touching)):
        part = min(max((depth - heights[i]) / max(slopes[i], LEAST_RISE) + 0.5, 0.0), 1.0)
        touching[i] = cover[i] * part
    return touching.sum()


@njit(cache=True, error_model="numpy")
def _on_rigid(shape, of_line, area, whole, sunk, law):
    """(m2 of the face, the part of the force on it) under a crown that has given way, as if it were over the face's
    middle if the contact goes beyond the face. whole, sunk: as _given_way has them. of_line: m, of a line, 0 of a spot.
    area: m2 of the face that touches."""
    half = law.half_face
    if of_line > 0.0:
        wide, held = math.sqrt(2 * (sunk + law.roughness) / shape[0]), 1.0
        if shape[2] + wide <= half:
            return min(2 * wide * of_line, area), 1.0
        if wide > half:
            share = half / wide
            wide, held = half, (3 - share * share) * share / 2
        return 2 * wide * of_line, held
    if shape[2] + math.sqrt(whole / math.pi) <= half:
        return min(whole, area), 1.0
    part, held = disc_on_face(whole / math.pi, half, 0.0, 0.0)
    return whole * part, held


@njit(cache=True, error_model="numpy")
def _hertz_gaps(heights, sunk, given, rough):
    """(C,) m: heights by which the gap beside a flattened crown is Hertz's. given: how much of it is due to the body,
    not to roughness and springs; where nothing is, the gap is the shape's own."""
    gaps, level = heights.copy(), sunk + rough
    for i in range(len(gaps)):
        square = (heights[i] - sunk) / level
        if square > 0.0:
            x = math.sqrt(square)
            hertz = 2 / math.pi * (x + (square - 1.0) * math.atan(x))
            gaps[i] -= given * level * (square - hertz)
    return gaps


@njit(cache=True, error_model="numpy")
def _beside(points, heights, cover, touching, gap, rows):
    """(m, moments over m) of what does not touch, over its gap: of the moments' gaps m `gap` has what is above the
    heights and the least of all, and for the first a length more. rows: (C,), room."""
    gap_height, narrowest, more = gap
    side = round(math.sqrt(len(touching)))
    sums = rows[: 4 * side].reshape(4, side)
    sums[:] = 0.0
    gently, flows, along, squares = sums[0], sums[1], sums[2], sums[3]
    for row in range(side):
        # a row's sums do not depend on each other, so that they are made side by side
        z = points[row * side, 1]
        for k in range(side):
            i = row * side + k
            free, far = max(cover[i] - touching[i], 0.0), max(gap_height + heights[i], narrowest)
            flow = free / far
            gently[k] += free / (far + more)
            flows[k] += flow
            along[k] += flow * z
            squares[k] += flow * z * z
    less, s, y, z, yy, yz, zz = 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0
    for k in range(side):
        at = points[k, 0]
        less += gently[k]
        s, y, z = s + flows[k], y + flows[k] * at, z + along[k]
        yy, yz, zz = yy + flows[k] * at * at, yz + along[k] * at, zz + squares[k]
    return less, Moments(s, y, z, yy, yz, zz)


@njit(cache=True, inner=True, error_model="numpy")
def _compact(round):
    return min(max((round - _LINE) / (_COMPACT - _LINE), 0.0), 1.0)


@njit(cache=True, error_model="numpy")
def _no_more(row, above):
    """Lets a row of `conducted` conduct no more than that of the next force, however that touches."""
    row[7] = min(row[7], above[6] + above[7])
    row[6] = min(row[6], above[6] + above[7] - row[7])


@njit(cache=True, error_model="numpy")
def _crown(points, heights, cover, counted, law):
    """(1/m, 1/m, m): how curved the mesh is, more and less, around what of it comes to the face first; 0 and 0 where
    that is no crown: flat, or a shape that no paraboloid is. How far that is from the face's middle, along the side
    where it is further."""
    low, total, y, z = np.inf, 0.0, 0.0, 0.0
    for i in range(counted):
        if cover[i] > 0.0:
            low = min(low, heights[i])
    for i in range(counted):
        if cover[i] > 0.0 and heights[i] <= low + law.roughness:
            total += cover[i]
            y += cover[i] * points[i, 0]
            z += cover[i] * points[i, 1]
    y, z = y / total, z / total
    off = max(abs(y), abs(z))
    terms = 6 if _at_edge(off, law) else 4  # beside a crown the surface slopes, too
    matrix, right, square, count = np.zeros((terms, terms)), np.zeros(terms), 0.0, 0
    row = np.ones(6)
    for i in range(counted):
        u, v = (points[i, 0] - y) / _AROUND, (points[i, 1] - z) / _AROUND
        if u * u + v * v < 1.0 and cover[i] > 0.0:
            height = heights[i] - low
            row[1], row[2], row[3], row[4], row[5] = u * u, v * v, u * v, u, v
            for j in range(terms):
                right[j] += row[j] * height
                for k in range(terms):
                    matrix[j, k] += row[j] * row[k]
            square += height**2
            count += 1
    if count < _FEWEST:
        return 0.0, 0.0, off
    for j in range(terms):
        matrix[j, j] += _UPRIGHT * count  # of points in a line
    found = np.linalg.solve(matrix, right)
    spread = square - right[0] ** 2 / count
    left = square - (found * right).sum()
    mean, half = (found[1] + found[2]) / 2, np.hypot((found[1] - found[2]) / 2, found[3] / 2)
    most, least = 2 * (mean + half) / _AROUND**2, 2 * (mean - half) / _AROUND**2
    if not (most > 1 / _FLATTEST and left < _UNLIKE * spread):
        return 0.0, 0.0, off
    return most, max(least, 0.0), off


@njit(cache=True, inner=True, error_model="numpy")
def _at_edge(off, law):
    """Whether a crown is at the face's edge, or beyond it."""
    return off > law.half_face - _AROUND


@njit(cache=True, error_model="numpy")
def _hertz(crown, load, long, modulus):
    """(m2 of Hertz's contact on a crown, how round it is: its breadth over its length). long: m, of the contact, where
    the crown is a line."""
    most, least, _ = crown
    round = (least / most) ** (2 / 3)  # nearly, of Hertz's ellipse
    if round <= _LINE:
        return 4 * np.sqrt(load * long / (most * np.pi * modulus)), round
    return np.pi * (0.75 * load / (np.sqrt(most * least) * modulus)) ** (2 / 3), round
