"""Contacts narrower than the sensor's face: their tables beside other solutions, and passive states that are kept."""

# mujoco ships no type stubs for its compiled names
# pyright: reportAttributeAccessIssue=false

import importlib.util
import math
from dataclasses import replace
from pathlib import Path

import mujoco
import numpy as np
import pytest

from thermograsp.thermal import Material, material
from thermograsp.thermal.contact import patch_ends, patch_offset
from thermograsp.thermal.kernels import (
    GRAM,
    GRASP,
    OF_GRASP,
    Patches,
    Resolution,
    box_samples,
    element_samples,
)
from thermograsp.touch import Fingertip, ThermalTouch
from thermograsp.touch.contacts import (
    AREA,
    ASIDE,
    BESIDE,
    CLOSED,
    COLUMNS,
    CONDUCTANCE,
    ENDS,
    LENGTH,
    NORMAL,
    PLACE,
)
from thermograsp.touch.heat import JoinedHeat, Wall, narrow_tables, wall_of
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


MIDDLE, AT_ENDS = np.zeros(2), np.ones(2)


def added(
    pad: PadPlace,
    made_of: Material,
    area: float,
    length: float,
    aside: np.ndarray = MIDDLE,
    ends: np.ndarray = MIDDLE,
    thick: float = math.inf,
) -> np.ndarray:
    """K/W at GRASP that a contact of that area m2 and length m has beyond the whole face, on so many m."""
    root = np.zeros(LEVEL.rates)
    wall = wall_of(made_of, 1.0, thick, pad.stack.width)
    tables, _, ((own, other),) = narrow_tables([(pad, wall)], LEVEL, 0.01)
    assert spread(
        tables[own], tables[other], (pad.stack.width, pad.stack.width), area, length, aside, ends, root
    )
    return (root**2 / (GRASP[:, None] + LEVEL.decay)).sum(axis=1)


@pytest.mark.parametrize("name", ["aluminium", "glass", "wood"])
@pytest.mark.parametrize(("p", "q"), [(0.0041, 0.009), (0.0015, 0.009), (0.006, 0.006), (0.0022, 0.0022)])
@pytest.mark.parametrize("where", [(0, 0), (1, 0), (1, 1)])
@pytest.mark.parametrize("at_end", [False, True])
@pytest.mark.parametrize(("thick", "bound"), [(0.06, 0.06), (0.0012, 0.06), (0.0003, 0.1)])
def test_a_narrow_contact_has_the_impedance_of_a_patch_on_a_box(
    pad: PadPlace,
    name: str,
    p: float,
    q: float,
    where: tuple[int, int],
    at_end: bool,
    thick: float,
    bound: float,
) -> None:
    """A box by its images (thermal/kernels/box.py), in place of the plate without sides, and of all flows the one that
    loses the least. where: in the middle or at an end of the face along both axes; at_end: of the box too."""
    made_of, width, size = material(name), pad.stack.width, (thick, 0.08, 0.08)

    def impedance(sides: tuple[float, float], where: tuple[int, int]) -> np.ndarray:
        ends = tuple(
            (0.0, side) if end else ((width - side) / 2, (width + side) / 2)
            for side, end in zip(sides, where, strict=True)
        )
        middle = [side / 2 if end and at_end else 0.04 for side, end in zip(sides, where, strict=True)]
        patch = Patches(np.array([0]), np.array([middle]), np.array([sides]) / 2)
        box = box_samples(size, made_of.conductivity, made_of.volumetric_heat_capacity, 0.0, patch).whole()
        loose = 1 / (1e4 * sides[0] * sides[1])
        series = (element_samples(pad.stack, ends).value + box)[OF_GRASP] + loose * GRAM  # pyright: ignore
        return 1 / (np.linalg.solve(series, GRAM[0]) @ GRAM[0])

    series, aside = impedance((p, q), where), np.array(where, float)
    loose = (1 / (p * q) - 1 / width**2) / 1e4
    error = added(pad, made_of, p * q, q, aside, aside if at_end else MIDDLE, thick)
    error = error - (series - impedance((width, width), where) - loose)
    assert np.abs(error / series).max() < bound


