"""How often materials are told apart, beside the Bayes limit and learned rivals."""

from typing import TYPE_CHECKING

from thermograsp.doors import opened

if TYPE_CHECKING:
    from thermograsp.bench.identify.figure import draw
    from thermograsp.bench.identify.record import measured

__all__ = ["draw", "measured"]

__getattr__ = opened(__name__)
