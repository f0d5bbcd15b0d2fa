import numpy as np
import pytest
import trimesh

from thermograsp import thermal
from thermograsp.errors import InvalidValueError
from thermograsp.thermal.column import Column, element_slabs
from thermograsp.thermal.laplace import invert
from thermograsp.thermal.mesh_press import press_body
from thermograsp.thermal.mesh_solid import Solid, SolidPart, SurfacePatch, solid

CUBE = (0.04, 0.04, 0.04)
TOP = SurfacePatch((0, 0, 0.02), (0, 0, 1))
NAMES = "rubber", "stainless_steel"


def of(mesh, material):
    return solid(mesh.vertices, mesh.faces, thermal.material(material))


@pytest.mark.parametrize("material", ["cork", "glass", "aluminium"])
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
    felt = press_body(cup, SurfacePatch((radius, 0, 0), (1, 0, 0)), tolerance=0.025, cache=False)
    layer, plate = (
        thermal.press("glass", object_size=(0.06, 0.06, wall), rung=rung)
        for rung in ("layered", "semi_analytic")
    )
    first = thermal.material("glass").diffusivity * felt.t / 81e-6 < 1e-3
    first &= felt.t >= 0.05
    assert first.sum() > 3
    assert np.abs(felt.temperature_drop - layer.temperature_drop)[first].max() < 0.05
    late = felt.t >= 0.05
    assert np.abs(felt.temperature_drop - plate.temperature_drop)[late].max() < 0.05  # 1 %, and it is curved
    assert np.abs(felt.temperature_drop - layer.temperature_drop)[late].max() > 0.3


def layered_drop(t: np.ndarray, layers) -> np.ndarray:
    """K of 12 K at t (n,) s, of one dimension: layers of (m, material), the touched one first, adiabatic behind."""
    stack = thermal.sensor("seed")

    def impedance(s: np.ndarray) -> np.ndarray:
        admittance = np.zeros_like(s)
        for depth, material in reversed(layers):
            root = np.sqrt(s / material.diffusivity)
            own, along = material.conductivity * root, np.tanh(root * depth)
            admittance = own * (admittance + own * along) / (own + admittance * along)
        return 1 / admittance

    contact = 1 / (1e4 * 81e-6)
    column = Column("T", element_slabs(stack), stack.sensed, stack.face_area, contact, impedance, 81e-6)
    return 12.0 * invert(column.transform, t)[:, 0]


@pytest.mark.parametrize("sleeve", [0.0005, 0.0002])
def test_a_steel_core_in_a_sleeve_of_rubber_is_layered_at_first(sleeve):
    """While rubber's diffusivity * time is below 1/4000 of the contact's area (.28 s), in which heat passes .2 mm of it
    but not .5 mm; after that heat spreads sideways."""
    rubber, steel = thermal.material("rubber"), thermal.material("stainless_steel")
    outer, inner = (trimesh.creation.box(np.array(CUBE) - 2 * depth) for depth in (0.0, sleeve))
    parts = SolidPart(outer.vertices, outer.faces, rubber), SolidPart(inner.vertices, inner.faces, steel)
    felt = press_body(Solid(parts), TOP, tolerance=0.025, cache=False, seconds=4.0)
    layers = [(sleeve, rubber), (CUBE[2] - 2 * sleeve, steel), (sleeve, rubber)]
    first = (felt.t >= 0.05) & (rubber.diffusivity * felt.t < 81e-6 / 4000)
    assert first.sum() > 10
    assert np.abs(felt.temperature_drop[first] - layered_drop(felt.t[first], layers)).max() < 0.03
    plain = [press_body(of(outer, name), TOP, tolerance=0.025, cache=False, seconds=4.0) for name in NAMES]
    between = felt.t > 1.0
    rubbery, steely = (curve.temperature_drop[between] for curve in plain)
    assert np.all(felt.temperature_drop[between] > rubbery) and np.all(
        felt.temperature_drop[between] < steely
    )


def test_air_cools_by_the_true_surface():
    body = of(trimesh.creation.box(CUBE), "aluminium")
    mesh = press_body(body, TOP, air=20.0, cache=False, seconds=60, dt=0.1)
    box = thermal.press(
        "aluminium", object_size=CUBE, air=20.0, rung="network", tolerance=0.02, seconds=60, dt=0.1
    )
    assert mesh.object_surface[-1] == pytest.approx(box.object_surface[-1], abs=0.02)
    assert mesh.stored_heat[-1, 1] == pytest.approx(box.stored_heat[-1, 1], rel=5e-3)


def test_what_cannot_be_pressed_is_refused():
    body = of(trimesh.creation.box(CUBE), "glass")
    with pytest.raises(InvalidValueError, match="finer than a mesh's grid"):
        press_body(body, TOP, tolerance=0.001)
    with pytest.raises(InvalidValueError, match="more than the face"):
        press_body(body, SurfacePatch((0, 0, 0.02), (0, 0, 1), 1e-4))
