"""Objects that collide as pieces and are felt as one geom of their body, which tells their shape."""

# mujoco ships no type stubs for its compiled names
# pyright: reportAttributeAccessIssue=false

import warnings

import mujoco
import numpy as np
import pytest
import trimesh

from thermograsp.errors import InvalidValueError, UnknownNameError
from thermograsp.touch import ThermalBody, ThermalTouch, install, prepare
from thermograsp.touch.scene import hull_of, mesh_of

from .engine_scene import (
    NEEDS_COMPILER,
    NEEDS_RECORDS,
    NEEDS_SPECS,
    ROUND_OFF,
    per_kelvin,
    sent,
    voltages,
)

TIP = {"tip": "tip"}
SEEN = 'contype="0" conaffinity="0"'
FLAT = '<geom name="tip" type="box" size=".01 .01 .004" mass=".1"/>'
CAPSULE = '<geom name="tip" type="capsule" size=".004 .012" euler="0 90 0" mass=".1"/>'
LEANING = {"flat": (FLAT, 4.0), "capsule": (CAPSULE, 0.0)}
CUP = trimesh.creation.annulus(0.027, 0.03, 0.08, sections=48)


def slabs(count: int) -> str:
    """A block of 40 mm in so many geoms, side by side."""
    half = 0.02 / count
    places = (-0.02 + half * (2 * n + 1) for n in range(count))
    return "".join(f'<geom type="box" size="{half} .02 .02" pos="{x} 0 0"/>' for x in places)


def staves() -> str:
    """The cup in 48 convex pieces."""
    turns = (np.arange(48) + 0.5) * 2 * np.pi / 48
    return "".join(
        f'<geom type="box" size=".0015 .00186 .04" pos="{0.0284 * np.cos(a)} {0.0284 * np.sin(a)} 0" '
        f'euler="0 0 {np.degrees(a)}"/>'
        for a in turns
    )


def mesh_geom(words: str) -> str:
    return f'<geom name="whole" type="mesh" mesh="cup" {words}/>'


WHOLE = f'<geom name="whole" type="box" size=".02 .02 .02" {SEEN}/>'


def scene(geoms: str, tip: str = FLAT, lean: float = 0.0, turn: str = "") -> mujoco.MjSpec:
    """A fingertip above the body."""
    points, faces = (" ".join(map(str, part.ravel())) for part in (CUP.vertices, CUP.faces))
    return mujoco.MjSpec.from_string(f"""<mujoco><option gravity="0 0 0"/>
        <asset><mesh name="cup" vertex="{points}" face="{faces}"/></asset><worldbody>
        <body name="thing" {turn}>{geoms}</body>
        <body name="other" pos=".3 0 0"><geom name="elsewhere" size=".01"/></body>
        <body pos="0 0 {0.0242 + 0.0008 * lean}"><joint type="slide" axis="0 0 -1" damping="20"/>
        <body euler="0 {lean} 0">{tip}</body></body></worldbody></mujoco>""")


def of(material: str = "aluminium", shape: str | None = "whole") -> dict[str, ThermalBody]:
    return {"thing": ThermalBody(material, shape=shape)}


def steps(data: mujoco.MjData, count: int = 250, force: float = 8.0):
    data.qfrc_applied[0] = force
    for _ in range(count):
        mujoco.mj_step(data.model, data)
        yield


def felt(spec: mujoco.MjSpec, objects: dict) -> float:
    """K of drop after half a second."""
    model = spec.compile()
    data, touch = mujoco.MjData(model), ThermalTouch(model, fingertips=TIP, objects=objects, chain="ideal")
    for _ in steps(data):
        touch.update(data)
    return float(touch.reading.temperature_drop[0])


@pytest.mark.parametrize("tip", LEANING)
def test_what_touches_pieces_is_felt_on_the_whole(tip: str) -> None:
    """Eight slabs, which alone lose half of a leaning pad and give a capsule eight contacts."""
    one = felt(scene(slabs(1), *LEANING[tip]), of(shape=None))
    eight = felt(scene(slabs(8), *LEANING[tip]), of(shape=None))
    assert felt(scene(slabs(8) + WHOLE, *LEANING[tip]), of()) == pytest.approx(one, rel=0.01)
    assert abs(eight - one) > 2.0


def test_a_cup_of_staves_is_felt_as_its_mesh() -> None:
    lying = 'pos="0 0 -.01" euler="90 0 0"'
    one = felt(scene(mesh_geom(""), turn=lying), of("ceramic", None))
    assert felt(scene(staves() + mesh_geom(SEEN), turn=lying), of("ceramic")) == pytest.approx(one, rel=0.02)
    assert one > 1.0


def test_its_heat_is_that_of_the_whole() -> None:
    model = scene(slabs(8) + WHOLE).compile()
    (shape,) = ThermalTouch(model, fingertips=TIP, objects=of("glass"))._shapes
    (block,) = ThermalTouch(scene(slabs(1)).compile(), fingertips=TIP, objects=of("glass", None))._shapes
    np.testing.assert_array_equal(shape.size, block.size)
    assert shape.solid is None  # as of one box
    assert shape.heat_capacity == block.heat_capacity


