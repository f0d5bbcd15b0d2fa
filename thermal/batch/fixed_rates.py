"""Heat of boxes and fingertips whose networks share their rates: what differs between rows is residues alone.

A contact's flow q is known to either body by how it has faded at each of the level's rates, y' = -rate y + q: the same
numbers whatever the body, its place and its size, so that a field stays where fingertips come, go, slide and change
objects. A body's temperature at its ports is the sum over the rates of (residues y). The step is that of
network/coupling.py; as a rate's states fade alike, its products with ports are taken once and not at each pole.

Beside its contacts a body follows its surroundings (a box the air, an element its thermostat): z' = rate (around - z),
and u z of it at the ports; by reciprocity u y is heat of the flows. A box's slowest state is its own and comes first.

B: rows, F: fingertips, M: places of a box, P: patterns of a contact, N = M P, K = RATES, E = POLES_KEPT: an element's
slow poles, Q: pole pairs, T: elements under different contacts.
"""

from __future__ import annotations

from collections.abc import Sequence
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

from ..kernels import BodyResidues, Resolution
from ..network import POLES, WEIGHTS
from ..numerics import FAST, ThermalNetwork
from .carry import TipRows

FIXED_LEVEL = Resolution(12, 3, slowest=3e-3)
"""Of all networks; slower ones than a touch lasts, since in sheets of poor conductors heat stays where it is. With
slower ones still, the others would be too far from each other for metals under a small, good contact."""
SHARED = FIXED_LEVEL.decay
"""1/s: the rates of all networks."""
_PAIRS = len(POLES)
_POLES, _WEIGHTS = POLES[:, None], WEIGHTS[:, None]
_FADING, _SEEN, _PUSHED = 1, 2, 2 + 2 * _PAIRS
_RATE_ROWS = (
    2 + 4 * _PAIRS
)  # of a rate: itself, how it fades in a step, how it is seen and pushed at the poles
HELD = _RATE_ROWS  # of the slowest state of a box: sqrt(J K) of heat in it
_PORT, _DROP, POLE_HEAT = _RATE_ROWS, _RATE_ROWS + 1, _RATE_ROWS + 2  # of an element's pole
RATES, POLES_KEPT = len(SHARED), 8
"""Of a level, and at most of an element's slow poles: loops of a length that the compiler knows are faster, and what is
left over is zero. So are lanes (thermograsp/lanes.py), in which the step's poles and a level's rates are taken."""
_BLOCKS = RATES // LANES
USED, AIRED, WHERE = 0, 1, 2  # of FixedTables.links; then a fingertip's place each, then its element


class FixedTables(NamedTuple):
    """Rows of boxes between fingertips, for steps of dt s.

    patterns, places: P and M. rates (14, K) and poles (17, E): rates 1/s, and what a step makes of them; of poles
    their ports sqrt(K/J), drop and heat too. tips (T, P P + 2 P + 2, K): residues K/J, drop and heat rows, and what
    follows the thermostat of either. slow (B, 15 + N): of a box's slowest state the same, its heat, and its ports.
    body (B, N N + N + 1, K): residues of the places under fingertips by those of all, heat rows u, heat of what follows
    the air J/K. gram (B, F P, F P, 2, LANES): real and imaginary K/J of all that is in touch at the poles. links
    (B, 2 + 2 F): places used, whether the air takes any heat, each fingertip's place (-1 for none) and element. seen
    (K, 2, LANES): real and imaginary parts of how rates are seen at the poles, as in `rates`.
    """

    dt: float
    patterns: int
    places: int
    rates: np.ndarray
    poles: np.ndarray
    tips: np.ndarray
    slow: np.ndarray
    body: np.ndarray
    gram: np.ndarray
    links: np.ndarray
    seen: np.ndarray

    @property
    def states(self) -> int:
        """Of a row."""
        count, tips = self.rates.shape[1], (self.links.shape[1] - WHERE) // 2
        return 1 + count * (1 + self.places * self.patterns) + tips * self.of_tip

    @property
    def of_tip(self) -> int:
        """States of a fingertip; they come last, one fingertip after the other."""
        return self.poles.shape[1] + self.rates.shape[1] * (1 + self.patterns)


