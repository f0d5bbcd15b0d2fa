"""A pure step of fingertips that takes contacts, beside ThermalTouch.update."""

# mujoco ships no type stubs for its compiled names
# pyright: reportAttributeAccessIssue=false

import importlib.util
from pathlib import Path

import mujoco
import numpy as np
import pytest

from thermograsp.errors import InvalidValueError, UnknownNameError
from thermograsp.thermal import IDEAL, Thermostat, material
from thermograsp.touch import Fingertip, FixedTouch, ThermalBody, ThermalTouch, grasp_touch, prepare

from .engine_scene import NEEDS_RECORDS

pytestmark = NEEDS_RECORDS

_spec = importlib.util.spec_from_file_location("hand", Path(__file__).with_name("hand.py"))
assert _spec and _spec.loader
hand = importlib.util.module_from_spec(_spec)
_spec.loader.exec_module(hand)

PADS = {name: f"{name}_pad" for name in hand.FINGERS}
BLOCK = """
<mujoco><option timestep=".002" gravity="0 0 0"/><worldbody>
  <body name="block"><geom type="box" size=".02 .02 .02"/></body>
  <body name="tip" pos=".004 0 .034"><joint name="slide" type="slide" axis="0 0 -1" damping="20"/>
    <geom name="pad" type="box" size=".01 .01 .004" mass=".1"/></body>
</worldbody><actuator><motor joint="slide"/></actuator></mujoco>"""
TIP = {"tip": "pad"}
SAMPLE = 5
WORLDS = 3
MATERIALS = ("glass", "wood", "aluminium")


def recorded(model: mujoco.MjModel, data: mujoco.MjData, substeps: int) -> np.ndarray:
    """(1, substeps, sensordata)."""
    rows = []
    for _ in range(substeps):
        mujoco.mj_step(model, data)
        rows.append(data.sensordata.copy())
    return np.array(rows)[None]


def block() -> tuple[mujoco.MjModel, np.ndarray]:
    """A pad comes to a block, presses it, and leaves it: the model and (1, 500, sensordata)."""
    model = prepare(mujoco.MjSpec.from_string(BLOCK), TIP, {"block": "glass"})
    data, parts = mujoco.MjData(model), []
    for force, substeps in ((5.0, 400), (-2.0, 100)):
        data.ctrl[0] = force
        parts.append(recorded(model, data, substeps))
    return model, np.concatenate(parts, axis=1)


def worlds_of(model: mujoco.MjModel, **words: object) -> tuple[ThermalTouch, FixedTouch]:
    two = [ThermalBody(name, 24.0 + 10 * w) for w, name in enumerate(MATERIALS)]
    touch = ThermalTouch(model, fingertips=TIP, objects={"block": two}, chain="ideal", worlds=WORLDS, **words)  # pyright: ignore[reportArgumentType]
    return touch, touch.fixed_touch(np.zeros(0))


def test_it_goes_on_as_update_does() -> None:
    """Three fingers on a can, each by a strip narrower than its sensor."""
    model = prepare(mujoco.MjSpec.from_string(hand.scene()), PADS, {"can": "glass"})
    data = mujoco.MjData(model)
    hand.press(data, 8.0)
    touch = ThermalTouch(model, fingertips=PADS, objects={"can": "glass"}, worlds=1)
    touch._electronics._chains["noise"] = 0.0
    touch.update(recorded(model, data, 250))
    fixed = touch.fixed_touch(np.zeros(0))
    state = fixed.start(2)
    for _ in range(40):
        record = recorded(model, data, 2 * SAMPLE)
        touch.update(record)
        for half in (record[:, :SAMPLE], record[:, SAMPLE:]):
            state, reading = fixed.advance(state, fixed.contacts(np.repeat(half[:, ::-1], 2, axis=0)))
        np.testing.assert_allclose(
            reading.temperature_drop, np.repeat(touch.reading.temperature_drop, 2, axis=0), rtol=0, atol=1e-12
        )
        warmth = touch.reading.object_temperature["can"]
        np.testing.assert_allclose(reading.object_temperature, np.full((2, 1), warmth), rtol=0, atol=1e-10)
        np.testing.assert_array_equal(reading.voltage[1], touch.reading.voltage[0])
        assert (reading.touching == 0).all()
    assert abs(state.narrow).max() > 0
    assert touch.reading.temperature_drop.min() > 1.0


