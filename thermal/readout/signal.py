"""From temperature drop to the voltage that a driver reports: Seebeck effect, amplifier, noise and converter.

B: rows (environments, fingertips), n: samples. Everything is elementwise, so a row does not depend on the others.
measure_sample takes arrays of any shape, of NumPy, PyTorch or JAX alike.
"""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass
from types import MappingProxyType
from typing import NamedTuple

import numpy as np

from thermograsp.errors import (
    InvalidValueError,
    finite,
    non_negative,
    positive,
)

from ..numerics import Array


@dataclass(frozen=True, slots=True)
class SignalChain:
    """Amplifier and converter; voltages are at the amplifier's input unless stated.

    gain: V/V, what the driver divides by. gain_error: relative, of the actual gain. offset: V. bandwidth: Hz, corner of
    a first-order low-pass; inf for none. noise: V rms a sample. span: V at the converter's input, which takes -span to
    span; inf for no limit. bits: of the signed converter; 0 for no quantisation.
    Raises InvalidValueError for a value that no chain can have.
    """

    gain: float = 1.0
    gain_error: float = 0.0
    offset: float = 0.0
    bandwidth: float = np.inf
    noise: float = 0.0
    span: float = np.inf
    bits: int = 0

    def __post_init__(self) -> None:
        positive("signal chain: gain (V/V)", self.gain)
        finite("signal chain: gain_error", self.gain_error)
        finite("signal chain: offset (V)", self.offset)
        non_negative("signal chain: noise (V)", self.noise)
        if not self.bandwidth > 0 or not self.span > 0:
            raise InvalidValueError(
                f"signal chain: bandwidth and span must be above 0, got {self.bandwidth!r} Hz and {self.span!r} V"
            )
        if not 0 <= self.bits <= 32 or self.bits == 1 or (self.bits and not np.isfinite(self.span)):
            raise InvalidValueError(
                "signal chain: bits must be 0 (none) or 2 .. 32 with a finite span, "
                f"got {self.bits!r} bits and {self.span!r} V"
            )

    @property
    def resolution(self) -> float:
        """V at the amplifier's input of one step of the converter; 0 without quantisation."""
        return self.span / 2 ** (self.bits - 1) / self.gain if self.bits else 0.0

    @property
    def limits(self) -> tuple[float, float]:
        """V, the lowest and highest voltage that can be reported."""
        return -self.span / self.gain, self.span / self.gain - self.resolution


IDEAL = SignalChain()
"""Hands the voltage on as it is."""

ADS1115 = SignalChain(
    gain_error=1e-4, offset=3 * 7.8125e-6, bandwidth=30.0, noise=7.8125e-6, span=0.256, bits=16
)
"""TI ADS1115 datasheet (SBAS444): 16 bits, +-0.256 V, noise 1 LSB rms at 128 samples/s in that range, gain error 0.01 %
typical, 0.15 % at most, offset 3 LSB at most. The low-pass of 30 Hz is an estimate (20 to 40 Hz)."""

_DIVIDER_STEP = 4.096 / 2**15  # V

ADS1115_DIVIDER = SignalChain(
    gain_error=1e-4, offset=3 * _DIVIDER_STEP, bandwidth=30.0, noise=_DIVIDER_STEP, span=4.096, bits=16
)
"""The same in its range of +-4.096 V, for the voltage of a thermistor's divider."""

SIGNAL_CHAINS: Mapping[str, SignalChain] = MappingProxyType({"ideal": IDEAL, "ads1115": ADS1115})
"""By the names that commands and environments take."""


class SignalState(NamedTuple):
    """The state of the low-pass, V before the gain: its output and its last input, (B,) each."""

    filtered: Array
    last: Array


def settled(drop: np.ndarray, seebeck: np.ndarray | float) -> SignalState:
    """The state after a long time at that temperature drop (B,) K. seebeck: V/K, or (B,)."""
    volts = np.asarray(drop, dtype=float) * seebeck
    return SignalState(volts, volts)


def measure(
    chain: SignalChain,
    state: SignalState,
    drop: np.ndarray,
    seebeck: np.ndarray | float,
    dt: float,
    noise: np.ndarray,
) -> tuple[SignalState, np.ndarray]:
    """The next n samples: (new state, reported voltage (B, n) V).

    drop: (B, n) K at the samples, between them taken as linear in time. seebeck: V/K, or (B,). dt: s between samples.
    noise: (B, n) standard normal numbers; not used where the chain has none. The reported voltage is referred to the
    amplifier's input, as a driver does that divides by gain. A voltage beyond limits reports the limit: see saturated.
    """
    reported = np.zeros_like(drop, dtype=float)
    for i in range(drop.shape[1]):
        state, reported[:, i] = measure_sample(chain, state, drop[:, i], seebeck, dt, noise[:, i])
    return state, reported


def measure_sample(
    chain: SignalChain,
    state: SignalState,
    drop: Array,
    seebeck: Array | float,
    dt: float,
    noise: Array | float = 0.0,
) -> tuple[SignalState, Array]:
    """The next sample: (new state, reported voltage V), elementwise. drop: K, dt s after the last one; others as in
    measure. Quantisation has no gradient: where one is wanted, take a chain of 0 bits."""
    lag = 1 / (2 * math.pi * chain.bandwidth)
    decay = math.exp(-dt / lag) if lag else 0.0
    volts = drop * seebeck
    slope_lag = (volts - state.last) * (lag / dt)
    filtered = volts - slope_lag + (state.filtered - state.last + slope_lag) * decay
    return SignalState(filtered, volts), _convert(chain, filtered + noise * chain.noise)


def saturated(chain: SignalChain, voltage: np.ndarray) -> np.ndarray:
    """Which of the reported voltages lie at an end of the range, so that the true ones may lie beyond. Same shape."""
    low, high = chain.limits
    margin = chain.resolution / 2
    return (voltage <= low + margin) | (voltage >= high - margin)


def _convert(chain: SignalChain, volts: Array) -> Array:
    low, high = chain.limits
    volts = (volts + chain.offset) * (1 + chain.gain_error)
    if chain.bits:
        volts = (volts / chain.resolution).round() * chain.resolution
    return volts.clip(low, high)
