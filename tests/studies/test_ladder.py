"""The ladder's promise over a few random scenes; studies/networks/ladder.py runs a thousand."""

import importlib.util
import sys
from pathlib import Path

import numpy as np
import pytest

ROOT = Path(__file__).parents[2]


@pytest.fixture(scope="module")
def outcomes():
    path = ROOT / "studies" / "networks" / "ladder.py"
    spec = importlib.util.spec_from_file_location("thermograsp_benchmarks_ladder", path)
    assert spec is not None and spec.loader is not None
    module = importlib.util.module_from_spec(spec)
    sys.modules[spec.name] = module
    spec.loader.exec_module(module)
    yield module.run(30, 11, 4, progress=False)
    del sys.modules[spec.name]


def test_no_error_above_the_tolerance(outcomes) -> None:
    assert [o for o in outcomes if o.error > 1 or o.truth > 1] == []


def test_no_rung_at_half_the_cost_would_have_done(outcomes) -> None:
    assert [o for o in outcomes if o.cost > 2] == []


def test_the_full_network_is_as_good_as_it_says(outcomes) -> None:
    from thermograsp.thermal.network.choice import FLOOR

    assert np.nanmax([o.yardstick_error for o in outcomes]) <= FLOOR
