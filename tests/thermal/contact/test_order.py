"""What every law of a curved contact must keep, over drawn radii, materials, fingertips and places: more force is more
heat, a ball feels less than a rod and a rod less than a flat face, and nothing jumps over the sensor's edge."""

from __future__ import annotations

import numpy as np
import pytest

from thermograsp.compiled import njit
from thermograsp.thermal import SKINS, Pad, Skin, Surface, joint, material, materials
from thermograsp.thermal.contact import (
    Wedge,
    bared,
    beneath,
    beside_round,
    conductance,
    conduction,
    curved_contact,
    curved_table,
    cylinder_contact,
    face_joint,
    flat_contact,
    flat_footprint,
    flat_law,
    footprint,
    mean_gap,
    round_footprint,
    skinned,
    sphere_contact,
    touching,
)
from thermograsp.thermal.contact.spread import patches
from thermograsp.thermal.matter import Material

PAD, SKIN = Pad(), SKINS["filled_silicone"]
FORCES = np.geomspace(1e-3, 300.0, 90)
RADII = np.geomspace(1e-3, 100.0, 16)
PLACES = ((0.0, 0.0), (0.002, 0.001), (0.0044, 0.0044), (0.0, 0.0045), (0.005, 0.0), (0.007, 0.006))
BODIES = {"ball": None, "rod": 0.05, "short rod": 0.006}


@njit(error_model="numpy")
def swept(law, forces, place, out):
    for k in range(len(forces)):
        out[k] = conduction(law, forces[k], place)[1]


def over_forces(law: np.void, place: tuple[float, float]) -> np.ndarray:
    out = np.empty(len(FORCES))
    swept(law, FORCES, np.array([0.0, *place]), out)
    return out


@njit(error_model="numpy")
def patched(law, below, forces, place, out):
    for k in range(len(forces)):
        contact, gas, _, _, area = patches(law, below, forces[k], place)
        out[k] = contact + gas, area


def felt(made: Material, skin: Skin | None, conducts: np.ndarray, patch: np.ndarray) -> np.ndarray:
    """W/K under a skin, with what heat meets beneath the patch: what constricts it is told in both. Of a bare face what
    the contact conducts, whose patch the force hardly changes."""
    if skin is None:
        return conducts
    below, some = beneath(made, skin), conducts > 0
    resists = 1 / np.where(some, conducts, 1.0) + (below.straight + below.sheet) / np.where(some, patch, 1.0)
    return some / resists


@pytest.mark.parametrize("every", [5, pytest.param(1, marks=pytest.mark.slow)])
@pytest.mark.parametrize("body", BODIES)
@pytest.mark.parametrize("skin", [None, SKIN], ids=["bare", "skinned"])
def test_more_force_is_more_heat(skin: Skin | None, body: str, every: int) -> None:
    """Of every material, or every fifth, from 1 mm to 100 m, wherever the body is. Where its crown or its rim is off
    the face, the sum of the gas over angles is good to 1e-3 of what is felt in the middle, and under a skin the patch,
    which is told by differences of such sums, to three times that."""
    rng = np.random.default_rng(3)
    for name in list(materials())[::every]:
        made = material(name)
        for radius in RADII * rng.uniform(0.8, 1.25, len(RADII)):
            body_law = round_footprint(PAD, skin, Surface.of(made), float(radius), BODIES[body])
            middle = 0.0
            for place in PLACES:
                every_patch = np.empty((len(FORCES), 2))
                patched(body_law, beneath(made, skin), FORCES, np.array([0.0, *place]), every_patch)
                np.testing.assert_allclose(
                    over_forces(body_law, place), every_patch[:, 0], rtol=1e-9, atol=1e-15
                )
                conducts = felt(made, skin, *every_patch.T)
                middle = middle or conducts.max()
                assert np.isfinite(conducts).all() and (conducts >= 0).all()
                on_it = max(place) <= PAD.face / 2 and radius > 2 * PAD.face
                rounding = (1e-9 if on_it else 1e-3) if skin is None else (1e-3 if on_it else 3e-3)
                falls = (np.maximum.accumulate(conducts) - conducts).max()
                assert falls <= rounding * middle, (name, radius, place)


