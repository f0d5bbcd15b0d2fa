"""Heat fields of fingertips and objects as passive networks, and how an object's field survives a new place.

A fingertip's network is always that of its whole face, so that its field goes with it wherever it touches. An object's
network is seen through the places where it has been touched. A place that comes or goes changes its states, and the
field is carried along.

n: states, M: patterns of a contact, N: places.
"""

from __future__ import annotations

from dataclasses import dataclass, field, replace
from functools import lru_cache

import numpy as np
from threadpoolctl import ThreadpoolController

from ...thermal import Material, SensorStack, Solid, SurfacePatch
from ...thermal.kernels import Patches, Resolution, Tip, box_side, glued_element, tip
from ...thermal.numerics import ThermalNetwork
from ...thermal.padded import RINGS, PaddedTip, box_in_pads, padded_tip, ring_sides
from ..scene import BodyShape, PadPlace
from .march import ACROSS

NEAR = 0.25 + 1e-6
"""Of the sensor's width: a pad that is as near to a known place is on it. A little more than two steps of the grid
(march.py), so that round-off does not decide between places that are two steps apart."""
MOST_PLACES = 2
"""Of an object that are remembered besides those in use."""

_LEVELS = ((0.04, Resolution(8, 3)), (0.015, Resolution(12, 4)), (0.0, Resolution(18, 5)))
_PADDED_LEVELS = (
    (0.04, Resolution(12, 3, slowest=3e-3)),
    (0.015, Resolution(12, 4, slowest=3e-3)),
    (0.0, Resolution(18, 5, slowest=3e-3)),
)
"""The same where a fingertip has a pad, which touches more of an object: there heat stays for longer."""
_PADDED_MOMENTS = 12
AFTERWARDS = np.concatenate(([0.0], np.geomspace(3e-3, 100.0, 14)))  # s, over which a field is followed
_LEAST = 7e-4  # singular values below that share of the largest are left out
_LEAST_PORT = 0.03  # of the largest, below which a combination of flows is hardly seen
_GROWTH = 1.1  # times the norm of a field's states, the root of what they store: a new network has no more


def resolution(tolerance: float, padded: bool = False, solid: bool = False) -> Resolution:
    """Rates and patterns that are meant to keep a tolerance, K of temperature drop for a difference of 12 K. padded:
    whether a fingertip has a pad around its element. solid: whether an object is no box, which has one level."""
    if solid:
        from ...thermal.meshes import PLACED_LEVEL  # nothing that meshes need is loaded without them

        return PLACED_LEVEL
    levels = _PADDED_LEVELS if padded else _LEVELS
    return next(level for least, level in levels if tolerance >= least)


_BLAS = ThreadpoolController()

Rings = tuple[float, ...]
"""m, the outer sides of the rings of a pad."""


@dataclass(frozen=True, slots=True, eq=False)
class TipField:
    """A fingertip's or a glued element's network. tip: of its whole face. face: (n, M) sqrt(K/J), its ports for another
    fingertip that touches it. uniform: (n,) states of one that is 1 K warm throughout. padded: in its pad, whose heat
    the network has too; None for an element without one."""

    tip: Tip
    face: np.ndarray
    uniform: np.ndarray
    padded: PaddedTip | None = None


def tip_field(pad: PadPlace, level: Resolution) -> TipField:
    """The network of a fingertip's whole face, of an element that is glued on, or of a bare thermostat, which has no
    states and stays as warm as it is."""
    if pad.glued is not None:
        element = glued_element(pad.stack, level)
        return TipField(element.bond, element.top, element.uniform)
    if pad.surround is not None:
        padded = padded_tip(pad.stack, pad.surround, level, _PADDED_MOMENTS)
        return TipField(padded.tip, padded.tip.side.ports, padded.tip.uniform, padded)
    whole = (0.0, pad.stack.width)
    made = tip(pad.stack, (whole, whole), level)
    if pad.bare:
        none = np.zeros(0)
        made = replace(
            made,
            side=ThermalNetwork(none, np.zeros((0, level.patterns)), outputs={"drop": none, "element": none}),
        )
    return TipField(made, made.side.ports, made.uniform)


@dataclass(frozen=True, slots=True)
class Place:
    """Where a fingertip touches: a face of the object's box, 2 axis + side, the middle (2,) m along the other two axes
    from its corner, and the fingertip, by number. across: m from that corner along the face's axis, where the object is
    no box."""

    face: int
    middle: tuple[float, float]
    fingertip: int
    across: float = 0.0

    @property
    def whole(self) -> tuple[float, float, float]:
        """m along the face's axes and across it."""
        return (*self.middle, self.across)


