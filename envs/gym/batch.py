"""The grasp environments' common core: a batch of them over one plant. One environment is a batch of one.

B: environments.
"""

from __future__ import annotations

import copy
import math
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from typing import Any, NamedTuple

import gymnasium.error
import numpy as np

from thermograsp.errors import InvalidValueError, ThermograspError, whole_number
from thermograsp.plant import (
    Plant,
    Reading,
    merged,
    plant_factory,
)

from ..spaces import Observation, Observer
from ..tasks import GraspTask, Outcome, Task, stopped

_NOTHING = np.random.default_rng(0)  # what an environment that was never reset draws from
MAPS = ("taxels", "face_temperature")
"""Keywords that add a map of each fingertip to the observation."""


class ClosedEnvironmentError(ThermograspError, gymnasium.error.ClosedEnvironmentError):
    """An environment is used that has been closed."""


@dataclass(frozen=True, slots=True)
class BatchState:
    """A whole batch in mid-episode; picklable."""

    plant: Any
    observed: tuple[np.ndarray, ...]
    task: Any
    reading: Reading | None


class Step(NamedTuple):
    """What a control step of a batch returns. observation: dict of (B, ...). reward (B,), terminated (B,), truncated
    (B,). outcome says why an environment ended; reading is what it all follows from."""

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
        if outcome.terminated[row]:
            info |= {name: True for name, ended in outcome.reasons.items() if ended[row]}
        for name, values in outcome.info.items():
            info[name] = _item(values[row])
        if reading.error[row]:
            info["error"] = reading.error[row]
    truth = reading.truth
    for name in reading.info_names:
        info[name] = _item(truth[name][row])
    if truth.get("randomized"):
        info["randomized"] = {name: float(values[row]) for name, values in truth["randomized"].items()}
    return info


def _item(value: Any) -> Any:
    """A value of its own: arrays are copied, NumPy's numbers become Python's."""
    if isinstance(value, np.ndarray):
        return value.copy()
    return value.item() if isinstance(value, np.generic) else value


def infos_of(
    reading: Reading, outcome: Outcome | None, rows: np.ndarray, judged: np.ndarray | None = None
) -> dict[str, Any]:
    """The same of the environments where `rows` (B,) is True, as a vector environment gives it: name -> (B, ...) and
    _name -> (B,), which rows have it. judged: (B,), the rows that took a step and were not reset (None: all)."""
    infos: dict[str, Any] = {}
    judged = rows if judged is None else rows & judged

    complete = bool(rows.all())

    def add(name: str, values: np.ndarray, have: np.ndarray) -> None:
        if have is not rows or not complete:
            values = values.copy()
            values[~have] = None if values.dtype == object else 0
        infos[name], infos["_" + name] = values, have.copy()

    add("success", outcome.success if outcome else np.zeros(len(rows), bool), rows)
    if outcome is not None:
        for name, reason in outcome.reasons.items():
            ended = reason & rows
            if ended.any():
                add(name, ended, ended)
        if judged.any():
            for name, values in outcome.info.items():
                add(name, values, judged)
        if any(reading.error):
            broken = np.array([bool(error) for error in reading.error]) & rows
            if broken.any():
                add("error", np.array(reading.error, object), broken)
    for name in reading.info_names:
        add(name, np.array(reading.truth[name]), rows)
    randomized = reading.truth.get("randomized")
    if randomized:
        nested: dict[str, Any] = {}
        for name, values in randomized.items():
            reported = values.copy() if complete else np.where(rows, values, 0.0)
            nested[name], nested["_" + name] = reported, rows.copy()
        infos["randomized"], infos["_randomized"] = nested, rows.copy()
    return infos


def reset_options(options: object) -> dict[str, Any]:
    """A copy of a reset's options. Raises InvalidValueError for what is no dictionary."""
    if not isinstance(options, Mapping | None):
        raise InvalidValueError(f"options must be a dict, such as {{'material': 'glass'}}, got {options!r}")
    return dict(options or {})


