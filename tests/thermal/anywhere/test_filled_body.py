"""Contents that feed an object through the walls of its hollow."""

from __future__ import annotations

from functools import cache

import numpy as np
import pytest
import trimesh

from thermograsp import thermal
from thermograsp.thermal import (
    SurfacePatch,
    advance_heat,
    heat_tables,
)
from thermograsp.thermal.anywhere import placed_body
from thermograsp.thermal.anywhere.box import _across
from thermograsp.thermal.anywhere.placed import placed_network
from thermograsp.thermal.anywhere.ports import centred_tip, face_patterns
from thermograsp.thermal.meshes.film import Film, film_of, held_apart
from thermograsp.thermal.meshes.grid import MeshGridding
from thermograsp.thermal.meshes.network import patch_fields
from thermograsp.thermal.meshes.touched import TouchedBody, field_carried
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


@cache
def body(name: str, film: float, count: int = 1) -> TouchedBody:
    """film: W/(m2 K). Built once for all tests: not to be written to."""
    inside = film * 6 * (SIDE - 2 * WALL) ** 2
    return placed_body(hollow_box(name), patches(count), STACK, 12.0, fingertips=1, film=inside, cache=False)


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


def through_a_wall(film: float, s: float) -> float:
    """K/W of an even flow W into a square of 9 mm in the middle of a flat wall of hollow_box, of plastic, at s 1/s:
    waves along the wall fade into it, and through a film of W/(m2 K) at its other side."""
    of, waves = thermal.material("plastic"), np.arange(600)
    spread = np.sinc(waves * 0.009 / SIDE) * np.where(waves > 0, 2, 1) ** 0.5
    along = (2 * np.pi / SIDE) ** 2 * np.add.outer(waves**2, waves**2)
    inward = np.sqrt(along + s / of.diffusivity)
    flow, fall = of.conductivity * inward, np.tanh(inward * WALL)
    return (
        float(np.sum(np.outer(spread, spread) ** 2 * (flow + film * fall) / (flow * (flow * fall + film))))
        / SIDE**2
    )


@pytest.mark.parametrize("film", [500.0, pytest.param(1e4, marks=pytest.mark.slow)])
def test_a_thin_wall_between_finger_and_contents_is_a_wall_with_a_film(film):
    made = body("plastic", film)
    inside = film * 6 * (SIDE - 2 * WALL) ** 2
    system = made.filled(inside, 0.0).system((0,))
    states = made.object.order + 1
    port, rates = system.ports[:states, 0], system.rates[:states]
    slow = 1e-3  # 1/s: at rest, but for object and contents that warm together
    assert system.reservoir is not None
    together = float(np.sum((system.object_heat + system.reservoir) ** 2))
    impedance = float(np.sum(port**2 / (rates + slow))) - 1 / (slow * together)
    assert impedance == pytest.approx(through_a_wall(film, slow), rel=5e-3)
    assert impedance < made.object.impedance(slow)[0, 0] / 2


def test_heat_goes_from_finger_to_object_air_and_contents_to_round_off():
    made = body("plastic", 500.0)
    system = made.filled(500.0 * 6 * (SIDE - 2 * WALL) ** 2, 0.02).system((0,))
    tables, state = heat_tables([system], [5.0], 0.01), np.zeros((1, len(system.rates)))
    weight, difference = np.array([[0.5]]), np.array([[12.0]])
    state, heats = advance_heat(tables, np.zeros(1, int), state, weight, difference, np.ones(1, bool), 500)
    assert system.reservoir is not None
    contents = float(system.reservoir @ state[0])
    passed = 0.01 * (heats.flow.sum() - heats.air_loss.sum())
    assert contents > 0.05 and heats.object_heat[0, -1] + contents == pytest.approx(passed, rel=1e-9)


def test_a_body_as_warm_as_its_contents_stays_so():
    made = body("plastic", 500.0)
    filled = made.filled(500.0 * 6 * (SIDE - 2 * WALL) ** 2, 0.0)
    even = np.append(np.eye(made.object.order)[0] * made.object.outputs["heat"][0], np.sqrt(NODE))
    flow = filled.rates * (filled.turn.T @ even)
    assert np.abs(flow).max() < 1e-9 * np.abs(even).max() * filled.rates.max()
    assert made.object.outputs["wet"][0] == pytest.approx(made.object.outputs["mean"][0], rel=1e-9)


def test_contents_are_part_of_what_an_added_patch_carries_over():
    """The field on the node and its walls is the same on either side, in the body's own states."""
    one, two = (body("plastic", 500.0, count) for count in (1, 2))
    matrix = field_carried(one, two)
    state = np.zeros(one.object.order)
    for _ in range(300):
        state += 0.01 * (one.object.ports[:, 0] - one.object.rates * state) / (1 + 0.01 * one.object.rates)
    walls = [each.object.outputs["wet"] for each in (one, two)]
    heat = [each.object.outputs["heat"] for each in (one, two)]
    assert walls[1] @ (matrix @ state) == pytest.approx(walls[0] @ state, rel=0.02)
    assert heat[1] @ (matrix @ state) == pytest.approx(heat[0] @ state, rel=1e-12)


