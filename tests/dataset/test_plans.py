"""Plans of datasets, those that cannot be, and folders that hold another's."""

import dataclasses
from pathlib import Path
from typing import Any

import pytest

from thermograsp import dataset
from thermograsp.dataset.shards import read_plan
from thermograsp.envs import ObjectSpec, Roughness
from thermograsp.errors import InvalidValueError, SimulationError, ThermograspError, UnknownNameError
from thermograsp.thermal import material

from .plan import MATERIALS, PLAN, contents

pytest.importorskip("pyarrow")


@pytest.mark.parametrize("keywords", [{"tolerence": 0.1}, {"tolerance": -1.0}, {"skin": "cotton wool"}])
@pytest.mark.parametrize("known", [False, True])
def test_what_no_environment_takes_leaves_no_dataset_behind(
    tmp_path: Path, keywords: dict[str, Any], known: bool
) -> None:
    """So that the same folder serves the command without the mistake."""
    folder = tmp_path / "d"
    if known:
        folder.mkdir()
        (folder / "mine.txt").write_text("kept")
    with pytest.raises((InvalidValueError, UnknownNameError)):
        dataset.make(dataclasses.replace(PLAN, keywords=keywords), folder)
    assert [path.name for path in tmp_path.rglob("*")] == (["d", "mine.txt"] if known else [])


@pytest.mark.parametrize(
    ("changed", "message"),
    [
        ({"episodes": 5}, "its episodes is 7, not 5"),
        ({"episodes": 9, "mode": "O"}, "its mode is T, not O"),  # and it does not grow
        ({"keywords": {"tolerance": 0.1}}, "its keyword tolerance is left out, not 0.1"),
        ({"sources": "f" * 64}, "its hash of thermograsp's sources is"),
        ({"seed": 4, "policy": "random"}, "its seed is 8, not 4; its policy is scripted, not random"),
        (
            {"materials": (material("wood"),)},
            "its materials is glass, water_gel, gold, not wood",
        ),
        (
            {"materials": (dataclasses.replace(MATERIALS[0], density=1.0), *MATERIALS[1:])},
            f"its density of glass is {MATERIALS[0].density}, not 1.0",
        ),
        ({"versions": {**PLAN.versions, "mujoco": "1.0"}}, "its version of mujoco is"),
    ],
)
def test_another_plan_is_refused_by_name(folder: Path, changed: dict[str, Any], message: str) -> None:
    before = contents(folder)
    with pytest.raises(InvalidValueError, match="holds another dataset") as raised:
        dataset.make(dataclasses.replace(PLAN, **changed), folder)
    assert message in str(raised.value)
    assert contents(folder) == before


def test_other_versions_make_no_rows() -> None:
    from thermograsp.dataset.shards import shard_bytes

    plan = dataclasses.replace(PLAN, versions={**PLAN.versions, "numpy": "0.1"})
    with pytest.raises(SimulationError, match="numpy"):
        shard_bytes(plan, plan.shards[0])
    plan = dataclasses.replace(PLAN, sources="0" * 64)
    with pytest.raises(SimulationError, match="hash of thermograsp's sources"):
        shard_bytes(plan, plan.shards[0])


def test_folders_that_are_none(tmp_path: Path) -> None:
    with pytest.raises(InvalidValueError, match=r"no manifest\.json"):
        dataset.load(tmp_path)
    (tmp_path / "mine.parquet").write_bytes(b"")
    with pytest.raises(InvalidValueError, match="without other Parquet files"):
        dataset.make(PLAN, tmp_path)
    (tmp_path / "manifest.json").write_text('{"format": 1, "episodes": 3}', encoding="utf-8")
    with pytest.raises(InvalidValueError, match="missing or unknown"):
        dataset.load(tmp_path)
    (tmp_path / "manifest.json").write_text('{"format": 3}', encoding="utf-8")
    with pytest.raises(InvalidValueError, match="another version"):
        dataset.load(tmp_path)


@pytest.mark.slow
def test_any_keyword_of_the_environment(tmp_path: Path) -> None:
    keywords = {
        "objects": [ObjectSpec(shape="cylinder", size=(0.03, 0.03, 0.05))],
        "randomize": [Roughness(0.5, 2.0)],
        "tolerance": 0.1,
        "taxels": (2, 3),
    }
    plan = dataset.Plan(episodes=1, materials=MATERIALS[:1], keywords=keywords)
    dataset.make(plan, tmp_path)
    assert read_plan(tmp_path) == plan and read_plan(tmp_path).differences(plan) == []
    assert plan.keywords["randomize"] == (Roughness(0.5, 2.0),)
    rows = dataset.load(tmp_path, ["pressure"])
    assert rows["pressure"][0].shape[1:] == (2, 2, 3)
    other = dataclasses.replace(plan, keywords={**keywords, "tolerance": 0.2})
    with pytest.raises(InvalidValueError, match=r"its keyword tolerance is 0\.1, not 0\.2"):
        dataset.make(other, tmp_path)


def test_keywords_that_cannot_be_kept() -> None:
    with pytest.raises(InvalidValueError, match="gripper .* the name of its file"):
        dataset.Plan(keywords={"gripper": object()})
    with pytest.raises(InvalidValueError, match="mode is an argument of its own"):
        dataset.Plan(keywords={"mode": "O"})
    with pytest.raises(UnknownNameError, match="unknown record 'Popen'"):
        dataset.decoded({"record": "Popen", "args": ["ls"]})
    with pytest.raises(InvalidValueError, match="cannot make Roughness"):
        dataset.decoded({"record": "Roughness", "colour": 1})


@pytest.mark.parametrize(
    ("changed", "error"),
    [
        ({"episodes": 0}, InvalidValueError),
        ({"seed": -1}, InvalidValueError),
        ({"seed": 2**63}, InvalidValueError),
        ({"shard_size": 0}, InvalidValueError),
        ({"mode": "X"}, InvalidValueError),
        ({"materials": ()}, InvalidValueError),
        ({"policy": "scriptd"}, UnknownNameError),
    ],
)
def test_plans_that_cannot_be(changed: dict[str, Any], error: type[Exception]) -> None:
    with pytest.raises(error):
        dataclasses.replace(PLAN, **changed)


def test_an_environment_that_does_not_fit_is_refused(tmp_path: Path) -> None:
    with pytest.raises(ThermograspError, match="cannot run 'thermograsp/Grasp-v9'"):
        dataset.make(dataclasses.replace(PLAN, env_id="thermograsp/Grasp-v9"), tmp_path / "a")
    assert not list(tmp_path.rglob("*.parquet"))
