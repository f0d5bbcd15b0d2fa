"""What a simulated second of Grasp-v0 costs, against the error of the voltage that the agent sees.

Three knobs: MuJoCo's time step, the frame skip (time steps in a control step) and the tolerance of the heat models. All
settings get the same commands at the same times, from the same places, on the same materials; the voltage is read every
40 ms, by an ideal chain, and compared with that of a run with a far smaller time step and tolerance and the shortest
control step that there is, 10 ms.
"""

from __future__ import annotations

import time
from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace

import numpy as np

from thermograsp.envs import (
    GraspBatch,
    GraspTask,
    SimulationConfig,
    SolverSettings,
    action_of,
)

MATERIALS = ("wood", "glass", "stainless_steel", "aluminium")
TICK = 0.04  # s between changes of the command, and between readings; every control step divides it
_SECONDS = 5.6


@dataclass(frozen=True, slots=True)
class Setting:
    """The steps and the tolerance of an environment. timestep: s. substeps: time steps in a control step. tolerance:
    K."""

    timestep: float
    substeps: int
    tolerance: float

    @property
    def period(self) -> float:
        """s, the control step."""
        return self.timestep * self.substeps


SHIPPED = Setting(SolverSettings().timestep, SimulationConfig().substeps, SimulationConfig().tolerance)
REFERENCE = Setting(0.0002, 50, 0.002)


@dataclass(frozen=True, slots=True)
class Point:
    """What one setting costs, and its error. seconds: of CPU per environment and simulated second. speed: simulated
    seconds per second of computing over those of SHIPPED. error: V, rms over environments, fingertips and time of the
    voltage less the reference's. relative: error over the reference's rms. lost: environments whose simulation broke
    down. pareto: no other is as fast and better."""

    setting: Setting
    seconds: float
    speed: float
    error: float
    relative: float
    lost: int
    pareto: bool = False


def settings(quick: bool) -> list[Setting]:
    """What is compared, SHIPPED among them."""
    timesteps = (0.001, 0.002) if quick else (0.0005, 0.001, 0.002, 0.005)
    periods = (0.02,) if quick else (0.01, 0.02, 0.04)
    tolerances = (0.05, 0.5) if quick else (0.01, 0.05, 0.5)
    return [
        Setting(timestep, round(period / timestep), tolerance)
        for timestep in timesteps
        for period in periods
        for tolerance in tolerances
    ]


def measure(
    chosen: Sequence[Setting], num_envs: int, repeats: int, seed: int, shown: Callable[[Setting], None]
) -> list[Point]:
    """Runs every setting `repeats` times, in random order, each counted with its quickest run, on `num_envs`
    environments at once. chosen: SHIPPED must be among them. shown: called with the one that runs."""
    rng = np.random.default_rng(seed)
    actions = _script(rng, num_envs)
    shown(REFERENCE)
    exact, _, _ = _run(REFERENCE, actions, seed)
    scale = _rms(exact)
    quickest = np.full(len(chosen), np.inf)
    errors, lost = np.zeros(len(chosen)), np.zeros(len(chosen), int)
    for i in np.concatenate([rng.permutation(len(chosen)) for _ in range(repeats)]):
        shown(chosen[i])
        voltage, seconds, lost[i] = _run(chosen[i], actions, seed)
        quickest[i] = min(quickest[i], seconds)
        errors[i] = _rms(voltage - exact)
    base = quickest[chosen.index(SHIPPED)]
    points = [
        Point(setting, float(q), float(base / q), float(e), float(e / scale), int(gone))
        for setting, q, e, gone in zip(chosen, quickest, errors, lost, strict=True)
    ]
    return [replace(p, pareto=_undominated(p, points)) for p in points]


def _script(rng: np.random.Generator, num_envs: int) -> np.ndarray:
    """Actions (ticks, B, 3): close, lift, squeeze otherwise, put down, open, close again on what is still cold; forces
    of each environment's own."""
    first, second, third = rng.uniform(5.0, 20.0, (3, num_envs))
    phases = (  # until s, opening m, force N, lift rate m/s
        (1.0, 0.0, first, 0.0),
        (2.2, 0.0, first, 0.04),
        (2.8, 0.0, second, 0.0),
        (4.0, 0.0, second, -0.04),
        (4.6, 0.06, second, 0.0),
        (_SECONDS, 0.0, third, 0.0),
    )
    ticks = []
    for k in range(round(_SECONDS / TICK)):
        _, opening, force, rate = next(phase for phase in phases if k * TICK < phase[0] - TICK / 2)
        ticks.append([action_of(opening, each, rate) for each in force])
    return np.array(ticks)


def _run(setting: Setting, actions: np.ndarray, seed: int) -> tuple[np.ndarray, float, int]:
    """Voltage (ticks, B, 2) V, CPU s per environment and simulated second, environments that broke down."""
    ticks, num_envs = actions.shape[:2]
    batch = GraspBatch(
        num_envs,
        task=GraspTask(hold_seconds=1e9, seconds=1e9),
        tolerance=setting.tolerance,
        solver=SolverSettings(timestep=setting.timestep),
        substeps=setting.substeps,
        signal="ideal",
    )
    for row in range(num_envs):
        name = MATERIALS[row % len(MATERIALS)]
        batch.reset([row], [np.random.default_rng([seed, row])], {"material": name})
    steps = round(TICK / setting.period)
    voltage, broken = np.zeros((ticks, num_envs, 2)), np.zeros(num_envs, bool)
    begun = time.process_time()
    for tick, action in enumerate(actions):
        for _ in range(steps - 1):
            batch.step(action)
        step = batch.step(action)
        voltage[tick] = step.observation["voltage"][:, :, -1]
        broken |= step.truncated
    seconds = (time.process_time() - begun) / (num_envs * ticks * TICK)
    batch.close()
    return voltage, seconds, int(broken.sum())


def _rms(values: np.ndarray) -> float:
    return float(np.sqrt(np.mean(values**2)))


def _undominated(point: Point, points: Sequence[Point]) -> bool:
    return not any(
        q.speed >= point.speed and q.error <= point.error and (q.speed > point.speed or q.error < point.error)
        for q in points
    )
