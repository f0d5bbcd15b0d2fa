"""What the paper states, what was computed for it, and the verdict."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Literal

Verdict = Literal["holds", "partly", "fails", "open"]


@dataclass(frozen=True, slots=True)
class Finding:
    """What a computation says of a statement. computed: what was computed, in words with numbers. verdict: "holds",
    "partly" (the text says which part), "fails", or "open" where nothing that could decide it is published. numbers:
    the same numbers for machines, units in their names."""

    computed: str
    verdict: Verdict
    numbers: Mapping[str, float | list[float]] = field(default_factory=dict)


@dataclass(frozen=True, slots=True)
class Support:
    """What becomes of a statement on the experiment on every drawn rig. counts: rigs by verdict. deciding: the unknown
    by which rigs where it holds differ most from the others, with its median there and on the others; None where no
    unknown parts them."""

    counts: Mapping[Verdict, int]
    deciding: tuple[str, float, float] | None


@dataclass(frozen=True, slots=True)
class Claim:
    """A statement of the paper. key: short name. section: where the paper says so. statement: what it says, in our
    words. support: within the bands that the experiment's unknowns leave; None of a statement that is not on the
    experiment."""

    key: str
    section: str
    statement: str
    finding: Finding
    support: Support | None = None


def graded(holds: bool, partly: bool = False) -> Verdict:
    """The verdict on a statement that holds, or that holds in part."""
    return "holds" if holds else "partly" if partly else "fails"
