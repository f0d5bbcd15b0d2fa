"""What a ThermalTouch does after nearly every step of one MjData, or with nearly every record of many worlds, as one
call of compiled code with one address: it looks whether one step has passed, adds its contacts, and at a sample's end
advances heat and electronics."""

from __future__ import annotations

from collections.abc import Callable
from functools import cache

import numpy as np
from numba import types  # pyright: ignore[reportPrivateImportUsage]

from thermograsp.compiled import njit

from .contacts import read_contacts, sense_contacts
from .heat import sample
from .pointers import called, called_two, entry, floats, integers, table, words
from .readings import close_sample

NOTHING, DUE, SPENT, FULL, BROKEN, ELSEWHERE = 0, 1, 2, 4, 8, 16
"""What `hear` returns: DUE where a reading is to be made and SPENT where noise is to be drawn, or both; FULL where the
sample's contacts are there and its heat is still to be advanced; BROKEN where a force is not finite or a
mesh's table could not be made; ELSEWHERE where not one step has passed, and nothing has been done."""

_LAST, _STEP, _SUBSTEPS, _TAKEN, _NOW, _CONTACTS, _MEMORY, _READER, _HEAT, _TOUCHES, _ELECTRONICS = range(11)
_OF_SAMPLE, _OF_READING, _READ, _ADVANCE, _CLOSE, _LENGTH = range(11, 17)
"""Of Hearing's table: addresses of the time s of the last update, of a step and what it may be off by, of the substeps
and samples that have been taken; of the data's time and number of contacts; of what the three functions take, HEAT 0
where Python advances it; substeps of a sample and samples of a reading; and the addresses of the three functions."""


class Hearing:
    """What compiled code needs to take a step of one MjData. arrays: last (1,) s, step (2,) s, substeps (1,) and taken
    (1,), which must stay where they are. addresses: of the data's time and number of contacts, of its ContactMemory, of
    a reader, of heat and touches (0 for none), and of the electronics. sizes: substeps of a sample, samples of a
    reading. address: for `hear`, as long as this lives."""

    def __init__(
        self, arrays: tuple[np.ndarray, ...], addresses: tuple[int, ...], sizes: tuple[int, int]
    ) -> None:
        self._arrays = arrays
        self._table = table(arrays, (*addresses, *sizes, *_functions()))
        self.address = self._table.ctypes.data


@cache
def hearer() -> Callable[[int], int]:
    """`hear` as Python calls it soonest: numba does not look again of what kind the address is."""
    return hear.compile((types.int64,))


def compile_hearing() -> None:
    """Compiles what a Hearing needs."""
    _functions()
    hearer()


def compile_record_hearing() -> None:
    """Compiles what a RecordHearing needs."""
    _sensing()
    _of_samples()
    hear_record.compile((types.int64,) * 4)


@cache
def _functions() -> tuple[int, int, int]:
    return entry(read_contacts, 4), *_of_samples()


@cache
def _of_samples() -> tuple[int, int]:
    return entry(sample, 4), entry(close_sample, 2)


@cache
def _sensing() -> int:
    return entry(sense_contacts, 4)


class RecordHearing:
    """What compiled code needs to take a recorded step of many worlds. arrays: last (W,) s, step (2,) s, substeps (1,)
    and taken (1,), which must stay where they are. addresses: of what `sense_contacts` takes, of heat and touches (0
    for none), and of the electronics. sizes: substeps of a sample, samples of a reading. address: for `hear_record`, as
    long as this lives."""

    def __init__(
        self, arrays: tuple[np.ndarray, ...], addresses: tuple[int, ...], sizes: tuple[int, int]
    ) -> None:
        self._heard = np.zeros(1, np.int64)
        self._arrays = *arrays, self._heard
        functions = _sensing(), *_of_samples()
        self._table = table(self._arrays, (len(arrays[0]), *addresses, *sizes, *functions))
        self.address = self._table.ctypes.data

    @property
    def heard(self) -> int:
        """Substeps of the record that have been heard."""
        return int(self._heard[0])


@njit(cache=True, borrows=True, error_model="numpy")
def _close(advance, heat, touches, substeps, taken, of_reading, close, electronics):
    """What hear returns at a sample's end. Addresses and sizes as in Hearing."""
    if heat == 0 or called(advance, heat, touches, substeps[0], 0) != 0:
        return FULL
    substeps[0] = 0
    taken[0] += 1
    due = 0
    if taken[0] == of_reading:
        due, taken[0] = 1, 0
    return DUE * due + SPENT * called_two(close, electronics, due)


@njit(cache=True, borrows=True, error_model="numpy")
def hear_record(at, record_at, first, count):
    """The substeps first to count - 1 of a record at that address, or those up to the end of the first sample after
    which something is to be done, as `hear` tells it. at: a RecordHearing's address."""
    entries = words(at, 15)
    last, step = floats(entries[0], entries[5]), floats(entries[1], 2)
    substeps, taken = words(entries[2], 1), words(entries[3], 1)
    heard = words(entries[4], 1)
    heard[0] = first
    while heard[0] < count:
        begun, heard[0] = heard[0], min(heard[0] + entries[10] - substeps[0], count)
        substeps[0] += heard[0] - begun
        if called(entries[12], record_at, begun, heard[0], entries[6]) == 0:
            return BROKEN
        for _ in range(heard[0] - begun):
            for w in range(len(last)):
                last[w] += step[0]
        if substeps[0] == entries[10]:
            found = _close(
                entries[13], entries[7], entries[8], substeps, taken, entries[11], entries[14], entries[9]
            )
            if found != NOTHING:
                return found
    return NOTHING


@njit(cache=True, borrows=True, error_model="numpy")
def hear(at):
    """To be called after a step. at: a Hearing's address."""
    entries = words(at, _LENGTH)
    last, step, now = (
        floats(entries[_LAST], 1),
        floats(entries[_STEP], 2),
        floats(entries[_NOW], 1),
    )
    if not abs(now[0] - last[0] - step[0]) <= step[1]:
        return ELSEWHERE
    last[0] = now[0]
    substeps, taken = words(entries[_SUBSTEPS], 1), words(entries[_TAKEN], 1)
    substeps[0] += 1
    contacts = integers(entries[_CONTACTS], 1)[0]
    if contacts > 0 and called(entries[_READ], contacts, 1, entries[_MEMORY], entries[_READER]) == 0:
        return BROKEN
    if substeps[0] < entries[_OF_SAMPLE]:
        return NOTHING
    return _close(
        entries[_ADVANCE],
        entries[_HEAT],
        entries[_TOUCHES],
        substeps,
        taken,
        entries[_OF_READING],
        entries[_CLOSE],
        entries[_ELECTRONICS],
    )
