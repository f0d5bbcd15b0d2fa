"""Fingertips on a box, anywhere on its faces, as passive networks of fixed rates: a field's states are how its flows
have faded at these, whatever the body, so that it stays where a place, a size or an object changes.

Z(s) of a conducting body is a sum of R_k / (s + rate_k) with positive semidefinite residues. Put on rates that are the
same for every body, equally spaced in the logarithm, it is found by least squares under that constraint
(numerics/passive_residues.py), in the same few steps whatever the body: no search and no eigenproblem of its size, and
what comes out is passive by construction. Each contact keeps the few patterns of flow that it excites (coverage.py).
The film of air on the box does not cover what lies under a fingertip.

F: fingertips, P: patterns known (patterns.py), M: kept of each, S: moments, n: states.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property, lru_cache
from typing import NamedTuple

import numba
import numpy as np

from thermograsp.compiled import njit

from ..matter import Material, SensorStack
from ..numerics import (
    ThermalNetwork,
    least_row,
    output_row,
    passive_residues,
    passive_states,
)
from .box import BoxSamples, Patches, box_samples
from .coverage import Rectangle, Spot, contact_patterns, spot_patterns
from .element import POLES, Element, compiled_impedance, element, seen_face
from .excited import shown_element
from .patterns import FUNCTIONS, JUMPS, basis_shares, basis_terms
from .samples import GRASP, OF_GRASP

_WEIGHED = 3e4  # W/(m2 K) of the contact beside which errors of impedances are weighed


@dataclass(frozen=True, slots=True)
class Resolution:
    """The knob between speed and accuracy. rates: how many, of every network, slowest to fastest 1/s equally spaced in
    the logarithm. patterns: kept of each contact. least: a state's share of the whole resistance below which it is left
    out."""

    rates: int
    patterns: int
    slowest: float = 0.01
    fastest: float = 1e3
    least: float = 2e-5

    @property
    def decay(self) -> np.ndarray:
        """(rates,) 1/s."""
        return _decay(self.rates, self.slowest, self.fastest)


@lru_cache(maxsize=64)
def _decay(count: int, slowest: float, fastest: float) -> np.ndarray:
    rates = np.geomspace(slowest, fastest, count)
    rates.setflags(write=False)
    return rates


@dataclass(frozen=True, eq=False)
class Tip:
    """A fingertip's element under a contact of m2 area: basis (P, M) of the patterns kept and even (M,), the net heat
    of each; impedance (S,) K/W of the even one; side: its network, outputs "drop" (K) and "element" (J)."""

    area: float
    basis: np.ndarray
    even: np.ndarray
    impedance: np.ndarray
    side: ThermalNetwork

    @property
    def uniform(self) -> np.ndarray:
        """(n,) the states of an element that is 1 K warm throughout, in its slowest modes; the others forget it at
        once."""
        heat = self.side.outputs["element"]
        return np.where(np.arange(len(heat)) < POLES, heat, 0.0)

    @cached_property
    def weight(self) -> np.ndarray:
        """(S,) W/K, what an error of an object's impedance counts at most."""
        return contact_weight(self.impedance, self.area)

    @cached_property
    def shares(self) -> np.ndarray:
        """(2, M, F) of the functions along the patch's axes, as basis_shares has them."""
        return basis_shares(self.basis)

    @cached_property
    def jumps(self) -> np.ndarray:
        """(2, M, E) of these."""
        return self.shares @ JUMPS


def contact_weight(impedance: np.ndarray, area: float) -> np.ndarray:
    """W/K, what an error of impedance counts beside an element of impedance (S,) K/W under a contact of m2 area."""
    return 1 / (impedance + 1 / (_WEIGHED * area))


@lru_cache(maxsize=1024)
def tip(stack: SensorStack, covered: Rectangle, level: Resolution) -> Tip:
    """The element under a contact that covers that rectangle of its face, m from the face's corner, wherever it is."""
    return _tip(element(stack), covered, level, contact_patterns(stack, covered, level.patterns))


