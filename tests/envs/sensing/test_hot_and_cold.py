"""Objects that are not as warm as the room: cooling, reservoirs, heaters, ice, and what the fingertips make of them."""

from __future__ import annotations

import math

import numpy as np
import pytest

from thermograsp import thermal
from thermograsp.envs import (
    GraspBatch,
    GraspBody,
    GraspTask,
    ObjectSpec,
    action_of,
)
from thermograsp.envs.sensing.heat import GraspHeat
from thermograsp.errors import InvalidValueError
from thermograsp.thermal import Mode, Reservoir, ice, water

from ..scripted import grasp_action

ENDLESS = GraspTask(hold_seconds=1e3, seconds=1e3)
STACK = thermal.sensor("seed")
STEP = 0.02  # s
AIR = 10.0  # W/(m2 K)
SETTINGS = {"tolerance": 0.05, "dt": STEP / 2, "samples": 2, "sensor_temperature": 36.0}


def grasp_body(
    name: str = "aluminium",
    celsius: float = 24.0,
    *,
    mode: Mode = "T",
    ambient: float | None = None,
    reservoir: Reservoir | None = None,
) -> GraspBody:
    glued = (STACK.width, STACK.thickness) if mode == "O" else None
    spec = ObjectSpec(mass=0.1, friction=0.8, elements=glued, reservoir=reservoir)
    return GraspBody(spec, thermal.material(name), celsius, mode, STACK, ambient=ambient)


class Run:
    """One object's heat, pressed by both fingertips at will, and sums of what was told."""

    def __init__(self, body: GraspBody, air: float = AIR, celsius: float = 36.0) -> None:
        self.body, self.heat = body, GraspHeat(1, **SETTINGS, air=air)
        self.heat.reset([0], [body], np.full((1, 2), celsius))
        self.drawn = self.air = self.supplied = 0.0

    def step(self, newton: float = 0.0):
        report = self.heat.advance(np.full((1, 10, 2), newton), self.body.spec.element_places[None]).info[0]
        self.drawn += STEP * report["drawn"].sum()
        self.air += STEP * report["air_loss"]
        self.supplied += STEP * report["reservoir_flow"]
        scale = abs(report["heat"]).sum() + report["exchanged"] + 1e-9
        assert abs(report["imbalance"]) < 1e-10 * scale
        assert abs(report["heat"].sum() + self.air - self.drawn - self.supplied) < 1e-9 * scale
        return report

    def steps(self, count: int, newton: float = 0.0):
        """What the last of them told."""
        return [self.step(newton) for _ in range(count)][-1]


def film(grasp_body: GraspBody, air: float = AIR) -> float:
    """W/K to the air."""
    return air * thermal.free_area(grasp_body.geometry)


@pytest.mark.parametrize("mode", ["T", "O"])
@pytest.mark.parametrize("celsius", [80.0, 2.0])
def test_before_the_touch_an_object_cools_towards_the_room_as_a_lumped_body(mode: Mode, celsius: float):
    body = grasp_body(celsius=celsius, mode=mode, ambient=20.0)
    capacity = body.heat_capacity + (2 * STACK.heat_capacity if mode == "O" else 0.0)
    run = Run(body)
    report = run.steps(1000)
    expected = 20.0 + (celsius - 20.0) * math.exp(-1000 * STEP * film(body) / capacity)
    assert report["object_temperature"] == pytest.approx(expected, abs=1e-5 if mode == "T" else 5e-3)
    assert not report["flow"].any()


def test_in_the_room_it_started_from_an_object_costs_nothing_until_it_is_touched():
    run = Run(grasp_body(ambient=24.0))
    for _ in range(3):
        run.step()
    assert not run.heat._state.any() and not run.heat._rows["begun"][0]


def test_the_room_s_temperature_is_a_shift_of_all_three():
    """Sensor, object and room 10 K warmer: the same drops to round-off, another network's demand aside."""
    plain, warmer = (
        Run(grasp_body("glass", 40.0, ambient=30.0)),
        Run(grasp_body("glass", 50.0, ambient=40.0), celsius=46.0),
    )
    for newton in [0.0] * 20 + [10.0] * 50 + [0.0] * 20:
        low, high = plain.step(newton), warmer.step(newton)
        assert np.allclose(low["heat"], high["heat"], rtol=0, atol=1e-9)
        assert high["object_temperature"] - low["object_temperature"] == pytest.approx(10.0, abs=1e-9)


