"""A recorded grasp, played again: a CSV file of `thermograsp grasp`, `press` or `device replay`."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np

from thermograsp.agents import LONGEST
from thermograsp.columns import read_csv
from thermograsp.envs.limits import MAX_OPENING, TIPS
from thermograsp.errors import InvalidValueError
from thermograsp.studio.control import Choices, Controls, Stock, known_touch
from thermograsp.studio.sources.puppet import Puppet
from thermograsp.thermal import TouchSetup

_STEP = 0.02  # s of the recording at a time
_PRESSING = 0.5  # N on each pad, from which the opening is the object's width
_ONE = ("voltage", "temperature_drop")  # of a press, which has one fingertip: shown as the left one


class PlayedGrasp:
    """See SimulatedGrasp. Of the choices the mode and the temperatures count, as what identification may know. Raises
    InvalidValueError for a file without time or voltage."""

    paced = False
    rows = 1
    dt = _STEP

    def __init__(self, choices: Choices, stock: Stock) -> None:
        path = Path(stock.recording or "")
        columns = read_csv(path)
        for name in _ONE:
            unit = "V" if name == "voltage" else "K"
            if f"{name}_{unit}" in columns:
                columns[f"{name}_left_{unit}"] = columns.pop(f"{name}_{unit}")
        for name in ("time_s", "voltage_left_V"):
            if name not in columns:
                raise InvalidValueError(
                    f"{path} has no column {name}: give what `thermograsp grasp --csv` writes"
                )
        time = columns["time_s"]
        if not np.isfinite(time).all() or (np.diff(time) <= 0).any() or time[-1] - time[0] > LONGEST:
            raise InvalidValueError(f"{path}: time_s must increase, by {LONGEST:g} s in all at most")
        self._time, self._columns, self._choices = time - min(time[0], 0.0), columns, choices
        self.names = (path.stem,)
        self._puppet = Puppet(self._width())
        self.reset(0)

    @property
    def colours(self) -> tuple[float, float]:
        """See SimulatedGrasp."""
        return self._choices.colours

    def reset(self, seed: int) -> None:
        """Starts from the recording's beginning."""
        del seed
        self._steps = self._at = 0

    @property
    def time(self) -> float:
        """s of the recording."""
        return self._steps * self.dt

    @property
    def running(self) -> bool:
        """Whether anything is left."""
        return self._at < len(self._time)

    def step(self, controls: Controls) -> dict[str, np.ndarray]:
        """The columns (1, S) of the next 20 ms."""
        del controls
        self._steps += 1
        first, self._at = self._at, int(np.searchsorted(self._time, self.time + 1e-9))
        return {name: values[None, first : self._at] for name, values in self._columns.items()}

    def shapes(self) -> list[dict[str, Any]]:
        """See shapes.py."""
        return self._puppet.shapes()

    def message(self, row: int) -> dict[str, Any]:
        """See SimulatedGrasp."""
        del row
        opening = self._now("opening_m", MAX_OPENING)
        height = self._now("height_m", 0.0)
        celsius = {f"sensor_{tip}": self._now(f"sensor_surface_{tip}_degC") for tip in TIPS}
        celsius["object"] = self._now("object_temperature_degC")
        return {
            "poses": self._puppet.poses(opening, height, self._now("lift_m", 0.0)),
            "celsius": {name: round(value, 3) for name, value in celsius.items() if np.isfinite(value)},
            "ending": "" if self.running else "the recording’s end",
            "state": "recorded",
            "opening": opening,
            "height": height,
        }

    def touch_setup(self, row: int) -> TouchSetup:
        """See SimulatedGrasp."""
        del row
        return known_touch(self._choices, 2 if "voltage_right_V" in self._columns else 1)

    def close(self) -> None:
        """Nothing is held."""

    def _now(self, name: str, absent: float = np.nan) -> float:
        if name not in self._columns:
            return absent
        return float(self._columns[name][min(max(self._at - 1, 0), len(self._time) - 1)])

    def _width(self) -> float | None:
        needed = ("opening_m", "force_left_N", "force_right_N")
        if not all(name in self._columns for name in needed):
            return None
        opening, *force = (self._columns[name] for name in needed)
        pressing = np.minimum(*force) > _PRESSING
        return float(np.median(opening[pressing])) if pressing.any() else None
