"""CSV files of equally long columns, written whole or not at all."""

from __future__ import annotations

import csv
import io
import os
from collections.abc import Mapping

import numpy as np

from thermograsp.errors import InvalidValueError
from thermograsp.files import write_text


def write_csv(path: str | os.PathLike[str], columns: Mapping[str, np.ndarray]) -> None:
    """Columns name -> (N,) under a header of their names, nine significant digits, one line a row."""
    write_text(path, csv_text(columns))


def csv_text(columns: Mapping[str, np.ndarray]) -> str:
    """What write_csv writes."""
    text = io.StringIO()
    rows = np.column_stack(list(columns.values()))
    np.savetxt(text, rows, fmt="%.9g", delimiter=",", header=",".join(columns), comments="")
    return text.getvalue()


def read_csv(path: str | os.PathLike[str]) -> dict[str, np.ndarray]:
    """Columns name -> (N,) of such a file; an empty or wordy cell is NaN. Raises InvalidValueError where the file
    cannot be read, has no rows, names that commas do not separate or that are not told apart, or a row of another
    length than the header."""
    try:
        # spreadsheets begin UTF-8 with a byte order mark
        with open(path, encoding="utf-8-sig", newline="") as file:
            header, *rows = [row for row in csv.reader(file) if row] or [[]]
    except (OSError, ValueError, csv.Error) as error:
        reason = getattr(error, "strerror", None) or error  # of the system, without its number
        raise InvalidValueError(f"cannot read {path}: {reason}") from error
    if not rows:
        raise InvalidValueError(f"{path} has no rows: it must hold a header of names and one row per sample")
    if len(header) == 1 and (other := next((mark for mark in ";\t" if mark in header[0]), None)):
        mark = "tabs" if other == "\t" else "semicolons"
        raise InvalidValueError(f"{path} has {mark} between its columns: write commas, and points in numbers")
    named = [name.strip() for name in header]
    if twice := next((name for name in named if named.count(name) > 1), None):
        raise InvalidValueError(f"{path}: two columns are named {twice!r}: name each column once")
    for number, row in enumerate(rows, start=2):
        if len(row) != len(header):
            raise InvalidValueError(f"{path}, row {number}: {len(row)} cells under {len(header)} names")
    table = np.array([[_number(cell) for cell in row] for row in rows])
    return {name: table[:, k] for k, name in enumerate(named)}


def _number(cell: str) -> float:
    try:
        return float(cell)
    except ValueError:
        return float("nan")
