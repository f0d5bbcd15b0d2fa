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

CONTACTS, FORCES, XPOS, XMAT, GEOM_XPOS, GEOM_XMAT, STRIDE, POS, FRAME, GEOM, DIM, EFC, LENGTH = range(13)
"""Of a table: addresses of the places where the addresses of mjContact and of efc_force stand, addresses of poses;
mjContact's size in bytes, and where its fields are, in numbers of their own size."""
_WORD = 8
_FIELDS = (("pos", POS), ("frame", FRAME), ("geom", GEOM), ("dim", DIM), ("efc_address", EFC))
_MOST = 1 << 16  # words of an mjData


class ContactMemory:
    """Of one MjData. table: (LENGTH,) integers, as the constants say; it holds while the MjData lives."""

    def __init__(self, data: mujoco.MjData) -> None:
        self._data, self._said = data, np.zeros(2, np.int64)
        self.table = np.zeros(LENGTH, np.int64)
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
        words = self._said.ctypes.data + _WORD * np.arange(2)
        self.address = self.table.ctypes.data
        """Of the table; it holds as long as this does."""
        self.table[:2] = words if places is None else data._address + _WORD * np.array(places)

    def __reduce__(self) -> tuple[type[ContactMemory], tuple[mujoco.MjData]]:
        """A copy is of a copy of the MjData, which is elsewhere."""
        return ContactMemory, (self._data,)

    def refresh(self) -> None:
        """Says where the contacts of the step that was just taken are."""
        self._said[:] = _contacts(self._data), self._data.efc_force.ctypes.data


def _contacts(data: mujoco.MjData) -> int:
    """The address of the first mjContact."""
    found = data.contact
    return found.pos.ctypes.data - _WORD * int(_layout()[POS - STRIDE])


@cache
def _pressed() -> mujoco.MjData:
    """A simulation with a contact."""
    model = mujoco.MjModel.from_xml_string(
        "<mujoco><worldbody><geom type='plane' size='1 1 1'/><body pos='0 0 .009'><freejoint/><geom size='.01'/></body>"
        "</worldbody></mujoco>"
    )
    data = mujoco.MjData(model)
    mujoco.mj_forward(model, data)
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
def _places() -> tuple[int, int] | None:
    """Words of an mjData in which the addresses of contacts and forces stand; None where this MuJoCo's bindings do not
    tell where an mjData is."""
    data = _pressed()
    first = getattr(data, "_address", None)
    if first is None or ctypes.c_uint64.from_address(first).value != data.narena:
        return None
    found = []
    for wanted in (_contacts(data), data.efc_force.ctypes.data):
        at = next(
            (n for n in range(_MOST) if ctypes.c_uint64.from_address(first + _WORD * n).value == wanted), None
        )
        if at is None:
            return None
        found.append(at)
    return found[0], found[1]
