"""Fits the preset `heated_thermistor` to metal and wood of runs 1 to 12, and leaves out each part of its structure.

    python studies/sensors/heated_thermistor.py --out BUILD/heated_thermistor.json [--parts]

Cold wood and runs 13 to 20 are predicted, never fitted. The document holds the values with their intervals, and for
every structure how far it is off; --parts takes some ten minutes more. Values go into assets/sensors.toml by hand.
"""

from __future__ import annotations

import argparse
import json
from collections.abc import Callable
from dataclasses import asdict, replace
from pathlib import Path
from typing import Any

import numpy as np

from thermograsp.files import write_text
from thermograsp.thermal.matter import Layer
from thermograsp.thermal.measured import (
    Free,
    Recordings,
    StackFit,
    compare,
    drawn_apart,
    fit_stack,
    known_labels,
    predict,
    shipped_recordings,
    touched_as,
    value_of,
    with_value,
)
from thermograsp.thermal.stack import HeatedStack, Off, Place, Recorder, heated_stack

FITTED_RUNS = 12
FREE = (
    Free("contact.conductance", 100.0, 2e4),
    Free("contact.preload", 0.01, 1.9),
    Free("cover.resistance", 1e-5, 2e-2),
    Free("cover.capacity", 10.0, 1e4),
    Free("film.resistance", 1e-5, 5e-2),
)
NOTHING = 1e-3  # of a part's fitted value, where it is left out

Change = Callable[[HeatedStack], HeatedStack]


def main() -> None:
    """Fits, prints and writes."""
    parser = argparse.ArgumentParser(description="Fits the preset heated_thermistor.")
    parser.add_argument("--out", type=Path, required=True, help="JSON")
    parser.add_argument(
        "--few", action="store_true", help="also fit on one run at a time, and on two touches of one"
    )
    parser.add_argument("--parts", action="store_true", help="leave out each part in turn, too")
    args = parser.parse_args()
    recordings = shipped_recordings()
    best = fitted(recordings, heated_stack("heated_thermistor"), FREE)
    document: dict[str, Any] = {
        "values": {name: asdict(value) for name, value in best.values.items()},
        "errors": errors(recordings, best.stack),
        "parts": {},
    }
    show("all parts", best, document["errors"])
    for layer in best.stack.layers:
        print(layer)
    print(best.stack.contact)
    if args.few:
        document["few"] = {str(n): few(recordings, best.stack, n) for n in (1, 3)}
        write_text(args.out, json.dumps(document, indent=1) + "\n")
    if args.parts:
        for name, (change, held) in left_out().items():
            less = fitted(recordings, change(best.stack), [f for f in FREE if f.name not in held])
            document["parts"][name] = errors(recordings, less.stack)
            show(name, less, document["parts"][name])
            write_text(args.out, json.dumps(document, indent=1) + "\n")
        more = fitted(recordings, with_thermistor(best.stack), (*FREE, Free("thermistor.capacity", 1.0, 5e3)))
        document["parts"]["and a thermistor of its own heat capacity"] = errors(recordings, more.stack)
        show("and a thermistor of its own heat capacity", more, errors(recordings, more.stack))
        for name, metal in (("metal: stainless steel", "stainless_steel"), ("metal: brass", "brass")):
            document["parts"][name] = errors(
                recordings, fitted(recordings, best.stack, FREE, metal).stack, metal
            )
            print(name, document["parts"][name])
    write_text(args.out, json.dumps(document, indent=1) + "\n")


def fitted(recordings: Recordings, start: HeatedStack, free: Any, metal: str = "aluminium") -> StackFit:
    """On metal and wood of the fitted runs."""
    some = recordings.only((recordings.run <= FITTED_RUNS) & (recordings.label != "cold_wood"))
    touched = known_labels(some.labels, {"metal": touched_as(f"metal={metal}")[1]})
    return fit_stack(some, start, touched, free, np.random.default_rng(0))


