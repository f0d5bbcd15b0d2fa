"""Heat beneath a face on unrolled cells beside closed forms, other solvers and finer cells."""

from __future__ import annotations

import numpy as np
import pytest
import trimesh
from scipy.linalg import expm

from thermograsp import thermal
from thermograsp.thermal.kernels import Patches, Resolution, basis_jumps, basis_terms, box_kernel, tip
from thermograsp.thermal.matter import Material
from thermograsp.thermal.surfaces import Solid, SolidPart
from thermograsp.thermal.unrolled import (
    Face,
    Fineness,
    Place,
    filmed,
    local_cells,
    overlapped,
    sensed_patch,
    spread_beneath,
)
from thermograsp.thermal.unrolled.fading import fading

STACK = thermal.sensor("seed")
WIDTH = STACK.width
TIP = tip(STACK, ((0.0, WIDTH), (0.0, WIDTH)), Resolution(12, 3))
COARSE = Fineness(9e-3, 9e-3)
FINE = Fineness(12e-3, 12e-3, 0.12e-3, 0.25e-3, 0.15e-3, 0.25, 1.5e-3)
GLASS = thermal.material("glass")
TAUS = np.geomspace(1e-8, 1e-5, 8)  # m2


def solid(*meshes: tuple[trimesh.Trimesh, Material]) -> Solid:
    return Solid(tuple(SolidPart(np.array(mesh.vertices), np.array(mesh.faces), of) for mesh, of in meshes))


def kernel(
    body: Solid, wet: list[np.ndarray], film: float, place: Place, times: np.ndarray, fine: Fineness
) -> np.ndarray:
    """(T, M, M)"""
    cells = local_cells(body, wet, film, place, TIP, fine)
    assert cells is not None
    return cells.kernel(times).kernel


def dry(body: Solid) -> list[np.ndarray]:
    return [np.zeros(len(part.faces), bool) for part in body.parts]


def on_top(height: float, ends: list[list[float]], depth: float, x: float = 0.0) -> Place:
    return Place(Face(np.array([x, 0.0, height]), np.eye(3), np.zeros(2)), WIDTH / 2, np.array(ends), depth)


def test_chebyshev_moments_are_the_exponential_s() -> None:
    rng = np.random.default_rng(3)
    count = 40
    neighbours = np.tile(np.arange(count)[:, None], 6)
    links = np.zeros((count, 6))
    low = np.arange(count - 1)
    neighbours[low, 1], neighbours[low + 1, 0] = low + 1, low
    links[low, 1] = links[low + 1, 0] = rng.uniform(0.5, 2.0, count - 1)
    capacity, sink = rng.uniform(0.5, 2.0, count), rng.uniform(0.0, 0.1, count)
    ports = rng.normal(size=(count, 3))
    matrix = np.diag(links.sum(axis=1) + sink)
    matrix[low, low + 1] = matrix[low + 1, low] = -links[low, 1]
    known = fading(capacity, neighbours, links, sink, ports, 50.0)
    times = np.array([0.0, 0.3, 4.0, 50.0])
    for time, found in zip(times, known.kernel(times), strict=True):
        expected = ports.T @ expm(-time * matrix / capacity[:, None]) @ (ports / capacity[:, None])
        assert found == pytest.approx(
            expected, abs=1e-5 * np.abs(ports.T @ (ports / capacity[:, None])).max()
        )


@pytest.mark.parametrize("x", [0.0, 0.011, 0.016])
def test_on_a_block_it_is_the_block_s(x: float) -> None:
    """In the middle of a face, over its edge, and with its middle beyond the edge."""
    body = solid((trimesh.creation.box((0.03, 0.04, 0.005)), GLASS))
    place = on_top(0.0025, [[0.05, 0.015 - x], [0.05, 0.05]], 0.005, x)
    found = (
        kernel(body, dry(body), 0.0, place, TAUS / GLASS.diffusivity, COARSE) * GLASS.volumetric_heat_capacity
    )
    low, high = x + 0.015 - WIDTH / 2, min(x + 0.015 + WIDTH / 2, 0.03)
    patches = Patches(
        np.array([5]), np.array([[(low + high) / 2, 0.02]]), np.array([[(high - low) / 2, WIDTH / 2]])
    )
    jumps = basis_jumps(TIP.basis)[None]
    expected, _, port, _, _ = box_kernel(
        (0.03, 0.04, 0.005), 1.0, 1.0, 0.0, patches, jumps, basis_terms(3), 1, TAUS
    )
    expected += np.outer(port, port)
    assert found[:, 0, 0] == pytest.approx(expected[:, 0, 0], rel=2e-3)
    if x == 0:  # other patterns are cut off at an edge
        assert found / expected[:, :1, :1] == pytest.approx(expected / expected[:, :1, :1], abs=2e-3)