class GraspBatch:
    """`num_envs` environments over a plant. task: defines the actions, rewards and endings. plant: "simulated" or a
    URL. observer: makes the observations of that many environments. Other keywords go to the plant
    (SimulationConfig)."""

    def __init__(
        self,
        num_envs: int = 1,
        *,
        plant: str = "simulated",
        task: Task | None = None,
        observer: Callable[[int], Observer] = Observer,
        **config: Any,
    ) -> None:
        self.task: Task = task or GraspTask()
        self.num_envs = num_envs = whole_number("num_envs", num_envs, 1)
        self.plant: Plant = plant_factory(plant)(plant, num_envs, **config)
        self._observer = observer(num_envs)
        maps = {name: config[name] for name in MAPS if config.get(name) is not None}
        if maps:
            from ..spaces import with_maps  # nothing that maps need is loaded without them

            self._observer = with_maps(self._observer, maps)
        self.observation_space = self._observer.space
        self.action_space = self.task.action_space()
        self._judged = self.task.fresh(num_envs)
        self._all = np.ones(num_envs, bool)
        self.reading: Reading | None = None
        self.generators: list[np.random.Generator] = [_NOTHING] * num_envs
        """Of each environment's episodes."""
        self._never_reset = set(range(num_envs))
        self.closed = False

    def never_reset(self, row: int) -> bool:
        """Whether an environment has not been started yet."""
        return row in self._never_reset

    @property
    def time_limit(self) -> int | None:
        """Control steps after which the task truncates an episode; None for a task that has no such limit."""
        seconds = getattr(self.task, "seconds", np.inf)
        return max(math.ceil(seconds / self.dt - 0.5), 1) if np.isfinite(seconds) else None

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
        """Starts the rows anew, each with its generator; observations and reading are of all environments. Raises
        ClosedEnvironmentError."""
        self.require_open("reset")
        reading = self.plant.reset(rows, rngs, reset_options(options))
        for row, rng in zip(rows, rngs, strict=True):
            self.generators[row] = rng
        self._never_reset -= {int(row) for row in rows}
        if self.reading is not None:
            reading = merged(self.reading, reading, rows)
        chosen = np.zeros(self.num_envs, bool)
        chosen[list(rows)] = True
        self._observer.restart(chosen)
        self._judged[chosen] = np.zeros(1, self._judged.dtype)
        self.reading = reading
        return self._observer.observe(reading, np.zeros(self.num_envs), chosen), reading

    def step(self, action: np.ndarray) -> Step:
        """One control step of all environments. action: (B, ...). An environment whose simulation broke down is
        truncated, the reason in info["error"], with its last finite observation. Raises InvalidValueError where one has
        never been reset, and ClosedEnvironmentError."""
        self.require_open("step")
        self._all_reset_before("step")
        command = self.task.command(action)
        self.reading = reading = self.plant.step(command)
        running = self._all
        if any(reading.error):
            running = np.array([not error for error in reading.error])
        seen = self._observer.observe(reading, command.force_limit, running)
        self._judged, outcome = self.task.judge(self._judged, self.plant.dt, action, reading)
        if running is not self._all:
            outcome = stopped(outcome, ~running)
        return Step(seen, outcome.reward, outcome.terminated, outcome.truncated, outcome, reading)

    def state(self) -> BatchState:
        """A copy of the whole batch in mid-episode. Raises InvalidValueError where the plant has no state to copy, or
        one of the environments has never been reset."""
        if not hasattr(self.plant, "state"):
            raise InvalidValueError("this plant's state can't be saved: it is not simulated")
        self._all_reset_before("state")
        plant: Any = self.plant
        rows = range(self.num_envs)
        return copy.deepcopy(BatchState(plant.state(rows), self._observer.arrays, self._judged, self.reading))

    def set_state(self, state: BatchState) -> tuple[np.random.Generator, ...]:
        """Puts the batch into a state: what follows is bit-identical to what followed it first. Returns the
        generators, which are the batch's own from now on. Raises InvalidValueError for what is no state, and
        ClosedEnvironmentError."""
        self.require_open("set_state")
        if not isinstance(state, BatchState):
            raise InvalidValueError(f"set_state takes what state() returned, got {type(state).__name__}")
        current, given = self._judged, state.task
        if (
            current.dtype != given.dtype
            or current.shape != given.shape
            or [kept.shape for kept in self._observer.arrays] != [kept.shape for kept in state.observed]
        ):
            raise InvalidValueError(
                f"the state is of {len(given)} environments of another task or of other keywords: give one of "
                f"{len(current)} made like these"
            )
        state = copy.deepcopy(state)
        plant: Any = self.plant
        rngs = plant.set_state(range(self.num_envs), state.plant)
        for kept, observed in zip(self._observer.arrays, state.observed, strict=True):
            kept[:] = observed
        self._judged, self.reading = state.task, state.reading
        self.generators = list(rngs)
        self._never_reset = set()
        return rngs

    def require_open(self, what: str) -> None:
        """Raises ClosedEnvironmentError, which says what was asked for, where the batch has been closed."""
        if self.closed:
            raise ClosedEnvironmentError(
                f"{what} of an environment that has been closed: make a new one, or close it later"
            )

    def close(self) -> None:
        """Releases the plant. Does nothing the second time."""
        if not self.closed:
            self.closed = True
            self.plant.close()

    def _all_reset_before(self, call: str) -> None:
        if self._never_reset:
            raise InvalidValueError(
                f"environments {sorted(self._never_reset)} have never been reset: call reset before {call}"
            )
