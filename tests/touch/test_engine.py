"""Heat inside MuJoCo's step: the same numbers as ThermalTouch, in whatever way the steps are taken."""

# mujoco ships no type stubs for its compiled names
# pyright: reportAttributeAccessIssue=false

import copy
import importlib.util
import os
import shutil
import subprocess
import sys
import time
from collections.abc import Iterator
from concurrent.futures import ThreadPoolExecutor
from dataclasses import replace
from pathlib import Path

import mujoco
import mujoco.rollout
import numpy as np
import pytest

from thermograsp.errors import InvalidValueError, MissingDependencyError, ThermograspError
from thermograsp.thermal import IDEAL, Thermostat
from thermograsp.thermal.stack import Held, Off, Pid, Place, heated_stack
from thermograsp.touch import Fingertip, SensorElement, ThermalBody, ThermalTouch, install, load_plugin
from thermograsp.touch.contacts import BESIDE

pytestmark = pytest.mark.skipif(
    shutil.which(os.environ.get("CC", "cc")) is None, reason="needs a C compiler to build the plugin"
)
TIER = pytest.mark.skipif(
    not os.environ.get("THERMOGRASP_ENGINE"), reason="takes minutes and gcc's sanitizers: make test-engine"
)
SPECS_TAKE_PLUGINS = hasattr(mujoco.MjSpec, "activate_plugin")
NEEDS_SPECS = pytest.mark.skipif(not SPECS_TAKE_PLUGINS, reason="specs take plugins from MuJoCo 3.3.2 on")
ROUND_OFF = 1e-9  # K; the two sum in another order

_spec = importlib.util.spec_from_file_location("hand", Path(__file__).with_name("hand.py"))
assert _spec and _spec.loader
hand = importlib.util.module_from_spec(_spec)
_spec.loader.exec_module(hand)

PADS = {name: f"{name}_pad" for name in hand.FINGERS}
OBJECTS = {"can": ThermalBody("aluminium", 5.0), "ball": "glass"}
HEATED, WARM_CORE = heated_stack("heated_thermistor"), heated_stack("biotac_like")
CONTROLLER = Pid(setpoint=36.0, proportional=2e3, integral=500.0, derivative=5e3, limit=10.0)
ORDERS = (10.0, 0.0, 0.0), (10.0, 0.015, 0.0), (-5.0, 0.0, 0.0), (10.0, -0.015, 0.01), (6.0, 0.0, -0.005)
"""Forces N, and places m of the palm, each for a while: touches, slips, lets go, comes back elsewhere."""
FULL = mujoco.mjtState.mjSTATE_FULLPHYSICS


@pytest.fixture(scope="module")
def model() -> mujoco.MjModel:
    if not SPECS_TAKE_PLUGINS:
        pytest.skip("specs take plugins from MuJoCo 3.3.2 on")
    return install(mujoco.MjSpec.from_string(hand.scene()), fingertips=PADS, objects=OBJECTS)


def order(data: mujoco.MjData, force: float, x: float, z: float, fingers: tuple[str, ...] = ()) -> None:
    hand.press(data, force, *fingers)
    data.actuator("palm").ctrl[0], data.actuator("palm_z").ctrl[0] = x, z


def orders(steps: int) -> np.ndarray:
    """(steps * len(ORDERS), 5) controls."""
    rows = [[force, force, force, x, z] for force, x, z in ORDERS]
    return np.repeat(np.array(rows), steps, axis=0)


def states(model: mujoco.MjModel, data: mujoco.MjData, kind: mujoco.mjtState = FULL) -> np.ndarray:
    found = np.empty(mujoco.mj_stateSize(model, kind))
    mujoco.mj_getState(model, data, found, kind)
    return found


def voltages(model: mujoco.MjModel, data: mujoco.MjData) -> np.ndarray:
    mujoco.mj_forward(model, data)
    return data.sensor("heat").data.copy()


def sent(touch: ThermalTouch) -> np.ndarray:
    """(S,) V that the sensors send to their electronics."""
    sensors = (*touch._pads, *touch._glued)
    return touch._heat.sent[0] * [1.0 if pad.heated else pad.stack.seebeck for pad in sensors]


