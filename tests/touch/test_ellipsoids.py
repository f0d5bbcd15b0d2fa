"""Geoms that are ellipsoids: under a flat pad they are as round as they are where it touches."""

# mujoco ships no type stubs for its compiled names
# pyright: reportAttributeAccessIssue=false

from __future__ import annotations

import math
from functools import cache
from itertools import product

import mujoco
import numpy as np
import pytest

from thermograsp.thermal import SKINS, Pad, material
from thermograsp.thermal.contact import curved_table, curved_touch
from thermograsp.thermal.numerics import as_like
from thermograsp.touch import Fingertip, ThermalTouch, install
from thermograsp.touch.contacts import AREA, BESIDE, CONDUCTANCE, CURVED
from thermograsp.touch.contacts.round_pads import WIDE, array_on_ellipsoid
from thermograsp.touch.contacts.views import (
    array_between_sides,
    array_next_sides,
    between_sides,
    ellipsoid_radii,
    next_sides,
)

from .engine_scene import NEEDS_COMPILER, NEEDS_SPECS

FORCE = 8.0  # N
SIZES = (0.01, 0.02, 0.03), (0.02, 0.02, 0.005), (0.02, 0.008, 0.03), (0.02, 0.02, 0.03)
TURNS = (
    *((axis, degrees) for axis in (0, 1) for degrees in (0.0, 20.0, 45.0, 60.0, 90.0)),
    *((axis, 40.0) for axis in (2, 3)),
)
"""An axis, the last between all, and degrees about it."""


def frame(axis: int, degrees: float) -> tuple[str, np.ndarray]:
    """The geom's quat, and the way up (3,) in its frame."""
    quat, turn = np.zeros(4), np.zeros(9)
    about = np.eye(3)[axis] if axis < 3 else np.array([2.0, 1.0, 2.0]) / 3
    mujoco.mju_axisAngle2Quat(quat, about, math.radians(degrees))
    mujoco.mju_quat2Mat(turn, quat)
    return " ".join(map(str, quat)), turn.reshape(3, 3)[2]


def bent(size: tuple[float, ...], normal: np.ndarray, tangents: np.ndarray) -> np.ndarray:
    """(2, 2) 1/m along two tangents: how the normal turns as the place on the surface moves."""
    half, step = np.array(size), 1e-6
    place = half**2 * normal / math.sqrt(((half * normal) ** 2).sum())
    ahead, behind = ((place + way * step * tangents) / half**2 for way in (1, -1))
    turned = [each / np.linalg.norm(each, axis=1, keepdims=True) for each in (ahead, behind)]
    return (turned[0] - turned[1]) @ tangents.T / (2 * step)


def across(normal: np.ndarray) -> np.ndarray:
    """(2, 3): two unit vectors."""
    aside = np.cross(normal, np.eye(3)[np.argmin(abs(normal))])
    aside /= np.linalg.norm(aside)
    return np.stack([aside, np.cross(normal, aside)])


FLAT = 'type="box" size=".01 .01 .004"'


def scene(
    size: tuple[float, ...], axis: int = 0, degrees: float = 0.0, aside: float = 0.0, tip: str = FLAT
) -> str:
    """A pad of 20 mm, or another fingertip 8 mm high, over the highest place of an ellipsoid, or of a ball, so far m
    aside."""
    quat, up = frame(axis, degrees)
    half = np.array(size if len(size) == 3 else 3 * size)
    turn = np.zeros(9)
    mujoco.mju_quat2Mat(turn, np.array(quat.split(), float))
    high = math.sqrt(((half * up) ** 2).sum())
    top = turn.reshape(3, 3) @ (half**2 * up) / high
    kind = "ellipsoid" if len(size) == 3 else "sphere"
    return f"""
      <mujoco><option timestep=".002" gravity="0 0 0"/><worldbody>
        <body name="thing"><geom type="{kind}" size="{" ".join(map(str, size))}" quat="{quat}"/></body>
        <body name="tip" pos="{top[0] + aside} {top[1]} {high + 0.0041}">
          <joint name="tip" type="slide" axis="0 0 -1" damping="20"/>
          <geom name="tip" {tip} mass=".05"/></body>
      </worldbody><actuator><motor joint="tip"/></actuator></mujoco>"""


@cache
def touches(
    size: tuple[float, ...],
    axis: int = 0,
    degrees: float = 0.0,
    skin: str | None = None,
    surround: str | None = None,
    aside: float = 0.0,
    tip: str = FLAT,
) -> np.ndarray:
    """Of a substep, columns.py."""
    model = mujoco.MjModel.from_xml_string(scene(size, axis, degrees, aside, tip))
    data, worn = mujoco.MjData(model), Fingertip("tip", skin=skin, surround=surround)
    touch = ThermalTouch(model, fingertips={"tip": worn}, objects={"thing": "aluminium"}, chain="ideal")
    data.ctrl[0] = FORCE
    for _ in range(103):
        mujoco.mj_step(model, data)
        touch.update(data)
    return touch._reader.touches[0, 0, 0] / touch._reader.substeps


