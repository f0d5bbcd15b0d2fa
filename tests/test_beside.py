"""Processes that compile at once: each function once, and a second process that never outlives the first one."""

import os
import subprocess
import sys
import time
from pathlib import Path
from typing import Any

import pytest

from thermograsp import beside
from thermograsp.beside import ALONE, start_beside, turn

pytestmark = pytest.mark.skipif(os.name != "posix", reason="this system has no locks")

HOLD = """
import sys, time
from thermograsp.beside import turn
with turn(sys.argv[1], 7) as own:
    print(own, flush=True)
    sys.stdin.read()
"""


def holder(folder: Path) -> subprocess.Popen[str]:
    """A process that has the turn until its stdin ends."""
    process = subprocess.Popen(
        [sys.executable, "-c", HOLD, str(folder)], stdin=subprocess.PIPE, stdout=subprocess.PIPE, text=True
    )
    assert process.stdout is not None
    assert process.stdout.readline() == "True\n"
    return process


def test_one_enters_at_a_time(tmp_path: Path) -> None:
    with holder(tmp_path) as other:
        with turn(str(tmp_path), 7, wait=False) as taken:
            assert not taken
        with turn(str(tmp_path), 8, wait=False) as taken:
            assert taken
        assert other.stdin is not None
        other.stdin.close()
        with turn(str(tmp_path), 7) as taken:
            assert taken


def test_a_process_that_is_killed_holds_nothing(tmp_path: Path) -> None:
    with holder(tmp_path) as other:
        other.kill()
        with turn(str(tmp_path), 7) as taken:
            assert taken


