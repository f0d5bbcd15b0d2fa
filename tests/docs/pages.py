"""The pages of documentation, and what stands in them that can be run."""

import re
from pathlib import Path

ROOT = Path(__file__).parents[2]
PAGES = {
    str(path.relative_to(ROOT)): path.read_text(encoding="utf-8")
    for path in [ROOT / "README.md", *sorted((ROOT / "docs").rglob("*.md"))]
}


def blocks(page: str, kind: str) -> list[str]:
    """The code of its fenced blocks whose first line is ``` and `kind`."""
    return re.findall(rf"^```{re.escape(kind)}\n(.*?)^```$", PAGES[page], re.DOTALL | re.MULTILINE)


def kinds(page: str) -> set[str]:
    """What stands behind the ``` of its fenced blocks."""
    return set(re.findall(r"^```(.+)$", PAGES[page], re.MULTILINE))


def commands(page: str) -> list[str]:
    """What follows `thermograsp` in indented lines and in blocks of the shell."""
    lines = re.findall(r"^    thermograsp (.*)$", PAGES[page], re.MULTILINE)
    for block in blocks(page, "sh"):
        lines += re.findall(r"^thermograsp (.*)$", block, re.MULTILINE)
    return lines
