"""What a ThermalTouch is given, checked: keywords, worlds, seeds, temperatures, records.

W: worlds, O: objects.
"""

# mujoco ships no type stubs for its compiled names
# pyright: reportAttributeAccessIssue=false

from __future__ import annotations

from collections.abc import Mapping, Sequence

import mujoco
import numpy as np

from thermograsp.errors import InvalidValueError, celsius, unknown_name

from ..thermal import SIGNAL_CHAINS, SignalChain


def require_mapping(name: str, value: object, example: str) -> None:
    """Raises InvalidValueError for what is none."""
    if not isinstance(value, Mapping):
        raise InvalidValueError(f"{name} must be a mapping such as {example}, got {type(value).__name__}")


def named_chain(chain: SignalChain | str) -> SignalChain:
    """The electronics, by name or as they are. Raises UnknownNameError."""
    if isinstance(chain, SignalChain):
        return chain
    try:
        return SIGNAL_CHAINS[chain]
    except (KeyError, TypeError):  # a list is no name at all
        raise unknown_name("signal chain", chain, SIGNAL_CHAINS) from None


def chosen_worlds(worlds: Sequence[int] | np.ndarray | None, count: int) -> list[int]:
    """Their numbers, of so many: None for all, numbers, or (W,) booleans. Raises InvalidValueError."""
    if worlds is None:
        return list(range(count))
    given = np.asarray(worlds)
    if given.dtype == bool and given.shape == (count,):
        return np.flatnonzero(given).tolist()
    if given.size and (
        given.ndim != 1 or given.dtype.kind not in "iu" or given.min() < 0 or given.max() >= count
    ):
        raise InvalidValueError(f"worlds must be numbers from 0 to {count - 1} or ({count},) booleans")
    return sorted(set(given.tolist()))


def seeds_of(seed: int | Sequence[int], worlds: Sequence[int]) -> list[int]:
    """Those of the worlds' noise: one number is world 0's, and the others count on from it. Raises
    InvalidValueError."""
    try:
        numbers = np.array(seed if isinstance(seed, int | np.integer) else list(seed))
    except TypeError:
        numbers = np.array("")
    if numbers.dtype.kind not in "iu" or numbers.ndim > 1 or numbers.size == 0 or numbers.min() < 0:
        raise InvalidValueError(f"seed must be whole numbers from 0 on, got {seed!r}")
    seeds = [int(numbers) + w for w in worlds] if numbers.ndim == 0 else numbers.tolist()
    if len(seeds) != len(worlds):
        raise InvalidValueError(f"seed: give one number or {len(worlds)}, got {len(seeds)}")
    return seeds


def set_temperatures(
    first: np.ndarray, temperatures: Mapping[str, float | np.ndarray], names: Sequence[str]
) -> None:
    """Writes those of some objects, °C, into first (W, O). names: (O,). Raises InvalidValueError and
    UnknownNameError."""
    for name, value in temperatures.items():
        if name not in names:
            raise unknown_name("object", name, names)
        if np.shape(value) not in ((), (len(first),)):
            raise InvalidValueError(
                f"temperatures[{name!r}] must be one number or {len(first)}, got shape {np.shape(value)}"
            )
        for one in np.ravel(value).tolist():
            celsius(f"temperatures[{name!r}] (°C)", one)
        first[:, names.index(name)] = value


def checked_record(record: mujoco.MjData | np.ndarray, worlds: int, size: int) -> np.ndarray:
    """(W, substeps, size) numbers of recorded sensordata. Raises InvalidValueError."""
    if isinstance(record, mujoco.MjData):
        raise InvalidValueError("a ThermalTouch of many worlds reads recorded sensordata, not MjData")
    try:
        numbers = np.asarray(record)
    except ValueError:  # rows of different lengths
        numbers = np.array("")
    if numbers.dtype.kind not in "fiu":
        raise InvalidValueError(
            f"a record must hold sensordata, real numbers, got {type(record).__name__} of {numbers.dtype}"
        )
    found = np.ascontiguousarray(numbers, float)
    if found.ndim not in (2, 3):
        raise InvalidValueError(
            f"a record must have the shape (worlds, substeps, sensordata), got {found.shape}"
        )
    if (found.shape[0], found.shape[-1]) != (worlds, size):
        raise InvalidValueError(
            f"a record must hold the sensordata of {worlds} worlds, ({worlds}, {size}) of each substep, got shape "
            f"{found.shape}"
        )
    return found.reshape(worlds, -1, size)
