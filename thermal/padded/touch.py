"""Fingertips with pads around their elements on a box, as networks for one touch.

Ports are flows over the whole front that touches, the even one first, then the element's face against the pad around
it, then what is crowded toward the face's edges. The pad's own contact is taken to conduct as well as the face's: the
silicone behind it is by far the larger resistance.

F: fingertips, P: patterns of the element's face (kernels), Q = P + 1, S: moments.
"""

from __future__ import annotations

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
from .fingertip import PaddedSamples, padded_samples


def padded_sides(
    material: Material,
    size: tuple[float, float, float],
    film: float,
    fronts: Patches,
    stack: SensorStack,
    surround: Surround,
    detail: Detail,
) -> tuple[tuple[Tip, ...], ThermalNetwork]:
    """The fingertips, all alike, and the box between them, as touch_sides makes them; a tip's output "element" has the
    pad's heat in it. size: m. film: W/(m2 K), not on what the fingertips cover. fronts: what of each pad touches, the
    element's whole face in its middle. stack: with its skin. surround: with its depth."""
    seen = padded_samples(stack, surround, float(fronts.areas[0]))
    box = _seen(material, size, film, fronts, stack.width)
    count, tips = len(GRAM), len(fronts.face)
    faces = np.concatenate([np.arange(count) + f * (count + 1) for f in range(tips)])
    across = [seen.impedance[:, :count, :count]] * tips
    areas = np.full(tips, seen.face)
    whole = box.whole()[:, faces[:, None], faces]
    basis = seen.orthonormal(touch_patterns(whole, across, areas, detail.patterns, shared=True)[0])
    made = (_tip(seen, basis, detail),) * tips
    return made, touch_box(box, film, made, detail)


def _tip(seen: PaddedSamples, basis: np.ndarray, detail: Detail) -> Tip:
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
    material: Material, size: tuple[float, float, float], film: float, fronts: Patches, width: float
) -> BoxSamples:
    """The box's samples between Q flows of each fingertip: the patterns of its element's face, of that width, and an
    even one over its front."""
    count, tips = len(GRAM), len(fronts.face)
    nested = Patches(
        np.repeat(fronts.face, 2),
        np.repeat(fronts.centre, 2, axis=0),
        np.stack((np.full_like(fronts.half, width / 2), fronts.half), axis=1).reshape(-1, 2),
    )
    box = box_samples(size, material.conductivity, material.volumetric_heat_capacity, film, nested)
    early = before(material.conductivity / material.volumetric_heat_capacity)
    impedance = box.impedance.copy()
    for f, area in enumerate(fronts.areas):
        # before the first time the face's part of the front is a half-space under the front's even flow
        face, front = np.arange(count) + 2 * f * count, (2 * f + 1) * count
        shared = early / material.volumetric_heat_capacity / area * GRAM[0]
        impedance[:, face, front] += shared
        impedance[:, front, face] += shared
    flows = np.concatenate([np.arange(count + 1) + 2 * f * count for f in range(tips)])
    return BoxSamples(
        impedance[:, flows[:, None], flows],
        box.slope[:, flows[:, None], flows],
        box.rate,
        box.port[flows],
        box.held,
        None if box.heat is None else box.heat[:, flows],
    )
