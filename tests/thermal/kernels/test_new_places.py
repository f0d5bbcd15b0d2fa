"""What the network of a new place is made of, beside what is told at many times, by every pattern, without a table."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from thermograsp.thermal import SensorStack, sensor
from thermograsp.thermal.kernels import (
    ALONG,
    GRAM,
    JUMPS,
    NODES,
    OF_GRASP,
    Footprint,
    Patches,
    Resolution,
    Spot,
    basis_terms,
    box_samples,
    contact_patterns,
    tip,
    tip_at,
    touch_patterns,
)
from thermograsp.thermal.kernels.alone import alone
from thermograsp.thermal.kernels.axis import (
    MODES,
    SWITCH,
    free_kernels,
    images,
    left_inside,
    overlaps,
    wave_numbers,
)
from thermograsp.thermal.kernels.element import element, element_samples, face_impedance
from thermograsp.thermal.kernels.excited import Face, excited, excited_alone, shown_box, shown_element
from thermograsp.thermal.kernels.patterns import EACH_FUNCTION, EVENNESS, basis_shares
from thermograsp.thermal.kernels.samples import SHOWN
from thermograsp.thermal.matter import Layer

SEED = sensor("seed")
WIDTH = SEED.width
FULL = ((0.0, WIDTH), (0.0, WIDTH))
PART = ((0.0, 0.004), (0.001, 0.0085))
SLIVER = ((0.0, 0.0006), (0.0, WIDTH))


def coated(thickness: float, conductivity: float) -> SensorStack:
    return replace(SEED, layers=(*SEED.layers, Layer("coat", thickness, conductivity, 1200.0, 1500.0)))


@pytest.mark.parametrize("half", [(0.0045, 0.0045), (0.0003, 0.002), (0.01, 0.03)])
def test_a_patch_by_itself_is_its_kernel(half: tuple[float, float]) -> None:
    """At all times that it is asked for, of the functions and of combinations; the last one is in no table."""
    taus = 2.5e-10 * np.exp(np.arange(16.0))
    for shares in (EACH_FUNCTION, basis_shares(contact_patterns(SEED, PART, 4))):
        for sides in (np.array(half), np.array(half) * 1e-6):
            found = alone(sides, shares, taus)
            wanted = free_kernels(sides[None], (shares @ JUMPS)[None], NODES, taus)[0]
            largest = np.abs(wanted).max(axis=(1, 2), keepdims=True)
            assert (np.abs(found - wanted) / largest).max() < 1e-6


@pytest.mark.parametrize("covered", [FULL, PART, SLIVER])
@pytest.mark.parametrize(
    "stack",
    [SEED, coated(1e-6, 0.2), coated(1e-4, 0.2), coated(5e-6, 400.0)],
    ids=["bare", "oxide", "paint", "metal"],
)
def test_few_times_and_sums_tell_an_element(stack: SensorStack, covered) -> None:
    """Of combinations at a grasp's moments, and of all patterns at those where a touch is shown."""
    whole = element_samples(stack, covered).value
    basis = contact_patterns(stack, covered, 3)
    few = face_impedance(element(stack), covered, basis_shares(basis), basis_terms(3), np.eye(3), shown=False)
    wanted = basis.T @ whole[OF_GRASP] @ basis
    assert (np.abs(few - wanted) / wanted[:, :1, :1]).max() < 1e-3
    shown = face_impedance(element(stack), covered, EACH_FUNCTION, ALONG[:, None], GRAM, shown=True)
    own = np.sqrt(np.einsum("sii->si", whole[SHOWN]))
    error = (np.abs(shown - whole[SHOWN]) / (own[:, :, None] * own[:, None])).max()
    assert error < (0.025 if covered == SLIVER else 4e-3)  # it decides on patterns alone


SPOTS = [
    Spot(1.0, 2.1e6, (0.04, 0.03), 0.01, Footprint(FULL, (0.02, 0.012), (WIDTH / 2, WIDTH / 2))),
    Spot(16.2, 4e6, (0.04, 0.03), 0.01, Footprint(PART, (0.002, 0.012), (0.002, 0.00375))),
    Spot(237.0, 2.4e6, (0.03, 0.03), 0.02, Footprint(FULL, (0.0045, 0.0145), (WIDTH / 2, WIDTH / 2))),
    Spot(
        0.15,
        1e6,
        (0.04, 0.04),
        5e-4,
        Footprint(FULL, (0.02, 0.02), (WIDTH / 2, WIDTH / 2)),
        Footprint(PART, (0.022, 0.02), (0.002, 0.00375)),
    ),
]


@pytest.mark.parametrize("spot", SPOTS)
def test_a_spot_s_patterns_hold_what_flows_there(spot: Spot) -> None:
    """Of the flows that excite them, told at many times, as much as the best three patterns of these."""
    pair = [spot.contact, *([spot.opposite] if spot.opposite else [])]
    patches = Patches(
        np.array([5, 4][: len(pair)]),
        np.array([each.centre for each in pair]),
        np.array([each.half for each in pair]),
    )
    size = (*spot.sides, spot.depth)
    box = box_samples(size, spot.conductivity, spot.heat_capacity, 0.0, patches).whole()
    elements = [element_samples(SEED, each.covered).value for each in pair]
    best = touch_patterns(box, elements, patches.areas, 3, shared=False)[0]
    found = tip_at(SEED, spot, Resolution(12, 3)).basis
    np.testing.assert_allclose(found.T @ GRAM @ found, np.eye(3), atol=1e-9)
    both = box[:, : len(GRAM), : len(GRAM)] + elements[0]
    flows = np.linalg.solve(both + GRAM / (1e4 * patches.areas[0]), GRAM[0][:, None])[SHOWN, :, 0] @ EVENNESS
    missed = [
        np.linalg.norm(flows - (flows @ orthonormal) @ orthonormal.T, axis=1) / np.linalg.norm(flows, axis=1)
        for orthonormal in (EVENNESS.T @ best, EVENNESS.T @ found)
    ]
    assert missed[1].max() < 1.05 * missed[0].max() + 1e-4


