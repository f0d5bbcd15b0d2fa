"""`thermograsp validate`: recorded touches of a real heated sensor, predicted one by one."""

from __future__ import annotations

import argparse
from dataclasses import asdict
from typing import TYPE_CHECKING, Any

from thermograsp.cli.shared import Output, target
from thermograsp.errors import InvalidValueError

if TYPE_CHECKING:
    import numpy as np

    from thermograsp.thermal.measured import Comparison, Confusion, Predictions, Recordings, Touched
    from thermograsp.thermal.stack import HeatedStack

NAME = "validate"
HELP = "Predict the recorded touches of a real heated sensor, and report the errors of the predictions."

_SHIPPED_SPLIT = 12  # the last run that the preset heated_thermistor is fitted to
_SEED = 0  # of runs drawn again


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """Arguments of the command."""
    add = parser.add_argument
    add(
        "file",
        nargs="?",
        metavar="FILE",
        help="file of recorded touches, .npz (default: the shipped file of 180 touches of Bhattacharjee et al. 2021)",
    )
    add(
        "--sensor",
        default="heated_thermistor",
        help="name of a heated sensor, or a file that `thermograsp device fit` wrote",
    )
    add(
        "--sample",
        action="append",
        default=[],
        metavar="LABEL=MATERIAL[@WHERE]",
        help="material that a label of the file stands for, and its temperature: @passive for that of the passive "
        "sensor (default), @free for one fitted to all of its touches, or a number in degC; may be repeated",
    )
    add(
        "--split",
        type=int,
        metavar="RUN",
        help="last run on which the sensor was fitted; later runs are shown separately (default: "
        f"{_SHIPPED_SPLIT} for the shipped file)",
    )
    add(
        "--sort",
        action="store_true",
        help="also classify each touch by its curve, with and without the passive sensor",
    )
    add(
        "--plot", metavar="FILE", help="draw the measured and predicted temperature drops: .svg, .png or .pdf"
    )


def run(args: argparse.Namespace) -> int:
    """Predicts, compares and prints. 0 only where every touch was predicted."""
    from thermograsp.thermal.measured import (
        known_labels,
        load_recordings,
        predict,
        shipped_recordings,
        touched_as,
    )
    from thermograsp.thermal.stack import heated_stack

    picture = target(args.plot, (".svg", ".png", ".pdf"))
    recordings = shipped_recordings() if args.file is None else load_recordings(args.file)
    stack = heated_stack(args.sensor)
    touched = known_labels(recordings.labels, dict(touched_as(text) for text in args.sample))
    split = _SHIPPED_SPLIT if args.file is None and args.split is None else args.split
    parts = _parts(recordings, split)
    found = predict(recordings, stack, touched)
    rows = _compared(recordings, found.curves, parts)
    sorted_as = _sorted(recordings, stack, touched, parts) if args.sort else {}
    if picture is not None:
        from thermograsp.figures import plot_validation

        drawn = [(name, recordings.only(chosen), found.curves[chosen]) for name, chosen in parts]
        plot_validation(picture, drawn, stack.name)
    _print(Output(args.json), args, recordings, found, rows, sorted_as)
    return 0


def _parts(recordings: Recordings, split: int | None) -> list[tuple[str, np.ndarray]]:
    """(name, mask) of runs to show apart."""
    import numpy as np

    if split is None:
        return [("all runs", np.ones(len(recordings.run), bool))]
    early = recordings.run <= split
    if early.all() or not early.any():
        raise InvalidValueError(
            f"--split {split} leaves all runs on one side: the file's go from {recordings.run.min()} to "
            f"{recordings.run.max()}"
        )
    return [(f"runs up to {split}", early), ("later runs", ~early)]


