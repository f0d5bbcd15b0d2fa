"""numba's `njit`, whose compiled code is kept on disk only as long as nothing that was compiled into it has changed.

numba itself looks no further than the file that holds the function. A function inlined from another file and a constant
of another module are part of the machine code too: after a change of theirs numba would go on with the old code. Here
the code is kept under a hash of the function, of all that it calls and of every value that it refers to.
"""

from __future__ import annotations

import functools
import gc
import glob
import hashlib
import inspect
import logging
import os
import pickle
import types
import warnings
from collections.abc import Callable, Iterator, Mapping, Sequence
from contextlib import contextmanager, nullcontext
from typing import Any, cast

import numba
import numpy as np
from numba.core import event, ir
from numba.core.caching import CompileResultCacheImpl, FunctionCache, IndexDataCacheFile, NullCache
from numba.core.codegen import JITCodeLibrary
from numba.core.compiler import Compiler
from numba.core.compiler_lock import global_compiler_lock
from numba.core.dispatcher import Dispatcher
from numba.core.environment import lookup_environment
from numba.core.extending import _Intrinsic
from numba.core.postproc import PostProcessor, VariableLifetime
from numba.core.registry import cpu_target
from numba.core.serialize import dumps
from numba.core.sigutils import normalize_signature
from numba.core.targetconfig import TargetConfig
from numba.core.transforms import canonicalize_cfg
from numba.core.types.functions import BaseFunction

from thermograsp.beside import start_beside, turn
from thermograsp.errors import InvalidValueError
from thermograsp.notice import notice

_LOG = logging.getLogger(__name__)
_REPORTED: list[str] = []
"""The first function that this process has compiled."""

_FIXED_OPTIONS = {"fastmath": False, "error_model": "python", "forceinline": False, "_nrt": True}
"""Options that a function would otherwise take from the caller for which it is first compiled, and keep for all."""

_ENVIRONMENT = "_ZN08NumbaEnv"
"""How numba names what holds a function's environment."""

_PLAIN = frozenset(
    {numba.types.Float, numba.types.Integer, numba.types.Boolean, numba.types.Complex, numba.types.Array}
)
"""Kinds of types on which alone depends what an operator makes of them."""

_NUMBERS = numba.types.IntegerLiteral, numba.types.BooleanLiteral
"""The type of a number that is written into the code."""

_DEFAULTS: dict[type, dict[str, Any]] = {}
"""The default of every option of a kind of numba's configurations."""

_BELOW = ("numpy", "numba", "scipy")
"""Packages whose functions numba compiles in its own way: their names say it."""


def njit(
    *,
    cache: bool = False,
    inner: bool = False,
    short_loops: bool = False,
    borrows: bool = False,
    **options: Any,
) -> Callable[[Callable[..., Any]], Any]:
    """A decorator as numba.njit is, whose functions compile sooner.

    cache: keep the compiled code beside the source, or where NUMBA_CACHE_DIR says. inner: only compiled code calls the
    function. No entry from Python is then compiled, which may take longer than the function itself; a call from Python
    raises TypeError. Every other function has an inner twin, which compiled code calls; its entry is compiled when
    Python first calls it. A number written into a call is an argument as others are: numba would compile the function
    once more for each. short_loops: the innermost loops run over few elements, so the processor's vectors are not used
    for them. The results have the same bits, and the function compiles and runs in less time. borrows: it makes no
    arrays, it only looks at those that it is given: nothing counts who holds them, which takes a call for each part of
    one. It may return a part to others that borrow, not to a function that counts.
    """
    if borrows:
        options["_nrt"] = False

    def compiled(function: Callable[..., Any]) -> Any:
        entries: dict[str, Any] = {"no_cpython_wrapper": inner, "no_cfunc_wrapper": True}
        entries["pipeline_class"] = (
            _InnerCompiler if inner else _ShortLoopsCompiler if short_loops else _OuterCompiler
        )
        dispatcher: Any = numba.njit(**{**_FIXED_OPTIONS, **options, **entries})(function)
        if cache:
            dispatcher._cache = _cache(dispatcher, inner)
        dispatcher.compile = _quickly(dispatcher)
        if inner:  # numba would take the entry that is not there
            dispatcher._insert = _nothing
            dispatcher._compile_for_args = functools.partial(_refused, function.__name__)
            dispatcher.called = lambda: dispatcher
            dispatcher.get_call_template = _without_numbers(dispatcher.get_call_template)
        else:

            @functools.cache
            def twin() -> Any:
                return njit(cache=cache, inner=True, **options)(function)

            dispatcher.called = twin
            dispatcher.get_call_template = lambda *arguments: twin().get_call_template(*arguments)
            dispatcher.get_overload = lambda signature: twin().get_overload(signature)
        return dispatcher

    return compiled


