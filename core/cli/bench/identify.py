"""`thermograsp bench identify`: how often materials are told apart, the Bayes limit, and what learns from examples."""

from __future__ import annotations

from thermograsp.bench import Record
from thermograsp.cli.shared import Output

_TITLES = {
    "limit": "Bayes limit",
    "identify": "thermograsp identify",
    "svm": "SVM + PCA",
    "net": "recurrent net",
}


def report(record: Record, output: Output) -> None:
    """Prints shares of right answers, computing times and what intervals hold."""
    for reason in record["left_out"]:
        output.warn(f"{reason}; its curve is left out")
    windows, eleven = record["windows_s"], record["eleven"]
    output.line(
        f"right, % of {record['touches']} touches of {len(record['materials'])} materials, by contact time"
    )
    _shares(output, windows, record["right"])
    output.table(
        ("", *(f"{window:g} s" for window in windows)),
        [
            ("same as the limit", *(f"{100 * share:.1f}" for share in record["agreement_with_limit"])),
            ("a posterior, median", *(f"{1e3 * seconds:.1f} ms" for seconds in record["cpu_median_s"])),
            ("99 % are faster than", *(f"{1e3 * seconds:.1f} ms" for seconds in record["cpu_99_s"])),
        ],
    )
    output.line()
    for contact, right in eleven["right"].items():
        output.line(
            f"right, % of {eleven['touches']} touches of {len(eleven['materials'])} materials, contact {contact}"
        )
        _shares(output, eleven["windows_s"], right)
    published = ", ".join(
        f"{100 * share:.0f} % at {window} s" for window, share in record["published"].items()
    )
    output.line(f"published for eleven (another sensor, SVM + PCA, RSS 2015): {published}")
    output.line()
    output.line(
        "fresh objects of any effusivity: inside their 90 % interval, and its upper end over its lower"
    )
    output.table(
        ("contact", "held", "10 %", "median", "90 %"),
        [
            (
                f"{each['window']:g} s",
                f"{100 * each['held']:.1f} %",
                *(f"{ratio:.2f}" for ratio in each["ratio"]),
            )
            for each in record["coverage"]
        ],
    )


def _shares(output: Output, windows: list[float], right: dict[str, list[float]]) -> None:
    output.table(
        ("", *(f"{window:g} s" for window in windows)),
        [(_TITLES[name], *(f"{100 * share:.1f}" for share in shares)) for name, shares in right.items()],
    )
    output.line()