def per_kelvin(touch: ThermalTouch) -> np.ndarray:
    """(S,) V/K of the sensors, about."""
    return np.array([pad.stack.seebeck for pad in (*touch._pads, *touch._glued)])


def with_backs(*each: dict) -> dict:
    """The hand with a fingertip of each of these."""
    return {
        "fingertips": {
            name: Fingertip(pad, **words) for (name, pad), words in zip(PADS.items(), each, strict=True)
        }
    }


BACKS = with_backs({"sensor": HEATED}, {"thermostat": Thermostat(power_limit=0.3)}, {"sensor": None})
BOXED = hand.scene().replace('type="cylinder" size="0.03 .05"', 'type="box" size=".03 .03 .05"')
GLUED = SensorElement((0.03, 0.001, 0.002), (1, 0, 0)), SensorElement((-0.015, 0.03, 0.0), (0, 1, 0))
EVERYTHING = {**BACKS, "objects": {"can": ThermalBody("glass", 60.0, elements=GLUED), "ball": "wood"}}
"""In the scene where the can is a box: of what may be behind an element, and elements on an object."""


def furthest(model: mujoco.MjModel, data: mujoco.MjData, touch: ThermalTouch) -> float:
    """K between the two in the next steps."""
    most = 0.0
    for n in range(150):
        mujoco.mj_step(model, data)
        touch.update(data)
        if n % 10 == 9:
            difference = voltages(model, data) - sent(touch)
            most = max(most, float(np.abs(difference / per_kelvin(touch)).max()))
    return most


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
    touching, places = set(), 0
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
        places = max(places, *(len(field.places) for field in touch._heat._fields[0]))
    assert len(touching) > 2 and places == len(PADS) + 2  # places have gone again


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
    places = set()
    for number in range(14):
        force, x, z = ORDERS[rng.integers(len(ORDERS))]
        aside = rng.uniform(-0.004, 0.004, 2)
        order(data, force * rng.uniform(0.5, 1.5), x + aside[0], z + aside[1], hand.FINGERS[: 2 + number % 2])
        assert furthest(model, data, touch) < ROUND_OFF
        places.update(place for field in touch._heat._fields[0] for place in field.places)
    assert len(places) > len(PADS) + 2


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
def test_fingertips_on_one_another_and_other_shapes() -> None:
    """Two pads that meet, a ball, a turned box, pyramidal cones."""
    spec = mujoco.MjSpec.from_string("""
    <mujoco><option timestep=".002" cone="pyramidal"/><worldbody>
      <body name="low"><geom name="low" type="box" size=".01 .01 .004"/></body>
      <body name="high" pos=".002 0 .03"><joint name="high" type="slide" axis="0 0 -1" damping="20"/>
        <geom name="high" type="box" size=".01 .01 .004" mass=".1"/></body>
      <body name="ball" pos=".2 0 0"><geom type="sphere" size=".03"/></body>
      <body name="on_ball" pos=".203 0 .05"><joint name="on_ball" type="slide" axis="0 0 -1" damping="20"/>
        <geom name="on_ball" type="box" size=".01 .01 .004" mass=".1"/></body>
      <body name="box" pos="-.2 0 0" euler="0 0 20"><geom type="box" size=".02 .03 .02"/></body>
      <body name="on_box" pos="-.19 0 .04"><joint name="on_box" type="slide" axis="0 0 -1" damping="20"/>
        <geom name="on_box" type="box" size=".01 .01 .004" mass=".1"/></body>
    </worldbody><actuator><motor joint="high"/><motor joint="on_ball"/><motor joint="on_box"/></actuator></mujoco>""")
    down, up = {"normal": (0, 0, -1), "position": (0, 0, -0.004), "size": (0.02, 0.02)}, (0, 0, 1)
    words = {
        "fingertips": {
            "low": Fingertip("low", (0, 0, 0.004), up, (0.02, 0.02), temperature=30.0),
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
    plain, times = mujoco.MjSpec.from_string(hand.scene()).compile(), []
    for each in (plain, model):
        many = batch.Batch(each, nsim=8, nthread=1)
        places = np.linspace(-0.015, 0.015, 8)[:, None]
        many.bind("ctrl")[:] = np.hstack([np.full((8, 3), 10.0), places, 0.0 * places])
        many.step(nstep=300)
        for _ in range(3):
            many.step(nstep=5)
        rounds = []  # the quickest counts: the process may have other work in one
        for _ in range(5):
            begun = time.process_time()
            for _ in range(10):
                many.step(nstep=5)
            rounds.append(time.process_time() - begun)
        times.append(min(rounds))
    assert times[1] < 2 * times[0]


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


EDGE = """
<mujoco><option timestep=".002" gravity="0 0 0"/><asset><mesh name="block" vertex="-.02 -.02 -.02  .02 -.02 -.02
  -.02 .02 -.02  .02 .02 -.02  -.02 -.02 .02  .02 -.02 .02  -.02 .02 .02  .02 .02 .02"/></asset><worldbody>
  <body name="block"><geom {} friction=".1" mass="1"/></body>
  <body name="tip" pos="0 0 .0241"><joint name="over" type="slide" axis="{}" damping="5"/>
    <joint name="down" type="slide" axis="0 0 -1" damping="20"/>
    <geom name="tip" type="box" size=".01 .01 .004" mass=".1"/>
  </body></worldbody>
  <actuator><position joint="over" kp="2000" kv="60"/><motor joint="down"/></actuator></mujoco>"""
WAYS, SKINS = ("1 0 0", "0 -1 0", "0.8 0.6 0"), (None, "filled_silicone")
QUICK = ("0.8 0.6 0", None), ("0 -1 0", "filled_silicone")  # of the mesh


@NEEDS_SPECS
@pytest.mark.parametrize(
    ("geom", "way", "skin"),
    [
        *(('type="box" size=".02 .02 .02"', way, skin) for way in WAYS for skin in SKINS),
        *(
            pytest.param(
                'type="mesh" mesh="block"', way, skin, marks=() if (way, skin) in QUICK else pytest.mark.slow
            )
            for way in WAYS
            for skin in SKINS
        ),
    ],
)
def test_over_an_edge_its_voltages_are_those_of_thermal_touch(geom: str, way: str, skin: str | None) -> None:
    tip = Fingertip("tip", (0, 0, -0.004), (0, 0, -1), (0.02, 0.02), skin=skin)
    words: dict = {"fingertips": {"tip": tip}, "objects": {"block": "steel"}}
    model = install(mujoco.MjSpec.from_string(EDGE.format(geom, way)), **words)
    data, touch = mujoco.MjData(model), ThermalTouch(model, **words, chain="ideal")
    data.ctrl[1], most, narrow = 10.0, 0.0, 0
    for n in range(300):
        data.ctrl[0] = 0.016 + 0.012 * np.sin(n / 40)
        mujoco.mj_step(model, data)
        touch.update(data)
        if n % 10 == 9:
            narrow += touch._heat.state().narrow.any()
            most = max(most, float(np.abs((voltages(model, data) - sent(touch)) / per_kelvin(touch)).max()))
    assert most < 1e-9 and narrow > 10


def broken() -> Iterator[dict[str, str]]:
    spec = mujoco.MjSpec.from_string(hand.scene())
    install(spec, fingertips=PADS, objects=OBJECTS)
    good = dict(spec.plugins[-1].config)
    numbers, huge = good["numbers"], np.array([1e300], ">f8").tobytes().hex()
    yield {}
    yield {"geoms": good["geoms"]}
    yield {"numbers": numbers}
    yield {**good, "geoms": ""}
    yield {**good, "geoms": good["geoms"] + ",table"}
    yield {**good, "geoms": good["geoms"].replace("thumb_pad", "nothing")}
    yield {**good, "geoms": good["geoms"].replace("thumb_pad", "index_pad")}
    yield {**good, "numbers": "heat"}
    yield {**good, "numbers": numbers[:-1]}
    yield {**good, "numbers": numbers[:-16]}
    yield {**good, "numbers": numbers + numbers[:16]}
    yield {**good, "numbers": numbers.replace("0", "O", 1)}
    for at in range(19):  # what says how much there is, and the first roles
        for value in (huge, "0" * 16, "7ff8" + "0" * 12, "bff0" + "0" * 12, "3fe0" + "0" * 12):
            if (at, value) == (17, "0" * 16):
                continue  # the first fingertip is number 0
            if at not in (8, 9, 10) or value[:2] in ("7f", "bf"):
                yield {**good, "numbers": numbers[: 16 * at] + value + numbers[16 * at + 16 :]}


@NEEDS_SPECS
def test_broken_attributes_are_refused() -> None:
    tried = 0
    for config in broken():
        spec = mujoco.MjSpec.from_string(hand.scene())
        spec.activate_plugin("thermograsp.heat")
        spec.add_plugin(name="heat", plugin_name="thermograsp.heat", active=True).config = config
        sensor = spec.add_sensor(name="heat", type=mujoco.mjtSensor.mjSENS_PLUGIN)
        sensor.plugin.active, sensor.plugin.name, sensor.plugin.plugin_name = True, "heat", "thermograsp.heat"
        with pytest.raises((ValueError, mujoco.FatalError)):
            mujoco.MjData(spec.compile())
        tried += 1
    assert tried > 50


@NEEDS_SPECS
@pytest.mark.parametrize("tries", [20, pytest.param(300, marks=TIER)])
def test_wrong_numbers_crash_nothing(tries: int) -> None:
    """They are refused, or give wrong temperatures."""
    rng, spec = np.random.default_rng(tries), mujoco.MjSpec.from_string(BOXED)
    install(spec, **EVERYTHING)
    good = np.frombuffer(bytes.fromhex(spec.plugins[-1].config["numbers"]), ">f8")
    nonsense, stepped = np.array([1e300, -1e300, 1e-300, -1.0, 0.0, 0.5, 2.0, 3.0, 255.0, 1e9]), 0
    for _ in range(tries):
        numbers, count = good.copy(), int(10 ** rng.uniform(0.0, 3.5))
        hit = np.unique(rng.integers(16, len(good), count))
        hit = hit[hit >= len(good) * rng.choice([0.0, 0.9])]  # tables of what is curved are most of it
        numbers[hit] = rng.choice(nonsense, len(hit))
        spec.plugins[-1].config = {**spec.plugins[-1].config, "numbers": numbers.tobytes().hex()}
        try:
            data = mujoco.MjData(spec.compile())
        except (ValueError, mujoco.FatalError):
            continue
        hand.press(data, 10.0)
        mujoco.mj_step(data.model, data, 40)
        stepped += 1
    assert stepped > tries / 10


@NEEDS_SPECS
@pytest.mark.parametrize(
    ("scene", "words"), [(hand.scene(), {}), (BOXED, EVERYTHING)], ids=["plain", "everything"]
)
def test_a_state_of_nonsense_starts_anew(scene: str, words: dict) -> None:
    model = install(mujoco.MjSpec.from_string(scene), **{"fingertips": PADS, "objects": OBJECTS, **words})
    rng, data = np.random.default_rng(1), mujoco.MjData(model)
    for scale in (1.0, 10.0, 1e9, np.nan, np.inf):
        for share in (0.02, 1.0):
            hit = rng.random(model.npluginstate) < share
            data.plugin_state[hit] = scale * rng.standard_normal(hit.sum())
            mujoco.mj_step(model, data, 20)
    hand.press(data, 10.0)
    numbers = np.array([np.nan, np.inf, -np.inf, 1e308, -1e308, 1e-308, -1.0, 0.0, 0.5, 3.0, 1e9])
    for turn in range(200):  # among numbers that make sense
        hit = rng.integers(model.npluginstate, size=20 if turn % 3 else model.npluginstate)
        data.plugin_state[hit] = rng.choice(numbers, len(hit))
        mujoco.mj_step(model, data, 7)
    fresh = mujoco.MjData(model)
    mujoco.mj_resetData(model, data)
    for each in (data, fresh):
        hand.press(each, 10.0)
        mujoco.mj_step(model, each, 200)
    assert np.median(np.abs(voltages(model, fresh))) > 1e-4
    assert np.array_equal(data.plugin_state, fresh.plugin_state)


@NEEDS_SPECS
@pytest.mark.parametrize(
    ("words", "message"),
    [
        ({"dt": 0.0031}, "whole number"),
        ({"air": -1.0}, "air"),
        (
            {"objects": {"crate": ThermalBody("glass", elements=(SensorElement((0, 0, 0.03), (0, 0, 1)),))}},
            "off the face",
        ),
        (
            {"objects": {"can": ["glass", "wood"]}},
            "'can': a list of 2 materials is one for each of many worlds",
        ),
    ],
)
def test_what_is_not_served_is_refused(words: dict, message: str) -> None:
    crate = '<body name="crate" pos="0 .3 .02"><geom type="box" size=".02 .02 .02"/></body>'
    spec = mujoco.MjSpec.from_string(hand.scene(objects=crate))
    with pytest.raises(InvalidValueError, match=message):
        install(spec, **{"fingertips": PADS, "objects": OBJECTS, **words})


def test_without_a_compiler_it_says_what_is_missing(tmp_path: Path) -> None:
    code = (
        "import thermograsp\nfrom thermograsp.touch import load_plugin\n"
        "try:\n    load_plugin()\nexcept thermograsp.errors.MissingDependencyError as e:\n    print(e)"
    )
    environment = os.environ | {"CC": "no-such-compiler", "THERMOGRASP_CACHE": str(tmp_path)}
    done = subprocess.run(
        [sys.executable, "-c", code], env=environment, capture_output=True, text=True, check=True
    )
    assert "there is no 'no-such-compiler'" in done.stdout
    environment["CC"] = "false"
    done = subprocess.run([sys.executable, "-c", code], env=environment, capture_output=True, text=True)
    assert "ThermograspError" in done.stderr and "failed" in done.stderr
    assert issubclass(MissingDependencyError, ThermograspError) and list(tmp_path.iterdir()) == []


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


@TIER
def test_processes_that_build_at_once_load_the_same(tmp_path: Path) -> None:
    environment = os.environ | {"THERMOGRASP_CACHE": str(tmp_path)}
    code = "from thermograsp.touch import load_plugin; print(load_plugin())"
    both = [
        subprocess.Popen([sys.executable, "-c", code], env=environment, stdout=subprocess.PIPE, text=True)
        for _ in range(2)
    ]
    paths = {one.communicate()[0] for one in both}
    assert [one.returncode for one in both] == [0, 0] and len(paths) == 1
    assert len(list(tmp_path.glob("*.so"))) == 1


@TIER
def test_sanitizers_find_nothing(tmp_path: Path) -> None:
    """This file again, in a process whose plugin is built with gcc's sanitizers."""
    asan = subprocess.run(["cc", "-print-file-name=libasan.so"], capture_output=True, text=True, check=True)
    code = f"""
import sys
from pathlib import Path
from thermograsp.touch.engine import library
path = Path({str(tmp_path / "heat.so")!r})
library.build(path, "-g", "-fsanitize=address,undefined", "-fno-sanitize-recover=all", "-Werror")
library.library = lambda: path
import pytest
sys.exit(pytest.main(["-q", "-x", "-p", "no:cacheprovider", {__file__!r}]))
"""
    environment = os.environ | {
        "LD_PRELOAD": asan.stdout.strip(),
        "ASAN_OPTIONS": "detect_leaks=0:handle_segv=0",
    }
    environment.pop("THERMOGRASP_ENGINE")
    done = subprocess.run([sys.executable, "-c", code], env=environment, capture_output=True, text=True)
    assert done.returncode == 0, done.stdout[-3000:] + done.stderr[-3000:]


@TIER
def test_a_million_random_steps(model: mujoco.MjModel) -> None:
    rng, data = np.random.default_rng(7), mujoco.MjData(model)
    for n in range(2_000):
        order(data, rng.uniform(-5.0, 12.0), *rng.uniform(-0.03, 0.03, 2))
        mujoco.mj_step(model, data, 500)
        if n % 10 == 0:
            assert np.isfinite(data.plugin_state).all() and np.abs(voltages(model, data)).max() < 0.1


@pytest.mark.skipif(SPECS_TAKE_PLUGINS, reason="this MuJoCo's specs take plugins")
def test_an_older_mujoco_is_named() -> None:
    with pytest.raises(MissingDependencyError, match=r"mujoco>=3\.3\.2"):
        install(mujoco.MjSpec.from_string(hand.scene()), fingertips=PADS, objects=OBJECTS)


def test_loading_twice_is_loading_once() -> None:
    assert load_plugin() == load_plugin()


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