HARD = """
<mujoco><option timestep=".002" gravity="0 0 0"/><worldbody>
  <body name="left" pos="-.035 0 0"><joint type="slide" axis="1 0 0" damping="20"/>
    <geom type="box" size=".004 .01 .005" pos="0 0 .005" mass=".1"/>
    <geom type="box" size=".004 .01 .005" pos="0 0 -.005" mass=".1"/></body>
  <body name="right" pos=".04 0 0"><joint type="slide" axis="-1 0 0" damping="20"/>
    <geom name="ball" type="sphere" size=".009" mass=".1"/></body>
  <body name="can"><geom type="cylinder" size=".03 .05"/></body>
  <body name="far" pos="0 .5 0"><geom type="box" size=".02 .02 .02"/>
    <geom type="sphere" size=".02" pos=".02 0 0"/></body>
</worldbody></mujoco>"""


def test_pads_of_two_geoms_round_pads_and_objects_that_nothing_touches() -> None:
    flat = Fingertip("left", position=(0.004, 0, 0), normal=(1, 0, 0), size=(0.02, 0.02))
    tips, materials_of = {"left": flat, "right": "ball"}, {"can": "glass", "far": "steel"}
    model = prepare(mujoco.MjSpec.from_string(HARD), tips, materials_of)
    data = mujoco.MjData(model)
    touch = ThermalTouch(model, fingertips=tips, objects=materials_of, worlds=1, chain="ideal")
    data.qfrc_applied[:2] = 8.0
    touch.update(recorded(model, data, 100))
    fixed = touch.fixed_touch(np.zeros(0), materials={"can": "wood"})
    state = fixed.start(1)
    for _ in range(10):
        data.qfrc_applied[:2] += 0.5
        record = recorded(model, data, 2 * SAMPLE)
        touch.update(record)
        for half in (record[:, :SAMPLE], record[:, SAMPLE:]):
            state, reading = fixed.advance(state, fixed.contacts(half))
        right = touch.reading
        np.testing.assert_allclose(reading.temperature_drop, right.temperature_drop, rtol=0, atol=1e-12)
    assert touch.reading.touching == (("can", "can"),) and touch.reading.temperature_drop.min() > 0.5


def test_worlds_have_materials_and_temperatures_of_their_own() -> None:
    """From before the first touch until after the last one."""
    model, record = block()
    touch, fixed = worlds_of(model)
    state, closest = fixed.start(), []
    assert state.material.tolist() == [[0], [1], [2]]
    for begin in range(0, record.shape[1], 2 * SAMPLE):
        part = np.repeat(record[:, begin : begin + 2 * SAMPLE], WORLDS, axis=0)
        touch.update(part)
        force = []
        for half in (part[:, :SAMPLE], part[:, SAMPLE:]):
            state, reading = fixed.advance(state, fixed.contacts(half))
            force.append(reading.force)
        right = touch.reading
        # what nothing touches fades by the step's rational function, within 3e-6 of the exponential
        np.testing.assert_allclose(reading.temperature_drop, right.temperature_drop, rtol=0, atol=2e-5)
        warmth = right.object_temperature["block"]
        np.testing.assert_allclose(reading.object_temperature[:, 0], warmth, rtol=0, atol=1e-5)
        np.testing.assert_allclose(np.mean(force, axis=0), right.force, rtol=1e-12, atol=1e-12)
        closest.append(reading.touching[0, 0])
    assert closest[0] == -1 and closest[30] == 0 and closest[-1] == -1
    before = touch._heat.state().started
    assert len(set(np.round(before.ravel(), 3))) == WORLDS


