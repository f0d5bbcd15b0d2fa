"""Round-off decides nothing: what differs by one part in 1e15 is alike to 1e-9 K, wherever fingertips slide."""

# mujoco ships no type stubs for its compiled names
# pyright: reportAttributeAccessIssue=false

import importlib.util
from dataclasses import replace
from pathlib import Path

import mujoco
import numpy as np
import pytest

from thermograsp.thermal import Material, SensorStack, material, sensor
from thermograsp.touch import Fingertip, ThermalBody, ThermalTouch, prepare

from .engine_scene import NEEDS_RECORDS

_spec = importlib.util.spec_from_file_location("hand", Path(__file__).with_name("hand.py"))
assert _spec and _spec.loader
hand = importlib.util.module_from_spec(_spec)
_spec.loader.exec_module(hand)

ROUND_OFF = 1e-9  # K
SHARE = 1e-15
WORLDS = 4
STEP = 0.125 * sensor("seed").width  # m of the grid on which places stand
ORDERS, STEPS = 8, 150


def slide(model: mujoco.MjModel, rng: np.random.Generator) -> np.ndarray:
    """(ORDERS * STEPS, sensordata) of two or three fingers that press, slip and let go."""
    data, found = mujoco.MjData(model), np.empty((ORDERS * STEPS, model.nsensordata))
    for number in range(ORDERS):
        hand.press(data, rng.uniform(3.0, 15.0), *hand.FINGERS[: 2 + number % 2])
        data.actuator("palm").ctrl[0], data.actuator("palm_z").ctrl[0] = rng.uniform(-0.018, 0.018, 2)
        for step in range(number * STEPS, (number + 1) * STEPS):
            mujoco.mj_step(model, data)
            found[step] = data.sensordata
    return found


def by_round_off(record: np.ndarray, rng: np.random.Generator) -> np.ndarray:
    """(WORLDS, steps, sensordata) of one record (steps, sensordata), which the first world has unchanged."""
    found = np.repeat(record[None], WORLDS, axis=0)
    found[1:] *= 1 + SHARE * rng.uniform(-1.0, 1.0, found[1:].shape)
    return found


def nudged(value: float, rng: np.random.Generator) -> float:
    return value * (1 + SHARE * rng.uniform(-1.0, 1.0))


def nudged_matter(matter: Material, rng: np.random.Generator) -> Material:
    return replace(matter, conductivity=nudged(matter.conductivity, rng), density=nudged(matter.density, rng))


def nudged_sensor(stack: SensorStack, rng: np.random.Generator) -> SensorStack:
    return replace(stack, width=nudged(stack.width, rng))


@NEEDS_RECORDS
@pytest.mark.parametrize(
    ("name", "skin"),
    [
        pytest.param("rubber", None, marks=pytest.mark.slow),
        ("rubber", "filled_silicone"),
        ("aluminium", None),
        pytest.param("wood", None, marks=pytest.mark.slow),
    ],
)
def test_slides_that_differ_by_round_off_are_curves_alike(name: str, skin: str | None) -> None:
    rng, matter, stack = np.random.default_rng(7), material(name), sensor("seed")
    pads = {finger: f"{finger}_pad" for finger in hand.FINGERS}
    model = prepare(mujoco.MjSpec.from_string(hand.scene()), pads, {"can": name})
    record = by_round_off(slide(model, rng), rng)
    cans = [matter, *(nudged_matter(matter, rng) for _ in range(WORLDS - 1))]
    curves = []
    for worn in (stack, nudged_sensor(stack, rng)):
        tips = {finger: Fingertip(pad, sensor=worn, skin=skin) for finger, pad in pads.items()}
        bodies = {"can": [ThermalBody(can, 5.0) for can in cans]}
        touch = ThermalTouch(model, fingertips=tips, objects=bodies, worlds=WORLDS)
        drops = [
            touch.update(record[:, step : step + 10]).temperature_drop.copy()
            for step in range(0, record.shape[1], 10)
        ]
        curves.append(np.stack(drops))
        assert len(touch._heat._fields[0][0].places) > len(pads)
    both = np.concatenate(curves, axis=1)  # (samples, 2 WORLDS, F)
    assert np.abs(both).max() > 0.1
    assert np.abs(both - both[:, :1]).max() < ROUND_OFF


@NEEDS_RECORDS
@pytest.mark.parametrize(
    ("geom", "turn", "aside"),
    [("cylinder", 45.0, 0.0), ("box", 0.0, 0.5 * STEP), ("box", 0.0, -1.5 * STEP)],
    ids=["between faces", "between points", "between others"],
)
def test_where_a_pad_is_in_the_middle_the_place_is_the_same(geom: str, turn: float, aside: float) -> None:
    """Between two faces of the box that stands for a can, or two points of the grid on which places stand."""
    size = ".02 .03" if geom == "cylinder" else ".03 .02 .02"
    spec = mujoco.MjSpec.from_string(f"""
    <mujoco><option timestep=".002"/><worldbody>
      <body name="block"><geom type="{geom}" size="{size}"/></body>
      <body euler="0 0 {turn}"><body name="tip" pos="0 {aside} 0">
        <joint name="slide" type="slide" axis="-1 0 0" damping="20"/>
        <geom name="pad" type="box" pos="{0.0239 if geom == "cylinder" else 0.0339} 0 0" size=".004 .01 .01" mass=".1"/>
      </body></body>
    </worldbody><actuator><motor joint="slide"/></actuator></mujoco>""")
    model = prepare(spec, {"tip": "pad"}, {"block": "rubber"})
    data, rng, found = mujoco.MjData(model), np.random.default_rng(1), np.empty((200, model.nsensordata))
    data.ctrl[:] = 5.0
    for row in found:
        mujoco.mj_step(model, data)
        row[:] = data.sensordata
    record = by_round_off(found, rng)
    touch = ThermalTouch(
        model, fingertips={"tip": "pad"}, objects={"block": ThermalBody("rubber", 5.0)}, worlds=WORLDS
    )
    drop = np.zeros((WORLDS, 1))
    for step in range(0, len(found), 10):
        drop = touch.update(record[:, step : step + 10]).temperature_drop
        assert np.abs(drop - drop[0]).max() < ROUND_OFF
    assert len({field.places for (field,) in touch._heat._fields}) == 1
    assert drop.min() > 0.1
