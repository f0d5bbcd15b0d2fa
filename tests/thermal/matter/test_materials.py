"""The material table is plausible and sourced; a user's table is read whole or refused by name."""

import math
import pickle
import re
import tomllib
from dataclasses import FrozenInstanceError, replace
from itertools import product
from pathlib import Path

import pytest

from thermograsp import thermal
from thermograsp.assets import asset
from thermograsp.errors import InvalidValueError, UnknownNameError
from thermograsp.thermal import (
    Material,
    load_materials,
    material,
    materials,
)
from thermograsp.thermal.matter.materials import UNITS

SEED = "cotton wood plastic rubber glass ceramic marble stainless_steel iron aluminium".split()
SEED_VALUES = {
    "cotton": (0.04, 80, 1300),
    "wood": (0.15, 600, 1700),
    "plastic": (0.19, 1180, 1470),
    "rubber": (0.16, 1100, 2000),
    "glass": (1.0, 2500, 840),
    "ceramic": (1.5, 2300, 1070),
    "marble": (2.8, 2700, 880),
    "stainless_steel": (16.2, 8000, 500),
    "iron": (80.2, 7874, 449),
    "aluminium": (237, 2700, 897),
}
# Family: conductivity, density, volumetric heat capacity MJ/(m3 K) and Young's modulus, as Ashby's charts bound them.
RANGES = {
    "metal": ((10, 450), (1700, 20000), (1.2, 4.2), (1e10, 5e11)),
    "wood": ((0.03, 0.25), (100, 1100), (0.15, 1.5), (1e7, 5e9)),
    "polymer": ((0.1, 0.5), (850, 2300), (1.2, 2.6), (2e8, 5e9)),
    "composite": ((0.3, 3), (1400, 2000), (1.2, 2.6), (1e10, 2e11)),
    "elastomer": ((0.08, 0.5), (850, 1900), (1.2, 2.8), (5e5, 5e7)),
    "foam": ((0.02, 0.08), (10, 200), (0.01, 0.3), (1e4, 1e8)),
    "textile": ((0.03, 0.2), (50, 1100), (0.05, 2.0), (1e4, 5e8)),
    "paper": ((0.05, 0.2), (400, 1200), (0.5, 1.7), (1e6, 1e10)),
    "stone": ((0.2, 7), (1400, 3000), (1.2, 3.2), (1e9, 1e11)),
    "glass": ((0.7, 1.6), (2100, 2700), (1.5, 2.3), (5e10, 9e10)),
    "ceramic": ((1, 500), (2200, 4100), (1.5, 3.3), (5e10, 5e11)),
    "tissue": ((0.2, 0.6), (900, 2000), (2.0, 4.0), (5e3, 3e10)),
    "food": ((0.2, 0.62), (800, 1100), (2.0, 4.2), (1e4, 5e10)),
    "water": ((0.5, 2.3), (900, 1010), (1.8, 4.2), (1e3, 1e10)),
    "wax": ((0.2, 0.3), (850, 950), (1.5, 3.0), (1e7, 1e9)),
}

GOOD = """
[sources]
lab = "Measured in our laboratory, 2024"
[materials.mine]
family = "polymer"
conductivity = { value = 0.2, unit = "W/(m K)", source = "lab" }
density = { value = 1200, unit = "kg/m3", source = "lab" }
specific_heat = { value = 1500.0, unit = "J/(kg K)", source = "lab" }
roughness = { value = 1e-6, unit = "m", source = "lab" }
[materials.other]
conductivity = { value = 0.3, unit = "W/(m K)", source = "lab" }
density = { value = 1300, unit = "kg/m3", source = "lab" }
specific_heat = { value = 1600, unit = "J/(kg K)", source = "lab" }
"""


@pytest.fixture
def write(tmp_path: Path):
    def write(text: str) -> Path:
        path = tmp_path / "mine.toml"
        path.write_text(text, encoding="utf-8")
        return path

    return write


