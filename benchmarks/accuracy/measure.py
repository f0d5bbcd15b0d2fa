"""Work and precision of a press: what each way of computing the temperature drop costs, and how far off it is.

Ours: every rung of the ladder, and what rung="auto" chooses for tolerances. Beside them what one would write instead:
a plain uniform grid (semi_discrete) with textbook time steps, scipy's integrators or FiPy, and 3-D finite elements.
All answer the same question, the drop every 20 ms for 8 s. The error is the largest difference from the semi-analytic
solution in three dimensions, itself good to .0003 K, from 0.05 s on. What can be prepared once for a material (grids,
matrices, factors, networks) is timed apart and not counted; the package's own grids are timed with their factors.
"""

from __future__ import annotations

import time
from collections.abc import Callable
from dataclasses import dataclass, replace

import numpy as np

from thermograsp import thermal
from thermograsp.bench.accuracy import elements, fipy_press, steppers
from thermograsp.bench.accuracy.semi_discrete import disc_press
from thermograsp.thermal import (
    RUNGS,
    Orders,
    PressProblem,
    network_of,
)
from thermograsp.thermal.network import FIRST
from thermograsp.thermal.rungs import grid_3d, grid_axisymmetric, press_network, solve_rung
from thermograsp.thermal.rungs import network as network_press

MATERIALS = ("wood", "glass", "stainless_steel", "aluminium")
TOLERANCES = (1.0, 0.3, 0.1, 0.03, 0.01)
RATIO_TO = "auto 0.03 K"
SPACING, SECONDS = 0.02, 8.0
_ORDERS = ((1, 3, 5), (2, 5, 6), (2, 8, 8), (3, 10, 12), (4, 12, 16))  # modes, states of sensor and object

March = Callable[[], np.ndarray]
Prepare = Callable[[PressProblem, np.ndarray], tuple[str, March]]


@dataclass(frozen=True, slots=True)
class Method:
    """A way to compute a press, at one setting of its accuracy. family: what it is called in the figure. setting: its
    knob. prepare: of a problem and its samples t (n,) s, what was made (for "auto" the rung) and the march that returns
    the drop (n,) K. repeats: 1 for what takes long."""

    family: str
    setting: str
    prepare: Prepare
    repeats: int = 5


@dataclass(frozen=True, slots=True)
class Point:
    """One method on one case. seconds: of CPU per simulated second. preparation: CPU s, once for a material. error:
    K, largest from 0.05 s on. ratio: seconds over those of the case's network for RATIO_TO. pareto: nothing measured on
    this case is both cheaper and better."""

    material: str
    mode: str
    family: str
    setting: str
    detail: str
    seconds: float
    preparation: float
    error: float
    ratio: float = float("nan")
    pareto: bool = False


def press_problem(name: str, mode: str) -> PressProblem:
    """The sensor of the paper on a 40 x 40 x 10 mm plate, conductance 1e4 W/(m2 K), 36 on 24 degC."""
    return PressProblem(
        stack=thermal.sensor("seed"),
        material=thermal.material(name),
        mode="T" if mode == "T" else "O",
        conductance=1e4,
        area=81e-6,
        shape="square",
        object_size=(0.04, 0.04, 0.01),
        air=0.0,
        sensor_temperature=36.0,
        object_temperature=24.0,
    )


def methods(quick: bool) -> list[Method]:
    """What is compared; scikit-fem and FiPy where they are installed. quick: without FiPy and the finest settings."""
    found = [Method(name, "", _rung(name)) for name in ("lumped", "half_space", "closed_form", "layered")]
    found += [Method("auto", f"{tolerance:g} K", _auto(tolerance, quick)) for tolerance in TOLERANCES]
    found += [Method("network", "/".join(map(str, orders)), _network(*orders)) for orders in _ORDERS]
    for resolution in (1,) if quick else (1, 2, 4):
        found.append(Method("axisymmetric", f"x{resolution}", _graded(grid_axisymmetric, resolution), 1))
    for resolution in () if quick else (1, 2):
        found.append(Method("grid_3d", f"x{resolution}", _graded(grid_3d, resolution), 1))
    for cell in (1e-3, 0.5e-3) if quick else (1e-3, 0.5e-3, 0.25e-3, 0.125e-3):
        plain, coarse = f"{1e3 * cell:g} mm", cell > 0.2e-3
        found += [
            Method("backward Euler", plain, _theta(cell, 1.0), 3 if coarse else 1),
            Method("Crank-Nicolson", plain, _theta(cell, 0.5), 3 if coarse else 1),
        ]
        if coarse:
            found.append(Method("FTCS", plain, _ftcs(cell), 3))
            found += [Method(name, plain, _ivp(cell, name), 2) for name in ("BDF", "Radau", "LSODA")]
    found += [
        Method("1-D Crank-Nicolson", "0.1 mm", _theta(1e-4, 0.5, lateral=False)),
        Method("1-D FTCS", "0.1 mm", _ftcs(1e-4, lateral=False), 1),
        Method("1-D BDF", "0.1 mm", _ivp(1e-4, "BDF", lateral=False), 2),
    ]
    if fipy_press.available() and not quick:
        found += [Method("FiPy", f"{1e3 * cell:g} mm", _fipy(cell), 1) for cell in (1e-3, 0.5e-3)]
    if elements.available():
        sizes = (2,) if quick else (2, 4, 6)
        found += [Method("finite elements", f"{cells} a half side", _elements(cells), 1) for cells in sizes]
    return found