OPPOSITE, BESIDE, OVER_THE_EDGE = (
    (np.array([0.002, 0.0, -0.0025]), np.diag([1.0, -1.0, -1.0])),
    (np.array([0.0, 0.0105, 0.0025]), np.eye(3)),
    (np.array([0.015, 0.0, 0.0]), np.array([[0.0, 1.0, 0.0], [0.0, 0.0, 1.0], [1.0, 0.0, 0.0]])),
)


@pytest.mark.parametrize(
    ("place", "face", "middle", "half"),
    [
        pytest.param(OPPOSITE, 4, (0.017, 0.02), (WIDTH / 2, WIDTH / 2), id="opposite"),
        pytest.param(BESIDE, 5, (0.015, 0.0305), (WIDTH / 2, WIDTH / 2), id="beside"),
        pytest.param(OVER_THE_EDGE, 1, (0.02, 0.0025), (WIDTH / 2, 0.0025), id="over an edge"),
    ],
)
def test_on_a_block_another_patch_feels_what_it_does_on_the_block(
    place: tuple[np.ndarray, np.ndarray], face: int, middle: tuple[float, float], half: tuple[float, float]
) -> None:
    """As shares of what the patch itself feels."""
    taus = np.geomspace(1e-6, 1.2e-5, 7)
    body = solid((trimesh.creation.box((0.03, 0.04, 0.005)), GLASS))
    x = 0.006 if face == 1 else 0.0
    here = on_top(0.0025, [[0.05, 0.015 - x], [0.05, 0.05]], 0.005, x)
    patches = Patches(
        np.array([5, face]),
        np.array([(0.015 + x, 0.02), middle]),
        np.array([(WIDTH / 2, WIDTH / 2), half]),
    )
    jumps = np.array([basis_jumps(TIP.basis)] * 2)
    expected, _, port, _, _ = box_kernel(
        (0.03, 0.04, 0.005), 1.0, 1.0, 0.0, patches, jumps, basis_terms(3), 2, taus
    )
    expected = (expected + np.outer(port, port))[:, [0, 0], [0, 3]]
    felt = sensed_patch(body.outside, Face(*place, np.zeros(2)), WIDTH / 2, TIP)
    assert felt is not None
    for fine, error in ((COARSE, 0.01), (FINE, 0.005)):
        cells = local_cells(body, dry(body), 0.0, here, TIP, fine)
        assert cells is not None
        spread = spread_beneath(cells, taus / GLASS.diffusivity)
        between = spread.sensed_by(felt)
        assert between is not None
        found = between.kernel[:, 0, 0] * GLASS.volumetric_heat_capacity
        assert np.abs((found - expected[:, 1]) / expected[:, 0]).max() < error