def fixed_tables(
    rows: int, fingertips: int, places: int, patterns: int, whole: ThermalNetwork, dt: float
) -> FixedTables:
    """Empty tables. whole: the element under a contact with all of its face, which is element 0."""
    slow = _slow(whole)
    poles, rates = np.zeros((_RATE_ROWS + 3, POLES_KEPT)), np.zeros((_RATE_ROWS, RATES))
    poles[:_RATE_ROWS, :slow] = _rate_table(whole.rates[:slow], dt)
    seen = whole.ports[:, 0], whole.outputs["drop"], whole.outputs["element"]
    poles[_PORT, :slow], poles[_DROP, :slow], poles[POLE_HEAT, :slow] = (row[:slow] for row in seen)
    rates[:] = _rate_table(SHARED, dt)
    ports = places * patterns
    tables = FixedTables(
        dt,
        patterns,
        places,
        rates,
        poles,
        np.zeros((1 + rows * fingertips, patterns * patterns + 2 * patterns + 2, RATES)),
        np.zeros((rows, _RATE_ROWS + 1 + ports)),
        np.zeros((rows, ports * ports + ports + 1, RATES)),
        np.zeros((rows, fingertips * patterns, fingertips * patterns, 2, LANES)),
        np.full((rows, WHERE + 2 * fingertips), -1),
        np.zeros((RATES, 2, LANES)),
    )
    tables.links[:, WHERE + fingertips :] = 0
    tables.seen[:, :, :_PAIRS] = tables.rates[_SEEN:_PUSHED].reshape(2, _PAIRS, RATES).transpose(2, 0, 1)
    tables.tips[0] = tip_residues(whole)
    return tables


def no_fixed_tables(dt: float) -> FixedTables:
    """Of no rows."""
    return FixedTables(
        dt,
        1,
        1,
        np.zeros((_RATE_ROWS, RATES)),
        np.zeros((_RATE_ROWS + 3, POLES_KEPT)),
        np.zeros((1, 5, RATES)),
        np.zeros((0, HELD + 2)),
        np.zeros((0, 3, RATES)),
        np.zeros((0, 1, 1, 2, LANES)),
        np.zeros((0, WHERE + 2), int),
        np.zeros((RATES, 2, LANES)),
    )


def set_gram(tables: FixedTables, row: int) -> None:
    """Makes what meets at the row's contacts what its other tables say; after these have changed."""
    parts = tables.slow[row], tables.body[row], tables.gram[row], tables.links[row]
    _gram(tables.rates, tables.poles, tables.tips, *parts, tables.patterns, tables.places)


def fixed_heat(tables: FixedTables, row: int, state: np.ndarray) -> float:
    """J in the row's box above its first temperature; state (n,)."""
    parts = tables.slow[row], tables.body[row], tables.links[row]
    return _box_heat(*parts, state, tables.patterns, tables.places)


def fixed_warmth(tables: FixedTables, row: int, state: np.ndarray, left: np.ndarray) -> list[float]:
    """K at each place of the row's box from what has flowed through it alone, of which so much is left (K,)."""
    return _warmth(tables.body[row], state, left, tables.patterns, tables.places).tolist()


def fixed_tip_rows(tables: FixedTables, number: int) -> TipRows:
    """What a fingertip with the element of that number tells of its states."""
    patterns, rates, poles, element = tables.patterns, tables.rates[0], tables.poles, tables.tips[number]
    drop, heat, ports = (
        element[first : first + patterns] for first in (patterns**2, patterns**2 + patterns, 0)
    )
    still = element[patterns**2 + 2 * patterns :]
    return TipRows(
        np.concatenate((poles[0], np.tile(rates, 1 + patterns))),
        np.concatenate((poles[POLE_HEAT], still[1], heat.ravel())),
        np.concatenate((poles[_DROP], still[0], drop.ravel())),
        np.concatenate((poles[_PORT], heat[0], ports.ravel())),
        np.zeros((0, len(poles[0]) + (1 + patterns) * len(rates))),
    )


