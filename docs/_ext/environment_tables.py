"""Every registered environment as tables, from its spaces, its steps and its docstring."""

from __future__ import annotations

import inspect
from collections.abc import Iterable, Iterator, Mapping
from functools import cache
from typing import Any

import gymnasium
import numpy as np
from environment_words import (
    ACTIONS,
    COMMANDS,
    INFOS,
    OBSERVATIONS,
    ON_HARDWARE,
    OPTIONS,
    SIMULATED,
    SOMETIMES,
)

from thermograsp.envs.gym import TouchEnv
from thermograsp.plant import Command


def registered() -> list[str]:
    """Ids of the package's environments, in the order in which they are registered."""
    return [name for name in gymnasium.registry if name.startswith("thermograsp/")]


@cache
def environment_tables() -> str:
    """A section for each. Raises KeyError where environment_words.py lacks a word."""
    return "\n".join(_section(name) for name in registered())


def _section(name: str) -> str:
    env: Any = gymnasium.make(name).unwrapped
    try:
        paragraphs = _paragraphs(type(env))
        parts = (
            f"## {name}\n\n{paragraphs['']}",
            f"### Action\n\nThe action space is {_numbers(env.action_space)}, with one action every "
            f"{1e3 * env.dt:.0f} ms. Values outside it are clipped.\n\n{action_table(name, env)}",
            f"### Observation\n\nThe observation space is a `Dict` of float32 boxes.\n\n{observation_table(name, env)}",
            f"### Reward and end\n\n{paragraphs['Reward']}",
            f"### Info\n\n{info_table(name, env)}",
            f"### Keywords\n\n{paragraphs['Keywords']}",
        )
    finally:
        env.close()
    return "\n\n".join(part.replace("<", "&lt;") for part in parts) + "\n"


def action_table(name: str, env: TouchEnv) -> str:
    """What each component commands at -1 and at 1, as the task itself translates it."""
    size = _still(env).size
    words = ACTIONS[name]
    rows = []
    for i, what in enumerate(words):
        last = i == len(words) - 1 and size > len(words)
        low, high = (_changed(env, i, end) for end in (-1.0, 1.0))
        rows.append((f"{i} .. {size - 1}" if last else str(i), what, low, high))
    return _table(("index", "what", "at -1", "at 1"), rows)


def _changed(env: TouchEnv, component: int, value: float) -> str:
    """What a component changes of the command, against its other end."""
    forward, reverse = _still(env), _still(env)
    forward[0, component], reverse[0, component] = value, -value
    commands = [env.batch.task.command(action) for action in (forward, reverse)]
    changes = []
    for name in Command._fields:
        value_here, other = (getattr(command, name) for command in commands)
        if value_here is not None and value_here[0] != other[0]:
            unit = COMMANDS[name]
            number = value_here[0] * (1e3 if unit.startswith("mm") else 1.0)
            changes.append((name.replace("_", " "), f"{number:.4g} {unit}"))
    if len(changes) == 1:
        return changes[0][1]
    return ", ".join(f"{name} {number}" for name, number in changes)


def observation_table(name: str, env: TouchEnv) -> str:
    """Shape, unit and bounds of every key, and of those that a keyword adds."""
    plain = env.observation_space
    rows = [row for key in plain.spaces for row in _observed(key, plain, "")]
    for keyword, other in variants(name):
        space = other.observation_space
        for key in sorted(set(space.spaces) - set(plain.spaces)):
            rows += _observed(key, space, f"; with `{keyword}`")
        other.close()
    return _table(("key", "shape", "what", "unit", "from", "to"), rows)


def variants(name: str) -> Iterator[tuple[str, TouchEnv]]:
    """The environment with each of the keywords that add something."""
    for keyword, value in OPTIONS[name].items():
        made: Any = gymnasium.make(name, **{keyword: value}).unwrapped
        yield keyword, made


def _observed(key: str, space: gymnasium.spaces.Dict, condition: str) -> list[tuple[str, ...]]:
    """A row for each component, or one for all."""
    box, words, rows = space[key], OBSERVATIONS[key], []
    assert isinstance(box, gymnasium.spaces.Box)
    for i, (what, unit) in enumerate(words):
        low, high = (np.atleast_1d(bound)[i] if len(words) > 1 else bound for bound in (box.low, box.high))
        ends = tuple(f"{_one(bound):.4g}" for bound in (low, high))
        index = f" [{i}]" if len(words) > 1 else ""
        rows.append((f"`{key}`{index}", str(box.shape), what + condition, unit, *ends))
    return rows


def info_table(name: str, env: TouchEnv) -> str:
    """Keys in the order in which they come, with the shapes that they have in a first step."""
    values, ends = info_keys(env)
    rows = [(f"`{key}`", _shape(value), *INFOS[key], _known(key)) for key, value in values.items()]
    for keyword, other in variants(name):
        more, _ = info_keys(other)
        when = f"with `{keyword}`"
        rows += [(f"`{key}`", _shape(more[key]), *INFOS[key], when) for key in more if key not in values]
        other.close()
    for when, keys in (("at the end", ends), ("if there is one", SOMETIMES), ("on hardware", ON_HARDWARE)):
        rows += [(f"`{key}`", "", *INFOS[key], when) for key in keys]
    return _table(("key", "shape", "what", "unit", "when"), rows)


def _known(key: str) -> str:
    """When info has it."""
    return "in a simulation" if key in SIMULATED else "always"


def info_keys(env: TouchEnv) -> tuple[Mapping[str, Any], Iterable[str]]:
    """What info always has, with values of a step, and the reasons that can end an episode."""
    env.reset(seed=0)
    step = env.batch.step(_still(env))
    reasons = env.batch.task.reasons
    return {key: value for key, value in step.info(0).items() if key not in reasons}, reasons


def _still(env: TouchEnv) -> np.ndarray:
    """(1, n) of zeros, an action of the batch."""
    assert isinstance(env.action_space, gymnasium.spaces.Box)
    return np.zeros((1, *env.action_space.shape))


def _paragraphs(kind: type) -> dict[str, str]:
    """Of its docstring: the first, under "", and those that begin with a name of their part."""
    found: dict[str, str] = {}
    for paragraph in (inspect.getdoc(kind) or "").split("\n\n"):
        start = paragraph.split(":")[0].split()[0].rstrip(",") if found else ""
        found.setdefault(start, paragraph)
    return found


def _numbers(box: gymnasium.Space[Any]) -> str:
    assert isinstance(box, gymnasium.spaces.Box)
    return f"`Box({_one(box.low):g}, {_one(box.high):g}, {box.shape}, {box.dtype})`"


def _one(bound: np.ndarray) -> float:
    """The bound of all components, which is one."""
    (value,) = np.unique(bound)
    return float(value)


def _shape(value: object) -> str:
    if isinstance(value, np.ndarray):
        return str(value.shape)
    return type(value).__name__


def _table(header: tuple[str, ...], rows: list[tuple[str, ...]]) -> str:
    """Columns that are empty throughout are left out."""
    kept = [i for i in range(len(header)) if any(row[i] for row in rows)]
    lines = [header, ("---",) * len(header), *rows]
    return "\n".join("| " + " | ".join(line[i] for i in kept) + " |" for line in lines)
