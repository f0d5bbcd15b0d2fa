"""narrow.py's contacts narrower than the face as a pure function of arrays: NumPy, PyTorch, JAX.

B: rows, N: pairs, J: widths of a table, K: rates.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from ...thermal.contact import NARROW
from ...thermal.numerics import Array, as_integers, as_like, namespace_of
from .narrow import STEPS


@dataclass(frozen=True, slots=True, eq=False)
class ArrayNarrow:
    """Narrow contacts in steps of dt s. tables: (U 2 2 J J, K) K/J and ripples: (U,) m2 K/W of narrow_tables, and
    numbers: (kinds, 2) integers of the sides', by kind of contact. width: (N,) m of the sensors. kept: (K,), of a state
    after a step. grown: (K,) s, of a flow in a state after a step. mean: (K,), of a state over a step that it fades in.
    lag: (K,) s of a flow that has begun with the step, in the state's mean over it."""

    tables: Array
    ripples: Array
    numbers: Array
    width: Array
    kept: Array
    grown: Array
    mean: Array
    lag: Array

    def behind(
        self, states: Array, kind: Array, area: Array, length: Array, shares: Array, ripple: Array
    ) -> tuple[Array, Array, Array]:
        """What contacts of that kind (B, N) of integers, area m2, length m and array_ripple (B, N), and shares
        (B, N, 4) have beyond those of the whole face that stay closed: the roots (B, N, K) by which they send and
        receive, K (B, N) that their states (B, N, K) put against the flow over a step, and K/W (B, N) in series with
        it."""
        xp = namespace_of(area)
        roots, faces = self._roots(kind, area, length, shares), self.ripples[self.numbers[kind]].sum(-1)
        pulsed = faces * ripple / xp.where(area > 0, area, 1.0 + area)
        return roots, (roots * self.mean * states).sum(-1), (roots * roots * self.lag).sum(-1) + pulsed

    def after(self, states: Array, roots: Array, flow: Array) -> Array:
        """States (B, N, K) after a step with those flows W (B, N)."""
        return self.kept * states + self.grown * roots * flow[..., None]

    def _roots(self, kind: Array, area: Array, length: Array, shares: Array) -> Array:
        """narrow.py's `spread`, 0 where contacts are not narrow."""
        xp = namespace_of(area)
        width = self.width
        touching = area > 0
        whole = width + 0.0 * area
        safe, along = xp.where(touching, area, whole * width), xp.where(touching, length, whole)
        first = xp.minimum(safe / along, whole)
        second = xp.minimum(safe / first, whole)
        narrow = touching & (xp.minimum(first, second) < width * NARROW)
        (i, u), (j, v) = _between(xp, whole / first), _between(xp, whole / second)
        shares = shares.clip(0.0, 1.0)
        total = 0.0
        for side in range(2):
            one, other = shares[..., 2 * side], shares[..., 2 * side + 1]
            begin = self.numbers[kind][..., side] * (4 * STEPS * STEPS) + i * STEPS + j
            for corner in range(16):
                a, b, c, d = corner & 1, corner >> 1 & 1, corner >> 2 & 1, corner >> 3
                weight = _of(one, a) * _of(other, b) * _of(u, c) * _of(v, d)
                at = begin + ((2 * a + b) * STEPS + c) * STEPS + d
                total = total + weight[..., None] * self.tables[at]
        return xp.where(narrow[..., None], total, 0.0 * total) ** 0.5


def _between(xp, ratio):
    steps = (2 * xp.log2(ratio)).clip(0.0, STEPS - 1.0)
    at = xp.floor(steps).clip(None, STEPS - 2.0)
    return as_integers(at), (2.0 ** ((steps - at) / 2) - 1) / (2.0**0.5 - 1)


def _of(share, end):
    return share if end == 1 else 1 - share


def array_narrow(
    tables: np.ndarray,
    ripples: np.ndarray,
    numbers: np.ndarray,
    width: np.ndarray,
    decay: np.ndarray,
    dt: float,
    like: Array,
) -> ArrayNarrow:
    """tables: (U, 2, 2, J, J, K), ripples: (U,) and numbers: (kinds, 2) of narrow_tables. width: (N,) m. decay: (K,)
    1/s, the states' rates."""
    kept = np.exp(-dt * decay)
    grown = (1 - kept) / decay
    rows = tables.reshape(-1, tables.shape[-1])
    each = (as_like(part, like) for part in (width, kept, grown, grown / dt, (1 - grown / dt) / decay))
    sides = as_like(rows, like), as_like(ripples, like)
    return ArrayNarrow(*sides, as_integers(as_like(numbers.astype(float), like)), *each)
