"""The tables that stand in pages' files are those of the code."""

import pytest

from .pages import PAGES

pytest.importorskip("sphinx", reason="needs the site's tools: make docs")

from generated import BLOCK, with_tables

GENERATED = [page for page, text in PAGES.items() if BLOCK.search(text)]


def test_every_mark_has_its_end() -> None:
    for page, text in PAGES.items():
        assert text.count("<!-- generated: ") == 2 * len(BLOCK.findall(text)), page


@pytest.mark.parametrize("page", GENERATED)
def test_the_tables_are_those_of_the_code(page: str) -> None:
    assert PAGES[page] == with_tables(PAGES[page]), "make reference writes them again"
