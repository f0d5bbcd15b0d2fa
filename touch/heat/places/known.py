"""Networks of a scene's objects, each made once."""

from __future__ import annotations

from collections.abc import Collection, Sequence

from ....thermal import Material
from ....thermal.kernels import Resolution, Tip
from ...scene import BodyShape, PadPlace
from .bodies import BodyField, touched, untouched
from .place import Place


class KnownFields:
    """Of objects of those shapes, touched by those pads of those tips. film: W/(m2 K) of the air. cache: keep on disk
    what takes long."""

    def __init__(
        self,
        shapes: Sequence[BodyShape],
        pads: tuple[PadPlace, ...],
        tips: tuple[Tip, ...],
        level: Resolution,
        film: float,
        cache: bool,
    ) -> None:
        self._shapes, self._pads, self._tips = shapes, pads, tips
        self._level, self._film, self._cache = level, film, cache
        self._known: dict[tuple[int, Material, tuple[Place, ...], tuple[bool, ...]], BodyField] = {}

    def __len__(self) -> int:
        return len(self._known)

    def field(
        self, o: int, material: Material, places: tuple[Place, ...], whole: tuple[bool, ...]
    ) -> BodyField:
        """Of object o, of that material, seen through those places, some of them wholly."""
        key = o, material, places, whole
        if key not in self._known:
            shape, of_tips = self._shapes[o].of(material), (self._pads, self._tips, self._level, self._cache)
            self._known[key] = (
                touched(shape, self._film, places, whole, *of_tips)
                if places
                else untouched(shape, self._film, self._cache)
            )
        return self._known[key]

    def bare(self, materials: Sequence[Material]) -> list[BodyField]:
        """Of objects of those materials that nothing has touched."""
        return [self.field(o, material, (), ()) for o, material in enumerate(materials)]

    def of(self, o: int, material: Material, saved: BodyField) -> BodyField:
        """The one that is known of these places, or the saved one, which is known from now on."""
        return self._known.setdefault((o, material, saved.places, saved.whole), saved)

    def forget(self, in_use: Collection[BodyField]) -> None:
        """Of touched objects those that are not in use."""
        self._known = {key: field for key, field in self._known.items() if field in in_use or not key[2]}
