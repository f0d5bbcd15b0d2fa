"""A dataset's folder: a manifest and one Parquet file a shard, each there whole or not at all.

A shard's name and content follow from its seeds and the plan alone, so whoever makes it, and however often, makes the
same file.
"""

from __future__ import annotations

import json
import os
import warnings
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path

from thermograsp.dataset.episodes import roll
from thermograsp.dataset.plan import Plan, Shard, installed_versions
from thermograsp.dataset.schema import arrow, table
from thermograsp.dataset.sources import sources_digest
from thermograsp.errors import InvalidValueError, SimulationError, ThermograspError
from thermograsp.files import atomic_write, made_folder, write_text

MANIFEST = "manifest.json"


def shard_bytes(plan: Plan, shard: Shard, advance: Callable[[], None] = lambda: None) -> bytes:
    """A shard's Parquet file. advance: called after each episode.

    Raises SimulationError where this machine's packages are not those of the plan: its numbers could differ."""
    different = plan.differences(replace(plan, versions=installed_versions(), sources=sources_digest()))
    if different:
        raise SimulationError(
            f"this worker differs from the plan: its {'; its '.join(different)}; install the same versions everywhere"
        )
    pa = arrow()
    listed, episodes = roll(plan, shard.seeds, advance=advance)
    rows = table(plan, listed, episodes)
    words = [column.name for column in listed if column.dtype == "str"]
    sink = pa.BufferOutputStream()
    # No dictionary for numbers: the voltage history repeats itself from step to step, which zstd finds.
    pa.parquet.write_table(
        rows, sink, compression="zstd", use_dictionary=words, row_group_size=max(1, len(episodes))
    )
    return sink.getvalue().to_pybytes()


def store(folder: Path, shard: Shard, content: bytes) -> None:
    """Puts a shard into the folder."""
    with atomic_write(folder / shard.file) as temporary:
        temporary.write_bytes(content)


def start(folder: Path, plan: Plan) -> Plan:
    """Makes the folder a dataset's, or checks that it is this plan's, or grows it to its number of episodes. Returns
    the plan as the folder has it: with the versions that it was begun with. Raises InvalidValueError that names the
    difference where it is another's."""
    if (folder / MANIFEST).exists():
        held = read_plan(folder)
        grown = replace(held, episodes=max(plan.episodes, held.episodes))
        different = grown.differences(plan)
        if different:
            raise InvalidValueError(
                f"{folder} holds another dataset: its {'; its '.join(different)}. "
                f"Use the arguments of its {MANIFEST}, or name another folder"
            )
        if grown.episodes > held.episodes:
            write_text(folder / MANIFEST, _manifest(grown))
        return grown
    if folder.exists() and (not folder.is_dir() or any(folder.glob("*.parquet"))):
        raise InvalidValueError(
            f"cannot start a dataset in {folder}: name a folder without other Parquet files"
        )
    made_folder(folder)
    write_text(folder / MANIFEST, _manifest(plan))
    return plan


def tidy(folder: Path, plan: Plan) -> None:
    """Removes files of fewer episodes from before the dataset grew, whose seeds are in others now."""
    kept = {shard.file for shard in plan.shards}
    for path in folder.glob("seeds-*.parquet"):
        if path.name not in kept:
            path.unlink()


def _manifest(plan: Plan) -> str:
    return json.dumps(plan.document(), indent=2, ensure_ascii=False) + "\n"


def read_plan(folder: str | os.PathLike[str]) -> Plan:
    """The plan of a dataset's folder. Raises InvalidValueError where there is none that can be read."""
    path = Path(folder) / MANIFEST
    try:
        return Plan.from_document(json.loads(path.read_text(encoding="utf-8")))
    except (FileNotFoundError, NotADirectoryError):
        raise InvalidValueError(f"{folder} is not a dataset: it has no {MANIFEST}") from None
    except (ValueError, AttributeError, ThermograspError) as error:
        raise InvalidValueError(f"cannot read {path}: {error}") from error


def missing(folder: Path, plan: Plan) -> list[Shard]:
    """Shards that the folder lacks. A file that is cut short or of other seeds counts as lacking."""
    return [shard for shard in plan.shards if not _is_complete(folder / shard.file, shard)]


def whole(folder: str | os.PathLike[str], incomplete: bool = False) -> tuple[Plan, list[Path]]:
    """The plan and all files of a dataset, in the order of their seeds. incomplete: those that are there, with a
    RuntimeWarning where some lack.

    Raises InvalidValueError where it lacks some, or, if that may be, all."""
    plan = read_plan(folder)
    lacking = missing(Path(folder), plan)
    complete = [shard for shard in plan.shards if shard not in lacking]
    if lacking:
        lacks = f"{folder} lacks {len(lacking)} of {len(plan.shards)} shards"
        if not incomplete or not complete:
            raise InvalidValueError(
                f"{lacks}: repeat the command that made it"
                + ("" if incomplete else ", or read what is there with incomplete=True")
            )
        episodes = sum(shard.count for shard in complete)
        warnings.warn(
            f"{lacks}: these are {episodes} of {plan.episodes} episodes", RuntimeWarning, stacklevel=3
        )
    return plan, [Path(folder) / shard.file for shard in complete]


def _is_complete(path: Path, shard: Shard) -> bool:
    pa = arrow()
    try:
        found = pa.parquet.read_metadata(path)
    except (OSError, pa.ArrowException):
        return False
    if found.num_rows != shard.count:
        return False
    place = found.schema.names.index("seed") if "seed" in found.schema.names else -1
    limits = found.row_group(0).column(place).statistics if place == 0 else None
    return limits is not None and (limits.min, limits.max) == (shard.first, shard.seeds[-1])
