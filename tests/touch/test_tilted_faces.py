"""Flat faces that lie at an angle on a flat pad, beside sums over strips of the same springs and gap, and in scenes."""

# mujoco ships no type stubs for its compiled names
# pyright: reportAttributeAccessIssue=false

from __future__ import annotations

import itertools
import math
from typing import Any

import mujoco
import numpy as np
import pytest
from scipy.optimize import brentq

from thermograsp.thermal import IDEAL
from thermograsp.thermal.contact import array_laws, contact
from thermograsp.touch import Fingertip, ThermalTouch, install
from thermograsp.touch.contacts import pair_laws
from thermograsp.touch.contacts.tilt import (
    ALIGNED,
    FIRM,
    GAP,
    SOFT,
    TURN,
    array_edge_patch,
    array_edged,
    array_fall,
    edge_patch,
    edged,
    fall,
)
from thermograsp.touch.scene import bodies, pads

from .engine_scene import NEEDS_COMPILER, NEEDS_SPECS

SCENE = """
<mujoco><option timestep=".002" gravity="0 0 0"/><worldbody>
  <body name="object" euler="{} {} 0"><geom name="block" type="box" size=".02 .02 .02"/></body>
  <body name="finger" pos="{} 0 {}"><joint name="down" type="slide" axis="0 0 -1" damping="20"/>
    <geom name="tip" type="box" size=".01 .01 .004" mass=".1"/></body>
</worldbody><actuator><motor joint="down"/></actuator></mujoco>"""
PAD = {"position": (0.0, 0.0, -0.004), "normal": (0.0, 0.0, -1.0), "size": (0.02, 0.02)}


def scene(about_y: float, aside: float = 0.0, about_x: float = 0.0) -> str:
    c, s = math.cos(math.radians(about_y)), math.sin(math.radians(abs(about_y)))
    turned = math.cos(math.radians(about_x)) * c + math.sin(math.radians(abs(about_x))) + s
    return SCENE.format(about_x, about_y, aside, 0.02 * turned + 0.0045)


def law_of(skin: str | None, geom: str = "box") -> tuple[np.ndarray, np.void]:
    """Of the pad on the block's upper face."""
    model = mujoco.MjModel.from_xml_string(scene(0.0).replace('name="block" type="box"', f'type="{geom}"'))
    shapes = bodies(model, {"object": "steel"}, 24.0)
    found = pair_laws(model, pads(model, {"tip": Fingertip("tip", skin=skin, **PAD)}, shapes), shapes)
    return found.tilts[0, 0, 2], found.laws[0, 0, 2]


def part_of(
    tilt: np.ndarray, law: np.void, force: float, place: np.ndarray, rise: tuple[float, float]
) -> Any:
    area, share = contact(law, force, place)
    return area, share, *edged(tilt, law, force, force, share, place[0], place[1], *rise)[:2]


@pytest.mark.parametrize("aside", [0.0, 0.012, 0.019])
@pytest.mark.parametrize("residual", [0.003, 0.02, 0.1])
@pytest.mark.parametrize("force", [2.0, 10.0, 40.0])
def test_a_skin_touches_as_far_as_its_springs_and_the_silicone_s_hold(
    force: float, residual: float, aside: float
) -> None:
    """The gap grows towards the block's middle: the end of the pad, or the block's edge, is the lowest."""
    tilt, law = law_of("filled_silicone")
    slope = residual + ALIGNED + tilt[TURN] * force
    place = np.array([-aside, 0.0, 0.024])
    area, share, part, pressed = part_of(tilt, law, force, place, (slope, 0.0))
    start, end = max(-0.01, aside - 0.02), 0.01
    begin = max(start, -0.0045)
    reach, width = begin - start, 0.0045 - begin
    s = np.linspace(0.0, width, 20_001)

    def borne(long: float) -> float:
        skin = tilt[FIRM] * residual * 0.009 * np.trapezoid(np.maximum(long - s, 0), s)
        soft = tilt[SOFT] * residual * 0.02 * (reach * reach / 2 + reach * long)
        return skin + soft

    assert area == pytest.approx(width * 0.009) and end > start
    if borne(0.0) > force:
        assert (part, pressed) == (0.0, 0.0)
        return
    long: Any = brentq(lambda long: borne(long) - force, 0.0, 10.0)
    skin = tilt[FIRM] * residual * 0.009 * np.trapezoid(np.maximum(long - s, 0), s)
    assert part == pytest.approx(min(long / width, 1.0), rel=1e-6)
    assert pressed == pytest.approx(min(skin, share), rel=1e-6)


