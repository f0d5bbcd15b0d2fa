"""Reads a dataset: whole episodes, or batches of steps, as NumPy arrays or torch tensors.

E: episodes, T: steps of one, B: steps of a batch.
"""

from __future__ import annotations

import os
import sys
from collections.abc import Iterator, Sequence
from pathlib import Path
from typing import Any, Literal

import numpy as np

from thermograsp.dataset.schema import arrow, shape_of
from thermograsp.dataset.shards import whole
from thermograsp.errors import InvalidValueError, MissingDependencyError, install, unknown_name, whole_number

Library = Literal["numpy", "torch"]

NEXT = "next_"
_MIXED = 8  # shards whose steps are shuffled together
_LAST_STEP = ("terminated", "truncated")


def load(
    folder: str | os.PathLike[str],
    columns: Sequence[str] | None = None,
    where: Any = None,
    library: Library = "numpy",
    incomplete: bool = False,
) -> dict[str, Any]:
    """Returns all episodes that pass the filter `where`, in the order of their seeds.

    columns: names, None for all. where: a filter on the columns that have one value an episode, as PyArrow takes it:
    [("material", "in", ["glass", "wood"]), ("success", "==", True)], or an expression.
    Returns name -> (E,) array for one value an episode, else a list of E arrays (T + 1, ...) for observations and
    (T, ...) for actions and rewards. Text stays a NumPy array. Units are in docs/datasets.md and in the files.
    incomplete: read what is there of a dataset that lacks files, with a RuntimeWarning that says how much that is.
    Raises InvalidValueError, UnknownNameError, MissingDependencyError."""
    tensors = _tensors(library)
    _, files = whole(folder, incomplete)
    rows = arrow().concat_tables([read(file, columns, where) for file in files])
    return {
        name: [tensors(item) for item in values] if isinstance(values, list) else tensors(values)
        for name, values in unpacked(rows).items()
    }


def iterate(
    folder: str | os.PathLike[str],
    batch_size: int,
    columns: Sequence[str] | None = None,
    where: Any = None,
    rng: np.random.Generator | None = None,
    library: Library = "numpy",
    drop_last: bool = False,
    incomplete: bool = False,
    part: tuple[int, int] = (0, 1),
) -> Iterator[dict[str, Any]]:
    """Yields batches of B = batch_size steps as name -> (B, ...). Each step occurs once; the last batch may be smaller.

    An observation's column is what the agent saw before the step; "next_" and its name, where `columns` asks for it,
    what it saw after. One value an episode is repeated for its steps, but terminated and truncated are true at the
    last step only. rng: shuffles; None keeps the order of seeds and time. It puts the shards in random order and mixes
    the steps of eight shards at a time, so that a dataset need not fit into memory. columns, where, library,
    incomplete and errors: as load has them. drop_last: leave out a last batch that is not full.

    part: (k, n), the k-th of n readers, from 0: every shard is read by one of them, whatever their generators are. The
    workers of a torch DataLoader share what their process is to read by themselves."""
    whole_number("batch_size", batch_size, 1)
    tensors = _tensors(library)
    k, n = _share(*part)
    files = whole(folder, incomplete)[1][k::n]
    if rng is not None:
        files = [files[k] for k in rng.permutation(len(files))]
    at_once = 1 if rng is None else _MIXED
    left: dict[str, np.ndarray] = {}
    for first in range(0, len(files), at_once):
        steps = _joined([left, *(_steps(file, columns, where) for file in files[first : first + at_once])])
        count = len(next(iter(steps.values())))
        if rng is not None:
            order = rng.permutation(count)
            steps = {name: values[order] for name, values in steps.items()}
        full = count - count % batch_size
        for k in range(0, full, batch_size):
            yield {name: tensors(values[k : k + batch_size]) for name, values in steps.items()}
        left = {name: values[full:] for name, values in steps.items()}
    if left and len(next(iter(left.values()))) and not drop_last:
        yield {name: tensors(values) for name, values in left.items()}


def _share(k: int, n: int) -> tuple[int, int]:
    """The k-th of n parts, shared among the workers of the DataLoader that asks. Raises InvalidValueError."""
    if not 0 <= k < n:
        raise InvalidValueError(f"part must be (k, n) with k from 0 to n - 1, got {(k, n)}")
    loading = sys.modules.get("torch.utils.data")  # there in a DataLoader's worker
    worker = None if loading is None else loading.get_worker_info()
    return (k, n) if worker is None else (k * worker.num_workers + worker.id, n * worker.num_workers)


