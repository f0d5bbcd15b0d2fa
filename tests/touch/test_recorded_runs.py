"""What mujoco.rollout and mujoco.batch record of a prepared model, beside a loop over mj_step."""

# mujoco ships no type stubs for its compiled names
# pyright: reportAttributeAccessIssue=false

import importlib
import importlib.util
from pathlib import Path
from typing import Any

import mujoco
import numpy as np
import pytest

from thermograsp.touch import ThermalTouch, prepare

_spec = importlib.util.spec_from_file_location("hand", Path(__file__).with_name("hand.py"))
assert _spec and _spec.loader
hand = importlib.util.module_from_spec(_spec)
_spec.loader.exec_module(hand)

PADS = {name: f"{name}_pad" for name in hand.FINGERS}
OBJECTS = {"can": "aluminium"}
FORCES = (10.0, 4.0)  # N of each world
STEPS, CHUNK = 400, 50


@pytest.fixture(scope="module")
def model() -> mujoco.MjModel:
    if not hasattr(mujoco.mjtSensor, "mjSENS_CONTACT"):
        pytest.skip("this MuJoCo has no contact sensors: it needs 3.3.5")
    return prepare(mujoco.MjSpec.from_string(hand.scene()), PADS, OBJECTS)


@pytest.fixture(scope="module")
def looped(model: mujoco.MjModel) -> tuple[np.ndarray, np.ndarray]:
    """Of a plain loop, (worlds, fingertips, samples) V and (worlds, fingertips) K."""
    volts, drops = [], []
    for force in FORCES:
        data = mujoco.MjData(model)
        touch = ThermalTouch(model, fingertips=PADS, objects=OBJECTS, chain="ideal")
        hand.press(data, force)
        for _ in range(STEPS):
            mujoco.mj_step(model, data)
            touch.update(data)
        volts.append(touch.reading.voltage)
        drops.append(touch.reading.temperature_drop)
    return np.array(volts), np.array(drops)


def controls(model: mujoco.MjModel) -> np.ndarray:
    """(worlds, actuators)."""
    found = []
    for force in FORCES:
        data = mujoco.MjData(model)
        hand.press(data, force)
        found.append(data.ctrl.copy())
    return np.array(found)


def agrees(touch: ThermalTouch, looped: tuple[np.ndarray, np.ndarray]) -> None:
    """A contact sensor tells the net force of a pair, at its place: the heat is that of single contacts to 1 %."""
    volts, drops = looped
    reading = touch.reading
    assert reading.time == pytest.approx(STEPS * touch.model.opt.timestep)
    assert (drops > 1.0).all() and (reading.touching == (("can",) * 3,) * 2)
    np.testing.assert_allclose(reading.temperature_drop, drops, rtol=0.01)
    np.testing.assert_allclose(reading.voltage, volts, rtol=0.01, atol=1e-5)


