"""Wire formats, drivers, emulators and the serial plant."""

from .emulated import Emulated
from .emulator import DeviceModel, EmulatedFingertips
from .errors import (
    CommandRefusedError,
    DeviceError,
    GripperFaultError,
    GripperTimeoutError,
    LinkLostError,
    NoAnswerError,
    PortBusyError,
    PortError,
    PortForbiddenError,
    PortMissingError,
    ProtocolVersionError,
    SensorFaultError,
    StaleSensorError,
    WrongDeviceError,
)
from .feel import Feel, Source, press_source, samples_source, untouched
from .fingers import Fingers, SpringFingers
from .fingertips import Fingertips, LinkStatistics
from .gripper import Contact, Gripper, GripperStatus, open_gripper
from .known_touches import known_touch
from .line_faults import LineFaults
from .link import LinkSettings, Tap
from .messages import Calibration, Flag, Identity, SelfTest, Status, ThermostatReport
from .modbus_line import ModbusSettings
from .modbus_slave import INSTANT, LinePacing
from .pty_device import PtyDevice
from .recording import Recorder, Recording, read_recording
from .replay import Replay, replay
from .robotiq import RobotiqGripper
from .robotiq_emulator import EmulatedGripper, GripperModel
from .robotiq_registers import Fault
from .robotiq_units import RobotiqUnits
from .samples import Samples
from .serial_plant import SerialConfig, SerialPlant
from .serial_port import PortInfo, SerialPort, ports
from .transport import Opener, Transport
from .virtual_line import VirtualLine

__all__ = [
    "Calibration",
    "CommandRefusedError",
    "Contact",
    "DeviceError",
    "DeviceModel",
    "Emulated",
    "EmulatedFingertips",
    "EmulatedGripper",
    "Fault",
    "Feel",
    "Fingers",
    "Fingertips",
    "Flag",
    "Gripper",
    "GripperFaultError",
    "GripperModel",
    "GripperStatus",
    "GripperTimeoutError",
    "INSTANT",
    "Identity",
    "LineFaults",
    "LinePacing",
    "LinkLostError",
    "LinkSettings",
    "LinkStatistics",
    "ModbusSettings",
    "NoAnswerError",
    "Opener",
    "PortBusyError",
    "PortError",
    "PortForbiddenError",
    "PortInfo",
    "PortMissingError",
    "ProtocolVersionError",
    "PtyDevice",
    "Recorder",
    "Recording",
    "Replay",
    "RobotiqGripper",
    "RobotiqUnits",
    "Samples",
    "SelfTest",
    "SensorFaultError",
    "SerialConfig",
    "SerialPlant",
    "SerialPort",
    "Source",
    "SpringFingers",
    "StaleSensorError",
    "Status",
    "Tap",
    "ThermostatReport",
    "Transport",
    "VirtualLine",
    "WrongDeviceError",
    "known_touch",
    "open_gripper",
    "ports",
    "press_source",
    "read_recording",
    "replay",
    "samples_source",
    "untouched",
]
