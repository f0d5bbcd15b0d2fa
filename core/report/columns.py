"""CSV files of equally long columns, written whole or not at all."""

from __future__ import annotations

import os
from collections.abc import Mapping

import numpy as np

from thermograsp.files import atomic_write


def write_csv(path: str | os.PathLike[str], columns: Mapping[str, np.ndarray]) -> None:
    """Columns name -> (N,) under a header of their names, nine significant digits, one line a row."""
    header = ",".join(columns)
    rows = np.column_stack(list(columns.values()))
    with atomic_write(path) as temporary:
        np.savetxt(temporary, rows, fmt="%.9g", delimiter=",", header=header, comments="", encoding="utf-8")
