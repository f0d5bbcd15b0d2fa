"""Fingertips that feel heat, and their gripper, as a ROS 2 node.

    thermograsp device emulate-hand --link /tmp/tips --gripper-link /tmp/gripper &
    python3 examples/ros2_hand.py --ros-args -p port:=/tmp/tips -p gripper:=robotiq:///tmp/gripper

~/samples (std_msgs/Float64MultiArray): a row a sample, all since the last message; the label of the second dimension
names the columns. ~/gripper_command (control_msgs/action/GripperCommand): position is m between the pads, max_effort N.
"""

# pyright: reportMissingImports=false

import threading
import time
from collections.abc import Callable, Iterator
from dataclasses import asdict, dataclass
from typing import Any

import numpy as np

from thermograsp.errors import ThermograspError
from thermograsp.hardware import Contact, Fingertips, Gripper, GripperStatus, open_gripper

PERIOD = 0.02  # s between messages, and between looks at fingers that move
REACHED = 1e-3  # m from its target at which a command has reached it
SPEED = 0.1  # m/s of the fingers


@dataclass(frozen=True, slots=True)
class Progress:
    """What GripperCommand tells: position in m, effort in N, whether something stopped the fingers, and whether they
    are where they were sent."""

    position: float
    effort: float
    stalled: bool
    reached_goal: bool


class Hand:
    """What the node does, without ROS. Each method may be called by a thread of its own."""

    def __init__(self, tips: Fingertips, gripper: Gripper) -> None:
        self.tips, self.gripper = tips, gripper
        self._pressed = 0.0  # N, mean of both pads
        self._commands = 0  # so far
        self._one = threading.Lock()

    def rows(self, epoch: float = 0.0) -> tuple[list[str], np.ndarray]:
        """Names of the columns, and all samples since the last call: (n, columns), times in s after the host's clock
        began, plus epoch. Raises DeviceError."""
        samples = self.tips.take()
        if len(samples):
            self._pressed = float(samples.force[-1, :, 0].mean())
        columns = {**samples.columns, "time_s": samples.time + epoch}
        return list(columns), np.stack(list(columns.values()), axis=1)

    def command(self, position: float, effort: float, cancelled: Callable[[], bool]) -> Iterator[Progress]:
        """Sends the fingers to a position in m with at most that effort in N, and tells how it goes until they stand.
        A later command ends it; cancelled() stops the fingers where they are. Raises ThermograspError."""
        with self._one:
            self._commands += 1
            number = self._commands
            self.gripper.move(position, effort, SPEED)
        while number == self._commands:
            time.sleep(PERIOD)
            if cancelled():
                self.gripper.stop()
            status = self.gripper.status()
            yield self._progress(status, position)
            if not status.moving:
                return

    def _progress(self, status: GripperStatus, position: float) -> Progress:
        reached = abs(status.opening - position) <= REACHED
        return Progress(status.opening, self._pressed, status.contact is not Contact.NONE, reached)


def main() -> None:
    """Spins the node until it is interrupted."""
    import rclpy
    from rclpy.executors import ExternalShutdownException, MultiThreadedExecutor

    rclpy.init()
    node, executor = make_node(), MultiThreadedExecutor()
    executor.add_node(node)
    try:
        executor.spin()
    except (KeyboardInterrupt, ExternalShutdownException):
        pass
    finally:
        node.destroy_node()
        rclpy.try_shutdown()


def make_node() -> Any:
    """The node, with its devices open. Raises DeviceError where they cannot be opened."""
    from control_msgs.action import GripperCommand
    from rclpy.action import ActionServer, CancelResponse
    from rclpy.callback_groups import ReentrantCallbackGroup
    from rclpy.node import Node
    from std_msgs.msg import Float64MultiArray, MultiArrayDimension

    class HandNode(Node):
        def __init__(self) -> None:
            super().__init__("thermograsp_hand")
            named = {
                "port": "/dev/ttyACM0",
                "gripper": "robotiq:///dev/ttyUSB0",
                "rate": 100,
                "setpoint": 36.0,
            }
            port, gripper, rate, setpoint = (
                self.declare_parameter(name, default).value for name, default in named.items()
            )
            self.gripper = open_gripper(gripper)
            try:
                self.gripper.activate()  # its fingers close and open wholly
                self.tips = Fingertips(port, rate=rate, setpoint=setpoint)
            except BaseException:
                self.gripper.close()
                raise
            self.hand = Hand(self.tips, self.gripper)
            self.epoch = self.get_clock().now().nanoseconds * 1e-9 - time.monotonic()
            side_by_side = ReentrantCallbackGroup()
            self.publisher = self.create_publisher(Float64MultiArray, "~/samples", 10)
            self.timer = self.create_timer(PERIOD, self.publish, callback_group=side_by_side)
            self.server = ActionServer(
                self,
                GripperCommand,
                "~/gripper_command",
                self.execute,
                cancel_callback=lambda goal: CancelResponse.ACCEPT,
                callback_group=side_by_side,
            )

        def publish(self) -> None:
            try:
                names, rows = self.hand.rows(self.epoch)
            except ThermograspError as error:
                self.get_logger().error(str(error), throttle_duration_sec=1.0)
                return
            if len(rows):
                message = Float64MultiArray(data=rows.ravel().tolist())
                message.layout.dim = [
                    MultiArrayDimension(label="sample", size=len(rows), stride=rows.size),
                    MultiArrayDimension(label=",".join(names), size=len(names), stride=len(names)),
                ]
                self.publisher.publish(message)

        def execute(self, goal: Any) -> Any:
            wanted, now = goal.request.command, Progress(float("nan"), 0.0, False, False)
            try:
                for now in self.hand.command(
                    wanted.position, wanted.max_effort, lambda: goal.is_cancel_requested
                ):
                    goal.publish_feedback(GripperCommand.Feedback(**asdict(now)))
            except ThermograspError as error:
                self.get_logger().error(str(error))
                goal.abort()
                return GripperCommand.Result(**asdict(now))
            if goal.is_cancel_requested:
                goal.canceled()
            elif now.stalled or now.reached_goal:
                goal.succeed()
            else:
                goal.abort()
            return GripperCommand.Result(**asdict(now))

        def destroy_node(self) -> None:
            self.tips.close()
            self.gripper.close()
            super().destroy_node()

    return HandNode()


if __name__ == "__main__":
    main()
