"""Contents that feed an object through the walls of its hollow."""

from __future__ import annotations

import numpy as np
import pytest
import trimesh

from thermograsp import thermal
from thermograsp.thermal import (
    Demand,
    SurfacePatch,
    advance_heat,
    heat_tables,
)
from thermograsp.thermal.meshes import placed_body
from thermograsp.thermal.meshes.touched import TouchedBody, field_carried, touched_body
from thermograsp.thermal.network import NODE
from thermograsp.thermal.surfaces.hollow import wetted_faces

STACK = thermal.sensor("seed")
SIDE, WALL = 0.024, 0.001  # m


def hollow_box(name: str) -> thermal.Solid:
    inner = trimesh.creation.box((SIDE - 2 * WALL,) * 3)
    inner.invert()
    outer = trimesh.creation.box((SIDE,) * 3)
    vertices = np.concatenate((outer.vertices, inner.vertices))
    faces = np.concatenate((outer.faces, inner.faces + len(outer.vertices)))
    return thermal.solid(vertices, faces, thermal.material(name))


def patches(count: int = 1) -> list[SurfacePatch]:
    return [SurfacePatch((-SIDE / 2, y, 0), (-1, 0, 0)) for y in (0.0, 0.006)[:count]]


def body(name: str, film: float, count: int = 1, tolerance: float = 0.1, placed: bool = False) -> TouchedBody:
    """film: W/(m2 K). placed: by its modes, in place of a grid that is fine at the patches."""
    inside = film * 6 * (SIDE - 2 * WALL) ** 2
    if placed:
        made = hollow_box(name)
        return placed_body(made, patches(count), STACK, 12.0, fingertips=1, film=inside, cache=False)
    return touched_body(
        hollow_box(name),
        patches(count),
        STACK,
        Demand(tolerance, 12.0),
        fingertips=1,
        film=inside,
        cache=False,
    )


def area(triangles: np.ndarray) -> float:
    sides = triangles[:, 1] - triangles[:, 0], triangles[:, 2] - triangles[:, 0]
    return float(np.linalg.norm(np.cross(*sides), axis=1).sum() / 2)


def test_walls_of_hollows_are_found_and_nothing_else():
    cup = trimesh.creation.revolve(
        [[0, 0], [0.02, 0], [0.02, 0.04], [0.0175, 0.04], [0.0175, 0.003], [0, 0.003]], sections=64
    )
    glass = thermal.material("glass")
    inside = area(wetted_faces(thermal.solid(cup.vertices, cup.faces, glass)))
    assert inside == pytest.approx(np.pi * 0.0175 * (2 * 0.037 + 0.0175), rel=0.01)
    assert area(wetted_faces(hollow_box("glass"))) == pytest.approx(6 * (SIDE - 2 * WALL) ** 2)
    for mesh in (trimesh.creation.box((0.03,) * 3), trimesh.creation.icosphere(radius=0.02)):
        assert not len(wetted_faces(thermal.solid(mesh.vertices, mesh.faces, glass)))


@pytest.mark.parametrize("placed", [False, True])
@pytest.mark.parametrize(("name", "film"), [("plastic", 500.0)])
def test_a_thin_wall_between_finger_and_contents_is_a_resistance_with_the_area_of_a_fin(name, film, placed):
    """At rest the patch is fed across wall and film, over an area that is wider by a fin's length sqrt(k d/h) each way
    (Incropera et al., section 3.6), which is short here. Ever finer grids tend to 6 % above that: a wall that insulates
    so well is no fin."""
    made = body(name, film, tolerance=0.01, placed=placed)
    inside = film * 6 * (SIDE - 2 * WALL) ** 2
    system = made.filled(inside, 0.0).system((0,))
    states = made.object.order + 1
    port, rates = system.ports[:states, 0], system.rates[:states]
    slow = 1e-3  # 1/s: at rest, but for object and contents that warm together
    assert system.reservoir is not None
    together = float(np.sum((system.object_heat + system.reservoir) ** 2))
    impedance = float(np.sum(port**2 / (rates + slow))) - 1 / (slow * together)
    k = thermal.material(name).conductivity
    reach = np.sqrt(k * WALL / film)
    expected = (WALL / k + 1 / film) / (0.009 + 2 * reach) ** 2
    assert impedance == pytest.approx(expected, rel=0.09 if placed else 0.06)
    assert impedance < made.object.impedance(slow)[0, 0] / 2


@pytest.mark.parametrize("placed", [False, True])
def test_heat_goes_from_finger_to_object_air_and_contents_to_round_off(placed):
    made = body("plastic", 500.0, placed=placed)
    system = made.filled(500.0 * 6 * (SIDE - 2 * WALL) ** 2, 0.02).system((0,))
    tables, state = heat_tables([system], [5.0], 0.01), np.zeros((1, len(system.rates)))
    weight, difference = np.array([[0.5]]), np.array([[12.0]])
    state, heats = advance_heat(tables, np.zeros(1, int), state, weight, difference, np.ones(1, bool), 500)
    assert system.reservoir is not None
    contents = float(system.reservoir @ state[0])
    passed = 0.01 * (heats.flow.sum() - heats.air_loss.sum())
    assert contents > 0.05 and heats.object_heat[0, -1] + contents == pytest.approx(passed, rel=1e-9)


@pytest.mark.parametrize("placed", [False, True])
def test_a_body_as_warm_as_its_contents_stays_so(placed):
    made = body("plastic", 500.0, placed=placed)
    filled = made.filled(500.0 * 6 * (SIDE - 2 * WALL) ** 2, 0.0)
    even = np.append(np.eye(made.object.order)[0] * made.object.outputs["heat"][0], np.sqrt(NODE))
    flow = filled.rates * (filled.turn.T @ even)
    assert np.abs(flow).max() < 1e-9 * np.abs(even).max() * filled.rates.max()
    assert made.object.outputs["wet"][0] == pytest.approx(made.object.outputs["mean"][0], rel=1e-9)


@pytest.mark.parametrize("placed", [False, True])
def test_contents_are_part_of_what_an_added_patch_carries_over(placed):
    """The field on the node and its walls is the same on either side, in the body's own states."""
    one, two = (body("plastic", 500.0, count, placed=placed) for count in (1, 2))
    matrix = field_carried(one, two)
    state = np.zeros(one.object.order)
    for _ in range(300):
        state += 0.01 * (one.object.ports[:, 0] - one.object.rates * state) / (1 + 0.01 * one.object.rates)
    walls = [each.object.outputs["wet"] for each in (one, two)]
    heat = [each.object.outputs["heat"] for each in (one, two)]
    assert walls[1] @ (matrix @ state) == pytest.approx(walls[0] @ state, rel=0.02)
    assert heat[1] @ (matrix @ state) == pytest.approx(heat[0] @ state, rel=1e-12)