@dataclass(frozen=True, slots=True, eq=False)
class BodyField:
    """An object's network of the places where it is touched. rates: (n,) 1/s. ports: (n, N M) sqrt(K/J). heat: (n,) J
    and loss: (n,) W of a state; only the first one, the mean temperature's, has any. beside: (n, N RINGS) ports
    under the pads around the elements, no columns where no fingertip has one. own: how many of the states, the first
    ones, are the object's wherever it is touched. covered: of each place the share of the sensor's face under which the
    object is; from less than all the network knows how heat spreads."""

    places: tuple[Place, ...]
    rates: np.ndarray
    ports: np.ndarray
    heat: np.ndarray
    loss: np.ndarray
    beside: np.ndarray = field(default_factory=lambda: np.zeros((0, 0)))
    own: int = 1
    covered: tuple[float, ...] = ()

    def port(self, place: int, patterns: int) -> np.ndarray:
        """(n, M) of one place."""
        return self.ports[:, place * patterns : (place + 1) * patterns]

    def in_rings(self, place: int) -> np.ndarray:
        """(n, RINGS) of the pad around one place."""
        return self.beside[:, place * RINGS : (place + 1) * RINGS]


def rings_of(pad: PadPlace) -> Rings | None:
    """Of the pad around a fingertip's element."""
    return None if pad.surround is None else ring_sides(pad.stack.width, pad.surround)


def near(one: Place, other: Place, reach: float) -> bool:
    """Whether two places of one fingertip are the same to it. reach: m."""
    distance = max(abs(a - b) for a, b in zip(one.middle, other.middle, strict=True))
    distance = max(distance, ACROSS * abs(one.across - other.across))
    return one.fingertip == other.fingertip and one.face == other.face and distance <= reach


def untouched(shape: BodyShape, film: float) -> BodyField:
    """An object that nothing has touched: its mean temperature and no more. film: W/(m2 K) of the air."""
    capacity = shape.heat_capacity
    held = np.array([np.sqrt(capacity)])
    rate = np.array([film * shape.surface / capacity])
    return BodyField((), rate, np.zeros((1, 0)), held, held * rate)


def touched(
    shape: BodyShape,
    film: float,
    places: tuple[Place, ...],
    pads: tuple[PadPlace, ...],
    tips: tuple[Tip, ...],
    level: Resolution,
    cache: bool,
) -> BodyField:
    """An object and its places. pads, tips: of all fingertips, by number. cache: keep on disk what takes long. The air
    takes heat from the object's mean temperature."""
    bare = untouched(shape, film)
    if shape.solid is not None:
        side, beside, own, covered = _solid_side(shape, places, pads, cache)
        # the body's mean, by its own heat capacity
        side.ports[0] *= side.outputs["heat"][0] / bare.heat[0]
        beside[0] *= side.outputs["heat"][0] / bare.heat[0]
    else:
        x, y, z = shape.size.tolist()
        at = tuple((place.face, place.middle) for place in places)
        seen = tuple(tips[place.fingertip] for place in places)
        around = tuple(rings_of(pads[place.fingertip]) for place in places)
        side, beside = _side(shape.material, (x, y, z), at, seen, around, level)
        widths = [pads[place.fingertip].stack.width for place in places]
        own = 1
        covered = tuple(_under((x, y, z), place, width) for place, width in zip(places, widths, strict=True))
    rates = side.rates.copy()
    rates[0] = bare.rates[0]
    rest = np.zeros(len(rates) - 1)
    heat, loss = np.concatenate((bare.heat, rest)), np.concatenate((bare.loss, rest))
    return BodyField(places, rates, side.ports, heat, loss, beside, own, covered)


