"""Where MuJoCo keeps the contacts of a step, as addresses for compiled code.

The bindings make an array for every field at every access, and compiled code takes each of them apart again: several
times what it costs to read the contacts. The poses of an mjData stay where they are as long as it lives. Contacts and
forces move in an arena from step to step: of these, the places in the mjData are handed over that say where they are.
"""

# mujoco ships no type stubs for its compiled names
# pyright: reportAttributeAccessIssue=false

from __future__ import annotations

import ctypes
from functools import cache

import mujoco
import numpy as np

CONTACTS, FORCES, TYPES, XPOS, XMAT, GEOM_XPOS, GEOM_XMAT, STRIDE, POS, FRAME, GEOM, DIM, EFC, WORDS = range(
    14
)
"""Of a table: addresses of the places where the addresses of mjContact, of efc_force and of efc_type stand, addresses
of poses; mjContact's size in bytes, and where its fields are, in numbers of their own size."""
_WORD = 8
_FIELDS = (("pos", POS), ("frame", FRAME), ("geom", GEOM), ("dim", DIM), ("efc_address", EFC))
_MOST = 1 << 16  # words of an mjData
_POSES = (
    (0.009, 0.0),
    (0.1, 0.0),
    (0.0135, np.pi / 4),
)  # of a box that touches with a face, not at all, with an edge


class ContactMemory:
    """Of one MjData. table: (WORDS,) integers, as the constants say; it holds while the MjData lives."""

    def __init__(self, data: mujoco.MjData) -> None:
        self._data, self._said = data, np.zeros(XPOS, np.int64)
        self.table = np.zeros(WORDS, np.int64)
        for column, array in zip(
            (XPOS, XMAT, GEOM_XPOS, GEOM_XMAT),
            (data.xpos, data.xmat, data.geom_xpos, data.geom_xmat),
            strict=True,
        ):
            self.table[column] = array.ctypes.data
        self.table[STRIDE:] = _layout()
        places = _places()
        self.follows = places is not None
        """Whether the table needs no `refresh` at each step."""
        clock = None if places is None else _clock()
        self.clock = None if clock is None else (data._address + clock[0], data._address + clock[1])
        """Addresses of the data's time s, and of the number of contacts, 32 bits; None where they are not known."""
        words = self._said.ctypes.data + _WORD * np.arange(XPOS)
        self.address = self.table.ctypes.data
        """Of the table; it holds as long as this does."""
        self.table[:XPOS] = words if places is None else data._address + _WORD * np.array(places)

    def __reduce__(self) -> tuple[type[ContactMemory], tuple[mujoco.MjData]]:
        """A copy is of a copy of the MjData, which is elsewhere."""
        return ContactMemory, (self._data,)

    def refresh(self) -> None:
        """Says where the contacts of the step that was just taken are."""
        self._said[:] = _addresses(self._data)


def clock_of(data: mujoco.MjData) -> int | None:
    """The address of the data's time s, which holds while they live; None where it is not known."""
    clock = _clock()
    return None if clock is None else data._address + clock[0]


def _addresses(data: mujoco.MjData) -> tuple[int, int, int]:
    """Of the first mjContact, of efc_force and of efc_type."""
    contacts = data.contact.pos.ctypes.data - _WORD * int(_layout()[POS - STRIDE])
    return contacts, data.efc_force.ctypes.data, data.efc_type.ctypes.data


@cache
def _scene() -> mujoco.MjModel:
    """A box over a plane."""
    return mujoco.MjModel.from_xml_string(
        "<mujoco><worldbody><geom type='plane' size='1 1 1'/><body><freejoint/><geom type='box' size='.01 .01 .01'/>"
        "</body></worldbody></mujoco>"
    )


@cache
def _pressed() -> mujoco.MjData:
    """A simulation with contacts."""
    return _posed(mujoco.MjData(_scene()), 0.009, 0.0)


def _posed(data: mujoco.MjData, height: float, turn: float) -> mujoco.MjData:
    """The box's middle at that height m, turned about a side by that angle."""
    data.qpos[:] = 0.0, 0.0, height, np.cos(turn / 2), np.sin(turn / 2), 0.0, 0.0
    mujoco.mj_forward(_scene(), data)
    return data


@cache
def _layout() -> np.ndarray:
    """The numbers of a table from STRIDE on."""
    found = _pressed().contact
    first = found.dist.ctypes.data  # mjContact's first field
    sizes = [int(found.pos.strides[0])]
    for name, _ in _FIELDS:
        array = getattr(found, name)
        sizes.append((array.ctypes.data - first) // array.itemsize)
    return np.array(sizes, np.int64)


@cache
def _places() -> tuple[int, ...] | None:
    """Words of an mjData in which the addresses of contacts, forces and types stand; None where this MuJoCo's bindings
    do not tell where an mjData is."""
    data = _pressed()
    first = getattr(data, "_address", None)
    if first is None or ctypes.c_uint64.from_address(first).value != data.narena:
        return None
    found = []
    for wanted in _addresses(data):
        at = next(
            (n for n in range(_MOST) if ctypes.c_uint64.from_address(first + _WORD * n).value == wanted), None
        )
        if at is None:
            return None
        found.append(at)
    return tuple(found)


@cache
def _clock() -> tuple[int, int] | None:
    """Bytes of an mjData at which its time and its number of contacts stand; None where that is not found out."""
    places = _places()
    if places is None:
        return None
    data, seen = mujoco.MjData(_scene()), set()
    whole = memoryview((ctypes.c_uint8 * (_WORD * min(places))).from_address(data._address))
    times, counts = np.frombuffer(whole, float), np.frombuffer(whole, np.int32)
    is_time, is_count = np.ones(len(times), bool), np.ones(len(counts), bool)
    for n, (height, turn) in enumerate(_POSES):
        data.time = 0.1 + n
        count = int(_posed(data, height, turn).ncon)
        seen.add(count)
        is_time &= times == data.time
        is_count &= counts == count
    if len(seen) < len(_POSES) or is_time.sum() != 1 or is_count.sum() != 1:
        return None
    return int(is_time.argmax()) * times.itemsize, int(is_count.argmax()) * counts.itemsize