def test_the_seed_ten_keep_their_values_and_rise_in_effusivity() -> None:
    table = materials()
    assert [name for name in table if name in SEED] == SEED
    for name, values in SEED_VALUES.items():
        entry = table[name]
        assert (entry.conductivity, entry.density, entry.specific_heat) == values
    effusivities = [table[name].effusivity for name in SEED]
    assert effusivities == sorted(effusivities)


def test_the_table_is_wide() -> None:
    assert len(materials()) >= 65
    assert {entry.family for entry in materials().values()} == set(RANGES)
    wanted = "copper brass steel oak pine ptfe granite skin water_gel ice silicone egg paper leather".split()
    assert set(wanted) <= set(materials())


@pytest.mark.parametrize("name", materials())
def test_an_entry_is_complete_plausible_and_sourced(name: str) -> None:
    entry = material(name)
    assert entry.name == name
    conductivity, density, capacity, modulus = RANGES[entry.family]
    assert conductivity[0] <= entry.conductivity <= conductivity[1]
    assert density[0] <= entry.density <= density[1]
    assert capacity[0] <= entry.volumetric_heat_capacity / 1e6 <= capacity[1]
    assert entry.youngs_modulus is not None and modulus[0] <= entry.youngs_modulus <= modulus[1]
    assert entry.poisson_ratio is not None and 0 <= entry.poisson_ratio < 0.5
    assert entry.roughness is not None and 5e-9 <= entry.roughness <= 1e-4
    assert entry.friction is not None and 0.05 <= entry.friction <= 1.5
    if entry.microhardness is not None:
        assert 1e7 <= entry.microhardness <= 3e10
        assert entry.microhardness < entry.youngs_modulus
    if entry.crushing_stress is not None:
        assert 1e4 <= entry.crushing_stress <= 2e9
    given = {prop for prop in UNITS if getattr(entry, prop) is not None}
    assert set(entry.sources) == given
    assert all(len(citation) > 40 for citation in entry.sources.values())


@pytest.mark.parametrize("name", materials())
def test_slopes_follow_lambert_and_fletcher(name: str) -> None:
    entry = material(name)
    assert entry.roughness is not None
    assert entry.asperity_slope == pytest.approx(0.076 * (entry.roughness * 1e6) ** 0.52, rel=0.06)


def test_hard_families_have_a_hardness() -> None:
    for entry in materials().values():
        if entry.family in ("metal", "glass", "ceramic", "stone", "polymer"):
            assert entry.microhardness is not None, entry.name


def test_metals_obey_wiedemann_and_franz() -> None:
    """Conductivity times resistivity over temperature is near 2.44e-8 W ohm/K2; resistivities at 293 K from the CRC."""
    resistivity = {"silver": 1.587e-8, "copper": 1.678e-8, "gold": 2.214e-8, "tungsten": 5.28e-8}
    resistivity |= {
        "aluminium": 2.650e-8,
        "magnesium": 4.39e-8,
        "zinc": 5.9e-8,
        "tin": 11.5e-8,
        "lead": 20.8e-8,
    }
    resistivity |= {"nickel": 6.93e-8, "iron": 9.61e-8}
    for name, rho in resistivity.items():
        assert 2.0e-8 < material(name).conductivity * rho / 293 < 3.3e-8, name


def test_elements_obey_dulong_and_petit() -> None:
    """Metals near room temperature hold 22 to 27 J/(mol K) (3 R = 24.9), by their CRC molar masses, g/mol."""
    molar = {
        "aluminium": 26.98,
        "copper": 63.55,
        "gold": 196.97,
        "iron": 55.85,
        "lead": 207.2,
        "magnesium": 24.31,
    }
    molar |= {
        "nickel": 58.69,
        "silver": 107.87,
        "tin": 118.71,
        "titanium": 47.87,
        "tungsten": 183.84,
        "zinc": 65.38,
    }
    for name, mass in molar.items():
        assert 22 < material(name).specific_heat * mass / 1e3 < 28, name