def test_all_heat_of_an_element_is_in() -> None:
    """Its outputs jump by what goes in, and by nothing."""
    for covered in (FULL, PART, SLIVER):
        side = tip(SEED, covered, Resolution(12, 3)).side
        np.testing.assert_allclose(side.outputs["element"] @ side.ports, [1, 0, 0], atol=1e-10)
        np.testing.assert_allclose(side.outputs["drop"] @ side.ports, 0, atol=1e-8)


@pytest.mark.parametrize("tau", [1e-4, 2e-3])
def test_weak_films_are_the_limit_of_stronger_ones(tau: float) -> None:
    """What one takes is told by a series up to some strength and by a closed form from there on."""
    nodes = 0.25 + 0.15 * NODES
    film = 0.02 / np.sqrt(tau)
    tables = []
    for strength in (1 - 1e-9, 1 + 1e-9):
        table, inside = np.empty((len(nodes), len(nodes))), np.empty(len(nodes))
        images(nodes, 1, nodes, 1, True, 1.0, strength * film, tau, table)
        left_inside(nodes, 1.0, strength * film, tau, inside)
        tables.append((JUMPS @ table @ JUMPS.T, JUMPS @ inside))
    for soon, late in zip(*tables, strict=True):
        np.testing.assert_allclose(soon, late, rtol=1e-8, atol=1e-9)


@pytest.mark.parametrize("film", [0.0, 0.1, 2.0])
def test_what_is_left_inside_is_what_eigenfunctions_hold(film: float) -> None:
    nodes, waves = 0.25 + 0.15 * NODES, wave_numbers(1.0, film)
    found, whole, inside = np.empty((len(JUMPS), MODES)), np.empty((1, MODES)), np.empty(len(nodes))
    overlaps(nodes, JUMPS, 1, 1.0, waves, np.empty(MODES), found)
    overlaps(np.array([0.0, 1.0]), np.array([[-1.0, 1.0]]), 1, 1.0, waves, np.empty(MODES), whole)
    left_inside(nodes, 1.0, film, SWITCH, inside)
    wanted = (found * np.exp(-(waves**2) * SWITCH)) @ whole[0]
    np.testing.assert_allclose(JUMPS @ inside, wanted, rtol=1e-6)


@pytest.mark.parametrize("side", [0.0041, 0.0063, 0.00895])
def test_a_face_narrower_than_the_sensor_is_nearly_covered_on_the_sensor(side: float) -> None:
    """What is covered in steps, a little more or less, does not end beyond the sensor's face."""
    for begun in np.linspace(0.0, WIDTH - side, 41).tolist():
        part = begun, begun + side
        half = side / 2, side / 2
        spot = Spot(1.0, 2e6, (side, side), 0.02, Footprint((part, part), half, half))
        for low, high in spot.alike(WIDTH).contact.covered:
            assert 0 <= low < high <= WIDTH * (1 + 1e-12)
            assert high - low == pytest.approx(side, abs=WIDTH / 17)
        assert np.isfinite(tip_at(SEED, spot.alike(WIDTH), Resolution(12, 3)).side.ports).all()


def test_what_a_tip_knows_beforehand_is_what_it_would_find() -> None:
    made = tip(SEED, PART, Resolution(12, 3))
    again = replace(made)
    for name in ("weight", "shares", "jumps"):
        np.testing.assert_allclose(getattr(made, name), getattr(again, name), rtol=1e-13, atol=1e-15)


@pytest.mark.parametrize("spot", SPOTS[:3])
def test_a_face_excites_what_its_box_does(spot: Spot) -> None:
    """From kernels along its axes, beside the box's own at as few times."""
    centre, half = np.array([spot.contact.centre]), np.array([spot.contact.half])
    patches, made = Patches(np.array([5]), centre, half), (spot.conductivity, spot.heat_capacity)
    across = shown_element(element(SEED), spot.contact.covered)
    face = Face(spot.sides, spot.depth, spot.contact.centre, spot.contact.half)
    found = excited_alone(face, *made, across, 3)
    wanted = excited(shown_box((*spot.sides, spot.depth), *made, patches), across[None], patches.areas, 3)[0]
    assert np.abs(EVENNESS.T @ (found - wanted)).max() < 1e-5  # of combinations of size 1


@pytest.mark.parametrize("width", [0.02, 0.05, 0.3])
def test_an_even_flow_into_a_sensor_of_any_width_sees_the_same_layers(width: float) -> None:
    """Patterns of flow were sought on a box that one of 40 mm and more is wider than, which broke the process."""
    wide = replace(SEED, width=width)
    found, known = (tip(each, ((0.0, each.width),) * 2, Resolution(12, 3)) for each in (wide, SEED))
    np.testing.assert_allclose(found.impedance * found.area, known.impedance * known.area, rtol=1e-6)
    assert np.isfinite(found.side.ports).all()
