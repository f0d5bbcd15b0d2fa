"""How much of the wall's time goes into which part of a step."""

from __future__ import annotations

import time
from typing import Any


class Stopwatch:
    """Adds up the seconds spent in methods that it was put on, by label."""

    def __init__(self) -> None:
        self.seconds: dict[str, float] = {}

    def put_on(self, owner: Any, method: str, label: str) -> None:
        """From now on every call of owner.method counts under `label`."""
        original = getattr(owner, method)
        self.seconds.setdefault(label, 0.0)

        def timed(*args: Any, **keywords: Any) -> Any:
            begun = time.perf_counter()
            try:
                return original(*args, **keywords)
            finally:
                self.seconds[label] += time.perf_counter() - begun

        setattr(owner, method, timed)
