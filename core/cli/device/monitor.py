"""`thermograsp device monitor`: what the fingertips feel, as they feel it."""

from __future__ import annotations

import argparse
import sys
import time
from collections.abc import Callable
from typing import TYPE_CHECKING

import numpy as np

from thermograsp.cli.shared import (
    LivePlot,
    Output,
    add_duration,
    add_port,
    add_sampling,
    connect,
    link_document,
    link_line,
)
from thermograsp.hardware.errors import DeviceError

if TYPE_CHECKING:
    from thermograsp.hardware import Fingertips, Samples

HELP = (
    "Show voltages, temperatures and forces live, as a plot on a terminal or a line per second in a pipe. With --json, "
    "print a line of JSON for each sample and a last one with the counts."
)

_PERIOD = 0.1  # s between pictures
_LINES = 1.0  # s between lines


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """Arguments of the action."""
    add_port(parser)
    add_sampling(parser)
    add_duration(parser)


def run(args: argparse.Namespace) -> int:
    """Shows until the end of the time or an interrupt. 1 where the line was broken at the end."""
    output = Output(args.json)
    with connect(args) as tips:
        if args.json:
            broken = _follow(tips, args.seconds, _records(output))
        elif not sys.stdout.isatty():
            broken = _follow(tips, args.seconds, _lines(output))
        else:
            with LivePlot(f"{args.port}  {tips.identity.serial:#x}") as plot:
                broken = _follow(tips, args.seconds, plot.show)
        statistics = tips.statistics()
    if broken:
        output.warn(broken)
    output.line(link_line(statistics))
    output.record({"end": {"port": args.port, "broken": broken, **link_document(statistics)}})
    return 1 if broken else 0


def _follow(tips: Fingertips, seconds: float | None, show: Callable[[Samples | None, str], None]) -> str:
    """What is wrong with the line at the end, "" for nothing."""
    end = time.monotonic() + (seconds if seconds is not None else np.inf)
    broken = ""
    try:
        while time.monotonic() < end:
            time.sleep(_PERIOD)
            try:
                samples, broken = tips.take(), ""
            except DeviceError as error:
                samples, broken = None, str(error)
            show(samples, broken)
    except KeyboardInterrupt:
        pass
    return broken


def _records(output: Output) -> Callable[[Samples | None, str], None]:
    """Prints every sample as JSON, and what is wrong with the line when that changes."""
    last = ""

    def show(samples: Samples | None, broken: str) -> None:
        nonlocal last
        if broken != last:
            output.record({"broken": broken})
        last = broken
        for k in range(0 if samples is None else len(samples)):
            assert samples is not None
            output.record(
                {
                    "time_s": samples.time[k],
                    "voltage_V": samples.voltage[k],
                    "thermostat_degC": samples.thermostat[k],
                    "force_N": samples.force[k],
                    "faults": samples[k : k + 1].faults.name or "",
                }
            )

    return show


def _lines(output: Output) -> Callable[[Samples | None, str], None]:
    """Prints the newest sample once a second."""
    last = -np.inf

    def show(samples: Samples | None, broken: str) -> None:
        nonlocal last
        now = time.monotonic()
        if now - last < _LINES or (not broken and (samples is None or not len(samples))):
            return
        last = now
        if samples is None:
            output.line(f"-- {broken}")
            return
        volts, degrees, newtons = 1e3 * samples.voltage[-1], samples.thermostat[-1], samples.force[-1, :, 0]
        output.line(
            f"{volts[0]:8.3f} {volts[1]:8.3f} mV  {degrees[0]:6.2f} {degrees[1]:6.2f} degC  "
            f"{newtons[0]:6.2f} {newtons[1]:6.2f} N"
        )

    return show
