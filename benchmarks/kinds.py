"""What every benchmark takes and returns."""

from __future__ import annotations

from collections.abc import Callable
from contextlib import AbstractContextManager
from typing import Any

Record = dict[str, Any]
"""What a benchmark measured, by name_unit. Written as JSON and read back before anything is printed or drawn: lists in
place of arrays, None in place of a number that is not finite, and text as the keys of dictionaries."""

Progress = Callable[[float], AbstractContextManager[Callable[[str, float], None]]]
"""progress(total) yields what is called with what is being done, and by how much it advanced."""
