"""What a fingertip on each patch of a body's network feels: the drop of its temperature. Of the studies of places."""

# pyright: reportAttributeAccessIssue=false

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from thermograsp import thermal
from thermograsp.thermal import SurfacePatch
from thermograsp.thermal.anywhere.ports import centred_tip
from thermograsp.thermal.meshes.film import held_apart
from thermograsp.thermal.meshes.network import PatchFields
from thermograsp.thermal.network import ThermalNetwork

CONDUCTANCES = 1e3, 1e4, 1e5  # W/(m2 K)
TIMES = 0.02 * np.arange(3, 300)  # s
DIFFERENCE = 12.0  # K
STACK = thermal.sensor("seed")
AREA = STACK.width**2
TIP = centred_tip(STACK, AREA)

Vector = tuple[float, float, float]


def at(centre: Vector, normal: Vector) -> SurfacePatch:
    """As large as the sensor's face."""
    return SurfacePatch(centre, normal, AREA)


class Worst(NamedTuple):
    """error: K of DIFFERENCE, with its sign, at time s and conductance W/(m2 K), the largest. drop: K there."""

    error: float
    drop: float
    time: float
    conductance: float


def drops(network: ThermalNetwork, conductance: float) -> np.ndarray:
    """(TIMES, patches) K: a fingertip on each of the network's patches from time 0 on."""
    side, patterns = TIP.side, TIP.side.ports.shape[1]
    fingertips, order = network.ports.shape[1] // patterns, len(network.rates)
    rates = np.concatenate([network.rates, *[side.rates] * fingertips])
    ports, rows = np.zeros((len(rates), network.ports.shape[1])), np.zeros((fingertips, len(rates)))
    ports[:order] = network.ports
    for tip in range(fingertips):
        own = slice(order + tip * len(side.rates), order + (tip + 1) * len(side.rates))
        ports[own, tip * patterns : (tip + 1) * patterns] = -side.ports
        rows[tip, own] = side.outputs["drop"]
    matrix = np.diag(rates) + conductance * AREA * ports @ ports.T
    drive = conductance * AREA * DIFFERENCE * ports[:, ::patterns].sum(axis=1)
    fades, turn = np.linalg.eigh(matrix)
    fades = np.maximum(fades, 1e-14)
    return -np.expm1(-np.outer(TIMES, fades)) / fades * (turn.T @ drive) @ (rows @ turn).T


def largest(told: ThermalNetwork, tip: int, expected: ThermalNetwork) -> Worst:
    """Of the error of one of the fingertips' drops at CONDUCTANCES, beside that of the last of another network's."""
    found = Worst(0.0, 0.0, 0.0, 0.0)
    for conductance in CONDUCTANCES:
        drop = drops(expected, conductance)[:, -1]
        error = drops(told, conductance)[:, tip] - drop
        most = int(np.abs(error).argmax())
        if abs(error[most]) > abs(found.error):
            found = Worst(float(error[most]), float(drop[most]), float(TIMES[most]), conductance)
    return found


def on_grid(fields: PatchFields) -> ThermalNetwork:
    """Of a grid that is fine at its patches."""
    return ThermalNetwork(fields.rates, fields.ports, np.zeros((fields.ports.shape[1],) * 2))


def held(network: ThermalNetwork, film: float) -> ThermalNetwork:
    """With its contents held at one temperature. film: W/K."""
    rates, turn = held_apart(network, film)
    return ThermalNetwork(rates, turn.T @ network.ports, network.direct)
