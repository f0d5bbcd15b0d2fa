"""Work and precision of a grasp: what MuJoCo's settings cost, how well they hold, and what error heat gets from them.

Every variant goes through the same course (course.py) with a box, a cylinder, a sphere and a mesh, each placed a few
times. The reference is a run with a time step of 0.1 ms and settings that are otherwise shipped; slip needs none: the
load never passes a sixth of what friction can hold, so nothing should slip.
"""

from __future__ import annotations

import tempfile
from collections.abc import Callable
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

import numpy as np

from thermograsp.bench.grasp.course import (
    Grasp,
    duration,
    grasp,
    lift_rates,
    placements,
    shapes,
)
from thermograsp.bench.grasp.errors import (
    FATES,
    METRICS,
    Errors,
    HeatOfGrasps,
    errors,
    worst,
)
from thermograsp.envs import ObjectSpec, SolverSettings
from thermograsp.envs.mechanics import SHIPPED

SHAPES = ("box", "cylinder", "sphere", "mesh")
_COST_NOISE = 1.05  # of timings
_ERROR_NOISE = 1.5  # of errors: no two variants touch at the same instants


@dataclass(frozen=True, slots=True)
class Variant:
    """One set of solver settings that is compared with the others. family: which knob is turned. label: how far, unique
    in its family. repeats: how often it is timed."""

    family: str
    label: str
    settings: SolverSettings
    repeats: int = 2

    @property
    def name(self) -> str:
        """Unique among variants."""
        return f"{self.family}, {self.label}"


@dataclass(frozen=True, slots=True)
class Point:
    """A variant's outcome. shapes: errors by shape. worst: the worst fate and errors of all. seconds: CPU time of the
    mechanics per simulated second of one grasp, mean over shapes; ratio: over that of what is shipped. beaten_by:
    variants that are better in something and worse in nothing, cost included, by more than their noise."""

    variant: Variant
    shapes: dict[str, Errors]
    worst: Errors
    seconds: float
    ratio: float = float("nan")
    beaten_by: tuple[str, ...] = ()


SHIPPED_VARIANT = Variant("shipped", "2 ms, discrete, elliptic cone, impratio 100, Newton", SHIPPED)
_MUJOCO = SolverSettings(0.002, "Euler", "pyramidal", 1.0, "Newton", 100, 0, (0.02, 1.0), (0.9, 0.95, 0.001))


def reference(quick: bool) -> SolverSettings:
    """What forces, centroids and temperature drops are compared with."""
    return replace(SHIPPED, timestep=5e-4 if quick else 1e-4)


def placement_count(quick: bool) -> int:
    """How often each shape is placed anew."""
    return 1 if quick else 8


def variants(quick: bool) -> list[Variant]:
    """What is compared: what is shipped, one knob turned at a time, MuJoCo's defaults, and settings known to fail."""

    def turned(family: str, label: str, repeats: int = 2, **knobs: Any) -> Variant:
        return Variant(family, label, replace(SHIPPED, **knobs), repeats)

    def implicitfast(label: str, **knobs: Any) -> Variant:
        return turned("implicitfast", label, integrator="implicitfast", **knobs)

    few = [
        SHIPPED_VARIANT,
        Variant("MuJoCo's defaults", "2 ms", _MUJOCO),
        turned("time step", "1 ms", timestep=0.001),
        turned("time step", "4 ms", timestep=0.004),
        turned("Euler", "2 ms", integrator="Euler"),
        turned("elliptic cone", "impratio 1", impratio=1.0),
        turned("noslip", "3 iterations", noslip_iterations=3),
        turned("Newton", "1 iteration", iterations=1),
        implicitfast("5 ms, refsafe off", timestep=0.005, refsafe=False),
    ]
    if quick:
        return [replace(variant, repeats=1) for variant in few]
    return [
        *few,
        turned("time step", "0.2 ms", 1, timestep=2e-4),
        turned("time step", "0.5 ms", 1, timestep=5e-4),
        turned("time step", "5 ms", timestep=0.005),
        turned("time step", "10 ms", timestep=0.01),
        turned("Euler", "1 ms", integrator="Euler", timestep=0.001),
        turned("Euler", "4 ms", integrator="Euler", timestep=0.004),
        implicitfast("1 ms", timestep=0.001),
        implicitfast("2 ms"),
        implicitfast("4 ms", timestep=0.004),
        implicitfast("4 ms, refsafe off", timestep=0.004, refsafe=False),
        implicitfast("4 ms, solref -1e5", timestep=0.004, solref=(-1e5, -500.0)),
        turned("RK4", "2 ms", 1, integrator="RK4"),
        *(turned("elliptic cone", f"impratio {r:g}", impratio=r) for r in (10.0, 1000.0, 10000.0)),
        *(
            turned("pyramidal cone", f"impratio {r:g}", cone="pyramidal", impratio=r)
            for r in (1.0, 10.0, 100.0)
        ),
        turned("noslip", "3 iterations, impratio 1", noslip_iterations=3, impratio=1.0),
        *(turned("Newton", f"{n} iterations", iterations=n) for n in (2, 3, 5, 10)),
        *(turned("CG", f"{n} iterations", solver="CG", iterations=n) for n in (10, 100)),
        *(turned("PGS", f"{n} iterations", 1, solver="PGS", iterations=n) for n in (20, 100)),
        *(
            turned("contact time", f"{1e3 * s:g} ms", solref=(s, 1.0))
            for s in (0.02, 0.01, 0.005, 0.003, 0.0025)
        ),
        turned("discrete", "solref 1 ms, refsafe off", solref=(0.001, 1.0), refsafe=False),
        turned("discrete", "4 ms, solref -1e5", timestep=0.004, solref=(-1e5, -500.0)),
    ]


