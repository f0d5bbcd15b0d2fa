"""What a second process compiles while the first one makes a ThermalTouch."""

# mujoco ships no type stubs for its compiled names
# pyright: reportAttributeAccessIssue=false

import os
import subprocess
import sys
from pathlib import Path

import mujoco
import pytest

from thermograsp.beside import ALONE
from thermograsp.touch import ThermalTouch, ahead, prepare

SCENE = """
<mujoco><option gravity="0 0 0"/><worldbody>
  <body name="block"><geom type="box" size=".02 .02 .02"/></body>
  <body pos="0 0 .0245"><joint type="slide" axis="0 0 -1" damping="20"/>
    <geom name="pad" type="box" size=".01 .01 .004"/></body>
</worldbody></mujoco>"""
TOUCH = f"""
import gc, hashlib, sys
import mujoco, numpy as np
from numba.core.dispatcher import Dispatcher
from thermograsp.touch import ThermalTouch, ahead, prepare
SCENE = {SCENE!r}
"""
AHEAD = "getattr(ahead, sys.argv[1])()\nhow = 'cache_misses'\n"
FIRST = """
given = {"fingertips": {"tip": "pad"}, "objects": {"block": "steel"}}
worlds = None if sys.argv[1] == "compile_ahead" else 1
spec = mujoco.MjSpec.from_string(SCENE)
model = spec.compile() if worlds is None else prepare(spec, **given)
data, total = mujoco.MjData(model), hashlib.sha256()
touch = ThermalTouch(model, **given, worlds=worlds, seed=0)
data.qfrc_applied[0] = 5.0
for _ in range(100):
    mujoco.mj_step(model, data)
    reading = touch.update(data if worlds is None else data.sensordata[None])
    total.update(reading.voltage.tobytes())
assert np.all(reading.temperature_drop > 0.1)
how = "cache_hits"
"""
TELL = """
for one in gc.get_objects():
    ours = isinstance(one, Dispatcher) and one.py_func.__module__.startswith("thermograsp.")
    if ours and "Inner" not in one._compiler.pipeline_class.__name__:
        for arguments, count in getattr(one.stats, how).items():
            print(one.py_func.__module__, one.py_func.__name__, *arguments, sep=" ")
"""
READ = {
    "compile_ahead": ("read_contacts", "hear"),
    "compile_records_ahead": ("sense_contacts", "hear_record"),
}


def _model(worlds: int | None) -> mujoco.MjModel:
    spec = mujoco.MjSpec.from_string(SCENE)
    return spec.compile() if worlds is None else prepare(spec, {"tip": "pad"}, {"block": "steel"})


@pytest.mark.parametrize(("worlds", "expected"), [(None, "compile_ahead"), (2, "compile_records_ahead")])
def test_it_is_asked_for_what_will_hear(
    worlds: int | None, expected: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    if worlds is not None and not hasattr(mujoco.mjtSensor, "mjSENS_CONTACT"):
        pytest.skip("this MuJoCo has no contact sensors")
    asked: list[tuple[str, str, tuple[str, ...]]] = []

    def noted(module: str, *needed, by: str = "compile_ahead") -> None:
        asked.append((module, by, tuple(each.py_func.__name__ for each in needed)))

    monkeypatch.setattr(ahead, "compile_beside", noted)
    ThermalTouch(_model(worlds), fingertips={"tip": "pad"}, objects={"block": "steel"}, worlds=worlds)
    assert asked == [(ahead.__name__, expected, (READ[expected][0], "sample"))]
    assert callable(getattr(ahead, expected))


@pytest.mark.slow
@pytest.mark.parametrize("function", list(READ))
def test_what_is_compiled_ahead_is_what_a_first_touch_takes(tmp_path: Path, function: str) -> None:
    """All of it, and the bits are those of code that this run's own tests have compiled, or any before."""
    if function == "compile_records_ahead" and not hasattr(mujoco.mjtSensor, "mjSENS_CONTACT"):
        pytest.skip("this MuJoCo has no contact sensors")
    told = {}
    ahead_of_it = {"NUMBA_CACHE_DIR": str(tmp_path)}
    for kept, name, code in (
        (ahead_of_it, "ahead", AHEAD),
        (ahead_of_it, "touch", FIRST),
        ({}, "alone", FIRST),
    ):
        end = TELL if name != "alone" else ""
        end += "" if name == "ahead" else "print(total.hexdigest())\n"
        done = subprocess.run(
            [sys.executable, "-W", "ignore", "-c", TOUCH + code + end, function],
            env={**os.environ, **kept, ALONE: "1"},
            check=True,
            capture_output=True,
            text=True,
        )
        told[name] = done.stdout.splitlines()
    made, found = set(told["ahead"]), set(told["touch"][:-1])
    names = {line.split()[1] for line in made}
    assert {*READ[function], "sample", "close_sample", "measure_rows", "passive_states"} <= names
    assert made <= found
    assert told["touch"][-1] == told["alone"][-1]