@pytest.mark.parametrize("skin", [None, SKIN], ids=["bare", "skinned"])
def test_a_ball_less_than_a_rod_and_a_rod_less_than_a_flat_face(skin: Skin | None) -> None:
    """Of every material, in the pad's middle, up to 50 mm of radius and 50 N; the flat face is the sensor's, so that
    all force is on it as under a ball. 2 % for soft bodies that lie on all of it, whose pressure is not even."""
    gripped = FORCES < 50
    for name in materials():
        made = material(name)
        pad = bared(PAD) if skin is None else skinned(PAD, skin)
        pair = joint(touching(skin), Surface.of(made), full_contact=True)
        flat = over_forces(flat_footprint(pad, pair, (PAD.face, PAD.face)), (0.0, 0.0))
        for radius in np.geomspace(2e-3, 0.05, 6):
            ball, rod = (
                over_forces(round_footprint(PAD, skin, Surface.of(made), float(radius), length), (0.0, 0.0))
                for length in (None, 0.05)
            )
            assert (ball <= 1.02 * rod)[gripped].all(), (name, radius)
            assert (rod <= 1.02 * flat)[gripped].all(), (name, radius)


@pytest.mark.parametrize("skin", [None, SKIN], ids=["bare", "skinned"])
def test_the_pressures_add_up_to_the_force(skin: Skin | None) -> None:
    """With the sensor's face as large as the pad, all of the force is on it, to 1e-6, wherever the body is."""
    pad = bared(PAD) if skin is None else skinned(PAD, skin)
    whole = Pad(face=pad.width, youngs_modulus=pad.youngs_modulus, face_stiffness=pad.face_stiffness)
    rng = np.random.default_rng(4)
    for _ in range(300):
        force, radius = np.exp(rng.uniform(np.log([1e-3, 1e-3]), np.log([300.0, 100.0])))
        y, z = rng.uniform(-0.0099, 0.0099, 2)
        for found in (
            sphere_contact(whole, force, radius, (y, z)),
            cylinder_contact(whole, force, radius, 0.05, (y, z)),
            flat_contact(whole, force, (0.05, 0.004), (y, 0.0)),
        ):
            assert float(found.face_force) == pytest.approx(force, rel=1e-6)


@pytest.mark.parametrize("body", BODIES)
@pytest.mark.parametrize("skin", [None, SKIN], ids=["bare", "skinned"])
def test_nothing_jumps_as_a_body_slides_over_the_sensor_s_edge_and_the_pad_s(
    skin: Skin | None, body: str
) -> None:
    """Steps four times as fine make changes less than half as large, or next to none. Heat spreads in a skin, so that a
    line which is hundredths of a millimetre on the face conducts a tenth of what all of it would."""
    rng = np.random.default_rng(5)
    names = sorted(materials())
    for _ in range(12):
        made = material(str(rng.choice(names)))
        radius, force = np.exp(rng.uniform(np.log([2e-3, 0.05]), np.log([1.0, 50.0])))
        body_law, turn = (
            round_footprint(PAD, skin, Surface.of(made), float(radius), BODIES[body]),
            rng.uniform(0, np.pi / 2),
        )
        way = np.array([0.0, np.cos(turn), np.sin(turn)])
        largest = []
        for steps in (500, 2000) if skin is None else (2000, 8000):
            conducts = [
                conduction(body_law, force, at * way) for at in np.linspace(-0.0095, 0.0095, steps + 1)
            ]
            largest.append(
                np.abs(np.diff([watts for _, watts in conducts])).max() / max(w for _, w in conducts)
            )
        assert largest[1] <= 0.5 * largest[0] + 1e-4, (made.name, radius, force, turn)


