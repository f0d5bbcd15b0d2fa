"""What a bad line does to frames on their way to the host."""

from __future__ import annotations

from dataclasses import dataclass, fields

import numpy as np

from thermograsp.errors import InvalidValueError


@dataclass(frozen=True, slots=True)
class LineFaults:
    """Chances a frame, 0 to 1: that a bit flips, a byte is lost, its end is missing, it is lost, it comes twice, its
    delimiters are lost so that it merges with the next, or 1 to 60 random bytes come before it; and that an
    acknowledgement is lost. answer_delay: s by which acknowledgements come late."""

    corrupt: float = 0.0
    drop_byte: float = 0.0
    truncate: float = 0.0
    drop_frame: float = 0.0
    duplicate: float = 0.0
    merge: float = 0.0
    garbage: float = 0.0
    drop_answer: float = 0.0
    answer_delay: float = 0.0

    def __post_init__(self) -> None:
        for field in fields(self):
            value = getattr(self, field.name)
            if not (0 <= value <= 1 or (field.name == "answer_delay" and 0 <= value < np.inf)):
                raise InvalidValueError(f"{field.name} must be a chance, 0 to 1, got {value!r}")

    def spoil(self, wire: bytes, rng: np.random.Generator) -> bytes:
        """What is left of a frame."""
        if self == _GOOD:
            return wire
        happens = {field.name: rng.random() < getattr(self, field.name) for field in fields(self)}
        spoiled = bytearray(wire)
        if happens["drop_frame"]:
            return b""
        if happens["corrupt"]:
            spoiled[rng.integers(len(spoiled))] ^= 1 << int(rng.integers(8))
        if happens["drop_byte"]:
            del spoiled[rng.integers(len(spoiled))]
        if happens["truncate"]:
            del spoiled[rng.integers(1, len(spoiled)) :]
        if happens["merge"]:
            spoiled = spoiled.strip(b"\0")
        if happens["duplicate"]:
            spoiled *= 2
        if happens["garbage"]:
            spoiled[:0] = rng.bytes(int(rng.integers(1, 61)))
        return bytes(spoiled)


_GOOD = LineFaults()
