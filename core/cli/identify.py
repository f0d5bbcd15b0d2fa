"""`thermograsp identify`: what a touched object is of, from the voltage of the touch."""

from __future__ import annotations

import argparse
from dataclasses import replace
from typing import TYPE_CHECKING

from thermograsp.cli.shared import (
    Output,
    add_materials_file,
    add_mode,
    add_old_name,
    add_sensor,
    add_skin,
    add_tolerance,
    target,
)
from thermograsp.errors import InvalidValueError, unknown_name

if TYPE_CHECKING:
    import numpy as np

    from thermograsp.thermal import Identification, Material, TouchSetup

NAME = "identify"
HELP = "Identify the material and effusivity of a touched object from a recorded voltage."

_TIME, _VOLTAGES = "time_s", ("voltage_left_V", "voltage_right_V")
_UNDECIDED = 1
_SIZES = {1: (0.04, 0.04, 0.01), 2: (0.04, 0.04, 0.04)}  # m, by the number of fingertips


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """Arguments of the command."""
    add = parser.add_argument
    add(
        "csv",
        metavar="CSV",
        help=f"table with the columns {_TIME} and voltage_V, or {_TIME}, {' and '.join(_VOLTAGES)}, as "
        "`thermograsp grasp --csv` writes it",
    )
    add(
        "--among",
        nargs="+",
        metavar="NAME",
        help="names of the materials that it may be (default: the whole table)",
    )
    add_materials_file(parser)
    add_mode(parser)
    add_sensor(parser)
    add_skin(parser)
    add(
        "--fingertips",
        type=int,
        help="number of fingertips: 1, or 2 on opposite faces (default: the number of voltages in the file)",
    )
    add(
        "--object-size",
        type=float,
        nargs=3,
        metavar=("X", "Y", "THICKNESS"),
        help="size of the object, m (default: "
        + ", between two fingertips ".join(" ".join(map(str, size)) for size in _SIZES.values())
        + ")",
    )
    spread = ("MEAN", "DEVIATION")
    for name, what, usual in (("object", "object", (24.0, 3.0)), ("sensor", "thermostat", (36.0, 0.1))):
        about = f"initial temperature of the {what}, degC, and its standard deviation, K"
        add(f"--{name}-temperature", type=float, nargs=2, default=usual, metavar=spread, help=about)
    add(
        "--conductance",
        type=float,
        nargs=2,
        default=(1e3, 2e4),
        metavar=("LOW", "HIGH"),
        help="range of the contact conductance, W/(m2 K)",
    )
    add("--touch", type=float, help="time of the touch, s (default: found in the voltage)")
    add("--until", type=float, help="time of the last sample to use, s (default: all samples)")
    add("--bandwidth", type=float, default=30.0, help="bandwidth of the amplifier, Hz; inf for no limit")
    add(
        "--model-error",
        type=float,
        default=0.005,
        help="rms error of the simulated curves, as a share of their largest value",
    )
    add_tolerance(parser)
    add("--no-cache", action="store_true", help="do not keep simulated curves on disk")
    plot = add("--plot", metavar="FILE", help="draw the voltage and the posteriors: .svg, .png or .pdf")
    add_old_name(parser, "--out", plot)


def run(args: argparse.Namespace) -> int:
    """Identifies and prints. 1 where the curve does not tell; the reason is printed."""
    from thermograsp import thermal

    picture = target(args.plot, (".svg", ".png", ".pdf"))
    t, voltage = _samples(args)
    setup = _setup(args, voltage.shape[1])
    candidates = _candidates(args)
    result = thermal.identify(
        t, voltage, setup=setup, candidates=candidates, touch=args.touch, cache=not args.no_cache
    )
    if picture is not None:
        from thermograsp.figures import plot_identification

        plot_identification(picture, t, voltage, setup, candidates, args.touch)
    _print(Output(args.json), args, result)
    return 0 if result.verdict in (thermal.Verdict.MATERIAL, thermal.Verdict.SEVERAL) else _UNDECIDED


def _samples(args: argparse.Namespace) -> tuple[np.ndarray, np.ndarray]:
    """Times (n,) and voltages (n, F); rows without a number, of lost frames, are left out."""
    import numpy as np

    from thermograsp.columns import read_csv

    columns = read_csv(args.csv)
    found = [name for name in _VOLTAGES if name in columns] or ["voltage_V"]
    for name in (_TIME, *found):
        if name not in columns:
            raise unknown_name(f"column of {args.csv}:", name, columns)
    t, voltage = columns[_TIME], np.stack([columns[name] for name in found], axis=1)
    good = np.isfinite(t) & np.isfinite(voltage).all(axis=1)
    if args.until is not None:
        good &= t <= args.until
    if not good.any():
        raise InvalidValueError(f"{args.csv} has no sample with a time and a voltage")
    return t[good], voltage[good]


def _setup(args: argparse.Namespace, columns: int) -> TouchSetup:
    from thermograsp import thermal
    from thermograsp.thermal.stack import any_sensor

    fingertips = columns if args.fingertips is None else args.fingertips
    usual = thermal.TouchSetup()
    return replace(
        usual,
        stack=any_sensor(args.sensor),
        mode=args.mode,
        fingertips=fingertips,
        object_size=tuple(args.object_size or _SIZES.get(fingertips, usual.object_size)),
        chain=replace(usual.chain, bandwidth=args.bandwidth),
        object_temperature=tuple(args.object_temperature),
        sensor_temperature=tuple(args.sensor_temperature),
        conductance=tuple(args.conductance),
        model_error=args.model_error,
        tolerance=args.tolerance,
        skin=args.skin,
    )


def _candidates(args: argparse.Namespace) -> list[Material]:
    from thermograsp import thermal

    known = thermal.materials() if args.materials is None else thermal.load_materials(args.materials)
    for name in args.among or ():
        if name not in known:
            raise unknown_name("material", name, known)
    return [known[name] for name in dict.fromkeys(args.among or known)]


def _print(output: Output, args: argparse.Namespace, result: Identification) -> None:
    low, high = result.effusivity.interval()
    mean, deviation = result.difference
    output.line(result.message)
    likely = result.likely(0.99)
    chance = dict(zip(result.materials, result.probability.tolist(), strict=True))
    if result.samples:
        output.line()
        output.table(
            ("material", "probability"), [(name, f"{100 * chance[name]:.1f} %") for name in likely[:10]]
        )
        output.line()
        output.line(f"difference of temperature {mean:.2f} +- {deviation:.2f} K (sensor less object)")
        output.line(f"contact {result.conductance:.0f} W/(m2 K) with {result.best.replace('_', ' ')}")
        touches = ", ".join(f"{touch:.3f} s" for touch in result.touch)
        output.line(f"touch at {touches}; {result.samples} samples, noise {1e6 * result.noise:.1f} uV")
    if args.plot:
        output.line(f"wrote {args.plot}")
    output.document(
        {
            "verdict": result.verdict,
            "message": result.message,
            "best": result.best,
            "likely": likely,
            "probability": chance,
            "effusivity_Ws05_m2K": result.effusivity.median,
            "effusivity_90_Ws05_m2K": [low, high],
            "difference_K": mean,
            "difference_deviation_K": deviation,
            "conductance_W_m2K": result.conductance,
            "touch_s": result.touch,
            "noise_V": result.noise,
            "samples": result.samples,
            "out": args.plot,
        }
    )
