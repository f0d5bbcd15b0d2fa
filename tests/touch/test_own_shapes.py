"""The heat of meshes flows in their own shape: beside boxes, grids that are fine at the place, and every way to ask."""

# mujoco ships no type stubs for its compiled names
# pyright: reportAttributeAccessIssue=false

from __future__ import annotations

import logging
import pickle
import runpy
from pathlib import Path
from typing import Any

import mujoco
import numpy as np
import pytest
import trimesh

from thermograsp.errors import InvalidValueError
from thermograsp.thermal import IDEAL, SurfacePatch, material, press_body, solid
from thermograsp.touch import Fingertip, ThermalTouch, grasp_touch, prepare
from thermograsp.touch.contacts import AREA, CLOSED, CONDUCTANCE

from .engine_scene import NEEDS_RECORDS, keep_boxes
from .recorded import felt_alike

AREA_OF_FACE = 81e-6  # m2
CUBE = trimesh.creation.box((0.04, 0.04, 0.04))
BAR = trimesh.creation.box((0.12, 0.012, 0.012))
WALL = 1e-3  # m


def tray() -> Any:
    """A box of 40 x 40 x 30 mm that is hollow: its walls are that thick."""
    outside = trimesh.creation.box((0.04, 0.04, 0.03))
    inside = trimesh.creation.box((0.04 - 2 * WALL, 0.04 - 2 * WALL, 0.03 - 2 * WALL))
    inside.invert()
    return trimesh.util.concatenate([outside, inside])


MESHES: dict[str, Any] = {"cube": CUBE, "bar": BAR, "tray": tray()}


def spec(geom: str, high: float, tips: int = 1) -> mujoco.MjSpec:
    """A thing and a fingertip above it, or another one below it."""
    assets = "".join(
        f'<mesh name="{name}" vertex="{" ".join(f"{x:.9g}" for x in mesh.vertices.ravel())}" '
        f'face="{" ".join(map(str, mesh.faces.ravel()))}"/>'
        for name, mesh in MESHES.items()
    )
    ways = ("tip", 1), ("other", -1)
    fingers = "".join(
        f"""<body name="{name}" pos="0 0 {way * (high + 0.0045)}">
          <joint name="{name}" type="slide" axis="0 0 {-way}" damping="100"/>
          <joint name="{name}_aside" type="slide" axis="1 0 0" damping="20"/>
          <geom name="{name}" type="box" size=".01 .01 .004" mass=".05" friction="0"/></body>"""
        for name, way in ways[:tips]
    )
    drives = "".join(
        f'<motor joint="{name}"/><position joint="{name}_aside" kp="500"/>' for name, _ in ways[:tips]
    )
    return mujoco.MjSpec.from_string(f"""
      <mujoco><option timestep=".002" gravity="0 0 0"/><asset>{assets}</asset><worldbody>
      <body name="thing"><geom name="thing" {geom} friction="0"/></body>{fingers}
      </worldbody><actuator>{drives}</actuator></mujoco>""")


def mesh(name: str) -> str:
    return f'type="mesh" mesh="{name}"'


def touch_of(model: mujoco.MjModel, made_of: Any = "steel", tips: int = 1, **words: Any) -> ThermalTouch:
    pads = {name: name for name in ("tip", "other")[:tips]}
    words = {"fingertips": pads, "objects": {"thing": made_of}, "chain": "ideal", "air": 0.0, **words}
    return ThermalTouch(model, **words)


def felt(touch: ThermalTouch, data: mujoco.MjData, seconds: float, *orders: float) -> np.ndarray:
    """(readings, F) K after every 20 ms under those forces N and places m aside."""
    data.ctrl[:] = orders
    found = []
    for n in range(round(seconds / 0.002)):
        mujoco.mj_step(touch.model, data)
        reading = touch.update(data)
        if n % 10 == 9:
            found.append(reading.temperature_drop)
    return np.array(found)


@pytest.mark.parametrize("name", [pytest.param("aluminium", marks=pytest.mark.slow), "wood"])
def test_a_mesh_of_a_cube_is_felt_as_a_box(name: str, monkeypatch: pytest.MonkeyPatch) -> None:
    """Held, let go, elsewhere and back."""
    moves = (1.0, 10.0, 0.0), (0.4, -2.0, 0.006), (0.6, 10.0, 0.006), (0.4, -2.0, 0.0), (0.6, 20.0, 0.0)
    both, model = [], spec(mesh("cube"), 0.02).compile()
    for keep in (False, True):
        if keep:
            keep_boxes(monkeypatch)
        touch, data = touch_of(model, name), mujoco.MjData(model)
        assert (touch._shapes[0].solid is None) == keep
        both.append(np.concatenate([felt(touch, data, *move) for move in moves]))
    assert np.abs(both[0]).max() > 0.8
    np.testing.assert_allclose(both[0], both[1], atol=0.02)


