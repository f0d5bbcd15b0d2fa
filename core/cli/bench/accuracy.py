"""`thermograsp bench accuracy`: what a second of contact costs, against the largest error, for every method."""

from __future__ import annotations

import argparse
from pathlib import Path

import numpy as np

from thermograsp.bench import accuracy, elements, fipy_press
from thermograsp.bench.accuracy_figure import draw_accuracy
from thermograsp.cli.output import Output

_QUICK_MATERIALS = ("glass",)


def measure(
    args: argparse.Namespace, output: Output, folder: Path, footnote: str
) -> tuple[list[Path], object]:
    """Measures, prints and draws. Returns the files of its figure and what goes into the JSON document."""
    beside = {"scikit-fem": elements.available(), "FiPy": fipy_press.available()}
    for name in (name for name, here in beside.items() if not here):
        output.warn(f"{name} is not installed, so its points are left out: pip install thermograsp[bench]")
    names = _QUICK_MATERIALS if args.quick else accuracy.MATERIALS
    cases = [(name, mode) for mode in "TO" for name in names]
    methods = accuracy.methods(args.quick)
    rng = np.random.default_rng(args.seed)
    points = []
    with output.progress(len(cases)) as advance:
        for case in cases:
            points += accuracy.measure(case, methods, rng, lambda doing: advance(doing, 0))
            advance("", 1)
    output.line(
        "time per second of contact, its ratio to the network for 0.03 K, and the largest error; * = Pareto front"
    )
    header = ("method", "setting", *(f"{name} {mode}" for name, mode in cases))
    rows = []
    for method in methods:
        mine = [p for p in points if (p.family, p.setting) == (method.family, method.setting)]
        cells = [
            f"{_seconds(p.seconds)} {p.ratio:8.3g}x {p.error:8.4f} K{'*' if p.pareto else ' '}" for p in mine
        ]
        rows.append((method.family, method.setting, *cells))
    for start in range(2, len(header), 2):
        pick = [0, 1, *range(start, min(start + 2, len(header)))]
        output.table([header[i] for i in pick], [[row[i] for i in pick] for row in rows])
        output.line()
    for case in cases:
        auto = [p for p in points if (p.material, p.mode) == case and p.family == "auto"]
        output.line(f"{' '.join(case)}: auto took " + ", ".join(f"{p.detail} for {p.setting}" for p in auto))
    kept = [p.error <= float(p.setting.split()[0]) for p in points if p.family == "auto"]
    output.line(f"auto kept its tolerance in {sum(kept)} of {len(kept)} cases")
    figures = [
        file
        for mode in "TO"
        for file in draw_accuracy(folder / f"accuracy{'' if mode == 'T' else '_o'}", points, mode, footnote)
    ]
    return figures, {
        "reference": "semi_analytic, 3-D, good to 0.0003 K of 12 K",
        "ratio_to": accuracy.RATIO_TO,
        "installed": beside,
        "auto_kept_tolerance": sum(kept),
        "auto_cases": len(kept),
        "points": [
            {
                "material": p.material,
                "mode": p.mode,
                "method": p.family,
                "setting": p.setting,
                "rung": p.detail,
                "seconds_per_second": p.seconds,
                "preparation_s": p.preparation,
                "ratio": p.ratio,
                "error_K": p.error,
                "pareto": p.pareto,
            }
            for p in points
        ],
    }


def _seconds(value: float) -> str:
    return f"{1e6 * value:7.1f} us" if value < 1e-3 else f"{1e3 * value:7.1f} ms"
