"""Heat of grasps with several objects in reach: a row of heat for each, fingertips that go from one to another.

Object o of environment i has row O i + o. A fingertip belongs to the object that it touches or touched last; there its
field is advanced, and it is carried over when the fingertip touches another one, sample by sample. One that touches
several belongs to the one that it presses hardest; the other contacts carry no heat.

B: environments, O: objects, F = 2 fingertips, S: substeps, N: heat samples of a control step.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any, NamedTuple

import numpy as np

from ...thermal.batch import LEAST_STATES
from ..footprint import GraspBody
from .heat import GraspHeat, HeatState, HeatStep
from .rows import heat_info

_OF_FINGERTIPS = ("conductance", "area", "sensor_surface", "object_surface", "flow", "drawn")
_SUMMED = ("air_loss", "reservoir_flow", "imbalance", "exchanged")
_OF_OBJECT = ("object_temperature", "reservoir_temperature")


@dataclass(frozen=True, slots=True)
class SceneHeatState:
    """Everything that the heat of some environments remembers; picklable. owner: (n, F) each fingertip's object."""

    rows: HeatState
    owner: np.ndarray


class SceneHeatStep(NamedTuple):
    """One control step. fingertips: what a HeatStep tells, of each fingertip and the object that it belongs to; the
    objects' heat, air loss and books are sums over all, object and reservoir temperature are the left fingertip's
    object's. objects: (B, O) HEAT_INFO, as each object's row tells. owner: (B, F) the object that each fingertip
    touches or touched last."""

    fingertips: HeatStep
    objects: np.ndarray
    owner: np.ndarray


