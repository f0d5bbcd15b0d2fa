"""What must hold after every control step of an environment, whatever the policy does.

B: environments at once.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from typing import Any

import gymnasium
import numpy as np

from thermograsp.plant import Reading

HEAT_BALANCE = 1e-6  # of the heat that was exchanged
_LEAST_HEAT = 1e-9  # J, below which a balance is round-off
_TEMPERATURES = ("sensor_surface", "object_surface", "object_temperature")


@dataclass(frozen=True, slots=True)
class Violation:
    """episode, step: counted from 0 and 1. what: which rule, with the numbers."""

    episode: int
    step: int
    what: str

    def __str__(self) -> str:
        return f"episode {self.episode}, step {self.step}: {self.what}"


def violations(
    env: gymnasium.vector.VectorEnv,
    observation: Any,
    reward: np.ndarray,
    info: dict[str, Any],
    rows: np.ndarray,
    first: int,
    step: int,
    check: bool,
) -> list[Violation]:
    """Violations in the named rows (those still running) of one step; first: the episode of row 0. Broken simulations
    always count, the other rules where `check` is set."""
    found: list[tuple[int, str]] = []
    errors, failed = info.get("error"), info.get("_error")
    if errors is not None and failed is not None:
        found += [(row, str(errors[row])) for row in rows if failed[row]]
    if check:
        found += _values(env, observation, reward, rows)
        batch = getattr(env.unwrapped, "batch", None)
        if batch is not None and batch.reading is not None and "object_temperature" in batch.reading.truth:
            found += _temperatures(batch.plant, batch.reading, rows)
            found += _heat(batch.reading, rows)
    return [Violation(first + int(row), step, what) for row, what in found]


def _values(
    env: gymnasium.vector.VectorEnv, observation: Any, reward: np.ndarray, rows: np.ndarray
) -> Iterator[tuple[int, str]]:
    space = env.single_observation_space
    spaces = space.spaces if isinstance(space, gymnasium.spaces.Dict) else {"observation": space}
    parts = observation if isinstance(observation, dict) else {"observation": observation}
    for row in rows:
        if not np.isfinite(reward[row]):
            yield row, f"the reward is {reward[row]}"
        for name, part in parts.items():
            if not np.isfinite(part[row]).all():
                yield row, f"{name} is not finite: {part[row].tolist()}"
            elif not spaces[name].contains(part[row]):
                yield row, f"{name} is outside its space: {part[row].tolist()}"


def _temperatures(plant: Any, reading: Reading, rows: np.ndarray) -> Iterator[tuple[int, str]]:
    """Nothing gets colder or warmer than what it all started from, up to the networks' tolerance."""
    margin = plant.config.tolerance
    for row in rows:
        ends = plant.temperatures(row)
        low, high = min(ends) - margin, max(ends) + margin
        for name in _TEMPERATURES:
            values = np.atleast_1d(reading.truth[name][row])
            if not ((values >= low) & (values <= high)).all():
                yield row, f"{name} {values.tolist()} degC is outside {low:g} .. {high:g}"


def _heat(reading: Reading, rows: np.ndarray) -> Iterator[tuple[int, str]]:
    for row in rows:
        missing, exchanged = (
            float(reading.truth[name][row]) for name in ("heat_imbalance", "heat_exchanged")
        )
        if not abs(missing) <= HEAT_BALANCE * exchanged + _LEAST_HEAT:
            yield row, f"{missing:.3g} J are missing of {exchanged:.3g} J exchanged"
