"""Learnt agents as small files of arrays, which need NumPy alone to act.

B: environments at once.
"""

from __future__ import annotations

import json
from collections.abc import Mapping, Sequence
from dataclasses import asdict, dataclass
from pathlib import Path
from typing import Any
from zipfile import BadZipFile

import gymnasium
import numpy as np

from thermograsp.errors import InvalidValueError
from thermograsp.files import atomic_write

from .inputs import REPEAT, Inputs, Memory


@dataclass(frozen=True, slots=True)
class Agent:
    """layers: (weight (out, in), bias (out,)) each, with tanh between them. task: of TASKS. about: how it was
    trained."""

    task: str
    inputs: Inputs
    layers: tuple[tuple[np.ndarray, np.ndarray], ...]
    about: dict[str, Any]

    def decide(self, vector: np.ndarray) -> np.ndarray:
        """(B, n) in -1 .. 1 for inputs (B, size). A row's result does not depend on the others."""
        rows = []
        # A product of matrices is rounded differently for different numbers of rows.
        for values in vector:
            for at, (weight, bias) in enumerate(self.layers):
                values = weight @ (np.tanh(values) if at else values) + bias
            rows.append(values)
        return np.clip(np.stack(rows), -1.0, 1.0).astype(np.float32)

    def save(self, path: str | Path) -> Path:
        """Writes an .npz file, with weights as float16: half the size, and 3 digits of each."""
        arrays: dict[str, Any] = {}
        for at, (weight, bias) in enumerate(self.layers):
            arrays[f"weight_{at}"], arrays[f"bias_{at}"] = weight.astype(np.float16), bias.astype(np.float32)
        text = json.dumps({"task": self.task, "inputs": asdict(self.inputs), "about": self.about})
        with atomic_write(path) as temporary:
            np.savez_compressed(temporary, agent=np.array(text), **arrays)
        return Path(path)


def load_agent(path: str | Path) -> Agent:
    """Of a file that `Agent.save` wrote. Raises InvalidValueError where there is none."""
    try:
        with np.load(path, allow_pickle=False) as file:
            setup = json.loads(str(file["agent"]))
            count = sum(name.startswith("weight_") for name in file.files)
            layers = tuple(
                (file[f"weight_{at}"].astype(np.float32), file[f"bias_{at}"]) for at in range(count)
            )
        agent = Agent(setup["task"], Inputs(**setup["inputs"]), layers, setup["about"])
    except FileNotFoundError as error:
        raise InvalidValueError(f"no file {path}: give one that `thermograsp train` wrote") from error
    except (AttributeError, EOFError, KeyError, OSError, TypeError, ValueError, BadZipFile) as error:
        raise InvalidValueError(f"{path} holds no trained policy: {error}") from error
    sizes = [agent.inputs.size, *(len(bias) for _, bias in layers)]
    if not layers or [weight.shape for weight, _ in layers] != list(zip(sizes[1:], sizes[:-1], strict=True)):
        raise InvalidValueError(f"{path} holds no trained policy: its layers do not fit together")
    return agent


class Acting:
    """An agent as a policy of a vector environment. Raises InvalidValueError where its actions or what it is asked do
    not fit."""

    def __init__(self, env: gymnasium.vector.VectorEnv, agent: Agent) -> None:
        shape, actions = env.single_action_space.shape, len(agent.layers[-1][1])
        goals = goals_of(env)
        if shape != (actions,) or goals != agent.inputs.goals:
            raise InvalidValueError(
                f"an agent for {agent.task!r} gives actions of {actions} numbers and is asked for one of "
                f"{agent.inputs.goals} things, but the environment takes {shape} and asks for one of {goals}"
            )
        self._agent, self._memory = agent, Memory(agent.inputs, env.num_envs)
        self._action = np.zeros((env.num_envs, actions), np.float32)
        self._taken = np.zeros(env.num_envs, int)

    def restart(self, rows: Sequence[int] | np.ndarray, seeds: Sequence[int]) -> None:
        """Begins episodes."""
        del seeds
        self._memory.restart(np.asarray(rows, int))
        self._taken[np.asarray(rows, int)] = 0

    def action(self, observation: Mapping[str, np.ndarray]) -> np.ndarray:
        """(B, n): decided anew every REPEAT steps."""
        deciding = np.flatnonzero(self._taken % REPEAT == 0)
        if len(deciding):
            self._action = self._action.copy()
            self._action[deciding] = self._agent.decide(self._memory.vector(observation, deciding))
        self._taken += 1
        return self._action


def goals_of(env: gymnasium.vector.VectorEnv) -> int:
    """Numbers by which an environment says what it asks for."""
    space = env.single_observation_space
    if isinstance(space, gymnasium.spaces.Dict) and "goal" in space.spaces:
        return (space["goal"].shape or (0,))[0]
    return 0
