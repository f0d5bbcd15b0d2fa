"""Fingertips that are round: the contact of two curved bodies by closed forms and integrals, in whatever scene."""

# mujoco ships no type stubs for its compiled names
# pyright: reportAttributeAccessIssue=false

from __future__ import annotations

import math
import os
import shutil
from typing import Any

import mujoco
import numpy as np
import pytest
from scipy.optimize import brentq

from thermograsp.thermal import IDEAL, Pad
from thermograsp.thermal.contact import (
    Wedge,
    array_wedge_gas,
    cylinder_contact,
    sphere_contact,
    wedge_gas,
)
from thermograsp.touch import Fingertip, ThermalTouch, install
from thermograsp.touch.contacts.round_pads import ALIGNED, WIDE, array_round_contact, round_contact
from thermograsp.touch.scene import bodies, pads

PAD = Pad()
STIFFNESS = PAD.foundation_modulus / PAD.thickness
ALONG = np.array([1.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 0.0])


def bend(first: float, second: float, half: float = PAD.width / 2, face: float = PAD.face / 2) -> np.ndarray:
    return np.array([first, second, STIFFNESS, half, half, face, face, STIFFNESS, half, half])


def turned(degrees: float) -> np.ndarray:
    c, s = math.cos(math.radians(degrees)), math.sin(math.radians(degrees))
    return np.array([c, s, -s, c, 0.0, 0.0, 0.0, 0.0])


def rising(slope: float) -> np.ndarray:
    return np.array([1.0, 0.0, 0.0, 1.0, 0.0, slope, 0.0, 0.0])


def body(first: float, second: float, half_first: float = WIDE, half_second: float = WIDE) -> np.ndarray:
    """An object's curvatures 1/m and half lengths m."""
    return np.array([first, second, half_first, half_second, 0.0, WIDE, WIDE])


FORCES = 0.05, 0.5, 5.0, 50.0


@pytest.mark.parametrize("force", FORCES)
def test_a_ball_on_a_ball_is_one_of_their_summed_curvatures_on_a_plane(force: float) -> None:
    """sphere_contact's disc is cut off by the face as round_contact's ellipse is; both solve one load."""
    found = round_contact(bend(120.0, 120.0), body(30.0, 30.0), ALONG, force, 0.0, 0.0)
    expected = sphere_contact(PAD, force, 1 / 150.0)
    assert found[0] == pytest.approx(float(expected.face), rel=1e-9)
    assert found[1] == pytest.approx(float(expected.face_force), rel=1e-9)
    assert found[2] == 1.0 and found[3] == pytest.approx(1.0)


@pytest.mark.parametrize("force", FORCES)
def test_rods_along_one_another_meet_in_a_line_and_across_in_a_spot(force: float) -> None:
    rod, other = bend(100.0, 0.0), body(30.0, 0.0, WIDE, 0.05)
    along = round_contact(rod, other, ALONG, force, 0.0, 0.0)
    line = cylinder_contact(PAD, force, 1 / 130.0)
    assert along[0] == pytest.approx(float(line.face), rel=1e-4)  # what is straight counts as a little curved
    across = round_contact(rod, other, turned(90.0), force, 0.0, 0.0)
    if force < 1:  # an ellipse within the face: area 2 pi D/sqrt(k1 k2), load pi D^2 K/(d sqrt(k1 k2))
        root = math.sqrt(100.0 * 30.0)
        assert across[0] == pytest.approx(2 * math.sqrt(math.pi * force / (STIFFNESS * root)), rel=1e-9)
        assert across[1] == pytest.approx(force, rel=1e-9)
        assert across[0] < along[0]
        assert across[3] == pytest.approx(math.sqrt(100.0 / 30.0), rel=1e-9)
        assert along[3] > 4


@pytest.mark.parametrize("degrees", [0.0, 20.0, 45.0, 70.0])
def test_crossed_rods_follow_hertz_s_curvatures(degrees: float) -> None:
    """k1 k2 = A B sin^2 of the angle between two cylinders of curvatures A and B (Johnson, section 4.1)."""
    rod, other = bend(100.0, 0.0, WIDE, WIDE), body(60.0, 0.0)
    force = 1e-3
    area = round_contact(rod, other, turned(degrees + 10), force, 0.0, 0.0)[0]
    root = math.sqrt(100.0 * 60.0) * math.sin(math.radians(degrees + 10))
    assert area == pytest.approx(2 * math.sqrt(math.pi * force / (STIFFNESS * root)), rel=1e-9)


