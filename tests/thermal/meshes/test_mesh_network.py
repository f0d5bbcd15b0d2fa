from typing import Literal

import numpy as np
import pytest
import trimesh
from scipy.special import erf

from thermograsp import thermal
from thermograsp.errors import InvalidValueError, MeshError
from thermograsp.thermal.meshes.grid import (
    MeshGridding,
    grid_axes,
    grid_frame,
    mesh_grid,
)
from thermograsp.thermal.meshes.network import body_network
from thermograsp.thermal.meshes.patch import learned_patterns
from thermograsp.thermal.meshes.place import place_patch
from thermograsp.thermal.meshes.solve import conduct
from thermograsp.thermal.network.system import SHIFTS, sample_geometry
from thermograsp.thermal.plates.impedance import layered_impedance
from thermograsp.thermal.plates.samples import Geometry
from thermograsp.thermal.surfaces.solid import (
    Solid,
    SolidPart,
    SurfacePatch,
    solid,
)

PLATE = (0.04, 0.04, 0.01)
TOP, BOTTOM = (SurfacePatch((0, 0, z / 2 * 0.01), (0, 0, z)) for z in (1, -1))
MOMENTS = SHIFTS[4:12]  # 0.07 .. 23 1/s


def part(mesh, material="glass") -> SolidPart:
    return SolidPart(mesh.vertices, mesh.faces, thermal.material(material))


def of(mesh, material="glass") -> Solid:
    return Solid((part(mesh, material),))


def box(*size, at=(0, 0, 0)):
    return trimesh.creation.box(size).apply_translation(at)


def cup(radius=0.02, height=0.05, wall=0.003):
    inner, top = radius - wall, height / 2
    profile = [
        [0, -top],
        [radius, -top],
        [radius, top],
        [inner, top],
        [inner, wall - top],
        [0, wall - top],
    ]
    return trimesh.creation.revolve(profile, sections=128)


def network(body, *patches, **keywords):
    return body_network(body, patches, cache=False, **keywords)


def plate(material="glass", fingertips: Literal[1, 2] = 1):
    return Geometry(
        thermal.sensor("seed"), thermal.material(material), "T", 81e-6, "square", PLATE, fingertips
    )


@pytest.mark.parametrize("material", ["plastic", "aluminium"])
def test_a_box_is_the_plate_s_network_with_the_plate_s_flux_patterns(material):
    geometry = plate(material)
    net = network(of(box(*PLATE), material), TOP, patterns=learned_patterns(geometry, 3))
    expected = sample_geometry(geometry).network("even", 3).impedance(MOMENTS)
    z = net.impedance(MOMENTS)
    assert z[:, 0, 0] == pytest.approx(expected[:, 0, 0], rel=5e-3)
    # the others are steep at the patch's edge, and matter by the square of their share
    scale = expected[:, :1, :1]
    assert z / scale == pytest.approx(expected / scale, abs=0.1)


def test_patches_on_opposite_faces_are_the_plate_s_two_fingertips():
    samples = sample_geometry(plate(fingertips=2))
    even, odd = (samples.network(name, 1).impedance(MOMENTS)[:, 0, 0] for name in ("even", "odd"))
    z = network(of(box(*PLATE)), TOP, BOTTOM).impedance(MOMENTS)
    assert z[:, 0, 0] == pytest.approx((even + odd) / 2, rel=3e-3)
    assert z[:, 1, 1] == pytest.approx((even + odd) / 2, rel=3e-3)
    assert z[:, 0, 1] / z[:, 0, 0] == pytest.approx((even - odd) / (even + odd), abs=2e-3)
    assert z[:, 0, 1] == pytest.approx(z[:, 1, 0], rel=1e-12)


def test_the_impedance_converges_at_second_order():
    s = SHIFTS[3:9]
    expected = sample_geometry(plate()).network("even", 1).impedance(s)[:, 0, 0]
    errors, lengths = [], np.array([2.0, 1.0, 0.5])
    for f in lengths:
        gridding = MeshGridding(depth=40e-6 * f, side=0.1e-3 * f, growth=0.6 * f, largest=4e-3 * f)
        z = network(of(box(*PLATE)), TOP, gridding=gridding).impedance(s)[:, 0, 0]
        errors.append(np.abs(z / expected - 1).max())
    assert np.polyfit(np.log(lengths), np.log(errors), 1)[0] == pytest.approx(2.0, abs=0.3)
    assert errors[-1] < 1e-3


