"""A dataset's episodes as a LeRobot dataset (format v3, a row a frame), for imitation learning; without network."""

from __future__ import annotations

import os
import re
import secrets
import shutil
from collections.abc import Callable, Mapping, Sequence
from contextlib import AbstractContextManager, closing
from pathlib import Path
from typing import Any

import gymnasium
import numpy as np

from thermograsp.dataset.plan import Plan
from thermograsp.dataset.reading import read, unpacked
from thermograsp.dataset.run import Advance, silent
from thermograsp.dataset.schema import TRUTH, Column, columns
from thermograsp.dataset.shards import whole
from thermograsp.errors import InvalidValueError, MissingDependencyError, ThermograspError, install
from thermograsp.files import write_error

_NAME = re.compile(r"[A-Za-z0-9][\w.-]*/[A-Za-z0-9][\w.-]*")
_TASKS: Mapping[str, str] = {
    "thermograsp/Grasp-v0": "Grasp the object and lift it.",
    "thermograsp/Identify-v0": "Touch the object and identify its material.",
    "thermograsp/Sort-v0": "Grasp the object and put it where its material belongs.",
}
"""What LeRobot calls a task: the sentence that a policy of words is given. Of another environment it is the id."""


def lerobot_id(plan: Plan) -> str:
    """Such as thermograsp/Grasp-scripted."""
    return f"{plan.env_id.rpartition('-v')[0]}-{plan.policy}"


def export_lerobot(
    folder: str | os.PathLike[str],
    repo_id: str | None = None,
    progress: Callable[[float], AbstractContextManager[Advance]] = silent,
) -> tuple[str, Path]:
    """Writes a complete dataset to LeRobot's folder ($HF_LEROBOT_HOME, or ~/.cache/huggingface/lerobot), whole or not
    at all. Returns its id and path.

    repo_id: LeRobot's OWNER/NAME, None for lerobot_id()'s. A frame is a control step: `observation.state` is what the
    agent saw before it, one number after another as the file's names say; `action`, `next.reward`, `next.done` and
    `next.success` follow, then what a real gripper cannot know (`truth.`), the seed and the material. Numbers are
    float32. progress: as make() has it.
    Raises InvalidValueError where the dataset lacks shards, the id is taken or malformed, or the control rate is no
    whole number of frames a second; WriteError on a full disk, and MissingDependencyError."""
    home, create, without_bars = _lerobot()
    plan, files = whole(folder)
    name = lerobot_id(plan) if repo_id is None else repo_id
    if not _NAME.fullmatch(name):
        raise InvalidValueError(f"{name!r} is not a LeRobot id such as {lerobot_id(plan)!r}")
    target = Path(home) / name
    if target.exists():
        raise InvalidValueError(f"{target} exists: take another name, or delete it first")
    with closing(gymnasium.make(plan.env_id, **plan.env_config)) as env:
        listed = {one.name: one for one in columns(env.observation_space, env.action_space)}
        assert isinstance(env.observation_space, gymnasium.spaces.Dict)
        observed = tuple(listed[name] for name in env.observation_space.spaces)
        frames_per_second = _whole_rate(env.get_wrapper_attr("dt"))
    staged = target.parent / f".{secrets.token_hex(8)}"
    written = None
    try:
        target.parent.mkdir(parents=True, exist_ok=True)
        written = create(
            repo_id=name,
            fps=frames_per_second,
            features=_features(observed, listed["action"]),
            root=staged,
            robot_type="thermograsp",
            use_videos=False,
        )
        with progress(plan.episodes) as advance, without_bars():
            for file in files:
                for episode in _episodes(file):
                    for frame in _frames(episode, observed):
                        written.add_frame({**frame, "task": _TASKS.get(plan.env_id, plan.env_id)})
                    written.save_episode()
                    advance("", 1)
        written.finalize()
        os.replace(staged, target)
    except BaseException as error:
        if written is not None:  # else it would write this when it is collected
            written.meta.metadata_buffer.clear()
        shutil.rmtree(staged, ignore_errors=True)
        if isinstance(error, OSError) and not isinstance(error, ThermograspError):
            raise write_error(target, error) from error
        raise
    return name, target


def _features(observed: Sequence[Column], action: Column) -> dict[str, dict[str, Any]]:
    """LeRobot's description of a frame: what each name holds."""
    state = [name for column in observed for name in _names(column)]

    def one(dtype: str, names: list[str] | None = None) -> dict[str, Any]:
        return {"dtype": dtype, "shape": (len(names) if names else 1,), "names": names}

    return {
        "observation.state": one("float32", state),
        "action": one("float32", _names(action)),
        "next.reward": one("float32"),
        "next.done": one("bool"),
        "next.success": one("bool"),
        **{f"truth.{name}": one("float32", ["left", "right"]) for name in TRUTH},
        "seed": one("int64"),
        "material": one("string"),
    }


def _names(column: Column) -> list[str]:
    """Of each number of an item in C order, such as voltage.1.15."""
    return [".".join([column.name, *map(str, index)]) for index in np.ndindex(column.shape)]


def _episodes(file: Path) -> list[dict[str, Any]]:
    """Column name -> value, or array (items, ...), of each episode of a shard."""
    held = unpacked(read(file))
    return [{name: values[k] for name, values in held.items()} for k in range(len(held["seed"]))]


def _frames(episode: Mapping[str, Any], observed: Sequence[Column]) -> list[dict[str, Any]]:
    """LeRobot's frames of an episode, one a control step, without the last observation, which no action follows."""
    steps = int(episode["steps"])
    last = np.arange(steps) == steps - 1
    state = np.concatenate(
        [episode[column.name][:-1].reshape(steps, -1).astype(np.float32) for column in observed], axis=1
    )
    by_name = {
        "observation.state": state,
        "action": episode["action"].astype(np.float32),
        "next.reward": episode["reward"].astype(np.float32)[:, None],
        "next.done": last[:, None],
        "next.success": (last & episode["success"])[:, None],
        **{f"truth.{name}": episode[name][:-1] for name in TRUTH},
        "seed": np.full((steps, 1), episode["seed"], np.int64),
    }
    material = str(episode["material"])
    return [
        {**{name: values[t] for name, values in by_name.items()}, "material": material} for t in range(steps)
    ]


def _whole_rate(dt: float) -> int:
    rate = round(1.0 / dt)
    if abs(rate * dt - 1.0) > 1e-6:
        raise InvalidValueError(
            f"LeRobot's frames come at a whole rate, and a control step is {dt:g} s: give one such as 0.02 s"
        )
    return rate


def _lerobot() -> tuple[Any, Callable[..., Any], Any]:
    """Its folder of datasets, what begins a new one, and a context in which it shows no progress of its own."""
    try:
        from lerobot.datasets.lerobot_dataset import (  # pyright: ignore[reportMissingImports]
            HF_LEROBOT_HOME,
            LeRobotDataset,
        )
        from lerobot.utils.utils import SuppressProgressBars  # pyright: ignore[reportMissingImports]
    except ImportError as error:
        raise MissingDependencyError(f"the export needs LeRobot: {install('lerobot')}") from error
    return HF_LEROBOT_HOME, LeRobotDataset.create, SuppressProgressBars
