"""What a ThermalTouch does not take: wrong words, data and states of another model, resets that cannot be."""

# mujoco ships no type stubs for its compiled names
# pyright: reportAttributeAccessIssue=false

import mujoco
import numpy as np
import pytest

from thermograsp.errors import InvalidValueError, SimulationError, UnknownNameError
from thermograsp.thermal import (
    Thermostat,
    sensor,
)
from thermograsp.touch import Fingertip, ThermalTouch

from . import hand
from .hand import ONE_PRESS, PADS, make, run

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
    ({"fingertips": {"": "thumb_pad"}}, InvalidValueError, "'' is no name"),
    ({"fingertips": {1: "thumb_pad"}}, InvalidValueError, "1 is no name"),
    ({"fingertips": {"can": "thumb_pad"}}, InvalidValueError, "'can' is called as an object is"),
    ({"dt": 0.013}, InvalidValueError, "whole number"),
    ({"dt": 0.0}, InvalidValueError, "dt"),
    ({"tolerance": -1.0}, InvalidValueError, "tolerance"),
    ({"chain": "ads"}, UnknownNameError, "ads1115"),
    ({"chain": ["ideal"]}, UnknownNameError, r"unknown signal chain \['ideal'\]"),
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


def test_a_force_that_is_not_finite_is_told() -> None:
    model, data = hand.hand()
    touch = make(model)
    hand.press(data, 10.0)
    run(model, data, touch, 0.3)
    mujoco.mj_step(model, data)
    data.efc_force[:] = np.nan
    with pytest.raises(SimulationError, match="not finite"):
        touch.update(data)


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
