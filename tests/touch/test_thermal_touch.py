"""Heat in a scene of somebody else's: three fingers, a can and a ball."""

# mujoco ships no type stubs for its compiled names
# pyright: reportAttributeAccessIssue=false

import importlib.util
import pickle
from pathlib import Path
from typing import Literal

import mujoco
import numpy as np
import pytest

from thermograsp.errors import InvalidValueError, SimulationError, UnknownNameError
from thermograsp.thermal import (
    LAPPED_ALUMINA,
    SKINS,
    THERMOSTAT_FACE,
    Surface,
    Thermostat,
    contact_conductance,
    joint,
    material,
    press,
    sensor,
)
from thermograsp.thermal.contact import Pad, face_joint, flat_contact, skinned
from thermograsp.thermal.stack import heated_core, heated_stack
from thermograsp.touch import Fingertip, SensorElement, ThermalBody, ThermalTouch
from thermograsp.touch.contacts import COLUMNS, CONDUCTANCE, NORMAL, PLACE
from thermograsp.touch.heat.joined import JoinedHeat

_spec = importlib.util.spec_from_file_location("hand", Path(__file__).with_name("hand.py"))
assert _spec and _spec.loader
hand = importlib.util.module_from_spec(_spec)
_spec.loader.exec_module(hand)

PADS = {name: f"{name}_pad" for name in hand.FINGERS}


def make(model: mujoco.MjModel, objects: dict | None = None, **words: object) -> ThermalTouch:
    words = {"chain": "ideal", **words}
    return ThermalTouch(model, fingertips=PADS, objects=objects or {"can": "aluminium"}, **words)  # pyright: ignore


def run(model: mujoco.MjModel, data: mujoco.MjData, touch: ThermalTouch, seconds: float) -> None:
    for _ in range(round(seconds / model.opt.timestep)):
        mujoco.mj_step(model, data)
        touch.update(data)


ONE_PRESS = """
<mujoco>
  <option timestep=".002" gravity="0 0 0" cone="{cone}"/>
  <worldbody>
    <body name="block"><geom name="block" type="box" size=".02 .02 .02"/></body>
    <body name="tip" pos="0 0 .0241">
      <joint name="tip" type="slide" axis="0 0 -1" damping="20"/>
      <geom name="tip" type="box" size=".01 .01 .004" mass=".1"/>
    </body>
  </worldbody>
  <actuator><motor joint="tip"/></actuator>
</mujoco>"""


@pytest.mark.parametrize(
    ("name", "cone", "skin"),
    [
        ("wood", "elliptic", None),
        ("glass", "elliptic", None),
        ("glass", "pyramidal", None),
        ("stainless_steel", "elliptic", None),
        ("aluminium", "elliptic", None),
        ("aluminium", "elliptic", "filled_silicone"),
    ],
)
def test_one_fingertip_on_a_box_feels_what_a_press_does(name: str, cone: str, skin: str | None) -> None:
    model = mujoco.MjModel.from_xml_string(ONE_PRESS.format(cone=cone))
    data = mujoco.MjData(model)
    tips = {"tip": Fingertip("tip", skin=skin)}
    touch = ThermalTouch(model, fingertips=tips, objects={"block": name}, air=0.0, chain="ideal")
    data.ctrl[0] = 10.0
    drops, times, reading = [], [], touch.reading
    for _ in range(2000):
        mujoco.mj_step(model, data)
        reading = touch.update(data)
        if not times and not reading.touching[0]:
            continue
        if reading.time not in times:
            times.append(reading.time)
            drops.append(reading.temperature_drop[0])
    assert reading.force[0] == pytest.approx(10.0, rel=1e-3)
    worn = None if skin is None else SKINS[skin]
    pressure = float(flat_contact(skinned(Pad(), worn), 10.0).face_pressure)
    h = float(contact_conductance(face_joint(worn, Surface.of(material(name))), pressure))
    size = (0.04, 0.04, 0.04)
    curves = press(name, skin=skin, conductance=h, object_size=size, seconds=4.0, dt=0.02, tolerance=0.01)
    # the touch began within the first reading, at some force that is still rising
    late = np.array(times) - times[0] > 0.3
    expected = np.interp(np.array(times) - times[0] + 0.02, curves.t, curves.temperature_drop)
    assert np.abs(np.array(drops) - expected)[late].max() < 0.05 + 0.02


