"""What only a simulation knows of a control step, worked out when it is asked for.

B: environments, F = 2 fingertips, N: heat samples.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np

from .heat import HeatStep
from .heat_rows import EVENTS

TOLD = ("material", "temperature_drop", "contact_area", "conductance", "rung", "events")
"""What info tells at every step."""


@dataclass(frozen=True, slots=True)
class Episodes:
    """What stays as it is through each environment's episode; arrays are not written to later. mode: T or O. material,
    rung (B,) names. crushing_force (B,) N. randomized: (B,) by name of what differs between episodes.
    heaters: whether the thermostats have some, which go off when they are too hot."""

    mode: str
    material: np.ndarray
    rung: np.ndarray
    crushing_force: np.ndarray
    randomized: dict[str, np.ndarray]
    heaters: bool = False


@dataclass(slots=True, eq=False)
class Truth(Mapping[str, Any]):
    """A mapping name -> (B, ...); see HeatStep for what heat tells. lift (B,) m: the object above where it lay. error:
    (B,) why an environment broke down. Nothing writes to one; that it could costs every step half as much."""

    heat: HeatStep
    episodes: Episodes
    lift: np.ndarray
    error: tuple[str, ...]

    def __getitem__(self, name: str) -> Any:
        return _VALUES[name](self)

    def told(self, row: int) -> dict[str, Any]:
        """What info tells of one environment. Written out: name by name takes twice as long."""
        heat, episodes = self.heat.told[row], self.episodes
        told = {
            "material": episodes.material[row],
            "temperature_drop": self.heat.drop[row, -1],
            "contact_area": heat["area"],
            "conductance": heat["conductance"],
            "rung": episodes.rung[row],
            "events": EVENTS.item(*heat["events"].tolist()),
        }
        if episodes.heaters:
            told["over_temperature"] = bool(heat["over_temperature"])
        if episodes.randomized:
            told["randomized"] = {name: float(values[row]) for name, values in episodes.randomized.items()}
        return told

    def __contains__(self, name: object) -> bool:
        return name in _VALUES

    def __iter__(self) -> Iterator[str]:
        return iter(_VALUES)

    def __len__(self) -> int:
        return len(_VALUES)


def _told(name: str) -> Callable[[Truth], np.ndarray]:
    return lambda truth: truth.heat.told[name]


_VALUES: dict[str, Callable[[Truth], Any]] = {
    "mode": lambda truth: truth.episodes.mode,
    "material": lambda truth: truth.episodes.material,
    "temperature_drop": lambda truth: truth.heat.drop[:, -1],
    "temperature_drops": lambda truth: truth.heat.drop,
    "contact_area": _told("area"),
    "conductance": _told("conductance"),
    "sensor_surface": _told("sensor_surface"),
    "object_surface": _told("object_surface"),
    "object_temperature": _told("object_temperature"),
    "heat_flow": _told("flow"),
    "heat_drawn": _told("drawn"),
    "heat": _told("heat"),
    "heat_imbalance": _told("imbalance"),
    "heat_exchanged": _told("exchanged"),
    "reservoir_temperature": _told("reservoir_temperature"),
    "over_temperature": _told("over_temperature"),
    "events": lambda truth: truth.heat.events,
    "rung": lambda truth: truth.episodes.rung,
    "lift": lambda truth: truth.lift,
    "crushing_force": lambda truth: truth.episodes.crushing_force,
    "randomized": lambda truth: truth.episodes.randomized,
    "failed": lambda truth: np.array([bool(reason) for reason in truth.error]),
}
