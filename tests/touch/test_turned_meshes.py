"""Pads that lie on a mesh at any angle: on its ends, its flanks and its rounded edges."""

# mujoco ships no type stubs for its compiled names
# pyright: reportAttributeAccessIssue=false

from __future__ import annotations

import math
from functools import cache

import mujoco
import numpy as np
import pytest
import trimesh

from thermograsp.touch import Fingertip, ThermalTouch
from thermograsp.touch.contacts import CONDUCTANCE

from .engine_scene import keep_boxes

FORCE = 8.0  # N
ELLIPSOID, EGG, LENS = (0.01, 0.02, 0.03), (0.02, 0.02, 0.03), (0.02, 0.02, 0.005)


@pytest.fixture(autouse=True)
def boxes(monkeypatch: pytest.MonkeyPatch) -> None:
    """Contacts alone are looked at."""
    keep_boxes(monkeypatch)


@cache
def solid(name: str) -> trimesh.Trimesh:
    if name == "cube":
        return trimesh.creation.box((0.04, 0.04, 0.04))
    if name == "capsule":
        return trimesh.creation.capsule(0.04, 0.01, count=[32, 32])
    if name.startswith("rounded"):
        radius = float(name.split()[1]) / 1e3
        corners = np.array(np.meshgrid(*[[-1, 1]] * 3)).reshape(3, -1).T * (0.02 - radius)
        ball = trimesh.creation.icosphere(3, radius).vertices
        return trimesh.convex.convex_hull((corners[:, None] + ball).reshape(-1, 3))
    if name == "ball":
        return trimesh.creation.uv_sphere(0.01)
    made = trimesh.creation.icosphere(5 if name == "fine lens" else 4)
    made.apply_scale({"ellipsoid": ELLIPSOID, "egg": EGG}.get(name, LENS))
    return made


@cache
def conducts(
    name: str, degrees: float = 0.0, axis: int = 1, aside: float | None = 0.0, geom: str = ""
) -> float:
    """W/K of a bare pad on the top of aluminium that is turned about an axis, its middle that far m aside, or where the
    top is. geom: in place of the mesh."""
    mesh, turn, quat = solid(name), np.zeros(9), np.zeros(4)
    mujoco.mju_axisAngle2Quat(quat, np.eye(3)[axis], math.radians(degrees))
    mujoco.mju_quat2Mat(turn, quat)
    points = mesh.vertices @ turn.reshape(3, 3).T
    top = points[points[:, 2].argmax()] if aside is None else [aside, 0.0, points[:, 2].max()]
    vertex, face = (" ".join(f"{x:.9g}" for x in part.ravel()) for part in (mesh.vertices, mesh.faces))
    model = mujoco.MjModel.from_xml_string(f"""
      <mujoco><option timestep=".002" gravity="0 0 0"/>
      <asset><mesh name="thing" vertex="{vertex}" face="{face}"/></asset><worldbody>
        <body name="thing" quat="{" ".join(map(str, quat))}"><geom {geom or 'type="mesh" mesh="thing"'}/></body>
        <body name="tip" pos="{top[0]} {top[1]} {top[2] + 0.0045}">
          <joint name="tip" type="slide" axis="0 0 -1" damping="20"/>
          <geom name="tip" type="box" size=".01 .01 .004" mass=".05"/></body>
      </worldbody><actuator><motor joint="tip"/></actuator></mujoco>""")
    data, touch = mujoco.MjData(model), None
    touch = ThermalTouch(
        model, fingertips={"tip": Fingertip("tip")}, objects={"thing": "aluminium"}, chain="ideal"
    )
    data.ctrl[0] = FORCE
    for _ in range(123):
        mujoco.mj_step(model, data)
        touch.update(data)
    return float(touch._reader.touches[0, 0, 0, CONDUCTANCE] / touch._reader.substeps)


@pytest.mark.parametrize("radius", [1, 3, 8])
def test_a_rounded_edge_leaves_the_face_between_flat(radius: int) -> None:
    """To where the sensor begins to leave the face; a mean of a face's and its rounding's directions made it round."""
    flat = conducts("cube")
    assert conducts(f"rounded {radius}") == pytest.approx(flat, rel=0.06)
    last = 0.02 - radius / 1e3 - 0.0045
    assert conducts(f"rounded {radius}", aside=last) == pytest.approx(conducts("cube", aside=last), rel=0.1)
    assert conducts(f"rounded {radius}", aside=last + 0.0045) < 0.8 * flat


@pytest.mark.parametrize("degrees", [0.0, 10.0])
def test_a_rounded_edge_leaves_the_face_level_to_pads_that_lean(degrees: float) -> None:
    for aside in (0.0, 0.01):
        flat = conducts("cube", degrees, aside=aside)
        assert conducts("rounded 3", degrees, aside=aside) == pytest.approx(flat, rel=0.05)


def test_the_ends_of_slender_bodies_are_felt() -> None:
    ends = [
        conducts("ellipsoid", degrees, axis, None)
        for axis, degrees in ((0, 0.0), (0, 15.0), (1, 5.0), (1, 15.0))
    ]
    exact = conducts("ellipsoid", geom='type="ellipsoid" size=".01 .02 .03"')
    assert ends == pytest.approx([exact] * len(ends), rel=0.3)
    assert conducts("ellipsoid", 90.0, 1, None) == pytest.approx(
        conducts("ellipsoid", 90.0, 1, None, 'type="ellipsoid" size=".01 .02 .03"'), rel=0.1
    )


def test_a_pad_that_goes_round_a_body_is_always_on_what_it_touches() -> None:
    """From an egg's end to its flank, on whose top the pad's middle always is."""
    around = [conducts("egg", degrees, 0, None) for degrees in range(0, 91, 10)]
    least, most = (
        conducts("egg", degrees, 0, None, 'type="ellipsoid" size=".02 .02 .03"') for degrees in (0, 90)
    )
    assert min(around) > 0.8 * least and max(around) < 1.1 * most


def test_a_round_end_is_where_it_lies() -> None:
    """A capsule's, which moves from under the pad's middle as it is turned about its own."""
    straight = conducts("capsule")
    assert straight == pytest.approx(conducts("ball", geom='type="sphere" size=".01"'), rel=0.1)
    for degrees in (5.0, 10.0, 20.0):
        gone = 0.02 * math.sin(math.radians(degrees))
        assert conducts("capsule", degrees, aside=gone) == pytest.approx(straight, rel=0.15)
        assert conducts("capsule", degrees, aside=gone - 0.009) < 0.3 * straight


def test_a_finer_mesh_of_a_lens_is_as_round() -> None:
    """On whose pole no face is like another: .065 and .052 W/K by the sphere of its mean radius there."""
    for degrees in (6.0, 12.0):
        fine, coarse = (conducts(name, degrees, 1, None) for name in ("fine lens", "lens"))
        assert fine == pytest.approx(coarse, rel=0.2)