def measure(
    quick: bool, rng: np.random.Generator, shown: Callable[[str], None], cache: bool = True
) -> list[Point]:
    """Every variant's point. Timings run in random order, so that a busy moment of the machine hits no variant alone,
    and every control step counts with its quickest. shown: called with what is being done, once a run. cache: keep
    thermal networks on disk."""
    chosen = variants(quick)
    with tempfile.TemporaryDirectory() as folder:
        placed = {
            name: placements(spec, placement_count(quick), rng) for name, spec in shapes(Path(folder)).items()
        }
        tests = {}
        for name, specs in placed.items():
            shown(f"reference: {name}")
            tests[name] = _test(specs, reference(quick), cache)
        found: list[dict[str, Errors]] = [{} for _ in chosen]
        seconds = [{name: np.full(len(lift_rates()), np.inf) for name in SHAPES} for _ in chosen]
        for i in rng.permutation(np.repeat(np.arange(len(chosen)), [v.repeats for v in chosen])):
            shown(chosen[i].name)
            for name, test in tests.items():
                run = grasp(chosen[i].settings, placed[name])
                seconds[i][name] = np.minimum(seconds[i][name], run.seconds)
                if name not in found[i]:
                    found[i][name] = test(run)
    points = [
        Point(
            variant,
            by_shape,
            worst(list(by_shape.values())),
            float(np.mean([each.sum() for each in cost.values()])) / duration(),
        )
        for variant, by_shape, cost in zip(chosen, found, seconds, strict=True)
    ]
    base = points[0].seconds
    points = [replace(point, ratio=point.seconds / base) for point in points]
    return [replace(p, beaten_by=tuple(q.variant.name for q in points if beats(q, p))) for p in points]


def runs(quick: bool) -> int:
    """How often `measure` reports."""
    return len(SHAPES) + sum(variant.repeats for variant in variants(quick))


def beats(point: Point, other: Point) -> bool:
    """Whether a point is better in something and worse in nothing, by more than noise."""
    if FATES.index(point.worst.fate) > FATES.index(other.worst.fate):
        return False
    noise = np.array([_COST_NOISE, *[_ERROR_NOISE] * len(METRICS)])
    scores, other_scores = _scores(point), _scores(other)
    no_worse = scores <= noise * other_scores
    return bool(no_worse.all() and (noise * scores < other_scores).any())


def _test(placed: list[ObjectSpec], exact: SolverSettings, cache: bool) -> Callable[[Grasp], Errors]:
    truth = grasp(exact, placed)
    heat = HeatOfGrasps(placed[0], len(placed), cache)
    drops = heat.drops(truth)
    return lambda run: errors(run, truth, heat, drops)


def _scores(point: Point) -> np.ndarray:
    """Cost and every error; those of what is not held are infinite."""
    error = [getattr(point.worst, name) for name in METRICS]
    return np.array([point.ratio, *np.nan_to_num(error, nan=np.inf)])