def test_resets_go_by_world() -> None:
    model, record = block()
    _, fixed = worlds_of(model)
    contacts = fixed.contacts(np.repeat(record[:, 300 : 300 + SAMPLE], WORLDS, axis=0))
    state = fixed.start()
    for _ in range(10):
        state, _ = fixed.advance(state, contacts)
    one = np.array([False, True, False])
    after = fixed.reset(state, one)
    for old, new, first in zip(_flat(state), _flat(after), _flat(fixed.start()), strict=True):
        np.testing.assert_array_equal(new[~one], old[~one])
        np.testing.assert_array_equal(new[one], first[one])
    # another material and temperature: as a world that has had them from the start
    number, warm = np.array([[0], [2], [0]]), np.full((WORLDS, 1), 44.0)
    changed = fixed.reset(state, one, material=number, temperature=warm)
    np.testing.assert_array_equal(changed.material, [[0], [2], [2]])
    np.testing.assert_array_equal(changed.heat[1], fixed.start().heat[2])
    np.testing.assert_array_equal(changed.heat[0], state.heat[0])
    _, reading = fixed.advance(fixed.reset(state), contacts)
    _, fresh = fixed.advance(fixed.start(), contacts)
    np.testing.assert_array_equal(reading.temperature_drop, fresh.temperature_drop)


def test_a_world_that_breaks_down_fails_alone() -> None:
    model, record = block()
    _, fixed = worlds_of(model)
    part = np.repeat(record[:, 300 : 300 + SAMPLE], WORLDS, axis=0)
    good, right = fixed.advance(fixed.start(), fixed.contacts(part))
    state = good
    for column in range(part.shape[2]):  # a place where nothing presses too
        broken = part.copy()
        broken[1, 2, column] = np.inf if column % 2 else np.nan
        with np.errstate(invalid="ignore"):
            contacts = fixed.contacts(broken)
        if all(np.isfinite(each).all() for each in contacts):  # a number that is not listened to
            continue
        with np.errstate(invalid="ignore"):
            state, reading = fixed.advance(fixed.start(), contacts)
        assert np.isnan(reading.temperature_drop[1]).all() and reading.touching[1] == -1
        for value, other in zip(_flat(state), _flat(good), strict=True):
            np.testing.assert_array_equal(value[[0, 2]], other[[0, 2]])
    with np.errstate(invalid="ignore"):
        state, _ = fixed.advance(state, fixed.contacts(part))
    state = fixed.reset(state, np.array([False, True, False]))
    _, reading = fixed.advance(state, fixed.contacts(part))
    np.testing.assert_array_equal(reading.temperature_drop[1], right.temperature_drop[1])


def test_forces_and_places_may_come_from_elsewhere() -> None:
    """Single contacts of the data with the poses of all bodies, in place of the sensors that prepare adds."""
    model = prepare(mujoco.MjSpec.from_string(BLOCK), TIP, {"block": "glass"})
    data = mujoco.MjData(model)
    touch = ThermalTouch(model, fingertips=TIP, objects={"block": "glass"})
    fixed = touch.fixed_touch(np.zeros(0), materials={"block": ("wood", "glass")})
    assert [each.name for each in fixed.materials[0]] == ["wood", "glass"]
    start = fixed.start(1)
    assert start.material.tolist() == [[1]]
    data.ctrl[0] = 5.0
    record = recorded(model, data, 300)[:, -1:].repeat(SAMPLE, axis=1)
    force, place = np.zeros((1, SAMPLE, 1, 1, 4, 3)), np.zeros((1, SAMPLE, 1, 1, 4, 3))
    for n in range(data.ncon):
        share = np.zeros(6)
        mujoco.mj_contactForce(model, data, n, share)
        along = data.contact.frame[n, :3] * (1 if data.contact.geom[n, 0] == model.geom("pad").id else -1)
        force[..., n, :], place[..., n, :] = share[0] * along, data.contact.pos[n]
    poses = (
        np.tile(each, (1, SAMPLE, 1, 1)) for each in (data.xpos, data.xmat, data.geom_xpos, data.geom_xmat)
    )
    _, reading = fixed.advance(start, fixed.posed(force, place, *poses))
    _, right = fixed.advance(start, fixed.contacts(record))
    assert data.ncon > 1 and right.force > 1.0
    for field, other in zip(reading, right, strict=True):
        np.testing.assert_allclose(field, other, rtol=1e-9)


