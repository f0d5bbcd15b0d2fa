from typing import Any

import numpy as np
import pytest
import trimesh

from thermograsp import thermal
from thermograsp.errors import InvalidValueError
from thermograsp.thermal.meshes import press as press_module
from thermograsp.thermal.meshes.press import press_body
from thermograsp.thermal.meshes.touched import touched_body
from thermograsp.thermal.network import Demand
from thermograsp.thermal.numerics.laplace import invert
from thermograsp.thermal.rungs.layered import Column
from thermograsp.thermal.surfaces.solid import (
    Solid,
    SolidPart,
    SurfacePatch,
    solid,
)

CUBE = (0.04, 0.04, 0.04)
TOP = SurfacePatch((0, 0, 0.02), (0, 0, 1))
NAMES = "rubber", "stainless_steel"


def of(mesh, material):
    return solid(mesh.vertices, mesh.faces, thermal.material(material))


@pytest.mark.parametrize(
    "material", ["aluminium", *(pytest.param(name, marks=pytest.mark.slow) for name in ("cork", "glass"))]
)
def test_a_mesh_cube_feels_like_the_box(material):
    mesh = press_body(of(trimesh.creation.box(CUBE), material), TOP, tolerance=0.025, cache=False)
    box = thermal.press(material, object_size=CUBE, rung="semi_analytic")
    late = mesh.t >= 0.05
    assert np.abs(mesh.temperature_drop - box.temperature_drop)[late].max() < 0.02
    passed = np.concatenate(([0.0], np.cumsum((mesh.heat_flow[1:] + mesh.heat_flow[:-1]) / 2) * 0.02))
    assert mesh.stored_heat[-1, 1] == pytest.approx(
        passed[-1] + (mesh.stored_heat[2, 1] - passed[2]), rel=5e-3
    )


def test_a_cup_s_wall_is_a_layer_at_first_and_a_shell_later():
    """3 mm of glass in a cup of 40 mm radius. The layered rung, one-dimensional, serves while diffusivity * time is
    below 1/1000 of the contact's area (0.1 s here); after that heat spreads sideways, as in a plate of 3 mm."""
    wall, radius = 0.003, 0.04
    profile = [
        (0, -0.03),
        (radius, -0.03),
        (radius, 0.03),
        (radius - wall, 0.03),
        (radius - wall, -0.027),
        (0, -0.027),
    ]
    cup = of(trimesh.creation.revolve(profile, sections=256), "glass")
    press = press_body(cup, SurfacePatch((radius, 0, 0), (1, 0, 0)), tolerance=0.025, cache=False)
    layer, plate = (
        thermal.press("glass", object_size=(0.06, 0.06, wall), rung=rung)
        for rung in ("layered", "semi_analytic")
    )
    first = thermal.material("glass").diffusivity * press.t / 81e-6 < 1e-3
    first &= press.t >= 0.05
    assert first.sum() > 3
    assert np.abs(press.temperature_drop - layer.temperature_drop)[first].max() < 0.05
    late = press.t >= 0.05
    assert np.abs(press.temperature_drop - plate.temperature_drop)[late].max() < 0.05  # 1 %, and it is curved
    assert np.abs(press.temperature_drop - layer.temperature_drop)[late].max() > 0.3


def layered_drop(t: np.ndarray, layers) -> np.ndarray:
    """K of 12 K at t (n,) s, of one dimension: layers of (m, material), the touched one first, adiabatic behind."""
    stack = thermal.sensor("seed")

    def impedance(s: np.ndarray) -> np.ndarray:
        admittance = np.zeros_like(s)
        for depth, material in reversed(layers):
            root = np.sqrt(s / material.diffusivity)
            effusive, along = material.conductivity * root, np.tanh(root * depth)
            admittance = effusive * (admittance + effusive * along) / (effusive + admittance * along)
        return 1 / admittance

    contact = 1 / (1e4 * 81e-6)
    column = Column("T", stack.layers, stack.sensed, stack.face_area, contact, impedance, 81e-6)
    return 12.0 * invert(column.transform, t)[:, 0]


@pytest.mark.parametrize("sleeve", [0.0005, pytest.param(0.0002, marks=pytest.mark.slow)])
def test_a_steel_core_in_a_sleeve_of_rubber_is_layered_at_first(sleeve):
    """While rubber's diffusivity * time is below 1/4000 of the contact's area (.28 s), in which heat passes .2 mm of it
    but not .5 mm; after that heat spreads sideways."""
    rubber, steel = thermal.material("rubber"), thermal.material("stainless_steel")
    outer, inner = (trimesh.creation.box(np.array(CUBE) - 2 * depth) for depth in (0.0, sleeve))
    parts = SolidPart(outer.vertices, outer.faces, rubber), SolidPart(inner.vertices, inner.faces, steel)
    press = press_body(Solid(parts), TOP, tolerance=0.025, cache=False, seconds=4.0)
    layers = [(sleeve, rubber), (CUBE[2] - 2 * sleeve, steel), (sleeve, rubber)]
    first = (press.t >= 0.05) & (rubber.diffusivity * press.t < 81e-6 / 4000)
    assert first.sum() > 10
    assert np.abs(press.temperature_drop[first] - layered_drop(press.t[first], layers)).max() < 0.03
    plain = [press_body(of(outer, name), TOP, tolerance=0.025, cache=False, seconds=4.0) for name in NAMES]
    between = press.t > 1.0
    rubbery, steely = (curve.temperature_drop[between] for curve in plain)
    assert np.all(press.temperature_drop[between] > rubbery) and np.all(
        press.temperature_drop[between] < steely
    )