def test_a_small_square_ends_with_the_resistance_of_a_half_space(pad: PadPlace) -> None:
    """.473 q / (k side) of a square source's mean temperature: Carslaw & Jaeger, section 10.5."""
    bare, made_of = replace(pad, bare=True), material("copper")
    side, width = pad.stack.width / 4, pad.stack.width
    expected = 0.473 / made_of.conductivity * (1 / side - 1 / width)
    assert added(bare, made_of, side**2, side)[0] == pytest.approx(expected, rel=0.01)


def test_a_contact_of_the_whole_face_or_of_no_known_area_has_nothing_to_spread(pad: PadPlace) -> None:
    width, root = pad.stack.width, np.zeros(LEVEL.rates)
    tables, _, ((own, other),) = narrow_tables([(pad, Wall(material("glass")))], LEVEL, 0.01)
    assert (tables >= 0).all()
    for area, length in ((width**2, width), (0.0, np.nan), (1.2 * width**2, 0.9 * width)):
        assert not spread(tables[own], tables[other], (width, width), area, length, AT_ENDS, AT_ENDS, root)
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


FACE = 0.009  # m
PATCHES = {
    "a quarter": ((-FACE / 2, -FACE / 4), FACE, 3.4e5, -FACE / 4 - 0.02),
    "half": ((-FACE / 2, 0.0), FACE, 2.5e5, -0.02),
    "three quarters": ((-FACE / 2, FACE / 4), FACE, 2.1e5, FACE / 4 - 0.02),
    "a rod at the edge": ((0.0029, FACE / 2), FACE, 5e5, 0.0),
    "a rod that ends": ((-FACE / 2, 0.0), 0.0016, 5e5, -0.02),
    "a ball at the edge": ((0.0017, FACE / 2), 0.0028, 5e5, 0.0),
    "a narrow pad": ((-0.003, 0.003), 0.006, 2.5e5, 0.0),
    "half of a narrow pad": ((-0.003, 0.0), 0.006, 2.5e5, -0.02),
}
"""m along y from the face's middle, m along z, W/(m2 K), and the y of the middle of a block of 40 mm."""


@pytest.mark.parametrize(
    ("patch", "made_of", "expected"),
    [
        ("a quarter", "aluminium", (2.135, 4.135)),
        ("a quarter", "glass", (0.690, 1.224)),
        ("half", "steel", (3.575, 6.096)),
        ("half", "wood", (0.448, 0.722)),
        ("three quarters", "aluminium", (5.679, 8.801)),
        ("a rod at the edge", "steel", (1.543, 3.253)),
        ("a rod at the edge", "glass", (0.549, 1.092)),
        ("a rod that ends", "steel", (0.910, 2.316)),
        ("a ball at the edge", "aluminium", (0.993, 2.406)),
        ("a narrow pad", "aluminium", (3.981, 7.604)),
        ("half of a narrow pad", "aluminium", (2.151, 4.775)),
    ],
)
def test_a_contact_at_an_edge_is_that_of_volumes(
    patch: str, made_of: str, expected: tuple[float, float]
) -> None:
    """The drop of a skinned fingertip after .5 and 2 s, K, by studies/scenes/placed_patches.py."""
    model = mujoco.MjModel.from_xml_string("""
    <mujoco><worldbody>
      <body name="block"><geom type="box" size=".02 .02 .02"/></body>
      <body name="tip" pos="0 0 .1"><geom name="tip" type="box" size=".01 .01 .004"/></body>
    </worldbody></mujoco>""")
    tip = Fingertip("tip", (0, 0, -0.004), (0, 0, -1), (0.02, 0.02), skin="filled_silicone")
    touch = ThermalTouch(model, fingertips={"tip": tip}, objects={"block": made_of}, chain="ideal", air=0.0)
    (low, high), length, conducts, block = PATCHES[patch]
    heat = JoinedHeat(
        touch._pads, (), touch._shapes, worlds=1, dt=0.01, tolerance=0.05, film=0.0, ambient=24.0
    )
    touches, middle, area = np.zeros((1, 1, 2, COLUMNS)), (low + high) / 2, (high - low) * length
    row = touches[0, 0, 0]
    row[[CONDUCTANCE, CLOSED, AREA, LENGTH]] = conducts * area, 1.0, area, area * length
    row[PLACE : PLACE + 3], row[NORMAL : NORMAL + 3] = (-block, 0.0, 0.02), (0.0, 0.0, -1.0)
    row[ASIDE] = area * patch_offset(middle, high - low, FACE)
    row[ENDS] = area * patch_ends(middle - block, block, high - low, 0.04, FACE)
    drops = []
    for _ in range(200):
        heat.advance(touches, 1)
        drops.append(heat.drop[0, 0])
    assert (drops[49], drops[199]) == pytest.approx(expected, abs=0.08)


