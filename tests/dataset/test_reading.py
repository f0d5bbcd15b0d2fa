"""Batches hold every step once, paired with its neighbour, whatever their size and order."""

import re
import sys
from collections.abc import Iterator
from pathlib import Path
from types import SimpleNamespace

import numpy as np
import pytest

from thermograsp import dataset
from thermograsp.dataset import reading
from thermograsp.errors import InvalidValueError, UnknownNameError
from thermograsp.thermal import material

pytest.importorskip("pyarrow")

ROOT = Path(__file__).parents[2]
COLUMNS = [
    "seed",
    "voltage",
    "next_voltage",
    "force",
    "action",
    "reward",
    "terminated",
    "truncated",
    "material",
]


@pytest.fixture(scope="module")
def folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    made = tmp_path_factory.mktemp("dataset") / "grasps"
    names = ("glass", "water_gel", "wood", "iron")
    dataset.make(dataset.Plan(episodes=9, shard_size=2, materials=tuple(map(material, names))), made)
    return made


def joined(batches: Iterator[dict[str, np.ndarray]]) -> dict[str, np.ndarray]:
    held = list(batches)
    return {name: np.concatenate([batch[name] for batch in held]) for name in held[0]}


def test_in_order_batches_are_the_episodes(folder: Path) -> None:
    rows = dataset.load(folder)
    batches = list(dataset.iterate(folder, 100, COLUMNS))
    assert {len(batch["seed"]) for batch in batches[:-1]} == {100} and len(batches[-1]["seed"]) <= 100
    steps = joined(iter(batches))
    assert np.array_equal(steps["seed"], np.repeat(rows["seed"], rows["steps"]))
    assert np.array_equal(steps["material"], np.repeat(rows["material"], rows["steps"]))
    assert np.array_equal(steps["voltage"], np.concatenate([one[:-1] for one in rows["voltage"]]))
    assert np.array_equal(steps["next_voltage"], np.concatenate([one[1:] for one in rows["voltage"]]))
    assert np.array_equal(steps["force"], np.concatenate([one[:-1] for one in rows["force"]]))
    assert np.array_equal(steps["action"], np.concatenate(rows["action"]))
    assert np.array_equal(steps["reward"], np.concatenate(rows["reward"]))
    ends = np.cumsum(rows["steps"]) - 1
    assert np.flatnonzero(steps["terminated"]).tolist() == ends[rows["terminated"]].tolist()
    assert np.flatnonzero(steps["truncated"]).tolist() == ends[rows["truncated"]].tolist()


