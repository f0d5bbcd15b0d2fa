"""Networks of bodies of any shape in pads: of a block they are those of the box, which come from other kernels, and of
any body no ring's heat is lost."""

from __future__ import annotations

import numpy as np
import pytest
import trimesh

from thermograsp.thermal import Material, SurfacePatch, Surround, material, sensor, solid
from thermograsp.thermal.anywhere import PLACED_LEVEL, body_in_pads, surface_patch
from thermograsp.thermal.anywhere.place import is_touchable
from thermograsp.thermal.kernels import GRASP, Patches
from thermograsp.thermal.matter import SKINS
from thermograsp.thermal.padded import box_in_pads, padded_tip, ring_sides

STACK = SKINS["filled_silicone"].over(sensor("seed"))
SURROUND = Surround().around(sensor("seed"))
SIDES = ring_sides(STACK.width, SURROUND)


def impedance(rates: np.ndarray, ports: np.ndarray) -> np.ndarray:
    """(S, N, N) K/W at GRASP."""
    return np.einsum("ni,sn,nj->sij", ports, 1 / (GRASP[:, None] + rates), ports)


def block(size: tuple[float, float, float], made: Material):
    mesh = trimesh.creation.box(size)
    return solid(np.asarray(mesh.vertices), np.asarray(mesh.faces), made)


@pytest.mark.parametrize("thickness", [0.01, pytest.param(0.003, marks=pytest.mark.slow)])
@pytest.mark.parametrize("name", ["aluminium", pytest.param("glass", marks=pytest.mark.slow)])
def test_a_block_is_the_box(name: str, thickness: float) -> None:
    made, size = material(name), (thickness, 0.04, 0.04)
    patches = [SurfacePatch((way * thickness / 2, 0.0, 0.0), (way, 0.0, 0.0), 81e-6) for way in (-1.0, 1.0)]
    network, beside, _ = body_in_pads(block(size, made), patches, STACK, SIDES)
    tip = padded_tip(STACK, SURROUND, PLACED_LEVEL, 12).tip
    faces = Patches(np.array([0, 1]), np.full((2, 2), 0.02), np.full((2, 2), 0.0045))
    box, around = box_in_pads(made, size, faces, (tip, tip), (SIDES, SIDES), PLACED_LEVEL)
    found = impedance(network.rates, np.concatenate((network.ports, beside), axis=1))
    expected = impedance(box.rates, np.concatenate((box.ports, around), axis=1))
    even = [0, 3, *range(6, 12)]
    found, expected = (each[:, even][:, :, even] for each in (found, expected))
    most = np.sqrt(np.einsum("sii,sjj->sij", expected, expected))
    assert np.abs((found - expected) / most).max() < 1e-2


@pytest.mark.parametrize("sides", [SIDES, ()])
def test_a_place_of_which_the_even_flow_is_told_is_as_any_other(sides: tuple[float, ...]) -> None:
    """Beside one that is told wholly: the even flows into faces, and those into its rings."""
    made, size = material("glass"), (0.01, 0.04, 0.04)
    body = block(size, made)
    patches = [SurfacePatch((way * 0.005, 0.0, 0.004), (way, 0.0, 0.0), 81e-6) for way in (-1.0, 1.0)]
    rings, found = len(sides), []
    for whole in (None, [True, False]):
        network, beside, _ = body_in_pads(body, patches, STACK, sides, whole=whole)
        assert beside.shape == (len(network.rates), 2 * rings)
        ports = np.concatenate((network.ports[:, [0, 1, 2, 3]], beside[:, :rings]), axis=1)
        found.append(impedance(network.rates, ports))
        if whole:
            assert not beside[:, rings:].any() and not network.ports[1:, 4:][network.rates[1:] > 10].any()
    most = np.sqrt(np.einsum("sii,sjj->sij", found[0], found[0]))
    assert np.abs((found[1] - found[0]) / most).max() < 2e-3
    network, beside, _ = body_in_pads(body, patches, STACK, sides, whole=[False, False])
    assert np.isfinite(network.ports).all() and not beside.any()


@pytest.mark.parametrize(
    "shape", ["box", *(pytest.param(each, marks=pytest.mark.slow) for each in ("ball", "rod"))]
)
def test_all_heat_of_a_ring_is_in_the_body(shape: str) -> None:
    """Also of rings that reach beyond what there is of it."""
    made, radius = material("glass"), 0.008
    mesh = {
        "ball": trimesh.creation.icosphere(3, radius=radius),
        "rod": trimesh.creation.cylinder(radius, 0.05, sections=32),
        "box": trimesh.creation.box((2 * radius, 0.012, 0.03)),
    }[shape]
    body = solid(np.asarray(mesh.vertices), np.asarray(mesh.faces), made)
    patch = surface_patch(body, np.array([-0.02, 0.0, 0.0]), np.array([-1.0, 0.0, 0.0]), STACK)
    network, beside, _ = body_in_pads(body, [patch], STACK, SIDES)
    np.testing.assert_allclose(network.outputs["heat"][0] * beside[0], 1.0, rtol=1e-9)
    assert network.outputs["heat"][0] * network.ports[0, 0] == pytest.approx(1.0, rel=1e-9)
    assert (network.rates >= 0).all() and np.isfinite(beside).all()


@pytest.mark.parametrize(
    ("turn", "place", "axis"),
    [
        ((0.637, 0.2698, 0.041), (0.01222, -0.02274, 0.02469), 1),
        *(
            pytest.param((0.2616, 0.2985, 0.8142), place, 0, marks=pytest.mark.slow)
            for place in ((-0.02342, -0.002057, -0.01958), (-0.01717, -0.003071, -0.03087))
        ),
    ],
)
def test_a_place_is_found_where_a_rim_or_an_opening_is_touched_at_a_slant(
    turn: tuple[float, float, float], place: tuple[float, float, float], axis: int
) -> None:
    """On the hull of a thin cup. What looks along the axis there is below the rest of the cup."""
    wall = 0.3e-3
    profile = [(0, 0), (0.02, 0), (0.02, 0.03), (0.02 - wall, 0.03), (0.02 - wall, wall), (0, wall)]
    cup = trimesh.creation.revolve(profile, sections=24)
    cup.apply_transform(trimesh.transformations.random_rotation_matrix(np.array(turn)))
    body = solid(np.asarray(cup.vertices), np.asarray(cup.faces), material("ceramic"))
    outward = -np.eye(3)[axis]
    assert is_touchable(body, surface_patch(body, np.array(place), outward, STACK), STACK)
