"""One control step of heat, compiled row by row: contact laws, touches and releases, thermal networks.

B: environments, S: substeps, F = 2 fingertips, N: heat samples, K: states of the largest network.
"""

from __future__ import annotations

import math

import numpy as np

from thermograsp.compiled import njit

from ...thermal.batch import (
    RESERVOIR,
    WHERE,
    FixedTables,
    HeatReading,
    HeatTables,
    advance_fixed,
    advance_row,
    fingertips_of,
    fixed_room,
    forget_fixed,
    forget_row,
)
from ...thermal.contact import FLAT, beside_face, footprint, gas_around, solid_conduction
from ...thermal.matter import reservoir_step, reservoir_temperature
from ...thermal.network import NODE, workspace
from ...thermal.numerics import FAST
from .rows import (
    NEW_PATCH,
    OFF_ELEMENT,
    RELEASE,
    TOUCH,
)


@njit(cache=True, error_model="numpy", fastmath=FAST)
def advance_grasps(laws, reservoirs, rows, state, normal, place, drop, info, first, last, *numbers):
    """Advances rows (B,) HEAT_ROW and state (B, K) by the samples first to last - 1 of a control step, and fills these
    of drop (B, N, F) K and, once the last one is done, info (B,) HEAT_INFO. Rows of boxes are advance_boxes' to take.

    A step may be taken in several calls, one after the other, with the same normal, place, drop and info: what changes
    networks between two samples does so between two calls, and the numbers are the same however many there are.
    laws: (B,) FOOTPRINT_LAW. reservoirs: (B,) RESERVOIR_ROW. normal: (B, S, F) N. place: (B, F, 3) m. numbers: the
    fields of a HeatTables, which cost less to hand over one by one."""
    tables = HeatTables(*numbers)
    samples, tips = drop.shape[1], fingertips_of(tables)
    room, reading = workspace(tables.rows.shape[2], tables.gram.shape[3]), _reading(samples, tips)
    conducts, beside, ring = np.empty((samples, 2)), np.zeros((samples, 2)), np.empty(1)
    duration = tables.dt * samples
    for b in range(len(rows)):
        row, step, x = rows[b], info[b], state[b]
        if row.boxed:
            continue
        _meet(laws[b], row, step, normal[b], place[b], drop[b], conducts, first)
        if row.pad[0] > 0.0:
            _meet_pads(row, normal[b], place[b], ring, beside)
        if first == 0 and reservoirs[b].conductance > 0.0:
            step.reservoir_temperature = reservoir_temperature(reservoirs[b], row.enthalpy)
        around = row.ambient
        film, above = reservoirs[b].conductance, 0.0
        if film > 0.0:
            above = step.reservoir_temperature - (
                row.sensor_temperature[0] + row.offset[0] - row.difference[0]
            )
            if row.fed:
                if first == 0:
                    _set_node(tables, row.network, x, above)
                film = 0.0
            else:
                around = (row.air * row.ambient + film * above) / (row.air + film)
        if row.begun:
            for k in range(first, last):
                if row.lasting == 0 and _renewed(step, conducts, k):
                    forget_row(tables, row.network, x)
                advance_row(
                    tables,
                    row.network,
                    x,
                    conducts[k],
                    beside[k],
                    row.difference,
                    around,
                    room,
                    reading,
                    0,
                    k,
                )
                _add(step, reading, drop[b], k, samples, tips)
        if last < samples:
            continue
        if row.begun:
            _end(row, step, reading, samples - 1, tips)
            if row.ambient != 0.0 or film > 0.0:
                mean = step.air_loss / (row.air + film)  # of the object over the step, above its first
                step.air_loss = row.air * (mean - row.ambient)
                if film > 0.0:
                    step.reservoir_flow = film * (above - mean)
            if row.fed:
                step.reservoir_flow = NODE * (above - _node(tables, row.network, x)) / duration
            if film > 0.0 or row.fed:
                reservoir = reservoirs[b]
                row.enthalpy = reservoir_step(reservoir, row.enthalpy, step.reservoir_flow, duration)
                step.reservoir_temperature = reservoir_temperature(reservoir, row.enthalpy)
        _book(row, step, duration)


@njit(cache=True, error_model="numpy", fastmath=FAST)
def advance_boxes(laws, rows, state, normal, place, drop, info, first, last, *numbers):
    """The same for the rows that are boxes of FixedTables, of whose fields the numbers are. They are compiled apart, so
    that whoever has none of them does not wait for it. Boxes have no reservoirs."""
    tables = FixedTables(*numbers)
    samples, tips = drop.shape[1], (tables.links.shape[1] - WHERE) // 2
    room, reading = fixed_room(tables.gram.shape[1]), _reading(samples, tips)
    conducts = np.empty((samples, 2))
    for b in range(len(rows)):
        row, step = rows[b], info[b]
        if row.boxed == 0:
            continue
        _meet(laws[b], row, step, normal[b], place[b], drop[b], conducts, first)
        if row.begun:
            for k in range(first, last):
                for f in range(tips):
                    if tables.links[b, WHERE + f] < 0:
                        conducts[k, f] = 0.0
                if row.lasting == 0 and _renewed(step, conducts, k):
                    forget_fixed(tables, b, state[b])
                advance_fixed(
                    tables, b, state[b], conducts[k], row.difference, row.ambient, room, reading, 0, k
                )
                _add(step, reading, drop[b], k, samples, tips)
        if last < samples:
            continue
        if row.begun:
            _end(row, step, reading, samples - 1, tips)
        _book(row, step, tables.dt * samples)


