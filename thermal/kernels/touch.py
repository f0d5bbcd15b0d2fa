"""Fingertips on a box as passive networks for just one touch: few states, on the patterns that it excites itself.

Fewer states than fixed rates need (contact.py) and a tenth of their error; but these states are the touch's own
(`states`): only the element's slowest are the same from one touch to another. The film of air on the box does not
cover what lies under a fingertip.

F: fingertips, P: patterns known (patterns.py), M: kept of each, S: moments, n: states.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from ..matter import Material, SensorStack
from ..numerics import Sampled, ThermalNetwork, output_row, sampled_fields
from .box import BoxSamples, Patches, box_samples
from .contact import Tip, contact_weight
from .coverage import touch_patterns
from .element import Rectangle, element, element_samples
from .patterns import GRAM
from .samples import MOMENTS

_RANKS = (1e-5, 1e-6, 1e-8)
"""Shares of the largest of the fields' Gram matrix, below which its directions are left out. The first leaves out
fields that count where large contacts are on a small block in air (.1 K of 12); with the last, the samples' errors may
come in where there are many patterns. What the network says between its moments tells which serves."""


@dataclass(frozen=True, slots=True)
class Detail:
    """The knob between speed and accuracy. moments: how many, equally spaced in the logarithm from slowest to fastest
    1/s, at which networks are exact: each gives a state a port. patterns: kept of each contact."""

    moments: int
    patterns: int
    slowest: float = 1 / 60
    fastest: float = 180.0

    @property
    def indices(self) -> np.ndarray:
        """Of MOMENTS."""
        first, last = np.searchsorted(MOMENTS, (self.slowest * 0.99, self.fastest * 1.01))
        return np.unique(np.round(np.linspace(first, last - 1, self.moments)).astype(int))


def touch_sides(
    material: Material,
    size: tuple[float, float, float],
    film: float,
    patches: Patches,
    elements: Sequence[tuple[SensorStack, Rectangle]],
    detail: Detail,
    shared: bool = False,
) -> tuple[tuple[Tip, ...], ThermalNetwork]:
    """The fingertips' elements and the box between them, its slowest state first; outputs as `tip` and `box_side` have
    them. size: m. film: W/(m2 K). elements: what each patch covers of a sensor's face. shared: one set of patterns for
    all contacts, which are alike."""
    box = box_samples(size, material.conductivity, material.volumetric_heat_capacity, film, patches)
    seen = [element_samples(stack, covered).value for stack, covered in elements]
    bases = touch_patterns(box.whole(), seen, patches.areas, detail.patterns, shared)
    tips = tuple(
        _tip(stack, covered, basis, detail) for (stack, covered), basis in zip(elements, bases, strict=True)
    )
    return tips, touch_box(box, film, tips, detail)


def _tip(stack: SensorStack, covered: Rectangle, basis: np.ndarray, detail: Detail) -> Tip:
    samples = element_samples(stack, covered)
    value, slope = basis.T @ samples.value @ basis, basis.T @ samples.slope @ basis
    even = GRAM[0] @ basis
    even[1:] = 0.0
    (x0, x1), (y0, y1) = covered
    area = (x1 - x0) * (y1 - y0)
    impedance = value[:, 0, 0].copy()
    weight = contact_weight(impedance, area)
    return Tip(
        area, basis, even, impedance, _element_side(stack, Sampled(value, slope), even, weight, detail)
    )


def touch_box(box: BoxSamples, film: float, tips: tuple[Tip, ...], detail: Detail) -> ThermalNetwork:
    """The box between tips, each on its combinations of the patterns that the box was sampled with."""
    count, kept = tips[0].basis.shape
    turn = np.zeros((len(tips) * count, len(tips) * kept))
    for f, one in enumerate(tips):
        turn[f * count : (f + 1) * count, f * kept : (f + 1) * kept] = one.basis
    port = box.port @ turn
    value, slope = turn.T @ box.impedance @ turn, turn.T @ box.slope @ turn
    slow = 1 / (MOMENTS + box.rate)
    weights = [
        1 / (1 / one.weight + value[:, f * kept, f * kept] + port[f * kept] ** 2 * slow)
        for f, one in enumerate(tips)
    ]
    weight = np.min(weights, axis=0)
    if film == 0:
        rates, ports = states(value, slope, weight, detail.indices)
        rates, ports = np.concatenate(([0.0], rates)), np.concatenate((port[None], ports))
        held = np.zeros(len(rates))
        held[0] = box.held
        return ThermalNetwork(rates, ports, outputs={"object": held, "loss": np.zeros(len(rates))})
    value, slope, heat = _shielded(box, film, Sampled(value, slope), port, turn, tips)
    rates, ports = states(value, slope, weight, detail.indices)
    held = output_row(MOMENTS, heat, rates, ports, MOMENTS, np.concatenate([one.even for one in tips]))
    return ThermalNetwork(rates, ports, outputs={"object": held, "loss": held * rates})


def _shielded(
    box: BoxSamples, film: float, rest: Sampled, port: np.ndarray, turn: np.ndarray, tips: tuple[Tip, ...]
) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """The whole samples' value and slope, and the heat's (S, ports), with no film on the patches: a film's flow is put
    back there in proportion to the temperature."""
    assert box.heat is not None
    back = np.repeat([film * one.area for one in tips], len(tips[0].even))
    slow = 1 / (MOMENTS + box.rate)
    slowest = np.outer(port, port)
    value = rest.value + slow[:, None, None] * slowest
    slope = rest.slope - (slow**2)[:, None, None] * slowest
    heat = box.heat @ turn + slow[:, None] * box.held * port
    # T = Z (q + back T)
    opened = np.linalg.inv(np.eye(len(back)) - value * back)
    value = opened @ value
    slope = opened @ slope @ opened.transpose(0, 2, 1)
    heat = heat + np.einsum("si,i,sij->sj", heat, back, value)
    return (value + value.transpose(0, 2, 1)) / 2, (slope + slope.transpose(0, 2, 1)) / 2, heat


def _element_side(
    stack: SensorStack, whole: Sampled, even: np.ndarray, weight: np.ndarray, detail: Detail
) -> ThermalNetwork:
    known = element(stack)
    slowest, slow = np.outer(even, even), 1 / (MOMENTS[:, None] + known.rates)
    value = whole.value - (slow @ known.ports**2)[:, None, None] * slowest
    slope = whole.slope + (slow**2 @ known.ports**2)[:, None, None] * slowest
    fast, ports = states(value, slope, weight, detail.indices)
    drop = output_row(MOMENTS, np.outer(known.drop_rest, even), fast, ports, weight)
    # all heat that goes in is in
    jump = (1 - known.heat @ known.ports) * even
    heat = output_row(MOMENTS, np.outer(known.heat_rest, even), fast, ports, MOMENTS, jump)
    return ThermalNetwork(
        np.concatenate((known.rates, fast)),
        np.concatenate((known.ports[:, None] * even, ports)),
        outputs={"drop": np.concatenate((known.drop, drop)), "element": np.concatenate((known.heat, heat))},
    )


def states(
    impedance: np.ndarray, slope: np.ndarray, weight: np.ndarray, moments: np.ndarray
) -> tuple[np.ndarray, np.ndarray]:
    """Rates (n,) 1/s and ports (n, N) sqrt(K/J) of a passive network, the slowest first: the Galerkin projection of the
    body on its fields at those moments (numerics/reduction.py). So a network of one state a moment and port has the
    body's impedance there, and is passive whatever the moments are. impedance, slope: (S, N, N) K/W
    and K s/W at MOMENTS. weight: (S,) W/K of the impedance's errors. moments: the indices of those that count."""
    value = impedance[moments]
    gram, pencil, scale = sampled_fields(MOMENTS[moments], Sampled(value, slope[moments]))
    values, vectors = np.linalg.eigh(gram)
    columns, found = value.reshape(-1, value.shape[-1]), []
    for rank in _RANKS:
        kept = values > rank * values[-1]
        basis = scale[:, None] * vectors[:, kept] / np.sqrt(values[kept])
        rates, turn = np.linalg.eigh(basis.T @ pencil @ basis)
        # what round-off makes grow is no field of the body's
        real = rates > 0
        ports = (basis @ turn[:, real]).T @ columns
        found.append((rates[real], ports))
    return min(found, key=lambda network: _misfit(impedance, network[0], network[1], weight, moments))


def _misfit(
    impedance: np.ndarray, rates: np.ndarray, ports: np.ndarray, weight: np.ndarray, moments: np.ndarray
) -> float:
    """Largest error of the network between those of MOMENTS at which it has none, weighted (S,) W/K."""
    seen = slice(moments[0], moments[-1] + 1)
    reduced = ports.T @ (ports / (MOMENTS[seen, None, None] + rates[:, None]))
    return float(np.max(np.abs(reduced - impedance[seen]) * weight[seen, None, None]))
