"""What a thermal step costs in NumPy, PyTorch and JAX, as a ratio to the compiled kernel in the same run.

    python studies/speed/backends.py                                   numpy, torch and jax on the CPU
    python studies/speed/backends.py --device cuda --rows 65536 --dtype float32 --bandwidth 4800
    python studies/speed/backends.py --one-network --json

Ways that take turns; the shortest of several repeats each. On the CPU all take one thread, and its time is counted, so
that other programs on the machine matter little; on other devices it is the wall's, with the device waited for. Bytes
are the least that a step must move: states in and out, conductances, differences and network numbers in, readings out;
divided by time and by --bandwidth they say how near a memory-bound step the device comes. Packages that are not
installed are left out.
"""

from __future__ import annotations

import argparse
import importlib.util
import json
import platform
import time
from collections.abc import Callable
from typing import Any

import numpy as np

from thermograsp import thermal

MATERIALS = ("glass", "aluminium", "cotton", "plastic")
STEP = 0.01  # s
SECONDS = 20.0  # over which float32 is held against float64


def inputs(rows: int, networks: int) -> tuple[thermal.HeatTables, tuple[np.ndarray, ...]]:
    """Tables of a 40 mm cube of each material, and (network, state, conductance, difference) amid a grasp."""
    stack, size = thermal.sensor("seed"), (0.04, 0.04, 0.04)
    systems = [
        thermal.network_for(
            thermal.Geometry(stack, thermal.material(name), "T", stack.face_area, "square", size, 2),
            thermal.Demand(0.05, 12.0),
        ).system
        for name in MATERIALS[:networks]
    ]
    tables = thermal.heat_tables(systems, [5.0] * networks, STEP)
    rng = np.random.default_rng(0)
    network, state = np.arange(rows) % networks, np.zeros((rows, tables.rates.shape[1]))
    conductance = 10 ** rng.uniform(-2, 1, (rows, 2)) * (rng.random((rows, 2)) > 0.2)
    difference = np.full((rows, 2), 12.0)
    state, _ = thermal.advance_heat(tables, network, state, conductance, difference, np.ones(rows, bool), 3)
    return tables, (network, state, conductance, difference)


def ways(arguments: argparse.Namespace, packages: set[str]) -> tuple[dict[str, Callable[[], object]], int]:
    """One step by each way of numba, NumPy and these packages, and the bytes that it must move."""
    tables, given = inputs(arguments.rows, 1 if arguments.one_network else len(MATERIALS))
    network, state, conductance, difference = given
    active = np.ones(len(state), bool)
    found: dict[str, Callable[[], object]] = {
        "numba": lambda: thermal.advance_heat(tables, network, state, conductance, difference, active, 1)
    }

    def called(step: Callable[..., Any], like: Any, move: Callable[[np.ndarray], Any]) -> Callable[[], Any]:
        tables_like = thermal.array_tables(tables, like)
        rows = [move(values.astype(arguments.dtype)) for values in (state, conductance, difference)]
        which = 0 if arguments.one_network else move(network)
        return lambda: step(tables_like, which, *rows)

    if arguments.device == "cpu":
        found["numpy"] = called(thermal.array_step, np.zeros(0, arguments.dtype), np.asarray)
    if "torch" in packages:
        torch = importlib.import_module("torch")
        torch.set_num_threads(1)
        on = torch.zeros(0, dtype=getattr(torch, arguments.dtype), device=arguments.device)
        steps = {
            "torch": thermal.array_step,
            "torch.compile": torch.compile(thermal.array_step, fullgraph=True),
        }
        for name, step in steps.items():
            run = called(step, on, lambda values: torch.as_tensor(values, device=on.device))
            wait = torch.cuda.synchronize if arguments.device == "cuda" else lambda: None
            found[name] = lambda run=run, wait=wait: (run(), wait())
    if "jax" in packages:
        jax = importlib.import_module("jax")
        jax.config.update("jax_enable_x64", True)
        place = jax.devices("gpu" if arguments.device == "cuda" else arguments.device)[0]
        with jax.default_device(place):
            run = called(
                # one network is a constant of the program, as in a Python int
                jax.jit(thermal.array_step, static_argnums=(1,) if arguments.one_network else ()),
                jax.numpy.zeros(0, arguments.dtype),
                lambda values: jax.device_put(values, place),
            )
        found["jax.jit"] = lambda: jax.block_until_ready(run())
    size = np.dtype(arguments.dtype).itemsize
    numbers = 2 * state.shape[1] + 2 * 2 + (5 * 2 + 2)  # states, inputs, readings of a row
    return found, len(state) * (numbers * size + (0 if arguments.one_network else 8))


