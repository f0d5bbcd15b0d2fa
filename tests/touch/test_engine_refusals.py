"""What the plugin does not take: broken attributes, numbers and states of nonsense, scenes that it does not serve."""

# mujoco ships no type stubs for its compiled names
# pyright: reportAttributeAccessIssue=false

import os
import subprocess
import sys
from collections.abc import Iterator
from pathlib import Path

import mujoco
import mujoco.rollout
import numpy as np
import pytest

from thermograsp.errors import InvalidValueError, MissingDependencyError, ThermograspError
from thermograsp.touch import SensorElement, ThermalBody, install, load_plugin

from . import hand
from .engine_scene import (
    BOXED,
    EVERYTHING,
    NEEDS_COMPILER,
    NEEDS_SPECS,
    OBJECTS,
    SPECS_TAKE_PLUGINS,
    TIER,
    installed,
    order,
    voltages,
)
from .hand import PADS

pytestmark = NEEDS_COMPILER


@pytest.fixture(scope="module")
def model() -> mujoco.MjModel:
    return installed()


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


@NEEDS_SPECS
def test_sensors_that_are_off_are_told_of() -> None:
    spec = mujoco.MjSpec.from_string(hand.scene())
    spec.option.disableflags |= mujoco.mjtDisableBit.mjDSBL_SENSOR
    with pytest.raises(InvalidValueError, match="the model disables its sensors"):
        install(spec, fingertips=PADS, objects=OBJECTS)


def test_without_a_compiler_it_says_what_is_missing(tmp_path: Path) -> None:
    code = (
        "import os, thermograsp\nfrom thermograsp.touch import load_plugin\n"
        "try:\n    load_plugin()\nexcept thermograsp.errors.MissingDependencyError as e:\n    print(e)\n"
        "os.environ['CC'] = 'false'\nload_plugin()"
    )
    environment = os.environ | {"CC": "no-such-compiler", "THERMOGRASP_CACHE": str(tmp_path)}
    done = subprocess.run([sys.executable, "-c", code], env=environment, capture_output=True, text=True)
    assert "there is no 'no-such-compiler'" in done.stdout
    assert "ThermograspError" in done.stderr and "failed" in done.stderr
    assert issubclass(MissingDependencyError, ThermograspError) and list(tmp_path.iterdir()) == []


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
    """All tests of the plugin again, in a process whose plugin is built with gcc's sanitizers."""
    tests = sorted(map(str, Path(__file__).parent.glob("test_engine*.py")))
    asan = subprocess.run(["cc", "-print-file-name=libasan.so"], capture_output=True, text=True, check=True)
    code = f"""
import sys
from pathlib import Path
from thermograsp.touch.engine import library
path = Path({str(tmp_path / "heat.so")!r})
library.build(path, "-g", "-fsanitize=address,undefined", "-fno-sanitize-recover=all", "-Werror")
library.library = lambda: path
import pytest
sys.exit(pytest.main(["-q", "-x", "-p", "no:cacheprovider", *{tests!r}]))
"""
    environment = os.environ | {
        "LD_PRELOAD": asan.stdout.strip(),
        "ASAN_OPTIONS": "detect_leaks=0:handle_segv=0",
    }
    environment.pop("THERMOGRASP_ENGINE")
    done = subprocess.run([sys.executable, "-c", code], env=environment, capture_output=True, text=True)
    assert done.returncode == 0, done.stdout[-3000:] + done.stderr[-3000:]


@TIER
def test_wider_registers_give_the_same_bits(tmp_path: Path) -> None:
    """Beside a plugin that no function is compiled twice in."""
    said = []
    for name, options in (("wider", ()), ("plain", ("-DWIDER=",))):
        code = f"""
import mujoco
from pathlib import Path
from thermograsp.touch.engine import library
from tests.touch.engine_scene import installed, order
path = Path({str(tmp_path / f"{name}.so")!r})
library.build(path, *{options!r})
library.library = lambda: path
model = installed()
data = mujoco.MjData(model)
for force, x in ((8.0, 0.0), (-2.0, 0.02), (5.0, 0.0)):
    order(data, force, x, 0.0)
    mujoco.mj_step(model, data, 300)
print(data.plugin_state.tobytes().hex())
"""
        command, folder = [sys.executable, "-c", code], Path(__file__).parents[2]
        done = subprocess.run(command, cwd=folder, capture_output=True, text=True, check=True)
        said.append(done.stdout)
    assert said[0] == said[1] and np.any(np.frombuffer(bytes.fromhex(said[0].strip())))


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
