"""What a serial plant is told about its clocks and limits, and how well it keeps its pace."""

from __future__ import annotations

from dataclasses import dataclass

from thermograsp.errors import InvalidValueError, finite, positive


@dataclass(frozen=True, slots=True)
class SerialConfig:
    """rate: Hz of the voltage. dt: s, the control period, a whole number of samples. setpoint: °C of both thermostats.
    speed: m/s of the fingers. most_force: N on a pad, of either sign, above which the gripper lets go; so it does where
    a load cell is at an end of its range (62.4 N in docs/firmware.md), whatever this is. watchdog: s without a step
    after which it lets go; 0 for never. settle_within, open_within, lower_within,
    centre_within: s that a reset waits for the thermostats, for the fingers to open, for the lift to go down, and for
    the lateral axis to come to its middle."""

    rate: int = 100
    dt: float = 0.02
    setpoint: float = 36.0
    speed: float = 0.1
    most_force: float = 50.0
    watchdog: float = 0.5
    settle_within: float = 60.0
    open_within: float = 6.0
    lower_within: float = 10.0
    centre_within: float = 10.0

    def __post_init__(self) -> None:
        waits = ("settle_within", "open_within", "lower_within", "centre_within")
        for name in ("dt", "speed", "most_force", *waits):
            positive(f"serial plant: {name}", getattr(self, name))
        for name in ("setpoint", "watchdog"):
            finite(f"serial plant: {name}", getattr(self, name))
        if self.samples < 1 or abs(self.dt * self.rate - self.samples) > 1e-9:
            raise InvalidValueError(
                f"serial plant: {self.rate} Hz and steps of {self.dt:g} s: give a whole number of samples a step"
            )
        if self.watchdog and self.watchdog < 2 * self.dt:
            raise InvalidValueError(
                f"serial plant: watchdog must be 0 or at least 2 steps, got {self.watchdog:g} s"
            )

    @property
    def samples(self) -> int:
        """Of the voltage in a control step."""
        return round(self.dt * self.rate)


@dataclass(slots=True)
class PaceCounts:
    """steps. overruns: that ended more than 1 ms late. latest: s, the worst. repeated, skipped: samples that were not
    there in time, so that the one before stood in for it, and that came too many."""

    steps: int = 0
    overruns: int = 0
    latest: float = 0.0
    repeated: int = 0
    skipped: int = 0
