"""MuJoCo's clock, by which the steps of one MjData are heard while MuJoCo takes them.

mj_step asks a clock when each of its parts begins and ends, for `data.timer`. The last time that it asks in a step, the
data's time has advanced, and the contacts and forces of the step are still there. A clock of compiled code that looks
whether the time has advanced hears every step of one call, and nothing else of MuJoCo is touched: errors are raised by
its bindings, and the timers go on as the clock that was there says.

The integrator RK4 also puts the time ahead in the midst of a step: its steps are not heard so.
"""

# mujoco ships no type stubs for its compiled names
# pyright: reportAttributeAccessIssue=false

from __future__ import annotations

import ctypes
import threading
from collections.abc import Callable
from functools import cache
from pathlib import Path
from typing import Any

import mujoco
import numpy as np
from llvmlite import ir
from numba.core.compiler_lock import global_compiler_lock
from numba.core.registry import cpu_target

from thermograsp.compiled import njit

from ..contacts import clock_of
from ..heard import DUE, ELSEWHERE, NOTHING, hear
from ..pointers import asked, called_one, entry, floats, words
from ..thermal_touch import ThermalTouch

_BEFORE, _THREAD, _NOW, _SEEN, _HEARING, _DUE, _ASK, _WHO, _HEAR, _LENGTH = range(10)
"""Of the clock's table: the address of the clock that was there; the thread whose steps are heard, 0 for none;
addresses of the data's time, of the time that was seen last and that of the last reading, and of a Hearing, 0 for none;
whether that reading is to be made; and addresses of functions: what Python does, what tells the thread, `hear`."""
_WORD = 8
_SELF_TEST_STEPS = 3


def heard_steps(
    touch: ThermalTouch, step: Callable[..., None], model: mujoco.MjModel, data: mujoco.MjData, nstep: int
) -> bool:
    """Takes so many steps of the touch's data by MuJoCo's `step` as it was, and updates the touch after each. Returns
    False, and does nothing, where they cannot be heard: MuJoCo's library or the places in an MjData are not known,
    somebody has put a clock of their own there, or other steps are being heard. Raises what an update raises; the steps
    behind it are taken all the same, and not heard."""
    clock = _clock()
    return clock is not None and clock.hears(touch, step, model, data, nstep)


class _Clock:
    """In MuJoCo's library, of which `place` is where the address of its clock stands."""

    def __init__(self, place: ctypes.c_void_p) -> None:
        self._place = place
        self._table, self._times = np.zeros(_LENGTH, np.int64), np.zeros(2)
        # Python reads or writes one number of a memoryview in half the time that it takes with an array
        self._entries, self._time = self._table.data, self._times.data
        self._finish = _ASKED(self._finished)
        self._table[_SEEN] = self._times.ctypes.data
        self._table[_ASK] = _address(self._finish)
        self._table[_WHO] = _address(ctypes.pythonapi.PyThread_get_thread_ident)
        self._table[_HEAR] = entry(hear, 1)
        self._library, self._address = _compiled(self._table.ctypes.data)
        self._touch: Any = None
        self._data: Any = None
        self._known: Any = None  # the data that were heard last, and where their time is
        self._failed: BaseException | None = None

    def hears(
        self, touch: Any, step: Callable[..., None], model: mujoco.MjModel, data: mujoco.MjData, nstep: int
    ) -> bool:
        """As heard_steps."""
        place, entries = self._place, self._entries
        before = place.value
        if self._touch is not None or mujoco.get_mjcb_time() is not None or not before:
            return False
        if data is not self._known:
            at = clock_of(data)
            if at is None:
                return False
            self._known, entries[_NOW] = data, at
        self._touch, self._data = touch, data
        self._time[0] = data.time
        entries[_BEFORE], entries[_HEARING], entries[_DUE] = before, touch.hearing(data), 0
        entries[_THREAD] = threading.get_ident()
        place.value = self._address
        try:
            step(model, data, nstep)
        finally:
            if place.value == self._address:
                place.value = before
            entries[_THREAD] = 0
            failed, self._touch, self._data, self._failed = self._failed, None, None, None
            if entries[_DUE]:
                touch.due(self._time[1])
        if failed is not None:
            raise failed
        return True

    def _finished(self, found: int) -> int:
        """What is left to Python after a step, of which `hear` has returned `found`. Returns what hears the next one;
        nothing can be raised through MuJoCo's code."""
        try:
            if self._entries[_DUE]:
                self._entries[_DUE] = 0
                if not found & DUE:
                    self._touch.due(self._time[1])
            return self._touch.heard(self._data, found)
        except BaseException as error:  # noqa: BLE001  (raised behind the step; Ctrl-C too)
            self._failed, self._entries[_THREAD] = error, 0
            return 0