@pytest.mark.parametrize("size", SIZES)
def test_its_radius_is_that_of_the_surface(size: tuple[float, ...]) -> None:
    radii = np.array(ellipsoid_radii(size))
    for turn in TURNS:
        _, normal = frame(*turn)
        gauss = np.linalg.det(bent(size, normal, across(normal)))
        assert 1 / (normal**2 / radii[:3]).sum() == pytest.approx(1 / math.sqrt(gauss), rel=1e-5)


@pytest.mark.parametrize("size", SIZES)
def test_under_a_round_pad_it_is_as_curved_as_its_surface(size: tuple[float, ...]) -> None:
    """Both ways, where a ball's side touches it as well as where its pad's middle does."""
    radii, curve = np.array([ellipsoid_radii(size)]), np.array([[[30.0, 70.0, *[WIDE] * 5]]])
    for turn, lean in product(TURNS, ((0.0, 0.0), (0.3, -0.2), (0.0, 0.6))):
        _, normal = frame(*turn)
        tangents = across(normal)
        # the turn that leads the pad's normal to where it leans
        there = np.array([math.sqrt(1 - math.hypot(*lean) ** 2), *lean]) @ [normal, *tangents]
        angle, about = math.asin(math.hypot(*lean)), np.cross(normal, there)
        quat, moved = np.zeros(4), np.zeros((2, 3))
        mujoco.mju_axisAngle2Quat(quat, about / max(np.linalg.norm(about), 1e-12), angle)
        for of_pad, out in zip(tangents, moved, strict=True):
            mujoco.mju_rotVecQuat(out, of_pad, quat)
        found = array_on_ellipsoid(
            radii, curve, np.array([[lean]]), normal[None, None], tangents.T[None, None]
        )[0, 0]
        made = found.T @ (curve[0, 0, :2, None] * found)
        np.testing.assert_allclose(made, bent(size, there, moved), rtol=1e-4, atol=1e-3)


def test_its_sides_are_few_and_near_one_another() -> None:
    assert ellipsoid_radii((0.01, 0.02, 0.03)) == pytest.approx([0.06, 0.015, 0.02 / 3])
    assert ellipsoid_radii((0.02, 0.02, 0.03)) == pytest.approx([0.03, 0.03, 0.04 / 3])
    assert (
        len(set(ellipsoid_radii((0.02, 0.02, 0.03)))) == 2 and len(set(ellipsoid_radii((0.0123,) * 3))) == 1
    )
    for size in ((0.02, 0.02, 0.001), (0.03, 0.02, 0.005), (0.001, 0.001, 0.1)):
        radii = np.sort(ellipsoid_radii(size))
        assert (radii[1:] / radii[:-1]).max() < 4.0001
        assert len(radii) <= 3 + math.log(radii[-1] / radii[0], 4)


@pytest.mark.parametrize("size", SIZES)
def test_where_an_axis_leaves_it_there_is_one_side(size: tuple[float, ...]) -> None:
    radii = np.array(ellipsoid_radii(size))
    for axis, normal in enumerate(np.eye(3)):
        for noise in (0.0, 1e-9, -1e-9):
            below, _, share = next_sides(radii, normal + noise)
            assert radii[below] == radii[axis] and share == pytest.approx(0.0, abs=1e-8)


@pytest.mark.parametrize("size", SIZES)
@pytest.mark.parametrize("skin", [None, "filled_silicone"])
def test_between_its_sides_is_what_a_ball_of_its_radius_touches(
    size: tuple[float, ...], skin: str | None
) -> None:
    radii, worn, made = np.array(ellipsoid_radii(size)), skin and SKINS[skin], material("aluminium")

    def ball(radius: float, force: float, place: tuple[float, float], shares: np.ndarray) -> tuple:
        return curved_touch(curved_table(Pad(), worn, made, radius), force, *place, shares)

    for (axis, degrees), force, place in product(TURNS, (8.0, 30.0), ((0.0, 0.0), (0.003, 0.002))):
        _, normal = frame(axis, degrees)
        below, above, share = next_sides(radii, normal)
        ends, others, exact = np.zeros((3, 4))
        one, other = (
            ball(float(radii[side]), force, place, at) for side, at in ((below, ends), (above, others))
        )
        found = between_sides(share, one, other, ends, others)
        expected = ball(float(1 / (normal**2 / radii[:3]).sum()), force, place, exact)
        assert found[0] == pytest.approx(expected[0], rel=0.04)
        assert found[1] == pytest.approx(expected[1], rel=0.1)
        assert found[2] ** 2 / found[1] == pytest.approx(expected[2] ** 2 / expected[1], rel=0.01)
        np.testing.assert_allclose(ends, exact, atol=0.12)


