"""Heat inside MuJoCo's step: the same numbers as ThermalTouch."""

# mujoco ships no type stubs for its compiled names
# pyright: reportAttributeAccessIssue=false

from dataclasses import replace

import mujoco
import mujoco.rollout
import numpy as np
import pytest

from thermograsp.thermal import IDEAL, Thermostat
from thermograsp.thermal.stack import Held, Off, Place
from thermograsp.touch import Fingertip, ThermalBody, ThermalTouch, install
from thermograsp.touch.contacts import BESIDE
from thermograsp.touch.heat.places import MOST_PLACES

from . import hand
from .engine_scene import (
    BACKS,
    BOXED,
    CONTROLLER,
    EVERYTHING,
    HEATED,
    NEEDS_COMPILER,
    NEEDS_SPECS,
    OBJECTS,
    ORDERS,
    ROUND_OFF,
    TIER,
    WARM_CORE,
    furthest,
    keep_boxes,
    order,
    per_kelvin,
    sent,
    voltages,
    with_backs,
)
from .hand import PADS

pytestmark = NEEDS_COMPILER


@NEEDS_SPECS
@pytest.mark.parametrize(
    "case",
    [
        {},
        {
            "fingertips": {name: Fingertip(pad, skin="filled_silicone") for name, pad in PADS.items()},
            "objects": {"can": ThermalBody("rubber", 5.0), "ball": "glass"},
        },
        BACKS,
        pytest.param({"tolerance": 0.02}, marks=TIER),
        pytest.param(
            with_backs(  # too weak, no lag and no losses, ideal in another room
                {"thermostat": Thermostat(power_limit=0.05, loss=0.1, ambient=40.0), "temperature": 50.0},
                {"thermostat": Thermostat(power_limit=0.3, sensor_lag=0.0, loss=0.0)},
                {"thermostat": Thermostat(heat_capacity=np.inf, ambient=10.0)},
            ),
            marks=TIER,
        ),
        pytest.param(
            with_backs(
                {"sensor": replace(WARM_CORE, law=replace(CONTROLLER, cut=8.0)), "skin": "filled_silicone"},
                {"sensor": replace(HEATED, law=Held())},
                {"sensor": None, "skin": "filled_silicone", "thermostat": Thermostat(heat_capacity=5.0)},
            ),
            marks=TIER,
        ),
        pytest.param(
            with_backs(  # read and heated in the depth of other layers
                {"sensor": replace(WARM_CORE, readout=Place(0, 0.5), heater=Place(1, 0.5), law=CONTROLLER)},
                {"sensor": replace(WARM_CORE, readout=Place(0, 0.0), heater=Place(1, 0.0), law=Off())},
                {"sensor": WARM_CORE, "temperature": 30.0},
            ),
            marks=TIER,
        ),
    ],
    ids=["bare", "soft", "backs", "finer", "plates", "laws", "cores"],
)
def test_its_voltages_are_those_of_thermal_touch(case: dict) -> None:
    words = {"fingertips": PADS, "objects": OBJECTS, **case}
    model = install(mujoco.MjSpec.from_string(hand.scene()), **words)
    data, touch = mujoco.MjData(model), ThermalTouch(model, **words, chain=IDEAL)
    assert np.array_equal(voltages(model, data) != 0, [pad.heated is not None for pad in touch._pads])
    touching, idle = set(), []
    patterns = touch._heat._level.patterns
    for number, (force, x, z) in enumerate(ORDERS):
        order(data, force, x, z, hand.FINGERS[: 2 + number % 2])
        for n in range(150):
            mujoco.mj_step(model, data)
            reading = touch.update(data)
            if (
                n % 10 == 8
            ):  # a sample's sums, before they start anew: nothing is between these and the contacts
                touches = touch._reader.touches[0, :, :, :BESIDE]  # the plugin has no pads that exchange heat
                plugin_touches = data.plugin_state[1 : 1 + touches.size].reshape(touches.shape)
                np.testing.assert_allclose(plugin_touches, touches, rtol=1e-12, atol=1e-15)
            if n % 10 == 9:
                difference = voltages(model, data) - sent(touch)
                assert np.abs(difference / per_kelvin(touch)).max() < ROUND_OFF
                touching.add(reading.touching)
                can = touch._heat._fields[0][0]
                idle += [can.port(n, patterns) for n, whole in enumerate(can.whole) if not whole]
    assert len(touching) > 2 and not any(port[:, 1:].any() for port in idle)
    assert idle or "objects" not in case  # aluminium soon has none that is remembered


