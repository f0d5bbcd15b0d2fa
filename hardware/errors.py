"""What can go wrong between a host and a device; each message names the cause and the cure."""

from __future__ import annotations

from thermograsp.errors import ThermograspError


class DeviceError(ThermograspError, RuntimeError):
    """Base of everything that a device or its line does."""


class PortError(DeviceError, OSError):
    """A port cannot be opened."""


class PortMissingError(PortError):
    """There is no such port: the device is not plugged in, or its name is another one."""


class PortBusyError(PortError):
    """Another program has the port."""


class PortForbiddenError(PortError):
    """This user may not open the port."""


class LinkLostError(DeviceError, ConnectionError):
    """The port went away or takes no more bytes."""


class StaleSensorError(DeviceError, TimeoutError):
    """The device should send samples, and none has come for too long."""


class NoAnswerError(DeviceError, TimeoutError):
    """A command was sent as often as allowed and not acknowledged."""


class CommandRefusedError(DeviceError):
    """The device understood a command and did not do it."""


class WrongDeviceError(DeviceError):
    """What answers is not a device of this kind, or not the one that was there before."""


class ProtocolVersionError(DeviceError):
    """Host and device speak no common version of the protocol."""


class SensorFaultError(DeviceError):
    """A sensor of the device cannot be believed: open thermistor, saturated converter, thermostat off its setpoint."""


class GripperFaultError(DeviceError):
    """The gripper says that something is wrong with it, or that it is not ready to move."""


class GripperTimeoutError(DeviceError, TimeoutError):
    """The gripper answers, and has not done in time what it was told."""


class RecordingError(ThermograspError, OSError):
    """A recording could not be written to its end, as on a full disk; the file has what came before."""


class StoppedError(DeviceError):
    """A stop came from elsewhere while the device was being told to do something; the rest of that was not done."""
