"""One control step of heat, compiled row by row: contact laws, touches and releases, thermal networks.

B: environments, S: substeps, F = 2 fingertips, N: heat samples, K: states of the largest network.
"""

from __future__ import annotations

import math

import numpy as np
from numba import njit

from ..thermal.batch import RESERVOIR, HeatReading, HeatTables, advance_row, fingertips_of, forget_row
from ..thermal.contact_law import conductance, contact
from ..thermal.coupling_kernel import FAST, workspace
from ..thermal.system import NODE
from .heat_rows import NEW_PATCH, OFF_ELEMENT, RELEASE, TOUCH
from .reservoir import reservoir_step, reservoir_temperature


@njit(cache=True, error_model="numpy", fastmath=FAST)
def advance_grasps(laws, reservoirs, rows, state, normal, place, drop, told, *numbers):
    """Advances rows (B,) HEAT_ROW and state (B, K) by the samples of drop (B, N, F) K and fills drop and told (B,)
    HEAT_TOLD. laws: (B,) CONTACT_LAW. reservoirs: (B,) RESERVOIR_ROW. normal: (B, S, F) N. place: (B, F, 3) m.
    numbers: a HeatTables' fields, which cost less to hand over one by one."""
    tables = HeatTables(*numbers)
    samples, tips = drop.shape[1], fingertips_of(tables)
    room = workspace(tables.rows.shape[2], tables.gram.shape[3])
    by_tip, by_row = np.zeros((5, samples, tips)), np.zeros((2, samples))
    reading = HeatReading(
        by_tip[0:1], by_tip[1:2], by_row[0:1], by_tip[2:3], by_tip[3:4], by_tip[4:5], by_row[1:2]
    )
    felt = np.zeros(tips)
    duration = tables.dt * samples
    for b in range(len(rows)):
        row, one, x = rows[b], told[b], state[b]
        renewed = one.over_temperature = False
        for f in range(2):
            touching = _mean_contact(laws[b], normal[b, :, f], one, f, place[b, f])
            renewed |= _follow(row, one, f, touching, place[b, f])
            row.begun |= touching
        if renewed and row.lasting == 0:
            forget_row(tables, row.network, x)
        for f in range(2):
            one.heat[f] = one.flow[f] = 0.0
            one.sensor_surface[f] = row.sensor_temperature[f] + row.offset[f]
            one.object_surface[f] = one.sensor_surface[f] - row.difference[f]
            for k in range(samples):
                drop[b, k, f] = 0.0
        one.heat[2] = one.air_loss = 0.0
        one.object_temperature = first = one.object_surface[0]
        around = row.ambient
        one.reservoir_temperature, one.reservoir_flow = math.nan, 0.0
        film, above = reservoirs[b].conductance, 0.0
        if film > 0.0:
            one.reservoir_temperature = reservoir_temperature(reservoirs[b], row.enthalpy)
            above = one.reservoir_temperature - first
            if row.fed:
                _set_node(tables, row.network, x, above)
                film = 0.0
            else:
                around = (row.air * row.ambient + film * above) / (row.air + film)
        if row.begun:
            for f in range(tips):  # a fingertip without a sensor takes no part
                sensed = row.glued == 0 or _distance(place[b, f], row.anchor[f]) <= row.reach
                felt[f] = one.conductance[f] * one.area[f] if sensed else 0.0
            advance_row(tables, row.network, x, felt, row.difference, around, room, reading, 0)
            for f in range(tips):
                one.heat[f] = reading.element_heat[0, samples - 1, f]
                one.sensor_surface[f] += reading.sensor_rise[0, samples - 1, f]
                one.object_surface[f] += reading.object_rise[0, samples - 1, f]
                for k in range(samples):
                    drop[b, k, f] = reading.drop[0, k, f]
                    one.flow[f] += reading.flow[0, k, f] / samples
            one.heat[2] = reading.object_heat[0, samples - 1]
            one.object_temperature += one.heat[2] / row.capacity
            for k in range(samples):
                one.air_loss += reading.air_loss[0, k] / samples
            if row.ambient != 0.0 or film > 0.0:
                mean = one.air_loss / (row.air + film)  # of the object over the step, above its first
                one.air_loss = row.air * (mean - row.ambient)
                if film > 0.0:
                    one.reservoir_flow = film * (above - mean)
            if row.fed:
                one.reservoir_flow = NODE * (above - _node(tables, row.network, x)) / duration
            if film > 0.0 or row.fed:
                reservoir = reservoirs[b]
                row.enthalpy = reservoir_step(reservoir, row.enthalpy, one.reservoir_flow, duration)
                one.reservoir_temperature = reservoir_temperature(reservoir, row.enthalpy)
        for f in range(2):
            one.drawn[f] = one.flow[f]
            if row.glued == 0:
                one.heat[f] += row.element_capacity * row.offset[f]
                one.drawn[f] += (one.heat[f] - row.stored[f]) / duration
            row.stored[f] = one.heat[f]
        row.books[0] += (one.flow[0] + one.flow[1] + one.reservoir_flow) * duration
        row.books[1] += (abs(one.flow[0]) + abs(one.flow[1]) + abs(one.reservoir_flow)) * duration
        row.books[2] += one.air_loss * duration
        gained = one.heat[2] + (one.heat[0] + one.heat[1] if row.glued else 0.0)
        one.imbalance = gained + row.books[2] - row.books[0]
        one.exchanged = row.books[1]


