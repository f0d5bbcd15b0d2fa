"""`thermograsp bench episode`: what simulated time costs, against the error of the voltage that the agent sees."""

from __future__ import annotations

from thermograsp.bench import Record
from thermograsp.cli.shared import Output


def report(record: Record, output: Output) -> None:
    """Prints a table of the settings, slowest first."""
    output.line("speed as a multiple of the shipped setting's, and the error of the voltage; * = front")
    output.table(
        ("time step", "frame skip", "control step", "tolerance", "speed", "error", "of the signal", ""),
        [
            (
                f"{1e3 * p['timestep']:g} ms",
                str(p["substeps"]),
                f"{1e3 * p['control_step_s']:g} ms",
                f"{p['tolerance']:g} K",
                f"{p['speed']:.2f}",
                f"{1e6 * p['error_V']:.1f} uV",
                f"{100 * p['relative']:.2f} %",
                "*" * p["pareto"] + " shipped" * p["shipped"] + " LOST" * bool(p["lost"]),
            )
            for p in sorted(record["points"], key=lambda p: p["speed"])
        ],
    )