@pytest.mark.parametrize("residual", [1e-5, 1e-3, 0.03, 0.4])
def test_gas_beside_an_edge_on_a_bare_face_is_that_of_its_gap(residual: float) -> None:
    tilt, law = law_of(None)
    force = 5.0
    slope = residual + ALIGNED + tilt[TURN] * force
    _, _, part, pressed = part_of(tilt, law, force, np.array([-0.0155, 0.0, 0.024]), (slope, 0.0))
    # the block's edge is that of the face
    gap = np.geomspace(1e-9, 0.009, 200_001)
    mean = np.trapezoid(tilt[GAP] / (tilt[GAP] + residual * gap), gap) / 0.009
    assert part == pytest.approx(mean, rel=1e-4)
    assert 0 < pressed <= force


@pytest.mark.parametrize("skin", [None, "filled_silicone"])
def test_what_is_aligned_is_as_it_was(skin: str | None) -> None:
    tilt, law = law_of(skin)
    for rise in ((0.0, 0.0), (0.04, 0.0), (-0.02, 0.03)):
        _, share, part, pressed = part_of(tilt, law, 5.0, np.array([0.002, 0.001, 0.024]), rise)
        assert (part, pressed) == (1.0, share)
    beyond = ALIGNED + tilt[TURN] * 5.0 + 1e-6
    _, share, part, pressed = part_of(tilt, law, 5.0, np.array([0.002, 0.001, 0.024]), (beyond, 0.0))
    assert (part, pressed) == pytest.approx((1.0, share), rel=2e-2)


def test_arrays_do_as_compiled_code_does() -> None:
    rng = np.random.default_rng(0)
    count, narrow = 300, 0
    for skin, geom in itertools.product((None, "filled_silicone"), ("box", "cylinder")):
        tilt, law = law_of(skin, geom)
        place = np.column_stack((rng.uniform(-0.022, 0.022, (count, 2)), np.full(count, 0.024)))
        rises = rng.uniform(-0.4, 0.4, (count, 2)) * (rng.random((count, 2)) < 0.7)
        force = 10 ** rng.uniform(-2, 2, count)
        together, given = force * rng.choice([1.0, 3.0], count), rises
        level = [contact(law, *each) for each in zip(force, place, strict=True)]
        area, share = np.array(level).T
        laws, tilts = array_laws(np.repeat(law, count), np.zeros(0)), np.tile(tilt, (count, 1))
        at, rises = array_fall(tilts, laws, place, rises)
        found = array_edged(tilts, laws, force, together, share, at, rises)
        length, shares = array_edge_patch(laws, at, rises, found[0], np.zeros(count), np.zeros((count, 4)))
        for n in range(count):
            if area[n] == 0:
                continue
            row = fall(tilt, place[n, 0], place[n, 1], *given[n])
            np.testing.assert_allclose(np.concatenate((at[n], rises[n])), row, rtol=1e-12, atol=1e-15)
            expected = edged(tilt, law, force[n], together[n], share[n], *row)
            np.testing.assert_allclose([each[n] for each in found], expected, rtol=1e-9, atol=1e-15)
            if 0 < expected[0] < 1 - 1e-9:
                of, narrow = np.zeros(4), narrow + 1
                long = edge_patch(law, *row, expected[0], of)
                assert length[n] == pytest.approx(long, rel=1e-9)
                np.testing.assert_allclose(shares[n], of, rtol=1e-7, atol=1e-9)
    assert narrow > 300


def drop(skin: str | None, degrees: float, aside: float = 0.0, about_x: float = 0.0) -> float:
    """K after a second at 10 N on aluminium."""
    model = mujoco.MjModel.from_xml_string(scene(degrees, aside, about_x))
    data = mujoco.MjData(model)
    tip = {"tip": Fingertip("tip", skin=skin, **PAD)}
    touch = ThermalTouch(model, fingertips=tip, objects={"object": "aluminium"}, chain=IDEAL)
    data.ctrl[0], reading = 10.0, touch.reading
    for _ in range(500):
        mujoco.mj_step(model, data)
        reading = touch.update(data)
    return float(reading.temperature_drop[0])


