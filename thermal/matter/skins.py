"""A skin over a sensor's face: a soft sheet that conforms to what is touched, and that heat must pass."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace
from types import MappingProxyType
from typing import TypeVar

from thermograsp.errors import InvalidValueError, positive, unknown_name, within

from .layers import Layer
from .materials import Material, material

_Stack = TypeVar("_Stack")
_THINNEST, _THICKEST = 1e-6, 5e-3  # m; a thicker one feels nothing


@dataclass(frozen=True, slots=True)
class Skin:
    """A sheet of one material, thickness 1e-6 .. 5e-3 m, bonded to the sensor's face without a resistance of its own.

    material: a name of thermal.materials() or a Material, with Young's modulus and roughness, for its contact. Raises
    UnknownNameError and InvalidValueError."""

    material: str | Material
    thickness: float

    def __post_init__(self) -> None:
        within("skin: thickness", positive("skin: thickness (m)", self.thickness), _THINNEST, _THICKEST, "m")
        made = self.made_of
        if made.youngs_modulus is None or made.roughness is None:
            raise InvalidValueError(
                f"skin: {made.name} has no youngs_modulus or no roughness, which its contact needs: give both"
            )

    @property
    def made_of(self) -> Material:
        """The material."""
        return material(self.material)

    @property
    def layer(self) -> Layer:
        """It as the sensor's outermost layer."""
        return self.made_of.layer(self.thickness)

    @property
    def resistance(self) -> float:
        """m2 K/W."""
        return self.thickness / self.made_of.conductivity

    def over(self, stack: _Stack) -> _Stack:
        """A SensorStack or a HeatedStack with this skin on its face: one more layer, which is read and heated where it
        was."""
        return replace(stack, layers=(*stack.layers, self.layer))  # pyright: ignore


SKINS: Mapping[str, Skin] = MappingProxyType(
    {
        "filled_silicone": Skin(
            Material(
                "filled_silicone",
                conductivity=1.6,
                density=2200.0,
                specific_heat=1000.0,
                family="elastomer",
                youngs_modulus=1.7e6,
                poisson_ratio=0.49,
                roughness=2e-6,
            ),
            thickness=0.2e-3,
        )
    }
)
"""By name. filled_silicone: a sheet of silicone filled with ceramic powder, of the kind that is sold in 0.2 to 0.25 mm
as insulation under power transistors. Every number is an estimate of a usual value, no datasheet's: 1.6 W/(m K) is
within the 1.5 to 3 of such sheets, 1.7 MPa a Shore A hardness of 40 by Gent's relation."""


def skin(name: str | Skin | None) -> Skin | None:
    """What a keyword `skin` stands for: a name of SKINS, the skin itself, None for a bare face. Raises
    InvalidValueError and UnknownNameError."""
    if name is None or isinstance(name, Skin):
        return name
    if not isinstance(name, str):
        raise InvalidValueError(f"skin must be a name, a Skin or None, got {name!r}")
    if name not in SKINS:
        raise unknown_name("skin", name, SKINS)
    return SKINS[name]
