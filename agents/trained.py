"""Trained policies of a grasp in the older form, without a memory: small networks kept as arrays, which need NumPy
alone to act. learning/agent.py has the newer form.

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

from thermograsp.envs.spaces import SIZE, Senses, arm_waits
from thermograsp.errors import InvalidValueError
from thermograsp.files import atomic_write


@dataclass(frozen=True, slots=True)
class Network:
    """layers: (weight (out, in), bias (out,)) each, with tanh between them; inputs are those of `senses`, the arm waits
    for the fingers, and an action lasts `repeat` control steps. about: how it was trained."""

    layers: tuple[tuple[np.ndarray, np.ndarray], ...]
    senses: Senses
    repeat: int
    about: dict[str, Any]

    def action(self, observation: Mapping[str, np.ndarray]) -> np.ndarray:
        """(B, 3) float32 in -1 .. 1 for observations (B, ...). A row's result does not depend on the others."""
        values = self.senses.vector(observation)
        for at, (weight, bias) in enumerate(self.layers):
            if at:
                values = np.tanh(values)
            # matmul's rounding depends on how many rows there are.
            values = (values[:, None, :] * weight).sum(axis=-1) + bias
        return arm_waits(observation, np.clip(values, -1.0, 1.0))

    def save(self, path: str | Path) -> Path:
        """Writes an .npz file."""
        arrays: dict[str, Any] = {}
        for at, (weight, bias) in enumerate(self.layers):
            arrays[f"weight_{at}"], arrays[f"bias_{at}"] = weight.astype(np.float32), bias.astype(np.float32)
        text = json.dumps({"senses": asdict(self.senses), "repeat": self.repeat, "about": self.about})
        with atomic_write(path) as temporary:
            np.savez_compressed(temporary, setup=np.array(text), **arrays)
        return Path(path)


def load_network(path: str | Path) -> Network:
    """Of a file that `Network.save` wrote. Raises InvalidValueError where there is none."""
    try:
        with np.load(path, allow_pickle=False) as file:
            setup = json.loads(str(file["setup"]))
            count = sum(name.startswith("weight_") for name in file.files)
            layers = tuple((file[f"weight_{at}"], file[f"bias_{at}"]) for at in range(count))
        network = Network(layers, Senses(**setup["senses"]), int(setup["repeat"]), setup["about"])
    except FileNotFoundError as error:
        raise InvalidValueError(f"no file {path}: give one that `thermograsp train` wrote") from error
    except (AttributeError, EOFError, KeyError, OSError, TypeError, ValueError, BadZipFile) as error:
        raise InvalidValueError(f"{path} holds no trained policy: {error}") from error
    sizes = [SIZE, *(len(bias) for _, bias in layers)]
    if not layers or [weight.shape for weight, _ in layers] != list(zip(sizes[1:], sizes[:-1], strict=True)):
        raise InvalidValueError(f"{path} holds no trained policy: its layers do not fit together")
    return network


class Trained:
    """A network as a policy of a vector environment. Raises InvalidValueError where its actions do not fit."""

    def __init__(self, env: gymnasium.vector.VectorEnv, path: str | Path) -> None:
        self._network = load_network(path)
        shape, actions = env.single_action_space.shape, len(self._network.layers[-1][1])
        if shape != (actions,):
            raise InvalidValueError(
                f"{path} gives actions of {actions} numbers, but the environment takes {shape}"
            )
        self._action = np.zeros((env.num_envs, actions), np.float32)
        self._taken = np.zeros(env.num_envs, int)

    def restart(self, rows: Sequence[int] | np.ndarray, seeds: Sequence[int]) -> None:
        """Begins episodes."""
        del seeds
        self._taken[np.asarray(rows, int)] = 0

    def action(self, observation: Any) -> np.ndarray:
        """(B, actions): decided anew every `repeat` steps."""
        deciding = self._taken % self._network.repeat == 0
        if deciding.any():
            decided = self._network.action(observation)
            self._action = np.where(deciding[:, None], decided, self._action)
        self._taken += 1
        return self._action
