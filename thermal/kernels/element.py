"""The sensor's element seen through a patch anywhere on its face: a box of layers, held at its back.

Under the whole face or a part of it: the first layer as a half-space, a product of kernels as in box.py, and what its
depth and the further layers change, a sum over the lateral eigenfunctions that reach them. These are few, unless the
first layer is thin; then that change, smooth in the logarithm of the wave number, is known at nodes of it, and no
thickness takes long. What is even over the cross-section is one-dimensional: its slowest poles are found once per stack
and kept exactly, since the temperature drop, a mean over the face, follows from them alone.

P: patterns (patterns.py), S: moments (samples.py), L: nodes among an axis' lateral eigenfunctions, K: poles.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import lru_cache
from typing import Any, NamedTuple

import numpy as np
from threadpoolctl import threadpool_limits

from thermograsp.compiled import njit

from ..matter import SensorStack
from ..numerics import Sampled, dot
from ..plates import from_nodes, log_nodes, stack_impedance, stack_profile
from .alone import alone
from .axis import MODES, SWITCH, add_images, add_projected, ends_reached, images, overlaps
from .patterns import ALONG, EACH_FUNCTION, GRAM, JUMPS, NODES
from .samples import (
    GRASP,
    MOMENTS,
    OF_GRASP,
    SHOWN,
    TIMES,
    TO_MOMENTS,
    TO_SLOPES,
    USUALLY_SOONER,
    before,
    element_rule,
    times_sooner,
)

Rectangle = tuple[tuple[float, float], tuple[float, float]]
"""(low, high) in m along a face's two axes."""

POLES = 5
_DEPTHS = 6.0  # wave number times the first layer's thickness beyond which nothing below it is seen, exp(-12)
_EACH = 40  # eigenfunctions of an axis that are nodes, one by one
_SPACING = 0.15  # of the nodes beyond, in ln of the wave number: cubic interpolation leaves 1e-5
_REACH = 25.0  # wave number times a contact's finest strip beyond which no eigenfunction is summed
_LEFT_OUT = 1e-9  # of the largest, singular values of the correction that tell nothing
_SCAN = 4000  # places where the characteristic function is looked at for its first roots
_FADED = 1e-12  # of an eigenfunction, from which on it counts for nothing
_FINEST = float(np.diff(NODES).min())


@dataclass(frozen=True, slots=True, eq=False)
class Element:
    """A stack whose back is held at its first temperature, per heat that flows into its face.

    rates: (K,) 1/s and ports: (K,) sqrt(K/J) of its slowest even poles; their outputs drop: (K,) K/sqrt(J) and heat:
    (K,) sqrt(J K). drop_rest: (S,) K/W and heat_rest: (S,) J/W of the even part's transform at MOMENTS beyond them.
    nodes: (L,) lateral eigenfunctions of an axis, by half waves over the width. correction: (2, S, L, L) m2 K/W to add
    to the first layer's half-space there, and its derivative by the moment; less its small singular values it is
    (S, R, R) between few sums (L, R) of the eigenfunctions, `few` and `sums`. slow: K/W of
    the slowest even poles at GRASP."""

    stack: SensorStack
    rates: np.ndarray
    ports: np.ndarray
    drop: np.ndarray
    heat: np.ndarray
    drop_rest: np.ndarray
    heat_rest: np.ndarray
    nodes: np.ndarray
    correction: np.ndarray
    sums: np.ndarray
    few: np.ndarray
    slow: np.ndarray


