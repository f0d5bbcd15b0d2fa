"""The ROS 2 node of examples/ on emulated devices: by itself, over a stand-in of rclpy, and on ROS where that is."""

import runpy
import sys
import time
from collections.abc import Iterator
from contextlib import ExitStack
from pathlib import Path
from types import ModuleType, SimpleNamespace
from typing import Any

import numpy as np
import pytest

from thermograsp.hardware import (
    EmulatedFingertips,
    EmulatedGripper,
    Feel,
    Fingertips,
    GripperModel,
    PtyDevice,
    RobotiqGripper,
    SpringFingers,
)

from .serving import QUICK, nothing_left

EXAMPLE = runpy.run_path(str(Path(__file__).parents[2] / "examples" / "ros2_hand.py"))
WIDTH = 0.03  # m, of what lies between the fingers


def feel(now: float) -> Feel:
    return Feel((1e-3, -2e-3), (0.0, 0.0), ((3.0, 0.1, 0.2), (5.0, 0.3, 0.4)), (36.0, 36.0))


@pytest.fixture
def ports(tmp_path: Path) -> Iterator[dict[str, Any]]:
    """The node's parameters."""
    gripper = EmulatedGripper(GripperModel(activation_speed=1.0), SpringFingers(opening=0.085, width=WIDTH))
    with (
        PtyDevice(EmulatedFingertips(feel), tmp_path / "tips") as one,
        PtyDevice(gripper, tmp_path / "gripper") as other,
    ):
        yield {"port": one.path, "gripper": f"robotiq://{other.path}"}


def test_the_hand_tells_samples_and_how_a_command_goes(ports: dict[str, Any]) -> None:
    with ExitStack() as opened:
        tips = opened.enter_context(Fingertips(ports["port"], rate=200, settings=QUICK))
        gripper = opened.enter_context(RobotiqGripper(ports["gripper"].removeprefix("robotiq://")))
        gripper.activate()
        hand = EXAMPLE["Hand"](tips, gripper)
        time.sleep(0.2)
        names, rows = hand.rows(1000.0)
        column = dict(zip(names, rows.T, strict=True))
        assert len(rows) and rows.dtype == np.float64
        assert np.allclose(column["voltage_right_V"], -2e-3, atol=1e-8)
        assert np.all(np.abs(column["time_s"] - 1000.0 - time.monotonic()) < 60.0)
        *_, open_wide = hand.command(0.06, 40.0, lambda: False)
        assert open_wide.reached_goal and not open_wide.stalled
        *before, held = hand.command(0.0, 40.0, lambda: False)
        assert before and held.stalled and not held.reached_goal
        assert held.position == pytest.approx(WIDTH, abs=2e-3) and held.effort == pytest.approx(4.0, abs=0.01)
        begun = hand.command(0.085, 40.0, lambda: False)
        next(begun)
        *_, newer = hand.command(0.05, 40.0, lambda: False)
        assert list(begun) == [] and newer.reached_goal
        *_, stopped = hand.command(0.085, 40.0, lambda: True)
        assert not stopped.reached_goal and stopped.position < 0.08


class Record(SimpleNamespace):
    """A message of any fields."""

    layout: Any = None

    def __init__(self, **fields: Any) -> None:
        super().__init__(layout=SimpleNamespace(), **fields)