@lru_cache(maxsize=1024)
def tip_at(stack: SensorStack, spot: Spot, level: Resolution, covered: Rectangle | None = None) -> Tip:
    """The element under a contact, on the patterns of that place. covered: what it covers of its face, where that is
    only nearly as much as there."""
    known = element(stack)
    return _tip(known, covered or spot.contact.covered, level, spot_patterns(known, spot, level.patterns))


def tips_at(stack: SensorStack, spots: Sequence[tuple[Spot, Rectangle]], level: Resolution) -> list[Tip]:
    """The same of many: one kind of thing after the other, which the processor does in less time."""
    known = element(stack)
    for spot, covered in spots:
        seen_face(known, covered, shown=False)
        shown_element(known, spot.contact.covered)
    for spot, _ in spots:
        spot_patterns(known, spot, level.patterns)
    return [tip_at(stack, spot, level, covered) for spot, covered in spots]


def _tip(known: Element, covered: Rectangle, level: Resolution, basis: np.ndarray) -> Tip:
    kept, seen = basis.shape[1], seen_face(known, covered, shown=False)
    unit, samples, functions = _unit(kept), len(GRASP), len(FUNCTIONS)
    # few arrays: each that compiled code returns costs a microsecond
    (rates, drop, heat), ports, told = _pressed(
        basis,
        JUMPS,
        basis_terms(kept),
        unit,
        *_rates(level),
        level.least,
        GRASP,
        known.slow,
        known.rates,
        known.ports,
        known.drop,
        known.heat,
        *_rest(known),
        *seen,
    )
    side = ThermalNetwork.of_rates(rates, ports, {"drop": drop, "element": heat})
    made = Tip(seen[0], basis, unit[0], told[:samples], side)
    along = 2 * samples + 2 * kept * functions
    vars(made).update(  # they need not be found once more
        weight=told[samples : 2 * samples],
        shares=told[2 * samples : along].reshape(2, kept, functions),
        jumps=told[along:].reshape(2, kept, -1),
    )
    return made


@njit(cache=True, error_model="numpy")
def _pressed(
    basis,
    function_jumps,
    terms,
    gram,
    columns,
    decay,
    least,
    moments,
    slow_part,
    slow,
    seen,
    drops,
    heats,
    drop_rest,
    heat_rest,
    *face,
):
    """An element's states on the patterns of basis (P, M): (3, n) of rates, drop and heat, ports (n, M), and one after
    the other its impedance (S,), Tip.weight (S,), shares (2, M, F) and jumps (2, M, E). function_jumps: JUMPS. columns:
    fades of decay (K,) 1/s. slow_part (S,) K/W: of the slow states. face: as seen_face tells it. The rest as
    in compiled_impedance and _element_states."""
    kept, functions, nodes, samples = len(gram), len(function_jumps), function_jumps.shape[1], len(moments)
    told = np.empty(2 * (samples + kept * (functions + nodes)))
    alone, weight = told[:samples], told[samples : 2 * samples]
    shares = told[2 * samples : 2 * (samples + kept * functions)].reshape(2, kept, functions)
    jumps = told[2 * (samples + kept * functions) :].reshape(2, kept, nodes)
    for axis in range(2):
        for m in range(kept):
            shares[axis, m, 0] = 1.0 if m == 0 else (basis[0, m] if axis == 0 else 0.0)
            for f in range(1, functions):
                of = f if axis == 0 else functions - 1 + f
                shares[axis, m, f] = basis[of, m] if m > 0 else 0.0
            for e in range(nodes):
                jumps[axis, m, e] = 0.0
                for f in range(functions):
                    jumps[axis, m, e] += shares[axis, m, f] * function_jumps[f, e]
    rest, area = compiled_impedance(shares, terms, gram, *face), face[0]
    for s in range(samples):
        alone[s] = rest[s, 0, 0]
        weight[s] = 1 / (alone[s] + 1 / (_WEIGHED * area))
        rest[s, 0, 0] -= slow_part[s]
    fast, fast_ports = passive_states(columns, rest, weight, decay, least / weight[-1])
    states, ports = _element_states(
        fast, fast_ports, weight, moments, slow, seen, drops, heats, drop_rest, heat_rest
    )
    return states, ports, told


