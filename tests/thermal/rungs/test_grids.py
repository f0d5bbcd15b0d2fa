"""The finite-volume rungs: convergence, energy, exact solutions, and the semi-analytic reference."""

from __future__ import annotations

import json
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from scipy import sparse
from scipy.special import j0, jn_zeros

from thermograsp.errors import InvalidValueError
from thermograsp.thermal.matter import Layer, SensorStack, sensor
from thermograsp.thermal.matter.materials import Material, material
from thermograsp.thermal.numerics.finite_volume import (
    Body,
    graded_cells,
    radial_axis,
    single_cell,
    symmetric_axis,
)
from thermograsp.thermal.numerics.grid_contact import (
    OBJECT,
    SENSOR,
    Stage,
    rates,
)
from thermograsp.thermal.rungs import grid_3d, grid_axisymmetric
from thermograsp.thermal.rungs.grid import March
from thermograsp.thermal.rungs.problem import PressProblem

GLASS = Material("glass", conductivity=1.0, density=2500.0, specific_heat=840.0)
STEEL = Material("steel", conductivity=16.2, density=8000.0, specific_heat=500.0)
REFERENCE = json.loads((Path(__file__).parents[2] / "data" / "press_3d.json").read_text(encoding="utf-8"))[
    "cases"
]


def press(**changes) -> PressProblem:
    fields = {
        "stack": sensor("seed"),
        "material": GLASS,
        "mode": "T",
        "conductance": 1e4,
        "area": 81e-6,
        "shape": "square",
        "object_size": (0.04, 0.04, 0.01),
        "air": 0.0,
        "sensor_temperature": 36.0,
        "object_temperature": 24.0,
    }
    return PressProblem(**(fields | changes))


def orders(errors: list[float]) -> np.ndarray:
    """Observed orders between levels that halve the step."""
    return np.log2(np.array(errors[:-1]) / np.array(errors[1:]))


def test_graded_cells_hold_the_breaks_and_refine_in_place():
    breaks = [0.0, 1e-3, 4.5e-3, 20e-3]
    coarse = graded_cells(breaks, {4.5e-3: 1e-5}, 0.3, np.inf)
    fine = graded_cells(breaks, {4.5e-3: 1e-5}, 0.3, np.inf, resolution=3)
    assert np.all(np.diff(coarse) > 0)
    for x in breaks:
        assert np.abs(coarse - x).min() < 1e-15
    assert np.allclose(fine[::3], coarse, rtol=0, atol=1e-15)
    widths = np.diff(coarse)
    assert widths.min() == pytest.approx(1e-5, rel=0.3)
    assert np.max(widths[1:] / widths[:-1]) < 1.6


@pytest.mark.parametrize("geometry", ["plate", "disc"])
def test_second_order_in_space_on_a_smooth_mode(geometry):
    """A cosine or Bessel mode of a plate, an exact eigenfunction: L2 error of the conduction operator's solve."""
    side, depth, step = 0.02, 0.01, 5.0
    alpha = GLASS.diffusivity
    errors = []
    for cells in (8, 16, 32, 64):
        u = np.linspace(0, 1, cells + 1)
        edges = side * (u + 0.1 * np.sin(np.pi * u))  # unequal cells, smoothly so
        deep = depth * (u + 0.1 * np.sin(np.pi * u))
        x, z = (edges[1:] + edges[:-1]) / 2, (deep[1:] + deep[:-1]) / 2
        if geometry == "plate":
            axes = symmetric_axis(edges), symmetric_axis(edges)
            lateral = np.outer(np.cos(np.pi * x / side), np.cos(2 * np.pi * x / side))
            wave2 = 5 * (np.pi / side) ** 2
        else:
            root = jn_zeros(1, 1)[0]
            axes = radial_axis(edges), single_cell()
            lateral = j0(root * x / side)[:, None]
            wave2 = (root / side) ** 2
        body = Body(
            *axes,
            edges=deep,
            conductivity=np.full(cells, GLASS.conductivity),
            heat_capacity=np.full(cells, GLASS.volumetric_heat_capacity),
        )
        wave2 += (np.pi / depth) ** 2
        mode = np.cos(np.pi * z / depth)[:, None, None] * lateral
        solver = body.factor(step)
        solution = solver.backward(solver.eliminate(solver.forward(body.capacity * mode)))
        error = solution * (1 + step * alpha * wave2) - mode
        errors.append(np.sqrt(np.sum(body.capacity * error**2) / np.sum(body.capacity * mode**2)))
    assert np.all(np.abs(orders(errors)[1:] - 2) < 0.1), errors


