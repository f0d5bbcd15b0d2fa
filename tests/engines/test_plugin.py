"""Heat inside MuJoCo's step where other packages take the steps: the plugin's state is that of a plain loop."""

# pyright: reportMissingImports=false, reportAttributeAccessIssue=false

import os
import shutil

import mujoco
import numpy as np
import pytest

from thermograsp.touch import install

pytestmark = pytest.mark.skipif(
    shutil.which(os.environ.get("CC", "cc")) is None, reason="needs a C compiler to build the plugin"
)
STEPS = 200
SCENE = """
<mujoco><option timestep=".002"/><worldbody>
  <light pos="0 0 1"/>
  <body name="block"><geom name="block" type="box" size=".02 .02 .02"/></body>
  <body name="tip" pos="0 0 .03"><joint name="tip" type="slide" axis="0 0 -1" damping="20"/>
    <geom name="tip" type="box" size=".01 .01 .004" mass=".1"/></body>
</worldbody><actuator><motor joint="tip" ctrlrange="-20 20"/></actuator></mujoco>"""


@pytest.fixture(scope="module")
def xml() -> str:
    """A fingertip that is pressed on a block, with heat in the model."""
    spec = mujoco.MjSpec.from_string(SCENE)
    install(spec, fingertips={"tip": "tip"}, objects={"block": "aluminium"})
    return spec.to_xml()


@pytest.fixture(scope="module")
def plain(xml: str) -> mujoco.MjData:
    """After a plain loop."""
    model = mujoco.MjModel.from_xml_string(xml)
    data = mujoco.MjData(model)
    data.ctrl[:] = 10.0
    mujoco.mj_step(model, data, STEPS)
    mujoco.mj_forward(model, data)
    assert abs(data.sensor("heat").data[0]) > 1e-4
    return data


def test_dm_control(xml: str, plain: mujoco.MjData) -> None:
    dm_mujoco = pytest.importorskip("dm_control.mujoco")
    physics = dm_mujoco.Physics.from_xml_string(xml)
    physics.set_control(10.0)
    for _ in range(STEPS):
        physics.step()
    assert np.array_equal(physics.data.ptr.plugin_state, plain.plugin_state)
    assert np.array_equal(physics.named.data.sensordata["heat"], plain.sensor("heat").data)
    physics.reset()
    assert not physics.named.data.sensordata["heat"].any()


def test_robosuite(xml: str, plain: mujoco.MjData) -> None:
    binding = pytest.importorskip("robosuite.utils.binding_utils")
    sim = binding.MjSim.from_xml_string(xml)
    sim.data.ctrl[:] = 10.0
    for _ in range(STEPS):
        sim.step()
    sim.forward()
    assert np.array_equal(sim.data._data.plugin_state, plain.plugin_state)
    assert np.array_equal(sim.data.get_sensor("heat"), plain.sensor("heat").data[0])


def test_a_renderer_changes_nothing(xml: str, plain: mujoco.MjData) -> None:
    try:
        renderer = mujoco.Renderer(plain.model, 48, 64)
    except (RuntimeError, ImportError, AttributeError, mujoco.FatalError) as error:
        pytest.skip(f"no OpenGL here: {error}")
    before = plain.plugin_state.copy()
    with renderer:
        renderer.update_scene(plain)
        assert renderer.render().any()
    assert np.array_equal(plain.plugin_state, before)
