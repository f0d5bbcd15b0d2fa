"""Contacts narrower than the sensor's face: their tables beside other solutions, and passive states that are kept."""

# mujoco ships no type stubs for its compiled names
# pyright: reportAttributeAccessIssue=false

import importlib.util
from dataclasses import replace
from pathlib import Path

import mujoco
import numpy as np
import pytest

from thermograsp.thermal import Material, material
from thermograsp.thermal.kernels import GRASP, OF_GRASP, Patches, Resolution, box_samples, element_samples
from thermograsp.touch import Fingertip, ThermalTouch
from thermograsp.touch.contacts import AREA, CLOSED, COLUMNS, CONDUCTANCE, LENGTH, NORMAL, PLACE
from thermograsp.touch.heat import JoinedHeat, narrow_of
from thermograsp.touch.heat.narrow import spread
from thermograsp.touch.scene import PadPlace

_spec = importlib.util.spec_from_file_location("hand", Path(__file__).with_name("hand.py"))
assert _spec and _spec.loader
hand = importlib.util.module_from_spec(_spec)
_spec.loader.exec_module(hand)

LEVEL = Resolution(8, 3)


@pytest.fixture(scope="module")
def touch() -> ThermalTouch:
    model, _ = hand.hand()
    return ThermalTouch(
        model, fingertips={"thumb": "thumb_pad"}, objects={"can": "glass"}, chain="ideal", air=0.0
    )


@pytest.fixture
def pad(touch: ThermalTouch) -> PadPlace:
    return touch._pads[0]


def added(pad: PadPlace, made_of: Material, area: float, length: float) -> np.ndarray:
    """K/W at GRASP that a contact of that area m2 and length m has beyond the whole face."""
    root = np.zeros(LEVEL.rates)
    assert spread(narrow_of(pad, made_of, LEVEL), pad.stack.width, area, length, root)
    return (root**2 / (GRASP[:, None] + LEVEL.decay)).sum(axis=1)


@pytest.mark.parametrize("name", ["aluminium", "glass", "wood"])
@pytest.mark.parametrize(("p", "q"), [(0.0041, 0.009), (0.0015, 0.009), (0.006, 0.006), (0.0022, 0.0022)])
def test_a_narrow_contact_has_the_impedance_of_a_patch_on_a_box(
    pad: PadPlace, name: str, p: float, q: float
) -> None:
    """A box by its images (thermal/kernels/box.py), in place of the half-space."""
    made_of, width, size = material(name), pad.stack.width, (0.06, 0.08, 0.08)

    def impedance(p: float, q: float) -> np.ndarray:
        ends = ((width - p) / 2, (width + p) / 2), ((width - q) / 2, (width + q) / 2)
        patch = Patches(np.array([0]), np.array([[0.04, 0.04]]), np.array([[p / 2, q / 2]]))
        box = box_samples(size, made_of.conductivity, made_of.volumetric_heat_capacity, 0.0, patch).whole()
        return (element_samples(pad.stack, ends).value + box)[OF_GRASP, 0, 0]

    series = impedance(p, q)
    error = added(pad, made_of, p * q, q) - (series - impedance(width, width))
    assert np.abs(error / (series + 1 / (3000 * p * q))).max() < 0.02


def test_a_small_square_ends_with_the_resistance_of_a_half_space(pad: PadPlace) -> None:
    """.473 q / (k side) of a square source's mean temperature: Carslaw & Jaeger, section 10.5."""
    bare, made_of = replace(pad, bare=True), material("copper")
    side, width = pad.stack.width / 4, pad.stack.width
    expected = 0.473 / made_of.conductivity * (1 / side - 1 / width)
    assert added(bare, made_of, side**2, side)[0] == pytest.approx(expected, rel=0.01)


def test_a_contact_of_the_whole_face_or_of_no_known_area_has_nothing_to_spread(pad: PadPlace) -> None:
    width, root = pad.stack.width, np.zeros(LEVEL.rates)
    table = narrow_of(pad, material("glass"), LEVEL)
    assert (table >= 0).all()
    assert not spread(table, width, width**2, width, root)
    assert not spread(table, width, 0.0, np.nan, root)
    assert not spread(table, width, 2 * (0.9 * width) ** 2, 0.9 * width, root)  # of two geoms side by side
    assert not root.any()