def test_a_turned_box_is_the_same_box():
    rng = np.random.default_rng(1)
    expected = network(of(box(*PLATE)), TOP).impedance(MOMENTS)
    for _ in range(2):
        turn = trimesh.transformations.random_rotation_matrix(rng.random(3))
        turn[:3, 3] = rng.uniform(-0.5, 0.5, 3)
        (x, y, z), (u, v, w) = (turn[:3] @ [0, 0, 0.005, 1]).tolist(), turn[:3, 2].tolist()
        patch = SurfacePatch((x, y, z), (u, v, w))
        turned = of(box(*PLATE).apply_transform(turn))
        assert network(turned, patch).impedance(MOMENTS) == pytest.approx(expected, rel=1e-6)


def half_space_rise(material, area: float, t: np.ndarray) -> np.ndarray:
    """Mean rise (n,) K at t (n,) s of a square that takes a watt, spread evenly, on a half-space (Carslaw & Jaeger,
    section 10.5: sources spread over squares, their means over the same square)."""
    rise = []
    for end in t:
        root = (
            (np.arange(4000) + 0.5) / 4000 * np.sqrt(end)
        )  # of the time since; the integrand is smooth in it
        width = np.sqrt(area) / np.sqrt(4 * material.diffusivity) / root
        stays = erf(width) + np.expm1(-(width**2)) / (width * np.sqrt(np.pi))
        rise.append(np.sqrt(end) * np.mean(stays**2) * 2 / np.sqrt(np.pi) / (material.effusivity * area))
    return np.array(rise)


@pytest.mark.parametrize(
    ("name", "degree", "early"),
    [
        ("glass", 0, 0.01),
        ("plastic", 6, 0.015),
        pytest.param("glass", 10, 0.015, marks=pytest.mark.slow),
        pytest.param("aluminium", 20, 0.015, marks=pytest.mark.slow),
    ],
)
def test_a_face_inclined_to_its_patch_warms_as_a_half_space_does(name, degree, early):
    """The pads close along an axis that the face is not across, as on a cone."""
    material, turn = thermal.material(name), np.deg2rad(degree)
    mesh = box(0.04, 0.04, 0.04).apply_transform(trimesh.transformations.rotation_matrix(turn, [0, 0, 1]))
    patch = SurfacePatch((0.02 / np.cos(turn), 0, 0), (1, 0, 0))
    t = np.array([0.05, 0.1, 0.3, 1.0]) * min(1.0, 1e-5 / material.diffusivity)  # before the block ends
    found = network(of(mesh, name), patch).step_response(t)[:, 0, 0]
    assert found == pytest.approx(half_space_rise(material, 81e-6 / np.cos(turn), t), rel=early)


@pytest.mark.slow
def test_a_face_that_is_slanted_to_the_grid_warms_as_a_half_space_does():
    """The next but one of a hexagon's: coarser, since it is not the last."""
    glass = thermal.material("glass")
    mesh = trimesh.creation.cylinder(0.02, 0.04, sections=6)
    across = 0.02 * np.cos(np.pi / 6)
    slanted, last = (
        SurfacePatch((across * np.cos(a), across * np.sin(a), 0), (np.cos(a), np.sin(a), 0))
        for a in np.deg2rad([90, 30])
    )
    t = np.array([0.05, 0.2, 0.5])
    found = network(of(mesh), slanted, last).step_response(t)
    exact = half_space_rise(glass, 81e-6, t)
    assert found[:, 1, 1] == pytest.approx(exact, rel=3e-3)
    assert np.all(np.abs(found[:, 0, 0] / exact - 1) < [0.06, 0.015, 0.006])


def test_heat_that_flows_in_is_the_object_s_rise():
    mesh = cup()
    net = network(of(mesh), SurfacePatch((0.02, 0, 0), (1, 0, 0), 25e-6))
    capacity = mesh.volume * thermal.material("glass").volumetric_heat_capacity
    assert net.rates[0] == 0
    assert np.all(net.rates[1:] > 0)
    assert net.ports.T @ net.outputs["heat"] == pytest.approx(1.0, rel=1e-9)  # J stored per J let in
    assert net.outputs["heat"] == pytest.approx(capacity * net.outputs["mean"], rel=1e-6)


