"""Many worlds of one scene, from recorded contact sensors."""

# mujoco ships no type stubs for its compiled names
# pyright: reportAttributeAccessIssue=false

import importlib.util
import pickle
from pathlib import Path

import mujoco
import numpy as np
import pytest

from thermograsp.errors import InvalidValueError, MissingDependencyError, UnknownNameError
from thermograsp.touch import ThermalBody, ThermalTouch, prepare

from .engine_scene import NEEDS_RECORDS

_spec = importlib.util.spec_from_file_location("hand", Path(__file__).with_name("hand.py"))
assert _spec and _spec.loader
hand = importlib.util.module_from_spec(_spec)
_spec.loader.exec_module(hand)

PADS = {name: f"{name}_pad" for name in hand.FINGERS}
OBJECTS = {"can": "aluminium"}
FORCES = (10.0, 4.0, -5.0)


@pytest.fixture(scope="module")
def model() -> mujoco.MjModel:
    if not hasattr(mujoco.mjtSensor, "mjSENS_CONTACT"):
        pytest.skip("this MuJoCo has no contact sensors")
    return prepare(mujoco.MjSpec.from_string(hand.scene()), PADS, OBJECTS)


@pytest.fixture(scope="module")
def record(model: mujoco.MjModel) -> np.ndarray:
    """(worlds, 400 substeps, sensordata) of hands that press with FORCES."""
    found = np.empty((len(FORCES), 400, model.nsensordata))
    for world, force in enumerate(FORCES):
        data = mujoco.MjData(model)
        hand.press(data, force)
        for step in range(found.shape[1]):
            mujoco.mj_step(model, data)
            found[world, step] = data.sensordata
    return found


def many(model: mujoco.MjModel, worlds: int, **words: object) -> ThermalTouch:
    return ThermalTouch(model, fingertips=PADS, objects=OBJECTS, worlds=worlds, **words)  # pyright: ignore


def test_one_world_gives_the_bits_of_a_row_of_many(model: mujoco.MjModel, record: np.ndarray) -> None:
    touch = many(model, len(FORCES), seed=5)
    for first in range(0, record.shape[1], 10):
        touch.update(record[:, first : first + 10])
    for world in range(len(FORCES)):
        alone = many(model, 1, seed=5 + world)
        reading = alone.update(record[world : world + 1])
        np.testing.assert_array_equal(reading.voltage[0], touch.reading.voltage[world])
        np.testing.assert_array_equal(reading.temperature_drop[0], touch.reading.temperature_drop[world])
    assert touch.reading.touching == (("can",) * 3, ("can",) * 3, ("",) * 3)
    drop = touch.reading.temperature_drop
    assert (drop[0] > drop[1]).all() and (drop[1] > 1.0).all() and not drop[2].any()
    for balance in touch.balance:  # pyright: ignore[reportGeneralTypeIssues]
        error = balance.objects.sum() + balance.air - balance.given.sum()
        assert abs(error) <= 1e-10 * np.abs(balance.given).sum()


def test_recorded_sensors_tell_what_the_simulation_does(model: mujoco.MjModel, record: np.ndarray) -> None:
    touch = ThermalTouch(model, fingertips=PADS, objects=OBJECTS, chain="ideal")
    data = mujoco.MjData(model)
    hand.press(data, FORCES[0])
    for _ in range(record.shape[1]):
        mujoco.mj_step(model, data)
        touch.update(data)
    recorded = many(model, 1, chain="ideal").update(record[:1])
    np.testing.assert_allclose(recorded.force[0], touch.reading.force, rtol=1e-3)
    np.testing.assert_allclose(recorded.temperature_drop[0], touch.reading.temperature_drop, rtol=0.01)


def test_resets_go_by_rows(model: mujoco.MjModel, record: np.ndarray) -> None:
    touch = many(model, 2, seed=0, chain="ideal")
    touch.update(record[:2, :200])
    kept = touch.reading
    touch.reset(worlds=np.array([False, True]), temperatures={"can": 60.0})
    assert touch.reading.object_temperature["can"][1] == pytest.approx(60.0)  # pyright: ignore
    assert not touch.reading.temperature_drop[1].any()
    np.testing.assert_array_equal(touch.reading.temperature_drop[0], kept.temperature_drop[0])
    touch.update(record[:2, 200:])
    unbroken = many(model, 2, seed=0, chain="ideal").update(record[:2])
    np.testing.assert_array_equal(touch.reading.temperature_drop[0], unbroken.temperature_drop[0])
    assert (touch.reading.temperature_drop[1] < 0).all()