@pytest.mark.parametrize("mode", ["T", "O"])
def test_a_held_reservoir_warms_an_object_as_a_lumped_body(mode: Mode):
    inside = Reservoir(np.inf, 2.0, 90.0)
    body = grasp_body(mode=mode, reservoir=inside)
    capacity = body.heat_capacity + (2 * STACK.heat_capacity if mode == "O" else 0.0)
    run, total = Run(body), film(body) + 2.0
    report = run.steps(1500)
    final = (2.0 * 90.0 + film(body) * 24.0) / total
    expected = final + (24.0 - final) * math.exp(-1500 * STEP * total / capacity)
    assert report["object_temperature"] == pytest.approx(expected, abs=1e-4 if mode == "T" else 0.05)
    assert report["reservoir_temperature"] == 90.0


def test_water_and_wall_come_to_the_temperature_of_their_mixture():
    inside = water(0.05, 20.0, 90.0)
    run = Run(grasp_body(reservoir=inside), air=0.0)
    report = run.steps(4000)
    wall = run.body.heat_capacity
    mixed = (wall * 24.0 + inside.heat_capacity * 90.0) / (wall + inside.heat_capacity)
    assert report["object_temperature"] == pytest.approx(mixed, abs=1e-3)
    assert report["reservoir_temperature"] == pytest.approx(mixed, abs=1e-3)
    gone = inside.heat_capacity * (90.0 - report["reservoir_temperature"])
    assert run.supplied == pytest.approx(gone, rel=1e-9)


def test_ice_stays_at_its_melting_point_until_its_latent_heat_is_used():
    inside = ice(0.0002, 2.0)
    run = Run(grasp_body(celsius=0.0, ambient=24.0, reservoir=inside))
    melted = None
    report = run.step(10.0)
    for k in range(3000):
        report = run.step(10.0)
        taken = -run.supplied
        if taken < inside.latent_heat * (1 - 1e-9):
            assert report["reservoir_temperature"] == pytest.approx(0.0, abs=1e-12)
        else:
            melted = k if melted is None else melted
            above = (taken - inside.latent_heat) / inside.heat_capacity
            assert report["reservoir_temperature"] == pytest.approx(above, abs=1e-6)
    assert melted is not None and 100 < melted < 2900
    assert report["reservoir_temperature"] > 1.0


def test_a_heater_of_given_power_gives_it_and_one_with_a_setpoint_holds_it():
    powered = Run(grasp_body(reservoir=Reservoir(20.0, 5.0, power=8.0)), air=0.0)
    report = powered.steps(500)
    stored = 20.0 * (report["reservoir_temperature"] - 24.0)
    assert stored + report["heat"][2] == pytest.approx(8.0 * 500 * STEP, rel=1e-9)

    held = Run(grasp_body(reservoir=Reservoir(20.0, 5.0, power=200.0, setpoint=60.0)))
    report = [held.step() for _ in range(3000)]
    celsius = np.array([each["reservoir_temperature"] for each in report])
    assert celsius.max() < 60.0 + 1e-9 and celsius[-1] == pytest.approx(60.0, abs=1e-9)


@pytest.mark.parametrize("inside", [None, water(0.2, 6.0)])
def test_hot_objects_are_felt_as_such_and_water_keeps_them_hot(inside):
    """The drop turns its sign, and a wall with water behind it gives more heat than the wall alone."""
    body = grasp_body("glass", 70.0, ambient=22.0, reservoir=inside)
    alone, heat = Run(grasp_body("glass", 70.0, ambient=22.0)), Run(body)
    bare, report = alone.step(), heat.step()
    for newton in [0.0] * 50 + [10.0] * 250:
        bare, report = alone.step(newton), heat.step(newton)
        for name in ("sensor_surface", "object_surface", "object_temperature"):
            assert np.all(report[name] < 70.05) and np.all(report[name] > 22.0)
    assert np.all(report["flow"] < -0.1)
    assert (report["flow"].sum() < 1.002 * bare["flow"].sum()) == (inside is not None)


def test_a_state_in_the_middle_goes_on_bit_for_bit():
    body = grasp_body("glass", 5.0, ambient=22.0, reservoir=ice(0.001, 1.0))
    first = Run(body)
    for newton in [0.0] * 10 + [8.0] * 30:
        first.step(newton)
    other = Run(grasp_body())
    other.heat.set_state([0], first.heat.state([0]))
    for newton in [8.0] * 10 + [0.0] * 10:
        place = body.spec.element_places[None]
        a, b = (run.heat.advance(np.full((1, 10, 2), newton), place) for run in (first, other))
        assert a.info.tobytes() == b.info.tobytes() and np.array_equal(a.drop, b.drop)


def held(batch: GraspBatch, steps: int, force: float = 20.0) -> list:
    batch.reset(range(batch.num_envs), [np.random.default_rng(i) for i in range(batch.num_envs)])
    return [batch.step(grasp_action(batch, force)) for _ in range(steps)]


