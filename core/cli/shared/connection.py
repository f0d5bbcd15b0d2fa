"""What actions on a device share: the port and how to open it, and the service of an emulator."""

from __future__ import annotations

import argparse
import sys
import time
from collections.abc import Mapping
from typing import TYPE_CHECKING, Any

from thermograsp.cli.shared.arguments import add_duration, add_seed
from thermograsp.cli.shared.output import Output
from thermograsp.errors import InvalidValueError

if TYPE_CHECKING:
    from thermograsp.hardware import Fingertips, LinkStatistics, Tap

_BAUD = 500_000
_RATE = 100
_FOREVER = 2**31 - 1.0  # s


def add_port(parser: argparse.ArgumentParser) -> None:
    """PORT and --baud."""
    parser.add_argument(
        "port",
        metavar="PORT",
        help="serial port of the device, such as /dev/serial/by-id/..., see `thermograsp device list`",
    )
    parser.add_argument("--baud", type=int, default=_BAUD, help="bit rate of the line, bits per second")


def add_sampling(parser: argparse.ArgumentParser) -> None:
    """--rate and --setpoint."""
    parser.add_argument("--rate", type=int, default=_RATE, help="sampling rate, samples per second")
    parser.add_argument(
        "--setpoint",
        type=float,
        help="temperature of both thermostats, degC (default: the heaters stay as they are)",
    )


def add_service(parser: argparse.ArgumentParser, seed: str, faults: str = "") -> None:
    """--link, --seed, --seconds, and --fault where the emulator has faults, of which some examples are given."""
    add = parser.add_argument
    add("--link", metavar="PATH", help="path of a symbolic link to the port (default: none)")
    add_seed(parser, seed)
    add_duration(parser)
    if faults:
        about = f"fault to emulate and its time, such as {faults}; may be repeated; an unknown name lists all"
        add("--fault", action="append", default=[], metavar="NAME[=VALUE][@SECONDS]", help=about)


def serve(args: argparse.Namespace, url: str, document: Mapping[str, Any]) -> int:
    """Prints where the emulator is, and waits for the end of the time or an interrupt. Returns the exit status."""
    output = Output(args.json)
    output.line(f"{url}  (Ctrl-C ends it)")
    output.document(document)
    sys.stdout.flush()
    try:
        time.sleep(_FOREVER if args.seconds is None else args.seconds)
    except KeyboardInterrupt:
        pass
    return 0


def connect(args: argparse.Namespace, tap: Tap | None = None) -> Fingertips:
    """The driver that the arguments describe, sampling."""
    from thermograsp.hardware import Fingertips

    rate = getattr(args, "rate", _RATE)
    if not 1 <= rate <= 65535:
        raise InvalidValueError(f"rate must be 1 to 65535 samples a second, got {rate}")
    setpoint = getattr(args, "setpoint", None)
    return Fingertips(args.port, baud=args.baud, rate=rate, setpoint=setpoint, tap=tap)


def link_document(statistics: LinkStatistics) -> Mapping[str, Any]:
    """The line's statistics for a JSON document."""
    names = [name for name in statistics.__slots__ if name not in ("drift", "age")]
    return {**{name: getattr(statistics, name) for name in names}, "drift_ppm": 1e6 * statistics.drift}


def link_line(statistics: LinkStatistics) -> str:
    """The line's statistics for people."""
    return (
        f"{statistics.samples} samples, {statistics.lost} frames lost, {statistics.rejected} rejected, "
        f"{statistics.reconnects} reconnects, {statistics.reboots} reboots, clock {1e6 * statistics.drift:+.0f} ppm"
    )
