"""Agents that learn the tasks: training, inputs, the teachers that they imitate at first, and scores."""

from typing import TYPE_CHECKING

from thermograsp.doors import opened

if TYPE_CHECKING:
    from thermograsp.agents.learning import training
    from thermograsp.agents.learning.agent import Agent, load_agent
    from thermograsp.agents.learning.recipe import Recipe
    from thermograsp.agents.learning.scoring import HELD_OUT, Score, score
    from thermograsp.agents.learning.tasks import TASKS, LearningTask, learning_task

__all__ = [
    "HELD_OUT",
    "TASKS",
    "Agent",
    "LearningTask",
    "Recipe",
    "Score",
    "learning_task",
    "load_agent",
    "score",
    "training",
]

__getattr__ = opened(__name__)