@lru_cache(maxsize=64)
def element(stack: SensorStack) -> Element:
    """What a contact needs of a stack; some milliseconds, once."""
    layers = stack.layers[::-1]
    near, area = layers[0], stack.face_area
    rates = _even_rates(stack)
    temperature, drop, flow, slope = _characteristic(stack, rates)
    squared = temperature / slope / area  # residues, K/J
    ports = np.sqrt(squared)
    drop = drop / slope / area
    # stored heat: what flows in less what leaves at the back, over s
    heat = -flow / slope / rates
    s = MOMENTS[:, None]
    temperatures, flows = stack_profile(layers, "isothermal", s, np.zeros(1))
    sensed = len(layers) - 1 - stack.sensed
    even_drop = (temperatures[sensed + 1] - temperatures[sensed])[:, 0] / area
    even_heat = (flows[0] - flows[-1])[:, 0] / MOMENTS
    weights = 1 / (s + rates)
    count = int(_DEPTHS / near.thickness * stack.width / np.pi) + 1
    nodes = np.arange(min(count, _EACH), dtype=float)
    if count > _EACH:
        nodes = np.concatenate((nodes, log_nodes(_EACH, max(count, _EACH + 4), _SPACING)))
    wave = nodes * np.pi / stack.width
    kappa2 = (wave[:, None] ** 2 + wave**2).ravel()
    tiny = 1e-30
    turned = s * (1 + 1j * tiny)
    half_space = 1 / (near.conductivity * np.sqrt(turned / near.diffusivity + kappa2))
    correction = stack_impedance(layers, "isothermal", turned, kappa2) - half_space
    correction = np.stack((correction.real, correction.imag / (s * tiny)))
    correction = correction.reshape(2, len(MOMENTS), len(nodes), len(nodes))
    with threadpool_limits(1, "blas"):  # or the number of threads would decide last bits
        left, values, _ = np.linalg.svd(
            correction[0].transpose(1, 0, 2).reshape(len(nodes), -1), full_matrices=False
        )
        sums = np.ascontiguousarray(left[:, values > _LEFT_OUT * values[0]])
        few = np.ascontiguousarray(sums.T @ correction[0] @ sums)
    return Element(
        stack,
        rates,
        ports,
        drop / ports,
        heat / ports,
        even_drop - weights @ drop,
        even_heat - weights @ heat,
        nodes,
        correction,
        sums,
        few,
        (1 / (GRASP[:, None] + rates)) @ ports**2,
    )


class SeenSide(NamedTuple):
    """A rectangle of the face along one axis, as the functions along it see it. within: (F, F, T) m of the first
    layer's half-space at element_rule's times, and below: (F, F, R) m of the
    lateral eigenfunctions' sums."""

    within: np.ndarray
    below: np.ndarray


@lru_cache(maxsize=2048)
def seen_side(known: Element, low: float, high: float, sooner: int) -> SeenSide:
    """low, high: m from the face's edge. sooner: element_rule's."""
    width, half = known.stack.width, (high - low) / 2
    count = min(int(known.nodes[-1]) + 1, int(_REACH / (half * _FINEST) * width / math.pi) + 1)
    return SeenSide(*along_face(width, (low + high) / 2, half, _taus(known, sooner), _sums(known, count)))


@lru_cache(maxsize=64)
def _taus(known: Element, sooner: int) -> np.ndarray:
    diffusivity = known.stack.layers[-1].diffusivity
    return diffusivity * element_rule(diffusivity, sooner, shown=False).times


def along_face(
    length: float, centre: float, half: float, taus: np.ndarray, sums: np.ndarray
) -> tuple[np.ndarray, np.ndarray]:
    """(F, F, T) m of the kernel along an axis with adiabatic ends between the functions of a patch there, at taus (T,)
    m2, and (F, F, R) m of sums (W, R) of as many of its eigenfunctions. length, centre, half: m."""
    early, functions = int(taus.searchsorted(SWITCH * length * length, "right")), len(JUMPS)
    within = np.zeros((functions, functions, len(taus)))
    within[..., :early] = alone(np.array([half]), EACH_FUNCTION[:1], taus[:early])[0]
    below = np.zeros((functions, functions, sums.shape[1]))
    _within(length, taus, early, centre, half, NODES, JUMPS, sums, within, below)
    return within, below


def face_impedance(
    known: Element,
    covered: Rectangle,
    shares: np.ndarray,
    terms: np.ndarray,
    gram: np.ndarray,
    shown: bool,
) -> np.ndarray:
    """(S, M, M) K/W between combinations of the patterns on a rectangle of the face, m from its corner: functions of
    shares (2, F', F) along the axes, whose products add up as terms (M, X, 2) say, as in along_axes. gram: (M, M),
    their products' means. At SHOWN, or at GRASP."""
    return _impedance(shares, terms, gram, *seen_face(known, covered, shown))


def seen_face(known: Element, covered: Rectangle, shown: bool) -> tuple[Any, ...]:
    """What face_impedance takes of the rectangle."""
    layer, ((x0, x1), (y0, y1)) = known.stack.layers[-1], covered
    x, y = x1 - x0, y1 - y0
    sooner, diffusivity = times_sooner(min(x, y) / 2), layer.diffusivity
    of_sides = max(sooner, USUALLY_SOONER)
    return (
        x * y,
        *seen_side(known, x0, x1, of_sides),
        *seen_side(known, y0, y1, of_sides),
        of_sides - sooner,
        _few(known, shown),
        *element_rule(diffusivity, sooner, shown),
        layer.conductivity,
        diffusivity,
    )


