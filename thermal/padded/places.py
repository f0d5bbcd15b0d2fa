"""Fingertips with pads around their elements anywhere on a box, as networks that any contact joins.

An element's face has its patterns of flow, and the pad around it RINGS ports of even flows into rings of its front:
each ring conducts by itself, as much of it as the object reaches. A fingertip's network is its own whatever it touches:
a projection of the padded fingertip on its fields at a few moments. A box has the fixed rates of kernels/contact.py,
seen through the faces' patches and through what the rings cover of it beside them.

S: moments, N: places, M: patterns kept of each, n: states.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import lru_cache

import numpy as np

from ..kernels import (
    MOMENTS,
    OF_GRASP,
    Detail,
    Patches,
    Resolution,
    Tip,
    at_rates,
    before,
    box_samples,
    contact_patterns,
    contact_weight,
    least_weight,
    ports_told,
    states,
)
from ..matter import Material, SensorStack, Surround
from ..numerics import ThermalNetwork, output_row
from .fingertip import ringed_samples
from .rings import RINGS, ring_sides, to_rings

_SLOWEST = 1 / 600  # 1/s


@dataclass(frozen=True, slots=True, eq=False)
class PaddedTip:
    """A fingertip in its pad. tip: as of an element by itself under its whole face, but that its output "element" is
    the heat of element and pad. rings: (n, RINGS) sqrt(K/J), the ports of even flows into the rings, and impedance:
    (S, RINGS) K/W of each at GRASP. areas: (RINGS,) m2."""

    tip: Tip
    rings: np.ndarray
    impedance: np.ndarray
    areas: np.ndarray


@lru_cache(maxsize=64)
def padded_tip(stack: SensorStack, surround: Surround, level: Resolution, moments: int) -> PaddedTip:
    """stack: with its skin. surround: with its depth. level: tells the patterns. moments: at which the network is
    exact, from ten minutes to a fraction of a control step."""
    whole, kept = (0.0, stack.width), level.patterns
    seen = ringed_samples(stack, surround, ring_sides(stack.width, surround))
    face = contact_patterns(stack, (whole, whole), kept)
    known = len(face)
    basis = np.zeros((known + RINGS, kept + RINGS))
    basis[:known, :kept], basis[known:, kept:] = face, np.eye(RINGS)
    impedance, slope = basis.T @ seen.impedance @ basis, basis.T @ seen.slope @ basis
    even = np.ones(kept + RINGS)
    even[1:kept] = 0.0
    alone = impedance[:, 0, 0]
    weight = contact_weight(alone, seen.face)
    rates, ports = states(impedance, slope, weight, Detail(moments, kept, _SLOWEST).indices)
    # the drop does not jump with heat at the front, but all heat that goes in is in
    drop = output_row(MOMENTS, seen.drop @ basis, rates, ports, weight, np.zeros(kept + RINGS))
    heat = output_row(MOMENTS, seen.heat @ basis, rates, ports, MOMENTS, even)
    side = ThermalNetwork(rates, ports[:, :kept], outputs={"drop": drop, "element": heat})
    tip = Tip(seen.face, face, even[:kept], alone[OF_GRASP].copy(), side)
    of_rings = np.diagonal(impedance[OF_GRASP], axis1=1, axis2=2)[:, kept:]
    return PaddedTip(tip, ports[:, kept:], of_rings.copy(), seen.areas)


def box_in_pads(
    material: Material,
    size: tuple[float, float, float],
    faces: Patches,
    tips: Sequence[Tip],
    rings: Sequence[tuple[float, ...] | None],
    level: Resolution,
    whole: Sequence[bool] | None = None,
) -> tuple[ThermalNetwork, np.ndarray]:
    """The box's network of N M ports, as box_side makes it without a film, and (n, N RINGS) ports of even flows into
    what rings cover of its faces; 0 where they cover nothing. size: m. faces: under the elements. rings: ring_sides of
    each, None for an element without a pad. whole: whether all ports of a place are told, or the face's even one alone
    and zeros for the others; None: all of them."""
    kept, count, told = level.patterns, len(tips), ports_told(len(tips), level.patterns, whole)
    padded = [n for n, sides in enumerate(rings) if sides is not None and not told.even[n]]
    around = _around(size, faces, [(n, side) for n in padded for side in rings[n] or ()])
    bases, squares = [tip.basis for tip in tips], len(padded) * RINGS
    capacity = material.volumetric_heat_capacity
    box = box_samples(
        *(size, material.conductivity, capacity, 0.0),
        Patches(*(np.concatenate(pair) for pair in zip(faces, around, strict=True))),
        [*bases, *(bases[n] for n in padded for _ in range(RINGS))],
        even=[*told.even, *[True] * squares],
    )
    impedance, of_faces = box.impedance[OF_GRASP].copy(), len(told.columns)
    early = before(material.conductivity / capacity) / capacity
    turn = np.zeros((of_faces + squares, of_faces + squares))
    turn[:of_faces, :of_faces] = np.eye(of_faces)
    for r, n in enumerate(padded):
        first = of_faces + r * RINGS
        areas = [float(faces.areas[n]), *around.areas[r * RINGS : (r + 1) * RINGS].tolist()]
        to_rings(
            impedance, turn, (told.of(n), tips[n].even), range(first, first + RINGS), areas, early, first
        )
    rest, port = turn.T @ impedance @ turn, box.port @ turn
    fast, ports = at_rates(rest, level, least_weight(tips, rest, port, box.rate, told.first))
    rates, ports = np.concatenate(([box.rate], fast)), np.concatenate((port[None], ports))
    held = np.zeros(len(rates))
    held[0] = box.held
    every, beside = np.zeros((len(rates), count * kept)), np.zeros((len(rates), count * RINGS))
    every[:, told.columns] = ports[:, :of_faces]
    beside[:, [n * RINGS + r for n in padded for r in range(RINGS)]] = ports[:, of_faces:]
    return ThermalNetwork(rates, every, outputs={"object": held, "loss": held * rates}), beside


def _around(
    size: tuple[float, float, float], faces: Patches, squares: Sequence[tuple[int, float]]
) -> Patches:
    """What squares around those faces, of sides m, cover of the box's faces."""
    centre, half = np.zeros((len(squares), 2)), np.zeros((len(squares), 2))
    for r, (n, wide) in enumerate(squares):
        sides = [side for axis, side in enumerate(size) if axis != faces.face[n] // 2]
        for axis, side in enumerate(sides):
            middle, reach = faces.centre[n, axis], max(wide / 2, faces.half[n, axis])
            low, high = max(middle - reach, 0.0), min(middle + reach, side)
            centre[r, axis], half[r, axis] = (low + high) / 2, (high - low) / 2
    return Patches(faces.face[[n for n, _ in squares]], centre, half)
