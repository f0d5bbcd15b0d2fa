"""Between a temperature and the record of it: a causal low-pass as it was sampled, smoothing afterwards, a divider."""

from __future__ import annotations

from dataclasses import dataclass
from functools import lru_cache

import numpy as np

from thermograsp.errors import InvalidValueError, positive

_KELVIN = 273.15  # of 0 °C
_REFERENCE = 25.0  # °C, of a thermistor's resistance


@dataclass(frozen=True, slots=True)
class Recorder:
    """A Butterworth low-pass, sample by sample, then a Savitzky-Golay filter over the whole record, which looks ahead.

    rate: Hz of the samples that are filtered. corner: Hz of the low-pass, 0 for none. order: of it. window: samples of
    the smoothing, odd, 0 for none. degree: of its polynomials.
    """

    rate: float = 100.0
    corner: float = 0.0
    order: int = 2
    window: int = 0
    degree: int = 3

    def __post_init__(self) -> None:
        positive("recorder: rate (Hz)", self.rate)
        if not 0 <= self.corner < self.rate / 2:
            raise InvalidValueError(
                f"recorder: corner must be 0 (none) or below half the rate, {self.rate / 2:g} Hz, got {self.corner!r}"
            )
        if self.order < 1 or self.degree < 0:
            raise InvalidValueError(
                f"recorder: order must be 1 or more and degree 0 or more, got {self.order!r}, {self.degree!r}"
            )
        if self.window and (self.window % 2 == 0 or self.window <= self.degree):
            raise InvalidValueError(
                f"recorder: window must be 0 (none) or an odd number above degree {self.degree}, got {self.window!r}"
            )

    def record(self, temperature: np.ndarray, dt: float) -> np.ndarray:
        """Curves (B, n) sampled every dt s as they are recorded, at the same times, whatever the recorder's own rate:
        curves are cubic between samples and have been at their first value before."""
        if not self.corner and not self.window:
            return temperature
        return temperature @ _matrix(self, temperature.shape[1], dt).T

    def record_on(self, temperature: np.ndarray, dt: float) -> np.ndarray:
        """As `record`, of curves whose record began long before their first value: the smoothing has no edge there."""
        if not self.window:
            return self.record(temperature, dt)
        early = int(np.ceil(self.window / self.rate / dt))
        first = np.repeat(temperature[:, :1], early, axis=1)
        return self.record(np.concatenate((first, temperature), axis=1), dt)[:, early:]


@lru_cache(maxsize=8)
def _matrix(recorder: Recorder, n: int, dt: float) -> np.ndarray:
    """(n, n): the filters are linear."""
    from scipy.interpolate import CubicSpline  # nothing that filters need is loaded without them
    from scipy.signal import butter, savgol_filter, sosfilt

    t = np.arange(n) * dt
    sampled = np.arange(int(np.floor(t[-1] * recorder.rate * (1 + 1e-9))) + 1) / recorder.rate
    if len(sampled) < max(recorder.window, 4):
        raise InvalidValueError(
            f"the record's {n} samples every {dt:g} s are shorter than the recorder's window of {recorder.window} at "
            f"{recorder.rate:g} Hz: give a longer one"
        )
    curves = CubicSpline(t, np.eye(n))(sampled)
    if recorder.corner:
        sections = butter(recorder.order, recorder.corner / (recorder.rate / 2), output="sos")
        first = curves[0]
        curves = np.asarray(sosfilt(sections, curves - first, axis=0)) + first
    if recorder.window:
        curves = np.asarray(savgol_filter(curves, recorder.window, recorder.degree, axis=0))
    return CubicSpline(sampled, curves)(t)


@dataclass(frozen=True, slots=True)
class Divider:
    """A thermistor between a supply and a resistor: resistance (ohm at 25 °C) and beta (K) of the thermistor, series
    (ohm), supply (V). The voltage is the one over the series resistor."""

    resistance: float = 10e3
    beta: float = 3435.0
    series: float = 10e3
    supply: float = 3.3

    def __post_init__(self) -> None:
        for name in ("resistance", "beta", "series", "supply"):
            positive(f"divider: {name}", getattr(self, name))

    def voltage(self, temperature: np.ndarray) -> np.ndarray:
        """V at °C."""
        inverse = 1 / (np.asarray(temperature) + _KELVIN) - 1 / (_REFERENCE + _KELVIN)
        return self.supply / (1 + self.resistance / self.series * np.exp(self.beta * inverse))

    def temperature(self, voltage: np.ndarray) -> np.ndarray:
        """°C at V between 0 and the supply."""
        ratio = (self.supply / np.asarray(voltage) - 1) * self.series / self.resistance
        return 1 / (np.log(ratio) / self.beta + 1 / (_REFERENCE + _KELVIN)) - _KELVIN