def _compared(
    recordings: Recordings, curves: np.ndarray, parts: list[tuple[str, np.ndarray]]
) -> list[tuple[str, Comparison, float]]:
    """(part, comparison, drawn_apart)."""
    import numpy as np

    from thermograsp.thermal.measured import compare, drawn_apart

    rows = []
    for name, chosen in parts:
        first = name == parts[0][0]
        for row in compare(recordings.only(chosen), curves[chosen], np.random.default_rng(_SEED)):
            between = float("nan")
            if not first and row.label in recordings.only(~chosen).labels:
                halves = recordings.only(~chosen), recordings.only(chosen)
                between = drawn_apart(*halves, row.label, np.random.default_rng(_SEED))
            rows.append((name, row, between))
    return rows


def _sorted(
    recordings: Recordings,
    stack: HeatedStack,
    touched: dict[str, Touched],
    parts: list[tuple[str, np.ndarray]],
) -> dict[str, list[tuple[str, Confusion]]]:
    """By sensors: (part, confusion)."""
    from thermograsp.thermal.measured import confusion, sort_touches

    tables: dict[str, list[tuple[str, Confusion]]] = {}
    for sensors, passive in (("heated sensor alone", False), ("with the passive sensor", True)):
        chance = sort_touches(recordings, stack, touched, parts[0][1], passive=passive)
        tables[sensors] = [
            (name, confusion(recordings.only(chosen), list(touched), chance[chosen]))
            for name, chosen in parts
        ]
    return tables


def _print(
    output: Output,
    args: argparse.Namespace,
    recordings: Recordings,
    found: Predictions,
    rows: list[tuple[str, Comparison, float]],
    sorted_as: dict[str, list[tuple[str, Confusion]]],
) -> None:
    import numpy as np

    from thermograsp.thermal.measured import drops_of

    output.line(f"{len(recordings.run)} touches predicted with {args.sensor}; drops from -0.3 s on, K")
    output.line()
    header = ("touches", "mean rms", "largest", "draw", "touch rms", "largest", "scatter", "ratio")
    output.table(
        ("runs, label", *header),
        [
            (
                f"{name}, {row.label}",
                str(row.touches),
                *(
                    f"{v:.3f}"
                    for v in (row.mean_rms, row.mean_largest, row.drawn if between != between else between)
                ),
                *(f"{v:.3f}" for v in (row.touch_rms, row.touch_largest, row.scatter)),
                f"{row.ratio:.2f}",
            )
            for name, row, between in rows
        ],
    )
    output.line()
    output.line(
        "draw: by how much means of runs drawn again differ, in 95 % of draws (later runs: both halves drawn)"
    )
    for label, degrees in found.free.items():
        output.line(f"{label}: {degrees:.1f} degC fits best, the one free number")
    for sensors, tables in sorted_as.items():
        for name, table in tables:
            output.line()
            output.line(f"{sensors}, {name}: {100 * table.right:.1f} % right")
            output.table(
                ("is \\ said", *table.labels),
                [
                    (label, *map(str, row))
                    for label, row in zip(table.labels, table.table.tolist(), strict=True)
                ],
            )
    if args.plot:
        output.line(f"wrote {args.plot}")
    error = recordings.drops - drops_of(recordings, found.curves)
    output.document(
        {
            "file": args.file,
            "sensor": args.sensor,
            "parts": [
                {"runs": name, **asdict(row), "ratio": row.ratio, "drawn_apart": between}
                for name, row, between in rows
            ],
            "free_degC": dict(found.free),
            "touches": [_touch(recordings, found, error, i) for i in range(len(error))],
            "sorted": {
                sensors: [
                    {"runs": name, "labels": table.labels, "table": table.table, "right": table.right}
                    for name, table in tables
                ]
                for sensors, tables in sorted_as.items()
            },
            "predicted": int(np.isfinite(found.curves).all(axis=1).sum()),
            "out": args.plot,
        }
    )


def _touch(recordings: Recordings, found: Predictions, error: np.ndarray, i: int) -> dict[str, Any]:
    return {
        "run": recordings.run[i],
        "label": recordings.label[i],
        "sample_degC": found.temperature[i],
        "rms_K": float((error[i] ** 2).mean() ** 0.5),
        "largest_K": float(abs(error[i]).max()),
    }
