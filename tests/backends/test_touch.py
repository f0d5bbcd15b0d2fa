"""Fingertips of ThermalTouch on fixed places: PyTorch and JAX step them as NumPy does."""

# mujoco ships no type stubs for its compiled names
# pyright: reportAttributeAccessIssue=false

from __future__ import annotations

import mujoco
import numpy as np

from thermograsp.touch import ThermalTouch

from .conftest import Kind

SCENE = """
<mujoco>
  <option timestep=".002" gravity="0 0 0"/>
  <worldbody>
    <body name="block"><geom type="box" size=".02 .02 .02"/></body>
    <body name="tip" pos="0 0 .0241">
      <joint type="slide" axis="0 0 -1" damping="20"/><geom name="pad" type="box" size=".01 .01 .004" mass=".1"/>
    </body>
  </worldbody>
</mujoco>"""


def test_fixed_places_are_numpy_s(kind: Kind) -> None:
    model = mujoco.MjModel.from_xml_string(SCENE)
    data = mujoco.MjData(model)
    touch = ThermalTouch(model, fingertips={"tip": "pad"}, objects={"block": "glass"})
    for _ in range(100):
        data.qfrc_applied[0] = 10.0
        mujoco.mj_step(model, data)
        touch.update(data)
    exact, fixed = touch.fixed_places(np.zeros(0)), touch.fixed_places(kind.float64)
    state, expected = fixed.start(3), exact.start(3)
    step, rng = kind.compiled(fixed.advance), np.random.default_rng(0)
    for _ in range(20):
        conductance = rng.uniform(0.0, 2.0, (3, 1)) * (rng.random((3, 1)) < 0.8)
        state, drop = step(state, kind.of(conductance))
        expected, right = exact.advance(expected, conductance)
        np.testing.assert_allclose(np.asarray(drop), right, rtol=0, atol=1e-10)
        assert drop.dtype == kind.float64.dtype