def shortest(
    runs: dict[str, Callable[[], object]], repeats: int, clock: Callable[[], float]
) -> dict[str, float]:
    """s of each, after one run that compiles, the ways taking turns."""
    times = {name: np.inf for name in runs}
    for run in runs.values():
        run()
    for _ in range(repeats):
        for name, run in runs.items():
            start = clock()
            run()
            times[name] = min(times[name], clock() - start)
    return times


def float32_error() -> float:
    """K, the largest error of the temperature drop in 64 grasps of 20 s with a touch or release every 0.2 s."""
    tables, (network, state, conductance, difference) = inputs(64, len(MATERIALS))
    exact, coarse = (thermal.array_tables(tables, np.zeros(0, kind)) for kind in ("float64", "float32"))
    rng, worst, rounded = np.random.default_rng(1), 0.0, state.astype("float32")
    for k in range(round(SECONDS / STEP)):
        if k % 20 == 0:
            conductance = (10 ** rng.uniform(-3, 5, (64, 2)) * rng.integers(0, 2, (64, 2))).astype("float32")
        state, expected = thermal.array_step(exact, network, state, conductance.astype(float), difference)
        rounded, reading = thermal.array_step(
            coarse, network, rounded, conductance, difference.astype("float32")
        )
        worst = max(worst, float(np.max(np.abs(reading.drop - expected.drop))))
    return worst


def measure(arguments: argparse.Namespace) -> dict[str, Any]:
    """All figures."""
    runs, moved = ways(arguments, {name for name in ("torch", "jax") if importlib.util.find_spec(name)})
    times = shortest(
        runs, arguments.repeats, time.process_time if arguments.device == "cpu" else time.perf_counter
    )
    per = {
        name: {
            "fingertip_steps_per_s": 2 * arguments.rows / seconds,
            "time_over_numba": seconds / times["numba"],
            "gigabytes_per_s": moved / seconds / 1e9,
        }
        | ({"of_bandwidth": moved / seconds / 1e9 / arguments.bandwidth} if arguments.bandwidth else {})
        for name, seconds in times.items()
    }
    return {
        "machine": f"{platform.machine()}, {arguments.device}, {arguments.dtype} (numba float64)",
        "rows": arguments.rows,
        "bytes_per_fingertip_step": moved / arguments.rows / 2,
        "float32_error_K": float32_error(),
        "ways": per,
    }


def main() -> None:
    """Measures and prints."""
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument(
        "--rows", type=int, default=1024, help="grasps of two fingertips (default: %(default)s)"
    )
    parser.add_argument("--device", choices=["cpu", "cuda"], default="cpu")
    parser.add_argument("--dtype", choices=["float32", "float64"], default="float64")
    parser.add_argument("--one-network", action="store_true", help="one material, not four")
    parser.add_argument(
        "--bandwidth", type=float, help="GB/s of the device's memory, for the fraction reached"
    )
    parser.add_argument("--repeats", type=int, default=20)
    parser.add_argument("--json", action="store_true", help="print the result as JSON")
    arguments = parser.parse_args()
    result = measure(arguments)
    if arguments.json:
        print(json.dumps(result, indent=1))
        return
    for name, value in result.items():
        if name != "ways":
            print(f"{name}: {value if isinstance(value, str) else format(value, '.4g')}")
    for name, figures in result["ways"].items():
        print(f"{name:14}" + ", ".join(f"{key} {figure:.3g}" for key, figure in figures.items()))


if __name__ == "__main__":
    main()
