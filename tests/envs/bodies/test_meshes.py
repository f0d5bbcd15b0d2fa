import numpy as np
import pytest
import trimesh

from thermograsp.envs.bodies.mesh_files import FORMATS
from thermograsp.envs.bodies.meshes import load_mesh
from thermograsp.envs.bodies.object_spec import ObjectSpec
from thermograsp.envs.gym import GraspBatch
from thermograsp.envs.mechanics.batch import Mechanics
from thermograsp.envs.mechanics.scene import build_scene
from thermograsp.errors import InvalidValueError, MeshError


def saved(mesh, path):
    mesh.export(path)
    return str(path)


def box(*size):
    return trimesh.creation.box(size)


@pytest.mark.parametrize("suffix", FORMATS)
def test_a_solid_has_the_box_s_extents_volume_and_inertia(tmp_path, suffix):
    mesh = box(0.04, 0.05, 0.06).apply_translation((0.3, -0.2, 0.1))
    shape = load_mesh(saved(mesh, tmp_path / f"solid{suffix}"))
    assert shape.extents == pytest.approx((0.04, 0.05, 0.06), rel=1e-5)
    assert shape.volume == pytest.approx(0.04 * 0.05 * 0.06, rel=1e-5)
    assert shape.centre_of_mass == pytest.approx((0, 0, 0), abs=1e-7)
    expected = ObjectSpec(size=(0.04, 0.05, 0.06), mass=1.0).inertia[1]
    assert np.array(shape.unit_inertia) == pytest.approx(expected, rel=1e-4, abs=1e-9)


def test_scale_and_density_give_the_mass(tmp_path):
    path = saved(box(40, 40, 40), tmp_path / "millimetres.stl")
    spec = ObjectSpec(shape="mesh", mesh=path, scale=0.001, density=2500.0)
    assert spec.size == pytest.approx((0.04,) * 3)
    assert build_scene((spec,)).body("object").mass[0] == pytest.approx(0.16)


def test_an_inside_out_solid_is_turned_round(tmp_path):
    mesh = box(0.04, 0.04, 0.04)
    mesh.invert()
    assert load_mesh(saved(mesh, tmp_path / "inverted.stl")).volume == pytest.approx(6.4e-5)


def with_bad_vertex():
    mesh = box(0.04, 0.04, 0.04)
    vertices = mesh.vertices.copy()
    vertices[3] = np.nan
    return trimesh.Trimesh(vertices, mesh.faces, process=False)


def with_hole():
    mesh = box(0.04, 0.04, 0.04)
    mesh.update_faces(np.arange(len(mesh.faces)) > 0)
    return mesh


def sheet():
    return trimesh.Trimesh([[0, 0, 0], [0.04, 0, 0], [0, 0.04, 0]], [[0, 1, 2], [0, 2, 1]], process=False)


def folded_sheet():
    """Closed, with extents along every axis, and nothing inside."""
    corners = np.array([[0, 0, 0], [0.04, 0, 0.04], [0, 0.04, 0]])
    return trimesh.Trimesh(corners, [[0, 1, 2], [0, 2, 1]], process=False)


@pytest.mark.parametrize(
    ("make", "message"),
    [
        (with_bad_vertex, "1 of 8 vertices are not finite"),
        (with_hole, "not closed"),
        (sheet, "no volume"),
        (folded_sheet, "no volume"),
        (lambda: box(40, 40, 40), r"try scale 0.001 \(a file in millimetres\)"),
        (lambda: box(1.6, 1.6, 1.6), r"scale 0.0254 \(a file in inches\)"),
        (lambda: box(0.2, 0.3, 0.2), "scale 0.2"),
        (lambda: box(0.004, 0.03, 0.03), "5 mm at least"),
    ],
)
def test_unusable_meshes_are_refused_with_advice(tmp_path, make, message):
    path = saved(make(), tmp_path / "bad.ply")
    with pytest.raises(MeshError, match=message):
        load_mesh(path)


def test_missing_foreign_and_broken_files_are_refused(tmp_path):
    with pytest.raises(MeshError, match="no such file"):
        load_mesh(str(tmp_path / "none.stl"))
    with pytest.raises(MeshError, match="unknown mesh format '.step'"):
        load_mesh(str(tmp_path / "part.step"))
    for name in ("text.stl", "text.glb", "text.obj", "text.ply"):
        (tmp_path / name).write_text("hello")
        with pytest.raises(MeshError, match=name):
            load_mesh(str(tmp_path / name))