def test_single_precision_is_near() -> None:
    model, record = block()
    touch, fixed = worlds_of(model)
    single = touch.fixed_touch(np.zeros(0, np.float32))
    state, near = fixed.start(), single.start()
    for begin in range(0, 400, SAMPLE):
        part = np.repeat(record[:, begin : begin + SAMPLE], WORLDS, axis=0)
        state, right = fixed.advance(state, fixed.contacts(part))
        near, reading = single.advance(near, single.contacts(part.astype(np.float32)))
        assert all(each.dtype == np.float32 for each in (near.heat, reading.voltage, reading.force))
        np.testing.assert_allclose(reading.temperature_drop, right.temperature_drop, rtol=0, atol=1e-3)


def test_what_cannot_be_is_refused() -> None:
    model, record = block()
    touch, fixed = worlds_of(model)
    state, part = fixed.start(), np.repeat(record[:, :SAMPLE], WORLDS, axis=0)
    for wrong in (part[:2], part[:, :0], part[:, :4]):
        with pytest.raises(InvalidValueError, match="force must have the shape"):
            fixed.advance(state, fixed.contacts(wrong))
    contacts = fixed.contacts(part)
    with pytest.raises(InvalidValueError, match="geom_turn must have the shape"):
        fixed.advance(state, contacts._replace(geom_turn=contacts.geom_turn[..., 0]))
    with pytest.raises(InvalidValueError, match="a record must have the shape"):
        fixed.contacts(part[..., 1:])
    with pytest.raises(InvalidValueError, match="a record must have the shape.*NoneType"):
        fixed.contacts(None)
    with pytest.raises(InvalidValueError, match="advance takes a FixedTouchState, got NoneType"):
        fixed.advance(None, contacts)  # pyright: ignore[reportArgumentType]
    with pytest.raises(InvalidValueError, match="advance takes TouchContacts, got NoneType"):
        fixed.advance(state, None)  # pyright: ignore[reportArgumentType]
    for worlds in (0, 1, 5, 2.5):
        with pytest.raises(InvalidValueError, match="worlds must be"):
            fixed.start(worlds)  # pyright: ignore[reportArgumentType]
    with pytest.raises(InvalidValueError, match=r"fixed\.contacts\(record\)"):
        fixed.advance(state, part)  # pyright: ignore[reportArgumentType]
    with pytest.raises(InvalidValueError, match="noise must be"):
        fixed.advance(state, contacts, noise=np.zeros(WORLDS))
    for worlds in (np.array([0, 2, 1]), [True, False], 1):
        with pytest.raises(InvalidValueError, match="booleans"):
            fixed.reset(state, worlds)
    listed = fixed.reset(state, [True, False, True], material=[[2], [0], [1]])
    assert listed.material.tolist() == [[2], [1], [1]]
    with pytest.raises(InvalidValueError, match="whole numbers"):
        fixed.reset(state, material=np.array([[0], [1], [3]]))
    with pytest.raises(InvalidValueError, match="material must have the shape"):
        fixed.reset(state, material=np.array([0, 1, 2]))
    with pytest.raises(InvalidValueError, match="finite"):
        fixed.reset(state, temperature=np.array([[24.0], [np.nan], [24.0]]))
    with pytest.raises(UnknownNameError, match="object"):
        touch.fixed_touch(np.zeros(0), materials={"blok": ["wood"]})
    with pytest.raises(InvalidValueError, match="floating point"):
        touch.fixed_touch(np.zeros(0, int))
    bare = mujoco.MjModel.from_xml_string(BLOCK)
    with pytest.raises(InvalidValueError, match=r"touch\.prepare"):
        ThermalTouch(bare, fingertips=TIP, objects={"block": "glass"}).fixed_touch(np.zeros(0)).contacts(part)
    weak = {"tip": Fingertip("pad", thermostat=Thermostat())}
    with pytest.raises(InvalidValueError, match="ideal thermostats alone"):
        ThermalTouch(bare, fingertips=weak, objects={"block": "glass"}).fixed_touch(np.zeros(0))