SHIFTS = np.geomspace(0.05, 5.0, 5)  # 1/s


def held_impedance(made: thermal.Solid, patch: SurfacePatch, film: float) -> np.ndarray:
    """(S,) K/W of the even flow, contents held: from modes and the wall's kernel. film: W/(m2 K)."""
    inside = film * film_area(made)
    network = placed_network(made, [patch], STACK, inside, cache=False).network
    rates, turn = held_apart(network, inside)
    return ((turn.T @ network.ports[:, 0]) ** 2 / (SHIFTS[:, None] + rates)).sum(axis=1)


def film_area(made: thermal.Solid) -> float:
    one = film_of(made, 1.0)
    assert one is not None
    return one.area


def on_grid(made: thermal.Solid, patch: SurfacePatch, film: float, gridding: MeshGridding):
    """Fields on a grid that is fine there."""
    one, patterns = film_of(made, 1.0), face_patterns(centred_tip(STACK, STACK.width**2))
    assert one is not None
    return patch_fields(made, [patch], patterns, gridding, Film(film * one.area, one.walls))


@pytest.mark.parametrize("film", [500.0, *(pytest.param(f, marks=pytest.mark.slow) for f in (50.0, 3000.0))])
def test_a_grid_s_fields_and_a_wall_s_kernel_agree_behind_a_film(film):
    """One has cells, the other a closed form of the wall; fields that had flowed without the film were 6 % off."""
    made, patch = hollow_box("plastic"), patches()[0]
    fields = on_grid(made, patch, film, MeshGridding(growth=0.2))
    expected = (fields.ports[:, 0] ** 2 / (SHIFTS[:, None] + fields.rates)).sum(axis=1)
    assert held_impedance(made, patch, film) == pytest.approx(expected, rel=5e-3)


def cup(wall: float, name: str = "ceramic") -> thermal.Solid:
    inner, foot = 0.025 - wall, wall - 0.03
    profile = [(0, -0.03), (0.025, -0.03), (0.025, 0.03), (inner, 0.03), (inner, foot), (0, foot)]
    mesh = trimesh.creation.revolve(profile, sections=128)
    return thermal.solid(mesh.vertices, mesh.faces, thermal.material(name))


def test_a_round_wall_lies_where_it_is_however_coarse_its_grid():
    """Where cells' nodes lie beyond the wall: with what is left of the film alone there it was 4 % off."""
    made, patch = cup(0.001, "plastic"), SurfacePatch((0.025, 0.0, 0.0), (1, 0, 0), STACK.width**2)
    found, expected = (
        (fields.ports[:, 0] ** 2 / (SHIFTS[:, None] + fields.rates)).sum(axis=1)
        for fields in (on_grid(made, patch, 1e4, MeshGridding(growth=growth)) for growth in (0.8, 0.3))
    )
    assert found == pytest.approx(expected, rel=3e-3)


@pytest.mark.slow
@pytest.mark.parametrize("film", [50.0, 500.0])
@pytest.mark.parametrize(("wall", "height"), [(0.001, 0.0), (0.003, 0.0), (0.003, 0.024), (0.005, 0.0)])
def test_a_filled_cup_is_felt_within_the_stated_share(wall, height, film):
    made, one = cup(wall), centred_tip(STACK, STACK.width**2)
    patch = SurfacePatch((0.025, 0.0, height), (1, 0, 0), one.area)
    fields = on_grid(made, patch, film, MeshGridding(growth=0.3, largest=1e-3, relief=24))
    inside = film * film_area(made)
    network = placed_network(made, [patch], STACK, inside, cache=False).network
    rates, turn = held_apart(network, inside)
    times = np.arange(0.05, 20.0, 0.05)

    def drops(rates: np.ndarray, ports: np.ndarray, conductance: float) -> np.ndarray:
        side = one.side
        row = np.concatenate((np.zeros(len(rates)), side.outputs["drop"]))
        joined = np.concatenate((ports, -side.ports))
        closed = np.diag(np.concatenate((rates, side.rates))) + conductance * one.area * joined @ joined.T
        fades, turn = np.linalg.eigh(closed)
        fades = np.maximum(fades, 1e-14)
        drive = conductance * one.area * turn.T @ joined[:, 0]
        return -np.expm1(-np.outer(times, fades)) / fades * drive @ (row @ turn)

    for conductance in (1e3, 1e4):
        found = drops(rates, turn.T @ network.ports, conductance)
        assert np.abs(found - drops(fields.rates, fields.ports, conductance)).max() < 3.2e-3


def test_a_round_wall_has_less_room_only_as_long_as_heat_goes_through_it():
    """At first heat under a patch has less material than behind a flat one; long after, it has spread over more than
    the patch, where a wall that is unrolled in its middle is a flat one."""
    early, late = (_across(np.array([tau]), 0.009)[0] for tau in (1e-9, 1e-2))
    assert early == pytest.approx(1.0, abs=5e-3)
    assert late == pytest.approx(0.0, abs=5e-3)
