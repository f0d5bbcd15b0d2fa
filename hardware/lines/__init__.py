"""What carries bytes: serial ports, pseudo-terminals and lines in virtual time."""

from .emulated import Emulated
from .faults import LineFaults
from .pty_device import PtyDevice
from .serial_port import BAUD, PortInfo, SerialPort, ports
from .transport import Opener, Transport
from .turns import Turns
from .virtual_line import VirtualLine

__all__ = [
    "BAUD",
    "Emulated",
    "LineFaults",
    "Opener",
    "PortInfo",
    "PtyDevice",
    "SerialPort",
    "Transport",
    "Turns",
    "VirtualLine",
    "ports",
]