def test_separated_solve_equals_the_assembled_sparse_operator():
    """The same finite volumes as Kronecker products in scipy.sparse, films and covered cells included."""
    problem = press(area=30e-6, object_size=(0.03, 0.02, 0.004), air=15.0)
    body = grid_3d.grid(problem, resolution=1).bodies[OBJECT]
    rng = np.random.default_rng(1)
    state = rng.normal(size=body.capacity.shape)

    def line(axis):
        links = sparse.diags_array(axis.links)
        difference = sparse.csr_array(np.diff(np.eye(len(axis.volumes)), axis=0))
        end = np.zeros(len(axis.volumes))
        end[-1] = axis.end
        return difference.T @ links @ difference + sparse.diags_array(end)

    volumes = [sparse.diags_array(axis.volumes) for axis in (body.first, body.second)]
    thickness = np.diff(body.edges)
    half = thickness / 2 / body.conductivity
    difference = sparse.csr_array(np.diff(np.eye(len(half)), axis=0))
    deep = difference.T @ sparse.diags_array(1 / (half[:-1] + half[1:])) @ difference
    layer = sparse.diags_array(body.conductivity * thickness)
    films = np.zeros(body.capacity.shape)
    films[0] = body.area / (1 / 15 + half[0])
    films[0, : body.shielded[0], : body.shielded[1]] = 0.0
    films[-1] += body.area / (1 / 15 + half[-1])
    operator = (
        sparse.kron(deep, sparse.kron(*volumes))
        + sparse.kron(layer, sparse.kron(line(body.first), volumes[1]))
        + sparse.kron(layer, sparse.kron(volumes[0], line(body.second)))
        + sparse.diags_array(films.ravel())
    )
    heat, _ = body.conduct(state, (0.0, 0.0))
    expected = -(operator @ state.ravel()).reshape(state.shape)
    assert np.abs(heat - expected).max() < 1e-12 * np.abs(expected).max()


@pytest.mark.parametrize("mode", ["T", "O"])
@pytest.mark.parametrize("air", [0.0, 25.0])
@pytest.mark.parametrize("conductance", [0.0, 1e4, 1e9])
def test_an_implicit_stage_solves_its_equation(mode, air, conductance):
    """capacity (u - before) = step * rates(u), whatever touches, also with a contact smaller than the face."""
    grid = grid_3d.grid(press(mode=mode, area=40e-6, air=air, object_size=(0.03, 0.02, 0.005)), 1)
    rng = np.random.default_rng(2)
    before = [rng.normal(size=body.capacity.shape) for body in grid.bodies]
    heat = [body.capacity * u for body, u in zip(grid.bodies, before, strict=True)]
    step = 0.01
    after = Stage(grid, step).solve(heat, conductance)
    flows, _ = rates(grid, after, conductance)
    for body, was, now, flow in zip(grid.bodies, before, after, flows, strict=True):
        assert (
            np.abs(now - was - step * flow / body.capacity).max()
            < 1e-8 * np.abs(step * flow / body.capacity).max()
        )


@pytest.mark.parametrize("module", [grid_3d, grid_axisymmetric])
@pytest.mark.parametrize("mode", ["T", "O"])
def test_heat_is_balanced_to_round_off(module, mode):
    """Random conductances with 0 and 1e9 and random steps: what a body gains has come through its surfaces."""
    rng = np.random.default_rng(3)
    grid = module.grid(press(mode=mode, area=50e-6, air=20.0, object_size=(0.02, 0.03, 0.006)), resolution=1)
    value = [0.0]
    march = March(grid, lambda _: value[0])
    start = [np.sum(body.capacity * u) for body, u in zip(grid.bodies, march.state, strict=True)]
    scale = 0.0
    for _ in range(25 if module is grid_axisymmetric else 4):
        value[0] = rng.choice([0.0, 10 ** rng.uniform(1, 6), 1e9])
        march.advance(float(rng.choice([1e-5, 1e-3, 0.1, 10.0])))
        gained = [np.sum(b.capacity * u) - s for b, u, s in zip(grid.bodies, march.state, start, strict=True)]
        balance = march.balance
        scale = max(scale, abs(gained[SENSOR]), abs(gained[OBJECT]), abs(balance.thermostat))
        assert sum(gained) == pytest.approx(balance.thermostat + balance.air, abs=1e-10 * max(scale, 1e-3))
        if mode == "T":
            assert gained[OBJECT] == pytest.approx(
                balance.contact + balance.air, abs=1e-10 * max(scale, 1e-3)
            )
        assert all(np.abs(u).max() < 30 for u in march.state)


