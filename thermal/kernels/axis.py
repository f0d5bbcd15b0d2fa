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
_FINE = (
    512.0  # nodes a unit of the tables below: cubic Hermite interpolation leaves 4e-14, and few are read soon
)


def _integral_of_erfc() -> np.ndarray:
    """(nodes, 2) of the integral of erfc from r on, and its slope times the spacing."""
    r = np.arange(int(_REACH * _FINE) + 2) / _FINE
    return np.stack((np.exp(-(r**2)) / _ROOT_PI - r * erfc(r), -erfc(r) / _FINE), axis=1)


_TABLE = _integral_of_erfc()
_PI_FIRST = 201 / 64  # so few digits that its small multiples are exact
_PI_REST = math.pi - _PI_FIRST + math.sin(math.pi)  # which is what the number lacks
_SERIES = tuple((-1) ** n / math.factorial(2 * n + 1) for n in range(10))
_LEVEL = 1e-8  # wave number times length up to which an eigenfunction is even
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
                if abs(change) < 1e-8 * d:  # what is left is its square
                    break
        waves[m] = 2 * (base + d) / length
    return waves


@njit(cache=True, borrows=True, error_model="numpy")
def overlaps(nodes, jumps, order, length, waves, seen, out):
    """Fills out (F, M) with the functions' products with normalised eigenfunctions. seen: room (M,)."""
    out[:] = 0.0
    for k in range(len(nodes)):
        x = nodes[k] - length / 2
        for m in range(len(waves)):
            turn = waves[m] * x - m * math.pi / 2
            seen[m] = _sine(turn + math.pi / 2) if order == 0 else _sine(turn) / waves[m]
        if order == 1 and waves[0] * length <= _LEVEL:
            seen[0] = x
        for f in range(len(jumps)):
            for m in range(len(waves)):
                out[f, m] += jumps[f, k] * seen[m]
    for m in range(len(waves)):
        full = waves[m] * length
        norm = length if full <= _LEVEL else length / 2 * (1 + (1 - 2 * (m % 2)) * _sine(full) / full)
        for f in range(len(jumps)):
            out[f, m] /= math.sqrt(norm)


@njit(cache=True, inner=True, error_model="numpy", forceinline=True)
def _sine(x):
    """Of |x| up to some hundred, to round-off, without a branch or a call, so that a loop of it becomes vectors."""
    turns = np.floor(x / math.pi + 0.5)
    r = x - turns * _PI_FIRST - turns * _PI_REST
    square = r * r
    series = 0.0
    for n in range(9, 0, -1):
        series = (series + _SERIES[n]) * square
    return (r + r * series) * (1 - 2 * (turns - 2 * np.floor(turns / 2)))


@njit(cache=True, borrows=True, error_model="numpy")
def images(one, order, other, other_order, same, length, film, tau, out):
    """Fills out (E one, E other) with the kernel's antiderivatives, of the orders in x and in x', at tau m2. What is
    linear in both is left out: no function over strips sees it. one, other: ascending. same: one is other."""
    scale = 2 * math.sqrt(tau)
    if order + other_order == 2:
        _free_strips(one, other, scale, out)
    else:
        flip = -1.0 if other_order == 1 else 1.0
        for i in range(len(one)):
            for j in range(len(other)):
                out[i, j] = flip * _free(one[i] - other[j], scale, order + other_order)
    add_images(one, order, other, other_order, same, length, film, tau, out)


@njit(cache=True, inner=True, borrows=True, error_model="numpy")
def ends_reached(one, other, length, tau):
    """Whether anything comes from one to the other by way of the axis' first end, and of its last; as in images."""
    reach = _REACH * 2 * math.sqrt(tau)
    return one[0] + other[0] <= reach, 2 * length - one[-1] - other[-1] <= reach


@njit(cache=True, inner=True, borrows=True, error_model="numpy")
def add_images(one, order, other, other_order, same, length, film, tau, out):
    """Adds to out what comes by way of the ends, as in images."""
    total = order + other_order
    turned = -1.0 if total == 1 else 1.0
    scale = 2 * math.sqrt(tau)
    low_end, high_end = ends_reached(one, other, length, tau)
    if not low_end and not high_end:
        return
    if total == 2 and film * scale / 2 <= _FEW:
        if low_end:
            _strip_images(one, other, 0.0, 1.0, film, scale, out)
        if high_end:
            _strip_images(one, other, 2 * length, -1.0, film, scale, out)
        return
    for i in range(len(one)):
        for j in range(i + 1 if same else len(other)):
            far, value = one[i] + other[j], 0.0
            if low_end:
                value += _beyond(far, 1.0, scale, total)
                if film > 0.0:
                    value -= _lost(far, scale, film, total)
            if high_end:
                value += _beyond(far - 2 * length, -1.0, scale, total)
                if film > 0.0:
                    value -= turned * _lost(2 * length - far, scale, film, total)
            out[i, j] += value
            if same:
                out[j, i] = out[i, j]


