"""`thermograsp device clear-faults`: heaters that have latched themselves off follow their setpoint again."""

from __future__ import annotations

import argparse

from thermograsp.cli.shared import Output, add_port, connect

HELP = "Report why the heaters are latched off, and clear the latch. Inspect the fingertips first."


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """Arguments of the action."""
    add_port(parser)


def run(args: argparse.Namespace) -> int:
    """Clears and prints. 1 where something is left."""
    from thermograsp.hardware import HeatersOff

    output = Output(args.json)
    with connect(args) as tips:
        before = HeatersOff(tips.condition().heaters_off) & ~HeatersOff.HOST_SILENT
        after = HeatersOff(tips.clear_faults().heaters_off) & ~HeatersOff.HOST_SILENT
    cleared, left = ([str(one.name) for one in HeatersOff if one in off] for off in (before & ~after, after))
    output.line(f"cleared: {', '.join(cleared).lower() or 'nothing was latched'}")
    if left:
        output.line(f"latched still: {', '.join(left).lower()}")
    output.document({"cleared": cleared, "left": left})
    return 1 if left else 0
