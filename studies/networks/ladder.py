"""The ladder's promise over random scenes: the rung chosen keeps the tolerance, and no much cheaper one would have.

    python studies/networks/ladder.py                         1,000 scenes
    python studies/networks/ladder.py --scenes 40 --seed 7 --json

Every scene is a press of a random material, size, contact, horizon and tolerance. Its error is the largest difference
in temperature drop, from 0.05 s on, between the rung that press(rung="auto") takes and the network of full order; some
scenes are held against the semi-analytic solution too. Its cost is that rung's multiply-adds a step over those of the
cheapest rung or network whose error is under a third of the tolerance.
"""

from __future__ import annotations

import argparse
import json
import sys
import time
from dataclasses import asdict, dataclass

import numpy as np
from rich.console import Console
from rich.progress import track
from rich.table import Table

from thermograsp.thermal.matter import materials, sensor
from thermograsp.thermal.network import (
    FIRST,
    MOST_MODES,
    ContactSystem,
    Demand,
    Orders,
    assemble,
    candidates,
    reduce,
    responses,
    sample_geometry,
    state_bases,
)
from thermograsp.thermal.rungs import RUNGS, PressProblem, geometry_of, semi_analytic, solve_rung
from thermograsp.thermal.rungs import network as network_press

DT = 0.05  # s
SHARE_OF_FACE = (0.2, 1.0)


@dataclass(frozen=True, slots=True)
class Outcome:
    """One scene. error: largest difference from the yardstick over the tolerance, -. truth: the same difference from
    the semi-analytic solution, NaN where it was not asked. yardstick_error: K, of the full network against that. cost:
    over the cheapest rung or network under a third of the tolerance, -; 1 where no network at half the cost is."""

    scene: str
    tolerance: float
    rung: str
    error: float
    truth: float
    yardstick_error: float
    cost: float


def random_problem(rng: np.random.Generator) -> tuple[PressProblem, float, float]:
    """A press, its horizon s and the tolerance K asked for."""
    names = sorted(materials())
    stack = sensor("seed")
    sides = np.exp(rng.uniform(np.log(0.009), np.log(0.08), 2))
    size = (
        float(sides[0]),
        float(sides[rng.integers(2)]),
        float(np.exp(rng.uniform(np.log(0.002), np.log(0.04)))),
    )
    problem = PressProblem(
        stack=stack,
        material=materials()[names[rng.integers(len(names))]],
        mode="T" if rng.random() < 0.5 else "O",
        conductance=float(np.exp(rng.uniform(np.log(1e2), np.log(1e5)))),
        area=float(rng.uniform(*SHARE_OF_FACE)) * stack.face_area,
        shape="square" if rng.random() < 0.75 else "round",
        object_size=size,
        air=0.0,
        sensor_temperature=36.0,
        object_temperature=24.0,
    )
    horizon = float(np.exp(rng.uniform(np.log(0.5), np.log(60.0))))
    tolerance = float(np.exp(rng.uniform(np.log(0.005), np.log(5.0))))
    return problem, horizon, tolerance


def run_scene(problem: PressProblem, horizon: float, tolerance: float, against_truth: bool) -> Outcome:
    """Measures one scene. Raises what the ladder raises."""
    t = np.arange(int(horizon / DT) + 1) * DT
    late = t >= FIRST
    samples = sample_geometry(geometry_of(problem))
    full = assemble(samples.geometry, samples.networks(MOST_MODES))
    yardstick = network_press.solve(problem, t, full).temperature_drop
    used, curves = solve_rung("auto", problem, t, tolerance, cache=False)
    difference = np.abs(curves.temperature_drop - yardstick)[late]
    truth = yardstick_error = np.nan
    if against_truth:
        some = t[np.unique(np.geomspace(1, len(t) - 1, 40).astype(int))]
        exact = semi_analytic.solve(problem, some).temperature_drop
        index = np.round(some / DT).astype(int)
        truth = float(np.max(np.abs(curves.temperature_drop[index] - exact))) / tolerance
        yardstick_error = float(np.max(np.abs(yardstick[index] - exact)))
    chosen = Orders.parse(used.orders).multiply_adds if used.orders else RUNGS[used.name].multiply_adds
    cheapest = _cheapest(problem, t, yardstick, full, tolerance / 3, chosen)
    scene = (
        f"{problem.material.name} {problem.mode} {problem.shape} h {problem.conductance:.3g} "
        f"area {problem.area * 1e6:.1f} mm2 size {' x '.join(f'{1e3 * side:.1f}' for side in problem.object_size)} mm "
        f"{horizon:.3g} s"
    )
    return Outcome(
        scene,
        tolerance,
        str(used),
        float(np.max(difference)) / tolerance,
        truth,
        yardstick_error,
        chosen / cheapest,
    )


