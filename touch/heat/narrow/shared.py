"""Contacts that share a sensor's face: what the heat of one does where another is.

On the sensor's side a narrow contact falls by T more than the mean over the face. What flows through another contact of
the same face changes that mean, and the fall beside it. Both are told by how the face's temperature falls in products
of cosines along its axes, per flow in them: with the means a_n of these over contact i, and g_n of face_modes,

    M_ij = sum of c_n g_n a_n(i) a_n(j),   c = 2 along each axis on which a product is not even

is the fall of i per flow through j. The few products that are known are nearly all of M, as two contacts lie apart,
and the most of T. They hold of even flow; where it crowds to the edges of a contact, its T is less, and its a are
smaller by the root of that. What T has beyond them is its own. Two contacts that cover the face fall by nothing where
as much flows through either's area.

How far a contact lies from the face's middle is known, and not on which side: the sides are those on which contacts
overlap the least and lie apart the most. Of more than SHARED contacts the largest share the face.

The states stay one set a contact, and passive: with L of Cholesky's decomposition of M and of what the contacts have by
themselves, contact i sends to the states of contact j by L_ij, and receives by the same.

C: contacts of a group, K: states.
"""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np

from thermograsp.compiled import njit

from ....thermal.contact import offset_of_share
from .tables import MODES

SHARED = 4
"""Contacts of a face that know of one another."""
SPREAD = 1e-3
"""Of the face's width, an overlap that is worth as much as lying apart by all of it."""
FIRM = 1 + 1e-9
"""By which contacts have more than they have of one another: round-off is not divided by."""
ALIKE = 1e-9
"""Of the face's area, by which sides that are as good as the best may be worse: round-off does not decide."""


class FaceRoom(NamedTuple):
    """Memory of a group's contacts that may share a face. places: (C, 4) length and offset m along both axes. own: (C,
    K) T. waves: (SHARED, 2, MODES) a. order: (C,) which of those that share its face a contact is, from 0 on, -1 for
    none; members: (C, SHARED) the contacts before it and itself. lower: (C, SHARED, K) L. mutual: (C C,) K/W, above the
    diagonal, what one's flow does at another within a step."""

    places: np.ndarray
    own: np.ndarray
    waves: np.ndarray
    order: np.ndarray
    members: np.ndarray
    lower: np.ndarray
    mutual: np.ndarray


def face_room_size(contacts: int, states: int) -> int:
    """Numbers of which `face_room` makes a FaceRoom."""
    return contacts * (5 + SHARED + contacts + (1 + SHARED) * states) + 2 * SHARED * MODES


@njit(cache=True, inner=True, borrows=True, error_model="numpy")
def face_room(numbers, contacts, states):
    """A FaceRoom."""
    own = 4 * contacts
    waves = own + contacts * states
    order = waves + 2 * SHARED * MODES
    members = order + contacts
    lower = members + contacts * SHARED
    mutual = lower + contacts * SHARED * states
    end = mutual + contacts * contacts
    return FaceRoom(
        numbers[:own].reshape((contacts, 4)),
        numbers[own:waves].reshape((contacts, states)),
        numbers[waves:order].reshape((SHARED, 2, MODES)),
        numbers[order:members],
        numbers[members:lower].reshape((contacts, SHARED)),
        numbers[lower:mutual].reshape((contacts, SHARED, states)),
        numbers[mutual:end],
    )


@njit(cache=True, borrows=True, error_model="numpy")
def note_place(place, area, length, aside, width):
    """Fills place (4,) of a contact of that area m2 and length m, which lies aside (2,) by those shares; area 0 stands
    for the whole face, of that width m."""
    first, second = width, width
    if area > 0.0:
        first = min(area / length, width)
        second = min(area / first, width)
    place[0], place[1] = first, offset_of_share(aside[0], first, width)
    place[2], place[3] = second, offset_of_share(aside[1], second, width)