def test_what_touches_and_its_force_are_never_more_than_there_is() -> None:
    rng = np.random.default_rng(6)
    names = sorted(materials())
    for _ in range(400):
        made, skin = material(str(rng.choice(names))), (None, SKIN)[rng.integers(2)]
        radius, force = np.exp(rng.uniform(np.log([1e-3, 1e-3]), np.log([100.0, 1e3])))
        body_law = round_footprint(
            PAD, skin, Surface.of(made), float(radius), list(BODIES.values())[rng.integers(3)]
        )
        area, load = footprint(body_law, force, np.append(0.0, rng.uniform(-0.02, 0.02, 2)))
        assert 0 <= area <= PAD.face**2 * (1 + 1e-9)
        assert 0 <= load <= force * (1 + 1e-9)


def test_in_tables_more_force_is_more_heat_too() -> None:
    """What ThermalTouch, arrays and the plugin read, of drawn bodies at drawn places."""
    rng = np.random.default_rng(7)
    names = sorted(materials())
    for _ in range(40):
        made, skin = material(str(rng.choice(names))), (None, SKIN)[rng.integers(2)]
        radius, length = (
            float(np.exp(rng.uniform(np.log(2e-3), np.log(100.0)))),
            rng.choice([0.0, 0.006, 0.05]),
        )
        table = curved_table(PAD, skin, made, radius, float(length) or None)
        most = curved_contact(table, FORCES[-1], 0.0, 0.0)[0]
        for place in rng.uniform(-0.012, 0.012, (5, 2)):
            every = np.array([curved_contact(table, force, *place) for force in FORCES])
            conducts = felt(made, skin, *every[:, :2].T)
            assert (np.maximum.accumulate(conducts) - conducts <= 1e-3 * most).all(), (
                made.name,
                radius,
                length,
                place,
            )


@pytest.mark.parametrize("skin", [None, SKIN], ids=["bare", "skinned"])
def test_two_round_bodies_that_press_harder_feel_no_less(skin: Skin | None) -> None:
    """Of drawn curvatures along and across, ellipses and lines on springs: through contact, skin and bodies, and
    to a hundredth of what less force was felt by."""
    rng, half = np.random.default_rng(8), PAD.face / 2
    names = sorted(name for name, made in materials().items() if made.roughness and made.youngs_modulus)
    for _ in range(120):
        made = material(str(rng.choice(names)))
        pair, below = face_joint(skin, Surface.of(made)), beneath(made, skin)
        law = flat_law(skinned(PAD, skin), pair, (PAD.face, PAD.face))
        for key, value in {"mean_gap": mean_gap(pair), **below._asdict()}.items():
            law[key] = value
        least, most = np.sort(np.exp(rng.uniform(np.log(2.0), np.log(600.0), 2)))
        line, stiffness, before = rng.random() < 0.3, 1e9 * np.exp(rng.uniform(0.0, 4.0)), 0.0
        least = 1e-6 if line else least
        for force in np.geomspace(0.003, 60.0, 20):
            depth = np.sqrt(force * np.sqrt(most * least) / (np.pi * stiffness))
            if line:
                depth = (0.375 * force * np.sqrt(most / 2) / (stiffness * half)) ** (2 / 3)
            across, along = np.sqrt(2 * depth / most), half if line else np.sqrt(2 * depth / least)
            if max(across, along) > half:
                break
            area = (4 if line else np.pi) * across * along
            side = min(np.sqrt(area * along / across), PAD.face)
            wedge = Wedge(depth, 0.0, least, most, -half, half, -half, half)
            touches = conductance(law, force / area) * area
            conducts, patch, long = beside_round(law, wedge, touches, area, side)
            assert 0 < patch <= PAD.face**2 * (1 + 1e-9) and patch / PAD.face <= long <= PAD.face * (1 + 1e-9)
            heat = 1 / (1 / conducts + (below.straight + below.sheet) / patch)
            assert heat >= 0.99 * before, (made.name, most, least, force)
            before = max(heat, before)
