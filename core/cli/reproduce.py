"""`thermograsp reproduce`: the figures of Wu et al. 2012 and each of its statements beside what is computed."""

from __future__ import annotations

import argparse
import textwrap
import time
from collections import Counter
from collections.abc import Iterator
from dataclasses import asdict
from typing import TYPE_CHECKING, Literal

from thermograsp.cli.shared import Output
from thermograsp.files import made_folder, write_text

if TYPE_CHECKING:
    from thermograsp.reports.paper import Claim, Support, Task

NAME = "reproduce"
HELP = "Recompute the figures of the heat flux sensor paper (Wu et al. 2012), and report which of its statements hold."

_MARKS = {"holds": "holds  ", "partly": "partly ", "fails": "FAILS  ", "open": "open   "}
_ON_RIGS: dict[Literal["holds", "partly", "fails"], str] = {
    "holds": "holds on",
    "partly": "holds in part on",
    "fails": "fails on",
}


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """Arguments of the command."""
    parser.add_argument(
        "--out", metavar="DIR", default="reproduction", help="folder for the figures and claims"
    )
    parser.add_argument(
        "--quick", action="store_true", help="coarser computation: 0.005 K instead of 0.002 K, half the grid"
    )


def run(args: argparse.Namespace) -> int:
    """Computes, draws and prints. A statement that fails is a result: the status is 0 all the same."""
    from thermograsp.reports.paper import (
        FULL,
        MATERIALS,
        QUICK,
        draw_paper,
        paper_claims,
        run_paper,
    )

    begun, output, folder = time.perf_counter(), Output(args.json), made_folder(args.out)
    effort = QUICK if args.quick else FULL
    with output.progress(9) as advance:

        def shown(tasks: list[Task]) -> Iterator[Task]:
            for task in tasks:
                advance(task[0], 0)
                yield task
                advance(task[0], 1)

        runs = run_paper(effort, shown)
        advance("figures", 0)
        claims = paper_claims(runs)
        figures = draw_paper(folder, runs, claims, MATERIALS)
        advance("figures", 1)
    lines = [line for claim in claims for line in _lines(claim)]
    counts = Counter(claim.finding.verdict for claim in claims)
    total = ", ".join(f"{counts[verdict]} {verdict}" for verdict in _MARKS)
    report = folder / "claims.txt"
    lines += [f"{len(claims)} statements: {total}", "", *runs.bands.lines()]
    write_text(report, "\n".join([*lines, ""]))
    for line in lines:
        output.line(line)
    for file in [*figures, report]:
        output.line(f"wrote {file}")
    output.document(
        {
            "claims": [_fields(claim) for claim in claims],
            "verdicts": {verdict: counts[verdict] for verdict in _MARKS},
            "bands": runs.bands.document(),
            "figures": [str(file) for file in figures],
            "report": str(report),
            "tolerance_K": effort.tolerance,
            "seconds": time.perf_counter() - begun,
        }
    )
    return 0


def _lines(claim: Claim) -> list[str]:
    """What the paper says, what comes out, and for a statement on the experiment on how many rigs it does."""
    indent = " " * 9
    statement = textwrap.fill(
        f"{claim.statement} (section {claim.section})",
        110,
        initial_indent=f"{_MARKS[claim.finding.verdict]}  ",
        subsequent_indent=indent,
    )
    found = textwrap.fill(
        claim.finding.computed, 110, initial_indent=indent + "-> ", subsequent_indent=indent + "   "
    )
    if claim.support is None:
        return [statement, found, ""]
    on_rigs = textwrap.fill(
        _supported(claim.support), 110, initial_indent=indent + "   ", subsequent_indent=indent + "   "
    )
    return [statement, found, on_rigs, ""]


def _supported(support: Support) -> str:
    counts = support.counts
    counted = ", ".join(
        f"{words} {counts[verdict]}" for verdict, words in _ON_RIGS.items() if counts[verdict]
    )
    text = f"Of the {sum(counts.values())} rigs drawn the statement {counted}."
    if support.deciding is not None:
        name, where_it_holds, elsewhere = support.deciding
        text += f" Mostly {name} decides: its median is {where_it_holds:.2g} where it holds, {elsewhere:.2g} elsewhere."
    return text


def _fields(claim: Claim) -> dict[str, object]:
    return {
        "key": claim.key,
        "section": claim.section,
        "statement": claim.statement,
        "computed": claim.finding.computed,
        "verdict": claim.finding.verdict,
        "numbers": claim.finding.numbers,
        "support": None if claim.support is None else asdict(claim.support),
    }
