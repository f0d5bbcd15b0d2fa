"""Every statement of the paper that can be computed, in its order, and the one that cannot."""

from __future__ import annotations

from thermograsp.report.claim import Claim
from thermograsp.report.paper_experiment import experiment_claims
from thermograsp.report.paper_runs import PaperRuns
from thermograsp.report.paper_simulation import simulation_claims
from thermograsp.report.paper_theory import theory_claims


def paper_claims(runs: PaperRuns) -> list[Claim]:
    """All claims; a new one is added in the module of its section."""
    return [*theory_claims(runs), *simulation_claims(runs), *experiment_claims(runs)]
