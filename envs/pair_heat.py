"""Heat of grasps with two objects in reach: a row of heat for each object, fingertips that go from one to the other.

Object o of environment i has row 2 i + o. A fingertip belongs to the object that it touches or touched last; there its
field is advanced, and it is carried over when the fingertip touches the other one. One that touches both belongs to
the one that it presses harder; the other contact carries no heat.

B: environments, O = 2 objects, F = 2 fingertips, S: substeps.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from ..thermal.carry import LEAST_STATES
from .heat import GraspHeat, HeatState, HeatStep
from .heat_rows import HEAT_TOLD
from .pair_config import OBJECTS
from .things import Thing

_OF_FINGERTIPS = ("conductance", "area", "sensor_surface", "object_surface", "flow", "drawn")
_SUMMED = ("air_loss", "imbalance", "exchanged")


@dataclass(frozen=True, slots=True)
class PairHeatState:
    """Everything that the heat of some environments remembers; picklable. owner: (n, F) each fingertip's object."""

    rows: HeatState
    owner: np.ndarray


@dataclass(frozen=True, slots=True)
class PairHeatStep:
    """One control step. fingertips: what a HeatStep tells, of each fingertip and the object that it belongs to; the
    object's heat, air loss and books are the sums over both, its object temperature is the left fingertip's object's.
    objects: (B, O) HEAT_TOLD, as each object's row tells."""

    fingertips: HeatStep
    objects: np.ndarray


class PairHeat:
    """The thermal side of `num_envs` grasps with two objects each, in T mode. Keywords as GraspHeat's."""

    def __init__(self, num_envs: int, **settings: Any) -> None:
        self._rows = GraspHeat(OBJECTS * num_envs, least_sensor_states=LEAST_STATES, **settings)
        self._owner = np.zeros((num_envs, 2), int)
        self._tips: int = 2

    def reset(
        self, rows: Sequence[int], pairs: Sequence[Sequence[Thing]], sensor_temperatures: np.ndarray
    ) -> None:
        """The rows start with new objects, O each. sensor_temperatures: (n, F) °C of the thermostats."""
        things = [thing for pair in pairs for thing in pair]
        self._rows.reset(_both(rows), things, np.repeat(sensor_temperatures, OBJECTS, axis=0))
        self._owner[list(rows)] = 0
        self._tips = things[0].fingertips

    def rung(self, row: int) -> tuple[str, ...]:
        """The model that computes each object's heat."""
        return tuple(self._rows.rung(OBJECTS * row + number) for number in range(OBJECTS))

    def advance(self, force: np.ndarray, place: np.ndarray) -> PairHeatStep:
        """One control step. force: (B, O, S, F) N, normal, of each substep, 0 where apart. place: (B, O, F, 3) m, the
        sensor faces' middles in each object's frame at the end of the step."""
        most = force.max(axis=2)
        touching, harder = most.max(axis=1) > 0, (most[:, 1] > most[:, 0]).astype(int)
        owner = np.where(touching, harder, self._owner)
        for row, tip in np.argwhere(owner[:, : self._tips] != self._owner[:, : self._tips]).tolist():
            self._rows.carry(OBJECTS * row + self._owner[row, tip], OBJECTS * row + owner[row, tip], tip)
        self._owner = owner
        own = owner[:, None, None, :] == np.arange(OBJECTS)[:, None, None]
        count = OBJECTS * len(force)
        step = self._rows.advance(
            np.where(own, force, 0.0).reshape(count, *force.shape[2:]), place.reshape(count, *place.shape[2:])
        )
        return self._told(step)

    def rest(self) -> PairHeatStep:
        """What a step would tell of a batch in which nothing has touched yet."""
        return self._told(self._rows.rest())

    def set_thermostats(self, celsius: np.ndarray) -> None:
        """Temperatures (B, F) °C of the thermostats from now on."""
        self._rows.set_thermostats(np.repeat(celsius, OBJECTS, axis=0))

    def state(self, rows: Sequence[int]) -> PairHeatState:
        """A copy of what the rows remember."""
        return PairHeatState(self._rows.state(_both(rows)), self._owner[list(rows)])

    def set_state(self, rows: Sequence[int], state: PairHeatState) -> None:
        """Puts the rows into a state taken by `state`."""
        self._rows.set_state(_both(rows), state.rows)
        self._owner[list(rows)] = state.owner
        self._tips = state.rows.things[0].fingertips

    @property
    def sensor_temperatures(self) -> np.ndarray:
        """(B, F) °C of the thermostats at the start."""
        return self._rows.sensor_temperatures[::OBJECTS]

    def _told(self, step: HeatStep) -> PairHeatStep:
        objects = step.told.reshape(-1, OBJECTS)
        told = np.zeros(len(objects), HEAT_TOLD)
        for name in _OF_FINGERTIPS:
            told[name] = self._picked(objects[name])
        told["heat"][:, :2] = self._picked(objects["heat"][:, :, :2])
        told["heat"][:, 2] = objects["heat"][:, 0, 2] + objects["heat"][:, 1, 2]
        for name in _SUMMED:
            told[name] = objects[name][:, 0] + objects[name][:, 1]
        told["events"] = objects["events"][:, 0] | objects["events"][:, 1]
        told["object_temperature"] = self._picked(
            np.repeat(objects["object_temperature"][..., None], 2, axis=2)
        )[:, 0]
        drop = self._picked(step.drop.reshape(-1, OBJECTS, *step.drop.shape[1:]))
        return PairHeatStep(HeatStep(drop, told), objects)

    def _picked(self, values: np.ndarray) -> np.ndarray:
        """(B, ..., F) of each fingertip's own object from (B, O, ..., F)."""
        owner = self._owner.reshape(len(values), *(1,) * (values.ndim - 3), 2)
        return np.where(owner == 0, values[:, 0], values[:, 1])


def _both(rows: Sequence[int]) -> list[int]:
    return [OBJECTS * row + number for row in rows for number in range(OBJECTS)]
