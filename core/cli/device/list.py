"""`thermograsp device list`: the serial ports of this machine."""

from __future__ import annotations

import argparse

from thermograsp.cli.shared import Output

HELP = "List serial ports, by names that stay the same when a device is plugged in again."


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """It has none."""


def run(args: argparse.Namespace) -> int:
    """Prints the ports; none is no failure."""
    from thermograsp.hardware import ports

    output, found = Output(args.json), ports()
    if found:
        output.table(("port", "device", "description"), [(p.path, p.device, p.description) for p in found])
    else:
        output.line("no serial port; `thermograsp device emulate` makes one")
    output.document(
        {"ports": [{"path": p.path, "device": p.device, "description": p.description} for p in found]}
    )
    return 0
