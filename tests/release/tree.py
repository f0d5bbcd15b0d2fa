"""A fresh clone, and an environment of its own to run in."""

import os
import shutil
import subprocess
from collections.abc import Mapping, Sequence
from pathlib import Path

ROOT = Path(__file__).parents[2]


def sources() -> list[str]:
    """Paths of the files of the repository, as they are in the working tree."""
    command = ["git", "ls-files", "-z", "--cached", "--others", "--exclude-standard"]
    listed = subprocess.run(command, cwd=ROOT, capture_output=True, text=True, check=True).stdout
    return sorted(name for name in listed.split("\0") if name and (ROOT / name).is_file())


def clone(folder: Path) -> Path:
    """A copy of them in a new folder."""
    for name in sources():
        (folder / name).parent.mkdir(parents=True, exist_ok=True)
        shutil.copy2(ROOT / name, folder / name)
    return folder


def clean_environment(home: Path) -> dict[str, str]:
    """Of a user who has just logged in, with an empty home: nothing of Python's, of make's or of ours is set. What pip
    has downloaded before, and where it downloads from, stays, and what has been compiled where NUMBA_CACHE_DIR says."""
    ours = tuple("PYTHON MAKE MFLAGS VIRTUAL_ENV VENV THERMOGRASP MUJOCO_GL XDG_CACHE_HOME".split())
    kept = {name: value for name, value in os.environ.items() if not name.startswith(ours)}
    kept.setdefault("PIP_CACHE_DIR", str(Path.home() / ".cache" / "pip"))
    config = Path.home() / ".config" / "pip" / "pip.conf"
    if config.is_file():
        kept.setdefault("PIP_CONFIG_FILE", str(config))
    return {**kept, "HOME": str(home)}


def run(command: Sequence[str | Path], folder: Path, environment: Mapping[str, str]) -> str:
    """Its output. Fails with everything that it said where it fails."""
    done = subprocess.run(
        list(map(str, command)), cwd=folder, env=environment, capture_output=True, text=True, timeout=1800
    )
    assert done.returncode == 0, f"{command}\n{done.stdout}\n{done.stderr}"
    return done.stdout
