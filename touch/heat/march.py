"""The compiled part of a sample of heat: which contacts are closed and where, and a step of every field.

W: worlds, F: fingertips, O: objects, T = O + F: targets of a contact and fields, C: groups of a world, K: states.
"""

from __future__ import annotations

import numpy as np

from thermograsp.compiled import njit

from ...thermal.padded import RINGS
from ..contacts import (
    AREA,
    ASIDE,
    BESIDE,
    CLOSED,
    COLUMNS,
    CONDUCTANCE,
    CURVED,
    LENGTH,
    NORMAL,
    PAUSED,
    PLACE,
    PULSES,
)
from ..pointers import flags, floats, words
from .narrow import (
    MODES,
    STEPS,
    add_own,
    compiled_ripple,
    face_room,
    lean,
    note_place,
    send_across,
    share_faces,
    spread,
)
from .places import ACROSS
from .step import CONTACTS, HEADER, PACE, room_of, step

GRID = 0.125  # of the sensor's width: places stand on a grid, so that networks serve many touches
TABLE = 63
"""Of the table that `sample` takes: addresses of JoinedHeat's arrays and their sizes."""
BOX = 19
"""Of a row that tells an object."""
TURN = 0.1  # by which another face of the box must look more at the pad than the one in use
_ALL = 1 - 1e-9  # of a sample, of which a contact that is closed in all is summed
_TIE = 1e-6
"""By how much a face must look more at the pad than the axis before, and a place must be nearer to the next point of
the grid than to the one before: round-off does not decide where a pad is in the middle."""


@njit(cache=True, error_model="numpy")
def settle(
    touches, boxes, widths, reach, faces, middles, sought_faces, sought_middles, new_faces, new_middles,
    closed, stale, pads,
):  # fmt: skip
    """Notes which contacts are closed, (W, F + pads, T), those of pads around the sensors last, and where; stale (W,)
    where that is no longer what it was. pads: (F,) number of each one's pad, from F on, -1 for none.

    boxes: (O, BOX) size, extent and centre m, the axes, row by row, and 1 for what has its own shape. widths: (F,) m of
    the sensors. reach: (F,) m. faces (W, F, O) and middles (W, F, O, 3): the places in use, face -1 for none; along the
    face's two axes, and across it, 0 on a box. A contact that has left its place is told by new_faces, else -1, and
    new_middles, of the nearest place of the grid; not again where that is the one that was asked for last, for which
    the place in use was found to do. Returns how many have left theirs, and how many worlds are stale."""
    worlds, tips, targets = touches.shape[:3]
    objects, moved = len(boxes), 0
    position, looking, outdated = np.empty(3), np.empty(3), 0
    for w in range(worlds):
        for f in range(tips):
            for t in range(targets):
                now = touches[w, f, t, CONDUCTANCE] > 0
                if now != closed[w, f, t]:
                    closed[w, f, t], stale[w] = now, True
                if pads[f] >= 0:
                    around = False
                    for ring in range(RINGS):
                        around = around or touches[w, f, t, BESIDE + 3 * ring] > 0
                    if around != closed[w, pads[f], t]:
                        closed[w, pads[f], t], stale[w] = around, True
                    now = now or around
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
                new_middles[w, f, t, 2] = 0.0
                if box[18] > 0:
                    at, spacing = min(max(position[most], -box[most] / 2), box[most] / 2), GRID * widths[f]
                    new_middles[w, f, t, 2] = box[most] / 2 + np.rint(at / spacing) * spacing
                    distance = max(distance, ACROSS * abs(new_middles[w, f, t, 2] - middles[w, f, t, 2]))
                if face != known or distance > reach[f]:
                    answered = face == sought_faces[w, f, t]
                    for j in range(3):
                        answered = answered and new_middles[w, f, t, j] == sought_middles[w, f, t, j]
                    if not answered:
                        new_faces[w, f, t] = face
                        moved += 1
        outdated += stale[w]
    return moved, outdated


