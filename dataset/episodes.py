"""Episodes rolled out in a vector environment, recorded whole.

B: environments at once.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping, Sequence
from contextlib import closing
from typing import Any

import gymnasium
import numpy as np

from thermograsp.agents import policy
from thermograsp.dataset.plan import Plan
from thermograsp.dataset.schema import TRUTH, Column, columns
from thermograsp.errors import InvalidValueError, ThermograspError

AT_ONCE = 64
"""Environments that step together; no episode depends on it."""

_CAPACITY = 256  # items that a tape holds before it grows
_ENDINGS = ("error", "success", "dropped", "crushed")


def roll(
    plan: Plan,
    seeds: Sequence[int],
    at_once: int = AT_ONCE,
    advance: Callable[[], None] = lambda: None,
) -> tuple[tuple[Column, ...], list[dict[str, Any]]]:
    """The columns and the episodes of these seeds, in their order: column name -> value, or array (items, ...).

    advance: called after each episode. Raises ThermograspError for an environment that cannot be made and
    InvalidValueError for one whose episodes do not fit the schema."""
    try:
        env = gymnasium.make_vec(
            plan.env_id,
            num_envs=min(at_once, len(seeds)),
            vectorization_mode="vector_entry_point",
            **plan.env_config,
        )
    except gymnasium.error.Error as error:
        raise ThermograspError(f"cannot run {plan.env_id!r}: {error}") from error
    found: dict[int, dict[str, Any]] = {}
    with closing(env):
        listed = columns(env.single_observation_space, env.single_action_space)
        for seed, episode in _episodes(env, plan, listed, seeds):
            found[seed] = episode
            advance()
    return listed, [found[seed] for seed in seeds]


def _episodes(
    env: gymnasium.vector.VectorEnv, plan: Plan, listed: Sequence[Column], seeds: Sequence[int]
) -> Iterator[tuple[int, dict[str, Any]]]:
    """(seed, episode) as they end. A row whose episode ended starts the next seed at once, so that a few long
    episodes do not keep the others' rows idle."""
    count = env.num_envs
    acting = policy(env, plan.policy)
    tapes = {column.name: _Tape(count, column) for column in listed if column.per != "episode"}
    waiting = iter(seeds)
    running = np.array([next(waiting) for _ in range(count)])  # seed of each row, -1: nothing left to do
    observation, info = env.reset(seed=running.tolist())  # pyright: ignore[reportArgumentType]
    acting.restart(range(count), running.tolist())
    taken = np.zeros(count, int)
    _write(tapes, np.arange(count), taken, observation, info)
    while (running >= 0).any():
        action = acting.action(observation)
        observation, reward, terminated, truncated, info = env.step(action)
        rows = np.flatnonzero(running >= 0)
        tapes["action"].write(rows, taken, action)
        tapes["reward"].write(rows, taken, reward)
        taken[rows] += 1
        _write(tapes, rows, taken, observation, info)
        ended = rows[(terminated | truncated)[rows]]
        for row in ended.tolist():
            lists = {name: tape.read(row, int(taken[row])) for name, tape in tapes.items()}
            whole = _whole(plan, info, row, bool(terminated[row]), bool(truncated[row]))
            total = float(lists["reward"].sum())
            yield (
                int(running[row]),
                {"seed": int(running[row]), "steps": int(taken[row]), "return": total, **whole, **lists},
            )
            running[row] = next(waiting, -1)
        starting = ended[running[ended] >= 0]
        if starting.size:
            mask = np.isin(np.arange(count), starting)
            given = [seed if chosen else None for seed, chosen in zip(running.tolist(), mask, strict=True)]
            observation, info = env.reset(seed=given, options={"reset_mask": mask})  # pyright: ignore[reportArgumentType]
            acting.restart(starting, running[starting].tolist())
            taken[starting] = 0
            _write(tapes, starting, taken, observation, info)


def _write(
    tapes: Mapping[str, _Tape],
    rows: np.ndarray,
    at: np.ndarray,
    observation: Mapping[str, np.ndarray],
    info: Mapping[str, Any],
) -> None:
    for name in TRUTH:
        if name not in info:
            raise InvalidValueError(
                f"a dataset needs an environment whose info has {', '.join(TRUTH)}: {name} is missing"
            )
    for name, tape in tapes.items():
        if name not in ("action", "reward"):
            tape.write(rows, at, info[name] if name in TRUTH else observation[name])


def _whole(
    plan: Plan, info: Mapping[str, Any], row: int, terminated: bool, truncated: bool
) -> dict[str, Any]:
    """What holds for the whole episode, from its last step's info."""
    flags = {name: bool(info[name][row]) for name in _ENDINGS if name in info}
    fallback = "terminated" if terminated else "truncated"
    return {
        "material": str(info["material"][row]),
        "rung": str(info["rung"][row]),
        "success": flags.get("success", False),
        "ending": next((name for name in _ENDINGS if flags.get(name)), fallback),
        "error": str(info["error"][row]) if flags.get("error") else "",
        "terminated": terminated,
        "truncated": truncated,
        "version": plan.versions["thermograsp"],
    }


class _Tape:
    """A quantity of each row over time; it grows."""

    def __init__(self, rows: int, column: Column) -> None:
        self._values = np.zeros((rows, _CAPACITY, *column.shape), column.dtype)
        self._extra = int(column.per == "observation")

    def write(self, rows: np.ndarray, at: np.ndarray, values: np.ndarray) -> None:
        """values: (B, ...), of which only `rows` count. at: (B,), each row's place."""
        if at[rows].max() >= self._values.shape[1]:
            self._values = np.concatenate((self._values, np.zeros_like(self._values)), axis=1)
        self._values[rows, at[rows]] = np.asarray(values)[rows]

    def read(self, row: int, steps: int) -> np.ndarray:
        """A copy of a row's items of an episode of so many steps."""
        return self._values[row, : steps + self._extra].copy()