@pytest.mark.parametrize("shape", ["box", "mesh"])
@pytest.mark.parametrize("skin", [None, "filled_silicone"])
def test_nothing_jumps_where_a_face_slides_over_an_edge(shape: str, skin: str | None) -> None:
    """A pad from the middle of a block to beyond its edge, along either side: the flow of 12 K through a resistance,
    the contact and what heat has still to spread at a second's rate."""
    mesh = (
        ""
        if shape == "box"
        else '<asset><mesh name="m" vertex="'
        + " ".join(f"{x} {y} {z}" for x in (-0.02, 0.02) for y in (-0.02, 0.02) for z in (-0.02, 0.02))
        + '"/></asset>'
    )
    geom = 'type="box" size=".02 .02 .02"' if shape == "box" else 'type="mesh" mesh="m"'
    model = mujoco.MjModel.from_xml_string(f"""
    <mujoco>{mesh}<worldbody><body name="block"><geom {geom} mass="1"/></body>
      <body name="tip" pos="0 0 .0239"><joint type="slide" axis="1 0 0"/><joint type="slide" axis="0 1 0"/>
        <geom name="tip" type="box" size=".01 .01 .004" mass=".1"/></body>
    </worldbody></mujoco>""")
    tip = Fingertip("tip", (0, 0, -0.004), (0, 0, -1), (0.02, 0.02), skin=skin)
    touch = ThermalTouch(model, fingertips={"tip": tip}, objects={"block": "steel"}, chain="ideal", air=0.0)
    data, reader = mujoco.MjData(model), touch._reader
    tables, _, ((own, other),) = narrow_tables([(touch._pads[0], Wall(material("steel")))], LEVEL, 0.01)
    root = np.zeros(LEVEL.rates)
    # Its steepest part is the last tenth of a millimetre, where the flow falls in proportion to what is left.
    places = np.concatenate((np.arange(0.014, 0.0244, 2e-5), np.arange(0.0244, 0.024482, 5e-6)))
    for axis in range(2):
        series = []
        for at in places:
            data.qpos[:] = 0.0
            data.qpos[axis] = at
            mujoco.mj_forward(model, data)
            reader.clear()
            reader.read(data)
            row = reader.touches[0, 0, 0]
            found = 0.0
            if row[AREA] > 0:
                placed = row[ASIDE:BESIDE] / row[AREA]
                length = row[LENGTH] / row[AREA]
                if spread(
                    tables[own], tables[other], (FACE, FACE), row[AREA], length, placed[:2], placed[2:], root
                ):
                    found = float((root**2 / (1.0 + LEVEL.decay)).sum())
                found += 1 / row[CONDUCTANCE]
                series.append(12 / (found + 2.0))
            else:
                series.append(0.0)
        flow = np.array(series)
        assert flow[0] > 2 and flow[-1] < 0.05 * flow[0]  # .02 mm are left
        assert (np.diff(flow) <= 1e-9 + 1e-3 * flow[0]).all()
        assert np.abs(np.diff(flow)).max() < 0.015 * flow[0]


