"""`thermograsp demo`: ten materials grasped in both modes, and a page that shows what the fingertips felt."""

from __future__ import annotations

import argparse
import time
from collections.abc import Sequence
from typing import TYPE_CHECKING

from thermograsp.cli.shared import Output, add_seed, load_mujoco
from thermograsp.files import made_folder, write_text

if TYPE_CHECKING:
    from thermograsp.reports.demo import ModeRun

NAME = "demo"
HELP = "Grasp all ten seed materials in both modes; write a page, a CSV file for each run, and a table."

_MODES = ("T", "O")
_SECONDS, _QUICK = 10.0, 4.0
_FAILED = 1


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """Arguments of the command."""
    add = parser.add_argument
    add("--out", default="out/demo", metavar="DIR", help="folder for the page and the tables")
    add_seed(parser, "seed of the objects' places and of the noise")
    add("--quick", action="store_true", help=f"shorter grasps, of {_QUICK:g} s instead of {_SECONDS:g} s")


def run(args: argparse.Namespace) -> int:
    """Runs, writes and prints. 1 where an object was not lifted and held."""
    output = Output(args.json)
    load_mujoco(output)
    from thermograsp.columns import write_csv
    from thermograsp.figures import presses, touches
    from thermograsp.reports.demo import Settings, demo_page, run_mode, versions

    begun = time.perf_counter()
    out = made_folder(args.out)
    seconds = _QUICK if args.quick else _SECONDS
    with output.progress(20.0 * len(_MODES)) as advance:
        runs = [run_mode(mode, seconds, args.seed, mode == "T", advance) for mode in _MODES]
    files = []
    for grasp in (grasp for one in runs for grasp in one.grasps):
        files.append(out / f"{grasp.recording.material}_{grasp.mode}.csv")
        write_csv(files[-1], grasp.recording.columns)
    page = out / "index.html"
    write_text(page, demo_page(runs, presses(), touches(), Settings(seconds, args.seed, _command(args))))
    _print(output, runs)
    if runs[0].no_picture:
        output.warn(f"no pictures: {runs[0].no_picture}")
    wall = time.perf_counter() - begun
    output.line(f"\n{page} and {len(files)} CSV files in {wall:.0f} s")
    output.document(
        {
            "seconds": seconds,
            "seed": args.seed,
            "wall_s": wall,
            "page": str(page),
            "versions": versions(),
            "no_picture": runs[0].no_picture,
            "speed": {
                one.mode: {
                    "physics_steps_per_s": one.physics_steps_per_s,
                    "heat_share": one.heat_share,
                    "mechanics_share": one.mechanics_share,
                }
                for one in runs
            },
            "runs": [
                {**grasp.summary, "csv": str(file)}
                for grasp, file in zip((g for one in runs for g in one.grasps), files, strict=True)
            ],
        }
    )
    failed = [
        f"{grasp.recording.material} ({grasp.mode} mode{grasp.recording.ending and ', '}{grasp.recording.ending})"
        for one in runs
        for grasp in one.grasps
        if not grasp.recording.success
    ]
    if failed:
        output.warn(f"not lifted and held: {', '.join(failed)}")
    return _FAILED if failed else 0


def _command(args: argparse.Namespace) -> str:
    return "thermograsp demo" + " --quick" * args.quick + f" --seed {args.seed}" * bool(args.seed)


def _print(output: Output, runs: Sequence[ModeRun]) -> None:
    header = ("material", "mode", "peak K", "after s", "end K", "peak mV", "N", "mm2", "W/(m2 K)")
    rows = []
    for one in runs:
        for row in sorted(
            (grasp.summary for grasp in one.grasps), key=lambda row: -float(row["effusivity_Ws05_m2K"])
        ):
            rows.append(
                (
                    str(row["material"]),
                    one.mode,
                    f"{row['peak_temperature_drop_K']:.2f}",
                    f"{row['peak_after_touch_s']:.2f}",
                    f"{row['final_temperature_drop_K']:.2f}",
                    f"{1e3 * float(row['peak_voltage_V']):.2f}",
                    f"{row['force_N']:.2f}",
                    f"{1e6 * float(row['contact_area_m2']):.0f}",
                    f"{row['conductance_W_m2K']:.0f}",
                )
            )
    output.table(header, rows)
    for one in runs:
        output.line(
            f"{one.mode} mode: {one.physics_steps_per_s:.0f} physics steps/s; heat takes "
            f"{100 * one.heat_share:.0f} % of the time and mechanics {100 * one.mechanics_share:.0f} %"
        )
