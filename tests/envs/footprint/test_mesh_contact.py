"""What a pad meets of a mesh follows from the mesh: closed forms' areas of round bodies, faces up to their edges."""

import math
from collections.abc import Callable
from dataclasses import replace
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
from thermograsp.envs.footprint import mesh_contact as contacts
from thermograsp.envs.footprint.grasp_body import NOMINAL_FORCE, PAD, GraspBody
from thermograsp.envs.footprint.mesh_contact import is_mesh_contact, mesh_contact
from thermograsp.envs.footprint.taxels import Taxels
from thermograsp.thermal import SKINS, ContactArea, cylinder_contact, material, sensor, sphere_contact
from thermograsp.thermal.contact import TABLE_FORCES, footprint
from thermograsp.thermal.pressed import pressure_map


def saved(surface: Triangles, folder: Path, **placed: object) -> ObjectSpec:
    file = folder / "body.ply"
    trimesh.Trimesh(*surface, process=False).export(file)
    return ObjectSpec(shape="mesh", mesh=str(file), **placed)  # pyright: ignore[reportArgumentType]


def rod(radius: float, length: float = 0.05) -> Triangles:
    return turned(np.array([[0.0, 0.0], [radius, 0.0], [radius, length], [0.0, length]]))


def swept(radius: Callable[[np.ndarray, np.ndarray], np.ndarray], length: float = 0.05) -> Triangles:
    """A body along z whose radius is a function of angle and height."""
    around, up = 180, 300
    angle = np.arange(around) * (2 * np.pi / around)
    loops = []
    for height in np.linspace(0.0, length, up):
        reach = radius(angle, np.full(around, height))
        loops.append(
            np.stack([reach * np.cos(angle), reach * np.sin(angle), np.full(around, height)], axis=1)
        )
    return skinned(np.array(loops))


def thread(angle: np.ndarray, height: np.ndarray) -> np.ndarray:
    """M20: crests of 1/8 of a pitch of 2.5 mm, flanks of 60 degrees."""
    turn = (height / 0.0025 - angle / (2 * np.pi)) % 1
    return 0.01 - 0.00217 * np.maximum(abs(turn - 0.5) - 1 / 16, 0)


def gear(angle: np.ndarray, height: np.ndarray) -> np.ndarray:
    """Twenty teeth on a pitch circle of 20 mm."""
    turn = (20 * angle / (2 * np.pi)) % 1
    return 0.02 - 0.004 * np.clip((abs(turn - 0.5) - 0.15) / 0.1, 0, 1) + 0 * height


FORCES = (0.3, 3.0, 10.0, 30.0)


def contact_of(spec: ObjectSpec) -> ContactArea:
    found = mesh_contact(PAD, spec, FORCES)
    assert found is not None
    return found


@pytest.mark.parametrize("radius", [0.01, 0.02])  # a larger one's facets are as wide as the contact
@pytest.mark.parametrize("axis", ["z", "y"])
def test_a_rod_is_the_closed_form_s_cylinder(tmp_path: Path, radius: float, axis: str) -> None:
    found = contact_of(saved(rod(radius).along(axis), tmp_path))
    expected = cylinder_contact(PAD, np.array(FORCES), radius, 0.05)
    row = PAD.width**2 / 240  # of the points at which the mesh is looked at
    np.testing.assert_allclose(found.pad, expected.pad, rtol=0.01, atol=row)
    np.testing.assert_allclose(found.face, expected.face, rtol=0.01, atol=row * PAD.face / PAD.width)
    np.testing.assert_allclose(found.face_force, expected.face_force, rtol=0.01)


@pytest.mark.parametrize(
    "size", [(0.04, 0.04, 0.04), (0.06, 0.06, 0.06), (0.05, 0.07, 0.05), (0.06, 0.06, 0.045)]
)
def test_an_ellipsoid_is_a_sphere_of_its_mean_radius(
    tmp_path: Path, size: tuple[float, float, float]
) -> None:
    """Its contact is an ellipse whose axes go with the roots of the two radii: of the same area."""
    found = contact_of(saved(ellipsoid(size), tmp_path))
    x, y, z = (side / 2 for side in size)
    expected = sphere_contact(PAD, np.array(FORCES), y * z / x)
    np.testing.assert_allclose(found.pad[:3], expected.pad[:3], rtol=0.05)


def test_a_face_counts_up_to_its_edge(tmp_path: Path) -> None:
    bar = cut(np.array([[-0.05, -0.006, 0.006], [0.05, -0.006, 0.006]]), 0.02)
    found = contact_of(saved(bar, tmp_path))
    np.testing.assert_allclose(found.pad, 0.02 * 0.010, rtol=0.02)  # 2 mm of it are below the pad
    np.testing.assert_allclose(found.face, 0.009 * 0.0045, rtol=0.03)  # and its upper edge is on the face


