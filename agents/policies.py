"""Policies of a vector environment, by name.

B: environments at once.
"""

from __future__ import annotations

import copy
from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any, Protocol

import gymnasium
import numpy as np

from thermograsp.assets import ROOT
from thermograsp.errors import InvalidValueError, unknown_name

if TYPE_CHECKING:
    from thermograsp.agents.learning.agent import Agent

POLICIES = ("scripted", "feeling", "trained", "random", "zero")


class Policy(Protocol):
    """What acts. An episode's actions depend on its seed and observations alone, not on its row."""

    def restart(self, rows: Sequence[int] | np.ndarray, seeds: Sequence[int]) -> None:
        """The rows begin episodes of these seeds, one each."""
        ...

    def action(self, observation: Any) -> np.ndarray:
        """Actions (B, ...) for the observations of all environments."""
        ...


def policy(env: gymnasium.vector.VectorEnv, name: str) -> Policy:
    """The policy of that name, of a file of a trained one, or of "module:callable" (see called.py). Raises
    UnknownNameError, and InvalidValueError where there is none or it cannot act in `env`."""
    if not isinstance(name, str):
        raise unknown_name("policy", name, POLICIES)
    if name == "trained" or name.endswith(".npz"):
        return _of_file(env, shipped(env) if name == "trained" else name)
    if ":" in name:
        from thermograsp.agents.called import Called

        return Called(env, name)
    if name not in POLICIES:
        raise unknown_name("policy", name, POLICIES)
    if name in ("scripted", "feeling"):
        return _Scripted(env, name)
    return {"random": _Random, "zero": _Zero}[name](env)


def shipped(env: gymnasium.vector.VectorEnv) -> Path:
    """The file of the trained policy for the task of `env`. Raises InvalidValueError where there is none."""
    from thermograsp.agents.learning.tasks import task_name_of

    folder, task = ROOT / "policies", task_name_of(env)
    path = folder / f"{task}_heat_no-load.npz"
    if not path.exists():
        known = ", ".join(sorted(each.stem.split("_")[0] for each in folder.glob("*.npz")))
        raise InvalidValueError(
            f"no trained policy fits this environment; there are some for {known}. `thermograsp train` makes others: "
            "give its policy.npz"
        )
    return path


def load_policy(path: str | Path) -> Agent:
    """A trained policy's file, of `thermograsp train`. Raises InvalidValueError where there is none."""
    from thermograsp.agents.learning.agent import load_agent

    return load_agent(path)


def _of_file(env: gymnasium.vector.VectorEnv, path: str | Path) -> Policy:
    from thermograsp.agents.learning.agent import Acting

    return Acting(env, load_policy(path))


class _Zero:
    """Zeros: of the grasp environments the middle of each command."""

    def __init__(self, env: gymnasium.vector.VectorEnv) -> None:
        sample = env.action_space.sample()
        self._action = np.zeros_like(sample)

    def restart(self, rows: Sequence[int] | np.ndarray, seeds: Sequence[int]) -> None:
        del rows, seeds

    def action(self, observation: Any) -> np.ndarray:
        del observation
        return self._action


class _Random:
    """Uniform, each environment from a generator of its episode's seed."""

    def __init__(self, env: gymnasium.vector.VectorEnv) -> None:
        self._spaces = [copy.deepcopy(env.single_action_space) for _ in range(env.num_envs)]

    def restart(self, rows: Sequence[int] | np.ndarray, seeds: Sequence[int]) -> None:
        for row, seed in zip(rows, seeds, strict=True):
            self._spaces[row].seed(seed)

    def action(self, observation: Any) -> np.ndarray:
        del observation
        return np.stack([space.sample() for space in self._spaces])


class _Scripted:
    """Closes, lifts and holds, "feeling" with a force that fits what it feels; for environments that observe and act as
    Grasp-v0 does. In Sort-v0 it feels what it lifts under either name."""

    def __init__(self, env: gymnasium.vector.VectorEnv, name: str) -> None:
        space = env.single_observation_space
        if not (isinstance(space, gymnasium.spaces.Dict) and {"force", "gripper"} <= set(space.spaces)):
            raise InvalidValueError(f"policy {name!r} needs a gripper's observations: use 'random' or 'zero'")
        if "goal" in space.spaces:
            from thermograsp.agents.scripted_sort import ScriptedSort

            self._grasp = ScriptedSort(env.unwrapped.batch)  # pyright: ignore[reportAttributeAccessIssue]
            return
        from thermograsp.agents.scripted import FeelingGrasp, ScriptedGrasp

        grasp = ScriptedGrasp if name == "scripted" else FeelingGrasp
        self._grasp = grasp(env.num_envs, env.unwrapped.dt)  # pyright: ignore[reportAttributeAccessIssue]

    def restart(self, rows: Sequence[int] | np.ndarray, seeds: Sequence[int]) -> None:
        del seeds
        self._grasp.restart(np.asarray(rows, int))

    def action(self, observation: Any) -> np.ndarray:
        return self._grasp.action(observation)
