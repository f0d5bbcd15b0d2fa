"""Contacts as conductances in the arrays of a simulation of many worlds: NumPy, PyTorch, JAX.

What `sense_contacts` does with recorded contact sensors, as a pure function without a branch on data. It knows
contacts of fingertips with objects; those of fingertips with one another it leaves aside.

B: worlds, F: fingertips, O: objects, G: geoms of the objects, H: substeps, L: contacts of a pair, V: materials.
"""

# mujoco ships no type stubs for its compiled names
# pyright: reportAttributeAccessIssue=false

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import reduce
from operator import add
from typing import NamedTuple

import mujoco
import numpy as np

from ...thermal.contact import (
    ArrayLaws,
    Wedge,
    array_beside_round,
    array_conductance,
    array_contact,
    array_curved_contact,
    array_curved_shares,
    array_flat_patch,
    array_laws,
)
from ...thermal.numerics import Array, as_integers, as_like, namespace_of
from ..scene import BodyShape, PadPlace
from .laws import pair_laws
from .pad_contacts import DEPTH, LOOKING, RIM
from .round_pads import array_on_ellipsoid, array_round_contact, bends, curves
from .tilt import RADIUS, TILT, array_tilted
from .views import array_between_sides, array_next_sides, array_viewed

_ACROSS = [[[0, 1, 0], [0, 0, 1]], [[1, 0, 0], [0, 0, 1]], [[1, 0, 0], [0, 1, 0]]]


class TouchContacts(NamedTuple):
    """What pressed on fingertips in the substeps of a step, newest first, in the world's frame. force: (B, H, F, G, L,
    3) N on each geom of the objects from each fingertip and place: (B, H, F, G, L, 3) m where it acts; L are forces of
    one pair, such as several contacts; one that is 0 is none. tip_position (B, H, F, 3) m and tip_turn (B, H, F, 3, 3):
    of the bodies that carry the pads; geom_position (B, H, G, 3) m and geom_turn (B, H, G, 3, 3): of the geoms."""

    force: Array
    place: Array
    tip_position: Array
    tip_turn: Array
    geom_position: Array
    geom_turn: Array


class StepContacts(NamedTuple):
    """Of a step, (B, F, O) each: conductance W/K, its mean; area m2 and length m, along the second of two axes, of the
    contact while there was one, 0 without; force N on the pad, its mean; closed, the share of the substeps with a
    contact, and pulses, half of how often one has come or gone within the step. shares: (B, F, O, 4) by which the
    contact lies at an end of the sensor's face along both axes, and of the object (thermal/contact/patch_place.py).
    beside: (B, F) N off the pads, its mean."""

    conductance: Array
    area: Array
    length: Array
    shares: Array
    force: Array
    beside: Array
    closed: Array
    pulses: Array


