"""The pad around the sensor in environments: beside presses with a surround, books of heat, what is carried from object
to object, and what is refused."""

# mujoco ships no type stubs for its compiled names
# pyright: reportAttributeAccessIssue=false

from __future__ import annotations

from typing import Any

import gymnasium
import mujoco
import numpy as np
import pytest

import thermograsp.envs  # noqa: F401  (registers the environments)
from thermograsp.envs import GraspBatch, GraspTask, ObjectSpec, Part, SimulationConfig, Size
from thermograsp.envs.sensing import GraspHeat
from thermograsp.errors import InvalidValueError, UnknownNameError
from thermograsp.thermal import (
    Material,
    Pad,
    Surface,
    Surround,
    Thermostat,
    contact_conductance,
    flat_contact,
    joint,
    material,
    press,
    sensor,
)
from thermograsp.thermal.contact import beside_face, skinned
from thermograsp.thermal.matter import skin as named_skin
from thermograsp.thermal.padded import ring_sides
from thermograsp.touch import Fingertip
from thermograsp.touch.contacts import AREA, BESIDE, CLOSED, COLUMNS, CONDUCTANCE, LENGTH, NORMAL, PLACE
from thermograsp.touch.heat import JoinedHeat
from thermograsp.touch.scene import bodies, pads

FORCE, STEPS = 10.0, 250
CUBE, CORE = ObjectSpec(), Part("steel", size=(0.02, 0.02, 0.02))


def heat_of(rows: int = 1, tolerance: float = 0.06, air: float = 0.0) -> GraspHeat:
    return GraspHeat(rows, tolerance=tolerance, air=air, dt=0.01, samples=2, sensor_temperature=36.0)


def body_of(name: str, spec: ObjectSpec = CUBE, **words: Any):
    config = SimulationConfig(**{"material": name, "surround": "silicone", "objects": spec, **words})
    plain = dict.fromkeys(("size_factor", "mass_factor", "friction_factor", "roughness_factor"), 1.0)
    return config.body(config.stack, material(name), spec, {**plain, "object_temperature_shift": 0.0})


def held(heat: GraspHeat, steps: int, row: int = 0, force: float = FORCE) -> tuple[np.ndarray, Any]:
    """Drops (steps samples, F) K of a row under that force on both pads; the others are not touched."""
    rows = heat._rows.shape[0]
    normal, place = np.zeros((rows, 10, 2)), np.zeros((rows, 2, 3))
    normal[row], place[:, 0, 0], place[:, 1, 0] = force, -0.02, 0.02
    found = [heat.advance(normal, place) for _ in range(steps)]
    return np.concatenate([step.drop[row] for step in found]), found[-1]


@pytest.mark.parametrize("skin", [None, "filled_silicone"])
@pytest.mark.parametrize("thickness", [0.04, 0.002])
@pytest.mark.parametrize("name", ["aluminium", "glass", "wood"])
def test_a_held_box_is_as_cold_as_a_press_with_a_surround_says(
    name: str, thickness: float, skin: str | None
) -> None:
    """One fingertip, and a pad whose contact is its own."""
    spec = ObjectSpec(size=(thickness, 0.04, 0.04))
    heat, body = heat_of(), body_of(name, spec, fingertips=1, skin=skin)
    heat.reset([0], [body])
    drop, step = held(heat, STEPS)
    conducts = float(step.info["conductance"][0, 0])
    pressed = press(
        name,
        skin=skin,
        object_size=body.plate,
        conductance=min(conducts, 3e5),
        surround="silicone",
        tolerance=0.045,
        seconds=STEPS * 0.02,
        dt=0.01,
    )
    np.testing.assert_allclose(drop[4:, 0], pressed.temperature_drop[5:], atol=0.04)
    alone = heat_of()
    alone.reset([0], [body_of(name, spec, fingertips=1, skin=skin, surround=None)])
    assert np.abs(held(alone, STEPS)[0] - drop).max() > 0.03


def test_two_fingertips_feel_each_other_through_a_plate() -> None:
    spec = ObjectSpec(size=(0.003, 0.04, 0.04))
    heat, body = heat_of(), body_of("steel", spec)
    heat.reset([0], [body])
    drop, step = held(heat, STEPS)
    conducts = float(step.info["conductance"][0, 0])
    pressed = press(
        "steel",
        object_size=body.plate,
        conductance=conducts,
        opposite=conducts,
        surround="silicone",
        tolerance=0.045,
        seconds=STEPS * 0.02,
        dt=0.01,
    )
    np.testing.assert_allclose(drop[:, 0], drop[:, 1], atol=5e-3)
    np.testing.assert_allclose(drop[4:, 0], pressed.temperature_drop[5:], atol=0.04)


