"""Mjlab-Lift-Cube-Yam, unmodified but for the sensor, an observation and an event: cubes of aluminium and of wood."""

# this package is installed in the environment of make test-mjlab alone
# pyright: reportMissingImports=false, reportAttributeAccessIssue=false

from __future__ import annotations

import re
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

import mujoco
import numpy as np
import pytest

pytest.importorskip("mjlab", reason="mjlab is not installed: make test-mjlab installs it")

import torch
from torch.utils._python_dispatch import TorchDispatchMode

from thermograsp import thermal
from thermograsp.errors import InvalidValueError, UnknownNameError
from thermograsp.mjlab import (
    ThermalTouchCfg,
    ThermalTouchSensor,
    temperature_drop,
)
from thermograsp.mjlab.heat import WorldsHeat
from thermograsp.touch import Fingertip, FixedTouch, TouchContacts, grasp_touch
from thermograsp.touch.contacts import (
    AREA,
    ASIDE,
    BESIDE,
    CLOSED,
    COLUMNS,
    CONDUCTANCE,
    LENGTH,
    NORMAL,
    PLACE,
    PULSES,
)
from thermograsp.touch.heat import JoinedHeat
from thermograsp.touch.scene import BodyShape, PadPlace, bodies, pads

WORLDS = 8
MATERIALS = ("aluminium", "wood")
FINGERTIPS = {"left": "robot/lf_down", "right": "robot/rf_down"}
HOLD = 50  # control steps, 1 s

BRICK = """
<mujoco><worldbody>
  <body name="brick"><freejoint/><geom name="brick" type="box" size=".01 .015 .03"/></body>
  <body pos="-.05 0 0"><geom name="left" type="box" size=".004 .01 .01"/></body>
  <body pos=".05 0 0"><geom name="right" type="box" size=".004 .01 .01"/></body>
</worldbody></mujoco>"""


@dataclass(frozen=True)
class Held:
    """The environment after its grippers have closed on their cubes and held them. Of every control step since the
    reset: contacts in double precision, and drop: (steps, B, F) K. observation: the last. addresses: of the data's
    tensors before."""

    env: Any
    touch: ThermalTouchSensor
    contacts: list[TouchContacts]
    drop: np.ndarray
    observation: torch.Tensor
    addresses: list[int]


def addresses(touch: ThermalTouchSensor) -> list[int]:
    data = touch.data
    return [one.data_ptr() for one in (data.voltage, data.temperature_drop, data.force, data.touching)]


@pytest.fixture(scope="module")
def held() -> Held:
    names: dict[str, Any] = {}
    page = (Path(__file__).parents[2] / "docs" / "engines.md").read_text(encoding="utf-8")
    (block,) = re.findall(r"^```python mjlab\n(.*?)^```$", page, re.DOTALL | re.MULTILINE)
    exec(compile(block, "engines.md", "exec"), names)
    env = names["env"]
    touch = env.scene["touch"]
    touch.set_material("cube/cube", torch.arange(WORLDS) % len(MATERIALS))
    before, contacts, drop = addresses(touch), [], []
    action = torch.zeros(WORLDS, env.action_manager.total_action_dim)
    observation: Any = {}
    for step in range(HOLD + 30):
        action[:, -1] = 0.25 if step < 10 else -1.0
        if step < 25:  # the cube stays between the pads until they have it
            place(env)
        observation, *_ = env.step(action)
        contacts.append(TouchContacts(*(part.numpy().astype(float) for part in touch._record)))
        drop.append(touch.data.temperature_drop.numpy().copy())
    return Held(env, touch, contacts, np.array(drop), observation["actor"], before)


def place(env: Any) -> None:
    """Every cube in the middle between its gripper's pads, at rest."""
    model, data = env.sim.mj_model, env.sim.data
    first, second = (model.body(name).id for name in FINGERTIPS.values())
    turn = data.xmat[:, first]
    middle = (data.xpos[:, first] + data.xpos[:, second]) / 2 + 0.06 * turn[:, :, 2]
    pose = torch.cat((middle, data.xquat[:, first]), 1)
    cube = env.scene["cube"]
    cube.write_root_link_pose_to_sim(pose)
    cube.write_root_link_velocity_to_sim(torch.zeros(WORLDS, 6))


