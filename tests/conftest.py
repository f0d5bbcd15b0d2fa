"""Every run of the tests builds its own thermal networks: none are read that an older version left on this machine."""

from __future__ import annotations

import os
from collections.abc import Iterator
from pathlib import Path

import pytest

TIERS = {
    "bench": ("THERMOGRASP_BENCH", "runs all benchmarks for minutes: make test-bench"),
    "benchmarks": ("THERMOGRASP_BENCH", "compares with elements in 3-D for minutes: make test-bench"),
    "thermal/test_mesh_fem.py": (
        "THERMOGRASP_BENCH",
        "compares with elements in 3-D for minutes: make test-bench",
    ),
    "cli/test_demo.py": ("THERMOGRASP_BENCH", "runs the whole demo: make test-bench"),
    "cli/test_reproduce.py": ("THERMOGRASP_BENCH", "redraws the paper's figures: make test-bench"),
    "docs/test_code.py": ("THERMOGRASP_SITE", "runs the code of every page: make docs"),
    "release": ("THERMOGRASP_RELEASE", "builds and installs for minutes: make test-release"),
}
"""Tests that run only where a variable of the environment asks for them, which their targets in the Makefile set."""


def pytest_collection_modifyitems(items: list[pytest.Item]) -> None:
    here = Path(__file__).parent
    for place, (variable, reason) in TIERS.items():
        for item in items:
            if not os.environ.get(variable) and item.path.is_relative_to(here / place):
                item.add_marker(pytest.mark.skip(reason=reason))


@pytest.fixture(scope="session", autouse=True)
def own_cache(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Path]:
    folder = tmp_path_factory.mktemp("cache")
    before = os.environ.get("THERMOGRASP_CACHE")
    os.environ["THERMOGRASP_CACHE"] = str(folder)
    yield folder
    if before is None:
        del os.environ["THERMOGRASP_CACHE"]
    else:
        os.environ["THERMOGRASP_CACHE"] = before