@njit(cache=True, error_model="numpy", fastmath=FAST)
def meet_rows(laws, rows, normal, place, info):
    """Fills conductance, area and events of info (B, O) HEAT_INFO by what fingertips press on each of a row's objects:
    laws (B, O) FOOTPRINT_LAW, rows (B, O) HEAT_ROW, whose touches and anchors follow, normal (B, O, S, F) N and place
    (B, O, F, 3) m, in the objects' frames."""
    at, conducts = np.empty(3), np.empty((1, 2))
    for b in range(rows.shape[0]):
        for o in range(rows.shape[1]):
            for f in range(2):
                _along_pad(laws[b, o], place[b, o], f, at)
                touching = _mean_contacts(laws[b, o], normal[b, o, :, f], info[b, o], f, at, conducts)
                _follow(rows[b, o], info[b, o], f, touching, place[b, o, f])


@njit(cache=True, inner=True, error_model="numpy")
def _reading(samples, tips):
    """Room for the HeatReading of one row."""
    by_tip, by_row = np.empty((5, samples, tips)), np.empty((2, samples))
    return HeatReading(
        by_tip[0:1], by_tip[1:2], by_row[0:1], by_tip[2:3], by_tip[3:4], by_tip[4:5], by_row[1:2]
    )


@njit(cache=True, inner=True, error_model="numpy", fastmath=FAST, forceinline=True)
def _meet(law, row, step, normal, place, drop, conducts, first):
    """Where a row's fingertips touch in a control step: fills conducts (N, F) W/K of each sample, notes what has begun
    and ended, and before the first sample clears what the step adds up."""
    samples, at = len(drop), np.empty(3)
    for f in range(2):
        _along_pad(law, place, f, at)
        touching = _mean_contacts(law, normal[:, f], step, f, at, conducts)
        if first == 0:
            _follow(row, step, f, touching, place[f])
            row.begun |= touching
            step.heat[f] = step.flow[f] = 0.0
            step.sensor_surface[f] = row.sensor_temperature[f] + row.offset[f]
            step.object_surface[f] = step.sensor_surface[f] - row.difference[f]
            for k in range(samples):
                drop[k, f] = 0.0
        if row.glued and _distance(place[f], row.anchor[f]) > row.reach:
            for k in range(samples):  # a fingertip without a sensor takes no part
                conducts[k, f] = 0.0
    if first == 0:
        step.over_temperature = False
        step.heat[2] = step.air_loss = 0.0
        step.object_temperature = step.object_surface[0]
        step.reservoir_temperature, step.reservoir_flow = math.nan, 0.0


@njit(cache=True, inner=True, error_model="numpy", fastmath=FAST, forceinline=True)
def _add(step, reading, drop, k, samples, tips):
    """Adds sample k to what the step tells."""
    for f in range(tips):
        drop[k, f] = reading.drop[0, k, f]
        step.flow[f] += reading.flow[0, k, f] / samples
    step.air_loss += reading.air_loss[0, k] / samples


@njit(cache=True, inner=True, error_model="numpy", fastmath=FAST, forceinline=True)
def _end(row, step, reading, k, tips):
    """What sample k, the step's last, leaves."""
    for f in range(tips):
        step.heat[f] = reading.element_heat[0, k, f]
        step.sensor_surface[f] += reading.sensor_rise[0, k, f]
        step.object_surface[f] += reading.object_rise[0, k, f]
    step.heat[2] = reading.object_heat[0, k]
    step.object_temperature += step.heat[2] / row.capacity


@njit(cache=True, inner=True, error_model="numpy", fastmath=FAST, forceinline=True)
def _book(row, step, duration):
    """The balance of heat after a step of so many seconds."""
    for f in range(2):
        step.drawn[f] = step.flow[f]
        if row.glued == 0:
            step.heat[f] += row.element_capacity * row.offset[f]
            step.drawn[f] += (step.heat[f] - row.stored[f]) / duration
        row.stored[f] = step.heat[f]
    row.books[0] += (step.flow[0] + step.flow[1] + step.reservoir_flow) * duration
    row.books[1] += (abs(step.flow[0]) + abs(step.flow[1]) + abs(step.reservoir_flow)) * duration
    row.books[2] += step.air_loss * duration
    gained = step.heat[2] + (step.heat[0] + step.heat[1] if row.glued else 0.0)
    step.imbalance = gained + row.books[2] - row.books[0]
    step.exchanged = row.books[1]


@njit(cache=True, inner=True, error_model="numpy")
def _node(tables, network, x):
    """K of the network's node above the object's first temperature."""
    heat = 0.0
    for i in range(tables.sizes[network, 1]):
        heat += tables.rows[network, RESERVOIR, i] * x[i]
    return heat / NODE


