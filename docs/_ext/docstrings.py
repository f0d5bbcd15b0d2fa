"""Docstrings are Markdown here, as in the code: they pass through MyST and not as reStructuredText."""

from __future__ import annotations

from typing import Any

from docutils import nodes
from docutils.utils import new_document
from myst_parser.parsers.docutils_ import Parser
from sphinx.application import Sphinx
from sphinx.util.docutils import SphinxDirective


class Markdown(SphinxDirective):
    """Its content, parsed as Markdown without HTML, so that `<` in a formula stays what it is."""

    has_content = True

    def run(self) -> list[nodes.Node]:
        """The nodes of the content."""
        settings = self.state.document.settings.copy()
        settings.myst_disable_syntax = ["html_inline", "html_block"]
        document = new_document(self.get_location(), settings)
        Parser().parse("\n".join(self.content), document)
        return document.children


def _wrap(app: Sphinx, what: str, name: str, value: object, options: object, lines: list[str]) -> None:
    del app, what, name, value, options
    lines[:] = [".. markdown::", "", *("   " + line for line in lines), ""]


def setup(app: Sphinx) -> dict[str, Any]:
    """Called by Sphinx."""
    app.add_directive("markdown", Markdown)
    app.connect("autodoc-process-docstring", _wrap)
    return {"parallel_read_safe": True, "parallel_write_safe": True}
