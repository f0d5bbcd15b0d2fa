"""What the heat model costs: build, cache, press and batch step, with ratios to plain NumPy and to the 3-D grid.

    python studies/speed/cost.py             a table
    python studies/speed/cost.py --json

Times are the shortest of several repeats in this one run; they drift with the machine, the ratios hold better.
"""

from __future__ import annotations

import argparse
import json
import os
import platform
import tempfile
import time
from collections.abc import Callable
from typing import Literal

import numpy as np

from thermograsp import thermal
from thermograsp.thermal.network import propagator, step
from thermograsp.thermal.rungs import grid_3d

ROWS = 1024
MATERIALS = ("glass", "aluminium", "cotton", "plastic")
STEP = 0.01  # s


def shortest(run: Callable[[], object], repeats: int) -> float:
    """s, of `repeats` runs."""
    times = []
    for _ in range(repeats):
        start = time.perf_counter()
        run()
        times.append(time.perf_counter() - start)
    return min(times)


def geometry(name: str, fingertips: Literal[1, 2]) -> thermal.Geometry:
    """A 40 mm cube between fingertips."""
    return thermal.Geometry(
        thermal.sensor("seed"), thermal.material(name), "T", 81e-6, "square", (0.04, 0.04, 0.04), fingertips
    )


def batch_step(tolerance: float) -> dict[str, float]:
    """us per fingertip and step of the compiled batch, and of NumPy's batched step of the same systems."""
    demand = thermal.Demand(tolerance, 12.0, (1e2, 1e3, 1e4, 1e5), 20.0)
    systems = [thermal.network_for(geometry(name, 2), demand).system for name in MATERIALS]
    tables = thermal.heat_tables(systems, [0.0] * len(systems), STEP)
    network = np.arange(ROWS) % len(systems)
    state = np.zeros((ROWS, tables.rates.shape[1]))
    conductance, difference = np.full((ROWS, 2), 0.81), np.full((ROWS, 2), 12.0)
    active = np.ones(ROWS, bool)
    state, _ = thermal.advance_heat(tables, network, state, conductance, difference, active, 2)
    compiled = shortest(
        lambda: thermal.advance_heat(tables, network, state, conductance, difference, active, 1), 40
    )
    plain = 0.0
    for i, system in enumerate(systems):
        stepper = propagator(system.rates, system.ports, STEP)
        rows = np.flatnonzero(network == i)
        weights = np.full((len(rows), system.ports.shape[1]), 0.81)
        drive = np.zeros_like(weights)
        drive[:, :: system.modes] = 12.0
        states = state[rows, : len(system.rates)]
        plain += shortest(
            lambda stepper=stepper, states=states, w=weights, d=drive: step(stepper, states, w, d), 10
        )
    per = 1e6 / ROWS / 2
    return {
        "us_per_fingertip": compiled * per,
        "numpy_us_per_fingertip": plain * per,
        "ratio": plain / compiled,
    }


def measure() -> dict[str, object]:
    """All figures."""
    demand = thermal.Demand(0.05, 12.0, (1e2, 1e3, 1e4, 1e5), 20.0)
    with tempfile.TemporaryDirectory() as folder:
        os.environ["THERMOGRASP_CACHE"] = folder
        build = max(
            shortest(lambda name=name: thermal.network_for(geometry(name, 1), demand, cache=False), 3)
            for name in MATERIALS
        )
        thermal.network_for(geometry("glass", 1), demand)
        cached = shortest(lambda: thermal.network_for(geometry("glass", 1), demand), 20)
        thermal.press("glass", seconds=20.0)
        press = shortest(lambda: thermal.press("glass", seconds=20.0), 10)
        problem = thermal.PressProblem(
            thermal.sensor("seed"),
            thermal.material("glass"),
            "T",
            1e4,
            81e-6,
            "square",
            (0.04, 0.04, 0.01),
            0.0,
            36.0,
            24.0,
        )
        grid = shortest(lambda: grid_3d.solve(problem, np.linspace(0.0, 20.0, 101)), 1)
        return {
            "machine": f"{platform.machine()}, {os.cpu_count()} cores, numpy {np.__version__}",
            "network_build_s": build,
            "network_from_cache_s": cached,
            "press_20_s_at_20_ms_s": press,
            "grid_3d_20_s_s": grid,
            "grid_over_press": grid / press,
            "batch_step": {str(tolerance): batch_step(tolerance) for tolerance in (0.05, 0.005)},
        }


def main() -> None:
    """Measures and prints."""
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("--json", action="store_true", help="print the result as JSON")
    arguments = parser.parse_args()
    result = measure()
    if arguments.json:
        print(json.dumps(result, indent=1))
        return
    for name, value in result.items():
        if isinstance(value, dict):
            for tolerance, figures in value.items():
                row = ", ".join(f"{key} {figure:.3g}" for key, figure in figures.items())
                print(f"{name} at {tolerance} K: {row}")
        else:
            print(f"{name}: {value if isinstance(value, str) else format(value, '.3g')}")


if __name__ == "__main__":
    main()