def test_a_seen_mesh_has_the_hull_that_one_which_collides_has() -> None:
    """MuJoCo makes none of it."""
    hulls = []
    for words in ("", SEEN):
        model = scene(slabs(1) + mesh_geom(words)).compile()
        geom = model.geom("whole").id
        vertices, triangles = mesh_of(model, geom)[0], hull_of(model, geom)
        corners = vertices[triangles]
        hulls.append(
            np.linalg.norm(np.cross(*(corners[:, 1:] - corners[:, :1]).swapaxes(0, 1)), axis=1).sum()
        )
    assert hulls[1] == pytest.approx(hulls[0], rel=1e-6)


@NEEDS_RECORDS
@pytest.mark.parametrize("tip", LEANING)
def test_records_and_arrays_feel_the_same(tip: str) -> None:
    model = prepare(scene(slabs(4) + WHOLE, *LEANING[tip]), TIP, of())
    words = {"fingertips": TIP, "objects": of(), "chain": "ideal"}
    data, live, touch = (
        mujoco.MjData(model),
        ThermalTouch(model, **words),
        ThermalTouch(model, **words, worlds=1),
    )
    rows = []
    fixed = touch.fixed_touch(np.zeros(0))
    state, reading = fixed.start(1), None
    for n, _ in enumerate(steps(data), start=1):
        live.update(data)
        rows.append(data.sensordata.copy())
        if n % 5 == 0:
            record, rows = np.array(rows)[None], []
            touch.update(record)
            state, reading = fixed.advance(state, fixed.contacts(record))
    drop = live.reading.temperature_drop[0]
    assert touch.reading.temperature_drop[0, 0] == pytest.approx(drop, abs=0.01)  # net forces, not points
    assert reading is not None
    assert reading.temperature_drop[0, 0] == pytest.approx(touch.reading.temperature_drop[0, 0], abs=1e-9)


@NEEDS_SPECS
@NEEDS_COMPILER
@pytest.mark.parametrize("tip", LEANING)
def test_the_plugin_feels_the_same(tip: str) -> None:
    words = {"fingertips": TIP, "objects": of()}
    model = install(scene(slabs(4) + WHOLE, *LEANING[tip]), **words)
    data, touch = mujoco.MjData(model), ThermalTouch(model, **words, chain="ideal")
    for n, _ in enumerate(steps(data), start=1):
        touch.update(data)
        if n % 10 == 0:
            assert np.abs((voltages(model, data) - sent(touch)) / per_kelvin(touch)).max() < ROUND_OFF


def test_a_shape_must_be_of_the_objects_own_body() -> None:
    model = scene(slabs(2) + WHOLE).compile()
    with pytest.raises(
        InvalidValueError, match="is of body 'other', and a shape must be of the object's own body"
    ):
        ThermalTouch(model, fingertips=TIP, objects=of(shape="elsewhere"))
    with pytest.raises(UnknownNameError, match="shape of object 'thing'"):
        ThermalTouch(model, fingertips=TIP, objects=of(shape="hole"))


@NEEDS_RECORDS
def test_a_shape_stays_in_all_worlds() -> None:
    model = prepare(scene(slabs(2) + WHOLE), TIP, of())
    with pytest.raises(InvalidValueError, match="its shape must be the same in every world"):
        ThermalTouch(
            model, fingertips=TIP, objects={"thing": [*of().values(), *of(shape="own").values()]}, worlds=2
        )


@pytest.mark.filterwarnings("ignore:fingertip")
def test_a_geom_that_is_only_seen_is_told_how_to_be_felt() -> None:
    with pytest.warns(RuntimeWarning, match="with this one as the ThermalBody's shape"):
        ThermalTouch(scene(slabs(2) + WHOLE).compile(), fingertips=TIP, objects={"whole": "glass"})


@pytest.mark.parametrize(
    ("seen", "named"),
    [
        (WHOLE, True),
        (WHOLE.replace('name="whole" ', ""), False),
        (WHOLE.replace(".02 .02 .02", ".02 .02 .03"), False),
        (WHOLE.replace(SEEN, ""), False),
        (WHOLE.replace(SEEN, 'contype="2"'), False),
    ],
)
def test_a_geom_that_is_seen_and_as_large_as_all_pieces_is_named(seen: str, named: bool) -> None:
    model = scene(slabs(8) + seen).compile()
    with warnings.catch_warnings(record=True) as said:
        warnings.simplefilter("always")
        ThermalTouch(model, fingertips=TIP, objects=of("glass", None))
    told = [str(one.message) for one in said if "shape='whole'" in str(one.message)]
    assert len(told) == named and all("'thing' collides as 8 geoms" in one for one in told)
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        if named:
            ThermalTouch(model, fingertips=TIP, objects=of("glass"))
