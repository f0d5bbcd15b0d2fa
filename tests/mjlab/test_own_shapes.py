"""Mjlab-Lift-Cube-Yam with a cube that is hollow, a mesh: worlds on a device feel it in its own shape."""

# this package is installed in the environment of make test-mjlab alone
# pyright: reportMissingImports=false, reportAttributeAccessIssue=false

from __future__ import annotations

import logging
from typing import Any

import mujoco
import numpy as np
import pytest
import trimesh

pytest.importorskip("mjlab", reason="mjlab is not installed: make test-mjlab installs it")

import mjlab.tasks  # noqa: F401
import torch
from mjlab.entity import EntityCfg
from mjlab.envs import ManagerBasedRlEnv
from mjlab.tasks.registry import load_env_cfg

from thermograsp.mjlab import ThermalTouchCfg

from .test_lift_cube import FINGERTIPS, WORLDS, place

WALL = 6e-4  # m


def hollow() -> mujoco.MjSpec:
    """A cube of 40 mm with walls that thin."""
    outside, inside = (trimesh.creation.box((side,) * 3) for side in (0.04, 0.04 - 2 * WALL))
    inside.invert()
    both = trimesh.util.concatenate([outside, inside])
    spec = mujoco.MjSpec()
    spec.add_mesh(
        name="hollow", uservert=both.vertices.ravel().tolist(), userface=both.faces.ravel().tolist()
    )
    body = spec.worldbody.add_body(name="cube")
    body.add_freejoint(name="cube_joint")
    body.add_geom(name="cube_geom", type=mujoco.mjtGeom.mjGEOM_MESH, meshname="hollow", mass=0.05)
    return spec


def felt(spec: Any) -> np.ndarray:
    """(steps, worlds, fingertips) K of a second's grasp of ceramic."""
    cfg = load_env_cfg("Mjlab-Lift-Cube-Yam")
    cfg.scene.num_envs, cfg.seed = WORLDS, 1
    cfg.scene.sensors += (
        ThermalTouchCfg("touch", fingertips=FINGERTIPS, objects={"cube/cube": ("ceramic", "wood")}),
    )
    if spec is not None:
        cfg.scene.entities["cube"] = EntityCfg(spec_fn=spec)
    env = ManagerBasedRlEnv(cfg, device="cpu")
    env.reset()
    touch, found = env.scene["touch"], []
    action = torch.zeros(WORLDS, env.action_manager.total_action_dim)
    for step in range(60):
        action[:, -1] = 0.25 if step < 10 else -1.0
        place(env)
        env.step(action)
        found.append(touch.data.temperature_drop.numpy().copy())
    env.close()
    return np.array(found)


def test_a_hollow_cube_is_felt_as_one(caplog: pytest.LogCaptureFixture) -> None:
    """Its wall has cooled through after a second."""
    with caplog.at_level(logging.WARNING, "thermograsp"):
        solid, thin = felt(None), felt(hollow)
    assert not caplog.records
    assert np.isfinite(thin).all() and solid[-1].min() > 0.5
    assert 0.6 * solid[-1].min() < thin[-1].max() < 0.85 * solid[-1].min()
