"""Where the fingers close on the two objects of a pair, and what that decides."""

import numpy as np
import pytest

from thermograsp.envs import GraspBatch, ObjectSpec, SortVectorEnv, action_of, sliding_action_of
from thermograsp.envs.plant.config import SimulationConfig
from thermograsp.envs.plant.layouts import SceneLayout
from thermograsp.envs.plant.pair import PairLayout, pair_config

TWO = ["copper", "glass"]
BOX = {"size": (0.03, 0.04, 0.04), "mass": 0.1, "friction": 0.8}


def area_in_a_pair(spec: ObjectSpec) -> float:
    """m2 under each fingertip that the arm closes over the second place."""
    env = SortVectorEnv(1, material=TWO, objects=spec, placement=(0.0, 0.0))
    env.reset(seed=0)
    place, info = env.batch.plant.layout.places[1], {}
    for n in range(120):
        rate = np.clip((place - env.batch.plant.mechanics.lateral[0]) / 0.1, -0.1, 0.1)
        *_, info = env.step(sliding_action_of(0.085 if n < 60 else 0.0, 10.0, 0.0, float(rate))[None])
    return float(info["contact_area"][0].max())


def area_alone(spec: ObjectSpec) -> float:
    batch = GraspBatch(1, material="glass", objects=spec, placement=(0.0, 0.0))
    batch.reset([0], [np.random.default_rng(0)])
    for _ in range(60):
        step = batch.step(action_of(0.0, 10.0, 0.0)[None])
    return float(step.info(0)["contact_area"].max())  # pyright: ignore[reportPossiblyUnboundVariable]


def test_a_spec_s_position_is_where_on_the_object_the_fingers_close() -> None:
    """As on an object alone; before, a pair was always grasped in the middle."""
    middle, edge = ObjectSpec(**BOX), ObjectSpec(**BOX, position=(0.0, 0.0195))
    assert area_in_a_pair(middle) == pytest.approx(area_alone(middle), rel=0.02)
    assert area_in_a_pair(edge) == pytest.approx(area_alone(edge), rel=0.05)
    assert area_in_a_pair(edge) < 0.8 * area_in_a_pair(middle)


def test_a_pair_lies_around_its_places_by_its_position() -> None:
    layout = PairLayout(
        pair_config(objects=ObjectSpec(**BOX, position=(0.004, -0.007)), placement=(0.0, 0.0))
    )
    found = [body.spec.position for body in layout.draw(np.random.default_rng(0), {}).scene]
    np.testing.assert_allclose(found, [(0.004, place - 0.007) for place in layout.places], atol=1e-12)


def test_what_crushes_a_mesh_of_a_pair_is_what_crushes_it_alone() -> None:
    """Where the gripper is over each, not over the table between them, where pads miss it: 12 N in place of 1.2 N."""
    keywords = {"objects": "egg", "material": ["butter", "glass"], "placement": (0.0, 0.0)}
    keywords["object_temperature"] = 20.0
    pair, alone = PairLayout(pair_config(**keywords)), SceneLayout(SimulationConfig(**keywords))
    episode = pair.draw(np.random.default_rng(0), {})
    labels = pair.labels(episode.scene, episode.centred, ("", ""))
    for material, force in zip(labels.material, labels.crushing_force, strict=True):
        single = alone.draw(np.random.default_rng(0), {"material": material})
        assert force == pytest.approx(alone.labels(single.scene, single.centred, ("",)).crushing_force)