class _InnerLibrary(JITCodeLibrary):
    """Code that is compiled into its callers' only: with them it is optimised and becomes machine code."""

    @property
    def codegen(self) -> Any:
        """Without an engine, where numba would note the function's environment: its callers' code holds that too."""
        return _NoEngine

    def serialize_using_object_code(self) -> Any:
        return self.serialize_using_bitcode()

    def _optimize_final_module(self) -> None:
        pass

    def _finalize_final_module(self) -> None:
        self._finalize_dynamic_globals()
        self._verify_declare_only_symbols()
        self._finalized = True


class _ShortLoopsLibrary(JITCodeLibrary):
    """Code whose loops take one element after the other. Of an inner loop over three coordinates LLVM would make two
    versions, of which the one for many elements never runs."""

    def _optimize_final_module(self) -> None:
        made = self._codegen._module_pass_manager(loop_vectorize=False)
        passes, *builder = made if isinstance(made, tuple) else (made,)  # numba 0.61 makes no builder
        passes.run(self._final_module, *builder)


class _NoEngine:
    @staticmethod
    def set_env(name: str, environment: Any) -> None:
        pass


class _InnerCompiler(Compiler):
    """numba's, into an _InnerLibrary."""

    _library: type[JITCodeLibrary] = _InnerLibrary

    def __init__(self, typingctx: Any, targetctx: Any, library: Any, *rest: Any) -> None:
        library = self._library(targetctx.codegen(), self._library.__name__)
        library.enable_object_caching()
        super().__init__(typingctx, targetctx, library, *rest)


class _OuterCompiler(_InnerCompiler):
    """numba's, into a library that Python can call."""

    _library = JITCodeLibrary


class _ShortLoopsCompiler(_InnerCompiler):
    """numba's, into a library that Python can call and whose loops are left as they are."""

    _library = _ShortLoopsLibrary


def _without_numbers(call_template: Callable[..., Any]) -> Callable[..., Any]:
    """A dispatcher's get_call_template, for any numbers of the arguments' types."""

    def plain(kind: Any) -> Any:
        return numba.types.unliteral(kind) if isinstance(kind, _NUMBERS) else kind

    def run(arguments: Any, keywords: Any) -> Any:
        named = {name: plain(kind) for name, kind in keywords.items()}
        return call_template(tuple(map(plain, arguments)), named)

    return run


def _quickly(dispatcher: Any) -> Callable[[Any], Any]:
    """The dispatcher's compile in less time. The code then learns the environments of inner functions."""
    compile_ = dispatcher.compile

    @functools.wraps(compile_)
    def run(signature: Any) -> Any:
        arguments = tuple(normalize_signature(signature)[0])
        if (known := dispatcher.overloads.get(arguments)) is not None:
            return known.entry_point
        with global_compiler_lock, _turn(dispatcher, signature), _in_less_time(), _into(_InnerLibrary):
            missed = sum(dispatcher.stats.cache_misses.values())
            entry = compile_(signature)
            if sum(dispatcher.stats.cache_misses.values()) == missed:
                _let_age()
        library = dispatcher.overloads[arguments].library
        for held in library._final_module.global_variables:
            if held.name.startswith(_ENVIRONMENT) and (found := lookup_environment(held.name)) is not None:
                library.codegen.set_env(held.name, found)
        return entry

    return run


