"""Several objects under one fingertip: what the heat of one contact does where another is."""

# mujoco ships no type stubs for its compiled names
# pyright: reportAttributeAccessIssue=false

from collections.abc import Sequence
from itertools import pairwise

import mujoco
import numpy as np
import pytest

from thermograsp.thermal import IDEAL
from thermograsp.thermal.contact import array_offset_of_share, offset_of_share, patch_offset
from thermograsp.touch import ThermalTouch, install, prepare
from thermograsp.touch.contacts import AREA, ASIDE, CLOSED, COLUMNS, CONDUCTANCE, LENGTH, NORMAL, PLACE
from thermograsp.touch.heat import JoinedHeat

from .engine_scene import NEEDS_COMPILER, NEEDS_RECORDS, NEEDS_SPECS, ROUND_OFF, per_kelvin, sent, voltages
from .recorded import felt_alike

TIPS, SIDE, FACE = {"tip": "tip"}, 0.02, 0.009
HALVES, THIRDS = (-SIDE, 0.0, SIDE), (-SIDE, -FACE / 6, FACE / 6, SIDE)


def scene(edges: Sequence[float], gap: float = 0.0) -> str:
    """Blocks side by side along x between those edges, m, whose tops are at 0, and a damped pad above."""
    blocks = "".join(
        f"""<body name="{n}" pos="{(left + right) / 2} 0 {-SIDE}">
        <geom type="box" size="{(right - left - gap) / 2} {SIDE} {SIDE}"/></body>"""
        for n, (left, right) in enumerate(pairwise(edges))
    )
    return f"""<mujoco><option gravity="0 0 0"/><default><geom solref=".004 1"/></default><worldbody>{blocks}
      <body name="tip" pos="0 0 .0041"><joint name="press" type="slide" axis="0 0 -1" damping="200"/>
      <geom type="box" size=".01 .01 .004" mass=".05"/></body></worldbody>
      <actuator><motor joint="press"/></actuator></mujoco>"""


def objects_of(materials: Sequence[str]) -> dict[str, str]:
    return {str(n): each for n, each in enumerate(materials)}


def felt(
    edges: Sequence[float],
    materials: Sequence[str],
    gap: float = 0.0,
    seconds: float = 1.0,
    told: Sequence[int] | None = None,
) -> tuple[float, ThermalTouch]:
    """K after that time at 8 N, and the touch. told: which blocks it knows, in that order; all by default."""
    model = mujoco.MjModel.from_xml_string(scene(edges, gap))
    data = mujoco.MjData(model)
    objects = {str(n): materials[n] for n in (range(len(materials)) if told is None else told)}
    touch = ThermalTouch(model, fingertips=TIPS, objects=objects, chain=IDEAL, air=0.0)
    data.ctrl[:] = 8.0
    while data.time < seconds - 1e-9:
        mujoco.mj_step(model, data)
        touch.update(data)
    return float(touch.reading.temperature_drop[0]), touch


@pytest.mark.parametrize("of", ["aluminium", "stainless_steel", "glass", "wood"])
def test_two_halves_are_felt_as_the_whole(of: str) -> None:
    """Before, aluminium had 8.1 K for 9.9 K."""
    whole, _ = felt((-SIDE, SIDE), [of])
    halves, touch = felt(HALVES, [of, of])
    assert halves == pytest.approx(whole, abs=0.13)
    balance = touch.balance
    assert balance.given.sum() == pytest.approx(balance.objects.sum(), rel=1e-10)
    assert balance.given[0, 0] == pytest.approx(balance.given[0, 1], rel=0.01)


def test_which_object_is_told_first_does_not_matter() -> None:
    one, _ = felt(HALVES, ["aluminium", "wood"])
    other, _ = felt(HALVES, ["wood", "aluminium"])
    assert one == pytest.approx(other, abs=1e-6)


