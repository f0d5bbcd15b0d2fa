"""Meshes of bodies that give way under a bare face, beside the balls and rods that they are."""

from __future__ import annotations

import numpy as np
import pytest
import trimesh

from thermograsp.thermal import Pad, material
from thermograsp.thermal.contact import curved_contact, curved_table
from thermograsp.thermal.pressed import PressedMesh, pressed_view

PAD = Pad()
AXES = np.array([[-1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]])
RADIUS, LENGTH = 0.02, 0.08
BALL = trimesh.creation.icosphere(4, RADIUS)
FORCES = 0.2, 2.0, 20.0
HALF_FELT = 0.4  # W/K, by which about half of the temperature difference is felt
GIVING = "tomato", "banana", "apple", "rubber", "polyethylene"
QUICK = (None, "tomato"), (None, "banana"), (192, "tomato"), (192, "banana")


def table(solid: trimesh.Trimesh, name: str) -> tuple[np.ndarray, np.ndarray]:
    """A bare fingertip's table of a mesh of that material, and the mesh's middle, m, in its places."""
    vertices, faces = np.ascontiguousarray(solid.vertices, float), np.asarray(solid.faces, np.int64)
    one = PressedMesh(PAD, None, material(name), vertices.tobytes(), faces.tobytes(), AXES.tobytes())
    return one.table(), pressed_view(PAD, one.vertices, one.faces, one.axes).spans / 2


def rod(sections: int) -> trimesh.Trimesh:
    """It lies on one of its flat sides, of so many: a pad of the direction of AXES meets that first."""
    turned = trimesh.transformations.rotation_matrix(np.pi / sections, [0.0, 0.0, 1.0])
    return trimesh.creation.cylinder(RADIUS, LENGTH, sections=sections, transform=turned)


def felt(conducts: float) -> float:
    """The share of the temperature difference."""
    return conducts / (conducts + HALF_FELT)


@pytest.mark.parametrize(
    ("sections", "name"),
    [
        pytest.param(sections, name, marks=() if (sections, name) in QUICK else pytest.mark.slow)
        for sections in (None, 192)
        for name in GIVING
    ],
)
def test_a_mesh_gives_way_as_the_round_body_does(sections: int | None, name: str) -> None:
    """In the middle of the face and 3 mm beside it, from .2 to 20 N, between which a tomato's contact comes to cover
    all of the face."""
    mesh, middle = table(BALL if sections is None else rod(sections), name)
    itself = curved_table(PAD, None, material(name), RADIUS, None if sections is None else LENGTH)
    for aside in (0.0, 0.003):
        for force in FORCES:
            known, patch, _ = curved_contact(itself, force, aside, 0.0)
            found, area, _ = curved_contact(mesh, force, middle[0] + aside, middle[1])
            assert felt(found) == pytest.approx(felt(known), rel=0.08 if force < 1 else 0.04), (aside, force)
            assert area == pytest.approx(patch, rel=0.15 if force > 1 else 0.3)


@pytest.mark.parametrize("sections", [24, 48])
def test_a_soft_rod_of_flat_sides_is_felt_as_a_round_one(sections: int) -> None:
    """Sides that are narrower than what a tomato's flesh touches are not felt."""
    mesh, middle = table(rod(sections), "tomato")
    itself = curved_table(PAD, None, material("tomato"), RADIUS, LENGTH)
    for force in FORCES:
        known, found = (
            curved_contact(of, force, *at)[0] for of, at in ((itself, (0.0, 0.0)), (mesh, middle))
        )
        assert felt(found) == pytest.approx(felt(known), rel=0.02)


def test_a_soft_edge_yields_until_it_covers_the_face() -> None:
    """Of a body that no paraboloid is: a prism of six sides on one of its edges."""
    prism = trimesh.creation.cylinder(RADIUS, LENGTH, sections=6)
    mesh, middle = table(prism, "tomato")
    areas = [curved_contact(mesh, force, *middle)[1] for force in (0.02, 0.2, 2.0, 20.0)]
    assert (np.diff(areas) > 0).all()
    assert areas[-1] > 3 * areas[0]


def test_a_flat_soft_face_has_nowhere_to_give_way_to() -> None:
    """A block of it covers the face at every force."""
    mesh, middle = table(trimesh.creation.box((0.04, 0.04, 0.04)), "rubber")
    for force in FORCES:
        assert curved_contact(mesh, force, *middle)[1] == pytest.approx(PAD.face**2, rel=1e-3)


@pytest.mark.parametrize("sections", [None, 192])
def test_aluminium_does_not_give_way(sections: int | None) -> None:
    """Its contact is no larger than roughness and springs have it, as before soft bodies gave way: W/K."""
    mesh, middle = table(BALL if sections is None else rod(sections), "aluminium")
    known = (0.0207, 0.0251, 0.0347) if sections is None else (0.0970, 0.1670, 0.8198)
    for force, conducts in zip(FORCES, known, strict=True):
        assert curved_contact(mesh, force, *middle)[0] == pytest.approx(conducts, rel=0.005)
