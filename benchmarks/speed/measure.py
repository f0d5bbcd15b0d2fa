"""How near Grasp-v0 comes to bare MuJoCo, and where the rest goes.

Nested layers carry out the same control steps from the same state: mujoco.batch alone, Mechanics (commands in, contact
forces of every substep out), the simulated plant (heat, noise, electronics), GraspBatch (observation, reward), and the
environment, a vector one but for one alone. Each ends with the same bits, so contacts are the same; the difference of
two layers' times is what the outer one adds. Heat is also run alone, on the recorded forces. Layers take turns in short
blocks, in random order, so that a busy moment of the machine hits none alone, and the ratio is taken within each block.
"""

from __future__ import annotations

import time
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Any

import gymnasium
import numpy as np

from thermograsp.bench.speed.bare import BareBatch, Inputs, inputs_of
from thermograsp.envs import command_of
from thermograsp.envs.limits import SUBSTEPS
from thermograsp.envs.sensing import HeatStep

ID = "thermograsp/Grasp-v0"
LAYERS = ("mujoco.batch", "mechanics", "heat", "plant", "batch", "environment")
PARTS = ("physics", "contact", "heat", "noise, electronics", "observation, task", "Gymnasium")
_WARM = 100  # control steps before the first block: grippers have met their objects
_EPISODE = 500  # control steps of the environment's 10 s


@dataclass(frozen=True, slots=True)
class Speed:
    """Times of `num_envs` environments. seconds: of CPU per environment and control step, a layer each (medians).
    ratio: bare time over the environment's, CPU, median and quartiles of the blocks; wall_ratio: the same by the wall
    clock. reset: s of CPU to start one environment anew. touching: share of control steps in which a fingertip
    presses. blocks: that were timed. same: every layer ended each block with the same bits."""

    num_envs: int
    seconds: dict[str, float]
    ratio: float
    quartiles: tuple[float, float]
    wall_ratio: float
    reset: float
    touching: float
    blocks: int
    same: bool

    @property
    def ratio_with_resets(self) -> float:
        """Bare time over the environment's with one reset per episode of 500 control steps."""
        bare = self.seconds[LAYERS[0]]
        return bare / (bare / self.ratio + self.reset / _EPISODE)

    @property
    def parts(self) -> dict[str, float]:
        """Shares of the environment's time by PARTS; they add up to 1. One within the timing's noise may be below 0."""
        bare, mechanics, heat, plant, batch, whole = (self.seconds[name] for name in LAYERS)
        times = (bare, mechanics - bare, heat, plant - mechanics - heat, batch - plant, whole - batch)
        return {name: time / whole for name, time in zip(PARTS, times, strict=True)}


def measure(num_envs: int, blocks: int, steps: int, seed: int, shown: Callable[[], None]) -> Speed:
    """Times `blocks` blocks of `steps` control steps with random actions of Grasp-v0 as shipped. shown: called after
    each block."""
    rng = np.random.default_rng(seed)
    env = _environment(num_envs)
    env.reset(seed=seed)  # compiles, and fills caches
    begun = time.process_time()
    env.reset(seed=seed)
    reset = (time.process_time() - begun) / num_envs
    layers = _Layers(env)
    for action in _actions(rng, min(_WARM, 10 * steps), num_envs):
        env.step(action)
    timed, touching, same = [], [], True
    for _ in range(blocks):
        actions = _actions(rng, steps, num_envs)
        count = layers.rehearse(actions)
        if count == steps:
            timed.append(layers.time(actions, rng))
            same &= layers.same
            touching.append(layers.touching)
        else:  # an episode ends: the environment's own step sees to it, and to the reset after it
            for action in actions[: count + 1]:
                env.step(action)
            if num_envs == 1:
                env.reset()
            else:
                env.step(actions[0])
        shown()
    env.close()
    cpu = np.array([[times[name][0] for name in LAYERS] for times in timed]) / (steps * num_envs)
    wall = np.array([[times[name][1] for name in LAYERS] for times in timed])
    ratio = cpu[:, 0] / cpu[:, -1]
    low, middle, high = (float(x) for x in np.percentile(ratio, [25, 50, 75]))
    return Speed(
        num_envs,
        dict(zip(LAYERS, np.median(cpu, axis=0).tolist(), strict=True)),
        middle,
        (low, high),
        float(np.median(wall[:, 0] / wall[:, -1])),
        reset,
        float(np.mean(touching)),
        len(timed),
        same,
    )