class SceneHeat:
    """The thermal side of `num_envs` grasps with so many objects each, in T mode. Keywords as GraspHeat's."""

    def __init__(self, num_envs: int, objects: int, **settings: Any) -> None:
        self._objects: int = objects
        self._samples: int = settings["samples"]
        self._rows = GraspHeat(objects * num_envs, least_sensor_states=LEAST_STATES, **settings)
        self._owner = np.zeros((num_envs, 2), int)
        self._tips: int = 2

    def reset(
        self,
        rows: Sequence[int],
        scenes: Sequence[Sequence[GraspBody]],
        sensor_temperatures: np.ndarray,
        *,
        waiting: bool = False,
    ) -> None:
        """The rows start with new objects, O each. sensor_temperatures: (n, F) °C of the thermostats. waiting: networks
        of all but the first are made when they are touched."""
        bodies = [body for scene in scenes for body in scene]
        every = self._of(rows)
        later = [row for row in every if waiting and row % self._objects]
        temperatures = np.repeat(sensor_temperatures, self._objects, axis=0)
        self._rows.reset(every, bodies, temperatures, waiting=later)
        self._owner[list(rows)] = 0
        self._tips = bodies[0].fingertips

    def rung(self, row: int) -> tuple[str, ...]:
        """The model that computes each object's heat."""
        return tuple(self._rows.rung(each) for each in self._of([row]))

    def advance(self, force: np.ndarray, place: np.ndarray) -> SceneHeatStep:
        """One control step. force: (B, O, S, F) N, normal, of each substep, 0 where apart. place: (B, O, F, 3) m, the
        sensor faces' middles in each object's frame at the end of the step."""
        count, substeps = self._objects, force.shape[2]
        owners, carried = self._owners(force)
        # A substep in which two samples meet counts for an object that owns both.
        begins, ends = np.arange(substeps), np.arange(substeps) + 1
        begins, ends = begins * self._samples // substeps, (ends * self._samples - 1) // substeps
        number = np.arange(count)[:, None, None]
        owned = (owners[:, None, begins] == number) & (owners[:, None, ends] == number)
        self._owner = owners[:, -1]
        total = count * len(force)
        step = self._rows.advance(
            np.where(owned, force, 0.0).reshape(total, *force.shape[2:]),
            place.reshape(total, *place.shape[2:]),
            carried,
        )
        return self._joined_step(step, owners)

    def _owners(self, force: np.ndarray) -> tuple[np.ndarray, list[tuple[int, int, int, int]]]:
        """(B, N, F), of each sample, and what is carried: GraspHeat.advance's."""
        count, samples, substeps = self._objects, self._samples, force.shape[2]
        owners, carried = np.empty((len(force), samples, 2), int), []
        last = self._owner
        for k in range(samples):
            most = force[:, :, k * substeps // samples : -(-(k + 1) * substeps // samples)].max(axis=2)
            owners[:, k] = now = np.where(most.max(axis=1) > 0, most.argmax(axis=1), last)
            for row, tip in np.argwhere(now[:, : self._tips] != last[:, : self._tips]).tolist():
                carried.append((k, count * row + int(last[row, tip]), count * row + int(now[row, tip]), tip))
            last = now
        return owners, carried

    def rest(self) -> SceneHeatStep:
        """What a step would tell of a batch in which nothing has touched yet."""
        return self._joined_step(self._rows.rest(), self._owner[:, None])

    def set_thermostats(self, celsius: np.ndarray) -> None:
        """Temperatures (B, F) °C of the thermostats from now on."""
        self._rows.set_thermostats(np.repeat(celsius, self._objects, axis=0))

    def state(self, rows: Sequence[int]) -> SceneHeatState:
        """A copy of what the rows remember."""
        return SceneHeatState(self._rows.state(self._of(rows)), self._owner[list(rows)])

    def set_state(self, rows: Sequence[int], state: SceneHeatState) -> None:
        """Puts the rows into a state taken by `state`."""
        self._rows.set_state(self._of(rows), state.rows)
        self._owner[list(rows)] = state.owner
        self._tips = state.rows.bodies[0].fingertips

    @property
    def sensor_temperatures(self) -> np.ndarray:
        """(B, F) °C of the thermostats at the start."""
        return self._rows.sensor_temperatures[:: self._objects]

    def _joined_step(self, step: HeatStep, owners: np.ndarray) -> SceneHeatStep:
        """owners: (B, N or 1, F) of each sample."""
        objects = step.info.reshape(-1, self._objects)
        info = of_fingertips(objects, self._owner)
        drop = step.drop.reshape(len(objects), self._objects, *step.drop.shape[1:])
        chosen = np.broadcast_to(owners[:, None], (len(objects), 1, *drop.shape[2:]))
        return SceneHeatStep(
            HeatStep(np.take_along_axis(drop, chosen, axis=1)[:, 0], info), objects, self._owner
        )

    def _of(self, rows: Sequence[int]) -> list[int]:
        return [self._objects * row + number for row in rows for number in range(self._objects)]


def of_fingertips(objects: np.ndarray, owner: np.ndarray) -> np.ndarray:
    """(B,) HEAT_INFO of the fingertips, from that of each object (B, O) and each fingertip's own, (B, F) numbers."""

    def picked(values: np.ndarray) -> np.ndarray:
        """(B, F) of each fingertip's own object from (B, O, F)."""
        return np.take_along_axis(values, owner[:, None], axis=1)[:, 0]

    info = heat_info(len(objects))
    for name in _OF_FINGERTIPS:
        info[name] = picked(objects[name])
    # What flowed into an object that is not the fingertip's own, such as one that it left within the step.
    left = objects["flow"].sum(axis=1) - info["flow"]
    info["flow"] += left
    info["drawn"] += left
    info["heat"][:, :2] = picked(objects["heat"][:, :, :2])
    for number in range(objects.shape[1]):
        info["heat"][:, 2] += objects["heat"][:, number, 2]
        for name in _SUMMED:
            info[name] += objects[name][:, number]
        info["events"] |= objects["events"][:, number]
    for name in _OF_OBJECT:
        info[name] = picked(np.repeat(objects[name][..., None], 2, axis=2))[:, 0]
    return info
