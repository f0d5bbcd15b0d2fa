"""The samples of an episode as columns, the newest ones kept."""

from __future__ import annotations

from collections import deque
from collections.abc import Mapping

import numpy as np

LONGEST = 600.0  # s


class Log:
    """Keeps the last `most` control steps. names: of the columns, `time_s` first, once there are any. steps: added so
    far."""

    def __init__(self, most: int) -> None:
        self.names: tuple[str, ...] = ()
        self.steps = 0
        self._blocks: deque[np.ndarray] = deque(maxlen=most)

    def add(self, columns: Mapping[str, np.ndarray]) -> None:
        """The columns (B, S) of one control step."""
        self.names = tuple(columns)
        self.steps += 1
        self._blocks.append(np.stack([np.asarray(column, float) for column in columns.values()]))

    def since(self, step: int) -> dict[str, np.ndarray]:
        """Columns (B, N) of what came after that many steps, as far as it is kept."""
        new = min(self.steps - step, len(self._blocks))
        if new <= 0:
            return {}
        blocks = [self._blocks[k] for k in range(len(self._blocks) - new, len(self._blocks))]
        return dict(zip(self.names, np.concatenate(blocks, axis=2), strict=True))
