"""The contacts of a step, from MuJoCo's memory or from what contact sensors recorded: their sums on each pad, then what
each pad feels.

F: fingertips, N: what a pad may meet, C: contacts.
"""

# mujoco ships no type stubs for its compiled names
# pyright: reportAttributeAccessIssue=false

from __future__ import annotations

import math

import mujoco

from thermograsp.compiled import njit

from ...thermal.contact import CURVED_TABLE
from ...thermal.padded import RINGS
from ..pointers import flags, floats, integers, laws, words
from .columns import COLUMNS
from .memory import (
    CONTACTS,
    DIM,
    EFC,
    FORCES,
    FRAME,
    GEOM,
    GEOM_XMAT,
    GEOM_XPOS,
    POS,
    STRIDE,
    TYPES,
    WORDS,
    XMAT,
    XPOS,
)
from .pad_contacts import PAD, PLACED, SPOT, begin, feel, lies, place_pad, press
from .round_pads import BEND, CURVES
from .sensors import FORCE_AT, PLACE_AT
from .tilt import TILT
from .views import VIEW

_PYRAMID = int(mujoco.mjtConstraint.mjCNSTR_CONTACT_PYRAMIDAL)


@njit(cache=True, borrows=True, error_model="numpy", short_loops=True)
def read_contacts(count, substeps, memory_at, entries_at):
    """Adds `count` contacts to touches and beside. memory_at: the address of ContactMemory's table; entries_at: that of
    addresses and sizes of a ContactReader's arrays. Numbers are handed over in a fraction of the time that arrays take.
    Returns 1, and 0 where a force is not finite or a table could not be made."""
    memory, entries = words(memory_at, WORDS), words(entries_at, 24)
    counted = words(entries[16], 1)
    tips, targets, part_count = entries[18], entries[19], entries[20]
    sides = entries[22]
    role = words(entries[0], entries[17])
    pads = floats(entries[1], (tips, PAD))
    parts = words(entries[2], (part_count, 4))
    bend = floats(entries[3], (tips, BEND))
    curve = floats(entries[4], (part_count, 3, CURVES))
    pushed = floats(entries[5], (tips, part_count, 3))  # room for forces and moments
    touches = floats(entries[6], (tips, targets, COLUMNS))
    beside = floats(entries[7], tips)
    law = laws(entries[8], (tips, part_count, 6))
    curved = words(entries[9], (tips, part_count, sides, 1 + RINGS))
    tables = floats(entries[10], (entries[21], CURVED_TABLE))
    frames, spot = floats(entries[11], (tips, PLACED)), floats(entries[12], SPOT)
    tilts = floats(entries[13], (tips, part_count, 3, TILT))
    views, radii = floats(entries[14], (part_count, sides, VIEW)), floats(entries[15], (part_count, sides))
    place = words(memory[CONTACTS], 1)[0]
    numbers = floats(place, (count, memory[STRIDE] // 8))
    whole = integers(place, (count, memory[STRIDE] // 4))
    efc = floats(words(memory[FORCES], 1)[0], 0)  # as many as MuJoCo says
    kind = integers(words(memory[TYPES], 1)[0], 0)
    xpos, xmat = floats(memory[XPOS], (1, 3)), floats(memory[XMAT], (1, 9))
    geom_xpos = floats(memory[GEOM_XPOS], (1, 3))
    geom_xmat = floats(memory[GEOM_XMAT], (1, 9))
    pos, frame = numbers[:, memory[POS] :], numbers[:, memory[FRAME] :]
    geom, dim, address = whole[:, memory[GEOM] :], whole[:, memory[DIM]], whole[:, memory[EFC]]
    weight = float(substeps)
    any_touch = False
    for c in range(count):
        first, second = role[geom[c, 0]], role[geom[c, 1]]
        if first < 0 or second < 0 or address[c] < 0 or first == second:
            continue
        sign = 1.0
        if first >= tips or (second < tips and second < first):
            first, second, sign = second, first, -1.0
        if first >= tips:
            continue
        force = efc[address[c]]
        if kind[address[c]] == _PYRAMID:
            for k in range(1, 2 * (dim[c] - 1)):
                force += efc[address[c] + k]
        if not math.isfinite(force):
            return 0
        if force <= 0.0:
            continue
        if not any_touch:
            begin(pushed, frames)
            any_touch = True
        part = second - tips if second >= tips else part_count - tips + second
        place_pad(pads, parts, xpos, xmat, frames, first)
        sunk = max(-numbers[c, 0], 0.0) / 2  # mjContact's first field is the distance, its place is half way
        on, y, z = lies(pads[first], frames[first], pos[c], frame[c], sign, sunk)
        if second < tips:
            place_pad(pads, parts, xpos, xmat, frames, second)
            on_other, _, _ = lies(pads[second], frames[second], pos[c], frame[c], -sign, sunk)
            on = on and on_other
            if not on:
                beside[second] += weight * force
        if on:
            pushed[first, part, 0] += force
            pushed[first, part, 1] += force * y
            pushed[first, part, 2] += force * z
        else:
            beside[first] += weight * force
    if any_touch and not feel(
        xpos, xmat, geom_xpos, geom_xmat, pads, frames, parts, law, curved, tables, tilts, bend, curve, pushed,
        touches, weight, counted[0] - weight, spot, views, radii, entries[23],
    ):  # fmt: skip
        return 0
    return 1


@njit(cache=True, borrows=True, error_model="numpy", short_loops=True)
def sense_contacts(record_at, first, last, entries_at):
    """read_contacts of recorded sensors, world by world. record_at: the address of the record (W, substeps,
    sensordata), of which the substeps first to last - 1 are read; entries_at: that of ContactReader's `sensing`.
    Returns 1, and 0 where a table could not be made."""
    entries = words(entries_at, 39)
    counted = words(entries[26], 1)
    worlds, size, pairs, poses, geoms = entries[27], entries[28], entries[29], entries[30], entries[31]
    tips, part_count, targets, sides = entries[32], entries[33], entries[34], entries[36]
    record = floats(record_at, (worlds, entries[38], size))
    pair, pose = words(entries[0], (pairs, 3)), words(entries[1], (poses, 3))
    placed = words(entries[2], (geoms, 2))
    turns, offsets = floats(entries[3], (geoms, 9)), floats(entries[4], (geoms, 3))
    pads, parts = floats(entries[5], (tips, PAD)), words(entries[6], (part_count, 4))
    which = words(entries[8], worlds)
    kinds = 1
    for w in range(worlds):
        kinds = max(kinds, which[w] + 1)
    law = laws(entries[7], (kinds, tips, part_count, 6))
    curved = words(entries[19], (kinds, tips, part_count, sides, 1 + RINGS))
    tables = floats(entries[20], (entries[35], CURVED_TABLE))
    views, radii = floats(entries[24], (part_count, sides, VIEW)), floats(entries[25], (part_count, sides))
    tilts = floats(entries[23], (kinds, tips, part_count, 3, TILT))
    frames, spot = floats(entries[21], (tips, PLACED)), floats(entries[22], SPOT)
    bend = floats(entries[9], (tips, BEND))
    curve = floats(entries[10], (part_count, 3, CURVES))
    pushed = floats(entries[11], (tips, part_count, 3))  # room for forces and moments
    # room for the poses of the bodies and geoms, as many as the model has
    xpos, xmat = floats(entries[12], (1, 3)), floats(entries[13], (1, 9))
    geom_xpos, geom_xmat = floats(entries[14], (1, 3)), floats(entries[15], (1, 9))
    touches = floats(entries[16], (worlds, tips, targets, COLUMNS))
    beside, broken = floats(entries[17], (worlds, tips)), flags(entries[18], worlds)
    for w in range(worlds):
        kind = which[w]
        if not _sense_world(
            record, w, first, last, pair, pose, placed, turns, offsets, pads, parts, law[kind], curved[kind], tables,
            tilts[kind], views, radii, bend, curve, pushed, frames, spot, xpos, xmat, geom_xpos, geom_xmat, touches[w],
            beside[w], broken, counted[0] - last, entries[37],
        ):  # fmt: skip
            return 0
    return 1


@njit(cache=True, inner=True, borrows=True, error_model="numpy", forceinline=True)
def _sense_world(
    record, w, first, last, pair, pose, placed, turns, offsets, pads, parts, laws, curved, tables, tilts, views, radii,
    bend, curve, pushed, frames, spot, xpos, xmat, geom_xpos, geom_xmat, touches, beside, broken, ahead, make,
):  # fmt: skip
    """sense_contacts of one world. ahead: how many more substeps the sample has before one than the record. Returns
    whether every table that it needs could be made."""
    pairs, poses, geoms, tips, part_count = len(pair), len(pose), len(placed), len(pads), len(parts)
    for n in range(first, last):
        if broken[w]:
            break
        data, total, any_touch = record[w, n], 0.0, False
        for p in range(pairs):
            at = pair[p, 2]
            total += (
                (data[at + PLACE_AT] + data[at + PLACE_AT + 1])
                + (data[at + PLACE_AT + 2] + data[at + FORCE_AT])
                + (data[at + FORCE_AT + 1] + data[at + FORCE_AT + 2])
                + data[at]
            )
            any_touch = any_touch or data[at] > 0
        for p in range(poses):
            at, quat = pose[p, 1], pose[p, 2]
            total += data[at] + data[at + 1] + data[at + 2]
            total += (data[quat] + data[quat + 1]) + (data[quat + 2] + data[quat + 3])
        if not math.isfinite(total):
            broken[w] = True
            break
        if not any_touch:
            continue
        for p in range(poses):
            body, at, quat = pose[p, 0], pose[p, 1], pose[p, 2]
            a, b, c, d = data[quat], data[quat + 1], data[quat + 2], data[quat + 3]
            for k in range(3):
                xpos[body, k] = data[at + k]
            turn = xmat[body]
            turn[0], turn[4], turn[8] = (
                a * a + b * b - c * c - d * d,
                a * a - b * b + c * c - d * d,
                a * a - b * b - c * c + d * d,
            )
            turn[1], turn[3] = 2 * (b * c - a * d), 2 * (b * c + a * d)
            turn[2], turn[6] = 2 * (b * d + a * c), 2 * (b * d - a * c)
            turn[5], turn[7] = 2 * (c * d - a * b), 2 * (c * d + a * b)
        for g in range(geoms):
            geom, body = placed[g, 0], placed[g, 1]
            for i in range(3):
                x, y, z = xmat[body, 3 * i], xmat[body, 3 * i + 1], xmat[body, 3 * i + 2]
                geom_xpos[geom, i] = xpos[body, i] + (
                    x * offsets[g, 0] + y * offsets[g, 1] + z * offsets[g, 2]
                )
                for k in range(3):
                    geom_xmat[geom, 3 * i + k] = x * turns[g, k] + y * turns[g, 3 + k] + z * turns[g, 6 + k]
        begin(pushed, frames)
        for p in range(pairs):
            if data[pair[p, 2]] > 0:
                first_tip, part = pair[p, 0], pair[p, 1]
                place_pad(pads, parts, xpos, xmat, frames, first_tip)
                if part >= part_count - tips:
                    place_pad(pads, parts, xpos, xmat, frames, part - (part_count - tips))
                press(data, pair[p, 2], pads, bend, frames, first_tip, part, part_count, pushed, beside)
        if not feel(
            xpos, xmat, geom_xpos, geom_xmat, pads, frames, parts, laws, curved, tables, tilts, bend, curve, pushed,
            touches, 1.0, float(ahead + n), spot, views, radii, make,
        ):  # fmt: skip
            return False
    return True
