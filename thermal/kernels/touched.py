"""Boxes under fingertips as residues at rates that all share, as they are touched.

Fixed-rate steps ask how warm a box is under the fingertips that are on it. Those patches are fitted together, their
residues positive semidefinite (`under_tips`). What flowed through another place once is the past: how warm it leaves
them is a sum of fades that needs no constraint, and between two such places nothing is asked (`touched_box`). So a box
that remembers many places costs hardly more than one that is touched for the first time. The film of air covers what
lies under no fingertip.

N: patches, A: those under fingertips, L: the others, M: patterns of each, T: times, S: moments, K: rates.
"""

from __future__ import annotations

from collections.abc import Sequence
from functools import lru_cache
from typing import NamedTuple

import numpy as np

from thermograsp.compiled import njit

from ..matter import Material
from ..numerics import compiled_residues, free_residues
from .alone import alone_table, compiled_alone
from .axis import SWITCH
from .box import Patches, box_kernel, compiled_kernel
from .contact import Resolution, Tip, fades
from .patterns import JUMPS, NODES, basis_terms
from .samples import GRASP, at_moments, compiled_grasp_rule, grasp_rule, grasp_steps

_HEAT_RIDGE = 1e-8  # of the heat's residues, beside columns of about unit length
_SEEN_LEAST = 1e-3  # of the largest resistance, beside one that a port hardly sees


class TouchedBox(NamedTuple):
    """size: m. film: W/(m2 K). tips: on the patches, of which the first `touched` are under fingertips now."""

    material: Material
    size: tuple[float, float, float]
    film: float
    patches: Patches
    tips: tuple[Tip, ...]
    touched: int


class BodyResidues(NamedTuple):
    """Of a box with N M ports: rate 1/s, ports (N M,) and heat of its slowest state; residues (A M, N M, K) of the
    temperatures of what is touched; heat rows (N M, K) and heat of what follows the air (K,), zeros where it takes
    none."""

    rate: float
    ports: np.ndarray
    held: float
    residues: np.ndarray
    heat: np.ndarray
    still: np.ndarray


class UnderTips(NamedTuple):
    """What of a box follows from the places under its fingertips alone. bare: the box with no other place. For others,
    at GRASP: opened (S, A M, A M), what the temperatures are that flow elsewhere would bring about if the film covered
    the fingertips too, by these; returned (S, A M) J/K, heat that it does not take there, by what they are. slowest:
    1/s, the rate under such a film. weight (S,): what an error of impedance counts, W/K."""

    bare: BodyResidues
    opened: np.ndarray
    returned: np.ndarray
    slowest: float
    weight: np.ndarray


def touched_box(box: TouchedBox, level: Resolution, under: UnderTips | None = None) -> BodyResidues:
    """A box's residues at the level's rates. under: what is known of its places under fingertips, or of others so near
    to these that it serves."""
    count = box.touched
    if under is None:
        under = under_tips(
            box._replace(patches=Patches(*(each[:count] for each in box.patches)), tips=box.tips[:count]),
            level,
        )
    bare = under.bare
    if len(box.tips) == count:
        return bare
    material, size, film, patches, tips, _ = box
    touched, fit, capacity = len(bare.ports), _fit(level), material.volumetric_heat_capacity
    rule = grasp_rule(material.conductivity / capacity)
    # with its film on the patches too, by those under no fingertip
    kernel, _, exact, held, warmth = box_kernel(
        size,
        material.conductivity,
        capacity,
        film,
        patches,
        np.array([one.jumps for one in tips]),
        basis_terms(level.patterns),
        count,
        rule.times,
        count,
    )
    port = np.concatenate((bare.ports, exact[touched:]))
    residues, heat = np.empty((touched, len(port), level.rates)), np.zeros((len(port), level.rates))
    residues[:, :touched], heat[:touched] = bare.residues, bare.heat
    total = np.concatenate([one.even for one in tips[count:]]) if film > 0 else np.zeros(0)
    _beside(
        kernel,
        np.zeros((len(rule.times), kernel.shape[2])) if warmth is None else warmth,
        exact,
        rule.to_moments,
        rule.early,
        port,
        bare.held,
        bare.rate,
        under.slowest,
        under.opened,
        under.returned,
        free_residues(fit.fades, under.weight),
        GRASP,
        total,
        fit.seen,
        fit.share,
        residues,
        heat,
    )
    return BodyResidues(bare.rate, port, bare.held, residues, heat, bare.still)


def under_tips(box: TouchedBox, level: Resolution) -> UnderTips:
    """Of a box all of whose patches are under fingertips."""
    return under_many([box], level)[0]