@contextmanager
def _turn(dispatcher: Any, signature: Any) -> Iterator[None]:
    """While one process compiles a function, the others wait for what it keeps."""
    cache = dispatcher._cache
    if not isinstance(cache, _Cache):
        yield
        return
    with turn(cache.cache_path, cache.number(signature, dispatcher.targetctx.codegen())):
        yield


def compile_beside(module: str, *needed: Any, by: str = "compile_ahead") -> None:
    """Where the code of one of the needed functions, or of an inner twin (`called`) that is given in its place, is not
    kept on disk yet, a second process calls that function of the module while this one goes on (see start_beside). This
    one waits only where it needs what the other is compiling at that moment. The code is the same whoever compiles it.
    One second process at a time has the same first function."""
    caches = [function._cache for function in needed]
    if all(isinstance(cache, _Cache) for cache in caches) and not all(cache.keeps_any() for cache in caches):
        start_beside(module, caches[0].cache_path, by)


def _let_age() -> None:
    """What has been loaded lasts as long as the process. Python puts it among its oldest objects at once: it would
    search all of it for cycles twice, for some 10 ms each, the second time amid somebody's steps."""
    if gc.get_freeze_count() == 0:
        gc.freeze()
        gc.unfreeze()


@contextmanager
def _in_less_time() -> Iterator[None]:
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


@contextmanager
def _into(library: type[JITCodeLibrary]) -> Iterator[None]:
    """While it lasts, numba makes libraries of that kind, also of its own functions, which only compiled code calls."""
    codegen = cast(Any, cpu_target.target_context).codegen()
    before, codegen._library_class = codegen._library_class, library
    try:
        yield
    finally:
        codegen._library_class = before


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


def _nothing(*_: Any) -> None:
    pass


def _refused(name: str, *_: Any, **__: Any) -> None:
    raise TypeError(f"{name} is for compiled functions: it was compiled without an entry from Python")


def compiled_hash(kernel: Any) -> str:
    """Hash of all that is compiled into an njit function: its own code and options, what it calls, and the values
    that it refers to. Raises InvalidValueError where it refers to something whose value cannot be read."""
    total = hashlib.sha256()
    for piece in _pieces(kernel, set()):
        total.update(piece.encode() + b"\0")
    return total.hexdigest()


def _cache(dispatcher: Any, inner: bool) -> FunctionCache | NullCache:
    """Where the function's code is kept: nowhere where numba knows no place for it, as for text that was executed."""
    try:
        return _Cache(dispatcher, inner)
    except RuntimeError:
        return NullCache()


@functools.lru_cache(maxsize=8)
def _warn_of_no_folder(reason: str) -> None:
    """Once, not for every function."""
    warnings.warn(
        f"cannot keep compiled code ({reason}): every process compiles it again, which takes some seconds; make room, "
        "or set NUMBA_CACHE_DIR to a writable folder",
        RuntimeWarning,
        stacklevel=2,
    )


_Chosen, _BesideSource = cast(tuple[Any, Any], tuple(CompileResultCacheImpl._locator_classes[:2]))
"""numba's places of code: in NUMBA_CACHE_DIR, and in the source's folder. Their names depend on numba's version."""


class _Unwritable(_BesideSource):
    """Where no folder can be written: the source's. What others have kept can still be read."""

    @classmethod
    def from_function(cls, py_func: Any, py_file: str) -> Any:
        return cls(py_func, py_file) if os.path.exists(py_file) else None


class _Implementation(CompileResultCacheImpl):
    """numba's, with one more place to try."""

    _locator_classes = (*CompileResultCacheImpl._locator_classes, _Unwritable)


