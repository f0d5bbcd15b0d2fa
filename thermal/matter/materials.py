"""Materials of touched objects: the table that comes with the package, and a user's own in the same format.

A table is TOML. [sources] maps keys to citations; [materials.NAME] gives a family and each property as
{ value = 1.0, unit = "W/(m K)", source = "key" }. There is one unit a property, and it is spelled out, so that a
number means the same to whoever writes the file, whoever reads it, and this parser.
"""

from __future__ import annotations

import os
import re
from collections.abc import Mapping
from dataclasses import dataclass, field
from functools import cache
from types import MappingProxyType
from typing import Any

from thermograsp.errors import (
    InvalidValueError,
    ThermograspError,
    finite,
    positive,
    unknown_name,
)
from thermograsp.files import read_toml

from ...assets import asset
from .layers import Conductor, Layer

UNITS: Mapping[str, str] = MappingProxyType(
    {
        "conductivity": "W/(m K)",
        "density": "kg/m3",
        "specific_heat": "J/(kg K)",
        "youngs_modulus": "Pa",
        "poisson_ratio": "1",
        "microhardness": "Pa",
        "roughness": "m",
        "asperity_slope": "1",
        "friction": "1",
        "crushing_stress": "Pa",
    }
)
"""Property -> the unit that a table must give; "1" is dimensionless."""

_RANGES: Mapping[str, tuple[float, float]] = MappingProxyType(
    {
        "conductivity": (1e-4, 1e6),
        "density": (1e-3, 1e9),
        "specific_heat": (1e-3, 1e9),
        "youngs_modulus": (1.0, 1e15),
        "poisson_ratio": (0.0, 0.5),
        "microhardness": (1.0, 1e15),
        "roughness": (1e-15, 0.1),
        "asperity_slope": (1e-6, 100.0),
        "friction": (1e-6, 1e3),
        "crushing_stress": (1e-2, 1e15),
    }
)
"""Property -> the least and the most that is taken, in its unit: real matter, from gases and aerogels to diamond, with
decades to spare."""
_CAPACITIES = 0.1, 1e10  # J/(m3 K), density times specific heat; real matter has 1e2 to 5e6
_REQUIRED = ("conductivity", "density", "specific_heat")
_PASCALS = {"kPa": 1e3, "MPa": 1e6, "GPa": 1e9, "N/mm2": 1e6, "bar": 1e5}
_CONVERSIONS: Mapping[str, Mapping[str, float]] = {
    "W/(m K)": {"W/mK": 1.0, "W/m/K": 1.0, "mW/(m K)": 1e-3, "W/(cm K)": 100.0},
    "kg/m3": {"g/cm3": 1e3, "g/cc": 1e3, "kg/l": 1e3, "kg/m^3": 1.0},
    "J/(kg K)": {"kJ/(kg K)": 1e3, "J/(g K)": 1e3, "J/kgK": 1.0, "J/kg/K": 1.0, "kcal/(kg K)": 4184.0},
    "Pa": _PASCALS,
    "m": {"mm": 1e-3, "um": 1e-6, "µm": 1e-6, "nm": 1e-9},
    "1": {"-": 1.0, "": 1.0, "%": 0.01},
}
_NAME = re.compile(r"[a-z][a-z0-9_]*")


@dataclass(frozen=True, slots=True)
class Material(Conductor):
    """A homogeneous material at room temperature.

    conductivity: W/(m K), across the grain where there is one. density: kg/m3. specific_heat: J/(kg K).
    family: such as "metal". youngs_modulus: Pa. poisson_ratio: 0 .. 0.5. microhardness: Pa. roughness: m, rms height
    of a usual surface. asperity_slope: its mean absolute slope. friction: coefficient against a silicone pad.
    crushing_stress: Pa, pressure of a flat pad that leaves damage. sources: property -> citation. None: not known.
    Raises InvalidValueError for a value that is decades off what any material has.
    """

    name: str
    conductivity: float
    density: float
    specific_heat: float
    family: str = field(default="", kw_only=True)
    youngs_modulus: float | None = field(default=None, kw_only=True)
    poisson_ratio: float | None = field(default=None, kw_only=True)
    microhardness: float | None = field(default=None, kw_only=True)
    roughness: float | None = field(default=None, kw_only=True)
    asperity_slope: float | None = field(default=None, kw_only=True)
    friction: float | None = field(default=None, kw_only=True)
    crushing_stress: float | None = field(default=None, kw_only=True)
    sources: Mapping[str, str] = field(default_factory=dict, kw_only=True, compare=False, repr=False)

    def __post_init__(self) -> None:
        if not isinstance(self.name, str) or not self.name:
            raise InvalidValueError(f"a material needs a name, by which it is told of, got {self.name!r}")
        for name, unit in UNITS.items():
            value = getattr(self, name)
            if value is None and name not in _REQUIRED:
                continue
            _check(f"{self.name}: {name} ({unit})", name, value)
        low, high = _CAPACITIES
        if not low <= self.volumetric_heat_capacity <= high:
            raise InvalidValueError(
                f"{self.name}: density {self.density:g} kg/m3 times specific_heat {self.specific_heat:g} J/(kg K) must "
                f"be from {low:g} to {high:g} J/(m3 K), got {self.volumetric_heat_capacity:g}"
            )

    def layer(self, thickness: float) -> Layer:
        """A layer of this material, thickness m."""
        return Layer(self.name, thickness, self.conductivity, self.density, self.specific_heat)


