"""How soon an agent knows a material, beside posteriors of the same samples, and what a decision to stop is worth."""

from typing import TYPE_CHECKING

from thermograsp.doors import opened

if TYPE_CHECKING:
    from thermograsp.bench.stopping.figure import draw
    from thermograsp.bench.stopping.record import measured

__all__ = ["draw", "measured"]

__getattr__ = opened(__name__)