@pytest.mark.parametrize("x", [0.0, 0.006, 0.0125])
@pytest.mark.parametrize(
    ("on", "error"), [((0.0017, 0.0), 1e-3), ((0.003, -0.002), 1e-3), ((-0.001, 0.0085), 0.01)]
)
@pytest.mark.parametrize("turned", [False, True])
def test_on_a_block_a_patch_that_overlaps_feels_what_it_does_on_the_block(
    x: float, on: tuple[float, float], error: float, turned: bool
) -> None:
    """In the middle of a face and over its edge; its sides named in either order. As shares of what the patch itself
    feels. What lies farthest is near the end of the cells."""
    taus = np.geomspace(1e-7, 1.2e-5, 7)
    body = solid((trimesh.creation.box((0.03, 0.04, 0.005)), GLASS))
    here = on_top(0.0025, [[0.05, 0.015 - x], [0.05, 0.05]], 0.005, x)
    ends = np.array([[x, x + on[0]]] * 2) + 0.015 + np.array([[-1], [1]]) * WIDTH / 2
    low, high = np.minimum(ends, 0.03)
    middles = np.stack(((low + high) / 2, [0.02, 0.02 + on[1]]), axis=1)
    patches = Patches(np.array([5, 5]), middles, np.stack(((high - low) / 2, [WIDTH / 2, WIDTH / 2]), axis=1))
    jumps = np.array([basis_jumps(TIP.basis)] * 2)
    expected, _, port, _, _ = box_kernel(
        (0.03, 0.04, 0.005), 1.0, 1.0, 0.0, patches, jumps, basis_terms(3), 2, taus
    )
    own, expected = np.split((expected + np.outer(port, port))[:, :, :3], 2, axis=1)
    cells = local_cells(body, dry(body), 0.0, here, TIP, COARSE)
    assert cells is not None
    axes = np.array([[0.0, 1.0, 0.0], [-1.0, 0.0, 0.0], [0.0, 0.0, 1.0]]) if turned else np.eye(3)
    other = Face(here.face.centre + [*on, 0.0], axes, np.zeros(2))
    between = overlapped(spread_beneath(cells, taus / GLASS.diffusivity), other, TIP)
    assert between is not None
    found = between.kernel * GLASS.volumetric_heat_capacity
    assert found[:, 0, 0] / own[:, 0, 0] == pytest.approx(expected[:, 0, 0] / own[:, 0, 0], abs=error)
    if not turned and high.max() < 0.03:  # other patterns are cut off at an edge
        assert found / own[:, :1, :1] == pytest.approx(expected / own[:, :1, :1], abs=error)


def test_a_patch_on_another_face_or_turned_aside_does_not_overlap() -> None:
    body = solid((trimesh.creation.box((0.03, 0.04, 0.005)), GLASS))
    cells = local_cells(body, dry(body), 0.0, on_top(0.0025, [[0.05] * 2] * 2, 0.005), TIP, COARSE)
    assert cells is not None
    spread = spread_beneath(cells, TAUS / GLASS.diffusivity)
    assert overlapped(spread, Face(np.array([0.0, 0.0205, 0.0025]), np.eye(3), np.zeros(2)), TIP) is None
    aside = np.array([[1.0, 1.0, 0.0], [-1.0, 1.0, 0.0], [0.0, 0.0, 2**0.5]]) / 2**0.5
    for centre, axes in (((0.002, 0.0, 0.0025), aside), OPPOSITE, ((0.002, 0.0, 0.0045), np.eye(3))):
        assert overlapped(spread, Face(np.array(centre), axes, np.zeros(2)), TIP) is None


def test_the_wall_of_a_hollow_is_met_from_within() -> None:
    """Not what lies across the hollow; and a floor that rises beside the wall is there."""
    profile = [(0, -0.04), (0.03, -0.04), (0.03, 0.04), (0.027, 0.04), (0.027, -0.037), (0, -0.037)]
    body = solid((trimesh.creation.revolve(profile, sections=128), GLASS))
    axes = np.array([[0.0, 0.0, 1.0], [0.0, 1.0, 0.0], [-1.0, 0.0, 0.0]])
    found = []
    for height in (0.0, -0.032):
        face = Face(np.array([0.027, 0.0, height]), axes, np.array([0.0, -1 / 0.027]))
        place = Place(face, WIDTH / 2, np.array([[height + 0.037, 0.04 - height], [0.05, 0.05]]), 0.003)
        cells = local_cells(body, dry(body), 0.0, place, TIP, COARSE)
        assert cells is not None
        found.append(cells.cells.capacity.sum() / GLASS.volumetric_heat_capacity)
        assert cells.cells.cover.max() == 1.0
    sector = (0.03**2 - 0.027**2) / 2  # of one radian, over 27 mm of the circumference
    floor = 0.003 * (0.027**2 - 0.018**2) / 2  # as far in as a face is wide
    assert found == pytest.approx([0.027 * sector, 0.0215 * sector + floor], rel=0.02)