def noted(touch: ThermalTouch) -> list[float]:
    """From now on has the tip's W/(m2 K) of every sample."""
    found, advance = [], touch._heat.advance

    def noting(touches: np.ndarray, substeps: int) -> None:
        found.append(touches[0, 0, 0, CONDUCTANCE] / substeps / AREA_OF_FACE)
        assert touches[0, 0, 0, AREA] == pytest.approx(touches[0, 0, 0, CLOSED] * AREA_OF_FACE)
        advance(touches, substeps)

    touch._heat.advance, touch._heat.hearing = noting, lambda touches: (0, 0)  # pyright: ignore
    return found


@pytest.mark.parametrize(
    "name", ["ceramic", *(pytest.param(name, marks=pytest.mark.slow) for name in ("aluminium", "wood"))]
)
def test_thin_walls_are_felt_as_by_a_grid_that_is_fine_there(name: str) -> None:
    """Which shares neither the network's states nor its kernels, and takes the conductances that were recorded."""
    model = spec(mesh("tray"), 0.015).compile()
    touch, data = touch_of(model, name), mujoco.MjData(model)
    through = noted(touch)
    drops = felt(touch, data, 4.0, 10.0, 0.0)[:, 0]
    hollow = MESHES["tray"]
    body = solid(np.asarray(hollow.vertices), np.asarray(hollow.faces), material(name))
    patch = SurfacePatch((0.0, 0.0, 0.015), (0.0, 0.0, 1.0), AREA_OF_FACE)
    expected = press_body(
        body,
        patch,
        conductance=lambda t: through[min(int(t / 0.01), 399)],
        seconds=4.0,
        dt=0.01,
        tolerance=0.05,
    ).temperature_drop
    known = np.asarray(expected)[2::2]
    np.testing.assert_allclose(drops[2:], known[2:], atol=0.03)


PLATES = "".join(
    f'<geom type="box" size="{" ".join(f"{x:.6g}" for x in half)}" pos="{" ".join(f"{x:.6g}" for x in at)}"/>'
    for half, at in (
        (
            [WALL / 2 if k == axis else side / 2 for k, side in enumerate((0.04, 0.04, 0.03))],
            [way * (side - WALL) / 2 if k == axis else 0 for k, side in enumerate((0.04, 0.04, 0.03))],
        )
        for axis in range(3)
        for way in (-1, 1)
    )
)


def test_geoms_that_are_one_body_are_felt_as_its_mesh() -> None:
    pytest.importorskip("manifold3d")
    both = []
    for model in (spec(mesh("tray"), 0.015).compile(), of_geoms(PLATES, 0.015)):
        touch, data = touch_of(model, "ceramic"), mujoco.MjData(model)
        both.append(felt(touch, data, 2.0, 10.0, 0.0))
        assert touch._shapes[0].heat_capacity == pytest.approx(18.62, rel=6e-3)
    np.testing.assert_allclose(both[0], both[1], atol=0.02)


@pytest.mark.parametrize(
    "size",
    [
        (0.003, 0.02),
        *(pytest.param(size, marks=pytest.mark.slow) for size in ((0.0004, 0.004), (0.02, 0.02))),
    ],
)
def test_thin_capsules_and_cylinders_are_fused_too(
    size: tuple[float, float], caplog: pytest.LogCaptureFixture
) -> None:
    """Such as the handle of a cup and a wire."""
    pytest.importorskip("manifold3d")
    radius, half = size
    geoms = f'<geom type="box" size=".004 .004 .002" pos="0 0 {-half}"/>'
    geoms += "".join(
        f'<geom type="{kind}" size="{radius} {half}" euler="{turn}"/>'
        for kind, turn in (("capsule", "0 0 0"), ("cylinder", "0 25 70"))
    )
    (shape,) = touch_of(of_geoms(geoms, 0.1))._shapes
    assert shape.solid is not None and not caplog.records


def of_geoms(geoms: str, high: float) -> mujoco.MjModel:
    made = spec(mesh("cube"), high).to_xml()
    first, last = made.index("<geom"), made.index("/>", made.index("<geom")) + 2
    return mujoco.MjModel.from_xml_string(made[:first] + geoms + made[last:])


