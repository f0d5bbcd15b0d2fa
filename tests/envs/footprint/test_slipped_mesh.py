"""What pads meet of a mesh that slips and turns between them."""

from pathlib import Path

import numpy as np
import pytest
import trimesh

from thermograsp.envs import ObjectSpec
from thermograsp.envs.footprint import GraspBody
from thermograsp.envs.footprint.slipped_mesh import GRID, mesh_steps
from thermograsp.envs.sensing.heat import GraspHeat
from thermograsp.thermal import SKINS, cylinder_contact, flat_contact, material, sensor
from thermograsp.thermal.contact import TABLE_FORCES, footprint

FORCES = TABLE_FORCES[3:]
CLOSED = np.array([[[-0.02, 0.0, 0.0], [0.02, 0.0, 0.0]]])
"""m, the pads' middles."""


def body_of(mesh: trimesh.Trimesh, folder: Path, **placed: object) -> GraspBody:
    file = folder / f"{len(mesh.faces)}.ply"
    mesh.export(file)
    spec = ObjectSpec(shape="mesh", mesh=str(file), **placed)  # pyright: ignore[reportArgumentType]
    skin = SKINS["filled_silicone"]
    return GraspBody(spec, material("steel"), 24.0, "T", skin.over(sensor("seed")), skin=skin)


def found(body: GraspBody, places: np.ndarray) -> np.ndarray:
    """m2 on the face at FORCES."""
    closed = body.closed_mesh
    assert closed is not None
    step = mesh_steps(places, np.array([closed.azimuth]), np.array([closed.place]))[0]
    law = body.slipped_law(tuple(step.tolist()))
    return np.array([footprint(law, force, np.zeros(3))[0] for force in FORCES])


def turned(places: np.ndarray, angle: float) -> np.ndarray:
    """As a mesh that turns by -angle rad about z sees them."""
    cos, sin = np.cos(angle), np.sin(angle)
    return places @ np.array([[cos, sin, 0.0], [-sin, cos, 0.0], [0.0, 0.0, 1.0]])


def test_where_the_pads_closed_nothing_changes(tmp_path: Path) -> None:
    body = body_of(trimesh.creation.box((0.03, 0.04, 0.05)), tmp_path, position=(0.0, 0.004), yaw=0.3)
    closed = body.closed_mesh
    assert closed is not None
    lies = turned(CLOSED - [0.0, 0.004, body.spec.size[2] / 2 - body.spec.grasp_height], -0.3)
    near = lies + 0.4 * GRID * np.array([0.0, 0.0, 1.0])
    for places in (lies, near):
        assert not mesh_steps(places, np.array([closed.azimuth]), np.array([closed.place])).any()
    assert body.slipped_law((0, 0, 0, 0, 0)).tobytes() == body.law.tobytes()


@pytest.mark.parametrize("down", [0.004, 0.018, 0.021, 0.0232, 0.035])
def test_a_rod_that_slips_out_is_touched_up_to_its_end(tmp_path: Path, down: float) -> None:
    body = body_of(trimesh.creation.cylinder(0.01, 0.04, sections=180), tmp_path)
    expected = cylinder_contact(body.pad, FORCES, 0.01, 0.04, offset=(down, 0.0)).face
    whole = cylinder_contact(body.pad, FORCES, 0.01, 0.04).face
    np.testing.assert_allclose(
        found(body, CLOSED + [0.0, 0.0, down]), expected, rtol=0, atol=0.16 * whole.max()
    )


@pytest.mark.parametrize("aside", [0.0, 0.016, 0.02, 0.0239])
def test_a_block_is_touched_up_to_its_edge(tmp_path: Path, aside: float) -> None:
    body = body_of(trimesh.creation.box((0.03, 0.04, 0.05)), tmp_path)
    expected = flat_contact(body.pad, FORCES, (0.04, 0.05), (aside, 0.0)).face
    np.testing.assert_allclose(found(body, CLOSED + [0.0, aside, 0.0]), expected, rtol=0, atol=5e-6)


def test_a_block_that_turns_is_touched_at_its_edge_and_a_rod_as_before(tmp_path: Path) -> None:
    block = body_of(trimesh.creation.box((0.03, 0.03, 0.05)), tmp_path)
    closed = found(block, CLOSED)
    edge, quarter = (found(block, turned(CLOSED, angle)) for angle in (np.pi / 4, np.pi / 2))
    assert (edge < 0.5 * closed).all() and (edge > 0).all()
    np.testing.assert_allclose(quarter, closed, rtol=1e-6)
    rod = body_of(trimesh.creation.cylinder(0.01, 0.04, sections=360), tmp_path)
    np.testing.assert_allclose(found(rod, turned(CLOSED, 0.8)), found(rod, CLOSED), rtol=0.1)


def test_slipping_off_changes_it_little_by_little(tmp_path: Path) -> None:
    body = body_of(trimesh.creation.cylinder(0.01, 0.04, sections=180), tmp_path)
    areas = np.array([found(body, CLOSED + [0.0, 0.0, down])[-1] for down in np.arange(0.0, 0.026, GRID / 2)])
    assert areas[-1] == 0 and areas[0] > 0
    assert np.abs(np.diff(areas)).max() < 0.1 * areas[0]


def test_the_heat_follows_a_mesh_that_slips(tmp_path: Path) -> None:
    """And goes back: what a mesh conducts follows from where the pads are alone."""
    body = body_of(trimesh.creation.box((0.03, 0.04, 0.05)), tmp_path)
    heat = GraspHeat(2, tolerance=0.12, air=0.0, dt=0.05, samples=1, sensor_temperature=36.0)
    heat.reset([0, 1], [body, body], waiting=(0, 1))
    force = np.full((2, 5, 2), 10.0)
    whole = footprint(body.law, 10.0, np.zeros(3))[0]
    for aside in (0.0, 0.02, 0.01, 0.02, 0.0):
        heat._slip(force, np.concatenate((CLOSED + [0.0, aside, 0.0], CLOSED)))
        found = [footprint(law, 10.0, np.zeros(3))[0] for law in heat._laws]
        assert found == pytest.approx([whole / 2 if aside == 0.02 else whole, whole], rel=0.05)
    assert heat._laws[0].tobytes() == body.law.tobytes()
    force[:] = 0.0
    heat._slip(force, np.concatenate((CLOSED + [0.0, 0.02, 0.0], CLOSED)))
    assert heat._laws[0].tobytes() == body.law.tobytes()
    heat._slip(force + 1.0, np.concatenate((CLOSED + [0.0, 0.02, 0.0], CLOSED)))
    heat.reset([0], [body], waiting=(0, 1))
    assert heat._laws[0].tobytes() == body.law.tobytes()
