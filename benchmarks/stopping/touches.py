"""Touches of Identify-v0 by an agent that is kept from declaring, so that it says at every time what it would have
declared then.

N: episodes, D: decisions of each, K: materials, n: samples of a fingertip.
"""

from __future__ import annotations

from collections.abc import Callable
from contextlib import closing
from dataclasses import dataclass
from typing import Any

import numpy as np

from thermograsp.agents import policy
from thermograsp.agents.learning import TASKS
from thermograsp.envs.tasks import DECLARES
from thermograsp.thermal import TouchSetup

STEP, EVERY = 0.02, 5  # s, the control step; control steps between decisions
RATE = 100.0  # Hz
_AT_ONCE = 50
_KNOWN = 0.1  # K


@dataclass(frozen=True, slots=True)
class Touched:
    """Grasps with what an agent would have declared at each moment. materials: (K,) names. truth: (N,), which it was.
    touch: (N,) s, the end of the last control step before the first contact. times: (D,) s of the decisions. shares:
    (N, D, K), what the agent would have declared. declares: (N, D), whether it would have. voltage: (N, n, 2) V, sample
    i at (i + 1) / RATE s."""

    materials: tuple[str, ...]
    truth: np.ndarray
    touch: np.ndarray
    times: np.ndarray
    shares: np.ndarray
    declares: np.ndarray
    voltage: np.ndarray

    @property
    def contact(self) -> np.ndarray:
        """(N, D) s of contact before each decision; negative before the touch."""
        return self.times - self.touch[:, None]

    @property
    def right(self) -> np.ndarray:
        """(N, D) bool, whether the largest share is the true material's."""
        return self.shares.argmax(axis=2) == self.truth[:, None]


def touched(episodes: int, first: int, seconds: float, advance: Callable[[str, float], None]) -> Touched:
    """`episodes` of them by the agent that comes with the package, on a gripper without load cells, from seed `first`
    on, for `seconds` each. advance: called with progress, in episodes."""
    parts, task = [], TASKS["identify"]
    with closing(task.make(min(episodes, _AT_ONCE))) as env:
        for begun in range(0, episodes, env.num_envs):
            parts.append(_batch(env, first + begun, round(seconds / STEP)))
            advance("touching", min(env.num_envs, episodes - begun))
        names = env.unwrapped.batch.task.classes  # pyright: ignore[reportAttributeAccessIssue]
    truth, touch, shares, declares, voltage = (
        np.concatenate(each)[:episodes] for each in zip(*parts, strict=True)
    )
    times = np.arange(0, round(seconds / STEP), EVERY) * STEP
    return Touched(tuple(names), truth, touch, times, shares, declares, voltage)


def _batch(env: Any, first: int, steps: int) -> tuple[np.ndarray, ...]:
    """truth, touch, shares, declares and voltage of as many episodes as there are environments."""
    count = env.num_envs
    batch, acting = env.unwrapped.batch, policy(env, "trained")
    seeds = [first + row for row in range(count)]
    observation, _ = env.reset(seed=seeds)
    acting.restart(range(count), list(range(count)))
    names = list(batch.reading.truth["material"])
    truth = np.array([batch.task.classes.index(name) for name in names])
    touch, shares, declares, voltage = np.full(count, np.nan), [], [], []
    for step in range(steps):
        observation = {**observation, "force": np.zeros_like(observation["force"])}
        action = acting.action(observation)
        going_on = action.copy()
        going_on[:, 1] = -1.0
        observation, _, _, _, info = env.step(going_on)
        if step % EVERY == 0:
            shares.append(info["prediction"])
            declares.append(action[:, 1] > DECLARES)
        voltage.append(observation["voltage"][:, :, -round(STEP * RATE) :])
        begins = np.isnan(touch) & (batch.reading.truth["conductance"].max(axis=1) > 0)
        touch[begins] = step * STEP
    samples = np.concatenate(voltage, axis=2).transpose(0, 2, 1)
    return truth, touch, np.stack(shares, 1), np.stack(declares, 1), samples


def setup_known() -> TouchSetup:
    """What an identifier may know of these touches beforehand: all but the contact's conductance; temperatures within
    .1 K, as an instrument knows them."""
    with closing(TASKS["identify"].make(1)) as env:
        env.reset(seed=0)
        plant = env.unwrapped.batch.plant  # pyright: ignore[reportAttributeAccessIssue]
        body, config = plant.bodies[0], plant.config
        warm = config.sensor_temperatures[0], _KNOWN
        return body.touch_setup(config.chain, warm, _KNOWN, config.tolerance)
