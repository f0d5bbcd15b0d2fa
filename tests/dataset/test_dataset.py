"""Datasets made in one process: what a row holds, files that depend on their seeds alone, resuming, and the command."""

import dataclasses
import errno
import json
import multiprocessing
import os
import signal
import subprocess
import sys
import time
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from pathlib import Path
from typing import Any

import gymnasium
import numpy as np
import pytest

from thermograsp import dataset
from thermograsp.agents.policies import policy
from thermograsp.cli import main
from thermograsp.dataset import episodes as rolling
from thermograsp.dataset import in_processes
from thermograsp.dataset.episodes import roll
from thermograsp.dataset.plan import installed_versions
from thermograsp.dataset.schema import TRUTH, shape_of
from thermograsp.dataset.shards import read_plan
from thermograsp.envs import ObjectSpec, Roughness
from thermograsp.errors import (
    InvalidValueError,
    MissingDependencyError,
    SimulationError,
    ThermograspError,
    UnknownNameError,
    WriteError,
)
from thermograsp.files import atomic_write
from thermograsp.thermal import material, materials
from thermograsp.thermal.matter.materials import UNITS

pa = pytest.importorskip("pyarrow")
pq = pytest.importorskip("pyarrow.parquet")

# Glass is held after 188 steps, water gel is crushed after 25, gold is too heavy and runs into the time limit: 500.
MATERIALS = tuple(material(name) for name in ("glass", "water_gel", "gold"))
PLAN = dataset.Plan(episodes=7, seed=8, shard_size=3, materials=MATERIALS)


@pytest.fixture(scope="module")
def folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    made = tmp_path_factory.mktemp("dataset") / "grasps"
    assert dataset.make(PLAN, made) == dataset.ShardCounts(shards=3, found=0)
    return made


def contents(folder: Path) -> dict[str, bytes]:
    return {path.name: path.read_bytes() for path in folder.iterdir()}


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


def copied(folder: Path, to: Path) -> Path:
    for name, content in contents(folder).items():
        (to / name).write_bytes(content)
    return to


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


@pytest.mark.slow
def test_processes_of_this_machine_make_the_same_files(folder: Path, tmp_path: Path) -> None:
    done = []

    @contextmanager
    def watching(total: float) -> Iterator[Any]:
        assert total == PLAN.episodes
        yield lambda doing, by: done.append(by)

    assert dataset.make(PLAN, tmp_path, workers=2, progress=watching) == dataset.ShardCounts(
        shards=3, found=0
    )
    assert contents(tmp_path) == contents(folder)
    assert done == [1] * PLAN.episodes  # it moves with every episode


@pytest.mark.slow
def test_a_process_that_dies_loses_and_doubles_nothing(folder: Path) -> None:
    made: dict[str, bytes] = {}
    producing = in_processes.produce(PLAN, PLAN.shards, 1, lambda: None)
    for shard, content in producing:
        made[shard.file] = content
        for process in multiprocessing.active_children():
            process.kill()
    assert not multiprocessing.active_children()
    assert made == {name: content for name, content in contents(folder).items() if name.endswith("parquet")}


def test_what_a_process_raises_is_raised(tmp_path: Path) -> None:
    with pytest.raises(ThermograspError, match="cannot run 'thermograsp/Grasp-v9'"):
        dataset.make(dataclasses.replace(PLAN, env_id="thermograsp/Grasp-v9"), tmp_path, workers=1)
    assert not multiprocessing.active_children() and not list(tmp_path.glob("*.parquet"))


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