@njit(cache=True, inner=True, error_model="numpy")
def _set_node(tables, network, x, above):
    """Gives the node that temperature, K; the object keeps its own."""
    change = above - _node(tables, network, x)
    for i in range(tables.sizes[network, 1]):
        x[i] += change * tables.rows[network, RESERVOIR, i]


@njit(cache=True, inner=True, error_model="numpy", fastmath=FAST, forceinline=True)
def _along_pad(law, place, f, at):
    """Writes where a pad's middle (3,) m is, of bodies that aren't flat what of it lies along the pads: across the line
    between both pads' middles, since these face each other."""
    square, share = 0.0, 0.0
    for i in range(3):
        between = place[1, i] - place[0, i]
        square += between * between
        share += between * place[f, i]
    for i in range(3):
        at[i] = place[f, i]
        if law.shape != FLAT and square > 0.0:
            at[i] -= share / square * (place[1, i] - place[0, i])


@njit(cache=True, inner=True, error_model="numpy", fastmath=FAST, forceinline=True)
def _meet_pads(row, normal, place, ring, conductances):
    """Fills conductances (N, F) W/K of the pads around the sensors, the mean over each sample's own substeps. ring:
    room for one."""
    for f in range(2):
        for k in range(len(conductances)):
            conductances[k, f] = 0.0
        for s in range(len(normal)):
            if normal[s, f] > 0:
                conducts = beside_face(row.pad_law, row.pad, normal[s, f], place[f], ring)
                _share(conductances, f, s, len(normal), conducts * ring[0])
        for k in range(len(conductances)):
            conductances[k, f] /= len(normal)


@njit(cache=True, inner=True, error_model="numpy", fastmath=FAST, forceinline=True)
def _share(conductances, f, s, substeps, conducts):
    """Adds what a fingertip conducts in one of the substeps, W/K, to the sums of the samples (N, F) that it is part of;
    where the samples' ends fall within a substep, it counts for both by its parts."""
    samples = len(conductances)
    for k in range(s * samples // substeps, samples):  # in parts of 1/(S N) of the step
        part = min((s + 1) * samples, (k + 1) * substeps) - max(s * samples, k * substeps)
        if part <= 0:
            break
        conductances[k, f] += conducts * part


@njit(cache=True, inner=True, error_model="numpy", fastmath=FAST, forceinline=True)
def _mean_contacts(law, normal, step, f, place, conductances):
    """Fills conductances (N, F) W/K of the fingertip, the mean over each sample's own substeps. Writes conductance
    W/(m2 K) and area m2, whose product is the mean of all, and whose area is the mean over the substeps that touch.
    place: see footprint. Returns whether any does."""
    samples, substeps = len(conductances), len(normal)
    total, area, force, pressing, touching = 0.0, 0.0, 0.0, 0, 0
    for k in range(samples):
        conductances[k, f] = 0.0
    for s in range(substeps):
        if normal[s] > 0:
            force += normal[s]
            pressing += 1
    gas, spread = 0.0, 0.0
    if pressing:  # they change little with the force
        gas, spread = gas_around(law, force / pressing, place)
    for s in range(substeps):
        if normal[s] > 0:
            face, load = footprint(law, normal[s], place)
            conducts = solid_conduction(law, face, load, place, gas, spread) + gas
            if conducts > 0:
                total += conducts
                area += face
                touching += 1
                _share(conductances, f, s, substeps, conducts)
    for k in range(samples):
        conductances[k, f] /= substeps
    if touching and area == 0.0:  # gas alone, all over the face
        area = 4 * law.half_face * law.half_face * touching
    step.area[f] = area / touching if touching else 0.0
    step.conductance[f] = total / substeps / step.area[f] if touching else 0.0
    return touching > 0


@njit(cache=True, inner=True, error_model="numpy")
def _renewed(step, conductances, k):
    """Whether a fingertip meets its new patch in sample k."""
    for f in range(2):
        if step.events[f] & NEW_PATCH and conductances[k, f] > 0.0:
            before = 0.0
            for earlier in range(k):
                before += conductances[earlier, f]
            if before == 0.0:
                return True
    return False


@njit(cache=True, inner=True, error_model="numpy")
def _follow(row, step, f, touching, place):
    """Notes a touch, a release or a new patch since the last step."""
    touched, events = row.touching[f] > 0, 0
    moved = _distance(place, row.anchor[f]) > row.reach
    row.touching[f] = touching
    if touched and not touching:
        events = RELEASE
    if touching and not touched:
        events = OFF_ELEMENT if row.glued and moved else TOUCH
    if touching and not row.glued and (moved or not row.known[f]):
        if row.known[f]:
            events |= NEW_PATCH
        row.known[f] = 1
        for i in range(3):
            row.anchor[f, i] = place[i]
    step.events[f] = events


@njit(cache=True, error_model="numpy", inline="always")
def _distance(a, b):
    x, y, z = a[0] - b[0], a[1] - b[1], a[2] - b[2]
    return math.sqrt(x * x + y * y + z * z)
