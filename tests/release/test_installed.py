"""The wheel in an environment with nothing but what it asks for."""

import json
import sys
from dataclasses import dataclass
from pathlib import Path

import pytest

import thermograsp

from .conftest import Release
from .tree import clean_environment, run

EPISODE = """
import gymnasium, thermograsp
from thermograsp.envs import action_of

env = gymnasium.make("thermograsp/Grasp-v0", material="glass")
observation, info = env.reset(seed=0)
for _ in range(50):
    observation, reward, terminated, truncated, info = env.step(action_of(0.0, 10.0, 0.0))
assert info["temperature_drop"].min() > 1.0, info
print(info["material"], thermograsp.__file__)
"""
IMPORTS = """
import importlib, pkgutil, thermograsp
from thermograsp.errors import MissingDependencyError

count = 0
for module in pkgutil.walk_packages(thermograsp.__path__, "thermograsp."):
    if module.name == "thermograsp.__main__":
        continue
    try:
        importlib.import_module(module.name)
    except MissingDependencyError as error:
        print(module.name, error)
    count += 1
print(count)
"""


@dataclass(frozen=True, slots=True)
class Installed:
    """scripts: folder of its programs. folder: an empty one to work in."""

    scripts: Path
    folder: Path
    environment: dict[str, str]

    def run(self, *words: str) -> str:
        return run([self.scripts / words[0], *words[1:]], self.folder, self.environment)


@pytest.fixture(scope="module")
def installed(release: Release, tmp_path_factory: pytest.TempPathFactory) -> Installed:
    folder = tmp_path_factory.mktemp("installed")
    environment = clean_environment(tmp_path_factory.mktemp("home"))
    environment["THERMOGRASP_CACHE"] = str(tmp_path_factory.mktemp("networks"))
    run([sys.executable, "-m", "venv", folder / "venv"], folder, environment)
    scripts = folder / "venv" / "bin"
    run(
        [scripts / "python", "-m", "pip", "install", "-q", "--no-compile", release.wheel], folder, environment
    )
    (folder / "work").mkdir()
    return Installed(scripts, folder / "work", environment)


def test_versions(installed: Installed) -> None:
    versions = json.loads(installed.run("thermograsp", "--version", "--json"))
    assert versions["thermograsp"] == thermograsp.__version__
    assert None not in versions["packages"].values()
    assert versions["extras"]["hardware"] == {"pymodbus": None, "pyserial": None}
    assert (
        installed.run("python", "-m", "thermograsp", "--version")
        == f"thermograsp {thermograsp.__version__}\n"
    )


def test_commands(installed: Installed) -> None:
    assert "aluminium" in installed.run("thermograsp", "materials")
    assert "network" in installed.run("thermograsp", "press", "glass")


def test_an_episode(installed: Installed) -> None:
    material, file = installed.run("python", "-c", EPISODE).split()
    assert material == "glass" and "site-packages" in file
    assert (Path(file).parent / "py.typed").is_file()


def test_every_module_imports_or_names_its_extra(installed: Installed) -> None:
    *missing, count = installed.run("python", "-c", IMPORTS).splitlines()
    assert int(count) > 200
    assert all("pip install" in line for line in missing), missing


def test_nothing_is_left_in_the_folder_of_work(installed: Installed) -> None:
    assert [path.name for path in installed.folder.iterdir()] == []
