"""What is known about a touch before its curve is seen: the sensor, the object's size, and priors of the rest."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import Literal

import numpy as np

from thermograsp.errors import InvalidValueError, celsius, non_negative, numbers, positive

from ..matter import Material, Mode, SensorStack, Shape, Skin, sensor
from ..matter import skin as named_skin
from ..plates import Geometry
from ..readout import ADS1115, SignalChain, saturated
from ..stack import HeatedCore, HeatedStack, any_sensor, converter, fallen, heated_core, require_linear

_STEP = 0.01  # s; curves take nothing of it
_MOST = 300.0  # K across an element, which nothing that is touched comes near


@dataclass(frozen=True, slots=True)
class TouchSetup:
    """A touch whose material is asked for. The contact opens at once, with a conductance that then stays.

    stack: the sensor; a heated one has been at its temperature for long, and its samples are taken before any
    smoothing that looks ahead (or those near the touch are left out). mode, area (m2), shape, object_size (m): as in
    thermal.press. fingertips: 2 for equal ones on opposite faces that touch together, object_size[2] apart. chain:
    amplifier and converter; its noise and resolution are the noise, its bandwidth is part of the curve, its offset is
    taken as unknown with that standard deviation. conductance: (lowest, highest) W/(m2 K), log-uniform between.
    object_temperature, sensor_temperature: (mean, standard deviation) °C at the touch, normal. model_error: rms of
    slow deviations of real curves from the model, as a share of the curve's largest value. tolerance: K that the
    network which simulated a curve may be off, however small the curve is: a quarter of it, the rms of such networks'
    errors, is added; 0 where no network did. touch_error: s, standard deviation of a touch time that is given.
    horizon: s after the touch; later samples are not used. skin: over the sensor's face (T mode), a name of
    thermal.SKINS or a Skin, None for a bare one, or for a stack whose last layer is one already. Raises
    InvalidValueError and UnknownNameError.
    """

    stack: SensorStack | HeatedStack = field(default_factory=lambda: sensor("seed"))
    mode: Mode = "T"
    area: float = 81e-6
    shape: Shape = "square"
    object_size: tuple[float, float, float] = (0.04, 0.04, 0.01)
    fingertips: Literal[1, 2] = 1
    chain: SignalChain = ADS1115
    conductance: tuple[float, float] = (1e3, 2e4)
    object_temperature: tuple[float, float] = (24.0, 3.0)
    sensor_temperature: tuple[float, float] = (36.0, 0.1)
    model_error: float = 0.005
    tolerance: float = 0.05
    touch_error: float = 0.0
    horizon: float = 10.0
    skin: str | Skin | None = None

    def __post_init__(self) -> None:
        named_skin(self.skin, self.mode)  # checks it
        object.__setattr__(self, "stack", any_sensor(self.stack))
        numbers("object_size (m)", self.object_size, 3)
        low, high = numbers("conductance (W/(m2 K))", self.conductance, 2)
        if not positive("lowest conductance (W/(m2 K))", low) < positive(
            "highest conductance (W/(m2 K))", high
        ):
            raise InvalidValueError(f"conductance must be (lowest, highest), got {self.conductance!r}")
        for name in ("object_temperature", "sensor_temperature"):
            mean, deviation = numbers(f"{name} (°C, K)", getattr(self, name), 2)
            celsius(f"{name}: mean (°C)", mean)
            non_negative(f"{name}: standard deviation (K)", deviation)
        positive("standard deviation of the temperature difference (K)", self.difference[1])
        non_negative("model_error", self.model_error)
        non_negative("tolerance (K)", self.tolerance)
        non_negative("touch_error (s)", self.touch_error)
        positive("horizon (s)", self.horizon)
        positive("noise and resolution of the signal chain (V)", self.noise)
        if self.mode not in ("T", "O"):
            raise InvalidValueError(f"mode must be 'T' or 'O', got {self.mode!r}")
        if self.fingertips not in (1, 2):
            raise InvalidValueError(f"fingertips must be 1 or 2, got {self.fingertips!r}")
        if isinstance(self.stack, HeatedStack):
            require_linear(self.stack, "identification")
            if self.mode == "O":
                raise InvalidValueError(
                    f"sensor {self.stack.name!r} has a heater of its own, which mode 'O' has no place for: use mode 'T'"
                )

    @property
    def difference(self) -> tuple[float, float]:
        """K, mean and standard deviation of sensor less object temperature at the touch."""
        (warm, a), (cold, b) = self.sensor_temperature, self.object_temperature
        return warm - cold, float(np.hypot(a, b))

    @property
    def worn(self) -> SensorStack | HeatedStack:
        """The sensor with its skin."""
        skin = named_skin(self.skin)
        return self.stack if skin is None else skin.over(self.stack)

    @property
    def core(self) -> HeatedCore | None:
        """What is behind a heated sensor's element; None of an element on a thermostat."""
        worn = self.worn
        return heated_core(worn, _STEP) if isinstance(worn, HeatedStack) else None

    @property
    def element(self) -> SensorStack:
        """The layers that networks know."""
        core = self.core
        return core.element if core is not None else self.worn  # pyright: ignore[reportReturnType]

    @property
    def converter(self) -> SignalChain:
        """The chain as it takes this sensor."""
        return converter(self.stack, self.chain)

    @property
    def noise(self) -> float:
        """V rms of a sample: the chain's noise, and its steps taken as uniform noise."""
        chain = self.converter
        return float(np.hypot(chain.noise, chain.resolution / np.sqrt(12)))

    @property
    def offset(self) -> float:
        """K, standard deviation of what all samples are off by: the chain's offset, and of a heated sensor, whose
        fall is counted from what it was given to be at, how well that is known."""
        volts = abs(self.converter.offset) / self.element.seebeck
        return float(np.hypot(volts, self.sensor_temperature[1])) if self.core is not None else volts

    @property
    def smoothing(self) -> float:
        """s before and after the touch in which smoothing mixes what was with what came."""
        if isinstance(self.stack, SensorStack):
            return 0.0
        return self.stack.recorder.window / self.stack.recorder.rate / 2

    def kelvin(self, voltage: np.ndarray) -> np.ndarray:
        """K over the sensed layer, or of a heated sensor's fall. Raises InvalidValueError for voltages it never
        sends."""
        if isinstance(self.stack, HeatedStack):
            return fallen(self.stack, voltage, self.sensor_temperature[0])
        kelvin = voltage / self.stack.seebeck
        most = float(np.abs(kelvin).max(initial=0.0))
        if most > _MOST:
            raise InvalidValueError(
                f"voltage is up to {np.abs(voltage).max():g} V, which sensor {self.stack.name!r} would send at "
                f"{most:.3g} K: give it in V, not in mV or counts, and the sensor that sent it"
            )
        return kelvin

    def saturated(self, kelvin: np.ndarray) -> np.ndarray:
        """Which samples lie at an end of the converter's range."""
        if isinstance(self.stack, HeatedStack):
            return saturated(self.converter, self.stack.divider.voltage(self.sensor_temperature[0] - kelvin))
        return saturated(self.converter, kelvin * self.stack.seebeck)

    @property
    def resistance(self) -> tuple[float, float]:
        """m2 K/W, the lowest and highest contact resistance."""
        low, high = self.conductance
        return 1 / high, 1 / low

    def geometry(self, material: Material) -> Geometry:
        """The contact on an object of that material. Two equal fingertips drive no heat through the middle plane, so
        each one's object is a plate of half the thickness whose back is adiabatic."""
        width, depth, thickness = self.object_size
        size = (width, depth, thickness / self.fingertips)
        return Geometry(self.element, material, self.mode, self.area, self.shape, size)
