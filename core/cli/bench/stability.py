"""`thermograsp bench stability`: where each time step of a contact is stable, rings, is wrong or blows up."""

from __future__ import annotations

from thermograsp.bench import Record
from thermograsp.cli.shared import Output


def report(record: Record, output: Output) -> None:
    """Prints a row a scheme."""
    output.line(f"share of the map, and how far the range was left at most ({record['steps']} steps)")
    output.table(
        ("scheme", "stable", "rings", "leaves range", "blows up", "outside"),
        [
            (
                each["title"],
                *(f"{100 * each['shares'][kind]:.1f} %" for kind in record["kinds"]),
                "inf" if each["outside"] is None else f"{each['outside']:.2g}",
            )
            for each in record["maps"]
        ],
    )
