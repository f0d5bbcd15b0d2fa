"""Heat kernels of boxes and elements and the networks of fixed rates made of them."""

import json
from dataclasses import replace
from functools import lru_cache
from pathlib import Path

import numpy as np
import pytest
from scipy.linalg import block_diag, eigh_tridiagonal

from thermograsp.thermal import Geometry, SensorStack, ThermalNetwork, material, sensor
from thermograsp.thermal.kernels import (
    GRAM,
    MOMENTS,
    Detail,
    Footprint,
    Patches,
    Resolution,
    Spot,
    box_samples,
    box_side,
    contact_patterns,
    ports_told,
    tip,
    tip_at,
    touch_sides,
)
from thermograsp.thermal.kernels.axis import MODES, SWITCH, images, overlaps, wave_numbers
from thermograsp.thermal.kernels.element import element, element_samples
from thermograsp.thermal.kernels.patterns import JUMPS, NODES
from thermograsp.thermal.matter import Layer
from thermograsp.thermal.plates import sample_bodies, stack_impedance

SEED = sensor("seed")
WIDTH = SEED.width
FULL = ((0.0, WIDTH), (0.0, WIDTH))
PRESSES = json.loads((Path(__file__).parents[2] / "data" / "press_3d.json").read_text())["cases"]


def placed(face: list[int], centre: list[tuple[float, float]], half: list[tuple[float, float]]) -> Patches:
    return Patches(np.array(face), np.array(centre), np.array(half))


MIDDLE = placed([5], [(0.02, 0.02)], [(WIDTH / 2, WIDTH / 2)])


def drop(
    sides: tuple[ThermalNetwork, ThermalNetwork], patterns: int, conductance: float, times: np.ndarray
) -> np.ndarray:
    """(n,) K per K of difference after a touch, W/K of each pattern's contact, solved exactly."""
    box, element_side = sides
    rates = np.concatenate((box.rates, element_side.rates))
    ports = np.concatenate((box.ports, -element_side.ports))
    read_out = np.concatenate((np.zeros(len(box.rates)), element_side.outputs["drop"]))
    decay, turn = np.linalg.eigh(np.diag(rates) + conductance * ports @ ports.T)
    product = np.outer(times, np.maximum(decay, 1e-15))
    grown = -np.expm1(-product) / np.maximum(decay, 1e-15)
    return grown @ ((turn.T @ ports[:, 0]) * conductance * (turn.T @ read_out))


def axis_kernel(tau: float, length: float, film: float, late: bool) -> np.ndarray:
    """Between the patterns of a patch 0.1 .. 0.4 along the axis."""
    nodes = 0.25 + 0.15 * NODES
    if late:
        waves, found = wave_numbers(length, film), np.empty((len(JUMPS), MODES))
        overlaps(nodes, JUMPS, 1, length, waves, np.empty(MODES), found)
        return (found * np.exp(-(waves**2) * tau)) @ found.T
    table = np.empty((len(nodes), len(nodes)))
    images(nodes, 1, nodes, 1, True, length, film, tau, table)
    return JUMPS @ table @ JUMPS.T


def test_images_and_eigenfunctions_agree_where_they_change_over() -> None:
    early, late = (axis_kernel(SWITCH, 1.0, 0.0, late) for late in (False, True))
    np.testing.assert_allclose(early, late, rtol=1e-9)


def test_with_a_film_they_agree_to_what_two_ends_do_to_each_other() -> None:
    early, late = (axis_kernel(SWITCH, 1.0, 2.0, late) for late in (False, True))
    np.testing.assert_allclose(early, late, rtol=1e-3)


@lru_cache(maxsize=3)
def fine_grid(film: float) -> tuple[float, np.ndarray, np.ndarray]:
    """Length of its cells, and rates and fields of its slowest modes; all others have faded by exp(-20) at 1e-4."""
    cells = 3000
    step = 1 / cells
    diagonal = np.full(cells, 2 / step**2)
    diagonal[[0, -1]] = 1 / step**2 + film / (1 + film * step / 2) / step
    rates, fields = eigh_tridiagonal(
        diagonal, np.full(cells - 1, -1 / step**2), select="i", select_range=(0, 149)
    )
    return step, rates, fields


