"""One step of a row of FixedTables.

Letters as in fixed_rates.py.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from thermograsp.compiled import njit
from thermograsp.lanes import (
    LANES,
    add_products,
    add_sum,
    dot,
    put,
    put_sum,
    solve_symmetric,
    take_products,
)

from ..network import POLES, WEIGHTS
from ..numerics import FAST
from .fixed_rates import (
    AIRED,
    BLOCKS,
    DROP,
    FADING,
    HELD,
    PAIRS,
    POLE_HEAT,
    POLES_KEPT,
    PORT,
    PUSHED,
    RATES,
    SEEN,
    USED,
    WHERE,
)
from .remembered import held_heat

_LAGS = WEIGHTS / POLES


class FixedRoom(NamedTuple):
    """Memory of advance_fixed; what it holds between calls does not matter. moved (F P, K). Real and imaginary parts at
    the poles: flows (F P, 2, LANES), matrix (F P, F P, 2, LANES) and factors (F P, 2, LANES). numbers (2, F P)."""

    moved: np.ndarray
    flows: np.ndarray
    matrix: np.ndarray
    factors: np.ndarray
    numbers: np.ndarray


@njit(cache=True, inner=True)
def fixed_room(ports):
    """Room for so many ports of contacts."""
    matrix = np.zeros((ports + 2, ports, 2, LANES))
    return FixedRoom(
        np.zeros((ports, RATES)), matrix[ports], matrix[:ports], matrix[ports + 1], np.zeros((2, ports))
    )


@njit(cache=True, inner=True, error_model="numpy", fastmath=FAST, forceinline=True)
def forget_fixed(tables, i, x):
    """The heat of row i's box, state x in place, is evenly in it from now on, for compiled callers."""
    slow, body, index = tables.slow[i], tables.body[i], tables.links[i]
    most = tables.places * tables.patterns
    heats, still = most * most, most * most + most
    used, aired = index[USED] * tables.patterns, index[AIRED] > 0
    capacity = slow[HELD] * slow[HELD]
    heat = held_heat(slow, body, heats, still, x, used, aired)
    if aired:
        for r in range(RATES):
            capacity += body[still, r]
    mean = heat / capacity
    x[0] = slow[HELD] * mean
    x[1 : 1 + RATES] = mean
    x[1 + RATES : 1 + RATES * (1 + most)] = 0.0


