"""`thermograsp device fit`: a sensor's properties from recordings of touches, as a preset that the simulation loads."""

from __future__ import annotations

import argparse
from dataclasses import replace
from typing import TYPE_CHECKING, Any

from thermograsp.cli.shared import (
    Output,
    add_materials_file,
    add_object_size,
    add_old_name,
    chosen_material,
    target,
)
from thermograsp.errors import InvalidValueError, unknown_name

if TYPE_CHECKING:
    from thermograsp.thermal import Estimate, KnownTouch, SensorFit

HELP = (
    "Fit a sensor to recordings of touches on known materials, and write it as a preset for the simulation."
)

_SIDES = ("left", "right")


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """Arguments of the action."""
    add = parser.add_argument
    add(
        "recordings",
        nargs="+",
        metavar="MATERIAL[@DEGC]=FILE",
        help="known material and a recording from `thermograsp device record` whose first touch is of that "
        "material, such as glass=a.tgr, or glass@21.5=a.tgr for an object at 21.5 degC",
    )
    add_materials_file(parser)
    preset = add(
        "--save",
        dest="out",
        metavar="FILE",
        help="write the sensor as a preset: .toml, to load with sensor=FILE or --sensor FILE",
    )
    add_old_name(parser, "--out", preset)
    add("--fingertip", default="left", help="fingertip to fit: left or right")
    warmth = add(
        "--object-temperature",
        dest="temperature",
        type=float,
        default=24.0,
        help="initial temperature of the objects for which none is given, degC",
    )
    add_old_name(parser, "--temperature", warmth)
    add_object_size(parser)
    add(
        "--start",
        default="seed",
        help="sensor of the same make to start from: a name, or a file that `thermograsp device fit` wrote",
    )
    add("--chain", default="ads1115", help="signal chain (amplifier and converter): ads1115 or ideal")
    add(
        "--hold",
        action="append",
        default=[],
        metavar="NAME",
        help="property to keep as in --start: seebeck, offset, delay, conductivity or heat_capacity; may be repeated",
    )


def run(args: argparse.Namespace) -> int:
    """Fits, writes and prints. 1 where the recordings cannot tell something; the preset is written all the same."""
    from thermograsp.thermal import SIGNAL_CHAINS, fit_sensor, write_sensor
    from thermograsp.thermal.fitting import UNITS
    from thermograsp.thermal.stack import HeatedStack, any_sensor

    out = target(args.out, (".toml",))
    if args.fingertip not in _SIDES:
        raise unknown_name("fingertip", args.fingertip, _SIDES)
    if args.chain not in SIGNAL_CHAINS:
        raise unknown_name("signal chain", args.chain, SIGNAL_CHAINS)
    start = any_sensor(args.start)
    if out is not None and isinstance(start, HeatedStack):
        raise InvalidValueError(
            f"--save writes sensors on a thermostat, and {start.name!r} has a heater of its own: leave --save out, and "
            "put the numbers that are printed into its file"
        )
    touches = [_touch(text, args) for text in args.recordings]
    fit = fit_sensor(touches, start=start, chain=SIGNAL_CHAINS[args.chain], hold=args.hold)
    output = Output(args.json)
    percent = f"{100 * fit.confidence:g} %"
    output.table(
        ("parameter", "value", "low", "high", "unit"),
        [(name, *_numbers(e), UNITS[name]) for name, e in fit.shared.items()]
        + [
            (f"conductance, {touch.name}", *_numbers(e), "W/(m2 K)")
            for touch, e in zip(touches, fit.conductances, strict=True)
        ],
    )
    output.line(
        f"intervals of {percent}; residuals {1e6 * fit.noise:.2f} uV rms, at most {max(fit.misfit):.2%} of a touch"
    )
    for sentence in fit.untold:
        output.line(f"not told: {sentence}")
    if out is not None and not isinstance(fit.stack, HeatedStack):
        write_sensor(out, replace(fit.stack, name=out.stem), _notes(fit, touches, args.fingertip))
        output.line(f"wrote {args.out}")
    output.document(
        {
            "shared": {name: _document(e, UNITS[name]) for name, e in fit.shared.items()},
            "touches": [
                {"name": touch.name, "conductance": _document(e, "W/(m2 K)"), "misfit": misfit}
                for touch, e, misfit in zip(touches, fit.conductances, fit.misfit, strict=True)
            ],
            "confidence": fit.confidence,
            "correlation": {"order": list(UNITS), "matrix": fit.correlation},
            "noise_V": fit.noise,
            "untold": fit.untold,
            "preset": args.out,
        }
    )
    return 1 if fit.untold else 0


def _touch(text: str, args: argparse.Namespace) -> KnownTouch:
    """Of "MATERIAL[@DEGC]=FILE"."""
    from thermograsp.hardware import known_touch, replay

    what, _, file = text.partition("=")
    name, _, degrees = what.partition("@")
    try:
        temperature = float(degrees) if degrees else args.temperature
    except ValueError:
        file = ""
        temperature = 0.0
    if not file:
        raise InvalidValueError(f"give MATERIAL=FILE or MATERIAL@DEGC=FILE, got {text!r}")
    return known_touch(
        replay(file).samples,
        chosen_material(name, args.materials),
        name=text,
        fingertip=_SIDES.index(args.fingertip),
        object_temperature=temperature,
        object_size=tuple(args.object_size),
    )


def _notes(fit: SensorFit, touches: list[KnownTouch], fingertip: str) -> list[str]:
    from thermograsp.thermal.fitting import UNITS

    materials = ", ".join(sorted({touch.material.name for touch in touches}))
    return [
        f"Fitted to {len(touches)} touches of the {fingertip} fingertip ({materials}); {fit.confidence:.0%} intervals:",
        *(
            f"{name} {e.value:.6g} ({e.low:.6g} to {e.high:.6g}) {UNITS[name]}"
            for name, e in fit.shared.items()
        ),
        *(f"not told: {sentence}" for sentence in fit.untold),
        "",
    ]


def _numbers(estimate: Estimate) -> tuple[str, str, str]:
    return f"{estimate.value:.5g}", f"{estimate.low:.5g}", f"{estimate.high:.5g}"


def _document(estimate: Estimate, unit: str) -> dict[str, Any]:
    return {"value": estimate.value, "low": estimate.low, "high": estimate.high, "unit": unit}