@njit(cache=True, error_model="numpy")
def _node(tables, network, x):
    """K of the network's node above the object's first temperature."""
    heat = 0.0
    for i in range(tables.sizes[network, 1]):
        heat += tables.rows[network, RESERVOIR, i] * x[i]
    return heat / NODE


@njit(cache=True, error_model="numpy")
def _set_node(tables, network, x, above):
    """Gives the node that temperature, K; the object keeps its own."""
    change = above - _node(tables, network, x)
    for i in range(tables.sizes[network, 1]):
        x[i] += change * tables.rows[network, RESERVOIR, i]


@njit(cache=True, error_model="numpy", fastmath=FAST, forceinline=True)
def _mean_contact(law, normal, one, f, place):
    """Writes conductance W/(m2 K) and area m2, whose product is the mean of their products over the substeps; the area
    is the mean over those that press. place: see contact. Returns whether any does."""
    total, area, pressing = 0.0, 0.0, 0
    for s in range(len(normal)):
        if normal[s] > 0:
            face, load = contact(law, normal[s], place)
            if face > 0:
                total += conductance(law, load / face) * face
                area += face
                pressing += 1
    one.area[f] = area / pressing if pressing else 0.0
    one.conductance[f] = total / len(normal) / one.area[f] if pressing else 0.0
    return pressing > 0


@njit(cache=True, error_model="numpy")
def _follow(row, one, f, touching, place):
    """Notes a touch, a release or a new patch since the last step. Returns whether the patch is a new one."""
    touched, events, renewed = row.touching[f] > 0, 0, False
    moved = _distance(place, row.anchor[f]) > row.reach
    row.touching[f] = touching
    if touched and not touching:
        events = RELEASE
    if touching and not touched:
        events = OFF_ELEMENT if row.glued and moved else TOUCH
    if touching and not row.glued and (moved or not row.known[f]):
        if row.known[f]:
            events |= NEW_PATCH
            renewed = True
        row.known[f] = 1
        for i in range(3):
            row.anchor[f, i] = place[i]
    one.events[f] = events
    return renewed


@njit(cache=True, error_model="numpy", inline="always")
def _distance(a, b):
    x, y, z = a[0] - b[0], a[1] - b[1], a[2] - b[2]
    return math.sqrt(x * x + y * y + z * z)
