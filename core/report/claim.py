"""A statement of a paper beside what was computed for it."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Literal

Verdict = Literal["holds", "partly", "fails", "open"]


@dataclass(frozen=True, slots=True)
class Claim:
    """key: short name. section: where the paper says so. statement: what it says, in our words. computed: what was
    computed, in words with numbers. verdict: "holds", "partly" (the text says which part), "fails", or "open" where
    nothing that could decide it is published. numbers: the same numbers for machines, units in their names."""

    key: str
    section: str
    statement: str
    computed: str
    verdict: Verdict
    numbers: Mapping[str, float | list[float]] = field(default_factory=dict)


def graded(holds: bool, partly: bool = False) -> Verdict:
    """The verdict on a statement that holds, or that holds in part."""
    return "holds" if holds else "partly" if partly else "fails"