def _environment(num_envs: int) -> Any:
    """One is the single environment, many the native vector one: what a user has."""
    if num_envs == 1:
        return gymnasium.make(ID)
    return gymnasium.make_vec(ID, num_envs=num_envs, vectorization_mode="vector_entry_point")


def _actions(rng: np.random.Generator, steps: int, num_envs: int) -> np.ndarray:
    """(steps, B, 3); (steps, 3) for the single environment."""
    shape = (steps, 3) if num_envs == 1 else (steps, num_envs, 3)
    return rng.uniform(-1.0, 1.0, shape).astype(np.float32)


class _Layers:
    """The layers of an environment, and a bare batch beside it."""

    def __init__(self, env: Any) -> None:
        self._env = env
        self._batch = env.unwrapped.batch
        self._plant = self._batch.plant
        self._mechanics = self._plant.mechanics
        self._bare = BareBatch(self._mechanics, self._plant.config.threads, SUBSTEPS)
        self._inputs: list[Inputs] = []
        self._start: Any = None
        self.touching = 0.0
        self.same = True

    def rehearse(self, actions: np.ndarray) -> int:
        """Takes the steps once, untimed, and goes back to where it began. Returns how many come before an episode
        ends, all of them where none does."""
        self._start, self._inputs, pressed = self._batch.state(), [], []
        count = len(actions)
        for k, action in enumerate(actions):
            step = self._batch.step(np.atleast_2d(action))
            self._inputs.append(inputs_of(self._mechanics.model, self._mechanics.state()))
            self._drop = step.reading.truth["temperature_drop"].copy()
            pressed.append(np.any(step.observation["force"][:, :, 0] > 0, axis=1).mean())
            if step.terminated.any() or step.truncated.any():
                count = k
                break
        self._end = self._mechanics.state().rows
        self.touching = float(np.mean(pressed))
        self._batch.set_state(self._start)
        return count

    def time(self, actions: np.ndarray, rng: np.random.Generator) -> dict[str, tuple[float, float]]:
        """(CPU, wall) s of the rehearsed steps by layer; the environment is left where they end."""
        commands = [command_of(np.atleast_2d(action)) for action in actions]
        moves = [(each.opening, each.force_limit, each.lift_rate, SUBSTEPS) for each in commands]
        self._batch.set_state(self._start)
        motions = [self._mechanics.advance(*each) for each in moves]
        runs: dict[str, tuple[Callable[..., Any], Sequence[tuple[Any, ...]]]] = {
            "mujoco.batch": (self._bare.step, [(inputs,) for inputs in self._inputs]),
            "mechanics": (self._mechanics.advance, moves),
            "heat": (self._plant.heat.advance, [(each.normal, each.place) for each in motions]),
            "plant": (self._plant.step, [(each,) for each in commands]),
            "batch": (self._batch.step, [(np.atleast_2d(action),) for action in actions]),
            "environment": (self._env.step, [(action,) for action in actions]),
        }
        self.same, found = True, {}
        for name in [LAYERS[i] for i in rng.permutation(len(LAYERS) - 1)] + [LAYERS[-1]]:
            self._restore(name)
            step, arguments = runs[name]
            wall, cpu = time.perf_counter(), time.process_time()
            last = None
            for each in arguments:
                last = step(*each)
            found[name] = (time.process_time() - cpu, time.perf_counter() - wall)
            if isinstance(last, HeatStep):
                self.same &= np.array_equal(last.drop[:, -1], self._drop)
                continue
            rows = self._bare.batch.state if name == "mujoco.batch" else self._mechanics.state().rows
            self.same &= np.array_equal(rows, self._end)
        return found

    def _restore(self, name: str) -> None:
        """Puts what that layer works on back to where the block began."""
        plant, rows = self._start.plant, range(self._batch.num_envs)
        if name == "mujoco.batch":
            self._bare.copy(self._mechanics, plant.mechanics)
        elif name == "mechanics":
            self._mechanics.set_state(plant.mechanics)
        elif name == "heat":
            self._plant.heat.set_state(rows, plant.heat)
        elif name == "plant":
            self._plant.set_state(rows, plant)
        else:
            self._batch.set_state(self._start)
