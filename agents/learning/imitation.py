"""The first part of a training: an agent acts, and learns what a teacher would have done (DAgger).

Ross S., Gordon G. & Bagnell D., A Reduction of Imitation Learning and Structured Prediction to No-Regret Online
Learning, AISTATS 2011. B: environments, T: decisions of each.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import numpy as np

from thermograsp.errors import MissingDependencyError, install

try:
    import torch  # pyright: ignore[reportMissingImports]
except ImportError as error:
    raise MissingDependencyError(f"PyTorch is not installed: {install('rl')}") from error

from .inputs import REPEAT
from .perceiving import Perceiving
from .recipe import Recipe
from .teachers import Teacher

_STILL = 0.01
"""Added to an input's deviation, so that one that never changes counts little."""


@dataclass(frozen=True, slots=True)
class Seen:
    """vector: (N, size) inputs. right: (N, n) what the teacher would do, nan
    where it has no opinion. gained: (N,) discounted rewards to the end of
    the episode; nan where it did not end."""

    vector: np.ndarray
    right: np.ndarray
    gained: np.ndarray

    def and_also(self, other: Seen) -> Seen:
        """Both."""
        return Seen(
            np.concatenate([self.vector, other.vector]),
            np.concatenate([self.right, other.right]),
            np.concatenate([self.gained, other.gained]),
        )


def watched(
    env: Perceiving,
    teacher: Teacher,
    agent: Callable[[np.ndarray], np.ndarray] | None,
    decisions: int,
    gamma: float,
    advance: Callable[[int], None],
) -> Seen:
    """T = `decisions` of each environment from a reset on. agent: acts in three of four environments, the teacher in
    the others; None: the teacher acts in all. advance: called with the control steps done."""
    vector: Any = env.reset()
    rows = np.arange(env.num_envs)
    taught = rows % 4 == 0 if agent is not None else np.ones(env.num_envs, bool)
    teacher.restart(rows)
    vectors, rights, rewards, ends = [], [], [], []
    for _ in range(decisions):
        learner = None if agent is None else agent(vector)
        right = np.clip(teacher.action(env.raw, learner), -1.0, 1.0)
        shown = np.nan_to_num(right, nan=-1.0)
        action = shown if learner is None else np.where(taught[:, None], shown, learner)
        vectors.append(vector)
        rights.append(right)
        vector, reward, ended, _ = env.step(action)
        rewards.append(reward)
        ends.append(ended)
        teacher.restart(np.flatnonzero(ended))
        advance(env.num_envs * REPEAT)
    gained, after = np.zeros((decisions, env.num_envs), np.float32), np.full(env.num_envs, np.nan)
    for at in range(decisions - 1, -1, -1):
        after = rewards[at] + gamma * np.where(ends[at], 0.0, after)
        gained[at] = after
    return Seen(np.concatenate(vectors), np.concatenate(rights).astype(np.float32), gained.ravel())


def imitate(
    policy: Any, seen: Seen, minibatches: int, recipe: Recipe, seed: int, averaged: slice = slice(0)
) -> float:
    """Fits a policy of stable-baselines3, its mean actions to the teacher's and its values to what was gained; returns
    the mean error of the actions over the last pass. averaged: see Teacher.

    Descent works on inputs of mean 0 and deviation 1: what the voltages do late in a touch is small, but tells most."""
    generator = torch.Generator().manual_seed(seed)
    count = len(seen.vector)
    mean = seen.vector.mean(axis=0)
    scale = 1.0 / (seen.vector.std(axis=0) + _STILL)
    first = policy.mlp_extractor.policy_net[0], policy.mlp_extractor.value_net[0]
    for layer in first:
        _of_other_inputs(layer, -mean * scale, 1.0 / scale)
    optimizer = torch.optim.Adam(policy.parameters(), lr=recipe.imitation_rate)
    falling = torch.optim.lr_scheduler.CosineAnnealingLR(optimizer, minibatches)
    vector = torch.from_numpy((seen.vector - mean) * scale)
    right, gained = torch.from_numpy(seen.right), torch.from_numpy(seen.gained)
    squared = torch.zeros(right.shape[1], dtype=torch.bool)
    squared[averaged] = True
    errors = []
    for _ in range(minibatches):
        chosen = torch.randint(count, (min(recipe.batch, count),), generator=generator)
        acting, valuing = policy.mlp_extractor(vector[chosen])
        wanted = right[chosen]
        deviation = (
            policy.action_net(acting) - wanted.nan_to_num()
        )  # not even a NaN without weight has a gradient
        errors_of = torch.where(squared, deviation**2, _even(deviation.abs(), recipe.even_from))
        error = errors_of[~wanted.isnan()].mean()
        known = ~gained[chosen].isnan()
        loss = error
        if known.any():
            value = policy.value_net(valuing)[:, 0]
            loss = error + ((value - gained[chosen])[known] ** 2).mean()
        optimizer.zero_grad()
        loss.backward()
        optimizer.step()
        falling.step()
        errors.append(error.item())
    for layer in first:
        _of_other_inputs(layer, mean, scale)
    return float(np.mean(errors[-max(count // recipe.batch, 1) :]))


def _even(size: Any, even_from: float) -> Any:
    """Errors that count by their size, below `even_from` by their square."""
    return torch.where(size < even_from, size**2 / (2 * even_from), size - even_from / 2)


def _of_other_inputs(layer: Any, mean: np.ndarray, scale: np.ndarray) -> None:
    """A linear layer of (x - mean) scale becomes one of x that does the same."""
    with torch.no_grad():
        layer.weight *= torch.from_numpy(scale)
        layer.bias -= layer.weight @ torch.from_numpy(mean)