@pytest.mark.parametrize("order", [(1, 0, 2), (2, 1, 0)])
@pytest.mark.parametrize("seams", [(-1.5, 1.5), (-1.6, 1.4), (0.0, 1.0), (-4.2, 1.0)])
def test_a_third_object_and_the_order_in_which_they_are_told(
    seams: tuple[float, float], order: tuple[int, int, int]
) -> None:
    """Seams in mm from the middle."""
    edges = (-SIDE, *(1e-3 * seam for seam in seams), SIDE)
    one, other = (felt(edges, ["aluminium"] * 3, seconds=0.5, told=each)[0] for each in (order, (0, 1, 2)))
    whole, _ = felt((-SIDE, SIDE), ["aluminium"], seconds=0.5)
    assert one == pytest.approx(other, abs=1e-7)
    assert one == pytest.approx(whole, abs=0.25)


def test_a_fourth_and_a_fifth_object() -> None:
    """The four largest share the face."""
    whole, _ = felt((-SIDE, SIDE), ["aluminium"])
    quarters, _ = felt((-SIDE, *(FACE * n / 4 for n in (-1, 0, 1)), SIDE), ["aluminium"] * 4)
    fifths, _ = felt((-SIDE, *(FACE * n / 10 for n in (-3, -1, 1, 3)), SIDE), ["aluminium"] * 5)
    assert quarters == pytest.approx(whole, abs=0.2)
    assert 0.85 * whole < fifths < quarters


def test_a_step_of_nothing_changes_nothing() -> None:
    one, other = (
        felt((-SIDE, -FACE / 6 + off, FACE / 6 + off, SIDE), ["aluminium"] * 3)[0] for off in (0, 1e-9)
    )
    assert one == pytest.approx(other, abs=1e-5)


def test_one_more_cold_object_does_not_warm() -> None:
    """Between two blocks of aluminium a strip of copper: it was as much as .95 K of 12 K."""
    edges, materials = (-SIDE, -3.7e-3, 1e-4, SIDE), ["aluminium", "copper", "aluminium"]
    without, of_all = (felt(edges, materials, gap=4e-4, told=told)[0] for told in ((1, 2), None))
    assert of_all > without


def test_one_that_leaves_leaves_the_other_alone() -> None:
    """The pad slides off one of two blocks, and what is behind it fades; back on both it is as before."""
    model = mujoco.MjModel.from_xml_string(scene(HALVES))
    data, objects = mujoco.MjData(model), objects_of(["aluminium", "aluminium"])
    touch = ThermalTouch(model, fingertips=TIPS, objects=objects, chain=IDEAL, air=0.0)
    data.ctrl[:] = 8.0
    found = []
    for x in (0.0, -0.0044, 0.0):
        for _ in range(1500):
            data.qpos[0], data.qvel[0] = data.qpos[0], 0.0
            model.body("tip").pos[0] = x
            mujoco.mj_step(model, data)
            touch.update(data)
        found.append(float(touch.reading.temperature_drop[0]))
    assert found[0] == pytest.approx(found[2], rel=0.05)
    assert np.isfinite(found).all()


@pytest.mark.parametrize("seed", range(6))
def test_nothing_is_felt_beyond_the_difference(seed: int) -> None:
    """Any contacts of three objects that come, go and lie anywhere, overlapping ones too: no drop leaves the range of
    what the two sides differ by, and what flows out of the fingertip is what the objects take."""
    model = mujoco.MjModel.from_xml_string(scene(THIRDS))
    touch = ThermalTouch(
        model, fingertips=TIPS, objects=objects_of(["aluminium", "glass", "wood"]), chain=IDEAL, air=0.0
    )
    heat = JoinedHeat(
        touch._pads, (), touch._shapes, worlds=1, dt=0.01, tolerance=0.05, film=0.0, ambient=24.0
    )
    rng = np.random.default_rng(seed)
    drops = []
    touches = np.zeros((1, 1, 4, COLUMNS))
    for step in range(300):
        if step % 10 == 0:
            touches[:] = 0.0
            for o in np.flatnonzero(rng.random(3) < 0.8):
                row = touches[0, 0, o]
                sides = rng.uniform(2e-4, FACE, 2)
                area = sides.prod()
                row[[CONDUCTANCE, CLOSED, AREA, LENGTH]] = (
                    10 ** rng.uniform(-3, 1.5),
                    1.0,
                    area,
                    area * sides[1],
                )
                row[ASIDE : ASIDE + 4] = area * rng.uniform(0, 1, 4)
                row[PLACE : PLACE + 3], row[NORMAL : NORMAL + 3] = (0.0, 0.0, SIDE), (0.0, 0.0, -1.0)
        heat.advance(touches, 1)
        drops.append(float(heat.drop[0, 0]))
    assert -0.1 < min(drops) and 1.0 < max(drops) < 12.1
    balance = heat.balance(0)
    assert balance.given.sum() == pytest.approx(balance.objects.sum(), rel=1e-9)