def test_a_face_whose_edge_is_under_the_sensor_counts_for_its_part(tmp_path: Path) -> None:
    """A bar that is moved along the pad: the area on the face falls in proportion."""
    bar = cut(np.array([[-0.01, -0.03, 0.03], [0.01, -0.03, 0.03]]), 0.02)
    for aside in (0.007, 0.009, 0.011):  # the bar is 20 mm wide
        found = contact_of(saved(bar, tmp_path, position=(0.0, aside)))
        np.testing.assert_allclose(found.face, 0.009 * (0.0145 - aside), rtol=0.03)


def test_threads_and_teeth_touch_less_than_smooth_bodies(tmp_path: Path) -> None:
    for rough, radius in ((thread, 0.01), (gear, 0.02)):
        found = contact_of(saved(swept(rough), tmp_path))
        smooth = cylinder_contact(PAD, np.array(FORCES), radius, 0.05)
        assert (found.face < 0.8 * smooth.face).all() and (np.diff(found.face) > 0).all()
        assert (found.face_force <= np.array(FORCES) * (1 + 1e-9)).all()


def test_the_heat_s_area_is_that_of_the_pressure_map(tmp_path: Path) -> None:
    """The same springs on the same mesh: the squares under pressure of a fine map, to what its squares resolve."""
    spec = saved(swept(thread), tmp_path)
    pads = Taxels((80, 80))
    frame = np.array([[-0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]])
    pressure = pads._map(spec, frame, 10.0, np.zeros(2))
    covered = (pressure > 0).sum() * (PAD.width / 80) ** 2
    assert covered == pytest.approx(contact_of(spec).pad[2], rel=0.15)


@pytest.mark.parametrize(
    ("name", "shape", "radius"),
    [("drinks_can", "cylinder", 0.0331), ("tomato", "sphere", 0.027), ("hex_nut", "flat", math.inf)],
)
def test_an_object_s_contact_is_that_of_its_shape(name: str, shape: str, radius: float) -> None:
    spec = objects()[name].spec()
    skin = SKINS["filled_silicone"]
    body = GraspBody(spec, material(str(spec.material)), 24.0, "T", skin.over(sensor("seed")), skin=skin)
    area = float(body.contact(np.array(NOMINAL_FORCE)).pad)
    if shape == "flat":
        assert area == pytest.approx(PAD.width**2, rel=0.02)
        return
    plain = (sphere_contact if shape == "sphere" else cylinder_contact)(body.pad, NOMINAL_FORCE, radius)
    assert area == pytest.approx(float(plain.pad), rel=0.05)
    assert GraspBody(spec, body.material, 24.0, "O", body.stack).contact_shape == "flat"
    expected = body.contact(np.array(NOMINAL_FORCE))
    found = footprint(body.law, NOMINAL_FORCE, np.zeros(3))
    assert found == pytest.approx((float(expected.face), float(expected.face_force)), rel=0.04)


def test_an_object_that_can_break_is_pressed_once_and_seen_once(monkeypatch: pytest.MonkeyPatch) -> None:
    """What a reset asks: each pad looks at the mesh once and is pressed by one force. Its table is made when a heat
    model asks for it."""
    pressed = []

    def press(*given: object) -> tuple[float, float, float]:
        pressed.append(given[6])
        return pressure_map(*given)

    monkeypatch.setattr(contacts, "pressure_map", press)
    seen = contacts._seen.cache_info().misses
    spec = replace(objects()["egg"].spec(), yaw=0.0123)
    body = GraspBody(spec, material("egg"), 24.0, "T", sensor("seed"), skin=SKINS["filled_silicone"])
    assert body.crushing_force > 0
    assert pressed == 2 * [NOMINAL_FORCE]
    assert body.law["areas"].max() > 0
    assert len(pressed) == 2 + 2 * len(TABLE_FORCES)
    assert contacts._seen.cache_info().misses == seen + 2


def test_pads_that_miss_a_mesh_meet_a_flat_stand_in(tmp_path: Path) -> None:
    spec = saved(rod(0.01, 0.02), tmp_path, position=(0.0, 0.03))
    assert not is_mesh_contact(PAD, spec)
    assert mesh_contact(PAD, spec, (1.0,)) is None
    body = GraspBody(spec, material("steel"), 24.0, "T", sensor("seed"))
    assert body.contact_shape == "flat"
    assert body.closed_mesh is None
