"""Work and precision of a grasp under MuJoCo's settings."""

from typing import TYPE_CHECKING

from thermograsp.doors import opened

if TYPE_CHECKING:
    from thermograsp.bench.grasp.figure import draw
    from thermograsp.bench.grasp.record import measured

__all__ = ["draw", "measured"]

__getattr__ = opened(__name__)
