"""`thermograsp bench episode`: what simulated time costs, against the error of the voltage that the agent sees."""

from __future__ import annotations

import argparse
from dataclasses import asdict
from pathlib import Path

from thermograsp.bench import end_to_end
from thermograsp.bench.end_to_end_figure import draw_end_to_end
from thermograsp.cli.output import Output


def measure(
    args: argparse.Namespace, output: Output, folder: Path, footnote: str
) -> tuple[list[Path], object]:
    """Measures, prints and draws. Returns the files of its figure and what goes into the JSON document."""
    num_envs, repeats = (4, 1) if args.quick else (16, 2)
    chosen = end_to_end.settings(args.quick)
    with output.progress(1 + repeats * len(chosen)) as advance:
        points = end_to_end.measure(
            chosen,
            num_envs,
            repeats,
            args.seed,
            lambda s: advance(f"{1e3 * s.timestep:g} ms x {s.substeps}, {s.tolerance:g} K", 1),
        )
    output.line("speed as a multiple of the shipped setting's, and the error of the felt voltage; * = front")
    output.table(
        ("time step", "frame skip", "control step", "tolerance", "speed", "error", "of the signal", ""),
        [
            (
                f"{1e3 * p.setting.timestep:g} ms",
                str(p.setting.substeps),
                f"{1e3 * p.setting.period:g} ms",
                f"{p.setting.tolerance:g} K",
                f"{p.speed:.2f}",
                f"{1e6 * p.error:.1f} uV",
                f"{100 * p.relative:.2f} %",
                "*" * p.pareto + " shipped" * (p.setting == end_to_end.SHIPPED) + " LOST" * bool(p.lost),
            )
            for p in sorted(points, key=lambda p: p.speed)
        ],
    )
    files = draw_end_to_end(folder / "end_to_end", points, num_envs, footnote)
    return files, {
        "environments": num_envs,
        "materials": end_to_end.MATERIALS,
        "reference": asdict(end_to_end.REFERENCE),
        "shipped": asdict(end_to_end.SHIPPED),
        "points": [
            {
                **asdict(p.setting),
                "control_step_s": p.setting.period,
                "seconds_per_second": p.seconds,
                "speed": p.speed,
                "error_V": p.error,
                "relative": p.relative,
                "lost": p.lost,
                "pareto": p.pareto,
            }
            for p in points
        ],
    }
