"""Work and precision of a press, by every method."""

from typing import TYPE_CHECKING

from thermograsp.doors import opened

if TYPE_CHECKING:
    from thermograsp.bench.accuracy.figure import draw
    from thermograsp.bench.accuracy.record import measured

__all__ = ["draw", "measured"]

__getattr__ = opened(__name__)
