"""A dataset's episodes as a Minari dataset, for offline reinforcement learning; local, without network."""

from __future__ import annotations

import copy
import os
import secrets
import shutil
from collections.abc import Callable, Sequence
from contextlib import AbstractContextManager, closing
from pathlib import Path
from typing import Any

import gymnasium
import numpy as np
from gymnasium.envs.registration import EnvSpec

from thermograsp.dataset.plan import Plan
from thermograsp.dataset.reading import read, unpacked
from thermograsp.dataset.run import Advance, silent
from thermograsp.dataset.schema import TRUTH
from thermograsp.dataset.shards import whole
from thermograsp.errors import (
    InvalidValueError,
    MissingDependencyError,
    ThermograspError,
    UnknownNameError,
    install,
)
from thermograsp.files import write_error
from thermograsp.thermal import material

_KEPT = ("material", "rung", "ending", "success")  # of an episode, in its Minari metadata


def minari_id(plan: Plan) -> str:
    """Such as thermograsp/Grasp/scripted-v0."""
    return f"{plan.env_id.rpartition('-v')[0]}/{plan.policy}-v0"


def export_minari(
    folder: str | os.PathLike[str],
    dataset_id: str | None = None,
    progress: Callable[[float], AbstractContextManager[Advance]] = silent,
) -> tuple[str, Path]:
    """Writes a complete dataset to Minari's folder ($MINARI_DATASETS_PATH, or ~/.minari/datasets), whole or not at all.
    Returns its id and path.

    dataset_id: a Minari id, None for minari_id()'s. An episode's infos hold what a real gripper cannot know, per
    observation; its metadata its seed, material, rung and ending. progress: as make() has it.
    Raises InvalidValueError where the dataset lacks shards or the id is taken or malformed, WriteError on a full
    disk, and MissingDependencyError."""
    minari = _minari()
    plan, files = whole(folder)
    name = minari_id(plan) if dataset_id is None else dataset_id
    try:
        namespace, _, _ = minari.dataset.minari_dataset.parse_dataset_id(name)
    except (ValueError, TypeError) as error:  # TypeError: an id without its version
        raise InvalidValueError(f"{name!r} is not a Minari id such as {minari_id(plan)!r}") from error
    target = Path(minari.storage.get_dataset_path(name))
    if target.exists():
        raise InvalidValueError(f"{target} exists: take another name or version, or delete it first")
    # Minari does not look into hidden folders, so a part of a dataset is never taken for one.
    staged = Path(minari.storage.get_dataset_path()) / f".{secrets.token_hex(8)}"
    staged.mkdir()
    try:
        with (
            closing(gymnasium.make(plan.env_id, **plan.env_config)) as env,
            progress(plan.episodes) as advance,
        ):
            observation, action = env.observation_space, env.action_space
            assert isinstance(observation, gymnasium.spaces.Dict)
            storage = minari.dataset.minari_storage.MinariStorage.new(
                staged / "data", observation, action, _spec(plan), "hdf5"
            )
            storage.update_metadata(_about(plan, name, minari.__version__))
            for file in files:
                advance("", _append(minari, storage, file, tuple(observation.spaces)))
        if namespace is not None and namespace not in minari.namespace.list_local_namespaces():
            minari.namespace.create_namespace(namespace)
        os.replace(staged, target)
    except BaseException as error:
        shutil.rmtree(staged, ignore_errors=True)
        if isinstance(error, OSError) and not isinstance(error, ThermograspError):
            raise write_error(target, error) from error
        raise
    return name, target


def _append(minari: Any, storage: Any, file: Path, observed: Sequence[str]) -> int:
    """Adds a shard's episodes; returns how many."""
    columns = unpacked(read(file))
    first, count = storage.total_episodes, len(columns["seed"])
    buffers = []
    for k in range(count):
        last = np.arange(columns["steps"][k]) == columns["steps"][k] - 1
        buffers.append(
            minari.data_collector.EpisodeBuffer(
                id=first + k,
                seed=int(columns["seed"][k]),
                observations={name: columns[name][k] for name in observed},
                actions=columns["action"][k],
                rewards=columns["reward"][k],
                terminations=last & columns["terminated"][k],
                truncations=last & columns["truncated"][k],
                infos={name: columns[name][k] for name in TRUTH},
            )
        )
    storage.update_episodes(buffers)
    kept = ({name: columns[name][k].item() for name in _KEPT} for k in range(count))
    storage.update_episode_metadata(kept, range(first, first + count))
    return count


def _about(plan: Plan, name: str, minari_version: str) -> dict[str, Any]:
    drawn = ", ".join(one.name for one in plan.materials)
    return {
        "dataset_id": name,
        "minari_version": minari_version,
        "algorithm_name": plan.policy,
        "requirements": [f"{package}=={version}" for package, version in plan.versions.items()],
        "description": f"{plan.env_id}, mode {plan.mode}, policy {plan.policy}, seeds from {plan.seed} on; materials: "
        f"{drawn}. Infos: temperature_drop K, contact_area m2, conductance W/(m2 K), per fingertip.",
    }


def _spec(plan: Plan) -> EnvSpec | None:
    """What makes the environment again, by names; None where a material is not the package's, for JSON cannot hold
    it."""
    try:
        by_name = not plan.keywords and all(material(one.name) == one for one in plan.materials)
    except UnknownNameError:
        by_name = False
    if not by_name:
        return None
    spec = copy.deepcopy(gymnasium.spec(plan.env_id))
    spec.kwargs |= {"mode": plan.mode, "material": [one.name for one in plan.materials]}
    return spec


def _minari() -> Any:
    try:
        import h5py  # noqa: F401  # pyright: ignore[reportMissingImports]
        import minari  # pyright: ignore[reportMissingImports]
        import minari.namespace  # pyright: ignore[reportMissingImports]
    except ImportError as error:
        raise MissingDependencyError(f"the export needs Minari: {install('minari')}") from error
    return minari
