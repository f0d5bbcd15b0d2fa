"""The grasp environments' common core: a batch of them over one plant. One environment is a batch of one.

B: environments.
"""

from __future__ import annotations

import copy
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import gymnasium
import numpy as np

from thermograsp.errors import InvalidValueError
from thermograsp.plant import Command, Plant, Reading, merged, plant_factory

from .mechanics import MAX_FORCE, MAX_LIFT_RATE
from .observation import Observation, Observer, observation_space
from .scene import MAX_OPENING
from .tasks import GraspTask, Outcome, TaskState, fresh, judge

_EVERY_STEP = ("material", "temperature_drop", "contact_area", "conductance", "rung", "events")


def action_space() -> gymnasium.spaces.Box:
    """Target opening 0 .. 85 mm, force limit 0 .. 40 N, lift rate -50 .. 50 mm/s, each scaled to -1 .. 1."""
    return gymnasium.spaces.Box(-1.0, 1.0, (3,), np.float32)


def command_of(action: np.ndarray) -> Command:
    """Commands of actions (B, 3), clipped to -1 .. 1. Raises InvalidValueError for a wrong shape or a value that is not
    finite."""
    array = np.asarray(action, dtype=float)
    if array.ndim != 2 or array.shape[1] != 3:
        raise InvalidValueError(
            f"an action is (3,): opening, force limit, lift rate, each -1 .. 1; got shape {np.shape(action)[1:]}"
        )
    if not np.isfinite(array).all():
        row = int(np.argmax(~np.isfinite(array).all(axis=1)))
        raise InvalidValueError(
            f"action {array[row]} of environment {row} is not finite: give numbers in -1 .. 1"
        )
    array = np.clip(array, -1.0, 1.0)
    return Command(
        (array[:, 0] + 1) / 2 * MAX_OPENING, (array[:, 1] + 1) / 2 * MAX_FORCE, array[:, 2] * MAX_LIFT_RATE
    )


def action_of(opening: float, force_limit: float, lift_rate: float) -> np.ndarray:
    """The action (3,) of a command in m, N and m/s."""
    scaled = (2 * opening / MAX_OPENING - 1, 2 * force_limit / MAX_FORCE - 1, lift_rate / MAX_LIFT_RATE)
    return np.array(scaled, np.float32)


@dataclass(frozen=True, slots=True)
class BatchState:
    """A whole batch in mid-episode; picklable."""

    plant: Any
    history: np.ndarray
    task: TaskState
    last: Observation
    reading: Reading | None


@dataclass(frozen=True, slots=True)
class Step:
    """observation: dict of (B, ...). reward (B,), terminated (B,), truncated (B,). infos: one dict per environment."""

    observation: Observation
    reward: np.ndarray
    terminated: np.ndarray
    truncated: np.ndarray
    infos: list[dict[str, Any]]