def test_aluminium_is_colder_than_wood(held: Held) -> None:
    data = held.touch.data
    assert (data.touching == 0).all() and (data.force > 1.0).all()
    drop = data.temperature_drop
    assert drop.shape == (WORLDS, 2) and data.voltage.shape == (WORLDS, 2, 16)
    assert float(drop[0::2].min()) > 2 * float(drop[1::2].max()) > 0
    assert float(data.voltage[0::2, :, -1].min()) > 2 * float(data.voltage[1::2, :, -1].max())


def test_the_observation_ends_with_the_voltages(held: Held) -> None:
    env, data = held.env, held.touch.data
    np.testing.assert_array_equal(held.observation[:, -32:], data.voltage.flatten(1))
    assert torch.equal(temperature_drop(env, "touch"), data.temperature_drop)


def in_double(held: Held) -> tuple[FixedTouch, list[BodyShape], tuple[PadPlace, ...]]:
    """The sensor's FixedTouch in NumPy's double precision, its objects and its pads."""
    cfg, model = held.touch.cfg, held.env.sim.mj_model
    shapes = [
        replace(shape, temperature=cfg.ambient) for shape in bodies(model, {"cube/cube": "wood"}, cfg.ambient)
    ]
    tips = pads(model, cfg.fingertips, tuple(shapes))
    fixed, ways = grasp_touch(
        model,
        tips,
        shapes,
        [held.touch.materials("cube/cube")],
        dt=cfg.dt,
        substeps=4,
        tolerance=cfg.tolerance,
        ambient=cfg.ambient,
        air=cfg.air,
        chain=thermal.IDEAL,
        samples=cfg.samples,
        like=np.zeros(0),
    )
    assert ways == 1
    return fixed, shapes, tips


def test_single_precision_is_near_to_double(held: Held) -> None:
    fixed, _, _ = in_double(held)
    state = fixed.reset(fixed.start(WORLDS), material=np.arange(WORLDS)[:, None] % 2)
    for contacts, drop in zip(held.contacts, held.drop, strict=True):
        state, reading = fixed.advance(state, contacts)
        np.testing.assert_allclose(drop, reading.temperature_drop, rtol=0, atol=1e-4)
    assert held.drop.max() > 5.0


def test_it_is_the_heat_of_the_cpu_environments(held: Held) -> None:
    """ThermalTouch's compiled kernel on the same contacts, the pads in the middles of the cubes' faces."""
    cfg = held.touch.cfg
    fixed, (cube,), tips = in_double(held)
    heat = JoinedHeat(
        tips,
        (),
        (cube,),
        worlds=WORLDS,
        dt=cfg.dt,
        tolerance=cfg.tolerance,
        film=cfg.air,
        ambient=cfg.ambient,
    )
    worlds = range(WORLDS)
    heat.set_materials(worlds, [(thermal.material(MATERIALS[w % 2]),) for w in worlds])
    heat.reset(worlds, np.full((WORLDS, 1), cfg.ambient))
    touches = np.zeros((WORLDS, 2, 3, COLUMNS))
    touches[..., PLACE : PLACE + 3] = cube.centre
    touches[:, 0, 0, NORMAL : NORMAL + 3], touches[:, 1, 0, NORMAL : NORMAL + 3] = (
        cube.axes[:, 0],
        -cube.axes[:, 0],
    )
    material = np.arange(WORLDS)[:, None] % 2
    for contacts, drop in zip(held.contacts, held.drop, strict=True):
        step = fixed.reads.of_step(contacts, material, fixed.of_object)
        area = step.area * step.closed
        touches[:, :, :1, CONDUCTANCE], touches[:, :, :1, AREA] = step.conductance, area
        touches[:, :, :1, ASIDE:BESIDE] = area[..., None] * step.shares
        touches[:, :, :1, LENGTH] = area * step.length
        touches[:, :, :1, CLOSED], touches[:, :, :1, PULSES] = step.closed, step.pulses
        heat.advance(touches, 1)
        np.testing.assert_allclose(drop, heat.drop, rtol=0, atol=1e-4)


