"""Heat fields of objects: passive networks that are seen through the places where an object has been touched.

n: states, M: patterns of a contact, N: places.
"""

from __future__ import annotations

from dataclasses import dataclass, field, replace
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
_IN_AIR = 0.5  # of a sheet's faces, where a fingertip touches one of them


@dataclass(frozen=True, slots=True, eq=False)
class BodyField:
    """An object's network of the places where it is touched. whole: of each place whether it has all ports, or the
    even one alone, which tells what flowed there a while ago, and zeros for the others. rates: (n,) 1/s.
    ports: (n, N M) sqrt(K/J). heat: (n,) J and loss: (n,) W of a state; only the first one, the mean temperature's, has
    any. beside: (n, N RINGS) ports under the pads around the elements, no columns where no fingertip has one. modal:
    how many of the states, the first ones, are the object's wherever it is touched. below: of each place the share of
    the sensor's face under which the object is, and how thick m it is there. walls: (modal, modal) 1/s, of an object
    with contents that nothing has touched: how its own states fade towards contents that are held, by the film
    alone."""

    places: tuple[Place, ...]
    whole: tuple[bool, ...]
    rates: np.ndarray
    ports: np.ndarray
    heat: np.ndarray
    loss: np.ndarray
    beside: np.ndarray = field(default_factory=lambda: np.zeros((0, 0)))
    modal: int = 1
    below: tuple[tuple[float, float], ...] = ()
    walls: np.ndarray = field(default_factory=lambda: np.zeros((0, 0)))

    def port(self, place: int, patterns: int) -> np.ndarray:
        """(n, M) of one place."""
        return self.ports[:, place * patterns : (place + 1) * patterns]

    def in_rings(self, place: int) -> np.ndarray:
        """(n, RINGS) of the pad around one place."""
        return self.beside[:, place * RINGS : (place + 1) * RINGS]


def levelled(rates: np.ndarray, loss: np.ndarray | float, crossing: np.ndarray | float) -> np.ndarray:
    """(n,) 1/s at which states of these rates fade that the air levels too. loss: 1/s of the mean temperature;
    crossing: of heat from face to face. In a sheet the air takes from each place by its own temperature, on the face
    that no fingertip covers; what fades before it has crossed the object does not come to that face. These states hold
    no heat in all, so that none is lost: the mean temperature's alone gives to the air."""
    return rates + _IN_AIR * loss / (1 + rates / crossing)


def crossing_rate(shape: BodyShape) -> float:
    """1/s: diffusivity over the square of a sheet's thickness, which is twice volume over surface."""
    matter = shape.material
    thickness = 2 * shape.heat_capacity / matter.volumetric_heat_capacity / shape.surface
    return matter.conductivity / matter.volumetric_heat_capacity / thickness**2


def untouched(shape: BodyShape, film: float, cache: bool = True) -> BodyField:
    """An object that nothing has touched: its mean temperature, and where contents wet its walls what else is its own.
    film: W/(m2 K) of the air."""
    capacity, inside = shape.heat_capacity, shape.contents
    held = np.array([np.sqrt(capacity)])
    rate = np.array([film * shape.surface / capacity])
    bare = BodyField((), (), rate, np.zeros((1, 0)), held, held * rate)
    if inside is None:
        return bare
    if shape.solid is not None:
        found = _filled_field(
            shape.solid, float(held[0]), float(rate[0]), crossing_rate(shape), inside.conductance, cache
        )
        if found is not None:
            return found
    return replace(bare, walls=np.array([[inside.conductance / capacity]]))


@lru_cache(maxsize=512)
def _filled_field(
    solid: Solid, held: float, rate: float, crossing: float, wet: float, cache: bool
) -> BodyField | None:
    """Of a body with contents behind walls that conduct W/K to them; None where it has no hollow."""
    from ....thermal.anywhere import own_network

    with _BLAS.limit(limits=1, user_api="blas"):  # or the number of threads would decide last bits
        network = own_network(solid, wet, cache=cache)
    outputs = network.outputs
    film_rows = [row for name, row in outputs.items() if name.startswith("film:")]
    if not film_rows:
        return None
    rows, none = np.stack(film_rows), np.zeros((len(network.rates), 0))
    rows[:, 0] *= outputs["heat"][0] / held  # the body's mean, by its own heat capacity
    found = _with_mean(held, rate, crossing, (), (), network, none, len(network.rates), ())
    return replace(found, walls=wet * rows.T @ rows)


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
    what takes long. The air takes heat from the object's mean temperature, and levels the rest (`levelled`)."""
    bare = untouched(replace(shape, contents=None), film)
    x, y, z = shape.size.tolist()
    held, rate, crossing = float(bare.heat[0]), float(bare.rates[0]), crossing_rate(shape)
    around = tuple(rings_of(pads[place.fingertip]) for place in places)
    if shape.solid is not None:
        stack, inside = pads[places[0].fingertip].stack, shape.contents
        wet = 0.0 if inside is None else inside.conductance
        rings = around[0] or ()
        return _solid_field(
            shape.solid, (x, y, z), held, rate, crossing, places, whole, stack, rings, wet, cache
        )
    seen = tuple(tips[place.fingertip] for place in places)
    widths = tuple(pads[place.fingertip].stack.width for place in places)
    return _box_field(
        shape.material, (x, y, z), held, rate, crossing, places, whole, seen, around, widths, level
    )


