"""Wire formats, drivers, emulators and the serial plant."""

from .emulator import DeviceModel, EmulatedFingertips
from .errors import (
    CommandRefusedError,
    DeviceError,
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
from .fingertips import Fingertips, LinkStatistics
from .line_faults import LineFaults
from .link import LinkSettings, Tap
from .messages import Calibration, Flag, Identity, SelfTest, Status, ThermostatReport
from .pty_device import PtyDevice
from .recording import Recorder, Recording, read_recording
from .replay import Replay, replay
from .samples import Samples
from .serial_port import PortInfo, SerialPort, ports
from .transport import Opener, Transport
from .virtual_line import VirtualLine

__all__ = [
    "Calibration",
    "CommandRefusedError",
    "DeviceError",
    "DeviceModel",
    "EmulatedFingertips",
    "Feel",
    "Fingertips",
    "Flag",
    "Identity",
    "LineFaults",
    "LinkLostError",
    "LinkSettings",
    "LinkStatistics",
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
    "Samples",
    "SelfTest",
    "SensorFaultError",
    "SerialPort",
    "Source",
    "StaleSensorError",
    "Status",
    "Tap",
    "ThermostatReport",
    "Transport",
    "VirtualLine",
    "WrongDeviceError",
    "ports",
    "press_source",
    "read_recording",
    "replay",
    "samples_source",
    "untouched",
]