def test_a_linear_field_along_a_sheet_thinner_than_its_cells_is_met_exactly():
    rng = np.random.default_rng(2)
    turn = trimesh.transformations.random_rotation_matrix(rng.random(3))
    sheet = of(box(0.06, 0.05, 0.001).apply_transform(turn))
    triangles = sheet.parts[0].triangles
    coarse = MeshGridding(oblique=3e-3, largest=3e-3)
    patch = place_patch(triangles, SurfacePatch((0, 0, 0), tuple(turn[:3, 2].tolist())), np.eye(3))
    assert not patch.aligned
    axes = grid_axes(triangles, [patch], [0.0], coarse)
    grid = mesh_grid(sheet, np.eye(3), axes)
    along = turn[:3, 0]
    field = grid.nodes @ along
    flow = conduct(grid, field[:, None])[:, 0]
    inside = np.all(np.abs(grid.nodes @ turn[:3, :2]) < [0.024, 0.019], axis=1)
    conductivity = thermal.material("glass").conductivity
    assert np.abs(flow[inside]).max() < 1e-6 * conductivity * 3e-3
    # the power that the field dissipates is that of the sheet: its thickness and area are right
    assert field @ flow == pytest.approx(conductivity * sheet.parts[0].volume, rel=2e-3)
    assert grid.capacity.sum() == pytest.approx(
        sheet.parts[0].volume * thermal.material("glass").volumetric_heat_capacity, rel=1e-9
    )


@pytest.mark.parametrize("thickness", [0.002, 0.0005])
def test_rubber_on_a_steel_core_is_the_layered_plate(thickness):
    rubber, steel = thermal.material("rubber"), thermal.material("stainless_steel")
    layers = rubber.layer(thickness), steel.layer(0.01 - thickness)
    geometry = plate()
    value = layered_impedance(layers, "adiabatic", geometry.object_section, geometry.patch, MOMENTS).value
    uniform = geometry.patch.uniform
    expected = np.einsum("c,scd,d->s", uniform, value, uniform) / 81e-6
    core = part(box(0.04, 0.04, 0.01 - thickness, at=(0, 0, -thickness / 2)), "stainless_steel")
    layer = part(box(0.04, 0.04, thickness, at=(0, 0, 0.005 - thickness / 2)), "rubber")
    nested = network(Solid((part(box(*PLATE), "rubber"), core)), TOP).impedance(MOMENTS)
    beside = network(Solid((layer, core)), TOP).impedance(MOMENTS)
    assert nested[:, 0, 0] == pytest.approx(expected, rel=2e-3)
    assert beside == pytest.approx(nested, rel=1e-9)


@pytest.mark.slow
def test_a_sleeve_on_a_round_core_is_the_same_nested_or_beside():
    core = trimesh.creation.cylinder(0.008, 0.06, sections=64)
    outer = trimesh.creation.cylinder(0.011, 0.06, sections=64)
    ring = trimesh.creation.annulus(0.008, 0.011, 0.06, sections=64)
    patch = SurfacePatch((0.011, 0, 0), (1, 0, 0), 36e-6)
    nested = network(Solid((part(outer, "rubber"), part(core, "stainless_steel"))), patch)
    beside = network(Solid((part(core, "stainless_steel"), part(ring, "rubber"))), patch)
    rubber = network(of(outer, "rubber"), patch)
    assert nested.outputs["heat"][0] == pytest.approx(beside.outputs["heat"][0], rel=1e-3)
    assert nested.impedance(MOMENTS) == pytest.approx(beside.impedance(MOMENTS), rel=1e-2)
    late = np.array([1e-3])
    assert nested.impedance(late) - rubber.impedance(late) < -0.05 * rubber.impedance(late)


@pytest.mark.slow
def test_thickness_and_cavities_matter():
    """A touch feels what is within about sqrt(diffusivity time): later it is warmer where there is less behind it."""
    side = SurfacePatch((0.02, 0, 0), (1, 0, 0), 36e-6)
    t = np.array([0.02, 20.0])
    for material in ("glass", "aluminium"):
        hollow = network(of(cup(), material), side).step_response(t)[:, 0, 0]
        full = network(of(trimesh.creation.cylinder(0.02, 0.05, sections=128), material), side)
        assert hollow[1] > 1.05 * full.step_response(t)[1, 0, 0]
        block = network(of(box(*PLATE), material), TOP).step_response(t)[:, 0, 0]
        sheet = SurfacePatch((0, 0, 0.0005), (0, 0, 1))
        sheet = network(of(box(0.04, 0.04, 0.001), material), sheet).step_response(t)[:, 0, 0]
        assert sheet[1] > 2 * block[1]
        if material == "glass":  # 0.1 mm in 0.02 s
            assert sheet[0] == pytest.approx(block[0], rel=1e-3)


