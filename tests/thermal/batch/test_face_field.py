"""The temperature over a face, against a grid of its own and what must be so."""

import numpy as np
import pytest
from scipy import sparse
from scipy.sparse.linalg import splu

from thermograsp.errors import InvalidValueError
from thermograsp.thermal import Layer, material, sensor
from thermograsp.thermal.batch.face import (
    CELLS,
    COSINES,
    FaceState,
    cosine_means,
    face_field,
    face_means,
    face_state,
    step_face,
)

STACK, DT, DEPTH = sensor("seed"), 0.02, 0.01
CELL_MEANS = cosine_means(CELLS)


def field_of(name: str):
    body = material(name)
    return face_field(STACK, body.layer(DEPTH), DT)


def means(state: FaceState, rows: np.ndarray = CELL_MEANS, columns: np.ndarray = CELL_MEANS) -> np.ndarray:
    return face_means(CELL_MEANS, state.surface, state.contact, rows, columns)


def half_covered() -> np.ndarray:
    """W/(m2 K): columns of one half."""
    conductance = np.full((CELLS, CELLS), 1e4)
    conductance[:, : CELLS // 2] = 0.0
    return conductance


def by_grid(name: str, seconds: float, difference: float = 12.0):
    """A half-covered face as a problem of breadth and depth, both bodies as broad as the face: cell by cell in depth,
    backward Euler in fifths of a step. Flux (steps,) W/m2, and the face's columns (steps, CELLS) K."""
    body = material(name)
    layers = [(each.thickness, each.conductivity, each.volumetric_heat_capacity) for each in STACK.layers]
    below = [(DEPTH, body.conductivity, body.volumetric_heat_capacity)]
    fine = 5  # columns in a cell
    columns, width = CELLS * fine, STACK.width / CELLS / fine
    depths, k, c = [], [], []
    for thickness, conductivity, capacity in layers + below:
        count = 20 if thickness < 5e-3 else 60
        edges = np.linspace(0, 1, count + 1)
        if thickness > 5e-3:
            edges = edges**2  # fine at the contact
        depths += list(np.diff(edges) * thickness)
        k += [conductivity] * count
        c += [capacity] * count
    depths, k, c = np.array(depths), np.array(k), np.array(c)
    rows, contact = len(depths), 60  # the first row of the object
    down = 1 / (depths[:-1] / 2 / k[:-1] + depths[1:] / 2 / k[1:])
    number = np.arange(rows * columns).reshape(rows, columns)
    matrix = sparse.csr_matrix((number.size, number.size))
    load = np.zeros(number.size)
    resistance = depths[contact - 1] / 2 / k[contact - 1] + 1e-4 + depths[contact] / 2 / k[contact]

    def link(a: np.ndarray, b: np.ndarray, conductance: np.ndarray | float) -> None:
        nonlocal matrix
        values = np.broadcast_to(conductance, a.shape).ravel()
        a, b = a.ravel(), b.ravel()
        entries = (np.concatenate((values, values, -values, -values)),)
        places = np.concatenate((a, b, a, b)), np.concatenate((a, b, b, a))
        matrix = matrix + sparse.coo_matrix((*entries, places), shape=matrix.shape)

    for row in range(rows - 1):
        if row == contact - 1:
            half = slice(columns // 2, None)
            link(number[row, half], number[row + 1, half], width / resistance)
        else:
            link(number[row], number[row + 1], down[row] * width)
    link(number[:, :-1], number[:, 1:], (k * depths / width)[:, None])
    first = 2 * k[0] / depths[0] * width
    held = sparse.coo_matrix((np.full(columns, first), (number[0], number[0])), shape=matrix.shape)
    load[number[0]] = first * difference
    capacity = np.repeat(c * depths * width, columns)
    step = DT / 5
    solver = splu(sparse.csc_matrix(sparse.diags(capacity / step) + matrix + held))
    u = np.where(np.arange(number.size) < contact * columns, difference, 0.0)
    flux, faces = [], []
    jump = np.zeros(columns)
    for _ in range(round(seconds / DT)):
        total = 0.0
        for _ in range(5):
            u = solver.solve(capacity / step * u + load)
            half = slice(columns // 2, None)
            jump[half] = (u[number[contact - 1]] - u[number[contact]])[half] / resistance
            total += jump.mean() / 5
        flux.append(total)
        face = u[number[contact - 1]] - jump * depths[contact - 1] / 2 / k[contact - 1]
        faces.append(face.reshape(CELLS, fine).mean(axis=1))
    return np.array(flux), np.array(faces)


@pytest.mark.parametrize(
    "name",
    [
        pytest.param("aluminium", marks=pytest.mark.slow),
        "glass",
        pytest.param("cotton", marks=pytest.mark.slow),
    ],
)
def test_a_half_covered_face_is_that_of_a_grid(name: str) -> None:
    """The same bodies by other means."""
    field, state, conductance = field_of(name), face_state(), half_covered()
    flux, faces = by_grid(name, 2.0)
    found = []
    for each in flux:
        step_face(field, conductance, each, *state)
        found.append(means(state))
    found = np.array(found)
    assert np.ptp(found, axis=1).max() < 1e-9 * found.max()  # the same along the border
    expected = faces - faces[:, CELLS // 2 :].mean(axis=1)[:, None]
    late = slice(4, None)  # from 0.1 s on
    assert np.ptp(expected[-1]) > 0.1
    assert found[late, 0] == pytest.approx(expected[late], abs=0.02 * np.ptp(expected))


def test_evenly_touched_it_is_even_and_its_mean_over_the_contact_is_0() -> None:
    field, state = field_of("glass"), face_state()
    for flux in (4000.0, -300.0, 1e4):
        step_face(field, np.full((CELLS, CELLS), 2e3), flux, *state)
    assert np.abs(means(state)).max() < 1e-9
    rng = np.random.default_rng(3)
    spots = np.where(rng.random((CELLS, CELLS)) < 0.4, rng.uniform(10, 1e5, (CELLS, CELLS)), 0.0)
    step_face(field, spots, 5000.0, *state)
    above = means(state)
    assert np.ptp(above) > 0.1 and abs(above[spots > 0].mean()) < 1e-12
    parts = means(state, cosine_means(2), cosine_means(3))
    assert parts == pytest.approx(above.reshape(2, 9, 3, 6).mean(axis=(1, 3)), abs=1e-12)


def test_two_levels_where_half_is_touched_and_none_after_a_while_apart() -> None:
    field, state = field_of("aluminium"), face_state()
    for _ in range(100):
        step_face(field, half_covered(), 4000.0, *state)
    above = means(state)
    free, touched = above[:, : CELLS // 2], above[:, CELLS // 2 :]
    assert free.min() > touched.max() and free.mean() - touched.mean() > 1.5
    assert np.diff(above[0]).max() <= 1e-9  # cooler and cooler from the free side on
    for _ in range(1000):
        step_face(field, np.zeros((CELLS, CELLS)), 0.0, *state)
    assert np.abs(means(state)).max() < 1e-3


def test_it_is_as_symmetric_as_the_contact_and_linear_in_the_flow() -> None:
    rng = np.random.default_rng(4)
    conductance = np.where(rng.random((CELLS, CELLS)) < 0.5, 1e4, 0.0)
    found = []
    for each, factor in (
        (conductance, 1.0),
        (conductance.T, 1.0),
        (conductance[::-1], 1.0),
        (conductance, 3.0),
    ):
        field, state = field_of("glass"), face_state()
        for _ in range(20):
            step_face(field, np.ascontiguousarray(each), 2000.0 * factor, *state)
        found.append(means(state))
    plain, turned, mirrored, thrice = found
    assert turned.T == pytest.approx(plain, abs=1e-4)
    assert mirrored[::-1] == pytest.approx(plain, abs=1e-4)
    assert thrice == pytest.approx(3 * plain, abs=1e-4)


def test_steady_it_is_the_impedances_sum() -> None:
    """An infinite conductance over nothing but one cell hands it the whole flow: each cosine as it conducts at rest."""
    field, state = field_of("cotton"), face_state()
    conductance = np.zeros((CELLS, CELLS))
    conductance[4, 7] = 1e6
    for _ in range(2000):
        step_face(field, conductance, 1000.0, *state)
    flux = 1000.0 * CELL_MEANS[:, 4, None] * CELL_MEANS[:, 7]
    order = np.arange(COSINES)
    kappa = np.pi / STACK.width * np.hypot(order[:, None], order)
    kappa[0, 0], steady = 1.0, np.zeros_like(kappa)
    for layer in STACK.layers:  # from the thermostat
        t = np.tanh(kappa * layer.thickness)
        k = layer.conductivity * kappa
        steady = (steady + t / k) / (1 + steady * k * t)
    steady[0, 0] = 0.0  # the mean is the network's
    assert state.surface == pytest.approx(-steady * flux, rel=1e-6, abs=1e-9)


def test_a_step_that_is_none() -> None:
    with pytest.raises(InvalidValueError, match="dt"):
        face_field(STACK, Layer("plate", DEPTH, 1.0, 1e3, 2e3), 0.0)


@pytest.mark.parametrize("name", ["cotton", "glass", "copper"])
@pytest.mark.parametrize("highest", [1e2, 1e4, 1e7])
def test_the_cells_flux_is_the_coupled_problem_s(name: str, highest: float) -> None:
    """Against the dense matrix of all cells: flux over conductance plus what flux does, constant over what touches."""
    field, state = field_of(name), face_state()
    at_once = field.at_once.sum(axis=0)
    pairs = np.einsum("pi,qj->pqij", CELL_MEANS, CELL_MEANS).reshape(COSINES**2, -1)
    does = pairs.T @ (at_once.ravel()[:, None] * pairs) / CELLS**2
    rng = np.random.default_rng(5)
    for touching in (half_covered() > 0, rng.random((CELLS, CELLS)) < 0.5, rng.random((CELLS, CELLS)) < 0.02):
        conductance = np.where(touching, highest * 10 ** rng.uniform(-2, 0, touching.shape), 0.0)
        for part in state:
            part[:] = 0.0
        step_face(field, conductance, 1000.0, *state)
        on = touching.ravel()
        flux = np.zeros(on.size)
        flux[on] = np.linalg.solve(
            np.diag(1 / conductance.ravel()[on]) + does[np.ix_(on, on)], np.ones(on.sum())
        )
        flux *= 1000.0 / flux.mean()
        expected = -field.at_once[0] * (pairs @ flux).reshape(COSINES, COSINES) / CELLS**2
        assert state.surface == pytest.approx(expected, abs=1e-4 * np.abs(expected).max())


@pytest.mark.parametrize("dt", [1e-3, 0.02, 10.0])
def test_no_contact_blows_it_up(dt: float) -> None:
    """Contacts that change at random in every step: never beyond what the whole flow through one cell would do."""
    rng = np.random.default_rng(6)
    body = material("copper")
    field = face_field(STACK, body.layer(DEPTH), dt)
    spot, state = face_state(), face_state()
    one = np.zeros((CELLS, CELLS))
    one[0, 0] = 1e9
    for _ in range(30 if dt == 10.0 else 2000):
        step_face(field, one, 1000.0, *spot)
    most = np.ptp(means(spot))
    for _ in range(300):
        share, highest = rng.uniform(0.005, 1.0), 10 ** rng.uniform(0, 9)
        touching = rng.random((CELLS, CELLS)) < share
        conductance = np.where(touching, highest * rng.random(touching.shape), 0.0)
        step_face(field, conductance, 1000.0 * rng.uniform(-1, 1) * touching.any(), *state)
        assert np.ptp(means(state)) < most