@pytest.mark.parametrize("name", ["oak", "maple", "walnut", "pine", "douglas_fir", "spruce"])
def test_woods_follow_the_wood_handbook(name: str) -> None:
    """FPL-GTR-190, the equations of chapter 4 at 12 % moisture and 20 °C."""
    entry = material(name)
    gravity = entry.density / 1120
    assert entry.conductivity == pytest.approx(gravity * (0.1941 + 0.004064 * 12) + 0.01864, abs=1e-3)
    dry = 0.1031 + 0.003867 * 293.15
    bound = 12 * (-0.06191 + 2.36e-4 * 293.15 - 1.33e-4 * 12)
    assert entry.specific_heat == pytest.approx(1000 * ((dry + 0.12 * 4.18) / 1.12 + bound), abs=5)


@pytest.mark.parametrize(
    ("name", "composition"),
    [  # mass of water, protein, fat, carbohydrate without fibre, fibre, ash in 100
        ("potato", (78.96, 2.07, 0.10, 16.38, 1.6, 0.89)),
        ("tomato", (93.76, 0.85, 0.33, 3.54, 1.1, 0.42)),
        ("beef", (64.75, 20.37, 12.81, 0, 0, 0.97)),
        ("cheese", (36.75, 24.9, 33.14, 1.28, 0, 3.93)),
        ("butter", (15.87, 0.85, 81.11, 0.06, 0, 2.11)),
        ("egg", (75.33, 12.49, 10.02, 1.22, 0, 0.94)),
    ],
)
def test_foods_follow_choi_and_okos(name: str, composition: tuple[float, ...]) -> None:
    """Component properties at 20 °C: W/(m K), kg/m3, J/(kg K)."""
    conductivity = (0.6037, 0.2016, 0.1751, 0.2274, 0.2071, 0.3565)
    density = (995.7, 1319.5, 917.2, 1592.9, 1304.2, 2418.2)
    heat = (4129, 2032, 2012, 1586, 1881, 1129)
    total = sum(composition)
    parts = [part / total for part in composition]
    volumes = [part / rho for part, rho in zip(parts, density, strict=True)]
    entry = material(name)
    assert entry.density == pytest.approx(1 / sum(volumes), rel=2e-3)
    assert entry.specific_heat == pytest.approx(
        sum(p * c for p, c in zip(parts, heat, strict=True)), rel=3e-3
    )
    mixed = sum(volume * k for volume, k in zip(volumes, conductivity, strict=True)) / sum(volumes)
    assert entry.conductivity == pytest.approx(mixed, rel=3e-3)


def test_every_source_is_used() -> None:
    table = tomllib.loads(asset("materials.toml").read_text(encoding="utf-8"))
    cells = [
        cell for entry in table["materials"].values() for cell in entry.values() if isinstance(cell, dict)
    ]
    assert {cell["source"] for cell in cells} == set(table["sources"])


def test_derived_quantities() -> None:
    first = Material("mine", 2.0, 1000.0, 800.0)
    assert first.volumetric_heat_capacity == 8e5
    assert first.diffusivity == 2.5e-6
    assert first.effusivity == pytest.approx(math.sqrt(1.6e6))


def test_a_material_is_a_frozen_value() -> None:
    glass = material("glass")
    assert material(glass) is glass
    assert pickle.loads(pickle.dumps(glass)) == glass
    assert hash(replace(glass)) == hash(glass)
    assert replace(glass, conductivity=1.1) != glass
    with pytest.raises(FrozenInstanceError):
        glass.conductivity = 2.0  # pyright: ignore[reportAttributeAccessIssue]


def test_the_table_is_read_once_and_cannot_be_changed() -> None:
    assert thermal.materials() is materials()
    with pytest.raises(TypeError):
        materials()["mine"] = material("glass")  # pyright: ignore[reportIndexIssue]


def test_a_misspelt_name_gets_suggestions() -> None:
    with pytest.raises(UnknownNameError, match="unknown material 'glas'; did you mean 'glass'"):
        material("glas")
    with pytest.raises(UnknownNameError, match="aluminium"):
        material("aluminum")
    for wrong in (None, 3, ["glass"]):
        with pytest.raises(InvalidValueError, match="a name or a Material"):
            material(wrong)  # pyright: ignore[reportArgumentType]


