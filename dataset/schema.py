"""The Arrow schema: one row an episode, because an episode is what a seed makes.

It is the unit that is drawn, filtered and counted, and it is never split between files. What holds for all of it
(material, success) stands there once; a step's values are lists in the order of time, one column a quantity, so that a
reader takes only what it needs.

T: steps of an episode. A list column `per` observation has T + 1 items, the reset's first; one `per` step has T.
Each item is a fixed-size list where the quantity is an array: `shape` in the field's metadata, C order.
"""

from __future__ import annotations

import json
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any, Literal

import gymnasium
import numpy as np

from thermograsp.dataset.plan import Plan
from thermograsp.errors import InvalidValueError, MissingDependencyError, install

Per = Literal["episode", "step", "observation"]
KEY = b"thermograsp"
"""The schema's metadata holds the plan under this name, as JSON, but for the number of episodes."""

_OBSERVED: Mapping[str, tuple[str, str]] = {
    "gripper": ("m, m/s, m, N", "opening, its rate, height, commanded force"),
    "force": ("N", "normal and two tangential per fingertip, pad frame"),
    "voltage": ("V", "per fingertip, after the ADC, oldest first"),
    "thermostat": ("degC", "per fingertip"),
    "lateral": ("m", "of the arm along the table"),
    "goal": ("", "1 for what is asked, 0 for the others"),
    "pressure": ("Pa", "over each pad: rows up to the wrist, columns across"),
    "face_temperature": ("degC", "over each sensor's face: rows and columns alike"),
}
_TRUTH: Mapping[str, tuple[str, str]] = {
    "temperature_drop": ("K", "across the sensor, per fingertip, without noise"),
    "contact_area": ("m2", "of the patch on the sensor, per fingertip"),
    "conductance": ("W/(m2 K)", "of the contact, per fingertip"),
}
TRUTH = tuple(_TRUTH)


@dataclass(frozen=True, slots=True)
class Column:
    """Type, shape and unit of a column. dtype: of an item, "str" for text. shape: of an item. unit: "" where there is
    none."""

    name: str
    per: Per
    dtype: str
    shape: tuple[int, ...] = ()
    unit: str = ""
    description: str = ""


_EPISODE = (
    Column("seed", "episode", "int64", description="that the environment was reset with; identifies the row"),
    Column("material", "episode", "str", description="of the object; its properties are in the metadata"),
    Column("rung", "episode", "str", description="thermal model that was used"),
    Column("steps", "episode", "int32", description="control steps, T"),
    Column("return", "episode", "float64", description="sum of the rewards"),
    Column("success", "episode", "bool", description="lifted and held"),
    Column(
        "ending", "episode", "str", description="success, dropped, crushed, error, terminated or truncated"
    ),
    Column("error", "episode", "str", description="why the simulation broke down, else empty"),
    Column("terminated", "episode", "bool", description="at the last step"),
    Column("truncated", "episode", "bool", description="at the last step"),
    Column("version", "episode", "str", description="of thermograsp"),
)


def columns(observation: gymnasium.Space, action: gymnasium.Space) -> tuple[Column, ...]:
    """All columns for an environment of these (single) spaces: a Dict of boxes, and a Box.

    Raises InvalidValueError for other spaces."""
    if not isinstance(observation, gymnasium.spaces.Dict) or not isinstance(action, gymnasium.spaces.Box):
        raise InvalidValueError(
            "a dataset needs an environment that observes a Dict of boxes and acts on a Box"
        )
    taken = {column.name for column in _EPISODE} | {"action", "reward", *TRUTH}
    observed = []
    for name, space in observation.spaces.items():
        if not isinstance(space, gymnasium.spaces.Box) or name in taken:
            raise InvalidValueError(
                f"observation {name!r} cannot be a column: it must be a Box of a name of its own"
            )
        unit, description = _OBSERVED.get(name, ("", ""))
        observed.append(Column(name, "observation", str(space.dtype), space.shape, unit, description))
    truth = [Column(name, "observation", "float32", (2,), *_TRUTH[name]) for name in TRUTH]
    return (
        *_EPISODE,
        *observed,
        Column("action", "step", str(action.dtype), action.shape, description="as the environment took it"),
        Column("reward", "step", "float64"),
        *truth,
    )


def arrow() -> Any:
    """The pyarrow module, with pyarrow.parquet loaded. Raises MissingDependencyError."""
    try:
        import pyarrow
        import pyarrow.parquet
    except ImportError as error:
        raise MissingDependencyError(f"datasets need PyArrow: {install('dataset')}") from error
    return pyarrow


def table(plan: Plan, listed: Sequence[Column], episodes: Sequence[Mapping[str, Any]]) -> Any:
    """A pyarrow.Table, one row for each of the episodes: column name -> value, or array (items, *shape)."""
    pa = arrow()
    fields, arrays = [], []
    for column in listed:
        array = _array(pa, column, [episode[column.name] for episode in episodes])
        described = {"per": column.per, "unit": column.unit, "description": column.description}
        if column.per != "episode":
            described["shape"] = ",".join(str(size) for size in column.shape)
        fields.append(pa.field(column.name, array.type, nullable=False, metadata=described))
        arrays.append(array)
    held = {KEY: json.dumps(plan.of_file(), sort_keys=True)}
    return pa.Table.from_arrays(arrays, schema=pa.schema(fields, metadata=held))


def _array(pa: Any, column: Column, values: list[Any]) -> Any:
    if column.per == "episode":
        return pa.array(values, pa.string() if column.dtype == "str" else pa.from_numpy_dtype(column.dtype))
    ends = np.cumsum([0, *(len(value) for value in values)])
    items = pa.array(np.concatenate(values).astype(column.dtype, copy=False).reshape(-1))
    if column.shape:
        items = pa.FixedSizeListArray.from_arrays(items, int(np.prod(column.shape)))
    return pa.ListArray.from_arrays(pa.array(ends, pa.int32()), items)


def shape_of(field: Any) -> tuple[int, ...]:
    """Shape of an item of a list column, from its Arrow field."""
    text = field.metadata[b"shape"].decode()
    return tuple(int(size) for size in text.split(",")) if text else ()
