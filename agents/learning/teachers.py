"""Teachers that an agent imitates at first: scripts that act on observations, but get the truth where a script would
have to judge the voltage. Only training uses them, and they act every REPEAT control steps.

B: environments.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from typing import Any, Protocol

import numpy as np

from thermograsp.agents.scripted import FeelingGrasp
from thermograsp.agents.scripted_sort import GOING, PRESSING, ScriptedSort
from thermograsp.envs import force_window
from thermograsp.envs.limits import MAX_FORCE, MAX_LIFT_RATE, MAX_OPENING
from thermograsp.envs.tasks import DECLARES

from .inputs import REPEAT

_CLOSING = 0.9 * MAX_OPENING  # m, below which fingers close on what is between them
_BESIDE = 0.006  # m beside an object's place, where they hold it as well
_SINKING = 0.1  # s, time constant of an arm that goes down
_LEFT = 0.01  # m beside an object's place, from which the arm has left it


class Teacher(Protocol):
    """Actions (B, n) for observations (B, ...), and rows that begin a new episode. averaged: those numbers of an action
    of which an agent that cannot tell learns the mean of the answers, as a probability; of the others, movements, it
    learns what is right more often than not, for there is nothing to be gained between two of them."""

    averaged: slice

    def restart(self, rows: np.ndarray) -> None:
        """The rows begin a new episode."""
        ...

    def action(self, observation: dict[str, np.ndarray], learner: np.ndarray | None = None) -> np.ndarray:
        """What is right to do now; nan where the teacher has no opinion yet. learner: (B, n) what the agent would do;
        None while there is none."""
        ...


class GraspTeacher(FeelingGrasp):
    """Closes with little force until something touches, for heavy fingers would hit it with more than they press with.
    Then gently, and firmly on an object that needs it and bears it, also while one fingertip has to push it."""

    averaged = slice(0)
    _closing, _touch_force = 2.0, 0.5  # N, until something touches, and what a touch gives at least
    _settling_time = 0.15  # s of touch, after which both fingers have come to rest
    _firm = 38.0  # N, near the gripper's 40: drawn metals need up to 57 N
    _known = 0.3  # s of touch, after which an agent can tell what it touches

    def __init__(self, batch: Any) -> None:
        super().__init__(batch.num_envs, batch.dt * REPEAT)
        self._plant = batch.plant
        self._touched = np.zeros(batch.num_envs)  # s without a break

    def restart(self, rows: Sequence[int] | np.ndarray) -> None:
        """The rows begin a new episode."""
        super().restart(rows)
        self._force[rows] = self._closing
        self._touched[rows] = 0.0

    def action(self, observation: dict[str, np.ndarray], learner: np.ndarray | None = None) -> np.ndarray:
        """As the script's, but firm as soon as an object that needs it has been touched for long enough."""
        touching = np.any(observation["force"][:, :, 0] > self._touch_force, axis=1)
        self._touched = np.where(touching, self._touched + self._dt, 0.0)
        firm = (self._touched > self._known) & self._heavy(observation)
        settled = np.where(
            self._touched > self._settling_time, np.maximum(self._force, self._gentle), self._force
        )
        self._force = np.where(firm, self._firm, settled)
        return super().action(observation)

    def _decide(self, observation: dict[str, np.ndarray], rows: np.ndarray) -> None:
        pass  # the force is settled before

    def _heavy(self, observation: dict[str, np.ndarray]) -> np.ndarray:
        del observation
        windows = np.array([force_window(body) for body in self._plant.bodies])
        return (windows[:, 0] > self._gentle) & (windows[:, 1] > self._firm)


class IdentifyTeacher:
    """Closes, names what the object is, and would declare it wherever the agent names it, too.

    An agent that regresses to this learns how probably it is right, and so when to stop: where that probability is
    _SURE, the mean of the teacher's answers is DECLARES, from which on an agent declares."""

    averaged = slice(1, None)
    _share = 0.25  # of the gripper's largest force
    _SURE = 0.97
    _YES = (1.0 + DECLARES) / _SURE - 1.0  # its answer where the agent is right; -1 where it is wrong
    _late = 0.3  # s before the end, from where on any answer is better than none

    def __init__(self, batch: Any) -> None:
        self._batch, self._dt = batch, batch.dt * REPEAT
        self._elapsed = np.zeros(batch.num_envs)  # s

    def restart(self, rows: np.ndarray) -> None:
        """The rows begin a new episode."""
        self._elapsed[rows] = 0.0

    def action(self, observation: dict[str, np.ndarray], learner: np.ndarray | None = None) -> np.ndarray:
        """(B, 2 + K). Without an agent it has no opinion about declaring."""
        classes = self._batch.task.classes
        true = np.array([classes.index(name) for name in self._batch.reading.truth["material"]])
        action = np.full((len(true), 2 + len(classes)), -1.0, np.float32)
        action[:, 0] = self._share
        action[np.arange(len(true)), 2 + true] = 1.0
        if learner is None:
            action[:, 1] = np.nan
        else:
            pressing = np.all(observation["force"][:, :, 0] > self._share * MAX_FORCE / 2, axis=1)
            right = pressing & (learner[:, 2:].argmax(axis=1) == true)
            action[:, 1] = np.where(right, self._YES, -1.0)
        self._elapsed += self._dt
        action[self._elapsed > self._batch.task.seconds - self._late, 1] = 1.0
        return action


class SortTeacher(ScriptedSort):
    """Feels as the script does, and then lifts the right one."""

    averaged = slice(0)

    def __init__(self, batch: Any) -> None:
        super().__init__(batch)
        # Materials take longer to tell apart than temperatures, for which both objects are touched, one maybe twice.
        self.feeling = 1.5 if batch.plant.layout.pair.goal == "material" else 0.5
        self._batch, self._dt = batch, batch.dt * REPEAT

    def action(self, observation: dict[str, np.ndarray], learner: np.ndarray | None = None) -> np.ndarray:
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