def test_worlds_do_not_depend_on_one_another() -> None:
    model = mujoco.MjModel.from_xml_string(scene(HALVES))
    words = {"fingertips": TIPS, "objects": objects_of(["aluminium", "wood"]), "chain": IDEAL}
    touch = ThermalTouch(model, **words)
    told = {"worlds": 3, "dt": 0.01, "tolerance": 0.05, "film": 5.0, "ambient": 24.0}
    many = JoinedHeat(touch._pads, (), touch._shapes, **told)
    one = JoinedHeat(touch._pads, (), touch._shapes, **{**told, "worlds": 1})
    touches = np.zeros((3, 1, 3, COLUMNS))
    for w, o in ((0, 0), (1, 0), (1, 1), (2, 1)):
        row, area = touches[w, 0, o], 0.5 * FACE**2
        row[[CONDUCTANCE, CLOSED, AREA, LENGTH]] = 0.5, 1.0, area, area * FACE
        row[ASIDE : ASIDE + 4] = area
        row[PLACE : PLACE + 3], row[NORMAL : NORMAL + 3] = (0.0, 0.0, SIDE), (0.0, 0.0, -1.0)
    for _ in range(50):
        many.advance(touches, 1)
        one.advance(touches[1:2], 1)
    assert np.array_equal(many.drop[1:2], one.drop)


@NEEDS_COMPILER
@NEEDS_SPECS
@pytest.mark.parametrize(("edges", "gap"), [(HALVES, 0.0), (HALVES, 0.003), (THIRDS, 0.0)])
def test_inside_mujoco_s_step_they_feel_the_same(edges: Sequence[float], gap: float) -> None:
    objects = objects_of(["aluminium", "glass", "wood"][: len(edges) - 1])
    model = install(mujoco.MjSpec.from_string(scene(edges, gap)), fingertips=TIPS, objects=objects)
    data, touch = mujoco.MjData(model), ThermalTouch(model, fingertips=TIPS, objects=objects, chain=IDEAL)
    for force in (8.0, -2.0, 8.0):
        data.ctrl[:] = force
        for n in range(150):
            mujoco.mj_step(model, data)
            touch.update(data)
            if n % 10 == 9:
                difference = voltages(model, data) - sent(touch)
                assert np.abs(difference / per_kelvin(touch)).max() < ROUND_OFF
    assert touch.reading.temperature_drop[0] > 1.0


@NEEDS_RECORDS
@pytest.mark.parametrize(
    ("edges", "materials"),
    [
        (HALVES, ["aluminium", "wood"]),
        (THIRDS, ["aluminium", "glass", "wood"]),
        ((-SIDE, -0.003, 0.0, 0.003, SIDE), ["aluminium", "glass", "wood", "copper"]),
    ],
    ids=["two", "three", "four"],
)
def test_fixed_touch_is_the_loop(edges: Sequence[float], materials: Sequence[str]) -> None:
    objects = objects_of(materials)
    model = prepare(mujoco.MjSpec.from_string(scene(edges)), TIPS, objects)
    touch = ThermalTouch(model, fingertips=TIPS, objects=objects, chain=IDEAL, air=0.0, worlds=1, dt=0.01)
    drop = felt_alike(touch, model, (8.0, -2.0, 8.0), 30, 1e-6)
    assert drop.max() > 1.0


def test_the_offset_of_a_share_is_what_had_that_share() -> None:
    for length in (0.0002, 0.003, 0.0089):
        for offset in np.linspace(0.0, (FACE - length) / 2, 7):
            share = patch_offset(offset, length, FACE)
            assert offset_of_share(share, length, FACE) == pytest.approx(offset, abs=2e-9)
            found = array_offset_of_share(np.array([share]), np.array([length]), np.array([FACE]))
            assert found[0] == pytest.approx(offset, abs=2e-9)
    assert offset_of_share(1.0, FACE, FACE) == 0.0
