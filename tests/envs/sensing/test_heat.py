"""Contact to heat: the grasp's temperature drops against thermal.press, order of materials, books of heat."""

from __future__ import annotations

from functools import partial
from typing import Any

import numpy as np
import pytest

from thermograsp import thermal
from thermograsp.envs import (
    GraspBatch,
    GraspTask,
    ObjectSpec,
    Size,
    SortTask,
    action_of,
)
from thermograsp.envs.footprint.grasp_body import PAD
from thermograsp.thermal import SEED_MATERIALS

from ..scripted import SAMPLE, grasp_action, sampled_conductance, watched_contacts

ENDLESS = GraspTask(hold_seconds=1e3, seconds=1e3)


def grasped(batch: GraspBatch, steps: int) -> list:
    rngs = [np.random.default_rng(i) for i in range(batch.num_envs)]
    batch.reset(range(batch.num_envs), rngs)
    readings = []
    for _ in range(steps):
        batch.step(grasp_action(batch))
        readings.append(batch.reading)
    return readings


def sampled_conductances(batch: GraspBatch, steps: int) -> tuple[list, np.ndarray]:
    """The readings of a grasp, and what each heat sample felt: sampled_conductance."""
    plant: Any = batch.plant
    seen = watched_contacts(plant.heat)
    readings = grasped(batch, steps)
    return readings, sampled_conductance(seen, plant.heat._bodies[0])


