"""Heat inside MuJoCo's step is the same in whatever way steps are taken: threads, batches, states, copies, files."""

# mujoco ships no type stubs for its compiled names
# pyright: reportAttributeAccessIssue=false

import copy
import ctypes
import os
import shutil
import subprocess
import sys
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

import mujoco
import mujoco.rollout
import numpy as np
import pytest

from thermograsp.errors import InvalidValueError
from thermograsp.touch import install, load_plugin

from . import hand
from .engine_scene import (
    BOXED,
    EVERYTHING,
    FULL,
    NEEDS_COMPILER,
    NEEDS_SPECS,
    OBJECTS,
    ORDERS,
    TIER,
    installed,
    order,
    orders,
    states,
    voltages,
)
from .hand import PADS

pytestmark = NEEDS_COMPILER


@pytest.fixture(scope="module")
def model() -> mujoco.MjModel:
    return installed()


def test_threads_of_rollout_do_as_one_does(model: mujoco.MjModel) -> None:
    data = mujoco.MjData(model)
    start, controls = states(model, data), np.stack([orders(60) * s for s in (1.0, 0.8, 0.6, 0.9)])
    starts, runs = np.tile(start, (4, 1)), []
    for threads in (1, 3):
        rooms = [mujoco.MjData(model) for _ in range(threads)]
        ends, voltages_read = map(np.asarray, mujoco.rollout.rollout(model, rooms, starts, controls))
        runs.append((ends, voltages_read))
    for one, other in zip(*runs, strict=True):
        assert np.array_equal(one, other)
    assert np.abs(runs[0][1][:, -1]).max() > 1e-4
    for row in controls[0]:
        data.ctrl[:] = row
        mujoco.mj_step(model, data)
    assert np.array_equal(states(model, data), runs[0][0][0, -1])


def test_a_batch_does_as_steps_do(model: mujoco.MjModel) -> None:
    batch = pytest.importorskip("mujoco.batch", reason="mujoco.batch exists from MuJoCo 4.0 on")
    many = batch.Batch(model, nsim=3, nthread=2)
    data = mujoco.MjData(model)
    controls, voltages_read = np.asarray(many.bind("ctrl")), np.asarray(many.bind("sensordata"))
    for row in orders(40):
        controls[:], data.ctrl[:] = row, row
        many.step()
        mujoco.mj_step(model, data)
    assert np.abs(data.sensordata).max() > 1e-4
    assert (voltages_read == data.sensordata).all()


def test_worlds_of_a_batch_that_touch_elsewhere_do_as_alone(model: mujoco.MjModel) -> None:
    """One thread steps all of them with one mjData, whose networks change at each turn."""
    batch = pytest.importorskip("mujoco.batch", reason="mujoco.batch exists from MuJoCo 4.0 on")
    shifts, substeps = (0.0, 1.0, -1.0, 0.6), 5
    many = batch.Batch(model, len(shifts), 1)
    alone = [mujoco.MjData(model) for _ in shifts]
    controls, voltages_read = np.asarray(many.bind("ctrl")), np.asarray(many.bind("sensordata"))
    for row in orders(60)[::substeps]:
        for world, (shift, data) in enumerate(zip(shifts, alone, strict=True)):
            controls[world] = data.ctrl[:] = (*row[:3], shift * row[3], shift * row[4])
            mujoco.mj_step(model, data, substeps)
        many.step(nstep=substeps)
    assert np.array_equal(voltages_read, [data.sensordata for data in alone])
    assert len(np.unique(voltages_read, axis=0)) == len(shifts)


def test_worlds_of_a_batch_keep_their_networks(model: mujoco.MjModel) -> None:
    """Made anew at each turn they would take several times as long as the steps themselves."""
    batch = pytest.importorskip("mujoco.batch", reason="mujoco.batch exists from MuJoCo 4.0 on")
    made = ctypes.c_ulong.in_dll(ctypes.CDLL(str(load_plugin())), "heat_networks_made")
    many = batch.Batch(model, nsim=8, nthread=1)
    places = np.linspace(-0.015, 0.015, 8)[:, None]
    many.bind("ctrl")[:] = np.hstack([np.full((8, 3), 10.0), places, 0.0 * places])
    before = made.value
    many.step(nstep=300)
    for _ in range(3):
        many.step(nstep=5)
    first = made.value
    for _ in range(50):
        many.step(nstep=5)
    assert first >= before + 8 and made.value <= first + 2