def test_a_world_that_breaks_down_fails_alone(model: mujoco.MjModel, record: np.ndarray) -> None:
    broken = record[:2].copy()
    broken[0, 100] = np.nan
    touch = many(model, 2, seed=0)
    reading = touch.update(broken)
    assert reading.failed.tolist() == [True, False]  # pyright: ignore
    assert np.isnan(reading.voltage[0]).all() and np.isnan(reading.temperature_drop[0]).all()
    whole = many(model, 2, seed=0).update(record[:2])
    np.testing.assert_array_equal(reading.voltage[1], whole.voltage[1])
    touch.reset(worlds=[0])
    reading = touch.update(record[:2])
    assert not reading.failed.any() and np.isfinite(reading.voltage).all()  # pyright: ignore


def test_a_state_of_many_worlds_goes_on_alike(model: mujoco.MjModel, record: np.ndarray) -> None:
    touch = many(model, 3, seed=1)
    touch.update(record[:, :203])
    kept = pickle.dumps(touch.state())
    first = touch.update(record[:, 203:])
    again = many(model, 3)
    again.set_state(pickle.loads(kept))
    second = again.update(record[:, 203:])
    np.testing.assert_array_equal(first.voltage, second.voltage)
    with pytest.raises(InvalidValueError, match="worlds"):
        many(model, 2).set_state(pickle.loads(kept))


@pytest.mark.parametrize("kind", [complex, str, object])
def test_a_record_of_no_real_numbers_is_refused(
    model: mujoco.MjModel, record: np.ndarray, kind: type
) -> None:
    with pytest.raises(InvalidValueError, match="real numbers"):
        many(model, 3).update(record[:, :1].astype(kind))


def test_what_does_not_fit_is_refused(model: mujoco.MjModel, record: np.ndarray) -> None:
    bare, data = hand.hand()
    with pytest.raises(InvalidValueError, match="prepare"):
        many(bare, 2)
    with pytest.raises(InvalidValueError, match="MjData"):
        many(model, 2).update(data)
    with pytest.raises(InvalidValueError, match="shape"):
        many(model, 2).update(record)
    with pytest.raises(InvalidValueError, match="worlds"):
        many(model, 2).reset(worlds=[2])
    with pytest.raises(InvalidValueError, match="worlds"):
        many(model, 0)
    with pytest.raises(InvalidValueError, match="worlds=n"):
        ThermalTouch(bare, fingertips=PADS, objects=OBJECTS).update(record)


def test_rows_of_different_lengths_are_refused(model: mujoco.MjModel, record: np.ndarray) -> None:
    ragged = [record[0, 0], record[1, 0, :-1], record[2, 0]]
    with pytest.raises(InvalidValueError, match="real numbers"):
        many(model, 3).update(ragged)  # pyright: ignore[reportArgumentType]


def test_sensors_are_added_once_and_to_a_spec(model: mujoco.MjModel) -> None:
    spec = mujoco.MjSpec.from_string(hand.scene())
    prepare(spec, PADS, OBJECTS)
    with pytest.raises(InvalidValueError, match="already"):
        prepare(spec, PADS, OBJECTS)
    with pytest.raises(InvalidValueError, match="MjSpec, got MjModel"):
        prepare(model, PADS, OBJECTS)  # pyright: ignore[reportArgumentType]


@NEEDS_RECORDS
def test_sensors_that_are_off_are_told_of() -> None:
    """Their numbers are 0, as if nothing were touched."""
    spec = mujoco.MjSpec.from_string(hand.scene())
    spec.option.disableflags |= mujoco.mjtDisableBit.mjDSBL_SENSOR
    model = prepare(spec, PADS, OBJECTS)
    with pytest.raises(InvalidValueError, match="the model disables its sensors.*flag sensor"):
        many(model, 2)
    ThermalTouch(model, fingertips=PADS, objects=OBJECTS)


