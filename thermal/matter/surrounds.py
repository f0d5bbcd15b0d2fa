"""What holds a sensor's element in its fingertip: a pad around it, which gives heat to its sides and to the object."""

from __future__ import annotations

from dataclasses import dataclass, replace

from thermograsp.errors import InvalidValueError, length

from .layers import Layer
from .materials import Material, material
from .mounting import Mode
from .sensors import SensorStack

MOST_CONDUCTIVE = 3.0
"""W/(m K), up to which the drop was compared with three-dimensional finite elements: on glass and steel it is off by
.03 K of 12 K at 0.5, .024 at 1, .014 at 2 and .008 at 3."""

_LEAST_WIDER = 1.1
"""Times the element's width. With foams in a rim of a quarter of a millimetre, networks are off by .1 K."""


@dataclass(frozen=True, slots=True)
class Surround:
    """A square pad with the sensor's element in its middle, bonded to the element's sides, on the same thermostat and
    flush with the element's face.

    material: a name of thermal.materials() or a Material, of at most MOST_CONDUCTIVE W/(m K). width: m, the pad's side.
    depth: m, None for as deep as the element without a skin; a skin lies over both. Raises UnknownNameError and
    InvalidValueError."""

    material: str | Material = "silicone"
    width: float = 0.020
    depth: float | None = None

    def __post_init__(self) -> None:
        made = material(self.material)
        if made.conductivity > MOST_CONDUCTIVE:
            raise InvalidValueError(
                f"surround: {made.name} conducts {made.conductivity:g} W/(m K), and what pads do is known up to "
                f"{MOST_CONDUCTIVE:g} W/(m K): take one such as silicone"
            )
        length("surround: width (m)", self.width)
        if self.depth is not None:
            length("surround: depth (m)", self.depth)

    @property
    def layer(self) -> Layer:
        """The pad as a layer as deep as it is."""
        if self.depth is None:
            raise InvalidValueError(
                "this surround has no depth yet: `around` gives it the element's, or give depth"
            )
        return material(self.material).layer(self.depth)

    def around(self, stack: SensorStack) -> Surround:
        """The pad around that bare element, as deep as it unless a depth is given. Raises InvalidValueError for a pad
        that is less than a tenth wider than the element, and for one that is deeper."""
        if self.width < _LEAST_WIDER * stack.width * (1 - 1e-9):
            raise InvalidValueError(
                f"surround: width {self.width:g} m leaves hardly anything around sensor {stack.name!r}, "
                f"which is {stack.width:g} m wide: give {_LEAST_WIDER * stack.width:g} m or more"
            )
        depth = stack.thickness if self.depth is None else self.depth
        if depth > stack.thickness * (1 + 1e-9):
            raise InvalidValueError(
                f"surround: depth {depth:g} m is more than that of sensor {stack.name!r}, {stack.thickness:g} m: give "
                "at most that"
            )
        return replace(self, depth=min(depth, stack.thickness))


def surround(name: str | Material | Surround | None, mode: Mode = "T") -> Surround | None:
    """What a keyword `surround` stands for: the name of its material or a Material, of the usual width, the surround
    itself, None for none. Raises UnknownNameError, and InvalidValueError for what is none, or any in mode O."""
    if name is None:
        return None
    if mode == "O":
        raise InvalidValueError(
            "a surround is around the element of a fingertip, which is glued on the object in mode 'O': leave it out"
        )
    if isinstance(name, Surround):
        return name
    if not isinstance(name, str | Material):
        raise InvalidValueError(f"surround must be the name of a material, a Surround or None, got {name!r}")
    return Surround(name)
