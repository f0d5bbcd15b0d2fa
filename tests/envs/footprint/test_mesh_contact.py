"""What a pad meets of a mesh is found from the mesh: radii of bodies whose radii are known, faces of flat ones."""

import math
from pathlib import Path

import numpy as np
import pytest
import trimesh

from thermograsp.envs import ObjectSpec, objects
from thermograsp.envs.bodies.solids import (
    Triangles,
    cut,
    ellipsoid,
    skinned,
    turned,
)
from thermograsp.envs.footprint.grasp_body import NOMINAL_FORCE, PAD, GraspBody
from thermograsp.envs.footprint.mesh_contact import mesh_contact
from thermograsp.thermal import material, sensor


def saved(surface: Triangles, folder: Path, **placed: object) -> ObjectSpec:
    file = folder / "body.ply"
    trimesh.Trimesh(*surface, process=False).export(file)
    return ObjectSpec(shape="mesh", mesh=str(file), **placed)  # pyright: ignore[reportArgumentType]


def rod(radius: float, length: float = 0.05) -> Triangles:
    return turned(np.array([[0.0, 0.0], [radius, 0.0], [radius, length], [0.0, length]]))


@pytest.mark.parametrize("radius", [0.01, 0.02, 0.04])
@pytest.mark.parametrize("axis", ["z", "y"])
def test_a_cylinder_s_radius(tmp_path: Path, radius: float, axis: str) -> None:
    found = mesh_contact(PAD, saved(rod(radius).along(axis), tmp_path), NOMINAL_FORCE)
    assert found.shape == "cylinder" and found.size[0] == pytest.approx(PAD.width, rel=0.01)
    assert found.radius == pytest.approx(radius, rel=0.05)


@pytest.mark.parametrize(
    "size", [(0.04, 0.04, 0.04), (0.06, 0.06, 0.06), (0.05, 0.07, 0.05), (0.06, 0.06, 0.045)]
)
def test_a_sphere_s_radius_and_the_mean_of_an_ellipsoid_s_two(
    tmp_path: Path, size: tuple[float, float, float]
) -> None:
    found = mesh_contact(PAD, saved(ellipsoid(size), tmp_path), NOMINAL_FORCE)
    x, y, z = (side / 2 for side in size)
    assert found.shape == "sphere"
    assert found.radius == pytest.approx(y * z / x, rel=0.05)


def test_a_flat_face_and_its_size(tmp_path: Path) -> None:
    bar = cut(np.array([[-0.05, -0.006, 0.006], [0.05, -0.006, 0.006]]), 0.02)
    found = mesh_contact(PAD, saved(bar, tmp_path), NOMINAL_FORCE)
    assert found.shape == "flat" and found.size == pytest.approx(
        (0.02, 0.010), rel=0.02
    )  # 2 mm of it are below the pad


def test_a_turned_body_is_met_on_the_faces_between_the_fingers(tmp_path: Path) -> None:
    """A half round bar: round along x, flat along y."""
    angle = np.linspace(0.0, math.pi, 60)
    loops = np.array([np.stack([0.02 * np.cos(angle), 0 * angle, 0.02 * np.sin(angle)], axis=1)] * 2)
    loops[0, :, 1], loops[1, :, 1] = -0.03, 0.03
    bar = saved(skinned(loops), tmp_path)
    assert mesh_contact(PAD, bar, NOMINAL_FORCE).shape != "flat"
    ends = ObjectSpec(shape="mesh", mesh=bar.mesh, yaw=math.pi / 2)
    assert mesh_contact(PAD, ends, NOMINAL_FORCE).shape == "flat"


@pytest.mark.parametrize(
    ("name", "shape", "radius"),
    [("drinks_can", "cylinder", 0.0331), ("tomato", "sphere", 0.027), ("hex_nut", "flat", math.inf)],
)
def test_an_object_s_contact_is_that_of_its_shape(name: str, shape: str, radius: float) -> None:
    spec = objects()[name].spec()
    thing = GraspBody(spec, material(str(spec.material)), 24.0, "T", sensor("seed"))
    assert thing.contact_shape == shape
    area = float(thing.contact(np.array(NOMINAL_FORCE)).pad)
    if shape == "flat":
        assert area == pytest.approx(PAD.width**2, rel=0.02)
        return
    size = (2 * radius, 2 * radius, 2 * radius if shape == "sphere" else 0.115)
    plain = GraspBody(ObjectSpec(shape=shape, size=size), thing.material, 24.0, "T", thing.stack)  # pyright: ignore
    assert area == pytest.approx(float(plain.contact(np.array(NOMINAL_FORCE)).pad), rel=0.05)
    assert GraspBody(spec, thing.material, 24.0, "O", thing.stack).contact_shape == "flat"