def _flat(state: object) -> list[np.ndarray]:
    heat, narrow, signal, voltage, material, first = state  # pyright: ignore[reportGeneralTypeIssues]
    return [heat, narrow, *signal, voltage, material, first]


BRICK = """
<mujoco><option timestep=".002" gravity="0 0 0"/><worldbody>
  <body name="brick"><geom name="brick" type="box" size=".015 .01 .03" euler="0 0 {}"/></body>
  <body name="left" pos="-.035 0 0"><joint type="slide" axis="1 0 0" damping="20"/>
    <geom name="left" type="box" size=".004 .01 .01" mass=".1"/></body>
  <body name="right" pos=".035 0 0"><joint type="slide" axis="-1 0 0" damping="20"/>
    <geom name="right" type="box" size=".004 .01 .01" mass=".1"/></body>
</worldbody></mujoco>"""
GRASP = {
    "left": Fingertip("left", (0.004, 0, 0), (1, 0, 0)),
    "right": Fingertip("right", (-0.004, 0, 0), (-1, 0, 0)),
}


@pytest.mark.parametrize(("turned", "way"), [(0, 0), (90, 1)])
def test_a_grasp_across_the_middle_has_a_way_for_each_side(turned: int, way: int) -> None:
    model = prepare(mujoco.MjSpec.from_string(BRICK.format(turned)), GRASP, {"brick": "glass"})
    data = mujoco.MjData(model)
    touch = ThermalTouch(model, fingertips=GRASP, objects={"brick": "glass"}, worlds=1, chain="ideal")
    fixed, ways = grasp_touch(
        model,
        touch._pads,
        touch._shapes,
        [tuple(map(material, ("wood", "glass")))],
        dt=0.01,
        substeps=SAMPLE,
        tolerance=0.05,
        ambient=24.0,
        air=5.0,
        chain=IDEAL,
        samples=4,
        like=np.zeros(0),
    )
    assert ways == 3
    recorder = touch.fixed_touch(np.zeros(0))
    state = fixed.reset(fixed.start(1), material=np.array([[ways + way]]))
    data.qfrc_applied[:2], right = 8.0, np.zeros(2)
    for _ in range(40):
        record = recorded(model, data, 2 * SAMPLE)
        touch.update(record)
        for half in (record[:, :SAMPLE], record[:, SAMPLE:]):
            state, reading = fixed.advance(state, recorder.contacts(half))
        right = touch.reading.temperature_drop
        # as in test_worlds_have_materials_and_temperatures_of_their_own, until both touch
        np.testing.assert_allclose(reading.temperature_drop, right, rtol=0, atol=2e-5)
    assert right.min() > 2.0


def test_more_combinations_than_fit_are_refused() -> None:
    model = mujoco.MjModel.from_xml_string(BRICK.format(0))
    touch = ThermalTouch(model, fingertips=GRASP, objects={"brick": "glass"})
    with pytest.raises(InvalidValueError, match="combine in 6000 ways"):
        grasp_touch(
            model,
            touch._pads,
            touch._shapes,
            [[material("glass")] * 2000],
            dt=0.01,
            substeps=SAMPLE,
            tolerance=0.05,
            ambient=24.0,
            air=5.0,
            chain=IDEAL,
            samples=4,
            like=np.zeros(0),
        )