@NEEDS_SPECS
@pytest.mark.parametrize(
    ("name", "skin", "seed"),
    [
        ("rubber", None, 12),  # where round-off decided how networks are fitted, 2.4e-5 K apart
        *(
            pytest.param(name, skin, seed, marks=TIER)
            for seed in (13, 14)
            for name in ("rubber", "cotton", "wood", "glass", "copper")
            for skin in (None, "filled_silicone")
        ),
    ],
)
def test_after_long_slides_its_voltages_are_still_those_of_thermal_touch(
    name: str, skin: str | None, seed: int
) -> None:
    rng = np.random.default_rng(seed)
    words = {
        "fingertips": {finger: Fingertip(pad, skin=skin) for finger, pad in PADS.items()},
        "objects": {"can": ThermalBody(name, 5.0), "ball": "glass"},
    }
    model = install(mujoco.MjSpec.from_string(hand.scene()), **words)
    data, touch = mujoco.MjData(model), ThermalTouch(model, **words, chain=IDEAL)
    places, most = set(), 0
    for number in range(20):
        force, x, z = ORDERS[rng.integers(len(ORDERS))]
        aside = rng.uniform(-0.02, 0.02, 2)
        order(data, force * rng.uniform(0.5, 1.5), x + aside[0], z + aside[1], hand.FINGERS[: 2 + number % 2])
        assert furthest(model, data, touch) < ROUND_OFF
        places.update(place for field in touch._heat._fields[0] for place in field.places)
        most = max(most, *(len(field.places) for field in touch._heat._fields[0]))
    if skin is None:  # many have been forgotten, in copper since nothing was felt of them
        assert len(places) > most + len(PADS)
        assert name == "copper" or most == len(PADS) + MOST_PLACES


@NEEDS_SPECS
@pytest.mark.parametrize("skin", [None, pytest.param("filled_silicone", marks=TIER)])
def test_elements_on_an_object_are_those_of_thermal_touch(skin: str | None) -> None:
    words = dict(EVERYTHING)
    words["fingertips"] = {name: replace(tip, skin=skin) for name, tip in words["fingertips"].items()}
    model = install(mujoco.MjSpec.from_string(BOXED), **words)
    data, touch = mujoco.MjData(model), ThermalTouch(model, **words, chain=IDEAL)
    on_elements = []
    for number, (force, x, z) in enumerate(ORDERS):
        order(data, force, x, z, hand.FINGERS[: 2 + number % 2])
        assert furthest(model, data, touch) < ROUND_OFF
        drops = touch.reading.element_drop
        assert np.allclose(data.sensor("heat").data[3:] / per_kelvin(touch)[3:], drops, atol=1e-9)
        on_elements.append(drops)
    assert np.ptp(on_elements, axis=0).min() > 0.1  # both were touched and let go


@NEEDS_SPECS
@pytest.mark.parametrize("half", [0.01, 0.003])
def test_fingertips_on_one_another_and_other_shapes(half: float) -> None:
    """Two pads that meet, a ball, a turned box, pyramidal cones; pads wider than the sensor and narrower ones."""
    spec = mujoco.MjSpec.from_string(f"""
    <mujoco><option timestep=".002" cone="pyramidal"/><worldbody>
      <body name="low"><geom name="low" type="box" size="{half} {half} .004"/></body>
      <body name="high" pos=".002 0 .03"><joint name="high" type="slide" axis="0 0 -1" damping="20"/>
        <geom name="high" type="box" size="{half} {half} .004" mass=".1"/></body>
      <body name="ball" pos=".2 0 0"><geom type="sphere" size=".03"/></body>
      <body name="on_ball" pos=".203 0 .05"><joint name="on_ball" type="slide" axis="0 0 -1" damping="20"/>
        <geom name="on_ball" type="box" size="{half} {half} .004" mass=".1"/></body>
      <body name="box" pos="-.2 0 0" euler="0 0 20"><geom type="box" size=".02 .03 .02"/></body>
      <body name="on_box" pos="-.19 0 .04"><joint name="on_box" type="slide" axis="0 0 -1" damping="20"/>
        <geom name="on_box" type="box" size="{half} {half} .004" mass=".1"/></body>
    </worldbody><actuator><motor joint="high"/><motor joint="on_ball"/><motor joint="on_box"/></actuator></mujoco>""")
    size = (2 * half, 2 * half)
    down, up = {"normal": (0, 0, -1), "position": (0, 0, -0.004), "size": size}, (0, 0, 1)
    words = {
        "fingertips": {
            "low": Fingertip("low", (0, 0, 0.004), up, size, temperature=30.0),
            **{name: Fingertip(name, **down) for name in ("high", "on_ball", "on_box")},
        },
        "objects": {"ball": "glass", "box": "aluminium"},
    }
    model = install(spec, **words)
    data, touch = mujoco.MjData(model), ThermalTouch(model, **words, chain=IDEAL)
    data.ctrl[:], reading = 5.0, touch.reading
    for _ in range(500):
        mujoco.mj_step(model, data)
        reading = touch.update(data)
    drop = voltages(model, data) / np.array([pad.stack.seebeck for pad in touch._pads])
    assert reading.touching == ("high", "low", "ball", "box")
    assert np.abs(drop - reading.temperature_drop).max() < ROUND_OFF
    assert np.abs(drop).min() > 0.1


