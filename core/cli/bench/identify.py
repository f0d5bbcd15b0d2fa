"""`thermograsp bench identify`: how often materials are told apart, the Bayes limit, and what learns from examples."""

from __future__ import annotations

import argparse
from dataclasses import asdict
from pathlib import Path

import numpy as np

from thermograsp.bench import identification_run as run
from thermograsp.bench.identification import SETUP, WINDOWS
from thermograsp.bench.identification_figure import draw_identification
from thermograsp.cli.output import Output
from thermograsp.thermal import SEED_MATERIALS

_FEW = ("plastic", "rubber", "glass", "aluminium")
_TITLES = {
    "limit": "Bayes limit",
    "identify": "thermograsp identify",
    "svm": "SVM + PCA",
    "net": "recurrent net",
}


def measure(
    args: argparse.Namespace, output: Output, folder: Path, footnote: str
) -> tuple[list[Path], object]:
    """Measures, prints and draws. Returns the files of its figure and what goes into the JSON document."""
    tests, examples, objects = (80, 120, 60) if args.quick else (2000, 3000, 2000)
    materials, others = (_FEW, _FEW) if args.quick else (SEED_MATERIALS, run.ELEVEN)
    rng = np.random.default_rng(args.seed)
    with output.progress(1) as advance:

        def doing(what: str) -> None:
            advance(what, 0)

        ten, missing = run.compare(rng, SETUP, materials, WINDOWS, tests, examples, doing)
        setups = {"unknown": SETUP, "steady": run.STEADY}
        elevens = {
            name: run.compare(rng, one, others, run.ELEVEN_WINDOWS, tests // 2, examples, doing, net=False)[0]
            for name, one in setups.items()
        }
        coverage = run.cover(rng, objects, doing)
    for reason in missing:
        output.warn(f"{reason}; its curve is left out")
    _tables(output, ten, elevens, coverage)
    figures = draw_identification(folder / "identify", ten, elevens, coverage, footnote)
    return figures, {
        "materials": materials,
        "touches": tests,
        "examples": examples,
        "windows_s": ten.windows,
        "right": ten.share,
        "agreement_with_limit": [_agreement(ten, window) for window in ten.windows],
        "cpu_median_s": [float(np.median(ten.found[window].seconds)) for window in ten.windows],
        "cpu_99_s": [float(np.quantile(ten.found[window].seconds, 0.99)) for window in ten.windows],
        "confusion": {f"{window:g}": ten.confusion(window) for window in ten.windows},
        "eleven": {
            "materials": others,
            "windows_s": run.ELEVEN_WINDOWS,
            "conductance_W_m2K": {name: one.conductance for name, one in setups.items()},
            "right": {name: one.share for name, one in elevens.items()},
        },
        "published": run.PUBLISHED,
        "coverage": [asdict(one) for one in coverage],
    }


def _agreement(ten: run.Accuracies, window: float) -> float:
    """Share of touches where identifier and brute force name the same material."""
    same = ten.found[window].probability.argmax(axis=1) == ten.limit[window].argmax(axis=1)
    return float(np.mean(same))


def _tables(
    output: Output, ten: run.Accuracies, elevens: dict[str, run.Accuracies], coverage: list[run.Coverage]
) -> None:
    output.line(f"right, % of {len(ten.truth)} touches of {len(ten.materials)} materials, by contact time")
    _shares(output, ten)
    output.table(
        ("", *(f"{window:g} s" for window in ten.windows)),
        [
            ("same as the limit", *(f"{100 * _agreement(ten, window):.1f}" for window in ten.windows)),
            *(
                (title, *(f"{1e3 * np.quantile(ten.found[w].seconds, share):.1f} ms" for w in ten.windows))
                for title, share in (("a posterior, median", 0.5), ("99 % are faster than", 0.99))
            ),
        ],
    )
    output.line()
    for name, eleven in elevens.items():
        output.line(
            f"right, % of {len(eleven.truth)} touches of {len(eleven.materials)} materials, contact {name}"
        )
        _shares(output, eleven)
    published = ", ".join(f"{100 * share:.0f} % at {window:g} s" for window, share in run.PUBLISHED.items())
    output.line(f"published for eleven (another sensor, SVM + PCA, RSS 2015): {published}")
    output.line()
    output.line(
        "fresh objects of any effusivity: inside their 90 % interval, and its upper end over its lower"
    )
    output.table(
        ("contact", "held", "10 %", "median", "90 %"),
        [
            (f"{one.window:g} s", f"{100 * one.held:.1f} %", *(f"{ratio:.2f}" for ratio in one.ratio))
            for one in coverage
        ],
    )


def _shares(output: Output, found: run.Accuracies) -> None:
    output.table(
        ("", *(f"{window:g} s" for window in found.windows)),
        [(_TITLES[name], *(f"{100 * one:.1f}" for one in values)) for name, values in found.share.items()],
    )
    output.line()