def test_arrays_find_the_same_sides() -> None:
    """Also of a geom that is no ellipsoid, and in single precision where an axis is straight ahead."""
    every = [ellipsoid_radii(size) for size in SIZES]
    most = max(map(len, every))
    radii = np.array([*(row + [0.0] * (most - len(row)) for row in every), [0.0] * most])
    normals = np.array([frame(*turn)[1] for turn in TURNS])[:, None] * np.ones((1, len(radii), 1))
    below, above, share = array_next_sides(radii, normals)
    assert np.isfinite(share).all() and not share[:, -1].any()
    for n, g in np.ndindex(len(TURNS), len(SIZES)):
        assert (below[n, g], above[n, g]) == next_sides(radii[g], normals[n, g])[:2]
        assert share[n, g] == pytest.approx(next_sides(radii[g], normals[n, g])[2], rel=1e-12)
    single = array_next_sides(*(as_like(each, np.zeros(0, np.float32)) for each in (radii, normals)))
    assert np.isfinite(single[2]).all()
    rng = np.random.default_rng(3)
    parts, ends = rng.uniform(0, 1, (7, 50)), rng.uniform(0, 1, (2, 50, 4))
    parts[1:4, :9], parts[4:, 5:12] = 0.0, 0.0  # what does not touch
    found = array_between_sides(parts[0], [*parts[1:4]], [*parts[4:]], *ends)
    for n in range(50):
        mixed = ends[0, n].copy()
        one, other = (tuple(each[:, n].tolist()) for each in (parts[1:4], parts[4:]))
        expected = between_sides(parts[0, n], one, other, mixed, ends[1, n])
        np.testing.assert_allclose([each[n] for each in found[:3]], expected, rtol=1e-12)
        np.testing.assert_allclose(found[3][n], mixed, rtol=1e-12)


@pytest.mark.parametrize(
    ("axis", "degrees"),
    [(1, 0.0), (1, 30.0), (1, 45.0), (1, 60.0), (1, 90.0), pytest.param(3, 40.0, marks=pytest.mark.slow)],
)
def test_it_is_felt_as_the_ball_that_it_is_there(axis: int, degrees: float) -> None:
    size = SIZES[0]
    radius = float(1 / (frame(axis, degrees)[1] ** 2 / ellipsoid_radii(size)[:3]).sum())
    found, expected = touches(size, axis, degrees), touches((radius,))
    assert found[CONDUCTANCE] == pytest.approx(expected[CONDUCTANCE], rel=0.02)
    assert found[AREA] == pytest.approx(expected[AREA], rel=0.05)


def test_one_with_like_axes_is_a_ball_however_it_is_turned() -> None:
    """Also under a round fingertip, whose conductance was 1 % off by the axes that lean."""
    for tip in (FLAT, 'type="sphere" size=".004"'):
        words = (None, None, 0.001, tip)
        found, expected = touches((0.013,) * 3, 3, 30.0, *words), touches((0.013,), 0, 0.0, *words)
        assert found[CONDUCTANCE] == pytest.approx(expected[CONDUCTANCE], rel=1e-3)


def test_so_are_the_rings_around_the_sensor() -> None:
    size, words = SIZES[0], ("filled_silicone", "silicone", 0.005)
    radius = float(1 / (frame(1, 45.0)[1] ** 2 / ellipsoid_radii(size)[:3]).sum())
    found, expected = touches(size, 1, 45.0, *words), touches((radius,), 0, 0.0, *words)
    np.testing.assert_allclose(found[BESIDE:CURVED:3], expected[BESIDE:CURVED:3], rtol=0.04)
    np.testing.assert_allclose(found[BESIDE : CURVED + 1], expected[BESIDE : CURVED + 1], rtol=0.2)
    assert found[BESIDE] > 0.5


@NEEDS_COMPILER
@NEEDS_SPECS
@pytest.mark.parametrize(
    ("tip", "skin"),
    [
        (FLAT, None),
        (FLAT, "filled_silicone"),
        ('type="ellipsoid" size=".006 .008 .004"', None),
    ],
)
@pytest.mark.parametrize("size", SIZES[1:3])
def test_in_mujoco_s_step_it_is_the_same(size: tuple[float, ...], tip: str, skin: str | None) -> None:
    for axis, degrees in ((1, 0.0), (1, 20.0), (1, 75.0), (3, 40.0)):
        spec = mujoco.MjSpec.from_string(scene(size, axis, degrees, 0.001, tip))
        words = {"fingertips": {"tip": Fingertip("tip", skin=skin)}, "objects": {"thing": "glass"}}
        model = install(spec, **words)
        data, touch = mujoco.MjData(model), ThermalTouch(model, **words, chain="ideal")
        data.ctrl[0] = FORCE
        for _ in range(108):
            mujoco.mj_step(model, data)
            touch.update(data)
        read = touch._reader.touches[0, :, :, :BESIDE]
        assert read[0, 0, CONDUCTANCE] > 0
        np.testing.assert_allclose(
            data.plugin_state[1 : 1 + read.size].reshape(read.shape), read, 1e-12, 1e-15
        )
