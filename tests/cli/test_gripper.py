"""`thermograsp gripper check`: what it says, writes and exits with."""

from __future__ import annotations

import json
from pathlib import Path
from typing import NoReturn

import pytest

from thermograsp.cli import main
from thermograsp.errors import MissingDependencyError

SLIDES = """
<mujoco>
  <worldbody>
    <body name="base">
      <geom type="box" size=".05 .02 .01" mass=".3"/>
      <body name="one" pos="-.05 0 -.06">
        <joint name="one" type="slide" axis="1 0 0" range="0 .045"/>
        <geom name="face_one" type="box" size=".004 .012 .03" mass=".05"/>
      </body>
      <body name="two" pos=".05 0 -.06">
        <joint name="two" type="slide" axis="-1 0 0" range="0 .045"/>
        <geom name="face_two" type="box" size=".004 .012 .03" mass=".05"/>
      </body>
    </body>
  </worldbody>
  <actuator>
    <motor name="push_one" joint="one" ctrlrange="-{newton} {newton}"/>
    <motor name="push_two" joint="two" ctrlrange="-{newton} {newton}"/>
  </actuator>
</mujoco>
"""


@pytest.fixture
def strong(tmp_path: Path) -> Path:
    file = tmp_path / "strong.xml"
    file.write_text(SLIDES.format(newton=15), encoding="utf-8")
    return file


def test_one_that_is_fit(strong: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    picture = tmp_path / "strong.png"
    assert main(["gripper", "check", str(strong), "--render", str(picture)]) == 0
    output = capsys.readouterr().out
    for part in ("fingertips on 'one' and 'two'", "geom 'face_two'", "glass", "aluminium", "fit: it grasps"):
        assert part in output
    # a picture where there is OpenGL, a word on stderr where there is none
    assert picture.exists() == (f"wrote {picture}" in output)


def test_its_document(strong: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["gripper", "check", str(strong), "--json", "--shape", "cylinder", "--force", "12"]) == 0
    summary = json.loads(capsys.readouterr().out)
    assert summary["passed"] is True and summary["problem"] == "" and summary["png"] is None
    assert summary["limit_N"] == 12 and summary["shape"] == "cylinder"
    assert summary["gripper"]["widest_m"] == pytest.approx(0.08, abs=1e-5)
    glass, aluminium = summary["trials"]
    assert glass["force_N"] == pytest.approx([12.0, 12.0], rel=0.02)
    assert min(aluminium["drop_K"]) > max(glass["drop_K"]) > 0
    assert glass["slip_m"] < 5e-4 and glass["lifted_m"] > 0.05


def test_one_that_is_too_weak_is_not_fit(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    file = tmp_path / "weak.xml"
    file.write_text(SLIDES.format(newton=0.4), encoding="utf-8")
    assert main(["gripper", "check", str(file)]) == 1
    assert "not fit: glass: " in capsys.readouterr().out


def test_without_opengl_the_rest_goes_on(
    strong: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    def nothing(*args: object) -> NoReturn:
        raise MissingDependencyError("no OpenGL to render with")

    monkeypatch.setattr("thermograsp.figures.draw_gripper", nothing)
    assert main(["gripper", "check", str(strong), "--render", str(tmp_path / "no.png")]) == 0
    captured = capsys.readouterr()
    assert "no picture: no OpenGL" in captured.err and "fit:" in captured.out and "wrote" not in captured.out


def test_other_commands_take_it(strong: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["grasp", "--gripper", str(strong), "--seconds", "4", "--hold", "0.5"]) == 0
    assert main(["grasp", "--gripper", str(strong.parent / "none.xml")]) == 2
    assert "no file" in capsys.readouterr().err


def test_one_that_opens_little_is_tried_with_less(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    file = tmp_path / "narrow.xml"
    file.write_text(SLIDES.format(newton=15).replace(".05 0 -.06", ".025 0 -.06"), encoding="utf-8")
    assert main(["gripper", "check", str(file), "--json"]) == 0
    summary = json.loads(capsys.readouterr().out)
    assert summary["gripper"]["widest_m"] == pytest.approx(0.030, abs=1e-5)
    assert summary["width_m"] == pytest.approx(0.022, abs=1e-5)


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        (["none.xml"], "no file"),
        (["{strong}", "--fingertips", "one", "three"], "unknown finger"),
        (["{strong}", "--actuators", "pull"], "unknown actuator"),
        (["{strong}", "--render", "picture.gif"], "must end with .png"),
        (["{strong}", "--force", "-1"], "force"),
    ],
)
def test_bad_input(
    arguments: list[str], message: str, strong: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    assert main(["gripper", "check", *(a.format(strong=strong) for a in arguments)]) == 2
    assert message in capsys.readouterr().err
