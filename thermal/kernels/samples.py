"""Moments at which heat kernels are known and transfer functions are told.

A kernel g(t) is taken at TIMES, equally spaced in ln t, where the trapezoidal rule for its Laplace transform converges
exponentially; what comes before the first is a geometric sum, since every strip is a half-space of its own then.
"""

from __future__ import annotations

import math
from functools import lru_cache
from typing import NamedTuple

import numpy as np

from thermograsp.compiled import njit

_SPACING = 0.7  # relative error exp(-pi^2 / spacing), 8e-7

TIMES = 3e-6 * np.exp(_SPACING * np.arange(33))
"""(T,) s, to four hours."""
MOMENTS = np.geomspace(1 / 600, 180, 22)
"""(S,) 1/s: real Laplace variables, from a fraction of a control step to ten minutes."""
OF_GRASP = slice(4, 20)
GRASP = MOMENTS[OF_GRASP]
"""From a control step to the minute that a grasp lasts, where networks of fixed rates are fitted."""
TO_MOMENTS = _SPACING * TIMES * np.exp(-MOMENTS[:, None] * TIMES)
"""(S, T): the transform at MOMENTS of a kernel at TIMES, less what comes before the first."""
TO_SLOPES = -TIMES * TO_MOMENTS
"""(S, T): its derivative by the Laplace variable; what comes before the first has none to speak of."""


SHOWN = slice(6, 20, 3)
"""Of MOMENTS, at which it is told what flows a contact excites."""

FEW_SPACING = 1.0  # of times in ln t: the transforms are known to exp(-pi^2 / spacing), 5e-5
_ELEMENT_SPACING, ROUGH_SPACING = 0.85, 1.4  # the same to 9e-6 and 9e-4
_UNFELT = (
    2.5e-10  # m2, diffusivity times time up to which every strip of a contact is a half-space of its own
)
_WIDE = 0.0045  # m, half width of a contact of which that is so; of others the strips are narrower
_FIRST, _LAST = (
    3e-6,
    40.0,
)  # s; and its product with the slowest moment, after which kernels count for nothing
_POWERS = 16  # of moment times first time, which is below 1
_MOST = 64  # times


MOST_ROUGH = math.ceil(math.log(_LAST / MOMENTS[SHOWN][0] / _FIRST) / ROUGH_SPACING) + 1
"""Times of rough_rule, of the best conductor."""


class Rule(NamedTuple):
    """Times (T,) s, equally spaced in ln t, at which a kernel is needed, from begun m2 over the diffusivity on; (S, T)
    its transform at some moments by the trapezoidal rule, as if it had its first value before; (S,) s of what it has
    more then if it falls as 1 / sqrt(t)."""

    begun: float
    times: np.ndarray
    to_moments: np.ndarray
    early: np.ndarray


@lru_cache(maxsize=512)
def grasp_rule(diffusivity: float) -> Rule:
    """Of kernels of m2/s, at GRASP."""
    return _rule(diffusivity, GRASP, FEW_SPACING, max(_FIRST * diffusivity, _UNFELT))


def grasp_steps() -> tuple[np.ndarray, np.ndarray]:
    """What compiled_grasp_rule takes."""
    return _steps(FEW_SPACING)


@njit(cache=True, inner=True, error_model="numpy")
def compiled_grasp_rule(diffusivity, moments, steps, sooner):
    """grasp_rule, for compiled callers. moments: GRASP. steps, sooner: grasp_steps."""
    begun = max(_FIRST * diffusivity, _UNFELT)
    first = begun / diffusivity
    count = math.ceil(math.log(_LAST / moments[0] / first) / FEW_SPACING) + 1
    times, to_moments, early = np.empty(count), np.empty((len(moments), count)), np.empty(len(moments))
    _fill_rule(moments, FEW_SPACING, first, steps, sooner, times, to_moments, early)
    return begun, times, to_moments, early


def times_sooner(half: float) -> int:
    """How many times more, sooner ones, a patch of half width m along its shorter side has to be told at."""
    return max(math.ceil(2 * math.log(_WIDE / half) / _ELEMENT_SPACING), 0)


USUALLY_SOONER = 7
"""Of most patches at most: sides of a sensor's face are told at one set of times for all of these."""