def fixed_tip_heat(tables: FixedTables, element: np.ndarray) -> np.ndarray:
    """(of_tip,) of such rows, the heat's alone. element: one of the tips."""
    patterns = tables.patterns
    first = patterns**2 + patterns
    return np.concatenate((tables.poles[POLE_HEAT], element[-1], element[first : first + patterns].ravel()))


def _rate_table(rates: np.ndarray, dt: float) -> np.ndarray:
    """(14, n) of rates (n,) 1/s: themselves, what of a state is left after a step, how it is seen at the poles, and
    what flows at the poles push it by."""
    scale = 1 / (_POLES + dt * rates)
    weighted = -2 * dt * (_WEIGHTS * scale)
    left = 1 - rates * weighted.real.sum(axis=0)
    return np.concatenate((rates[None], left[None], scale.real, scale.imag, weighted.real, -weighted.imag))


def tip_residues(side: ThermalNetwork) -> np.ndarray:
    """(P P + 2 P + 2, K) of an element at FIXED_LEVEL's rates: a row of FixedTables.tips. Raises ValueError for one of
    other rates."""
    found = np.zeros((side.ports.shape[1] ** 2 + 2 * side.ports.shape[1] + 2, RATES))
    if not _tip_residues(
        side.rates, side.ports, side.outputs["drop"], side.outputs["element"], SHARED, found
    ):
        raise ValueError(f"rates {side.rates} 1/s are not among the shared ones, {SHARED}")
    return found


@njit(cache=True, short_loops=True, error_model="numpy")
def _tip_residues(rates, ports, drop, heat, shared, found):
    """Fills found, the sums over the states that fade at each of the shared rates. Whether each does."""
    patterns, first = ports.shape[1], 0
    while first < len(rates) and _even_alone(ports, first):
        first += 1
    for n in range(first, len(rates)):
        k = 0
        while k < len(shared) and shared[k] != rates[n]:
            k += 1
        if k == len(shared):
            return False
        for p in range(patterns):
            for r in range(patterns):
                found[p * patterns + r, k] += ports[n, p] * ports[n, r]
            found[patterns * patterns + p, k] += ports[n, p] * drop[n]
            found[patterns * patterns + patterns + p, k] += ports[n, p] * heat[n]
        found[len(found) - 2, k] += drop[n] * heat[n]
        found[len(found) - 1, k] += heat[n] * heat[n]
    return True


@njit(cache=True, inner=True, error_model="numpy")
def _even_alone(ports, n):
    """Whether only the even pattern sees that state."""
    for p in range(1, ports.shape[1]):
        if ports[n, p] != 0.0:
            return False
    return True


def set_body(tables: FixedTables, row: int, box: BodyResidues, places: Sequence[int]) -> None:
    """Makes a box the row's, whose patches, those under fingertips first, are the places of these numbers."""
    parts = tables.slow[row], tables.body[row], tables.links[row]
    _body(*parts, np.array(places), tables.patterns, tables.dt, *box)


