"""Two hundred meshes that are broken in every way that files are: each is mended or refused, and told which."""

import warnings

import numpy as np
import pytest
import trimesh

from thermograsp.envs.bodies.meshes import load_mesh
from thermograsp.errors import MeshError, ThermograspError

EACH = 17


def shape(rng: np.random.Generator) -> trimesh.Trimesh:
    """Some solid of 2 to 6 cm, turned somehow."""
    size = rng.uniform(0.02, 0.06)
    mesh = (
        trimesh.creation.box((size, 0.7 * size, 0.8 * size)),
        trimesh.creation.icosphere(2, size / 2),
        trimesh.creation.cylinder(size / 2, size, sections=24),
        trimesh.creation.annulus(size / 4, size / 2, size, sections=24),
    )[rng.integers(4)]
    return mesh.apply_transform(trimesh.transformations.random_rotation_matrix(rng.random(3)))


def rebuilt(mesh, faces, vertices=None) -> trimesh.Trimesh:
    return trimesh.Trimesh(mesh.vertices if vertices is None else vertices, faces, process=False)


def opened(rng):
    mesh = shape(rng)
    return rebuilt(mesh, rng.permutation(mesh.faces)[rng.integers(1, 5) :])


def inverted(rng):
    mesh = shape(rng)
    return rebuilt(mesh, mesh.faces[:, ::-1])


def partly_turned(rng):
    mesh = shape(rng)
    turned = rng.choice(len(mesh.faces), rng.integers(1, len(mesh.faces) // 3), replace=False)
    faces = np.array(mesh.faces)
    faces[turned] = faces[turned, ::-1]
    return rebuilt(mesh, faces)


def with_pointed_faces(rng):
    mesh = shape(rng)
    corner = rng.integers(len(mesh.vertices), size=(rng.integers(1, 9), 1))
    return rebuilt(mesh, np.concatenate((mesh.faces, np.repeat(corner, 3, axis=1))))


def doubled(rng):
    mesh = shape(rng)
    again = rng.choice(len(mesh.faces), rng.integers(1, len(mesh.faces)), replace=False)
    return rebuilt(mesh, np.concatenate((mesh.faces, mesh.faces[again])))


def crossing(rng):
    mesh = shape(rng)
    other = mesh.copy().apply_translation(rng.uniform(0.2, 0.4) * mesh.extents * [1, 0, 0])
    return trimesh.util.concatenate([mesh, other])


def partly_inside_out(rng):
    mesh = shape(rng)
    other = shape(rng).apply_scale(0.5).apply_translation([0.1, 0, 0])
    return trimesh.util.concatenate([mesh, rebuilt(other, other.faces[:, ::-1])])


def not_finite(rng):
    mesh = shape(rng)
    vertices = np.array(mesh.vertices)
    vertices[rng.integers(len(vertices)), rng.integers(3)] = rng.choice([np.nan, np.inf, -np.inf])
    return rebuilt(mesh, mesh.faces, vertices)


def in_millimetres(rng):
    return shape(rng).apply_scale(1000)


def far_away(rng):
    return shape(rng).apply_translation([10.0 ** rng.uniform(7, 30), 0, 0])


def flat(rng):
    mesh = shape(rng)
    return rebuilt(mesh, mesh.faces, mesh.vertices * [1, 1, 0])


MENDED = {
    inverted: "inside out and has been turned",
    partly_turned: "turned the wrong way and have been turned",
    with_pointed_faces: "faces without area have been left out",
    doubled: "faces given twice have been left out",
}
REFUSED = {
    opened: "not closed",
    crossing: "crosses itself",
    partly_inside_out: "inside out",
    not_finite: "not finite",
    in_millimetres: r"try scale 0.001 \(a file in millimetres\)",
    far_away: "units from the origin|no volume",
    flat: "no volume|no faces",
}


@pytest.mark.parametrize("make", MENDED, ids=lambda make: make.__name__)
def test_what_can_be_mended_is_the_same_solid_and_told(tmp_path, make):
    rng = np.random.default_rng(1)
    for number in range(EACH):
        state = rng.bit_generator.state
        path = str(tmp_path / f"{number}.{('stl', 'ply', 'obj')[number % 3]}")
        make(rng).export(path)
        with pytest.warns(RuntimeWarning, match=MENDED[make]):
            mended = load_mesh(path)
        rng.bit_generator.state = state  # the shape that was broken
        assert mended.volume == pytest.approx(shape(rng).volume, rel=1e-5)


@pytest.mark.parametrize("make", REFUSED, ids=lambda make: make.__name__)
def test_what_cannot_be_mended_is_refused_with_why(tmp_path, make):
    rng = np.random.default_rng(2)
    for number in range(EACH):
        path = str(tmp_path / f"{number}.{('stl', 'ply')[number % 2]}")
        make(rng).export(path)
        with pytest.raises(MeshError, match=REFUSED[make]) as caught:
            load_mesh(path)
        assert path in str(caught.value)


@pytest.mark.parametrize("suffix", ["stl", "obj", "ply", "glb"])
def test_files_of_anything_are_refused(tmp_path, suffix):
    rng = np.random.default_rng(3)
    good = tmp_path / f"good.{suffix}"
    shape(rng).export(good)
    content = good.read_bytes()
    broken = [
        b"",
        b"solid model\n" + b"this is a letter, not a mesh\n" * 400,
        b"\x00" * 400,
        content[: len(content) // 3],
        *(rng.bytes(int(rng.integers(1, 3000))) for _ in range(4)),
    ]
    for number, what in enumerate(broken):
        path = tmp_path / f"{number}.{suffix}"
        path.write_bytes(what)
        with pytest.raises(MeshError, match=str(path)):
            load_mesh(str(path))


@pytest.mark.parametrize("suffix", ["stl", "obj", "ply", "glb"])
def test_files_with_wrong_bytes_are_refused_or_solids(tmp_path, suffix):
    rng = np.random.default_rng(4)
    good = tmp_path / f"good.{suffix}"
    shape(rng).export(good)
    content = np.frombuffer(good.read_bytes(), np.uint8)
    for number in range(EACH):
        wrong = content.copy()
        where = rng.integers(len(wrong), size=rng.integers(1, 20))
        wrong[where] = rng.integers(256, size=len(where))
        path = tmp_path / f"{number}.{suffix}"
        path.write_bytes(wrong.tobytes())
        with warnings.catch_warnings():
            warnings.simplefilter("ignore", RuntimeWarning)
            try:
                found = load_mesh(str(path))
            except ThermograspError as error:
                assert str(path) in str(error)
            else:
                assert 0 < found.volume <= np.prod(found.extents)


def test_files_that_are_too_large_are_not_read(tmp_path):
    path = tmp_path / "huge.stl"
    with path.open("wb") as file:
        file.truncate(300 * 2**20)
    with pytest.raises(MeshError, match="simplify it"):
        load_mesh(str(path))


def test_a_surface_with_one_side_is_no_solid(tmp_path):
    """The projective plane on six corners."""
    faces = "125 126 134 136 145 234 235 246 356 456".split()
    corners = np.random.default_rng(5).uniform(0, 0.05, (6, 3))
    path = str(tmp_path / "plane.ply")
    trimesh.Trimesh(corners, [[int(c) - 1 for c in face] for face in faces], process=False).export(path)
    with pytest.raises(MeshError, match="one side only"):
        load_mesh(path)