@njit(cache=True, inner=True, error_model="numpy", fastmath=FAST, forceinline=True)
def advance_fixed(tables, i, x, conductance, difference, around, room, reading, b, k):
    """One step of row i, state x in place, for compiled callers. conductance: (F,) W/K, 0 of a fingertip without a
    place. difference: (F,) K, what element less box was when both were uniform. around: K, the air above the box's
    first temperature. Into sample k of row b of a HeatReading, whose air_loss is what the air takes in all."""
    dt, patterns, most = tables.dt, tables.patterns, tables.places * tables.patterns
    rates, poles, index = tables.rates, tables.poles, tables.links[i]
    slow, body, gram = tables.slow[i], tables.body[i], tables.gram[i]
    tips, count, lasting, square = tables.tips, RATES, POLES_KEPT, patterns * patterns
    fingertips = (len(index) - WHERE) // 2
    used, aired = index[USED] * patterns, index[AIRED] > 0
    heats, still = most * most, most * most + most  # rows of the body
    z, fields = 1, 1 + count
    first_tip = fields + most * count
    of_tip = lasting + count * (1 + patterns)
    moved, flows, matrix, factors = room.moved, room.flows, room.matrix, room.factors
    flow0, weight = room.numbers[0], room.numbers[1]
    slope = -slow[0] * (x[0] - slow[HELD] * around)
    before = held_heat(slow, body, heats, still, x, used, aired) if aired else 0.0

    poled, row, seen = 2 * LANES, 2 * LANES * flows.shape[0], tables.seen
    of_element = (square + 2 * patterns + 2) * count
    touching = 0
    for f in range(fingertips):
        reading.flow[b, k, f] = 0.0
        if conductance[f] <= 0.0:
            continue
        first = index[WHERE + fingertips + f] * of_element
        tip = first_tip + f * of_tip
        for p in range(patterns):
            j, at, held = index[WHERE + f] * patterns + p, touching * count, tip + lasting
            residues, heat = first + p * patterns * count, first + (square + patterns + p) * count
            difference_left = slow[HELD + 1 + j] * x[0]
            for r in range(RATES):
                moved[touching, r] = 0.0
            if aired:
                for r in range(RATES):
                    moved[touching, r] = body[heats + j, r] * (x[z + r] - around)
                    difference_left += body[heats + j, r] * around
            for n in range(0, count, LANES):
                add_products(moved, at + n, body, j * most * count + n, x, fields + n, count, used)
                take_products(moved, at + n, tips, residues + n, x, held + count + n, count, patterns)
                take_products(moved, at + n, tips, heat + n, x, held + n, count, 1)
            for r in range(RATES):
                difference_left += moved[touching, r]
                moved[touching, r] *= -rates[0, r]
            if p == 0:
                difference_left -= difference[f]
                for r in range(POLES_KEPT):
                    difference_left -= poles[PORT, r] * x[tip + r]
            flow0[touching] = -difference_left / dt
            weight[touching] = 1 / (dt * conductance[f])
            touching += 1

    a = 0
    for f in range(fingertips):
        if conductance[f] <= 0.0:
            continue
        tip = first_tip + f * of_tip
        for p in range(patterns):
            push = slow[HELD + 1 + index[WHERE + f] * patterns + p] * slope
            for part in range(2):
                lane = part * LANES
                put_sum(flows, a * poled + lane, seen, lane, poled, moved, a * count, count)
                for q in range(PAIRS):
                    heard = flows[a, part, q] + slow[SEEN + part * PAIRS + q] * push
                    if p == 0:
                        for r in range(POLES_KEPT):
                            heard += (
                                poles[SEEN + part * PAIRS + q, r] * poles[PORT, r] * poles[0, r] * x[tip + r]
                            )
                    flows[a, part, q] = (flow0[a] if part == 0 else 0.0) - heard
            c = 0
            for g in range(fingertips):
                if conductance[g] <= 0.0:
                    continue
                for r in range(patterns):
                    if c >= a:
                        known = ((f * patterns + p) * fingertips * patterns + g * patterns + r) * poled
                        put(matrix, a * row + c * poled, gram, known)
                        put(matrix, a * row + c * poled + LANES, gram, known + LANES)
                    c += 1
            for q in range(LANES):
                matrix[a, a, 0, q] += weight[a]
            a += 1
    solve_symmetric(matrix, row, flows, factors, touching)

    for r in range(RATES):
        x[z + r] = around + rates[FADING, r] * (x[z + r] - around)
    for other in range(used):
        start = fields + other * count
        for r in range(RATES):
            x[start + r] *= rates[FADING, r]
    x[0] = slow[HELD] * around + slow[FADING] * (x[0] - slow[HELD] * around)
    for f in range(fingertips):
        tip = first_tip + f * of_tip
        for r in range(POLES_KEPT):
            x[tip + r] *= poles[FADING, r]
        for other in range(1 + patterns):
            start = tip + lasting + other * count
            for r in range(RATES):
                x[start + r] *= rates[FADING, r]
    a, taken = 0, 0.0
    for f in range(fingertips):
        if conductance[f] <= 0.0:
            continue
        tip = first_tip + f * of_tip
        for p in range(patterns):
            j = index[WHERE + f] * patterns + p
            start, under = fields + j * count, tip + lasting + (1 + p) * count
            for n in range(0, count, LANES):
                real, imag = PUSHED * count + n, (PUSHED + PAIRS) * count + n
                put_sum(moved, a * count + n, rates, real, count, flows, a * poled, PAIRS)
                add_sum(moved, a * count + n, rates, imag, count, flows, a * poled + LANES, 1, PAIRS)
            mean, into = 0.0, 0.0
            for q in range(PAIRS):
                real, imag = flows[a, 0, q], flows[a, 1, q]
                mean -= 2 * (_LAGS[q].real * real - _LAGS[q].imag * imag)
                into += slow[PUSHED + q] * real + slow[PUSHED + PAIRS + q] * imag
            for r in range(RATES):
                x[start + r] += moved[a, r]
                x[under + r] -= moved[a, r]
            x[0] += slow[HELD + 1 + j] * into
            if p == 0:
                reading.flow[b, k, f] = mean
                for r in range(POLES_KEPT):
                    into = 0.0
                    for q in range(PAIRS):
                        into += poles[PUSHED + q, r] * flows[a, 0, q]
                        into += poles[PUSHED + PAIRS + q, r] * flows[a, 1, q]
                    x[tip + r] -= poles[PORT, r] * into
            if aired:  # what all states lose is what came in less what they gained, each by itself
                whole = slow[HELD] * slow[HELD + 1 + j]
                for r in range(RATES):
                    whole += body[heats + j, r]
                taken += mean * whole
            a += 1

    now = held_heat(slow, body, heats, still, x, used, aired)
    reading.object_heat[b, k] = now
    reading.air_loss[b, k] = taken - (now - before) / dt if aired else 0.0
    for f in range(fingertips):
        first = index[WHERE + fingertips + f] * of_element
        tip = first_tip + f * of_tip
        states = tip + lasting + count
        drop = dot(tips, first + square * count, x, states, patterns * BLOCKS)
        heat = dot(tips, first + (square + patterns) * count, x, states, patterns * BLOCKS)
        rise = dot(tips, first, x, states, patterns * BLOCKS)
        for r in range(POLES_KEPT):
            drop += poles[DROP, r] * x[tip + r]
            heat += poles[POLE_HEAT, r] * x[tip + r]
            rise += poles[PORT, r] * x[tip + r]
        drop += dot(tips, first + (square + 2 * patterns) * count, x, states - count, BLOCKS)
        heat += dot(tips, first + (square + 2 * patterns + 1) * count, x, states - count, BLOCKS)
        rise += dot(tips, first + (square + patterns) * count, x, states - count, BLOCKS)
        reading.drop[b, k, f], reading.element_heat[b, k, f] = drop, heat
        reading.sensor_rise[b, k, f] = rise
        above, j = now / (slow[HELD] * slow[HELD]), index[WHERE + f] * patterns
        if j >= 0:
            above = slow[HELD + 1 + j] * x[0] + dot(body, j * most * count, x, fields, used * BLOCKS)
            if aired:
                above += dot(body, (heats + j) * count, x, z, BLOCKS)
        reading.object_rise[b, k, f] = above