def test_second_order_in_time():
    """Equal steps from the touch on, against steps eight times shorter than the shortest."""
    grid = grid_axisymmetric.grid(press(shape="round", conductance=2e3), resolution=1)

    def drop(steps: int) -> np.ndarray:
        march = March(grid, lambda _: 2e3)
        for _ in range(steps):
            march.advance(2.0 / steps)
        return march.state[SENSOR][:, 0, 0]

    exact = drop(640)
    errors = [float(np.abs(drop(n) - exact).max()) for n in (20, 40, 80)]
    assert np.all(np.abs(orders(errors) - 2) < 0.1), errors


def _inverse(transform, t: np.ndarray, nodes: int = 24) -> np.ndarray:
    """Fixed Talbot inversion (Abate & Valko 2004)."""
    theta = np.arange(1, nodes) * np.pi / nodes
    values = []
    for time in t:
        r = 2 * nodes / (5 * time)
        s = r * theta * (1 / np.tan(theta) + 1j)
        slope = 1 + 1j * (theta + (theta / np.tan(theta) - 1) / np.tan(theta))
        total = 0.5 * np.exp(r * time) * transform(np.array([r + 0j]))[0].real
        values.append(r / nodes * (total + np.sum((np.exp(time * s) * transform(s) * slope).real)))
    return np.array(values)


def exact_1d(problem: PressProblem, t: np.ndarray) -> np.ndarray:
    """Temperature drop where the plate is as wide as the sensor: layers in series by transfer matrices."""
    plate, difference, conductance = problem.material, problem.temperature_difference, problem.conductance
    assert not callable(conductance)

    def matrix(s, thickness, conductivity, capacity):
        q = np.sqrt(s * capacity / conductivity)
        d = q * thickness
        return np.array(
            [[np.cosh(d), -np.sinh(d) / (conductivity * q)], [-conductivity * q * np.sinh(d), np.cosh(d)]]
        )

    def transform(s):
        """(temperature, flux) at a layer's bottom = matrix @ those at its top, deviations from each body's start."""
        q = np.sqrt(s / plate.diffusivity)
        admittance = plate.conductivity * q * np.tanh(q * problem.object_size[2])
        layers = [
            matrix(s, x.thickness, x.conductivity, x.volumetric_heat_capacity) for x in problem.stack.layers
        ]

        def down(vector, to):
            for layer in layers[:to]:
                vector = np.einsum("ijs,js->is", layer, vector)
            return vector

        n, sensed = len(layers), problem.stack.sensed
        if (
            problem.mode == "T"
        ):  # top deviation 0, unknown top flux f; bottom: flux = Y_object * object temperature
            unit = np.array([np.zeros_like(s), np.ones_like(s)])
            theta, flux = down(unit, n)
            # object = dT/s + theta f - flux f / h; flux f = admittance * object
            f = admittance * difference / s / (flux * (1 + admittance / conductance) - admittance * theta)
            ends = [down(unit, to)[0] * f for to in (sensed, sensed + 1)]
        else:  # f = h (dT/s - theta_top), bonded below
            cold, warm = (
                np.array(v) for v in ((np.zeros_like(s), np.ones_like(s)), (np.ones_like(s), 0 * s))
            )
            (tf, ff), (tt, ft) = down(cold, n), down(warm, n)
            impedance = (ff - admittance * tf) / (admittance * tt - ft)  # top temperature per top flux
            f = difference / s / (impedance + 1 / conductance)
            top = np.array([impedance * f, f])
            ends = [down(top, to)[0] for to in (sensed, sensed + 1)]
        return ends[0] - ends[1]

    return _inverse(transform, t)


@pytest.mark.parametrize("mode", ["T", "O"])
def test_one_dimensional_limit_is_the_exact_layered_solution(mode):
    problem = press(mode=mode, material=STEEL, object_size=(0.009, 0.009, 0.01))
    t = np.array([0.1, 0.5, 2.0])
    exact = exact_1d(problem, t)

    def error(module, resolution: int) -> float:
        return float(
            np.abs(module.solve(problem, t, resolution, 0.1 / resolution).temperature_drop - exact).max()
        )

    errors = [error(grid_axisymmetric, resolution) for resolution in (1, 2)]
    assert errors[0] < 0.02
    assert np.all(np.abs(orders(errors) - 2) < 0.1), errors
    assert error(grid_3d, 1) == pytest.approx(errors[0], rel=0.1)  # nearly the same cells in depth


def test_one_layer_sensor_senses_the_whole_element():
    stack = SensorStack("plain", (Layer("paste", 3e-3, 1.6, 5000.0, 400.0),), 9e-3, 0, 1e-3)
    t = np.array([0.2, 1.0, 4.0])
    for mode in ("T", "O"):
        problem = press(stack=stack, mode=mode, object_size=(0.009, 0.009, 0.01))
        drop = grid_axisymmetric.solve(problem, t).temperature_drop
        assert np.abs(drop - exact_1d(problem, t)).max() < 0.01


