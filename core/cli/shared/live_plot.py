"""A plot of both fingertips' voltages in the terminal, of Braille dots."""

from __future__ import annotations

from collections import deque
from types import TracebackType
from typing import TYPE_CHECKING

import numpy as np

if TYPE_CHECKING:
    from thermograsp.hardware import Samples

_SECONDS = 10.0  # shown
_WIDTH, _HEIGHT = 72, 9  # characters
_DOTS = ((0x01, 0x08), (0x02, 0x10), (0x04, 0x20), (0x40, 0x80))  # rows x columns of a Braille character
_LEAST = 1e-4  # V, the smallest span shown
_SIDES = ("left", "right")


def braille(x: np.ndarray, y: np.ndarray, width: int, height: int) -> list[str]:
    """Points x, y, each from 0 (left, bottom) to 1, as `height` lines of `width` characters."""
    cells = np.zeros((height, width), int)
    columns = np.clip((x * 2 * width).astype(int), 0, 2 * width - 1)
    rows = 4 * height - 1 - np.clip((y * 4 * height).astype(int), 0, 4 * height - 1)
    for column, row in zip(columns.tolist(), rows.tolist(), strict=True):
        cells[row // 4, column // 2] |= _DOTS[row % 4][column % 2]
    return ["".join(chr(0x2800 + cell) for cell in line) for line in cells.tolist()]


class LivePlot:
    """Drawn on a terminal while its `with` block lasts: the last 10 s of voltage, and the newest of all else."""

    def __init__(self, title: str) -> None:
        from rich.live import Live

        self._title = title
        self._live = Live(refresh_per_second=10)
        self._parts: deque[tuple[np.ndarray, np.ndarray]] = deque()
        self._newest = ""

    def __enter__(self) -> LivePlot:
        self._live.start()
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        self._live.stop()

    def show(self, samples: Samples | None, broken: str) -> None:
        """Takes in samples and draws; None where the line is broken, with what is wrong."""
        from rich.panel import Panel

        if samples is not None and len(samples):
            self._parts.append((samples.time, samples.voltage))
            degrees, newtons = samples.thermostat[-1], samples.force[-1, :, 0]
            self._newest = "\n".join(
                f"{side:5}  {1e3 * samples.voltage[-1, i]:9.3f} mV  {degrees[i]:6.2f} °C  {newtons[i]:6.2f} N"
                for i, side in enumerate(_SIDES)
            )
            faults = samples.faults
            if faults:
                self._newest += f"\n{faults.name}"
        self._live.update(Panel(f"{self._plot()}\n{broken or self._newest}", title=self._title, expand=False))

    def _plot(self) -> str:
        """Both voltages under one another, on one scale."""
        if not self._parts:
            return "waiting for samples"
        while self._parts[-1][0][-1] - self._parts[0][0][-1] > _SECONDS:
            self._parts.popleft()
        time = np.concatenate([part[0] for part in self._parts])
        volts = np.concatenate([part[1] for part in self._parts])
        low, high = float(volts.min()), float(volts.max())
        span = max(high - low, _LEAST)
        x = 1 + (time - time[-1]) / _SECONDS
        blocks = []
        for i, side in enumerate(_SIDES):
            lines = braille(x[x >= 0], ((volts[:, i] - low) / span)[x >= 0], _WIDTH, _HEIGHT)
            blocks.append(
                f"{side}, {1e3 * low:.3f} to {1e3 * (low + span):.3f} mV, {_SECONDS:g} s\n" + "\n".join(lines)
            )
        return "\n".join(blocks)
