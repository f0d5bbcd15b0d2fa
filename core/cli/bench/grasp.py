"""`thermograsp bench grasp`: what MuJoCo's settings cost, how well they hold an object, and what heat gets from it."""

from __future__ import annotations

import argparse
from dataclasses import asdict
from pathlib import Path

import numpy as np

from thermograsp.bench import grasp, grasp_course
from thermograsp.bench.grasp_errors import FATES, FIRST, HELD, LATE, METRICS, Errors
from thermograsp.bench.grasp_figure import draw_grasp, draw_grasp_shapes
from thermograsp.cli.output import Output


def measure(
    args: argparse.Namespace, output: Output, folder: Path, footnote: str
) -> tuple[list[Path], object]:
    """Measures, prints and draws. Returns the files of its figures and what goes into the JSON document."""
    with output.progress(grasp.runs(args.quick)) as advance:
        points = grasp.measure(args.quick, np.random.default_rng(args.seed), lambda doing: advance(doing, 1))
    reference = grasp.reference(args.quick)
    output.line(
        f"cost: CPU time of the mechanics over that of what is shipped ({1e3 * points[0].seconds:.1f} ms per second)"
    )
    output.line(
        "slip: farthest, against the gripper, while held and shaken. force: RMS, normal, against the 10 N commanded"
    )
    output.line(
        f"reference: RMS, normal force, against a run with a time step of {1e3 * reference.timestep:g} ms"
    )
    output.line("jitter: RMS scatter of the contact's centroid within 20 ms, less the reference's")
    output.line(
        f"drop: largest error of the temperature drop from {FIRST} s after the touch on, median; late: from {LATE} s on"
    )
    header = (
        "worst of four shapes",
        "cost",
        "slip mm",
        "force N",
        "reference N",
        "jitter um",
        "drop K",
        "late K",
    )
    output.table(header, [(p.variant.name, f"{p.ratio:.2f}", *_cells(p.worst)) for p in points])
    output.line()
    output.table(
        ("fate; slip, mm, and error of the drop, K", *grasp.SHAPES),
        [(p.variant.name, *(_fate(p.shapes[shape]) for shape in grasp.SHAPES)) for p in points],
    )
    output.line()
    shipped = points[0]
    if shipped.beaten_by:
        output.line(f"what is shipped is beaten by {'; '.join(shipped.beaten_by)}")
    else:
        output.line("what is shipped is on the front: nothing is better in one column and worse in none")
    figures = draw_grasp(folder / "grasp", points, 1e3 * reference.timestep, footnote)
    figures += draw_grasp_shapes(folder / "grasp_shapes", points, footnote)
    return figures, {
        "force_commanded_N": grasp_course.FORCE,
        "seconds": grasp_course.duration(),
        "phases_s": {name: grasp_course.PERIOD * steps for name, steps in grasp_course.PHASES.items()},
        "placements": grasp.placement_count(args.quick),
        "reference": asdict(reference),
        "metrics": METRICS,
        "fates": FATES,
        "points": [
            {
                "family": p.variant.family,
                "label": p.variant.label,
                "settings": asdict(p.variant.settings),
                "seconds_per_second": p.seconds,
                "ratio": p.ratio,
                "worst": _numbers(p.worst),
                "shapes": {shape: _numbers(errors) for shape, errors in p.shapes.items()},
                "beaten_by": p.beaten_by,
            }
            for p in points
        ],
    }


def _cells(errors: Errors) -> list[str]:
    if errors.fate != HELD:
        return [errors.fate, *[""] * (len(METRICS) - 1)]
    return [f"{getattr(errors, name):.4g}" for name in METRICS]


def _fate(errors: Errors) -> str:
    return f"{errors.slip:.4f} {errors.drop:.3f}" if errors.fate == HELD else errors.fate


def _numbers(errors: Errors) -> dict[str, object]:
    return {
        "fate": errors.fate,
        **{f"{name}_{unit}": getattr(errors, name) for name, unit in METRICS.items()},
    }