def under_many(boxes: Sequence[TouchedBox], level: Resolution) -> list[UnderTips]:
    """The same of many at once, which takes less time for each."""
    if not boxes:
        return []
    fit, kept, tips = _fit(level), level.patterns, [one for box in boxes for one in box.tips]
    first = np.cumsum([0, *(len(box.tips) for box in boxes)])
    sizes = np.array([box.size for box in boxes])
    matter = np.array(
        [(box.film, box.material.conductivity, box.material.volumetric_heat_capacity) for box in boxes]
    )
    ports = [kept * len(box.tips) for box in boxes]
    places = np.cumsum([0, *(_room(each, level.rates) for each in ports)])
    told = np.zeros(places[-1])
    _fill_under(
        first,
        sizes,
        matter,
        *(np.concatenate(each) for each in zip(*(box.patches for box in boxes), strict=True)),
        NODES,
        JUMPS,
        alone_table(),
        np.array([one.shares for one in tips]),
        np.array([one.jumps for one in tips]),
        np.array([one.weight for one in tips]),
        np.array([one.even for one in tips]),
        np.array([_mirrored(box) for box in boxes]),
        basis_terms(kept),
        GRASP,
        *grasp_steps(),
        fit.fades,
        fit.seen,
        fit.share,
        places,
        told,
    )
    starts = places.tolist()
    return [
        _told(told[start:end], each, level.rates)
        for start, end, each in zip(starts, starts[1:], ports, strict=False)
    ]


def _room(ports: int, rates: int) -> int:
    """How many numbers _told takes."""
    samples = len(GRASP)
    return 3 + ports + samples + (ports + 1) * rates + ports * ports * (rates + samples) + samples * ports


def _told(numbers: np.ndarray, ports: int, rates: int) -> UnderTips:
    """From numbers one after the other, as _fill_under has them."""
    samples, square = len(GRASP), ports * ports
    rate, slowest, held = numbers[:3].tolist()
    port = 3 + ports
    weight = port + samples
    heat = weight + ports * rates
    still = heat + rates
    residues = still + square * rates
    opened = residues + samples * square
    bare = BodyResidues(
        rate,
        numbers[3:port],
        held,
        numbers[still:residues].reshape(ports, ports, rates),
        numbers[weight:heat].reshape(ports, rates),
        numbers[heat:still],
    )
    return UnderTips(
        bare,
        numbers[residues:opened].reshape(samples, ports, ports),
        numbers[opened:].reshape(samples, ports),
        slowest,
        numbers[port:weight],
    )


def _mirrored(box: TouchedBox) -> bool:
    """Whether two like fingertips are exactly over each other on opposite faces."""
    if len(box.tips) != 2 or box.tips[0] is not box.tips[1]:
        return False
    face, centre, half = (each.tolist() for each in box.patches)
    return face[0] == face[1] ^ 1 and centre[0] == centre[1] and half[0] == half[1]


@njit(cache=True, error_model="numpy")
def _fill_under(
    first,
    sizes,
    matter,
    face,
    centre,
    half,
    nodes,
    function_jumps,
    table,
    shares,
    jumps,
    weight,
    even,
    mirrored,
    terms,
    moments,
    steps,
    sooner,
    columns,
    seen,
    share,
    starts,
    told,
):
    """Writes what _told reads into told, each box's from its place in starts (B + 1,) on. first: (B + 1,), its tips
    among all. sizes: (B, 3) m. matter: (B, 3) W/(m2 K) of the film, W/(m K), J/(m3 K). function_jumps: JUMPS. table,
    shares: as in compiled_alone. weight: (N, S), jumps, even: of the tips. steps, sooner: grasp_steps. columns: fades.
    The rest as in compiled_kernel, _samples and _warmed."""
    samples, rates, kept = len(moments), len(share), len(terms)
    for b in range(len(sizes)):
        here = slice(first[b], first[b + 1])
        size, (film, conductivity, capacity) = sizes[b], (matter[b, 0], matter[b, 1], matter[b, 2])
        count, diffusivity = first[b + 1] - first[b], conductivity / capacity
        ports, out = count * kept, told[starts[b] : starts[b + 1]]
        begun, times, to_grasp, early = compiled_grasp_rule(diffusivity, moments, steps, sooner)
        taus, images = np.empty(len(times)), 0
        for t in range(len(times)):
            taus[t] = diffusivity * times[t]
            images += taus[t] <= SWITCH * size.max() ** 2
        free = np.empty((count, 2, kept, kept, images))
        for n in range(count):
            one = first[b] + n
            compiled_alone(table, function_jumps, nodes, half[one], shares[one], taus[:images], free[n])
        kernel, slowest, port, held, heat = compiled_kernel(
            *(size, film / conductivity, capacity, taus, face[here], centre[here], half[here]),
            *(np.zeros(count, np.bool_), nodes, jumps[here], free, terms, count, 0),
        )
        slowest *= diffusivity
        # before the first time a patch by itself is on a half-space
        alone = 1 / (capacity * np.sqrt(np.pi * begun))
        rest, warmth, counts, lasting, opened, returned = _samples(
            *(
                kernel,
                heat,
                port,
                to_grasp,
                early,
                moments,
                alone,
                half[here],
                slowest,
                held,
                film,
                weight[here],
            )
        )
        found = compiled_residues(columns, rest, counts, mirrored[b])
        out[0], out[1], out[2] = lasting, slowest, held
        at = 3
        for i in range(ports):
            out[at + i] = port[i]
        at += ports
        for s in range(samples):
            out[at + s] = counts[s]
        at += samples
        rows = out[at : at + (ports + 1) * rates].reshape(ports + 1, rates)
        at += (ports + 1) * rates
        if film > 0.0:
            whole = capacity * size[0] * size[1] * size[2]
            _warmed(found, warmth, even[here], port, held, whole, seen, share, rows[:-1], rows[-1])
        for each in (found.reshape(found.size), opened.reshape(opened.size), returned.reshape(returned.size)):
            for i in range(len(each)):
                out[at + i] = each[i]
            at += len(each)


