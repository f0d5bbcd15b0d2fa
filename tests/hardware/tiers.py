"""Sizes of tests that come short and long: THERMOGRASP_LONG=1 (make test-hardware-long) chooses the long ones."""

import os
from typing import TypeVar

T = TypeVar("T")


def size(short: T, long: T) -> T:
    """The short one, unless the long tier was asked for."""
    return long if os.environ.get("THERMOGRASP_LONG") else short
