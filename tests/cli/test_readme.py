"""What the README promises is there, and its code runs; so do the examples."""

import configparser
import re
import runpy
import shlex
from pathlib import Path

import pytest
from PIL import Image

from thermograsp.cli import COMMANDS, main
from thermograsp.cli.shared.versions import DEVELOPMENT

ROOT = Path(__file__).parents[2]
README = (ROOT / "README.md").read_text(encoding="utf-8")


def test_the_code_runs(capsys: pytest.CaptureFixture[str]) -> None:
    blocks = re.findall(r"```python\n(.*?)```", README, re.DOTALL)
    assert blocks
    for block in blocks:
        exec(compile(block, "README.md", "exec"), {})
    assert "K at most, by network" in capsys.readouterr().out


def test_the_commands_parse(capsys: pytest.CaptureFixture[str]) -> None:
    lines = re.findall(r"^    thermograsp (.*)$", README, re.MULTILINE)
    assert lines
    for line in lines:
        words = shlex.split(line)
        assert words[0] in COMMANDS
        assert main([*words, "--help"]) == 0  # every option before --help is parsed


def test_links_lead_somewhere() -> None:
    for link in re.findall(r"\]\(([^)#]+)", README):
        assert link.startswith("http") or (ROOT / link).exists(), link


def test_extras_are_those_of_setup_cfg() -> None:
    parser = configparser.ConfigParser()
    parser.read(ROOT / "setup.cfg", encoding="utf-8")
    named = set(re.findall(r"pip install '\.\[(\w+)\]'", README))
    assert named == set(parser["options.extras_require"]) - DEVELOPMENT


def test_it_is_short_and_its_picture_moves() -> None:
    assert len(README.split()) <= 700
    (path,) = re.findall(r"!\[.*?\]\((.*?)\)", README)
    assert (ROOT / path).stat().st_size < 1_000_000
    with Image.open(ROOT / path) as picture:
        assert getattr(picture, "n_frames", 1) > 10


def test_example_press(capsys: pytest.CaptureFixture[str]) -> None:
    drops = runpy.run_path(str(ROOT / "examples" / "press_materials.py"))["main"]()
    assert drops["cotton"] < drops["wood"] < drops["glass"] < drops["stainless_steel"] < drops["aluminium"]
    assert capsys.readouterr().out.count("\n") == len(drops) + 1


def test_example_lift(capsys: pytest.CaptureFixture[str]) -> None:
    assert runpy.run_path(str(ROOT / "examples" / "lift_and_feel.py"))["main"]()
    assert "mV" in capsys.readouterr().out
