"""Which tables of narrow contacts the pairs of all worlds have.

W: worlds, L: sensors and the rings of the pads around them, T: targets.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from ....thermal import Material
from ....thermal.kernels import Resolution
from ...scene import PadPlace
from .tables import narrow_table, rippling
from .walls import Beside, Pinched, Side, Wall, narrow_sides, widths_of


class NarrowPairs:
    """tables: of tables.py, as many as there are and room for more, and ripples: m2 K/W of the same sides. kinds: (W,
    L, T, 2) the numbers of those of both sides of a contact. rings: (L - F, moments) K/W of each. widths: (L,) m."""

    def __init__(
        self,
        pads: Sequence[PadPlace],
        rings: Sequence[Sequence[float]],
        widths: np.ndarray,
        level: Resolution,
        worlds: int,
        targets: int,
        dt: float,
    ) -> None:
        self._pads, self._rings, self._widths, self._level = tuple(pads), tuple(rings), widths, level
        self._dt = dt
        self._numbers: dict[tuple[Side, float], int] = {}
        self.tables = narrow_table((None, 0.0), 0.0, level)[None]
        self.ripples = np.zeros(1)
        self.kinds = np.zeros((worlds, len(widths), targets, 2), np.int64)

    def forget(self) -> None:
        """All tables are numbered anew; `know` of every world must follow."""
        self._numbers.clear()

    def know(self, w: int, materials: tuple[Material, ...]) -> None:
        """What a world's objects are made of."""
        for f, pad in enumerate(self._pads):
            for t, target in enumerate((*map(Wall, materials), *self._pads)):
                sides = zip(narrow_sides(pad, target), widths_of(pad, target), strict=True)
                self.kinds[w, f, t] = [self._number(*side) for side in sides]
        for lane, impedance in enumerate(self._rings, len(self._pads)):
            width = float(self._widths[lane])
            self.kinds[w, lane, :, 0] = self._number((Beside(tuple(impedance)), 0.0), width)
            # the object has a patch of what the ring covers
            self.kinds[w, lane, :, 1] = self._number((None, 0.0), width)

    def spread(self, w: int, f: int, o: int, wall: Wall | Pinched) -> None:
        """What the object of a pair spreads heat as."""
        self.kinds[w, f, o, 1] = self._number(narrow_sides(self._pads[f], wall)[1], self._pads[f].stack.width)

    def _number(self, side: Side, width: float) -> int:
        key = side, width
        if key not in self._numbers:
            number = self._numbers[key] = len(self._numbers)
            if number == len(self.tables):
                self.tables = np.concatenate((self.tables, np.zeros_like(self.tables)))
                self.ripples = np.concatenate((self.ripples, np.zeros_like(self.ripples)))
            self.tables[number] = narrow_table(side, width, self._level)
            self.ripples[number] = rippling(side, self._dt)
        return self._numbers[key]