@NEEDS_SPECS
@pytest.mark.parametrize("names", [("low", "high"), ("high", "low")])
def test_round_fingertips_on_one_another(names: tuple[str, str]) -> None:
    spec = mujoco.MjSpec.from_string("""
    <mujoco><option timestep=".002" gravity="0 0 0"/><worldbody>
      <body name="block" pos=".1 0 0"><geom name="block" type="box" size=".02 .02 .02"/></body>
      <body name="low"><geom name="low" type="capsule" size=".008 .012" euler="0 90 20"/></body>
      <body name="high" pos=".001 .001 .0165"><joint name="high" type="slide" axis="0 0 -1" damping="20"/>
        <geom name="high" type="ellipsoid" size=".009 .012 .008" mass=".1"/></body>
    </worldbody><actuator><motor joint="high"/></actuator></mujoco>""")
    tips = {"low": Fingertip("low", temperature=46.0), "high": Fingertip("high", skin="filled_silicone")}
    words = {"fingertips": {name: tips[name] for name in names}, "objects": {"block": "glass"}}
    model = install(spec, **words)
    data, touch = mujoco.MjData(model), ThermalTouch(model, **words, chain=IDEAL)
    data.ctrl[0] = 5.0
    for _ in range(250):
        mujoco.mj_step(model, data)
        touch.update(data)
    drop = voltages(model, data) / np.array([pad.stack.seebeck for pad in touch._pads])
    assert np.abs(drop - touch.reading.temperature_drop).max() < ROUND_OFF
    assert np.abs(drop).min() > 0.1


@NEEDS_SPECS
def test_a_pad_that_sinks_in_deep_is_on_its_face_here_too() -> None:
    pads, objects = {"tip": "pad"}, {"ball": "glass"}
    model = install(mujoco.MjSpec.from_string(hand.SOFT), fingertips=pads, objects=objects)
    data = mujoco.MjData(model)
    touch = ThermalTouch(model, fingertips=pads, objects=objects, chain=IDEAL)
    for _ in range(500):
        mujoco.mj_step(model, data)
        touch.update(data)
    drop = voltages(model, data)[0] / touch._pads[0].stack.seebeck
    assert drop > 0.3 and abs(drop - touch.reading.temperature_drop[0]) < ROUND_OFF


EDGE = """
<mujoco><option timestep=".002" gravity="0 0 0"/><asset><mesh name="block" vertex="-.02 -.02 -.02  .02 -.02 -.02
  -.02 .02 -.02  .02 .02 -.02  -.02 -.02 .02  .02 -.02 .02  -.02 .02 .02  .02 .02 .02"/></asset><worldbody>
  <body name="block"><geom {geom} friction=".1" mass="1"/></body>
  <body name="tip" pos="0 0 .0241"><joint name="over" type="slide" axis="{way}" damping="5"/>
    <joint name="down" type="slide" axis="0 0 -1" damping="20"/>
    <geom name="tip" type="box" size="{half} {half} .004" mass=".1"/>
  </body></worldbody>
  <actuator><position joint="over" kp="2000" kv="60"/><motor joint="down"/></actuator></mujoco>"""


WAYS, SKINS = ("1 0 0", "0 -1 0", "0.8 0.6 0"), (None, "filled_silicone")


@NEEDS_SPECS
@pytest.mark.parametrize(
    ("geom", "way", "skin", "half"),
    [
        *(('type="box" size=".02 .02 .02"', way, skin, 0.01) for way in WAYS for skin in SKINS),
        *(('type="box" size=".02 .02 .02"', WAYS[2], skin, 0.003) for skin in SKINS),
        *(
            (f'type="box" size="{bar}"', WAYS[0], None, 0.01)
            for bar in (".004 .02 .02", ".02 .0035 .02", ".004 .003 .02")
        ),
        pytest.param('type="mesh" mesh="block"', WAYS[2], None, 0.003, marks=pytest.mark.slow),
        *(
            pytest.param('type="mesh" mesh="block"', way, skin, 0.01, marks=pytest.mark.slow)
            for way in WAYS
            for skin in SKINS
        ),
    ],
)
def test_over_an_edge_its_voltages_are_those_of_thermal_touch(
    geom: str, way: str, skin: str | None, half: float, monkeypatch: pytest.MonkeyPatch
) -> None:
    keep_boxes(monkeypatch)
    tip = Fingertip("tip", (0, 0, -0.004), (0, 0, -1), (2 * half, 2 * half), skin=skin)
    words: dict = {"fingertips": {"tip": tip}, "objects": {"block": "steel"}}
    model = install(mujoco.MjSpec.from_string(EDGE.format(geom=geom, way=way, half=half)), **words)
    data, touch = mujoco.MjData(model), ThermalTouch(model, **words, chain="ideal")
    data.ctrl[1], most, narrow = 10.0, 0.0, 0
    for n in range(300):
        data.ctrl[0] = 0.006 + half + 0.012 * np.sin(n / 40)
        mujoco.mj_step(model, data)
        touch.update(data)
        if n % 10 == 9:
            narrow += touch._heat.state().narrow.any()
            most = max(most, float(np.abs((voltages(model, data) - sent(touch)) / per_kelvin(touch)).max()))
    assert most < 1e-9 and narrow > 10