def test_a_file_is_on_the_disk_when_its_name_is(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """A loss of power may not leave a name without its content."""
    order: list[str] = []
    sync, put = os.fsync, os.replace
    monkeypatch.setattr(
        os, "fsync", lambda handle: (order.append(os.readlink(f"/proc/self/fd/{handle}")), sync(handle))[1]
    )
    monkeypatch.setattr(os, "replace", lambda a, b: (order.append(f"{a} becomes {b}"), put(a, b))[1])
    with atomic_write(tmp_path / "a.parquet") as temporary:
        temporary.write_bytes(b"rows")
    assert order == [str(temporary), f"{temporary} becomes {tmp_path / 'a.parquet'}", str(tmp_path)]


@pytest.mark.parametrize("workers", [0, pytest.param(2, marks=pytest.mark.slow)])
def test_a_disk_that_fills_up_loses_nothing_that_was_whole(
    folder: Path, tmp_path: Path, workers: int
) -> None:
    """The system finds no room for the second shard. What was there stays, no part of a file is left, no process goes
    on, and the same command makes the rest when there is room again."""
    whole, sync, stored = contents(folder), os.fsync, []

    def full(handle: int) -> None:
        name = os.readlink(f"/proc/self/fd/{handle}")
        if name.endswith(".parquet"):
            stored.append(name)
            if len(stored) > 1:
                raise OSError(errno.ENOSPC, "No space left on device")
        sync(handle)

    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(os, "fsync", full)
        with pytest.raises(WriteError, match=r"cannot write .*seeds-.*No space left on device; make room"):
            dataset.make(PLAN, tmp_path, workers=workers)
    assert not multiprocessing.active_children()
    left = contents(tmp_path)
    assert len(left) == 2 and left.items() <= whole.items()
    assert dataset.make(PLAN, tmp_path, workers=workers) == dataset.ShardCounts(shards=3, found=1)
    assert contents(tmp_path) == whole


def test_a_disk_that_is_full_at_once_begins_nothing(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    def full(handle: int) -> None:
        raise OSError(errno.ENOSPC, "No space left on device")

    monkeypatch.setattr(os, "fsync", full)
    with pytest.raises(WriteError, match=r"manifest\.json: No space left on device"):
        dataset.make(PLAN, tmp_path / "d")
    assert not list((tmp_path / "d").iterdir())


@pytest.mark.slow
@pytest.mark.skipif(not Path("/proc/self/stat").exists(), reason="looks for processes in /proc")
def test_a_command_that_is_killed_with_its_processes_goes_on(folder: Path, tmp_path: Path) -> None:
    """Killed after the first file; no process of it is left, and another number of workers makes the same bytes."""
    whole = contents(folder)
    line = "dataset --episodes 7 --seed 8 --shard 3 --material glass water_gel gold".split()
    command = [sys.executable, "-m", "thermograsp", *line, "--out", str(tmp_path)]
    running = subprocess.Popen([*command, "--workers", "2"], start_new_session=True)
    try:
        while running.poll() is None and not list(tmp_path.glob("seeds-*.parquet")):
            time.sleep(0.02)
        running.kill()  # the one that writes; it can end nobody
        assert running.wait() in (-signal.SIGKILL, 0)
        for _ in range(1500):  # its processes see that it is gone when they have something to say
            if not _alive(running.pid):
                break
            time.sleep(0.02)
        assert not _alive(running.pid)
    finally:
        with suppress(ProcessLookupError):
            os.killpg(running.pid, signal.SIGKILL)
    left = {name: content for name, content in contents(tmp_path).items() if not name.startswith(".")}
    assert len(left) >= 2 and left.items() <= whole.items()
    assert main([*line, "--out", str(tmp_path), "--workers", "1"]) == 0
    assert {name: content for name, content in contents(tmp_path).items() if name in whole} == whole


def _alive(group: int) -> bool:
    """Whether any process of a group runs; those that have ended and wait to be noticed do not."""
    for path in Path("/proc").glob("[0-9]*/stat"):
        with suppress(OSError):  # it has just gone
            state, _, its_group = path.read_text().rpartition(")")[2].split()[:3]
            if int(its_group) == group and state != "Z":
                return True
    return False


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


@pytest.mark.parametrize(("episodes", "size"), [(1, 1), (7, 3), (9, 3), (3, 100)])
def test_shards_share_the_seeds(episodes: int, size: int) -> None:
    shards = dataset.Plan(episodes=episodes, seed=5, shard_size=size).shards
    assert [seed for shard in shards for seed in shard.seeds] == list(range(5, 5 + episodes))
    assert max(shard.count for shard in shards) <= size
    assert [shard.file for shard in shards] == sorted(shard.file for shard in shards)


def test_an_environment_that_does_not_fit_is_refused(tmp_path: Path) -> None:
    with pytest.raises(ThermograspError, match="cannot run 'thermograsp/Grasp-v9'"):
        dataset.make(dataclasses.replace(PLAN, env_id="thermograsp/Grasp-v9"), tmp_path / "a")
    assert not list(tmp_path.rglob("*.parquet"))


def test_workers_without_ray(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setitem(__import__("sys").modules, "ray", None)
    with pytest.raises(MissingDependencyError, match=r"thermograsp\[ray\]"):
        dataset.make(PLAN, tmp_path, workers=1, address="local")
    with pytest.raises(InvalidValueError, match="needs workers"):
        dataset.make(PLAN, tmp_path, address="auto")
    with pytest.raises(InvalidValueError, match="workers must be a whole number, 0 or above"):
        dataset.make(PLAN, tmp_path, workers=-1)


def test_the_command(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    line = [
        "dataset",
        "--episodes",
        "3",
        "--shard",
        "2",
        "--out",
        str(tmp_path / "d"),
        "--material",
        "glass",
        "wood",
    ]
    assert main([*line, "--json"]) == 0
    summary = json.loads(capsys.readouterr().out)
    assert (summary["episodes"], summary["shards"], summary["found"]) == (3, 2, 0)
    assert main(line) == 0
    shown = capsys.readouterr()
    assert "2 of them found done" in shown.out and shown.err == ""
    assert set(dataset.load(tmp_path / "d", ["material"])["material"]) <= {"glass", "wood"}
    assert main([*line, "--mode", "O"]) == 2
    assert "its mode is T, not O" in capsys.readouterr().err
    assert main([*line, "--set", "tolerance=0.1"]) == 2
    assert "its keyword tolerance is left out, not 0.1" in capsys.readouterr().err
    assert main([*line, "--set", "tolerance"]) == 2
    assert "--set takes NAME=VALUE" in capsys.readouterr().err
    for wrong in (["dataset"], ["dataset", "--episodes", "1", "--name", "x-v0"]):
        assert main([*wrong, "--out", str(tmp_path / "e")]) == 2
    assert not (tmp_path / "e").exists()


def test_the_command_with_materials_of_ones_own(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    entry = {name: (getattr(material("glass"), name), unit) for name, unit in UNITS.items()}
    entry["conductivity"] = (5.0, "W/(m K)")
    lines = [f'{name} = {{ value = {v}, unit = "{u}", source = "s" }}' for name, (v, u) in entry.items()]
    (tmp_path / "own.toml").write_text(
        "\n".join(['[sources]\ns = "me"\n[materials.own]', *lines]), encoding="utf-8"
    )
    line = [
        "dataset",
        "--episodes",
        "1",
        "--out",
        str(tmp_path / "d"),
        "--materials",
        str(tmp_path / "own.toml"),
    ]
    assert main(line) == 2
    assert "--materials needs --material" in capsys.readouterr().err
    assert main([*line, "--material", "own"]) == 0
    assert read_plan(tmp_path / "d").materials[0].conductivity == 5.0
    assert dataset.load(tmp_path / "d")["material"].tolist() == ["own"]
