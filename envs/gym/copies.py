"""Copies of an environment, by pickle and copy.deepcopy: made anew from its keywords, and put into its state."""

from __future__ import annotations

from typing import Any

import numpy as np

from thermograsp.errors import InvalidValueError


class Copied:
    """What makes an environment picklable and copyable. A copy is another environment of the same keywords in the same
    state: both go on bit for bit alike, each with generators of its own. Attributes that were put on it are not
    copied. Raises InvalidValueError on hardware, of which there is but one."""

    batch: Any
    spec: Any
    _np_random: np.random.Generator | None
    _np_random_seed: int | None

    def __new__(cls, *args: Any, **keywords: Any) -> Any:
        env: Any = super().__new__(cls)
        env._keywords = args, dict(keywords)
        return env

    def __reduce__(self) -> tuple[Any, ...]:
        if not hasattr(self.batch.plant, "state"):
            raise InvalidValueError(
                "this environment cannot be copied or pickled: its plant is not simulated"
            )
        args, keywords = self._keywords  # pyright: ignore[reportAttributeAccessIssue]
        state = None if self.batch.reading is None else self.state()  # pyright: ignore[reportAttributeAccessIssue]
        drawing = self._np_random, self._np_random_seed
        return _rebuilt, (type(self), args, keywords, self.spec, drawing, state)


def _rebuilt(kind: type, args: Any, keywords: Any, spec: Any, drawing: tuple, state: Any) -> Any:
    env: Any = kind(*args, **keywords)
    env.spec = spec
    env._np_random, env._np_random_seed = drawing
    if state is not None:
        env.set_state(state)
    return env
