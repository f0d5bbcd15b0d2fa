"""Fingertips with pads around their elements on a box, as networks for one touch.

Ports are an even flow into the element's face, then an even one into the rings of the pad around it and these against
one another, then what is crowded toward the face's edges: the pad's own contact conducts by itself. Networks are made
on flows over the whole front, which no film of air reaches.

F: fingertips, P: patterns of the element's face (kernels), R: rings, Q = P + R, S: moments.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from ..kernels import (
    GRAM,
    MOMENTS,
    BoxSamples,
    Detail,
    Patches,
    Tip,
    before,
    box_samples,
    contact_weight,
    states,
    touch_box,
    touch_patterns,
)
from ..matter import Material, SensorStack, Surround
from ..numerics import ThermalNetwork, output_row
from .fingertip import RingedSamples, covered_samples
from .rings import RING_PORTS, RINGS, nested_sides, to_rings


def padded_sides(
    material: Material,
    size: tuple[float, float, float],
    film: float,
    fronts: Patches,
    stack: SensorStack,
    surround: Surround,
    detail: Detail,
) -> tuple[tuple[Tip, ...], ThermalNetwork]:
    """The fingertips, all alike, and the box between them, as touch_sides makes them, but with the pad's RING_PORTS; a
    tip's output "element" has the pad's heat in it, and its area is of the face alone. size: m. film: W/(m2 K), not on
    what the fingertips cover. fronts: what of each pad touches, the element's whole face in its middle. stack: with its
    skin. surround: with its depth."""
    # what touches is no square where the object ends under the pad
    sides = nested_sides(stack.width, float(2 * fronts.half[0].max()))
    nested = [np.minimum(side / 2, fronts.half) for side in (stack.width, *sides)]
    areas = np.diff([4 * float(half[0].prod()) for half in nested])
    seen = covered_samples(stack, surround, sides, areas)
    box = _seen(material, size, film, fronts, nested)
    count, tips = len(GRAM), len(fronts.face)
    faces = np.concatenate([np.arange(count) + f * (count + RINGS) for f in range(tips)])
    across = [seen.impedance[:, :count, :count]] * tips
    areas = np.full(tips, seen.face)
    whole = box.whole()[:, faces[:, None], faces]
    basis = seen.orthonormal(touch_patterns(whole, across, areas, detail.patterns, shared=True)[0])
    made = _tip(seen, basis, detail)
    body, turn = touch_box(box, film, (made,) * tips, detail), seen.separated(basis.shape[1])
    basis, even = basis @ turn, np.zeros(basis.shape[1])
    even[: RING_PORTS.start + 1] = 1.0
    impedance = np.einsum("p,spq,q->s", basis[:, 0], seen.impedance, basis[:, 0])
    made = Tip(seen.face, basis, even, impedance, _turned(made.side, turn))
    return (made,) * tips, _turned(body, np.kron(np.eye(tips), turn))


def _turned(network: ThermalNetwork, turn: np.ndarray) -> ThermalNetwork:
    """On other combinations of its ports."""
    return replace(network, ports=network.ports @ turn, direct=turn.T @ network.direct @ turn)


def _tip(seen: RingedSamples, basis: np.ndarray, detail: Detail) -> Tip:
    impedance, slope = basis.T @ seen.impedance @ basis, basis.T @ seen.slope @ basis
    even = np.eye(basis.shape[1])[0]
    seen_even = impedance[:, 0, 0].copy()
    weight = contact_weight(seen_even, seen.front)
    rates, ports = states(impedance, slope, weight, detail.indices)
    drop = output_row(MOMENTS, seen.drop @ basis, rates, ports, weight)
    # all heat that goes in is in
    heat = output_row(MOMENTS, seen.heat @ basis, rates, ports, MOMENTS, even)
    side = ThermalNetwork(rates, ports, outputs={"drop": drop, "element": heat})
    return Tip(seen.front, basis, even, seen_even, side)


def _seen(
    material: Material,
    size: tuple[float, float, float],
    film: float,
    fronts: Patches,
    halves: Sequence[np.ndarray],
) -> BoxSamples:
    """The box's samples between Q flows of each fingertip: the patterns of its element's face, and even ones into rings
    of its front. halves: (F, 2) m of the face, then of what touches of the squares around it."""
    count, tips, each = len(GRAM), len(fronts.face), 1 + RINGS
    nested = Patches(
        np.repeat(fronts.face, each),
        np.repeat(fronts.centre, each, axis=0),
        np.stack(halves, axis=1).reshape(tips * each, 2),
    )
    even = [False, *[True] * RINGS] * tips
    box = box_samples(size, material.conductivity, material.volumetric_heat_capacity, film, nested, even=even)
    early = before(material.conductivity / material.volumetric_heat_capacity)
    early /= material.volumetric_heat_capacity
    impedance, flows = box.impedance.copy(), count + RINGS
    turn = np.zeros((tips * flows, tips * flows))
    for f in range(tips):
        face = first = f * flows
        turn[face : face + count, first : first + count] = np.eye(count)
        rows, squares = slice(face, face + count), range(face + count, face + flows)
        areas = nested.areas[f * each : (f + 1) * each].tolist()
        to_rings(impedance, turn, (rows, GRAM[0]), squares, areas, early, first + count)
    return BoxSamples(
        turn.T @ impedance @ turn,
        turn.T @ box.slope @ turn,
        box.rate,
        box.port @ turn,
        box.held,
        None if box.heat is None else box.heat @ turn,
    )
