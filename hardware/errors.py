"""What can go wrong between a host and a device; each message names the cause and the cure."""

from __future__ import annotations

from thermograsp.errors import ThermograspError


class DeviceError(ThermograspError, RuntimeError):
    """Base class of all errors of a device or its line."""


class PortError(DeviceError, OSError):
    """A port cannot be opened."""


class PortMissingError(PortError):
    """The port does not exist: the device is not plugged in, or has another name."""


class PortBusyError(PortError):
    """Another program has the port."""


class PortForbiddenError(PortError):
    """This user may not open the port."""


class LinkLostError(DeviceError, ConnectionError):
    """The port has disappeared or accepts no more bytes."""


class StaleSensorError(DeviceError, TimeoutError):
    """The device should send samples, but none has arrived for too long."""


class NoAnswerError(DeviceError, TimeoutError):
    """A command was sent as often as allowed and was never acknowledged."""


class CommandRefusedError(DeviceError):
    """The device understood a command but did not execute it."""


class WrongDeviceError(DeviceError):
    """The device that answers is of another kind, or is not the one that was connected before."""


class ProtocolVersionError(DeviceError):
    """Host and device speak no common version of the protocol."""


class SensorFaultError(DeviceError):
    """A sensor of the device cannot be trusted: open thermistor, saturated converter, thermostat off its setpoint."""


class GripperFaultError(DeviceError):
    """The gripper reports a fault, or is not ready to move."""


class GripperTimeoutError(DeviceError, TimeoutError):
    """The gripper answers, but has not carried out a command in time."""


class RecordingError(ThermograspError, OSError):
    """A recording could not be completed, for example because the disk is full; the file holds what came before."""


class StoppedError(DeviceError):
    """Another thread stopped the device, or gave it another command, before this command was finished."""
