"""Mjlab-Lift-Cube-Yam, unmodified but for the sensor, an observation and an event: cubes of aluminium and of wood."""

# this package is installed in the environment of make test-mjlab alone
# pyright: reportMissingImports=false, reportAttributeAccessIssue=false

from __future__ import annotations

import re
from dataclasses import dataclass
from pathlib import Path
from typing import Any

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

WORLDS = 8
MATERIALS = ("aluminium", "wood")
FINGERTIPS = {"left": "robot/lf_down", "right": "robot/rf_down"}
HOLD = 50  # control steps, 1 s


@dataclass(frozen=True)
class Held:
    """The environment after its grippers have closed on their cubes and held them. conductance: (steps, B, F) W/K and
    drop: (steps, B, F) K of every control step since the reset. observation: the last. addresses: of the data's tensors
    before."""

    env: Any
    touch: ThermalTouchSensor
    conductance: np.ndarray
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
    before, noted = addresses(touch), []
    action = torch.zeros(WORLDS, env.action_manager.total_action_dim)
    observation: Any = {}
    for step in range(HOLD + 30):
        action[:, -1] = 0.25 if step < 10 else -1.0
        if step < 25:  # the cube stays between the pads until they have it
            place(env)
        observation, *_ = env.step(action)
        data = touch.data
        noted.append((data.conductance.numpy().copy(), data.temperature_drop.numpy().copy()))
    conductance, drop = map(np.array, zip(*noted, strict=True))
    return Held(env, touch, conductance, drop, observation["actor"], before)


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


def test_it_is_the_heat_of_the_cpu_environments(held: Held) -> None:
    """On the same conductances, in double precision and a cube at a time."""
    cfg = held.touch.cfg
    worst = 0.0
    for world in range(WORLDS):
        tips = thermal.array_fingertips(
            MATERIALS[world % 2], dt=cfg.dt, like=np.zeros(0), chain=thermal.IDEAL, air=cfg.air
        )
        state = tips.start(1)
        for conductance, drop in zip(held.conductance[:, world], held.drop[:, world], strict=True):
            state, _, reading = tips.step(state, conductance[None].astype(float))
            worst = max(worst, float(np.abs(reading.drop[0] - drop).max()))
    assert held.drop.max() > 1.0
    assert worst < 1e-4


def test_it_is_the_heat_of_the_compiled_kernel(held: Held) -> None:
    """Another solver of the same networks: the one that the Gymnasium environments run."""
    cfg = held.touch.cfg
    sizes = (0.04, 0.04, 0.04)
    for world in range(2):
        stack = thermal.sensor("seed")
        cube = thermal.Geometry(
            stack, thermal.material(MATERIALS[world]), "T", stack.face_area, "square", sizes, 2
        )
        system = thermal.network_for(cube, thermal.Demand(cfg.tolerance, 12.0), air=cfg.air).system
        tables = thermal.heat_tables([system], [cfg.air], cfg.dt)
        state = np.zeros((1, len(system.rates)))
        for conductance, drop in zip(held.conductance[:, world], held.drop[:, world], strict=True):
            state, reading = thermal.advance_heat(
                tables,
                np.zeros(1, np.int64),
                state,
                conductance[None].astype(float),
                np.full((1, 2), 12.0),
                np.ones(1, bool),
                1,
            )
            np.testing.assert_allclose(np.ravel(reading.drop), drop, atol=1e-4)


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


def test_a_world_that_breaks_down_fails_alone(held: Held) -> None:
    touch = held.touch
    force = touch._sensors[0]._history_state["force"]  # pyright: ignore[reportOptionalSubscript]
    force[2] = float("nan")
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
    told = {"fingertips": FINGERTIPS, "objects": {"cube/cube": "wood"}} | words
    with pytest.raises((InvalidValueError, UnknownNameError), match=match):
        ThermalTouchCfg("touch", **told).build().edit_spec(held.env.scene.spec, {})
