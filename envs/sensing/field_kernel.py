"""One control step of many rows' fields, compiled: what each one's pads touch, its samples, and what it tells.

B: environments, O: objects, S: substeps, F = 2 fingertips, N: heat samples of a control step.
"""

from __future__ import annotations

import numpy as np

from thermograsp.compiled import njit

from ...thermal.contact import CURVED_TABLE, FOOTPRINT_LAW
from ...thermal.padded import RINGS
from ...touch.contacts import COLUMNS
from ...touch.heat import tell_books, tell_drop, tell_warmth
from ...touch.pointers import called, floats, footprints, laws
from ..footprint import touch_pads
from .kernel import meet_rows
from .rows import HEAT_INFO, HEAT_ROW

HEAT, SAMPLE, TOUCHES, TIPS, LISTED = range(5)
"""Of a row's heat: the addresses of JoinedHeat.telling, of what `sample` takes, which is 0 where a step is more than
that, and of its touches (N, F, O + F, COLUMNS), which is 0 before the first reset; and how many fingertips it has."""
PARTS = 8
"""Of an object under pads: the addresses of a PadContact's arrays, in its order, and the lengths of its tables and
halves."""


def compile_fields() -> None:
    """Compiles a control step as FieldScenes calls it, by one of no rows."""
    listed, parts = np.zeros((0, LISTED), np.int64), np.zeros((0, 1, PARTS), np.int64)
    force, place, drop = np.zeros((0, 1, 1, 2)), np.zeros((0, 1, 2, 3)), np.zeros((0, 1, 2))
    records, info = np.zeros((0, 1), HEAT_ROW), np.zeros((0, 1), HEAT_INFO)
    pairs, of_objects, air = np.zeros((0, 2, 1)), np.zeros((0, 1)), np.zeros(0)
    meet_rows(np.zeros((0, 1), FOOTPRINT_LAW), records, force, place, info)
    advance_fields(0, listed, parts, force, place, drop, 0)
    tell_fields(listed, records, 1.0, info, pairs, np.zeros((0, 2)), of_objects, air)
    tell_temperatures(listed, records, air, 1, info)


@njit(cache=True, error_model="numpy")
def advance_fields(sample, rows, contacts, force, place, drop, first):
    """Advances the rows (B, LISTED) by the samples of a control step, all samples counted row by row, from number
    `first` on; fills drop (B, N, F) K. sample: the address of touch.heat's. contacts: (B, O, PARTS). force:
    (B, O, S, F) N. place: (B, O, F, 3) m. Returns the number of a sample that has not been taken yet, as places or
    contacts change before it or it is more than `sample` does; B N after the last one."""
    samples, objects = drop.shape[1], force.shape[1]
    for number in range(first, len(rows) * samples):
        b, k = number // samples, number % samples
        heat, touches, tips = rows[b, SAMPLE], rows[b, TOUCHES], rows[b, TIPS]
        if touches == 0:
            continue
        if k == 0:
            every = floats(touches, (samples, tips, objects + tips, COLUMNS))
            for o in range(objects):
                part = contacts[b, o]
                touch_pads(
                    footprints(part[0], 1),
                    laws(part[1], 1),
                    floats(part[2], (part[6], CURVED_TABLE)),
                    footprints(part[3], RINGS),
                    floats(part[4], (9, 6)),
                    floats(part[5], part[7]),
                    force[b, o],
                    place[b, o],
                    every[:, :, o],
                )
        if heat == 0 or called(sample, heat, touches + 8 * k * tips * (objects + tips) * COLUMNS, 1, 0) != 0:
            return number
        tell_drop(rows[b, HEAT], drop[b, k])
    return len(rows) * samples


@njit(cache=True, error_model="numpy")
def tell_fields(rows, records, seconds, info, given, stored, gained, air):
    """Fills flows, heats and books of info (B, O) HEAT_INFO after a control step of so many seconds; books of records
    (B, O) HEAT_ROW go on, and what elements hold. From the step before to this one go given (B, F, O) J from fingertips
    to objects, gained (B, O) J in objects, and air (B,) J; stored (B, F) J is what elements and pads have gained beside
    thermostats that stay as they are."""
    passed = np.empty(given.shape[1:])
    for b in range(len(rows)):
        if rows[b, TOUCHES] == 0:
            continue
        lost, imbalance = air[b], 0.0
        for f in range(2):
            for o in range(info.shape[1]):
                passed[f, o] = given[b, f, o]
        air[b] = tell_books(rows[b, HEAT], given[b], stored[b], gained[b])
        for o in range(info.shape[1]):
            step, record, exchanged = info[b, o], records[b, o], 0.0
            for f in range(2):
                flowed = given[b, f, o] - passed[f, o]
                step.flow[f] = flowed / seconds
                step.heat[f] = stored[b, f] + record.element_capacity * record.offset[f]
                step.drawn[f] = step.flow[f] + (step.heat[f] - record.stored[f]) / seconds
                record.stored[f] = step.heat[f]
                exchanged += abs(flowed)
                imbalance -= given[b, f, o]
            step.heat[2] = gained[b, o]
            imbalance += gained[b, o]
            record.books[1] += exchanged
            step.exchanged = record.books[1]
        info[b, 0].air_loss = (air[b] - lost) / seconds
        info[b, 0].imbalance = imbalance + air[b]


@njit(cache=True, error_model="numpy")
def tell_temperatures(rows, records, ambient, samples, info):
    """Fills temperatures of info (B, O) HEAT_INFO after so many samples. records: (B, O) HEAT_ROW. ambient: (B,) °C of
    the air."""
    objects = info.shape[1]
    sensors, under, means = np.empty((objects, 2)), np.empty((objects, 2)), np.empty(objects)
    for b in range(len(rows)):
        if rows[b, TOUCHES] == 0:
            continue
        tips = rows[b, TIPS]
        last = rows[b, TOUCHES] + 8 * (samples - 1) * tips * (objects + tips) * COLUMNS
        tell_warmth(rows[b, HEAT], last, ambient[b], sensors, under, means)
        for o in range(objects):
            step = info[b, o]
            step.object_temperature = means[o]
            for f in range(2):
                has = f < tips
                step.sensor_surface[f] = sensors[o, f] if has else records[b, o].sensor_temperature[f]
                step.object_surface[f] = under[o, f] if has else means[o]
