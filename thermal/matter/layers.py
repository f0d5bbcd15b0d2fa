"""A homogeneous layer: of a sensor, or a plate of an object."""

from __future__ import annotations

from dataclasses import dataclass
from math import sqrt

from thermograsp.errors import positive


class Conductor:
    """What follows of a conductivity W/(m K), a density kg/m3 and a specific heat J/(kg K)."""

    __slots__ = ()
    conductivity: float
    density: float
    specific_heat: float

    @property
    def volumetric_heat_capacity(self) -> float:
        """J/(m3 K)."""
        return self.density * self.specific_heat

    @property
    def effusivity(self) -> float:
        """W s^0.5/(m2 K), sqrt(k rho c): decides the temperature of a fresh contact."""
        return sqrt(self.conductivity * self.volumetric_heat_capacity)

    @property
    def diffusivity(self) -> float:
        """m2/s, k/(rho c)."""
        return self.conductivity / self.volumetric_heat_capacity


@dataclass(frozen=True, slots=True)
class Layer(Conductor):
    """One homogeneous layer of a sensor or of an object.

    thickness: m. conductivity: W/(m K). density: kg/m3. specific_heat: J/(kg K).
    Raises InvalidValueError when one of them is not a positive finite number.
    """

    name: str
    thickness: float
    conductivity: float
    density: float
    specific_heat: float

    def __post_init__(self) -> None:
        for field in ("thickness", "conductivity", "density", "specific_heat"):
            positive(f"{self.name}: {field}", getattr(self, field))
