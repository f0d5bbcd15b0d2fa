"""The page's files, read once: what the server can hand out is this table and nothing else."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path

_TYPES = {
    ".html": "text/html; charset=utf-8",
    ".css": "text/css; charset=utf-8",
    ".js": "text/javascript; charset=utf-8",
    ".svg": "image/svg+xml",
}
FIRST = "index.html"

HEADERS: Mapping[str, str] = {
    "Content-Security-Policy": "default-src 'none'; script-src 'self'; style-src 'self'; img-src 'self' data:; "
    "connect-src 'self'; base-uri 'none'; form-action 'none'; frame-ancestors 'none'",
    "X-Content-Type-Options": "nosniff",
    "Referrer-Policy": "no-referrer",
    "Cache-Control": "no-store",
}
"""With every file: the page runs its own scripts only, and is in nobody's frame."""


def page_files() -> dict[str, tuple[str, bytes]]:
    """Type and content by path; "" is the page itself."""
    folder = Path(__file__).with_name("page")
    files = {
        path.name: (_TYPES[path.suffix], path.read_bytes())
        for path in sorted(folder.iterdir())
        if path.suffix in _TYPES
    }
    return {"": files[FIRST], **files}
