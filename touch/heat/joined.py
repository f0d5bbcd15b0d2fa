"""Heat of all fingertips and objects of one or many worlds: separate passive fields that any contacts join.

Every field is x' = -rates x + ports q; contacts with conductances G join them to x' = -(rates + B G B^T) x + B G d,
which one rational step of the exponential solves (thermal/network/coupling.py): exact while conductances stand still,
stable and balanced whatever they do. Temperatures count from the air's. A world's numbers do not depend on how many
there are.

W: worlds, F: fingertips, O: objects, T = O + F: targets of a contact (objects, then fingertips) and fields, K: states.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from operator import is_
from typing import Any

import numpy as np

from thermograsp.errors import InvalidValueError

from ...thermal import Material
from ...thermal.numerics import Array
from ...thermal.padded import RINGS, ring_shares
from ..contacts import FORCE, GluedContacts
from ..pointers import table
from ..scene import BodyShape, PadPlace
from .backs import HeatedBack, ThermostatBack
from .contents import HeldContents
from .fixed import FixedNetworks, FixedPlaces, JoinedWorld, world_networks, world_places
from .march import TABLE, sample
from .narrow import (
    STEPS,
    NarrowPairs,
    face_modes,
    face_room_size,
    kinds_of,
    pressed_behind,
    wall_of,
)
from .places import (
    MOST_PLACES,
    NEAR,
    BodyField,
    KnownFields,
    Place,
    carried_states,
    moved,
    resolution,
    rings_of,
    tip_field,
)
from .records import HeatBalance, HeatState
from .reported import narrow_falls
from .step import room_size
from .systems import Pair, SystemPool, groups

MOST_SYSTEMS = 1024
"""That are kept; beyond, those that no world uses are forgotten."""


class JoinedHeat:
    """Heat of pads, objects and the elements that are glued on them, in steps of dt s. Elements count as fingertips
    behind the others, S = F + E sensors in all, and are always on their objects. tolerance: K. film: W/(m2 K) of the
    air at `ambient` °C. cache: keep on disk what takes long of bodies that are no boxes."""

    def __init__(
        self,
        fingertips: Sequence[PadPlace],
        glued: Sequence[PadPlace],
        shapes: Sequence[BodyShape],
        *,
        worlds: int,
        dt: float,
        tolerance: float,
        film: float,
        ambient: float,
        cache: bool = True,
    ) -> None:
        pads = (*fingertips, *glued)
        self._pads, self._shapes = pads, tuple(shapes)
        self._pad_kinds = kinds_of(pads)
        self._glued = GluedContacts(fingertips, glued, len(shapes), worlds) if glued else None
        self._dt, self._ambient = dt, ambient
        self._level = resolution(tolerance, any(shape.solid is not None for shape in shapes))
        self._tip_fields = tuple(tip_field(pad, self._level) for pad in pads)
        self._tips = tuple(field.tip for field in self._tip_fields)
        # pads around elements, which are contacts of their own behind the sensors'
        around = [(f, field.padded) for f, field in enumerate(self._tip_fields) if field.padded is not None]
        self._around = tuple(around)
        shares = [ring_shares(pads[f].stack.width, rings_of(pads[f]) or (), STEPS) for f, _ in around]
        self._shares = np.concatenate((np.zeros((0, STEPS, 2)), *shares))
        self._owners = np.array([*range(len(pads)), *(f for f, _ in around)])
        self._around_of = np.full(len(pads), -1)
        self._around_of[self._owners[len(pads) :]] = np.arange(len(pads), len(self._owners))
        wide = [np.sqrt(padded.areas) for _, padded in around]
        self._widths = np.concatenate(([pad.stack.width for pad in pads], *wide))
        self._boxes = np.array(
            [
                np.concatenate((s.size, s.extent, s.centre, s.axes.ravel(), [s.solid is not None]))
                for s in self._shapes
            ]
        )
        count, objects, fields = len(pads), len(shapes), len(shapes) + len(pads)
        contacts, lanes = len(self._owners), len(self._widths)
        self._known = KnownFields(self._shapes, pads, self._tips, self._level, film, cache)
        self._materials = [tuple(shape.material for shape in shapes)] * worlds
        bare = self._known.bare(self._materials[0])
        self._held_by = np.tile([field.heat[0] for field in bare], (worlds, 1))
        self._warm = np.tile(np.array([pad.temperature for pad in pads]) - ambient, (worlds, 1))
        self._rows = _padded([tip.side.outputs["drop"] for tip in self._tips])
        self._elements = _padded([tip.side.outputs["element"] for tip in self._tips])
        self._uniform = _padded([field.uniform for field in self._tip_fields])
        self._even = _padded([tip.side.ports[:, 0] for tip in self._tips])
        self._glued_on = [pad.glued for pad in glued if pad.glued is not None]
        self._fields = [list(bare) for _ in range(worlds)]
        self._current = np.full((worlds, count, objects), -1)
        self._faces = np.full((worlds, count, objects), -1)
        self._middles = np.zeros((worlds, count, objects, 3))
        # the places for which these were found to do, and those for which one is to be found
        self._sought_faces, self._sought_middles = self._faces.copy(), self._middles.copy()
        self._new_faces, self._new_middles = self._faces.copy(), self._middles.copy()
        self._closed = np.zeros((worlds, contacts, fields), bool)
        self._stale = np.zeros(worlds, bool)
        self._plan = np.full((worlds, min(count, fields)), -1)
        self._nets = np.zeros((worlds, fields), np.int64)
        self._given, self._air = np.zeros((worlds, lanes, fields)), np.zeros(worlds)
        self._x = np.zeros((worlds, fields, max(self._rows.shape[1], 1)))
        self._started = np.zeros((worlds, objects))
        self._narrow = np.zeros((worlds, lanes, fields, self._level.rates))
        rings = [one for _, padded in around for one in padded.impedance.T.tolist()]
        self._pairs = NarrowPairs(pads, rings, self._widths, self._level, worlds, fields, dt)
        self._modes = np.array([face_modes(pad, self._level) for pad in pads])
        self.drop = np.zeros((worlds, count))
        """(W, S) K over the sensed layers, mean over the face. It stays where it is."""
        self.warmth = np.zeros((worlds, objects))
        """(W, O) K, by how much the objects' means are above the air's temperature. It stays where it is."""
        self._backs = tuple(
            self._back(f, pad, worlds) for f, pad in enumerate(pads) if pad.heated or pad.thermostat
        )
        inside = [(o, shape.contents) for o, shape in enumerate(shapes) if shape.contents is not None]
        self.inner = np.zeros((worlds, len(inside)))
        """(W, C) °C of the contents of the objects that have any, in their order. It stays where it is."""
        self.contents = tuple(HeldContents(o, each, self.inner, c, dt) for c, (o, each) in enumerate(inside))
        """Of these."""
        self._busy, self._seconds, self._reach = np.zeros(fields, bool), np.array([dt]), NEAR * self._widths
        kept = np.exp(-dt * self._level.decay)
        self._decay = np.array([self._level.decay, kept, (1 - kept) / self._level.decay])
        ports = contacts * fields * self._level.patterns
        self._roots, self._leans = np.zeros((2, ports, self._level.rates))
        self._placed = np.zeros(4)
        self._touches, self._touches_at = np.zeros(0), 0
        self._face_room = np.zeros(0)
        self._room, self._table = np.zeros(0), np.zeros(TABLE, np.int64)
        self._point()
        self._forget()
        self.reset(range(worlds), np.tile([shape.temperature for shape in shapes], (worlds, 1)))

    def reset(self, worlds: Sequence[int], temperatures: np.ndarray) -> None:
        """Those worlds' fields at their first temperatures; the objects' (rows, O) in °C."""
        for w, celsius in zip(worlds, temperatures, strict=True):
            self._fields[w] = self._known.bare(self._materials[w])
            self._held_by[w] = [field.heat[0] for field in self._fields[w]]
            self._x[w] = 0.0
            self._x[w, : len(self._shapes), 0] = (celsius - self._ambient) * self._held_by[w]
            for each in self.contents:
                each.reset(w, float(celsius[each.object]), self._fields[w][each.object])
            for e, o in enumerate(self._glued_on, len(self._pads) - len(self._glued_on)):
                warm = celsius[o] - self._ambient
                self._x[w, len(self._shapes) + e, : self._uniform.shape[1]] = warm * self._uniform[e]
            self._renumber(w)
        rows = list(worlds)
        for back in self._backs:
            back.reset(rows)
            self._warm[rows, back.tip] = back.temperature[rows] - self._ambient
        self._current[rows], self._faces[rows], self._plan[rows] = -1, -1, -1
        for w in rows:
            self._pairs.know(w, self._materials[w])
        self._sought_faces[rows] = -1
        self._closed[rows], self._stale[rows] = False, False
        self._narrow[rows] = 0.0
        self._given[rows], self._air[rows], self.drop[rows] = 0.0, 0.0, 0.0
        for w in rows:
            self._started[w] = self._held(w)
        self._warm_up()

    def warm(self, change: np.ndarray) -> None:
        """The fingertips' thermostats are warmer by change (W, S) K from now on; their elements' fields stay as they
        are, and are told from where the thermostats have gone."""
        for f, each in enumerate(change.T):
            self._x[:, len(self._shapes) + f, : self._uniform.shape[1]] -= each[:, None] * self._uniform[f]
        self._warm[:, : change.shape[1]] += change

    def set_materials(self, worlds: Sequence[int], materials: Sequence[tuple[Material, ...]]) -> None:
        """What those worlds' objects are made of from now on; a reset of these worlds must follow."""
        for w, combination in zip(worlds, materials, strict=True):
            self._materials[w] = combination

    def set_around(self, ambient: float, fingertips: np.ndarray) -> None:
        """°C of the air and (S,) of ideal thermostats from now on; a reset of all worlds must follow."""
        self._ambient = ambient
        self._warm[:] = fingertips - ambient
        now = zip(self._pads, fingertips.tolist(), strict=True)
        self._pad_kinds = kinds_of([replace(pad, temperature=celsius) for pad, celsius in now])

    @property
    def systems(self) -> int:
        """How many groups of fields are known."""
        return len(self._pool)

    def advance(self, touches: np.ndarray, substeps: int) -> bool:
        """One step of dt. touches: (W, F, O + F, COLUMNS) of the fingertips, sums over so many substeps. Returns
        whether places or contacts have changed."""
        if self._glued is not None:
            touches = self._glued.redirected(touches, substeps)
        if touches is not self._touches:
            self._touches = np.ascontiguousarray(touches, float)
            self._touches_at = self._touches.ctypes.data
        before = [(back.held(self._field_of(back)), self._passed(back)) for back in self._backs]
        self._exchange()
        changed = sample(self._address(), self._touches_at, substeps, 0) > 0
        if changed:
            for w, o in np.argwhere((self._new_faces >= 0).any(axis=1)).tolist():
                self._settle(w, o, np.flatnonzero(self._new_faces[w, :, o] >= 0).tolist())
            while self._stale.any():
                for w in np.flatnonzero(self._stale).tolist():
                    self._stale[w] = False
                    self._join(w)
            sample(self._address(), self._touches_at, substeps, 1)
        if self.contents:
            self._exchange()
            for inside in self.contents:
                inside.end()
            self._warm_up()
        for back, (held, passed) in zip(self._backs, before, strict=True):
            f = back.tip
            force = touches[:, f, :, FORCE].sum(axis=1) + touches[:, :, len(self._shapes) + f, FORCE].sum(
                axis=1
            )
            out = self._passed(back) - passed
            back.step(self._field_of(back), held, out, self.drop[:, f], force / substeps)
            self._warm[:, f] = back.temperature - self._ambient
        return changed

    def hearing(self, touches: np.ndarray) -> tuple[int, int]:
        """What `sample` takes first, until a call of anything else here: addresses of all arrays and of the touches.
        Zeros where a step is more than that."""
        if self._backs or self.contents or self._glued is not None:
            return 0, 0
        return self._address(), touches.ctypes.data

    def _exchange(self) -> None:
        """Half a step of contents and walls."""
        for each in self.contents:
            each.exchange(self._x[:, each.object], self._ambient)

    def telling(self) -> np.ndarray:
        """What the functions of reported.py take of a heat of one world, until a call of anything else here."""
        ports = np.zeros((*self._current.shape[1:], self._x.shape[2]))
        for f, of_tip in enumerate(self._current[0].tolist()):
            for o, number in enumerate(of_tip):
                if number >= 0:
                    field = self._fields[0][o]
                    ports[f, o, : len(field.rates)] = field.ports[:, number * self._level.patterns]
        self._books = self._elements, self._even, self._started, self._current, ports
        widths = self._elements.shape[1], self._even.shape[1]
        return table(self._books, (self._address(), *widths))

    def _address(self) -> int:
        """Of the table of all arrays that `sample` takes."""
        if self._outdated:
            pool = self._pool
            room = room_size(pool.most, self._level.patterns, pool.rates)
            if room != len(self._room):
                self._room = np.zeros(room)
            faces = face_room_size(pool.most, self._level.rates)
            if faces != len(self._face_room):
                self._face_room = np.zeros(faces)
            arrays = (
                *(self._boxes, self._widths, self._reach, self._faces, self._middles),
                *(self._sought_faces, self._sought_middles, self._new_faces, self._new_middles),
                *(self._closed, self._stale, self._warm, self._plan),
                *(pool.starts, pool.integers, pool.ports, pool.grams, pool.paces),
                *(self._fade, self._held_by, self._rows, self._nets, self._decay, self._pairs.tables),
                *(self._pairs.kinds, self._x, self._narrow, self._given, self._air, self.drop, self._busy),
                *(self.warmth, self._seconds, self._roots, self._room, self._placed),
                *(self._around_of, self._owners, self._shares, self._leans),
                *(self._pairs.ripples, self._modes, self._face_room),
            )
            worlds, tips, objects = self._current.shape
            sizes = (
                *(worlds, tips, objects, self._level.patterns, self._plan.shape[1]),
                *(len(pool.starts), len(pool.integers), len(pool.ports), len(pool.grams)),
                *(len(self._fade), self._x.shape[2], self._rows.shape[1], len(self._pairs.tables)),
                *(
                    self._level.rates,
                    len(pool.paces),
                    len(self._room),
                    pool.most,
                    len(self._owners),
                    len(self._widths),
                    len(self._face_room),
                ),
            )
            self._outdated = False
            if sizes != self._sizes or not all(map(is_, arrays, self._pointed)):
                self._pointed, self._sizes = (
                    arrays,
                    sizes,
                )  # they must live as long as their addresses are in use
                entries = table(arrays, sizes)
                self._table[: len(entries)] = entries
        return self._table_at

    def __setstate__(self, state: dict[str, Any]) -> None:
        """A copy, whose arrays are elsewhere."""
        self.__dict__.update(state)
        self._touches = np.zeros(0)
        self._point()

    def _point(self) -> None:
        """The table is to be filled, wherever it is."""
        self._table_at, self._outdated = self._table.ctypes.data, True
        self._pointed: tuple[np.ndarray, ...] = ()
        self._sizes: tuple[int, ...] = ()

    def fixed_places(self, w: int, like: Array) -> FixedPlaces:
        """World w's fingertips on the places that they have, and on other fingertips that they touch."""
        self._refuse_backs()
        return world_places(self._world(w), like)

    def fixed_networks(
        self, w: int, materials: Sequence[Sequence[Material]], poses: np.ndarray
    ) -> FixedNetworks:
        """World w's fingertips on the places that they have, or would have where they have not touched an object.
        materials: that each object may be of, the world's among them. poses: (ways, F, O, 6) the pads' PLACE and
        NORMAL on every object (contacts/columns.py), in each way of touching it; every material comes once a way, and
        the state is that of the first."""
        self._refuse_backs()
        return world_networks(self._world(w), materials, poses)

    def _world(self, w: int) -> JoinedWorld:
        tips = self._current.shape[1]
        return JoinedWorld(
            w,
            self._dt,
            self._level,
            self._pads[:tips],
            self._tips[:tips],
            [shape.name for shape in self._shapes],
            self._boxes,
            self._widths[:tips],
            self._fields[w],
            self._materials[w],
            self._known.field,
            self._current[w],
            self._closed[w, :tips],
            self._x[w],
            self._warm[w],
            self._narrow[w, :tips],
        )

    def meeting_through(self) -> set[tuple[int, int, int]]:
        """Two fingertips each and the object that they touch from opposite sides while they touch one another, in any
        world."""
        tips, objects = self._current.shape[1:]
        meets = self._closed[:, :tips, objects:]
        found = set()
        for w, f, g in np.argwhere(meets).tolist():
            for o in np.flatnonzero(self._closed[w, f, :objects] & self._closed[w, g, :objects]).tolist():
                if self._faces[w, f, o] == self._faces[w, g, o] ^ 1:
                    found.add((min(f, g), max(f, g), o))
        return found

    @property
    def touched(self) -> bool:
        """Whether any fingertip has touched an object in any world."""
        return bool((self._current >= 0).any())

    def _refuse_backs(self) -> None:
        if self.contents:
            raise InvalidValueError(
                "fixed places know empty objects alone: leave contents= of the objects out, or update a ThermalTouch "
                "step by step"
            )
        if self._around:
            raise InvalidValueError(
                "fixed places know elements without a pad alone: leave surround= of the fingertips out, or update a "
                "ThermalTouch step by step"
            )
        if self._backs or self._glued is not None:
            raise InvalidValueError(
                "fixed places know fingertips on ideal thermostats alone: leave out thermostat=, heated sensors and "
                "elements that are glued on"
            )

    @property
    def backed(self) -> bool:
        """Whether any sensor has a thermostat of finite power or a heater of its own."""
        return bool(self._backs)

    @property
    def sent(self) -> np.ndarray:
        """(W, S) what the electronics take: K of drop, or V of the dividers of sensors with heaters of their own."""
        if not self._backs:
            return self.drop
        found = self.drop.copy()
        for back in self._backs:
            found[:, back.tip] = back.sent(self.drop[:, back.tip])
        return found

    def _back(self, f: int, pad: PadPlace, worlds: int) -> HeatedBack | ThermostatBack:
        field = self._tip_fields[f]
        if pad.thermostat is not None:
            return ThermostatBack(pad, f, field, worlds=worlds, dt=self._dt)
        return HeatedBack(pad, f, field, worlds=worlds, dt=self._dt, ambient=self._ambient)

    def _field_of(self, back: HeatedBack | ThermostatBack) -> np.ndarray:
        """(W, K) states of its element."""
        return self._x[:, len(self._shapes) + back.tip]

    def _passed(self, back: HeatedBack | ThermostatBack) -> np.ndarray:
        """(W,) J out of its face so far."""
        target = len(self._shapes) + back.tip
        return self._given[:, back.tip].sum(axis=1) - self._given[:, :, target].sum(axis=1)

    @property
    def rung(self) -> str:
        """The model's name."""
        return f"fields:{self._level.rates}x{self._level.patterns}"

    def faces(self, world: int, touches: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """°C of a world's sensors and of the objects under them, (F, O) each: means over the contacts of the last step,
        whose touches (F, O + F, COLUMNS) these are, and over the whole face where there is none; an object's mean where
        none has touched it."""
        objects, patterns = len(self._shapes), self._level.patterns
        x, under = self._x[world], np.empty(self._current.shape[1:])
        even = self._warm[world] + (x[objects:, : self._even.shape[1]] * self._even).sum(axis=1)
        sensors = np.repeat(even[:, None], objects, axis=1)
        under[:] = self.warmth[world]
        for f, of_tip in enumerate(self._current[world].tolist()):
            for o, number in enumerate(of_tip):
                if number < 0:
                    continue
                field = self._fields[world][o]
                under[f, o] = field.ports[:, number * patterns] @ x[o, : len(field.rates)]
                sides = (self._pairs.tables[n] for n in self._pairs.kinds[world, f, o])
                states = self._narrow[world, f, o]
                tip, other = narrow_falls(*sides, float(self._widths[f]), touches[f, o], states)
                sensors[f, o] -= tip
                under[f, o] += other
        return self._ambient + sensors, self._ambient + under

    @property
    def object_temperature(self) -> np.ndarray:
        """(W, O) °C, the objects' means."""
        return self._ambient + self.warmth

    def balance(self, world: int) -> HeatBalance:
        """Where a world's heat has gone."""
        objects = len(self._shapes)
        sensors = len(self._pads)
        given, elements = self._given[world, :sensors].copy(), self._in_tips(world)
        for r, (f, _) in enumerate(self._around):
            given[f] += self._given[world, sensors + r * RINGS : sensors + (r + 1) * RINGS].sum(axis=0)
        for back in self._backs:
            elements[back.tip] += back.gained[world]
        tips = self._current.shape[1] - len(self._glued_on)
        for e, o in enumerate(self._glued_on, tips):
            given[:, o] += given[:, objects + e]
        contents = np.zeros(objects)
        for each in self.contents:
            contents[each.object] = each.given[world]
        return HeatBalance(
            given[:tips, :objects],
            given[:tips, objects : objects + tips],
            float(self._air[world]),
            elements[:tips],
            self._held(world) - self._started[world],
            contents,
        )

    def state(self) -> HeatState:
        """A copy of what it remembers."""
        return HeatState(
            tuple(tuple(fields) for fields in self._fields),
            tuple(self._materials),
            self._current.copy(),
            self._x.copy(),
            self._started.copy(),
            self._narrow.copy(),
            self._given.copy(),
            self._air.copy(),
            self.drop.copy(),
            tuple(back.state() for back in self._backs),
            tuple(each.state() for each in self.contents),
        )

    def set_state(self, state: HeatState) -> None:
        """Puts it into a state taken by `state`."""
        self._materials = list(state.materials)
        for w, (saved, materials) in enumerate(zip(state.fields, state.materials, strict=True)):
            pairs = enumerate(zip(materials, saved, strict=True))
            self._fields[w] = [self._known.of(o, material, field) for o, (material, field) in pairs]
            self._held_by[w] = [field.heat[0] for field in self._fields[w]]
        self._current[:] = state.current
        self._x = state.states.copy()
        self._given[:], self._air[:], self._started[:] = state.given, state.air, state.started
        self._narrow[:] = state.narrow
        self.drop[:] = state.drop
        for back, saved in zip(self._backs, state.backs, strict=True):
            back.set_state(saved)
            self._warm[:, back.tip] = back.temperature - self._ambient
        bare = [self._known.bare(materials) for materials in self._materials] if self.contents else []
        for each, saved in zip(self.contents, state.contents, strict=True):
            each.set_state(saved, [fields[each.object] for fields in bare])
        for w, f, o in np.ndindex(self._current.shape):
            self._place(w, f, o)
        self._forget()
        self._warm_up()

    def _warm_up(self) -> None:
        """Says how warm the objects are."""
        self.warmth[:] = self._x[:, : len(self._shapes), 0] / self._held_by

    def _in_tips(self, w: int) -> np.ndarray:
        """(S,) J in the sensors' elements."""
        return (self._x[w, len(self._shapes) :, : self._elements.shape[1]] * self._elements).sum(axis=1)

    def _held(self, w: int) -> np.ndarray:
        """(O,) J in the objects and what is glued on them, counted from the air's temperature."""
        held = self._x[w, : len(self._shapes), 0] * self._held_by[w]
        if self._glued_on:
            within = self._in_tips(w)
            for e, o in enumerate(self._glued_on, self._current.shape[1] - len(self._glued_on)):
                held[o] += within[e]
        return held

    def _forget(self) -> None:
        """Systems are made anew when they are wanted."""
        self._outdated = True
        faces = [field.face for field in self._tip_fields]
        around = [(f, padded.rings) for f, padded in self._around]
        self._pool = SystemPool(self._tips, faces, len(self._shapes), self._level.patterns, self._dt, around)
        self._numbers: dict[BodyField, int] = {}
        self._fade = _padded([np.exp(-self._dt * tip.side.rates) for tip in self._tips])
        self._known.forget({field for fields in self._fields for field in fields})
        self._pairs.forget()
        for w in range(len(self._fields)):
            self._renumber(w)
            self._pairs.know(w, self._materials[w])
        self._plan[:] = -1
        self._stale[:] = True

    def _renumber(self, w: int) -> None:
        """Which networks a world's fields have."""
        self._outdated = True
        for o, field in enumerate(self._fields[w]):
            if field not in self._numbers:
                number = self._numbers[field] = len(self._tips) + len(self._numbers)
                rows, wide = self._fade.shape
                if number == rows or len(field.rates) > wide:
                    more = (number == rows) * rows, max(len(field.rates) - wide, 0)
                    self._fade = np.pad(self._fade, ((0, more[0]), (0, more[1])))
                self._fade[number, : len(field.rates)] = np.exp(-self._dt * field.rates)
            self._nets[w, o] = self._numbers[field]
        objects = len(self._shapes)
        self._nets[w, objects:] = np.arange(len(self._tips))
        wide = self._fade.shape[1] - self._x.shape[2]
        if wide > 0:
            self._x = np.pad(self._x, ((0, 0), (0, 0), (0, wide)))
        elif wide < 0:
            self._fade = np.pad(self._fade, ((0, 0), (0, -wide)))

    def _settle(self, w: int, o: int, fingertips: Sequence[int]) -> None:
        """Those fingertips of an object are on places that are known near there, or on new ones."""
        before, patterns = self._fields[w][o], self._level.patterns
        wanted = {
            f: Place.on_grid(f, self._new_faces[w, f, o], self._new_middles[w, f, o]) for f in fingertips
        }
        held = self._x[w, o, : len(before.rates)]
        current = self._current[w, :, o].tolist()
        move = moved(before, current, wanted, self._widths, patterns, held, MOST_PLACES)
        after = self._known.field(o, self._materials[w][o], move.places, move.whole)
        self._current[w, :, o] = move.current
        if after is not before:
            heat = carried_states(before, after, patterns, held)
            self._fields[w][o] = after
            self._renumber(w)
            self._x[w, o] = 0.0
            self._x[w, o, : len(heat)] = heat
        for f in range(len(self._pads)):
            self._place(w, f, o)
        for f, place in wanted.items():
            self._sought_faces[w, f, o], self._sought_middles[w, f, o] = place.face, place.whole
        self._stale[w] = True

    def _place(self, w: int, f: int, o: int) -> None:
        number = int(self._current[w, f, o])
        self._sought_faces[w, f, o] = -1
        if number < 0:
            self._faces[w, f, o] = -1
            return
        place = self._fields[w][o].places[number]
        self._faces[w, f, o], self._middles[w, f, o] = place.face, place.whole

    def _spread(self, w: int, f: int, o: int) -> None:
        """How a narrow contact's heat spreads in the object at the pair's place."""
        field, current, width = self._fields[w][o], self._current[w, :, o].tolist(), float(self._widths[f])
        at = int(current[f])
        behind = [
            field.places[number]
            for g, number in enumerate(current)
            if g != f and number >= 0 and self._closed[w, g, o] and self._pad_kinds[g] == self._pad_kinds[f]
        ]
        by = pressed_behind(field.places[at], behind, field.below[at][1], width)
        wall = wall_of(self._materials[w][o], *field.below[at], width, by)
        self._pairs.spread(w, f, o, wall)

    def _join(self, w: int) -> None:
        """The systems of a world's closed contacts."""
        self._outdated = True
        if len(self._pool) > MOST_SYSTEMS + 2 * self._plan.size:
            self._forget()
        objects = len(self._shapes)
        for f, o in np.argwhere(self._current[w] >= 0).tolist():
            self._spread(w, f, o)
        pairs: list[Pair] = [(f, t) for f, t in np.argwhere(self._closed[w]).tolist()]
        self._plan[w] = -1
        owners = self._pool.owners
        for number, group in enumerate(groups(pairs, objects, owners)):
            fields = {t: self._fields[w][t] for t in sorted({t for _, t in group if t < objects})}
            current = {(owners[f], t): int(self._current[w, owners[f], t]) for f, t in group if t < objects}
            self._plan[w, number] = self._pool.number(group, fields, current)


def _padded(rows: Sequence[np.ndarray]) -> np.ndarray:
    """The rows behind one another, zeros behind the shorter ones."""
    table = np.zeros((len(rows), max(len(row) for row in rows)))
    for target, row in zip(table, rows, strict=True):
        target[: len(row)] = row
    return table