@pytest.mark.parametrize(
    ("preset", "name"),
    [("heated_thermistor", "wood"), ("heated_thermistor", "aluminium"), ("biotac_like", "aluminium")],
)
def test_a_heated_sensor_reads_what_it_does_in_a_press(preset: str, name: str) -> None:
    """Its heater cut or kept at constant power, its core cooling: the reading, not only the drop."""
    model = mujoco.MjModel.from_xml_string(ONE_PRESS.format(cone="elliptic"))
    data = mujoco.MjData(model)
    sensor = heated_stack(preset)
    touch = ThermalTouch(
        model,
        fingertips={"tip": Fingertip("tip", sensor=preset)},
        objects={"block": name},
        air=0.0,
        chain="ideal",
    )
    assert sensor.divider.temperature(touch.reading.voltage) == pytest.approx(36.0, abs=0.01)
    data.ctrl[0] = 10.0
    found, times = [], []
    for _ in range(3000):
        mujoco.mj_step(model, data)
        reading = touch.update(data)
        if (times or reading.touching[0]) and reading.time not in times:
            times.append(reading.time)
            found.append(float(sensor.divider.temperature(reading.voltage[0, -1])))
    faces = joint(LAPPED_ALUMINA, Surface.of(material(name)))
    h = float(contact_conductance(faces, 10.0 / 0.02**2))
    curves = press(
        name,
        sensor=preset,
        conductance=h,
        force=10.0,
        area=heated_core(sensor, 0.01).element.face_area,
        object_size=(0.04, 0.04, 0.04),
        seconds=6.0,
        tolerance=0.01,
    )
    assert curves.reading is not None
    since = np.array(times) - times[0] + 0.02
    expected = np.interp(since, curves.t, curves.reading)
    assert expected[-1] < 35.0
    # the recorder's smoothing looks ahead
    assert np.abs(found - expected)[since > 0.5].max() < 0.05


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


def test_two_fingers_on_thin_glass_feel_each_other_as_in_a_press() -> None:
    tips = "".join(
        f"""<body name="tip{n}" pos="0 0 {0.0057 * side}">
              <joint type="slide" axis="0 0 {-side}" damping="20"/>
              <geom type="box" size=".0045 .0045 .004" mass=".1"/></body>"""
        for n, side in enumerate((1, -1))
    )
    model = mujoco.MjModel.from_xml_string(f"""<mujoco><option timestep=".002" gravity="0 0 0"/><worldbody>
        <body name="sheet"><geom type="box" size=".02 .02 .0015"/></body>{tips}</worldbody></mujoco>""")
    data = mujoco.MjData(model)
    touch = ThermalTouch(
        model, fingertips={"a": "tip0", "b": "tip1"}, objects={"sheet": "glass"}, air=0.0, chain="ideal"
    )
    for _ in range(3000):
        data.qfrc_applied[:] = 5.0
        mujoco.mj_step(model, data)
        touch.update(data)
    assert touch.reading.force == pytest.approx([5.0, 5.0], rel=1e-3)
    faces = joint(LAPPED_ALUMINA, Surface.of(material("glass")))
    h = float(contact_conductance(faces, 5.0 / 0.009**2))
    alone, both = (
        press(
            "glass",
            conductance=h,
            opposite=opposite,
            object_size=(0.04, 0.04, 0.003),
            seconds=6.0,
            tolerance=0.02,
        )
        for opposite in (None, h)
    )
    assert touch.reading.temperature_drop == pytest.approx([both.temperature_drop[-1]] * 2, abs=0.05)
    assert alone.temperature_drop[-1] > both.temperature_drop[-1] + 0.2


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
    model, _ = hand.hand(custom='<text name="thermograsp:can" data="aluminium warm"/>')
    with pytest.raises(InvalidValueError, match="aluminium 5.0"):
        ThermalTouch(model, fingertips=PADS)


def test_what_the_scene_says_is_renamed_as_its_bodies_are_when_it_is_attached() -> None:
    if not hasattr(mujoco.MjSpec, "attach"):
        pytest.skip("this MuJoCo attaches no specs")
    whole = mujoco.MjSpec()
    for side in ("left_", "right_"):
        part = mujoco.MjSpec.from_string(
            '<mujoco><custom><text name="thermograsp:wall" data="glass 5"/></custom><worldbody><body name="cup">'
            '<geom name="tip" type="box" size=".01 .01 .01" pos="0 0 1"/>'
            '<geom name="wall" type="box" size=".02 .02 .02"/>'
            "</body></worldbody></mujoco>"
        )
        whole.attach(part, prefix=side, frame=whole.worldbody.add_frame())
    touch = ThermalTouch(whole.compile(), fingertips={"tip": Fingertip("left_tip")})
    assert touch.objects == ("left_wall", "right_wall")
    assert touch.reading.object_temperature == {"left_wall": 5.0, "right_wall": 5.0}


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


