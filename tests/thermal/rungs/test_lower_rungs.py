"""The lower rungs against each other in the limits where two of them describe the same thing."""

from dataclasses import replace

import numpy as np
import pytest
from scipy.integrate import cumulative_simpson, solve_ivp

from thermograsp.errors import InvalidValueError
from thermograsp.thermal.matter import Layer, SensorStack, sensor
from thermograsp.thermal.matter.materials import Material
from thermograsp.thermal.rungs import (
    closed_form,
    grid_3d,
    half_space,
    layered,
    lumped,
)
from thermograsp.thermal.rungs.problem import PressProblem

GLASS = Material("glass", 1.0, 2500.0, 840.0)
METAL = Material("metal", 237.0, 2700.0, 897.0)
ONE_LAYER = SensorStack("one", (Layer("telluride", 3e-3, 1.6, 7740.0, 154.4),), 9e-3, 0, 1e-3)
SEED = sensor("seed")
RUNGS = {"closed_form": closed_form, "half_space": half_space, "layered": layered, "lumped": lumped}
PERFECT = 1e12


def press(**changes: object) -> PressProblem:
    problem = PressProblem(
        stack=SEED,
        material=GLASS,
        mode="T",
        conductance=1e4,
        area=81e-6,
        shape="square",
        object_size=(0.04, 0.04, 0.01),
        air=0.0,
        sensor_temperature=36.0,
        object_temperature=24.0,
    )
    return replace(problem, **changes)  # pyright: ignore[reportArgumentType]


@pytest.mark.parametrize("mode", ["T", "O"])
@pytest.mark.parametrize("material", [GLASS, METAL])
def test_layered_becomes_the_closed_form(mode: str, material: Material) -> None:
    """One layer, perfect contact, thick object: the rungs share nothing but the inversion, the closed form's early part
    not even that."""
    t = np.geomspace(0.05, 100, 20)
    problem = press(
        stack=ONE_LAYER, mode=mode, material=material, conductance=PERFECT, object_size=(0.04, 0.04, 5.0)
    )
    exact, layers = closed_form.solve(problem, t), layered.solve(problem, t)
    for name in ("temperature_drop", "heat_flow", "sensor_surface", "object_surface", "stored_heat"):
        np.testing.assert_allclose(
            getattr(layers, name), getattr(exact, name), rtol=1e-6, atol=1e-7, err_msg=name
        )


@pytest.mark.parametrize("mode", ["T", "O"])
def test_layered_becomes_two_half_spaces_early(mode: str) -> None:
    """One layer: diffusion takes L^2/alpha = 6.7 s to cross it, so 0.05 s is early on both far sides."""
    t = np.linspace(0, 0.05, 11)
    problem = press(stack=ONE_LAYER, mode=mode, conductance=3e3)
    early, layers = half_space.solve(problem, t), layered.solve(problem, t)
    for name in ("temperature_drop", "heat_flow", "sensor_surface", "object_surface", "stored_heat"):
        np.testing.assert_allclose(
            getattr(layers, name), getattr(early, name), rtol=1e-9, atol=1e-11, err_msg=name
        )


@pytest.mark.parametrize("mode", ["T", "O"])
def test_layered_becomes_lumped_late(mode: str) -> None:
    """A heavy slice of metal under the patch: once the element has settled, its flow follows the resistances with an
    error of the order (element's capacity / object's), which falls with the object's size."""
    errors = []
    for thickness in (0.05, 0.2):
        problem = press(
            material=Material("ideal", 1e6, 2700.0, 897.0), mode=mode, object_size=(9e-3, 9e-3, thickness)
        )
        t = np.linspace(0, 60, 601)
        one, many = lumped.solve(problem, t), layered.solve(problem, t)
        errors.append(
            np.max(np.abs(one.temperature_drop - many.temperature_drop)[300:]) / one.temperature_drop[300]
        )
    assert errors[0] < 0.05
    assert errors[1] < errors[0] / 3


@pytest.mark.parametrize("mode", ["T", "O"])
def test_layered_keeps_the_books(mode: str) -> None:
    """What flows through the contact is stored; in O mode it feeds element and object, in T the object only."""
    root = np.linspace(0, np.sqrt(20), 4001)  # the flow is smooth in the root of time
    curves = layered.solve(press(mode=mode), root**2)
    flowed = cumulative_simpson(curves.heat_flow * 2 * root, x=root, initial=0)
    stored = curves.stored_heat[:, 1] if mode == "T" else curves.stored_heat.sum(axis=1)
    np.testing.assert_allclose(stored, flowed, atol=1e-9)


def test_layered_t_mode_books_at_the_thermostat() -> None:
    """The element, cooled from the thermostat's temperature, ends at the mean of its linear profile."""
    problem = press(stack=ONE_LAYER, material=Material("sink", 1e5, 1e4, 1e4), object_size=(0.04, 0.04, 5.0))
    curves = layered.solve(problem, np.array([200.0]))
    mean_fall = (36.0 - curves.sensor_surface[0]) / 2
    assert curves.stored_heat[0, 0] == pytest.approx(-ONE_LAYER.heat_capacity * mean_fall, rel=1e-3)