@pytest.mark.parametrize("force", [1.0, 30.0])
@pytest.mark.parametrize(("name", "skin"), [("sandstone", None), ("potato", "filled_silicone")])
def test_face_and_pad_conduct_by_a_pressure_each_has(name: str, skin: str | None, force: float) -> None:
    """Of rough and of soft objects, on which they conduct least alike."""
    heat, body = heat_of(), body_of(name, fingertips=1, skin=skin)
    heat.reset([0], [body])
    drop, step = held(heat, STEPS, force=force)
    worn, other = named_skin(skin), Surface.of(material(name))
    own = Surface.of(material("silicone") if worn is None else worn.made_of)
    flat = flat_contact(skinned(Pad(), worn), force)
    pressure = (force - flat.face_force) / (flat.pad - flat.face)
    pressed = press(
        name,
        skin=skin,
        object_size=body.plate,
        conductance=float(step.info["conductance"][0, 0]),
        surround="silicone",
        surround_conductance=float(contact_conductance(joint(own, other, full_contact=True), pressure)),
        tolerance=0.045,
        seconds=STEPS * 0.02,
        dt=0.01,
    )
    np.testing.assert_allclose(drop[4:, 0], pressed.temperature_drop[5:], atol=0.04)


@pytest.mark.parametrize("air", [0.0, 20.0])
def test_what_flows_is_in_the_object(air: float) -> None:
    """Through touches of any force, apart in between."""
    rng, heat = np.random.default_rng(2), heat_of(air=air)
    heat.reset([0], [body_of("glass", air=air)])
    normal, place = np.zeros((1, 10, 2)), np.array([[[-0.02, 0.0, 0.0], [0.02, 0.0, 0.0]]])
    for _ in range(400):
        normal[0] = 10.0 ** rng.uniform(-2, 2, (10, 2)) * (rng.random((10, 2)) < 0.7)
        step = heat.advance(normal, place)
        assert abs(step.info["imbalance"][0]) <= 1e-10 * step.info["exchanged"][0]
        assert ((step.drop > -0.01) & (step.drop < 12.0)).all()


def test_one_row_is_as_alone() -> None:
    names = ("aluminium", "glass", "wood")
    many = heat_of(3)
    many.reset([0, 1, 2], [body_of(name) for name in names])
    normal, place = np.full((3, 10, 2), FORCE), np.zeros((3, 2, 3))
    place[:, 0, 0], place[:, 1, 0] = -0.02, 0.02
    together = np.array([many.advance(normal, place).drop for _ in range(50)])
    for row, name in enumerate(names):
        alone = heat_of()
        alone.reset([0], [body_of(name)])
        np.testing.assert_array_equal(held(alone, 50)[0], together[:, row].reshape(100, 2))


def met(object_number: int, conducts: float, beside: float) -> np.ndarray:
    """What a reader of ThermalTouch tells of a pad that lies wholly on the lower face of one of two boxes."""
    touches, within = np.zeros((1, 1, 3, COLUMNS)), 0.009**2
    row = touches[0, 0, object_number]
    row[PLACE : PLACE + 3], row[NORMAL + 2], row[CLOSED] = (0.0, 0.0, -0.02), 1.0, 1.0
    row[CONDUCTANCE], row[AREA], row[LENGTH] = conducts * within, within, within * 0.009
    for ring, side in enumerate(ring_sides(0.009, Surround())):
        area, within = side**2 - within, side**2
        row[BESIDE + 3 * ring : BESIDE + 3 * ring + 3] = beside * area, area, 1.0
    return touches


def test_a_fingertip_takes_its_warmth_from_one_object_to_the_next() -> None:
    """From aluminium to glass, beside the fields of ThermalTouch, whose fingertip keeps its own."""
    heat = heat_of(2)
    held_bodies = [body_of(name, fingertips=1) for name in ("aluminium", "glass")]
    heat.reset([0, 1], held_bodies)
    first, step = held(heat, 100)
    stored = heat._rows["stored"][0].copy()
    heat.carry(0, 1, 0)
    np.testing.assert_allclose(heat._rows["stored"][1], stored, rtol=1e-12)
    second, other = held(heat, 250, row=1)
    model = mujoco.MjModel.from_xml_string("""
<mujoco><worldbody>
  <body name="first"><geom name="first" type="box" size=".02 .02 .02"/></body>
  <body name="second" pos=".1 0 0"><geom name="second" type="box" size=".02 .02 .02"/></body>
  <body name="tip" pos="0 0 -.1"><geom name="flat" type="box" size=".01 .01 .01"/></body>
</worldbody></mujoco>""")
    shapes = bodies(model, {"first": "aluminium", "second": "glass"}, 24.0)
    fingertips = pads(model, {"tip": Fingertip("flat", surround="silicone")}, shapes)
    fields = JoinedHeat(fingertips, (), shapes, worlds=1, dt=0.01, tolerance=0.02, film=0.0, ambient=24.0)
    conducts = float(step.info["conductance"][0, 0]), float(other.info["conductance"][1, 0])
    half, room = np.array([Surround().width / 2]), np.zeros(1)
    beside = [beside_face(body.pad_law, half, FORCE, np.zeros(3), room) for body in held_bodies]
    expected = []
    for number, count in ((0, 200), (1, 500)):
        for _ in range(count):
            fields.advance(met(number, conducts[number], beside[number]), 1)
            expected.append(fields.drop[0, 0])
    np.testing.assert_allclose(np.concatenate((first, second))[4:, 0], expected[4:], atol=0.06)