WRONG = [
    ({"fingertips": {"thumb": "thumbpad"}}, UnknownNameError, "thumb_pad"),
    ({"fingertips": {}}, InvalidValueError, "none given"),
    ({"objects": {"cann": "glass"}}, UnknownNameError, "can"),
    ({"objects": {"can": "glas"}}, UnknownNameError, "glass"),
    ({"objects": {"can": 3.0}}, InvalidValueError, "material"),
    ({"objects": {"floor": "wood"}}, InvalidValueError, "without volume"),
    ({"objects": {"can": "glass", "can_wall": "wood"}}, InvalidValueError, "share geom"),
    ({"objects": {"thumb": "glass"}}, InvalidValueError, "part of object"),
    ({"fingertips": {"a": "thumb_pad", "b": "thumb"}}, InvalidValueError, "one geom"),
    ({"dt": 0.013}, InvalidValueError, "whole number"),
    ({"dt": 0.0}, InvalidValueError, "dt"),
    ({"tolerance": -1.0}, InvalidValueError, "tolerance"),
    ({"chain": "ads"}, UnknownNameError, "ads1115"),
    ({"ambient": -300.0}, InvalidValueError, "ambient"),
    ({"dt": 1e300}, InvalidValueError, "too long"),
    ({"fingertips": ["thumb_pad"]}, InvalidValueError, "mapping"),
    ({"objects": ["can"]}, InvalidValueError, "mapping"),
    ({"worlds": 0}, InvalidValueError, "worlds"),
    ({"worlds": True}, InvalidValueError, "worlds"),
    ({"seed": "a"}, InvalidValueError, "seed must be"),
    ({"seed": -1}, InvalidValueError, "seed must be"),
    ({"seed": 1.5}, InvalidValueError, "seed must be"),
]


@pytest.mark.parametrize(("words", "error", "said"), WRONG)
def test_bad_input_is_refused_by_name(words: dict, error: type[Exception], said: str) -> None:
    model, _ = hand.hand(objects='<geom name="floor" type="plane" size="1 1 .1" pos="0 0 -.2"/>')
    with pytest.raises(error, match=said):
        ThermalTouch(model, **{"fingertips": PADS, "objects": {"can": "aluminium"}, **words})


def test_data_of_another_model_are_refused() -> None:
    model, _ = hand.hand()
    other = mujoco.MjModel.from_xml_string(ONE_PRESS.format(cone="elliptic"))
    with pytest.raises(InvalidValueError, match="another model"):
        make(model).update(mujoco.MjData(other))


ASIDE = """
<mujoco><option timestep=".002" gravity="0 0 0"/><worldbody>
  <geom name="beside" type="box" size=".01 .01 .01" pos="1 0 0"/>
  <body name="cube"><geom type="box" size=".02 .02 .02"/></body>
  <body name="tip" pos="0 0 .1"><joint type="slide" axis="0 0 1"/><geom type="box" size=".01 .01 .004"/></body>
</worldbody></mujoco>"""


def test_a_model_of_the_same_names_and_other_sizes_is_another_one() -> None:
    model, _ = hand.hand()
    other, data = hand.hand()
    other.geom_size[other.geom("thumb_pad").id] *= 2.0
    with pytest.raises(InvalidValueError, match="another model"):
        make(model).update(data)


def test_a_model_whose_geoms_lie_elsewhere_is_another_one() -> None:
    model, _ = hand.hand()
    other, data = hand.hand()
    other.geom_pos[other.geom("thumb_pad").id, 2] += 0.01
    with pytest.raises(InvalidValueError, match="another model"):
        make(model).update(data)


def test_other_geoms_of_the_scene_may_lie_elsewhere() -> None:
    model = mujoco.MjModel.from_xml_string(ASIDE)
    other = mujoco.MjModel.from_xml_string(ASIDE)
    other.geom_pos[other.geom("beside").id, 2] += 0.01
    touch = ThermalTouch(model, fingertips={"tip": "tip"}, objects={"cube": "steel"}, dt=0.02)
    data = mujoco.MjData(other)
    mujoco.mj_step(other, data)
    assert touch.update(data).touching == ("",)


