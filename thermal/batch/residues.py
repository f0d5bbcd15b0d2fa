"""Networks whose states fade at rates that all networks share: the states of a rate add up.

K: rates, n: states, C: columns.
"""

from __future__ import annotations

import numpy as np


def summed(rates: np.ndarray, columns: np.ndarray, shared: np.ndarray) -> np.ndarray:
    """(K, C): sums of columns (n, C) over the states that fade at each of the shared rates (K,), ascending. Raises
    ValueError for one that fades at another."""
    which = np.minimum(np.searchsorted(shared, rates), len(shared) - 1)
    if not np.array_equal(shared[which], rates):
        raise ValueError(f"rates {rates[shared[which] != rates]} 1/s are not among the shared ones")
    found = np.zeros((len(shared), columns.shape[1]))
    np.add.at(found, which, columns)
    return found
