"""docs/comparison.md repeats what was measured and adds nothing: its numbers stand on the pages that say how."""

import re

from .pages import PAGES

NUMBER = re.compile(r"(?<![\w.])[-+]?\d[\d,]*(?:\.\d+)?(?![\w.]*\.md)")
SOURCES = ("docs/benchmarks.md", "docs/identification.md")


def numbers(text: str) -> set[str]:
    return {number.strip(",+").replace(",", "") for number in NUMBER.findall(text)}


def test_every_number_is_measured_elsewhere() -> None:
    known = set[str]().union(*(numbers(PAGES[page]) for page in SOURCES))
    assert numbers(PAGES["docs/comparison.md"]) <= known
