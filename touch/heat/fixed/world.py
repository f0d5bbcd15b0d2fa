"""One world of joined heat whose fingertips stay where they are: its fields and places as arrays.

F: fingertips, O: objects, T = O + F: targets of a contact and fields, K: states.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass

import numpy as np

from thermograsp.errors import InvalidValueError

from ....thermal import Material
from ....thermal.kernels import Resolution, Tip
from ....thermal.numerics import Array
from ...contacts import COLUMNS, CONDUCTANCE, NORMAL, PLACE
from ...scene import PadPlace
from ..march import settle
from ..narrow import face_modes, kinds_of, narrow_tables, pressed_behind, wall_of
from ..places import BodyField, Place, carried_states
from .networks import FixedNetworks, fixed_networks
from .places import FixedPlaces, fixed_places


@dataclass(frozen=True, slots=True, eq=False)
class JoinedWorld:
    """As joined.py has it. number: its own. pads, tips: of the fingertips. names: of objects. boxes: (O, BOX) of
    march.py. widths: (F,) m. fields, materials: of the objects, and field: makes one of an object, by number, of its
    material and places, and which of these wholly. current: (F, O) each pair's place among its object's, -1 for none.
    closed: (F, T) contacts. states: (T, K). warm: (F,) K of the thermostats above the air. narrow: (F, T, K)."""

    number: int
    dt: float
    level: Resolution
    pads: Sequence[PadPlace]
    tips: Sequence[Tip]
    names: Sequence[str]
    boxes: np.ndarray
    widths: np.ndarray
    fields: Sequence[BodyField]
    materials: Sequence[Material]
    field: Callable[[int, Material, tuple[Place, ...], tuple[bool, ...]], BodyField]
    current: np.ndarray
    closed: np.ndarray
    states: np.ndarray
    warm: np.ndarray
    narrow: np.ndarray


def world_places(world: JoinedWorld, like: Array) -> FixedPlaces:
    """Its fingertips on the places that they have, and on other fingertips that they touch."""
    objects, patterns = len(world.names), world.level.patterns
    at = np.concatenate((world.current >= 0, world.closed[:, objects:]), axis=1)
    pairs = [(f, t) for f, t in np.argwhere(at).tolist()]
    if not pairs:
        raise InvalidValueError(
            f"no fingertip of world {world.number} has touched anything: there are no places yet"
        )
    used = sorted({t for _, t in pairs} | {objects + f for f, _ in pairs})
    rates = [world.tips[b - objects].side.rates if b >= objects else world.fields[b].rates for b in used]
    begin = dict(zip(used, np.cumsum([0, *map(len, rates)]).tolist(), strict=False))
    flat = np.concatenate(rates)
    ports, drop = np.zeros((len(flat), patterns * len(pairs))), np.zeros((len(pairs), len(flat)))
    for n, (f, t) in enumerate(pairs):
        in_port, first = slice(n * patterns, (n + 1) * patterns), begin[objects + f]
        side = world.tips[f].side
        ports[first : first + len(side.rates), in_port] = -side.ports
        drop[n, first : first + len(side.rates)] = side.outputs["drop"]
        taking = (
            world.fields[t].port(int(world.current[f, t]), patterns)
            if t < objects
            else world.tips[t - objects].side.ports
        )
        ports[begin[t] : begin[t] + len(taking), in_port] = taking
    names = (*world.names, *(pad.label for pad in world.pads))
    warm = np.append(np.zeros(objects), world.warm)
    return fixed_places(
        [(world.pads[f].label, names[t]) for f, t in pairs],
        flat,
        ports,
        drop,
        np.array([warm[objects + f] - warm[t] for f, t in pairs]),
        np.concatenate([world.states[b, : len(r)] for b, r in zip(used, rates, strict=True)]),
        world.dt,
        like,
    )


def world_networks(
    world: JoinedWorld, materials: Sequence[Sequence[Material]], poses: np.ndarray
) -> FixedNetworks:
    """Its fingertips on the places that they have, or would have where they have not touched an object. materials: that
    each object may be of, the world's among them. poses: (ways, F, O, 6) the pads' PLACE and NORMAL on every object
    (contacts/columns.py), in each way of touching it; every material comes once a way, and the state is that of the
    first."""
    tips, objects = world.current.shape
    level, current = world.level, world.current.copy()
    places = [[list(field.places) for field in world.fields] for _ in poses]
    for known, expected in zip(places, (_expected(world, pose) for pose in poses), strict=True):
        for f, o in np.argwhere(world.current < 0).tolist():
            current[f, o] = len(known[o])
            known[o].append(expected[f][o])
    whole = [
        tuple(n in current[:, o].tolist() for n in range(len(known))) for o, known in enumerate(places[0])
    ]
    after = [
        [world.field(o, one, tuple(way[o]), whole[o]) for one in choices for way in places]
        for o, choices in enumerate(materials)
    ]
    states = []
    for o, before in enumerate(world.fields):
        field = world.field(o, world.materials[o], tuple(places[0][o]), whole[o])
        held = world.states[o, : len(before.rates)]
        states.append(held if field is before else carried_states(before, field, level.patterns, held))
    states += [world.states[objects + f, : len(tip.side.rates)] for f, tip in enumerate(world.tips)]
    most = max(map(len, materials))
    kinds = [[choices[min(v, len(choices) - 1)] for v in range(most) for _ in poses] for choices in materials]
    # as `after` has them, of which an object may have fewer
    fields = [[known[min(v, len(known) - 1)] for v in range(most * len(poses))] for known in after]
    pairs, pinched, behind, pad_kinds = [], [], [], kinds_of(world.pads)
    for f, pad in enumerate(world.pads):
        width, others = pad.stack.width, [g for g in range(tips) if g != f and pad_kinds[g] == pad_kinds[f]]
        for o, each in enumerate(kinds):
            shares = np.zeros((len(each), tips))
            for v, field in enumerate(fields[o]):
                at = int(current[f, o])
                for g in others:
                    behind_it = [field.places[int(current[g, o])]]
                    shares[v, g] = pressed_behind(field.places[at], behind_it, field.below[at][1], width)
            other = int(shares.max(axis=0).argmax())
            behind.append(other * objects + o)
            for one, field, by in zip(each, fields[o], shares[:, other].tolist(), strict=True):
                below = field.below[int(current[f, o])]
                pairs.append((pad, wall_of(one, *below, width)))
                pinched.append((pad, wall_of(one, *below, width, by)))
    tables, ripples, number = narrow_tables([*pairs, *pinched], level, world.dt)
    number = np.column_stack((number[: len(pairs)], number[len(pairs) :, 1]))
    return fixed_networks(
        world.dt,
        level.patterns,
        world.tips,
        after,
        current,
        world.warm,
        tables,
        ripples,
        number,
        np.array(behind),
        np.repeat(world.widths, objects),
        level.decay,
        np.array([face_modes(pad, level) for pad in world.pads]),
        states,
        world.narrow[:, :objects].reshape(tips * objects, -1),
    )


def _expected(world: JoinedWorld, poses: np.ndarray) -> list[list[Place]]:
    """(F, O) places of pads in those poses (F, O, 6)."""
    tips, objects = poses.shape[:2]
    touches = np.zeros((1, tips, objects, COLUMNS))
    touches[..., CONDUCTANCE] = 1.0
    touches[0, :, :, PLACE : PLACE + 3], touches[0, :, :, NORMAL : NORMAL + 3] = (
        poses[..., :3],
        poses[..., 3:],
    )
    faces, middles = np.full((1, tips, objects), -1), np.zeros((1, tips, objects, 3))
    new = faces.copy(), middles.copy()
    closed, stale = np.zeros((1, tips, objects), bool), np.zeros(1, bool)
    known = faces, middles, faces, middles
    none = np.full(tips, -1)
    settle(touches, world.boxes, world.widths, world.widths, *known, *new, closed, stale, none)
    return [
        [Place.on_grid(f, int(new[0][0, f, o]), new[1][0, f, o]) for o in range(objects)] for f in range(tips)
    ]