@lru_cache(maxsize=64)
def _few(known: Element, shown: bool) -> np.ndarray:
    return known.few[SHOWN if shown else OF_GRASP].copy()


def _sums(known: Element, count: int) -> np.ndarray:
    """(count, R) of the first eigenfunctions, those beyond the first nodes by interpolation."""
    if count <= _EACH:
        return known.sums[:count]
    beyond = from_nodes(known.nodes[_EACH:], np.arange(_EACH, count)) @ known.sums[_EACH:]
    return np.concatenate((known.sums[:_EACH], beyond))


@lru_cache(maxsize=1024)
def element_samples(stack: SensorStack, covered: Rectangle) -> Sampled:
    """(S, P, P) K/W between patterns of unit heat flow into a rectangle of the face, m from the face's corner."""
    known, layer = element(stack), stack.layers[-1]
    ends = np.array(covered)
    centre, half = ends.mean(axis=1), (ends[:, 1] - ends[:, 0]) / 2
    capacity = layer.volumetric_heat_capacity
    diffusivity = layer.conductivity / capacity
    area = 4 * half[0] * half[1]
    finest = float(half.min() * np.diff(NODES).min())
    count = min(int(known.nodes[-1]) + 1, int(_REACH / finest * stack.width / np.pi) + 1)
    kernel, overlap = _lateral(stack.width, diffusivity * TIMES, centre, half, NODES, JUMPS, ALONG, count)
    # products of two functions along each axis, then of the two axes, for the pairs of patterns that there are
    pairs = (overlap[:, :, None] * overlap[:, None]).reshape(2, -1, count)
    if len(known.nodes) > _EACH:
        between = from_nodes(known.nodes[_EACH:], np.arange(_EACH, count))
        pairs = np.stack([np.hstack((axis[:, :_EACH], axis[:, _EACH:] @ between)) for axis in pairs])
    lateral = pairs[0] @ known.correction @ pairs[1].T
    first, second = (along[:, None] * len(JUMPS) + along for along in ALONG.T)
    lateral = lateral[..., first, second] / area**2
    value = np.tensordot(TO_MOMENTS, kernel, axes=1) / (capacity * area**2)
    value += before(diffusivity) / (capacity * area) * GRAM + lateral[0]
    slope = np.tensordot(TO_SLOPES, kernel, axes=1) / (capacity * area**2) + lateral[1]
    value.setflags(write=False)
    slope.setflags(write=False)
    return Sampled(value, slope)


def _characteristic(
    stack: SensorStack, rates: np.ndarray
) -> tuple[np.ndarray, np.ndarray, np.ndarray, np.ndarray]:
    """At s = -rates (K,), per unit heat flux out of the back's face: temperature of the front, drop (thermostat side
    less object side), the flux itself, and the slope by s of the flux into the front, whose roots are the poles."""
    tiny = 1e-30
    s = -rates * (1 + 1j * tiny)
    temperature, flux = np.zeros_like(s), np.ones_like(s)
    at = [temperature]
    for layer in stack.layers:
        k = layer.conductivity
        g = np.sqrt(s * layer.volumetric_heat_capacity / k)
        turn = g * layer.thickness
        temperature, flux = (
            temperature * np.cosh(turn) + flux * np.sinh(turn) / (k * g),
            temperature * k * g * np.sinh(turn) + flux * np.cosh(turn),
        )
        at.append(temperature)
    drop = (at[stack.sensed] - at[stack.sensed + 1]).real
    return at[-1].real, drop, -np.ones(len(rates)), flux.imag / (-rates * tiny)


def _front_flux(stack: SensorStack, roots: np.ndarray) -> np.ndarray:
    """Flux into the front at s = -roots^2 per unit flux out of the back."""
    temperature, flux = np.zeros_like(roots), np.ones_like(roots)
    for layer in stack.layers:
        k = layer.conductivity
        g = roots * np.sqrt(layer.volumetric_heat_capacity / k)
        turn = g * layer.thickness
        temperature, flux = (
            temperature * np.cos(turn) + flux * np.sin(turn) / (k * g),
            -temperature * k * g * np.sin(turn) + flux * np.cos(turn),
        )
    return flux


