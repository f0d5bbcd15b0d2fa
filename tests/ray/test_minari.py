"""The export to Minari holds the same episodes, and a part of one is never left."""

from __future__ import annotations

import dataclasses
import errno
import os
import re
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from thermograsp import dataset
from thermograsp.cli import main
from thermograsp.errors import InvalidValueError, WriteError
from thermograsp.thermal import material

minari: Any = pytest.importorskip("minari", reason="needs Minari: make test-ray")
pytest.importorskip("h5py", reason="needs Minari's hdf5 extra: make test-ray")

ROOT = Path(__file__).parents[2]
ID = "thermograsp/Grasp/scripted-v0"
PLAN = dataset.Plan(episodes=5, seed=3, shard_size=2, materials=(material("glass"), material("water_gel")))


@pytest.fixture
def home(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    monkeypatch.setenv("MINARI_DATASETS_PATH", str(tmp_path / "minari"))
    return tmp_path / "minari"


@pytest.fixture(scope="module")
def folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    made = tmp_path_factory.mktemp("dataset") / "grasps"
    dataset.make(PLAN, made)
    return made


def test_the_episodes_are_the_same(folder: Path, home: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["dataset", "--export", "minari", "--out", str(folder)]) == 0
    assert ID in capsys.readouterr().out and list(minari.list_local_datasets()) == [ID]
    rows, exported = dataset.load(folder), minari.load_dataset(ID)
    assert exported.total_episodes == 5 and exported.total_steps == rows["steps"].sum()
    for k, (episode, about) in enumerate(
        zip(exported, exported.storage.get_episode_metadata(range(5)), strict=True)
    ):
        for name in ("gripper", "force", "voltage", "thermostat"):
            assert np.array_equal(episode.observations[name], rows[name][k])
        for name in ("temperature_drop", "contact_area", "conductance"):
            assert np.array_equal(episode.infos[name], rows[name][k])
        assert np.array_equal(episode.actions, rows["action"][k])
        assert np.array_equal(episode.rewards, rows["reward"][k])
        assert np.flatnonzero(episode.terminations).tolist() == [rows["steps"][k] - 1]
        assert not episode.truncations.any()
        assert (about["seed"], about["material"], about["ending"]) == (
            rows["seed"][k],
            rows["material"][k],
            rows["ending"][k],
        )


def test_the_environment_is_recovered(folder: Path, home: Path) -> None:
    dataset.export_minari(folder)
    exported = minari.load_dataset(ID)
    env = exported.recover_environment()
    observation, info = env.reset(seed=3)
    assert all(np.array_equal(observation[name], exported[0].observations[name][0]) for name in observation)
    assert info["material"] == dataset.load(folder, ["material"])["material"][0]


def test_a_name_that_is_taken_or_malformed_is_refused(folder: Path, home: Path) -> None:
    assert dataset.export_minari(folder, "mine-v3") == ("mine-v3", home / "mine-v3")
    before = sorted(home.rglob("*"))
    with pytest.raises(InvalidValueError, match="exists"):
        dataset.export_minari(folder, "mine-v3")
    for name in ("mine", "a b-v0", "../x-v0"):
        with pytest.raises(InvalidValueError, match="is not a Minari id"):
            dataset.export_minari(folder, name)
    assert sorted(home.rglob("*")) == before


def test_an_export_that_fails_leaves_nothing(folder: Path, home: Path) -> None:
    class Failing:
        def __init__(self, total: float) -> None: ...

        def __enter__(self) -> Any:
            return self.advance

        def __exit__(self, *error: object) -> None: ...

        def advance(self, doing: str, by: float) -> None:
            assert len(list(home.rglob("main_data.hdf5"))) == 1
            assert minari.list_local_datasets() == {}
            raise KeyboardInterrupt

    with pytest.raises(KeyboardInterrupt):
        dataset.export_minari(folder, progress=Failing)
    assert list(home.iterdir()) == []


def test_an_incomplete_dataset_is_not_exported(folder: Path, home: Path, tmp_path: Path) -> None:
    (tmp_path / "manifest.json").write_bytes((folder / "manifest.json").read_bytes())
    with pytest.raises(InvalidValueError, match="lacks 3 of 3"):
        dataset.export_minari(tmp_path)


def test_materials_of_ones_own_are_exported_without_the_environment(home: Path, tmp_path: Path) -> None:
    glass = dataclasses.replace(material("glass"), name="own", conductivity=2.0)
    dataset.make(dataset.Plan(episodes=1, materials=(glass,)), tmp_path / "d")
    dataset.export_minari(tmp_path / "d")
    assert minari.load_dataset(ID).env_spec is None


def test_the_docs_run(
    folder: Path, home: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    dataset.export_minari(folder)
    (block,) = re.findall(
        r"```python minari\n(.*?)```", (ROOT / "docs" / "datasets.md").read_text("utf-8"), re.DOTALL
    )
    exec(compile(block, "docs/datasets.md", "exec"), {})
    assert capsys.readouterr().out.startswith("5 (")


def test_a_full_disk_leaves_no_part(folder: Path, home: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    def full(*_: object) -> None:
        raise OSError(errno.ENOSPC, os.strerror(errno.ENOSPC))

    monkeypatch.setattr("thermograsp.dataset.minari_export._append", full)
    with pytest.raises(WriteError, match="make room"):
        dataset.export_minari(folder)
    assert not [path for path in home.rglob("*") if path.is_file()] and not minari.list_local_datasets()