def test_a_state_that_comes_back_goes_on_alike(model: mujoco.MjModel) -> None:
    first = mujoco.MjData(model)
    for row in orders(60):
        first.ctrl[:] = row
        mujoco.mj_step(model, first)
    kind = mujoco.mjtState.mjSTATE_INTEGRATION
    saved, second, third = states(model, first, kind), mujoco.MjData(model), copy.copy(first)
    mujoco.mj_setState(model, second, saved, kind)
    for data in (first, second, third):
        for row in orders(30):
            data.ctrl[:] = row
            mujoco.mj_step(model, data)
    assert np.array_equal(states(model, first), states(model, second))
    assert np.array_equal(states(model, first), states(model, third))
    mujoco.mj_resetData(model, first)
    assert not voltages(model, first).any()
    assert np.array_equal(first.plugin_state, mujoco.MjData(model).plugin_state)


@NEEDS_SPECS
def test_what_is_behind_elements_is_in_the_state_too() -> None:
    model = install(mujoco.MjSpec.from_string(BOXED), **EVERYTHING)
    first, kind = mujoco.MjData(model), mujoco.mjtState.mjSTATE_INTEGRATION
    start, begun, controls = states(model, first), voltages(model, first), orders(40)
    for row in controls[:100]:
        first.ctrl[:] = row
        mujoco.mj_step(model, first)
    saved, second, third = states(model, first, kind), mujoco.MjData(model), copy.copy(first)
    mujoco.mj_setState(model, second, saved, kind)
    for data in (first, second, third):
        for row in controls[100:]:
            data.ctrl[:] = row
            mujoco.mj_step(model, data)
    assert np.array_equal(states(model, first), states(model, second))
    assert np.array_equal(states(model, first), states(model, third))
    rooms = [mujoco.MjData(model) for _ in range(8)]
    ends, _ = mujoco.rollout.rollout(model, rooms, np.tile(start, (16, 1)), np.tile(controls, (16, 1, 1)))
    assert all(np.array_equal(end, states(model, first)) for end in np.asarray(ends)[:, -1])
    assert begun.any() and np.abs(voltages(model, first) - begun).max() > 1e-4
    mujoco.mj_resetData(model, first)
    assert np.array_equal(first.plugin_state, mujoco.MjData(model).plugin_state)
    assert np.array_equal(voltages(model, first), begun)


def test_the_model_is_written_and_read_again(model: mujoco.MjModel, tmp_path: Path) -> None:
    spec = mujoco.MjSpec.from_string(hand.scene())
    install(spec, fingertips=PADS, objects=OBJECTS)
    again = mujoco.MjModel.from_xml_string(spec.to_xml())
    mujoco.mj_saveModel(model, str(tmp_path / "hand.mjb"), None)
    binary = mujoco.MjModel.from_binary_path(str(tmp_path / "hand.mjb"))
    ends = []
    for one in (again, binary):
        data = mujoco.MjData(one)
        hand.press(data, 10.0)
        mujoco.mj_step(one, data, 200)
        ends.append(voltages(one, data))
    assert np.abs(ends[0]).min() > 1e-4
    # XML keeps six digits: the pads end micrometres apart, and heat spreads the worse the nearer an edge of a face is
    assert np.allclose(ends[0], ends[1], rtol=5e-4)


@NEEDS_SPECS
def test_a_second_sensor_needs_another_name() -> None:
    spec = mujoco.MjSpec.from_string(hand.scene())
    install(spec, fingertips=PADS, objects=OBJECTS)
    for name in ("heat", "", 3):
        with pytest.raises(InvalidValueError, match="name"):
            install(spec, fingertips=PADS, objects=OBJECTS, name=name)  # type: ignore[arg-type]
    data = mujoco.MjData(both := install(spec, fingertips=PADS, objects=OBJECTS, name="more"))
    hand.press(data, 10.0)
    mujoco.mj_step(both, data, 200)
    assert np.array_equal(data.sensor("heat").data, data.sensor("more").data)
    assert data.sensor("heat").data.all()


