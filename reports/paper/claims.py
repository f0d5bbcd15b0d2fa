"""Every statement of the paper that can be computed, in its order, and the one that cannot."""

from __future__ import annotations

import tomllib
from collections.abc import Callable

import numpy as np

from thermograsp.assets import asset
from thermograsp.reports.paper import experiment, simulation, theory
from thermograsp.reports.paper.claim import Claim, Finding, Support, Verdict
from thermograsp.reports.paper.runs import PaperRuns

FINDINGS = {
    finding.__name__: finding for part in (theory, simulation, experiment) for finding in part.FINDINGS
}
"""Functions by the key of the statement that they compute."""


def paper_claims(runs: PaperRuns) -> list[Claim]:
    """The statements of assets/paper.toml, each with what was computed; those on the experiment on every rig too."""
    statements = tomllib.loads(asset("paper.toml").read_text(encoding="utf-8"))
    return [
        Claim(
            key,
            words["section"],
            words["statement"],
            FINDINGS[key](runs),
            support(FINDINGS[key], runs) if FINDINGS[key] in experiment.ON_RIGS else None,
        )
        for key, words in statements.items()
    ]


def support(finding: Callable[[PaperRuns], Finding], runs: PaperRuns) -> Support:
    """The finding on every rig of the bands."""
    verdicts: list[Verdict] = [finding(each).verdict for each in runs.on_rigs()]
    holds = np.array([verdict == "holds" for verdict in verdicts])
    counts: dict[Verdict, int] = {each: verdicts.count(each) for each in ("holds", "partly", "fails")}
    return Support(counts, runs.bands.deciding(holds))
