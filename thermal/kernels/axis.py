"""Heat kernels of one axis of a box: [0, length] with adiabatic ends or a film of air on both.

A box's kernel is the product of three of them (Carslaw & Jaeger, Conduction of Heat in Solids, 2nd ed., sections 1.15,
3.3 and 14.2). Each is told between what patches are along that axis: functions over their width where it is tangential
(order 1: strips), one point where it is the axis that they face (order 0). A function f meets phi as
sum_k jumps_k PHI(nodes_k), PHI the antiderivative of phi of that order. Small times sum images, each with its film's
closed form; large times sum eigenfunctions. At the switch the two agree to 1e-13, as no path has met both ends before.

E: nodes, F: functions, M: eigenfunctions.
"""

from __future__ import annotations

import math

import numpy as np
from scipy.special import erfc, erfcx

from thermograsp.compiled import njit

MODES = 24
SWITCH = 0.0075  # diffusion length squared over length squared from which eigenfunctions serve
_ROOT_PI = math.sqrt(math.pi)
_REACH = 6.0  # diffusion lengths (2 sqrt tau) beyond which an image is below round-off
_FINE = 2048.0  # nodes a unit of the tables below: cubic Hermite interpolation leaves round-off


def _integral_of_erfc() -> np.ndarray:
    """(nodes, 2) of the integral of erfc from r on, and its slope times the spacing."""
    r = np.arange(int(_REACH * _FINE) + 2) / _FINE
    return np.stack((np.exp(-(r**2)) / _ROOT_PI - r * erfc(r), -erfc(r) / _FINE), axis=1)


_TABLE = _integral_of_erfc()
_FAR = 20.0  # from which on erfcx is told by its series
_FEW = 0.02  # what is added to its argument up to which differences of erfcx are told by theirs


def _scaled_erfc() -> np.ndarray:
    """(nodes, 2) of erfcx(x) at 4 / (4 + x) = 1 - node / _FINE, and its slope along the nodes."""
    place = 1 - np.arange(int((1 - 4 / (4 + _FAR)) * _FINE) + 2) / _FINE
    x = 4 / place - 4
    value = erfcx(x)
    return np.stack((value, (2 * x * value - 2 / _ROOT_PI) * 4 / place**2 / _FINE), axis=1)


_SCALED = _scaled_erfc()


@njit(cache=True, error_model="numpy")
def wave_numbers(length, film):
    """(M,) 1/m of the eigenfunctions cos(wave (x - length / 2) - m pi / 2). film: 1/m, its W/(m2 K) over the
    conductivity."""
    biot = film * length / 2
    waves = np.empty(MODES)
    for m in range(MODES):
        base = m * math.pi / 2
        # (base + d) tan d = biot by Newton's method; for m = 0 from the root of biot, which is near
        d = math.atan(math.sqrt(biot)) if m == 0 else math.atan(biot / base)
        if biot > 0.0:
            for _ in range(20):
                angle = base + d
                ratio = biot / angle
                change = (d - math.atan(ratio)) / (1 + ratio / angle / (1 + ratio * ratio))
                d -= change
                if abs(change) < 1e-15 * d:
                    break
        waves[m] = 2 * (base + d) / length
    return waves


@njit(cache=True, error_model="numpy")
def overlaps(nodes, jumps, order, length, waves, cosines, out):
    """Fills out (F, M) with the functions' products with normalised eigenfunctions. cosines: room (E,)."""
    for m in range(len(waves)):
        wave, phase = waves[m], m * math.pi / 2
        full = wave * length
        norm = length / 2
        if full > 1e-8:
            norm *= 1 + (1 - 2 * (m % 2)) * math.sin(full) / full
        else:
            norm *= 2
        for k in range(len(nodes)):
            x = nodes[k] - length / 2
            if order == 0:
                cosines[k] = math.cos(wave * x - phase)
            elif full > 1e-8:
                cosines[k] = math.sin(wave * x - phase) / wave
            else:
                cosines[k] = x
        scale = 1 / math.sqrt(norm)
        for f in range(len(jumps)):
            total = 0.0
            for k in range(len(nodes)):
                total += jumps[f, k] * cosines[k]
            out[f, m] = total * scale


