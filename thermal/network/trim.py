"""Networks of two bodies in contact cut down to the states and patterns that one demand needs.

Each body is projected on the states that its contacts excite (states.py): passive, whatever is left out. How many are
kept follows from the drop itself, beside the network that nothing was left out of: a bisection and a few steps down
from there, some tens of small eigenproblems.

F: fingertips, P: patterns of one, S: moments.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np

from ..numerics import ThermalNetwork
from ..plates import Geometry
from .choice import Demand, drops, even_ports, port_weights
from .states import MOMENTS, StateBasis, excited_states
from .system import ContactSystem

_CUTS = np.geomspace(0.3, 1e-8, 33)  # of a state's weight beside the largest
_SENSOR = 4.0  # times as little is cut off fingertips, whose states are the drop

_UNTOUCHED = 1e4  # W/(m2 K), for whose flows states are kept where nothing conducts

_LEAST = 1e-9  # of the face's conductance, that of a pad which does not touch

Join = Callable[[ThermalNetwork, ThermalNetwork, int], ContactSystem]
"""The system of a fingertip's network and the object's, of so many patterns a contact."""


@dataclass(frozen=True, slots=True)
class _Bodies:
    """Both sides of the contacts on their first patterns, and the bases of their states."""

    sensor: ThermalNetwork
    box: ThermalNetwork
    bases: tuple[StateBasis, StateBasis]


def trimmed(
    geometry: Geometry, sensor: ThermalNetwork, box: ThermalNetwork, demand: Demand, within: float, join: Join
) -> tuple[ContactSystem, float]:
    """The cheapest system found that is within K of the whole one, and how far it is off."""
    patterns = sensor.ports.shape[1]
    whole = _together(_part(sensor, np.eye(sensor.order)), _part(box, np.eye(box.order)), geometry.fingertips)
    exact = drops(*whole, geometry, demand)
    best, least = join(sensor, box, patterns), 0.0
    for count in range(1, patterns + 1):
        bodies = _on_first(geometry, sensor, box, count, demand)
        found = _cheapest(geometry, bodies, demand, exact, within)
        if found is None:
            continue
        vectors, error = found
        parts = [
            body.projected(basis) for body, basis in zip((bodies.sensor, bodies.box), vectors, strict=True)
        ]
        system = join(parts[0], parts[1], count)
        if system.orders.multiply_adds >= best.orders.multiply_adds:
            break
        best, least = system, error
    return best, least


class _Part(NamedTuple):
    """A body on its own eigenstates: rates (K,) 1/s, ports (K, M), and the drop's row (K,), zeros of an object."""

    rates: np.ndarray
    ports: np.ndarray
    drop: np.ndarray


def _part(network: ThermalNetwork, basis: np.ndarray) -> _Part:
    """The body on those orthonormal states (n, K)."""
    rates, turn = np.linalg.eigh((basis.T * network.rates) @ basis)
    on = basis @ turn
    drop = network.outputs["drop"] @ on if "drop" in network.outputs else np.zeros(len(rates))
    return _Part(rates, on.T @ network.ports, drop)


def _together(sensor: _Part, box: _Part, fingertips: int) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Rates, ports and the first fingertip's drop of the whole."""
    first, count = len(box.rates), len(sensor.rates)
    total = np.zeros((first + fingertips * count, box.ports.shape[1]))
    total[:first] = box.ports
    each = sensor.ports.shape[1]
    for f in range(fingertips):
        total[first + f * count : first + (f + 1) * count, f * each : (f + 1) * each] = -sensor.ports
    row = np.zeros(len(total))
    row[first : first + count] = sensor.drop
    return np.concatenate((box.rates, np.tile(sensor.rates, fingertips))), total, row


