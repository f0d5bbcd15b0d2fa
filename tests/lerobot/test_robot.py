"""LeRobot's robot on emulated devices: found by LeRobot's own means, read, moved, and let go."""

from __future__ import annotations

import re
from collections.abc import Iterator
from contextlib import ExitStack
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import draccus  # pyright: ignore[reportMissingImports]
import pytest
from lerobot.configs import parser  # pyright: ignore[reportMissingImports]
from lerobot.robots import RobotConfig, make_robot_from_config  # pyright: ignore[reportMissingImports]
from lerobot.utils.errors import (  # pyright: ignore[reportMissingImports]
    DeviceAlreadyConnectedError,
    DeviceNotConnectedError,
)

from thermograsp.hardware import (
    EmulatedFingertips,
    EmulatedGripper,
    Feel,
    Fingertips,
    GripperModel,
    PortMissingError,
    PtyDevice,
    SensorFaultError,
    SpringFingers,
    open_gripper,
)


@dataclass
class Command:
    """As lerobot-record and lerobot-teleoperate have it."""

    robot: RobotConfig


def feel(now: float) -> Feel:
    return Feel((1e-3, -2e-3), (0.0, 0.0), ((3.0, 0.1, 0.2), (4.0, 0.3, 0.4)), (36.0, 36.0))


@pytest.fixture
def hand(tmp_path: Path) -> Iterator[tuple[EmulatedFingertips, PtyDevice, PtyDevice]]:
    tips = EmulatedFingertips(feel)
    gripper = EmulatedGripper(GripperModel(activation_speed=1.0), SpringFingers(opening=0.085, width=0.03))
    with ExitStack() as served:
        yield (
            tips,
            served.enter_context(PtyDevice(tips, tmp_path / "tips")),
            served.enter_context(PtyDevice(gripper, tmp_path / "gripper")),
        )


def robot(folder: Path, *given: str) -> Any:
    """Of a command line, by LeRobot's parser."""
    parser.load_plugin("thermograsp.lerobot")
    args = ["--robot.type=thermograsp_hand", f"--robot.calibration_dir={folder}", *given]
    return make_robot_from_config(draccus.parse(Command, args=args).robot)


def test_it_is_read_and_moved_and_lets_go(
    hand: tuple[EmulatedFingertips, PtyDevice, PtyDevice], tmp_path: Path
) -> None:
    _, tips, gripper = hand
    url = f"robotiq://{gripper.path}"
    fingers = robot(tmp_path, f"--robot.port={tips.path}", f"--robot.gripper={url}")
    with pytest.raises(DeviceNotConnectedError):
        fingers.get_observation()
    fingers.connect()
    assert fingers.is_connected and fingers.is_calibrated
    with pytest.raises(DeviceAlreadyConnectedError):
        fingers.connect()
    seen = fingers.get_observation()
    assert seen.keys() == fingers.observation_features.keys()
    assert all(
        isinstance(value, kind)
        for value, kind in zip(seen.values(), fingers.observation_features.values(), strict=True)
    )
    assert (seen["voltage_left_V"], seen["voltage_right_V"]) == pytest.approx((1e-3, -2e-3), abs=1e-8)
    assert (seen["force_left_N"], seen["shear_2_right_N"]) == pytest.approx((3.0, 0.4), abs=1e-3)
    assert seen["thermostat_right_degC"] == pytest.approx(36.0, abs=0.01)
    assert seen["opening_m"] == pytest.approx(0.085, abs=1e-3)
    sent = fingers.send_action({"opening_m": 0.04, "force_N": 30.0})
    assert sent.keys() == fingers.action_features.keys()
    assert sent == pytest.approx({"opening_m": 0.04, "force_N": 30.0}, abs=0.84)
    assert abs(sent["opening_m"] - 0.04) < 4e-4
    assert fingers.send_action({"opening_m": 1.0, "force_N": 30.0})["opening_m"] == pytest.approx(
        0.085, abs=4e-4
    )
    fingers.disconnect()
    assert not fingers.is_connected
    with pytest.raises(DeviceNotConnectedError):
        fingers.disconnect()
    with Fingertips(tips.path) as again, open_gripper(url) as free:  # nobody holds the ports
        assert len(again.wait(1, 2.0)) and free.status().active
    fingers.connect()
    fingers.disconnect()


def test_fingertips_alone_have_no_actions(
    hand: tuple[EmulatedFingertips, PtyDevice, PtyDevice], tmp_path: Path
) -> None:
    device, tips, _ = hand
    with robot(tmp_path, f"--robot.port={tips.path}") as fingers:
        assert fingers.action_features == {} and fingers.send_action({}) == {}
        assert "opening_m" not in fingers.get_observation()
        device.broken_converters.add(1)
        fingers._tips.wait(5, 2.0)
        fingers._tips.wait(1, 2.0)
        with pytest.raises(SensorFaultError, match="right voltage is missing"):
            while True:
                fingers.get_observation()


def test_a_gripper_that_is_missing_holds_no_port(
    hand: tuple[EmulatedFingertips, PtyDevice, PtyDevice], tmp_path: Path
) -> None:
    _, tips, _ = hand
    fingers = robot(tmp_path, f"--robot.port={tips.path}", f"--robot.gripper=robotiq://{tmp_path / 'none'}")
    with pytest.raises(PortMissingError):
        fingers.connect()
    assert not fingers.is_connected
    Fingertips(tips.path).close()


def test_the_docs_run(
    hand: tuple[EmulatedFingertips, PtyDevice, PtyDevice], capsys: pytest.CaptureFixture[str]
) -> None:
    _, tips, gripper = hand
    page = (Path(__file__).parents[2] / "docs" / "hardware.md").read_text("utf-8")
    (block,) = re.findall(r"```python lerobot\n(.*?)```", page, re.DOTALL)
    block = block.replace("/dev/ttyACM0", tips.path).replace("/dev/ttyUSB0", gripper.path)
    exec(compile(block, "docs/hardware.md", "exec"), {})
    assert "'opening_m': 0.04" in capsys.readouterr().out
