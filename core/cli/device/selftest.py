"""`thermograsp device selftest`: the device's own checks, and those of its line."""

from __future__ import annotations

import argparse

from thermograsp.cli.device.connection import add_port, connect, link_document, link_line
from thermograsp.cli.output import Output

HELP = "Have the device test itself, and test its line for a second."

_SECONDS = 1
_RATE = 100


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """Arguments of the action."""
    add_port(parser)


def run(args: argparse.Namespace) -> int:
    """Tests and prints. 1 where something failed or a frame was lost."""
    from thermograsp.hardware.messages import Check

    output = Output(args.json)
    with connect(args) as tips:
        identity, result = tips.identity, tips.self_test()
        tips.wait(_SECONDS * _RATE, 2.0 * _SECONDS)
        status, statistics = tips.status(), tips.statistics()
    failed = [check.name for check in Check if check & result.failed]
    good = not failed and not statistics.lost and not statistics.rejected
    version, firmware = (".".join(map(str, pair)) for pair in (identity.protocol, identity.firmware))
    output.line(
        f"device {identity.serial:#x}, protocol {version}, firmware {firmware}, boot {identity.boots}"
    )
    output.table(
        ("check", "result"),
        [(str(check.name).lower(), "failed" if check & result.failed else "good") for check in Check],
    )
    output.line(f"supply {status.supply:.2f} V, {status.overruns} overruns, {status.bad_frames} bad frames")
    output.line(link_line(statistics))
    output.document(
        {
            "good": good,
            "failed": failed,
            "serial": identity.serial,
            "protocol": version,
            "firmware": firmware,
            "boots": identity.boots,
            "voltage_noise_V": result.voltage_noise,
            "heater_current_A": result.heater_current,
            "supply_V": status.supply,
            "overruns": status.overruns,
            **link_document(statistics),
        }
    )
    return 0 if good else 1