def test_a_long_mesh_fits_when_turned(tmp_path):
    path = saved(box(0.12, 0.03, 0.03), tmp_path / "long.stl")
    with pytest.raises(InvalidValueError, match="turn it"):
        ObjectSpec(shape="mesh", mesh=path)
    assert ObjectSpec(shape="mesh", mesh=path, yaw=np.pi / 2).width == pytest.approx(0.03)


def hold(mechanics, seconds=1.2, lift=0.0):
    n = mechanics.num_envs
    records = [
        mechanics.step(np.zeros(n), np.full(n, 10.0), np.full(n, lift)) for _ in range(round(seconds / 0.02))
    ]
    return records[-1]


def test_a_mesh_box_feels_like_a_box(tmp_path):
    path = saved(box(0.04, 0.04, 0.04), tmp_path / "box.stl")
    forces = []
    for spec in (ObjectSpec(), ObjectSpec(shape="mesh", mesh=path)):
        mechanics = Mechanics((spec,))
        hold(mechanics)
        hold(mechanics, 1.0, lift=0.05)
        forces.append(hold(mechanics, 0.5).force[0, -1, :, 0])
    assert forces[1] == pytest.approx(forces[0], abs=0.01)


@pytest.mark.slow
def test_convex_pieces_leave_the_hole_open(tmp_path):
    pytest.importorskip("vhacdx")
    path = saved(trimesh.creation.annulus(0.02, 0.03, 0.03), tmp_path / "ring.stl")
    solid, ring = load_mesh(path), load_mesh(path, pieces=6)
    hull_volume = [sum(trimesh.Trimesh(*hull).volume for hull in shape.hulls) for shape in (solid, ring)]
    assert solid.volume == ring.volume  # the true solid's
    assert hull_volume[0] == pytest.approx(np.pi * 0.03**2 * 0.03, rel=0.02)
    assert hull_volume[1] == pytest.approx(ring.volume, rel=0.25)
    mechanics = Mechanics((ObjectSpec(shape="mesh", mesh=path, pieces=6),))
    normal = hold(mechanics).force[0, -1, :, 0, 0]
    assert normal.sum() == pytest.approx(20.0, rel=5e-3)  # the table's friction may unbalance the two


def test_meshes_and_primitives_share_a_batch(tmp_path):
    ball = ObjectSpec(shape="mesh", mesh=saved(trimesh.creation.icosphere(3, 0.02), tmp_path / "ball.stl"))
    brick = ObjectSpec(shape="mesh", mesh=saved(box(0.03, 0.04, 0.05), tmp_path / "brick.stl"))
    plain = ObjectSpec(size=(0.03, 0.04, 0.05))
    mechanics = Mechanics((plain,), 3, library=(ball, brick))
    mechanics.reset(objects=[(plain,), (ball,), (brick,)])
    record = hold(mechanics)
    assert not record.failed.any()
    normal = record.force[:, -1, :, 0, 0]
    assert normal.mean(axis=1) == pytest.approx(10.0, rel=0.001)
    assert normal == pytest.approx(
        10.0, abs=0.8 * 0.1 * 9.81 / 2
    )  # the table's friction may unbalance the two
    assert record.opening[:, -1] == pytest.approx([0.03, 0.04, 0.03], abs=1e-3)
    with pytest.raises(InvalidValueError, match="library"):
        Mechanics((plain,)).reset(objects=[(ball,)])


def test_where_a_plate_stands_for_a_mesh_it_is_told_why(tmp_path):
    """Two cubes that share an edge, through which the line between the fingers goes."""
    cubes = [trimesh.creation.box((0.02, 0.02, 0.04)) for _ in range(2)]
    for cube, side in zip(cubes, (-1, 1), strict=True):
        cube.apply_translation((0.01 * side, 0.01 * side, 0.0))
    trimesh.util.concatenate(cubes).export(tmp_path / "edge.stl")
    spec = ObjectSpec(shape="mesh", mesh=str(tmp_path / "edge.stl"), name="two cubes")
    batch = GraspBatch(1, objects=spec, material="wood", anywhere=False)
    with pytest.warns(RuntimeWarning, match="'two cubes': .*. A plate of the same volume stands for it"):
        batch.reset([0], [np.random.default_rng(0)])
