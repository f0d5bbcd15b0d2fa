"""A homogeneous box seen through patches anywhere on its six faces: its impedance between the patches' patterns.

The box starts uniform; its faces are adiabatic or lose heat through one film to air at that temperature. Its heat
kernel is a product of three one-dimensional ones (axis.py), taken at TIMES and transformed to MOMENTS (samples.py). The
slowest eigenfunction, an adiabatic box's uniform temperature, is a state of its own and left out of the samples.

N: patches, P: patterns of each (patterns.py), T: times, S: moments.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from thermograsp.compiled import njit

from .axis import MODES, SWITCH, images, overlaps, wave_numbers
from .patterns import ALONG, GRAM, JUMPS, NODES
from .samples import MOMENTS, TIMES, TO_MOMENTS, TO_SLOPES, before


class Patches(NamedTuple):
    """face: (N,) 2 axis + side, side 0 at the coordinate's 0 and 1 at the far end. centre, half: (N, 2) m along the
    other two axes in their order, from the box's corner: middle and half width of each rectangle."""

    face: np.ndarray
    centre: np.ndarray
    half: np.ndarray

    @property
    def areas(self) -> np.ndarray:
        """(N,) m2."""
        return 4 * self.half[:, 0] * self.half[:, 1]


class BoxSamples(NamedTuple):
    """impedance: (S, N P, N P) K/W between patterns of unit heat flow, less the slowest eigenfunction's part, and slope
    of it by the moment. rate: 1/s of that and port: (N P,) sqrt(K/J) of it at each pattern; held: sqrt(J K) of heat in
    it. heat: (S, N P) J/W of heat in the box, likewise without it; None where no film takes any (held holds it all)."""

    impedance: np.ndarray
    slope: np.ndarray
    rate: float
    port: np.ndarray
    held: float
    heat: np.ndarray | None

    def whole(self) -> np.ndarray:
        """(S, N P, N P) K/W with the slowest."""
        return self.impedance + np.outer(self.port, self.port) / (MOMENTS[:, None, None] + self.rate)


def box_samples(
    size: tuple[float, float, float], conductivity: float, heat_capacity: float, film: float, patches: Patches
) -> BoxSamples:
    """size: m. conductivity: W/(m K). heat_capacity: J/(m3 K). film: W/(m2 K), 0 for adiabatic faces.

    The film covers the patches too: what lies under a fingertip loses no heat to the air, see `shielded`."""
    diffusivity = conductivity / heat_capacity
    kernel, rate, port, whole, held = _kernel(
        np.asarray(size, float),
        film / conductivity,
        diffusivity * TIMES,
        np.asarray(patches.face),
        patches.centre,
        patches.half,
        NODES,
        JUMPS,
        ALONG,
    )
    scale = 1 / np.repeat(patches.areas, len(GRAM))
    kernel *= np.outer(scale, scale) / heat_capacity
    port *= scale / np.sqrt(heat_capacity)
    rate *= diffusivity
    kernel -= np.outer(port, port) * np.exp(-rate * TIMES)[:, None, None]
    impedance = np.tensordot(TO_MOMENTS, kernel, axes=1)
    slope = np.tensordot(TO_SLOPES, kernel, axes=1)
    early = before(diffusivity) / heat_capacity
    for n, area in enumerate(patches.areas):
        own = slice(n * len(GRAM), (n + 1) * len(GRAM))
        impedance[:, own, own] += early / area * GRAM
    held = float(held * np.sqrt(heat_capacity))
    if film == 0:
        return BoxSamples(impedance, slope, 0.0, port, held, None)
    whole *= scale
    whole -= np.exp(-rate * TIMES)[:, None] * port * held
    return BoxSamples(impedance, slope, float(rate), port, held, TO_MOMENTS @ whole)