@lru_cache(maxsize=16)
def _unit(kept: int) -> np.ndarray:
    return np.eye(kept)


@lru_cache(maxsize=64)
def _rates(level: Resolution) -> tuple[np.ndarray, np.ndarray]:
    """fades of them, and themselves."""
    return fades(level.decay), level.decay


@lru_cache(maxsize=64)
def _rest(known: Element) -> tuple[np.ndarray, np.ndarray]:
    """An element's drop_rest and heat_rest at GRASP."""
    return known.drop_rest[OF_GRASP], known.heat_rest[OF_GRASP]


def compile_tip_states() -> None:
    """Compiles what makes a fingertip's network of its impedance, as `tip` does."""
    samples, columns = numba.typeof(np.ones(1)), numba.typeof(np.ones((1, 1)))
    residues = numba.typeof(np.ones((1, 1, 1))), samples, numba.typeof(Resolution(2, 1).decay)
    passive_states.compile((columns, *residues, numba.types.float64))
    arguments = (samples, columns, samples, numba.typeof(GRASP), *(samples,) * 6)
    _element_states.get_call_template(arguments, {})


@njit(cache=True, inner=True, short_loops=True, error_model="numpy")
def _element_states(fast, fast_ports, weight, moments, slow, seen, drops, heats, drop_rest, heat_rest):
    """Rates, drop and heat (3, n) and ports (n, M) of an element's states: the slow ones of rates slow (K,), ports seen
    (K,), drops and heats, then those of rates fast (n - K,) and fast_ports (n - K, M). The rest as in Element."""
    count, kept, samples = len(slow), fast_ports.shape[1], len(moments)
    wanted = np.zeros((2, samples, kept))
    for s in range(samples):
        wanted[0, s, 0], wanted[1, s, 0] = drop_rest[s], heat_rest[s]
    # neither output jumps with heat at the face, but all heat that goes in is in
    jumps = np.zeros((2, kept))
    jumps[1, 0] = 1.0
    for k in range(count):
        jumps[0, 0] -= drops[k] * seen[k]
        jumps[1, 0] -= heats[k] * seen[k]
    states = count + len(fast)
    told, ports = np.empty((3, states)), np.zeros((states, kept))
    rates, drop, heat = told[0], told[1], told[2]
    for k in range(count):
        rates[k], ports[k, 0], drop[k], heat[k] = slow[k], seen[k], drops[k], heats[k]
    for n in range(len(fast)):
        rates[count + n] = fast[n]
        for i in range(kept):
            ports[count + n, i] = fast_ports[n, i]
    for output in range(2):  # one call of it compiles sooner than two
        into, errors = (drop, weight) if output == 0 else (heat, moments)
        row = least_row(moments, wanted[output], fast, fast_ports, errors, jumps[output], True)
        for n in range(len(fast)):
            into[count + n] = row[n]
    return told, ports


def box_side(
    material: Material,
    size: tuple[float, float, float],
    film: float,
    patches: Patches,
    tips: tuple[Tip, ...],
    level: Resolution,
    whole: Sequence[bool] | None = None,
) -> ThermalNetwork:
    """The box's network, M ports a patch, its slowest state first; outputs "object" (J in it) and "loss" (W to the
    air). size: m. film: W/(m2 K), 0 where not all ports are told. tips: on the patches. whole: (N,) of which patches
    all ports are told, or the even one alone and zeros for the others; None: all of them."""
    bases, told = [one.basis for one in tips], ports_told(len(tips), level.patterns, whole)
    box = box_samples(
        *(size, material.conductivity, material.volumetric_heat_capacity, film, patches, bases),
        even=told.even,
    )
    port, rest = box.port, box.impedance[OF_GRASP]
    weight = least_weight(tips, rest, port, box.rate, told.first)
    rate, heat = box.rate, None
    if film > 0:
        rate, rest, heat = _shielded(box, film, rest, tips)
    fast, ports = at_rates(rest, level, weight)
    rates, held = np.concatenate(([rate], fast)), np.zeros(1 + len(fast))
    held[0] = box.held
    if heat is not None:
        net = np.concatenate([one.even for one in tips])
        held[1:] = output_row(GRASP, heat, fast, ports, GRASP, net - box.held * port)
    every = np.zeros((len(rates), len(tips) * level.patterns))
    every[0, told.columns], every[1:, told.columns] = port, ports
    return ThermalNetwork(rates, every, outputs={"object": held, "loss": held * rates})


