"""Rods and balls between the fingers of an environment beside ThermalTouch on the same bodies."""

# mujoco ships no type stubs for its compiled names
# pyright: reportAttributeAccessIssue=false

from __future__ import annotations

from typing import Any

import mujoco
import numpy as np
import pytest
import trimesh

from thermograsp import Fingertip, ThermalTouch
from thermograsp.envs import GraspBatch, GraspTask, ObjectSpec, action_of

ENDLESS = GraspTask(hold_seconds=1e3, seconds=1e3)
FORCE, SECONDS = 8.0, 2.0


def environment(name: str, skin: str | None, spec: ObjectSpec, **more: Any) -> float:
    """K of drop that long after the touch."""
    batch = GraspBatch(
        1, material=name, task=ENDLESS, objects=spec, placement=(0.0, 0.0), skin=skin, air=0.0, **more
    )
    batch.reset([0], [np.random.default_rng(0)])
    drops = [0.0]
    while np.count_nonzero(drops) < SECONDS / batch.dt:
        step = batch.step(action_of(0.0, FORCE, 0.0)[None])
        drops.append(float(step.info(0)["temperature_drop"][0]))
    return drops[-1]


def touch(name: str, skin: str | None, spec: ObjectSpec) -> float:
    kinds, (radius, length) = mujoco.mjtGeom, (spec.size[0] / 2, spec.size[2])
    scene = mujoco.MjSpec()
    scene.option.gravity = [0, 0, 0]
    thing = scene.worldbody.add_body(name="thing")
    kind = kinds.mjGEOM_SPHERE if spec.shape == "sphere" else kinds.mjGEOM_CYLINDER
    thing.add_geom(type=kind, size=[radius, length / 2, 0])
    for way, tip in ((1, "right"), (-1, "left")):
        body = scene.worldbody.add_body(name=tip, pos=[way * (radius + 0.0041), 0, 0])
        body.add_joint(name=tip, type=mujoco.mjtJoint.mjJNT_SLIDE, axis=[-way, 0, 0], damping=20)
        body.add_geom(
            name=tip, type=kinds.mjGEOM_BOX, size=[0.004, 0.01, 0.01], mass=0.05, friction=[0, 0, 0]
        )
        scene.add_actuator(target=tip, trntype=mujoco.mjtTrn.mjTRN_JOINT)
    model = scene.compile()
    data = mujoco.MjData(model)
    tips = {tip: Fingertip(tip, skin=skin) for tip in ("right", "left")}
    touched = ThermalTouch(model, fingertips=tips, objects={"thing": name}, air=0.0, chain="ideal")
    data.ctrl[:] = FORCE
    began = None
    while began is None or data.time < began + SECONDS:
        mujoco.mj_step(model, data)
        touched.update(data)
        if began is None and touched.reading.force[0] > 0:
            began = data.time
    return float(touched.reading.temperature_drop[0])


@pytest.mark.parametrize("skin", [None, "filled_silicone"])
@pytest.mark.parametrize("name", ["aluminium", "glass"])
@pytest.mark.parametrize("broad", [0.012, 0.03])
def test_a_rod_is_felt_as_under_thermal_touch(broad: float, name: str, skin: str | None) -> None:
    """As its plate: within .35 K of 12. A square of the strip's area was up to 2.7 K off."""
    rod = ObjectSpec(shape="cylinder", size=(broad, broad, 0.05))
    assert environment(name, skin, rod) == pytest.approx(touch(name, skin, rod), abs=0.35)


@pytest.mark.parametrize("skin", [None, "filled_silicone"])
def test_a_ball_is_felt_as_under_thermal_touch(skin: str | None) -> None:
    ball = ObjectSpec(shape="sphere", size=(0.04, 0.04, 0.04))
    assert environment("aluminium", skin, ball) == pytest.approx(touch("aluminium", skin, ball), abs=0.35)


@pytest.mark.parametrize("skin", [None, "filled_silicone"])
def test_a_rod_s_mesh_is_felt_as_the_rod_touched_anywhere(skin: str | None, tmp_path: Any) -> None:
    trimesh.creation.cylinder(0.015, 0.05, sections=96).export(tmp_path / "rod.stl")
    rod = ObjectSpec(shape="cylinder", size=(0.03, 0.03, 0.05))
    mesh = ObjectSpec(shape="mesh", mesh=str(tmp_path / "rod.stl"), size=(0.03, 0.03, 0.05))
    found = environment("aluminium", skin, mesh, anywhere=True)
    assert found == pytest.approx(environment("aluminium", skin, rod, anywhere=True), abs=0.12)
    assert found == pytest.approx(environment("aluminium", skin, mesh), abs=0.3)