@dataclass(frozen=True, slots=True)
class ArrayContacts:
    """Pads and objects for steps of arrays. position (F, 3) m and axes (F, 3, 3) of the pads in their bodies' frames,
    half (F, 2) m of their sides, width (F,) m of the sensors. laws: of (V F G 3) records, by material, fingertip, geom
    and axis of the geom's frame. tables: those of curved contacts behind one another, and curved (V F G A) their
    numbers by axis, of ellipsoids by radius or, of meshes, by view, -1 for flat ones; tilts (V F G 3, TILT) of rods.
    numbers: (F, G) integers, the pairs of the first material. views: (G, A, VIEW), and meshed: (G,) 1 for what has
    some. radii: (G, A) m of ellipsoids, 0 of others.
    bend (F, BEND) and curve (G, 3, CURVES) are round_pads.py's; bulging: (F,) 1 for pads that are round. Flat ones
    have the bend of a round one, whose contact is not used. units (3, 3) and across (3, 2, 3): an axis and the two
    others."""

    position: Array
    axes: Array
    half: Array
    width: Array
    laws: ArrayLaws
    tables: Array
    curved: Array
    tilts: Array
    numbers: Array
    bend: Array
    curve: Array
    bulging: Array
    any_bulging: bool
    any_curved: bool
    any_meshed: bool
    any_rounded: bool
    views: Array
    meshed: Array
    radii: Array
    units: Array
    across: Array

    def of_step(self, contacts: TouchContacts, material: Array, of_object: Array) -> StepContacts:
        """What `contacts` are to the heat of a step, each substep with its own places. material: (B, G) integers.
        of_object: (G, O), 1 where a geom is an object's. A world with a number that is not finite has no number that
        is."""
        xp = namespace_of(contacts.force)
        worlds, substeps = contacts.force.shape[:2]
        total = reduce(add, ((0.0 * part).reshape(worlds, -1).sum(-1) for part in contacts))
        force, place, tip_position, tip_turn, geom_position, geom_turn = (
            part.reshape((worlds * substeps, *part.shape[2:])) for part in contacts
        )
        axes = _product(tip_turn, self.axes)  # (B H, F, 3, 3), columns normal, y and z
        middle = tip_position + _rotated(tip_turn, self.position)
        at = _seen(axes[:, :, None, None], place - middle[:, :, None, None])
        vector = _seen(axes[:, :, None, None], force)
        pressed = vector[..., 0]  # (B H, F, G, L)
        on = (abs(at[..., 1:]) <= self.half[:, None, None] + RIM).all(-1) & (abs(at[..., 0]) <= DEPTH)
        if self.any_bulging:  # along the normal where it presses, that of a ball of the pad's curvatures
            leans = at[..., 1:] * (self.bend[:, :2] * self.bulging[:, None])[:, None, None]
            upright = (1.0 - (leans * leans).sum(-1)).clip(0.0, None) ** 0.5
            pressed = upright * pressed + (leans * vector[..., 1:]).sum(-1)
            on = on & (upright >= LOOKING)
        none = 0.0 * pressed
        pressed = xp.where(pressed > 0, pressed, none)
        beside = xp.where(on, none, pressed).sum(-1).sum(-1)
        pressed = xp.where(on, pressed, none)
        whole = pressed.sum(-1)
        off = (pressed[..., None] * at[..., 1:]).sum(-2) / xp.where(whole > 0, whole, 1.0 + whole)[..., None]
        every = xp.broadcast_to(material[:, None], (worlds, substeps, material.shape[-1])).reshape(
            (worlds * substeps, -1)
        )
        found = self._joined(whole[..., None], off, middle, axes, geom_position, geom_turn, every)

        def summed(values: Array) -> Array:
            """(B, H, F, O) of the objects, from (B H, F, G)."""
            of = (values[..., None] * of_object).sum(-2)
            return of.reshape((worlds, substeps, *of.shape[1:]))

        conducts, area, long = (each[..., 0] for each in found[:3])
        areas, placed = summed(area), (area[..., None] * found[3][..., 0, :])
        placed = (placed[..., None, :] * of_object[:, :, None]).sum(-3)
        placed = placed.reshape((worlds, substeps, *placed.shape[1:])).sum(1)
        there = xp.where(areas > 0, 1.0 + 0.0 * areas, 0.0 * areas)
        closed, pulses = there.sum(1), abs(there[:, 1:] - there[:, :-1]).sum(1) / 2
        areas = areas.sum(1)
        over = xp.where(areas > 0, areas, 1.0 + areas)
        broken = total[:, None, None]
        return StepContacts(
            summed(conducts).mean(1) + broken,
            areas / xp.where(closed > 0, closed, 1.0 + closed),
            summed(area * long).sum(1) / over,
            placed / over[..., None],
            summed(whole).mean(1) + broken,
            beside.reshape((worlds, substeps, -1)).mean(1) + total[:, None],
            closed / substeps,
            pulses,
        )

    def _joined(
        self,
        pressed: Array,
        off: Array,
        middle: Array,
        axes: Array,
        geom_position: Array,
        geom_turn: Array,
        material: Array,
    ) -> tuple[Array, Array, Array, Array]:
        """(conductance W/K of a contact of the whole face's spread, area m2, length m), (B, F, G, H) each, 0 where
        nothing conducts, and shares (B, F, G, H, 4). pressed: (B, F, G, H) N on the pads, which acts at off (B, F, G,
        2) m from the middle (B, F, 3) m of a pad with axes (B, F, 3, 3)."""
        xp = namespace_of(pressed)
        tips, geoms = self.numbers.shape
        looking = _seen(geom_turn[:, None], axes[:, :, None, :, 0])  # (B, F, G, 3) in the geom's frame
        axis = abs(looking).argmax(-1)
        from_geom = _seen(geom_turn[:, None], middle[:, :, None] - geom_position[:, None])
        pair = material[:, None] * (tips * geoms) + self.numbers
        which = as_integers(pair * 3 + axis)
        law = ArrayLaws(*(table[:, :, :, None] for table in self.laws.at(which)))
        area, share = array_contact(law, pressed, from_geom[..., None, :])
        width = self.width[:, None, None]
        long, shares = array_flat_patch(law, area, from_geom[..., None, :], width)
        flat = self._conducting(law, area, share, long)
        # 0 where nothing conducts, but what is not a number stays so, for its world alone
        none = 0.0 * pressed
        if self.any_bulging:
            bulging = self.bulging[:, None, None] > 0
            bulged = self._of_round(law, pressed, off, axis, axes, geom_turn)
            flat = tuple(xp.where(bulging, new, old) for new, old in zip(bulged, flat, strict=True))
            shares = xp.where(bulging[..., None], 0.0 * shares, shares)
        if not self.any_curved:
            return *flat, shares
        tilts = self.tilts[which]
        aside, along, slope = self._crown(law, tilts[..., RADIUS], off, from_geom, axes, geom_turn)
        side = next_side = axis
        part = 0.0 * from_geom[..., 0]
        if self.any_rounded:
            below, above, part = array_next_sides(self.radii, looking)
            rounded = self.radii[:, 0] + part > part
            side, next_side = xp.where(rounded, below, axis), xp.where(rounded, above, axis)
        if self.any_meshed:
            view, *seen = array_viewed(self.views, looking, from_geom, law.half_face[..., 0])
            meshed = (self.meshed + 0.0 * axis)[..., None] > 0
            aside, along = (
                xp.where(meshed, one[..., None], other)
                for one, other in zip(seen, (aside, along), strict=True)
            )
            side = xp.where(meshed[..., 0], view, side)
        first_table = pair * self.views.shape[1]
        table = self.curved[as_integers(first_table + side)][..., None]
        number = as_integers(table.clip(0.0, None))
        whole, lying = array_tilted(tilts[..., None, :], pressed, slope + none, along + none)
        lies = whole > 0
        share = xp.where(lies, whole, 1.0 + 0.0 * whole)
        lying = lying / share
        found = array_curved_contact(self.tables, number, lying, aside + none, along + none)
        placed = array_curved_shares(self.tables, number, lying, aside + none, along + none)
        if self.any_rounded:
            further = self.curved[as_integers(first_table + next_side)][..., None]
            further = as_integers(further.clip(0.0, None))
            larger = array_curved_contact(self.tables, further, lying, aside + none, along + none)
            others = array_curved_shares(self.tables, further, lying, aside + none, along + none)
            part = part[..., None] + none
            *both, ends = array_between_sides(part, found, larger, placed, others)
            between = part > 0
            found = tuple(xp.where(between, new, old) for new, old in zip(both, found, strict=True))
            placed = xp.where(between[..., None], ends, placed)
        conducts, area, long = (
            xp.where(table >= 0, xp.where(lies, share * bent, none), even)
            for bent, even in zip(found, flat, strict=True)
        )
        return conducts, area, long, xp.where((table >= 0)[..., None], placed, shares)

    def _conducting(
        self, law: ArrayLaws, area: Array, share: Array, long: Array
    ) -> tuple[Array, Array, Array]:
        """(W/K, m2, m) of a contact of that area m2 under a force `share` N, 0 each where it does not touch."""
        xp = namespace_of(area)
        pressure = share / xp.where(area > 0, area, area + self.width[:, None, None] ** 2)
        closed = (area > 0) & (pressure > 0)
        h = array_conductance(law, xp.where(closed, pressure, pressure * 0 + 1.0))
        none = 0.0 * area
        return xp.where(closed, h * area, none), xp.where(closed, area, none), xp.where(closed, long, none)

    def _of_round(
        self, law: ArrayLaws, pressed: Array, off: Array, axis: Array, axes: Array, geom_turn: Array
    ) -> tuple[Array, Array, Array]:
        """(W/K, m2, m), (B, F, G, H) each, of round pads in place of flat ones', with the gas beside them."""
        xp = namespace_of(pressed)
        of_axis = self.units[axis]  # (B, F, G, 3)
        curve = (of_axis[..., None] * self.curve).sum(-2)
        # the geom's axes along the pad's y and z, then the two of them that lie across
        seen = (geom_turn[:, None, :, :, :, None] * axes[:, :, None, :, None, 1:]).sum(-3)  # (B, F, G, 3, 2)
        picked = (of_axis[..., None, None] * self.across).sum(-3)  # (B, F, G, 2, 3)
        sides = (picked[..., None] * seen[..., None, :, :]).sum(-2)
        if self.any_rounded:
            ahead = _seen(geom_turn[:, None], axes[:, :, None, :, 0])
            on_it = array_on_ellipsoid(self.radii, curve, self.bend[:, None, :2] * off, ahead, seen)
            rounded = (self.radii[:, 0] + 0.0 * off[..., 0] > 0)[..., None, None]
            sides = xp.where(rounded, on_it, sides)
        facing = (of_axis[..., None] * seen).sum(-2)  # what a flat face looks along
        ahead = (of_axis * _seen(geom_turn[:, None], axes[:, :, None, :, 0])).sum(-1)
        # fingertips and meshes count as level
        flat = (curve[..., 0] + curve[..., 1] == 0) & (ahead != 0) & (self.meshed + 0.0 * ahead == 0)
        rise = xp.where(
            flat[..., None], facing / xp.where(flat, ahead, 1.0 + 0.0 * ahead)[..., None], 0.0 * facing
        )
        touching = pressed > 0
        force = xp.where(touching, pressed, 1.0 + 0.0 * pressed)
        found = array_round_contact(
            self.bend[:, None, None],
            curve[..., None, :],
            sides[..., None, :, :],
            rise[..., None, :],
            force,
            off[..., None, 0],
            off[..., None, 1],
        )
        area, load, kept, longer, even, wedge = found
        none = 0.0 * force
        conducts, area, _ = self._conducting(law, area + none, load + none, none)
        conducts, area = conducts * kept, area * kept * (1.0 - law.narrowing * (1.0 - even))
        touches = area > 0
        long = xp.where(touches, xp.where(touches, area * longer, 1.0 + none) ** 0.5, none)
        wedge = Wedge(*(each + none for each in wedge))
        together = array_beside_round(law, wedge, conducts, area, long)
        away = 0.0 * pressed
        return tuple(xp.where(touching, each, away) for each in together)  # pyright: ignore[reportReturnType]

    def _crown(
        self, law: ArrayLaws, radius: Array, off: Array, from_geom: Array, axes: Array, geom_turn: Array
    ) -> tuple[Array, Array, Array]:
        """m, (B, F, G, 1) each, from a pad's middle to where a curved body touches it: of a ball along y and z, of a
        cylinder across it, and along it to the middle of the line that is nearest to the pad; and the tangent of its
        angle to the pad, 0 of a ball. radius: (B, F, G) m of rods; off: (B, F, G, 2) m."""
        xp = namespace_of(off)
        rod_axis = _seen(axes[:, :, None], geom_turn[:, None, :, :, 2])
        line = rod_axis[..., 1:]  # a cylinder's axis along y and z
        length = (line * line).sum(-1) ** 0.5
        turned = off[..., 0] * line[..., 1] - off[..., 1] * line[..., 0]
        safe = xp.where(length > 0, length, length + 1)
        across = (turned / safe)[..., None]
        lies = law.cylinder > 0
        normal = _seen(geom_turn[:, None], axes[:, :, None, :, 0])  # in the geom's frame
        slope = xp.where(length > 0, rod_axis[..., 0] / safe, 0.0 * length)
        away = (from_geom * normal).sum(-1)
        middle = (from_geom[..., 2] - rod_axis[..., 0] * away) / safe - radius * rod_axis[..., 0]
        middle = xp.where(length > 0, middle, 0.0 * length)
        return (
            xp.where(lies, across, off[..., 0][..., None]),
            xp.where(lies, middle[..., None], off[..., 1][..., None]),
            xp.where(lies, slope[..., None], 0.0 * slope[..., None]),
        )


