"""Arrays and functions for compiled code, by their addresses."""

from .arrays import chains, flags, floats, footprints, integers, laws, table, words
from .calls import asked, called, called_one, called_two, entry

__all__ = [
    "asked",
    "called",
    "called_one",
    "called_two",
    "chains",
    "entry",
    "flags",
    "floats",
    "footprints",
    "integers",
    "laws",
    "table",
    "words",
]