def _cheapest(
    problem: PressProblem,
    t: np.ndarray,
    yardstick: np.ndarray,
    full: ContactSystem,
    within: float,
    chosen: int,
) -> int:
    """Multiply-adds of the cheapest rung or network with an error below `within`; of networks only those are tried that
    cost less than half of what was `chosen`, which is the answer where none does."""
    late = t >= FIRST
    for info in sorted(RUNGS.values(), key=lambda info: info.multiply_adds):
        if info.solve is None or not 0 < info.multiply_adds < chosen:
            continue
        difference = np.abs(info.solve(problem, t).temperature_drop - yardstick)[late]
        if np.max(difference) < within:
            chosen = info.multiply_adds
            break
    samples = sample_geometry(full.geometry)
    networks = {modes: samples.networks(modes) for modes in range(1, MOST_MODES + 1)}
    bases = {modes: state_bases(bodies, full.geometry.area) for modes, bodies in networks.items()}
    assert not callable(problem.conductance)
    demand = Demand(within, problem.temperature_difference, (problem.conductance,), float(t[-1]))
    exact = responses(full, demand)
    cheaper = [orders for orders in candidates(bases) if 2 * orders.multiply_adds < chosen]
    for orders in cheaper:
        system = assemble(full.geometry, reduce(networks[orders.modes], bases[orders.modes], orders))
        if np.max(np.abs(responses(system, demand) - exact)) < within:
            return orders.multiply_adds
    return chosen


def run(scenes: int, seed: int, exact: int, progress: bool) -> list[Outcome]:
    """Outcomes of the scenes, the first `exact` of them held against the semi-analytic solution as well."""
    rng = np.random.default_rng(seed)
    drawn = [random_problem(rng) for _ in range(scenes)]
    rows = track(drawn, "scenes", console=Console(stderr=True)) if progress else drawn
    return [run_scene(*scene, against_truth=i < exact) for i, scene in enumerate(rows)]


def main() -> int:
    """Command line. Returns 1 where a scene's error is above its tolerance or its cost above twice the cheapest's."""
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("--scenes", type=int, default=1000)
    parser.add_argument("--seed", type=int, default=0)
    parser.add_argument(
        "--exact", type=int, default=20, help="scenes held against the semi-analytic solution"
    )
    parser.add_argument("--json", action="store_true", help="print the result as JSON")
    arguments = parser.parse_args()
    start = time.perf_counter()
    outcomes = run(arguments.scenes, arguments.seed, arguments.exact, sys.stderr.isatty())
    error = np.array([outcome.error for outcome in outcomes])
    truth = np.array([outcome.truth for outcome in outcomes])
    cost = np.array([outcome.cost for outcome in outcomes])
    summary = {
        "scenes": len(outcomes),
        "largest error over tolerance": float(error.max()),
        "scenes above tolerance": int(np.sum(error > 1)),
        "largest error over tolerance, against semi_analytic": float(np.nanmax(truth))
        if arguments.exact
        else None,
        "largest error of the full network, K": max(
            (outcome.yardstick_error for outcome in outcomes[: arguments.exact]), default=None
        ),
        "largest cost over cheapest": float(cost.max()),
        "scenes above twice the cheapest": int(np.sum(cost > 2)),
        "rungs": {name: sum(o.rung.split(":")[0] == name for o in outcomes) for name in RUNGS},
        "seconds": time.perf_counter() - start,
    }
    if arguments.json:
        worst = sorted(outcomes, key=lambda outcome: -outcome.error)
        json.dump({**summary, "outcomes": [asdict(outcome) for outcome in worst]}, sys.stdout, indent=1)
        print()
    else:
        _print(summary, outcomes)
    return int(bool(np.any(error > 1) or np.nanmax(truth, initial=0.0) > 1 or np.any(cost > 2)))


def _print(summary: dict[str, object], outcomes: list[Outcome]) -> None:
    console = Console()
    for name, value in summary.items():
        console.print(f"{name}: {value:.3g}" if isinstance(value, float) else f"{name}: {value}")
    for title, column in (("error", "error"), ("cost", "cost"), ("error against semi_analytic", "truth")):
        table = Table("scene", "tolerance K", "rung", "error", "truth", "cost", title=f"worst {title}")
        known = [outcome for outcome in outcomes if np.isfinite(getattr(outcome, column))]
        for o in sorted(known, key=lambda outcome: -getattr(outcome, column))[:8]:
            table.add_row(
                o.scene, f"{o.tolerance:.3g}", o.rung, f"{o.error:.2f}", f"{o.truth:.2f}", f"{o.cost:.2f}"
            )
        console.print(table)


if __name__ == "__main__":
    sys.exit(main())