@njit(cache=True, error_model="numpy")
def _body(slow, body, index, places, patterns, dt, rate, ports, held, residues, heat, still):
    """Fills one row's slow, body and index, for steps of dt s. The rest is a BodyResidues."""
    most, touched, told = (len(slow) - HELD - 1), len(residues), len(ports)
    slow[:], body[:] = 0.0, 0.0
    slow[0], slow[_FADING], slow[HELD] = rate, 1.0, held
    for q in range(_PAIRS):  # as in _rate_table
        scale = 1 / (POLES[q] + dt * rate)
        pushed = -2 * dt * (WEIGHTS[q] * scale)
        slow[_FADING] -= rate * pushed.real
        slow[_SEEN + q], slow[_SEEN + _PAIRS + q] = scale.real, scale.imag
        slow[_PUSHED + q], slow[_PUSHED + _PAIRS + q] = pushed.real, -pushed.imag
    for j in range(told):
        at = places[j // patterns] * patterns + j % patterns
        slow[HELD + 1 + at] = ports[j]
        for k in range(RATES):
            body[most * most + at, k] = heat[j, k]
            for i in range(touched):
                to = places[i // patterns] * patterns + i % patterns
                body[to * most + at, k] = residues[i, j, k]
            if j >= touched and j % patterns == 0:
                body[at * most + at, k] = residues[0, 0, k]  # stands in for its own, which no step asks for
    index[USED], index[AIRED] = len(places), 0
    for k in range(RATES):
        body[most * most + most, k] = still[k]
        if still[k] != 0.0:
            index[AIRED] = 1


@njit(cache=True, error_model="numpy")
def _box_heat(slow, body, index, x, patterns, places):
    """See fixed_heat; of one row's slow, body and index."""
    most = patterns * places
    used, aired = index[USED] * patterns, index[AIRED] > 0
    return _held(slow, body, most * most, most * most + most, x, used, aired)


@njit(cache=True, error_model="numpy")
def _warmth(body, x, left, patterns, places):
    """See fixed_warmth; of one row's body."""
    most, found = patterns * places, np.zeros(places)
    for n in range(places):
        even, start = n * patterns * (most + 1), 1 + RATES * (1 + n * patterns)
        for k in range(RATES):
            found[n] += body[even, k] * x[start + k] * left[k]
        found[n] = abs(found[n])
    return found


def _slow(element: ThermalNetwork) -> int:
    """How many of an element's states are its slow poles, which only the even pattern sees."""
    return int(np.argmax(np.append(element.ports[:, 1:].any(axis=1), True)))


@njit(cache=True, error_model="numpy")
def _gram(rates, poles, tips, slow, body, gram, index, patterns, places):
    """Fills gram (F P, F P, 2, LANES) of one row from the other tables and its own slow, body and index."""
    most = places * patterns
    fingertips = (len(index) - WHERE) // 2
    gram[:] = 0.0
    for f in range(fingertips):
        element = tips[index[WHERE + fingertips + f]]
        for p in range(patterns):
            a = f * patterns + p
            for part in range(2):
                for q in range(_PAIRS):
                    at = _SEEN + part * _PAIRS + q
                    for r in range(patterns):
                        for k in range(RATES):
                            gram[a, f * patterns + r, part, q] += rates[at, k] * element[p * patterns + r, k]
                    if p == 0:
                        for k in range(POLES_KEPT):
                            gram[a, a, part, q] += poles[at, k] * poles[_PORT, k] * poles[_PORT, k]
                    if index[WHERE + f] < 0:
                        continue
                    j = index[WHERE + f] * patterns + p
                    for g in range(fingertips):
                        if index[WHERE + g] < 0:
                            continue
                        for r in range(patterns):
                            i, c = index[WHERE + g] * patterns + r, g * patterns + r
                            gram[a, c, part, q] += slow[at] * slow[HELD + 1 + j] * slow[HELD + 1 + i]
                            for k in range(RATES):
                                gram[a, c, part, q] += rates[at, k] * body[j * most + i, k]


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
    heat = _held(slow, body, heats, still, x, used, aired)
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
    before = _held(slow, body, heats, still, x, used, aired) if aired else 0.0

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
                    difference_left -= poles[_PORT, r] * x[tip + r]
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
                for q in range(_PAIRS):
                    heard = flows[a, part, q] + slow[_SEEN + part * _PAIRS + q] * push
                    if p == 0:
                        for r in range(POLES_KEPT):
                            heard += (
                                poles[_SEEN + part * _PAIRS + q, r]
                                * poles[_PORT, r]
                                * poles[0, r]
                                * x[tip + r]
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
        x[z + r] = around + rates[_FADING, r] * (x[z + r] - around)
    for other in range(used):
        start = fields + other * count
        for r in range(RATES):
            x[start + r] *= rates[_FADING, r]
    x[0] = slow[HELD] * around + slow[_FADING] * (x[0] - slow[HELD] * around)
    for f in range(fingertips):
        tip = first_tip + f * of_tip
        for r in range(POLES_KEPT):
            x[tip + r] *= poles[_FADING, r]
        for other in range(1 + patterns):
            start = tip + lasting + other * count
            for r in range(RATES):
                x[start + r] *= rates[_FADING, r]
    a, taken = 0, 0.0
    for f in range(fingertips):
        if conductance[f] <= 0.0:
            continue
        tip = first_tip + f * of_tip
        for p in range(patterns):
            j = index[WHERE + f] * patterns + p
            start, under = fields + j * count, tip + lasting + (1 + p) * count
            for n in range(0, count, LANES):
                real, imag = _PUSHED * count + n, (_PUSHED + _PAIRS) * count + n
                put_sum(moved, a * count + n, rates, real, count, flows, a * poled, _PAIRS)
                add_sum(moved, a * count + n, rates, imag, count, flows, a * poled + LANES, 1, _PAIRS)
            mean, into = 0.0, 0.0
            for q in range(_PAIRS):
                real, imag = flows[a, 0, q], flows[a, 1, q]
                mean -= 2 * (_LAGS[q].real * real - _LAGS[q].imag * imag)
                into += slow[_PUSHED + q] * real + slow[_PUSHED + _PAIRS + q] * imag
            for r in range(RATES):
                x[start + r] += moved[a, r]
                x[under + r] -= moved[a, r]
            x[0] += slow[HELD + 1 + j] * into
            if p == 0:
                reading.flow[b, k, f] = mean
                for r in range(POLES_KEPT):
                    into = 0.0
                    for q in range(_PAIRS):
                        into += poles[_PUSHED + q, r] * flows[a, 0, q]
                        into += poles[_PUSHED + _PAIRS + q, r] * flows[a, 1, q]
                    x[tip + r] -= poles[_PORT, r] * into
            if aired:  # what all states lose is what came in less what they gained, each by itself
                whole = slow[HELD] * slow[HELD + 1 + j]
                for r in range(RATES):
                    whole += body[heats + j, r]
                taken += mean * whole
            a += 1

    now = _held(slow, body, heats, still, x, used, aired)
    reading.object_heat[b, k] = now
    reading.air_loss[b, k] = taken - (now - before) / dt if aired else 0.0
    for f in range(fingertips):
        first = index[WHERE + fingertips + f] * of_element
        tip = first_tip + f * of_tip
        states = tip + lasting + count
        drop = dot(tips, first + square * count, x, states, patterns * _BLOCKS)
        heat = dot(tips, first + (square + patterns) * count, x, states, patterns * _BLOCKS)
        rise = dot(tips, first, x, states, patterns * _BLOCKS)
        for r in range(POLES_KEPT):
            drop += poles[_DROP, r] * x[tip + r]
            heat += poles[POLE_HEAT, r] * x[tip + r]
            rise += poles[_PORT, r] * x[tip + r]
        drop += dot(tips, first + (square + 2 * patterns) * count, x, states - count, _BLOCKS)
        heat += dot(tips, first + (square + 2 * patterns + 1) * count, x, states - count, _BLOCKS)
        rise += dot(tips, first + (square + patterns) * count, x, states - count, _BLOCKS)
        reading.drop[b, k, f], reading.element_heat[b, k, f] = drop, heat
        reading.sensor_rise[b, k, f] = rise
        above, j = now / (slow[HELD] * slow[HELD]), index[WHERE + f] * patterns
        if j >= 0:
            above = slow[HELD + 1 + j] * x[0] + dot(body, j * most * count, x, fields, used * _BLOCKS)
            if aired:
                above += dot(body, (heats + j) * count, x, z, _BLOCKS)
        reading.object_rise[b, k, f] = above


_LAGS = WEIGHTS / POLES


@njit(cache=True, inner=True, error_model="numpy", fastmath=FAST, forceinline=True)
def _held(slow, body, heats, still, x, used, aired):
    """J in a box, above its first temperature."""
    total = slow[HELD] * x[0]
    if aired:
        total += dot(body, still * RATES, x, 1, _BLOCKS)
        total += dot(body, heats * RATES, x, 1 + RATES, used * _BLOCKS)
    return total