@pytest.mark.parametrize("case", sorted(REFERENCE))
def test_3d_agrees_with_the_reference_within_its_mesh_error(case):
    name, conductance, mode = case.split("/")
    t, reference = (np.array(REFERENCE[case][key]) for key in ("t", "Td"))
    problem = press(material=material(name), mode=mode, conductance=float(conductance))
    assert np.abs(grid_3d.solve(problem, t, resolution=1).temperature_drop - reference).max() < 0.021


@pytest.mark.slow
def test_3d_error_falls_with_the_mesh():
    t, reference = (np.array(REFERENCE["glass/10000/T"][key][:6]) for key in ("t", "Td"))
    errors = [np.abs(grid_3d.solve(press(), t, n).temperature_drop - reference).max() for n in (1, 2)]
    assert errors[1] < 0.004
    assert (
        3 < errors[0] / errors[1] < 6
    )  # four, as the edge is graded; the reference itself is good to .001 K


def test_disc_of_equal_area_is_near_the_square():
    """Steel, both at the same resolution: hundredths of a kelvin, not nothing."""
    t = np.array([0.1, 0.5, 2.0, 8.0])
    square = grid_3d.solve(press(material=STEEL), t, resolution=1).temperature_drop
    disc = grid_axisymmetric.solve(press(material=STEEL), t, resolution=1).temperature_drop
    assert 0.002 < np.abs(square - disc).max() < 0.05


def test_the_readings_agree_with_each_other():
    """Heat flow is conductance times the step of temperature across the contact, and its integral the stored heat."""
    t = np.concatenate(([0.0], np.geomspace(1e-3, 5, 400)))
    curves = grid_axisymmetric.solve(press(shape="round"), t, resolution=1)
    assert curves.heat_flow[0] == pytest.approx(1e4 * 81e-6 * 12)
    assert curves.temperature_drop[0] == 0.0
    gap = curves.sensor_surface - curves.object_surface
    assert np.allclose(curves.heat_flow, 1e4 * 81e-6 * gap, rtol=1e-6)
    passed = np.concatenate(
        ([0.0], np.cumsum(np.diff(t) * (curves.heat_flow[1:] + curves.heat_flow[:-1]) / 2))
    )
    assert np.allclose(curves.stored_heat[:, OBJECT], passed, rtol=1e-3, atol=1e-3)
    assert np.all(np.diff(curves.stored_heat[:, OBJECT]) > 0)


def test_a_conductance_that_is_constant_as_a_function_changes_nothing():
    t = np.linspace(0, 2, 21)
    number = grid_axisymmetric.solve(press(), t, resolution=1).temperature_drop
    function = grid_axisymmetric.solve(press(conductance=lambda time: 1e4), t, resolution=1).temperature_drop
    assert np.abs(number - function).max() < 3e-3


@pytest.mark.slow
def test_touch_release_touch_follows_the_jumps():
    """A release between samples and a touch at one, against steps so short that nothing can be missed."""

    def conductance(time: float) -> float:
        return 0.0 if 0.53 <= time < 1.0 else 1e5

    t = np.linspace(0, 2, 41)
    problem = press(material=STEEL, conductance=conductance)
    curves = grid_axisymmetric.solve(problem, t, resolution=1)
    fine = grid_axisymmetric.solve(problem, np.linspace(0, 2, 1001), resolution=1)
    assert np.abs(curves.temperature_drop - fine.temperature_drop[::25]).max() < 0.01
    released = (t > 0.531) & (t < 0.999)
    assert np.all(curves.heat_flow[released] == 0.0)


def test_apart_nothing_happens():
    curves = grid_3d.solve(press(conductance=0.0), np.array([0.0, 1.0, 10.0]), resolution=1)
    assert np.abs(curves.temperature_drop).max() < 1e-9
    assert np.all(curves.heat_flow == 0.0)
    assert np.abs(curves.object_surface - 24.0).max() < 1e-9


def test_bad_questions_are_refused():
    with pytest.raises(InvalidValueError, match="round"):
        grid_3d.solve(press(shape="round"), np.array([1.0]))
    with pytest.raises(InvalidValueError, match="increasing"):
        grid_3d.solve(press(), np.array([1.0, 0.5]))
    with pytest.raises(InvalidValueError, match="conductance at"):
        grid_axisymmetric.solve(press(conductance=lambda time: -1.0), np.array([0.1]))


def test_a_rectangular_plate_turned_is_the_same():
    t = np.array([0.5, 2.0])
    wide = press(object_size=(0.03, 0.012, 0.005), air=10.0)
    turned = replace(wide, object_size=(0.012, 0.03, 0.005))
    drops = [grid_3d.solve(p, t, resolution=1).temperature_drop for p in (wide, turned)]
    assert np.allclose(*drops, rtol=1e-9)
