"""The grasp environments' common core: a batch of them over one plant. One environment is a batch of one.

B: environments.
"""

from __future__ import annotations

import copy
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any, NamedTuple

import gymnasium
import numpy as np
from numba import njit

from thermograsp.errors import InvalidValueError
from thermograsp.plant import Command, Plant, Reading, merged, plant_factory

from .mechanics import MAX_FORCE, MAX_LIFT_RATE
from .observation import Observation, Observer, observation_space
from .scene import MAX_OPENING
from .tasks import GraspTask, Outcome, TaskState, fresh, judge, stopped

_ENDS = ("dropped", "crushed")
_EVERY_STEP = (
    "material", "temperature_drop", "contact_area", "conductance", "rung", "events", "unknown", "late",
)  # fmt: skip


def action_space() -> gymnasium.spaces.Box:
    """Target opening 0 .. 85 mm, force limit 0 .. 40 N, lift rate -50 .. 50 mm/s, each scaled to -1 .. 1."""
    return gymnasium.spaces.Box(-1.0, 1.0, (3,), np.float32)


def command_of(action: np.ndarray) -> Command:
    """Commands of actions (B, 3), clipped to -1 .. 1. Raises InvalidValueError for a wrong shape or a value that is not
    finite."""
    array = np.ascontiguousarray(action, dtype=float)
    if array.ndim != 2 or array.shape[1] != 3:
        raise InvalidValueError(
            f"an action is (3,): opening, force limit, lift rate, each -1 .. 1; got shape {np.shape(action)[1:]}"
        )
    command = Command(np.empty(len(array)), np.empty(len(array)), np.empty(len(array)))
    row = _scale(array, command.opening, command.force_limit, command.lift_rate)
    if row >= 0:
        raise InvalidValueError(
            f"action {array[row]} of environment {row} is not finite: give numbers in -1 .. 1"
        )
    return command


@njit(cache=True, error_model="numpy")
def _scale(action, opening, force_limit, lift_rate):
    """Fills the commands; returns the first row that is not finite, -1 where all are."""
    for b in range(len(action)):
        for i in range(3):
            if not np.isfinite(action[b, i]):
                return b
        opening[b] = (min(max(action[b, 0], -1.0), 1.0) + 1) / 2 * MAX_OPENING
        force_limit[b] = (min(max(action[b, 1], -1.0), 1.0) + 1) / 2 * MAX_FORCE
        lift_rate[b] = min(max(action[b, 2], -1.0), 1.0) * MAX_LIFT_RATE
    return -1


def action_of(opening: float, force_limit: float, lift_rate: float) -> np.ndarray:
    """The action (3,) of a command in m, N and m/s."""
    scaled = (2 * opening / MAX_OPENING - 1, 2 * force_limit / MAX_FORCE - 1, lift_rate / MAX_LIFT_RATE)
    return np.array(scaled, np.float32)


@dataclass(frozen=True, slots=True)
class BatchState:
    """A whole batch in mid-episode; picklable."""

    plant: Any
    history: np.ndarray
    last: tuple[np.ndarray, ...]
    task: TaskState
    reading: Reading | None


class Step(NamedTuple):
    """observation: dict of (B, ...). reward (B,), terminated (B,), truncated (B,). outcome says why an environment
    ended; reading is what it all follows from."""

    observation: Observation
    reward: np.ndarray
    terminated: np.ndarray
    truncated: np.ndarray
    outcome: Outcome
    reading: Reading

    def info(self, row: int) -> dict[str, Any]:
        """One environment's info."""
        return info_of(self.reading, self.outcome, row)

    @property
    def infos(self) -> list[dict[str, Any]]:
        """All of them."""
        return [self.info(row) for row in range(len(self.reward))]


def info_of(reading: Reading, outcome: Outcome | None, row: int) -> dict[str, Any]:
    """One environment's info after a step, or, without an outcome, after a reset."""
    info: dict[str, Any] = {"success": False}
    if outcome is not None:
        info["success"] = bool(outcome.success[row])
        for name in _ENDS:
            if getattr(outcome, name)[row]:
                info[name] = True
        if reading.error[row]:
            info["error"] = reading.error[row]
    for name in _EVERY_STEP:
        if name in reading.truth:
            value = reading.truth[name][row]
            info[name] = value.copy() if isinstance(value, np.ndarray) else value
    randomized = reading.truth.get("randomized")
    if randomized:
        info["randomized"] = {name: float(values[row]) for name, values in randomized.items()}
    return info


