"""The frame of the command line: version, help, exit statuses, and what is loaded when."""

import argparse
import configparser
import io
import json
import logging
import re
import shlex
import subprocess
import sys
from collections.abc import Iterator
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
from thermograsp.cli.shared import Output, described
from thermograsp.cli.shared.versions import DEVELOPMENT, versions
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
    versions = json.loads(capsys.readouterr().out)
    assert versions["thermograsp"] == thermograsp.__version__
    assert versions["python"] == ".".join(map(str, sys.version_info[:3]))
    assert set(versions["packages"]) == names(setup["options"]["install_requires"])
    assert (
        versions["packages"]["numpy"] == np.__version__
        and versions["packages"]["mujoco"] == mujoco.__version__
    )
    needed = {extra: names(text) for extra, text in setup["options.extras_require"].items()}
    assert {extra: set(found) for extra, found in versions["extras"].items()} == {
        extra: found for extra, found in needed.items() if extra not in DEVELOPMENT
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
    command = f"{shlex.quote(sys.executable)} -m thermograsp materials --json | head -n 1"
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
    "press glass --skin filled_silicon": "did you mean 'filled_silicone'",
    "press glass --seconds ten": "invalid float value: 'ten'",
    "press glass --csv missing/folder/a.csv": "create it first",
    "press glass --csv .": "folder",
    "press glass --plot a.doc": "must end with .svg or .png or .pdf",
    "press glass --materials none.toml": "cannot read none.toml",
    "materials unobtainium": "unknown material 'unobtainium'",
    "materials --sort weight": "unknown property 'weight'",
    "materials --materials none.toml": "cannot read none.toml",
    "grasp --material glas": "did you mean 'glass'",
    "grasp --force nan": "force (N) must be a finite number above 0, got nan",
    "grasp --force 1000": "force (N) must be at most 40",
    "grasp --seconds -1": "seconds",
    "grasp --seconds 1e9": "seconds must be at most 3600",
    "grasp --skin filled_silicon": "did you mean 'filled_silicone'",
    "grasp --skin filled_silicone --mode O": "a skin is what touches the object",
    "grasp --surround silicone_": "did you mean 'silicone'",
    "grasp --surround silicone --mode O": "a surround is around the element of a fingertip",
    "grasp --surround silicone --object screwdriver": "has parts, and the heat of a pad",
    "device emulate --skin filled_silicon": "did you mean 'filled_silicone'",
    "grasp --mode X": "mode must be 'T' or 'O'",
    "grasp --shape tetrahedron": "unknown shape",
    "grasp --width 0.2": "make it at most",
    "grasp --mesh none.stl": "no such file",
    "grasp --render a.mp4": "must end with",
    "grasp --csv missing/folder/a.csv": "create it first",
    "grasp --seed -1": "seed must be a whole number, 0 or above, got -1",
    "grasp --seed 1.5": "seed must be a whole number, 0 or above, got 1.5",
    "grasp --scale 0.001": "--scale is for meshes: give --mesh FILE too",
    "grasp --mesh none.stl --shape sphere --height 0.03": "leave out --shape and --height",
    "grasp --shape sphere --width 0.03 --height 0.02": "as high as wide, 0.03 m: leave out --height 0.02",
    "view --scale 0.001": "--scale is for meshes: give --mesh FILE too",
    "dataset --episodes 1 --set seconds=1 seconds=2": "--set seconds=1 seconds=2: give every name once",
    "rollout thermograsp/Grip-v0": "cannot run 'thermograsp/Grip-v0'",
    "rollout thermograsp/Grasp-v0 --episodes 0": "episodes must be at least 1",
    "rollout thermograsp/Grasp-v0 --policy clever": "unknown policy 'clever'",
    "rollout CartPole-v1": "needs a gripper's observations",
    "rollout CartPole-v1 --policy random": "cannot run 'CartPole-v1'",
    "demo --seed -1": "seed must be a whole number, 0 or above",
}


@pytest.mark.parametrize("line", ["--json materials glas", "materials --json glas", "materials glas --json"])
def test_an_error_is_a_document_too(line: str, capsys: pytest.CaptureFixture[str]) -> None:
    assert main(line.split()) == 2
    out, err = capsys.readouterr()
    printed = json.loads(out)
    assert printed["status"] == 2 and printed["error"]["kind"] == "UnknownNameError"
    assert "did you mean 'glass'" in printed["error"]["message"] and err.count("\n") == 1


@pytest.mark.parametrize(
    "line", ["--json materials glass", "materials --json glass", "materials glass --json"]
)
def test_json_may_stand_anywhere(line: str, capsys: pytest.CaptureFixture[str]) -> None:
    assert main(line.split()) == 0
    assert json.loads(capsys.readouterr().out)["materials"][0]["name"] == "glass"


@pytest.mark.parametrize("line", ["--verbose device list", "device --verbose list", "device list --verbose"])
def test_verbose_may_stand_anywhere(line: str, capsys: pytest.CaptureFixture[str]) -> None:
    logger = logging.getLogger("thermograsp")
    before = logger.level
    try:
        assert main(line.split()) == 0
        assert logger.level == logging.INFO
    finally:
        logger.setLevel(before)


