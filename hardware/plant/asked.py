"""What an episode with two real objects asks for, as whoever laid them there says it."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np

from thermograsp.errors import InvalidValueError, unknown_name

_OBJECTS = 2


class Asked:
    """goals: G names of what can be asked, as Sort-v0 has them; none for a plant that asks for nothing. truth: for one
    environment goal (1, G), 1 for what is asked, its name `asked`, and `right`, the number of the right object, where
    that was told."""

    def __init__(self, goals: Sequence[str]) -> None:
        self._goals = tuple(goals)
        self.truth: Mapping[str, np.ndarray] = {}

    @property
    def info_names(self) -> tuple[str, ...]:
        """Those of truth that info has."""
        return tuple(name for name in ("asked", "right") if name in self.truth)

    def begin(self, options: Mapping[str, Any]) -> None:
        """An episode. options: asked, one of the goals (may be left out where there is one only); right, 0 or 1, the
        object that is it, so that success can be told. Raises InvalidValueError and UnknownNameError."""
        known = ("asked", "right") if self._goals else ()
        if set(options) - set(known):
            has = f"has the reset options {', '.join(known)}" if known else "has no reset options"
            raise InvalidValueError(f"a serial plant {has}, got {sorted(options)}")
        if not self._goals:
            return
        asked = options.get("asked", self._goals[0] if len(self._goals) == 1 else None)
        if asked is None:
            raise InvalidValueError(
                "nobody knows what real objects are: say what is asked, reset(options={'asked': NAME}), one of "
                f"{', '.join(self._goals)}"
            )
        if asked not in self._goals:
            raise unknown_name("asked", asked, self._goals)
        goal = np.zeros((1, len(self._goals)))
        goal[0, self._goals.index(asked)] = 1.0
        truth = {"goal": goal, "asked": np.array([asked], object)}
        if "right" in options:
            if options["right"] not in range(_OBJECTS):
                raise InvalidValueError(
                    f"right must be 0, the object on the side of the lateral axis's positions below 0, or 1, got "
                    f"{options['right']!r}"
                )
            truth["right"] = np.array([int(options["right"])])
        self.truth = truth
