"""Heat in a scene of somebody else's: three fingers, a can and a ball."""

# mujoco ships no type stubs for its compiled names
# pyright: reportAttributeAccessIssue=false

import pickle

import mujoco
import numpy as np
import pytest

from thermograsp.errors import InvalidValueError, UnknownNameError
from thermograsp.thermal import (
    Thermostat,
)
from thermograsp.thermal.stack import heated_stack
from thermograsp.touch import Fingertip, ThermalBody, ThermalTouch

from . import hand
from .hand import ONE_PRESS, PADS, make, run


def test_a_heated_fingertip_beside_others_is_remembered_and_reset() -> None:
    model, data = hand.hand()
    tips = {name: Fingertip(pad) for name, pad in PADS.items()}
    first = next(iter(tips))
    tips[first] = Fingertip(PADS[first], sensor="heated_thermistor")
    one, two = (
        ThermalTouch(model, fingertips=tips, objects={"can": "aluminium"}, chain="ideal", seed=1)
        for _ in range(2)
    )
    warm = one.reading.voltage[0, -1]
    assert heated_stack("heated_thermistor").divider.temperature(warm) == pytest.approx(36.0, abs=0.01)
    assert (one.reading.voltage[1:] == 0).all()
    hand.press(data, 10.0)
    run(model, data, one, 0.5)
    two.set_state(pickle.loads(pickle.dumps(one.state())))
    for _ in range(100):
        mujoco.mj_step(model, data)
        both = one.update(data), two.update(data)
        assert (both[0].voltage == both[1].voltage).all()
    assert one.reading.voltage[0, -1] != warm and (one.reading.voltage[1:, -1] > 1e-3).all()
    given, balance = one.balance.given.sum(), one.balance
    assert abs(balance.objects.sum() + balance.air - given) < 1e-10 * np.abs(balance.given).sum()
    assert one.reset().voltage[0, -1] == warm


def test_three_fingers_share_one_can_and_heat_is_balanced() -> None:
    model, data = hand.hand()
    touch = make(model, {"can": "aluminium", "ball": ThermalBody("wood", temperature=5.0)})
    hand.press(data, 10.0)
    run(model, data, touch, 1.5)
    reading, balance = touch.reading, touch.balance
    assert reading.touching == ("can", "can", "can")
    np.testing.assert_allclose(reading.temperature_drop, reading.temperature_drop.mean(), rtol=0.02)
    given = balance.given.sum()
    assert given > 1.0
    assert abs(balance.objects.sum() + balance.air - given) < 1e-10 * np.abs(balance.given).sum()
    # an object that nothing touches is warmed by the air alone
    assert balance.given[:, 1].tolist() == [0.0, 0.0, 0.0]
    assert reading.object_temperature["ball"] > 5.0


def test_a_finger_that_goes_from_one_object_to_another_keeps_its_cold() -> None:
    model, data = hand.hand()
    touch = make(model)
    hand.press(data, 10.0)
    run(model, data, touch, 1.0)
    cold = touch.reading.temperature_drop.copy()
    hand.press(data, -5.0)
    run(model, data, touch, 0.1)
    assert touch.reading.touching == ("", "", "")
    assert (touch.reading.temperature_drop > 0.3 * cold).all()
    where = touch.reading.object_temperature["can"]
    hand.press(data, 10.0)
    run(model, data, touch, 0.3)
    assert touch.reading.object_temperature["can"] > where
    balance = touch.balance
    assert (
        abs(balance.objects.sum() + balance.air - balance.given.sum()) < 1e-10 * np.abs(balance.given).sum()
    )


def test_a_saved_state_goes_on_alike_and_can_be_pickled() -> None:
    model, data = hand.hand()
    touch = make(model, chain="ads1115", seed=3)
    hand.press(data, 10.0)
    run(model, data, touch, 0.303)
    kept, saved = touch.state(), np.empty(mujoco.mj_stateSize(model, mujoco.mjtState.mjSTATE_INTEGRATION))
    mujoco.mj_getState(model, data, saved, mujoco.mjtState.mjSTATE_INTEGRATION)
    run(model, data, touch, 0.5)
    first = touch.reading
    mujoco.mj_setState(model, data, saved, mujoco.mjtState.mjSTATE_INTEGRATION)
    touch.set_state(pickle.loads(pickle.dumps(kept)))
    run(model, data, touch, 0.5)
    np.testing.assert_array_equal(first.voltage, touch.reading.voltage)
    np.testing.assert_array_equal(first.temperature_drop, touch.reading.temperature_drop)