def test_compiled_steps_feel_the_same(held: Held) -> None:
    touch = held.touch
    model, like = held.env.sim.mj_model, touch.data.force[:, 0]
    heat = WorldsHeat(model, touch._fixed, touch._shapes(model), ways=1, like=like, compiled=torch.compile)
    material, tensors = torch.arange(WORLDS)[:, None] % 2, [one.data_ptr() for one in heat.reading]
    for contacts, drop in zip(held.contacts, held.drop, strict=True):
        heat.advance(TouchContacts(*(torch.from_numpy(part).float() for part in contacts)), material, 0.0)
        np.testing.assert_allclose(heat.reading.temperature_drop, drop, rtol=0, atol=1e-4)
    assert [one.data_ptr() for one in heat.reading] == tensors


def test_an_object_that_is_grasped_another_way_keeps_its_mean_temperature() -> None:
    """A brick across one side, then across another: what was warm in it is even by then."""
    model = mujoco.MjModel.from_xml_string(BRICK)
    tips = {
        "left": Fingertip("left", (0.004, 0, 0), (1, 0, 0)),
        "right": Fingertip("right", (-0.004, 0, 0), (-1, 0, 0)),
    }
    shapes = bodies(model, {"brick": "glass"}, 24.0)
    like = torch.zeros(1, dtype=torch.float64)
    fixed, ways = grasp_touch(
        model,
        pads(model, tips, shapes),
        shapes,
        [(thermal.material("glass"),)],
        dt=0.02,
        substeps=1,
        tolerance=0.05,
        ambient=24.0,
        air=5.0,
        chain=thermal.IDEAL,
        samples=1,
        like=like,
    )
    assert ways == 3

    def pressed(angle: float, force: float) -> TouchContacts:
        turn = torch.tensor(
            [[np.cos(angle), -np.sin(angle), 0], [np.sin(angle), np.cos(angle), 0], [0, 0, 1.0]]
        )
        half = 0.01 if angle == 0 else 0.015
        place = torch.tensor([[-half, 0, 0], [half, 0, 0]]).double()
        push = torch.tensor([[force, 0, 0], [-force, 0, 0]]).double()
        eye = torch.eye(3).double()
        return TouchContacts(
            push[None, None, :, None, None],
            place[None, None, :, None, None],
            torch.stack((place[0] - eye[0] * 0.004, place[1] + eye[0] * 0.004))[None, None],
            torch.stack((eye, eye))[None, None],
            torch.zeros(1, 1, 1, 3).double(),
            turn.double()[None, None, None],
        )

    heat, glass = WorldsHeat(model, fixed, shapes, ways=ways, like=like), torch.zeros(1, 1, dtype=torch.long)
    for _ in range(100):
        heat.advance(pressed(0.0, 10.0), glass, 0.0)
    assert heat.state.material.item() == 0
    heat.advance(pressed(0.0, 0.0), glass, 0.0)
    uneven = (fixed.states_of - fixed.mean)[0]
    assert (heat.state.heat * uneven).abs().max() > 0.01
    even = heat.state._replace(heat=heat.state.heat * (1 - uneven), material=glass + 1)
    _, wanted = fixed.advance(even, pressed(np.pi / 2, 10.0))
    heat.advance(pressed(np.pi / 2, 10.0), glass, 0.0)
    assert heat.state.material.item() == 1
    for field, right in zip(heat.reading, wanted, strict=True):
        assert torch.equal(field, right)
    heat.reset(slice(None))
    fresh = WorldsHeat(model, fixed, shapes, ways=ways, like=like)
    for one in (heat, fresh):
        one.advance(pressed(0.0, 10.0), glass, 0.0)
    assert heat.reading.temperature_drop.min() > 0.1
    assert torch.equal(heat.reading.temperature_drop, fresh.reading.temperature_drop)


def test_tensors_stay_where_they_are(held: Held) -> None:
    assert addresses(held.touch) == held.addresses


