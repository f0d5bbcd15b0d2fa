"""Compiled sums round in one way, whatever this process compiled and whatever it found compiled."""

import importlib
import os
import pkgutil
import subprocess
import sys
from collections.abc import Iterator
from contextlib import suppress
from pathlib import Path
from types import ModuleType

import pytest
from numba.core.dispatcher import Dispatcher

import thermograsp.envs
import thermograsp.thermal
from thermograsp.errors import MissingDependencyError

STEPS = """
import hashlib
import numpy as np
from thermograsp.thermal.batch import HeatTables, advance_heat

rng = np.random.default_rng(0)
digest = hashlib.sha256()
for states, modes in ((19, 1), (33, 2), (40, 3), (63, 3)):
    sizes = np.array([[states, states - 14, 7, modes, 0, 0]])
    rows = rng.normal(0, 0.1, (1, 4 + 4 * 2 + 2 * 3 + 2 * modes, states))
    gram = rng.normal(0, 0.1, (1, 3, 2 * modes, 2 * modes)) + 0j
    tables = HeatTables(0.01, sizes, rows, gram)
    state, felt = rng.normal(0, 1, (1, states)), rng.uniform(0, 1, (1, 2))
    state, told = advance_heat(tables, np.zeros(1, int), state, felt, np.full((1, 2), 12.0), np.ones(1, bool), 50)
    for values in (state, *told):
        assert np.isfinite(values).all()
        digest.update(values.tobytes())
print(digest.hexdigest())
"""


def modules() -> Iterator[ModuleType]:
    for package in (thermograsp.thermal, thermograsp.envs):
        for each in pkgutil.walk_packages(package.__path__, f"{package.__name__}."):
            with suppress(MissingDependencyError):  # an adapter of what is not installed
                yield importlib.import_module(each.name)


def compiled() -> dict[str, Dispatcher]:
    return {
        f"{module.__name__}.{name}": value
        for module in modules()
        for name, value in vars(module).items()
        if isinstance(value, Dispatcher) and value.py_func.__module__ == module.__name__
    }


def test_what_may_reassociate_sums_is_inlined_where_it_is_called() -> None:
    # Of a function of its own, LLVM keeps one version beside each caller and one alone; which of them runs depends on
    # what has been compiled in this process before, and their last bits differ.
    found = compiled()
    assert len(found) > 20
    for name, caller in found.items():
        code, names = caller.py_func.__code__, caller.py_func.__globals__
        for called in code.co_names:
            callee = names.get(called)
            if isinstance(callee, Dispatcher) and callee.targetoptions.get("fastmath"):
                options = callee.targetoptions
                inlined = options.get("forceinline") or options.get("inline") == "always"
                assert inlined, f"{name} calls {called}"


@pytest.mark.slow
def test_a_process_that_compiles_and_one_that_finds_it_compiled_agree_to_the_last_bit(tmp_path: Path) -> None:
    environment = os.environ | {"NUMBA_CACHE_DIR": str(tmp_path)}
    first, second = (
        subprocess.run(
            [sys.executable, "-c", STEPS], env=environment, capture_output=True, text=True, check=True
        ).stdout
        for _ in range(2)
    )
    assert first == second and len(first.strip()) == 64
