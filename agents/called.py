"""Policies of other packages, named as "module:callable". They get the observation and nothing else.

B: environments at once.
"""

from __future__ import annotations

import importlib
import sys
from collections.abc import Sequence
from typing import Any

import gymnasium
import numpy as np

from thermograsp.errors import InvalidValueError


class Called:
    """A function of the observations (B, ...) that returns actions (B, n), or a class without arguments whose instances
    are such functions: each batch of episodes gets a new one, which may remember what it has observed.

    The module may lie in the current folder. Raises InvalidValueError where there is no such callable, and for actions
    of another shape or that are not finite numbers. What the policy raises itself goes on with its own traceback."""

    def __init__(self, env: gymnasium.vector.VectorEnv, name: str) -> None:
        module, _, attribute = name.partition(":")
        if "" not in sys.path:
            sys.path.insert(0, "")
        try:
            self._made = getattr(importlib.import_module(module), attribute)
        except (ImportError, AttributeError, ValueError) as error:
            raise InvalidValueError(f"no policy {name!r}: {error}; give module:callable") from error
        if not callable(self._made):
            raise InvalidValueError(f"policy {name!r} is a {type(self._made).__name__}: give a callable")
        self._name, self._act = name, self._made
        self._shape = (env.num_envs, *(env.single_action_space.shape or ()))

    def restart(self, rows: Sequence[int] | np.ndarray, seeds: Sequence[int]) -> None:
        """Begins episodes in all rows together."""
        del seeds
        if isinstance(self._made, type):
            if len(rows) < self._shape[0]:
                raise InvalidValueError(f"policy {self._name!r} is a class: its episodes must begin together")
            self._act = self._made()

    def action(self, observation: Any) -> np.ndarray:
        """(B, n) float32 for copies of the observations."""
        given = {name: values.copy() for name, values in observation.items()}
        returned = self._act(given)
        try:
            action = np.asarray(returned, np.float32)
        except (TypeError, ValueError) as error:
            raise InvalidValueError(f"policy {self._name!r} returned no array of numbers: {error}") from error
        if action.shape != self._shape:
            raise InvalidValueError(
                f"policy {self._name!r} returned actions of shape {action.shape}: it must return {self._shape}"
            )
        if not np.isfinite(action).all():
            wrong = float(action[~np.isfinite(action)][0])
            raise InvalidValueError(f"policy {self._name!r} returned {wrong}: it must return finite numbers")
        return action
