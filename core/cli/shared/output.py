"""What a command shows: tables and progress for people on a terminal, plain lines in a pipe, JSON for machines."""

from __future__ import annotations

import json
import math
import sys
from collections.abc import Callable, Iterator, Mapping, Sequence
from contextlib import contextmanager
from typing import Any


class Output:
    """Writes to stdout; progress goes to stderr, and only to a terminal. as_json: nothing but `document` prints."""

    def __init__(self, as_json: bool) -> None:
        self.as_json = as_json

    def line(self, text: str = "") -> None:
        """One line for people."""
        if not self.as_json:
            print(text)

    def warn(self, text: str) -> None:
        """One line on stderr, in every mode."""
        print(f"thermograsp: {text}", file=sys.stderr)

    def table(self, header: Sequence[str], rows: Sequence[Sequence[str]]) -> None:
        """A table; columns but the first are numbers, or set that way."""
        if self.as_json:
            return
        if sys.stdout.isatty():
            self._rich_table(header, rows)
            return
        widths = [max(len(row[i]) for row in [header, *rows]) for i in range(len(header))]
        for row in [header, *rows]:
            cells = [
                row[0].ljust(widths[0]),
                *(cell.rjust(w) for cell, w in zip(row[1:], widths[1:], strict=True)),
            ]
            print("  ".join(cells).rstrip())

    def document(self, content: Mapping[str, Any]) -> None:
        """The JSON document, where one was asked for. Numbers that are not finite become null."""
        if self.as_json:
            print(json.dumps(plain(content), indent=2, allow_nan=False))

    def record(self, content: Mapping[str, Any]) -> None:
        """One of many JSON documents, on a line of its own and at once."""
        if self.as_json:
            print(json.dumps(plain(content), allow_nan=False), flush=True)

    @contextmanager
    def progress(self, total: float | None) -> Iterator[Callable[[str, float], None]]:
        """A bar up to `total`, with the time gone and an estimate of what is left; one that runs to and fro where the
        total is not known (None). Call what it yields with what is being done and by how much it advanced."""
        if self.as_json or not sys.stderr.isatty():
            yield lambda doing, advance: None
            return
        from rich.console import Console
        from rich.progress import BarColumn, Progress, TextColumn, TimeElapsedColumn, TimeRemainingColumn

        times = (TimeElapsedColumn(), TextColumn("left"), TimeRemainingColumn())
        columns = (TextColumn("{task.description}"), BarColumn(), *(times if total else times[:1]))
        console = Console(stderr=True)
        with Progress(*columns, console=console, transient=True, speed_estimate_period=300) as bars:
            bar = bars.add_task("", total=total)
            yield lambda doing, advance: bars.update(bar, description=doing, advance=advance)

    def _rich_table(self, header: Sequence[str], rows: Sequence[Sequence[str]]) -> None:
        from rich import box
        from rich.console import Console
        from rich.table import Table

        table = Table(box=box.SIMPLE_HEAD, header_style="bold", pad_edge=False, padding=(0, 1, 0, 0))
        for i, name in enumerate(header):
            table.add_column(name, justify="right" if i else "left", no_wrap=True)
        for row in rows:
            table.add_row(*row)
        Console().print(table)


def plain(value: Any) -> Any:
    """What JSON can hold: lists in place of arrays, None in place of numbers that are not finite."""
    if isinstance(value, Mapping):
        return {str(key): plain(item) for key, item in value.items()}
    if isinstance(value, list | tuple):
        return [plain(item) for item in value]
    if hasattr(value, "tolist"):  # numpy's arrays and scalars
        return plain(value.tolist())
    if isinstance(value, float) and not math.isfinite(value):
        return None
    return value
