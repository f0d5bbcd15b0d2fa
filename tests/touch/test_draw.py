"""What fingertips feel, drawn into MuJoCo's scenes."""

# mujoco ships no type stubs for its compiled names
# pyright: reportAttributeAccessIssue=false

import importlib.util
from pathlib import Path

import mujoco
import numpy as np
import pytest

from thermograsp.cli import main
from thermograsp.touch import ThermalBody, ThermalTouch

_spec = importlib.util.spec_from_file_location("hand", Path(__file__).with_name("hand.py"))
assert _spec and _spec.loader
hand = importlib.util.module_from_spec(_spec)
_spec.loader.exec_module(hand)

PADS = {name: f"{name}_pad" for name in hand.FINGERS}


def test_a_cold_touch_is_drawn_blue_with_a_bar() -> None:
    model, data = hand.hand()
    touch = ThermalTouch(
        model, fingertips=PADS, objects={"can": ThermalBody("aluminium", 5.0)}, chain="ideal"
    )
    hand.press(data, 10.0)
    scene = mujoco.MjvScene(model, 50)
    mujoco.mj_forward(model, data)
    assert touch.draw(scene, data) == 3  # plates alone: no voltage yet
    grey = np.array(scene.geoms[0].rgba)
    for _ in range(500):
        mujoco.mj_step(model, data)
        touch.update(data)
    scene.ngeom = 0
    assert touch.draw(scene, data) == 6
    blue = np.array(scene.geoms[0].rgba)
    assert blue[2] > blue[0] + 0.5 and abs(grey[2] - grey[0]) < 1e-6
    pad = model.geom("thumb_pad").id
    assert np.linalg.norm(np.array(scene.geoms[0].pos) - data.geom_xpos[pad]) < 0.006
    full = mujoco.MjvScene(model, 2)
    assert touch.draw(full, data) == 2


@pytest.mark.usefixtures("opengl")
def test_view_writes_a_picture_of_any_scene(
    tmp_path: Path, capsys: pytest.CaptureFixture, monkeypatch: pytest.MonkeyPatch
) -> None:
    keys = '<keyframe><key time="5" ctrl="10 10 10 0 0"/></keyframe></mujoco>'
    (tmp_path / "scene.xml").write_text(hand.scene().replace("</mujoco>", keys))
    command = ["view", "--model", str(tmp_path / "scene.xml"), "--seconds", "0.3"]
    pads = ["--fingertips", *PADS.values()]
    written = tmp_path / "felt.png"
    assert main([*command, *pads, "--objects", "can=aluminium", "--render", str(written)]) == 0
    assert written.read_bytes()[:4] == b"\x89PNG"
    short = [*command[:-1], "0.004", *pads, "--objects", "can=aluminium", "--render", str(written)]
    assert main(short) == 0
    monkeypatch.delenv("DISPLAY", raising=False)
    monkeypatch.delenv("WAYLAND_DISPLAY", raising=False)
    assert main([*command, *pads, "--objects", "can=aluminium"]) != 0
    assert "no display" in capsys.readouterr().err
    assert main([*command, *pads, "--objects", "can", "--render", str(written)]) != 0
    assert "NAME=MATERIAL" in capsys.readouterr().err
    assert main([*command, "--objects", "can=aluminium", "--render", str(written)]) != 0
    assert "--fingertips" in capsys.readouterr().err
    assert main(["view", "--objects", "can=aluminium"]) != 0
