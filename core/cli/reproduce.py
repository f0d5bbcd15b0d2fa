"""`thermograsp reproduce`: the figures of Wu et al. 2012 and each of its statements beside what is computed."""

from __future__ import annotations

import argparse
import textwrap
import time
from collections import Counter
from collections.abc import Iterator
from pathlib import Path
from typing import TYPE_CHECKING

from thermograsp.cli.output import Output
from thermograsp.errors import InvalidValueError
from thermograsp.files import write_text

if TYPE_CHECKING:
    from thermograsp.report.claim import Claim
    from thermograsp.report.paper_runs import Task

NAME = "reproduce"
HELP = "Recompute the heat flux sensor paper (Wu et al. 2012): its figures, and which of its statements hold."

_MARKS = {"holds": "holds  ", "partly": "partly ", "fails": "FAILS  ", "open": "open   "}


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """Arguments of the command."""
    parser.add_argument("--out", metavar="DIR", default="reproduction", help="folder for figures and claims")
    parser.add_argument(
        "--quick", action="store_true", help="coarser: 0.005 K instead of 0.002 K, half the grid"
    )


def run(args: argparse.Namespace) -> int:
    """Computes, draws and prints. A statement that fails is a result: the status is 0 all the same."""
    from thermograsp.report.paper import draw_paper
    from thermograsp.report.paper_claims import paper_claims
    from thermograsp.report.paper_runs import FULL, MATERIALS, QUICK, run_paper

    begun, output, folder = time.perf_counter(), Output(args.json), _folder(args.out)
    effort = QUICK if args.quick else FULL
    with output.progress(7) as advance:

        def shown(tasks: list[Task]) -> Iterator[Task]:
            for task in tasks:
                advance(task[0], 0)
                yield task
                advance(task[0], 1)

        runs = run_paper(effort, shown)
        advance("figures", 0)
        figures = draw_paper(folder, runs, MATERIALS)
        advance("figures", 1)
    claims = paper_claims(runs)
    lines = [line for claim in claims for line in _lines(claim)]
    counts = Counter(claim.verdict for claim in claims)
    total = ", ".join(f"{counts[verdict]} {verdict}" for verdict in _MARKS)
    report = folder / "claims.txt"
    write_text(report, "\n".join([*lines, f"{len(claims)} statements: {total}", ""]))
    for line in lines:
        output.line(line)
    output.line(f"{len(claims)} statements: {total}")
    for file in [*figures, report]:
        output.line(f"wrote {file}")
    output.document(
        {
            "claims": [_fields(claim) for claim in claims],
            "verdicts": {verdict: counts[verdict] for verdict in _MARKS},
            "figures": [str(file) for file in figures],
            "report": str(report),
            "tolerance_K": effort.tolerance,
            "seconds": time.perf_counter() - begun,
        }
    )
    return 0


def _folder(path: str) -> Path:
    folder = Path(path)
    if folder.exists() and not folder.is_dir():
        raise InvalidValueError(f"cannot write into {path}: it is not a folder; name another with --out")
    folder.mkdir(parents=True, exist_ok=True)
    return folder


def _lines(claim: Claim) -> list[str]:
    """Two paragraphs: what the paper says, and what comes out."""
    indent = " " * 9
    said = textwrap.fill(
        f"{claim.statement} (section {claim.section})",
        110,
        initial_indent=f"{_MARKS[claim.verdict]}  ",
        subsequent_indent=indent,
    )
    found = textwrap.fill(
        claim.computed, 110, initial_indent=indent + "-> ", subsequent_indent=indent + "   "
    )
    return [said, found, ""]


def _fields(claim: Claim) -> dict[str, object]:
    return {
        "key": claim.key,
        "section": claim.section,
        "statement": claim.statement,
        "computed": claim.computed,
        "verdict": claim.verdict,
        "numbers": claim.numbers,
    }
