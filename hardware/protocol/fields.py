"""Messages as packed little-endian structs: what a dataclass's fields are on the wire."""

from __future__ import annotations

import math
import struct
from collections.abc import Iterator
from dataclasses import dataclass
from typing import Any

import numpy as np

from thermograsp.errors import InvalidValueError

_LETTERS = {"u1": "B", "u2": "H", "u4": "I", "u8": "Q", "i2": "h", "i4": "i"}


@dataclass(frozen=True, slots=True)
class Field:
    """How one attribute of a message is coded in bytes. name: of the message's attribute. kind: u1, u2, u4, u8, i2, i4,
    as numpy names them. per_unit: steps of the integer in one SI unit (°C for temperatures); 0 where the attribute is
    the integer. shape: of an array, C order.

    A signed field with per_unit carries NaN as its lowest value."""

    name: str
    kind: str
    per_unit: float = 0
    shape: tuple[int, ...] = ()

    @property
    def count(self) -> int:
        """Numbers in the field."""
        return math.prod(self.shape)

    @property
    def bounds(self) -> tuple[int, int]:
        """Lowest and highest integer of a value."""
        bits = 8 * int(self.kind[1])
        if self.kind[0] == "u":
            return 0, 2**bits - 1
        return -(2 ** (bits - 1)) + bool(self.per_unit), 2 ** (bits - 1) - 1

    @property
    def missing(self) -> int | None:
        """The integer that stands for NaN."""
        return self.bounds[0] - 1 if self.kind[0] == "i" and self.per_unit else None


class Layout:
    """The fields of one message, in order, without gaps."""

    def __init__(self, *fields: Field) -> None:
        self.fields = fields
        self.struct = struct.Struct("<" + "".join(f"{field.count}{_LETTERS[field.kind]}" for field in fields))
        self.dtype = np.dtype([(field.name, f"<{field.kind}", field.shape) for field in fields])

    def pack(self, message: object) -> bytes:
        """The attributes of a message as bytes. Raises InvalidValueError for one that its field cannot hold."""
        return self.struct.pack(
            *(
                _integer(field, value)
                for field in self.fields
                for value in _flat(getattr(message, field.name), len(field.shape))
            )
        )

    def unpack(self, payload: bytes) -> dict[str, Any]:
        """The attributes by name: int, float, or nested tuples of them. payload: of the struct's size."""
        numbers = iter(self.struct.unpack(payload))
        return {field.name: _shaped(field, numbers, field.shape) for field in self.fields}

    def columns(self, payloads: bytes) -> dict[str, np.ndarray]:
        """Many payloads in a row as arrays by name, (n, *shape) each: floats with per_unit, else integers."""
        rows = np.frombuffer(payloads, self.dtype)
        return {field.name: _column(field, rows[field.name]) for field in self.fields}


def _flat(value: Any, depth: int) -> Iterator[Any]:
    if depth == 0:
        yield value
    else:
        for item in value:
            yield from _flat(item, depth - 1)


def _shaped(field: Field, numbers: Iterator[int], shape: tuple[int, ...]) -> Any:
    if shape:
        return tuple(_shaped(field, numbers, shape[1:]) for _ in range(shape[0]))
    number = next(numbers)
    if not field.per_unit:
        return number
    return math.nan if number == field.missing else number / field.per_unit


def _integer(field: Field, value: float) -> int:
    low, high = field.bounds
    if math.isnan(value):
        if field.missing is None:
            raise InvalidValueError(f"{field.name} must be a number, got nan")
        return field.missing
    scale = field.per_unit or 1
    number = value * scale
    if not low - 0.5 <= number <= high + 0.5:
        raise InvalidValueError(f"{field.name} must be {low / scale:g} to {high / scale:g}, got {value!r}")
    return min(max(round(number), low), high)


def _column(field: Field, numbers: np.ndarray) -> np.ndarray:
    if not field.per_unit:
        return numbers
    values = numbers / field.per_unit
    if field.missing is not None:
        values[numbers == field.missing] = np.nan
    return values
