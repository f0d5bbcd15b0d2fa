"""Where the time steps of a contact are stable."""

from typing import TYPE_CHECKING

from thermograsp.doors import opened

if TYPE_CHECKING:
    from thermograsp.bench.stability.figure import draw
    from thermograsp.bench.stability.record import measured

__all__ = ["draw", "measured"]

__getattr__ = opened(__name__)
