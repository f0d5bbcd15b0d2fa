"""What a page has on the site and not in its file: tables where it says `<!-- generated: NAME -->`, made from the code
that the site is built of, and the titles of pages in place of their files' names."""

from __future__ import annotations

import re
from collections.abc import Callable
from typing import Any

from command_reference import command_reference
from environment_tables import environment_tables
from public_names import public_names
from sphinx.application import Sphinx

MARK = re.compile(r"^<!-- generated: (\w+)(?: ([\w.]+))? -->$", re.MULTILINE)
FILE = re.compile(r"\[[\w/-]+\.md\](?=\([\w/-]+\.md(?:#[\w-]+)?\))")

GENERATORS: dict[str, Callable[..., str]] = {
    "commands": command_reference,
    "environments": environment_tables,
    "names": public_names,
}


def _fill(app: Sphinx, page: str, source: list[str]) -> None:
    del app, page
    filled = MARK.sub(lambda mark: GENERATORS[mark[1]](*filter(None, [mark[2]])), source[0])
    source[0] = FILE.sub("[]", filled)


def setup(app: Sphinx) -> dict[str, Any]:
    """Called by Sphinx."""
    app.connect("source-read", _fill)
    return {"parallel_read_safe": True, "parallel_write_safe": True}
