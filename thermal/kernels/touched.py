"""Boxes under fingertips as residues at rates that all share, many boxes at once.

Fixed-rate steps ask how warm a box is under the fingertips that are on it. Those patches are fitted together, their
residues positive semidefinite. What flowed through another place once is the past: how warm it leaves them is a sum of
fades that needs no constraint, and between two such places nothing is asked. So a box that remembers many places costs
hardly more than one that is touched for the first time. The film of air covers what lies under no fingertip.

Nothing of a box's numbers depends on which others are made with it.

B: boxes, N: patches, A: those under fingertips, M: patterns of each, S: moments, K: rates.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from functools import lru_cache
from typing import NamedTuple

import numpy as np

from ..matter import Material
from .box import Patches, box_kernel
from .contact import Resolution, Tip
from .exponentials import past_residues, residues
from .patterns import along_axes
from .samples import GRASP

_SPACING = 1.0  # of times in ln t: the transforms at GRASP are known to exp(-pi^2 / spacing), 5e-5
_UNFELT = (
    2.5e-10  # m2, diffusivity times time up to which every strip of a contact is a half-space of its own
)
_FIRST, _LAST = (
    3e-6,
    40.0,
)  # s; and its product with the slowest of GRASP, after which kernels count for nothing
_BEFORE = 40  # times before the first that count
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


def touched_boxes(boxes: Sequence[TouchedBox], level: Resolution) -> list[BodyResidues]:
    """Each box's residues at the level's rates."""
    alike: dict[tuple[int, int, bool], list[int]] = {}
    for number, box in enumerate(boxes):
        alike.setdefault((len(box.tips), box.touched, box.film > 0), []).append(number)
    found: dict[int, BodyResidues] = {}
    for numbers in alike.values():
        found.update(zip(numbers, _of_one_kind([boxes[number] for number in numbers], level), strict=True))
    return [found[number] for number in range(len(boxes))]


class _Kernels(NamedTuple):
    """impedance (B, S, A M, N M) K/W and heat (B, S, N M) J/W, None without a film, both less the slowest
    eigenfunction's part; that one's rate (B,), port (B, N M) and held (B,). capacity (B,) J/K of the boxes. weight
    (B, A, S) W/K of the tips. area, even (B, N M): of each port's patch, and the net heat of its pattern."""

    impedance: np.ndarray
    heat: np.ndarray | None
    rate: np.ndarray
    port: np.ndarray
    held: np.ndarray
    capacity: np.ndarray
    weight: np.ndarray
    area: np.ndarray
    even: np.ndarray


def _of_one_kind(boxes: Sequence[TouchedBox], level: Resolution) -> list[BodyResidues]:
    known, own = _kernels(boxes), boxes[0].touched * level.patterns
    port, rate, rest = known.port, known.rate, known.impedance
    slow = 1 / (GRASP + rate[:, None])
    each = np.diagonal(rest[..., :own], axis1=-2, axis2=-1) + slow[..., None] * port[:, None, :own] ** 2
    alone = each[..., :: level.patterns].swapaxes(-1, -2)
    weight = np.min(1 / (1 / known.weight + alone), axis=1)
    heat, warmed, still = known.heat, None, None
    if heat is not None:
        rate, rest, heat = _shielded(boxes, known, own)
        warmed = _heat_rows(heat, known.even - known.held[:, None] * port, level)
    found = np.zeros((len(boxes), own, port.shape[1], level.rates))
    for one, square, felt in zip(found, rest[..., :own], weight, strict=True):
        one[:, :own] = np.moveaxis(residues(square, level.decay, felt), 0, -1)
    if own < port.shape[1]:
        found[:, :, own:] = np.moveaxis(past_residues(rest[..., own:], level.decay, weight), 1, -1)
    if warmed is not None:
        still = _still(found, warmed, known.capacity - known.held**2)
    nothing = np.zeros((port.shape[1], level.rates)), np.zeros(level.rates)
    return [
        BodyResidues(
            float(rate[b]),
            port[b],
            float(known.held[b]),
            found[b],
            *(nothing if warmed is None or still is None else (warmed[b], still[b])),
        )
        for b in range(len(boxes))
    ]


