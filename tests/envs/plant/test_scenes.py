"""Scenes of several objects: each touched one has its own heat, and the others cost nothing."""

from __future__ import annotations

from typing import Any

import gymnasium
import numpy as np
import pytest

from thermograsp.agents.checks import violations
from thermograsp.envs import GraspBatch, GraspTask, ObjectSpec, SimulationConfig
from thermograsp.errors import InvalidValueError
from thermograsp.thermal import Material

from ..scripted import grasp_action

ENDLESS = GraspTask(hold_seconds=1e3, seconds=1e3)
LEFT = ObjectSpec(size=(0.02, 0.04, 0.04), position=(-0.011, 0.0), material="aluminium", temperature=40.0)
RIGHT = ObjectSpec(size=(0.02, 0.04, 0.04), position=(0.011, 0.0), material="cork", temperature=10.0)
ASIDE = ObjectSpec(size=(0.03, 0.03, 0.03), position=(0.0, 0.06), material="glass")


def batch(count: int, *scene: ObjectSpec, **config: Any) -> GraspBatch:
    made = GraspBatch(count, scene=scene, task=ENDLESS, placement=(0.0, 0.0), **config)
    made.reset(range(count), [np.random.default_rng(i) for i in range(count)])
    return made


def test_each_finger_feels_the_object_that_it_touches():
    """Side by side between the fingers: warm aluminium on the left, cold cork on the right."""
    made = batch(1, LEFT, RIGHT, ASIDE, signal="ideal", air=0.0)
    steps = [made.step(grasp_action(made)) for _ in range(200)]
    info, truth = steps[-1].info(0), steps[-1].reading.truth
    assert info["touched"].tolist() == [0, 1]
    assert info["temperature_drop"][0] < -0.5 < 0.5 < info["temperature_drop"][1]
    assert steps[-1].reading.voltage[0, -1, 0] < 0 < steps[-1].reading.voltage[0, -1, 1]
    left, right, aside = info["object_temperatures"]
    assert left < 40.0 and right > 10.0 and aside == 24.0
    assert np.all(abs(truth["heat_imbalance"]) < 1e-9 * truth["heat_exchanged"])
    assert info["material"] == "aluminium"


def test_what_is_not_touched_has_no_network():
    made = batch(2, ObjectSpec(), ASIDE, material="glass")
    heat: Any = made.plant.heat  # pyright: ignore[reportAttributeAccessIssue]
    for _ in range(60):
        made.step(grasp_action(made))
    assert heat._rows._waiting == {1, 3} and len(heat._rows._networks.systems) == 1
    assert heat.rung(0) == (heat.rung(0)[0], "")


def test_the_first_object_among_others_is_felt_as_if_it_were_alone():
    """Up to the fingertips' states, of which scenes have as many as carrying them over asks for."""
    among, alone = (
        batch(1, ObjectSpec(), ASIDE, material="glass", skin=None),
        GraspBatch(1, objects=ObjectSpec(), material="glass", task=ENDLESS, placement=(0.0, 0.0)),
    )
    alone.reset([0], [np.random.default_rng(0)])
    one = other = among.step(grasp_action(among))
    alone.step(grasp_action(alone))
    for _ in range(150):
        one, other = among.step(grasp_action(among)), alone.step(grasp_action(alone))
    drops = [step.reading.truth["temperature_drop"] for step in (one, other)]
    assert np.abs(drops[0] - drops[1]).max() < 0.01


def test_vector_and_single_scenes_agree_bit_for_bit_and_states_go_on():
    many = batch(3, LEFT, RIGHT, ambient_temperature=22.0)
    singles = [batch(1, LEFT, RIGHT, ambient_temperature=22.0) for _ in range(3)]
    for row, single in enumerate(singles):
        single.reset([0], [np.random.default_rng(row)])
    kept = together = None
    for k in range(90):
        if k == 60:
            kept = singles[1].state()
        together = many.step(grasp_action(many))
        for row, single in enumerate(singles):
            alone = single.step(grasp_action(single))
            for key, value in alone.observation.items():
                assert np.array_equal(value[0], together.observation[key][row])
    assert kept is not None and together is not None
    again = batch(1, LEFT, RIGHT, ambient_temperature=22.0)
    again.set_state(kept)
    step = [again.step(grasp_action(again)) for _ in range(30)][-1]
    for name in ("temperature_drop", "object_temperatures", "heat_imbalance"):
        assert np.array_equal(step.reading.truth[name][0], together.reading.truth[name][1])


def test_scenes_keep_what_is_checked_of_every_step():
    env = gymnasium.make_vec(
        "thermograsp:thermograsp/Grasp-v0",
        num_envs=2,
        vectorization_mode="vector_entry_point",
        scene=[LEFT, RIGHT],
        placement=(0.0, 0.0),
    )
    info = env.reset(seed=0)[1]
    unwrapped: Any = env.unwrapped
    for k in range(120):
        observation, reward, _, _, info = env.step(grasp_action(unwrapped.batch).astype(np.float32))
        assert not violations(env, observation, reward, info, np.arange(2), 0, k, check=True)
    assert info["touched"].shape == (2, 2) and info["object_temperatures"].shape == (2, 2)
    env.close()


def test_objects_that_meant_the_same_name_get_numbers_and_wrong_scenes_are_refused():
    made = batch(1, LEFT, RIGHT)
    mechanics: Any = made.plant.mechanics  # pyright: ignore[reportAttributeAccessIssue]
    assert mechanics.names == ("object", "object_1")
    wrong: dict[str, Any]
    for wrong in ({"scene": []}, {"scene": [LEFT], "objects": RIGHT}, {"scene": [LEFT], "mode": "O"}):
        with pytest.raises(InvalidValueError, match="scene"):
            GraspBatch(1, **wrong)


@pytest.mark.parametrize("given", [5, [5], {"a": 1}, [None], ("brick", 1.0)])
@pytest.mark.parametrize("name", ["objects", "scene"])
def test_what_is_no_list_of_objects_is_refused_by_name(name: str, given: Any) -> None:
    with pytest.raises(InvalidValueError, match=f"{name} must be ObjectSpecs or names"):
        SimulationConfig(**{name: given})


def test_objects_inside_each_other_are_refused():
    with pytest.raises(InvalidValueError, match="'object' and 'object_1' of the scene lie 10.0 mm deep"):
        batch(1, ObjectSpec(), ObjectSpec(position=(0.0, 0.03)), material="glass")


def test_a_material_of_which_touches_are_unknown_is_refused_before_an_episode_draws_it():
    slate = Material("slate", conductivity=2.0, density=2780.0, specific_heat=760.0)
    both: list[dict[str, Any]] = [{"material": ["glass", slate]}, {"objects": ObjectSpec(material=slate)}]
    for given in both:
        with pytest.raises(InvalidValueError, match="slate has no roughness"):
            GraspBatch(1, task=ENDLESS, **given)
