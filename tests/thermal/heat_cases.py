"""Batches of grasps that tests of the array step share: mixed networks, histories, and the kernel's answer."""

from __future__ import annotations

from collections.abc import Iterator
from functools import cache
from typing import Any, Literal

import numpy as np

from thermograsp.thermal import (
    Geometry,
    HeatReading,
    HeatTables,
    Orders,
    advance_heat,
    heat_tables,
    network_of,
)
from thermograsp.thermal.matter.materials import material
from thermograsp.thermal.matter.mounting import Mode
from thermograsp.thermal.matter.sensors import sensor

DT = 0.01  # s
AREA = 6e-5  # m2
SIZE = (0.04, 0.03, 0.01)  # m
ORDERS = {  # of three networks with 1, 2 and 3 ports a contact
    ("T", 1): ("1/5/6", "2/6/8", "3/7/9"),
    ("T", 2): ("1/5/6/5", "2/6/8/6", "3/7/9/7"),
    ("O", 1): ("1/0/7", "2/0/9", "3/0/11"),
    ("O", 2): ("1/0/7/6", "2/0/9/8", "3/0/11/9"),
}
CASES = list(ORDERS)
Case = tuple[Mode, Literal[1, 2]]


@cache
def tables_of(case: Case) -> HeatTables:
    """Aluminium, glass and cork, in air of 0, 5 and 10 W/(m2 K)."""
    mode, fingertips = case
    systems = [
        network_of(
            Geometry(sensor("seed"), material(name), mode, AREA, "square", SIZE, fingertips),
            Orders.parse(orders),
        )
        for name, orders in zip(("aluminium", "glass", "cork"), ORDERS[case], strict=True)
    ]
    return heat_tables(systems, [0.0, 5.0, 10.0], DT)


class Batch:
    """`rows` grasps, drawn at random: network (B,), difference (B, F) K and, step by step, conductances (B, F) W/K from
    1e-3 W/K to `largest` W/(m2 K) times AREA, a third of them 0."""

    def __init__(self, case: Case, rows: int, largest: float = 1e5) -> None:
        self.tables = tables_of(case)
        self._rng = np.random.default_rng(0)
        self._shape, self._largest = (rows, case[1]), np.log10(largest * AREA)
        self.network = self._rng.integers(0, 3, rows)
        self.difference = self._rng.uniform(-20.0, 20.0, self._shape)
        self.state = np.zeros((rows, self.tables.rates.shape[1]))

    def conductance(self) -> np.ndarray:
        """The next step's."""
        touching = self._rng.random(self._shape) > 1 / 3
        return touching * 10 ** self._rng.uniform(-3, self._largest, self._shape)

    def steps(self, count: int) -> Iterator[tuple[np.ndarray, np.ndarray, HeatReading]]:
        """Conductance of each step, and the compiled kernel's state and reading after it."""
        active = np.ones(len(self.state), bool)
        for _ in range(count):
            conductance = self.conductance()
            self.state, reading = advance_heat(
                self.tables, self.network, self.state, conductance, self.difference, active, 1
            )
            yield conductance, self.state, HeatReading(*(values[:, 0] for values in reading))


def difference_between(
    state: Any, reading: HeatReading, expected_state: np.ndarray, expected: HeatReading
) -> float:
    """The largest difference of any quantity relative to that quantity's largest value in the batch."""
    pairs = [(state, expected_state), *zip(reading, expected, strict=True)]
    return max(
        float(np.max(np.abs(np.asarray(found, dtype=float) - right)) / max(np.max(np.abs(right)), 1e-300))
        for found, right in pairs
    )
