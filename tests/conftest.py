"""What a run of the tests shares, in however many processes it goes, and which tests run only where they are asked for.

Every run builds its own thermal networks, once for all of its processes: none are read that an older version left on
this machine. Compiled code lies beside its source and serves the next run too (see thermograsp.compiled).
"""

from __future__ import annotations

import gc
import os
import tempfile
from collections.abc import Generator, Iterable
from functools import cache
from pathlib import Path
from typing import Any

import pytest

os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")
"""Processes of a run that each bring BLAS threads for all cores wait for one another most of the time."""

TIERS = {
    "bench": ("THERMOGRASP_BENCH", "runs all benchmarks for minutes: make test-bench"),
    "studies": ("THERMOGRASP_BENCH", "compares with elements in 3-D for minutes: make test-bench"),
    "thermal/meshes/test_mesh_fem.py": (
        "THERMOGRASP_BENCH",
        "compares with elements in 3-D for minutes: make test-bench",
    ),
    "cli/test_demo.py": ("THERMOGRASP_BENCH", "runs the whole demo: make test-bench"),
    "cli/test_reproduce.py": ("THERMOGRASP_BENCH", "redraws the paper's figures: make test-bench"),
    "docs/test_code.py": ("THERMOGRASP_SITE", "runs the code of every page: make docs"),
    "release": ("THERMOGRASP_RELEASE", "builds and installs for minutes: make test-release"),
}
"""Tests that run only where a variable of the environment asks for them, which their targets in the Makefile set."""


SLOW = "THERMOGRASP_SLOW"
"""The variable that asks for tests marked slow."""


def pytest_configure(config: pytest.Config) -> None:
    """A cache for the run, made before the workers start: they inherit the variable."""
    if not hasattr(config, "workerinput"):
        # a process that a test has just ended may still write to it
        cache = tempfile.TemporaryDirectory(prefix="thermograsp-tests-", ignore_cleanup_errors=True)
        config.add_cleanup(cache.cleanup)
        patch = pytest.MonkeyPatch()
        patch.setenv("THERMOGRASP_CACHE", cache.name)
        config.add_cleanup(patch.undo)


@pytest.hookimpl(wrapper=True)
def pytest_collection() -> Generator[None, object, object]:
    """What is imported and collected stays until the end: in vain would Python look for cycles in all of it."""
    gc.disable()
    try:
        return (yield)
    finally:
        gc.freeze()
        gc.enable()


class NotAskedFor(pytest.Module):
    """A file of a tier that nobody asks for: one skip, for which nothing is imported."""

    def collect(self) -> Iterable[pytest.Item | pytest.Collector]:
        pytest.skip(_not_asked_for(self.path), allow_module_level=True)


def pytest_pycollect_makemodule(module_path: Path, parent: pytest.Collector) -> pytest.Module | None:
    return NotAskedFor.from_parent(parent, path=module_path) if _not_asked_for(module_path) else None


def pytest_collection_modifyitems(items: list[pytest.Item]) -> None:
    for item in items:
        if item.get_closest_marker("slow") and not os.environ.get(SLOW):
            item.add_marker(pytest.mark.skip(reason="takes long: make test-slow"))


@cache
def _not_asked_for(path: Path) -> str:
    """Why the tests of a file do not run; "" where they do."""
    for place, (variable, reason) in TIERS.items():
        if not os.environ.get(variable) and path.is_relative_to(Path(__file__).parent / place):
            return reason
    return ""


@pytest.fixture(scope="session")
def run_folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A folder that all processes of the run share."""
    base = tmp_path_factory.getbasetemp()
    return base.parent if "PYTEST_XDIST_WORKER" in os.environ else base


@pytest.fixture(scope="session")
def opengl() -> None:
    """Skips where there is none to draw with."""
    from thermograsp.errors import (
        MissingDependencyError,  # numpy with it, which reads the number of threads once
    )
    from thermograsp.opengl import offscreen

    mujoco: Any = pytest.importorskip("mujoco")
    try:
        context, buffers = offscreen(mujoco.MjModel.from_xml_string("<mujoco/>"), 8, 8)
    except MissingDependencyError as error:
        pytest.skip(str(error))
    buffers.free()
    context.free()
