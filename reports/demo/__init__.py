"""The demonstration: ten materials grasped in both modes, as one page."""

from typing import TYPE_CHECKING

from thermograsp.doors import opened

if TYPE_CHECKING:
    from thermograsp.reports.demo.page import demo_page
    from thermograsp.reports.demo.runs import ModeRun, run_mode
    from thermograsp.reports.demo.tables import Settings, versions

__all__ = [
    "ModeRun",
    "Settings",
    "demo_page",
    "run_mode",
    "versions",
]

__getattr__ = opened(__name__)