@pytest.mark.parametrize("force", FORCES)
@pytest.mark.parametrize("curvatures", [(300.0, 40.0), (90.0, 1.0), (500.0, 500.0)])
def test_area_and_load_are_integrals_of_the_pressure(force: float, curvatures: tuple[float, float]) -> None:
    """By summing the pressure over 700 x 700 cells of the pad; D from the load that round_contact was given."""
    half, face, cells = 0.006, 0.004, 700
    area, load, *_ = round_contact(bend(*curvatures, half, face), body(0.0, 0.0), ALONG, force, 0, 0)
    middles = (np.arange(cells) + 0.5) / cells * half
    gap = middles[:, None] ** 2 * curvatures[0] / 2 + middles[None] ** 2 * curvatures[1] / 2
    cell = 4 * STIFFNESS * (half / cells) ** 2

    def whole(depth: float) -> float:
        return float(np.maximum(depth - gap, 0.0).sum()) * cell

    low, high = 0.0, 0.02
    for _ in range(40):
        middle = (low + high) / 2
        low, high = (middle, high) if whole(middle) < force else (low, middle)
    on = np.ix_(middles < face, middles < face)
    assert load == pytest.approx(float(np.maximum(low - gap[on], 0.0).sum()) * cell, rel=2e-3)
    assert area == pytest.approx(float((gap[on] < low).sum()) * 4 * (half / cells) ** 2, rel=5e-3)


def test_arrays_do_as_compiled_code_does() -> None:
    rng = np.random.default_rng(0)
    count = 1500
    bend_ = np.column_stack(
        (rng.uniform(0, 400, (count, 2)) * (rng.random((count, 2)) < 0.7), np.full(count, STIFFNESS),
         rng.uniform(0.003, 0.01, (count, 2)), rng.uniform(0.002, 0.003, (count, 2)),
         STIFFNESS * rng.choice([0.2, 1.0], count), rng.uniform(0.01, 0.015, (count, 2)))
    )  # fmt: skip
    bend_[:, 0] += 1.0
    curve = np.column_stack(
        (
            rng.uniform(0, 100, (count, 2)) * (rng.random((count, 2)) < 0.5),
            rng.uniform(0.002, 0.1, (count, 2)),
            np.zeros(count),
            np.full((count, 2), WIDE),
        )
    )
    sides = np.array([turned(angle) for angle in rng.uniform(-180, 180, count)])
    sides[:, 4:6] = rng.uniform(-0.12, 0.12, (count, 2)) * (rng.random((count, 1)) < 0.7)
    force = 10 ** rng.uniform(-3, 2, count)
    y, z = rng.uniform(-0.006, 0.006, (2, count))
    told = [round_contact(*row) for row in zip(bend_, curve, sides, force, y, z, strict=True)]
    expected, wedges = np.array([each[:5] for each in told]), [each[5] for each in told]
    axes, rise = sides[:, :4].reshape(count, 2, 2), sides[:, 4:6]
    *numbers, wedge = array_round_contact(bend_, curve, axes, rise, force, y, z)
    found = np.stack(numbers, axis=1)
    assert ((sides[:, 4] != 0) & (bend_[:, 1] == 0) & (curve[:, :2].sum(1) == 0)).sum() > 40
    np.testing.assert_allclose(found[:, :2], expected[:, :2], rtol=1e-7, atol=1e-15)
    np.testing.assert_allclose(found[:, 2], expected[:, 2], rtol=1e-7, atol=1e-12)
    np.testing.assert_allclose(found[:, 3:], expected[:, 3:], rtol=1e-7)
    np.testing.assert_allclose(np.transpose(wedge), wedges, rtol=1e-7, atol=1e-12)
    for gap in (2e-6, 1e-4):
        (gas,) = array_wedge_gas(wedge, [np.full(count, gap)])
        np.testing.assert_allclose(gas, [wedge_gas(each, gap) for each in wedges], rtol=1e-7)


