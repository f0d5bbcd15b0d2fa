"""The choice of a network: monotone in the demand, honest about its error."""

import copy
import pickle
import re
from concurrent.futures import ProcessPoolExecutor
from dataclasses import replace
from functools import cache
from multiprocessing import get_context

import numpy as np
import pytest

from thermograsp.errors import InvalidValueError
from thermograsp.thermal import Demand, network_for
from thermograsp.thermal.matter.materials import materials
from thermograsp.thermal.matter.sensors import sensor
from thermograsp.thermal.network.choice import FIRST, UnkeptToleranceError, choose
from thermograsp.thermal.network.states import Orders
from thermograsp.thermal.network.system import sample_geometry
from thermograsp.thermal.plates.samples import Geometry
from thermograsp.thermal.rungs import semi_analytic
from thermograsp.thermal.rungs.network import solve
from thermograsp.thermal.rungs.problem import PressProblem


def geometry(name: str = "glass", mode: str = "T", fingertips: int = 1) -> Geometry:
    return Geometry(sensor("seed"), materials()[name], mode, 8.1e-5, "square", (0.04, 0.04, 0.01), fingertips)  # pyright: ignore[reportArgumentType]


@pytest.mark.parametrize("mode", ["T", "O"])
def test_stricter_demands_cost_more(mode: str) -> None:
    samples = sample_geometry(geometry(mode=mode))
    choices = [choose(samples, Demand(tolerance, 12.0, (1e3, 1e4), 10.0)) for tolerance in (1.0, 0.1, 0.01)]
    costs = [choice.system.orders.multiply_adds for choice in choices]
    assert costs == sorted(costs) and costs[0] < costs[-1]
    assert all(choice.error <= tolerance for choice, tolerance in zip(choices, (1.0, 0.1, 0.01), strict=True))


@pytest.mark.parametrize("air", [0.0, 10.0])
def test_impossible_demand_says_what_is_possible(air: float) -> None:
    """In words that help whoever has no choice of rungs, as users of environments."""
    demand = Demand(1e-9, 12.0, (1e4,), 10.0)
    with pytest.raises(InvalidValueError, match="no network keeps 1e-09 K") as refused:
        network_for(geometry(), demand, air=air, cache=False)
    assert "rung" not in str(refused.value)
    (least,) = re.findall(r"give a tolerance of ([\d.e-]+) K or more", str(refused.value))
    kept = network_for(geometry(), replace(demand, tolerance=float(least)), air=air, cache=False)
    assert kept.error <= float(least)


def refuse(asked: float, kept: float) -> None:
    raise UnkeptToleranceError(asked, kept)


def test_a_refusal_goes_between_processes_and_stays_the_same() -> None:
    refusal = UnkeptToleranceError(1e-9, 3.21e-4)
    with ProcessPoolExecutor(1, get_context("spawn")) as processes:
        raised = processes.submit(refuse, refusal.asked, refusal.kept).exception()
    for same in (copy.copy(refusal), copy.deepcopy(refusal), pickle.loads(pickle.dumps(refusal)), raised):
        assert isinstance(same, UnkeptToleranceError)
        assert (same.asked, same.kept, str(same)) == (1e-9, 3.21e-4, str(refusal))


T = np.arange(201) * FIRST
LATE = np.unique(np.geomspace(1, 200, 30).astype(int))


@cache
def exact(problem: PressProblem) -> np.ndarray:
    return semi_analytic.solve(problem, T[LATE]).temperature_drop


@pytest.mark.parametrize("fingertips", [1, 2])
@pytest.mark.parametrize("seed", [0, *(pytest.param(seed, marks=pytest.mark.slow) for seed in (1, 2, 3))])
def test_random_scenes_keep_the_tolerance(seed: int, fingertips: int) -> None:
    """Against the solution without a grid, which shares neither kernels nor states with the networks. A second
    fingertip that stays apart changes nothing."""
    rng = np.random.default_rng(seed)
    stack, names = sensor("seed"), sorted(materials())
    problem = PressProblem(
        stack,
        materials()[names[rng.integers(len(names))]],
        "T" if seed % 2 else "O",
        float(10 ** rng.uniform(2, 5)),
        float(rng.uniform(0.2, 1)) * stack.face_area,
        "square" if rng.random() < 0.5 else "round",
        (0.03, 0.03, float(rng.uniform(0.002, 0.03))),
        0.0,
        36.0,
        24.0,
    )
    body = Geometry(
        stack,
        problem.material,
        problem.mode,
        problem.area,
        problem.shape,
        problem.object_size,
        2 if fingertips == 2 else 1,
    )
    tolerance = float(10 ** rng.uniform(-2.2, 0))
    assert not callable(problem.conductance)
    choice = choose(sample_geometry(body), Demand(tolerance, 12.0, (problem.conductance,), 10.0))
    found = solve(problem, T, choice.system).temperature_drop[LATE]
    assert np.max(np.abs(found - exact(problem))) <= tolerance


def test_orders_read_as_they_print() -> None:
    for text in ("2/10/12", "1/0/4", "3/8/10/9"):
        assert str(Orders.parse(text)) == text
    for text in ("", "2", "2/3", "a/b/c", "1/2/3/4/5", "-1/2/3"):
        with pytest.raises(InvalidValueError, match="orders must read"):
            Orders.parse(text)
    # twice the states cost at least 1.5 times as much, and more modes more
    assert Orders(2, 20, 24).multiply_adds > 1.5 * Orders(2, 10, 12).multiply_adds
    assert Orders(3, 10, 12).multiply_adds > Orders(2, 10, 12).multiply_adds
