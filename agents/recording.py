"""Grasps as they are recorded: one row a voltage sample.

B: grasps at once, N: samples, S: samples of a control step.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass

import numpy as np
from gymnasium.utils.seeding import np_random

from thermograsp.agents.scripted import ScriptedGrasp
from thermograsp.envs import GraspBatch
from thermograsp.errors import InvalidValueError, positive
from thermograsp.plant import Reading
from thermograsp.thermal import Material

LONGEST = 3600.0  # s
SIDES = ("left", "right")
Watch = Callable[[float, GraspBatch], None]

# Column, unit and where it comes from; per fingertip the array is (B, 2), or (B, S, 2) where it is sampled faster.
_PER_FINGERTIP: tuple[tuple[str, str, Callable[[Reading], np.ndarray]], ...] = (
    ("voltage", "V", lambda reading: reading.voltage),
    ("temperature_drop", "K", lambda reading: reading.truth["temperature_drops"]),
    ("force", "N", lambda reading: reading.force[:, :, 0]),
    ("contact_area", "m2", lambda reading: reading.truth["contact_area"]),
    ("conductance", "W_m2K", lambda reading: reading.truth["conductance"]),
    ("heat_flow", "W", lambda reading: reading.truth["heat_flow"]),
    ("sensor_surface", "degC", lambda reading: reading.truth["sensor_surface"]),
    ("object_surface", "degC", lambda reading: reading.truth["object_surface"]),
)
_PER_GRASP: tuple[tuple[str, str, Callable[[Reading], np.ndarray]], ...] = (
    ("object_temperature", "degC", lambda reading: reading.truth["object_temperature"]),
    ("opening", "m", lambda reading: reading.opening),
    ("height", "m", lambda reading: reading.height),
    ("lift", "m", lambda reading: reading.truth["lift"]),
)


@dataclass(frozen=True, slots=True)
class Event:
    """Something that happened to a fingertip in the control step that ended at `time` s."""

    time: float
    kind: str
    fingertip: str


@dataclass(frozen=True, slots=True)
class Recording:
    """One grasp. columns: name_unit -> (N,), time_s first; what is not sampled faster holds the value of its control
    step. success: at its end the object had been held 5 cm up for the task's hold_seconds. ending: what went wrong."""

    material: str
    seed: int
    rung: str
    columns: Mapping[str, np.ndarray]
    events: tuple[Event, ...]
    success: bool
    ending: str

    @property
    def touch(self) -> float:
        """s, when both fingertips had touched; NaN where they did not."""
        first = {event.fingertip: event.time for event in reversed(self.events) if event.kind == "touch"}
        return max(first.values()) if len(first) == len(SIDES) else float("nan")


def record(
    batch: GraspBatch,
    seeds: Sequence[int],
    seconds: float,
    force: float | np.ndarray = 10.0,
    materials: Sequence[str | Material | None] | None = None,
    watch: Watch | None = None,
) -> list[Recording]:
    """Scripted grasps, all of a batch at once, for `seconds` from their start.

    seeds: one for each; grasp i is that of a single environment reset with seeds[i]. force: N, one for all or (B,).
    materials: one for each, None to draw. watch: called with the time and the batch at the start and after every
    control step; it may read only.
    Raises InvalidValueError.
    """
    if positive("seconds", seconds) > LONGEST:
        raise InvalidValueError(f"seconds must be at most {LONGEST:g}, got {seconds!r}")
    policy = ScriptedGrasp(batch.num_envs, batch.dt, force)
    steps = max(1, round(seconds / batch.dt))
    observation: dict[str, np.ndarray] = {}
    for row, seed in enumerate(seeds):
        chosen = materials[row] if materials else None
        options = {"material": chosen} if chosen is not None else {}
        observation, _ = batch.reset([row], [np_random(seed)[0]], options)
    readings: list[Reading] = []
    events: list[list[Event]] = [[] for _ in seeds]
    ending = ["" for _ in seeds]
    success = [False for _ in seeds]
    length = [steps] * len(seeds)
    if watch:
        watch(0.0, batch)
    for k in range(steps):
        step = batch.step(policy.action(observation))
        observation = step.observation
        assert batch.reading is not None
        readings.append(batch.reading)
        now = (k + 1) * batch.dt
        for row, info in enumerate(step.infos):
            if "error" in info and length[row] == steps:
                length[row] = k
            events[row] += [Event(now, kind, tip) for kind, tip in info["events"]]
            ending[row] = ending[row] or _ending(info)
            success[row] = bool(info["success"])
        if watch:
            watch(now, batch)
    columns = columns_of(readings, batch.dt)
    last = readings[-1].truth
    return [
        Recording(
            material=last["material"][row],
            seed=seeds[row],
            rung=last["rung"][row],
            columns={
                name: np.ascontiguousarray(column[row, : length[row] * samples])
                for name, column in columns.items()
            },
            events=tuple(events[row]),
            success=success[row] and not ending[row],
            ending=ending[row],
        )
        for samples in [readings[0].voltage.shape[1]]
        for row in range(len(seeds))
    ]


def _ending(info: Mapping[str, object]) -> str:
    if "error" in info:
        return str(info["error"])
    return next((what for what in ("dropped", "crushed") if info.get(what)), "")


def columns_of(readings: Sequence[Reading], dt: float, begun: float = 0.0) -> dict[str, np.ndarray]:
    """Columns (B, N) by name_unit of a simulated plant's consecutive readings, the first of which ends a control step
    of dt s that started at `begun` s."""
    rows, samples = readings[0].voltage.shape[:2]
    count = len(readings) * samples
    time = begun + (np.arange(count) + 1) * (dt / samples)
    columns = {"time_s": np.broadcast_to(time, (rows, count))}
    for name, unit, read in _PER_FINGERTIP:
        values = np.stack([read(reading) for reading in readings], axis=1)  # (B, steps, [S,] 2)
        if values.ndim == 3:
            values = np.repeat(values[:, :, None], samples, axis=2)
        for side, label in enumerate(SIDES):
            columns[f"{name}_{label}_{unit}"] = values[..., side].reshape(rows, count)
    for name, unit, read in _PER_GRASP:
        values = np.stack([read(reading) for reading in readings], axis=1)
        columns[f"{name}_{unit}"] = np.repeat(values, samples, axis=1)
    return columns