@pytest.mark.parametrize("prop", UNITS)
@pytest.mark.parametrize("value", [-1.0, math.nan, math.inf, True, "1"])
def test_a_material_of_impossible_values_is_refused(prop: str, value: object) -> None:
    values = {"conductivity": 1.0, "density": 1000.0, "specific_heat": 1000.0, prop: value}
    with pytest.raises(InvalidValueError, match=f"mine: {prop}"):
        Material("mine", **values)  # pyright: ignore[reportArgumentType]


@pytest.mark.parametrize(
    ("prop", "value"),
    [("poisson_ratio", 99.0), *product(sorted(set(UNITS) - {"poisson_ratio"}), (1e-99, 1e99))],
)
def test_a_value_decades_off_all_matter_is_refused_with_the_range(prop: str, value: float) -> None:
    """Heat's networks would end in errors of NumPy's, or in no number, with such."""
    values = {"conductivity": 1.0, "density": 1000.0, "specific_heat": 1000.0, prop: value}
    with pytest.raises(
        InvalidValueError, match=f"mine: {prop} .* must be from .* to .*, got {re.escape(repr(value))}"
    ):
        Material("mine", **values)  # pyright: ignore[reportArgumentType]


def test_densities_and_specific_heats_are_refused_together() -> None:
    with pytest.raises(InvalidValueError, match=r"must be from 0.1 to 1e\+10 J/\(m3 K\), got 1e\+12"):
        Material("mine", 1.0, 1e6, 1e6)


@pytest.mark.parametrize(
    ("name", "conductivity", "density", "specific_heat"),
    [
        ("xenon", 0.0055, 5.4, 158.0),
        ("hydrogen", 0.18, 0.082, 14300.0),
        ("aerogel in a vacuum", 0.004, 3.0, 840.0),
        ("pure diamond", 3320.0, 3515.0, 509.0),
        ("osmium", 88.0, 22590.0, 130.0),
        ("melting paraffin", 0.2, 900.0, 2e5),
    ],
)
def test_all_real_matter_is_taken_and_felt(
    name: str, conductivity: float, density: float, specific_heat: float
) -> None:
    """And what conducts or stores ten times less or more."""
    for factor in (0.1, 1.0, 10.0):
        matter = Material(name, factor * conductivity, density, factor * specific_heat)
        drop = thermal.press(matter, seconds=1.0, cache=False).temperature_drop
        assert (-0.05 <= drop).all() and (drop <= 12.0).all()


def test_zero_is_refused_except_as_a_poisson_ratio() -> None:
    assert Material("mine", 1.0, 1.0, 1.0, poisson_ratio=0.0).poisson_ratio == 0
    for prop in set(UNITS) - {"poisson_ratio"}:
        with pytest.raises(InvalidValueError, match=f"mine: {prop}"):
            Material("mine", **({"conductivity": 1.0, "density": 1.0, "specific_heat": 1.0} | {prop: 0.0}))  # pyright: ignore[reportArgumentType]
    with pytest.raises(InvalidValueError, match="poisson_ratio .* from 0 to 0.5, got 0.6"):
        Material("mine", 1.0, 1.0, 1.0, poisson_ratio=0.6)


def test_a_users_table_is_read(write) -> None:
    catalogue = load_materials(write(GOOD))
    assert list(catalogue) == ["mine", "other"]
    assert catalogue["mine"].family == "polymer"
    assert catalogue["mine"].roughness == 1e-6
    assert catalogue["mine"].youngs_modulus is None
    assert catalogue["mine"].sources["density"] == "Measured in our laboratory, 2024"
    assert type(catalogue["mine"].density) is float
    assert "mine" not in materials()