def test_layers_conduct_as_in_one_dimension() -> None:
    """A patch that covers a block of glass on steel: through it alone heat flows."""
    steel = thermal.material("stainless_steel")
    upper, lower = (trimesh.creation.box((WIDTH, WIDTH, h)) for h in (0.002, 0.004))
    lower.apply_translation((0, 0, -0.003))
    body = solid((upper, GLASS), (lower, steel))
    place = on_top(0.001, [[WIDTH / 2] * 2] * 2, 0.002)
    times = np.geomspace(0.05, 40.0, 9)
    found = kernel(body, dry(body), 0.0, place, times, COARSE)[:, 0, 0]
    count = 1200
    at = np.arange(count) < count // 3
    size = 0.006 / count
    capacity = np.where(at, GLASS.volumetric_heat_capacity, steel.volumetric_heat_capacity) * size * WIDTH**2
    half = size / 2 / (np.where(at, GLASS.conductivity, steel.conductivity) * WIDTH**2)
    link = 1 / (half[1:] + half[:-1])
    matrix = np.diag(np.append(link, 0) + np.append(0, link)) - np.diag(link, 1) - np.diag(link, -1)
    root = 1 / np.sqrt(capacity)
    rates, turn = np.linalg.eigh(root[:, None] * matrix * root)
    expected = np.exp(-np.outer(times, np.maximum(rates, 0.0))) @ (root[0] * turn[0]) ** 2
    assert found == pytest.approx(expected, rel=0.02)


def test_contents_take_heat_through_a_wall() -> None:
    """A patch that covers a plate with a film at its other side."""
    film, thick = 2000.0, 0.003
    mesh = trimesh.creation.box((WIDTH, WIDTH, thick))
    body = solid((mesh, GLASS))
    wet = [mesh.face_normals[:, 2] < -0.5]
    place = on_top(thick / 2, [[WIDTH / 2] * 2] * 2, thick)
    times = np.geomspace(0.1, 20.0, 8)
    found = kernel(body, wet, film, place, times, COARSE)[:, 0, 0]
    taus = GLASS.diffusivity * times
    free = np.ones(len(times))
    for n in range(1, 400):
        free += 2 * np.exp(-((n * np.pi / thick) ** 2) * taus)
    free /= thick * WIDTH**2 * GLASS.volumetric_heat_capacity
    expected = free * filmed(taus, thick, film / GLASS.conductivity)
    assert found == pytest.approx(expected, rel=0.015)


@pytest.mark.parametrize("height", [0.0353, 0.0365, 0.04, -0.0352, -0.038])
def test_few_cells_serve_at_a_rim_and_at_a_foot(height: float) -> None:
    profile = [(0, -0.04), (0.03, -0.04), (0.03, 0.04), (0.027, 0.04), (0.027, -0.037), (0, -0.037)]
    body = solid((trimesh.creation.revolve(profile, sections=128), GLASS))
    axes = np.array([[0.0, 0.0, 1.0], [0.0, -1.0, 0.0], [1.0, 0.0, 0.0]])
    face = Face(np.array([0.03, 0.0, height]), axes, np.array([0.0, 1 / 0.03]))
    place = Place(face, WIDTH / 2, np.array([[height + 0.04, 0.04 - height], [0.05, 0.05]]), 0.003)
    times = TAUS / GLASS.diffusivity
    few, many = (kernel(body, dry(body), 0.0, place, times, each) for each in (COARSE, FINE))
    assert few[:, 0, 0] == pytest.approx(many[:, 0, 0], rel=0.01)


def test_a_surface_that_leaves_the_face_is_refused() -> None:
    body = solid((trimesh.creation.cylinder(0.006, 0.05, sections=64), GLASS))
    axes = np.array([[0.0, 0.0, 1.0], [0.0, -1.0, 0.0], [1.0, 0.0, 0.0]])
    place = Place(
        Face(np.array([0.006, 0.0, 0.0]), axes, np.zeros(2)), WIDTH / 2, np.full((2, 2), 0.05), 0.012
    )
    assert local_cells(body, dry(body), 0.0, place, TIP, COARSE) is None
