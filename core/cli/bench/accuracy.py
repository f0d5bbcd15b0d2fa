"""`thermograsp bench accuracy`: what a second of contact costs, against the largest error, for every method."""

from __future__ import annotations

from thermograsp.bench import Record
from thermograsp.cli.shared import Output
from thermograsp.errors import install


def report(record: Record, output: Output) -> None:
    """Prints a table for each two cases, and how often `auto` kept its tolerance."""
    for name in (name for name, installed in record["installed"].items() if not installed):
        output.warn(f"{name} was not installed, so its points are left out: {install('bench')}")
    points = record["points"]
    cases = list(dict.fromkeys((p["material"], p["mode"]) for p in points))
    found = {(p["material"], p["mode"], p["method"], p["setting"]): p for p in points}
    methods = list(dict.fromkeys((p["method"], p["setting"]) for p in points))
    output.line(
        "time per second of contact, its ratio to the network for 0.03 K, and the largest error; * = Pareto front"
    )
    for pair in (cases[start : start + 2] for start in range(0, len(cases), 2)):
        output.table(
            ("method", "setting", *(" ".join(case) for case in pair)),
            [(*method, *(_cell(found[*case, *method]) for case in pair)) for method in methods],
        )
        output.line()
    for case in cases:
        auto = [found[*case, *method] for method in methods if method[0] == "auto"]
        took = ", ".join(f"{p['rung']} for {p['setting']}" for p in auto)
        output.line(f"{' '.join(case)}: auto took {took}")
    output.line(f"auto kept its tolerance in {record['auto_kept_tolerance']} of {record['auto_cases']} cases")


def _cell(point: Record) -> str:
    seconds = point["seconds_per_second"]
    shown = f"{1e6 * seconds:7.1f} us" if seconds < 1e-3 else f"{1e3 * seconds:7.1f} ms"
    return f"{shown} {point['ratio']:8.3g}x {point['error_K']:8.4f} K{'*' if point['pareto'] else ' '}"
