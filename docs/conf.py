"""How `make docs` builds the site: Sphinx over the Markdown of this folder, with warnings as errors.

Everything that a page needs is beside it: no fonts, scripts or pictures from elsewhere, and equations are MathML.
"""

import sys
from pathlib import Path

from pygments.lexers.special import TextLexer
from sphinx.application import Sphinx

import thermograsp

sys.path.insert(0, str(Path(__file__).parent / "_ext"))

project = "thermograsp"
author = "The thermograsp authors"
project_copyright = "The thermograsp authors, Apache 2.0"
release = version = thermograsp.__version__

extensions = ["myst_parser", "sphinx.ext.autodoc", "docstrings", "generated", "mathml"]
source_suffix = {".md": "markdown"}
exclude_patterns = ["_ext"]
highlight_language = "text"
smartquotes = False  # it would make one dash of the two of --json

myst_enable_extensions = ["dollarmath"]
myst_fence_as_directive = {"math"}
myst_heading_anchors = 3

autodoc_member_order = "bysource"
autodoc_typehints = "signature"
autodoc_preserve_defaults = True
python_use_unqualified_type_names = True
python_maximum_signature_line_length = 100
toc_object_entries_show_parents = "hide"

html_theme = "furo"
html_title = f"thermograsp {version}"
html_math_renderer = "mathml"
html_static_path = ["_static"]
html_css_files = ["site.css"]
html_copy_source = False
html_show_sourcelink = False


def setup(app: Sphinx) -> None:
    """Called by Sphinx. "golden" blocks are the protocol's example frames, which tests read."""
    app.add_lexer("golden", TextLexer)