def test_it_is_the_same_whatever_its_frame(caplog: pytest.LogCaptureFixture) -> None:
    """MuJoCo's own frame of a mesh is that of its inertia."""
    found = []
    for frame in ("", 'pos=".01 .02 .03" euler="0 90 0"'):
        model = spec(f"{mesh('bar')} {frame}", 0.006).compile()
        (shape,) = touch_of(model)._shapes
        assert shape.solid is not None
        # its corners in the body's frame
        corners = shape.solid.parts[0].vertices @ shape.axes.T + shape.centre
        found.append(corners[np.lexsort(corners.T)])
    turned = found[0] @ np.array([[0, 0, 1], [0, 1, 0], [-1, 0, 0]]).T + [0.01, 0.02, 0.03]
    np.testing.assert_allclose(found[1], turned[np.lexsort(turned.T)], atol=1e-6)
    assert not caplog.records


def test_what_has_no_own_shape_says_why(caplog: pytest.LogCaptureFixture) -> None:
    hole = trimesh.creation.box((0.04, 0.04, 0.04))
    hole.update_faces(np.arange(len(hole.faces)) > 0)
    apart = trimesh.util.concatenate([BAR, BAR.copy().apply_translation((0.0, 0.0, 0.05))])
    for thing, why in ((hole, "not closed"), (apart, "separate pieces")):
        caplog.clear()
        MESHES["odd"] = thing
        try:
            touch = touch_of(spec(mesh("odd"), 0.1).compile())
        finally:
            del MESHES["odd"]
        assert touch._shapes[0].solid is None
        (record,) = [each for each in caplog.records if each.levelno == logging.WARNING]
        assert record.name.startswith("thermograsp") and why in record.getMessage()
    caplog.clear()
    pads = {"tip": "tip", "other": Fingertip("other", skin="filled_silicone")}
    touch = touch_of(spec(mesh("bar"), 0.006, 2).compile(), fingertips=pads)
    assert touch._shapes[0].solid is None and "different sensors" in caplog.text


def test_a_box_is_no_other_for_a_mesh_that_is_not_there(caplog: pytest.LogCaptureFixture) -> None:
    touch = touch_of(spec('type="box" size=".02 .02 .02"', 0.02).compile())
    assert touch._shapes[0].solid is None and touch._heat.rung == "fields:14x3" and not caplog.records


MOVES = ((10.0, 0.0, 10.0, 0.0), (-2.0, 0.02, 10.0, -0.03), (10.0, 0.02, -2.0, 0.0), (8.0, 0.03, 8.0, -0.03))
"""N and m aside of both fingertips."""


def test_a_state_goes_on_bit_for_bit_and_a_reset_begins_again() -> None:
    model = spec(mesh("bar"), 0.006, 2).compile()
    touch, data = touch_of(model, tips=2), mujoco.MjData(model)
    first = [felt(touch, data, 0.2, *move) for move in MOVES[:2]]
    saved = pickle.loads(pickle.dumps(touch.state()))
    whole = mujoco.mjtState.mjSTATE_INTEGRATION
    there = np.empty(mujoco.mj_stateSize(model, whole))
    mujoco.mj_getState(model, data, there, whole)
    rest = [felt(touch, data, 0.2, *move) for move in MOVES[2:]]
    other = touch_of(model, tips=2)
    mujoco.mj_setState(model, data, there, whole)
    other.set_state(saved)
    assert np.array_equal([felt(other, data, 0.2, *move) for move in MOVES[2:]], rest)
    mujoco.mj_resetData(model, data)
    other.reset(data)
    assert np.array_equal([felt(other, data, 0.2, *move) for move in MOVES[:2]], first)
    balance = touch.balance
    assert balance.objects == pytest.approx(balance.given.sum(axis=0), rel=1e-9)


def test_a_state_of_boxes_is_refused(monkeypatch: pytest.MonkeyPatch) -> None:
    """As of geoms on a computer where nothing fuses them."""
    model = spec(mesh("bar"), 0.006).compile()
    touch = touch_of(model)
    keep_boxes(monkeypatch)
    with pytest.raises(InvalidValueError, match=r"shapes are \('box',\) in place of \('own',\)"):
        touch.set_state(touch_of(model).state())