def measure(
    case: tuple[str, str],
    chosen: list[Method],
    rng: np.random.Generator,
    shown: Callable[[str], None],
) -> list[Point]:
    """Points of one (material, mode). Repeats run in random order over all methods, so that a busy moment of the
    machine hits no method alone; each counts with its quickest. shown: called with what is being done."""
    name, mode = case
    problem = press_problem(name, mode)
    t = SPACING * np.arange(round(SECONDS / SPACING) + 1)
    late = np.unique(np.round(np.geomspace(FIRST, SECONDS, 60) / SPACING).astype(int))
    late = late[t[late] >= FIRST]
    reference = RUNGS["semi_analytic"].solve
    assert reference is not None
    exact = reference(problem, t[late]).temperature_drop
    ready: list[tuple[str, March, float]] = []
    for method in chosen:
        begun = time.process_time()
        detail, march = method.prepare(problem, t)
        ready.append((detail, march, time.process_time() - begun))
    best = np.full(len(chosen), np.inf)
    errors = np.zeros(len(chosen))
    tickets = np.repeat(np.arange(len(chosen)), [method.repeats for method in chosen])
    # first calls compile and fill caches
    order = [i for i, method in enumerate(chosen) if method.repeats > 1] + rng.permutation(tickets).tolist()
    for i in order:
        shown(f"{name} {mode}: {chosen[i].family}")
        begun = time.process_time()
        drop = ready[i][1]()
        best[i] = min(best[i], time.process_time() - begun)
        errors[i] = float(np.max(np.abs(drop[late] - exact)))
    points = [
        Point(name, mode, m.family, m.setting, detail, best[i] / SECONDS, preparation, errors[i])
        for i, (m, (detail, _, preparation)) in enumerate(zip(chosen, ready, strict=True))
    ]
    base = next(p.seconds for p in points if f"{p.family} {p.setting}" == RATIO_TO)
    return [replace(p, ratio=p.seconds / base, pareto=_undominated(p, points)) for p in points]


def _undominated(point: Point, points: list[Point]) -> bool:
    return not any(
        q.seconds <= point.seconds
        and q.error <= point.error
        and (q.seconds < point.seconds or q.error < point.error)
        for q in points
    )


def _rung(name: str) -> Prepare:
    solver = RUNGS[name].solve
    assert solver is not None
    return lambda problem, t: (name, lambda: solver(problem, t).temperature_drop)


def _graded(module: object, resolution: int) -> Prepare:
    solve = module.solve  # pyright: ignore[reportAttributeAccessIssue]
    return lambda problem, t: ("", lambda: solve(problem, t, resolution).temperature_drop)


def _network(modes: int, sensor: int, body: int) -> Prepare:
    def prepare(problem: PressProblem, t: np.ndarray) -> tuple[str, March]:
        # in O mode the sensor is part of the object
        orders = (
            Orders(modes, sensor, body, None)
            if problem.mode == "T"
            else Orders(modes, 0, body + sensor // 2, None)
        )
        system = network_of(network_press.geometry_of(problem), orders)
        return f"network:{system.orders}", lambda: network_press.solve(problem, t, system).temperature_drop

    return prepare


def _auto(tolerance: float, cache: bool) -> Prepare:
    def prepare(problem: PressProblem, t: np.ndarray) -> tuple[str, March]:
        rung, _ = solve_rung("auto", problem, t, tolerance, cache)
        if rung.name != "network":
            solver = RUNGS[rung.name].solve
            assert solver is not None
            return str(rung), lambda: solver(problem, t).temperature_drop
        system = press_network(problem, t, tolerance, cache).system
        return str(rung), lambda: network_press.solve(problem, t, system).temperature_drop

    return prepare


def _steps(t: np.ndarray) -> tuple[float, int]:
    return float(t[1] - t[0]), len(t) - 1


def _theta(cell: float, weight: float, lateral: bool = True) -> Prepare:
    return lambda problem, t: ("", steppers.theta(disc_press(problem, cell, lateral), *_steps(t), weight))


def _ftcs(cell: float, lateral: bool = True) -> Prepare:
    return lambda problem, t: ("", steppers.ftcs(disc_press(problem, cell, lateral), *_steps(t)))


def _ivp(cell: float, method: str, lateral: bool = True) -> Prepare:
    return lambda problem, t: ("", steppers.ivp(disc_press(problem, cell, lateral), *_steps(t), method))


def _fipy(cell: float) -> Prepare:
    return lambda problem, t: ("", fipy_press.fipy_press(problem, *_steps(t), cell))


def _elements(cells: int) -> Prepare:
    return lambda problem, t: ("", steppers.sdirk2(elements.element_press(problem, cells), *_steps(t)))
