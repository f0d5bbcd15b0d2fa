"""Contacts of a simulation, read after each of its steps by compiled code: which pad, which object, how hard, where.

W: worlds, F: fingertips, O: objects, T = O + F: targets, G: geoms of the objects, N = G + F: what a pad may meet,
C: contacts.
"""

# mujoco ships no type stubs for its compiled names
# pyright: reportAttributeAccessIssue=false

from __future__ import annotations

import ctypes
import math
from collections.abc import Mapping, Sequence
from dataclasses import replace
from typing import Any

import mujoco
import numpy as np
from numba import carray  # pyright: ignore[reportPrivateImportUsage]

from thermograsp.compiled import njit
from thermograsp.errors import SimulationError

from ...thermal import CONTACT_LAW, Material
from ...thermal.contact import (
    CURVED_TABLE,
    CYLINDER,
    beside_face,
    conductance,
    contact,
    curved_contact,
    curved_shares,
    flat_patch,
)
from ...thermal.padded import RINGS, ring_sides
from ...thermal.pressed import PressedMesh
from ..scene import BodyShape, PadPlace
from .columns import AREA, ASIDE, BESIDE, CLOSED, COLUMNS, CONDUCTANCE, FORCE, LENGTH, NORMAL, PLACE
from .laws import pair_laws, stacked
from .memory import (
    CONTACTS,
    DIM,
    EFC,
    FORCES,
    FRAME,
    GEOM,
    GEOM_XMAT,
    GEOM_XPOS,
    POS,
    STRIDE,
    XMAT,
    XPOS,
    ContactMemory,
)
from .memory import LENGTH as TABLE
from .pointers import asked, flags, floats, integers, laws, table, words
from .round_pads import BEND, CURVES, bends, curves, round_contact
from .sensors import FORCE_AT, PLACE_AT, SensorPlaces
from .tilt import TILT, tilted
from .views import VIEW, stacked_views, viewed

DEPTH = (
    0.004  # m off the pad's plane, up to which a contact is on it, beside half of what the two have sunk in
)
RIM = 0.0005  # m beyond the pad's sides
LOOKING = 0.6  # least cosine between the pad's normal and the contact's

_AXES, _HALF, _WIDTH, _AROUND, _PAD = 3, 12, 14, 15, 15 + RINGS
"""Where a pad's axes, half sides m, its sensor's width m and half the outer sides m of its rings, 0 where it has no
heat, stand behind its position m in the frame of its body."""
_KNOWN, _FRAME = 12, 13
"""Of a pad in the world: its middle m, normal, y and z, and behind them whether these are of this substep."""
_SPOT = 11 + RINGS
"""Numbers of a contact under way: a place, two axes of the pad, by how much it lies at ends, and areas of rings."""