class _Cache(FunctionCache):
    """A kernel's compiled code on disk. The hash is taken when the code is first looked for, as a function may refer
    to what its module defines after it."""

    _impl_class = _Implementation

    def __init__(self, dispatcher: Any, inner: bool) -> None:
        super().__init__(dispatcher.py_func)
        self._dispatcher = dispatcher
        self._inner = inner
        self._hashed = False

    def load_overload(self, sig: Any, target_context: Any) -> Any:
        self._hash()
        with _into(_InnerLibrary if self._inner else JITCodeLibrary):
            found = super().load_overload(sig, target_context)
        if found is None:
            _tell(self._dispatcher.py_func.__name__)
        return found

    def save_overload(self, sig: Any, data: Any) -> None:
        """Where nothing can be written, this process has its code all the same, and the next one compiles again."""
        self._hash()
        try:
            super().save_overload(sig, data)
        except OSError as error:
            _warn_of_no_folder(error.strerror or str(error))

    def keeps_any(self) -> bool:
        """Whether code of the function as it is now is on disk, for whatever arguments."""
        self._hash()
        return self._cache_file.holds_any()

    def number(self, sig: Any, codegen: Any) -> int:
        """What processes that compile the function for such arguments call it."""
        self._hash()
        name = f"{self._cache_file._index_name}\0{self._cache_file._source_stamp}\0".encode()
        key = dumps(self._index_key(sig, codegen))
        return 1 + int.from_bytes(hashlib.sha256(name + key).digest()[:6])

    def _hash(self) -> None:
        if not self._hashed:
            stamp = compiled_hash(self._dispatcher)
            name = self._impl.filename_base + (".inner" if self._inner else "")
            shared = [_CacheFile(folder, name, stamp) for folder in self._shared()]
            self._cache_file = _CacheFile(self._cache_path, name, stamp, shared)
            self._hashed = True

    def _shared(self) -> Iterator[str]:
        """Folders that numba would have taken if this user could write them: others may have filled them."""
        function = self._dispatcher.py_func
        for kind in (_Chosen, _BesideSource):
            if type(self._impl.locator) is kind:
                return
            if kind is _BesideSource or cast(Any, numba).config.CACHE_DIR:
                yield kind(function, inspect.getfile(function)).get_cache_path()


def _tell(name: str) -> None:
    """Says once that this process compiles, and logs what."""
    if not _REPORTED:
        _REPORTED.append(name)
        notice("compiling for this processor, once: `thermograsp warmup` does it ahead ...")
    _LOG.info("compiling %s", name)


class _CacheFile(IndexDataCacheFile):
    """Safe where processes write at once. A file of code is named by what it holds and is written before the index
    that names it; of two indices written at once one is lost, and with it no more than the time to compile again.
    Every file begins with a hash of the rest: one that is damaged, as by a loss of power, is as good as none.

    shared: files that are only read, before this one."""

    def __init__(
        self, cache_path: str, filename_base: str, source_stamp: str, shared: Sequence[_CacheFile] = ()
    ) -> None:
        super().__init__(cache_path, filename_base, source_stamp)
        self._shared = shared

    def load(self, key: Any) -> Any:
        for file in self._shared:
            if (found := file.load(key)) is not None:
                return found
        return super().load(key)

    def holds_any(self) -> bool:
        """Whether it has code for whatever arguments."""
        return any(file.holds_any() for file in self._shared) or bool(self._load_index())

    def save(self, key: Any, data: Any) -> None:
        content = hashlib.sha256(f"{self._source_stamp}\0".encode() + dumps(key)).hexdigest()
        base = self._index_name.removesuffix(".nbi")
        name = f"{base}.{content[:24]}.nbc"
        self._save_data(name, data)
        known = self._load_index()
        self._save_index({**known, key: name})
        if not known:
            self._remove_others(base, name)

    def _load_index(self) -> dict[Any, str]:
        kept = self._read(self._index_path)
        if (
            kept is None or kept[0] != self._version
        ):  # numba's; another one's keys may mean nothing to this one
            return {}
        stamp, names = pickle.loads(kept[1])
        return names if stamp == self._source_stamp else {}

    def _save_index(self, overloads: Mapping[Any, str]) -> None:
        self._write(self._index_path, (self._version, self._dump((self._source_stamp, overloads))))

    def _load_data(self, name: str) -> Any:
        return self._read(self._data_path(name))

    def _save_data(self, name: str, data: Any) -> None:
        self._write(self._data_path(name), data)

    def _write(self, path: str, data: Any) -> None:
        content = self._dump(data)
        with self._open_for_write(path) as file:
            file.write(hashlib.sha256(content).digest() + content)

    def _read(self, path: str) -> Any:
        """What _write wrote there; None where there is nothing of it."""
        try:
            with open(path, "rb") as file:
                found, content = file.read(hashlib.sha256().digest_size), file.read()
        except OSError:
            return None
        if hashlib.sha256(content).digest() != found:
            _LOG.info("%s is damaged: its code is compiled again", path)
            return None
        return pickle.loads(content)

    def _remove_others(self, base: str, kept: str) -> None:
        """Code of an older version."""
        for path in glob.iglob(os.path.join(glob.escape(self._cache_path), f"{glob.escape(base)}.*.nbc")):
            if os.path.basename(path) != kept:
                try:
                    os.unlink(path)
                except OSError:  # another process was faster, or has it open
                    pass