@pytest.mark.slow
@NEEDS_RECORDS
def test_many_worlds_are_single_ones_and_a_material_scales_time() -> None:
    pads, made_of = {"tip": "tip", "other": "other"}, ["steel", "wood"]
    model = prepare(spec(mesh("bar"), 0.006, 2), pads, {"thing": "steel"})
    touch = touch_of(model, made_of, tips=2, worlds=2)
    single = [touch_of(model, each, tips=2, worlds=1) for each in made_of]
    data, alone = mujoco.MjData(model), []
    by_data = touch_of(model, "wood", tips=2)
    for move in MOVES:
        data.ctrl[:] = move
        for _ in range(10):
            record = np.empty((1, 10, model.nsensordata))
            for n in range(10):
                mujoco.mj_step(model, data)
                record[0, n] = data.sensordata
                by_data.update(data)
            reading = touch.update(np.repeat(record, 2, axis=0))
            alone = [each.update(record).temperature_drop[0] for each in single]
            assert np.array_equal(reading.temperature_drop, alone)
    np.testing.assert_allclose(alone[1], by_data.reading.temperature_drop, atol=0.02)
    assert np.abs(alone[0] - alone[1]).min() > 1.0


@NEEDS_RECORDS
def test_fixed_touch_is_the_loop() -> None:
    """While all fingertips are in contact."""
    pads = {"tip": "tip", "other": "other"}
    model = prepare(spec(mesh("tray"), 0.015, 2), pads, {"thing": "ceramic"})
    touch = touch_of(model, "ceramic", tips=2, worlds=1, dt=0.01)
    drop = felt_alike(touch, model, [(10.0, 0.0, 8.0, 0.0)], 60, 1e-6)
    assert drop.min() > 2.0


@pytest.mark.slow
@NEEDS_RECORDS
def test_a_grasp_across_the_middle_is_felt_in_its_own_shape() -> None:
    """As worlds on a device have it: across the third side of a tray, far from what its box would feel."""
    pads = {"tip": "tip", "other": "other"}
    model = prepare(spec(mesh("tray"), 0.015, 2), pads, {"thing": "ceramic"})
    touch = touch_of(model, "ceramic", tips=2, worlds=1, dt=0.01)
    fixed, ways = grasp_touch(
        model,
        touch._pads,
        touch._shapes,
        [tuple(map(material, ("wood", "ceramic")))],
        dt=0.01,
        substeps=5,
        tolerance=0.05,
        ambient=24.0,
        air=0.0,
        chain=IDEAL,
        samples=4,
        like=np.zeros(0),
    )
    assert ways == 3
    recorder = touch.fixed_touch(np.zeros(0))
    state = fixed.reset(fixed.start(1), material=np.array([[5]]))
    data, drop = mujoco.MjData(model), np.zeros(2)
    data.ctrl[:] = 10.0, 0.0, 8.0, 0.0
    for _ in range(60):
        record = np.empty((1, 5, model.nsensordata))
        for k in range(5):
            mujoco.mj_step(model, data)
            record[:, k] = data.sensordata
        drop = touch.update(record).temperature_drop
        state, reading = fixed.advance(state, recorder.contacts(record))
        np.testing.assert_allclose(reading.temperature_drop, drop, atol=1e-3)
    assert drop.min() > 2.0


def test_an_object_keeps_its_field_when_places_are_forgotten(monkeypatch: pytest.MonkeyPatch) -> None:
    """As if all were remembered: a bar is cold at one end long after other places have been touched."""
    found = []
    for remembered in (2, 12):
        monkeypatch.setattr("thermograsp.touch.heat.joined.MOST_PLACES", remembered)
        model = spec(mesh("bar"), 0.006).compile()
        touch, data = touch_of(model), mujoco.MjData(model)
        felt(touch, data, 2.0, 10.0, -0.045)
        for aside in (-0.03, -0.01, 0.005, 0.02, 0.035):
            felt(touch, data, 0.1, -2.0, aside)
            felt(touch, data, 0.2, 6.0, aside)
        felt(touch, data, 0.2, -2.0, -0.045)
        found.append(felt(touch, data, 1.0, 10.0, -0.045))
    np.testing.assert_allclose(found[0], found[1], atol=0.03)


@pytest.mark.slow
def test_the_edge_of_a_mesh_is_felt_as_by_finite_volumes() -> None:
    """It is narrower than the sensor's face."""
    judged = runpy.run_path(str(Path(__file__).parents[2] / "studies" / "scenes" / "touch_volumes.py"))[
        "judged"
    ]
    assert judged("rim", "glass").error < 0.04
