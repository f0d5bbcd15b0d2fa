"""A heated sensor as a stack: layers, where its temperature is read, where it is heated, what is behind, what touches.

Everything is per area of the face and one-dimensional: what spreads sideways in the sample or leaves at the sides is
left out.
"""

from __future__ import annotations

from dataclasses import dataclass, field

import numpy as np

from thermograsp.errors import InvalidValueError, non_negative, positive

from ..matter import Layer
from .laws import HeaterLaw, Off
from .recorder import Divider, Recorder


@dataclass(frozen=True, slots=True)
class Place:
    """A point of the stack. layer: index, from the back to the face. depth: share of that layer's thickness, from 0 at
    its back to 1 at its front; both ends are interfaces."""

    layer: int
    depth: float

    def __post_init__(self) -> None:
        if not 0 <= self.depth <= 1:
            raise InvalidValueError(
                f"depth in a layer must be 0 (its back) to 1 (its front), got {self.depth!r}"
            )


@dataclass(frozen=True, slots=True)
class Backing:
    """What is behind the first layer, all at once: a lump of `capacity` J/(m2 K), a half-space of `effusivity` W
    s^0.5/(m2 K), and a `loss` W/(m2 K) to the surroundings. All 0: adiabatic."""

    capacity: float = 0.0
    effusivity: float = 0.0
    loss: float = 0.0

    def __post_init__(self) -> None:
        for name in ("capacity", "effusivity", "loss"):
            non_negative(f"backing: {name}", getattr(self, name))


@dataclass(frozen=True, slots=True)
class ForceContact:
    """Conductance W/(m2 K) of a contact that follows its force: gap + conductance ((F - preload) / (force -
    preload))^exponent.

    conductance: at `force` N, beside the gap's. exponent: 0.95 for solid spots (Cooper, Mikic & Yovanovich, Int. J.
    Heat Mass Transfer 12, 1969). preload: N that what is around the sensor takes before the sensor bears any. gap: what
    passes without any force, through air and by radiation.
    """

    conductance: float
    force: float = 4.0
    exponent: float = 0.95
    preload: float = 0.0
    gap: float = 0.0

    def __post_init__(self) -> None:
        positive("contact: conductance (W/(m2 K))", self.conductance)
        positive("contact: force (N)", self.force)
        for name in ("exponent", "preload", "gap"):
            non_negative(f"contact: {name}", getattr(self, name))
        if not self.preload < self.force:
            raise InvalidValueError(
                f"contact: preload must be below force = {self.force:g} N, got {self.preload!r}"
            )

    def at(self, force: np.ndarray) -> np.ndarray:
        """W/(m2 K) at forces in N."""
        share = np.maximum(force - self.preload, 0.0) / (self.force - self.preload)
        return self.gap + self.conductance * np.where(share > 0, share, 0.0) ** self.exponent * (share > 0)


@dataclass(frozen=True, slots=True)
class HeatedStack:
    """A sensor of layers that is read at one place and heated at another.

    layers: from the back to the face. readout, heater: where the temperature is read and where heat enters. law: of the
    heater. backing: behind the first layer. contact: with what is touched. recorder: filters between the temperature
    and the record. divider: that the temperature is sent as the voltage of. width: m, side of the square face. Raises
    InvalidValueError.
    """

    name: str
    layers: tuple[Layer, ...]
    readout: Place
    heater: Place
    contact: ForceContact
    law: HeaterLaw = field(default_factory=Off)
    backing: Backing = field(default_factory=Backing)
    recorder: Recorder = field(default_factory=Recorder)
    divider: Divider = field(default_factory=Divider)
    width: float = 9e-3

    def __post_init__(self) -> None:
        if not self.layers:
            raise InvalidValueError(f"stack {self.name!r} has no layers: give at least one")
        positive(f"stack {self.name!r}: width (m)", self.width)
        for what in ("readout", "heater"):
            place = getattr(self, what)
            if not 0 <= place.layer < len(self.layers):
                raise InvalidValueError(
                    f"stack {self.name!r}: {what} in layer {place.layer}, which is not one of 0 .. "
                    f"{len(self.layers) - 1}"
                )
