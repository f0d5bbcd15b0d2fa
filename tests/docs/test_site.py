"""The built site is whole by itself. Part of `make docs`, which builds it first."""

import importlib
import os
import re
from functools import cache
from html.parser import HTMLParser
from pathlib import Path
from urllib.parse import unquote, urlsplit

import pytest

from thermograsp.cli import COMMANDS

from .pages import ROOT

SITE = Path(os.environ.get("THERMOGRASP_SITE", ""))
if not os.environ.get("THERMOGRASP_SITE"):
    pytest.skip("needs the built site: make docs", allow_module_level=True)

FILES = sorted(path.relative_to(SITE) for path in SITE.rglob("*.html") if "_static" not in path.parts)
PACKAGES = ("thermal", "envs", "hardware", "dataset")


class Page(HTMLParser):
    """Anchors of a page, what it links to, and what a browser loads with it."""

    def __init__(self, text: str) -> None:
        super().__init__()
        self.anchors: set[str] = set()
        self.links: list[str] = []
        self.loaded: list[str] = []
        self.equations = 0
        self.feed(text)

    def handle_starttag(self, tag: str, attrs: list[tuple[str, str | None]]) -> None:
        given = {name: value or "" for name, value in attrs}
        self.anchors |= {given[name] for name in ("id", "name") if name in given}
        self.equations += tag == "math"
        if tag == "a" and "href" in given:
            self.links.append(given["href"])
        elif tag in ("img", "script", "iframe", "source") and "src" in given:
            self.loaded.append(given["src"])
        elif tag == "link" and "href" in given and given.get("rel") not in ("canonical",):
            self.loaded.append(given["href"])


@cache
def page(path: Path) -> Page:
    return Page((SITE / path).read_text(encoding="utf-8"))


def missing(path: Path, reference: str) -> bool:
    """Whether a relative reference of the page leads to nothing."""
    parts = urlsplit(reference)
    target = (SITE / path).parent / unquote(parts.path) if parts.path else SITE / path
    if not target.exists():
        return True
    if not parts.fragment or target.suffix != ".html":
        return False
    return parts.fragment not in page(target.resolve().relative_to(SITE.resolve())).anchors


def test_every_page_is_built() -> None:
    sources = {path.relative_to(ROOT / "docs").with_suffix(".html") for path in (ROOT / "docs").rglob("*.md")}
    assert sources <= set(FILES)


@pytest.mark.parametrize("path", FILES, ids=map(str, FILES))
def test_a_page_loads_nothing_from_elsewhere(path: Path) -> None:
    assert [reference for reference in page(path).loaded if urlsplit(reference).netloc] == []
    assert [reference for reference in page(path).loaded if missing(path, reference)] == []


@pytest.mark.parametrize("path", FILES, ids=map(str, FILES))
def test_every_link_within_leads_somewhere(path: Path) -> None:
    within = [link for link in page(path).links if not urlsplit(link).scheme and not urlsplit(link).netloc]
    assert [link for link in within if missing(path, link)] == []


def test_styles_load_nothing_from_elsewhere() -> None:
    for path in SITE.rglob("*.css"):
        text = path.read_text(encoding="utf-8")
        assert not re.findall(r"(?:url\(|@import)\s*[\"']?(?:https?:)?//", text), path


@pytest.mark.parametrize("package", PACKAGES)
def test_the_reference_has_every_public_name(package: str) -> None:
    names = importlib.import_module(f"thermograsp.{package}").__all__
    anchors = page(Path("api") / f"{package}.html").anchors
    assert [name for name in names if f"thermograsp.{package}.{name}" not in anchors] == []


def test_generated_parts_are_there() -> None:
    assert not any("<!-- generated" in (SITE / path).read_text(encoding="utf-8") for path in FILES)
    assert "thermograsp-grasp-v0" in page(Path("environments.html")).anchors
    commands = page(Path("commands.html")).anchors
    assert all(any(anchor.startswith(f"thermograsp-{name}") for anchor in commands) for name in COMMANDS)


def test_equations_are_drawn_by_the_browser_alone() -> None:
    assert page(Path("physics.html")).equations > 10
    assert not any("mathjax" in name.lower() for path in FILES for name in page(path).loaded)
