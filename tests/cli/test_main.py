"""The frame of the command line: version, help, exit statuses, and what is loaded when."""

import configparser
import json
import re
import subprocess
import sys
from importlib.metadata import PackageNotFoundError
from pathlib import Path
from types import ModuleType
from typing import NoReturn

import mujoco
import numpy as np
import pytest

import thermograsp
from thermograsp import cli
from thermograsp.cli import main
from thermograsp.cli.versions import OWN_WORK, versions
from thermograsp.errors import ThermograspError


def replace_run(monkeypatch: pytest.MonkeyPatch, raised: BaseException) -> None:
    """Lets the command `materials` raise."""

    def run(args: object) -> NoReturn:
        raise raised

    module = ModuleType("materials")
    module.HELP, module.run = "", run  # pyright: ignore[reportAttributeAccessIssue]
    module.add_arguments = lambda parser: None  # pyright: ignore[reportAttributeAccessIssue]
    monkeypatch.setattr(cli, "_command", lambda name: module)


def test_version(capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["--version"]) == 0
    assert capsys.readouterr().out == f"thermograsp {thermograsp.__version__}\n"


@pytest.mark.parametrize("argv", [["--version", "--json"], ["--json", "--version"]])
def test_versions_of_what_it_runs_on(argv: list[str], capsys: pytest.CaptureFixture[str]) -> None:
    setup = configparser.ConfigParser()
    setup.read(Path(__file__).parents[2] / "setup.cfg", encoding="utf-8")

    def names(text: str) -> set[str]:
        return set(re.findall(r"^(?!thermograsp|#)[\w-]+", text, re.MULTILINE))

    assert main(argv) == 0
    told = json.loads(capsys.readouterr().out)
    assert told["thermograsp"] == thermograsp.__version__
    assert told["python"] == ".".join(map(str, sys.version_info[:3]))
    assert set(told["packages"]) == names(setup["options"]["install_requires"])
    assert told["packages"]["numpy"] == np.__version__ and told["packages"]["mujoco"] == mujoco.__version__
    needed = {extra: names(text) for extra, text in setup["options.extras_require"].items()}
    assert {extra: set(found) for extra, found in told["extras"].items()} == {
        extra: found for extra, found in needed.items() if extra not in OWN_WORK
    }


def test_a_package_that_is_not_installed_has_no_version(monkeypatch: pytest.MonkeyPatch) -> None:
    def nothing(name: str) -> NoReturn:
        raise PackageNotFoundError(name)

    monkeypatch.setattr("importlib.metadata.version", nothing)
    assert set(versions()["packages"].values()) == {None}


@pytest.mark.parametrize("argv", [[], ["--help"]])
def test_help_lists_every_command(argv: list[str], capsys: pytest.CaptureFixture[str]) -> None:
    assert main(argv) == 0
    shown = capsys.readouterr().out
    assert all(name in shown for name in cli.COMMANDS)


@pytest.mark.parametrize("name", cli.COMMANDS)
def test_every_command_has_help(name: str, capsys: pytest.CaptureFixture[str]) -> None:
    assert main([name, "--help"]) == 0
    assert "--json" in capsys.readouterr().out


def test_an_error_of_ours_is_one_line(
    monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    replace_run(monkeypatch, ThermograspError("this\n  is wrong"))
    assert main(["materials"]) == 2
    assert capsys.readouterr() == ("", "thermograsp: this is wrong\n")


def test_an_interrupt_and_a_closed_pipe_are_quiet(
    monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    replace_run(monkeypatch, KeyboardInterrupt())
    assert main(["materials"]) == 130
    assert capsys.readouterr() == ("", "")


def test_a_reader_that_leaves_early_sees_no_traceback() -> None:
    command = f"{sys.executable} -m thermograsp materials --json | head -n 1"
    done = subprocess.run(command, shell=True, capture_output=True, text=True, check=True)
    assert (done.stdout, done.stderr) == ("{\n", "")


def test_only_the_chosen_command_is_loaded() -> None:
    code = (
        "import sys; from thermograsp.cli import main; main(['materials', 'glass'])\n"
        "unwanted = ('mujoco', 'matplotlib', 'rich', 'thermograsp.cli.demo')\n"
        "print([name for name in unwanted if name in sys.modules])"
    )
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    assert done.stdout.splitlines()[-1] == "[]"


BAD = {
    "demoo": "did you mean 'demo'",
    "press": "arguments are required: material",
    "press glas": "did you mean 'glass'",
    "press glass --seconds -1": "seconds must be a finite number above 0",
    "press glass --conductance nan": "conductance",
    "press glass --mode X": "mode",
    "press glass --rung gird_3d": "did you mean 'grid_3d'",
    "press glass --seconds ten": "invalid float value: 'ten'",
    "press glass --csv missing/folder/a.csv": "create it first",
    "press glass --csv .": "folder",
    "press glass --plot a.doc": "must end with .svg or .png or .pdf",
    "press glass --materials none.toml": "cannot read none.toml",
    "materials unobtainium": "unknown material 'unobtainium'",
    "materials --sort weight": "unknown property 'weight'",
    "materials --file none.toml": "cannot read none.toml",
    "grasp --material glas": "did you mean 'glass'",
    "grasp --force nan": "force (N) must be a finite number above 0, got nan",
    "grasp --force 1000": "force (N) must be at most 40",
    "grasp --seconds -1": "seconds",
    "grasp --seconds 1e9": "seconds must be at most 3600",
    "grasp --mode X": "mode must be 'T' or 'O'",
    "grasp --shape tetrahedron": "unknown shape",
    "grasp --width 0.2": "make it at most",
    "grasp --mesh none.stl": "no such file",
    "grasp --render a.mp4": "must end with",
    "grasp --csv missing/folder/a.csv": "create it first",
    "grasp --seed -1": "seed must be 0 or above",
    "rollout thermograsp/Grip-v0": "cannot run 'thermograsp/Grip-v0'",
    "rollout thermograsp/Grasp-v0 --episodes 0": "episodes must be at least 1",
    "rollout thermograsp/Grasp-v0 --policy clever": "unknown policy 'clever'",
    "rollout CartPole-v1": "needs a gripper's observations",
    "rollout CartPole-v1 --policy random": "cannot run 'CartPole-v1'",
    "demo --seed -1": "seed must be 0 or above",
}


@pytest.mark.parametrize(("line", "told"), BAD.items(), ids=BAD)
def test_bad_input_is_one_line_and_2(
    line: str, told: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.chdir(tmp_path)
    assert main(line.split()) == 2
    out, err = capsys.readouterr()
    assert out == ""
    assert err.count("\n") == 1 and told in err
    assert not list(tmp_path.iterdir())
