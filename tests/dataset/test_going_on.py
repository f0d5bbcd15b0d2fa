"""A dataset that was begun: what is lost is made again, it grows, and it is read while it is incomplete."""

import dataclasses
import json
from pathlib import Path

import pytest

from thermograsp import dataset
from thermograsp.dataset.plan import installed_versions
from thermograsp.errors import InvalidValueError

from .plan import PLAN, contents, copied

pytest.importorskip("pyarrow")


def test_lost_and_broken_files_are_made_again_and_no_others(folder: Path, tmp_path: Path) -> None:
    whole = contents(folder)
    shards = [shard.file for shard in PLAN.shards]
    for name, content in whole.items():
        (tmp_path / name).write_bytes(content)
    (tmp_path / shards[0]).unlink()
    (tmp_path / shards[1]).write_bytes(whole[shards[1]][:-100])  # cut short
    (tmp_path / ".left.parquet").write_bytes(b"of a killed run")
    kept = (tmp_path / shards[2]).stat().st_mtime_ns
    assert dataset.make(PLAN, tmp_path) == dataset.ShardCounts(shards=3, found=1)
    (tmp_path / ".left.parquet").unlink()
    assert contents(tmp_path) == whole and (tmp_path / shards[2]).stat().st_mtime_ns == kept
    (tmp_path / shards[0]).write_bytes(whole[shards[1]])  # another's seeds
    assert dataset.make(PLAN, tmp_path) == dataset.ShardCounts(shards=3, found=2)
    assert contents(tmp_path) == whole


def test_a_dataset_grows_to_what_one_run_makes(folder: Path, tmp_path: Path) -> None:
    """The last file of the smaller one is cut off in the middle of a shard: its seeds must not be there twice."""
    small = tmp_path / "small"
    plan = dataclasses.replace(PLAN, episodes=4)
    dataset.make(plan, small)
    assert len(list(small.glob("*.parquet"))) == 2
    assert dataset.make(PLAN, small) == dataset.ShardCounts(shards=3, found=1)
    assert contents(small) == contents(folder)


def test_an_upgrade_with_the_same_sources_goes_on(
    folder: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    whole = contents(folder)
    copied(folder, tmp_path)
    (tmp_path / PLAN.shards[2].file).unlink()
    monkeypatch.setattr("thermograsp.__version__", "99.0")
    after = dataclasses.replace(PLAN, versions=installed_versions())
    assert after.versions["thermograsp"] == "99.0"
    assert dataset.make(after, tmp_path) == dataset.ShardCounts(shards=3, found=2)
    assert contents(tmp_path) == whole


def test_a_manifest_of_before_is_read(folder: Path, tmp_path: Path) -> None:
    manifest = json.loads((folder / "manifest.json").read_text(encoding="utf-8"))
    del manifest["sources"], manifest["keywords"]
    old = dataset.Plan.from_document({**manifest, "format": 1})
    assert old.differences(PLAN) == []
    later = dataclasses.replace(PLAN, versions={**PLAN.versions, "thermograsp": "99.0"})
    assert PLAN.differences(later) == []
    assert old.differences(later) == [f"version of thermograsp is {PLAN.versions['thermograsp']}, not 99.0"]


def test_an_incomplete_dataset_is_read_where_that_is_asked(folder: Path, tmp_path: Path) -> None:
    copied(folder, tmp_path)
    (tmp_path / PLAN.shards[1].file).unlink()
    with pytest.warns(RuntimeWarning, match="lacks 1 of 3 shards: these are 4 of 7 episodes"):
        rows = dataset.load(tmp_path, ["seed"], incomplete=True)
    assert rows["seed"].tolist() == [8, 9, 10, 14]
    with pytest.warns(RuntimeWarning, match="lacks 1 of 3"):
        steps = list(dataset.iterate(tmp_path, 10_000, ["seed"], incomplete=True))
    assert set(steps[0]["seed"]) == {8, 9, 10, 14}
    with pytest.raises(InvalidValueError, match="incomplete=True"):
        dataset.load(tmp_path)
    for shard in PLAN.shards:
        (tmp_path / shard.file).unlink(missing_ok=True)
    with pytest.raises(InvalidValueError, match="lacks 3 of 3"):
        dataset.load(tmp_path, incomplete=True)


def test_an_incomplete_dataset_is_not_read(folder: Path, tmp_path: Path) -> None:
    (tmp_path / "manifest.json").write_bytes((folder / "manifest.json").read_bytes())
    with pytest.raises(InvalidValueError, match="lacks 3 of 3 shards"):
        next(dataset.iterate(tmp_path, 4))