@lru_cache(maxsize=512)
def element_rule(diffusivity: float, sooner: int, shown: bool) -> Rule:
    """The same of an element, closer, since all that it touches is told beside it, and so many times more; at SHOWN
    the last ones of those at GRASP are left out."""
    moments = MOMENTS[SHOWN] if shown else GRASP
    return _rule(diffusivity, moments, _ELEMENT_SPACING, _UNFELT * math.exp(-_ELEMENT_SPACING * sooner))


@lru_cache(maxsize=512)
def rough_rule(diffusivity: float) -> Rule:
    """The same at SHOWN, of what only decides on patterns of flow, at fewer times."""
    return _rule(diffusivity, MOMENTS[SHOWN], ROUGH_SPACING, max(_FIRST * diffusivity, _UNFELT))


def _rule(diffusivity: float, moments: np.ndarray, spacing: float, begun: float) -> Rule:
    first = begun / diffusivity
    count = math.ceil(math.log(_LAST / float(moments[0]) / first) / spacing) + 1
    table, early = np.empty((1 + len(moments), count)), np.empty(len(moments))
    times, to_moments = table[0], table[1:]
    _fill_rule(moments, spacing, first, *_steps(spacing), times, to_moments, early)
    return Rule(begun, times, to_moments, early)


@njit(cache=True, error_model="numpy")
def _fill_rule(moments, spacing, first, steps, sooner, times, to_moments, early):
    """Fills a Rule's times, to_moments and early, from time first s on. steps, sooner: _steps of that spacing."""
    for t in range(len(times)):
        times[t] = first * steps[t]
    for s in range(len(moments)):
        for t in range(len(times)):
            to_moments[s, t] = spacing * times[t] * math.exp(-moments[s] * times[t])
        # each power of moment times first time, of what comes before
        power, flat, falling = first, 0.0, 0.0
        for n in range(len(sooner)):
            flat += power * sooner[n, 0]
            falling += power * sooner[n, 1]
            power *= moments[s] * first
        to_moments[s, 0] += flat
        early[s] = falling


@lru_cache(maxsize=8)
def _steps(spacing: float) -> tuple[np.ndarray, np.ndarray]:
    """Times over the first; and (n, 2) coefficients, by powers of moment times first time, of the trapezoidal sums
    before the first over it: of 1, and of what 1 / sqrt(t) is more than at the first."""
    n = np.arange(_POWERS)
    series = spacing * np.array([(-1) ** k / math.factorial(k) for k in n.tolist()])
    flat, falling = (1 / np.expm1(spacing * (n + power)) for power in (1.0, 0.5))
    return np.exp(spacing * np.arange(_MOST)), np.stack((series * flat, series * (falling - flat)), axis=1)


def before(diffusivity: float) -> float:
    """Integral to the first time of 1 / sqrt(pi diffusivity t), as the rule has it. diffusivity: m2/s."""
    return float(_SPACING * np.sqrt(TIMES[0] / (np.pi * diffusivity)) / np.expm1(_SPACING / 2))


@njit(cache=True, error_model="numpy")
def at_moments(kernel, heat, port, alone, gram, to_moments, early):
    """Impedance (S, A M, A M) K/W of a kernel (T, A M, A M) K/J that falls as 1 / sqrt(t) before the first time: of a
    patch by itself as alone (A,) K/J says, of one that it overlaps all of it; and (S, A M) J/W of heat (T, A M) J/J.
    port (A M,): of the slowest eigenfunction, left out of the kernel. gram: (M, M), means of patterns' products.
    to_moments, early: a Rule's."""
    count, rows, ports = kernel.shape
    patterns = rows // len(alone)
    found, warmed = np.zeros((len(early), rows, ports)), np.zeros((len(early), ports))
    flat, summed = kernel.reshape(count, rows * ports), found.reshape(len(early), rows * ports)
    for s in range(len(early)):
        for t in range(count):
            for i in range(rows * ports):  # one long loop, of which vectors are made
                summed[s, i] += to_moments[s, t] * flat[t, i]
            for j in range(ports):
                warmed[s, j] += to_moments[s, t] * heat[t, j]
        for i in range(rows):
            for j in range(ports):
                falling = kernel[0, i, j] + port[i] * port[j]
                if i // patterns == j // patterns:
                    falling = alone[i // patterns] * gram[i % patterns, j % patterns]
                found[s, i, j] += early[s] * falling
    return found, warmed


for _table in (TIMES, MOMENTS, TO_MOMENTS, TO_SLOPES):
    _table.setflags(write=False)