@njit(cache=True, error_model="numpy")
def images(one, order, other, other_order, same, length, film, tau, out):
    """Fills out (E one, E other) with the kernel's antiderivatives, of the orders in x and in x', at tau m2. What is
    linear in both is left out: no function over strips sees it. one, other: ascending. same: one is other."""
    total = order + other_order
    flip = -1.0 if other_order == 1 else 1.0
    turned = -1.0 if total == 1 else 1.0
    scale = 2 * math.sqrt(tau)
    reach = _REACH * scale
    low_end = one[0] + other[0] <= reach
    high_end = 2 * length - one[-1] - other[-1] <= reach
    for i in range(len(one)):
        for j in range(i + 1 if same else len(other)):
            near, far = one[i] - other[j], one[i] + other[j]
            value = flip * _free(near, scale, total)
            if low_end:
                value += _beyond(far, 1.0, scale, total)
                if film > 0.0:
                    value -= _lost(far, scale, film, total)
            if high_end:
                value += _beyond(far - 2 * length, -1.0, scale, total)
                if film > 0.0:
                    value -= turned * _lost(2 * length - far, scale, film, total)
            out[i, j] = value
            if same:
                out[j, i] = value


@njit(cache=True, inner=True, error_model="numpy")
def _free(d, scale, order):
    """Antiderivative of that order of the free kernel at d; scale: 2 sqrt(tau)."""
    side = 1.0 if d >= 0 else -1.0
    far = _beyond(d, side, scale, order)
    if order == 2:
        return far + 0.5 * abs(d)
    return far + 0.5 * side if order == 1 else far


@njit(cache=True, inner=True, error_model="numpy")
def _beyond(d, side, scale, order):
    """The same less what it becomes far off, |d| / 2 or side / 2. side: the sign of d."""
    r = abs(d) / scale
    if r > _REACH:
        return 0.0
    if order == 0:
        return math.exp(-r * r) / (scale * _ROOT_PI)
    if order == 1:
        return -0.5 * side * math.erfc(r)
    return 0.5 * scale * _between(_TABLE, r * _FINE)


@njit(cache=True, inner=True, error_model="numpy", forceinline=True)
def _between(table, place):
    """The table's value between two of its nodes."""
    k = int(place)
    u = place - k
    v = 1 - u
    left = table[k, 0] * (1 + 2 * u) + table[k, 1] * u
    right = table[k + 1, 0] * (1 + 2 * v) - table[k + 1, 1] * v
    return left * v * v + right * u * u


@njit(cache=True, inner=True, error_model="numpy")
def _lost(y, scale, film, order):
    """Antiderivative of that order, 0 far off, of what a film takes from the image at distance y."""
    r = y / scale
    if r > _REACH:
        return 0.0
    gauss, warm, more = math.exp(-r * r), _erfcx(r), film * scale / 2
    if order == 0:
        return film * gauss * _erfcx(r + more)
    if more > _FEW:
        cooled = _erfcx(r + more) - warm
    else:
        first = 2 * r * warm - 2 / _ROOT_PI
        second = 2 * (warm + r * first)
        third = 2 * (2 * first + r * second)
        fourth = 2 * (3 * second + r * third)
        fifth = 2 * (4 * third + r * fourth)
        cooled = more * (
            first + more / 2 * (second + more / 3 * (third + more / 4 * (fourth + more / 5 * fifth)))
        )
    if order == 1:
        return gauss * cooled
    return gauss * (cooled / film - y * warm + scale / _ROOT_PI)


@njit(cache=True, inner=True, error_model="numpy")
def _erfcx(x):
    """exp(x^2) erfc(x), x >= 0."""
    if x < _FAR:
        return _between(_SCALED, (1 - 4 / (4 + x)) * _FINE)
    square = 0.5 / (x * x)
    return (1 - square * (1 - 3 * square * (1 - 5 * square))) / (x * _ROOT_PI)