def test_in_an_episode_a_hot_mug_is_felt_and_a_room_cools_it():
    mug = ObjectSpec(
        shape="cylinder", size=(0.05, 0.05, 0.06), temperature=85.0, reservoir=water(0.1, 4.0, 85.0)
    )
    batch = GraspBatch(2, objects=mug, material="ceramic", ambient_temperature=21.0, task=ENDLESS)
    steps = held(batch, 200)
    truth = steps[-1].reading.truth
    assert np.all(steps[-1].reading.voltage[:, -1] < -1e-3)
    assert np.all(truth["temperature_drop"] < -1.0)
    assert np.all((truth["object_temperature"] < 85.0) & (truth["object_temperature"] > 80.0))
    assert np.all((truth["reservoir_temperature"] < 85.0) & (truth["reservoir_temperature"] > 84.0))
    assert np.all(abs(truth["heat_imbalance"]) < 1e-9 * truth["heat_exchanged"])
    assert not any(list(violations_of(batch, step)) for step in steps[::50])


def violations_of(batch: GraspBatch, step):
    ends = [batch.plant.temperatures(row) for row in range(batch.num_envs)]  # pyright: ignore
    for row, each in enumerate(ends):
        for name in ("sensor_surface", "object_surface", "object_temperature"):
            values = np.atleast_1d(step.reading.truth[name][row])
            if values.min() < min(each) - 0.05 or values.max() > max(each) + 0.05:
                yield name, row, values


def test_objects_of_one_list_may_differ_in_temperature_and_the_room_stays():
    cold, hot = ObjectSpec(temperature=4.0), ObjectSpec(temperature=60.0)
    batch = GraspBatch(8, objects=[cold, hot], material="glass", object_temperature=22.0, task=ENDLESS)
    batch.reset(range(8), [np.random.default_rng(i) for i in range(8)])
    scene_bodies = batch.plant.bodies  # pyright: ignore[reportAttributeAccessIssue]
    assert {each.temperature for each in scene_bodies} == {4.0, 60.0}
    assert {each.ambient for each in scene_bodies} == {22.0}


def test_too_hot_a_thermostat_puts_both_heaters_off_until_the_next_reset():
    """A small, weak plate that a hot object warms: the flag rises at 70 °C by its own sensor and stays when it has
    cooled; the reset's setpoint ends it, as SET_SETPOINT does on the device."""
    plate = thermal.Thermostat(heat_capacity=0.6, loss=0.1)
    batch = GraspBatch(
        2, material="copper", objects=ObjectSpec(temperature=170.0), thermostat=plate, task=ENDLESS, air=0.0
    )
    steps = held(batch, 450)
    flags = np.array([step.reading.truth["over_temperature"] for step in steps])
    measured = np.array([step.reading.thermostat for step in steps])
    assert not flags[0].any() and flags[-1].all()
    for row in range(2):
        first = int(np.argmax(flags[:, row]))
        assert measured[first, row].max() >= thermal.TOO_HOT > measured[first - 1, row].max()
        kinds = [kind for step in steps[first : first + 1] for kind, _ in step.info(row)["events"]]
        assert kinds.count("over temperature") in (1, 2)
        assert np.all(flags[first:, row])
        assert abs(steps[-1].reading.voltage[row, -1]).min() > 1e-3  # still told
    opened = np.tile(action_of(0.085, 0.0, 0.0), (2, 1))
    step = [batch.step(opened) for _ in range(600)][-1]
    assert step.reading.thermostat.max() < 65.0 and step.reading.truth["over_temperature"].all()
    plates = batch.plant._thermostats._state  # pyright: ignore[reportAttributeAccessIssue]
    assert not plates.power.any()
    after = batch.reset([1], [np.random.default_rng(1)])[1]
    assert after.truth["over_temperature"].tolist() == [True, False]


@pytest.mark.parametrize(
    ("wrong", "says"),
    [
        ({"heat_capacity": 0.0, "conductance": 1.0}, "heat_capacity"),
        ({"heat_capacity": np.inf, "conductance": 1.0, "power": 5.0}, "infinite heat_capacity"),
        ({"heat_capacity": 1.0, "conductance": 100.0}, "0.01 s"),
        ({"heat_capacity": 1.0, "conductance": 1.0, "latent_heat": -1.0}, "latent_heat"),
        ({"heat_capacity": 10.0, "conductance": 1.0, "setpoint": 60.0}, "give its power"),
    ],
)
def test_reservoirs_that_cannot_be_are_refused(wrong, says):
    with pytest.raises(InvalidValueError, match=says):
        Reservoir(**wrong)


@pytest.mark.parametrize("celsius", [-20.0, 101.0])
def test_water_is_liquid(celsius: float) -> None:
    with pytest.raises(InvalidValueError, match="0 to 100"):
        water(0.1, 4.0, celsius)
