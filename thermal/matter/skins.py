"""A skin over a fingertip: a soft sheet that conforms to what is touched, and that heat must pass.

From the outside in, a fingertip is its skin, if it wears one, over the sensor's layers in the middle and over the
pad's silicone around them.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace
from types import MappingProxyType
from typing import TypeVar

from thermograsp.errors import InvalidValueError, positive, unknown_name, within

from .layers import Layer
from .materials import Material, material
from .mounting import Mode

_Stack = TypeVar("_Stack")
_THINNEST, _THICKEST = 1e-6, 5e-3  # m; a thicker one feels nothing
_POISSON = 0.3  # where a material has none, as of its surface
_RUBBER_BULK = 2e9  # Pa, of rubbers, whose Poisson ratio tables round to 0.5
_HALF_WIDTH = 1.5e-3  # m, of the contact with a ball of 20 mm radius at 10 N
_BULGING = 3.4, 0.07  # of a layer that keeps its volume, fitted to studies/contact/ball_contact.py


@dataclass(frozen=True, slots=True)
class Skin:
    """A sheet of one material, thickness 1e-6 .. 5e-3 m, bonded to the fingertip without a resistance of its own.

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

    @property
    def stiffness(self) -> float:
        """Pa/m, pressure per indentation of the sheet on a rigid face, under the contacts of curved bodies.

        Two springs in series, over the sheet's thickness d: its modulus of compression without bulging, K + 4 G/3
        (Johnson, Contact Mechanics, section 5.8), which alone would hold under contacts many times as wide as d, and
        E (3.4 + 0.07 (a/d)^2) for what bulges beside a contact of half width a. The second is fitted to finite elements
        of a ball on a nearly incompressible sheet; a is 1.5 mm."""
        made = self.made_of
        assert made.youngs_modulus is not None  # checked at first
        ratio = _POISSON if made.poisson_ratio is None else made.poisson_ratio
        bulk = made.youngs_modulus / (3 * (1 - 2 * ratio)) if ratio < 0.5 else _RUBBER_BULK
        shear = made.youngs_modulus / (2 * (1 + ratio))
        constant, square = _BULGING
        bulging = made.youngs_modulus * (constant + square * (_HALF_WIDTH / self.thickness) ** 2)
        return 1 / (1 / (bulk + 4 * shear / 3) + 1 / bulging) / self.thickness

    def over(self, stack: _Stack) -> _Stack:
        """A SensorStack or a HeatedStack with this skin on its face: one more layer, which is read and heated where it
        was. Raises InvalidValueError for a skin that is thicker than the sensor: through it hardly anything is felt,
        and networks that keep a tolerance would tell no more than that."""
        most = sum(layer.thickness for layer in stack.layers)  # pyright: ignore
        if self.thickness > most:
            raise InvalidValueError(
                f"a skin of {1e3 * self.thickness:g} mm is thicker than its sensor of {1e3 * most:g} mm: hardly "
                f"anything is felt through it; take one of {1e3 * most:g} mm at most"
            )
        return replace(stack, layers=(*stack.layers, self.layer))  # pyright: ignore


SKINS: Mapping[str, Skin] = MappingProxyType(
    {
        "filled_silicone": Skin(
            Material(
                "filled_silicone",
                conductivity=1.8,
                density=2200.0,
                specific_heat=1000.0,
                family="elastomer",
                youngs_modulus=1.7e6,
                poisson_ratio=0.49,
                roughness=2e-6,
                sources=dict.fromkeys(
                    (
                        *("conductivity", "density", "specific_heat"),
                        *("youngs_modulus", "poisson_ratio", "roughness"),
                    ),
                    "estimate",
                ),
            ),
            thickness=0.203e-3,
        )
    }
)
"""By name. filled_silicone: silicone filled with ceramic powder, as it is sold for insulation under power transistors.
The thickness is that of Henkel's Bergquist Sil Pad TSP 1800ST. By a transcription of its data sheet (the sheet itself
has not been read) it has 0.20 K in2/W, or 1.29e-4 m2 K/W, between two faces at 200 psi; the sheet alone is 1.13e-4
here. Everything else is an estimate of a usual value: 1.8 W/(m K) agrees with that impedance, and 1.7 MPa is a Shore
A hardness of 40 by Gent's relation."""

USUAL_SKIN = "filled_silicone"
"""What meets objects where the environments choose (see envs.SimulationConfig)."""


def skin(name: str | Skin | None, mode: Mode = "T") -> Skin | None:
    """What a keyword `skin` stands for: a name of SKINS, the skin itself, None for a bare fingertip. Raises
    UnknownNameError, and InvalidValueError for what is none, or any in mode O."""
    if name is not None and mode == "O":
        raise InvalidValueError(
            "a skin is what touches the object, on which the element is glued in mode 'O': leave it out"
        )
    if name is None or isinstance(name, Skin):
        return name
    if not isinstance(name, str):
        raise InvalidValueError(f"skin must be a name, a Skin or None, got {name!r}")
    if name not in SKINS:
        raise unknown_name("skin", name, SKINS)
    return SKINS[name]