@pytest.fixture
def stand_in(ports: dict[str, Any], monkeypatch: pytest.MonkeyPatch) -> None:
    """As much of rclpy and its messages as the node uses."""

    class Node:
        def __init__(self, name: str) -> None:
            self.name, self.errors, self.published = name, [], []

        def declare_parameter(self, name: str, default: object) -> Any:
            return SimpleNamespace(value=ports.get(name, default))

        def get_clock(self) -> Any:
            return SimpleNamespace(now=lambda: SimpleNamespace(nanoseconds=time.time_ns()))

        def get_logger(self) -> Any:
            return SimpleNamespace(error=lambda text, **_: self.errors.append(text))

        def create_publisher(self, kind: type, topic: str, depth: int) -> Any:
            return SimpleNamespace(publish=self.published.append)

        def create_timer(self, period: float, callback: Any, callback_group: object) -> Any:
            return SimpleNamespace(callback=callback)

        def destroy_node(self) -> None: ...

    def server(node: Node, kind: type, name: str, execute: Any, **_: object) -> Any:
        return SimpleNamespace(execute=execute)

    contents: dict[str, dict[str, Any]] = {
        "rclpy": {},
        "rclpy.action": {"ActionServer": server, "CancelResponse": SimpleNamespace(ACCEPT=1)},
        "rclpy.callback_groups": {"ReentrantCallbackGroup": object},
        "rclpy.node": {"Node": Node},
        "control_msgs": {},
        "control_msgs.action": {"GripperCommand": SimpleNamespace(Feedback=Record, Result=Record)},
        "std_msgs": {},
        "std_msgs.msg": {"Float64MultiArray": Record, "MultiArrayDimension": Record},
    }
    for name, held in contents.items():
        module = ModuleType(name)
        vars(module).update(held)
        monkeypatch.setitem(sys.modules, name, module)


class Goal:
    """Of an action client: what it was told."""

    def __init__(self, position: float, cancelled: bool = False) -> None:
        self.request = SimpleNamespace(command=SimpleNamespace(position=position, max_effort=40.0))
        self.is_cancel_requested, self.feedback, self.end = cancelled, [], ""

    def publish_feedback(self, message: Record) -> None:
        self.feedback.append(message)

    def succeed(self) -> None:
        self.end += "succeeded"

    def canceled(self) -> None:
        self.end += "canceled"

    def abort(self) -> None:
        self.end += "aborted"


def test_the_node_publishes_and_takes_actions(stand_in: None) -> None:
    with nothing_left():
        node = EXAMPLE["make_node"]()
        time.sleep(0.2)
        node.timer.callback()
        (message,) = node.published
        rows, columns = message.layout.dim
        assert len(message.data) == rows.stride == rows.size * columns.size and columns.stride == columns.size
        table = np.reshape(message.data, (rows.size, columns.size))
        named = dict(zip(columns.label.split(","), table.T, strict=True))
        assert np.allclose(named["voltage_left_V"], 1e-3, atol=1e-8)
        assert np.all(np.abs(named["time_s"] - time.time()) < 60.0)
        for goal, end in (
            (Goal(0.0), "succeeded"),
            (Goal(0.085, cancelled=True), "canceled"),
            (Goal(9.0), "aborted"),
        ):
            result = node.server.execute(goal)
            assert goal.end == end
            assert vars(result).keys() >= {"position", "effort", "stalled", "reached_goal"}
        assert len(node.errors) == 1 and "9" in node.errors[0]
        node.destroy_node()


def test_on_ros(ports: dict[str, Any]) -> None:
    rclpy: Any = pytest.importorskip("rclpy", reason="needs ROS 2")
    from control_msgs.action import GripperCommand  # pyright: ignore[reportMissingImports]
    from rclpy.action import ActionClient  # pyright: ignore[reportMissingImports]
    from rclpy.executors import MultiThreadedExecutor  # pyright: ignore[reportMissingImports]
    from std_msgs.msg import Float64MultiArray  # pyright: ignore[reportMissingImports]

    given = [word for name, value in ports.items() for word in ("-p", f"{name}:={value}")]
    rclpy.init(args=["--ros-args", *given])
    node, client, executor = EXAMPLE["make_node"](), rclpy.create_node("client"), MultiThreadedExecutor()
    try:
        executor.add_node(node)
        executor.add_node(client)
        heard: list[Any] = []
        client.create_subscription(Float64MultiArray, "/thermograsp_hand/samples", heard.append, 10)
        actions = ActionClient(client, GripperCommand, "/thermograsp_hand/gripper_command")
        assert actions.wait_for_server(5.0)
        goal = GripperCommand.Goal()
        goal.command.position, goal.command.max_effort = 0.0, 40.0
        sent = actions.send_goal_async(goal)
        executor.spin_until_future_complete(sent, 5.0)
        answer = sent.result().get_result_async()
        executor.spin_until_future_complete(answer, 10.0)
        assert answer.result().result.stalled and heard
    finally:
        node.destroy_node()
        client.destroy_node()
        rclpy.shutdown()