@pytest.mark.parametrize("mode", ["T", "O"])
def test_layered_agrees_with_finite_volumes_to_second_order(mode: str) -> None:
    """An independent method of lines on the same column; its error must fall as the mesh squared."""
    problem, t = press(mode=mode), np.array([0.5, 2.0, 6.0])
    exact = layered.solve(problem, t).temperature_drop
    errors = [np.max(np.abs(_finite_volumes(problem, t, n) - exact)) for n in (8, 16, 32)]
    rate = np.polyfit(np.log([1 / 8, 1 / 16, 1 / 32]), np.log(errors), 1)[0]
    assert abs(rate - 2) < 0.1
    assert errors[-1] < 0.01


def _finite_volumes(problem: PressProblem, t: np.ndarray, cells: int) -> np.ndarray:
    """Temperature drop (n,) K, `cells` in each layer and ten times as many in the object."""
    slabs = [(x.thickness, x.conductivity, x.volumetric_heat_capacity, cells) for x in problem.stack.layers]
    body = problem.material
    slabs.append((problem.object_size[2], body.conductivity, body.volumetric_heat_capacity, 10 * cells))
    assert isinstance(problem.conductance, float)
    half = np.concatenate([np.full(n, d / n / k / 2) for d, k, _, n in slabs])
    capacity = np.concatenate([np.full(n, d / n * c) for d, _, c, n in slabs])
    link = half[:-1] + half[1:]
    element = 3 * cells
    first = half[0] + (1 / problem.conductance if problem.mode == "O" else 0)
    if problem.mode == "T":
        link[element - 1] += 1 / problem.conductance
    start = np.full(len(half), 24.0)
    if problem.mode == "T":
        start[:element] = 36.0

    def rate(_: float, u: np.ndarray) -> np.ndarray:
        flux = np.concatenate(([(36.0 - u[0]) / first], (u[:-1] - u[1:]) / link, [0.0]))
        return -np.diff(flux) / capacity

    u = solve_ivp(rate, (0, t[-1]), start, "LSODA", t, rtol=1e-8, atol=1e-9, lband=1, uband=1).y
    a, b = cells, 2 * cells
    top = u[a] + half[a] * (u[a - 1] - u[a]) / (half[a - 1] + half[a])
    bottom = u[b - 1] - half[b - 1] * (u[b - 1] - u[b]) / (half[b - 1] + half[b])
    return top - bottom


def test_lumped_is_exact_for_constant_conductance_and_air() -> None:
    t = np.array([0.0, 1.0, 10.0, 300.0])
    problem = press(material=METAL, air=20.0)
    curves = lumped.solve(problem, t)
    resistance = (2 * 0.7e-3 / 25 + 1.6e-3 / 1.6 + 1e-4) / 81e-6
    capacity = 2700.0 * 897.0 * 1.6e-5
    loss = 20.0 * (2 * 1.6e-3 + 4 * 4e-4 - 81e-6)
    final = 12 / resistance / (1 / resistance + loss)
    rise = final * -np.expm1(-(1 / resistance + loss) / capacity * t)
    np.testing.assert_allclose(curves.stored_heat[:, 1], capacity * rise, rtol=1e-12)
    np.testing.assert_allclose(curves.heat_flow, (12 - rise) / resistance, rtol=1e-12)
    np.testing.assert_allclose(curves.object_surface, 24 + rise, rtol=1e-12)
    assert np.isnan(curves.stored_heat[:, 0]).all()


def test_lumped_follows_a_conductance_in_time_to_second_order() -> None:
    def conductance(t: float) -> float:
        return 2e3 * (1 + np.sin(t)) + 1

    problem = press(material=METAL, conductance=conductance, object_size=(0.012, 0.012, 0.004))
    exact = lumped.solve(problem, np.linspace(0, 10, 5121)).stored_heat[-1, 1]
    errors = [
        abs(lumped.solve(problem, np.linspace(0, 10, n + 1)).stored_heat[-1, 1] - exact) for n in (10, 20, 40)
    ]
    assert abs(np.polyfit(np.log([10, 20, 40]), np.log(errors), 1)[0] + 2) < 0.1


def test_lumped_apart_and_together_again() -> None:
    problem = press(material=METAL, conductance=lambda t: 0.0 if 1 <= t < 2 else 1e4)
    curves = lumped.solve(problem, np.linspace(0, 3, 301))
    assert (curves.heat_flow[100:200] == 0).all()
    assert (np.diff(curves.stored_heat[100:200, 1]) == 0).all()
    assert (curves.heat_flow[200:] > 0).all()