class Copies(TorchDispatchMode):
    """Notes what would wait for a device: numbers and shapes that go to the host."""

    WAITING = ("_local_scalar_dense", "nonzero", "masked_select", "is_nonzero")

    def __init__(self) -> None:
        super().__init__()
        self.found: list[str] = []

    def __torch_dispatch__(self, func: Any, types: Any, args: Any = (), kwargs: Any = None) -> Any:
        name = func.__name__.split(".")[0]
        if name in self.WAITING:
            self.found.append(name)
        return func(*args, **(kwargs or {}))


def test_a_step_copies_nothing_to_the_host(held: Held) -> None:
    with Copies() as copies:
        for _ in range(4):
            held.touch.update(0.005)
    assert copies.found == []
    with Copies() as copies:  # the test sees one
        float(torch.ones(1).sum())
    assert copies.found == ["_local_scalar_dense"]


def test_resets_go_by_ids(held: Held) -> None:
    touch = held.touch
    before = touch.data.temperature_drop.clone(), touch.data.voltage.clone()
    ids = torch.tensor([1, 6])
    touch.reset(ids)
    after = touch.data
    assert not after.temperature_drop[ids].any() and (after.voltage[ids].abs() < 1e-4).all()
    assert (after.touching[ids] == -1).all()
    others = torch.tensor([0, 2, 3, 4, 5, 7])
    assert torch.equal(after.temperature_drop[others], before[0][others])
    assert torch.equal(after.voltage[others], before[1][others])
    assert addresses(touch) == held.addresses
    before = touch.data.temperature_drop.clone(), touch.material.clone()
    none = torch.zeros(0, dtype=torch.long)
    touch.reset(none)
    touch.set_material("cube/cube", none, none)
    assert torch.equal(touch.data.temperature_drop, before[0]) and torch.equal(touch.material, before[1])


def test_a_world_that_breaks_down_fails_alone(held: Held) -> None:
    touch = held.touch
    touch._record.force[2] = float("nan")
    touch._advance()
    drop = touch.data.temperature_drop
    broken = torch.arange(WORLDS) == 2
    assert drop[broken].isnan().all() and not drop[~broken].isnan().any()
    touch.reset(torch.tensor([2]))
    touch._advance()
    assert not touch.data.temperature_drop.isnan().any()


def test_every_reset_draws_materials(held: Held) -> None:
    drawn = set()
    for _ in range(6):
        held.env.reset()
        drawn.update(tuple(row) for row in held.touch.material.T.tolist())
        assert not held.touch.data.temperature_drop.any()
    assert len(drawn) > 1 and all(set(row) <= {0, 1} for row in drawn)


def test_what_cannot_be_is_refused(held: Held) -> None:
    touch = held.touch
    with pytest.raises(UnknownNameError, match="object"):
        touch.set_material("can", 0)
    with pytest.raises(InvalidValueError, match="materials 0 to 1"):
        touch.set_material("cube/cube", 2)
    with pytest.raises(InvalidValueError, match="objects: none given"):
        ThermalTouchCfg("touch", fingertips=FINGERTIPS).build()
    with pytest.raises(InvalidValueError, match="samples"):
        ThermalTouchCfg("touch", fingertips=FINGERTIPS, objects={"cube/cube": "wood"}, samples=0).build()
    with pytest.raises(UnknownNameError, match="signal chain"):
        ThermalTouchCfg("touch", fingertips=FINGERTIPS, objects={"cube/cube": "wood"}, chain="x").build()
    with pytest.raises(UnknownNameError, match="material"):
        ThermalTouchCfg("touch", fingertips=FINGERTIPS, objects={"cube/cube": "unobtainium"}).build()


@pytest.mark.parametrize(
    ("words", "match"),
    [
        ({"fingertips": {"left": "robot/lf_dawn"}}, "lf_down"),
        ({"fingertips": {}}, "none given"),
        ({"fingertips": {"left": "robot/lf_down", "right": "robot/rf_down4_collision"}}, "all by geoms"),
    ],
)
def test_names_are_checked_in_the_scene(held: Held, words: dict[str, Any], match: str) -> None:
    keywords = {"fingertips": FINGERTIPS, "objects": {"cube/cube": "wood"}} | words
    with pytest.raises((InvalidValueError, UnknownNameError), match=match):
        ThermalTouchCfg("touch", **keywords).build().edit_spec(held.env.scene.spec, {})
