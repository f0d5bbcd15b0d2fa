"""The speed of the environments beside bare MuJoCo."""

from typing import TYPE_CHECKING

from thermograsp.doors import opened

if TYPE_CHECKING:
    from thermograsp.bench.speed.figure import draw
    from thermograsp.bench.speed.record import measured

__all__ = ["draw", "measured"]

__getattr__ = opened(__name__)
