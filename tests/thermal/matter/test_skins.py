"""A skin is a layer of the sensor: in resistance, in heat capacity, and in what touches."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
import trimesh

from thermograsp.errors import InvalidValueError, UnknownNameError
from thermograsp.thermal import (
    IDEAL,
    SKINS,
    Material,
    Skin,
    SurfacePatch,
    TouchSetup,
    array_fingertips,
    material,
    press,
    press_body,
    sensor,
    solid,
)
from thermograsp.thermal.curves import UnitCurves
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


@pytest.mark.slow
def test_on_a_body_of_any_shape_it_is_the_same_layer() -> None:
    cube = (0.04, 0.04, 0.04)
    mesh = trimesh.creation.box(cube)
    body = solid(mesh.vertices, mesh.faces, material("aluminium"))
    top = SurfacePatch((0, 0, 0.02), (0, 0, 1))
    found = press_body(body, top, skin=SILICONE, tolerance=0.025, cache=False, **WORDS)  # pyright: ignore[reportArgumentType]
    stack = SILICONE.over(sensor("seed"))
    exact = press("aluminium", sensor=stack, object_size=cube, rung="semi_analytic", **WORDS)  # pyright: ignore[reportArgumentType]
    assert np.abs(found.temperature_drop - exact.temperature_drop)[1:].max() < 0.02


def test_fingertips_of_arrays_wear_one_row_by_row() -> None:
    """What a press feels at their own conductance, the same bits alone and among others."""
    words = {"dt": 0.05, "like": np.zeros(0), "fingertips": 1, "air": 0.0, "chain": IDEAL, "tolerance": 0.05}
    size = (0.04, 0.03, 0.02)
    tips = array_fingertips("aluminium", skin=SILICONE, object_size=size, **words)  # pyright: ignore[reportArgumentType]
    force = np.array([[2.0], [10.0], [0.0]])
    conductance = tips.conductance(force)
    state, volts = tips.start(3), np.zeros((0, 3))
    for _ in range(40):
        state, voltage, _ = tips.step(state, conductance)
        volts = np.vstack((volts, voltage[:, 0]))
    alone, one = tips.start(1), np.zeros(0)
    for _ in range(40):
        alone, voltage, _ = tips.step(alone, tips.conductance(force[1:2]))
        one = np.append(one, voltage[0, 0])
    assert np.array_equal(volts[:, 1], one) and not volts[:, 2].any()
    area = sensor("seed").face_area
    pressed = press(
        "aluminium",
        skin=SILICONE,
        conductance=float(conductance[1, 0]) / area,
        object_size=size,
        seconds=2.0,
        dt=0.05,
    )
    assert np.abs(pressed.voltage[1:] - one).max() < 0.1 * sensor("seed").seebeck


def test_the_sheet_is_the_data_sheet_s_impedance_less_two_faces() -> None:
    """0.20 K in2/W at 200 psi, between two flat faces."""
    impedance = 0.20 * 0.0254**2
    assert 0.8 * impedance < SILICONE.resistance < impedance


def test_its_springs_are_those_of_a_sheet_that_cannot_bulge_where_contacts_are_wide() -> None:
    """A thousand times as wide as the sheet is thick. Thicker sheets are softer: they bulge beside the contact."""
    made = Material("sheet", 1.0, 1e3, 1e3, youngs_modulus=2e6, poisson_ratio=0.49, roughness=1e-6)
    for ratio in (0.3, 0.45, 0.49, 0.5):
        made = replace(made, poisson_ratio=ratio)
        bulk = 2e6 / (3 * (1 - 2 * ratio)) if ratio < 0.5 else 2e9
        modulus = bulk + 4 / 3 * 2e6 / (2 * (1 + ratio))  # Johnson, Contact Mechanics, section 5.8
        assert Skin(made, 1e-6).stiffness == pytest.approx(modulus / 1e-6, rel=0.01)
        moduli = [Skin(made, thickness).stiffness * thickness for thickness in (1e-6, 1e-4, 1e-3, 5e-3)]
        assert (np.diff(moduli) < 0).all() and moduli[-1] > 2e6 / 2


def test_curves_to_identify_by_are_those_of_the_same_layers() -> None:
    setup, glass, t = TouchSetup(skin="filled_silicone"), material("glass"), np.array([0.1, 0.5, 2.0])
    found = 12 * UnitCurves(setup.geometry(glass), t).on(glass)(np.array([5e3]))[0]
    exact = press("glass", sensor=setup.element, conductance=5e3, seconds=2.0, dt=0.1, rung="semi_analytic")
    assert setup.element == SILICONE.over(sensor("seed"))
    assert np.abs(found - np.interp(t, exact.t, exact.temperature_drop)).max() < 0.02


def test_it_holds_heat_back_by_its_resistance() -> None:
    """Settled on a body that stays as it is, thin and wide of a good conductor: resistances in series."""
    bulk = Material("bulk", 1e5, 1e4, 1e4)
    stack, h = sensor("seed"), 1e4
    found = press(bulk, skin=SILICONE, conductance=h, seconds=40.0, dt=1.0, tolerance=0.01)
    layers = [layer.thickness / layer.conductivity for layer in stack.layers]
    whole = sum(layers) + SILICONE.resistance + 1 / h
    assert SILICONE.resistance == pytest.approx(0.203e-3 / 1.8)
    assert found.temperature_drop[-1] == pytest.approx(12 * layers[1] / whole, abs=0.02)


def test_layers_and_capacity_are_those_of_sensor_and_skin() -> None:
    bare, made = sensor("seed"), SILICONE.made_of
    worn = SILICONE.over(bare)
    assert worn.layers[:-1] == bare.layers and worn.sensed == bare.sensed
    heat_capacity = bare.face_area * SILICONE.thickness * made.volumetric_heat_capacity
    assert worn.heat_capacity == pytest.approx(bare.heat_capacity + heat_capacity)
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
    with pytest.raises(UnknownNameError, match="silicone"):
        Skin("silicnoe", 1e-4)
    for refused in (
        lambda: press("glass", skin=SILICONE, mode="O"),
        lambda: TouchSetup(skin=SILICONE, mode="O"),
        lambda: array_fingertips("glass", dt=0.1, like=np.zeros(0), skin="filled_silicone", mode="O"),
    ):
        with pytest.raises(InvalidValueError, match="mode"):
            refused()
    for nothing in (np.nan, -1e-4, np.inf, True):
        with pytest.raises(InvalidValueError, match="thickness"):
            Skin("silicone", nothing)
    with pytest.raises(UnknownNameError, match="filled_silicone"):
        TouchSetup(skin="filled_silicon")


def test_one_that_is_thicker_than_its_sensor_is_refused_with_both() -> None:
    stack = sensor("seed")
    assert Skin("silicone", 0.003).over(stack).thickness == pytest.approx(0.006)
    with pytest.raises(InvalidValueError, match="4 mm is thicker than its sensor of 3 mm"):
        press("glass", skin=Skin("silicone", 0.004))