def test_a_mujoco_without_contact_sensors_is_told(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("thermograsp.touch.contacts.sensors._SENSOR", None)
    with pytest.raises(MissingDependencyError, match=r"need MuJoCo 3\.3\.5"):
        prepare(mujoco.MjSpec.from_string(hand.scene()), PADS, OBJECTS)


def test_worlds_have_materials_and_temperatures_of_their_own(
    model: mujoco.MjModel, record: np.ndarray
) -> None:
    made = ["aluminium", ThermalBody("wood", temperature=5.0), "glass"]
    record = record[[0, 0, 1]]
    touch = ThermalTouch(model, fingertips=PADS, objects={"can": made}, worlds=3, seed=5)
    first = touch.update(record[:, :200])
    assert first.object_temperature["can"][1] < 10.0  # pyright: ignore[reportIndexIssue]
    touch.reset(
        worlds=[0, 2], objects={"can": ["glass", "wood"]}, temperatures={"can": np.array([60.0, 5.0])}
    )
    # from then on, also where a reset says nothing of it
    touch.reset(worlds=[2], seed=9)
    second = touch.update(record[:, 200:])
    for world, one in enumerate(made):
        alone = ThermalTouch(model, fingertips=PADS, objects={"can": one}, worlds=1, seed=5 + world)
        reading = alone.update(record[world : world + 1, :200])
        np.testing.assert_array_equal(reading.voltage[0], first.voltage[world])
        if world == 0:
            alone.reset(objects={"can": "glass"}, temperatures={"can": 60.0})
        elif world == 2:
            alone.reset(objects={"can": "wood"}, temperatures={"can": 5.0})
            alone.reset(seed=9 + 2)
        reading = alone.update(record[world : world + 1, 200:])
        np.testing.assert_array_equal(reading.voltage[0], second.voltage[world])
        np.testing.assert_array_equal(reading.temperature_drop[0], second.temperature_drop[world])
    kept = pickle.loads(pickle.dumps(touch.state()))
    again = many(model, 3)
    again.set_state(kept)
    np.testing.assert_array_equal(again.update(record).voltage, touch.update(record).voltage)
    for balance in touch.balance:  # pyright: ignore[reportGeneralTypeIssues]
        error = balance.objects.sum() + balance.air - balance.given.sum()
        assert abs(error) <= 1e-10 * np.abs(balance.given).sum()


@pytest.mark.parametrize(
    ("objects", "error", "said"),
    [
        ({"can": ["wood", "glass"]}, InvalidValueError, "3 worlds, got 2"),
        ({"can": []}, InvalidValueError, "got 0|empty"),
        ({"can": ["wood", 1.0, "glass"]}, InvalidValueError, "got 1.0"),
        ({"cann": "wood"}, UnknownNameError, "can"),
    ],
)
def test_materials_that_do_not_fit_are_refused(
    model: mujoco.MjModel, objects: dict, error: type[Exception], said: str
) -> None:
    touch = many(model, 3, seed=1)
    kept = pickle.dumps(touch.state())
    with pytest.raises(error, match=said):
        ThermalTouch(model, fingertips=PADS, objects=objects, worlds=3)
    with pytest.raises(error, match=said):
        touch.reset(objects=objects, seed=3)
    assert pickle.dumps(touch.state()) == kept


def test_one_world_changes_its_objects_at_a_reset() -> None:
    model, data = hand.hand()
    touch = ThermalTouch(model, fingertips=PADS, objects={"can": "wood"}, chain="ideal")
    drops = []
    for objects in ({}, {"can": "aluminium"}):
        mujoco.mj_resetData(model, data)
        touch.reset(data, objects=objects)
        hand.press(data, 10.0)
        for _ in range(500):
            mujoco.mj_step(model, data)
            touch.update(data)
        drops.append(touch.reading.temperature_drop[0])
    fresh = ThermalTouch(model, fingertips=PADS, objects={"can": "aluminium"}, chain="ideal")
    mujoco.mj_resetData(model, data)
    hand.press(data, 10.0)
    for _ in range(500):
        mujoco.mj_step(model, data)
        fresh.update(data)
    assert drops[1] == fresh.reading.temperature_drop[0] > drops[0] + 1.0