SEED_MATERIALS = (
    "cotton",
    "wood",
    "plastic",
    "rubber",
    "glass",
    "ceramic",
    "marble",
    "stainless_steel",
    "iron",
    "aluminium",
)
"""The ten of Wu et al. 2012, in the paper's order: rising effusivity."""


@cache
def materials() -> Mapping[str, Material]:
    """The package's materials by name, in the order of the table; read-only."""
    return load_materials(asset("materials.toml"))


def material(name: str | Material) -> Material:
    """The package's material of that name, or the Material itself.

    Raises UnknownNameError with near names, InvalidValueError for anything but a name or a Material.
    """
    if isinstance(name, Material):
        return name
    if not isinstance(name, str):
        raise InvalidValueError(
            f"material must be a name or a Material, got {name!r} ({type(name).__name__})"
        )
    try:
        return materials()[name]
    except KeyError:
        raise unknown_name("material", name, materials()) from None


def load_materials(path: str | os.PathLike[str]) -> Mapping[str, Material]:
    """The materials of a TOML file by name, read-only; the format is this module's docstring.

    conductivity, density and specific_heat are required, the other properties of UNITS are not. Raises
    InvalidValueError, which names the file, the material and the property, for anything that does not fit; then
    nothing is loaded.
    """
    table = read_toml(path)
    try:
        return MappingProxyType(_materials(table))
    except ThermograspError as error:
        raise InvalidValueError(f"{path}: {error}") from None


def _materials(table: dict[str, Any]) -> dict[str, Material]:
    for key in table:
        if key not in ("sources", "materials"):
            raise unknown_name("section", key, ("sources", "materials"))
    sources = table.get("sources", {})
    entries = table.get("materials", {})
    if not isinstance(entries, dict) or not entries:
        raise InvalidValueError("there is no [materials.NAME] section")
    if not isinstance(sources, dict):
        raise InvalidValueError('[sources] must hold lines such as key = "citation"')
    for key, citation in sources.items():
        if not isinstance(citation, str) or not citation.strip():
            raise InvalidValueError(f"source {key!r} must be a citation in quotes, got {citation!r}")
    return {name: _material(name, entry, sources) for name, entry in entries.items()}


def _material(name: str, entry: object, sources: Mapping[str, str]) -> Material:
    if not _NAME.fullmatch(name):
        raise InvalidValueError(
            f"material name {name!r} must be lower-case letters, digits and _, a letter first"
        )
    if not isinstance(entry, dict):
        raise InvalidValueError(f"{name}: must be a section [materials.{name}], got {entry!r}")
    family = entry.get("family", "")
    if not isinstance(family, str):
        raise InvalidValueError(f'{name}: family must be a word in quotes such as "metal", got {family!r}')
    values: dict[str, Any] = {}
    citations: dict[str, str] = {}
    for prop, cell in entry.items():
        if prop == "family":
            continue
        if prop not in UNITS:
            raise unknown_name(f"property of {name}:", prop, ("family", *UNITS))
        values[prop], citations[prop] = _property(name, prop, cell, sources)
    for prop in _REQUIRED:
        if prop not in values:
            raise InvalidValueError(f"{name}: {prop} ({UNITS[prop]}) is missing")
    return Material(name, **values, family=family, sources=citations)


def _property(name: str, prop: str, cell: object, sources: Mapping[str, str]) -> tuple[float, str]:
    unit = UNITS[prop]
    where = f"{name}: {prop}"
    if not isinstance(cell, dict):
        raise InvalidValueError(
            f'{where} must be {{ value = ..., unit = "{unit}", source = ... }}, got {cell!r}'
        )
    for key in cell:
        if key not in ("value", "unit", "source"):
            raise unknown_name(f"key of {where}:", key, ("value", "unit", "source"))
    for key in ("value", "unit", "source"):
        if key not in cell:
            raise InvalidValueError(
                f"{where} has no {key}: " + (f'add unit = "{unit}"' if key == "unit" else "add it")
            )
    if cell["unit"] != unit:
        raise InvalidValueError(f'{where} must be in "{unit}", got {cell["unit"]!r}{_conversion(cell, unit)}')
    if not isinstance(cell["source"], str) or cell["source"] not in sources:
        raise unknown_name(f"source of {where}:", cell["source"], sources)
    return _check(f"{where} ({unit})", prop, cell["value"]), sources[cell["source"]]


def _conversion(cell: dict[str, Any], unit: str) -> str:
    """The same value in the unit that is wanted, where the given one is a usual one."""
    given, value = cell["unit"], cell["value"]
    factor = _CONVERSIONS[unit].get(given) if isinstance(given, str) else None
    if factor is None or isinstance(value, bool) or not isinstance(value, int | float):
        return ""
    return f': write value = {value * factor:.6g}, unit = "{unit}"'


def _check(where: str, prop: str, value: object) -> float:
    low, high = _RANGES[prop]
    number = positive(where, value) if low > 0 else finite(where, value)
    if not low <= number <= high:
        raise InvalidValueError(f"{where} must be from {low:g} to {high:g}, got {value!r}")
    return number
