"""The cost of simulated time against the error of the voltage."""

from typing import TYPE_CHECKING

from thermograsp.doors import opened

if TYPE_CHECKING:
    from thermograsp.bench.episode.figure import draw
    from thermograsp.bench.episode.record import measured

__all__ = ["draw", "measured"]

__getattr__ = opened(__name__)
