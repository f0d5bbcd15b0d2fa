"""The compiled part of a sample of heat: which contacts are closed and where, and a step of every field.

W: worlds, F: fingertips, O: objects, T = O + F: targets of a contact and fields, C: groups of a world, K: states.
"""

from __future__ import annotations

import numpy as np
from numba import carray  # pyright: ignore[reportPrivateImportUsage]

from thermograsp.compiled import njit

from ..contacts import (
    AREA,
    ASIDE,
    CLOSED,
    COLUMNS,
    CONDUCTANCE,
    LENGTH,
    NORMAL,
    PLACE,
    flags,
    floats,
    words,
)
from .narrow import STEPS, spread
from .step import CONTACTS, HEADER, PACE, room_of, step

GRID = 0.125  # of the sensor's width: places stand on a grid, so that networks serve many touches
TABLE = 53
"""Of the table that `sample` takes: addresses of JoinedHeat's arrays and their sizes."""
TURN = 0.1  # by which another face of the box must look more at the pad than the one in use
_TIE = 1e-6
"""By how much a face must look more at the pad than the axis before, and a place must be nearer to the next point of
the grid than to the one before: round-off does not decide where a pad is in the middle."""


@njit(cache=True, error_model="numpy")
def settle(
    touches, boxes, widths, reach, faces, middles, sought_faces, sought_middles, new_faces, new_middles,
    closed, stale,
):  # fmt: skip
    """Notes which contacts are closed, (W, F, T), and where; stale (W,) where that is no longer what it was.

    boxes: (O, 18) size, extent and centre m and the axes, row by row. widths: (F,) m of the sensors. reach: (F,) m.
    faces (W, F, O) and middles (W, F, O, 2): the places in use, face -1 for none. A contact that has left its place is
    told by new_faces, else -1, and new_middles, of the nearest place of the grid; not again where that is the one that
    was asked for last, for which the place in use was found to do. Returns how many have left theirs, and how many
    worlds are stale."""
    worlds, tips, targets = closed.shape
    objects, moved = len(boxes), 0
    position, looking, outdated = np.empty(3), np.empty(3), 0
    for w in range(worlds):
        for f in range(tips):
            for t in range(targets):
                now = touches[w, f, t, CONDUCTANCE] > 0
                if now != closed[w, f, t]:
                    closed[w, f, t], stale[w] = now, True
                if t >= objects:
                    continue
                new_faces[w, f, t] = -1
                if not now:
                    continue
                touch, box, most = touches[w, f, t], boxes[t], 0
                for i in range(3):
                    looking[i], position[i] = 0.0, 0.0
                    for k in range(3):
                        axis = box[9 + 3 * k + i]
                        looking[i] += axis * touch[NORMAL + k]
                        position[i] += axis * (touch[PLACE + k] - box[6 + k])
                    position[i] *= box[i] / box[3 + i]
                for i in range(1, 3):
                    if abs(looking[i]) > abs(looking[most]) + _TIE:
                        most = i
                known = faces[w, f, t]
                if known >= 0 and abs(looking[known // 2]) > abs(looking[most]) - TURN:
                    most = known // 2
                face = 2 * most + (1 if looking[most] < 0 else 0)  # the pad looks inward
                j, distance = 0, 0.0
                for i in range(3):
                    if i == most:
                        continue
                    room = max(box[i] - widths[f], 0.0) / 2
                    at, spacing = box[i] / 2 + min(max(position[i], -room), room), GRID * widths[f]
                    steps = np.rint((at - box[i] / 2) / spacing * (1 - _TIE))
                    off = min(max(steps * spacing, -room), room)
                    new_middles[w, f, t, j] = box[i] / 2 + off
                    distance = max(distance, abs(at - middles[w, f, t, j]))
                    j += 1
                if face != known or distance > reach[f]:
                    answered = face == sought_faces[w, f, t]
                    for j in range(2):
                        answered = answered and new_middles[w, f, t, j] == sought_middles[w, f, t, j]
                    if not answered:
                        new_faces[w, f, t] = face
                        moved += 1
        outdated += stale[w]
    return moved, outdated


@njit(cache=True, error_model="numpy")
def sample(entries_at, touches_at, substeps, settled):
    """One step of every world; first, unless it is settled, `settle`, and no step where contacts are not where they
    were. entries_at: the address of JoinedHeat's table; touches_at: that of touches (W, F, T, COLUMNS), sums over so
    many substeps. settled: 1 or 0. Returns how many contacts and worlds `settle` tells of."""
    entries = carray(words(entries_at), TABLE)
    worlds, tips, objects = entries[36], entries[37], entries[38]
    targets = tips + objects
    touches, widths = (
        carray(floats(touches_at), (worlds, tips, targets, COLUMNS)),
        carray(floats(entries[1]), tips),
    )
    if settled == 0:
        moved, stale = settle(
            touches,
            carray(floats(entries[0]), (objects, 18)),
            widths,
            carray(floats(entries[2]), tips),
            carray(words(entries[3]), (worlds, tips, objects)),
            carray(floats(entries[4]), (worlds, tips, objects, 2)),
            carray(words(entries[5]), (worlds, tips, objects)),
            carray(floats(entries[6]), (worlds, tips, objects, 2)),
            carray(words(entries[7]), (worlds, tips, objects)),
            carray(floats(entries[8]), (worlds, tips, objects, 2)),
            carray(flags(entries[9]), (worlds, tips, targets)),
            carray(flags(entries[10]), worlds),
        )
        if moved or stale:
            return moved + stale
    states, rates = entries[46], entries[49]
    decays = carray(floats(entries[22]), (3, rates))
    _march(
        carray(floats(entries[32]), 1)[0],
        substeps,
        entries[39],
        touches,
        carray(floats(entries[11]), (worlds, tips)),
        carray(words(entries[12]), (worlds, entries[40])),
        carray(words(entries[13]), entries[41]),
        carray(words(entries[14]), entries[42]),
        carray(floats(entries[15]), entries[43]),
        carray(floats(entries[16]), entries[44]),
        carray(floats(entries[17]), entries[50] * PACE),
        carray(floats(entries[18]), (entries[45], states)),
        carray(floats(entries[19]), (worlds, objects)),
        carray(floats(entries[20]), (tips, entries[47])),
        carray(words(entries[21]), (worlds, targets)),
        decays[0],
        decays[1],
        decays[2],
        carray(floats(entries[23]), (entries[48], 2, 2, STEPS, STEPS, rates)),
        carray(words(entries[24]), (worlds, tips, targets, 2)),
        widths,
        carray(floats(entries[25]), (worlds, targets, states)),
        carray(floats(entries[25]), worlds * targets * states),
        carray(floats(entries[26]), (worlds, tips, targets, rates)),
        carray(floats(entries[27]), (worlds, tips, targets)),
        carray(floats(entries[28]), worlds),
        carray(floats(entries[29]), (worlds, tips)),
        carray(flags(entries[30]), targets),
        carray(floats(entries[31]), (worlds, objects)),
        carray(floats(entries[33]), (tips * targets, rates)),
        carray(floats(entries[34]), entries[51]),
        carray(floats(entries[35]), 4),
        entries[52],
    )
    return 0


@njit(cache=True, inner=True, borrows=True, error_model="numpy", forceinline=True)
def _march(
    dt, substeps, patterns, touches, warm, plan, starts, integers, ports, grams, paces, fade, held, rows, nets,
    decay, kept, grown, tables, kinds, widths, x, states, narrow, given, air, drop, busy, warmth, roots, numbers,
    placed, most,
):  # fmt: skip
    """One step of dt s of every world.

    touches: (W, F, T, columns), sums over so many substeps. warm: (W, F) K, the thermostats above the air. plan: (W, C)
    the groups' systems, -1 behind the last. fade: (networks, K), what a state keeps in a step alone; nets: (W, T) which
    of them each field is. held: (W, O) J of the mean's state. rows: (F, K) of the drop. x: (W, T, K), given: (W, F, T)
    J and air: (W,) J go on in place; drop: (W, F) K and warmth: (W, O) K, the objects' means, are filled. Room: busy
    (T,), roots (F T, R), placed (4,) and numbers, for groups of most contacts (step.py).

    Narrow contacts (narrow.py): decay (R,) 1/s their rates, kept and grown (R,) what of a state is there after a
    step, and s of a flow, tables (N, 2, 2, J, J, R), kinds (W, F, T, 2) which of these the sides of each contact have,
    widths (F,) m of the sensors, and narrow (W, F, T, R) the states, which go on in place. Within a step these follow
    the mean flow, which takes no heat from anywhere and leaves them passive: the power that a flow loses in a
    resistance is least where it is even."""
    worlds, fields, objects = x.shape[0], x.shape[1], held.shape[1]
    tips, targets, rates = narrow.shape[1], narrow.shape[2], len(decay)
    room = room_of(numbers, most, patterns)
    resistances, differences, flow = room.resistance, room.difference, room.flow
    for w in range(worlds):
        for f in range(tips):
            for t in range(targets):
                if not touches[w, f, t, CONDUCTANCE] > 0:
                    for k in range(rates):
                        narrow[w, f, t, k] *= kept[k]
        for b in range(fields):
            busy[b] = False
        for c in range(plan.shape[1]):
            if plan[w, c] < 0:
                break
            start = starts[plan[w, c]]
            contacts, joined = integers[start + CONTACTS], start + HEADER
            for i in range(contacts):
                f, t = integers[joined + 2 * i], integers[joined + 2 * i + 1]
                touch, root = touches[w, f, t], roots[i]
                behind, resistance = 0.0, substeps / touch[CONDUCTANCE]
                area = touch[AREA] / touch[CLOSED]
                for j in range(4):
                    placed[j] = touch[ASIDE + j] / touch[AREA]
                own, other = tables[kinds[w, f, t, 0]], tables[kinds[w, f, t, 1]]
                length = touch[LENGTH] / touch[AREA]
                if spread(own, other, widths[f], area, length, placed[:2], placed[2:], root):
                    for k in range(rates):
                        mean = grown[k] / dt  # of a state that fades, over the step
                        behind += root[k] * mean * narrow[w, f, t, k]
                        resistance += root[k] * root[k] * (1 - mean) / decay[k]
                else:
                    for k in range(rates):
                        root[k] = 0.0
                resistances[i] = resistance
                differences[i] = warm[w, f] - (warm[w, t - objects] if t >= objects else 0.0) - behind
            air[w] += dt * step(
                dt,
                start,
                integers,
                ports,
                grams,
                paces,
                patterns,
                states,
                w * fields * x.shape[2],
                x.shape[2],
                held[w],
                room,
            )
            for i in range(contacts):
                f, t = integers[joined + 2 * i], integers[joined + 2 * i + 1]
                busy[objects + f], busy[t] = True, True
                given[w, f, t] += dt * flow[i]
                for k in range(rates):
                    narrow[w, f, t, k] = kept[k] * narrow[w, f, t, k] + grown[k] * roots[i, k] * flow[i]
        for b in range(fields):
            if busy[b]:
                continue
            before = x[w, b, 0]
            for k in range(x.shape[2]):
                x[w, b, k] *= fade[nets[w, b], k]
            if b < objects:
                air[w] += held[w, b] * (before - x[w, b, 0])
        for f in range(len(rows)):
            total = 0.0
            for k in range(rows.shape[1]):
                total += rows[f, k] * x[w, objects + f, k]
            drop[w, f] = total
        for o in range(objects):
            warmth[w, o] = x[w, o, 0] / held[w, o]