@pytest.mark.parametrize(
    ("old", "new", "message"),
    [
        ("value = 0.2", "value = -0.2", r"mine: conductivity \(W/\(m K\)\) must be .* above 0, got -0.2"),
        ("value = 1200", "value = 0", "mine: density .* got 0"),
        ("value = 1200", "value = nan", "mine: density .* got nan"),
        ("value = 1200", "value = inf", "mine: density .* got inf"),
        ("value = 1200", "value = true", "mine: density .* must be a number, got True"),
        ("value = 1200", 'value = "1200"', "mine: density .* must be a number, got '1200'"),
        ("value = 1200, ", "", "mine: density has no value"),
        ('unit = "m", ', "", 'mine: roughness has no unit: add unit = "m"'),
        (', source = "lab" }\n[materials.other]', " }\n[materials.other]", "mine: roughness has no source"),
        (
            '1200, unit = "kg/m3"',
            '1.2, unit = "g/cm3"',
            'must be in "kg/m3", got .g/cm3.: write value = 1200, unit',
        ),
        (
            '1e-6, unit = "m"',
            '1, unit = "um"',
            'mine: roughness must be in "m", got .um.: write value = 1e-06',
        ),
        ('1e-6, unit = "m"', '1, unit = "furlong"', 'mine: roughness must be in "m", got .furlong.$'),
        ('1e-6, unit = "m"', '1, unit = ["m"]', 'mine: roughness must be in "m"'),
        ("roughness", "rougness", "unknown property of mine: 'rougness'; did you mean 'roughness'"),
        (
            '"m", source = "lab"',
            '"m", source = "lap"',
            "unknown source of mine: roughness: 'lap'; did you mean 'lab'",
        ),
        ('"m", source = "lab"', '"m", source = ["lab"]', "unknown source of mine: roughness"),
        ('source = "lab" }\n[materials.other]', 'source = "lab", note = 1 }\n[materials.other]', "'note'"),
        ('{ value = 1e-6, unit = "m", source = "lab" }', "1e-6", "mine: roughness must be .*, got 1e-06"),
        ("density = { value = 1300", "# ", r"other: density \(kg/m3\) is missing"),
        ("[materials.other]", "[materials.mine]", "not valid TOML"),
        ("[materials.other]", "[materials.Other]", "name 'Other' must be lower-case"),
        ("[materials.other]", "[material.other]", "unknown section 'material'; did you mean 'materials'"),
        ('family = "polymer"', "family = 3", "mine: family must be a word"),
        ('"Measured in our laboratory, 2024"', '" "', "source 'lab' must be a citation"),
        ('lab = "Measured in our laboratory, 2024"', "lab = 3", "source 'lab' must be a citation"),
    ],
)
def test_a_bad_table_is_refused_by_name_and_whole(write, old: str, new: str, message: str) -> None:
    assert old in GOOD
    path = write(GOOD.replace(old, new, 1))
    with pytest.raises(InvalidValueError, match=message) as caught:
        load_materials(path)
    assert str(path) in str(caught.value)


@pytest.mark.parametrize(
    "text", ["", "[sources]\n", "materials = 3", "sources = 3\n[materials.a]", "[materials]\na = 1"]
)
def test_a_table_without_materials_is_refused(write, text: str) -> None:
    with pytest.raises(InvalidValueError):
        load_materials(write(text))


def test_a_file_that_cannot_be_read_is_named(tmp_path: Path) -> None:
    with pytest.raises(InvalidValueError, match="cannot read .*missing.toml"):
        load_materials(tmp_path / "missing.toml")
    with pytest.raises(InvalidValueError, match="cannot read"):
        load_materials(tmp_path)
    (tmp_path / "binary.toml").write_bytes(b"\xff\xfe")
    with pytest.raises(InvalidValueError, match="binary.toml is not valid TOML"):
        load_materials(tmp_path / "binary.toml")


@pytest.mark.parametrize("name", ["", None, 3])
def test_a_material_needs_a_name(name: object) -> None:
    with pytest.raises(InvalidValueError, match="needs a name"):
        thermal.Material(name, 1.0, 2000.0, 800.0)  # pyright: ignore[reportArgumentType]