@NEEDS_SPECS
def test_a_spec_compiled_again_and_models_side_by_side_do_as_one_does() -> None:
    spec, others = mujoco.MjSpec.from_string(hand.scene()), mujoco.MjSpec.from_string(hand.scene())
    models = [install(spec, fingertips=PADS, objects=OBJECTS), spec.compile()]
    models.append(install(others, fingertips={"thumb": "thumb_pad"}, objects={"can": "wood"}))
    alone, together = ([mujoco.MjData(model) for model in models] for _ in range(2))
    for data in (*alone, *together):
        hand.press(data, 10.0)
    for model, data in zip(models, alone, strict=True):
        mujoco.mj_step(model, data, 200)
    for _ in range(200):
        for model, data in zip(models, together, strict=True):
            mujoco.mj_step(model, data)
    ends = [data.sensor("heat").data for data in alone]
    assert all(
        np.array_equal(one, data.sensor("heat").data) for one, data in zip(ends, together, strict=True)
    )
    assert np.array_equal(ends[0], ends[1]) and ends[2].all() and ends[2][0] != ends[0][0]


def test_copies_in_threads_do_as_one_does(model: mujoco.MjModel) -> None:
    first = mujoco.MjData(model)
    hand.press(first, 10.0)
    mujoco.mj_step(model, first, 100)

    def run(_: int) -> np.ndarray:
        data = copy.copy(first)
        if hasattr(mujoco, "mj_copyData"):  # Python has it from some version after 3.3.7 on
            mujoco.mj_copyData(data := mujoco.MjData(model), model, first)
        again = copy.copy(data)
        mujoco.mj_step(model, again, 200)
        return states(model, again)

    with ThreadPoolExecutor(4) as threads:
        ends = list(threads.map(run, range(8)))
    mujoco.mj_step(model, first, 200)
    assert all(np.array_equal(end, states(model, first)) for end in ends)


@NEEDS_SPECS
def test_a_timestep_that_changes_later_gives_no_wrong_voltages() -> None:
    model = install(mujoco.MjSpec.from_string(hand.scene()), fingertips=PADS, objects=OBJECTS)
    data = mujoco.MjData(model)
    model.opt.timestep /= 2
    mujoco.mj_step(model, data)
    assert np.isnan(data.sensor("heat").data).all()
    with pytest.raises((ValueError, mujoco.FatalError)):
        mujoco.MjData(model)


@NEEDS_SPECS
def test_a_copy_to_a_model_of_other_materials_is_as_its_state() -> None:
    first, second = (
        install(
            mujoco.MjSpec.from_string(hand.scene()), fingertips=PADS, objects={"can": name, "ball": "glass"}
        )
        for name in ("aluminium", "wood")
    )
    data, copied, restored = mujoco.MjData(first), mujoco.MjData(second), mujoco.MjData(second)
    order(data, *ORDERS[0])
    mujoco.mj_step(first, data, 200)
    mujoco.mj_copyData(copied, second, data)
    mujoco.mj_setState(second, restored, states(first, data), FULL)
    restored.ctrl[:], restored.qacc_warmstart[:] = data.ctrl, data.qacc_warmstart
    for each in (copied, restored):
        mujoco.mj_step(second, each, 300)
    difference = copied.sensor("heat").data - restored.sensor("heat").data
    assert np.abs(difference).max() < 1e-9


@TIER
@pytest.mark.skipif(shutil.which("xvfb-run") is None, reason="needs xvfb-run, a screen for nobody")
def test_the_passive_viewer_changes_nothing(model: mujoco.MjModel, tmp_path: Path) -> None:
    mujoco.mj_saveModel(model, str(tmp_path / "hand.mjb"), None)
    code = f"""
import os
import mujoco, mujoco.viewer
import numpy as np
from thermograsp.touch import load_plugin
load_plugin()
model = mujoco.MjModel.from_binary_path({str(tmp_path / "hand.mjb")!r})
plain, shown = mujoco.MjData(model), mujoco.MjData(model)
for data in (plain, shown):
    data.ctrl[:3] = 10.0
mujoco.mj_step(model, plain, 200)
with mujoco.viewer.launch_passive(model, shown) as viewer:
    for _ in range(200):
        with viewer.lock():
            mujoco.mj_step(model, shown)
        viewer.sync()
    assert viewer.is_running()
assert plain.sensor("heat").data.any() and np.array_equal(plain.plugin_state, shown.plugin_state)
print("the same", flush=True)
os._exit(0)  # without any plugin too the viewer's thread may crash as the process ends
"""
    environment = os.environ | {"MUJOCO_GL": "glfw"}
    done = subprocess.run(
        ["xvfb-run", "-a", sys.executable, "-c", code],
        env=environment,
        capture_output=True,
        text=True,
        timeout=300,
    )
    assert done.returncode == 0 and done.stdout.strip() == "the same", done.stderr
