"""The robot: what both fingertips feel, and the opening and force of their gripper, as LeRobot's tools ask for them."""

# lerobot is installed in the environment of make test-lerobot alone, and pyright takes this folder for it
# pyright: reportMissingImports=false, reportAttributeAccessIssue=false, reportGeneralTypeIssues=false
# pyright: reportCallIssue=false

from contextlib import ExitStack
from dataclasses import dataclass
from typing import Any

import numpy as np

from thermograsp.errors import MissingDependencyError, install
from thermograsp.hardware import Fingertips, Flag, Gripper, GripperFaultError, open_gripper

try:
    from lerobot.robots import Robot, RobotConfig
    from lerobot.utils.errors import DeviceAlreadyConnectedError, DeviceNotConnectedError
except ImportError as error:
    raise MissingDependencyError(f"thermograsp.lerobot needs LeRobot: {install('lerobot')}") from error

_COLUMNS = tuple(
    f"{quantity}_{side}_{unit}"
    for side in ("left", "right")
    for quantity, unit in (
        ("voltage", "V"),
        ("thermostat", "degC"),
        ("force", "N"),
        ("shear_1", "N"),
        ("shear_2", "N"),
    )
)
_TOLERATED = (
    Flag.SATURATED_LEFT | Flag.SATURATED_RIGHT | Flag.OFF_SETPOINT_LEFT | Flag.OFF_SETPOINT_RIGHT
)  # the voltages and temperatures of an observation show it
_FIRST_WITHIN = 2.0  # s


@RobotConfig.register_subclass("thermograsp_hand")
@dataclass(kw_only=True)
class ThermograspHandConfig(RobotConfig):
    """Configuration of our fingertips as a robot of LeRobot. port: of the fingertips, best a stable name
    (/dev/serial/by-id/...). gripper: URL as open_gripper takes it, such as robotiq:///dev/ttyUSB0, or "" for fingertips
    without one. rate: Hz of their samples. setpoint: °C of both thermostats. speed: m/s of the fingers."""

    port: str
    gripper: str = ""
    rate: int = 100
    setpoint: float = 36.0
    speed: float = 0.1


class ThermograspHand(Robot):
    """See LeRobot's Robot. An observation is the newest sample of the fingertips, and the opening of a gripper if there
    is one: voltage_left_V, thermostat_left_degC, force_left_N (normal), shear_1_left_N, shear_2_left_N, the same of
    the right one, and opening_m. An action is opening_m and force_N; without a gripper it is empty."""

    config_class = ThermograspHandConfig
    name = "thermograsp_hand"

    def __init__(self, config: ThermograspHandConfig) -> None:
        super().__init__(config)
        self.config = config
        self._tips: Fingertips | None = None
        self._gripper: Gripper | None = None
        self._opened = ExitStack()

    @property
    def observation_features(self) -> dict[str, type]:
        names = (*_COLUMNS, "opening_m") if self.config.gripper else _COLUMNS
        return dict.fromkeys(names, float)

    @property
    def action_features(self) -> dict[str, type]:
        return {"opening_m": float, "force_N": float} if self.config.gripper else {}

    @property
    def is_connected(self) -> bool:
        return self._tips is not None

    @property
    def is_calibrated(self) -> bool:
        """The device keeps its calibration (thermograsp device calibrate)."""
        return True

    def calibrate(self) -> None:
        """Nothing: see is_calibrated."""

    def configure(self) -> None:
        """Nothing: connect sets rate and setpoint."""

    def connect(self, calibrate: bool = True) -> None:
        """Opens the ports and turns the thermostats on. A gripper that is not active yet is activated: its fingers
        close and open wholly, and what they hold falls. Raises DeviceAlreadyConnectedError, DeviceError and its
        kinds."""
        if self.is_connected:
            raise DeviceAlreadyConnectedError(f"{self} is connected already")
        config = self.config
        with ExitStack() as opened:
            tips = opened.enter_context(Fingertips(config.port, rate=config.rate, setpoint=config.setpoint))
            gripper = opened.enter_context(open_gripper(config.gripper)) if config.gripper else None
            if gripper is not None:
                gripper.activate()
            self._newest = tips.wait(1, _FIRST_WITHIN)[-1:]
            self._opened = opened.pop_all()
        self._tips, self._gripper = tips, gripper

    def get_observation(self) -> dict[str, Any]:
        """The newest sample, and the opening now. Raises DeviceNotConnectedError, SensorFaultError for a fault of the
        samples, GripperFaultError, and what Fingertips.take raises while the line is broken."""
        samples = self._connected().take()
        samples.require_healthy(but=_TOLERATED)
        if len(samples):
            self._newest = samples[-1:]
        columns = self._newest.columns
        outputs = {name: float(columns[name][0]) for name in _COLUMNS}
        if self._gripper is None:
            return outputs
        status = self._gripper.status()
        if status.fault:
            raise GripperFaultError(f"gripper: {status.fault}")
        return {**outputs, "opening_m": status.opening}

    def send_action(self, action: dict[str, Any]) -> dict[str, Any]:
        """Sends the fingers there and returns what was sent: an opening that the gripper does not have becomes the
        nearest that it has, and both values are rounded to its steps. Raises DeviceNotConnectedError, DeviceError and
        its kinds, and InvalidValueError for a force that the gripper does not have."""
        self._connected()
        if self._gripper is None:
            return {}
        opening = float(np.clip(action["opening_m"], 0.0, self._gripper.stroke))
        force, speed = float(action["force_N"]), self.config.speed
        self._gripper.move(opening, force, speed)
        sent = self._gripper.quantised(opening, force, speed)
        return {"opening_m": float(sent[0]), "force_N": float(sent[1])}

    def disconnect(self) -> None:
        """Releases the ports; the fingers stay as they are, and the device turns its heaters off after 10 s. Raises
        DeviceNotConnectedError."""
        self._connected()
        self._tips = self._gripper = None
        self._opened.close()

    def _connected(self) -> Fingertips:
        if self._tips is None:
            raise DeviceNotConnectedError(f"{self} is not connected: call connect() first")
        return self._tips