_CORNERS = " ".join(f"{x} {y} {z}" for x in (-0.02, 0.02) for y in (-0.02, 0.02) for z in (-0.02, 0.02))
SIZES = ((0.004, 0.004), (0.006, 0.006), (0.004, 0.02), (0.006, 0.044), (0.009, 0.009), (0.02, 0.02))
"""m along a pad's y and z."""


def _placed(geom: str, size: tuple[float, float], aside: list[float]) -> np.ndarray:
    """(n, 5) shares of a pad that presses so many m aside of a block's middle, and its length over the face's."""
    model = mujoco.MjModel.from_xml_string(f"""
    <mujoco><asset><mesh name="m" vertex="{_CORNERS}"/></asset><worldbody><body name="block"><geom {geom}/></body>
      <body name="tip" pos="0 0 .0239"><joint type="slide" axis="0 1 0"/>
        <geom name="tip" type="box" size="{size[1] / 2} {size[0] / 2} .004" mass=".1"/></body>
    </worldbody></mujoco>""")
    tip = Fingertip("tip", (0, 0, -0.004), (0, 0, -1), size)
    touch = ThermalTouch(model, fingertips={"tip": tip}, objects={"block": "aluminium"})
    data, found, face = mujoco.MjData(model), [], touch._pads[0].silicone.face
    np.testing.assert_allclose(abs(touch._pads[0].axes[1]), [0.0, 1.0, 0.0], atol=1e-12)
    for at in aside:
        data.qpos[0] = at
        mujoco.mj_forward(model, data)
        touch._reader.clear()
        touch._reader.read(data)
        row = touch._reader.touches[0, 0, 0]
        assert row[AREA] > 0
        found.append([*row[ASIDE:BESIDE] / row[AREA], row[LENGTH] / row[AREA] / face])
    return np.array(found)


@pytest.mark.parametrize("size", SIZES)
def test_a_narrow_pad_lies_alike_on_a_box_and_on_its_mesh(size: tuple[float, float]) -> None:
    """In the middle of the sensor's face as long as the block is under all of it, and on without a jump."""
    half = math.sqrt(min(size[0], FACE) * min(size[1], FACE)) / 2
    aside = [0.0, 0.01, 0.02 - half - 1e-5, 0.02 - half + 1e-5, 0.02 - half / 2, 0.02]
    box, mesh = (
        _placed(geom, size, aside) for geom in ('type="box" size=".02 .02 .02"', 'type="mesh" mesh="m"')
    )
    np.testing.assert_allclose(box[4:], mesh[4:], atol=0.05)
    if half < FACE / 2 * (1 - 1e-9):
        np.testing.assert_allclose(box[:4], mesh[:4], atol=0.05)
        np.testing.assert_allclose(box[:2, :4], 0.0, atol=1e-9)
        assert np.abs(box[3] - box[2]).max() < 0.02
        assert (box[-1, :2] < 0.5).all()  # half of it lies on one side of the sensor's middle, not at its end


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


