"""`thermograsp device selftest`: the device's own checks, and those of its line."""

from __future__ import annotations

import argparse

from thermograsp.cli.shared import (
    Output,
    add_port,
    connect,
    link_document,
    link_line,
)

HELP = "Run the device's self-test, and test its line for one second."

_SECONDS = 1
_RATE = 100


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """Arguments of the action."""
    add_port(parser)


def run(args: argparse.Namespace) -> int:
    """Tests and prints. 1 where something failed or a frame was lost."""
    from thermograsp.hardware import HeatersOff, Reset
    from thermograsp.hardware.protocol import Check

    output = Output(args.json)
    with connect(args) as tips:
        identity, result = tips.identity, tips.self_test()
        tips.wait(_SECONDS * _RATE, 2.0 * _SECONDS)
        status, condition, statistics = tips.status(), tips.condition(), tips.statistics()
    checked = [check.name for check in Check if check & result.checks]
    failed = [check.name for check in Check if check & result.failed]
    causes = [str(cause.name) for cause in Reset if cause & condition.reset]
    off = [str(why.name) for why in HeatersOff if why & condition.heaters_off]
    good = not failed and not statistics.lost and not statistics.rejected
    version, firmware = (".".join(map(str, pair)) for pair in (identity.protocol, identity.firmware))
    output.line(
        f"device {identity.serial:#x}, protocol {version}, firmware {firmware}, boot {identity.boots}"
    )
    output.table(
        ("check", "result"),
        [(str(check.name).lower(), _result(check.name, checked, failed)) for check in Check],
    )
    output.line(f"started by: {', '.join(causes).lower().replace('_', ' ') or 'not known'}")
    if off:
        output.line(f"heaters off: {', '.join(off).lower().replace('_', ' ')}")
    output.line(f"supply {status.supply:.2f} V, {status.overruns} overruns, {status.bad_frames} bad frames")
    output.line(link_line(statistics))
    output.document(
        {
            "good": good,
            "checked": checked,
            "failed": failed,
            "reset": causes,
            "heaters_off": off,
            "serial": identity.serial,
            "protocol": version,
            "firmware": firmware,
            "boots": identity.boots,
            "voltage_noise_V": result.voltage_noise,
            "heater_current_A": [
                current if check & result.checks else None
                for check, current in zip(
                    (Check.LEFT_HEATER, Check.RIGHT_HEATER), result.heater_current, strict=True
                )
            ],
            "supply_V": status.supply,
            "overruns": status.overruns,
            **link_document(statistics),
        }
    )
    return 0 if good else 1


def _result(name: str | None, checked: list[str | None], failed: list[str | None]) -> str:
    """What the device says of a check; of one that it cannot make, or does not know, nothing is."""
    if name in failed:
        return "failed"
    return "good" if name in checked else "not checked"
