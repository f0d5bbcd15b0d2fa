"""The ladder of models, cheapest first, and the choice of the lowest rung that keeps a tolerance."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from types import MappingProxyType

import numpy as np
from threadpoolctl import ThreadpoolController

from thermograsp.errors import InvalidValueError, unknown_name
from thermograsp.notice import busy

from ..network import FIRST, Choice, Demand, Orders, box_choice, network_for, network_of
from . import (
    closed_form,
    grid_3d,
    grid_axisymmetric,
    half_space,
    layered,
    lumped,
    semi_analytic,
)
from . import (
    network as network_press,
)
from .network import geometry_of
from .problem import Conductance, PressCurves, PressProblem

_PROBES = 16  # samples at which a rung is tried first
_VARYING = (1e2, 1e3, 1e4, 1e5)  # W/(m2 K)
_PATTERNS = 1e-4  # of the difference, error of the semi-analytic rung
_GRIDS = (1, 2, 4)  # resolutions
_FINEST = 8e-5  # of the difference, what the finest of them is within
_FALL = 4.0  # of the gap between two of them, at most, where resolution doubles: grids are of second order

Solver = Callable[[PressProblem, np.ndarray], PressCurves]

_BLAS = ThreadpoolController()


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
    """The model that made a curve. orders: of a network, "" otherwise. error: K of temperature drop, a bound measured
    for boxes like it or against finer models where the rung was chosen by tolerance, NaN where it was asked for. It
    holds from 0.05 s after the touch to the press's last sample and no further: a longer press is another choice. It
    leaves out what steps of 10 ms add where a conductance or a thermostat varies. reason: why it was chosen."""

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
    with _BLAS.limit(limits=1, user_api="blas"):  # or the number of threads would decide last bits
        return _solved(name, problem, t, tolerance, cache)


def _solved(
    name: str, problem: PressProblem, t: np.ndarray, tolerance: float, cache: bool
) -> tuple[Rung, PressCurves]:
    """In the BLAS threads that there are."""
    if name == "auto":
        return _auto(problem, t, tolerance, cache)
    base, _, orders = name.partition(":")
    if base not in RUNGS:
        raise unknown_name("rung", base, [*RUNGS, "auto"])
    if orders and base != "network":
        raise InvalidValueError(f"rung {base!r} has no orders: write {base!r} instead of {name!r}")
    if base == "network":
        if orders and problem.surround is not None:
            raise InvalidValueError(f"{name!r}: with a surround the orders cannot be given, use 'network'")
        if orders:
            parsed = Orders.parse(orders)
            system = network_of(geometry_of(problem, parsed.fingertips), parsed, cache=cache)
            error = np.nan
        else:
            choice = press_network(problem, t, tolerance, cache)
            system, error = choice.system, choice.error
        return Rung("network", str(system.orders), error, "asked for"), network_press.solve(
            problem, t, system
        )
    solver = RUNGS[base].solve
    assert solver is not None
    if not problem.plain:
        raise InvalidValueError(
            f"rung {base!r} has one fingertip without a surround and an ideal thermostat: use 'network' for a second "
            "one, a surround, a real thermostat or a heater's own law"
        )
    return Rung(base, "", np.nan, "asked for"), solver(problem, t)


def _auto(problem: PressProblem, t: np.ndarray, tolerance: float, cache: bool) -> tuple[Rung, PressCurves]:
    """The rung of least cost whose temperature drop is within the tolerance: a network's from FIRST s on, a simpler
    one's at every sample, since rungs that neglect the element's heat capacity begin with most of the difference."""
    try:
        choice = press_network(problem, t, tolerance, cache)
    except InvalidValueError as refusal:
        return _above(problem, t, tolerance, refusal)
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
    probe = np.unique([0, *late[np.geomspace(1, len(late), _PROBES).astype(int) - 1]])
    for info in RUNGS.values():
        simpler = info.solve is not None and 0 < info.multiply_adds < system.orders.multiply_adds
        if not simpler or not _possible(info, problem):
            continue
        assert info.solve is not None
        for samples in (probe, np.arange(len(t))):
            candidate = info.solve(problem, t[samples])
            difference = np.abs(candidate.temperature_drop - curves.temperature_drop[samples])
            error = float(difference.max()) + choice.error
            if error > tolerance:
                break
        else:
            reason = f"the cheapest rung within {tolerance:g} K of the network {system.orders}"
            return Rung(info.name, "", error, reason), candidate
    return chosen, curves


def press_network(problem: PressProblem, t: np.ndarray, tolerance: float, cache: bool) -> Choice:
    """The cheapest network known to be within the tolerance, K, for a press of that problem at the times t (n,) s; its
    error has the air's in it. Raises InvalidValueError where there is none."""
    geometry, demand = geometry_of(problem), _demand(problem, t, tolerance)
    box = box_choice(geometry, demand, problem.air)
    return box or network_for(geometry, demand, air=problem.air, cache=cache)


def _above(
    problem: PressProblem, t: np.ndarray, tolerance: float, refusal: InvalidValueError
) -> tuple[Rung, PressCurves]:
    """The first rung above networks that keeps the tolerance. Raises the networks' refusal where none can."""
    patterns = _PATTERNS * abs(problem.temperature_difference)
    if _possible(RUNGS["semi_analytic"], problem) and patterns <= tolerance:
        reason = f"no network is within {tolerance:g} K; its flux patterns leave that error"
        return Rung("semi_analytic", "", patterns, reason), semi_analytic.solve(problem, t)
    grid = grid_3d if problem.shape == "square" else grid_axisymmetric
    within_reach = tolerance >= _FINEST * abs(problem.temperature_difference)
    if not problem.plain or not within_reach:
        raise refusal
    waiting = f"solving on grids up to {_GRIDS[-1]} times as fine, as no network keeps {tolerance:g} K"
    with busy(waiting):
        coarse = grid.solve(problem, t, _GRIDS[0])
    for resolution in _GRIDS[1:]:
        with busy(waiting):
            fine = grid.solve(problem, t, resolution)
        gap = np.abs(fine.temperature_drop - coarse.temperature_drop)[t >= FIRST]
        error = float(np.max(gap, initial=0.0))  # the finer one's is a third of it where both converge
        if error <= tolerance:
            name = "grid_3d" if grid is grid_3d else "axisymmetric"
            return Rung(name, "", error, f"no network is within {tolerance:g} K; from a coarser grid"), fine
        if error > _FALL * tolerance:
            break  # a grid twice as fine is not within it either
        coarse = fine
    raise refusal


def _possible(info: RungInfo, problem: PressProblem) -> bool:
    steady = not callable(problem.conductance)
    return problem.plain and (info.varying or steady) and (problem.air == 0 or info.name == "lumped")


def _demand(problem: PressProblem, t: np.ndarray, tolerance: float) -> Demand:
    conductances: tuple[float, ...] = ()
    for given in (problem.conductance, problem.opposite):
        if given is not None:
            conductances += expected(given, t)
    opposite = None if callable(problem.opposite) else problem.opposite
    horizon = float(max(t[-1], 2 * FIRST))
    difference, beside = problem.temperature_difference, problem.beside
    return Demand(tolerance, difference, conductances, horizon, opposite, beside)


def expected(conductance: Conductance, t: np.ndarray) -> tuple[float, ...]:
    """W/(m2 K) at which a network is demanded: one that varies is expected over _VARYING and up to its most at the
    samples t (n,) s."""
    if not callable(conductance):
        return (float(conductance),)
    most = max(map(conductance, t.tolist()))
    return (*_VARYING, most) if most > max(_VARYING) else _VARYING