class Told(NamedTuple):
    """Of patches' ports, of which not all are told. even: (N,) bool, patches of which the even one alone is. first:
    (N,) the number of each one's first among those told. columns: (P,) of those told, their numbers among all."""

    even: np.ndarray
    first: np.ndarray
    columns: np.ndarray

    def of(self, patch: int) -> slice:
        """Which of those told are a patch's."""
        last = len(self.columns) if patch + 1 == len(self.first) else int(self.first[patch + 1])
        return slice(int(self.first[patch]), last)


def ports_told(count: int, patterns: int, whole: Sequence[bool] | None) -> Told:
    """Of so many patches. whole: as in box_side."""
    even = np.zeros(count, bool) if whole is None else ~np.array(whole, bool)
    told = np.ones((count, patterns), bool)
    told[even, 1:] = False
    first = np.cumsum(told.sum(axis=1)) - told.sum(axis=1)
    return Told(even, first, np.flatnonzero(told))


def least_weight(
    tips: Sequence[Tip], impedance: np.ndarray, port: np.ndarray, rate: float, first: np.ndarray
) -> np.ndarray:
    """(S,) W/K, what an error of a box's impedance (S, P, P) K/W counts at most under any of its tips. port: (P,) of
    the slowest state, of that rate 1/s. first: (N,) each tip's even port."""
    weights = [
        1 / (1 / one.weight + impedance[:, n, n] + port[n] ** 2 / (GRASP + rate))
        for one, n in zip(tips, first.tolist(), strict=True)
    ]
    return np.min(weights, axis=0)


def at_rates(impedance: np.ndarray, level: Resolution, weight: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Rates (n,) 1/s, of the level's, and ports (n, N) sqrt(K/J) of a passive network near an impedance (S, N, N) K/W
    at GRASP. weight: (S,) W/K of its errors."""
    told = fades(level.decay), np.ascontiguousarray(impedance), weight
    return passive_states(*told, level.decay, level.least / weight[-1])


def _shielded(
    box: BoxSamples, film: float, rest: np.ndarray, tips: tuple[Tip, ...]
) -> tuple[float, np.ndarray, np.ndarray]:
    """The slowest rate, the samples without it, and the heat's (S, ports), with no film on the patches: a film's flow
    is put back there in proportion to the temperature."""
    assert box.heat is not None
    kept, port = len(tips[0].even), box.port
    back = np.repeat([film * one.area for one in tips], kept)
    slow = 1 / (GRASP + box.rate)
    whole = rest + slow[:, None, None] * np.outer(port, port)
    heat = box.heat[OF_GRASP] + slow[:, None] * box.held * port
    rate = max(box.rate - float(np.sum(back * port**2)), 0.0)
    # T = Z (q + back T)
    opened = np.linalg.inv(np.eye(len(back)) - whole * back)
    whole = opened @ whole
    heat = heat + np.einsum("si,i,sij->sj", heat, back, whole)
    slow = 1 / (GRASP + rate)
    whole = (whole + whole.transpose(0, 2, 1)) / 2
    return rate, whole - slow[:, None, None] * np.outer(port, port), heat - slow[:, None] * box.held * port


def residues(impedance: np.ndarray, rates: np.ndarray, weight: np.ndarray) -> np.ndarray:
    """(K, N, N) positive semidefinite. impedance: (S, N, N) K/W at GRASP. weight: (S,) of its errors, W/K."""
    return passive_residues(fades(rates), impedance, weight)


def fades(rates: np.ndarray) -> np.ndarray:
    """(S, K) s of a unit residue at each rate, at GRASP."""
    return 1 / (GRASP[:, None] + rates)