@pytest.mark.slow
def test_air_cools_by_the_true_surface():
    body = of(trimesh.creation.box(CUBE), "aluminium")
    mesh = press_body(body, TOP, air=20.0, cache=False, seconds=60, dt=0.1)
    box = thermal.press("aluminium", object_size=CUBE, air=20.0, rung="grid_3d", seconds=60, dt=0.1)
    assert mesh.object_surface[-1] == pytest.approx(box.object_surface[-1], abs=0.02)
    assert mesh.stored_heat[-1, 1] == pytest.approx(box.stored_heat[-1, 1], rel=5e-3)


def test_what_cannot_be_pressed_is_refused():
    body = of(trimesh.creation.box(CUBE), "glass")
    with pytest.raises(InvalidValueError, match="finer than a mesh's grid"):
        press_body(body, TOP, tolerance=0.001)
    with pytest.raises(InvalidValueError, match="more than the face"):
        press_body(body, SurfacePatch((0, 0, 0.02), (0, 0, 1), 1e-4))


BLOCK = (0.012, 0.012, 0.012)
SMALL = SurfacePatch((0, 0, 0.006), (0, 0, 1), 36e-6)


def pressed_block(celsius: float, tolerance: float) -> thermal.Press:
    body = of(trimesh.creation.box(BLOCK), "aluminium")
    keywords: dict[str, Any] = {"conductance": 1e5, "seconds": 3.0, "dt": 0.1, "cache": False}
    return press_body(body, SMALL, tolerance=tolerance, object_temperature=celsius, **keywords)


@pytest.fixture(scope="module")
def cold() -> thermal.Press:
    return pressed_block(24.0, 0.03)


def test_hot_objects_are_as_well_known_as_cold_ones(cold):
    """12 K from the sensor on either side, beside a solution that shares no network with it."""
    hot = pressed_block(48.0, 0.03)
    box = thermal.press(
        "aluminium",
        area=36e-6,
        object_size=BLOCK,
        conductance=1e5,
        seconds=3.0,
        dt=0.1,
        rung="semi_analytic",
    )
    assert cold.temperature_drop.max() > 1.0
    for press, sign in ((cold, 1.0), (hot, -1.0)):
        difference = np.abs(sign * press.temperature_drop - box.temperature_drop)[1:]
        assert difference.max() < press.rung.error <= 0.03
    assert np.abs(hot.temperature_drop + cold.temperature_drop).max() < 1e-9


def test_what_is_told_of_the_error_was_measured(cold):
    """The network's part is how far its drop is from that of all the grid's states, not what was asked for."""
    coarse = pressed_block(24.0, 0.3)
    assert cold.rung.error < coarse.rung.error < 0.3 / 2
    for press, tolerance in ((cold, 0.03), (coarse, 0.3)):
        network = press.rung.error - 1e-3 * 12
        assert 0 < network < tolerance / 2 and abs(network - tolerance / 2) > 1e-3 * tolerance
        assert f"measured {network:.2g} K off" in press.rung.reason
    difference = np.abs(coarse.temperature_drop - cold.temperature_drop)[1:].max()
    assert difference < coarse.rung.error + cold.rung.error


def test_where_states_left_out_are_missed_all_of_them_stay():
    """A tolerance near to rounding is kept by the whole network; it ended an episode with an error."""
    body, stack = of(trimesh.creation.box(BLOCK), "aluminium"), thermal.sensor("seed")
    fine, usual = (
        touched_body(body, [SMALL], stack, Demand(tolerance, 12.0, (1e5,), 3.0), fingertips=1, cache=False)
        for tolerance in (1e-9, 0.1)
    )
    assert fine.error == 0.0 < usual.error <= 0.05
    assert fine.object.order > usual.object.order and fine.sensor.order > usual.sensor.order


def test_what_a_press_in_air_leaves_unmeasured_is_told(monkeypatch):
    """And its network is made for the largest conductance of those that vary."""
    demanded = []

    def watched(body, patches, stack, demand, **others):
        demanded.append(demand.conductances)
        return touched_body(body, patches, stack, demand, **others)

    monkeypatch.setattr(press_module, "touched_body", watched)
    cube = of(trimesh.creation.box(CUBE), "glass")
    keywords: dict[str, Any] = {"tolerance": 0.1, "seconds": 0.5, "dt": 0.1}
    assert "air" not in press_body(cube, TOP, **keywords).rung.reason
    airy = press_body(cube, TOP, air=20.0, conductance=lambda time: 1e6, **keywords)
    assert "air" in airy.rung.reason
    assert demanded == [(1e4,), (1e2, 1e3, 1e4, 1e5, 1e6)]