@pytest.mark.parametrize("name", ["Grasp-v0", "Identify-v0", "Sort-v0"])
def test_environments_take_it(name: str) -> None:
    words: dict[str, Any] = {"material": ["aluminium", "glass"]}
    volts = {}
    for surround in (None, "silicone"):
        env = gymnasium.make(f"thermograsp/{name}", surround=surround, **words).unwrapped
        observation, _ = env.reset(seed=4)
        action = np.zeros(env.action_space.shape) if name != "Grasp-v0" else np.array([-1.0, -0.5, 0.0])
        for _ in range(100):
            observation, *_ = env.step(action)
        volts[surround] = np.concatenate([np.ravel(each) for each in observation.values()])
        assert np.isfinite(volts[surround]).all()
        env.close()
    if name == "Grasp-v0":
        assert np.abs(volts[None] - volts["silicone"]).max() > 0


def test_without_a_pad_it_is_as_before_and_with_one_that_does_nothing_nearly_so() -> None:
    nothing = Material(
        "nothing", conductivity=1e-3, density=1.0, specific_heat=1e3, youngs_modulus=5e6, roughness=2e-6
    )
    drops = []
    for surround in (None, nothing):
        heat = heat_of()
        heat.reset([0], [body_of("glass", surround=surround)])
        drops.append(held(heat, 100)[0])
    assert np.abs(drops[1] - drops[0])[4:].max() < 0.06


def test_sizes_are_drawn_by_steps() -> None:
    batch = GraspBatch(
        2,
        task=GraspTask(),
        material="glass",
        surround="silicone",
        randomize=[Size((0.8, 1.2))],
        tolerance=0.06,
    )
    batch.reset([0, 1], [np.random.default_rng(row) for row in range(2)])
    for _ in range(60):
        batch.step(np.tile([-1.0, -0.5, 0.0], (2, 1)))
    assert batch.reading is not None and np.isfinite(batch.reading.voltage).all()


@pytest.mark.parametrize(
    ("words", "says"),
    [
        ({"mode": "O"}, "mode 'O'"),
        ({"thermostat": Thermostat()}, "finite power"),
        ({"face_temperature": (3, 3)}, "face_temperature"),
        ({"sensor": "heated_thermistor"}, "heater of its own"),
        ({"objects": "mug_of_coffee"}, "has contents"),
        ({"scene": [CUBE, ObjectSpec(name="cup", material="rubber", parts=(CORE,))]}, "'cup' has parts"),
        ({"surround": Surround(width=0.03)}, "0.03 m wide, and the pad 0.02 m"),
        ({"surround": Surround(width=0.0095)}, "leaves hardly anything"),
        ({"surround": "aluminium"}, "conducts 237"),
    ],
    ids=str,
)
def test_what_has_no_pad_around_the_sensor_is_refused(words: dict[str, Any], says: str) -> None:
    with pytest.raises(InvalidValueError, match=says):
        SimulationConfig(**{"material": "glass", "surround": "silicone", **words})
    with pytest.raises(UnknownNameError, match="silicone"):
        SimulationConfig(surround="silicon rubber")


def test_a_tolerance_that_no_network_keeps_is_named() -> None:
    heat = heat_of(tolerance=0.03)
    with pytest.raises(InvalidValueError, match="give a tolerance of 0.039 K or more"):
        heat.reset([0], [body_of("glass")])


def test_identification_is_told_the_sensors_own_face() -> None:
    config = SimulationConfig(material="glass", surround="silicone")
    body = body_of("glass")
    setup = body.touch_setup(config.chain, (36.0, 0.1), 1.0, 0.05)
    assert setup.area == pytest.approx(81e-6) and body.geometry.area == pytest.approx(4e-4)
    assert body.surround == Surround().around(sensor("seed"))