@pytest.mark.parametrize("mixed", [1, 2, 100])
def test_shuffled_batches_hold_every_step_once(
    folder: Path, mixed: int, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(reading, "_MIXED", mixed)
    plain = joined(dataset.iterate(folder, 64, COLUMNS))
    mixed_up, again, other = (
        joined(dataset.iterate(folder, 64, COLUMNS, rng=np.random.default_rng(seed))) for seed in (1, 1, 2)
    )
    assert all(np.array_equal(mixed_up[name], again[name]) for name in COLUMNS)
    assert not np.array_equal(mixed_up["reward"], plain["reward"])
    assert not np.array_equal(mixed_up["reward"], other["reward"])

    def sorted_rows(steps: dict[str, np.ndarray]) -> np.ndarray:
        parts = [np.asarray(steps[name], float).reshape(len(steps["seed"]), -1) for name in COLUMNS[:-1]]
        rows = np.concatenate(parts, axis=1)
        return rows[np.lexsort(rows.T)]

    assert np.array_equal(sorted_rows(mixed_up), sorted_rows(plain))


def test_readers_share_the_shards(folder: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """Among processes, and among the workers of a DataLoader in each of them."""
    rows = dataset.load(folder, ["seed", "steps"])
    whole = sorted(np.repeat(rows["seed"], rows["steps"]).tolist())

    def seeds(part: tuple[int, int], seed: int) -> list[int]:
        batches = list(dataset.iterate(folder, 64, ["seed"], rng=np.random.default_rng(seed), part=part))
        return [int(one) for batch in batches for one in batch["seed"]]

    assert sorted(seeds((0, 2), 0) + seeds((1, 2), 7)) == whole  # each with a generator of its own
    worker = SimpleNamespace(id=0, num_workers=3)
    loading = SimpleNamespace(get_worker_info=lambda: worker)
    monkeypatch.setitem(sys.modules, "torch.utils.data", loading)  # pyright: ignore[reportArgumentType]
    found = []
    for worker.id in range(3):
        for k in range(2):
            found += seeds((k, 2), worker.id)
    assert sorted(found) == whole
    with pytest.raises(InvalidValueError, match="part must be"):
        seeds((2, 2), 0)


def test_a_last_batch_can_be_left_out(folder: Path) -> None:
    total = int(dataset.load(folder, ["steps"])["steps"].sum())
    sizes = [len(batch["seed"]) for batch in dataset.iterate(folder, 101, ["seed"], drop_last=True)]
    assert sizes == [101] * (total // 101)


def test_filters_take_episodes(folder: Path) -> None:
    rows = dataset.load(folder)
    chosen = dataset.load(folder, ["seed", "voltage"], where=[("material", "in", ["glass", "iron"])])
    wanted = [k for k in range(9) if rows["material"][k] in ("glass", "iron")]
    assert chosen["seed"].tolist() == wanted and list(chosen) == ["seed", "voltage"]
    assert all(np.array_equal(chosen["voltage"][i], rows["voltage"][k]) for i, k in enumerate(wanted))
    steps = joined(dataset.iterate(folder, 50, ["seed"], where=[("success", "==", False)]))
    assert set(steps["seed"]) == set(rows["seed"][~rows["success"]]) != set()
    nothing = dataset.load(folder, where=[("material", "==", "gold")])
    assert len(nothing["seed"]) == len(nothing["voltage"]) == 0
    assert list(dataset.iterate(folder, 50, where=[("material", "==", "gold")])) == []


def test_what_cannot_be_read_is_named(folder: Path) -> None:
    with pytest.raises(InvalidValueError, match=r"parquet is not a dataset: it has no manifest\.json"):
        dataset.load(next(folder.glob("*.parquet")))
    for wrong in (["voltag"], ["next_action"], ["next_voltag"]):
        with pytest.raises(UnknownNameError, match="unknown column"):
            next(dataset.iterate(folder, 8, wrong))
    with pytest.raises(UnknownNameError, match="did you mean 'voltage'"):
        dataset.load(folder, ["voltag"])
    with pytest.raises(InvalidValueError, match="cannot filter by"):
        dataset.load(folder, where=[("colour", "==", "red")])
    with pytest.raises(InvalidValueError, match="batch_size"):
        next(dataset.iterate(folder, 0))
    with pytest.raises(UnknownNameError, match="library"):
        dataset.load(folder, library="jax")  # pyright: ignore[reportArgumentType]


def test_torch_tensors_are_the_same_numbers(folder: Path) -> None:
    torch = pytest.importorskip("torch")
    arrays = list(dataset.iterate(folder, 128, COLUMNS, rng=np.random.default_rng(0)))
    tensors = list(dataset.iterate(folder, 128, COLUMNS, rng=np.random.default_rng(0), library="torch"))
    for batch, wanted in zip(tensors, arrays, strict=True):
        for name in COLUMNS[:-1]:
            assert isinstance(batch[name], torch.Tensor) and np.array_equal(batch[name].numpy(), wanted[name])
    whole = dataset.load(folder, ["voltage", "material"], library="torch")
    assert whole["voltage"][0].dtype == torch.float32 and whole["material"][0] in (
        "glass",
        "water_gel",
        "wood",
        "iron",
    )


@pytest.mark.parametrize("kind", ["", "torch"])
def test_the_docs_run(
    kind: str, folder: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    if kind:
        pytest.importorskip(kind)
    docs = (ROOT / "docs" / "datasets.md").read_text(encoding="utf-8")
    blocks = re.findall(rf"```python {kind}\n(.*?)```" if kind else r"```python\n(.*?)```", docs, re.DOTALL)
    assert blocks
    monkeypatch.chdir(folder.parent)
    for block in blocks:
        exec(compile(block, "docs/datasets.md", "exec"), {})
    assert "2, 16" in capsys.readouterr().out


def test_the_docs_list_every_column(folder: Path) -> None:
    import pyarrow.parquet as pq

    docs = (ROOT / "docs" / "datasets.md").read_text(encoding="utf-8")
    listed = {}
    for line in re.findall(r"^\| (.*) \|$", docs, re.MULTILINE):
        names, _, unit, per, *_ = (cell.strip() for cell in line.split("|"))
        listed |= {name: (unit, per) for name in names.split(", ")}
    schema = pq.read_schema(next(folder.glob("*.parquet")))
    held = {
        field.name: (field.metadata[b"unit"].decode(), field.metadata[b"per"].decode()) for field in schema
    }
    assert {name: listed.get(name) for name in held} == held
