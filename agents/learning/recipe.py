"""How agents are trained: one set of numbers for all tasks and grippers."""

from __future__ import annotations

from dataclasses import dataclass


@dataclass(frozen=True, slots=True)
class Recipe:
    """First an agent imitates a teacher that is told the truth, then PPO goes on with the task's own reward.

    steps: control steps of all environments together, both parts. taught: share of them for the first part, in
    `rounds`; in the first round the teacher acts, in the others the agent does in three of four episodes, and the
    teacher says in all of them what it would do. minibatches: of each round but the last, of all that has been seen so
    far; last_minibatches: of the last one, after which nothing is seen that could make up for what was not learned.
    even_from: error of a movement, of -1 .. 1, from which on it counts by its size rather than its square.
    hidden: tanh units of each layer. noise: logarithm of the standard deviation of PPO's actions at the start.
    decisions: of each environment between two updates of PPO. checkpoints: evaluations, evenly over PPO's steps.
    evaluated: episodes of each.
    """

    steps: int = 400_000
    taught: float = 0.95
    rounds: int = 6
    minibatches: int = 1500
    last_minibatches: int = 15_000
    even_from: float = 0.1
    imitation_rate: float = 3e-3
    num_envs: int = 32
    hidden: tuple[int, ...] = (128, 128)
    noise: float = -3.0
    decisions: int = 96
    batch: int = 512
    epochs: int = 4
    learning_rate: float = 1e-4
    gamma: float = 0.99
    gae_lambda: float = 0.95
    clip: float = 0.1
    target_kl: float = 0.01
    checkpoints: int = 4
    evaluated: int = 192