def test_nobody_waits_for_ever(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(beside, "_PATIENCE", 0.05)
    with holder(tmp_path) as other:
        with turn(str(tmp_path), 7) as taken:
            assert not taken
        other.kill()


def test_a_turn_may_be_taken_within_another_and_again(tmp_path: Path) -> None:
    for _ in range(2):
        with turn(str(tmp_path), 1) as one, turn(str(tmp_path), 2) as other:
            assert one and other


def test_without_a_folder_nobody_waits(tmp_path: Path) -> None:
    with turn(str(tmp_path / "none"), 7) as taken:
        assert not taken


@pytest.fixture
def module(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> str:
    """A module whose compile_ahead notes the process, and goes on for ever."""
    (tmp_path / "ahead_of.py").write_text(f"""
import os, pathlib, time
def compile_ahead():
    new = pathlib.Path({str(tmp_path / "new")!r})
    new.write_text(str(os.getpid()))
    new.rename({str(tmp_path / "started")!r})  # whole, or not there: the first process may end at once
    time.sleep(999)
""")
    monkeypatch.syspath_prepend(str(tmp_path))
    monkeypatch.delenv(ALONE, raising=False)
    monkeypatch.setattr(beside, "_processors", lambda: 2)
    return "ahead_of"


def started(folder: Path, seconds: float) -> int | None:
    """The id of the process that has started within that time."""
    until = time.monotonic() + seconds
    while time.monotonic() < until:
        try:
            return int((folder / "started").read_text())
        except (OSError, ValueError):  # not there, or not written yet
            time.sleep(0.01)
    return None


def gone(process: int) -> bool:
    """Whether a process has ended, or ends soon."""
    until = time.monotonic() + 60
    while time.monotonic() < until:
        try:
            state = Path(f"/proc/{process}/stat").read_text().rpartition(")")[2].split()[0]
        except OSError:
            return True
        if state == "Z":
            return True
        time.sleep(0.01)
    return False


@pytest.mark.skipif(not Path("/proc/self/stat").exists(), reason="needs /proc")
@pytest.mark.parametrize("end", ["", "import os; os._exit(1)", "import os; os.kill(os.getpid(), 9)"])
def test_the_second_process_ends_with_the_first(tmp_path: Path, module: str, end: str) -> None:
    code = f"""
import sys, time, pathlib
from thermograsp import beside
beside._processors = lambda: 2
beside.start_beside({module!r}, {str(tmp_path)!r})
while not pathlib.Path({str(tmp_path / "started")!r}).exists():
    time.sleep(0.01)
{end}
"""
    environment = {**os.environ, "PYTHONPATH": str(tmp_path)}
    subprocess.run([sys.executable, "-c", code], env=environment, timeout=120)
    process = started(tmp_path, 10)
    assert process is not None and gone(process)


def test_none_is_started_where_it_would_not_help(
    tmp_path: Path, module: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    def refused(*_: object, **__: object) -> None:
        raise AssertionError("it was started")

    monkeypatch.setattr(subprocess, "Popen", refused)
    with pytest.raises(AssertionError, match="it was started"):
        start_beside(module, str(tmp_path))
    start_beside(module, str(tmp_path / "none"))
    with monkeypatch.context() as patch:
        patch.setenv(ALONE, "1")
        start_beside(module, str(tmp_path))
    with monkeypatch.context() as patch:
        patch.setattr(beside, "_processors", lambda: 1)
        start_beside(module, str(tmp_path))
    with monkeypatch.context() as patch:
        patch.setattr(sys, "executable", None)
        start_beside(module, str(tmp_path))


PLATES = """
from thermograsp.envs.sensing.kernel import advance_grasps as step, advance_row, workspace
inner, entries = [advance_row, workspace], []
"""
BOXES = """
from thermograsp.envs.sensing.kernel import advance_boxes as step, advance_fixed, fixed_room
from thermograsp.envs.sensing.places import strayed
from thermograsp.thermal.batch import remembered, residues
from thermograsp.thermal.kernels import axis, touched
from thermograsp.thermal.numerics.passive_residues import _residues, free_residues
inner = [advance_fixed, fixed_room]
entries = [_residues, free_residues, strayed]
entries += [residues._gram, residues._body, remembered._box_heat, remembered._warmth]
entries += [touched._samples, touched._warmed, touched._beside, axis.free_kernels]
"""
FIELDS = """
import importlib
from thermograsp.envs.sensing import field_kernel
from thermograsp.envs.sensing.kernel import meet_rows
from thermograsp.thermal.numerics.passive_residues import _residues
table = importlib.import_module("thermograsp.thermal.contact.curved_table")
states = importlib.import_module("thermograsp.thermal.kernels.contact")
step, inner = field_kernel.advance_fields, []
entries = [_residues, states._element_states, states.rate_states, table._fill, table.begin_contacts]
entries += [meet_rows, field_kernel.tell_fields, field_kernel.tell_temperatures]
"""


@pytest.mark.slow
@pytest.mark.parametrize(
    ("function", "keywords", "needed", "steps"),
    [
        ("compile_ahead", {}, PLATES, "1"),
        ("compile_boxes_ahead", {"anywhere": True}, BOXES, "1"),
        ("compile_fields_ahead", {"objects": "golf_ball"}, FIELDS, "0"),
    ],
)
def test_what_is_compiled_ahead_is_what_a_step_needs(
    tmp_path: Path, function: str, keywords: dict[str, Any], needed: str, steps: str
) -> None:
    """The first step finds it, and senses the same bits as with code that this run's own tests have compiled, or any
    before. steps: compiled by itself all the same, what advances a step."""
    step = f"""
import hashlib
import gymnasium, numpy as np, thermograsp
from thermograsp.envs.sensing import kernel
from thermograsp.thermal.readout import measure_rows
{needed}
env = gymnasium.make("thermograsp/Grasp-v0", **{keywords})
env.reset(seed=0)
total = hashlib.sha256()
for _ in range(40):
    observation = env.step(np.array([-1, 0, 0], np.float32))[0]
    total.update(observation["voltage"].tobytes())
inner += [kernel.gas_conduction, kernel.footprint, kernel.solid_conduction, kernel._reading]
ahead = [one.called() for one in inner] + [measure_rows, *entries]
missed = sum(sum(one.stats.cache_misses.values()) for one in ahead)
print(missed, sum(step.stats.cache_misses.values()), total.hexdigest())
"""
    printed = []
    for kept, code in (
        (
            {"NUMBA_CACHE_DIR": str(tmp_path)},
            f"from thermograsp.envs.sensing import ahead; ahead.{function}()",
        ),
        ({}, ""),
    ):
        environment = {**os.environ, **kept, ALONE: "1"}
        subprocess.run([sys.executable, "-c", code], env=environment, check=True)
        done = subprocess.run(
            [sys.executable, "-c", step], env=environment, check=True, capture_output=True, text=True
        )
        printed.append(done.stdout.split())
    (missed, compiled, found), (_, _, alone) = printed
    assert (missed, compiled, found) == ("0", steps, alone)


@pytest.mark.slow
def test_a_second_process_compiles_what_a_mesh_needs(tmp_path):
    """A first mesh finds it, also what the mesh's networks are solved with."""
    mesh = """
import gymnasium, numpy as np, thermograsp
from thermograsp.thermal.meshes import patch, place, solve
from thermograsp.thermal.surfaces import cut, rays
from thermograsp.thermal.pressed import foundation
env = gymnasium.make("thermograsp/Grasp-v0", objects="mug")
env.reset(seed=0)
env.step(np.array([-1, 0, 0], np.float32))
ahead = [solve._factor, solve._iterate, solve._multiply, cut._accumulate, patch._pieces, place.within_cube]
ahead += [rays.crossed_above, foundation.pressure_map]
print(*(sum(one.stats.cache_misses.values()) for one in ahead))
"""
    environment = {**os.environ, "NUMBA_CACHE_DIR": str(tmp_path / "code"), ALONE: "1"}
    environment["THERMOGRASP_CACHE"] = str(tmp_path / "networks")
    code = "from thermograsp.envs.sensing.mesh_ahead import compile_ahead; compile_ahead()"
    subprocess.run([sys.executable, "-c", code], env=environment, check=True)
    done = subprocess.run(
        [sys.executable, "-c", mesh], env=environment, check=True, capture_output=True, text=True
    )
    assert set(done.stdout.split()) == {"0"}
