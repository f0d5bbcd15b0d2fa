"""Samples of both fingertips as arrays, calibrated.

n: samples; 2: left and right fingertip; 3: normal and two tangential forces.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, fields
from typing import NamedTuple

import numpy as np

from ..errors import SensorFaultError
from .messages import (
    LAYOUTS,
    Calibration,
    Flag,
    Sample,
)

_FAULTS = {
    Flag.SATURATED_LEFT: "the left voltage is at an end of the converter's range: press less, or use less gain",
    Flag.SATURATED_RIGHT: "the right voltage is at an end of the converter's range: press less, or use less gain",
    Flag.OPEN_LEFT: "the left thermistor is open: look at its wires",
    Flag.OPEN_RIGHT: "the right thermistor is open: look at its wires",
    Flag.OFF_SETPOINT_LEFT: "the left thermostat is off its setpoint: wait for it, or look at its heater",
    Flag.OFF_SETPOINT_RIGHT: "the right thermostat is off its setpoint: wait for it, or look at its heater",
    Flag.LATCHED_OFF: "a thermostat was too hot, or its heater on without warming it, and both heaters are off: look "
    "at it, let it cool, then clear_faults()",
    Flag.NO_VOLTAGE_LEFT: "the left voltage is missing: its converter gave none, look at its supply and bus",
    Flag.NO_VOLTAGE_RIGHT: "the right voltage is missing: its converter gave none, look at its supply and bus",
    Flag.NO_FORCE_LEFT: "the left load cell is at an end of its range: press less, or look at its wires",
    Flag.NO_FORCE_RIGHT: "the right load cell is at an end of its range: press less, or look at its wires",
}

_MISSING = {
    "voltage": int(Flag.NO_VOLTAGE_LEFT),
    "thermostat": int(Flag.OPEN_LEFT),
    "force": int(Flag.NO_FORCE_LEFT),
}  # the left fingertip's; the right one's is the next bit


class SampleRow(NamedTuple):
    """A sample as it came. time: s, when it was taken, on the host's clock. device_time: s since the device's boot.
    arrival: s, host clock. flags: of its frame. lost: frames missing just before it. payload: not yet decoded."""

    time: float
    device_time: float
    arrival: float
    flags: int
    lost: int
    payload: bytes


@dataclass(frozen=True, slots=True)
class Samples:
    """Samples of both fingertips, as arrays. time, device_time, arrival: (n,) s, when each was taken on the host's
    clock (never falling, never after arrival) and on the device's since its boot, and when it came. voltage: (n, 2) V.
    thermostat: (n, 2) °C. force: (n, 2, 3) N. What the device does not know is NaN, and a flag says so. flags: (n,)
    Flag. lost: (n,) frames that are missing just before it."""

    time: np.ndarray
    device_time: np.ndarray
    arrival: np.ndarray
    voltage: np.ndarray
    thermostat: np.ndarray
    force: np.ndarray
    flags: np.ndarray
    lost: np.ndarray

    def __len__(self) -> int:
        return len(self.time)

    def __getitem__(self, rows: slice) -> Samples:
        """Those of a slice."""
        return Samples(**{field.name: getattr(self, field.name)[rows] for field in fields(self)})

    @property
    def faults(self) -> Flag:
        """What was wrong with any of them."""
        return Flag(int(np.bitwise_or.reduce(self.flags, initial=0))) & ~Flag.UNIDENTIFIED

    @property
    def columns(self) -> dict[str, np.ndarray]:
        """As columns of a CSV file, name_unit -> (n,), time from the first sample."""
        named = {"time_s": self.time - self.time[:1], "device_time_s": self.device_time}
        for i, side in enumerate(("left", "right")):
            named[f"voltage_{side}_V"] = self.voltage[:, i]
            named[f"thermostat_{side}_degC"] = self.thermostat[:, i]
            named[f"force_{side}_N"] = self.force[:, i, 0]
            named[f"shear_1_{side}_N"] = self.force[:, i, 1]
            named[f"shear_2_{side}_N"] = self.force[:, i, 2]
        return {**named, "flags": self.flags, "lost_frames": self.lost}

    def require_healthy(self, but: int = 0) -> None:
        """Raises SensorFaultError where a sample has a fault, except those in `but`."""
        wrong = self.faults & ~but
        if wrong:
            raise SensorFaultError("; ".join(_FAULTS[flag] for flag in Flag if flag in wrong))


def samples_of(rows: Sequence[SampleRow], calibration: Calibration) -> Samples:
    """Rows as calibrated arrays."""
    columns = LAYOUTS[Sample].columns(b"".join(row.payload for row in rows))
    voltage = (columns["voltage"] - calibration.voltage_offset) * (1 + np.array(calibration.voltage_gain))
    force = (columns["force"] - calibration.force_offset) * (1 + np.array(calibration.force_gain))
    thermostat = columns["thermostat"] - calibration.thermostat_offset
    sent = np.array([row.flags for row in rows], np.uint16)
    return Samples(
        time=np.array([row.time for row in rows], float),
        device_time=np.array([row.device_time for row in rows], float),
        arrival=np.array([row.arrival for row in rows], float),
        voltage=voltage,
        thermostat=thermostat,
        force=force,
        flags=sent | _missing({"voltage": voltage, "thermostat": thermostat, "force": force}),
        lost=np.array([row.lost for row in rows], int),
    )


def _missing(columns: Mapping[str, np.ndarray]) -> np.ndarray:
    """(n,) the flags of what is missing, calibrated, whatever the device says."""
    flags = np.zeros(len(columns["voltage"]), np.uint16)
    for name, left in _MISSING.items():
        missing = np.isnan(columns[name])
        if missing.ndim == 3:
            missing = missing.any(axis=2)
        flags |= np.where(missing, (left, 2 * left), 0).sum(axis=1).astype(np.uint16)
    return flags