@pytest.mark.parametrize(
    ("words", "said"),
    [
        ({"objects": {"ball": "wood"}}, "objects"),
        ({"fingertips": {"other": "thumb_pad"}}, "fingertips"),
        ({"dt": 0.04}, "dt"),
        ({"tolerance": 0.005}, "tolerance"),
        ({"ambient": 30.0}, "ambient"),
        ({"air": 50.0}, "air"),
        ({"chain": "ideal"}, "chain"),
        ({"fingertips": {"thumb": Fingertip("thumb_pad", temperature=50.0)}}, "thermostats"),
        ({"fingertips": {"thumb": Fingertip("thumb_pad", thermostat=Thermostat())}}, "thermostats"),
        ({"fingertips": {"thumb": Fingertip("thumb_pad", skin="filled_silicone")}}, "sensors"),
        ({"fingertips": {"thumb": Fingertip("thumb_pad", sensor="biotac_like")}}, "sensors"),
    ],
)
def test_a_state_of_another_touch_is_refused_and_changes_nothing(words: dict, said: str) -> None:
    model, data = hand.hand()
    every = {"fingertips": {"thumb": "thumb_pad"}, "objects": {"can": "aluminium"}, "seed": 1}
    touch, other = ThermalTouch(model, **every), ThermalTouch(model, **{**every, **words})
    hand.press(data, 10.0)
    run(model, data, touch, 0.1)
    before = other.reading.voltage.copy()
    with pytest.raises(InvalidValueError, match=f"whose {said} (are|differ)"):
        other.set_state(touch.state())
    np.testing.assert_array_equal(other.reading.voltage, before)
    with pytest.raises(InvalidValueError, match="what state"):
        other.set_state(None)  # type: ignore[arg-type]


@pytest.mark.parametrize("what", [None, 3.0, "model"])
def test_what_is_no_data_is_refused(what: object) -> None:
    model, data = hand.hand()
    touch = make(model)
    given = model if what == "model" else what
    for _ in range(2):  # before any step and after one
        with pytest.raises(InvalidValueError, match="takes the simulation's MjData"):
            touch.update(given)  # pyright: ignore[reportArgumentType]
        run(model, data, touch, 0.01)
    data.time = np.nan
    with pytest.raises(InvalidValueError, match="time is nan"):
        touch.update(data)


def test_hours_between_updates_are_refused() -> None:
    model, data = hand.hand()
    touch = make(model)
    run(model, data, touch, 0.01)
    data.time = 1e300
    with pytest.raises(InvalidValueError, match="more than 3600 s ago"):
        touch.update(data)


WRONG_RESETS = [
    {"temperatures": {"can": np.nan}},
    {"temperatures": {"can": "hot"}},
    {"temperatures": 5.0},
    {"objects": ["can"]},
    {"seed": "a"},
    {"seed": -1},
    {"seed": [1, 2]},
    {"data": 5},
]


@pytest.mark.parametrize("words", WRONG_RESETS)
def test_a_reset_that_cannot_be_is_refused(words: dict) -> None:
    model, _ = hand.hand()
    with pytest.raises(InvalidValueError):
        make(model).reset(**words)


def test_a_grasp_that_has_sunk_in_may_be_reset_and_goes_on() -> None:
    text = ONE_PRESS.format(cone="elliptic")
    model = mujoco.MjModel.from_xml_string(text)
    data = mujoco.MjData(model)
    touch = ThermalTouch(model, fingertips={"tip": "tip"}, objects={"block": "glass"})
    data.ctrl[:] = 20.0
    softness = 0.03  # s; boxes sink twice as far into each other in MuJoCo 3 as in 4
    while data.qpos[0] < 0.0045:  # m, so that the pad sinks in by more than a contact does
        softness += 0.003
        model.geom_solref[:] = softness, 1.0
        run(model, data, touch, 0.4)
    assert touch.reading.touching == ("block",)
    touch.reset(data)
    run(model, data, touch, 0.1)
    assert touch.reading.touching == ("block",)


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


def test_a_force_that_is_not_finite_is_told() -> None:
    model, data = hand.hand()
    touch = make(model)
    hand.press(data, 10.0)
    run(model, data, touch, 0.3)
    mujoco.mj_step(model, data)
    data.efc_force[:] = np.nan
    with pytest.raises(SimulationError, match="not finite"):
        touch.update(data)


