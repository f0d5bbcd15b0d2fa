"""What is made of the code: tables between `<!-- generated: NAME -->` and `<!-- generated: end -->`, which stand in the
pages' files so that a forge shows them too, and the titles of pages in place of their files' names.

`make reference` writes the tables again; a test fails while they are not those of the code."""

from __future__ import annotations

import re
from collections.abc import Callable
from typing import Any

from command_reference import command_reference
from conductance_table import conductance_table
from environment_tables import environment_tables
from public_names import name_tables, public_names
from sphinx.application import Sphinx

BLOCK = re.compile(
    r"^<!-- generated: (?P<name>\w+)(?: (?P<of>[\w.]+))? -->\n(?P<tables>.*?)^<!-- generated: end -->$",
    re.MULTILINE | re.DOTALL,
)
FILE = re.compile(r"\[[\w/-]+\.md\](?=\([\w/-]+\.md(?:#[\w-]+)?\))")

GENERATORS: dict[str, Callable[..., str]] = {
    "commands": command_reference,
    "conductances": conductance_table,
    "environments": environment_tables,
    "names": name_tables,
}


def with_tables(page: str) -> str:
    """The page's text with the tables that the code gives today."""
    return BLOCK.sub(
        lambda block: "\n".join(
            (
                block[0].split("\n", 1)[0],
                "",
                GENERATORS[block["name"]](*filter(None, [block["of"]])).strip("\n"),
                "",
                "<!-- generated: end -->",
            )
        ),
        page,
    )


def _on_the_site(block: re.Match[str]) -> str:
    """Names with their whole docstrings, and other tables as they stand."""
    return public_names(block["of"]) if block["name"] == "names" else block["tables"]


def _fill(app: Sphinx, page: str, source: list[str]) -> None:
    del app, page
    source[0] = FILE.sub("[]", BLOCK.sub(_on_the_site, source[0]))


def setup(app: Sphinx) -> dict[str, Any]:
    """Called by Sphinx."""
    app.connect("source-read", _fill)
    return {"parallel_read_safe": True, "parallel_write_safe": True}
