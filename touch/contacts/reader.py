"""Contacts of a simulation, read after each of its steps by compiled code: which pad, which object, how hard, where.

W: worlds, F: fingertips, O: objects, T = O + F: targets, G: geoms of the objects, N = G + F: what a pad may meet.
"""

# mujoco ships no type stubs for its compiled names
# pyright: reportAttributeAccessIssue=false

from __future__ import annotations

import ctypes
from collections.abc import Mapping, Sequence
from dataclasses import replace
from typing import Any

import mujoco
import numpy as np

from thermograsp.errors import SimulationError

from ...thermal import CONTACT_LAW, Material
from ...thermal.contact import CURVED_TABLE
from ...thermal.padded import RINGS, ring_sides
from ..pointers import table
from ..scene import BodyShape, PadPlace
from .columns import COLUMNS
from .laws import Pressed, pair_laws, stacked
from .memory import ContactMemory
from .pad_contacts import AROUND, PAD, PLACED, SPOT
from .round_pads import bends, curves
from .sensors import SensorPlaces
from .step_contacts import read_contacts
from .tilt import TILT
from .views import stacked_views


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
        # of each geom: the fingertip, or F plus its number among the objects' geoms, or -1; the last is of geom -1, by
        # which MuJoCo means a flex
        self._role = np.full(model.ngeom + 1, -1, np.int64)
        self._pads = np.zeros((count, PAD))
        for f, pad in enumerate(pads):
            self._role[list(pad.geoms)] = f
            self._pads[f, :AROUND] = (*pad.position, *pad.axes.ravel(), *pad.half_sides, pad.stack.width)
            if pad.surround is not None:
                self._pads[f, AROUND:] = np.array(ring_sides(pad.stack.width, pad.surround)) / 2
        geoms = [(o, geom) for o, shape in enumerate(shapes) for geom in shape.geoms]
        self._role[[geom for _, geom in geoms]] = count + np.arange(len(geoms))
        for shape in shapes:
            self._role[list(shape.pieces)] = self._role[shape.geoms[0]]
        # of what a pad may meet: the target, the geom (-1 for a fingertip), its body, of meshes their views; of
        # fingertips too
        parts = [(o, geom, int(model.geom_bodyid[geom])) for o, geom in geoms]
        parts += [(objects + f, -1, pad.body) for f, pad in enumerate(pads)]
        self._views, viewed, self._radii = stacked_views(model, [geom for _, geom in geoms], count)
        self._parts = np.column_stack((np.array(parts, np.int64), viewed))
        self._model, self._of_pads, self._shapes = model, tuple(pads), tuple(shapes)
        # of each combination of the objects' materials that there is, and which of them each world has; laws of faces
        # by axis, and behind them those of the pads around them
        self._known: dict[tuple[Material, ...], int] = {}
        self._laws = np.zeros((0, 0, 0, 6), CONTACT_LAW)
        self._curved = np.zeros((0, 0, 0, 3, 1 + RINGS), np.int64)
        self._tilts = np.zeros((0, 0, 0, 3, TILT))
        self._every: list[np.ndarray] = []
        self._pressed: dict[Pressed, int] = {}  # the numbers of their tables, made when first touched
        self._failed: list[BaseException] = []  # while a table was made, until it is raised
        self._which = np.zeros(worlds, np.int64)
        self._pushed = np.zeros((count, len(parts), 3))
        self._frames, self._spot = np.zeros((count, PLACED)), np.zeros(SPOT)
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
                numbers = [*map(self._number, found.tables), *map(self._number_of, found.pressed)]
                numbers = np.array([*numbers, -1])  # the last of flat targets
                before = self._laws, self._curved, self._tilts
                both = np.concatenate((found.laws, found.beside), axis=-1)
                curved = np.concatenate((found.curved[..., None], found.around), axis=-1)
                after = both[None], numbers[curved][None], found.tilts[None]
                if len(self._known) > 1:
                    after = tuple(map(np.concatenate, zip(before, after, strict=True)))
                self._laws, self._curved, self._tilts = after
            self._which[w] = self._known[combination]
        self._tables = stacked(self._every)
        self._make = _making(self._pressed, self._tables, self._failed)
        self._point()

    def _number(self, table: np.ndarray) -> int:
        """Of a table of curved contacts among those of all materials."""
        for n, known in enumerate(self._every):
            if known is table:
                return n
        self._every.append(table)
        return len(self._every) - 1

    def _number_of(self, pressed: Pressed) -> int:
        """Of the table of a mesh or a ring, which is 0 until a pad touches it."""
        if pressed not in self._pressed:
            self._pressed[pressed] = len(self._every)
            self._every.append(np.zeros(CURVED_TABLE))
        return self._pressed[pressed]

    def __getstate__(self) -> dict[str, Any]:
        return {name: value for name, value in self.__dict__.items() if name != "_make"}

    def __setstate__(self, state: dict[str, Any]) -> None:
        """A copy, whose arrays are elsewhere."""
        self.__dict__.update(state)
        self._make = _making(self._pressed, self._tables, self._failed)
        self._point()

    def _point(self) -> None:
        """Says where the first world's arrays are."""
        first = self._which[0]
        self._first_laws, self._first_curved = self._laws[first], self._curved[first]
        self._first_tilts = self._tilts[first]
        arrays = (
            *(self._role, self._pads, self._parts, self._bend, self._curve),
            *(self._pushed, self.touches, self.beside, self._first_laws, self._first_curved, self._tables),
            *(self._frames, self._spot, self._first_tilts, self._views, self._radii, self.counted),
        )
        self._places = None
        sizes = len(self._role), *self.touches.shape[1:3], len(self._parts), len(self._tables)
        sizes += self._views.shape[1], ctypes.cast(self._make, ctypes.c_void_p).value or 0
        self._table = table(arrays, sizes)
        self._table_address = self._table.ctypes.data

    def read(self, data: mujoco.MjData, weight: int = 1) -> None:
        """Adds the contacts of the step that was just taken, for so many substeps. Raises SimulationError for forces
        that are not finite, and what went wrong where a table could not be made."""
        self.counted += weight
        count = data.ncon
        if count == 0:
            return
        memory = self.memory(data)
        if not memory.follows:
            memory.refresh()
        if not read_contacts(count, weight, memory.address, self._table_address):
            raise self.failure(data.time)

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
        sums += self._frames, self._spot, self._tilts, self._views, self._radii, self.counted
        sizes = len(self.beside), places.size, *map(len, sensed[:3]), *self._pushed.shape[:2]
        make = self._views.shape[1], ctypes.cast(self._make, ctypes.c_void_p).value or 0
        return table((*arrays, *room, *sums), (*sizes, self.touches.shape[2], len(self._tables), *make, 0))

    def clear(self) -> None:
        """Sums start anew."""
        self.touches[:] = 0.0
        self.beside[:] = 0.0
        self.substeps = 0

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


def _making(pressed: Mapping[Pressed, int], tables: np.ndarray, failed: list[BaseException]) -> Any:
    """What compiled code calls to have the table of that number made: 1, or 0 and why in `failed`, since nothing can be
    raised through compiled code."""
    of = {number: each for each, number in pressed.items()}

    def make(number: int) -> int:
        try:
            tables[number] = of[number].table()
        except BaseException as error:  # noqa: BLE001  (raised by the caller; Ctrl-C too)
            failed.append(error)
            return 0
        return 1

    return _MAKE(make)
