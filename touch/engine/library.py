"""The plugin's library: built once with the machine's own compiler, kept in the cache, loaded once by a process."""

# mujoco ships no type stubs for its compiled names
# pyright: reportAttributeAccessIssue=false

from __future__ import annotations

import hashlib
import os
import platform
import shlex
import subprocess
import threading
from functools import cache
from pathlib import Path

import mujoco

from thermograsp.errors import MissingDependencyError, ThermograspError
from thermograsp.files import cached_file
from thermograsp.notice import busy

_FOLDER = Path(__file__).parent
_OPTIONS = ("-std=c11", "-O3", "-fPIC", "-shared", "-fvisibility=hidden", "-Wall", "-Wextra")
# Sums keep their order and nothing is fused, in which compilers and processors would differ.
_SUMS = ("-fno-math-errno", "-fno-trapping-math", "-fno-signed-zeros", "-ffp-contract=off")
_LOCK = threading.Lock()


def load_plugin() -> Path:
    """Makes MuJoCo know the plugin "thermograsp.heat", which models with heat in them need before they are compiled or
    loaded; a second call does nothing. Returns the library's file, which C programs load by mj_loadPluginLibrary.

    The first call of a mujoco version builds it in a second or two, with the compiler that $CC names, else cc. Raises
    MissingDependencyError where there is no compiler, and ThermograspError with what the compiler says."""
    with _LOCK:
        return _loaded()


@cache
def _loaded() -> Path:
    path = library()
    mujoco.mj_loadPluginLibrary(str(path))
    return path


def library() -> Path:
    """The built library in the cache."""
    sources = {
        path.name: hashlib.sha256(path.read_bytes()).hexdigest() for path in sorted(_FOLDER.glob("*.[ch]"))
    }
    key = {
        "sources": sources,
        "mujoco": mujoco.__version__,
        "folder": str(Path(mujoco.__path__[0])),
        "machine": platform.machine(),
        "compiler": os.environ.get("CC", "cc"),
    }
    return cached_file(key, ".so", build)


def build(path: Path, *options: str) -> None:
    """Compiles the plugin to that path, with more options of the compiler."""
    home = Path(mujoco.__path__[0])
    found = sorted(home.glob("libmujoco.so*")) + sorted(home.glob("libmujoco*.dylib"))
    if not found:
        raise MissingDependencyError(f"there is no libmujoco in {home}: install mujoco from its wheel")
    # Where the library lies is told by the process that has it loaded; the path serves C programs.
    command = [
        *shlex.split(os.environ.get("CC", "cc")),
        *(*_OPTIONS, *_SUMS, *options),
        f"-I{home / 'include'}",
        *(str(source) for source in sorted(_FOLDER.glob("*.c"))),
        *("-o", str(path), str(found[0]), f"-Wl,-rpath,{home}", "-lm"),
    ]
    try:
        with busy("building the plugin of MuJoCo"):
            done = subprocess.run(command, capture_output=True, text=True, check=False)
    except FileNotFoundError:
        raise MissingDependencyError(
            f"heat inside MuJoCo's step needs a C compiler, and there is no {command[0]!r}: install gcc or clang, or "
            "name yours by the variable CC; ThermalTouch needs none"
        ) from None
    if done.returncode:
        raise ThermograspError(f"{shlex.join(command)} failed:\n{done.stderr.strip()}")
