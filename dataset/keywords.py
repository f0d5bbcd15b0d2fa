"""Keywords of an environment as JSON, so that a manifest can hold them: numbers, text, lists, and the records of
thermograsp.envs and thermograsp.thermal, such as ObjectSpec and Roughness."""

from __future__ import annotations

import dataclasses
from collections.abc import Mapping
from functools import cache
from types import MappingProxyType
from typing import Any

import numpy as np

import thermograsp.envs
import thermograsp.thermal
from thermograsp.errors import InvalidValueError, unknown_name

_RECORD = "record"
"""The entry of an object of JSON that names the record whose fields the others are."""


@cache
def _records() -> Mapping[str, type]:
    """The public records by name: what a manifest names is one of these, and nothing else is ever made from it."""
    found = {
        name: getattr(package, name)
        for package in (thermograsp.envs, thermograsp.thermal)
        for name in package.__all__
    }
    return MappingProxyType(
        {n: one for n, one in found.items() if isinstance(one, type) and dataclasses.is_dataclass(one)}
    )


def encoded(value: Any, name: str = "keyword") -> Any:
    """As JSON holds it; tuples become lists. Raises InvalidValueError for what it cannot."""
    if value is None or isinstance(value, bool | int | float | str):
        return value
    if isinstance(value, np.generic | np.ndarray):
        return encoded(value.tolist(), name)
    if isinstance(value, list | tuple | range):
        return [encoded(one, name) for one in value]
    if isinstance(value, Mapping):
        return {str(key): encoded(one, f"{name} {key}") for key, one in value.items()}
    kind = type(value).__name__
    if _records().get(kind) is type(value):
        fields = {
            one.name: encoded(getattr(value, one.name), f"{name}.{one.name}")
            for one in dataclasses.fields(value)
            if one.init
        }
        return {_RECORD: kind, **fields}
    raise InvalidValueError(
        f"{name} {value!r} ({kind}) cannot be kept in a manifest: use numbers, text, lists or the records of "
        "thermograsp.envs; for a gripper or a sensor the name of its file"
    )


def decoded(value: Any) -> Any:
    """The value that was encoded; lists become tuples. Raises InvalidValueError and UnknownNameError."""
    if isinstance(value, list):
        return tuple(decoded(one) for one in value)
    if not isinstance(value, Mapping):
        return value
    fields = {key: decoded(one) for key, one in value.items()}
    kind = fields.pop(_RECORD, None)
    if kind is None:
        return fields
    if kind not in _records():
        raise unknown_name("record", kind, _records())
    try:
        return _records()[kind](**fields)
    except TypeError as error:
        raise InvalidValueError(f"cannot make {kind} of {fields}: {error}") from error
