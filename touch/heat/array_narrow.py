"""narrow.py's contacts narrower than the face as a pure function of arrays: NumPy, PyTorch, JAX.

B: rows, N: pairs, J: widths of a table, K: rates.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from ...thermal.numerics import Array, as_like, namespace_of


@dataclass(frozen=True, slots=True, eq=False)
class ArrayNarrow:
    """Narrow contacts in steps of dt s. tables: (kinds, 2, J, K) K/J of narrow_of, by kind of contact. width: (N,) m of
    the sensors. counts: (J,), 0, 1, 2... kept: (K,), of a state after a step. grown: (K,) s, of a flow in a state after
    a step. mean: (K,), of a state over a step that it fades in. lag: (K,) s of a flow that has begun with the step, in
    the state's mean over it."""

    tables: Array
    width: Array
    counts: Array
    kept: Array
    grown: Array
    mean: Array
    lag: Array

    def behind(self, states: Array, kind: Array, area: Array, length: Array) -> tuple[Array, Array, Array]:
        """What contacts of that kind (B, N) of integers, area m2 and length m (B, N) have beyond those of the whole
        face: the roots (B, N, K) by which they send and receive, K (B, N) that their states (B, N, K) put against the
        flow over a step, and K/W (B, N) in series with it."""
        roots = self._roots(kind, area, length)
        return roots, (roots * self.mean * states).sum(-1), (roots * roots * self.lag).sum(-1)

    def after(self, states: Array, roots: Array, flow: Array) -> Array:
        """States (B, N, K) after a step with those flows W (B, N)."""
        return self.kept * states + self.grown * roots * flow[..., None]

    def _roots(self, kind: Array, area: Array, length: Array) -> Array:
        """narrow.py's `spread`, 0 where contacts are not narrow."""
        xp = namespace_of(area)
        width, count = self.width, self.counts.shape[0]
        touching = area > 0
        whole = width + 0.0 * area
        safe, along = xp.where(touching, area, whole * width), xp.where(touching, length, whole)
        first = xp.minimum(safe / along, whole)
        second = safe / first
        short, long = xp.minimum(first, second), xp.minimum(xp.maximum(first, second), whole)
        narrow = touching & (short < width * (1 - 1e-9))
        short = xp.where(narrow, short, whole / 2)
        steps = (2 * xp.log2(width / short)).clip(None, count - 1.0)
        at = xp.floor(steps).clip(None, count - 2.0)
        of_squares = 2.0 ** (steps - at) - 1
        of_strips = (2.0 ** ((steps - at) / 2) - 1) / (2.0**0.5 - 1)
        wider = 2.0 ** (steps / 2) - 1
        square = ((width / long - 1) / xp.where(wider > 0, wider, 1.0 + wider)).clip(None, 1.0)
        here, next_ = (abs(self.counts - (at[..., None] + more)) < 0.5 for more in (0.0, 1.0))

        def between(share: Array) -> Array:
            """(B, N, J), what each width of the table counts."""
            none = 0.0 * share[..., None]
            return xp.where(here, 1 - share[..., None], none) + xp.where(next_, share[..., None], none)

        table = self.tables[kind]  # (B, N, 2, J, K)
        squares = (between(of_squares)[..., None] * table[..., 0, :, :]).sum(-2)
        strips = (between(of_strips)[..., None] * table[..., 1, :, :]).sum(-2)
        each = square[..., None] * squares + (1 - square[..., None]) * strips
        return xp.where(narrow[..., None], each, 0.0 * each) ** 0.5


def array_narrow(
    tables: np.ndarray, width: np.ndarray, decay: np.ndarray, dt: float, like: Array
) -> ArrayNarrow:
    """tables: (kinds, 2, J, K) of narrow_of. width: (N,) m. decay: (K,) 1/s, the states' rates."""
    kept = np.exp(-dt * decay)
    grown = (1 - kept) / decay
    numbers = (tables, width, np.arange(tables.shape[2]), kept, grown, grown / dt, (1 - grown / dt) / decay)
    return ArrayNarrow(*(as_like(each, like) for each in numbers))