def _under(size: tuple[float, float, float], place: Place, width: float) -> float:
    """The share of a face of that width m under which a box is."""
    one, other = (side for axis, side in enumerate(size) if axis != place.face // 2)
    return min(one / width, 1.0) * min(other / width, 1.0)


def _solid_side(
    shape: BodyShape, places: tuple[Place, ...], pads: tuple[PadPlace, ...], cache: bool
) -> tuple[ThermalNetwork, np.ndarray, int, tuple[float, ...]]:
    """As _side's, of a body of any shape; how many of its states are its own, and how much of each
    face is on it."""
    from ...thermal.meshes import body_in_pads

    assert shape.solid is not None
    solid, (x, y, z) = shape.solid, shape.size.tolist()
    pad = pads[places[0].fingertip]
    with _BLAS.limit(limits=1, user_api="blas"):
        found = [_patch(solid, (x, y, z), place, pad.stack, cache) for place in places]
        patches, covered = [patch for patch, _ in found], tuple(share for _, share in found)
        return *body_in_pads(solid, patches, pad.stack, rings_of(pad) or (), cache=cache), covered


@lru_cache(maxsize=2048)
def _patch(
    solid: Solid, size: tuple[float, float, float], place: Place, stack: SensorStack, cache: bool
) -> tuple[SurfacePatch, float]:
    """Of a sensor's face, on a body that is as large as that box; and the share of it where the body is."""
    from ...thermal.meshes import covered_share, surface_patch

    outward, centre = np.zeros(3), np.zeros(3)
    axis, far = divmod(place.face, 2)
    outward[axis] = 1.0 if far else -1.0
    across_last = [*(i for i in range(3) if i != axis), axis]
    centre[across_last] = np.array(place.whole) - np.array(size)[across_last] / 2
    patch = surface_patch(solid, centre, outward, stack, cache=cache)
    return patch, covered_share(solid, patch)


@lru_cache(maxsize=2048)
def _side(
    material: Material,
    size: tuple[float, float, float],
    at: tuple[tuple[int, tuple[float, float]], ...],
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
        return box_in_pads(material, size, patches, seen, around, level)
    side = box_side(material, size, 0.0, patches, seen, level)
    return side, np.zeros((len(side.rates), 0))


@lru_cache(maxsize=1024)
def carried(before: BodyField, after: BodyField, patterns: int) -> np.ndarray:
    """(n after, n before): the field on the states of a network with other places.

    The field on the new states is the one that the places of both will see alike from then on, left alone: their
    temperatures at AFTERWARDS, by least squares. What the object has of its own stays as it is, and so does heat: it is
    all in the mean temperature's state.
    Singular values count the less the nearer they are to those that are left out: round-off decides nothing."""
    own = min(before.own, after.own)
    matrix = np.zeros((len(after.rates), len(before.rates)))
    matrix[:own, :own] = np.eye(own)
    common = [place for place in before.places if place in after.places]
    if not common:
        return matrix
    if own > 1:
        matrix[own:, own:] = _by_rates(before, after, common, patterns)
        return matrix
    source, target = (_future(field, common, patterns) for field in (before, after))
    with _BLAS.limit(limits=1, user_api="blas"):  # or the number of threads would decide last bits
        left, values, right = np.linalg.svd(target, full_matrices=False)
    kept = values > _LEAST * values[0]
    share = (1 - (_LEAST * values[0] / values[kept]) ** 2) / values[kept]
    matrix[1:, 1:] = (right[kept].T * share) @ (left[:, kept].T @ source)
    return matrix


def _by_rates(before: BodyField, after: BodyField, common: list[Place], patterns: int) -> np.ndarray:
    """(n after, n before) of what fades sooner than the states that an object has wherever it is touched: at the same
    rates whatever the places are, so that the states of one rate tell what the common places see of it."""
    old, new = (field.rates[field.own :] for field in (before, after))
    seen, wanted = (_seen(field, common, patterns)[:, field.own :] for field in (before, after))
    found = np.zeros((len(new), len(old)))
    for rate in np.unique(new):
        was, now = np.flatnonzero(old == rate), np.flatnonzero(new == rate)
        if len(was):
            found[np.ix_(now, was)] = np.linalg.pinv(wanted[:, now], rcond=_LEAST_PORT) @ seen[:, was]
    return found


def carried_states(before: BodyField, after: BodyField, patterns: int, states: np.ndarray) -> np.ndarray:
    """(n after,) the field of those states (n before,), on the states of a network with other places.

    The sum of their squares is what a passive network stores, which nothing but heat from outside makes grow. Networks
    with few states tell a field a little differently, but least squares may let it grow from place to place without
    end. Where the states but the mean would grow by more than _GROWTH, they are made smaller."""
    found = carried(before, after, patterns) @ states
    stored, now = float(np.linalg.norm(states[1:])), float(np.linalg.norm(found[1:]))
    if now > _GROWTH * stored:
        found[1:] *= _GROWTH * stored / now
    return found


def _seen(field: BodyField, common: list[Place], patterns: int) -> np.ndarray:
    """(temperatures, n) of the places' patterns and rings."""
    at = [field.places.index(place) for place in common]
    seen = [field.port(place, patterns) for place in at]
    if field.beside.size:
        seen += [field.in_rings(place) for place in at]
    return np.concatenate(seen, axis=1).T


def _future(field: BodyField, common: list[Place], patterns: int) -> np.ndarray:
    """(temperatures, n - 1) of the places' patterns at AFTERWARDS, each weighted by the time that it stays."""
    ports = _seen(field, common, patterns).T[1:]
    faded = np.exp(-np.outer(field.rates[1:], AFTERWARDS)) * np.sqrt(np.maximum(AFTERWARDS, AFTERWARDS[1]))
    return (ports[:, :, None] * faded[:, None, :]).reshape(len(ports), -1).T