def test_points_tell_the_object_s_own_field():
    points = [(0, 0, 0.005), (0.015, 0.015, -0.005), (0, 0, -0.005)]
    net = network(of(box(*PLATE)), TOP, points=points)
    rows = np.stack([net.outputs[f"point:{n}"] for n in range(3)])
    t = np.array([0.5, 5.0])
    product = np.outer(t, net.rates)
    grown = t[:, None] * np.where(product > 1e-12, -np.expm1(-product) / np.maximum(product, 1e-300), 1.0)
    near, far, behind = rows @ (grown * net.ports[:, 0]).T
    assert np.all(near > behind) and np.all(behind[1] > far[1]) and abs(far[0]) < 1e-3 * near[0]
    opposite = network(of(box(*PLATE)), TOP, BOTTOM).step_response(t)[:, 1, 0]
    assert behind == pytest.approx(opposite, rel=0.05, abs=0.01)  # mean over the patch and its middle
    assert rows @ np.linalg.pinv(net.outputs["mean"][None]) @ [1.0] == pytest.approx(1.0)  # 1 K everywhere


def test_where_the_surface_ends_the_patch_ends():
    rod = of(box(0.05, 0.005, 0.005), "aluminium")
    net = network(rod, SurfacePatch((0, 0, 0.0025), (0, 0, 1)))
    exact = network(rod, SurfacePatch((0, 0, 0.0025), (0, 0, 1), 25e-6))
    assert net.ports.T @ net.outputs["heat"] == pytest.approx(1.0)
    assert np.all(net.impedance(MOMENTS) < exact.impedance(MOMENTS))  # 9 x 5 mm of the rod, not 5 x 5


def test_networks_are_kept_by_content(tmp_path, monkeypatch):
    monkeypatch.setenv("THERMOGRASP_CACHE", str(tmp_path))
    first = body_network(of(box(*PLATE)), (TOP,))
    monkeypatch.setattr("thermograsp.thermal.meshes.network.mesh_grid", None)
    again = body_network(of(box(*PLATE)), (TOP,))
    assert np.array_equal(first.rates, again.rates) and np.array_equal(first.ports, again.ports)
    with pytest.raises(TypeError):  # another material has another network
        body_network(of(box(*PLATE), "cork"), (TOP,))


@pytest.mark.parametrize(
    ("body", "patch", "message"),
    [
        (lambda: of(box(*PLATE)), SurfacePatch((0.1, 0, 0), (0, 0, 1)), "does not meet the surface"),
        (
            lambda: of(trimesh.util.concatenate([box(*PLATE), box(*PLATE, at=(0, 0, 0.1))])),
            TOP,
            "2 separate pieces of 16, 16 cm3",
        ),
        (lambda: of(box(40, 40, 10)), SurfacePatch((0, 0, 5), (0, 0, 1)), "multiply them by 0.001"),
        (
            lambda: of(trimesh.util.concatenate([box(*PLATE), box(*PLATE, at=(0.01, 0, 0))])),
            TOP,
            "part 0 encloses 12 of its 32 cm3 twice",
        ),
    ],
)
def test_bodies_that_cannot_be_are_refused(body, patch, message):
    with pytest.raises(MeshError, match=message):
        network(body(), patch)


def test_parts_that_are_no_solids_are_refused():
    mesh, glass = box(*PLATE), thermal.material("glass")
    with pytest.raises(MeshError, match="3 of its edges"):
        solid(mesh.vertices, mesh.faces[1:], glass)
    with pytest.raises(MeshError, match="turn its faces outward"):
        solid(mesh.vertices, mesh.faces[:, ::-1], glass)
    with pytest.raises(MeshError, match="no faces"):
        solid(mesh.vertices, np.zeros((0, 3), int), glass)
    with pytest.raises(InvalidValueError, match="there are 8"):
        solid(mesh.vertices, mesh.faces + 1, glass)
    with pytest.raises(InvalidValueError, match="at least one patch"):
        body_network(of(mesh), ())


def test_a_grid_s_axes_follow_the_last_patch_and_the_sides():
    turn = trimesh.transformations.rotation_matrix(0.4, [0, 0, 1])
    body = of(box(*PLATE).apply_transform(turn))
    frame = grid_frame(body, [SurfacePatch((0, 0, 0), (1, 2, 3)), TOP])
    assert frame @ frame.T == pytest.approx(np.eye(3), abs=1e-12)
    assert frame[2] == pytest.approx([0, 0, 1])
    assert np.abs(frame @ turn[:3, :3]).max(axis=1) == pytest.approx(1.0)