TWO_TIPS = """
<mujoco>
  <option timestep=".002" gravity="0 0 0"/>
  <worldbody>
    <body name="block" pos=".1 0 0"><geom name="block" type="box" size=".02 .02 .02"/></body>
    <body name="a"><geom name="a" type="box" size=".01 .01 .004"/></body>
    <body name="b" pos="{offset} 0 .0081">
      <joint type="slide" axis="0 0 -1" damping="20"/>
      <geom name="b" type="box" size=".01 .01 .004" mass=".1"/>
    </body>
  </worldbody>
</mujoco>"""


def test_a_fingertip_warms_another() -> None:
    model = mujoco.MjModel.from_xml_string(TWO_TIPS.format(offset=0.0))
    data = mujoco.MjData(model)
    tips = {"a": "a", "b": Fingertip("b", temperature=46.0)}
    touch = ThermalTouch(model, fingertips=tips, objects={"block": "glass"}, chain="ideal")
    for _ in range(1500):
        data.qfrc_applied[0] = 5.0
        mujoco.mj_step(model, data)
        touch.update(data)
    reading, balance = touch.reading, touch.balance
    assert reading.touching == ("b", "a")
    assert reading.force == pytest.approx([5.0, 5.0], rel=1e-3)
    # the two halves of one path: what one loses the other gains
    assert reading.temperature_drop[1] > 1.0
    assert reading.temperature_drop[0] == pytest.approx(-reading.temperature_drop[1], rel=1e-6)
    assert isinstance(balance.passed, np.ndarray) and balance.passed[0, 1] < -0.1 and not balance.given.any()


def test_a_fingertip_between_another_and_an_object_hands_heat_on() -> None:
    model = mujoco.MjModel.from_xml_string(TWO_TIPS.format(offset=0.0))
    tips = {"a": "a", "b": Fingertip("b", temperature=46.0)}
    touch = ThermalTouch(model, fingertips=tips, objects={"block": "aluminium"})
    heat = JoinedHeat(
        touch._pads, (), touch._shapes, worlds=1, dt=0.01, tolerance=0.05, film=0.0, ambient=24.0
    )
    touches = np.zeros((1, 2, 3, COLUMNS))
    touches[0, 0, :, CONDUCTANCE] = 1.0, 0.0, 1.0  # on the block and on the other
    touches[0, 0, 0, PLACE : PLACE + 3], touches[0, 0, 0, NORMAL : NORMAL + 3] = (0, 0, 0.02), (0, 0, -1)
    for _ in range(3000):
        heat.advance(touches, 1)
    # it is warmed by the other and cooled by the block: its element hands on what both conduct at its face
    balance, element = heat.balance(0), touch._pads[0].stack
    resists = sum(layer.thickness / layer.conductivity for layer in element.layers) / element.face_area
    sensed = element.layers[element.sensed]
    sensed = sensed.thickness / sensed.conductivity / element.face_area
    kelvin = heat.object_temperature[0, 0] - 36.0
    # of the faces' temperatures in a steady state: both elements from their thermostats, and the block
    ends, links = np.array([0.0, 10.0]), 1 / resists
    matrix = np.array([[links + 2.0, -1.0], [-1.0, links + 1.0]])
    faces = np.linalg.solve(matrix, links * ends + np.array([kelvin, 0.0]))
    np.testing.assert_allclose(heat.drop[0], (ends - faces) * links * sensed, rtol=0.05)
    error = balance.objects.sum() - balance.given.sum()
    assert abs(error) < 1e-10 * np.abs(balance.given).sum()


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


def test_a_fingertip_that_starts_inside_its_object_is_refused() -> None:
    text = ONE_PRESS.format(cone="elliptic").replace('pos="0 0 .0241"', 'pos="0 0 .005"')
    model = mujoco.MjModel.from_xml_string(text)
    data = mujoco.MjData(model)
    touch = ThermalTouch(model, fingertips={"tip": "tip"}, objects={"block": "glass"})
    mujoco.mj_step(model, data)
    with pytest.raises(InvalidValueError, match="inside object 'block'"):
        touch.update(data)