@njit(cache=True, borrows=True, error_model="numpy")
def sample(entries_at, touches_at, substeps, settled):
    """One step of every world; first, unless it is settled, `settle`, and no step where contacts are not where they
    were. entries_at: the address of JoinedHeat's table; touches_at: that of touches (W, F, T, COLUMNS), sums over so
    many substeps. settled: 1 or 0. Returns how many contacts and worlds `settle` tells of."""
    entries = words(entries_at, TABLE)
    worlds, tips, objects, contacts, lanes = entries[43], entries[44], entries[45], entries[60], entries[61]
    targets = tips + objects
    touches, widths = (
        floats(touches_at, (worlds, tips, targets, COLUMNS)),
        floats(entries[1], lanes),
    )
    if settled == 0:
        moved, stale = settle(
            touches,
            floats(entries[0], (objects, BOX)),
            widths,
            floats(entries[2], lanes),
            words(entries[3], (worlds, tips, objects)),
            floats(entries[4], (worlds, tips, objects, 3)),
            words(entries[5], (worlds, tips, objects)),
            floats(entries[6], (worlds, tips, objects, 3)),
            words(entries[7], (worlds, tips, objects)),
            floats(entries[8], (worlds, tips, objects, 3)),
            flags(entries[9], (worlds, contacts, targets)),
            flags(entries[10], worlds),
            words(entries[36], tips),
        )
        if moved or stale:
            return moved + stale
    states, rates = entries[53], entries[56]
    decays = floats(entries[22], (3, rates))
    _march(
        floats(entries[32], 1)[0],
        substeps,
        entries[46],
        touches,
        floats(entries[11], (worlds, tips)),
        words(entries[12], (worlds, entries[47])),
        words(entries[13], entries[48]),
        words(entries[14], entries[49]),
        floats(entries[15], entries[50]),
        floats(entries[16], entries[51]),
        floats(entries[17], entries[57] * PACE),
        floats(entries[18], (entries[52], states)),
        floats(entries[19], (worlds, objects)),
        floats(entries[20], (tips, entries[54])),
        words(entries[21], (worlds, targets)),
        decays[0],
        decays[1],
        decays[2],
        floats(entries[23], (entries[55], 2, 2, STEPS, STEPS, rates)),
        words(entries[24], (worlds, lanes, targets, 2)),
        widths,
        words(entries[37], contacts),
        floats(entries[25], (worlds, targets, states)),
        floats(entries[25], worlds * targets * states),
        floats(entries[26], (worlds, lanes, targets, rates)),
        floats(entries[27], (worlds, lanes, targets)),
        floats(entries[28], worlds),
        floats(entries[29], (worlds, tips)),
        flags(entries[30], targets),
        floats(entries[31], (worlds, objects)),
        floats(entries[33], (contacts * targets * entries[46], rates)),
        floats(entries[34], entries[58]),
        floats(entries[35], 4),
        floats(entries[38], (lanes - tips, STEPS, 2)),
        floats(entries[39], (contacts * targets * entries[46], rates)),
        floats(entries[40], entries[55]),
        floats(entries[41], (tips, MODES, MODES, rates)),
        floats(entries[42], entries[62]),
        entries[59],
    )
    return 0


