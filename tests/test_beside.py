"""Processes that compile at once: each function once, and a second process that never outlives the first one."""

import os
import subprocess
import sys
import time
from pathlib import Path

import pytest

from thermograsp import beside
from thermograsp.beside import ALONE, start_beside, turn

from .kernels import kernels, names

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


MET = {"gas_around", "footprint", "solid_conduction", "_reading", "measure_rows"}
CASES = {
    "compile_ahead": ({}, "kernel.advance_grasps", MET | {"advance_row", "workspace"}),
    "compile_boxes_ahead": (
        {"anywhere": True},
        "kernel.advance_boxes",
        MET
        | {"advance_fixed", "fixed_room", "_pressed", "_fill_under", "_beside", "strayed", "free_residues"}
        | {"_gram", "_body", "_box_heat", "_warmth", "free_kernels"},
    ),
    "compile_fields_ahead": (
        {"objects": "golf_ball"},
        "",
        {"advance_fields", "passive_states", "_element_states", "_fill", "begin_contacts"}
        | {"meet_rows", "tell_fields", "tell_temperatures", "measure_rows"},
    ),
}
"""By what compiles ahead: settings of the environment whose first step finds it, the function by which that step
advances where it is compiled by the step itself, and some of what it is to find."""


@pytest.mark.slow
@pytest.mark.parametrize("function", CASES)
def test_what_is_compiled_ahead_is_what_a_step_needs(function: str) -> None:
    """Of the same types, or it would be compiled in vain. Nothing has to be compiled anew to tell that."""
    keywords, own, needed = CASES[function]
    step = f"""
import gymnasium, numpy as np, thermograsp
from numba.core.caching import NullCache
from thermograsp.envs.sensing import kernel
if {own!r}:
    {own or "kernel"}._cache = NullCache()  # what is inside is looked for, as where this is on no disk yet
env = gymnasium.make("thermograsp/Grasp-v0", **{keywords})
env.reset(seed=0)
for _ in range(40):
    env.step(np.array([-1, 0, 0], np.float32))
"""
    ahead = kernels(f"from thermograsp.envs.sensing import ahead; ahead.{function}()")
    assert needed <= names(ahead)
    missed = {line for line in kernels(step) - ahead if line.split()[3] in needed}
    assert not missed
    if own:
        assert own.split(".")[1] not in names(ahead)


@pytest.mark.slow
def test_a_second_process_compiles_what_a_mesh_needs(tmp_path: Path) -> None:
    """A first mesh finds it, also what the mesh's networks are solved with."""
    mesh = """
import gymnasium, numpy as np, thermograsp
env = gymnasium.make("thermograsp/Grasp-v0", objects="mug")
env.reset(seed=0)
env.step(np.array([-1, 0, 0], np.float32))
"""
    needed = {"_factor", "_iterate", "_multiply", "_accumulate", "_pieces", "within_cube", "crossed_above"}
    needed |= {"pressure_map"}
    networks = {"THERMOGRASP_CACHE": str(tmp_path)}
    code = "from thermograsp.envs.sensing.mesh_ahead import compile_ahead; compile_ahead()"
    ahead = kernels(code, **networks)
    assert needed <= names(ahead)
    assert not {line for line in kernels(mesh, **networks) - ahead if line.split()[3] in needed}