@pytest.mark.parametrize("mode", ["T", "O"])
@pytest.mark.parametrize("name", ["wood", "aluminium"])
def test_press_with_the_recorded_conductance_gives_the_same_drop(mode, name):
    """One fingertip, same rung and steps, no air: the coupling of the environment adds nothing of its own."""
    batch = GraspBatch(1, task=ENDLESS, material=name, mode=mode, fingertips=1, air=0.0)
    readings, recorded = sampled_conductances(batch, 200)
    area = np.array([reading.truth["contact_area"][0, 0] for reading in readings])
    drop = np.array([reading.truth["temperature_drop"][0, 0] for reading in readings])
    assert np.all((area == 0) | np.isclose(area, 81e-6, rtol=1e-12))
    first = 2 * int(np.argmax(recorded[:, 0] > 0) // 2)  # the beginning of a step
    held = recorded[first:, 0]
    body = batch.plant.heat._bodies[0]  # pyright: ignore[reportAttributeAccessIssue]
    press = thermal.press(
        name,
        mode=mode,
        conductance=lambda t: float(held[min(int(t / SAMPLE), len(held) - 1)]),
        object_size=body.plate,
        seconds=len(held) * SAMPLE,
        dt=SAMPLE,
        rung=readings[-1].truth["rung"][0],
    )
    assert drop.max() > 1.0
    assert np.max(np.abs(press.temperature_drop[2::2] - drop[first // 2 :])) < 1e-6


def test_two_fingertips_on_a_thick_poor_conductor_feel_what_one_would():
    """Through 40 mm of wood nothing arrives within seconds, so each fingertip is a press of its own."""
    batch = GraspBatch(1, task=ENDLESS, material="wood", air=0.0)
    readings, recorded = sampled_conductances(batch, 200)
    drop = np.array([reading.truth["temperature_drop"][0] for reading in readings])
    body = batch.plant.heat._bodies[0]  # pyright: ignore[reportAttributeAccessIssue]
    first = 2 * int(np.argmax(recorded.max(axis=1) > 0) // 2)
    for side in (0, 1):
        held = recorded[first:, side]
        press = thermal.press(
            "wood",
            conductance=lambda t, held=held: float(held[min(int(t / SAMPLE), len(held) - 1)]),
            object_size=body.plate,
            seconds=len(held) * SAMPLE,
            dt=SAMPLE,
            rung=readings[-1].truth["rung"][0],
        )
        assert np.max(np.abs(press.temperature_drop[2::2] - drop[first // 2 :, side])) < 1e-3


def test_both_fingers_warm_a_small_conductor_together():
    spec = ObjectSpec(size=(0.02, 0.02, 0.03))
    one, two = (
        grasped(GraspBatch(1, task=ENDLESS, material="aluminium", objects=spec, fingertips=f, air=0.0), 300)
        for f in (1, 2)
    )
    assert two[-1].truth["object_temperature"][0] > one[-1].truth["object_temperature"][0] + 0.2
    assert two[-1].truth["temperature_drop"][0, 0] < one[-1].truth["temperature_drop"][0, 0] - 0.1


def test_materials_are_in_order_when_grasped():
    """Metals over stone over plastics over cotton at 2 s after the touch."""
    batch = GraspBatch(10, task=ENDLESS, material=list(SEED_MATERIALS))
    rngs = [np.random.default_rng(i) for i in range(10)]
    for row, name in enumerate(SEED_MATERIALS):
        batch.reset([row], [rngs[row]], {"material": name})
    touched = None
    for k in range(160):
        batch.step(grasp_action(batch))
        assert batch.reading is not None
        if touched is None and np.all(batch.reading.truth["contact_area"] > 0):
            touched = k
        if touched is not None and k == touched + 100:
            break
    assert batch.reading is not None
    means = batch.reading.truth["temperature_drop"].mean(axis=1)
    drop = {str(name): float(mean) for name, mean in zip(SEED_MATERIALS, means, strict=True)}
    groups = [
        ["stainless_steel", "iron", "aluminium"],
        ["glass", "ceramic", "marble"],
        ["plastic", "rubber"],
        ["cotton"],
    ]
    for upper, lower in zip(groups, groups[1:], strict=False):
        assert min(drop[name] for name in upper) > max(drop[name] for name in lower)


@pytest.mark.parametrize("mode", ["T", "O"])
def test_books_of_heat_balance_and_temperatures_stay_in_range(mode):
    batch = GraspBatch(3, task=ENDLESS, material=["glass", "aluminium", "cotton"], mode=mode)
    for reading in grasped(batch, 250):
        truth = reading.truth
        assert np.all(np.abs(truth["heat_imbalance"]) <= 1e-6 * truth["heat_exchanged"] + 1e-15)
        for name in ("sensor_surface", "object_surface", "object_temperature"):
            assert np.all(truth[name] > 24 - 0.05) and np.all(truth[name] < 36 + 0.05)
    assert np.all(batch.reading.truth["heat_exchanged"] > 0.1)  # pyright: ignore[reportOptionalMemberAccess]


def test_a_single_row_does_not_depend_on_the_others():
    names = ["glass", "aluminium", "cotton", "wood"]
    many = GraspBatch(4, task=ENDLESS, material=names, threads=2)
    rngs = [np.random.default_rng(i) for i in range(4)]
    for row in range(4):
        many.reset([row], [rngs[row]], {"material": names[row]})
    singles = []
    for row in range(4):
        single = GraspBatch(1, task=ENDLESS, material=names)
        single.reset([0], [np.random.default_rng(row)], {"material": names[row]})
        singles.append(single)
    for _ in range(80):
        all_of_them = many.step(grasp_action(many))
        for row, single in enumerate(singles):
            alone = single.step(grasp_action(single))
            for key, value in alone.observation.items():
                assert np.array_equal(value[0], all_of_them.observation[key][row])
            assert alone.reward[0] == all_of_them.reward[row]


def test_voltage_is_the_drop_through_the_chain():
    batch = GraspBatch(1, task=ENDLESS, material="glass", signal="ideal")
    for reading in grasped(batch, 120):
        assert np.allclose(reading.voltage[0], 1e-3 * reading.truth["temperature_drops"][0], atol=1e-15)


def test_touch_off_the_element_is_not_felt_in_o_mode():
    batch = GraspBatch(1, task=ENDLESS, material="glass", mode="O", placement=(0.0, 0.0))
    batch.reset([0], [np.random.default_rng(0)])
    heat = batch.plant.heat  # pyright: ignore[reportAttributeAccessIssue]
    heat._rows["anchor"][0] += np.array([0.0, 0.0, 0.006])
    kinds = []
    for _ in range(100):
        step = batch.step(grasp_action(batch))
        kinds += [kind for kind, _ in step.infos[0]["events"]]
    assert kinds == ["touch off the element"] * 2
    assert not batch.reading.truth["temperature_drop"].any()  # pyright: ignore[reportOptionalMemberAccess]


@pytest.mark.parametrize("mode", ["T", "O"])
def test_a_thermostat_of_finite_power_dips_and_recovers(mode):
    ideal, real = (
        GraspBatch(
            1, task=ENDLESS, material="aluminium", mode=mode, signal="ideal", air=0.0, thermostat=thermostat
        )
        for thermostat in (None, thermal.Thermostat())
    )
    a, b = grasped(ideal, 500), grasped(real, 500)
    celsius = np.array([reading.thermostat[0] for reading in b])
    assert celsius[0] == pytest.approx([36.0, 36.0])
    assert 0.05 < 36.0 - celsius.min() < 2.0
    assert abs(celsius[-1] - 36.0).max() < 0.1
    drops = [np.array([reading.truth["temperature_drop"][0] for reading in run]) for run in (a, b)]
    assert np.abs(drops[0] - drops[1]).max() > 0.02  # it is felt
    assert np.abs(drops[0][-1] - drops[1][-1]).max() < 0.1  # and passes


def test_a_large_thermostat_is_the_ideal_one():
    ideal, large = (
        GraspBatch(1, task=ENDLESS, material="glass", signal="ideal", thermostat=thermostat)
        for thermostat in (None, thermal.Thermostat(heat_capacity=1e9))
    )
    for a, b in zip(grasped(ideal, 120), grasped(large, 120), strict=True):
        assert np.allclose(a.voltage, b.voltage, atol=1e-9)


def test_heat_drawn_from_thermostats_is_what_elements_and_object_gain():
    """With thermostats that drift by kelvins, drawn heat still equals the gain of elements and object."""
    weak = thermal.Thermostat(heat_capacity=0.5, power_limit=0.5)
    batch = GraspBatch(1, task=ENDLESS, material="aluminium", thermostat=weak, air=0.0)
    batch.reset([0], [np.random.default_rng(0)])
    drawn = 0.0
    for _ in range(200):
        batch.step(grasp_action(batch))
        assert batch.reading is not None
        drawn += batch.reading.truth["heat_drawn"].sum() * batch.dt
    assert batch.reading is not None
    assert batch.reading.thermostat.min() < 35.0
    assert batch.reading.truth["heat"].sum() == pytest.approx(drawn, rel=1e-9)


def test_a_grasp_elsewhere_is_a_new_patch_and_keeps_the_heat():
    batch = GraspBatch(1, task=ENDLESS, material="glass", air=0.0, placement=(0.0, 0.0))
    batch.reset([0], [np.random.default_rng(0)])
    plant = batch.plant
    kinds = []

    def run(steps, opening):
        for _ in range(steps):
            step = batch.step(action_of(opening, 10.0, 0.0)[None])
            kinds.extend(kind for kind, _ in step.infos[0]["events"])

    run(120, 0.0)
    run(60, 0.085)
    assert batch.reading is not None
    before = batch.reading.truth["heat"][0, 2]
    along_y = plant.mechanics.model.joint("object_free").qposadr[0] + 1  # pyright: ignore[reportAttributeAccessIssue]
    plant.mechanics._qpos[0, along_y] += 0.009  # pyright: ignore[reportAttributeAccessIssue]
    run(1, 0.085)
    assert batch.reading.truth["heat"][0, 2] == pytest.approx(before, rel=1e-9)
    run(60, 0.0)
    assert kinds.count("touch") == 4 and kinds.count("release") == 2
    assert kinds.count("new patch") == 2
    truth = batch.reading.truth
    assert abs(truth["heat_imbalance"][0]) <= 1e-6 * truth["heat_exchanged"][0]


@pytest.mark.parametrize("lift", [0.0, 0.016, 0.019])
def test_a_pad_that_hangs_over_an_edge_feels_by_what_lies_under_it(lift):
    """The arm rises before it closes: of a box of 30 mm the face's upper edge is 15 mm above its middle."""
    batch = GraspBatch(1, task=ENDLESS, material="aluminium", objects=ObjectSpec(size=(0.04, 0.04, 0.03)))
    batch.reset([0], [np.random.default_rng(0)])
    steps = int(lift / (0.05 * batch.dt))
    for action in [action_of(0.085, 10.0, 0.05)] * steps + [action_of(0.0, 10.0, 0.0)] * 60:
        batch.step(action[None])
    mechanics = batch.plant.mechanics  # pyright: ignore[reportAttributeAccessIssue]
    ones = np.ones(1)
    motion = mechanics.advance(0 * ones, 10 * ones, 0 * ones)
    above = motion.place[0, :, 2]
    step = batch.plant.heat.advance(motion.normal, motion.place)  # pyright: ignore[reportAttributeAccessIssue]
    expected = thermal.flat_contact(PAD, 10.0, (0.04, 0.03), (motion.place[0, :, 1], above)).face
    assert step.info["area"][0] == pytest.approx(expected, rel=1e-12)
    assert np.all(expected < 80e-6) == (lift > 0) and np.all(expected > 0)


def test_a_box_that_lies_across_is_held_by_its_other_sides():
    """A sheet of 30 x 10 mm, 6 mm thick, turned by 90 degrees is one of 6 x 10 mm, 30 mm thick."""
    conductances = []
    for spec in (ObjectSpec(size=(0.03, 0.006, 0.01)), ObjectSpec(size=(0.006, 0.03, 0.01), yaw=np.pi / 2)):
        batch = GraspBatch(1, task=ENDLESS, material="glass", objects=spec, placement=(0.0, 0.0))
        truth = grasped(batch, 100)[-1].truth
        conductances.append((truth["contact_area"][0], truth["temperature_drop"][0]))
    assert conductances[0][0] == pytest.approx(conductances[1][0], rel=1e-3)
    assert conductances[0][1] == pytest.approx(conductances[1][1], rel=1e-3)


@pytest.mark.parametrize("name", ["Grasp", pytest.param("Sort", marks=pytest.mark.slow)])
def test_networks_stay_few_however_many_are_drawn(monkeypatch, name):
    """Forgetting those that nothing uses changes no bit, of an episode that goes on beside either. The objects are so
    narrow that their networks are searched where heat does not know where it enters."""
    drops, narrow = [], ObjectSpec(size=(0.04, 0.012, 0.04))
    for most in (3, 1000):
        monkeypatch.setattr("thermograsp.envs.sensing.networks.MOST_NETWORKS", most)
        kind = GraspBatch if name == "Grasp" else partial(GraspBatch, plant="simulated-pair", task=SortTask())
        batch = kind(
            2, objects=narrow, anywhere=False, randomize=[Size(factors=(0.8, 1.0, 1.1))], signal="ideal"
        )
        rngs = [np.random.default_rng(row) for row in range(2)]
        batch.reset([0, 1], rngs)
        reported = []
        for _ in range(8):
            batch.reset([0], rngs[:1])
            for _ in range(25):
                action = np.tile([-1.0, 0.0, 0.0, 0.0][: batch.action_space.shape[0]], (2, 1))
                reported.append(batch.step(action).reading.truth["temperature_drops"])
        heat: Any = batch.plant.heat  # pyright: ignore[reportAttributeAccessIssue]
        networks = (heat if name == "Grasp" else heat._rows)._networks
        assert len(networks._numbers) == len(networks.systems) == len(networks.rungs)
        assert (len(networks.systems) <= 3 + 4) == (most == 3)
        drops.append(np.array(reported))
    assert np.array_equal(*drops) and (name == "Sort" or drops[0].any())