@pytest.mark.parametrize("skin", [None, "filled_silicone"])
def test_a_block_that_stands_on_its_edge_is_felt_less_and_less(skin: str | None) -> None:
    """It was felt as lying flat up to 45 degrees."""
    drops = [drop(skin, degrees) for degrees in (0.0, 2.0, 4.0, 6.0, 8.0, 15.0)]
    assert drops[1] == pytest.approx(drops[0], abs=0.1)
    assert all(after < before + 0.01 for before, after in zip(drops[1:-1], drops[2:], strict=True))
    assert drops[0] > 8.0 and drops[-1] < 0.5
    assert drop(skin, -8.0) == pytest.approx(drops[4], abs=0.02)
    assert drop(skin, 0.0, about_x=8.0) == pytest.approx(drops[4], abs=0.02)


def test_an_edge_under_the_sensor_is_felt_more_than_one_beside_it() -> None:
    """The block's upper edge presses on a skinned face, or on silicone beside it."""
    over = 0.02 * (math.cos(math.radians(15)) - math.sin(math.radians(15)))
    assert (
        drop("filled_silicone", -15.0, aside=over - 0.004) > drop("filled_silicone", -15.0, aside=0.0) + 0.2
    )


@NEEDS_COMPILER
@NEEDS_SPECS
@pytest.mark.parametrize("skin", [None, "filled_silicone"])
@pytest.mark.parametrize(("about_y", "about_x"), [(5.0, 0.0), (-6.0, 3.0), (0.0, 12.0)])
def test_the_plugin_feels_the_same(about_y: float, about_x: float, skin: str | None) -> None:
    words: dict[str, Any] = {
        "fingertips": {"tip": Fingertip("tip", skin=skin, **PAD)},
        "objects": {"object": "aluminium"},
    }
    model = install(mujoco.MjSpec.from_string(scene(about_y, 0.017, about_x)), **words)
    data, touch = mujoco.MjData(model), ThermalTouch(model, **words, chain=IDEAL)
    data.ctrl[0], reading = 8.0, touch.reading
    for _ in range(150):
        mujoco.mj_step(model, data)
        reading = touch.update(data)
    mujoco.mj_forward(model, data)
    found = data.sensor("heat").data / touch._pads[0].stack.seebeck
    assert found == pytest.approx(reading.temperature_drop, abs=1e-9)


@pytest.mark.parametrize("skin", [None, "filled_silicone"])
def test_a_cylinder_s_end_has_no_axes(skin: str | None) -> None:
    tilt, law = law_of(skin, "cylinder")
    found = []
    for turn in np.linspace(0.0, math.pi, 7):
        c, s = math.cos(turn), math.sin(turn)
        row = fall(tilt, 0.014 * c, 0.014 * s, 0.12 * c, 0.12 * s)
        found.append(edged(tilt, law, 60.0, 5.0, 50.0, *row))
    np.testing.assert_allclose(found, [found[0]] * 7, rtol=1e-9)
    assert 0 < found[0][0] < 1


def test_an_object_s_geoms_turn_the_pad_together() -> None:
    """A face of two boxes lets the pad turn as far as one box of both."""
    tilt, law = law_of(None)
    share, slope = 4.0, ALIGNED + tilt[TURN] * 10.0 - 1e-6
    assert edged(tilt, law, 5.0, 10.0, share, 0.0, 0.0, slope, 0.0) == (1.0, share, 1.0)
    assert edged(tilt, law, 5.0, 5.0, share, 0.0, 0.0, slope, 0.0)[0] < 0.5


def test_a_pad_around_the_sensor_is_off_the_block_too() -> None:
    given = []
    for degrees in (0.0, 12.0):
        model = mujoco.MjModel.from_xml_string(scene(degrees))
        data, tip = mujoco.MjData(model), {"tip": Fingertip("tip", surround="silicone", **PAD)}
        touch = ThermalTouch(model, fingertips=tip, objects={"object": "aluminium"}, chain=IDEAL)
        data.ctrl[0] = 10.0
        for _ in range(300):
            mujoco.mj_step(model, data)
            touch.update(data)
        given.append(touch.balance.given.sum())
    assert 0 < given[1] < 0.2 * given[0]