def _even_rates(stack: SensorStack) -> np.ndarray:
    """(POLES,) 1/s, the slowest of the stack with an adiabatic front."""
    delay = sum(
        layer.thickness * np.sqrt(layer.volumetric_heat_capacity / layer.conductivity)
        for layer in stack.layers
    )
    roots = np.linspace(0.0, (POLES + 2) * 2 * np.pi / delay, _SCAN)[1:]
    flux = _front_flux(stack, roots)
    first = np.flatnonzero(flux[1:] * flux[:-1] < 0)[:POLES]
    low, high, sign = roots[first], roots[first + 1], np.sign(flux[first])
    for _ in range(60):
        middle = (low + high) / 2
        before_it = np.sign(_front_flux(stack, middle)) == sign
        low, high = np.where(before_it, middle, low), np.where(before_it, high, middle)
    return ((low + high) / 2) ** 2


def _lateral(
    width: float,
    taus: np.ndarray,
    centre: np.ndarray,
    half: np.ndarray,
    nodes: np.ndarray,
    jumps: np.ndarray,
    along: np.ndarray,
    count: int,
) -> tuple[np.ndarray, np.ndarray]:
    """(T, P, P) m of the first layer's half-space and (2, F, count) of the functions on eigenfunctions. taus: (T,) m2,
    ascending."""
    early = int(np.count_nonzero(taus <= SWITCH * width * width))
    tables, late, overlap = _along_sides(width, taus, early, centre, half, nodes, jumps, count)
    between = np.concatenate((jumps @ tables @ jumps.T, late), axis=1)
    depth = 1 / np.sqrt(np.pi * taus)
    first, second = (axis[:, along[:, None, a], along[:, a]] for a, axis in enumerate(between))
    return depth[:, None, None] * first * second, overlap


@njit(cache=True, error_model="numpy")
def _along_sides(width, taus, early, centre, half, nodes, jumps, count):
    """By axis: at the first `early` times the images between nodes (2, early, E, E), at the others the functions'
    products by eigenfunctions (2, T - early, F, F); and (2, F, count) of the functions on these."""
    functions = len(jumps)
    overlap = np.empty((2, functions, count))
    tables = np.empty((2, early, len(nodes), len(nodes)))
    late = np.zeros((2, len(taus) - early, functions, functions))
    places, seen = np.empty(len(nodes)), np.empty(len(nodes))
    for axis in range(2):
        for k in range(len(nodes)):
            places[k] = centre[axis] + half[axis] * nodes[k]
        for w in range(count):
            wave, norm = w * math.pi / width, math.sqrt(width if w == 0 else width / 2)
            for k in range(len(nodes)):
                seen[k] = places[k] if w == 0 else math.sin(wave * places[k]) / wave
            for f in range(functions):
                total = 0.0
                for k in range(len(nodes)):
                    total += jumps[f, k] * seen[k]
                overlap[axis, f, w] = total / norm
        for t in range(early):
            images(places, 1, places, 1, True, width, 0.0, taus[t], tables[axis, t])
        for t in range(early, len(taus)):
            for w in range(min(count, MODES)):
                wave = w * math.pi / width
                decay = math.exp(-wave * wave * taus[t])
                for f in range(functions):
                    for g in range(functions):
                        late[axis, t - early, f, g] += decay * overlap[axis, f, w] * overlap[axis, g, w]
    return tables, late, overlap


