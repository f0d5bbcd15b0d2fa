"""What a row and a file of a dataset hold, and that they depend on their seeds alone."""

import dataclasses
import json
from pathlib import Path
from typing import Any

import gymnasium
import numpy as np
import pytest

from thermograsp import dataset
from thermograsp.agents.policies import policy
from thermograsp.dataset import episodes as rolling
from thermograsp.dataset.episodes import roll
from thermograsp.dataset.schema import TRUTH, shape_of
from thermograsp.dataset.shards import read_plan
from thermograsp.thermal import material, materials

from .plan import MATERIALS, PLAN

pytest.importorskip("pyarrow")
pq = pytest.importorskip("pyarrow.parquet")


def single(seed: int) -> dict[str, Any]:
    """The episode by the single environment, in the plainest loop."""
    env: Any = gymnasium.make(PLAN.env_id, mode=PLAN.mode, material=list(MATERIALS))
    spaces = gymnasium.make_vec(
        PLAN.env_id, num_envs=1, vectorization_mode="vector_entry_point", **PLAN.env_config
    )
    acting = policy(spaces, "scripted")
    acting.restart([0], [seed])
    observation, info = env.reset(seed=seed)
    observed, infos, actions, rewards, over = [observation], [info], [], [], False
    while not over:
        action = acting.action({name: value[None] for name, value in observation.items()})[0]
        observation, reward, terminated, truncated, info = env.step(action)
        observed.append(observation)
        infos.append(info)
        actions.append(action)
        rewards.append(reward)
        over = terminated or truncated
    lists = {name: np.stack([one[name] for one in observed]) for name in observation}
    lists |= {name: np.stack([one[name] for one in infos]).astype(np.float32) for name in TRUTH}
    lists |= {"action": np.stack(actions), "reward": np.array(rewards)}
    return {"material": infos[0]["material"], "rung": info["rung"], "success": info["success"], **lists}


def test_a_row_is_the_single_environments_episode_bit_for_bit(folder: Path) -> None:
    rows = dataset.load(folder)
    assert rows["seed"].tolist() == list(range(8, 15))
    assert set(rows["ending"]) == {"success", "crushed", "truncated"}  # episodes of 25, 188 and 500 steps
    for seed in (int(rows["seed"][list(rows["ending"]).index(ending)]) for ending in ("success", "crushed")):
        wanted, k = single(seed), seed - 8
        for name, value in wanted.items():
            assert np.array_equal(rows[name][k], value), name
            assert np.asarray(rows[name][k]).dtype.kind == np.asarray(value).dtype.kind
        assert rows["steps"][k] == len(wanted["action"])
        assert rows["return"][k] == pytest.approx(sum(wanted["reward"]), rel=1e-12)


@pytest.mark.slow
def test_an_episode_does_not_depend_on_its_neighbours() -> None:
    """The rows of ended episodes start others while their neighbours go on: 7 of 3 lengths, 1, 2 and 7 at once."""
    one, two, many = (roll(PLAN, range(8, 15), at_once)[1] for at_once in (1, 2, 7))
    for k in range(7):
        assert one[k].keys() == two[k].keys() == many[k].keys()
        for name in one[k]:
            assert np.array_equal(one[k][name], two[k][name]) and np.array_equal(one[k][name], many[k][name])


def test_random_actions_depend_on_the_seed_alone(monkeypatch: pytest.MonkeyPatch) -> None:
    plan = dataclasses.replace(PLAN, policy="random")
    both = roll(plan, range(8, 10), 2)[1]
    (alone,) = roll(plan, [9], 1)[1]
    assert np.array_equal(both[1]["action"], alone["action"])
    assert not np.array_equal(both[0]["action"][:20], both[1]["action"][:20])


def test_long_episodes_outgrow_the_tape(monkeypatch: pytest.MonkeyPatch) -> None:
    (wide,) = roll(PLAN, [11], 1)[1]
    monkeypatch.setattr(rolling, "_CAPACITY", 4)
    (grown,) = roll(PLAN, [11], 1)[1]
    assert all(np.array_equal(wide[name], grown[name]) for name in wide)


def test_units_and_the_plan_are_in_every_file(folder: Path) -> None:
    manifest = json.loads((folder / "manifest.json").read_text(encoding="utf-8"))
    for shard in PLAN.shards:
        schema = pq.read_schema(folder / shard.file)
        units = {field.name: field.metadata[b"unit"].decode() for field in schema}
        assert units["temperature_drop"] == "K" and units["voltage"] == "V" and units["force"] == "N"
        assert units["conductance"] == "W/(m2 K)" and units["contact_area"] == "m2"
        assert shape_of(schema.field("voltage")) == (2, 16) and shape_of(schema.field("reward")) == ()
        held = json.loads(schema.metadata[b"thermograsp"])
        assert held == {name: value for name, value in manifest.items() if name != "episodes"}
    assert [one["name"] for one in manifest["materials"]] == ["glass", "water_gel", "gold"]
    assert manifest["materials"][0]["conductivity"] == materials()["glass"].conductivity
    assert manifest["versions"]["thermograsp"] and manifest["versions"]["mujoco"]


def test_a_manifest_read_is_the_plan(folder: Path) -> None:
    assert read_plan(folder) == PLAN
    glass = dataclasses.replace(material("glass"), name="own", conductivity=2.0)
    plan = dataset.Plan(materials=(glass,), mode="O")
    assert dataset.Plan.from_document(json.loads(json.dumps(plan.document()))) == plan


@pytest.mark.parametrize(("episodes", "size"), [(1, 1), (7, 3), (9, 3), (3, 100)])
def test_shards_share_the_seeds(episodes: int, size: int) -> None:
    shards = dataset.Plan(episodes=episodes, seed=5, shard_size=size).shards
    assert [seed for shard in shards for seed in shard.seeds] == list(range(5, 5 + episodes))
    assert max(shard.count for shard in shards) <= size
    assert [shard.file for shard in shards] == sorted(shard.file for shard in shards)
