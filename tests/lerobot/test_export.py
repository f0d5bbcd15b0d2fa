"""The export to LeRobot holds the same episodes, as LeRobot reads them, and a part of one is never left."""

from __future__ import annotations

import errno
import os
import re
from pathlib import Path

import numpy as np
import pytest
from lerobot.datasets.lerobot_dataset import LeRobotDataset  # pyright: ignore[reportMissingImports]

from thermograsp import dataset
from thermograsp.cli import main
from thermograsp.errors import InvalidValueError, WriteError
from thermograsp.thermal import material

ROOT = Path(__file__).parents[2]
ID = "thermograsp/Grasp-scripted"
PLAN = dataset.Plan(episodes=3, seed=3, shard_size=2, materials=(material("glass"), material("water_gel")))
OBSERVED = {"gripper", "force", "voltage", "thermostat"}
TRUTH = ("temperature_drop", "contact_area", "conductance")


@pytest.fixture(scope="module")
def folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    made = tmp_path_factory.mktemp("dataset") / "grasps"
    dataset.make(PLAN, made)
    return made


@pytest.fixture
def home(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """In place of $HF_LEROBOT_HOME, which LeRobot reads when it is imported."""
    monkeypatch.setattr("lerobot.datasets.lerobot_dataset.HF_LEROBOT_HOME", tmp_path / "home")
    monkeypatch.setenv("HF_DATASETS_CACHE", str(tmp_path / "cache"))
    return tmp_path / "home"


def test_every_number_is_the_same(
    folder: Path, home: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    assert main(["dataset", "--export", "lerobot", "--out", str(folder)]) == 0
    assert f"wrote LeRobot dataset {ID} to {home / ID}" in capsys.readouterr().out
    rows, read = dataset.load(folder), LeRobotDataset(ID)
    assert (read.num_episodes, read.num_frames, read.fps) == (3, rows["steps"].sum(), 50)
    assert {path.name for path in home.iterdir()} == {"thermograsp"} and len(list(home.glob("*/*"))) == 1
    frames = read.hf_dataset.with_format("numpy")[:]
    starts = np.concatenate([[0], np.cumsum(rows["steps"])])
    names = read.features["observation.state"]["names"]
    observed = list(dict.fromkeys(name.split(".")[0] for name in names))
    assert set(observed) == OBSERVED
    for k in range(3):
        rows_of, steps = slice(starts[k], starts[k + 1]), rows["steps"][k]
        seen = np.concatenate([rows[name][k][:-1].reshape(steps, -1) for name in observed], axis=1)
        state = np.stack(frames["observation.state"][rows_of])
        assert state.dtype == np.float32 and state.shape == (steps, len(names))
        assert np.array_equal(state, seen)
        newest = names.index("voltage.1.15")
        assert np.array_equal(state[:, newest], rows["voltage"][k][:-1, 1, 15])
        assert np.array_equal(np.stack(frames["action"][rows_of]), rows["action"][k])
        assert np.array_equal(frames["next.reward"][rows_of], rows["reward"][k].astype(np.float32))
        for name in TRUTH:
            assert np.array_equal(np.stack(frames[f"truth.{name}"][rows_of]), rows[name][k][:-1])
        assert np.flatnonzero(frames["next.done"][rows_of]).tolist() == [steps - 1]
        assert bool(frames["next.success"][rows_of][-1]) == rows["success"][k]
        assert set(frames["seed"][rows_of]) == {rows["seed"][k]} == {3 + k}
        assert set(frames["material"][rows_of]) == {rows["material"][k]}
        assert np.allclose(frames["timestamp"][rows_of], np.arange(steps) * 0.02, atol=1e-5)
    (block,) = re.findall(
        r"```python lerobot\n(.*?)```", (ROOT / "docs" / "datasets.md").read_text("utf-8"), re.DOTALL
    )
    exec(compile(block, "docs/datasets.md", "exec"), {})
    assert "torch.Size([8, 44])" in capsys.readouterr().out


def test_a_name_that_is_taken_or_malformed_is_refused(folder: Path, home: Path) -> None:
    (home / "mine/grasps").mkdir(parents=True)
    with pytest.raises(InvalidValueError, match="exists: take another name"):
        dataset.export_lerobot(folder, "mine/grasps")
    for name in ("grasps", "a b/c", "../x", "a/b/c"):
        with pytest.raises(InvalidValueError, match="is not a LeRobot id"):
            dataset.export_lerobot(folder, name)


def test_a_full_disk_leaves_no_part(folder: Path, home: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    def full(*_: object) -> None:
        raise OSError(errno.ENOSPC, os.strerror(errno.ENOSPC))

    monkeypatch.setattr(LeRobotDataset, "finalize", full)
    with pytest.raises(WriteError, match="make room"):
        dataset.export_lerobot(folder)
    assert not [path for path in home.rglob("*") if path.is_file()] and not list(home.glob("*/*"))


def test_frames_at_no_whole_rate_are_refused(
    home: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    from thermograsp.dataset import lerobot_export

    with pytest.raises(InvalidValueError, match="a control step is 0.03 s"):
        lerobot_export._whole_rate(0.03)
    assert lerobot_export._whole_rate(0.02) == 50
