"""Heat fields of objects: passive networks that are seen through the places where an object has been touched.

n: states, M: patterns of a contact, N: places.
"""

from __future__ import annotations

from dataclasses import dataclass, field
from functools import lru_cache

import numpy as np
from threadpoolctl import ThreadpoolController

from ....thermal import Material, SensorStack, Solid, SurfacePatch
from ....thermal.kernels import Patches, Resolution, Tip, box_side
from ....thermal.numerics import ThermalNetwork
from ....thermal.padded import RINGS, box_in_pads
from ...scene import BodyShape, PadPlace
from .place import Place
from .tips import Rings, rings_of

_BLAS = ThreadpoolController()


@dataclass(frozen=True, slots=True, eq=False)
class BodyField:
    """An object's network of the places where it is touched. whole: of each place whether it has all ports, or the
    even one alone, which tells what flowed there a while ago, and zeros for the others. rates: (n,) 1/s.
    ports: (n, N M) sqrt(K/J). heat: (n,) J and loss: (n,) W of a state; only the first one, the mean temperature's, has
    any. beside: (n, N RINGS) ports under the pads around the elements, no columns where no fingertip has one. own: how
    many of the states, the first ones, are the object's wherever it is touched. below: of each place the share of the
    sensor's face under which the object is, and how thick m it is there."""

    places: tuple[Place, ...]
    whole: tuple[bool, ...]
    rates: np.ndarray
    ports: np.ndarray
    heat: np.ndarray
    loss: np.ndarray
    beside: np.ndarray = field(default_factory=lambda: np.zeros((0, 0)))
    own: int = 1
    below: tuple[tuple[float, float], ...] = ()

    def port(self, place: int, patterns: int) -> np.ndarray:
        """(n, M) of one place."""
        return self.ports[:, place * patterns : (place + 1) * patterns]

    def in_rings(self, place: int) -> np.ndarray:
        """(n, RINGS) of the pad around one place."""
        return self.beside[:, place * RINGS : (place + 1) * RINGS]


def untouched(shape: BodyShape, film: float) -> BodyField:
    """An object that nothing has touched: its mean temperature and no more. film: W/(m2 K) of the air."""
    capacity = shape.heat_capacity
    held = np.array([np.sqrt(capacity)])
    rate = np.array([film * shape.surface / capacity])
    return BodyField((), (), rate, np.zeros((1, 0)), held, held * rate)


def touched(
    shape: BodyShape,
    film: float,
    places: tuple[Place, ...],
    whole: tuple[bool, ...],
    pads: tuple[PadPlace, ...],
    tips: tuple[Tip, ...],
    level: Resolution,
    cache: bool,
) -> BodyField:
    """An object and its places. whole: as in BodyField. pads, tips: of all fingertips, by number. cache: keep on disk
    what takes long. The air takes heat from the object's mean temperature."""
    bare = untouched(shape, film)
    if shape.solid is not None:
        side, beside, own, below = _solid_side(shape, places, whole, pads, cache)
        # the body's mean, by its own heat capacity
        side.ports[0] *= side.outputs["heat"][0] / bare.heat[0]
        beside[0] *= side.outputs["heat"][0] / bare.heat[0]
    else:
        x, y, z = shape.size.tolist()
        at = tuple((place.face, place.middle) for place in places)
        seen = tuple(tips[place.fingertip] for place in places)
        around = tuple(rings_of(pads[place.fingertip]) for place in places)
        with _BLAS.limit(limits=1, user_api="blas"):
            side, beside = _side(shape.material, (x, y, z), at, whole, seen, around, level)
        widths = [pads[place.fingertip].stack.width for place in places]
        own = 1
        below = tuple(_under((x, y, z), place, width) for place, width in zip(places, widths, strict=True))
    rates = side.rates.copy()
    rates[0] = bare.rates[0]
    rest = np.zeros(len(rates) - 1)
    heat, loss = np.concatenate((bare.heat, rest)), np.concatenate((bare.loss, rest))
    return BodyField(places, whole, rates, side.ports, heat, loss, beside, own, below)


def _under(size: tuple[float, float, float], place: Place, width: float) -> tuple[float, float]:
    """The share of a face of that width m under which a box is, and how thick m it is there."""
    one, other = (side for axis, side in enumerate(size) if axis != place.face // 2)
    return min(one / width, 1.0) * min(other / width, 1.0), size[place.face // 2]


def _solid_side(
    shape: BodyShape,
    places: tuple[Place, ...],
    whole: tuple[bool, ...],
    pads: tuple[PadPlace, ...],
    cache: bool,
) -> tuple[ThermalNetwork, np.ndarray, int, tuple[tuple[float, float], ...]]:
    """As _side's, of a body of any shape; how many of its states are its own, how much of each face is on it, and how
    thick it is there."""
    from ....thermal.meshes import body_in_pads

    assert shape.solid is not None
    solid, (x, y, z) = shape.solid, shape.size.tolist()
    pad = pads[places[0].fingertip]
    with _BLAS.limit(limits=1, user_api="blas"):
        found = [_patch(solid, (x, y, z), place, pad.stack, cache) for place in places]
        patches, below = [patch for patch, _ in found], tuple(each for _, each in found)
        rings = rings_of(pad) or ()
        return *body_in_pads(solid, patches, pad.stack, rings, whole=whole, cache=cache), below


@lru_cache(maxsize=2048)
def _patch(
    solid: Solid, size: tuple[float, float, float], place: Place, stack: SensorStack, cache: bool
) -> tuple[SurfacePatch, tuple[float, float]]:
    """Of a sensor's face, on a body that is as large as that box; and the share of it where the body is, and how thick
    m it is there."""
    from ....thermal.meshes import surface_patch, wall_below

    outward, centre = np.zeros(3), np.zeros(3)
    axis, far = divmod(place.face, 2)
    outward[axis] = 1.0 if far else -1.0
    across_last = [*(i for i in range(3) if i != axis), axis]
    centre[across_last] = np.array(place.whole) - np.array(size)[across_last] / 2
    patch = surface_patch(solid, centre, outward, stack, cache=cache)
    return patch, wall_below(solid, patch)


@lru_cache(maxsize=512)
def _side(
    material: Material,
    size: tuple[float, float, float],
    at: tuple[tuple[int, tuple[float, float]], ...],
    whole: tuple[bool, ...],
    seen: tuple[Tip, ...],
    around: tuple[Rings | None, ...],
    level: Resolution,
) -> tuple[ThermalNetwork, np.ndarray]:
    """The network of a box of that material and size m with patches at those faces and middles; and its ports beside
    them."""
    half = np.empty((len(at), 2))
    for row, (face, _), tip_ in zip(half, at, seen, strict=True):
        others = [size[i] for i in range(3) if i != face // 2]
        row[:] = [min(np.sqrt(tip_.area), side) / 2 for side in others]
    patches = Patches(np.array([face for face, _ in at]), np.array([middle for _, middle in at]), half)
    if any(sides is not None for sides in around):
        return box_in_pads(material, size, patches, seen, around, level, whole)
    told = np.repeat(whole, level.patterns)
    told[:: level.patterns] = True
    side = box_side(material, size, 0.0, patches, seen, level, told)
    return side, np.zeros((len(side.rates), 0))
