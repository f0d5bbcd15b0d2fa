"""What a sensor's face and the pad around it touch of a mesh, and what that conducts.

A face with a skin sinks in on its springs. A bare one of lapped alumina does not: a mesh's crests lie on it, what of
them is within the faces' roughness of the highest touches, on springs as stiff as a column of alumina. Spots conduct
there and constrict the heat where they are small. Gas conducts beside what touches over the gap, place by place. Two
patches of even conductance stand for both, as they do under a ball (thermal/contact/spread.py).

Under a crest the rigid face bears nearly all of the force. A flat face meets it flush with the pad, whose springs are
then taken as the same all over, as they are for boxes (thermal/contact/area.py). In between, the share that touches of
what the mesh covers of the face tells how flat that is.

A soft mesh gives way further than its roughness (soft.py).
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
    Beneath,
    Pad,
    conductance,
    constricted,
    flows_of_line,
    through_soft,
    widened,
)
from .crown import CURVED, LINE, at_edge, compact, crown_at, hertz_contact
from .height_map import HeightMap, map_heights
from .lying import Moments, lie, mixed
from .soft import hertz_gaps, on_rigid, softly, touch_at
from .springs import (
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

_FEW = 1e-6  # of what both conduct: less is no contact


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
    _press(*_arguments(pad, ring, law, where), Beneath(0.0, 0.0, 0.0, 0.0, 0.0), touched)
    return touched


def conducted(pad: Pad, law: np.void, below: Beneath, where: Seen) -> np.ndarray:
    """(FORCES, rows, columns, 10) of the sensor's face: the shares by which what conducts lies at an end of the face
    along both axes, and of the mesh (thermal/contact/patch_place.py); m, how long the patches of the contact and of the
    gas are along the second axis; W/K of both; m2 of the patches. pad, law: as pressed has them. below: of
    both bodies."""
    found = where.room(10)
    _press(*_arguments(pad, None, law, where), below, found)
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
    counted, span, loads, forces, near, soft, law, below, found,
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
            shape = crown_at(points, heights, cover, counted, law) if rigid and of_face else no_crown
            if rigid:
                for i in range(len(points)):
                    heights[i] = max(heights[i] - law.roughness, 0.0)
            rises(heights, cover, slopes[:counted])
            crown = crown_at(points, heights, cover, counted, law) if rigid and of_face else no_crown
            covered = cover[span[0] : span[1]].sum()
            count = under(heights, cover, stiffness, slopes, near)
            evenly = under(heights, cover, even, slopes, soft) if rigid else 0
            depth, soft_depth = np.inf, np.inf
            for n in range(len(loads) - 1, -1, -1):
                depth, area, share = borne(near, count, cover, loads[n], depth, touching)
                count = touched_less(near, count, depth)
                flat = _touches(near, count, cover, depth, span) / covered if rigid and covered > 0.0 else 0.0
                if flat > CURVED:
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
                        below,
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
def _conduct(points, near, count, what, area, load, where, law, below, crown, shape, flat, row):
    """Fills a row of `conducted`. near, count: the springs that touch. what: (n,) heights m, cover m2, slopes m; m, by
    which springs sink in; (C,) m2 of the contact at each point; (C,), room. where: what `lie` takes after the moments,
    without a least length. load: N on a rigid face and on one like the pad. crown, shape: of crown_at, within the
    roughness and without it. flat: the share of what the mesh covers of the face that touches. Heat is constricted here
    from the patch in whose gas it spreads to the contact: not where the two are one, under a flush face."""
    heights, cover, slopes, depth, touching, beside = what
    resistance = below.straight + below.sheet
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
        sunk, whole, curved, rounder, load = softly(soft, round, flat, stiffly, load)
        if sunk > soft[3]:
            given, round = 1.0 - (soft[3] + law.roughness) / (sunk + law.roughness), rounder
            area, most = touch_at(heights, cover, slopes, sunk, touching), cover[: len(touching)].sum()
            touches, hertz, depth = _all_moments(points, touching), area, sunk
            if shape[0] > 0.0:
                of_line = long if round <= LINE else 0.0
                hertz, held = on_rigid(shape, of_line, area, whole, sunk, law)
                hertz = min(hertz, most)
                load *= held + curved * (1.0 - held)
                if of_line == 0.0:
                    gaps = hertz_gaps(heights[: len(touching)], sunk, given, law.roughness)
            else:
                lie(touches, *where, 0.0, found)
                long = max(found[4], area / found[4])
                round = area / long**2
            free = (most - hertz) / (most - area) if area < hertz else 1.0
        elif crown[0] > 0.0:
            hertz, round = hertz_contact(crown, load, long, law.modulus)
            hertz = min(hertz, cover[: len(touching)].sum() if at_edge(crown[2], law) else area)
        if hertz != area:
            touching *= hertz / area
            touches = mixed(touches, hertz / area, touches, 0.0)
            area = hertz
        least = min(long, face) * (1.0 - compact(round))
    solid = 0.0
    if area > 0.0:
        solid = conductance(law, load / area) * area
        solid = constricted(law, area, solid, law.constriction * compact(round) * (1.0 - curved))
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
    if gas > 0.0:
        rest = max(face * face - area, 0.0)
        whole += min(gas * less * resistance / (gas - less), rest) if gas > less else rest
        wide = whole
        if area > 0.0 and not rigid:
            solid = through_soft(solid, gas, area, max(row[4], area / row[4]), face, whole, below)
            total = solid + gas
    if rigid and (gas > 0.0 or (given > 0.0 and law.mean_gap > 0.0)):
        # what would flow under the contact without force is as wide as beside a constricted one, and no less where all
        # of a body that gives way has come to touch
        freely, row[5] = min(gas + law.gas / law.mean_gap * area, total), row[4]
    if gas > 0.0:
        if of_line > 0.0:
            # what gives way without constricting heat spreads as under a skin
            wide = area + (wide - area) * (1.0 - given * (1.0 - gas / freely))
        lie(mixed(around, wide / gas, around, 0.0), *where, least, found)
        row[5] = found[4]
    small = area
    if total > 0.0:
        patch = ((total - freely) * area + freely * wide) / total
        # on a rigid face of a line, since a spot's constriction is told
        apart = (1.0 - compact(round)) * (1.0 - min(curved, 1.0)) if rigid else 1.0
        if gas > 0.0 and area > 0.0 and apart > 0.0 and total - freely > _FEW * total:
            flows = whole
            if rigid:
                flows = flows_of_line(total - freely, freely, area, whole, below, min(long, face))
            if flows > patch:
                patch += apart * (flows - patch)
                small, wide = widened(total - freely, freely, area, whole, patch)
                lie(mixed(touches, small / area, touches, 0.0), *where, least, found)
                row[4] = found[4]
                lie(mixed(around, wide / gas, around, 0.0), *where, least, found)
                row[5] = found[4]
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


@njit(cache=True, error_model="numpy")
def _no_more(row, above):
    """Lets a row of `conducted` conduct no more than that of the next force, however that touches."""
    row[7] = min(row[7], above[6] + above[7])
    row[6] = min(row[6], above[6] + above[7] - row[7])