def _on_first(
    geometry: Geometry, sensor: ThermalNetwork, box: ThermalNetwork, count: int, demand: Demand
) -> _Bodies:
    fingertips = geometry.fingertips
    columns = np.arange(box.ports.shape[1]).reshape(fingertips, -1)[:, :count].ravel()
    sensor = ThermalNetwork(
        sensor.rates, sensor.ports[:, :count], sensor.direct[:count, :count], sensor.outputs
    )
    box = ThermalNetwork(box.rates, box.ports[:, columns], box.direct[np.ix_(columns, columns)], box.outputs)
    across, through = sensor.impedance(MOMENTS), box.impedance(MOMENTS)
    all_tips, one_tip = [], []
    even = np.tile(even_ports(geometry, count), fingertips)
    for h in [each for each in demand.conductances if each > 0] or [_UNTOUCHED]:
        weights = port_weights(geometry, count, h, demand.beside)
        tip_side = across + np.diag(1 / np.maximum(weights, _LEAST * weights[0]))
        one = through[:, :count, :count] + tip_side
        flow = np.zeros((len(MOMENTS), fingertips * count))
        flow[:, :count] = np.linalg.solve(one, even[:count, None])[..., 0]
        one_tip.append(flow)
        if fingertips > 1:
            both = through.copy()
            for f in range(fingertips):
                tip = slice(f * count, (f + 1) * count)
                both[:, tip, tip] += tip_side
            all_tips.append(np.linalg.solve(both, even[:, None])[..., 0])
    flows = np.array(one_tip + all_tips)
    of_sensor = flows[:, :, :count]
    return _Bodies(
        sensor, box, (_led_by_uniform("element", sensor, of_sensor), _led_by_uniform("object", box, flows))
    )


def _led_by_uniform(name: str, network: ThermalNetwork, flows: np.ndarray) -> StateBasis:
    """A body that loses heat beyond its touch has its uniform field first, a free one has it as its still state. A
    thermostat that moves, or the air, moves that field: without it heat would come and go at once."""
    basis = excited_states(network, flows)
    if basis.still:
        return basis
    uniform = network.outputs[name] / np.linalg.norm(network.outputs[name])
    rest = basis.vectors - np.outer(uniform, uniform @ basis.vectors)
    vectors, _ = np.linalg.qr(np.column_stack((uniform, rest)))
    return StateBasis(vectors, np.concatenate(([np.inf], basis.weights)), 1)


def _cheapest(
    geometry: Geometry, bodies: _Bodies, demand: Demand, exact: np.ndarray, within: float
) -> tuple[tuple[np.ndarray, np.ndarray], float] | None:
    """The states to keep of either body, and how far the drop is off."""
    most = tuple(basis.vectors.shape[1] for basis in bodies.bases)
    fewest = tuple(basis.still + 1 for basis in bodies.bases)
    tried: dict[tuple[int, int], float] = {}
    parts: dict[tuple[int, int], _Part] = {}

    def kept(orders: tuple[int, int]) -> tuple[np.ndarray, np.ndarray]:
        sensor, box = (basis.vectors[:, :n] for basis, n in zip(bodies.bases, orders, strict=True))
        return sensor, box

    def at(orders: tuple[int, int]) -> float:
        if orders not in tried:
            both = zip((bodies.sensor, bodies.box), kept(orders), strict=True)
            for body, (network, basis) in enumerate(both):
                if (body, orders[body]) not in parts:
                    parts[body, orders[body]] = _part(network, basis)
            system = _together(parts[0, orders[0]], parts[1, orders[1]], geometry.fingertips)
            tried[orders] = float(np.abs(drops(*system, geometry, demand) - exact).max())
        return tried[orders]

    def cut_at(cut: float) -> tuple[int, int]:
        sensor, box = (
            min(max(int(np.sum(basis.weights > limit)), low), high)
            for basis, limit, low, high in zip(bodies.bases, (cut / _SENSOR, cut), fewest, most, strict=True)
        )
        return sensor, box

    if at((most[0], most[1])) > within:
        return None
    low, high = 0, len(_CUTS) - 1  # the last one that fails or 0, the first one that serves
    while high - low > 1:
        middle = (low + high) // 2
        if at(cut_at(_CUTS[middle])) > within:
            low = middle
        else:
            high = middle
    orders = cut_at(_CUTS[high])
    if at(orders) > within:
        orders = most[0], most[1]
    going = True
    while going:
        going = False
        for step in ((1, 0), (0, 1)):
            fewer = orders[0] - step[0], orders[1] - step[1]
            if fewer[0] >= fewest[0] and fewer[1] >= fewest[1] and at(fewer) <= within:
                orders, going = fewer, True
    return kept(orders), at(orders)