def test_a_reset_starts_anew_with_other_temperatures() -> None:
    model, data = hand.hand()
    touch = make(model)
    hand.press(data, 10.0)
    run(model, data, touch, 0.3)
    mujoco.mj_resetData(model, data)
    with pytest.raises(InvalidValueError, match="touch.reset"):
        touch.update(data)
    touch.reset(data, seed=0, temperatures={"can": 60.0})
    assert touch.reading.object_temperature["can"] == pytest.approx(60.0)
    assert not touch.reading.temperature_drop.any()
    hand.press(data, 10.0)
    run(model, data, touch, 0.5)
    assert (touch.reading.temperature_drop < 0).all()
    with pytest.raises(UnknownNameError, match="can"):
        touch.reset(data, temperatures={"cann": 60.0})


def test_the_scene_may_say_itself_what_its_objects_are() -> None:
    text = '<text name="thermograsp:can" data="aluminium 5.0"/>'
    model, data = hand.hand(custom=text)
    touch = ThermalTouch(model, fingertips=PADS)
    touch.update(data)
    assert touch.objects == ("can",)
    assert touch.reading.object_temperature == {"can": pytest.approx(5.0)}
    for said in ("aluminium warm", "aluminium 5 6", "aluminium shape=", "shape=can"):
        model, _ = hand.hand(custom=f'<text name="thermograsp:can" data="{said}"/>')
        with pytest.raises(InvalidValueError, match="aluminium 5.0"):
            ThermalTouch(model, fingertips=PADS)
    model, _ = hand.hand(custom='<text name="thermograsp:can" data="aluminium shape=tin"/>')
    with pytest.raises(UnknownNameError, match="tin"):
        ThermalTouch(model, fingertips=PADS)


SIDES, OF_PARTS = ("left", "right"), (("wall", None), ("toy", "seen"))


def test_what_the_scene_says_is_renamed_as_its_bodies_are_when_it_is_attached() -> None:
    if not hasattr(mujoco.MjSpec, "attach"):
        pytest.skip("this MuJoCo attaches no specs")
    whole = mujoco.MjSpec()
    for side in ("left_", "right_"):
        part = mujoco.MjSpec.from_string(
            '<mujoco><custom><text name="thermograsp:wall" data="glass 5"/>'
            '<text name="thermograsp:toy" data="wood 30 shape=seen"/></custom><worldbody>'
            '<body name="toy" pos=".2 0 0">'
            '<geom name="seen" type="box" size=".01 .01 .02" contype="0" conaffinity="0"/>'
            '<geom type="box" size=".01 .01 .01" pos="0 0 .01"/><geom type="box" size=".01 .01 .01" pos="0 0 -.01"/>'
            '</body><body name="cup">'
            '<geom name="tip" type="box" size=".01 .01 .01" pos="0 0 1"/>'
            '<geom name="wall" type="box" size=".02 .02 .02"/>'
            "</body></worldbody></mujoco>"
        )
        whole.attach(part, prefix=side, frame=whole.worldbody.add_frame())
    touch = ThermalTouch(whole.compile(), fingertips={"tip": Fingertip("left_tip")})
    assert [
        touch.reading.object_temperature[f"{side}_{name}"] for name in ("wall", "toy") for side in SIDES
    ] == [*(5.0, 5.0, 30.0, 30.0)]
    shapes = {shape.name: shape.shape_name for shape in touch._shapes}
    assert shapes == {f"{side}_{name}": seen and f"{side}_seen" for name, seen in OF_PARTS for side in SIDES}


def test_a_touch_with_the_back_of_a_finger_is_none() -> None:
    model = mujoco.MjModel.from_xml_string(ONE_PRESS.format(cone="elliptic"))
    data = mujoco.MjData(model)
    back = Fingertip("tip", position=(0.0, 0.0, 0.004), normal=(0.0, 0.0, 1.0), size=(0.02, 0.02))
    touch = ThermalTouch(model, fingertips={"tip": back}, objects={"block": "aluminium"}, chain="ideal")
    data.ctrl[0] = 10.0
    for _ in range(500):
        mujoco.mj_step(model, data)
        touch.update(data)
    assert touch.reading.force[0] == 0.0 and touch.reading.touching == ("",)
    assert touch.reading.beside[0] == pytest.approx(10.0, rel=1e-3)
    assert touch.reading.temperature_drop[0] == 0.0