@pytest.mark.parametrize("tau", [1e-4, 2e-3, 0.2])
@pytest.mark.parametrize("film", [0.0, 3.0, 40.0])
def test_an_axis_is_a_fine_grid(film: float, tau: float) -> None:
    step, decay, fields = fine_grid(film)
    cells = len(fields)
    edges = np.arange(cells + 1) * step
    inside = np.diff(np.clip(edges, 0.1, 0.4))
    grid = (inside @ fields) ** 2 @ np.exp(-decay * tau) / step
    assert axis_kernel(tau, 1.0, film, tau > SWITCH)[0, 0] == pytest.approx(grid, rel=2e-3)


@pytest.mark.parametrize("name", ["wood", "glass", "aluminium"])
def test_a_box_is_the_plate_of_other_code(name: str) -> None:
    made = material(name)
    geometry = Geometry(SEED, made, "T", SEED.face_area, "square", (0.04, 0.04, 0.01), 2)
    plates = sample_bodies(geometry, MOMENTS)
    even = geometry.patch.uniform
    half = [
        np.einsum("c,scd,d->s", even, plates[parity].impedance.value, even) / geometry.patch.area
        for parity in ("even", "odd")
    ]
    both = placed([4, 5], [(0.02, 0.02)] * 2, [(WIDTH / 2, WIDTH / 2)] * 2)
    box = box_samples((0.04, 0.04, 0.01), made.conductivity, made.volumetric_heat_capacity, 0.0, both)
    alone, across = box.impedance[:, 0, 0], box.impedance[:, 0, len(box.port) // 2]
    np.testing.assert_allclose(alone, (half[0] + half[1]) / 2, rtol=1e-4)
    np.testing.assert_allclose(across, (half[0] - half[1]) / 2, rtol=2e-3, atol=1e-6 * alone.max())
    assert box.rate == 0
    assert box.port[0] * box.held == pytest.approx(1, abs=1e-12)


def test_a_box_does_not_know_its_faces_names() -> None:
    first = placed([4, 0], [(0.012, 0.01), (0.01, 0.004)], [(0.0045, 0.003), (0.004, 0.004)])
    turned = placed([0, 2], [(0.012, 0.01), (0.004, 0.01)], [(0.0045, 0.003), (0.004, 0.004)])
    one = box_samples((0.04, 0.03, 0.01), 1.0, 2e6, 8.0, first)
    other = box_samples((0.01, 0.04, 0.03), 1.0, 2e6, 8.0, turned)
    count = len(one.port) // 2
    np.testing.assert_allclose(
        one.impedance[:, ::count, ::count], other.impedance[:, ::count, ::count], rtol=1e-9
    )
    assert one.rate == pytest.approx(other.rate, rel=1e-9)


def test_between_any_patches_it_is_passive() -> None:
    rng = np.random.default_rng(7)
    for _ in range(10):
        size = rng.uniform(0.012, 0.05, 3)
        faces = rng.integers(0, 6, 3)
        room = np.array([np.delete(size, face // 2) for face in faces])
        half = rng.uniform(0.1, 0.4, (3, 2)) * np.minimum(room, WIDTH)
        centre = half + rng.uniform(size=(3, 2)) * (room - 2 * half)
        box = box_samples(tuple(size), 5.0, 2e6, float(rng.choice([0.0, 10.0])), Patches(faces, centre, half))
        values = np.linalg.eigvalsh(box.whole())
        assert np.all(values.min(axis=1) > -1e-7 * values.max(axis=1))


@pytest.mark.parametrize("film", [0.0, 10.0])
def test_few_patterns_are_combinations_of_all(film: float) -> None:
    """Also of patches that are alike along one axis, or along both."""
    part = ((0.0, 0.006), (0.0, WIDTH))
    covered = (FULL, FULL, part, part)
    centre = [(0.02, 0.015), (0.02, 0.015), (0.003, 0.012), (0.003, 0.02)]
    half = [((x1 - x0) / 2, (y1 - y0) / 2) for (x0, x1), (y0, y1) in covered]
    patches = placed([4, 5, 5, 4], centre, half)
    bases = [contact_patterns(SEED, each, 3) for each in covered]
    every = box_samples((0.04, 0.03, 0.01), 1.0, 2e6, film, patches)
    few = box_samples((0.04, 0.03, 0.01), 1.0, 2e6, film, patches, bases)
    turn = block_diag(*bases)
    for found_values, wanted in ((few.impedance, every.impedance), (few.slope, every.slope)):
        np.testing.assert_allclose(
            found_values, turn.T @ wanted @ turn, rtol=0, atol=1e-11 * float(np.abs(wanted).max())
        )
    np.testing.assert_allclose(few.port, every.port @ turn, rtol=0, atol=1e-11 * float(every.port.max()))
    if film > 0:
        assert few.heat is not None
        assert every.heat is not None
        np.testing.assert_allclose(
            few.heat, every.heat @ turn, rtol=0, atol=1e-11 * float(np.abs(every.heat).max())
        )


@pytest.mark.parametrize("film", [0.0, 10.0])
def test_even_flows_alone_are_those_of_all_patterns(film: float) -> None:
    """Some patches of which one port is told beside others, alike along an axis or not, and on every axis."""
    centre = [(0.02, 0.015), (0.02, 0.015), (0.02, 0.005), (0.015, 0.005), (0.006, 0.012)]
    patches = placed(
        [4, 5, 5, 0, 4], centre, [(0.0045, 0.0045), *[(0.0045, 0.0045)] * 2, (0.003, 0.0045), (0.004, 0.002)]
    )
    basis, even = contact_patterns(SEED, FULL, 3), [False, True, True, True, False]
    size = (0.04, 0.03, 0.01)
    every = box_samples(size, 1.0, 2e6, film, patches, [basis] * 5)
    few = box_samples(size, 1.0, 2e6, film, patches, [basis] * 5, even)
    told = ports_told(5, 3, [not each for each in even])
    assert told.columns.tolist() == [0, 1, 2, 3, 6, 9, 12, 13, 14] and told.first.tolist() == [0, 3, 4, 5, 6]
    expected = every.impedance[:, told.columns][:, :, told.columns]
    np.testing.assert_allclose(few.impedance, expected, rtol=0, atol=1e-11 * float(np.abs(expected).max()))
    np.testing.assert_allclose(few.port, every.port[told.columns], rtol=1e-11)
    if film > 0:
        assert few.heat is not None and every.heat is not None
        expected = every.heat[:, told.columns]
        np.testing.assert_allclose(few.heat, expected, rtol=0, atol=1e-11 * float(np.abs(expected).max()))


def test_a_spot_s_patterns_are_orthonormal_and_the_even_one_is_the_first() -> None:
    """Also where the flow is even: a box as wide as the sensor; and between fingertips in a sheet."""
    half, part = WIDTH / 2, ((0.0, 0.006), (0.0, WIDTH))
    whole = Footprint(FULL, (half, half), (half, half))
    beside = Footprint(part, (0.003, half), (0.003, half))
    for sides, depth, near, other in (
        ((WIDTH, WIDTH), 0.01, whole, None),
        ((WIDTH, WIDTH), 0.01, whole, whole),
        ((0.04, 0.04), 2e-4, beside, whole),
        ((0.04, 0.04), 2e-4, whole, beside),
    ):
        spot = Spot(1.0, 2.1e6, sides, depth, near, other)
        for each in (spot, spot.alike(WIDTH)):
            touched = tip_at(SEED, each, Resolution(8, 4))
            np.testing.assert_allclose(touched.basis.T @ GRAM @ touched.basis, np.eye(4), atol=1e-9)
            np.testing.assert_allclose(touched.basis[:, 0], np.eye(len(GRAM))[0], atol=1e-12)


def test_heat_that_no_film_takes_stays() -> None:
    box = box_samples((0.04, 0.03, 0.004), 0.15, 1e6, 1e-9, MIDDLE._replace(centre=np.array([[0.02, 0.015]])))
    assert box.heat is not None
    held = box.heat + box.held * box.port / (MOMENTS[:, None] + box.rate)
    np.testing.assert_allclose(held[:, 0] * MOMENTS, 1, rtol=1e-5)


def coated(thickness: float, conductivity: float) -> SensorStack:
    """The seed's sensor with one more layer on its face."""
    return replace(SEED, layers=(*SEED.layers, Layer("coat", thickness, conductivity, 1200.0, 1500.0)))


@pytest.mark.parametrize(
    "stack",
    [SEED, coated(1e-6, 0.2), coated(2e-5, 0.05), coated(1e-4, 0.2), coated(5e-6, 400.0)],
    ids=["bare", "oxide", "paper", "paint", "metal"],
)
@pytest.mark.parametrize(
    ("centre", "half"), [((0.0045, 0.0045), (0.0045, 0.0045)), ((0.003, 0.006), (0.002, 0.003))]
)
def test_an_element_is_the_sum_over_its_eigenfunctions(
    centre: tuple[float, float], half: tuple[float, float], stack: SensorStack
) -> None:
    slabs = stack.layers[::-1]
    count = 800
    wave = np.arange(count) * np.pi / WIDTH
    shares = []
    for middle, wide in zip(centre, half, strict=True):
        ends = np.stack((wave * (middle + wide), wave * (middle - wide)))
        overlap = np.append(2 * wide, -np.diff(np.sin(ends), axis=0)[0, 1:] / wave[1:])
        shares.append(overlap**2 / np.where(wave == 0, WIDTH, WIDTH / 2))
    kappa2 = (wave[:, None] ** 2 + wave**2).ravel()
    low_x, high_x, low_y, high_y = (
        m + side * w for m, w in zip(centre, half, strict=True) for side in (-1, 1)
    )
    found = element_samples(stack, ((low_x, high_x), (low_y, high_y))).value
    beyond = np.array([1.5 * (count * np.pi / WIDTH) ** 2])  # what is left out counts as if all there
    for s in (4, 12, 19):
        at = MOMENTS[s : s + 1, None]
        last = stack_impedance(slabs, "isothermal", at, beyond)
        each = stack_impedance(slabs, "isothermal", at, kappa2).reshape(count, count) - last
        area = 4 * np.prod(half)
        summed = shares[0] @ each @ shares[1] / area**2 + last[0, 0] / area
        assert found[s, 0, 0] == pytest.approx(summed, rel=5e-5)


def test_no_layer_is_too_thin() -> None:
    """What an element holds is a table of a hundred nodes or so an axis, not of all eigenfunctions."""
    for thickness in (1e-8, 1e-6, 3e-5):
        assert len(element(coated(thickness, 0.2)).nodes) < 160


def test_networks_hold_all_heat_that_goes_in() -> None:
    level = Resolution(8, 2)
    touching = tip(SEED, FULL, level)
    for film in (0.0, 10.0):
        side = box_side(material("glass"), (0.04, 0.04, 0.002), film, MIDDLE, (touching,), level)
        np.testing.assert_allclose(side.outputs["object"] @ side.ports, touching.even, atol=1e-10)
        np.testing.assert_allclose(side.outputs["loss"], side.outputs["object"] * side.rates, atol=1e-12)
        assert np.all(side.rates >= 0)
    np.testing.assert_allclose(
        touching.side.outputs["element"] @ touching.side.ports, touching.even, atol=1e-9
    )


@pytest.mark.parametrize(
    ("level", "within"), [(Resolution(8, 2), 0.02), (Resolution(10, 3), 0.0075), (Resolution(16, 4), 0.005)]
)
def test_networks_keep_the_reference(level: Resolution, within: float) -> None:
    for name, curve in PRESSES.items():
        made, conductance, mode = name.split("/")
        if mode != "T":
            continue
        touching = tip(SEED, FULL, level)
        side = box_side(material(made), (0.04, 0.04, 0.01), 0.0, MIDDLE, (touching,), level)
        weight = float(conductance) * SEED.face_area
        found = 12 * drop((side, touching.side), level.patterns, weight, np.array(curve["t"]))
        assert np.max(np.abs(found - curve["Td"])) < within, name


@pytest.mark.parametrize(
    ("detail", "within"), [(Detail(5, 2, fastest=60), 0.03), (Detail(7, 2), 0.02), (Detail(8, 3), 0.0075)]
)
def test_networks_of_one_touch_keep_the_reference_with_fewer_states(detail: Detail, within: float) -> None:
    for name, curve in PRESSES.items():
        made, conductance, mode = name.split("/")
        if mode != "T":
            continue
        tips, side = touch_sides(material(made), (0.04, 0.04, 0.01), 0.0, MIDDLE, ((SEED, FULL),), detail)
        weight = float(conductance) * SEED.face_area
        found = 12 * drop((side, tips[0].side), detail.patterns, weight, np.array(curve["t"]))
        assert np.max(np.abs(found - curve["Td"])) < within, name
        assert len(side.rates) <= detail.moments * detail.patterns + 1


@pytest.mark.parametrize("film", [0.0, 10.0])
@pytest.mark.parametrize("made", ["wood", "aluminium"])
def test_a_network_of_one_touch_is_passive_and_exact_at_its_moments(made: str, film: float) -> None:
    detail, known, size = Detail(6, 2), material(made), (0.04, 0.03, 0.003)
    patches = placed([5, 4], [(0.004, 0.012), (0.03, 0.02)], [(0.004, 0.0045), (0.0045, 0.0045)])
    elements = ((SEED, ((0.0, 0.008), (0.0, WIDTH))), (SEED, FULL))
    tips, side = touch_sides(known, size, film, patches, elements, detail)
    assert np.all(side.rates >= 0)
    even = np.concatenate([one.even for one in tips])
    np.testing.assert_allclose(side.outputs["object"] @ side.ports, even, atol=1e-8)
    if film > 0:
        return  # the film is off under the contacts only
    box = box_samples(size, known.conductivity, known.volumetric_heat_capacity, film, patches).whole()
    count = len(tips[0].basis)
    turn = np.zeros((2 * count, 4))
    for f, one in enumerate(tips):
        turn[f * count : (f + 1) * count, 2 * f : 2 * f + 2] = one.basis
    for moment in detail.indices:
        fitted = side.ports.T @ (side.ports / (MOMENTS[moment] + side.rates)[:, None])
        wanted = turn.T @ box[moment] @ turn
        assert np.max(np.abs(fitted - wanted)) < 2e-4 * np.max(np.abs(wanted))


def test_places_that_are_alike_feel_alike() -> None:
    """A patch at a corner, seen from each of the corners."""
    level = Resolution(8, 2)
    touching = tip(SEED, ((0.0, 0.006), (0.0, 0.005)), level)
    curves = []
    for x, y in ((0.003, 0.0025), (0.037, 0.0025), (0.003, 0.0275), (0.037, 0.0275)):
        half = ((0.003, 0.0025),)
        side = box_side(
            material("glass"), (0.04, 0.03, 0.01), 0.0, placed([5], [(x, y)], list(half)), (touching,), level
        )
        curves.append(side.rates[0] + side.ports[0, 0])
    np.testing.assert_allclose(curves, curves[0], rtol=1e-9)
