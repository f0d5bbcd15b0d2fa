"""Contact temperatures beside a peer's published ones."""

from typing import TYPE_CHECKING

from thermograsp.doors import opened

if TYPE_CHECKING:
    from thermograsp.bench.peer.figure import draw
    from thermograsp.bench.peer.record import measured

__all__ = ["draw", "measured"]

__getattr__ = opened(__name__)
