"""Fills in what a page says with a comment `<!-- generated: NAME -->`, from the code that the site is built of."""

from __future__ import annotations

import re
from collections.abc import Callable
from typing import Any

from command_reference import command_reference
from environment_tables import environment_tables
from public_names import public_names
from sphinx.application import Sphinx

MARK = re.compile(r"^<!-- generated: (\w+)(?: ([\w.]+))? -->$", re.MULTILINE)

GENERATORS: dict[str, Callable[..., str]] = {
    "commands": command_reference,
    "environments": environment_tables,
    "names": public_names,
}


def _fill(app: Sphinx, page: str, source: list[str]) -> None:
    del app, page
    source[0] = MARK.sub(lambda mark: GENERATORS[mark[1]](*filter(None, [mark[2]])), source[0])


def setup(app: Sphinx) -> dict[str, Any]:
    """Called by Sphinx."""
    app.connect("source-read", _fill)
    return {"parallel_read_safe": True, "parallel_write_safe": True}