def read(file: Path, columns: Sequence[str] | None = None, where: Any = None) -> Any:
    """A shard's pyarrow.Table, columns and where as load() has them; `where` sees columns that are not asked for."""
    pa = arrow()
    known = pa.parquet.read_schema(file).names
    for name in columns or ():
        if name not in known:
            raise unknown_name("column", name, known)
    try:
        return pa.parquet.read_table(
            file, columns=columns and list(columns), filters=where, partitioning=None
        )
    except (pa.ArrowException, TypeError, ValueError) as error:
        raise InvalidValueError(f"cannot filter by {where!r}: {error}") from error


def unpacked(rows: Any) -> dict[str, Any]:
    """A table's columns: name -> (E,), or a list of E arrays (items, ...)."""
    columns: dict[str, Any] = {}
    for name in rows.column_names:
        values = _values(rows, name)
        if rows.schema.field(name).metadata[b"per"] != b"episode":
            counts = np.concatenate(
                [np.diff(chunk.offsets.to_numpy()) for chunk in rows.column(name).chunks]
                or [np.zeros(0, int)]
            )
            values = np.split(values, np.cumsum(counts)[:-1]) if len(counts) else []
        columns[name] = values
    return columns


def _steps(file: Path, columns: Sequence[str] | None, where: Any) -> dict[str, np.ndarray]:
    """All steps of a shard's episodes, in order: name -> (steps, ...)."""
    schema = arrow().parquet.read_schema(file)
    wanted = list(columns) if columns is not None else list(schema.names)
    stored = list(dict.fromkeys([*(_stored(schema, name) for name in wanted), "steps"]))
    rows = read(file, stored, where)
    lengths = rows.column("steps").to_numpy()
    return {name: _per_step(rows, name, lengths) for name in wanted}


def _stored(schema: Any, name: str) -> str:
    """The column that holds what is asked for under this name."""
    plain = name.removeprefix(NEXT)
    observed = plain in schema.names and schema.field(plain).metadata[b"per"] == b"observation"
    if name not in schema.names and not (name != plain and observed):
        raise unknown_name("column", name, schema.names)
    return plain if observed else name


def _per_step(rows: Any, name: str, lengths: np.ndarray) -> np.ndarray:
    stored = _stored(rows.schema, name)
    per = rows.schema.field(stored).metadata[b"per"]
    values = _values(rows, stored)
    if per == b"step":
        return values
    ends = np.cumsum(lengths)
    if per == b"episode":
        repeated = np.repeat(values, lengths)
        if name in _LAST_STEP:
            last = np.zeros(len(repeated), bool)
            last[ends - 1] = True
            repeated &= last
        return repeated
    # Of an episode's T + 1 observations all but the last come before a step, all but the first after one.
    before = np.ones(len(values), bool)
    before[ends + np.arange(len(ends))] = False
    return values[np.roll(before, 1)] if name != stored else values[before]


def _values(rows: Any, name: str) -> np.ndarray:
    """A column's items one after another: (items, ...), an array of its own."""
    column, field = rows.column(name), rows.schema.field(name)
    if field.metadata[b"per"] == b"episode":
        return np.array(column.to_pylist()) if _is_text(field) else column.to_numpy().copy()
    shape, dtype = shape_of(field), field.type.value_type
    parts = [chunk.flatten() for chunk in column.chunks]
    if shape:
        parts, dtype = [part.flatten() for part in parts], dtype.value_type
    numbers = [part.to_numpy() for part in parts]
    joined = np.concatenate(numbers) if numbers else np.zeros(0, dtype.to_pandas_dtype())
    return joined.reshape(-1, *shape)


def _joined(parts: Sequence[dict[str, np.ndarray]]) -> dict[str, np.ndarray]:
    parts = [part for part in parts if part]
    return {name: np.concatenate([part[name] for part in parts]) for name in parts[0]}


def _tensors(library: Library) -> Any:
    """What turns an array into one of the library's; text stays as it is."""
    if library == "numpy":
        return lambda values: values
    if library != "torch":
        raise unknown_name("library", library, ("numpy", "torch"))
    try:
        import torch  # pyright: ignore[reportMissingImports]
    except ImportError as error:
        raise MissingDependencyError(f"torch tensors need PyTorch: {install('torch')}") from error
    return lambda values: values if values.dtype.kind == "U" else torch.from_numpy(values)


def _is_text(field: Any) -> bool:
    return str(field.type) == "string"
