"""The semi-analytic rung against the reference table, one-dimensional limits and the inversion one time at a time."""

import json
from pathlib import Path

import numpy as np
import pytest

from thermograsp.errors import InvalidValueError
from thermograsp.thermal import press
from thermograsp.thermal.matter.materials import material
from thermograsp.thermal.matter.mounting import Mode, Shape
from thermograsp.thermal.matter.sensors import sensor
from thermograsp.thermal.numerics.laplace import invert, invert_many
from thermograsp.thermal.rungs import layered, semi_analytic
from thermograsp.thermal.rungs.problem import Conductance, PressProblem

REFERENCE = json.loads((Path(__file__).parents[2] / "data" / "press_3d.json").read_text(encoding="utf-8"))[
    "cases"
]
FIELDS = ("temperature_drop", "heat_flow", "sensor_surface", "object_surface", "stored_heat")
SEED = sensor("seed")


def problem(
    name: str = "glass",
    mode: Mode = "T",
    conductance: Conductance = 1e4,
    area: float = 81e-6,
    shape: Shape = "square",
    size: tuple[float, float, float] = (0.04, 0.04, 0.01),
    air: float = 0.0,
) -> PressProblem:
    return PressProblem(SEED, material(name), mode, conductance, area, shape, size, air, 36.0, 24.0)


@pytest.mark.parametrize("case", REFERENCE)
def test_reference_table(case: str) -> None:
    """Made with strips of constant flux, good to .001 K (.002 K in O mode)."""
    name, conductance, mode = case.split("/")
    assert mode in ("T", "O")
    times = np.array(REFERENCE[case]["t"], float)
    curves = semi_analytic.solve(problem(name, mode, float(conductance)), times)
    np.testing.assert_allclose(curves.temperature_drop, REFERENCE[case]["Td"], atol=0.0015)


@pytest.mark.parametrize("mode", ["T", "O"])
@pytest.mark.parametrize("shape", ["square", "round"])
def test_one_dimensional_where_patch_and_plate_are_the_face(mode: Mode, shape: Shape) -> None:
    t = np.array([0.0, 0.01, 0.3, 4.0, 50.0])
    case = problem("glass", mode, 3e4, shape=shape, size=(0.009, 0.009, 0.02))
    one, three = layered.solve(case, t), semi_analytic.solve(case, t)
    for name in FIELDS:
        np.testing.assert_allclose(getattr(three, name), getattr(one, name), atol=2e-6, err_msg=name)


@pytest.mark.parametrize("mode", ["T", pytest.param("O", marks=pytest.mark.slow)])
def test_heat_that_passes_is_stored(mode: Mode) -> None:
    """Into the object and, in O mode, the element; the thermostat feeds a T-mode element from behind."""
    t = np.linspace(0, 20, 4001)[1:]
    curves = semi_analytic.solve(problem("marble", mode, 5e3, 4e-5), t)
    gained = curves.stored_heat[:, 1] if mode == "T" else curves.stored_heat.sum(axis=1)
    passed = np.cumsum((curves.heat_flow[1:] + curves.heat_flow[:-1]) / 2 * np.diff(t))
    late = t[1:] > 1  # the trapezoidal rule needs some distance from the touch
    start = np.argmax(late)
    np.testing.assert_allclose(
        (gained[1:] - gained[1:][start])[late], (passed - passed[start])[late], atol=1e-5 * passed[-1]
    )


def test_contact_of_constant_conductance() -> None:
    t = np.geomspace(0.01, 30, 9)
    curves = semi_analytic.solve(problem(area=4e-5), t)
    expected = 1e4 * 4e-5 * (curves.sensor_surface - curves.object_surface)
    np.testing.assert_allclose(curves.heat_flow, expected, rtol=1e-7)


def test_any_order_of_times_and_one_contour_for_many() -> None:
    rng = np.random.default_rng(0)
    t = np.exp(rng.uniform(np.log(0.01), np.log(60), 40))
    many = semi_analytic.solve(problem(), t).temperature_drop
    few = semi_analytic.solve(problem(), t[:3]).temperature_drop
    np.testing.assert_allclose(many[:3], few, atol=1e-6)


def test_windowed_inversion() -> None:
    """A relaxation over five decades of time, and a half-space, against closed form and the inversion time by time."""
    t = np.geomspace(1e-3, 1e2, 200)
    for transform, exact in (
        (lambda s: 1 / s - 1 / (s + 3), lambda t: 1 - np.exp(-3 * t)),
        (lambda s: s**-1.5, lambda t: 2 * np.sqrt(t / np.pi)),
    ):
        many = invert_many(transform, t)
        assert np.max(np.abs(many - exact(t)) / exact(10 * t)) < 2e-7
        assert np.max(np.abs(many - invert(transform, t)) / exact(10 * t)) < 2e-7
    with pytest.raises(InvalidValueError, match="> 0"):
        invert_many(lambda s: 1 / s, np.array([1.0, 0.0]))


def test_limits_and_refusals() -> None:
    t = np.array([0.0, 1.0])
    assert not np.any(semi_analytic.solve(problem(conductance=0.0), t).temperature_drop)
    start = semi_analytic.solve(problem(), t)
    assert start.temperature_drop[0] == 0 and start.heat_flow[0] == pytest.approx(12 * 1e4 * 81e-6)
    with pytest.raises(InvalidValueError, match="adiabatic"):
        semi_analytic.solve(problem(air=10.0), t)
    with pytest.raises(InvalidValueError, match="function of time"):
        semi_analytic.solve(problem(conductance=lambda time: 1e4), t)
    assert press("glass", rung="semi_analytic", seconds=1.0, dt=0.1).rung.name == "semi_analytic"