@njit(cache=True, borrows=True, error_model="numpy")
def share_faces(
    pairs, contacts, tips, patterns, dt, grown, decay, modes, widths, narrow, roots, room, resistance, difference
):  # fmt: skip
    """What those of a group's contacts that share a face do to one another: fills their L, and adds to resistance (m,)
    and room.mutual, K/W, and to difference (m,) K.

    pairs: integers, of each contact the sensor, numbers from tips on being none, and the target; contacts of a sensor
    follow one another. Contact i has row i patterns of roots (m, K): the root of T and what the other side has before,
    L_ii behind it. grown: (K,) s, of a flow in a state after a step of dt s. decay: (K,) 1/s. modes: (F, MODES, MODES,
    K) of face_modes. widths: m. narrow: (F, T, K) the states."""
    for i in range(contacts * contacts):
        room.mutual[i] = 0.0
    begin = 0
    while begin < contacts:
        f, end = pairs[2 * begin], begin + 1
        while end < contacts and pairs[2 * end] == f:
            end += 1
        count = _number(room, begin, end) if f < tips and end > begin + 1 else 0
        if count > 1:
            members = room.members[end - 1]
            _choose_sides(room.places, members, count, widths[f])
            for a in range(count):
                i = int(members[a])
                _fill_waves(room.waves[a], room.places[i], widths[f])
                _part(room.own[i], room.waves[a], modes[f], decay, roots[i * patterns], room.lower[i, a])
                for b in range(a):
                    _couple(room.waves[a], room.waves[b], modes[f], room.lower[i, b])
            _decompose(room.lower, members, count)
            for a in range(count):
                i = int(members[a])
                state, port, row = narrow[f, pairs[2 * i + 1]], i * patterns, room.lower[i]
                for k in range(len(decay)):
                    mean = grown[k] / dt  # of a state that fades, over the step
                    behind = (row[a, k] - roots[port, k]) * state[k]
                    own = -roots[port, k] * roots[port, k]
                    for n in range(a + 1):
                        own += row[n, k] * row[n, k]
                    for p in range(patterns):
                        resistance[port + p] += own * (1 - mean) / decay[k]
                    roots[port, k] = row[a, k]
                    for b in range(a):
                        j = int(members[b])
                        behind += row[b, k] * narrow[f, pairs[2 * j + 1], k]
                        both = 0.0
                        for n in range(b + 1):
                            both += row[n, k] * room.lower[j, n, k]
                        room.mutual[j * contacts + i] += both * (1 - mean) / decay[k]
                    difference[port] -= mean * behind
        else:
            for i in range(begin, end):
                room.order[i] = -1
        begin = end


@njit(cache=True, borrows=True, error_model="numpy")
def send_across(pairs, contacts, patterns, grown, narrow, room, flow):
    """What flows W (m,) of contacts that share a face send to the states of those before them; arguments as of
    share_faces."""
    for i in range(contacts):
        for a in range(int(room.order[i])):
            target = pairs[2 * int(room.members[i, a]) + 1]
            for k in range(len(grown)):
                narrow[pairs[2 * i], target, k] += grown[k] * room.lower[i, a, k] * flow[i * patterns]


@njit(cache=True, inner=True, borrows=True, error_model="numpy")
def _number(room, begin, end):
    """How many of contacts begin .. end, which are all of a face, share it, and which; the largest, in their order."""
    count = 0
    for i in range(begin, end):
        larger, area = 0, room.places[i, 0] * room.places[i, 2]
        for j in range(begin, end):
            other = room.places[j, 0] * room.places[j, 2]
            larger += other > area or (other == area and j < i)
        room.order[i] = -1
        if larger < SHARED:
            room.order[i] = count
            for j in range(i, end):
                room.members[j, count] = i
            count += 1
    return count


