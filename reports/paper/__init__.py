"""The figures and statements of Wu et al. 2012, each computed."""

from typing import TYPE_CHECKING

from thermograsp.doors import opened

if TYPE_CHECKING:
    from thermograsp.reports.paper.claim import Claim, Support
    from thermograsp.reports.paper.claims import paper_claims
    from thermograsp.reports.paper.figures import draw_paper
    from thermograsp.reports.paper.runs import Task, run_paper
    from thermograsp.reports.paper.sweeps import FULL, MATERIALS, QUICK

__all__ = [
    "FULL",
    "MATERIALS",
    "QUICK",
    "Claim",
    "Support",
    "Task",
    "draw_paper",
    "paper_claims",
    "run_paper",
]

__getattr__ = opened(__name__)