@njit(cache=True, inner=True, borrows=True, error_model="numpy", forceinline=True)
def _march(
    dt, substeps, patterns, touches, warm, plan, starts, integers, ports, grams, paces, fade, held, rows, nets,
    decay, kept, grown, tables, kinds, widths, owners, x, states, narrow, given, air, drop, busy, warmth, roots,
    numbers, placed, shares, leans, ripples, modes, face_numbers, most,
):  # fmt: skip
    """One step of dt s of every world.

    touches: (W, F, T, columns), sums over so many substeps. warm: (W, F) K, the thermostats above the air. plan: (W, C)
    the groups' systems, -1 behind the last. fade: (networks, K), what a state keeps in a step alone; nets: (W, T) which
    of them each field is. held: (W, O) J of the mean's state. rows: (F, K) of the drop. x: (W, T, K), given: (W, F, T)
    J and air: (W,) J go on in place; drop: (W, F) K and warmth: (W, O) K, the objects' means, are filled. Room: busy
    (T,), roots (F T, R), placed (4,) and numbers, for groups of most contacts (step.py).

    Narrow contacts (narrow.py): decay (R,) 1/s their rates, kept and grown (R,) what of a state is there after a
    step, and s of a flow, tables (N, 2, 2, J, J, R), kinds (W, F, T, 2) which of these the sides of each contact have,
    widths (F,) m of the sensors, and narrow (W, F, T, R) the states, which go on in place. Behind the fingertips stand
    the rings of pads around sensors, each as a square of its area that is touched from one side to the other; owners
    (F + pads,) tells of contacts whose they are. Under a curved object they see what the face's narrow contact does
    there, by shares (F RINGS, J, 2) of ring_shares; leans (F T, R) is room. ripples: (N,) m2 K/W of sides that
    heat passes in pulses (ripple.py). modes: (F, MODES, MODES, R) of sensors that several
    contacts share, and face_numbers, room for these (shared.py). Within a step these states follow the mean flow, which
    takes no heat from anywhere and leaves them passive: the power that a flow loses in a resistance is least where it
    is even."""
    worlds, fields, objects = x.shape[0], x.shape[1], held.shape[1]
    tips, targets, rates = len(rows), narrow.shape[2], len(decay)
    faces = face_room(face_numbers, most, rates)
    room = room_of(numbers, most, patterns)
    resistances, differences, flow = room.resistance, room.difference, room.flow
    for w in range(worlds):
        for lane in range(narrow.shape[1]):
            f, conducts = lane, CONDUCTANCE
            if lane >= tips:
                f, conducts = owners[tips + (lane - tips) // RINGS], BESIDE + 3 * ((lane - tips) % RINGS)
            for t in range(targets):
                if not touches[w, f, t, conducts] > 0:
                    for k in range(rates):
                        narrow[w, lane, t, k] *= kept[k]
        for b in range(fields):
            busy[b] = False
        for c in range(plan.shape[1]):
            if plan[w, c] < 0:
                break
            start = starts[plan[w, c]]
            contacts, joined = integers[start + CONTACTS], start + HEADER
            shared = False
            for i in range(contacts):
                f, t = integers[joined + 2 * i], integers[joined + 2 * i + 1]
                owner = owners[f]
                sharing = f < tips and (
                    (i > 0 and integers[joined + 2 * i - 2] == f)
                    or (i + 1 < contacts and integers[joined + 2 * i + 2] == f)
                )
                touch = touches[w, owner, t]
                differs = warm[w, owner] - (warm[w, t - objects] if t >= objects else 0.0)
                lane, parts, column = f, 1, CONDUCTANCE
                if f >= tips:
                    lane, parts, column = tips + (f - tips) * RINGS, RINGS, BESIDE
                for p in range(patterns):
                    port = i * patterns + p
                    if p >= parts:  # of the face's other patterns, which nothing drives
                        resistances[port] = resistances[port - 1]
                        differences[port] = 0.0
                        continue
                    root, behind = roots[port], 0.0
                    if not touch[column] > 0:  # a ring that is not covered
                        resistances[port], differences[port] = np.inf, 0.0
                        lane, column = lane + 1, column + 3
                        continue
                    resistance = substeps / touch[column]
                    if f < tips:
                        area, length = touch[AREA] / touch[CLOSED], touch[LENGTH] / touch[AREA]
                        for j in range(4):
                            placed[j] = touch[ASIDE + j] / touch[AREA]
                    else:
                        area, length = touch[column + 1] / touch[column + 2], widths[lane]
                        for j in range(4):
                            placed[j] = 0.0
                    first, second = kinds[w, lane, t, 0], kinds[w, lane, t, 1]
                    if f < tips and area > 0.0 and touch[CLOSED] < substeps * _ALL:
                        pulses = touch[PULSES]
                        if touch[PAUSED] >= substeps - touch[CLOSED]:  # the last goes on
                            pulses -= 0.5
                        rippled = compiled_ripple(touch[CLOSED] / substeps, max(pulses, 1.0))
                        resistance += (ripples[first] + ripples[second]) * rippled / area
                    first_side, second_side = tables[first], tables[second]
                    beneath = widths[t - objects] if t >= objects and f < tips else widths[lane]
                    spreads = spread(
                        *(first_side, second_side, (widths[lane], beneath), area, length),
                        *(placed[:2], placed[2:], root),
                    )
                    if not spreads:
                        for k in range(rates):
                            root[k] = 0.0
                    if sharing and p == 0:
                        shared = True
                        note_place(faces.places[i], area, length, placed[:2], widths[f])
                        for k in range(rates):
                            faces.own[i, k] = 0.0
                        if spreads:
                            add_own(first_side, widths[f], area, length, placed[:2], faces.own[i])
                    if f >= tips:
                        for k in range(rates):
                            leans[port, k] = 0.0
                        if touch[CURVED] > 0 and touch[CONDUCTANCE] > 0:
                            for j in range(4):
                                placed[j] = touch[ASIDE + j] / touch[AREA]
                            for k in range(rates):
                                root[k] *= root[k]
                            spreads |= lean(
                                tables[kinds[w, owner, t, 0]],
                                tables[kinds[w, owner, t, 1]],
                                widths[owner],
                                touch[AREA] / touch[CLOSED],
                                touch[LENGTH] / touch[AREA],
                                placed[:2],
                                placed[2:],
                                shares[lane - tips],
                                min(touch[CURVED] / touch[column + 2], 1.0),
                                leans[port],
                                root,
                            )
                            for k in range(rates):
                                root[k] = np.sqrt(root[k])
                                mean, sees = grown[k] / dt, leans[port, k]
                                behind += sees * mean * narrow[w, owner, t, k]
                                # twice: the face's flow in the step counts from the next one on
                                resistance += 2 * sees * sees * (1 - mean) / decay[k]
                    if spreads:
                        for k in range(rates):
                            mean = grown[k] / dt  # of a state that fades, over the step
                            behind += root[k] * mean * narrow[w, lane, t, k]
                            resistance += root[k] * root[k] * (1 - mean) / decay[k]
                    resistances[port], differences[port] = resistance, differs - behind
                    lane, column = lane + 1, column + 3
            if shared:
                share_faces(
                    *(integers[joined:], contacts, tips, patterns, dt, grown, decay),
                    *(modes, widths, narrow[w], roots, faces, resistances, differences),
                )
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
                shared,
                faces.mutual,
            )
            for i in range(contacts):
                f, t = integers[joined + 2 * i], integers[joined + 2 * i + 1]
                busy[objects + owners[f]], busy[t] = True, True
                lane, parts, column = f, 1, CONDUCTANCE
                if f >= tips:
                    lane, parts, column = tips + (f - tips) * RINGS, RINGS, BESIDE
                for p in range(parts):
                    port = i * patterns + p
                    if touches[w, owners[f], t, column + 3 * p] > 0:
                        given[w, lane + p, t] += dt * flow[port]
                        for k in range(rates):
                            narrow[w, lane + p, t, k] = (
                                kept[k] * narrow[w, lane + p, t, k] + grown[k] * roots[port, k] * flow[port]
                            )
            if shared:
                send_across(integers[joined:], contacts, patterns, grown, narrow[w], faces, flow)
            for i in range(contacts):
                f, t = integers[joined + 2 * i], integers[joined + 2 * i + 1]
                if f < tips or not touches[w, owners[f], t, CURVED] > 0:
                    continue
                for p in range(RINGS):
                    port = i * patterns + p
                    if touches[w, owners[f], t, BESIDE + 3 * p] > 0:
                        for k in range(rates):
                            narrow[w, owners[f], t, k] += grown[k] * leans[port, k] * flow[port]
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