def test_a_plate_that_is_too_light_is_refused_and_the_lightest_one_is_stable() -> None:
    """Element and plate answer each other a step late, and would push each other further and further."""
    model = mujoco.MjModel.from_xml_string(ONE_PRESS.format(cone="elliptic"))
    least = sensor("seed").answering(0.01)

    def touching(heat_capacity: float) -> ThermalTouch:
        tip = Fingertip("tip", thermostat=Thermostat(heat_capacity=heat_capacity))
        return ThermalTouch(model, fingertips={"tip": tip}, objects={"block": "aluminium"})

    with pytest.raises(
        InvalidValueError, match=r"a plate of 0.03 J/K is lighter .* give it 0.0\d+ J/K or more"
    ):
        touching(0.03)
    touch, data = touching(1.001 * least), mujoco.MjData(model)
    data.ctrl[0] = 10.0
    for _ in range(2000):
        mujoco.mj_step(model, data)
        touch.update(data)
    assert 1.0 < touch.reading.temperature_drop[0] < 12.0


@pytest.mark.parametrize(("name", "mode"), [("glass", "T"), ("aluminium", "T"), ("aluminium", "O")])
def test_a_thermostat_of_finite_power_cools_as_in_a_press(name: str, mode: Literal["T", "O"]) -> None:
    model = mujoco.MjModel.from_xml_string(ONE_PRESS.format(cone="elliptic"))
    data = mujoco.MjData(model)
    weak = Thermostat(power_limit=0.3, heat_capacity=1.0)
    glued = [SensorElement((0, 0, 0.02), (0, 0, 1))] if mode == "O" else []
    tip = Fingertip("tip", sensor=None if mode == "O" else "seed", thermostat=weak)
    objects = {"block": ThermalBody(name, elements=glued)}
    touch = ThermalTouch(model, fingertips={"tip": tip}, objects=objects, air=0.0, chain="ideal")
    data.ctrl[0] = 10.0
    drops, times = [], []
    for _ in range(3000):
        mujoco.mj_step(model, data)
        reading = touch.update(data)
        if (times or reading.touching[0]) and reading.time not in times:
            times.append(reading.time)
            drops.append(reading.element_drop[0] if mode == "O" else reading.temperature_drop[0])
    if mode == "O":
        h = float(contact_conductance(joint(LAPPED_ALUMINA, THERMOSTAT_FACE), 10.0 / 0.009**2))
    else:
        h = float(contact_conductance(joint(LAPPED_ALUMINA, Surface.of(material(name))), 10.0 / 0.02**2))
    size = (0.04, 0.04, 0.04)
    curves, ideal = (
        press(
            name,
            mode=mode,
            conductance=h,
            thermostat=kind,
            object_size=size,
            seconds=6.0,
            tolerance=0.01,
            rung="network",
        )
        for kind in (weak, None)
    )
    since = np.array(times) - times[0] + 0.02
    expected = np.interp(since, curves.t, curves.temperature_drop)
    difference = np.abs(np.array(drops) - expected)[since > 0.3].max()
    # the ideal one would be far off, and what is left is that of the networks
    assert ideal.temperature_drop[-1] - expected[-1] > 0.3
    assert difference < 0.07
    first = touch.reset()
    assert first.temperature_drop[0] == 0.0


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


@pytest.mark.parametrize("name", ["wood", "aluminium"])
def test_a_smaller_tolerance_is_nearer_to_a_press(name: str) -> None:
    model = mujoco.MjModel.from_xml_string(ONE_PRESS.format(cone="elliptic"))
    conductance = 3e4  # W/(m2 K), from the start on
    curves = press(
        name, conductance=conductance, object_size=(0.04, 0.04, 0.04), seconds=5.0, dt=0.01, tolerance=0.003
    )
    for tolerance in (0.05, 0.02):
        touch = ThermalTouch(
            model, fingertips={"tip": "tip"}, objects={"block": name}, air=0.0, tolerance=tolerance
        )
        touches, drops = np.zeros((1, 1, 2, COLUMNS)), []
        touches[0, 0, 0, CONDUCTANCE] = conductance * 81e-6
        touches[0, 0, 0, PLACE : PLACE + 3], touches[0, 0, 0, NORMAL : NORMAL + 3] = (0, 0, 0.02), (0, 0, -1)
        for _ in range(500):
            touch._heat.advance(touches, 1)
            drops.append(touch._heat.drop[0, 0])
        error = np.abs(np.array(drops) - curves.temperature_drop[1:])[4:].max()
        assert error < tolerance / 3
