"""The electronics of signal.py compiled row by row, for batches that are too small for NumPy's calls.

B: rows, F: fingertips, n: samples.
"""

from __future__ import annotations

import numba
import numpy as np

from thermograsp.compiled import njit

from .signal import SignalChain

_NAMES = ("seebeck", "lag", "decay", "noise", "offset", "gain", "resolution", "low", "high")
CHAIN_NUMBERS = np.dtype([*((name, "f8") for name in _NAMES), ("delay", "i8")])
"""V/K; time constant over dt; V; V; V/V; V; V; V; samples by which a voltage is reported late."""


def chain_numbers(chain: SignalChain, seebeck: float, dt: float) -> np.ndarray:
    """What a sample needs of a chain, a Seebeck coefficient V/K and a period s, as one CHAIN_NUMBERS record (1,),
    without delay."""
    lag = 0.0 if np.isinf(chain.bandwidth) else 1 / (2 * np.pi * chain.bandwidth)
    decay = float(np.exp(-dt / lag)) if lag else 0.0
    numbers = (
        *(seebeck, lag / dt, decay, chain.noise, chain.offset, 1 + chain.gain_error, chain.resolution),
        *(*chain.limits, 0),
    )
    return np.array([numbers], CHAIN_NUMBERS)


@njit(cache=True, borrows=True, error_model="numpy")
def measure_rows(chains, filtered, last, late, drop, noise, voltage):
    """signal.measure for many rows with chains (B,) CHAIN_NUMBERS of their own: fills voltage (B, n, F) V from drop (B,
    n, F) K and noise (B, n, F), standard normal. The low-pass's filtered and last (B, F) V and the voltages under way,
    late (B, L, F) V, of which a row uses its delay's first, go on in place."""
    for b in range(drop.shape[0]):
        chain = chains[b]
        for f in range(drop.shape[2]):
            for i in range(drop.shape[1]):
                volts = drop[b, i, f] * chain.seebeck
                slope_lag = (volts - last[b, f]) * chain.lag
                filtered[b, f] = volts - slope_lag + (filtered[b, f] - last[b, f] + slope_lag) * chain.decay
                last[b, f] = volts
                seen = (filtered[b, f] + noise[b, i, f] * chain.noise + chain.offset) * chain.gain
                if chain.resolution > 0:
                    seen = np.rint(seen / chain.resolution) * chain.resolution
                seen = min(max(seen, chain.low), chain.high)
                if chain.delay > 0:
                    arriving = late[b, 0, f]
                    for k in range(chain.delay - 1):
                        late[b, k, f] = late[b, k + 1, f]
                    late[b, chain.delay - 1, f] = seen
                    seen = arriving
                voltage[b, i, f] = seen


def compile_measuring() -> None:
    """Compiles measure_rows as Python calls it."""
    chains, matrix = numba.typeof(np.zeros(1, CHAIN_NUMBERS)), numba.types.float64[:, ::1]
    cube = numba.types.float64[:, :, ::1]
    measure_rows.compile((chains, matrix, matrix, cube, cube, cube, cube))