def errors(recordings: Recordings, stack: HeatedStack, metal: str = "aluminium") -> dict[str, Any]:
    """By label and half; one temperature of the cold wood for all of its touches."""
    touched = known_labels(recordings.labels, {"metal": touched_as(f"metal={metal}")[1]})
    found = predict(recordings, stack, touched)
    document: dict[str, Any] = {"free_degC": dict(found.free)}
    for half, selected in (
        ("fitted", recordings.run <= FITTED_RUNS),
        ("others", recordings.run > FITTED_RUNS),
    ):
        rows = compare(recordings.only(selected), found.curves[selected], np.random.default_rng(0))
        document[half] = {row.label: {**asdict(row), "ratio": row.ratio} for row in rows}
    early, later = (
        recordings.only(selected)
        for selected in (recordings.run <= FITTED_RUNS, recordings.run > FITTED_RUNS)
    )
    for label, row in document["others"].items():
        row["drawn_apart"] = drawn_apart(early, later, label, np.random.default_rng(0))
    return document


def few(recordings: Recordings, start: HeatedStack, touches: int) -> dict[str, list[float]]:
    """By label, K: median and 90 % of the mean curve's error in the later runs, for fits on the first `touches` of
    metal and of wood of one early run."""
    later = recordings.only(recordings.run > FITTED_RUNS)
    found: dict[str, list[float]] = {label: [] for label in recordings.labels}
    for run in range(1, FITTED_RUNS + 1):
        chosen = [
            np.flatnonzero((recordings.run == run) & (recordings.label == label))[:touches]
            for label in ("metal", "wood")
        ]
        stack = fitted(recordings.only(np.concatenate(chosen)), start, FREE).stack
        curves = predict(later, stack, known_labels(later.labels, {})).curves
        for row in compare(later, curves, np.random.default_rng(0)):
            found[row.label].append(row.mean_rms)
    shares = {label: np.quantile(values, (0.5, 0.9)).tolist() for label, values in found.items()}
    print(f"{touches} touches each of one run", shares, flush=True)
    return shares


def left_out() -> dict[str, tuple[Change, tuple[str, ...]]]:
    """name -> (what is changed, what is then no longer free)."""

    def less(*names: str) -> tuple[Change, tuple[str, ...]]:
        def change(stack: HeatedStack) -> HeatedStack:
            for name in names:
                stack = with_value(stack, name, NOTHING * value_of(stack, name))
            return stack

        return change, names

    def contact(**values: float) -> Change:
        return lambda stack: replace(stack, contact=replace(stack.contact, **values))

    return {
        "no cover": less("cover.resistance", "cover.capacity"),
        "cover without resistance": less("cover.resistance"),
        "cover without heat capacity": less("cover.capacity"),
        "no film: thermistor on the core": less("film.resistance"),
        "no core": (lambda s: with_value(s, "backing.capacity", 100.0), ()),
        "core of half the capacity": (
            lambda s: with_value(s, "backing.capacity", value_of(s, "backing.capacity") / 2),
            (),
        ),
        "no heat before the cut": (lambda s: replace(s, law=Off()), ()),
        "contact without preload": (contact(preload=0.0), ("contact.preload",)),
        "contact constant once the preload is borne": (contact(exponent=0.0), ()),
        "no gap": (contact(gap=0.0), ()),
        "no recorder": (lambda s: replace(s, recorder=Recorder()), ()),
    }


def with_thermistor(stack: HeatedStack) -> HeatedStack:
    """A layer of some heat capacity between film and cover, read in its middle."""
    film, cover = stack.layers
    between = Layer("thermistor", 0.25e-3, 2.0, 3000.0, 400.0)
    return replace(stack, layers=(film, between, cover), readout=Place(1, 0.5))


def show(name: str, fit: StackFit, found: dict[str, Any]) -> None:
    """One structure, in a few lines."""
    print(name, {key: round(value, 1) for key, value in found["free_degC"].items()}, flush=True)
    for key, value in fit.values.items():
        print(
            f"  {key} {value.value:.4g} ({value.low:.4g} to {value.high:.4g}){' AT LIMIT' * value.at_limit}"
        )
    for half in ("fitted", "others"):
        for label, row in found[half].items():
            halves = f", halves apart {row['drawn_apart']:.3f}" if "drawn_apart" in row else ""
            print(
                f"  {half} {label}: mean {row['mean_rms']:.3f} K (drawn {row['drawn']:.3f}{halves}), touches "
                f"{row['touch_rms']:.3f} K, {row['ratio']:.2f} of their scatter",
                flush=True,
            )


if __name__ == "__main__":
    main()