def strip(touch: ThermalTouch, dt: float, widths: np.ndarray, conductances: np.ndarray) -> JoinedHeat:
    """A heat that contacts of these widths m, as long as the face, have passed for dt each."""
    heat = JoinedHeat(touch._pads, (), touch._shapes, worlds=1, dt=dt, tolerance=0.05, film=0.0, ambient=24.0)
    width = touch._pads[0].stack.width
    touches = np.zeros((1, 1, 2, COLUMNS))
    touches[0, 0, 0, PLACE : PLACE + 3], touches[0, 0, 0, NORMAL : NORMAL + 3] = (0.03, 0, 0), (-1, 0, 0)
    for across, conducts in zip(widths, conductances, strict=True):
        touches[0, 0, 0, [CONDUCTANCE, CLOSED, AREA]] = conducts, 1.0, across * width
        touches[0, 0, 0, LENGTH] = across * width * width
        heat.advance(touches, 1)
    return heat


def test_steps_of_any_length_tell_the_same(touch: ThermalTouch) -> None:
    drops = [
        strip(touch, dt, *np.full((2, round(1 / dt)), [[0.004], [0.1]])).drop[0, 0] for dt in (0.02, 0.002)
    ]
    assert drops[0] == pytest.approx(drops[1], rel=2e-3)


def test_whatever_the_widths_do_nothing_grows_and_no_heat_is_lost(touch: ThermalTouch) -> None:
    rng = np.random.default_rng(5)
    widths = rng.uniform(2e-4, 0.01, 2000)
    conducts = 10.0 ** rng.uniform(-4, 1, 2000) * (rng.random(2000) < 0.9)
    heat = strip(touch, 0.01, widths, conducts)
    balance, reach = heat.balance(0), touch._pads[0].temperature - 24.0
    assert balance.objects.sum() == pytest.approx(balance.given.sum(), rel=1e-10)
    assert 0 < heat.drop[0, 0] < reach
    assert 0 < heat.object_temperature[0, 0] - 24.0 < reach


def test_what_has_spread_belongs_to_the_state() -> None:
    model, data = hand.hand()
    touch = ThermalTouch(model, fingertips={"thumb": "thumb_pad"}, objects={"can": "glass"}, chain="ideal")
    hand.press(data, 8.0)

    def drops_of(steps: int) -> np.ndarray:
        for _ in range(steps):
            mujoco.mj_step(model, data)
            touch.update(data)
        return touch.reading.temperature_drop.copy()

    drops_of(200)
    kind = mujoco.mjtState.mjSTATE_INTEGRATION
    kept, then = touch.state(), np.zeros(mujoco.mj_stateSize(model, kind))
    mujoco.mj_getState(model, data, then, kind)
    assert np.abs(kept.heat.narrow).max() > 0
    first = drops_of(100)
    mujoco.mj_setState(model, data, then, kind)
    touch.set_state(kept)
    np.testing.assert_array_equal(drops_of(100), first)
    touch.reset()
    assert not touch._heat.state().narrow.any()


def test_a_flat_pad_on_a_flat_face_has_none() -> None:
    model = mujoco.MjModel.from_xml_string("""
    <mujoco><worldbody>
      <body name="block"><geom type="box" size=".02 .02 .02"/></body>
      <body name="tip" pos="0 0 .0241"><joint type="slide" axis="0 0 -1" damping="20"/>
        <geom name="tip" type="box" size=".01 .01 .004" mass="1"/></body>
    </worldbody></mujoco>""")
    data = mujoco.MjData(model)
    tip = Fingertip("tip", (0, 0, -0.004), (0, 0, -1), (0.02, 0.02))
    touch = ThermalTouch(model, fingertips={"tip": tip}, objects={"block": "glass"})
    for _ in range(100):
        mujoco.mj_step(model, data)
        touch.update(data)
    assert touch.reading.touching == ("block",)
    assert not touch._heat.state().narrow.any()
