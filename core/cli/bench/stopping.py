"""`thermograsp bench stopping`: how soon an agent knows a material, and where it stops itself."""

from __future__ import annotations

from thermograsp.bench import Record
from thermograsp.cli.shared import Output

_TITLES = {
    "agent": "trained agent",
    "identify": "thermograsp identify, any contact",
    "fitted": "posterior fitted to these contacts",
}


def report(record: Record, output: Output) -> None:
    """Prints right answers by contact time, and where the agent stops beside fixed times."""
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
    declared = record["declared"]
    output.line(
        f"the agent declares after {declared['contact_s']:.3f} s of contact in the mean, and is right in "
        f"{100 * declared['right']:.1f} %; always at the same decision, after as long in the mean: "
        f"{100 * declared['fixed_right']:.1f} %"
    )