@njit(cache=True, error_model="numpy")
def _kernel(size, film, taus, face, centre, half, nodes, jumps, along):
    """Kernel (T, N P, N P) 1/m3 integrated over both patches' patterns; the slowest eigenfunction's squared wave number
    1/m2 and its integrals over the patterns; the kernel (T, N P) integrated over the box and a pattern; the slowest
    eigenfunction's integral over the box."""
    count, functions, patterns = len(face), len(jumps), len(along)
    total = count * patterns
    kernel = np.ones((len(taus), total, total))
    slowest, port = 0.0, np.ones(total)
    places = np.empty((count, len(nodes)))
    whole, held = np.ones((len(taus), total)), 1.0
    ends, step, inside = np.empty(2), np.array([[-1.0, 1.0]]), np.empty((1, MODES))
    point = np.ones((1, 1))
    told = np.zeros((count, functions, MODES))
    room = np.empty(len(nodes))
    table = np.empty((len(nodes), len(nodes)))
    half_done = np.empty((functions, len(nodes)))
    everywhere = np.empty(functions)
    between = np.empty((count, functions, count, functions))
    for axis in range(3):
        length = size[axis]
        waves = wave_numbers(length, film)
        slowest += waves[0] ** 2
        ends[0], ends[1] = 0.0, length
        overlaps(ends, step, 1, length, waves, room, inside)
        held *= inside[0, 0]
        orders = np.ones(count, np.int64)
        which = np.zeros(count, np.int64)
        for n in range(count):
            facing = face[n] // 2
            if facing == axis:
                orders[n] = 0
                places[n, 0] = length * (face[n] % 2)
                overlaps(places[n, :1], point, 0, length, waves, room, told[n])
            else:
                which[n] = axis if axis < facing else axis - 1
                for k in range(len(nodes)):
                    places[n, k] = centre[n, which[n]] + half[n, which[n]] * nodes[k]
                overlaps(places[n], jumps, 1, length, waves, room, told[n])
        for n in range(count):
            for i in range(patterns):
                f = along[i, which[n]] if orders[n] == 1 else 0
                port[n * patterns + i] *= told[n, f, 0]
        for t in range(len(taus)):
            tau = taus[t]
            late = tau > SWITCH * length * length
            for n in range(count):
                mine = functions if orders[n] == 1 else 1
                for m in range(n + 1):
                    others = functions if orders[m] == 1 else 1
                    if late:
                        for f in range(mine):
                            for g in range(others):
                                between[n, f, m, g] = 0.0
                        for w in range(MODES):
                            decay = np.exp(-waves[w] * waves[w] * tau)
                            if decay < 1e-17:
                                break
                            for f in range(mine):
                                for g in range(others):
                                    between[n, f, m, g] += decay * told[n, f, w] * told[m, g, w]
                        continue
                    a = places[n] if orders[n] == 1 else places[n, :1]
                    b = places[m] if orders[m] == 1 else places[m, :1]
                    images(a, orders[n], b, orders[m], n == m, length, film, tau, table)
                    for f in range(mine):
                        for q in range(len(b)):
                            value = 0.0
                            for k in range(len(a)):
                                value += (jumps[f, k] if orders[n] == 1 else 1.0) * table[k, q]
                            half_done[f, q] = value
                    for f in range(mine):
                        for g in range(others):
                            value = 0.0
                            for q in range(len(b)):
                                value += (jumps[g, q] if orders[m] == 1 else 1.0) * half_done[f, q]
                            between[n, f, m, g] = value
            if film > 0.0:
                for n in range(count):
                    mine = functions if orders[n] == 1 else 1
                    a = places[n] if orders[n] == 1 else places[n, :1]
                    if not late:
                        images(a, orders[n], ends, 1, False, length, film, tau, table)
                    for f in range(mine):
                        value = 0.0
                        if late:
                            for w in range(MODES):
                                value += np.exp(-waves[w] * waves[w] * tau) * told[n, f, w] * inside[0, w]
                        else:
                            for k in range(len(a)):
                                factor = jumps[f, k] if orders[n] == 1 else 1.0
                                value += factor * (table[k, 1] - table[k, 0])
                        everywhere[f] = value
                    for i in range(patterns):
                        whole[t, n * patterns + i] *= everywhere[along[i, which[n]] if orders[n] == 1 else 0]
            for n in range(count):
                for m in range(n + 1):
                    for i in range(patterns):
                        f = along[i, which[n]] if orders[n] == 1 else 0
                        for j in range(patterns):
                            g = along[j, which[m]] if orders[m] == 1 else 0
                            kernel[t, n * patterns + i, m * patterns + j] *= between[n, f, m, g]
    for t in range(len(taus)):
        for i in range(total):
            for j in range(i):
                kernel[t, j, i] = kernel[t, i, j]
    return kernel, slowest, port, whole, held
