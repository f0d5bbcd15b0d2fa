"""The tasks that agents learn, by short names."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field, replace
from types import MappingProxyType
from typing import Any

import gymnasium

import thermograsp  # noqa: F401  registers the environments
from thermograsp.envs import EVERYTHING, STAKES
from thermograsp.errors import unknown_name


@dataclass(frozen=True, slots=True)
class LearningTask:
    """An environment and its keywords. name: of this task, as in `thermograsp train NAME`. practice: keywords that are
    different while a teacher is imitated."""

    name: str
    env_id: str
    keywords: Mapping[str, Any]
    practice: Mapping[str, Any] = field(default_factory=dict)

    def make(self, num_envs: int, practice: bool = False) -> gymnasium.vector.VectorEnv:
        """`num_envs` of them in one array step."""
        keywords = {**self.keywords, **(self.practice if practice else {})}
        return gymnasium.make_vec(
            self.env_id, num_envs=num_envs, vectorization_mode="vector_entry_point", **keywords
        )

    def drawn(self) -> LearningTask:
        """The same, with all drawn that can differ between episodes (envs.EVERYTHING)."""
        return replace(self, keywords={**self.keywords, "randomize": EVERYTHING})


TASKS: Mapping[str, LearningTask] = MappingProxyType(
    {
        each.name: each
        for each in (
            # No success ends practice, so that the agent learns to go on holding.
            LearningTask("grasp", "thermograsp/Grasp-v0", STAKES, {"hold_seconds": STAKES["seconds"]}),
            LearningTask("identify", "thermograsp/Identify-v0", {}),
            LearningTask("sort", "thermograsp/Sort-v0", {}),
            LearningTask("hotter", "thermograsp/Sort-v0", {"goal": "hotter"}),
        )
    }
)
"""grasp: Grasp-v0 with stakes. identify: ten materials. sort: the requested one of ten materials. hotter: the hotter
one of two objects of one material."""


def learning_task(name: str) -> LearningTask:
    """The task of that name, or the first of that environment. Raises UnknownNameError."""
    for task in TASKS.values():
        if name in (task.name, task.env_id):
            return task
    raise unknown_name("task", name, TASKS)


def task_name_of(env: gymnasium.vector.VectorEnv) -> str | None:
    """Which of TASKS an environment's spaces are those of; None for any other."""
    observed = env.single_observation_space
    if not (isinstance(observed, gymnasium.spaces.Dict) and {"gripper", "voltage"} <= set(observed.spaces)):
        return None
    goals = (observed["goal"].shape or (0,))[0] if "goal" in observed.spaces else 0
    (actions,) = env.single_action_space.shape or (0,)
    return {(3, 0): "grasp", (12, 0): "identify", (4, 10): "sort", (4, 1): "hotter"}.get((actions, goals))