@njit(cache=True, inner=True, error_model="numpy")
def _samples(kernel, heat, port, to_grasp, early, moments, alone, half, rate, held, film, weight):
    """What at_moments and _shielded tell of patches of half widths (A, 2) m under a film of W/(m2 K). alone: K m2/J.
    weight: (A, S)."""
    areas = np.empty(len(half))
    for n in range(len(half)):
        areas[n] = 4 * half[n, 0] * half[n, 1]
    rest, warmth = at_moments(
        kernel, heat, port, alone / areas, np.eye(len(port) // len(half)), to_grasp, early
    )
    counts, lasting, opened, returned = _shielded(
        moments, rest, warmth, rate, port, held, film * areas, weight
    )
    return rest, warmth, counts, lasting, opened, returned


@njit(cache=True, inner=True, error_model="numpy")
def _shielded(moments, rest, heat, rate, port, held, back, weight):
    """Puts back into the samples rest (S, A M, A M) and heat (S, A M), in proportion to the temperature, what a film
    takes from under the fingertips, back (A,) W/K. Returns what an error of impedance counts (S,) W/K, beside weight
    (A, S) of the tips and the box as it was; the slowest rate, as it is; and UnderTips' opened and returned."""
    rows = rest.shape[1]
    patterns = rows // len(back)
    counts, whole = np.empty(len(moments)), np.empty((rows, rows))
    square, lasting = np.empty((rows, rows)), rate
    opened, returned = np.zeros((len(moments), rows, rows)), np.zeros((len(moments), rows))
    for i in range(rows):
        lasting -= back[i // patterns] * port[i] * port[i]
    lasting = max(lasting, 0.0)
    for s in range(len(moments)):
        slow = 1 / (moments[s] + rate)
        counts[s] = np.inf
        for n in range(len(back)):
            at = n * patterns
            alone = rest[s, at, at] + slow * port[at] * port[at]
            counts[s] = min(counts[s], 1 / (1 / weight[n, s] + alone))
        inverse = opened[s]
        for i in range(rows):
            inverse[i, i] = 1.0
        if back[0] == 0.0:
            continue
        for i in range(rows):
            for j in range(rows):
                whole[i, j] = rest[s, i, j] + slow * port[i] * port[j]
                square[i, j] = (1.0 if i == j else 0.0) - whole[i, j] * back[j // patterns]
        # T = Z (q + back T): no pivot is small, as the film would be one of a passive body
        for p in range(rows):
            for i in range(p + 1, rows):
                factor = square[i, p] / square[p, p]
                for j in range(p, rows):
                    square[i, j] -= factor * square[p, j]
                for j in range(rows):
                    inverse[i, j] -= factor * inverse[p, j]
        for p in range(rows - 1, -1, -1):
            for i in range(p + 1, rows):
                for j in range(rows):
                    inverse[p, j] -= square[p, i] * inverse[i, j]
            for j in range(rows):
                inverse[p, j] /= square[p, p]
        for i in range(rows):
            heat[s, i] += slow * held * port[i]
            returned[s, i] = heat[s, i] * back[i // patterns]
        now = 1 / (moments[s] + lasting)
        for i in range(rows):
            for j in range(rows):
                square[i, j] = 0.0
                for m in range(rows):
                    square[i, j] += inverse[i, m] * whole[m, j]
        for j in range(rows):
            for i in range(rows):
                heat[s, j] += returned[s, i] * square[i, j]
            heat[s, j] -= now * held * port[j]
        for i in range(rows):
            for j in range(rows):
                rest[s, i, j] = (square[i, j] + square[j, i]) / 2 - now * port[i] * port[j]
    return counts, lasting, opened, returned


@njit(cache=True, error_model="numpy")
def _beside(
    kernel,
    heat,
    exact,
    to_grasp,
    early,
    port,
    held,
    rate,
    slowest,
    opened,
    returned,
    fit,
    moments,
    total,
    seen,
    share,
    residues,
    rows,
):
    """Fills residues (A M, N M, K) and heat rows (N M, K) of the places under no fingertip. exact, port (N M,): of the
    slowest eigenfunction where the kernel is exact, and as it is in the network. total (L M,): even heats; empty where
    no film takes any heat. The rest as in _Kernel, BodyResidues, UnderTips and _Fit."""
    times, touched, others = kernel.shape
    found, whole = np.empty((touched, others)), np.empty((touched, others))
    summed, flat = found.reshape(touched * others), kernel.reshape(times, touched * others)
    for i in range(touched):
        for j in range(touched, touched + others):
            for k in range(len(share)):
                residues[i, j, k] = 0.0
    for s in range(len(early)):
        slow, now = 1 / (moments[s] + slowest), 1 / (moments[s] + rate)
        for i in range(touched):
            for j in range(others):
                both = exact[i] * exact[touched + j]
                found[i, j] = slow * both + early[s] * (kernel[0, i, j] + both)
        for t in range(times):
            for i in range(touched * others):
                summed[i] += to_grasp[s, t] * flat[t, i]
        for i in range(touched):
            for j in range(others):
                whole[i, j] = 0.0
            for m in range(touched):
                for j in range(others):
                    whole[i, j] += opened[s, i, m] * found[m, j]
            for j in range(others):
                left = whole[i, j] - now * port[i] * port[touched + j]
                for k in range(len(share)):
                    residues[i, touched + j, k] += left * fit[s, k]
        for j in range(len(total)):
            gained = (slow * exact[touched + j] - now * port[touched + j]) * held
            for t in range(times):
                gained += to_grasp[s, t] * heat[t, j]
            for i in range(touched):
                gained += returned[s, i] * whole[i, j]
            for k in range(len(share)):
                rows[touched + j, k] += gained * seen[s, k]
    for j in range(len(total)):
        _balanced(rows[touched + j], total[j] - held * port[touched + j], share)


class _Fit(NamedTuple):
    """Of a level. fades: (S, K) s. The least squares' answer to a heat's samples is seen (S, K) times these and share
    (K,) times its total; samples at s are weighed by s, as a share of what has gone in."""

    fades: np.ndarray
    seen: np.ndarray
    share: np.ndarray


@lru_cache(maxsize=8)
def _fit(level: Resolution) -> _Fit:
    columns = fades(level.decay)
    weighed, rates = GRASP[:, None] * columns, level.rates
    normal = np.ones((rates + 1, rates + 1))
    normal[:-1, :-1] = weighed.T @ weighed + _HEAT_RIDGE * np.eye(rates)
    normal[-1, -1] = 0.0
    inverse = np.linalg.inv(normal)
    seen = (inverse[:-1, :-1] @ (weighed * GRASP[:, None]).T).T
    return _Fit(columns, np.ascontiguousarray(seen), inverse[:-1, -1].copy())


@njit(cache=True, inner=True, borrows=True, error_model="numpy")
def _balanced(row, total, share):
    """Gives a row (K,) of heat its share of the total."""
    for _ in range(2):  # the second time it is what rounding has left of the total
        left = total
        if _ == 1:
            for k in range(len(share)):
                left -= row[k]
        for k in range(len(share)):
            row[k] += left * share[k]


@njit(cache=True, inner=True, borrows=True, error_model="numpy")
def _warmed(found, heat, even, port, held, capacity, seen, share, rows, still):
    """Adds to rows (A M, K) of the heat (S, A M) that follows each port's flow: with the slowest state's, of port
    (A M,) and held, they add up to what goes in, even (A, M). And to still (K,) J/K of what follows the air: with the
    slowest state's they add up to the box's capacity; a rate's share is what the touched ports tell, its heat row
    squared over its resistance, as in a state. found: (A M, A M, K). seen, share: as in _Fit."""
    rates, count, patterns = len(share), len(found), even.shape[1]
    for j in range(count):
        for s in range(len(heat)):
            for k in range(rates):
                rows[j, k] += heat[s, j] * seen[s, k]
        _balanced(rows[j], even[j // patterns, j % patterns] - held * port[j], share)
    least, whole = 0.0, 0.0
    for i in range(count):
        for k in range(rates):
            least = max(least, _SEEN_LEAST * found[i, i, k])
    for i in range(count):
        for k in range(rates):
            still[k] += rows[i, k] * rows[i, k] / (found[i, i, k] + least)
    for k in range(rates):
        whole += still[k]
    scale = max(capacity - held * held, 0.0) / whole if whole > 0.0 else 0.0
    for k in range(rates):
        still[k] *= scale
