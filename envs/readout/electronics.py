"""The fingertips' amplifiers, converters and lines, each environment with its own.

B: environments, F = 2 fingertips, N: samples of a control step.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np

from ...thermal import SignalChain
from ...thermal.readout import chain_numbers, measure_rows


@dataclass(frozen=True, slots=True)
class ElectronicsState:
    """The electronics' state of some environments; picklable. chains: CHAIN_NUMBERS records. filtered, last: (n, F) V
    of the low-pass. late: (n, L, F) V under way."""

    chains: np.ndarray
    filtered: np.ndarray
    last: np.ndarray
    late: np.ndarray


class Electronics:
    """The signal chains of a batch's fingertips. chain: what every environment's is at first. seebeck: V/K. dt: s
    between samples, `samples` of them in a control step. most_delay: samples by which an environment's may be late."""

    def __init__(
        self, num_envs: int, chain: SignalChain, seebeck: float, dt: float, samples: int, most_delay: int
    ) -> None:
        self._nominal = chain_numbers(chain, seebeck, dt)[0]
        self._chains = np.repeat(chain_numbers(chain, seebeck, dt), num_envs)
        self._filtered, self._last = np.zeros((num_envs, 2)), np.zeros((num_envs, 2))
        self._late = np.zeros((num_envs, most_delay, 2))
        self._noise = np.empty((num_envs, samples, 2))

    def reset(self, row: int, drawn: Mapping[str, float], rest: np.ndarray | float = 0.0) -> None:
        """Starts a row's with what randomization.draw has drawn for it, at rest. rest: V that the sensors send then."""
        self._filtered[row] = self._last[row] = self._late[row] = rest
        chain, nominal = self._chains[row], self._nominal
        chain["gain"] = nominal["gain"] * (1 + drawn["gain_error"])
        chain["offset"] = nominal["offset"] + drawn["offset_shift"]
        chain["noise"] = nominal["noise"] * drawn["noise_factor"]
        chain["delay"] = int(drawn["delay_samples"])

    def measure(self, drop: np.ndarray, rngs: Sequence[np.random.Generator]) -> np.ndarray:
        """Reported voltages (B, N, F) V of temperature drops (B, N, F) K, with noise from the environments' own
        generators."""
        for row, rng in enumerate(rngs):
            rng.standard_normal(out=self._noise[row])
        voltage = np.empty(drop.shape)
        measure_rows(self._chains, self._filtered, self._last, self._late, drop, self._noise, voltage)
        return voltage

    def state(self, rows: list[int]) -> ElectronicsState:
        """A copy of the rows' state."""
        return ElectronicsState(self._chains[rows], self._filtered[rows], self._last[rows], self._late[rows])

    def set_state(self, rows: list[int], state: ElectronicsState) -> None:
        """Puts the rows into a state taken by `state`."""
        self._chains[rows], self._filtered[rows] = state.chains, state.filtered
        self._last[rows], self._late[rows] = state.last, state.late