class ContactReader:
    """Reads contacts. What it has read is in `touches` (W, F, T, COLUMNS), see columns.py, and `beside` (W, F) N, sums
    over the `substeps` since `clear`; broken (W,) are the worlds with a force that is not finite."""

    def __init__(
        self, model: mujoco.MjModel, pads: Sequence[PadPlace], shapes: Sequence[BodyShape], worlds: int
    ) -> None:
        count, objects = len(pads), len(shapes)
        self.touches = np.zeros((worlds, count, objects + count, COLUMNS))
        self.beside = np.zeros((worlds, count))
        self.broken = np.zeros(worlds, bool)
        self.counted = np.zeros(1, np.int64)
        """The substeps, which compiled code counts too. It stays where it is."""
        # of each geom: the fingertip, or F plus its number among the objects' geoms, or -1
        self._role = np.full(model.ngeom, -1, np.int64)
        self._pads = np.zeros((count, _PAD))
        for f, pad in enumerate(pads):
            self._role[list(pad.geoms)] = f
            self._pads[f, :_AROUND] = (*pad.position, *pad.axes.ravel(), *(pad.size / 2), pad.stack.width)
            if pad.surround is not None:
                self._pads[f, _AROUND:] = np.array(ring_sides(pad.stack.width, pad.surround)) / 2
        geoms = [(o, geom) for o, shape in enumerate(shapes) for geom in shape.geoms]
        self._role[[geom for _, geom in geoms]] = count + np.arange(len(geoms))
        # of what a pad may meet: the target, the geom (-1 for a fingertip), its body, of meshes their views; of
        # fingertips too
        parts = [(o, geom, int(model.geom_bodyid[geom])) for o, geom in geoms]
        parts += [(objects + f, -1, pad.body) for f, pad in enumerate(pads)]
        self._views, viewed = stacked_views(model, [geom for _, geom in geoms], count)
        self._parts = np.column_stack((np.array(parts, np.int64), viewed))
        self._model, self._of_pads, self._shapes = model, tuple(pads), tuple(shapes)
        # of each combination of the objects' materials that there is, and which of them each world has; laws of faces
        # by axis, and behind them those of the pads around them
        self._known: dict[tuple[Material, ...], int] = {}
        self._laws = np.zeros((0, 0, 0, 6), CONTACT_LAW)
        self._curved = np.zeros((0, 0, 0, 3), np.int64)
        self._tilts = np.zeros((0, 0, 0, 3, TILT))
        self._every: list[np.ndarray] = []
        self._meshes: dict[PressedMesh, int] = {}  # the numbers of their tables, made when first touched
        self._failed: list[BaseException] = []  # while a table was made, until it is raised
        self._which = np.zeros(worlds, np.int64)
        self._pushed = np.zeros((count, len(parts), 3))
        self._frames, self._spot = np.zeros((count, _FRAME)), np.zeros(_SPOT)
        self._poses = tuple(np.zeros((many, size)) for many in (model.nbody, model.ngeom) for size in (3, 9))
        self._places: SensorPlaces | None = None
        self._sensed, self._sensed_at = np.zeros(0, np.int64), 0
        self._bend, self._curve = bends(pads), curves(model, pads, shapes)
        self.set_materials(range(worlds), [tuple(shape.material for shape in shapes)] * worlds)
        self._of: mujoco.MjData | None = None
        self._memory: ContactMemory | None = None

    def set_materials(self, worlds: Sequence[int], materials: Sequence[tuple[Material, ...]]) -> None:
        """What those worlds' objects are made of from now on."""
        for w, combination in zip(worlds, materials, strict=True):
            if combination not in self._known:
                self._known[combination] = len(self._known)
                shapes = [replace(s, material=m) for s, m in zip(self._shapes, combination, strict=True)]
                found = pair_laws(self._model, self._of_pads, shapes)
                numbers = [*map(self._number, found.tables), *map(self._number_of, found.meshes)]
                numbers = np.array([*numbers, -1])  # the last of flat targets
                before = self._laws, self._curved, self._tilts
                both = np.concatenate((found.laws, found.beside), axis=-1)
                after = both[None], numbers[found.curved][None], found.tilts[None]
                if len(self._known) > 1:
                    after = tuple(map(np.concatenate, zip(before, after, strict=True)))
                self._laws, self._curved, self._tilts = after
            self._which[w] = self._known[combination]
        self._tables = stacked(self._every)
        self._make = _making(self._meshes, self._tables, self._failed)
        self._point()

    def _number(self, table: np.ndarray) -> int:
        """Of a table of curved contacts among those of all materials."""
        for n, known in enumerate(self._every):
            if known is table:
                return n
        self._every.append(table)
        return len(self._every) - 1

    def _number_of(self, mesh: PressedMesh) -> int:
        """Of a mesh's table, which is 0 until a pad touches it."""
        if mesh not in self._meshes:
            self._meshes[mesh] = len(self._every)
            self._every.append(np.zeros(CURVED_TABLE))
        return self._meshes[mesh]

    def __getstate__(self) -> dict[str, Any]:
        return {name: value for name, value in self.__dict__.items() if name != "_make"}

    def __setstate__(self, state: dict[str, Any]) -> None:
        """A copy, whose arrays are elsewhere."""
        self.__dict__.update(state)
        self._make = _making(self._meshes, self._tables, self._failed)
        self._point()

    def _point(self) -> None:
        """Says where the first world's arrays are, and whether the model's friction cones are pyramids now."""
        first = self._which[0]
        self._first_laws, self._first_curved = self._laws[first], self._curved[first]
        self._first_tilts = self._tilts[first]
        arrays = (
            *(self._role, self._pads, self._parts, self._bend, self._curve),
            *(self._pushed, self.touches, self.beside, self._first_laws, self._first_curved, self._tables),
            *(self._frames, self._spot, self._first_tilts, self._views),
        )
        self._places = None
        pyramidal = int(self._model.opt.cone == mujoco.mjtCone.mjCONE_PYRAMIDAL)
        sizes = len(self._role), *self.touches.shape[1:3], len(self._parts), pyramidal, len(self._tables)
        sizes += self._views.shape[1], ctypes.cast(self._make, ctypes.c_void_p).value or 0
        self._table = table(arrays, sizes)
        self._table_address = self._table.ctypes.data

    def read(self, data: mujoco.MjData, weight: int = 1) -> None:
        """Adds the contacts of the step that was just taken, for so many substeps. Raises SimulationError for forces
        that are not finite, and what went wrong where a mesh's table could not be made."""
        self.counted += weight
        count = data.ncon
        if count == 0:
            return
        memory = self.memory(data)
        if not memory.follows:
            memory.refresh()
        if not read_contacts(count, weight, memory.address, self._table_address):
            raise self.failure(data.time)

    def sense(self, record: np.ndarray, first: int, last: int, places: SensorPlaces) -> None:
        """Adds what contact sensors recorded of the substeps first to last - 1, (W, substeps, sensordata). Worlds with
        a number that is not finite are `broken` from then on, and nothing more is added to them. Raises what went wrong
        where a mesh's table could not be made."""
        self.counted += last - first
        if not sense_contacts(record.ctypes.data, first, last, self.sensing(places, record.shape[1])):
            raise self._failed.pop()

    def sensing(self, places: SensorPlaces, substeps: int) -> int:
        """The address of what `sense_contacts` takes for records of so many substeps, until a call of set_materials."""
        if places is not self._places:
            self._places, self._sensed = places, self._sensing(places)
            self._sensed_at = self._sensed.ctypes.data
        self._sensed[-1] = substeps
        return self._sensed_at

    def failure(self, time: float) -> BaseException:
        """What to raise where `read_contacts` has returned 0, at `time` s."""
        if self._failed:
            return self._failed.pop()
        return SimulationError(
            f"a contact force is not finite at {time:g} s: the simulation broke down; reset both"
        )

    def _sensing(self, places: SensorPlaces) -> np.ndarray:
        """All addresses and sizes, and room for the record's substeps."""
        sensed = places.pairs, places.poses, places.geoms, places.turns, places.offsets
        arrays = *sensed, self._pads, self._parts, self._laws, self._which, self._bend, self._curve
        room = self._pushed, *self._poses
        sums = self.touches, self.beside, self.broken, self._curved, self._tables
        sums += self._frames, self._spot, self._tilts, self._views
        sizes = len(self.beside), places.size, *map(len, sensed[:3]), *self._pushed.shape[:2]
        make = self._views.shape[1], ctypes.cast(self._make, ctypes.c_void_p).value or 0
        return table((*arrays, *room, *sums), (*sizes, self.touches.shape[2], len(self._tables), *make, 0))

    def clear(self) -> None:
        """Sums start anew, with the model's kind of friction cones as it is now."""
        self.touches[:] = 0.0
        self.beside[:] = 0.0
        self.substeps = 0
        self._point()

    @property
    def substeps(self) -> int:
        """Since `clear`."""
        return int(self.counted[0])

    @substeps.setter
    def substeps(self, count: int) -> None:
        self.counted[0] = count

    def memory(self, data: mujoco.MjData) -> ContactMemory:
        """Of these data, which are those of nearly every call."""
        if data is not self._of or self._memory is None:
            self._of, self._memory = data, ContactMemory(data)
        return self._memory

    @property
    def address(self) -> int:
        """Of what `read_contacts` takes of it, until a call of set_materials."""
        return self._table_address


