"""The benchmark of the array step runs, and its ways take the same step."""

from __future__ import annotations

import runpy
from argparse import Namespace
from pathlib import Path

import numpy as np
import pytest


@pytest.mark.parametrize("one_network", [False, True])
def test_numba_and_numpy_take_the_same_step(one_network: bool) -> None:
    module = runpy.run_path(str(Path(__file__).parents[2] / "studies" / "speed" / "backends.py"))
    arguments = Namespace(rows=8, one_network=one_network, dtype="float64", device="cpu")
    runs, moved = module["ways"](arguments, set())
    state, reading = runs["numba"]()
    same, read = runs["numpy"]()
    np.testing.assert_allclose(same, state, rtol=0, atol=1e-12 * np.abs(state).max())
    numbers = sum(values[0].size for values in (same, same, *read)) + 2 + 2
    assert moved == 8 * (8 * numbers + (0 if one_network else 8))