_ASKED = ctypes.CFUNCTYPE(ctypes.c_int64, ctypes.c_int64)


@cache
def _clock() -> _Clock | None:
    """None where MuJoCo's library is not found, or does not ask as it should."""
    home = Path(mujoco.__path__[0])
    for path in (*home.glob("libmujoco.so*"), *home.glob("libmujoco*.dylib"), *home.glob("mujoco.dll")):
        try:
            clock = _Clock(ctypes.c_void_p.in_dll(ctypes.CDLL(str(path)), "mjcb_time"))
        except (OSError, ValueError, AttributeError):
            continue
        if _works(clock):
            return clock
    return None


class _Times:
    """In place of a touch: the times at which it was told of a step."""

    def __init__(self) -> None:
        self.times: list[float] = []

    def hearing(self, data: mujoco.MjData) -> int:
        del data
        return 0

    def heard(self, data: mujoco.MjData, found: int) -> int:
        self.times.append(data.time if found == ELSEWHERE else np.nan)
        return 0


def _works(clock: _Clock) -> bool:
    """Whether it tells of each step once."""
    model = mujoco.MjModel.from_xml_string("<mujoco/>")
    data, found, step = mujoco.MjData(model), _Times(), model.opt.timestep
    if not clock.hears(found, mujoco.mj_step, model, data, _SELF_TEST_STEPS):
        return False
    return found.times == np.cumsum([step] * _SELF_TEST_STEPS).tolist()


@njit(cache=True, error_model="numpy")
def look(table_at):
    """What the clock does where the time has advanced. table_at: the address of its table."""
    entries = words(table_at, _LENGTH)
    now, seen = floats(entries[_NOW], 1), floats(entries[_SEEN], 2)
    seen[0] = now[0]
    found = ELSEWHERE
    if entries[_HEARING] != 0:
        found = called_one(entries[_HEAR], entries[_HEARING])
    if found == DUE:  # made once, behind the last step
        entries[_DUE], seen[1] = 1, now[0]
    elif found != NOTHING:
        entries[_HEARING] = asked(entries[_ASK], found)
    return 0


def _address(function: Any) -> int:
    return ctypes.cast(function, ctypes.c_void_p).value or 0


def _compiled(table_at: int) -> tuple[Any, int]:
    """The clock as MuJoCo calls it, without an argument, and its address: it says what the clock that was there says,
    and looks where the time of the data is another one than it was. It is asked thirty times a step, by all threads. Of
    the process, as the addresses in it are; it holds as long as the first of the two lives."""
    word, number = ir.IntType(64), ir.DoubleType()
    module, name = ir.Module("thermograsp.clock"), "thermograsp_clock"
    function = ir.Function(module, ir.FunctionType(number, ()), name)
    every, ours, advanced, end = (function.append_basic_block() for _ in range(4))
    builder = ir.IRBuilder(every)
    # numba's functions take addresses for what they return and raise before their arguments
    found, raised = builder.alloca(word), builder.alloca(word)

    def value(n: int) -> Any:
        return builder.load(builder.inttoptr(ir.Constant(word, table_at + n * _WORD), word.as_pointer()))

    def called(address: Any, kind: Any, *arguments: Any) -> Any:
        taken = ir.FunctionType(kind, [each.type for each in arguments])
        return builder.call(builder.inttoptr(address, taken.as_pointer()), arguments)

    def number_at(n: int) -> Any:
        return builder.load(builder.inttoptr(value(n), number.as_pointer()))

    time = called(value(_BEFORE), number)
    # only this thread keeps the data alive: no other may look at them
    builder.cbranch(builder.icmp_unsigned("==", called(value(_WHO), word), value(_THREAD)), ours, end)
    builder.position_at_end(ours)
    builder.cbranch(builder.fcmp_unordered("!=", number_at(_NOW), number_at(_SEEN)), advanced, end)
    builder.position_at_end(advanced)
    called(ir.Constant(word, entry(look, 1)), ir.IntType(32), found, raised, ir.Constant(word, table_at))
    builder.branch(end)
    builder.position_at_end(end)
    builder.ret(time)
    with global_compiler_lock:
        library = cpu_target.target_context.codegen().create_library(name)
        library.add_ir_module(module)
        library.finalize()
    return library, library.get_pointer_to_function(name)
