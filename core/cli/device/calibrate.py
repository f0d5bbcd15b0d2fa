"""`thermograsp device calibrate`: the constants that a device keeps."""

from __future__ import annotations

import argparse
import json
import time
from dataclasses import asdict, fields, replace
from pathlib import Path
from typing import TYPE_CHECKING, Any

from thermograsp.cli.shared import Output, add_port, connect
from thermograsp.errors import InvalidValueError, unknown_name

if TYPE_CHECKING:
    from thermograsp.hardware import Calibration

HELP = "Show the calibration constants that a device keeps, or set them: true = (reported - offset) x (1 + gain)."


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """Arguments of the action."""
    add_port(parser)
    parser.add_argument(
        "--set",
        action="append",
        default=[],
        metavar="NAME=NUMBERS",
        help="constant to set, for the left and then the right fingertip, such as voltage_offset=20e-6,-10e-6; forces "
        "take three numbers for each fingertip; may be repeated",
    )
    parser.add_argument("--load", metavar="FILE", help="file of constants to set, as printed with --json")


def run(args: argparse.Namespace) -> int:
    """Sets what is to be set, reads back, and prints."""
    output = Output(args.json)
    with connect(args) as tips:
        wanted = tips.calibration
        if args.load is not None:
            wanted = _changed(wanted, _loaded(args.load))
        for text in args.set:
            wanted = _changed(wanted, dict([_parsed(text)]))
        if wanted != tips.calibration:
            tips.set_calibration(replace(wanted, date=int(time.time())))
        kept, serial = tips.calibration, tips.identity.serial
    for name, value in asdict(kept).items():
        if name != "date":
            output.line(f"{name:18} {'  '.join(f'{number:g}' for number in _flat(value))}")
    when = time.strftime("%Y-%m-%d %H:%M:%S UTC", time.gmtime(kept.date)) if kept.date else "never"
    output.line(f"{'calibrated':18} {when}")
    output.document({"serial": serial, "calibration": asdict(kept)})
    return 0


def _parsed(text: str) -> tuple[str, list[float]]:
    name, separator, numbers = text.partition("=")
    try:
        if separator:
            return name.strip(), [float(number) for number in numbers.split(",")]
    except ValueError:
        pass
    raise InvalidValueError(f"--set takes NAME=NUMBER,NUMBER..., got {text!r}")


def _loaded(path: str) -> dict[str, list[float]]:
    try:
        content = json.loads(Path(path).read_text(encoding="utf-8"))["calibration"]
        return {name: _flat(value) for name, value in content.items() if name != "date"}
    except (OSError, ValueError, KeyError, TypeError, AttributeError) as error:
        raise InvalidValueError(f"cannot load constants from {path}: {error!r}") from error


def _changed(calibration: Calibration, values: dict[str, list[float]]) -> Calibration:
    known = [field.name for field in fields(calibration) if field.name != "date"]
    shaped: dict[str, Any] = {}
    for name, numbers in values.items():
        if name not in known:
            raise unknown_name("constant", name, known)
        count = len(_flat(getattr(calibration, name)))
        if len(numbers) != count:
            raise InvalidValueError(f"{name} takes {count} numbers, left then right, got {len(numbers)}")
        half = count // 2
        shaped[name] = tuple(numbers) if count == 2 else (tuple(numbers[:half]), tuple(numbers[half:]))
    return replace(calibration, **shaped)


def _flat(value: Any) -> list[float]:
    return [number for item in value for number in (item if isinstance(item, tuple | list) else (item,))]
