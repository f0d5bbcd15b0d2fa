"""Episodes of a vector environment, each from its own seed, so that nothing depends on how many run at once.

B: environments at once.
"""

from __future__ import annotations

import copy
import hashlib
import time
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Any, Protocol

import gymnasium
import numpy as np

from thermograsp.errors import InvalidValueError, unknown_name
from thermograsp.report.checks import Violation, violations

POLICIES = ("scripted", "random", "zero")


@dataclass(frozen=True, slots=True)
class Rollout:
    """What came of it. steps: of all episodes. steps_per_second: in the environment's step. digest: sha256
    over all observations, episode by episode."""

    steps: int
    successes: int
    mean_return: float
    steps_per_second: float
    digest: str
    violations: tuple[Violation, ...]


class _Policy(Protocol):
    def restart(self, seeds: Sequence[int]) -> None: ...

    def action(self, observation: Any) -> np.ndarray: ...


def rollout(
    env: gymnasium.vector.VectorEnv,
    episodes: int,
    seed: int,
    policy: str = "scripted",
    max_steps: int | None = None,
    check: bool = False,
    advance: Callable[[str, float], None] = lambda doing, by: None,
) -> Rollout:
    """Runs episodes 0 .. episodes - 1; episode k is reset with seed + k. advance: told of progress, in episodes.

    Without `check` only broken simulations are violations. Raises UnknownNameError and InvalidValueError."""
    acting = _policy(env, policy)
    digests, found, returns = [], [], []
    steps = successes = 0
    wall = 0.0
    for first in range(0, episodes, env.num_envs):
        wanted = min(env.num_envs, episodes - first)
        seeds = [seed + first + i for i in range(env.num_envs)]
        observation, _ = env.reset(seed=seeds)  # pyright: ignore[reportArgumentType]
        acting.restart(seeds)
        hashes = [hashlib.sha256() for _ in range(wanted)]
        total, over, succeeded = np.zeros(wanted), np.zeros(wanted, bool), np.zeros(wanted, bool)
        _update(hashes, over, observation)
        taken = 0
        while not over.all() and (max_steps is None or taken < max_steps):
            action = acting.action(observation)
            begun = time.perf_counter()
            observation, reward, terminated, truncated, info = env.step(action)
            wall += time.perf_counter() - begun
            taken += 1
            running = ~over
            steps += int(running.sum())
            _update(hashes, over, observation)
            found += violations(env, observation, reward, info, np.flatnonzero(running), first, taken, check)
            total += np.where(running, reward[:wanted], 0.0)
            succeeded |= running & _flag(info, "success", wanted)
            ended = running & (terminated | truncated)[:wanted]
            over |= ended
            advance(f"{int(succeeded.sum())} succeeded", int(ended.sum()))
        advance("", int((~over).sum()))
        successes += int(succeeded.sum())
        returns += list(total)
        digests += [one.digest() for one in hashes]
    digest = hashlib.sha256(b"".join(digests)).hexdigest()
    return Rollout(steps, successes, float(np.mean(returns)), steps / wall, digest, tuple(found))


def _update(hashes: Sequence[Any], over: np.ndarray, observation: Any) -> None:
    parts = (
        [observation[name] for name in sorted(observation)]
        if isinstance(observation, dict)
        else [observation]
    )
    for row, digest in enumerate(hashes):
        if not over[row]:
            for part in parts:
                digest.update(np.ascontiguousarray(part[row]).tobytes())


def _flag(info: dict[str, Any], name: str, rows: int) -> np.ndarray:
    """(rows,) bool from a vector environment's info, False where it is not there."""
    return np.asarray(info.get(name, np.zeros(rows, bool)), bool)[:rows]


def _policy(env: gymnasium.vector.VectorEnv, name: str) -> _Policy:
    if name not in POLICIES:
        raise unknown_name("policy", name, POLICIES)
    return {"scripted": _Scripted, "random": _Random, "zero": _Zero}[name](env)


class _Zero:
    """Zeros: of the grasp environments the middle of each command."""

    def __init__(self, env: gymnasium.vector.VectorEnv) -> None:
        sample = env.action_space.sample()
        self._action = np.zeros_like(sample)

    def restart(self, seeds: Sequence[int]) -> None:
        del seeds

    def action(self, observation: Any) -> np.ndarray:
        del observation
        return self._action


class _Random:
    """Uniform, each environment from a generator of its episode's seed."""

    def __init__(self, env: gymnasium.vector.VectorEnv) -> None:
        self._spaces = [copy.deepcopy(env.single_action_space) for _ in range(env.num_envs)]

    def restart(self, seeds: Sequence[int]) -> None:
        for space, seed in zip(self._spaces, seeds, strict=True):
            space.seed(seed)

    def action(self, observation: Any) -> np.ndarray:
        del observation
        return np.stack([space.sample() for space in self._spaces])


class _Scripted:
    """Closes, lifts and holds; for environments that observe and act as Grasp-v0 does."""

    def __init__(self, env: gymnasium.vector.VectorEnv) -> None:
        space = env.single_observation_space
        if not (isinstance(space, gymnasium.spaces.Dict) and {"force", "gripper"} <= set(space.spaces)):
            raise InvalidValueError(
                "policy 'scripted' needs a gripper's observations: use 'random' or 'zero'"
            )
        from thermograsp.report.scripted import ScriptedGrasp

        self._grasp = ScriptedGrasp(env.num_envs, env.unwrapped.dt)  # pyright: ignore[reportAttributeAccessIssue]

    def restart(self, seeds: Sequence[int]) -> None:
        self._grasp.restart(np.arange(len(seeds)))

    def action(self, observation: Any) -> np.ndarray:
        return self._grasp.action(observation)
