"""What may differ from episode to episode besides material and placement: one small record a cause, all off by default.

Every draw comes from the environment's generator, in the order of CAUSES whatever order they are given in. Ranges are
judgements from the sources named; give others to the constructors.
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass

import numpy as np

from thermograsp.errors import InvalidValueError, finite, positive, whole_number

SIZES = (0.8, 0.9, 1.0, 1.1, 1.2)
"""Factors on the size of what needs a thermal network of its own for each."""


@dataclass(frozen=True, slots=True)
class _Factor:
    """Log-uniform between low and high. Raises InvalidValueError unless 0 < low <= high."""

    low: float
    high: float

    def __post_init__(self) -> None:
        name = type(self).__name__
        if positive(f"{name}: low", self.low) > positive(f"{name}: high", self.high):
            raise InvalidValueError(f"{name}: low {self.low:g} is above high {self.high:g}")

    def draw(self, rng: np.random.Generator) -> float:
        """One value."""
        return float(np.exp(rng.uniform(np.log(self.low), np.log(self.high))))


@dataclass(frozen=True, slots=True)
class _Shift:
    """Uniform between low and high. Raises InvalidValueError unless both are finite and low <= high."""

    low: float
    high: float

    def __post_init__(self) -> None:
        name = type(self).__name__
        if finite(f"{name}: low", self.low) > finite(f"{name}: high", self.high):
            raise InvalidValueError(f"{name}: low {self.low:g} is above high {self.high:g}")

    def draw(self, rng: np.random.Generator) -> float:
        """One value."""
        return float(rng.uniform(self.low, self.high))


@dataclass(frozen=True, slots=True)
class Roughness(_Factor):
    """Factor on the object's rms roughness, and so on the conductance of its touching spots: as-machined surfaces of
    one process differ by about 2 either way (ASME B46.1 lists a factor of 4 as each process's usual range)."""

    low: float = 0.5
    high: float = 2.0


@dataclass(frozen=True, slots=True)
class ObjectTemperature(_Shift):
    """K added to the object's temperature, as a room changes it in a day; 3 K as in the identification benchmark."""

    low: float = -3.0
    high: float = 3.0


@dataclass(frozen=True, slots=True)
class Size:
    """Factor on the object's size: log-uniform between low and high, or one of factors, evenly, where these are given.
    The networks of most boxes in mode T follow any size at once; of anything else every size needs one of its own,
    which takes a second the first time and then comes from the cache, so that factors are SIZES there where none are
    given (docs/environments.md). Raises InvalidValueError unless 0 < low <= high, and for no factor or one that is not
    above 0."""

    factors: tuple[float, ...] | None = None
    low: float = 0.8
    high: float = 1.2

    def __post_init__(self) -> None:
        if self.factors is not None and not (isinstance(self.factors, Sequence) and self.factors):
            raise InvalidValueError(
                f"Size: factors must be a list of one number or more, got {self.factors!r}"
            )
        for factor in self.factors or ():
            positive("Size: factor", factor)
        _Factor(self.low, self.high)

    @property
    def extremes(self) -> tuple[float, ...]:
        """Factors between which all are."""
        return (self.low, self.high) if self.factors is None else self.factors

    def in_steps(self) -> Size:
        """The same as one of few."""
        if self.factors is not None:
            return self
        inside = tuple(factor for factor in SIZES if self.low <= factor <= self.high)
        return Size(inside or (self.low, self.high), self.low, self.high)

    def draw(self, rng: np.random.Generator) -> float:
        """One value."""
        if self.factors is None:
            return _Factor(self.low, self.high).draw(rng)
        return float(self.factors[int(rng.integers(len(self.factors)))])


@dataclass(frozen=True, slots=True)
class Mass(_Factor):
    """Factor on the object's mass, for cavities, fillings and impurities; our estimate."""

    low: float = 0.8
    high: float = 1.25


@dataclass(frozen=True, slots=True)
class Friction(_Factor):
    """Factor on the coefficient of friction: handbook values of one pair scatter by about 30 % (Rabinowicz, Friction
    and Wear of Materials, section 4)."""

    low: float = 0.7
    high: float = 1.3


@dataclass(frozen=True, slots=True)
class Gain(_Shift):
    """Relative error of the amplifier's and converter's gain beyond the chain's own; .15 % is the ADS1115's largest
    (datasheet), 1 % an amplifier with 1 % resistors."""

    low: float = -0.01
    high: float = 0.01


@dataclass(frozen=True, slots=True)
class Offset(_Shift):
    """V at the amplifier's input, beyond the chain's own: 3 steps of the ADS1115 at +-.256 V (datasheet)."""

    low: float = -3 * 7.8125e-6
    high: float = 3 * 7.8125e-6


@dataclass(frozen=True, slots=True)
class Noise(_Factor):
    """Factor on the chain's noise, for wiring and supply; our estimate."""

    low: float = 0.5
    high: float = 2.0


@dataclass(frozen=True, slots=True)
class Delay:
    """Delay of the voltages in whole samples of 10 ms, uniform from 0 to most: a serial line, its driver and the host's
    scheduling. Raises InvalidValueError unless most >= 0."""

    most: int = 3

    def __post_init__(self) -> None:
        whole_number("Delay: most (samples)", self.most)

    def draw(self, rng: np.random.Generator) -> float:
        """One value."""
        return float(rng.integers(self.most + 1))


@dataclass(frozen=True, slots=True)
class ThermostatError(_Shift):
    """K by which a thermostat is warmer than its own sensor reports: .2 K is the tolerance of a usual 10 kOhm
    thermistor (1 % in resistance, B = 3950 K: .23 K at 36 °C)."""

    low: float = -0.2
    high: float = 0.2


Cause = (
    Roughness | ObjectTemperature | Size | Mass | Friction | Gain | Offset | Noise | Delay | ThermostatError
)

CAUSES: dict[type, tuple[str, float]] = {
    Roughness: ("roughness_factor", 1.0),
    ObjectTemperature: ("object_temperature_shift", 0.0),
    Size: ("size_factor", 1.0),
    Mass: ("mass_factor", 1.0),
    Friction: ("friction_factor", 1.0),
    Gain: ("gain_error", 0.0),
    Offset: ("offset_shift", 0.0),
    Noise: ("noise_factor", 1.0),
    Delay: ("delay_samples", 0.0),
    ThermostatError: ("thermostat_error", 0.0),
}
"""Each cause's name in info, and what stands where it is off."""

EVERYTHING: tuple[Cause, ...] = tuple(cause() for cause in CAUSES)
"""Every cause at its default range."""


def checked(causes: Iterable[Cause]) -> tuple[Cause, ...]:
    """The causes in the order in which they are drawn. Raises InvalidValueError for what is none, or one given
    twice."""
    if not isinstance(causes, Iterable):
        raise InvalidValueError(f"randomize must be a list of randomisations, got {causes!r}")
    given: dict[type, Cause] = {}
    for cause in causes:
        if type(cause) not in CAUSES:
            known = ", ".join(kind.__name__ for kind in CAUSES)
            raise InvalidValueError(f"randomize: {cause!r} is not a randomisation; known are {known}")
        if type(cause) in given:
            raise InvalidValueError(f"randomize: {type(cause).__name__} is given twice")
        given[type(cause)] = cause
    return tuple(given[kind] for kind in CAUSES if kind in given)


def draw(causes: tuple[Cause, ...], rng: np.random.Generator) -> dict[str, float]:
    """An episode's value of every cause, by its name in info; where it is off, what changes nothing."""
    values = dict(CAUSES.values())
    for cause in causes:
        values[CAUSES[type(cause)][0]] = cause.draw(rng)
    return values
