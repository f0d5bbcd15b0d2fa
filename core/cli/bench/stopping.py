"""`thermograsp bench stopping`: how soon an agent knows a material, and what deciding when to stop is worth."""

from __future__ import annotations

from thermograsp.bench import Record
from thermograsp.cli.shared import Output

_TITLES = {
    "agent": "trained agent",
    "identify": "thermograsp identify, any contact",
    "fitted": "posterior fitted to these contacts",
}


def report(record: Record, output: Output) -> None:
    """Prints right answers by contact time, and rules beside fixed times."""
    output.line(
        f"right, % of {record['episodes']} held-out episodes of Identify-v0, by contact time; all from the same samples"
    )
    output.table(
        ("", *(f"{window:g} s" for window in record["windows_s"])),
        [
            ("mean contact", *(f"{mean:.3f} s" for mean in record["contact_s"])),
            *(
                (_TITLES[name], *(f"{100 * share:.1f}" for share in shares))
                for name, shares in record["right"].items()
            ),
        ],
    )
    output.line()
    output.line(
        "the agent stops when its largest share reaches a limit, beside a fixed time of the same mean"
    )
    output.table(
        ("limit", "mean contact", "right", "fixed time"),
        [
            (
                f"{rule['share']:g}",
                f"{rule['contact_s']:.3f} s",
                f"{100 * rule['right']:.1f} %",
                f"{100 * rule['fixed_right']:.1f} %",
            )
            for rule in record["rules"]
        ],
    )
