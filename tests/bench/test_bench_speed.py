"""`thermograsp bench speed`: every layer runs the same physics, the document is complete. No timing decides."""

import os
import shutil
from pathlib import Path

import numpy as np
import pytest

from thermograsp.bench.speed import endurance, processes
from thermograsp.bench.speed import measure as speed
from thermograsp.bench.speed.bare import BareBatch, inputs_of
from thermograsp.envs import GraspBatch, action_of
from thermograsp.envs.limits import SUBSTEPS
from thermograsp.errors import ThermograspError


def test_bare_mujoco_follows_a_grasp_to_the_last_bit() -> None:
    batch = GraspBatch(3)
    for row, name in enumerate(("wood", "glass", "iron")):
        batch.reset([row], [np.random.default_rng(row)], {"material": name})
    mechanics = batch.plant.mechanics  # pyright: ignore[reportAttributeAccessIssue]
    bare = BareBatch(mechanics, 1, SUBSTEPS)
    bare.copy(mechanics, mechanics.state())
    actions = np.stack([action_of(0.0, force, 0.02) for force in (3.0, 10.0, 30.0)])
    pressed = False
    for _ in range(70):
        step = batch.step(actions)
        bare.step(inputs_of(mechanics.model, mechanics.state()))
        pressed |= bool((step.observation["force"][:, :, 0] > 1).all())
        np.testing.assert_array_equal(bare.batch.state, mechanics.state().rows)
    assert pressed
    masses = bare.batch.expanded("body_mass")
    assert masses is not None and len(np.unique(masses[:, -1])) == 3


def test_every_layer_ends_each_block_with_the_same_bits(written: tuple[Path, dict]) -> None:
    assert all(each["same"] for each in written[1]["speed"]["speeds"])
    assert all(each["same"] for each in written[1]["speed"]["modes"])


def test_an_episode_that_ends_between_blocks_is_started_anew() -> None:
    found = speed.measure(2, 6, 100, 0, lambda: None)  # the fourth ends with an episode of 500 control steps
    assert found.blocks == 5 and found.same


def test_document_is_complete_and_adds_up(written: tuple[Path, dict]) -> None:
    folder, document = written[0], written[1]["speed"]
    assert [each["num_envs"] for each in document["speeds"]] == [1, 4]
    for each in document["speeds"]:
        assert list(each["seconds"]) == document["layers"]
        assert list(each["parts"]) == document["parts"]
        assert sum(each["parts"].values()) == pytest.approx(1)
        low, high = each["quartiles"]
        assert 0 < low <= each["ratio"] <= high
        assert 0 < each["ratio_with_resets"] < each["ratio"]
        assert 0 <= each["touching"] <= 1 and each["blocks"] == 2 and each["reset"] > 0
    assert {each["mode"] for each in document["modes"]} >= {"native", "SyncVectorEnv", "AsyncVectorEnv"}
    assert document["modes"][0]["ratio"] == 1
    for suffix in (".png", ".svg"):
        assert (folder / f"speed{suffix}").stat().st_size > 10_000
    assert "seed 3" in (folder / "speed.svg").read_text(encoding="utf-8")


def test_scenes_are_those_that_can_be_had_and_their_physics_is_the_same(written: tuple[Path, dict]) -> None:
    found = written[1]["speed"]["scenes"]
    names = {each["scene"] for each in found}
    assert names >= {"three fingers, a loop of mj_step", "three fingers, 64 worlds"}
    built = shutil.which(os.environ.get("CC", "cc")) is not None
    for scene in ("Grasp-v0's scene", "three fingers, 64 worlds"):
        assert (f"{scene}, inside mj_step" in names) == built
    for each in found:
        assert each["same"] and each["blocks"] == 2 and each["bare"] > 0 and each["touch"] > 0
        low, high = each["quartiles"]
        assert 0 < low <= each["ratio"] <= high


def test_boxes_of_any_size_and_place_go_through_their_episodes(written: tuple[Path, dict]) -> None:
    drawn = written[1]["speed"]["drawn"]
    assert drawn["episodes"] == 40 and drawn["num_envs"] == 4
    low, high = drawn["quartiles"]
    assert 0 < low <= drawn["ratio"] <= high
    low, high = drawn["heat_quartiles"]
    assert 0 < low <= drawn["heat_ratio"] <= high
    assert drawn["plain"] > 0 and drawn["drawn"] > 0 and min(drawn["longest"]) > 0
    assert len(drawn["memory"]) in (0, 10)


def test_memory_and_imports_hold_what_is_promised(written: tuple[Path, dict]) -> None:
    document = written[1]["speed"]
    assert 0 < document["memory"]["per_env"] < 100_000
    assert document["start_up"]["heavy"] == []
    parts = ("make", "reset", "step")
    assert document["start_up"]["to_first_step"] == pytest.approx(
        sum(document["start_up"][name] for name in parts)
    )


def test_an_endless_episode_is_split_into_equal_parts() -> None:
    parts: list[int] = []
    found = endurance.endure(1_000, 0, lambda: parts.append(1))
    assert found.steps == 1_000 and found.touches == 40  # 20 s, closed once a second, two fingertips
    assert len(found.relative) == len(parts) == 20 and min(found.relative) > 0
    assert found.growth > 0


def test_a_process_that_fails_is_reported() -> None:
    with pytest.raises(ThermograspError, match="status 1: ZeroDivisionError"):
        processes._fresh("1 / 0")
