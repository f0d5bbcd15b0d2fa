"""How much of a sensor's face lies on a body, and how thick that is there."""

import numpy as np
import pytest
import trimesh

from thermograsp.thermal import material, sensor
from thermograsp.thermal.anywhere import surface_patch, wall_below
from thermograsp.thermal.surfaces import Solid, solid

STACK, UP = sensor("seed"), np.array([0.0, 0.0, 1.0])


@pytest.mark.parametrize(
    ("side", "aside"), [(0.003, 0.0), (0.006, 0.0), (0.0073, 0.001), (0.008, 0.0), (0.02, 0.01)]
)
def test_of_a_bars_end_it_is_the_bar(side: float, aside: float) -> None:
    """A grid of 7 x 7 rays took bars of 6 and of 8 mm for as wide."""
    bar = trimesh.creation.box((side, 2 * side, 0.03))
    body = solid(np.array(bar.vertices), np.array(bar.faces), material("glass"))
    place = np.array([min(aside, side / 2 - 1e-6), 0.0, 0.015])
    share, thick = wall_below(body, surface_patch(body, place, UP, STACK, cache=False))
    covered = [
        min(side * n / 2, at + STACK.width / 2) - max(-side * n / 2, at - STACK.width / 2)
        for n, at in ((1, place[0]), (2, 0.0))
    ]
    assert share == pytest.approx(np.prod(covered) / STACK.width**2, rel=1e-6)
    assert thick == pytest.approx(0.03)


def hollow(outer: trimesh.Trimesh, inner: trimesh.Trimesh) -> Solid:
    """One in the other, of ceramic."""
    vertices = np.concatenate((outer.vertices, inner.vertices))
    faces = np.concatenate((outer.faces, np.fliplr(inner.faces) + len(outer.vertices)))
    return solid(vertices, faces, material("ceramic"))


def test_of_a_hollow_body_it_is_the_wall() -> None:
    outer, inner = trimesh.creation.box((0.04, 0.04, 0.04)), trimesh.creation.box((0.036, 0.036, 0.036))
    body = hollow(outer, inner)
    share, thick = wall_below(body, surface_patch(body, np.array([0.0, 0.0, 0.02]), UP, STACK, cache=False))
    assert (share, thick) == pytest.approx((1.0, 0.002))


def test_of_a_floor_below_the_wall_nothing_counts() -> None:
    """A cavity of 2 mm under a wall of 1 mm, whose floor looks the sensor's way, too."""
    outer, inner = trimesh.creation.box((0.006, 0.006, 0.03)), trimesh.creation.box((0.005, 0.005, 0.002))
    inner.apply_translation((0, 0, 0.013))
    body = hollow(outer, inner)
    share, _ = wall_below(body, surface_patch(body, np.array([0.0, 0.0, 0.015]), UP, STACK, cache=False))
    assert share == pytest.approx(4 / 9)
