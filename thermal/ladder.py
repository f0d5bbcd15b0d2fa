"""The ladder of models, cheapest first, and the choice of the lowest rung that keeps a tolerance."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from types import MappingProxyType

import numpy as np

from thermograsp.errors import InvalidValueError, unknown_name

from . import (
    closed_form,
    grid_3d,
    grid_axisymmetric,
    half_space,
    layered,
    lumped,
    network_press,
    semi_analytic,
)
from .choice import FIRST, Demand
from .contact_network import network_for, network_of
from .network_press import geometry_of
from .problem import PressCurves, PressProblem
from .states import Orders

_PROBES = 16  # samples at which a rung is tried first

Solver = Callable[[PressProblem, np.ndarray], PressCurves]


@dataclass(frozen=True, slots=True)
class RungInfo:
    """One model of the ladder. neglects: what it leaves out. varying: whether it follows a conductance that is a
    function of time. multiply_adds: real ones a sample, to compare costs (a complex one is four, a transcendental
    function twenty); 0 where it depends on the orders or the grid."""

    name: str
    neglects: str
    varying: bool
    multiply_adds: int
    solve: Solver | None = None


@dataclass(frozen=True, slots=True)
class Rung:
    """The model that made a curve. orders: of a network, "" otherwise. error: K of temperature drop from 0.05 s on,
    measured against the network of full order where the rung was chosen by tolerance, NaN where it was asked for.
    reason: why it was chosen."""

    name: str
    orders: str
    error: float
    reason: str

    def __str__(self) -> str:
        return f"{self.name}:{self.orders}" if self.orders else self.name


RUNGS = MappingProxyType(
    {
        info.name: info
        for info in (
            RungInfo(
                "lumped",
                "the sensor's heat capacity and all conduction inside the object (Biot number below 0.1)",
                True,
                20,
                lumped.solve,
            ),
            RungInfo(
                "half_space",
                "the far sides of element and object, the element's layers and heat spreading sideways",
                False,
                140,
                half_space.solve,
            ),
            RungInfo(
                "closed_form",
                "contact resistance, the element's layers, the object's thickness and heat spreading sideways",
                False,
                200,
                closed_form.solve,
            ),
            RungInfo("layered", "heat spreading sideways in the object", False, 14 * 400, layered.solve),
            RungInfo("network", "what its orders cut off: its error is measured", True, 0),
            RungInfo(
                "semi_analytic",
                "air and conductances that vary, which it refuses; its flux patterns leave .0003 K of 12 K",
                False,
                1_000_000_000,  # a decade of times, however many there are
                semi_analytic.solve,
            ),
            RungInfo(
                "axisymmetric",
                "corners: square patches and plates are discs of equal area; what its mesh misses",
                True,
                0,
                grid_axisymmetric.solve,
            ),
            RungInfo("grid_3d", "what its mesh misses", True, 0, grid_3d.solve),
        )
    }
)
"""Name -> what is known of it, from the cheapest."""


def solve_rung(
    name: str, problem: PressProblem, t: np.ndarray, tolerance: float, cache: bool
) -> tuple[Rung, PressCurves]:
    """Curves at t (n,) = 0, dt, ... by the rung of that name, "network:ORDERS", or by the one "auto" chooses.

    Raises UnknownNameError, and InvalidValueError where the rung cannot do the problem, with the reason."""
    if name == "auto":
        return _auto(problem, t, tolerance, cache)
    base, _, orders = name.partition(":")
    if base not in RUNGS:
        raise unknown_name("rung", base, [*RUNGS, "auto"])
    if orders and base != "network":
        raise InvalidValueError(f"rung {base!r} has no orders: write {base!r} instead of {name!r}")
    if base == "network":
        if orders:
            parsed = Orders.parse(orders)
            system = network_of(geometry_of(problem, parsed.fingertips), parsed, cache=cache)
            error = np.nan
        else:
            choice = network_for(geometry_of(problem), _demand(problem, t, tolerance), cache=cache)
            system, error = choice.system, choice.error
        return Rung("network", str(system.orders), error, "asked for"), network_press.solve(
            problem, t, system
        )
    solver = RUNGS[base].solve
    assert solver is not None
    if problem.opposite is not None or problem.thermostat is not None:
        raise InvalidValueError(
            f"rung {base!r} has one fingertip and an ideal thermostat: use 'network' for a second one or a real one"
        )
    return Rung(base, "", np.nan, "asked for"), solver(problem, t)


def _auto(problem: PressProblem, t: np.ndarray, tolerance: float, cache: bool) -> tuple[Rung, PressCurves]:
    """The rung of least cost whose temperature drop is within the tolerance, measured from FIRST s on."""
    choice = network_for(geometry_of(problem), _demand(problem, t, tolerance), cache=cache)
    system = choice.system
    chosen = Rung(
        "network",
        str(system.orders),
        choice.error,
        f"the smallest network within {tolerance:g} K; no simpler rung is",
    )
    curves = network_press.solve(problem, t, system)
    late = np.flatnonzero(t >= FIRST)
    if not len(late):  # nothing by which a simpler rung could show itself fit
        return chosen, curves
    # A few samples show a simpler rung unfit; only one that passes them is computed whole.
    probe = np.unique(late[np.geomspace(1, len(late), _PROBES).astype(int) - 1])
    for info in RUNGS.values():
        simpler = info.solve is not None and 0 < info.multiply_adds < system.orders.multiply_adds
        if not simpler or not _possible(info, problem):
            continue
        assert info.solve is not None
        for samples in (probe, np.arange(len(t))):
            candidate = info.solve(problem, t[samples])
            difference = np.abs(candidate.temperature_drop - curves.temperature_drop[samples])
            error = float(np.max(difference[t[samples] >= FIRST], initial=0.0)) + choice.error
            if error > tolerance:
                break
        else:
            reason = f"the cheapest rung within {tolerance:g} K of the network {system.orders}"
            return Rung(info.name, "", error, reason), candidate
    return chosen, curves


def _possible(info: RungInfo, problem: PressProblem) -> bool:
    steady = not callable(problem.conductance)
    plain = problem.opposite is None and problem.thermostat is None
    return plain and (info.varying or steady) and (problem.air == 0 or info.name == "lumped")


def _demand(problem: PressProblem, t: np.ndarray, tolerance: float) -> Demand:
    if callable(problem.conductance):
        conductances = (1e2, 1e3, 1e4, 1e5)
    else:
        conductances = (problem.conductance,)
    return Demand(tolerance, problem.temperature_difference, conductances, float(max(t[-1], 2 * FIRST)))