def test_rollout_records_what_a_loop_feels(
    model: mujoco.MjModel, looped: tuple[np.ndarray, np.ndarray]
) -> None:
    rollout: Any = importlib.import_module("mujoco.rollout")
    whole = mujoco.mjtState.mjSTATE_FULLPHYSICS
    start, data = np.empty(mujoco.mj_stateSize(model, whole)), mujoco.MjData(model)
    mujoco.mj_getState(model, data, start, whole)
    state, control = np.tile(start, (len(FORCES), 1)), controls(model)[:, None]
    touch = ThermalTouch(model, fingertips=PADS, objects=OBJECTS, worlds=len(FORCES), chain="ideal")
    for _ in range(STEPS // CHUNK):
        states, record = rollout.rollout(model, data, state, np.repeat(control, CHUNK, axis=1))
        state = states[:, -1]
        touch.update(record)
    agrees(touch, looped)


def test_batch_records_what_a_loop_feels(
    model: mujoco.MjModel, looped: tuple[np.ndarray, np.ndarray]
) -> None:
    batch = pytest.importorskip("mujoco.batch", reason="mujoco.batch needs MuJoCo 4.0")
    worlds = batch.Batch(model, len(FORCES), 1)
    worlds.bind("ctrl")[:] = controls(model)
    touch = ThermalTouch(model, fingertips=PADS, objects=OBJECTS, worlds=len(FORCES), chain="ideal")
    for _ in range(STEPS // CHUNK):
        record = worlds.rollout(nstep=CHUNK, record=("sensordata",))["sensordata"]
        touch.update(record)
    agrees(touch, looped)


@pytest.mark.parametrize("degrees", [15.0, 40.0])
@pytest.mark.parametrize(
    "tip",
    [
        'type="sphere" size=".01"',
        'type="capsule" size=".008 .012" euler="0 90 0"',
        'type="ellipsoid" size=".008 .012 .01"',
    ],
)
def test_a_round_fingertip_feels_a_slanted_face_alike_by_record(tip: str, degrees: float) -> None:
    """The face's normal, and so the force, leans from the pad's own."""
    if not hasattr(mujoco.mjtSensor, "mjSENS_CONTACT"):
        pytest.skip("this MuJoCo has no contact sensors: it needs 3.3.5")
    words: dict[str, Any] = {"fingertips": {"tip": "tip"}, "objects": {"block": "aluminium"}}
    model = prepare(
        mujoco.MjSpec.from_string(f"""
        <mujoco><option timestep=".002" gravity="0 0 0" cone="elliptic"/><worldbody>
          <body name="block" euler="{degrees} 0 0"><geom name="block" type="box" size=".05 .05 .02"/></body>
          <body name="tip" pos="0 0 .05"><joint type="slide" axis="0 0 -1" damping="20"/>
            <geom name="tip" {tip} mass=".1"/></body>
        </worldbody></mujoco>"""),
        **words,
    )
    data, record = mujoco.MjData(model), []
    looped, recorded = (ThermalTouch(model, **words, chain="ideal", worlds=worlds) for worlds in (None, 1))
    for _ in range(STEPS):
        data.qfrc_applied[0] = 8.0
        mujoco.mj_step(model, data)
        looped.update(data)
        record.append(data.sensordata.copy())
    recorded.update(np.array(record)[None])
    expected = looped.reading.temperature_drop
    assert expected[0] > 4.0
    assert recorded.reading.temperature_drop[0] == pytest.approx(expected, rel=2e-3, abs=1e-6)


@pytest.mark.parametrize("degrees", [50.0, 58.0])
def test_a_ball_is_beside_its_pad_beyond_53_degrees_by_record_too(degrees: float) -> None:
    if not hasattr(mujoco.mjtSensor, "mjSENS_CONTACT"):
        pytest.skip("this MuJoCo has no contact sensors: it needs 3.3.5")
    words: dict[str, Any] = {"fingertips": {"tip": "tip"}, "objects": {"block": "aluminium"}}
    # the block lies below the middle of the pad as the model is made, and is then turned aside
    model = prepare(
        mujoco.MjSpec.from_string("""
        <mujoco><option timestep=".002" gravity="0 0 0"/><worldbody>
          <body name="block" pos="0 0 -.028">
            <joint name="turn" type="hinge" axis="1 0 0" pos="0 0 .028" armature="1" damping="1e6"/>
            <geom name="block" type="box" size=".02 .02 .02" contype="2" conaffinity="0" mass="1"/></body>
          <body name="tip"><joint name="tip" type="slide" axis="0 0 1" armature="1e6"/>
            <geom name="tip" type="sphere" size=".0081" mass=".1" contype="0" conaffinity="2"/></body>
        </worldbody></mujoco>"""),
        **words,
    )
    data, record = mujoco.MjData(model), []
    data.joint("turn").qpos[:] = np.radians(degrees)
    looped, recorded = (ThermalTouch(model, **words, chain="ideal", worlds=worlds) for worlds in (None, 1))
    for _ in range(50):
        mujoco.mj_step(model, data)
        looped.update(data)
        record.append(data.sensordata.copy())
    recorded.update(np.array(record)[None])
    on, beside = looped.reading.force[0], looped.reading.beside[0]
    assert (on > 0.0) == (degrees < 53.0) == (not beside > 0.0) and on + beside > 0.1
    assert recorded.reading.force[0] == pytest.approx([on], rel=0.02)
    assert recorded.reading.beside[0] == pytest.approx([beside], rel=0.02)