class GraspBatch:
    """`num_envs` grasp environments over a plant. task: what is judged. plant: "simulated" or a URL. Other keywords
    go to the plant (SimulationConfig)."""

    def __init__(
        self, num_envs: int = 1, *, plant: str = "simulated", task: GraspTask | None = None, **config: Any
    ) -> None:
        self.task = task or GraspTask()
        self.plant: Plant = plant_factory(plant)(plant, num_envs, **config)
        self.num_envs = num_envs
        self.observation_space = observation_space()
        self.action_space = action_space()
        self._observer = Observer(num_envs)
        self._judged = fresh(num_envs)
        self._idle = Command(np.full(num_envs, MAX_OPENING), np.zeros(num_envs), np.zeros(num_envs))
        self._last: Observation = {}
        self.reading: Reading | None = None

    @property
    def dt(self) -> float:
        """s, the control period."""
        return self.plant.dt

    def reset(
        self,
        rows: Sequence[int],
        rngs: Sequence[np.random.Generator],
        options: Mapping[str, Any] | None = None,
    ) -> tuple[Observation, list[dict[str, Any]]]:
        """Starts the rows anew, each with its generator; the observations are of all environments."""
        reading = self.plant.reset(rows, rngs, options or {})
        if self.reading is not None:
            reading = merged(self.reading, reading, rows)
        chosen = np.array(list(rows), int)
        self._observer.restart(chosen)
        for values in (self._judged.elapsed, self._judged.held, self._judged.lifted):
            values[chosen] = 0
        history = self._observer.history.copy()
        seen = self._observer.observe(reading, self._idle)
        # Only the rows that start have a new reading; the others keep what they last saw.
        self._observer.history = history
        if self._last:
            seen = {name: _where(chosen, value, self._last[name]) for name, value in seen.items()}
        self._last, self.reading = seen, reading
        return _copies(seen), self._infos(reading, None)

    def step(self, action: np.ndarray) -> Step:
        """One control step of all environments. action: (B, 3). An environment whose simulation broke down is
        truncated, the reason in info["error"], with its last finite observation."""
        command = command_of(action)
        reading = self.plant.step(command)
        broken = np.array([bool(error) for error in reading.error])
        seen = self._observer.observe(reading, command)
        if broken.any():
            seen = {
                name: _where(np.flatnonzero(~broken), value, self._last[name]) for name, value in seen.items()
            }
        lift = np.asarray(reading.truth.get("lift", reading.height), float)
        crushing = np.asarray(reading.truth.get("crushing_force", np.full(self.num_envs, np.inf)))
        self._judged, outcome = judge(
            self.task, self._judged, self.dt, reading.force[:, :, 0], lift, crushing
        )
        infos = self._infos(reading, outcome)
        for row in np.flatnonzero(broken):
            infos[row]["error"] = reading.error[row]
        self._last, self.reading = seen, reading
        return Step(
            _copies(seen),
            np.where(broken, 0.0, outcome.reward),
            outcome.terminated & ~broken,
            outcome.truncated | broken,
            infos,
        )

    def state(self) -> BatchState:
        """A copy of the whole batch in mid-episode. Raises InvalidValueError where the plant has no state to copy."""
        if not hasattr(self.plant, "state"):
            raise InvalidValueError("this plant's state can't be saved: it is not simulated")
        plant: Any = self.plant
        rows = range(self.num_envs)
        return copy.deepcopy(
            BatchState(plant.state(rows), self._observer.history, self._judged, self._last, self.reading)
        )

    def set_state(self, state: BatchState) -> tuple[np.random.Generator, ...]:
        """Puts the batch into a state: what follows is bit-identical to what followed it first. Returns the
        generators."""
        state = copy.deepcopy(state)
        plant: Any = self.plant
        rngs = plant.set_state(range(self.num_envs), state.plant)
        self._observer.history, self._judged = state.history, state.task
        self._last, self.reading = state.last, state.reading
        return rngs

    def close(self) -> None:
        """Releases the plant."""
        self.plant.close()

    def _infos(self, reading: Reading, outcome: Outcome | None) -> list[dict[str, Any]]:
        infos: list[dict[str, Any]] = []
        for row in range(self.num_envs):
            info: dict[str, Any] = {"success": bool(outcome.success[row]) if outcome else False}
            if outcome and outcome.dropped[row]:
                info["dropped"] = True
            if outcome and outcome.crushed[row]:
                info["crushed"] = True
            for name in _EVERY_STEP:
                if name in reading.truth:
                    value = reading.truth[name][row]
                    info[name] = value.copy() if isinstance(value, np.ndarray) else value
            infos.append(info)
        return infos


def _where(rows: np.ndarray, new: np.ndarray, old: np.ndarray) -> np.ndarray:
    merged = old.copy()
    merged[rows] = new[rows]
    return merged


def _copies(observation: Observation) -> Observation:
    return {name: value.copy() for name, value in observation.items()}
