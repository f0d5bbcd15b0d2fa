"""The heat of meshes flows in their own shape: beside boxes, grids that are fine at the place, and every way to ask."""

# mujoco ships no type stubs for its compiled names
# pyright: reportAttributeAccessIssue=false

from __future__ import annotations

import logging
import pickle
from typing import Any

import mujoco
import mujoco.rollout
import numpy as np
import pytest
import trimesh

from thermograsp.thermal import SurfacePatch, material, press_body, solid
from thermograsp.touch import Fingertip, ThermalTouch, prepare
from thermograsp.touch.contacts import AREA, CLOSED, CONDUCTANCE

AREA_OF_FACE = 81e-6  # m2
CUBE = trimesh.creation.box((0.04, 0.04, 0.04))
BAR = trimesh.creation.box((0.12, 0.012, 0.012))
WALL = 1e-3  # m


def tray() -> trimesh.Trimesh:
    """A box of 40 x 40 x 30 mm that is hollow: its walls are that thick."""
    outside = trimesh.creation.box((0.04, 0.04, 0.03))
    inside = trimesh.creation.box((0.04 - 2 * WALL, 0.04 - 2 * WALL, 0.03 - 2 * WALL))
    inside.invert()
    return trimesh.util.concatenate([outside, inside])


MESHES = {"cube": CUBE, "bar": BAR, "tray": tray()}


def spec(geom: str, high: float, tips: int = 1) -> mujoco.MjSpec:
    """A thing and a fingertip above it, or another one below it."""
    assets = "".join(
        f'<mesh name="{name}" vertex="{" ".join(f"{x:.9g}" for x in mesh.vertices.ravel())}" '
        f'face="{" ".join(map(str, mesh.faces.ravel()))}"/>'
        for name, mesh in MESHES.items()
    )
    ways = ("tip", 1), ("other", -1)
    fingers = "".join(
        f"""<body name="{name}" pos="0 0 {way * (high + 0.0045)}">
          <joint name="{name}" type="slide" axis="0 0 {-way}" damping="100"/>
          <joint name="{name}_aside" type="slide" axis="1 0 0" damping="20"/>
          <geom name="{name}" type="box" size=".01 .01 .004" mass=".05" friction="0"/></body>"""
        for name, way in ways[:tips]
    )
    drives = "".join(
        f'<motor joint="{name}"/><position joint="{name}_aside" kp="500"/>' for name, _ in ways[:tips]
    )
    return mujoco.MjSpec.from_string(f"""
      <mujoco><option timestep=".002" gravity="0 0 0"/><asset>{assets}</asset><worldbody>
      <body name="thing"><geom name="thing" {geom} friction="0"/></body>{fingers}
      </worldbody><actuator>{drives}</actuator></mujoco>""")


def mesh(name: str) -> str:
    return f'type="mesh" mesh="{name}"'


def touch_of(model: mujoco.MjModel, made_of: Any = "steel", tips: int = 1, **words: Any) -> ThermalTouch:
    pads = {name: name for name in ("tip", "other")[:tips]}
    words = {"fingertips": pads, "objects": {"thing": made_of}, "chain": "ideal", "air": 0.0, **words}
    return ThermalTouch(model, **words)


def felt(touch: ThermalTouch, data: mujoco.MjData, seconds: float, *orders: float) -> np.ndarray:
    """(readings, F) K after every 20 ms under those forces N and places m aside."""
    data.ctrl[:] = orders
    found = []
    for n in range(round(seconds / 0.002)):
        mujoco.mj_step(touch.model, data)
        reading = touch.update(data)
        if n % 10 == 9:
            found.append(reading.temperature_drop)
    return np.array(found)


@pytest.mark.parametrize("name", ["aluminium", "wood"])
def test_a_mesh_of_a_cube_is_felt_as_the_box(name: str) -> None:
    """Held, let go, elsewhere and back."""
    moves = (1.0, 10.0, 0.0), (0.4, -2.0, 0.006), (0.6, 10.0, 0.006), (0.4, -2.0, 0.0), (0.6, 20.0, 0.0)
    both = []
    for geom in (mesh("cube"), 'type="box" size=".02 .02 .02"'):
        model = spec(geom, 0.02).compile()
        touch, data = touch_of(model, name), mujoco.MjData(model)
        both.append(np.concatenate([felt(touch, data, *move) for move in moves]))
    assert np.abs(both[0]).max() > 0.8
    np.testing.assert_allclose(both[0], both[1], atol=0.03)


def noted(touch: ThermalTouch) -> list[float]:
    """From now on has the tip's W/(m2 K) of every sample."""
    found, advance = [], touch._heat.advance

    def noting(touches: np.ndarray, substeps: int) -> None:
        found.append(touches[0, 0, 0, CONDUCTANCE] / substeps / AREA_OF_FACE)
        assert touches[0, 0, 0, AREA] == pytest.approx(touches[0, 0, 0, CLOSED] * AREA_OF_FACE)
        advance(touches, substeps)

    touch._heat.advance, touch._heat.hearing = noting, lambda touches: (0, 0)  # pyright: ignore
    return found


@pytest.mark.parametrize("name", ["aluminium", "ceramic", "wood"])
def test_thin_walls_are_felt_as_by_a_grid_that_is_fine_there(name: str) -> None:
    """Which shares neither the network's states nor its kernels, and takes the conductances that were recorded."""
    model = spec(mesh("tray"), 0.015).compile()
    touch, data = touch_of(model, name), mujoco.MjData(model)
    through = noted(touch)
    drops = felt(touch, data, 4.0, 10.0, 0.0)[:, 0]
    hollow = MESHES["tray"]
    body = solid(np.asarray(hollow.vertices), np.asarray(hollow.faces), material(name))
    patch = SurfacePatch((0.0, 0.0, 0.015), (0.0, 0.0, 1.0), AREA_OF_FACE)
    expected = press_body(
        body,
        patch,
        conductance=lambda t: np.array(through)[np.minimum(np.asarray(t) / 0.01, 399).astype(int)],
        seconds=4.0,
        dt=0.01,
        tolerance=0.05,
    ).temperature_drop
    known = np.asarray(expected)[2::2]
    print(np.abs(drops - known)[[1,2,4,9,14,24,49,99,198]], drops[[4,14,49,198]])
    np.testing.assert_allclose(drops[2:], known[2:], atol=0.05)