def summed_springs(rod: np.ndarray, curvature: float, force: float, angle: float) -> tuple[float, float]:
    """Area and force on the face of a rod that leans, from the pressure over strips across it."""
    _, _, firm, _, _, face, _, soft, reach, half = rod
    s = np.linspace(0, 2 * half, 100_001)
    on = (s >= half - face) & (s <= half + face)
    stiffness = np.where(on, firm, soft)

    def strips(depth: float, most: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        sunk = np.where(on | (soft == firm), depth, min(depth, (half + face) * angle))
        sunk = np.maximum(sunk - angle * s, 0)
        wide = np.minimum(np.sqrt(2 * sunk / curvature), most)
        return 2 * wide, 2 * stiffness * (sunk * wide - curvature * wide**3 / 6)

    whole = np.where(on & (soft < firm), face, reach)
    depth: Any = brentq(lambda depth: np.trapezoid(strips(depth, whole)[1], s) - force, 1e-9, 0.1)
    area, load = strips(depth, np.minimum(whole, face))
    return float(np.trapezoid(np.where(on, area, 0), s)), float(np.trapezoid(np.where(on, load, 0), s))


@pytest.mark.parametrize("force", [0.5, 5.0, 50.0])
@pytest.mark.parametrize("degrees", [1e-4, 0.1, 1.0, 4.0])
@pytest.mark.parametrize("skinned", [False, True])
def test_a_rod_that_leans_presses_its_lower_end(skinned: bool, degrees: float, force: float) -> None:
    half = (0.0045, 0.0045) if skinned else (0.0064, 0.012)
    rod = np.array(
        [125.0, 0, STIFFNESS, *half, 0.0045, 0.0045, STIFFNESS / (6 if skinned else 1), 0.0064, 0.012]
    )
    flat, angle = body(0.0, 0.0), math.tan(math.radians(degrees))
    area, load, share, *_ = round_contact(rod, flat, rising(ALIGNED + angle), force, 0.0, 0.0)
    assert (area, load) == pytest.approx(summed_springs(rod, 125.0, force, angle), rel=2e-3, abs=1e-12)
    assert share == (1.0 if area > 0 else 0.0)
    if degrees < 1e-3:
        level = round_contact(rod, flat, ALONG, force, 0.0, 0.0)
        assert (area, load) == pytest.approx(level[:2], rel=1e-4)


def summed_gas(wedge: Wedge, gap: float) -> float:
    """What wedge_gas is, cell by cell."""
    x, y = (
        (np.arange(4000) + 0.5) / 4000 * (far - near) + near
        for near, far in ((wedge.left, wedge.right), (wedge.lower, wedge.upper))
    )
    deep = (
        wedge.depth - wedge.slope * y[:, None] - wedge.bend * y[:, None] ** 2 / 2 - wedge.curvature * x**2 / 2
    )
    conducts = np.where(deep < 0, 1 / (gap - np.minimum(deep, 0.0)), 0.0)
    return float(conducts.mean() * (wedge.right - wedge.left) * (wedge.upper - wedge.lower))


@pytest.mark.parametrize("gap", [2e-6, 1e-5, 1e-4])
@pytest.mark.parametrize(
    "wedge",
    [
        Wedge(1e-4, 0.0, 50.0, 50.0, -0.0045, 0.0045, -0.0045, 0.0045),
        Wedge(3e-5, 0.0, 1e-5, 125.0, -0.0045, 0.0045, -0.0045, 0.0045),
        Wedge(3e-5, 0.0, 20.0, 125.0, -0.002, 0.007, 0.001, 0.008),
        Wedge(5e-5, 0.0, 50.0, 50.0, -0.008, -0.0025, -0.004, 0.005),
        Wedge(1e-4, 0.05, 0.0, 125.0, -0.003, 0.006, 0.0, 0.009),
        Wedge(-1e-4, 0.05, 0.0, 125.0, -0.0045, 0.0045, 0.0, 0.009),
    ],
)
def test_gas_beside_round_bodies_is_the_sum_over_the_face(wedge: Wedge, gap: float) -> None:
    assert wedge_gas(wedge, gap) == pytest.approx(summed_gas(wedge, gap), rel=5e-3)


TIPS = {
    "ball": '<geom name="tip" type="sphere" size=".008" mass=".1"/>',
    "capsule": '<geom name="tip" type="capsule" size=".008 .012" euler="0 90 0" mass=".1"/>',
    "short capsule": '<geom name="tip" type="capsule" size=".008 .003" euler="0 90 0" mass=".1"/>',
    "upright capsule": '<geom name="tip" type="capsule" size=".008 .012" mass=".1"/>',
    "egg": '<geom name="tip" type="ellipsoid" size=".008 .012 .01" mass=".1"/>',
    "rod": '<geom name="tip" type="cylinder" size=".008 .01" euler="0 90 0" mass=".1"/>',
}
OBJECTS = {
    "block": ('<geom name="thing" type="box" size=".02 .02 .02"/>', 0.02),
    "ball": ('<geom name="thing" type="sphere" size=".025"/>', 0.025),
    "can": ('<geom name="thing" type="cylinder" size=".03 .04" euler="90 0 0"/>', 0.03),
    "can along": ('<geom name="thing" type="cylinder" size=".03 .04" euler="0 90 0"/>', 0.03),
}
SCENE = """
<mujoco><option timestep=".002" gravity="0 0 0"/><worldbody>
  <body name="object">{target}</body>
  <body name="finger" pos="0 0 {height}"><joint name="down" type="slide" axis="0 0 -1" damping="20"/>{tip}</body>
</worldbody><actuator><motor joint="down"/></actuator></mujoco>"""


def scene(tip: str, target: str) -> str:
    geom, top = OBJECTS[target]
    height = top + (0.0225 if tip == "upright capsule" else 0.0125 if tip == "egg" else 0.0085)
    return SCENE.format(tip=TIPS[tip], target=geom, height=height)


@pytest.mark.parametrize(
    ("tip", "size", "bent"),
    [
        ("ball", (0.0128, 0.0128), (125.0, 125.0)),
        ("capsule", (0.0128, 0.024), (125.0, 0.0)),
        ("short capsule", (0.0128, 0.0128), (125.0, 0.008 / 0.011**2)),
        ("upright capsule", (0.0128, 0.0128), (125.0, 125.0)),
        ("egg", (0.0128, 0.0128), (0.01 / 0.008**2, 0.01 / 0.012**2)),
        ("rod", (0.0128, 0.02), (125.0, 0.0)),
    ],
)
def test_a_round_fingertip_s_pad_is_as_curved_as_it(
    tip: str, size: tuple[float, float], bent: tuple[float, float]
) -> None:
    model = mujoco.MjModel.from_xml_string(scene(tip, "block"))
    (pad,) = pads(model, {"tip": "tip"}, bodies(model, {"object": "glass"}, 24.0))
    np.testing.assert_allclose(pad.size, size, atol=1e-12)
    np.testing.assert_allclose(pad.curvature, bent, rtol=1e-9)
    np.testing.assert_allclose(pad.axes[:, 0], (0, 0, -1), atol=1e-9)
    np.testing.assert_allclose(pad.axes.T @ pad.axes, np.eye(3), atol=1e-12)
    assert np.linalg.det(pad.axes) == pytest.approx(1.0)
    (flat,) = pads(
        model,
        {"tip": Fingertip("tip", tuple(pad.position), (0, 0, -1), (0.01, 0.01))},
        bodies(model, {"object": "glass"}, 24.0),
    )
    assert flat.curvature == (0.0, 0.0)


def dropped(tip: str | Fingertip, geometry: str, target: str = "block") -> float:
    model = mujoco.MjModel.from_xml_string(scene(geometry, target))
    data = mujoco.MjData(model)
    touch = ThermalTouch(model, fingertips={"tip": tip}, objects={"object": "aluminium"}, chain=IDEAL)
    data.ctrl[0], reading = 5.0, touch.reading
    for _ in range(500):
        mujoco.mj_step(model, data)
        reading = touch.update(data)
    assert reading.force[0] == pytest.approx(5.0, rel=0.05)
    return float(reading.temperature_drop[0])


def test_a_round_fingertip_feels_less_than_a_flat_one_and_the_less_the_rounder_the_object() -> None:
    flat = dropped(Fingertip("tip", (0, 0, -0.008), (0, 0, -1), (0.0128, 0.0128)), "ball")
    on_block, on_ball = dropped("tip", "ball"), dropped("tip", "ball", "ball")
    assert flat > 1.2 * on_block > 1.2 * on_ball > 0.1


def test_a_rod_feels_less_along_a_can_than_on_a_block_and_more_across_it() -> None:
    """Along either, 9 of its 24 mm press on the sensor's face, with 9/24 of the force; across, all of it does."""
    on_block, along, across = (dropped("tip", "capsule", target) for target in ("block", "can along", "can"))
    assert (along, on_block, across) == pytest.approx((5.1, 5.3, 6.1), abs=0.06)  # as docs/plugin.md has them
    rod = np.array([125.0, 0.0, STIFFNESS, 0.0064, 0.012, 0.0045, 0.0045, STIFFNESS, 0.0064, 0.012])
    can = body(1 / 0.03, 0.0, WIDE, 0.04)
    assert round_contact(rod, can, ALONG, 5.0, 0.0, 0.0)[1] == pytest.approx(5.0 * 9 / 24, rel=1e-4)
    assert round_contact(rod, can, turned(90.0), 5.0, 0.0, 0.0)[1] == pytest.approx(5.0, rel=1e-3)


@pytest.mark.parametrize("skin", [None, "filled_silicone"])
@pytest.mark.parametrize("tip", ["capsule", "rod"])
def test_a_rod_that_leans_feels_less_and_less(tip: str, skin: str | None) -> None:
    """Held down at an angle, from flat to where the sensor's face is off the block."""
    drops = []
    for degrees in (0.0, 2.0, 3.0, 3.5, 4.0, 5.0, 6.5, 14.0):
        xml = scene(tip, "block").replace('<body name="finger"', f'<body name="finger" euler="0 {degrees} 0"')
        words: dict[str, Any] = {
            "fingertips": {"tip": Fingertip("tip", skin=skin)},
            "objects": {"object": "glass"},
        }
        model = mujoco.MjModel.from_xml_string(xml.replace('axis="0 0 -1"', f'axis="{lowered(degrees)}"'))
        data, touch = mujoco.MjData(model), ThermalTouch(model, **words, chain=IDEAL)
        data.ctrl[0], reading = 10.0, touch.reading
        for _ in range(250):
            mujoco.mj_step(model, data)
            reading = touch.update(data)
        drops.append(float(reading.temperature_drop[0]))
    steps = np.diff(drops)
    assert drops[0] > 0.4 and 0 < drops[-1] < 0.05  # through the gas
    assert (steps < 0.005).all() and steps.min() > -0.75 * drops[0]


def lowered(degrees: float) -> str:
    """Straight down in the frame of a body that is turned by so much about y."""
    turn = math.radians(degrees)
    return f"{math.sin(turn)} 0 {-math.cos(turn)}"


@pytest.mark.skipif(shutil.which(os.environ.get("CC", "cc")) is None, reason="needs a C compiler")
@pytest.mark.skipif(
    not hasattr(mujoco.MjSpec, "activate_plugin"), reason="specs take plugins from MuJoCo 3.3.2 on"
)
@pytest.mark.parametrize("tip", TIPS)
@pytest.mark.parametrize("target", OBJECTS)
@pytest.mark.parametrize(("degrees", "skin"), [(0.0, None), (3.2, None), (3.2, "filled_silicone")])
def test_inside_mujoco_s_step_it_is_the_same(tip: str, target: str, degrees: float, skin: str | None) -> None:
    words: dict[str, Any] = {
        "fingertips": {"tip": Fingertip("tip", skin=skin)},
        "objects": {"object": "glass"},
    }
    leaning = scene(tip, target).replace('<body name="finger"', f'<body name="finger" euler="0 {degrees} 0"')
    model = install(mujoco.MjSpec.from_string(leaning), **words)
    data, touch = mujoco.MjData(model), ThermalTouch(model, **words, chain=IDEAL)
    data.ctrl[0], reading = 5.0, touch.reading
    for _ in range(100):
        mujoco.mj_step(model, data)
        reading = touch.update(data)
    mujoco.mj_forward(model, data)
    drop = data.sensor("heat").data / touch._pads[0].stack.seebeck
    assert reading.touching == ("object",)
    assert drop == pytest.approx(reading.temperature_drop, abs=1e-9)
    assert drop[0] > 0.02


def test_two_round_fingertips_feel_one_another() -> None:
    other = '<geom name="thing" type="capsule" size=".01 .02" euler="0 90 0"/>'
    other += '<geom name="far" type="box" size=".01 .01 .01" pos=".2 0 0"/>'
    model = mujoco.MjModel.from_xml_string(SCENE.format(tip=TIPS["ball"], target=other, height=0.0185))
    data = mujoco.MjData(model)
    fingers = {"tip": "tip", "other": Fingertip("thing", temperature=30.0)}
    touch = ThermalTouch(model, fingertips=fingers, objects={"far": "glass"}, chain=IDEAL)
    data.ctrl[0], reading = 5.0, touch.reading
    for _ in range(300):
        mujoco.mj_step(model, data)
        reading = touch.update(data)
    assert reading.touching == ("other", "tip")
    assert reading.temperature_drop[0] > 0.05 > -0.05 > reading.temperature_drop[1]


def after_a_press(model: mujoco.MjModel) -> float:
    """K on glass after a fifth of a second at 5 N."""
    words: dict[str, Any] = {"fingertips": {"tip": "tip"}, "objects": {"object": "glass"}}
    data, touch = mujoco.MjData(model), ThermalTouch(model, **words, chain=IDEAL)
    data.ctrl[0], reading = 5.0, touch.reading
    for _ in range(100):
        mujoco.mj_step(model, data)
        reading = touch.update(data)
    return float(reading.temperature_drop[0])


@pytest.mark.parametrize("tip", ["ball", "short capsule", "egg"])
def test_what_is_round_both_ways_leans_nowhere(tip: str) -> None:
    """A block that is turned by some degrees is met at another place of a ball, and by as much; of a short capsule,
    whose pad is the ellipsoid of its radius and half its length, past the end of its line."""
    drops = []
    for degrees in (0.0, 4.0):  # further than what counts as level
        xml = scene(tip, "block").replace('<body name="object"', f'<body name="object" euler="0 {degrees} 0"')
        model = mujoco.MjModel.from_xml_string(xml)
        drops.append(after_a_press(model))
    assert drops[0] > 0.05
    assert drops[1] == pytest.approx(drops[0], rel=0.35 if tip == "short capsule" else 0.01)


def test_a_rod_that_leans_on_a_bar_under_its_sensor_presses_on_the_bar_alone() -> None:
    rod = np.array([125.0, 0.0, STIFFNESS, 0.0064, 0.012, 0.0045, 0.0045, STIFFNESS, 0.0064, 0.012])
    bar = body(0.0, 0.0, WIDE, 0.002)
    level, leaning = (
        round_contact(rod, bar, rising(math.radians(angle)), 5.0, 0.0, 0.0) for angle in (0.0, 3.4)
    )
    assert leaning[1] == pytest.approx(5.0, rel=1e-6) == level[1]
    assert leaning[0] == pytest.approx(level[0], rel=0.01)


def test_a_level_face_of_a_mesh_is_level_whatever_its_frame() -> None:
    """MuJoCo turns a mesh's frame along its inertia, which says nothing of its faces."""
    wedge = "-.03 -.02 .02 .03 -.02 .02 -.03 .02 .02 .03 .02 .02 -.03 -.02 -.02 -.03 .02 -.02"
    drops = []
    for geom in ('type="box" size=".02 .02 .02"', 'type="mesh" mesh="wedge"'):
        xml = SCENE.format(tip=TIPS["capsule"], target=f"<geom {geom}/>", height=0.0285)
        xml = xml.replace("<worldbody>", f'<asset><mesh name="wedge" vertex="{wedge}"/></asset><worldbody>')
        model = mujoco.MjModel.from_xml_string(xml)
        drops.append(after_a_press(model))
    assert drops[1] == pytest.approx(drops[0], rel=0.1)
