"""Episodes of a vector environment, each from its own seed, so that nothing depends on how many run at once.

B: environments at once.
"""

from __future__ import annotations

import hashlib
import time
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Any

import gymnasium
import numpy as np

from thermograsp.agents.checks import Violation, violations
from thermograsp.agents.policies import Policy
from thermograsp.agents.policies import policy as named_policy
from thermograsp.errors import InvalidValueError, whole_number


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


def rollout(
    env: gymnasium.vector.VectorEnv,
    episodes: int,
    seed: int,
    policy: str | Policy = "scripted",
    max_steps: int | None = None,
    check: bool = False,
    advance: Callable[[str, float], None] = lambda doing, by: None,
) -> Rollout:
    """Runs episodes 0 .. episodes - 1; episode k is reset with seed + k. policy: its name, or one made for `env`.
    advance: called with progress, in episodes.

    Without `check` only broken simulations are violations. Raises UnknownNameError and InvalidValueError."""
    whole_number("episodes", episodes, 1)
    whole_number("seed", seed)
    if max_steps is not None:
        whole_number("max_steps", max_steps, 1)
    if not isinstance(env, gymnasium.vector.VectorEnv):
        raise InvalidValueError(
            f"env must be a vector environment, got {env!r}: make one by gymnasium.make_vec('thermograsp/Grasp-v0', 4, "
            "vectorization_mode='vector_entry_point')"
        )
    acting = named_policy(env, policy) if isinstance(policy, str) else policy
    digests, found, returns = [], [], []
    steps = successes = 0
    wall = 0.0
    for first in range(0, episodes, env.num_envs):
        wanted = min(env.num_envs, episodes - first)
        seeds = [seed + first + i for i in range(env.num_envs)]
        observation, _ = env.reset(seed=seeds)  # pyright: ignore[reportArgumentType]
        acting.restart(range(env.num_envs), seeds)
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