def _pieces(value: Any, seen: set[int]) -> Iterator[str]:
    """Text that differs where what is compiled differs. seen: functions that are already in it."""
    if isinstance(value, Dispatcher):
        yield f"compiler {cast(Any, value)._compiler.pipeline_class.__name__}"
        for name, option in sorted(value.targetoptions.items()):
            yield f"option {name}"
            yield from _pieces(option, seen)
        yield from _pieces(value.py_func, seen)
    elif callable(value) and (getattr(value, "__module__", None) or "").partition(".")[0] in _BELOW:
        yield f"name {value.__module__}.{getattr(value, '__qualname__', value)}"
    elif isinstance(value, types.FunctionType):
        yield f"function {value.__module__}.{value.__qualname__}"
        if id(value) not in seen:
            seen.add(id(value))
            yield from _function(value, seen)
    elif isinstance(value, _Intrinsic):
        yield "intrinsic"
        yield from _pieces(value._defn, seen)
    elif isinstance(value, np.ndarray) and value.dtype != object:
        content = hashlib.sha256(np.ascontiguousarray(value).tobytes()).hexdigest()
        yield f"array {value.dtype.str} {value.shape} {content}"
    elif isinstance(value, tuple | list):
        yield f"{type(value).__name__} of {len(value)}"
        for one in value:
            yield from _pieces(one, seen)
    elif isinstance(value, frozenset | set):
        yield f"set {sorted(map(repr, value))}"
    elif isinstance(value, Mapping):
        for key in sorted(value, key=repr):
            yield f"key {key!r}"
            yield from _pieces(value[key], seen)
    elif isinstance(value, type):
        yield f"class {value.__module__}.{value.__qualname__} {getattr(value, '_fields', ())}"
    elif (
        value is None
        or value is Ellipsis
        or isinstance(value, int | float | complex | str | bytes | np.generic)
    ):
        yield f"{type(value).__name__} {value!r}"
    elif isinstance(value, np.dtype | numba.types.Type):
        yield f"type {value!r}"
    elif isinstance(value, types.BuiltinFunctionType | np.ufunc) or inspect.ismodule(value):
        yield f"name {value.__name__}"
    else:
        raise InvalidValueError(
            f"a compiled function cannot refer to {value!r} ({type(value).__name__}): nothing would show whether it "
            "has changed since the code was compiled; pass it as an argument"
        )


def _function(function: types.FunctionType, seen: set[int]) -> Iterator[str]:
    yield from _pieces(function.__defaults__, seen)
    for cell in function.__closure__ or ():
        yield from _pieces(cell.cell_contents, seen)
    for code in _codes(function.__code__):
        yield code.co_code.hex()
        yield repr((code.co_names, code.co_varnames, code.co_freevars, code.co_cellvars, code.co_argcount))
        yield from _pieces([one for one in code.co_consts if not isinstance(one, types.CodeType)], seen)
        for name in code.co_names:
            if name not in function.__globals__:
                continue
            value = function.__globals__[name]
            yield f"global {name}"
            yield from _pieces(value, seen)
            if inspect.ismodule(value) and value.__name__.partition(".")[0] not in _BELOW:
                for attribute in code.co_names:
                    if hasattr(value, attribute):
                        yield f"attribute {attribute}"
                        yield from _pieces(getattr(value, attribute), seen)


def _codes(code: types.CodeType) -> Iterator[types.CodeType]:
    """A function's code and that of those defined in it."""
    yield code
    for one in code.co_consts:
        if isinstance(one, types.CodeType):
            yield from _codes(one)
