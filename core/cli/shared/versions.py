"""`thermograsp --version`: the version, and with --json those of everything it runs on."""

from __future__ import annotations

import argparse
import platform
import re
from collections.abc import Iterator
from importlib import metadata
from typing import Any

import thermograsp
from thermograsp.cli.shared.output import Output

_NEED = re.compile(r"([\w.-]+)(\[.*?\])?.*?(?:; extra == [\"']([\w-]+)[\"'])?$")
DEVELOPMENT = {"test", "grippers", "docs", "release", "dev"}
"""Extras for work on the package itself."""


class ShowVersion(argparse.Action):
    """Prints and exits. as_json: one document instead of a line."""

    def __init__(self, option_strings: list[str], dest: str, as_json: bool, help: str) -> None:
        super().__init__(option_strings, dest, nargs=0, default=argparse.SUPPRESS, help=help)
        self.as_json = as_json

    def __call__(self, parser: argparse.ArgumentParser, *given: object) -> None:
        output = Output(self.as_json)
        output.line(f"thermograsp {thermograsp.__version__}")
        if self.as_json:
            output.document(versions())
        parser.exit()


def versions() -> dict[str, Any]:
    """thermograsp, python, platform; packages: those it always needs; extras: name -> those that the extra brings. None
    where a package is not installed."""
    packages: dict[str, str | None] = {}
    extras: dict[str, dict[str, str | None]] = {}
    for name, extra in _needs():
        if extra not in DEVELOPMENT:
            (extras.setdefault(extra, {}) if extra else packages)[name] = _installed(name)
    return {
        "thermograsp": thermograsp.__version__,
        "python": platform.python_version(),
        "platform": platform.platform(),
        "packages": packages,
        "extras": extras,
    }


def _needs() -> Iterator[tuple[str, str]]:
    """(package, extra that brings it or "") as the installed metadata has them; an extra in an extra is left out."""
    try:
        lines = metadata.requires("thermograsp") or []
    except metadata.PackageNotFoundError:  # run from a folder, not installed
        lines = []
    for line in lines:
        need = _NEED.match(line)
        assert need is not None
        if need[1] != "thermograsp":
            yield need[1], need[3] or ""


def _installed(name: str) -> str | None:
    try:
        return metadata.version(name)
    except metadata.PackageNotFoundError:
        return None