@njit(cache=True, error_model="numpy")
def _within(width, taus, early, centre, half, nodes, jumps, sums, within, below):
    """Adds to within (F, F, T) what comes by way of the face's ends at the first `early` taus (T,) m2, and fills it at
    the others by eigenfunctions; fills below (F, F, R) with these eigenfunctions' sums (count, R)."""
    functions, ends = len(jumps), len(nodes)
    table, places, done = np.empty((ends, ends)), np.empty(ends), np.empty(ends)
    waves, seen = np.empty(len(sums)), np.empty(len(sums))
    overlap, decay = np.empty((functions, len(sums))), np.empty(len(taus))
    for k in range(ends):
        places[k] = centre + half * nodes[k]
    for w in range(len(sums)):
        waves[w] = w * math.pi / width
    overlaps(places, jumps, 1, width, waves, seen, overlap)
    for w in range(len(sums)):
        last = early
        while last < len(taus):
            decay[last] = math.exp(-waves[w] * waves[w] * taus[last])
            if decay[last] < _FADED:
                break
            last += 1
        for f in range(functions):
            for g in range(f + 1):
                both = overlap[f, w] * overlap[g, w]
                for t in range(early, last):
                    within[f, g, t] += both * decay[t]
                for r in range(sums.shape[1]):
                    below[f, g, r] += both * sums[w, r]
    for t in range(early):
        low_end, high_end = ends_reached(places, places, width, taus[t])
        if not low_end and not high_end:
            continue
        table[:] = 0.0
        add_images(places, 1, places, 1, True, width, 0.0, taus[t], table)
        add_projected(jumps, table, jumps, True, done, within, t)
    for f in range(functions):
        for g in range(f):
            for t in range(len(taus)):
                within[g, f, t] = within[f, g, t]
            for r in range(sums.shape[1]):
                below[g, f, r] = below[f, g, r]


@njit(cache=True, error_model="numpy")
def _impedance(*told):
    return compiled_impedance(*told)


@njit(cache=True, inner=True, error_model="numpy")
def compiled_impedance(
    shares,
    terms,
    gram,
    area,
    within,
    below,
    across_within,
    across_below,
    first,
    few,
    begun,
    times,
    to_moments,
    early,
    conductivity,
    diffusivity,
):
    """face_impedance of a rectangle of m2. within, below: of its SeenSide along the first axis; across_within,
    across_below: along the second. first: the number of the first of their times that is told. few: (S, R, R) of the
    element. conductivity, diffusivity: W/(m K) and m2/s of the
    first layer. The rest as in face_impedance and Rule."""
    moments, sums, kept = len(early), few.shape[1], len(terms)
    functions, known = shares.shape[1], shares.shape[2]
    along_axis = np.zeros((2, functions, functions, len(times)))
    lower = np.zeros((2, functions, functions, sums))
    for axis in range(2):
        inside, beneath = (within, below) if axis == 0 else (across_within, across_below)
        for f in range(functions):
            for g in range(f + 1):
                for i in range(known):
                    for j in range(known):
                        share = shares[axis, f, i] * shares[axis, g, j]
                        if share == 0.0:
                            continue
                        seen = inside[i, j, first:]
                        for t in range(len(times)):
                            along_axis[axis, f, g, t] += share * seen[t]
                        for r in range(sums):
                            lower[axis, f, g, r] += share * beneath[i, j, r]
                for t in range(len(times)):
                    along_axis[axis, g, f, t] = along_axis[axis, f, g, t]
                for r in range(sums):
                    lower[axis, g, f, r] = lower[axis, f, g, r]
    capacity = conductivity / diffusivity
    depth = np.empty(len(times))
    for t in range(len(times)):
        depth[t] = 1 / (math.sqrt(math.pi * diffusivity * times[t]) * capacity * area * area)
    # before the first time it is on a half-space
    falling = 1 / (math.sqrt(math.pi * begun) * capacity * area)
    crossed = np.empty((moments, functions, functions, sums))
    for s in range(moments):
        for f in range(functions):
            for g in range(f + 1):
                for r in range(sums):
                    crossed[s, f, g, r] = crossed[s, g, f, r] = dot(lower[0, f, g], few[s, r])
    found, kernel = np.zeros((moments, kept, kept)), np.empty(len(times))
    for i in range(kept):
        for j in range(i + 1):
            for t in range(len(times)):
                kernel[t] = 0.0
            for x in range(terms.shape[1]):
                for y in range(terms.shape[1]):
                    if terms[i, x, 0] < 0 or terms[j, y, 0] < 0:
                        continue
                    f, g, v, w = terms[i, x, 0], terms[j, y, 0], terms[i, x, 1], terms[j, y, 1]
                    for t in range(len(times)):
                        kernel[t] += along_axis[0, f, g, t] * along_axis[1, v, w, t]
                    for s in range(moments):
                        found[s, i, j] += dot(crossed[s, f, g], lower[1, v, w]) / (area * area)
            for t in range(len(times)):
                kernel[t] *= depth[t]
            for s in range(moments):
                found[s, i, j] += early[s] * falling * gram[i, j] + dot(to_moments[s], kernel)
                found[s, j, i] = found[s, i, j]
    return found
