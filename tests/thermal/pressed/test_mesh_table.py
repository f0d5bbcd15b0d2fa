"""Tables of meshes between their places, beside the springs themselves there."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
import trimesh

from thermograsp.envs.bodies import library_object
from thermograsp.thermal import SKINS, Pad, material, materials
from thermograsp.thermal.contact import (
    FIRST_FORCE,
    FORCE_STEP,
    FORCES,
    Surface,
    conductance,
    conduction,
    contact,
    curved_contact,
    curved_touch,
    face_joint,
    flat_footprint,
    flat_law,
    skinned,
)
from thermograsp.thermal.pressed import PressedMesh, corner_normals, height_map, pressed_view

PAD, SKIN, METAL = Pad(), SKINS["filled_silicone"], material("aluminium")
AXES = np.array([[-1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]])
SOLIDS = {
    "rod": trimesh.creation.cylinder(0.01, 0.06, sections=96),
    "ball": trimesh.creation.icosphere(4, 0.02),
    "small ball": trimesh.creation.icosphere(4, 0.006),
    "box": trimesh.creation.box((0.04, 0.04, 0.04)),
}
HALF_FELT = 0.4  # W/K, by which about half of the temperature difference is felt


QUICK = ("rod", "filled_silicone"), ("ball", None), ("small ball", "filled_silicone"), ("box", None)


@pytest.mark.parametrize(
    ("shape", "skin"),
    [
        pytest.param(shape, skin, marks=() if (shape, skin) in QUICK else pytest.mark.slow)
        for shape in SOLIDS
        for skin in (None, "filled_silicone")
    ],
)
def test_between_places_it_tells_what_the_springs_do(shape: str, skin: str | None) -> None:
    """At forces of .5 to 25 N, while a crown slides over the face's edge and beyond it, where a contact ends within
    tenths of a millimetre: in shares of what can be felt, beyond what springs tell a quarter of a millimetre away."""
    solid, worn = SOLIDS[shape], SKINS[skin] if skin else None
    vertices, faces = np.ascontiguousarray(solid.vertices, float), np.asarray(solid.faces, np.int64)
    one = PressedMesh(PAD, worn, METAL, vertices.tobytes(), faces.tobytes(), AXES.tobytes())
    table, sheet = one.table(), skinned(PAD, worn)
    view = pressed_view(sheet, one.vertices, one.faces, one.axes)
    middle, count = view.spans / 2, 97
    across = np.linspace(-0.0115, 0.0115, count)
    finer = replace(view, places=np.stack((middle[0] + across, np.full(count, middle[1]))))
    forces = np.exp(FIRST_FORCE + FORCE_STEP * np.arange(FORCES))
    found = finer.conducted(worn, METAL, ((1, count - 1), (1, 2)))[:, :, 0]
    conducts = found[..., 6] + found[..., 7]
    felt = conducts / (conducts + HALF_FELT)
    off = []
    for n in range(4, 10):
        for i in range(1, count - 3):
            near = felt[n, i - 1 : i + 2]
            told = curved_contact(table, float(forces[n]), float(finer.places[0, 1 + i]), float(middle[1]))[0]
            told /= told + HALF_FELT
            off.append((told - felt[n, i], max(near.min() - told, told - near.max(), 0.0)))
    here, nearby = np.abs(off).T
    assert nearby.max() < 0.06
    assert np.sqrt(np.mean(nearby**2)) < 0.006
    assert np.sqrt(np.mean(here**2)) < (0.01 if skin is None else 0.05)


def drawn(rng: np.random.Generator) -> trimesh.Trimesh:
    """2 mm to 20 cm large, half of them turned."""
    size, kind = float(np.exp(rng.uniform(np.log(2e-3), np.log(0.2)))), rng.integers(5)
    if kind == 0:
        mesh = trimesh.creation.box(size * rng.uniform(0.2, 1.0, 3))
    elif kind == 1:
        mesh = trimesh.creation.cylinder(
            size / 2, size * rng.uniform(0.2, 3.0), sections=int(rng.choice([6, 24, 96]))
        )
    elif kind == 2:
        mesh = trimesh.creation.icosphere(int(rng.integers(1, 5)), size / 2)
    elif kind == 3:
        mesh = trimesh.convex.convex_hull(rng.normal(size=(int(rng.integers(6, 60)), 3)) * size / 3)
    else:
        mesh = trimesh.creation.annulus(size / 4, size / 2, size)
    if rng.random() < 0.5:
        mesh.apply_transform(trimesh.transformations.random_rotation_matrix(rng.random(3)))
    return mesh


@pytest.mark.parametrize("skin", [None, "filled_silicone"])
def test_of_any_mesh_more_force_is_more_heat_and_nothing_is_more_than_flat(skin: str | None) -> None:
    rng, names = np.random.default_rng(11), sorted(materials())
    worn, forces = SKINS[skin] if skin else None, np.geomspace(0.01, 300.0, 40)
    for _ in range(6):
        mesh, made = drawn(rng), material(str(rng.choice(names)))
        vertices, faces = np.ascontiguousarray(mesh.vertices, float), np.asarray(mesh.faces, np.int64)
        one = PressedMesh(PAD, worn, made, vertices.tobytes(), faces.tobytes(), AXES.tobytes())
        table, sheet = one.table(), skinned(PAD, worn)
        flat = flat_footprint(sheet, face_joint(worn, Surface.of(made)), (0.5, 0.5))
        most = conduction(flat, forces[-1], np.zeros(3))[1]
        for place in rng.uniform(0.0, pressed_view(sheet, one.vertices, one.faces, one.axes).spans, (5, 2)):
            found = np.array([curved_contact(table, force, *place) for force in forces.tolist()])
            conducts, area, length = found.T
            assert (np.maximum.accumulate(conducts) - conducts <= 0.1 * conducts.max()).all(), made.name
            assert 0 <= conducts.min() and conducts.max() < 1.5 * most
            assert 0 <= area.min() and area.max() <= PAD.face**2 * (1 + 1e-9)
            assert 0 <= length.min() and length.max() <= PAD.face * (1 + 1e-9)
            shares = np.zeros(4)
            for force in forces[::8].tolist():
                curved_touch(table, force, *place, shares)
                assert 0 <= shares.min() and shares.max() <= 1 + 1e-12


@pytest.mark.parametrize("name", ["jam_jar", "beer_bottle", "rolling_pin", "screwdriver", "mug"])
def test_a_straight_wall_below_a_shoulder_stays_straight(name: str) -> None:
    """Smooth surfaces leave the triangles by what stands for a round wall, and by no bend of its outline."""
    vertices, faces = library_object(name).spec().geometry.surface
    vertices, faces = np.ascontiguousarray(vertices, float), faces.astype(np.int64)
    flat = height_map(vertices, faces, AXES).height
    smooth = height_map(vertices, faces, AXES, corner_normals(vertices.tobytes(), faces.tobytes())).height
    both = np.isfinite(flat) & np.isfinite(smooth)
    assert both.any() and np.abs(smooth[both] - flat[both]).max() < 5e-5


@pytest.mark.parametrize("name", ["aluminium", "wood"])
@pytest.mark.parametrize("skin", [None, "filled_silicone"])
@pytest.mark.parametrize(
    ("first", "second"), [(2.0, 40.0), (3.3, 40.0), (5.9, 30.0), (12.0, 40.0), (40.0, 6.1)]
)
def test_a_block_is_felt_as_a_box_is(first: float, second: float, skin: str | None, name: str) -> None:
    """Faces of mm that no grid divides, narrower than the sensor's, in the middle and up to where 2 mm of the sensor
    are over them."""
    size = first / 1e3, second / 1e3
    solid, worn = trimesh.creation.box((0.04, *size)), SKINS[skin] if skin else None
    of = np.array(solid.vertices).tobytes(), np.array(solid.faces, np.int64).tobytes(), np.eye(3).tobytes()
    table = PressedMesh(PAD, worn, material(name), *of).table()
    middle = pressed_view(skinned(PAD, worn), *of).spans / 2
    joint = face_joint(worn, Surface.of(material(name)))
    law = flat_law(skinned(PAD, worn), joint, size, (1, 2))
    for force in (1.0, 8.0, 20.0):
        for aside in np.linspace(0.0, size[0] / 2 + 0.0025, 9):
            area, load = contact(law, force, np.array([0.0, aside, 0.0]))
            found = curved_contact(table, force, middle[0] + aside, middle[1])
            felt = [each / (each + HALF_FELT) for each in (found[0], conductance(law, load / area) * area)]
            assert felt[0] == pytest.approx(felt[1], abs=0.015 if skin is None else 0.05)
            if aside < size[0] / 2 - PAD.face / 2 or aside == 0.0:
                assert found[1] == pytest.approx(area, rel=0.01)


def test_coverage_is_that_of_the_outline() -> None:
    """Of a disc and of a triangle in nodes of .25 mm, wherever they lie between them."""
    rng = np.random.default_rng(0)
    for side in rng.uniform(1e-3, 8e-3, 5):
        disc = trimesh.creation.cylinder(side, 0.01, sections=64)
        corners = np.array([[0, 0, 0], [0, side, 0], [0, 0, 2 * side], [1e-3, 0, 0]])
        wedge = np.array([[0, 1, 2]])
        for vertices, faces, area in (
            (np.array(disc.vertices), np.array(disc.faces), 32 * side**2 * np.sin(2 * np.pi / 64)),
            (corners, wedge, side**2),
        ):
            seen = height_map(vertices, faces, np.eye(3) if area == side**2 else AXES[[2, 1, 0]])
            assert (seen.seen.sum() * seen.pitch**2) == pytest.approx(area, rel=0.02)
            assert (np.isfinite(seen.height) == (seen.seen > 0)).all()