@lru_cache(maxsize=256)
def _transform(diffusivity: float) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Times (T,) s at which kernels of m2/s are needed; (S, T) their transform at GRASP by the trapezoidal rule in
    ln t, as if they had their first value before; (S,) s of what they have more then if they fall as 1 / sqrt(t)."""
    first = max(_FIRST, _UNFELT / diffusivity)
    count = math.ceil(math.log(_LAST / GRASP[0] / first) / _SPACING) + 1
    times = first * np.exp(_SPACING * np.arange(-_BEFORE, count))
    rule = _SPACING * times * np.exp(-GRASP[:, None] * times)
    sooner, to_grasp = rule[:, :_BEFORE], np.ascontiguousarray(rule[:, _BEFORE:])
    flat = sooner.sum(axis=1)
    to_grasp[:, 0] += flat
    return times[_BEFORE:], to_grasp, (sooner * np.sqrt(first / times[:_BEFORE])).sum(axis=1) - flat


def _at_first(
    kernel: np.ndarray, port: np.ndarray, patches: Patches, touched: int, reached: float, capacity: float
) -> np.ndarray:
    """(A M, N M) K/J of the first kernel (A M, N M) that falls as 1 / sqrt(t) before: of a patch by itself, that of a
    half-space; what one has of another that it overlaps, all of it. reached: m2, diffusivity times that time."""
    own, patterns = len(kernel), len(kernel) // touched
    falling = kernel + port[:own, None] * port
    for n, area in enumerate(patches.areas[:touched]):
        part = slice(n * patterns, (n + 1) * patterns)
        falling[part, part] = np.eye(patterns) / (capacity * area * math.sqrt(math.pi * reached))
    return falling


def _kernels(boxes: Sequence[TouchedBox]) -> _Kernels:
    impedance, heats, rates, ports, helds = [], [], [], [], []
    for material, size, film, patches, tips, touched in boxes:
        capacity = material.volumetric_heat_capacity
        jumps, terms = along_axes([one.basis for one in tips])
        diffusivity = material.conductivity / capacity
        times, to_grasp, early = _transform(diffusivity)
        kernel, rate, port, held, heat = box_kernel(
            size, material.conductivity, capacity, film, patches, jumps, terms, touched, times
        )
        at_moments = (to_grasp @ kernel.reshape(len(kernel), -1)).reshape(-1, *kernel.shape[1:])
        at_moments += early[:, None, None] * _at_first(
            kernel[0], port, patches, touched, diffusivity * times[0], capacity
        )
        impedance.append(at_moments)
        heats.append(None if heat is None else to_grasp @ heat)
        rates.append(rate)
        ports.append(port)
        helds.append(held)
    count = boxes[0].touched
    kept = boxes[0].tips[0].basis.shape[1]
    return _Kernels(
        np.array(impedance),
        None if heats[0] is None else np.array(heats),
        np.array(rates),
        np.array(ports),
        np.array(helds),
        np.array([box.material.volumetric_heat_capacity * math.prod(box.size) for box in boxes]),
        np.array([[one.weight for one in box.tips[:count]] for box in boxes]),
        np.repeat([[one.area for one in box.tips] for box in boxes], kept, axis=1),
        np.array([np.concatenate([one.even for one in box.tips]) for box in boxes]),
    )


def _shielded(
    boxes: Sequence[TouchedBox], known: _Kernels, own: int
) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """The slowest rate, the samples without it, and the heat's, with no film on what is touched: a film's flow is put
    back there in proportion to the temperature."""
    assert known.heat is not None
    port = known.port
    slow = 1 / (GRASP + known.rate[:, None])
    back = np.array([box.film for box in boxes])[:, None] * known.area[:, :own]
    whole = known.impedance + slow[..., None, None] * (port[:, None, :own, None] * port[:, None, None, :])
    heat = known.heat + slow[..., None] * (known.held[:, None] * port)[:, None]
    rate = np.maximum(known.rate - np.sum(back * port[:, :own] ** 2, axis=1), 0.0)
    # T = Z (q + back T)
    opened = np.linalg.inv(np.eye(own) - whole[..., :own] * back[:, None, None])
    whole = opened @ whole
    heat = heat + ((heat[..., :own] * back[:, None])[..., None, :] @ whole)[..., 0, :]
    square = whole[..., :own]
    whole[..., :own] = (square + square.swapaxes(-1, -2)) / 2
    slow = 1 / (GRASP + rate[:, None])
    rest = whole - slow[..., None, None] * (port[:, None, :own, None] * port[:, None, None, :])
    return rate, rest, heat - slow[..., None] * (known.held[:, None] * port)[:, None]


def _heat_rows(heat: np.ndarray, total: np.ndarray, level: Resolution) -> np.ndarray:
    """(B, N M, K) of the heat (B, S, N M) that follows each port's flow, whose sums are the total (B, N M): all heat
    that goes in is in."""
    seen, share = _heat_fit(level)
    rows = heat.swapaxes(-1, -2) @ seen + total[..., None] * share
    # what rounding has left of the total
    return rows + (total - rows.sum(axis=-1))[..., None] * share


@lru_cache(maxsize=8)
def _heat_fit(level: Resolution) -> tuple[np.ndarray, np.ndarray]:
    """(S, K) and (K,): the least squares' answer is a heat's samples times the first and its total times the second.
    Samples at s are weighed by s, as a share of what has gone in."""
    columns = GRASP[:, None] / (GRASP[:, None] + level.decay)
    rates = level.rates
    normal = np.ones((rates + 1, rates + 1))
    normal[:-1, :-1] = columns.T @ columns + _HEAT_RIDGE * np.eye(rates)
    normal[-1, -1] = 0.0
    inverse = np.linalg.inv(normal)
    return np.ascontiguousarray((inverse[:-1, :-1] @ (columns * GRASP[:, None]).T).T), inverse[:-1, -1].copy()


def _still(found: np.ndarray, warmed: np.ndarray, total: np.ndarray) -> np.ndarray:
    """(B, K) J/K of what follows the air, and not the box's slowest state; its sum is the total (B,) where the air
    takes any. A rate's share is what the touched ports tell: its heat row squared over its resistance, as in a state.
    """
    seen = np.diagonal(found[:, :, : found.shape[1]], axis1=1, axis2=2).swapaxes(-1, -2)
    least = _SEEN_LEAST * seen.max(axis=(-2, -1), keepdims=True)
    share = (warmed[:, : found.shape[1]] ** 2 / (seen + least)).sum(axis=1)
    whole = share.sum(axis=1)
    return (
        share * np.divide(np.maximum(total, 0.0), whole, out=np.zeros_like(whole), where=whole > 0)[:, None]
    )
