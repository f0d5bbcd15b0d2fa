"""Where on an object's surface fingertips touch it: patches found by position, as they come.

F: fingertips. Places are in m, in the object's frame.
"""

from __future__ import annotations

import logging
import math
import warnings
from dataclasses import dataclass, replace
from functools import lru_cache

import numpy as np

from thermograsp.errors import MeshError

from ...thermal import (
    Demand,
    SensorStack,
    Solid,
    SurfacePatch,
)
from ...thermal.anywhere import PLACED_SHARE, placed_body
from ...thermal.meshes import (
    TouchedBody,
    field_carried,
    surface_normal,
    touched_body,
    wetted_area,
)
from ..footprint import GraspBody

LATTICE = 0.003  # m, on which later patches are placed, so that touches nearly alike share a network
MOST_PATCHES = 5
_UPRIGHT = math.cos(math.radians(10.0))  # a surface this near to an axis is taken as across it
_KEPT = 256

_LOG = logging.getLogger(__name__)


@dataclass(frozen=True, slots=True)
class Touches:
    """The patches of one grasp on an object of any shape. grasped: the object. body: its network and its patches.
    contacts: (F,) the patch that each fingertip is on or was on last. demand: what the network was made for. film: W/K
    between it and its contents, 0 for none. cache: keep networks on disk."""

    grasped: GraspBody
    body: TouchedBody
    contacts: tuple[int, ...]
    demand: Demand
    film: float
    cache: bool

    @property
    def fed(self) -> bool:
        """Whether its contents feed it through the walls of a hollow."""
        return self.body.hollow

    def at(self, patches: tuple[SurfacePatch, ...], contacts: tuple[int, ...]) -> Touches:
        """The same object with these patches and contacts. Raises MeshError where a patch meets no surface."""
        body = self.body
        if patches != body.patches:
            body = _body(
                _solid(self.grasped),
                patches,
                self.grasped.stack,
                self.demand,
                len(contacts),
                self.film,
                self.cache,
            )
        return replace(self, body=body, contacts=contacts)

    def moved(self, fingertip: int, place: np.ndarray) -> Touches:
        """The fingertip touches at the place: on a patch known within half a face of there, or else on a new one. Where
        a new one meets no surface it stays on its last. The longest known patch that no other fingertip is on goes
        where there would be too many."""
        away = np.sqrt(((self.body.centres - place) ** 2).sum(axis=1))
        contacts = list(self.contacts)
        nearest = int(np.argmin(away))
        if away[nearest] <= self.grasped.stack.width / 2:
            contacts[fingertip] = nearest
            return replace(self, contacts=tuple(contacts))
        patches = list(self.body.patches)
        if len(patches) >= MOST_PATCHES:
            others = {contact for tip, contact in enumerate(contacts) if tip != fingertip}
            gone = next(number for number in range(len(patches)) if number not in others)
            del patches[gone]
            contacts = [contact - (contact > gone) for contact in contacts]
        contacts[fingertip] = len(patches)
        patches.append(_touched(_solid(self.grasped), place, patches[0].area))
        try:
            return self.at(tuple(patches), tuple(contacts))
        except MeshError as error:
            _LOG.info("the touch before stands for one at %s m: %s", place, error)
            return self

    def field_from(self, last: Touches) -> np.ndarray:
        """Matrix that takes the object's field from the network of earlier touches to this one; see field_carried."""
        return _carried(last.body, self.body)


def first_touches(grasped: GraspBody, demand: Demand, cache: bool) -> Touches | None:
    """The Touches with a patch where each fingertip is to meet the object; None, with a RuntimeWarning that says why,
    where no network can be made with these (a ring's hole, pieces that share but an edge), so that a plate stands for
    the object. Raises MeshError there for one with parts, which no plate can stand for."""
    contacts = tuple(range(grasped.fingertips))
    patches = tuple(_grasped(grasped, side) for side in (-1, 1)[: grasped.fingertips])
    film = grasped.spec.reservoir.conductance if grasped.spec.reservoir else 0.0
    try:
        body = _body(_solid(grasped), patches, grasped.stack, demand, grasped.fingertips, film, cache)
    except MeshError as error:
        if grasped.spec.parts:
            raise
        warnings.warn(
            f"object {grasped.spec.name!r}: {error}. A plate of the same volume stands for it, which is touched "
            "wherever a pad presses",
            RuntimeWarning,
            stacklevel=2,
        )
        return None
    return Touches(grasped, body, contacts, demand, film, cache)


@lru_cache(maxsize=_KEPT)
def _carried(source: TouchedBody, target: TouchedBody) -> np.ndarray:
    return field_carried(source, target)


@lru_cache(maxsize=_KEPT)
def _body(
    body: Solid,
    patches: tuple[SurfacePatch, ...],
    stack: SensorStack,
    demand: Demand,
    fingertips: int,
    film: float,
    cache: bool,
) -> TouchedBody:
    if (film and wetted_area(body)) or demand.tolerance >= PLACED_SHARE * abs(demand.difference):
        return placed_body(
            body, patches, stack, demand.difference, fingertips=fingertips, film=film, cache=cache
        )
    return touched_body(body, patches, stack, demand, fingertips=fingertips, cache=cache)


def _solid(grasped: GraspBody) -> Solid:
    assert grasped.solid is not None
    return grasped.solid


def _grasped(grasped: GraspBody, side: int) -> SurfacePatch:
    """Where the left (-1) or the right (1) fingertip of a gripper over the origin meets the object: the outermost
    surface along the line on which the fingers close."""
    spec = grasped.spec
    cos, sin = math.cos(spec.yaw), math.sin(spec.yaw)
    x, y = spec.position
    beyond = sum(spec.size)
    along = _clean(side * cos), _clean(-side * sin), 0.0
    middle = -x * cos - y * sin, x * sin - y * cos
    height = spec.grasp_height - spec.size[2] / 2
    return SurfacePatch(
        (middle[0] + beyond * along[0], middle[1] + beyond * along[1], height), along, grasped.geometry.area
    )


def _touched(body: Solid, place: np.ndarray, area: float) -> SurfacePatch:
    """The patch on the surface nearest to a place, on the lattice."""
    outward = surface_normal(body, place)
    axis = int(np.argmax(np.abs(outward)))
    if abs(outward[axis]) > _UPRIGHT:
        outward = np.sign(outward[axis]) * np.eye(3)[axis]
    x, y, z = (LATTICE * round(value / LATTICE) for value in place.tolist())
    along_x, along_y, along_z = outward.tolist()
    return SurfacePatch((x, y, z), (along_x, along_y, along_z), area)


def _clean(value: float) -> float:
    """0 where rounding left nearly 0."""
    return 0.0 if abs(value) < 1e-12 else value