@njit(cache=True, borrows=True, error_model="numpy")
def left_inside(places, length, film, tau, out):
    """Fills out (E,) with the antiderivative along the axis of what of heat that starts there is in it at tau m2, at a
    time at which eigenfunctions need not serve."""
    scale = 2 * math.sqrt(tau)
    low_end, high_end = places[0] <= _REACH * scale, length - places[-1] <= _REACH * scale
    for k in range(len(places)):
        out[k] = places[k]
    if film * scale / 2 <= _FEW:
        fine, more = _FINE / scale, film * scale
        for k in range(len(places) if low_end else 0):
            out[k] += scale * _soon(places[k] * fine, more)[1]
        for k in range(len(places) if high_end else 0):
            out[k] -= scale * _soon((length - places[k]) * fine, more)[1]
        return
    for k in range(len(places)):
        if low_end:
            out[k] += _lost(places[k], scale, film, 2)
        if high_end:
            out[k] -= _lost(length - places[k], scale, film, 2)


@njit(cache=True, error_model="numpy")
def free_kernels(half, jumps, nodes, taus):
    """(N, 2, F, F, T) of N patches' functions on themselves where no end is near. half: (N, 2) m. jumps: (N, 2, F, E)
    and nodes: (E,) from -1 to 1. taus: (T,) m2."""
    count, functions = len(half), jumps.shape[2]
    found = np.zeros((count, 2, functions, functions, len(taus)))
    table, done = np.empty((len(nodes), len(nodes))), np.empty(len(nodes))
    for n in range(count):
        for w in range(2):
            places = half[n, w] * nodes
            for t in range(len(taus)):
                _free_strips(places, places, 2 * math.sqrt(taus[t]), table)
                add_projected(jumps[n, w], table, jumps[n, w], False, done, found[n, w], t)
    return found


@njit(cache=True, inner=True, borrows=True, error_model="numpy")
def add_projected(by, table, beside, same, done, out, t):
    """Adds to out (F one, F other, T), at number t, jumps (F one, E one) times the table times jumps (F other,
    E other). same: these are the same, and only the lower half is wanted. done: room (E other,)."""
    count = len(done)
    for f in range(len(by)):
        for q in range(count):
            done[q] = 0.0
        for k in range(by.shape[1]):
            for q in range(count):
                done[q] += by[f, k] * table[k, q]
        for g in range(f + 1 if same else len(beside)):
            even, odd = 0.0, 0.0  # sums that need not wait for each other
            for q in range(count // 2):
                even += beside[g, 2 * q] * done[2 * q]
                odd += beside[g, 2 * q + 1] * done[2 * q + 1]
            if count % 2:
                even += beside[g, count - 1] * done[count - 1]
            out[f, g, t] += even + odd


@njit(cache=True, inner=True, borrows=True, error_model="numpy")
def _free_strips(one, other, scale, out):
    """Fills out with the free kernel's antiderivative in x and x', by loops that become vectors."""
    fine = _FINE / scale
    for i in range(len(one)):
        for j in range(len(other)):
            d = abs(one[i] - other[j])
            out[i, j] = -0.5 * (d + scale * _between(_TABLE, min(d * fine, _REACH * _FINE)))


@njit(cache=True, inner=True, borrows=True, error_model="numpy")
def _strip_images(one, other, end, side, film, scale, out):
    """Adds to out what comes to strips by way of one end, at distances end + side (x + x'). Rows of which a part is
    reached are taken whole, by loops that become vectors."""
    fine, more, reach = _FINE / scale, film * scale, _REACH * scale
    nearest = other[0] if side > 0 else other[-1]
    for i in range(len(one)):
        start = end + side * one[i]
        if start + side * nearest > reach:
            continue
        for j in range(len(other)):
            near, lost = _soon((start + side * other[j]) * fine, more)
            out[i, j] += scale * (near / 2 - lost)


@njit(cache=True, inner=True, borrows=True, error_model="numpy", forceinline=True)
def _soon(place, more):
    """At place _FINE y / scale, y from an end: the integral of erfc from y / scale on, and _lost of order 2 over the
    scale while more, film times scale, is at most 2 _FEW. That one is a series of the repeated integrals of erfc, which
    follow from the first two (Carslaw & Jaeger, appendix II)."""
    place = min(place, _REACH * _FINE)
    k = int(place)
    u = place - k
    v = 1 - u
    low, high, falls, falling = _TABLE[k, 0], _TABLE[k + 1, 0], _TABLE[k, 1], _TABLE[k + 1, 1]
    first = (low * (1 + 2 * u) + falls * u) * v * v + (high * (1 + 2 * v) - falling * v) * u * u
    slope = 6 * u * v * (high - low) + falls * v * (1 - 3 * u) + falling * u * (1 - 3 * v)
    r = place / _FINE
    second = (-slope * _FINE - 2 * r * first) / 4
    third = (first - 2 * r * second) / 6
    fourth = (second - 2 * r * third) / 8
    fifth = (third - 2 * r * fourth) / 10
    return first, more * (second - more * (third - more * (fourth - more * fifth)))


@njit(cache=True, inner=True, error_model="numpy")
def _free(d, scale, order):
    """Antiderivative of that order, 0 or 1, of the free kernel at d; scale: 2 sqrt(tau)."""
    side = 1.0 if d >= 0 else -1.0
    far = _beyond(d, side, scale, order)
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


@njit(cache=True, inner=True, borrows=True, error_model="numpy", forceinline=True)
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
