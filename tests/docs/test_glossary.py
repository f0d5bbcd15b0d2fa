"""The names that docs/glossary.md gives beside its words are in the code."""

import re
from pathlib import Path

ROOT = Path(__file__).parents[2]
FOLDERS = ("core", "thermal", "envs", "agents")


def test_every_name_of_the_glossary_is_in_the_code() -> None:
    source = "\n".join(
        path.read_text(encoding="utf-8")
        for folder in FOLDERS
        for path in sorted((ROOT / folder).rglob("*.py"))
    )
    rows = re.findall(
        r"^\| (?!term|---)(.+?) \| .* \| (.*)\|$", (ROOT / "docs/glossary.md").read_text("utf-8"), re.M
    )
    assert len(rows) > 40
    for term, code in rows:
        for name in re.findall(r"`([^`]+)`", code):
            if "/" in name:
                assert (ROOT / name).is_dir(), f"{term}: there is no {name}"
                continue
            for word in re.findall(r"[A-Za-z_]+", re.sub(r'".*?"|\.\.\.|\(n, m\)', "", name)):
                assert re.search(rf"\b{word}\b", source), f"{term}: the code has no {word}"
