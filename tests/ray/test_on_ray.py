"""Datasets on Ray equal those of one process byte for byte, whatever is killed meanwhile.

Every test ends what it started; none needs the network. Without Ray (`make test-ray` brings it) all are skipped."""

from __future__ import annotations

import os
import signal
import subprocess
import sys
import time
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import pytest

from thermograsp import dataset
from thermograsp.errors import InvalidValueError, ThermograspError
from thermograsp.thermal import material

ray: Any = pytest.importorskip("ray", reason="needs Ray: make test-ray")

PLAN = dataset.Plan(episodes=80, seed=5, shard_size=8, materials=(material("glass"), material("water_gel")))
COMMAND = "dataset --episodes 80 --seed 5 --shard 8 --material glass water_gel".split()
STORE = 100 * 2**20
# A killed node is given up after two seconds, not after some fifteen.
QUICK = {
    "health_check_initial_delay_ms": 0,
    "health_check_period_ms": 500,
    "health_check_failure_threshold": 4,
}


@pytest.fixture(autouse=True)
def no_statistics(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("RAY_USAGE_STATS_ENABLED", "0")


@pytest.fixture(scope="module")
def plain(tmp_path_factory: pytest.TempPathFactory) -> dict[str, bytes]:
    """The files as one process makes them."""
    folder = tmp_path_factory.mktemp("plain")
    dataset.make(PLAN, folder)
    return contents(folder)


@pytest.fixture
def cluster() -> Iterator[Any]:
    """A head and no other node yet, one CPU."""
    from ray.cluster_utils import Cluster  # pyright: ignore[reportMissingImports]

    head = {"num_cpus": 1, "include_dashboard": False, "object_store_memory": STORE, "_system_config": QUICK}
    made = Cluster(initialize_head=True, head_node_args=head)
    try:
        yield made
    finally:
        ray.shutdown()
        made.shutdown()


def contents(folder: Path) -> dict[str, bytes]:
    return {path.name: path.read_bytes() for path in folder.iterdir() if not path.name.startswith(".")}


def sorted_rows(folder: Path) -> Any:
    import pyarrow as pa
    import pyarrow.parquet as pq

    return pa.concat_tables([pq.read_table(file) for file in folder.glob("*.parquet")]).sort_by("seed")


def test_a_node_that_dies_loses_and_doubles_nothing(
    cluster: Any, plain: dict[str, bytes], tmp_path: Path
) -> None:
    """Two nodes of one CPU, two tasks at a time, so both are at work when the second is killed."""
    node = cluster.add_node(num_cpus=1, object_store_memory=STORE)
    assert cluster.wait_for_nodes(timeout=30) is None
    done, nodes = [0], []

    class Killing:
        def __init__(self, total: float) -> None:
            assert total == PLAN.episodes

        def __enter__(self) -> Any:
            return self.advance

        def __exit__(self, *error: object) -> None: ...

        def advance(self, doing: str, by: float) -> None:
            done[0] += 1
            if done[0] == 3:
                nodes.append(len([one for one in ray.nodes() if one["Alive"]]))
                cluster.remove_node(node, allow_graceful=False)
            if done[0] == len(PLAN.shards):
                nodes.append(len([one for one in ray.nodes() if one["Alive"]]))

    made = dataset.make(PLAN, tmp_path, workers=2, address=cluster.address, progress=Killing)
    assert made == dataset.ShardCounts(shards=10, found=0)
    assert nodes == [2, 1] and done == [10]
    assert contents(tmp_path) == plain
    reference = tmp_path / "reference"
    reference.mkdir()
    for name, content in plain.items():
        (reference / name).write_bytes(content)
    rows = sorted_rows(tmp_path)
    assert rows.equals(sorted_rows(reference), check_metadata=True)
    assert rows.column("seed").to_pylist() == list(range(5, 85))


def test_a_driver_that_is_killed_goes_on_where_it_was(plain: dict[str, bytes], tmp_path: Path) -> None:
    command = [sys.executable, "-m", "thermograsp", *COMMAND, "--out", str(tmp_path)]
    # A session of its own: what Ray leaves behind after such an end is found and ended by it.
    driver = subprocess.Popen([*command, "--workers", "2", "--ray-address", "local"], start_new_session=True)
    try:
        wait_for(lambda: len(list(tmp_path.glob("seeds-*.parquet"))) >= 2)
        driver.send_signal(signal.SIGKILL)
        assert driver.wait() == -signal.SIGKILL
    finally:
        end_session(driver.pid)
    before = contents(tmp_path)
    assert 2 <= len(before) - 1 < len(PLAN.shards)
    assert all(plain[name] == content for name, content in before.items())
    again = subprocess.run(
        [*command, "--workers", "1", "--ray-address", "local"], capture_output=True, text=True, check=True
    )
    assert f"{len(before) - 1} of them found done" in again.stdout and again.stderr == ""
    assert contents(tmp_path) == plain


def test_errors_arrive_as_ours_and_ray_ends(tmp_path: Path) -> None:
    plan = dataset.Plan(env_id="thermograsp/Grasp-v9", episodes=2)
    with pytest.raises(ThermograspError, match="cannot run 'thermograsp/Grasp-v9'"):
        dataset.make(plan, tmp_path / "a", workers=1, address="local")
    assert not ray.is_initialized()
    with pytest.raises(InvalidValueError, match="no Ray cluster at '127.0.0.1:1'"):
        dataset.make(PLAN, tmp_path / "b", workers=1, address="127.0.0.1:1")
    assert not ray.is_initialized()


def wait_for(holds: Any, seconds: float = 120.0) -> None:
    end = time.monotonic() + seconds
    while not holds():
        assert time.monotonic() < end, f"waited {seconds} s in vain"
        time.sleep(0.01)


def end_session(session: int) -> None:
    """Ends all processes of a session."""
    for entry in Path("/proc").glob("[0-9]*/stat"):
        try:
            fields = entry.read_text().rpartition(")")[2].split()
        except OSError:
            continue
        if int(fields[3]) == session and fields[0] != "Z":
            os.kill(int(entry.parent.name), signal.SIGKILL)
