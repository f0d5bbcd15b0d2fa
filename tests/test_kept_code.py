"""Compiled code on disk that is damaged, of another numba, another user's, or that can be kept nowhere."""

import os
import subprocess
import sys
import tempfile
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

import pytest

from thermograsp.beside import ALONE
from thermograsp.compiled import beside, cache, compile_beside, njit
from thermograsp.compiled.cache_file import CacheFile

KEY, CODE = ("float64",), {"code": b"0123456789" * 100}
DAMAGES: dict[str, Callable[[bytes], bytes]] = {
    "empty": lambda content: b"",
    "cut off": lambda content: content[: len(content) // 2],
    "zeros": lambda content: bytes(len(content)),
    "one bit": lambda content: content[:-9] + bytes([content[-9] ^ 1]) + content[-8:],
}

NOBODY = 65534
KERNELS = """
from thermograsp.compiled import njit

@njit(cache=True)
def doubled(x):
    return 2 * x

@njit(cache=True)
def tripled(x):
    return 3 * x
"""
READER = """
import os, sys, warnings
from thermograsp.compiled import njit
njit()(lambda x: x)(1.5)  # what numba imports late may lie where only root can read
if os.geteuid() != (user := int(sys.argv[1])):
    os.setgroups([]), os.setgid(user), os.setuid(user)
with warnings.catch_warnings(record=True) as said:
    warnings.simplefilter("always")
    import kernels
    for kernel, value in ((kernels.doubled, 1.5), (kernels.doubled, 1), (kernels.tripled, 1.5)):
        before = sum(kernel.stats.cache_hits.values())
        kernel(value)
        found = sum(kernel.stats.cache_hits.values()) > before
        print(f"{kernel.py_func.__name__}({value}): {'found' if found else 'compiled'}")
for one in said:
    print(one.message)
"""
unix = pytest.mark.skipif(sys.platform == "win32", reason="users and modes of files are POSIX's")


@pytest.fixture
def kept(tmp_path: Path) -> CacheFile:
    file = CacheFile(str(tmp_path), "kernel", "stamp")
    file.save(KEY, CODE)
    return file


def test_what_is_kept_is_found_by_who_compiles_the_same(kept: CacheFile, tmp_path: Path) -> None:
    assert kept.load(KEY) == CODE and kept.load(("int64",)) is None
    assert CacheFile(str(tmp_path), "kernel", "stamp").load(KEY) == CODE
    assert CacheFile(str(tmp_path), "kernel", "another stamp").load(KEY) is None


@pytest.mark.parametrize("suffix", [".nbi", ".nbc"])
@pytest.mark.parametrize("damage", DAMAGES.values(), ids=DAMAGES)
def test_a_damaged_file_is_as_good_as_none(
    kept: CacheFile, tmp_path: Path, suffix: str, damage: Callable[[bytes], bytes]
) -> None:
    (path,) = tmp_path.glob(f"*{suffix}")
    path.write_bytes(damage(path.read_bytes()))
    assert kept.load(KEY) is None
    kept.save(KEY, CODE)
    assert kept.load(KEY) == CODE


def test_an_index_of_another_numba_is_not_read(kept: CacheFile, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(kept, "_version", "0.0")
    assert kept.load(KEY) is None


@pytest.fixture(scope="module")
def others() -> Iterator[Path]:
    """A folder with kernels' module and a cache with one of them, for one kind of argument, which every user may read
    and this one may write."""
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        (folder / "kernels.py").write_text(KERNELS)
        folder.chmod(0o755)
        subprocess.run(
            [sys.executable, "-c", "import kernels; kernels.doubled(1.5)"],
            env=os.environ
            | {
                "NUMBA_CACHE_DIR": str(folder / "cache"),
                "PYTHONPATH": os.pathsep.join([str(folder), *sys.path]),
            },
            check=True,
        )
        yield folder


def run_as_reader(others: Path, home: Path) -> list[str]:
    """Calls both kernels as a user that may write nothing but what is below `home`, if that is there. Returns what each
    call found or compiled, and the warnings."""
    environment = os.environ | {"HOME": str(home), "XDG_CACHE_HOME": str(home), ALONE: "1"}
    environment |= {
        "NUMBA_CACHE_DIR": str(others / "cache"),
        "PYTHONPATH": os.pathsep.join([str(others), *sys.path]),
    }
    root = os.geteuid() == 0
    if not root:
        subprocess.run(["chmod", "-R", "a-w", others], check=True)
    done = subprocess.run(
        [sys.executable, "-c", READER, str(NOBODY if root else os.geteuid())],
        env=environment,
        capture_output=True,
        text=True,
    )
    if not root:
        subprocess.run(["chmod", "-R", "u+w", others], check=True)
    assert done.returncode == 0, done.stderr
    return done.stdout.splitlines()


def test_numba_has_its_places_in_this_order() -> None:
    places = [place.__name__.removeprefix("_") for place in (cache._Chosen, cache._BesideSource)]
    assert places == ["UserProvidedCacheLocator", "InTreeCacheLocator"]


def test_copies_of_the_package_share_a_folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("numba.config.CACHE_DIR", str(tmp_path / "code"))

    def path(copy: str, module: str) -> Path:
        source = tmp_path / copy / "kernel.py"
        source.parent.mkdir(exist_ok=True)
        source.write_text(text := "def kernel(x):\n    return x\n")
        scope: dict[str, Any] = {"__name__": module}
        exec(compile(text, str(source), "exec"), scope)
        return Path(cache._ByModule.from_function(scope["kernel"], str(source)).get_cache_path())

    one = path("one", "thermograsp.thermal.kernel")
    assert one == path("other", "thermograsp.thermal.kernel")
    assert one != path("one", "thermograsp.touch.kernel")
    assert path("one", "kernel") != path("other", "kernel")
    assert one.parents[1] == tmp_path / "code"


@unix
def test_what_others_have_compiled_is_read_where_it_cannot_be_written(others: Path) -> None:
    said = run_as_reader(others, others / "no home")
    assert said[:3] == ["doubled(1.5): found", "doubled(1): compiled", "tripled(1.5): compiled"]
    (warning,) = said[3:]
    assert "cannot keep compiled code (Permission denied)" in warning and "set NUMBA_CACHE_DIR" in warning


@unix
def test_what_others_have_not_compiled_is_kept_in_the_user_s_own_folder(others: Path) -> None:
    home = others / "home"
    home.mkdir()
    if os.geteuid() == 0:
        os.chown(home, NOBODY, NOBODY)
    before = sorted((others / "cache").rglob("*"))
    compiled_, found = (
        ["doubled(1): compiled", "tripled(1.5): compiled"],
        ["doubled(1): found", "tripled(1.5): found"],
    )
    assert run_as_reader(others, home) == ["doubled(1.5): found", *compiled_]
    assert run_as_reader(others, home) == ["doubled(1.5): found", *found]
    assert sorted((others / "cache").rglob("*")) == before


def test_code_of_text_that_was_executed_is_kept_nowhere(monkeypatch: pytest.MonkeyPatch) -> None:
    started: list[str] = []
    monkeypatch.setattr(beside, "start_beside", lambda module, folder: started.append(module))
    names: dict[str, Any] = {}
    exec("def doubled(x):\n    return 2.0 * x\n", names)
    doubled = njit(cache=True)(names["doubled"])
    compile_beside("none", doubled)
    assert doubled(1.5) == 3.0 and not started