def infos_of(reading: Reading, outcome: Outcome | None, rows: np.ndarray) -> dict[str, Any]:
    """The same of the environments where `rows` (B,) is True, as a vector environment gives it: name -> (B, ...) and
    _name -> (B,), which rows have it."""
    infos: dict[str, Any] = {}

    def add(name: str, values: np.ndarray, have: np.ndarray) -> None:
        infos[name], infos["_" + name] = values, have

    add("success", outcome.success & rows if outcome else np.zeros(len(rows), bool), rows.copy())
    if outcome is not None:
        for name in _ENDS:
            ended = getattr(outcome, name) & rows
            if ended.any():
                add(name, ended, ended.copy())
        broken = np.array([bool(error) for error in reading.error]) & rows
        if broken.any():
            reasons = np.array([error or None for error in reading.error], object)
            reasons[~rows] = None
            add("error", reasons, broken)
    for name in _EVERY_STEP:
        if name in reading.truth:
            values = reading.truth[name].copy()
            if not rows.all():
                values[~rows] = None if values.dtype == object else 0
            add(name, values, rows.copy())
    randomized = reading.truth.get("randomized")
    if randomized:
        nested: dict[str, Any] = {}
        for name, values in randomized.items():
            nested[name], nested["_" + name] = np.where(rows, values, 0.0), rows.copy()
        infos["randomized"], infos["_randomized"] = nested, rows.copy()
    return infos


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
        self._all = np.ones(num_envs, bool)
        self._unbreakable = np.full(num_envs, np.inf)
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
    ) -> tuple[Observation, Reading]:
        """Starts the rows anew, each with its generator; observations and reading are of all environments."""
        reading = self.plant.reset(rows, rngs, options or {})
        if self.reading is not None:
            reading = merged(self.reading, reading, rows)
        chosen = np.zeros(self.num_envs, bool)
        chosen[list(rows)] = True
        self._observer.restart(chosen)
        for values in (self._judged.elapsed, self._judged.held, self._judged.lifted):
            values[chosen] = 0
        self.reading = reading
        return self._observer.observe(reading, np.zeros(self.num_envs), chosen), reading

    def step(self, action: np.ndarray) -> Step:
        """One control step of all environments. action: (B, 3). An environment whose simulation broke down is
        truncated, the reason in info["error"], with its last finite observation."""
        command = command_of(action)
        self.reading = reading = self.plant.step(command)
        running = self._all
        if any(reading.error):
            running = np.array([not error for error in reading.error])
        seen = self._observer.observe(reading, command.force_limit, running)
        lift = reading.truth["lift"] if "lift" in reading.truth else reading.height
        crushing = reading.truth["crushing_force"] if "crushing_force" in reading.truth else self._unbreakable
        self._judged, outcome = judge(self.task, self._judged, self.dt, reading.force, lift, crushing)
        if running is not self._all:
            outcome = stopped(outcome, ~running)
        return Step(seen, outcome.reward, outcome.terminated, outcome.truncated, outcome, reading)

    def state(self) -> BatchState:
        """A copy of the whole batch in mid-episode. Raises InvalidValueError where the plant has no state to copy."""
        if not hasattr(self.plant, "state"):
            raise InvalidValueError("this plant's state can't be saved: it is not simulated")
        plant: Any = self.plant
        rows = range(self.num_envs)
        return copy.deepcopy(
            BatchState(
                plant.state(rows), self._observer.history, self._observer.last, self._judged, self.reading
            )
        )

    def set_state(self, state: BatchState) -> tuple[np.random.Generator, ...]:
        """Puts the batch into a state: what follows is bit-identical to what followed it first. Returns the
        generators."""
        state = copy.deepcopy(state)
        plant: Any = self.plant
        rngs = plant.set_state(range(self.num_envs), state.plant)
        self._observer.history, self._observer.last = state.history, state.last
        self._judged, self.reading = state.task, state.reading
        return rngs

    def close(self) -> None:
        """Releases the plant."""
        self.plant.close()
