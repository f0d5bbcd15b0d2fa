"""docs/comparison.md repeats what was measured and adds nothing: its numbers stand on the pages that say how."""

import re

import pytest

from .pages import PAGES

NUMBER = re.compile(r"(?<![\w.])[-+]?\d[\d,]*(?:\.\d+)?")
SOURCES = ("docs/benchmarks.md", "docs/identification.md")
ROWS = re.findall(r"^\| .*\d.* \|$", PAGES["docs/comparison.md"], re.MULTILINE)


def numbers(text: str) -> set[str]:
    return {number.strip(",+").replace(",", "") for number in NUMBER.findall(text)}


def measured() -> list[set[str]]:
    """Numbers of each row of a table and of each item of a list on the pages that say how they were measured."""
    parts: list[str] = []
    for page in SOURCES:
        parts += re.findall(r"^\| .* \|$", PAGES[page], re.MULTILINE)
        parts += re.findall(r"^- .*(?:\n  .*)*", PAGES[page], re.MULTILINE)
    return [numbers(part) for part in parts]


def test_every_number_is_measured_elsewhere() -> None:
    known = set[str]().union(*(numbers(PAGES[page]) for page in SOURCES))
    assert numbers(PAGES["docs/comparison.md"]) <= known


@pytest.mark.parametrize("row", ROWS, ids=range(len(ROWS)))
def test_a_row_repeats_one_measurement(row: str) -> None:
    assert any(numbers(row) <= known for known in measured())