OLD = {
    "materials --file none.toml": ("--materials", "cannot read none.toml"),
    "view --record x.mp4": ("--render", "must end with"),
    "gripper check none.xml --png x.gif": ("--render", "must end with"),
    "identify none.csv --out x.doc": ("--plot", "must end with"),
    "grasp --temperature -300": ("--object-temperature", "must be a temperature"),
    "device fit glass=FILE --out sensor.txt": ("--save", ".toml"),
    "device fit glass=FILE --temperature 20 --save sensor.txt": ("--object-temperature", ".toml"),
}


@pytest.mark.parametrize(("line", "new"), OLD.items(), ids=OLD)
def test_old_names_of_options_go_on_and_say_so(
    line: str, new: tuple[str, str], capsys: pytest.CaptureFixture[str]
) -> None:
    assert main(line.split()) == 2
    first, second = capsys.readouterr().err.splitlines()
    assert first.endswith(f"is an old name of {new[0]}")
    assert new[1] in second


def leaves(parser: argparse.ArgumentParser) -> Iterator[argparse.ArgumentParser]:
    below = [action for action in parser._actions if isinstance(action, argparse._SubParsersAction)]
    if not below:
        yield parser
    for action in below:
        for sub in action.choices.values():
            yield from leaves(sub)


def test_one_name_for_one_thing() -> None:
    """Folders, tables, plots, pictures and temperatures have the same option in all commands."""
    meant = {
        "--out": "DIR",
        "--csv": "FILE",
        "--plot": "FILE",
        "--render": "FILE",
        "--save": "FILE",
        "--materials": "FILE",
    }
    gone = {"--png", "--file", "--record", "--temperature"}
    for parser in leaves(cli.command_parser([])):
        for action in parser._actions:
            if action.help == argparse.SUPPRESS:
                continue
            for name in action.option_strings:
                assert action.metavar == meant.get(name, action.metavar), (parser.prog, name)
                assert name not in gone, (parser.prog, name)


@pytest.mark.parametrize(("line", "message"), BAD.items(), ids=BAD)
def test_bad_input_is_one_line_and_2(
    line: str,
    message: str,
    tmp_path: Path,
    monkeypatch: pytest.MonkeyPatch,
    capsys: pytest.CaptureFixture[str],
) -> None:
    monkeypatch.chdir(tmp_path)
    assert main(line.split()) == 2
    out, err = capsys.readouterr()
    assert out == ""
    assert err.count("\n") == 1 and message in err
    assert not list(tmp_path.iterdir())


def arguments(parser: argparse.ArgumentParser) -> Iterator[tuple[str, argparse.Action]]:
    """Those that --help shows, of all commands, with the command's name."""
    for action in parser._actions:
        if isinstance(action, argparse._SubParsersAction):
            for sub in action.choices.values():
                yield from arguments(sub)
        elif action.help != argparse.SUPPRESS:
            yield parser.prog, action


def test_help_shows_the_parser_s_own_defaults() -> None:
    """Once each, and none is typed into the text: of a changed default --help tells at once."""
    every = list(arguments(cli.command_parser([])))
    with_default = 0
    for command, action in every:
        text = described(action)
        given = action.default not in (None, False, argparse.SUPPRESS, "", [])
        with_default += given and action.nargs != 0
        said = [part for part in re.findall(r"\(default[^)]*\)", text) if part != "(default)"]
        assert len(said) == (1 if given and action.nargs != 0 else len(said)), (command, action.dest)
        assert not re.search(r"\(default [^:]", action.help or ""), (command, action.dest)
    assert with_default > 60
    by_name = {(command, action.dest): described(action) for command, action in every}
    assert by_name["thermograsp press", "object_size"] == "size of the object, m (default 0.04 0.04 0.01)"
    assert by_name["thermograsp press", "area"].endswith(
        "(default: 81e-6, or the area of the sensor's face if that is smaller)"
    )


def test_help_can_be_read_without_the_option_s_name() -> None:
    fragment = re.compile(r"(of|as|at|on|over|in|to|by|with|how|where|what|when|a|an|such)\b|\S+$")
    for command, action in arguments(cli.command_parser([])):
        assert not fragment.match(action.help or ""), (command, action.dest, action.help)


def test_help_follows_a_changed_default(capsys: pytest.CaptureFixture[str]) -> None:
    parser = cli.command_parser(["press"])
    (commands,) = (a for a in parser._actions if isinstance(a, argparse._SubParsersAction))
    commands.choices["press"].set_defaults(air=7.5)
    assert "W/(m2 K) (default 7.5)" in " ".join(commands.choices["press"].format_help().split())


def test_progress_moves_where_the_end_is_not_known(monkeypatch: pytest.MonkeyPatch) -> None:
    screen = io.StringIO()
    monkeypatch.setattr(screen, "isatty", lambda: True)
    monkeypatch.setattr(sys, "stderr", screen)
    monkeypatch.setenv("TERM", "xterm")
    with Output(as_json=False).progress(None) as advance:
        advance("recording, 1 samples", 0.1)
        advance("recording, 2 samples", 0.1)
    assert "recording, 2 samples" in screen.getvalue() and "left" not in screen.getvalue()