@njit(cache=True, inner=True, borrows=True, error_model="numpy")
def _choose_sides(places, members, count, width):
    """Gives the offsets of places (C, 4) of the members signs."""
    ways = 1 << (count - 1)  # the first is on one side
    least = np.inf
    for repeat in range(2):
        for way in range(ways * ways):
            cost = 0.0
            for a in range(count):
                one, flips = places[int(members[a])], (way << 1, (way // ways) << 1)
                for b in range(a):
                    other = places[int(members[b])]
                    overlap, apart = 1.0, 0.0
                    for axis in range(2):
                        first = -one[2 * axis + 1] if flips[axis] >> a & 1 else one[2 * axis + 1]
                        second = -other[2 * axis + 1] if flips[axis] >> b & 1 else other[2 * axis + 1]
                        off = abs(first - second)
                        overlap *= max((one[2 * axis] + other[2 * axis]) / 2 - off, 0.0)
                        apart += off
                    cost += overlap - SPREAD * width * apart
            if repeat == 0:
                least = min(least, cost)
            elif cost <= least + ALIKE * width * width:
                for a in range(count):
                    place = places[int(members[a])]
                    for axis, flips in enumerate((way << 1, (way // ways) << 1)):
                        if flips >> a & 1:
                            place[2 * axis + 1] = -place[2 * axis + 1]
                return


@njit(cache=True, inner=True, borrows=True, error_model="numpy")
def _fill_waves(waves, place, width):
    """Fills waves (2, MODES) with the means of cosines over a contact at place (4,)."""
    for axis in range(2):
        length, offset = place[2 * axis], place[2 * axis + 1]
        waves[axis, 0] = 1.0
        for n in range(1, MODES):
            half = n * math.pi * length / (2 * width)
            waves[axis, n] = math.cos(n * math.pi * (offset / width + 0.5)) * math.sin(half) / half


@njit(cache=True, inner=True, borrows=True, error_model="numpy")
def _couple(one, other, modes, squares):
    """Fills squares (K,) with what contacts of these waves (2, MODES) have of one another."""
    for k in range(len(squares)):
        squares[k] = 0.0
    for n in range(MODES):
        along = one[0, n] * other[0, n] * (2.0 if n > 0 else 1.0)
        for m in range(MODES):
            both = along * one[1, m] * other[1, m] * (2.0 if m > 0 else 1.0)
            for k in range(len(squares)):
                squares[k] += both * modes[n, m, k]


@njit(cache=True, inner=True, borrows=True, error_model="numpy")
def _part(own, waves, modes, decay, root, squares):
    """Fills squares (K,) with what a contact has in all, by waves (2, MODES), which become smaller where its own (K,)
    is less: as much of its own as the waves do not tell, in the end, and what is in root (K,) besides."""
    _couple(waves, waves, modes, squares)
    known, total, beyond = 0.0, 0.0, 0.0
    for k in range(len(decay)):
        known += squares[k] / decay[k]
        total += own[k] / decay[k]
    less = min(total / known, 1.0) if known > 0.0 else 1.0
    for n in range(MODES):  # a product of both axes shrinks with one of them
        waves[0, n] *= math.sqrt(less)
    for k in range(len(decay)):
        beyond += max(own[k] - less * squares[k], 0.0) / decay[k]
    rest = max(total - less * known, 0.0) / beyond if beyond > 0.0 else 0.0
    for k in range(len(decay)):
        besides = max(root[k] * root[k] - own[k], 0.0)
        squares[k] = less * squares[k] + rest * max(own[k] - less * squares[k], 0.0) + besides
        squares[k] *= FIRM


@njit(cache=True, inner=True, borrows=True, error_model="numpy")
def _decompose(lower, members, count):
    """From squares in the rows of lower (C, SHARED, K) of the members to L."""
    for a in range(count):
        row = lower[int(members[a])]
        for k in range(row.shape[1]):
            for b in range(a):
                other = lower[int(members[b])]
                for n in range(b):
                    row[b, k] -= row[n, k] * other[n, k]
                # what is left of the other is round-off where it is all known
                row[b, k] = row[b, k] / other[b, k] if other[b, k] > 0.0 else 0.0
                row[a, k] -= row[b, k] * row[b, k]
            row[a, k] = math.sqrt(max(row[a, k], 0.0))