def test_a_pad_that_sinks_in_deep_is_still_on_its_face() -> None:
    """A soft contact's place, half way between the two faces, is then far from the pad's."""
    model = mujoco.MjModel.from_xml_string(hand.SOFT)
    data = mujoco.MjData(model)
    touch = ThermalTouch(model, fingertips={"tip": "pad"}, objects={"ball": "glass"})
    for _ in range(500):
        mujoco.mj_step(model, data)
        touch.update(data)
    assert data.contact.dist.min() < -0.0085
    assert touch.reading.touching == ("ball",) and touch.reading.beside[0] == 0.0
    assert touch.reading.force[0] == pytest.approx(hand.SOFT_LOAD, rel=1e-3)
    assert touch.reading.temperature_drop[0] > 0.3


def test_steps_that_were_not_told_are_not_lost() -> None:
    model, data = hand.hand()
    often, seldom = make(model), make(model)
    hand.press(data, 10.0)
    for step in range(1000):
        mujoco.mj_step(model, data)
        often.update(data)
        if step % 5 == 4:
            seldom.update(data)
            seldom.update(data)
        if step == 0:
            seldom.update(data)
    assert seldom.reading.time == often.reading.time
    np.testing.assert_allclose(seldom.reading.temperature_drop, often.reading.temperature_drop, rtol=0.02)


def test_a_reset_sees_the_models_friction_cones() -> None:
    model, data = hand.hand()
    touch = make(model)
    hand.press(data, 8.0)
    run(model, data, touch, 0.4)
    before = touch.reading.force
    kinds = mujoco.mjtCone.mjCONE_PYRAMIDAL, mujoco.mjtCone.mjCONE_ELLIPTIC
    model.opt.cone = kinds[int(model.opt.cone == kinds[0])]
    touch.reset(data)
    run(model, data, touch, 0.4)
    np.testing.assert_allclose(touch.reading.force, before, rtol=0.1)


def test_a_hold_builds_no_networks_and_a_slide_few() -> None:
    model, data = hand.hand()
    touch = make(model)
    hand.press(data, 10.0)
    run(model, data, touch, 0.5)
    known = len(touch._heat._known)
    run(model, data, touch, 2.0)
    assert len(touch._heat._known) == known
    data.ctrl[model.actuator("palm_z").id] = 0.01  # the fingers carry the can along
    run(model, data, touch, 1.0)
    assert len(touch._heat._known) <= known + 12


def test_a_slide_keeps_the_balance_and_the_fingertips_cold() -> None:
    model = mujoco.MjModel.from_xml_string(
        ONE_PRESS.format(cone="elliptic").replace(
            '<geom name="block" type="box" size=".02 .02 .02"/>',
            '<joint name="along" type="slide" axis="1 0 0" damping="1"/>'
            '<geom name="block" type="box" size=".06 .02 .02" friction="0" mass="1"/>',
        )
    )
    data = mujoco.MjData(model)
    touch = ThermalTouch(model, fingertips={"tip": "tip"}, objects={"block": "wood"}, chain="ideal")
    data.ctrl[0] = 10.0
    run(model, data, touch, 1.0)
    before = touch.reading.temperature_drop[0]
    drops = []
    for _ in range(1500):
        data.joint("along").qvel[0] = 0.012  # m/s: 36 mm in all
        mujoco.mj_step(model, data)
        drops.append(touch.update(data).temperature_drop[0])
    balance = touch.balance
    error = balance.objects.sum() + balance.air - balance.given.sum()
    assert abs(error) < 1e-10 * np.abs(balance.given).sum()
    # a pad that slides meets fresh wood all the time and feels more; never a jump of more than a tenth between samples
    assert drops[-1] > before
    assert np.abs(np.diff(drops)).max() < 0.1 * before


def test_thermostats_are_remembered_and_refused_beside_a_heater() -> None:
    model, data = hand.hand()
    weak = Thermostat(power_limit=0.3, heat_capacity=1.0)
    tips = {name: Fingertip(pad, thermostat=weak) for name, pad in PADS.items()}
    one, two = (ThermalTouch(model, fingertips=tips, objects={"can": "aluminium"}, seed=1) for _ in range(2))
    hand.press(data, 10.0)
    run(model, data, one, 0.5)
    two.set_state(pickle.loads(pickle.dumps(one.state())))
    for _ in range(100):
        mujoco.mj_step(model, data)
        both = one.update(data), two.update(data)
        assert (both[0].voltage == both[1].voltage).all()
    given, balance = one.balance.given.sum(), one.balance
    assert abs(balance.objects.sum() + balance.air - given) < 1e-10 * np.abs(balance.given).sum()
    heated = Fingertip("thumb_pad", sensor="heated_thermistor", thermostat=weak)
    with pytest.raises(InvalidValueError, match="heater of its own"):
        ThermalTouch(model, fingertips={"thumb": heated}, objects={"can": "aluminium"})