def test_wherever_contacts_are_nothing_grows_and_no_heat_is_lost(touch: ThermalTouch) -> None:
    """Any rectangle anywhere, at every sample another one, also such as no reader tells."""
    rng = np.random.default_rng(6)
    heat = JoinedHeat(
        touch._pads, (), touch._shapes, worlds=1, dt=0.01, tolerance=0.05, film=0.0, ambient=24.0
    )
    touches = np.zeros((1, 1, 2, COLUMNS))
    row = touches[0, 0, 0]
    row[PLACE : PLACE + 3], row[NORMAL : NORMAL + 3], row[CLOSED] = (0.03, 0, 0), (-1, 0, 0), 1.0
    for _ in range(2000):
        first, second = 10.0 ** rng.uniform(-9, -1, 2)
        row[CONDUCTANCE], row[AREA] = 10.0 ** rng.uniform(-6, 3), first * second
        row[LENGTH], row[ASIDE:BESIDE] = row[AREA] * second, row[AREA] * rng.uniform(-0.5, 1.5, 4)
        heat.advance(touches, 1)
        assert 0 <= heat.drop[0, 0] <= touch._pads[0].temperature - 24.0
    balance = heat.balance(0)
    assert balance.objects.sum() == pytest.approx(balance.given.sum(), rel=1e-10)
    assert np.isfinite(heat.state().narrow).all()


def test_nearer_an_end_there_is_more_to_spread(pad: PadPlace) -> None:
    for shares in ((0.0, 0.0), (1.0, 0.0), (1.0, 1.0)):
        aside = np.array(shares)
        narrow = [
            added(pad, material("steel"), p * 0.004, 0.004, aside, aside)[0] for p in (0.001, 0.002, 0.004)
        ]
        assert narrow[0] > narrow[1] > narrow[2] > 0
    steps = np.linspace(0.0, 1.0, 11)
    found = [added(pad, material("steel"), 8e-6, 0.004, np.array([x, 0]), np.array([x, 0]))[0] for x in steps]
    assert (np.diff(found) > 0).all()


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


BAR = """<mujoco><option gravity="0 0 0"/><worldbody>
  <body name="bar"><geom type="box" size="{half} .02 .02" pos="{middle} 0 0"/></body>
  <body name="tip" pos="0 0 .0241"><joint type="slide" axis="0 0 -1" damping="20"/>
    <geom name="pad" type="box" size=".01 .01 .004" mass=".1"/></body>
</worldbody><actuator><motor joint="{joint}"/></actuator></mujoco>"""


def over_a_bar(first: float, last: float, made_of: str) -> float:
    """K of a skinned pad over a bar from first to last m across, after a second; its sensor reaches 4.5 mm to each
    side."""
    text = BAR.format(half=(last - first) / 2, middle=(first + last) / 2, joint="down")
    model = mujoco.MjModel.from_xml_string(text.replace("<joint type", '<joint name="down" type'))
    data = mujoco.MjData(model)
    tip = Fingertip("pad", skin="filled_silicone")
    touch = ThermalTouch(model, fingertips={"tip": tip}, objects={"bar": made_of}, chain="ideal")
    data.ctrl[:] = 10.0
    for _ in range(500):
        mujoco.mj_step(model, data)
        touch.update(data)
    return float(touch.reading.temperature_drop[0])


@pytest.mark.parametrize("made_of", ["glass", "wood", "aluminium"])
def test_what_a_bar_has_beyond_the_face_counts_little(made_of: str) -> None:
    """As much of the sensor's face is covered by all of them, from one end of the bar to beside the face's end."""
    drops = np.array(
        [over_a_bar(-2e-3, last * 1e-3, made_of) for last in (4.5, 5.0, 6.0, 6.5, 7.0, 9.0, 20.0)]
    )
    assert drops.max() / drops.min() < 1.04


@pytest.mark.parametrize("made_of", ["glass", "aluminium"])
def test_a_bar_that_leaves_the_face_is_felt_less_and_less(made_of: str) -> None:
    """Nearly by as much as it covers less of it."""
    offsets = np.array([0.5, 1.0, 1.5, 2.0, 3.0, 4.0, 5.0]) * 1e-3
    drops = np.array([over_a_bar(off - 4e-3, off + 4e-3, made_of) for off in offsets])
    assert (np.diff(drops) < 0).all()
    if made_of == "glass":
        covered = (8.5e-3 - offsets) / 8e-3
        assert (np.abs(drops / drops[0] - covered) < 0.12).all()
