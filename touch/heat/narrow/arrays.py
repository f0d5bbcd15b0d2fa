"""spread.py's contacts narrower than the face as a pure function of arrays: NumPy, PyTorch, JAX.

B: rows, N: pairs, J: widths of a table, K: rates.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import NamedTuple

import numpy as np

from ....thermal.contact import NARROW
from ....thermal.numerics import Array, as_integers, as_like, namespace_of
from .array_shared import ArrayFaces, SharedFaces, root_of
from .tables import STEPS, between_steps


class NarrowSample(NamedTuple):
    """behind: K (B, N) that the states put against the flow over a step. series: K/W (B, N) in series with it. mutual:
    K/W (B, N, N) that the flows of one face do to one another, None where there is one object. sends: how flows are
    sent to the states, (B, N, K) for one object."""

    behind: Array
    series: Array
    mutual: Array | None
    sends: Array | SharedFaces


@dataclass(frozen=True, slots=True, eq=False)
class ArrayNarrow:
    """Narrow contacts in steps of dt s. tables: (U 2 2 J J, K) K/J and ripples: (U,) m2 K/W of narrow_tables, and
    numbers: (kinds, 3) integers of the sides', by kind of contact, and of the object's while the contact of number
    pressed_by (N,) touches it from behind. width: (N,) m of the sensors. kept: (K,), of a state after a step. grown:
    (K,) s, of a flow in a state after a step. mean: (K,), of a state over a step that it fades in. lag: (K,) s of a
    flow that has begun with the step, in the state's mean over it. faces: of the fingertips."""

    tables: Array
    ripples: Array
    numbers: Array
    pressed_by: Array
    width: Array
    kept: Array
    grown: Array
    mean: Array
    lag: Array
    faces: ArrayFaces

    def behind(
        self,
        states: Array,
        kind: Array,
        touching: Array,
        area: Array,
        length: Array,
        shares: Array,
        ripple: Array,
    ) -> NarrowSample:
        """What contacts of that kind (B, N) of integers that are touching (B, N), of area m2, length m and array_ripple
        (B, N), and shares (B, N, 4), have beyond those of the whole face that stay closed, with states (B, N, K)."""
        xp = namespace_of(area)
        sides, behind = self.numbers[kind], touching[:, self.pressed_by]
        sides = sides[..., 0], xp.where(behind, sides[..., 2], sides[..., 1])
        own, besides = self._squares(sides, area, length, shares)
        pulsed = (
            (self.ripples[sides[0]] + self.ripples[sides[1]]) * ripple / xp.where(area > 0, area, 1.0 + area)
        )
        if self.faces.objects == 1:
            squares = own + besides
            series, roots = (squares * self.lag).sum(-1) + pulsed, root_of(squares)
            return NarrowSample((roots * self.mean * states).sum(-1), series, None, roots)
        shared = self.faces.shared(touching, area, length, shares[..., :2], own, besides)
        series = shared.series(self.lag) + pulsed
        return NarrowSample(shared.behind(states, self.mean), series, shared.mutual(self.lag), shared)

    def after(self, states: Array, sample: NarrowSample, flow: Array) -> Array:
        """States (B, N, K) after a step with those flows W (B, N)."""
        sends = sample.sends
        taken = sends.sent(flow) if sample.mutual is not None else sends * flow[..., None]
        return self.kept * states + self.grown * taken

    def _squares(
        self, sides: tuple[Array, Array], area: Array, length: Array, shares: Array
    ) -> tuple[Array, Array]:
        """What spread.py's `spread` has of the fingertip's side, and of the other, squares; 0 where contacts are not
        narrow."""
        xp = namespace_of(area)
        width = self.width
        touching = area > 0
        whole = width + 0.0 * area
        safe, along = xp.where(touching, area, whole * width), xp.where(touching, length, whole)
        first = xp.minimum(safe / along, whole)
        second = xp.minimum(safe / first, whole)
        narrow = touching & (xp.minimum(first, second) < width * NARROW)
        (i, u), (j, v) = between_steps(xp, whole / first), between_steps(xp, whole / second)
        shares = shares.clip(0.0, 1.0)
        found = []
        for side in range(2):
            total = 0.0
            one, other = shares[..., 2 * side], shares[..., 2 * side + 1]
            begin = sides[side] * (4 * STEPS * STEPS) + i * STEPS + j
            for place in range(4):
                a, b = place & 1, place >> 1
                between = 0.0
                for c, d in ((0, 0), (0, 1), (1, 0), (1, 1)):
                    at = begin + ((2 * a + b) * STEPS + c) * STEPS + d
                    between = between + (_of(u, c) * _of(v, d))[..., None] * self.tables[at]
                # where the network of a narrow object knows more, it has none
                total = total + (_of(one, a) * _of(other, b))[..., None] * between.clip(0.0)
            found.append(xp.where(narrow[..., None], total, 0.0 * total))
        return found[0], found[1]


def _of(share, end):
    return share if end == 1 else 1 - share


def array_narrow(
    tables: np.ndarray,
    ripples: np.ndarray,
    numbers: np.ndarray,
    pressed_by: np.ndarray,
    width: np.ndarray,
    decay: np.ndarray,
    dt: float,
    modes: np.ndarray,
    like: Array,
) -> ArrayNarrow:
    """tables: (U, 2, 2, J, J, K), ripples: (U,) of narrow_tables, numbers: (kinds, 3) and pressed_by: (N,) as
    ArrayNarrow has them. width: (N,) m. decay: (K,) 1/s, the states' rates.
    modes: (F, MODES, MODES, K) of face_modes."""
    kept = np.exp(-dt * decay)
    grown = (1 - kept) / decay
    rows = tables.reshape(-1, tables.shape[-1])
    each = (as_like(part, like) for part in (width, kept, grown, grown / dt, (1 - grown / dt) / decay))
    sides = as_like(rows, like), as_like(ripples, like)
    told = (as_integers(as_like(part.astype(float), like)) for part in (numbers, pressed_by))
    objects = len(width) // len(modes)
    faces = ArrayFaces(as_like(modes, like), as_like(width[::objects], like), as_like(decay, like), objects)
    return ArrayNarrow(*sides, *told, *each, faces=faces)
