"""One scripted grasp of a real gripper, and the same commands in simulation.

N: samples of the whole grasp.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass

import numpy as np
from gymnasium.utils.seeding import np_random

from thermograsp.agents import ScriptedGrasp
from thermograsp.envs import GraspBatch
from thermograsp.errors import positive
from thermograsp.hardware.plant import OVERRUN, PaceCounts, SerialPlant
from thermograsp.plant import Command, Reading

SIDES = ("left", "right")
LONGEST = 3600.0  # s
_PRESSING = 0.2  # N on each pad
_EARLIEST, _LATEST = -0.2, 0.5  # s
_LEAST = 2e-4  # V that tells a delay


@dataclass(frozen=True, slots=True)
class Beside:
    """columns: name_unit -> (N,), time_s first, those of the simulation at the same times with simulated_ in front;
    what is not sampled faster holds the value of its control step. error: why the grasp ended before its time, "".
    held: s up to its end that both pads pressed. counts: of the plant's pace. delay: s by which the measured voltage
    follows the simulated one best, NaN where nothing was touched. difference: V rms between the two after that."""

    columns: Mapping[str, np.ndarray]
    error: str
    held: float
    counts: PaceCounts
    delay: float
    difference: float


def grasp_beside(
    real: GraspBatch,
    simulated: GraspBatch,
    seconds: float,
    force: float = 10.0,
    seed: int = 0,
    watch: Callable[[float], None] | None = None,
) -> Beside:
    """Grasps for `seconds` with at most `force` N on a serial plant, then simulates what the gripper made of the
    commands, each for as long as it held, which is more than a control step where the host was late.

    seed: of the simulated object's place and noise. watch: called with the time after every control step. Raises
    InvalidValueError, and DeviceError where the grasp cannot begin."""
    plant = real.plant
    assert isinstance(plant, SerialPlant)
    steps = max(1, round(min(positive("seconds", seconds), LONGEST) / real.dt))
    policy = ScriptedGrasp(1, real.dt, force)
    # Before anything moves: what is wrong with the simulation is told, what a step needs is compiled.
    seen, _ = simulated.reset([0], [np_random(seed)[0]])
    simulated.step(policy.action(seen))
    simulated.reset([0], [np_random(seed)[0]])
    policy.restart([0])
    observation, _ = real.reset([0], [np_random(seed)[0]])
    commands: list[Command] = []
    measured: list[Reading] = []
    error = ""
    for k in range(steps):
        action = policy.action(observation)
        step = real.step(action)
        error = step.reading.error[0]
        if error:
            break
        observation = step.observation
        commands.append(plant.quantised(real.task.command(action)))
        measured.append(step.reading)
        if watch:
            watch((k + 1) * real.dt)
    late = np.array([reading.truth["late"][0] for reading in measured])
    ends = real.dt * np.arange(1, len(late) + 1) + np.cumsum(np.where(late > OVERRUN, late, 0.0))
    expected = [
        simulated.plant.step(commands[int(np.searchsorted(ends, middle))])
        for middle in np.arange(0.5 * real.dt, ends[-1] if len(ends) else 0.0, real.dt)
    ]
    samples = plant.config.samples
    columns = {"time_s": _times(ends, real.dt, samples), **measured_columns(measured, samples)}
    even = _times(real.dt * np.arange(1, len(expected) + 1), real.dt, samples)
    for name, values in measured_columns(expected, samples).items() if measured else ():
        columns[f"simulated_{name}"] = np.interp(columns["time_s"], even, values)
    columns["late_s"] = np.repeat(late, samples)
    delay, difference = best_delay(columns) if measured else (float("nan"), float("nan"))
    pressing = [bool(reading.force[0, :, 0].min() > _PRESSING) for reading in measured]
    holding = len(pressing) if all(pressing) else pressing[::-1].index(False)
    return Beside(columns, error, holding * real.dt, plant.counts, delay, difference)


def best_delay(columns: Mapping[str, np.ndarray]) -> tuple[float, float]:
    """(s, V): by how much the measured voltages follow the simulated ones, to a millisecond, and their rms difference
    then; NaN where either hardly moves."""
    time = columns["time_s"]
    measured, expected = (
        np.array([columns[f"{prefix}voltage_{side}_V"] for side in SIDES]) for prefix in ("", "simulated_")
    )
    if min(np.ptp(measured), np.ptp(expected)) < _LEAST:
        return float("nan"), float("nan")
    shifts = np.arange(_EARLIEST, _LATEST, 1e-3)
    errors = [
        np.sqrt(
            np.mean(
                [(m - np.interp(time - shift, time, e)) ** 2 for m, e in zip(measured, expected, strict=True)]
            )
        )
        for shift in shifts
    ]
    best = int(np.argmin(errors))
    return float(shifts[best]), float(errors[best])


def _times(ends: np.ndarray, dt: float, samples: int) -> np.ndarray:
    """(N,) s of the samples of control steps that ended at `ends` s."""
    return (ends[:, None] - dt / samples * np.arange(samples)[::-1]).ravel()


def measured_columns(readings: Sequence[Reading], samples: int) -> dict[str, np.ndarray]:
    """Columns (N,) by name_unit of what a real gripper tells, of readings with that many samples each."""
    volts = np.concatenate([reading.voltage[0] for reading in readings]) if readings else np.zeros((0, 2))
    columns: dict[str, np.ndarray] = {}
    for side, label in enumerate(SIDES):
        columns[f"voltage_{label}_V"] = volts[:, side]
        columns[f"force_{label}_N"] = np.repeat([r.force[0, side, 0] for r in readings], samples)
        columns[f"thermostat_{label}_degC"] = np.repeat([r.thermostat[0, side] for r in readings], samples)
    columns["opening_m"] = np.repeat([r.opening[0] for r in readings], samples)
    return columns