def test_biot_number_separates_metal_from_wood() -> None:
    small = (0.012, 0.012, 0.004)
    assert lumped.biot(press(material=METAL, object_size=small)) < 0.1
    assert lumped.biot(press(material=Material("wood", 0.15, 600.0, 1700.0), object_size=small)) > 0.1
    assert lumped.biot(press(conductance=0.0)) == 0


def test_half_space_contact_temperature() -> None:
    """Perfect contact: (b_S T_S + b_M T_M)/(b_S + b_M), at once and for good."""
    curves = half_space.solve(press(stack=ONE_LAYER, conductance=PERFECT), np.array([0.01, 1.0]))
    b_s, b_m = np.sqrt(1.6 * 7740.0 * 154.4), GLASS.effusivity
    expected = (b_s * 36 + b_m * 24) / (b_s + b_m)
    np.testing.assert_allclose(curves.sensor_surface, expected, rtol=1e-6)
    np.testing.assert_allclose(curves.object_surface, expected, rtol=1e-6)


@pytest.mark.parametrize("rung", ["layered", "half_space", "lumped"])
@pytest.mark.parametrize("mode", ["T", "O"])
def test_apart_nothing_flows(rung: str, mode: str) -> None:
    curves = RUNGS[rung].solve(press(conductance=0.0, mode=mode), np.linspace(0, 5, 6))
    assert (curves.temperature_drop == 0).all() and (curves.heat_flow == 0).all()
    assert (curves.sensor_surface == 36).all() and (curves.object_surface == 24).all()
    assert np.nanmax(np.abs(curves.stored_heat)) == 0


@pytest.mark.parametrize("rung", RUNGS)
@pytest.mark.parametrize("mode", ["T", "O"])
def test_linear_in_the_temperatures_and_consistent_at_the_contact(rung: str, mode: str) -> None:
    t = np.linspace(0, 5, 51)
    problem = press(mode=mode, area=50e-6)
    a = RUNGS[rung].solve(problem, t)
    b = RUNGS[rung].solve(replace(problem, sensor_temperature=24.0, object_temperature=36.0), t)
    np.testing.assert_allclose(a.temperature_drop, -b.temperature_drop, atol=1e-12)
    if rung != "closed_form":
        gap = a.sensor_surface - a.object_surface
        np.testing.assert_allclose(a.heat_flow, 1e4 * 50e-6 * gap, atol=1e-9)


@pytest.mark.parametrize("rung", ["closed_form", "half_space", "layered"])
def test_refusals_give_the_reason(rung: str) -> None:
    solve = RUNGS[rung].solve
    with pytest.raises(InvalidValueError, match=f"'{rung}'.*function of time"):
        solve(press(conductance=lambda t: 1e4), np.array([1.0]))
    with pytest.raises(InvalidValueError, match=f"'{rung}'.*air = 5"):
        solve(press(air=5.0), np.array([1.0]))


@pytest.mark.parametrize("rung", RUNGS)
def test_refuses_negative_times(rung: str) -> None:
    with pytest.raises(InvalidValueError, match="sample times"):
        RUNGS[rung].solve(press(), np.array([-1.0, 1.0]))


def test_lumped_refuses_what_it_cannot_march_through() -> None:
    with pytest.raises(InvalidValueError, match="increase"):
        lumped.solve(press(), np.array([1.0, 0.5]))
    with pytest.raises(InvalidValueError, match="conductance at t = .* got -5"):
        lumped.solve(press(conductance=lambda t: -5.0), np.array([1.0]))


def test_closed_form_refuses_no_contact() -> None:
    with pytest.raises(InvalidValueError, match="perfect"):
        closed_form.solve(press(conductance=0.0), np.array([1.0]))


@pytest.mark.parametrize("mode", ["T", "O"])
@pytest.mark.parametrize("material", [GLASS, METAL])
def test_half_space_is_of_the_right_size_for_the_layered_seed_early(mode: str, material: Material) -> None:
    """Its layers differ fivefold in diffusivity, so one homogeneous half-space is a rough picture: within a factor of
    two from 20 to 500 ms."""
    t = np.geomspace(0.02, 0.5, 8)
    problem = press(mode=mode, material=material)
    ratio = half_space.solve(problem, t).temperature_drop / layered.solve(problem, t).temperature_drop
    assert ratio.min() > 0.5 and ratio.max() < 2


@pytest.mark.slow
@pytest.mark.parametrize("mode", ["T", "O"])
def test_one_dimension_is_all_there_is_in_an_object_as_wide_as_the_sensor(mode: str) -> None:
    """Against the three-dimensional grid, which has nowhere to spread here: within its mesh error."""
    t = np.linspace(0, 4, 41)
    problem = press(mode=mode, object_size=(9e-3, 9e-3, 0.01))
    exact = layered.solve(problem, t)
    grid = grid_3d.solve(problem, t)
    np.testing.assert_allclose(grid.temperature_drop, exact.temperature_drop, atol=0.02)
