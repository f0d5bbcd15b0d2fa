"""numba in less time: what of it is replaced while it compiles."""

from __future__ import annotations

import functools
import gc
from collections.abc import Iterator
from contextlib import contextmanager, nullcontext
from typing import Any

import numba
from numba.core import event, ir
from numba.core.postproc import PostProcessor, VariableLifetime
from numba.core.targetconfig import TargetConfig
from numba.core.transforms import canonicalize_cfg
from numba.core.types.functions import BaseFunction

_PLAIN = frozenset(
    {numba.types.Float, numba.types.Integer, numba.types.Boolean, numba.types.Complex, numba.types.Array}
)
"""Kinds of types on which alone depends what an operator makes of them."""

_DEFAULTS: dict[type, dict[str, Any]] = {}
"""The default of every option of a kind of numba's configurations."""


def let_age() -> None:
    """What has been loaded lasts as long as the process. Python puts it among its oldest objects at once: it would
    search all of it for cycles twice, for some 10 ms each, the second time amid somebody's steps."""
    if gc.get_freeze_count() == 0:
        gc.freeze()
        gc.unfreeze()


@contextmanager
def in_less_time() -> Iterator[None]:
    """While it lasts, Python collects no cycles: of what a compilation builds, it would search all a thousand times
    and find little. numba's options, which it compares tens of thousands of times, make their dictionaries at once in
    place of calling a property for each. numba finds only once what an operator makes of numbers and arrays: at each
    place it would try all that the operator can mean, for dates too. After each of its passes it finds no variables
    that only generators and Python's objects need. And it takes no times, which nobody reads."""
    collects = gc.isenabled()
    calls: Any = BaseFunction
    call_type = calls.get_call_type
    kept = [(place, name, getattr(place, name)) for place, name, _ in _QUICKER]
    gc.disable()
    for place, name, quicker in _QUICKER:
        setattr(place, name, quicker)
    if not isinstance(call_type, _CallTypes):
        calls.get_call_type = _CallTypes(call_type)
    try:
        yield
    finally:
        for place, name, before in kept:
            setattr(place, name, before)
        calls.get_call_type = call_type
        if collects:
            gc.enable()


class _CallTypes:
    """numba's BaseFunction.get_call_type, which remembers what it found for numbers and arrays. What it finds depends
    on the caller's options only where it compiles something, and that is not remembered."""

    def __init__(self, search: Any) -> None:
        self._search = search
        self._remembered: dict[Any, Any] = {}

    def __get__(self, function: Any, kind: Any) -> Any:
        return self if function is None else functools.partial(self, function)

    def __call__(self, function: Any, context: Any, args: Any, kws: Any) -> Any:
        if kws or any(type(one) not in _PLAIN for one in args):
            return self._search(function, context, args, kws)
        key = function, context, args
        if (known := self._remembered.get(key)) is None:
            known = self._search(function, context, args, kws)
            if function._impl_keys[known.args] is function.typing_key:
                self._remembered[key] = known
        else:
            function._impl_keys[known.args] = function.typing_key
        return known


def _values(self: Any) -> dict[str, Any]:
    """TargetConfig.values, in the options' order."""
    if (kind := type(self)) not in _DEFAULTS:
        _DEFAULTS[kind] = {name: option.default for name, option in kind.options.items()}
    return {**_DEFAULTS[kind], **self._values}


def _variables(self: Any, value: Any) -> list[Any]:
    """ir.Inst._rec_list_vars."""
    if isinstance(value, dict):
        value = value.values()
    elif not isinstance(value, list | tuple):
        return (
            [value] if isinstance(value, ir.Var) else value.list_vars() if isinstance(value, ir.Inst) else []
        )
    found: list[Any] = []
    for one in value:
        kind = type(one)
        if kind is ir.Var:
            found.append(one)
        elif kind is not ir.Loc and kind is not str:
            found += _variables(self, one)
    return found


def _processed(self: Any, emit_dels: bool = False, extend_lifetimes: bool = False) -> None:
    """PostProcessor.run."""
    found = self.func_ir
    if emit_dels or extend_lifetimes or found.is_generator:
        _PROCESSED(self, emit_dels, extend_lifetimes)
        return
    found.blocks = canonicalize_cfg(found.blocks)
    found.variable_lifetime, found.generator_info = VariableLifetime(found.blocks), None


_PROCESSED = PostProcessor.run
_QUICKER: tuple[tuple[Any, str, Any], ...] = (
    (TargetConfig, "values", _values),
    (ir.Inst, "_rec_list_vars", _variables),
    (PostProcessor, "run", _processed),
    (event, "install_timer", lambda kind, callback: nullcontext()),
)
"""What of numba is replaced while it compiles."""