@lru_cache(maxsize=512)
def _box_field(
    material: Material,
    size: tuple[float, float, float],
    held: float,
    rate: float,
    crossing: float,
    places: tuple[Place, ...],
    whole: tuple[bool, ...],
    seen: tuple[Tip, ...],
    around: tuple[Rings | None, ...],
    widths: tuple[float, ...],
    level: Resolution,
) -> BodyField:
    """Of a box of that material and size m. held, rate: an untouched one's. seen: the tips at the places, of those
    widths m, with such pads around them."""
    with _BLAS.limit(limits=1, user_api="blas"):
        side, beside = _side(material, size, places, whole, seen, around, level)
    below = tuple(_under(size, place, width) for place, width in zip(places, widths, strict=True))
    return _with_mean(held, rate, crossing, places, whole, side, beside, 1, below)


@lru_cache(maxsize=512)
def _solid_field(
    solid: Solid,
    size: tuple[float, float, float],
    held: float,
    rate: float,
    crossing: float,
    places: tuple[Place, ...],
    whole: tuple[bool, ...],
    stack: SensorStack,
    rings: Rings,
    wet: float,
    cache: bool,
) -> BodyField:
    """The same of a body of any shape, which is as large as that box. rings: around all sensors. wet: W/K to its
    contents."""
    from ....thermal.anywhere import body_in_pads

    with _BLAS.limit(limits=1, user_api="blas"):
        found = [_patch(solid, size, place, stack, wet, cache) for place in places]
        patches, below = [patch for patch, _ in found], tuple(each for _, each in found)
        side, beside, modal = body_in_pads(solid, patches, stack, rings, whole=whole, film=wet, cache=cache)
    # the body's mean, by its own heat capacity
    side.ports[0] *= side.outputs["heat"][0] / held
    beside[0] *= side.outputs["heat"][0] / held
    return _with_mean(held, rate, crossing, places, whole, side, beside, modal, below)


def _with_mean(
    held: float,
    rate: float,
    crossing: float,
    places: tuple[Place, ...],
    whole: tuple[bool, ...],
    side: ThermalNetwork,
    beside: np.ndarray,
    modal: int,
    below: tuple[tuple[float, float], ...],
) -> BodyField:
    """The mean temperature's state is as that of an object that nothing has touched."""
    rates = levelled(side.rates, rate, crossing)
    heat, loss = np.zeros(len(rates)), np.zeros(len(rates))
    rates[0], heat[0], loss[0] = rate, held, held * rate
    return BodyField(places, whole, rates, side.ports, heat, loss, beside, modal, below)


def _under(size: tuple[float, float, float], place: Place, width: float) -> tuple[float, float]:
    """The share of a face of that width m under which a box is, and how thick m it is there."""
    one, other = (side for axis, side in enumerate(size) if axis != place.face // 2)
    return min(one / width, 1.0) * min(other / width, 1.0), size[place.face // 2]


@lru_cache(maxsize=2048)
def _patch(
    solid: Solid, size: tuple[float, float, float], place: Place, stack: SensorStack, wet: float, cache: bool
) -> tuple[SurfacePatch, tuple[float, float]]:
    """Of a sensor's face, on a body that is as large as that box; and the share of it where the body is, and how thick
    m it is there. wet: W/K to its contents."""
    from ....thermal.anywhere import surface_patch, wall_below

    outward, centre = np.zeros(3), np.zeros(3)
    axis, far = divmod(place.face, 2)
    outward[axis] = 1.0 if far else -1.0
    across_last = [*(i for i in range(3) if i != axis), axis]
    centre[across_last] = np.array(place.whole) - np.array(size)[across_last] / 2
    patch = surface_patch(solid, centre, outward, stack, wet, cache=cache)
    return patch, wall_below(solid, patch)


def _side(
    material: Material,
    size: tuple[float, float, float],
    places: tuple[Place, ...],
    whole: tuple[bool, ...],
    seen: tuple[Tip, ...],
    around: tuple[Rings | None, ...],
    level: Resolution,
) -> tuple[ThermalNetwork, np.ndarray]:
    """The network of a box with patches at those places; and its ports beside them."""
    half = np.empty((len(places), 2))
    for row, place, tip_ in zip(half, places, seen, strict=True):
        others = [size[i] for i in range(3) if i != place.face // 2]
        row[:] = [min(np.sqrt(tip_.area), side) / 2 for side in others]
    faces, middles = (np.array([getattr(place, each) for place in places]) for each in ("face", "middle"))
    patches = Patches(faces, middles, half)
    if any(sides is not None for sides in around):
        return box_in_pads(material, size, patches, seen, around, level, whole)
    side = box_side(material, size, 0.0, patches, seen, level, whole)
    return side, np.zeros((len(side.rates), 0))
