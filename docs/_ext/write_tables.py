"""Writes the tables that are made of the code into the pages that hold them: `make reference`."""

from __future__ import annotations

from pathlib import Path

from generated import BLOCK, with_tables

from thermograsp.files import atomic_write

DOCS = Path(__file__).parents[1]


def write_tables() -> None:
    """Pages whose tables are those of the code stay as they are."""
    for path in sorted(DOCS.rglob("*.md")):
        page = path.read_text(encoding="utf-8")
        if BLOCK.search(page) and (new := with_tables(page)) != page:
            with atomic_write(path) as file:
                file.write_text(new, encoding="utf-8")
            print(f"wrote {path.relative_to(DOCS.parent)}")


if __name__ == "__main__":
    write_tables()
