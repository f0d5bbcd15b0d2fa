"""The study of what the heat of many worlds costs runs, and its ways feel what NumPy feels."""

from __future__ import annotations

import argparse
import runpy
from pathlib import Path

import pytest


@pytest.mark.parametrize(("way", "package"), [("one by one", "torch"), ("jax.jit", "jax")])
def test_worlds_feel_what_numpy_feels(way: str, package: str) -> None:
    pytest.importorskip(package, reason="make test-backends installs it")
    module = runpy.run_path(str(Path(__file__).parents[2] / "studies" / "speed" / "worlds.py"))
    arguments = argparse.Namespace(device="cpu", repeats=1, bandwidth=100.0)
    grasp = module["Grasp"]()
    assert grasp.drop[-1, 0].min() > 2 * grasp.drop[-1, 1].max() > 0
    figures = module["measure"](grasp, way, 3, arguments)
    assert figures["error_K"] < 1e-4 and figures["ms"] > 0 and 0 < figures["of_bandwidth"] < 1