_MAKE = ctypes.CFUNCTYPE(ctypes.c_int64, ctypes.c_int64)


def _making(meshes: Mapping[PressedMesh, int], tables: np.ndarray, failed: list[BaseException]) -> Any:
    """What compiled code calls to have the table of that number made: 1, or 0 and why in `failed`, since nothing can be
    raised through compiled code."""
    of = {number: mesh for mesh, number in meshes.items()}

    def make(number: int) -> int:
        try:
            tables[number] = of[number].table()
        except BaseException as error:  # noqa: BLE001  (raised by the caller; Ctrl-C too)
            failed.append(error)
            return 0
        return 1

    return _MAKE(make)


@njit(cache=True, error_model="numpy", short_loops=True)
def read_contacts(count, substeps, memory_at, entries_at):
    """Adds `count` contacts to touches and beside. memory_at: the address of ContactMemory's table; entries_at: that of
    addresses and sizes of a ContactReader's arrays. Numbers are handed over in a fraction of the time that arrays take.
    Returns 1, and 0 where a force is not finite or a table could not be made."""
    memory, entries = carray(words(memory_at), TABLE), carray(words(entries_at), 23)
    tips, targets, part_count, pyramidal, sides = (
        entries[16],
        entries[17],
        entries[18],
        entries[19],
        entries[21],
    )
    role = carray(words(entries[0]), entries[15])
    pads = carray(floats(entries[1]), (tips, _PAD))
    parts = carray(words(entries[2]), (part_count, 4))
    bend = carray(floats(entries[3]), (tips, BEND))
    curve = carray(floats(entries[4]), (part_count, 3, CURVES))
    pushed = carray(floats(entries[5]), (tips, part_count, 3))  # room for forces and moments
    touches = carray(floats(entries[6]), (tips, targets, COLUMNS))
    beside = carray(floats(entries[7]), tips)
    law = carray(laws(entries[8]), (tips, part_count, 6))
    curved = carray(words(entries[9]), (tips, part_count, sides))
    tables = carray(floats(entries[10]), (entries[20], CURVED_TABLE))
    frames, spot = carray(floats(entries[11]), (tips, _FRAME)), carray(floats(entries[12]), _SPOT)
    tilts = carray(floats(entries[13]), (tips, part_count, 3, TILT))
    views = carray(floats(entries[14]), (part_count, sides, VIEW))
    place = carray(words(memory[CONTACTS]), 1)[0]
    numbers = carray(floats(place), (count, memory[STRIDE] // 8))
    whole = carray(integers(place), (count, memory[STRIDE] // 4))
    efc = carray(floats(carray(words(memory[FORCES]), 1)[0]), 0)  # as many as MuJoCo says
    xpos, xmat = carray(floats(memory[XPOS]), (1, 3)), carray(floats(memory[XMAT]), (1, 9))
    geom_xpos, geom_xmat = (
        carray(floats(memory[GEOM_XPOS]), (1, 3)),
        carray(floats(memory[GEOM_XMAT]), (1, 9)),
    )
    pos, frame = numbers[:, memory[POS] :], numbers[:, memory[FRAME] :]
    geom, dim, address = whole[:, memory[GEOM] :], whole[:, memory[DIM]], whole[:, memory[EFC]]
    weight = float(substeps)
    any_touch = False
    for c in range(count):
        first, second = role[geom[c, 0]], role[geom[c, 1]]
        if first < 0 or second < 0 or address[c] < 0 or first == second:
            continue
        sign = 1.0
        if first >= tips or (second < tips and second < first):
            first, second, sign = second, first, -1.0
        if first >= tips:
            continue
        force = efc[address[c]]
        if pyramidal == 1 and dim[c] > 1:
            for k in range(1, 2 * (dim[c] - 1)):
                force += efc[address[c] + k]
        if not math.isfinite(force):
            return 0
        if force <= 0.0:
            continue
        if not any_touch:
            _begin(pushed, frames)
            any_touch = True
        part = second - tips if second >= tips else part_count - tips + second
        _frame(pads, parts, xpos, xmat, frames, first)
        sunk = max(-numbers[c, 0], 0.0) / 2  # mjContact's first field is the distance, its place is half way
        on, y, z = _lies(pads[first], frames[first], pos[c], frame[c], sign, sunk)
        if second < tips:
            _frame(pads, parts, xpos, xmat, frames, second)
            on_other, _, _ = _lies(pads[second], frames[second], pos[c], frame[c], -sign, sunk)
            if not on_other:
                beside[second] += weight * force
            on = on and on_other
        if on:
            pushed[first, part, 0] += force
            pushed[first, part, 1] += force * y
            pushed[first, part, 2] += force * z
        else:
            beside[first] += weight * force
    if any_touch and not _feel(
        xpos, xmat, geom_xpos, geom_xmat, pads, frames, parts, law, curved, tables, tilts, bend, curve, pushed,
        touches, weight, spot, views, entries[22],
    ):  # fmt: skip
        return 0
    return 1


@njit(cache=True, error_model="numpy", short_loops=True)
def sense_contacts(record_at, first, last, entries_at):
    """read_contacts of recorded sensors, world by world. record_at: the address of the record (W, substeps,
    sensordata), of which the substeps first to last - 1 are read; entries_at: that of ContactReader's `sensing`.
    Returns 1, and 0 where a table could not be made."""
    entries = carray(words(entries_at), 37)
    worlds, size, pairs, poses, geoms = entries[25], entries[26], entries[27], entries[28], entries[29]
    tips, part_count, targets, sides = entries[30], entries[31], entries[32], entries[34]
    record = carray(floats(record_at), (worlds, entries[36], size))
    pair, pose, placed = (
        carray(words(entries[0]), (pairs, 3)),
        carray(words(entries[1]), (poses, 3)),
        carray(words(entries[2]), (geoms, 2)),
    )
    turns, offsets = carray(floats(entries[3]), (geoms, 9)), carray(floats(entries[4]), (geoms, 3))
    pads, parts = carray(floats(entries[5]), (tips, _PAD)), carray(words(entries[6]), (part_count, 4))
    which = carray(words(entries[8]), worlds)
    kinds = which.max() + 1
    law = carray(laws(entries[7]), (kinds, tips, part_count, 6))
    curved = carray(words(entries[19]), (kinds, tips, part_count, sides))
    tables = carray(floats(entries[20]), (entries[33], CURVED_TABLE))
    views = carray(floats(entries[24]), (part_count, sides, VIEW))
    tilts = carray(floats(entries[23]), (kinds, tips, part_count, 3, TILT))
    frames, spot = carray(floats(entries[21]), (tips, _FRAME)), carray(floats(entries[22]), _SPOT)
    bend = carray(floats(entries[9]), (tips, BEND))
    curve = carray(floats(entries[10]), (part_count, 3, CURVES))
    pushed = carray(floats(entries[11]), (tips, part_count, 3))  # room for forces and moments
    # room for the poses of the bodies and geoms, as many as the model has
    xpos, xmat = carray(floats(entries[12]), (1, 3)), carray(floats(entries[13]), (1, 9))
    geom_xpos, geom_xmat = carray(floats(entries[14]), (1, 3)), carray(floats(entries[15]), (1, 9))
    touches = carray(floats(entries[16]), (worlds, tips, targets, COLUMNS))
    beside, broken = carray(floats(entries[17]), (worlds, tips)), carray(flags(entries[18]), worlds)
    for w in range(worlds):
        kind = which[w]
        if not _sense_world(
            record, w, first, last, pair, pose, placed, turns, offsets, pads, parts, law[kind], curved[kind], tables,
            tilts[kind], views, bend, curve, pushed, frames, spot, xpos, xmat, geom_xpos, geom_xmat, touches[w],
            beside[w], broken, entries[35],
        ):  # fmt: skip
            return 0
    return 1


@njit(cache=True, inner=True, borrows=True, error_model="numpy", forceinline=True)
def _sense_world(
    record, w, first, last, pair, pose, placed, turns, offsets, pads, parts, laws, curved, tables, tilts, views, bend,
    curve, pushed, frames, spot, xpos, xmat, geom_xpos, geom_xmat, touches, beside, broken, make,
):  # fmt: skip
    """sense_contacts of one world. Returns whether every table that it needs could be made."""
    pairs, poses, geoms, tips, part_count = len(pair), len(pose), len(placed), len(pads), len(parts)
    for n in range(first, last):
        if broken[w]:
            break
        data, total, any_touch = record[w, n], 0.0, False
        for p in range(pairs):
            at = pair[p, 2]
            total += (
                (data[at + PLACE_AT] + data[at + PLACE_AT + 1])
                + (data[at + PLACE_AT + 2] + data[at + FORCE_AT])
                + (data[at + FORCE_AT + 1] + data[at + FORCE_AT + 2])
                + data[at]
            )
            any_touch = any_touch or data[at] > 0
        for p in range(poses):
            at, quat = pose[p, 1], pose[p, 2]
            total += data[at] + data[at + 1] + data[at + 2]
            total += (data[quat] + data[quat + 1]) + (data[quat + 2] + data[quat + 3])
        if not math.isfinite(total):
            broken[w] = True
            break
        if not any_touch:
            continue
        for p in range(poses):
            body, at, quat = pose[p, 0], pose[p, 1], pose[p, 2]
            a, b, c, d = data[quat], data[quat + 1], data[quat + 2], data[quat + 3]
            for k in range(3):
                xpos[body, k] = data[at + k]
            turn = xmat[body]
            turn[0], turn[4], turn[8] = (
                a * a + b * b - c * c - d * d,
                a * a - b * b + c * c - d * d,
                a * a - b * b - c * c + d * d,
            )
            turn[1], turn[3] = 2 * (b * c - a * d), 2 * (b * c + a * d)
            turn[2], turn[6] = 2 * (b * d + a * c), 2 * (b * d - a * c)
            turn[5], turn[7] = 2 * (c * d - a * b), 2 * (c * d + a * b)
        for g in range(geoms):
            geom, body = placed[g, 0], placed[g, 1]
            for i in range(3):
                x, y, z = xmat[body, 3 * i], xmat[body, 3 * i + 1], xmat[body, 3 * i + 2]
                geom_xpos[geom, i] = xpos[body, i] + (
                    x * offsets[g, 0] + y * offsets[g, 1] + z * offsets[g, 2]
                )
                for k in range(3):
                    geom_xmat[geom, 3 * i + k] = x * turns[g, k] + y * turns[g, 3 + k] + z * turns[g, 6 + k]
        _begin(pushed, frames)
        for p in range(pairs):
            if data[pair[p, 2]] > 0:
                first_tip, part = pair[p, 0], pair[p, 1]
                _frame(pads, parts, xpos, xmat, frames, first_tip)
                if part >= part_count - tips:
                    _frame(pads, parts, xpos, xmat, frames, part - (part_count - tips))
                _press(data, pair[p, 2], pads, frames, first_tip, part, part_count, pushed, beside)
        if not _feel(
            xpos, xmat, geom_xpos, geom_xmat, pads, frames, parts, laws, curved, tables, tilts, bend, curve, pushed,
            touches, 1.0, spot, views, make,
        ):  # fmt: skip
            return False
    return True


@njit(cache=True, error_model="numpy", inline="always")
def _begin(pushed, frames):
    """Forces, moments and frames of a substep start anew."""
    for f in range(len(frames)):
        frames[f, _KNOWN] = 0.0
        for g in range(pushed.shape[1]):
            pushed[f, g, 0] = 0.0
            pushed[f, g, 1] = 0.0
            pushed[f, g, 2] = 0.0


@njit(cache=True, inner=True, borrows=True, error_model="numpy", forceinline=True)
def _frame(pads, parts, xpos, xmat, frames, f):
    """Fills frames[f] with where pad f is in the world, unless it is known in this substep."""
    if frames[f, _KNOWN] > 0.0:
        return
    frames[f, _KNOWN] = 1.0
    body = parts[len(parts) - len(pads) + f, 2]
    for k in range(3):
        x, y, z = xmat[body, 3 * k], xmat[body, 3 * k + 1], xmat[body, 3 * k + 2]
        frames[f, k] = xpos[body, k] + (x * pads[f, 0] + y * pads[f, 1] + z * pads[f, 2])
        for i in range(3):
            at = _AXES + i
            frames[f, 3 + 3 * i + k] = x * pads[f, at] + y * pads[f, at + 3] + z * pads[f, at + 6]


@njit(cache=True, error_model="numpy", inline="always")
def _press(data, at, pads, frames, f, part, part_count, pushed, beside):
    """A net force on a pad or beside it; of another fingertip only where it is on that one's pad too."""
    tips = len(pads)
    on, y, z, force = _bears(data, at, pads[f], frames[f], 1.0)
    if part >= part_count - tips:
        other = part - (part_count - tips)
        on_other, _, _, back = _bears(data, at, pads[other], frames[other], -1.0)
        if not on_other and back > 0:
            beside[other] += back
        on = on and on_other
    if force > 0:
        if on:
            pushed[f, part, 0] += force
            pushed[f, part, 1] += force * y
            pushed[f, part, 2] += force * z
        else:
            beside[f] += force


@njit(cache=True, error_model="numpy", inline="always")
def _bears(data, at, pad, frame, sign):
    """Whether a net force is on a pad, where (m, along its y and z), and its part along the normal, N."""
    place, vector = data[at + PLACE_AT : at + PLACE_AT + 3], data[at + FORCE_AT : at + FORCE_AT + 3]
    x, y, z, force = _from_pad(frame, place, vector, sign)
    return force > 0 and _within(pad, x, y, z, 0.0), y, z, force


@njit(cache=True, error_model="numpy", inline="always")
def _lies(pad, frame, place, vector, sign, sunk):
    """Whether a contact is on a pad and looks at it, and where (m, along its y and z). sunk: m below both faces."""
    x, y, z, cosine = _from_pad(frame, place, vector, sign)
    return cosine >= LOOKING and _within(pad, x, y, z, sunk), y, z


@njit(cache=True, error_model="numpy", inline="always")
def _from_pad(frame, place, vector, sign):
    """Where a place is from a pad's middle, m along its normal, y and z, and the vector's part along the normal."""
    x, y, z, along = 0.0, 0.0, 0.0, 0.0
    for k in range(3):
        away = place[k] - frame[k]
        along += sign * frame[3 + k] * vector[k]
        x += away * frame[3 + k]
        y += away * frame[6 + k]
        z += away * frame[9 + k]
    return x, y, z, along


@njit(cache=True, error_model="numpy", inline="always")
def _within(pad, x, y, z, sunk):
    return abs(x) <= DEPTH + sunk and abs(y) <= pad[_HALF] + RIM and abs(z) <= pad[_HALF + 1] + RIM


@njit(cache=True, inner=True, borrows=True, error_model="numpy", forceinline=True)
def _feel(
    xpos, xmat, geom_xpos, geom_xmat, pads, frames, parts, laws, curved, tables, tilts, bend, curve, pushed, touches,
    weight, spot, views, make,
):  # fmt: skip
    """Adds what presses on the pads to the touches. Returns whether every table that it needs could be made."""
    tips, part_count = len(pads), len(parts)
    place, sides, shares, rings = spot[:3], spot[3:7], spot[7:11], spot[11:]
    for f in range(tips):
        if frames[f, _KNOWN] == 0.0:
            continue  # nothing has met it
        middle, normal, side_y, side_z = frames[f, :3], frames[f, 3:6], frames[f, 6:9], frames[f, 9:12]
        last = -1  # target that was touched; an object's geoms follow one another
        for g in range(part_count):
            force = pushed[f, g, 0]
            if force <= 0:
                continue
            target, geom, body = parts[g, 0], parts[g, 1], parts[g, 2]
            axis = 0
            if geom >= 0:
                most = 0.0
                x, y, z = (
                    middle[0] - geom_xpos[geom, 0],
                    middle[1] - geom_xpos[geom, 1],
                    middle[2] - geom_xpos[geom, 2],
                )
                for i in range(3):
                    one, two, three = geom_xmat[geom, i], geom_xmat[geom, 3 + i], geom_xmat[geom, 6 + i]
                    place[i] = one * x + two * y + three * z
                    looking = abs(one * normal[0] + two * normal[1] + three * normal[2])
                    if looking > most:
                        most, axis = looking, i
            else:
                # another fingertip: how far the pads' middles are apart along this one's sides
                other = g - (part_count - tips)
                place[0], place[1], place[2] = 0.0, 0.0, 0.0
                for k in range(3):
                    away = middle[k] - xpos[body, k]
                    for j in range(3):
                        away -= xmat[body, 3 * k + j] * pads[other, j]
                    place[1] += away * side_y[k]
                    place[2] += away * side_z[k]
            law = laws[f, g, axis]
            bulging = bend[f, 0] + bend[f, 1] > 0
            if geom < 0:
                bulging = bulging or curve[g, 0, 0] + curve[g, 0, 1] > 0
            conducts, area, share, kept, long = 0.0, 0.0, 0.0, 1.0, 0.0
            number, first, second, whole, lying = -1, 0.0, 0.0, 1.0, force
            for k in range(4):
                shares[k] = 0.0
            if not bulging and parts[g, 3] > 0:
                for i in range(3):
                    one, two, three = geom_xmat[geom, i], geom_xmat[geom, 3 + i], geom_xmat[geom, 6 + i]
                    sides[i] = one * normal[0] + two * normal[1] + three * normal[2]
                view, first, second = viewed(views[g], parts[g, 3], sides, place, law.half_face)
                number = curved[f, g, view]
                if tables[number, 1] == 0.0 and asked(make, number) == 0:
                    return False
            elif not bulging and curved[f, g, axis] >= 0:
                # A round body presses where MuJoCo says, which need not be on the sensor's face.
                number, first, second = curved[f, g, axis], pushed[f, g, 1] / force, pushed[f, g, 2] / force
                if law.shape == CYLINDER:
                    # MuJoCo may name any point of the line of contact: only what is across it is heard.
                    along_y, along_z = 0.0, 0.0
                    for k in range(3):
                        along_y += side_y[k] * geom_xmat[geom, 3 * k + 2]
                        along_z += side_z[k] * geom_xmat[geom, 3 * k + 2]
                    length = math.sqrt(along_y * along_y + along_z * along_z)
                    across = first * along_z - second * along_y
                    slope, away = 0.0, 0.0
                    for k in range(3):
                        slope += geom_xmat[geom, 3 * k + 2] * normal[k]
                        away += (middle[k] - geom_xpos[geom, k]) * normal[k]
                    first, second = 0.0, 0.0
                    if length > 0:
                        # along the pad
                        first, second, slope = (
                            across / length,
                            (place[2] - slope * away) / length,
                            slope / length,
                        )
                    whole, lying = tilted(tilts[f, g, axis], force, slope, second)
            elif bulging:
                _sides(geom_xmat, frames, f, geom, g - (part_count - tips), axis, sides)
                area, share, kept, longer = round_contact(
                    bend[f], curve[g, axis], sides, force, pushed[f, g, 1] / force, pushed[f, g, 2] / force
                )
                long = math.sqrt(area * kept * longer)
            else:
                area, share = contact(law, force, place)
                if area > 0:
                    long = flat_patch(law, area, place, shares)
            if number >= 0 and whole > 0:
                conducts, area, long = curved_contact(tables[number], lying / whole, first, second)
                curved_shares(tables[number], lying / whole, first, second, shares)
                conducts, area, long = whole * conducts, whole * area, whole * long
            if share > 0 and area > 0:
                conducts, area = conductance(law, share / area) * area * kept, area * kept
            touch = touches[f, target]
            if conducts > 0:
                touch[CONDUCTANCE] += weight * conducts
                touch[AREA] += weight * area
                touch[LENGTH] += weight * area * long
                for k in range(4):
                    touch[ASIDE + k] += weight * area * shares[k]
                if target != last:
                    touch[CLOSED] += weight
                    last = target
            if pads[f, _AROUND] > 0 and geom >= 0:
                # of objects that are one flat box each, which the scene sees to
                through = beside_face(laws[f, g, 3 + axis], pads[f, _AROUND:], force, place, rings)
                for ring in range(RINGS):
                    if rings[ring] > 0:
                        at = BESIDE + 3 * ring
                        touch[at] += weight * through * rings[ring]
                        touch[at + 1] += weight * rings[ring]
                        touch[at + 2] += weight
            touch[FORCE] += weight * force
            x, y, z = middle[0] - xpos[body, 0], middle[1] - xpos[body, 1], middle[2] - xpos[body, 2]
            for i in range(3):
                one, two, three = xmat[body, i], xmat[body, 3 + i], xmat[body, 6 + i]
                touch[PLACE + i] = one * x + two * y + three * z
                touch[NORMAL + i] = one * normal[0] + two * normal[1] + three * normal[2]
    return True


@njit(cache=True, error_model="numpy", inline="always")
def _sides(geom_xmat, frames, f, geom, other, axis, sides):
    """Fills sides (4,) with where the two axes of what a pad meets that lie across point, along the pad's y and z: of a
    geom, or of the other fingertip's pad."""
    n = 0
    for i in range(3):
        if geom >= 0 and i == axis:
            continue
        if geom < 0 and i == 0:
            continue
        y, z = 0.0, 0.0
        for k in range(3):
            points = geom_xmat[geom, 3 * k + i] if geom >= 0 else frames[other, 3 + 3 * i + k]
            y += points * frames[f, 6 + k]
            z += points * frames[f, 9 + k]
        sides[2 * n], sides[2 * n + 1] = y, z
        n += 1
