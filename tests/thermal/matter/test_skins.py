"""A skin is a layer of the sensor: in resistance, in heat capacity, and in what touches."""

from __future__ import annotations

import numpy as np
import pytest

from thermograsp.errors import InvalidValueError, UnknownNameError
from thermograsp.thermal import SKINS, Material, Skin, press, sensor
from thermograsp.thermal.stack import heated_stack

SILICONE = SKINS["filled_silicone"]
WORDS = {"seconds": 4.0, "dt": 0.05}


@pytest.mark.parametrize(
    ("name", "skin"),
    [
        ("plastic", SILICONE),
        ("aluminium", SILICONE),
        ("aluminium", Skin("silicone", 1e-5)),
        ("glass", Skin("silicone", 1e-6)),
    ],
    ids=str,
)
def test_a_press_is_that_of_the_semi_analytic_solution_of_the_same_layers(name: str, skin: Skin) -> None:
    found = press(name, skin=skin, tolerance=0.02, **WORDS)  # pyright: ignore[reportArgumentType]
    stack = skin.over(sensor("seed"))
    exact = press(name, sensor=stack, rung="semi_analytic", **WORDS)  # pyright: ignore[reportArgumentType]
    assert found.rung.name == "network"
    assert np.abs(found.temperature_drop - exact.temperature_drop).max() < 0.02


def test_it_holds_heat_back_by_its_resistance() -> None:
    """Settled on a body that stays as it is, thin and wide of a good conductor: resistances in series."""
    bulk = Material("bulk", 1e5, 1e4, 1e4)
    stack, h = sensor("seed"), 1e4
    found = press(bulk, skin=SILICONE, conductance=h, seconds=40.0, dt=1.0, tolerance=0.01)
    layers = [layer.thickness / layer.conductivity for layer in stack.layers]
    whole = sum(layers) + SILICONE.resistance + 1 / h
    assert SILICONE.resistance == pytest.approx(1.25e-4)
    assert found.temperature_drop[-1] == pytest.approx(12 * layers[1] / whole, abs=0.02)


def test_layers_and_capacity_are_those_of_sensor_and_skin() -> None:
    bare, made = sensor("seed"), SILICONE.made_of
    worn = SILICONE.over(bare)
    assert worn.layers[:-1] == bare.layers and worn.sensed == bare.sensed
    own = bare.face_area * SILICONE.thickness * made.volumetric_heat_capacity
    assert worn.heat_capacity == pytest.approx(bare.heat_capacity + own)
    heated = heated_stack("heated_thermistor")
    assert SILICONE.over(heated).layers == (*heated.layers, SILICONE.layer)
    assert SILICONE.over(heated).readout == heated.readout


def test_a_heated_sensor_wears_one() -> None:
    bare, worn = (
        press("aluminium", sensor="heated_thermistor", skin=skin, seconds=2.0, tolerance=0.1)
        for skin in (None, Skin("silicone", 0.5e-3))
    )
    assert bare.reading is not None and worn.reading is not None
    assert worn.reading[-1] > bare.reading[-1] + 0.1


def test_refuses_what_is_none() -> None:
    with pytest.raises(UnknownNameError, match="filled_silicone"):
        press("glass", skin="filled_silicon")
    for thickness in (0.0, 1e-7, 0.2, "thin"):
        with pytest.raises(InvalidValueError, match="thickness"):
            Skin("silicone", thickness)  # pyright: ignore[reportArgumentType]
    with pytest.raises(InvalidValueError, match="a name, a Skin or None"):
        press("glass", skin={"silicone": 1e-4})  # pyright: ignore[reportArgumentType]
    with pytest.raises(InvalidValueError, match="youngs_modulus"):
        Skin(Material("m", 1, 1, 1), 1e-4)
    with pytest.raises(InvalidValueError, match="mode"):
        press("glass", skin=SILICONE, mode="O")
