"""Teachers that an agent imitates at first: scripts that act on observations, but get the truth where a script would
have to judge the voltage. Only training uses them, and they act every REPEAT control steps.

B: environments.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from typing import Any, Protocol

import numpy as np

from thermograsp.agents.scripted import FeelingGrasp
from thermograsp.agents.scripted_sort import GOING, PRESSING, ScriptedSort
from thermograsp.envs import force_window
from thermograsp.envs.limits import MAX_FORCE, MAX_LIFT_RATE, MAX_OPENING

from .inputs import REPEAT

_CLOSING = 0.9 * MAX_OPENING  # m, below which fingers close on what is between them
_BESIDE = 0.006  # m beside an object's place, where they hold it as well
_SINKING = 0.1  # s, time constant of an arm that goes down
_LEFT = 0.01  # m beside an object's place, from which the arm has left it


class Teacher(Protocol):
    """Actions (B, n) for observations (B, ...), and rows that begin a new episode."""

    def restart(self, rows: np.ndarray) -> None:
        """The rows begin a new episode."""
        ...

    def action(self, observation: dict[str, np.ndarray]) -> np.ndarray:
        """What is right to do now."""
        ...


class GraspTeacher(FeelingGrasp):
    """Closes gently, and uses more force for an object that needs it."""

    def __init__(self, batch: Any) -> None:
        super().__init__(batch.num_envs, batch.dt * REPEAT)
        self._plant = batch.plant

    def _heavy(self, observation: dict[str, np.ndarray]) -> np.ndarray:
        del observation
        return np.array([force_window(body)[0] > self._gentle for body in self._plant.bodies])


class IdentifyTeacher:
    """Closes, and declares what the object is when both fingertips have pressed for long enough."""

    _share = 0.25  # of the gripper's largest force
    _feeling = 0.8  # s

    def __init__(self, batch: Any) -> None:
        self._batch, self._dt = batch, batch.dt * REPEAT
        self._pressed = np.zeros(batch.num_envs)  # s without a break

    def restart(self, rows: np.ndarray) -> None:
        """The rows begin a new episode."""
        self._pressed[rows] = 0.0

    def action(self, observation: dict[str, np.ndarray]) -> np.ndarray:
        """(B, 2 + K)."""
        classes = self._batch.task.classes
        pressing = np.all(observation["force"][:, :, 0] > self._share * MAX_FORCE / 2, axis=1)
        self._pressed = np.where(pressing, self._pressed + self._dt, 0.0)
        action = np.full((len(pressing), 2 + len(classes)), -1.0, np.float32)
        action[:, 0] = self._share
        action[self._pressed >= self._feeling, 1] = 1.0
        for row, name in enumerate(self._batch.reading.truth["material"]):
            action[row, 2 + classes.index(name)] = 1.0
        return action


class SortTeacher(ScriptedSort):
    """Feels as the script does, and then lifts the right one."""

    feeling = 0.5

    def __init__(self, batch: Any) -> None:
        super().__init__(batch)
        self._batch, self._dt = batch, batch.dt * REPEAT

    def action(self, observation: dict[str, np.ndarray]) -> np.ndarray:
        """As the script's, but goes back to its object where the agent has left it, is content where the agent closes a
        few millimetres beside its place, and lowers the arm where the agent has raised open fingers."""
        away = abs(self._places[self._side] - observation["lateral"][:, 0])
        opening, height = observation["gripper"][:, 0], observation["gripper"][:, 2]
        self._phase[away > _LEFT] = GOING
        self._phase[(self._phase == GOING) & (away < _BESIDE) & (opening < _CLOSING)] = PRESSING
        action = super().action(observation)
        sinking = np.clip(-height / _SINKING, -MAX_LIFT_RATE, 0.0) / MAX_LIFT_RATE
        action[:, 2] = np.where(self._phase == GOING, sinking, action[:, 2])
        return action

    def _wanted(self, row: int, goal: np.ndarray) -> bool:
        del goal
        measured = ~np.isnan(self._voltages[row])
        enough = (
            measured.all() if self._batch.plant.layout.pair.goal == "hotter" else measured[self._side[row]]
        )
        return bool(enough) and self._side[row] == self._batch.reading.truth["right"][row]


TEACHERS: Mapping[str, Callable[[Any], Teacher]] = {
    "grasp": GraspTeacher,
    "identify": IdentifyTeacher,
    "sort": SortTeacher,
    "hotter": SortTeacher,
}
"""By task; each takes the environment's batch."""
