"""`thermograsp identify`: what a touched object is of, from the voltage of the touch."""

from __future__ import annotations

import argparse
from collections.abc import Mapping
from dataclasses import replace
from typing import TYPE_CHECKING, Any

from thermograsp.cli.arguments import target
from thermograsp.cli.output import Output
from thermograsp.errors import InvalidValueError, unknown_name

if TYPE_CHECKING:
    import numpy as np

    from thermograsp.thermal import Identification, Material, TouchSetup

NAME = "identify"
HELP = "Identify the material and effusivity of a touched object from a recorded voltage."

_TIME, _VOLTAGES = "time_s", ("voltage_left_V", "voltage_right_V")
_NOT_TOLD = 1


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """Arguments of the command."""
    add = parser.add_argument
    add(
        "csv",
        metavar="CSV",
        help=f"{_TIME}, and voltage_V or {' and '.join(_VOLTAGES)}, as `grasp` writes them",
    )
    add("--among", nargs="+", metavar="NAME", help="materials it may be (default: the whole table)")
    add("--materials", metavar="FILE", help="your own TOML table in place of the package's")
    add("--mode", default="T", help="T: element on the thermostat (default), O: on the object")
    add("--sensor", default="seed", help="a sensor's name (default seed)")
    add(
        "--fingertips",
        type=int,
        help="1, or 2 on opposite faces (default: as many as the file has voltages)",
    )
    add(
        "--object-size",
        type=float,
        nargs=3,
        metavar=("X", "Y", "THICKNESS"),
        help="m (default 0.04 0.04 0.01, between two fingertips 0.04 0.04 0.04)",
    )
    spread = ("MEAN", "DEVIATION")
    add("--object-temperature", type=float, nargs=2, metavar=spread, help="degC and K (default 24 3)")
    add("--sensor-temperature", type=float, nargs=2, metavar=spread, help="degC and K (default 36 0.1)")
    add(
        "--conductance",
        type=float,
        nargs=2,
        metavar=("LOW", "HIGH"),
        help="of the contact, W/(m2 K) (default 1e3 2e4)",
    )
    add("--touch", type=float, help="time of the touch, s (default: found in the voltage)")
    add("--until", type=float, help="use samples up to this time, s (default: all)")
    add("--bandwidth", type=float, help="of the amplifier, Hz, inf for none (default 30)")
    add("--model-error", type=float, help="of the curves, rms, share of the largest value (default 0.005)")
    add("--tolerance", type=float, help="K that the network of a simulated curve may be off (default 0.05)")
    add("--no-cache", action="store_true", help="do not keep curves on disk")
    add("--out", metavar="FILE", help="draw voltage and posteriors: .svg, .png or .pdf")


def run(args: argparse.Namespace) -> int:
    """Identifies and prints. 1 where the curve does not tell; the reason is printed."""
    from thermograsp import thermal

    picture = target(args.out, (".svg", ".png", ".pdf"))
    t, voltage = _samples(args)
    setup = _setup(args, voltage.shape[1])
    candidates = _candidates(args)
    result = thermal.identify(
        t, voltage, setup=setup, candidates=candidates, touch=args.touch, cache=not args.no_cache
    )
    if picture is not None:
        from thermograsp.report.identify_plot import plot_identification

        plot_identification(picture, t, voltage, setup, candidates, args.touch)
    _print(Output(args.json), args, result)
    return 0 if result.verdict in (thermal.Verdict.MATERIAL, thermal.Verdict.SEVERAL) else _NOT_TOLD


def _samples(args: argparse.Namespace) -> tuple[np.ndarray, np.ndarray]:
    """Times (n,) and voltages (n, F); rows without a number, of lost frames, are left out."""
    import numpy as np

    from thermograsp.report.columns import read_csv

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

    setup = thermal.TouchSetup()
    fingertips = columns if args.fingertips is None else args.fingertips
    thick = (0.04, 0.04, 0.04) if fingertips == 2 else setup.object_size
    given: Mapping[str, Any] = {
        "object_temperature": args.object_temperature,
        "sensor_temperature": args.sensor_temperature,
        "conductance": args.conductance,
        "object_size": args.object_size or thick,
    }
    if args.bandwidth is not None:
        setup = replace(setup, chain=replace(setup.chain, bandwidth=args.bandwidth))
    for name in ("model_error", "tolerance"):
        if (value := getattr(args, name)) is not None:
            setup = replace(setup, **{name: value})
    return replace(
        setup,
        stack=thermal.sensor(args.sensor),
        mode=args.mode,
        fingertips=fingertips,
        **{name: tuple(value) for name, value in given.items() if value is not None},
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
    if args.out:
        output.line(f"wrote {args.out}")
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
            "out": args.out,
        }
    )