def array_contacts(
    model: mujoco.MjModel, pads: Sequence[PadPlace], kinds: Sequence[Sequence[BodyShape]], like: Array
) -> ArrayContacts:
    """Of a model's pads and objects, in the kind, dtype and device of the array `like`. kinds: the objects once for
    each number that a world's `material` may be, alike but for their materials."""
    found = [pair_laws(model, pads, shapes) for shapes in kinds]
    laws = np.stack([each.laws[:, : _geoms(shapes)] for each, shapes in zip(found, kinds, strict=True)])
    tilts = np.stack([each.tilts[:, : _geoms(shapes)] for each, shapes in zip(found, kinds, strict=True)])
    tables = [each.all_tables for each in found]
    before = np.cumsum([0, *map(len, tables)])
    curved = np.stack(
        [
            np.where(each.curved < 0, -1, each.curved + first)[:, : _geoms(shapes)]
            for each, first, shapes in zip(found, before, kinds, strict=False)
        ]
    )
    owner = [o for o, shape in enumerate(kinds[0]) for _ in shape.geoms]
    numbers = np.arange(len(pads) * len(owner)).reshape(len(pads), len(owner))
    bulging = tuple(sum(pad.curvature) > 0 for pad in pads)
    bend = bends(pads)
    bend[~np.array(bulging), 0] = 1.0
    return ArrayContacts(
        position=as_like(np.array([pad.position for pad in pads]), like),
        axes=as_like(np.array([pad.axes for pad in pads]), like),
        half=as_like(np.array([pad.half_sides for pad in pads]), like),
        width=as_like(np.array([pad.stack.width for pad in pads]), like),
        laws=array_laws(laws.reshape(-1), like),
        tables=as_like(np.concatenate(tables).ravel(), like),
        curved=as_like(curved.ravel().astype(float), like),
        tilts=as_like(tilts.reshape(-1, TILT), like),
        numbers=as_integers(as_like(numbers.astype(float), like)),
        bend=as_like(bend, like),
        curve=as_like(curves(model, pads, kinds[0])[: len(owner)], like),
        bulging=as_like(np.array(bulging, float), like),
        any_bulging=any(bulging),
        any_curved=bool((curved >= 0).any()),
        views=as_like(found[0].views[: len(owner)], like),
        any_meshed=bool(found[0].viewed.any()),
        any_rounded=bool(found[0].radii.any()),
        radii=as_like(found[0].radii[: len(owner)], like),
        meshed=as_like((found[0].viewed[: len(owner)] > 0).astype(float), like),
        units=as_like(np.eye(3), like),
        across=as_like(np.array(_ACROSS, float), like),
    )


def _geoms(shapes: Sequence[BodyShape]) -> int:
    return sum(len(shape.geoms) for shape in shapes)


def _rotated(turn: Array, vector: Array) -> Array:
    return (turn * vector[..., None, :]).sum(-1)


def _seen(turn: Array, vector: Array) -> Array:
    """A vector along the columns of a turn."""
    return (turn * vector[..., :, None]).sum(-2)


def _product(first: Array, second: Array) -> Array:
    return (first[..., :, :, None] * second[..., None, :, :]).sum(-2)
