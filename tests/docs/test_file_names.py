"""Files of source that the pages name exist, and each name leads to one file."""

import re

import pytest

from .pages import PAGES, ROOT

FOLDERS = (
    "agents",
    "benchmarks",
    "core",
    "dataset",
    "docs",
    "envs",
    "examples",
    "figures",
    "hardware",
    "reports",
)
FOLDERS += ("studies", "studio", "tests", "thermal", "touch", "twin")
SOURCES = [path.relative_to(ROOT).as_posix() for folder in FOLDERS for path in (ROOT / folder).rglob("*.py")]


@pytest.mark.parametrize("page", PAGES)
def test_a_file_that_a_page_names_is_there_once(page: str) -> None:
    named = set(re.findall(r"`([a-z_0-9/]+\.py)`", PAGES[page]))
    found = {name: [path for path in SOURCES if f"/{path}".endswith(f"/{name}")] for name in named}
    assert {name: paths for name, paths in found.items() if len(paths) != 1} == {}
