"""Fingertips of ThermalTouch on fixed places: PyTorch and JAX step them and their contacts as NumPy does."""

# mujoco ships no type stubs for its compiled names
# pyright: reportAttributeAccessIssue=false

from __future__ import annotations

import mujoco
import numpy as np
import pytest

from thermograsp.touch import ThermalTouch, prepare
from thermograsp.touch.contacts.round_pads import BEND, CURVES, array_on_ellipsoid, array_round_contact
from thermograsp.touch.contacts.views import ellipsoid_radii

from .conftest import Kind

SCENE = """
<mujoco>
  <option timestep=".002" gravity="0 0 0"/>
  <worldbody>
    <body name="block"><geom type="box" size=".02 .02 .02"/></body>
    <body name="tip" pos="0 0 .0241">
      <joint type="slide" axis="0 0 -1" damping="20"/><geom name="pad" type="box" size=".01 .01 .004" mass=".1"/>
    </body>
  </worldbody>
</mujoco>"""

CAN = """
<mujoco><option timestep=".002" gravity="0 0 0"/><worldbody>
  <body name="left" pos="-.0345 0 0"><joint type="slide" axis="1 0 0" damping="20"/>
    <geom name="left_pad" type="box" size=".004 .01 .01" mass=".1"/></body>
  <body name="right" pos=".0345 0 0"><joint type="slide" axis="-1 0 0" damping="20"/>
    <geom name="right_pad" type="box" size=".004 .01 .01" mass=".1"/></body>
  <body name="can"><geom {}/></body>
</worldbody></mujoco>"""


def test_fixed_places_are_numpy_s(kind: Kind) -> None:
    model = mujoco.MjModel.from_xml_string(SCENE)
    data = mujoco.MjData(model)
    touch = ThermalTouch(model, fingertips={"tip": "pad"}, objects={"block": "glass"})
    for _ in range(100):
        data.qfrc_applied[0] = 10.0
        mujoco.mj_step(model, data)
        touch.update(data)
    exact, fixed = touch.fixed_places(np.zeros(0)), touch.fixed_places(kind.float64)
    state, expected = fixed.start(3), exact.start(3)
    step, rng = kind.compiled(fixed.advance), np.random.default_rng(0)
    for _ in range(20):
        conductance = rng.uniform(0.0, 2.0, (3, 1)) * (rng.random((3, 1)) < 0.8)
        state, drop = step(state, kind.of(conductance))
        expected, right = exact.advance(expected, conductance)
        np.testing.assert_allclose(np.asarray(drop), right, rtol=0, atol=1e-10)
        assert drop.dtype == kind.float64.dtype


@pytest.mark.parametrize(
    "geom", ['type="cylinder" size=".03 .05"', 'type="ellipsoid" size=".03 .02 .09" euler="0 0 10"']
)
def test_contacts_are_felt_as_in_numpy(kind: Kind, geom: str) -> None:
    """A can between two fingers, by strips and in worlds of two materials, in one function of the record; and an egg
    between the radii of its sides."""
    tips = {"left": "left_pad", "right": "right_pad"}
    model = prepare(mujoco.MjSpec.from_string(CAN.format(geom)), tips, {"can": "glass"})
    data, rows = mujoco.MjData(model), []
    for _ in range(200):
        data.qfrc_applied[:2] = 8.0
        mujoco.mj_step(model, data)
        rows.append(data.sensordata.copy())
    touch = ThermalTouch(model, fingertips=tips, objects={"can": ["glass", "aluminium"]}, worlds=2)
    exact, fixed = touch.fixed_touch(np.zeros(0)), touch.fixed_touch(kind.float64)
    single = touch.fixed_touch(kind.float32)

    def step(state, record):
        return fixed.advance(state, fixed.contacts(record))

    compiled = kind.compiled(step)
    expected, state, near = exact.start(), fixed.start(), single.start()
    every = np.repeat(np.array(rows)[None], 2, axis=0)
    for begin in range(0, 200, exact.substeps):
        record = every[:, begin : begin + exact.substeps]
        expected, right = exact.advance(expected, exact.contacts(record))
        state, reading = compiled(state, kind.of(record))
        assert reading.temperature_drop.dtype == kind.float64.dtype
        for field, numpys in zip(reading, right, strict=True):
            np.testing.assert_allclose(np.asarray(field), numpys, rtol=1e-9, atol=1e-10)
    assert (expected.signal.last[1] > expected.signal.last[0]).all() and expected.narrow.max() > 0
    record = every[:, -exact.substeps :].astype(np.float32)
    near, reading = single.advance(near, single.contacts(kind.of(record)))
    assert {each.dtype for each in (near.heat, near.narrow, reading.force)} == {kind.float32.dtype}
    worlds = kind.of(np.array([False, True]))
    cleared, first = fixed.reset(state, worlds), fixed.start()
    np.testing.assert_array_equal(np.asarray(cleared.heat[1]), np.asarray(first.heat[1]))
    np.testing.assert_array_equal(np.asarray(cleared.heat[0]), np.asarray(state.heat[0]))


def test_round_pads_on_ellipsoids_touch_as_in_numpy(kind: Kind) -> None:
    """Without a compiler, which takes minutes for them."""
    rng, radii = np.random.default_rng(4), np.array([ellipsoid_radii((0.02, 0.008, 0.03)), [0.0] * 4])
    turn = np.linalg.qr(rng.normal(size=(5, 2, 3, 3)))[0]
    curve, bend = rng.uniform(30.0, 90.0, (5, 2, CURVES)), rng.uniform(40.0, 200.0, (5, 2, BEND))
    curve[..., 2:], bend[..., 3:7], bend[..., 8:] = 10.0, 0.004, 0.008
    bend[..., 2] = bend[..., 7] = 2e9
    lean, off, force = (
        rng.uniform(-0.4, 0.4, (5, 2, 2)),
        rng.uniform(-0.002, 0.002, (5, 2, 2)),
        np.full((5, 2), 4.0),
    )

    def touched(radii, curve, bend, lean, turn, off, force):
        sides = array_on_ellipsoid(radii, curve, lean, turn[..., 0], turn[..., 1:])
        found = array_round_contact(bend, curve, sides, 0.0 * off, force, off[..., 0], off[..., 1])
        return sides, *found[:5], *found[5]

    numbers = radii, curve, bend, lean, turn, off, force
    for found, expected in zip(touched(*map(kind.of, numbers)), touched(*numbers), strict=True):
        assert np.isfinite(expected).all()
        np.testing.assert_allclose(np.asarray(found), expected, rtol=1e-9, atol=1e-15)


@pytest.mark.parametrize("count", [2, 3, 5])
def test_several_objects_under_one_fingertip_are_numpy_s(kind: Kind, count: int) -> None:
    """Of five the four largest share its face."""
    edges = np.concatenate(([-0.02], np.linspace(-0.0035, 0.003, count - 1), [0.02]))
    blocks = "".join(
        f'<body name="{n}" pos="{(low + high) / 2} 0 -.02"><geom type="box" size="{(high - low) / 2} .02 .02"/></body>'
        for n, (low, high) in enumerate(zip(edges[:-1], edges[1:], strict=True))
    )
    spec = mujoco.MjSpec.from_string(f"""
    <mujoco><option gravity="0 0 0"/><worldbody>{blocks}<body name="tip" pos="0 0 .0041">
      <joint type="slide" axis="0 0 -1" damping="20"/><geom type="box" size=".01 .01 .004" mass=".1"/></body>
    </worldbody></mujoco>""")
    objects = dict(
        zip(map(str, range(count)), ("aluminium", "wood", "glass", "copper", "steel"), strict=False)
    )
    model, tips = prepare(spec, {"tip": "tip"}, objects), {"tip": "tip"}
    touch = ThermalTouch(model, fingertips=tips, objects=objects, worlds=1, dt=0.02, chain="ideal")
    exact, fixed = touch.fixed_touch(like=np.zeros(0)), touch.fixed_touch(like=kind.float64)
    data, state, expected = mujoco.MjData(model), fixed.start(), exact.start()
    step, drop = (
        kind.compiled(lambda state, record: fixed.advance(state, fixed.contacts(record))),
        np.zeros(1),
    )
    for _ in range(15):
        record = np.empty((1, fixed.substeps, model.nsensordata))
        for k in range(fixed.substeps):
            data.qfrc_applied[:] = 8.0
            mujoco.mj_step(model, data)
            record[0, k] = data.sensordata
        state, reading = step(state, kind.of(record))
        expected, right = exact.advance(expected, exact.contacts(record))
        drop = right.temperature_drop
        np.testing.assert_allclose(np.asarray(reading.temperature_drop), drop, rtol=0, atol=1e-10)
    assert drop[0] > 0.5


def test_derivatives_are_finite_where_an_object_is_not_touched(torch_kind: Kind) -> None:
    torch = torch_kind.xp
    objects = {"near": "aluminium", "far": "wood"}
    spec = mujoco.MjSpec.from_string("""
    <mujoco><option gravity="0 0 0"/><worldbody>
      <body name="near"><geom type="box" size=".02 .02 .02"/></body>
      <body name="far" pos=".1 0 0"><geom type="box" size=".02 .02 .02"/></body>
      <body name="tip" pos="0 0 .0241"><joint type="slide" axis="0 0 -1" damping="20"/>
        <geom type="box" size=".01 .01 .004" mass=".1"/></body></worldbody></mujoco>""")
    model, tips = prepare(spec, {"tip": "tip"}, objects), {"tip": "tip"}
    touch = ThermalTouch(model, fingertips=tips, objects=objects, worlds=1, dt=0.02, chain="ideal")
    fixed, data = touch.fixed_touch(like=torch_kind.float64), mujoco.MjData(model)
    pairs = [name for name in (model.sensor(n).name for n in range(model.nsensor)) if "frame" not in name]
    forces = np.zeros(model.nsensordata)
    for name in pairs:
        forces[model.sensor(name).adr[0] + 1 : model.sensor(name).adr[0] + 4] = 1.0
    records = []
    for _ in range(10):
        record = np.empty((1, fixed.substeps, model.nsensordata))
        for k in range(fixed.substeps):
            data.qfrc_applied[:] = 8.0
            mujoco.mj_step(model, data)
            record[0, k] = data.sensordata
        records.append(torch.tensor(record))

    def drop(factor):
        state, reading = fixed.start(), None
        for record in records:
            scale = 1 + (factor - 1) * torch.tensor(forces)
            state, reading = fixed.advance(state, fixed.contacts(record * scale))
        return reading.temperature_drop.sum()  # pyright: ignore[reportOptionalMemberAccess]

    factor = torch.ones(1, dtype=torch.float64, requires_grad=True)
    drop(factor).backward()
    with torch.no_grad():
        expected = float(drop(1 + 1e-5) - drop(1 - 1e-5)) / 2e-5
    assert expected > 1e-3
    assert float(factor.grad) == pytest.approx(expected, rel=1e-4)
