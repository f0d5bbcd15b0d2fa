"""Compiled code on disk is used only where nothing that was compiled into it has changed."""

import gc
import importlib
import os
import pkgutil
import subprocess
import sys
import textwrap
from pathlib import Path

import numpy as np
import pytest
from numba.core.dispatcher import Dispatcher

from thermograsp.compiled import compiled_hash, njit
from thermograsp.compiled.quicker import let_age
from thermograsp.errors import InvalidValueError

FILES = {
    "lower.py": """
from thermograsp.compiled import njit

@njit(cache=True, inline="always")
def inlined(x):
    return x + 1.0

@njit(cache=True)
def called(x):
    return 2.0 * inlined(x)
""",
    "limits.py": "LARGEST = 100.0\nSTEPS = (1.0, 2.0)\n",
    "upper.py": """
import limits
from limits import STEPS
from lower import called, inlined
from thermograsp.compiled import njit

@njit(cache=True)
def kernel(x):
    return min(called(x) + inlined(x) + STEPS[1], limits.LARGEST)
""",
}


def result(folder: Path) -> tuple[float, int]:
    """What a new process gets from the kernel, and how often it had to compile it."""
    code = """
from upper import kernel
print(kernel(1.0), sum(kernel.stats.cache_misses.values()))
"""
    beside = {name: value for name, value in os.environ.items() if name != "NUMBA_CACHE_DIR"}
    done = subprocess.run(
        [sys.executable, "-B", "-c", code], cwd=folder, env=beside, capture_output=True, text=True
    )
    assert done.returncode == 0, done.stderr
    value, compiled = done.stdout.split()
    return float(value), int(compiled)


@pytest.mark.slow
def test_a_hash_does_not_depend_on_the_process() -> None:
    code = """
from thermograsp.compiled import compiled_hash
from thermograsp.thermal.network import advance
print(compiled_hash(advance))
"""
    hashes = set()
    for seed in "1", "2", "3", "4":
        done = subprocess.run(
            [sys.executable, "-c", code],
            env={**os.environ, "PYTHONHASHSEED": seed},
            capture_output=True,
            text=True,
        )
        assert done.returncode == 0, done.stderr
        hashes.add(done.stdout)
    assert len(hashes) == 1


@pytest.fixture
def folder(tmp_path: Path) -> Path:
    for name, content in FILES.items():
        (tmp_path / name).write_text(content)
    return tmp_path


def edit(folder: Path, name: str, old: str, new: str) -> None:
    source = (folder / name).read_text()
    assert source.count(old) == 1
    (folder / name).write_text(source.replace(old, new))


def hash_now(folder: Path) -> str:
    """Of the kernel, its modules loaded afresh."""
    names = [name.removesuffix(".py") for name in FILES]
    sys.path.insert(0, str(folder))
    try:
        importlib.invalidate_caches()
        return compiled_hash(importlib.import_module("upper").kernel)
    finally:
        sys.path.remove(str(folder))
        for name in names:
            sys.modules.pop(name, None)


@pytest.mark.slow
def test_an_edit_of_what_was_compiled_in_is_never_missed(folder: Path) -> None:
    """Nor does code of an older version pile up."""
    assert result(folder) == (8.0, 1)
    files = sorted(path.suffix for path in (folder / "__pycache__").glob("upper.kernel*"))
    assert files == [".nbc", ".nbi"]
    assert result(folder) == (8.0, 0)
    edit(folder, "lower.py", "x + 1.0", "x + 10.0")
    edit(folder, "limits.py", "2.0)", "4.0)")
    assert result(folder) == (2 * 11 + 11 + 4, 1)
    assert sorted(path.suffix for path in (folder / "__pycache__").glob("upper.kernel*")) == files


@pytest.mark.parametrize(
    ("name", "old", "new"),
    [
        ("lower.py", "x + 1.0", "x + 10.0"),  # inlined from another file, straight and through a call
        ("lower.py", "2.0 *", "3.0 *"),  # called in another file
        ("lower.py", 'inline="always"', 'fastmath=True, inline="always"'),
        ("limits.py", "2.0)", "4.0)"),  # a value imported from another file
        ("limits.py", "100.0", "40.0"),  # an attribute of another module
        ("upper.py", "min(", "max("),
    ],
)
def test_every_edit_changes_the_hash(folder: Path, name: str, old: str, new: str) -> None:
    sys.dont_write_bytecode, before_flag = True, sys.dont_write_bytecode
    try:
        before = hash_now(folder)
        edit(folder, name, old, new)
        assert hash_now(folder) != before
    finally:
        sys.dont_write_bytecode = before_flag


def test_an_edit_of_what_is_not_compiled_in_costs_nothing(folder: Path) -> None:
    before = hash_now(folder)
    (folder / "limits.py").write_text("OTHER = 1.0\n" + FILES["limits.py"])
    (folder / "lower.py").write_text(FILES["lower.py"] + "\n# a comment\n\ndef unrelated():\n    return 1\n")
    assert hash_now(folder) == before


@pytest.mark.slow
def test_processes_that_compile_at_once_get_the_right_code(folder: Path) -> None:
    code = """
import sys
import numpy as np
sys.stdin.read()  # wait until all have started
from upper import kernel
for kind in sys.argv[1:]:
    assert kernel(np.dtype(kind).type(1)) == 8, kind
"""
    for _ in range(2):
        processes = [
            subprocess.Popen([sys.executable, "-B", "-c", code, *kinds], cwd=folder, stdin=subprocess.PIPE)
            for kinds in (("f8", "i8"), ("i8", "f8"))
        ]
        for process in processes:
            assert process.stdin is not None
            process.stdin.close()
        assert [process.wait(timeout=300) for process in processes] == [0] * 2


def test_what_cannot_be_hashed_is_refused() -> None:
    unknown = object()

    @njit(cache=True)
    def kernel(x: float) -> float:
        return x if unknown else 0.0

    with pytest.raises(InvalidValueError, match="pass it as an argument"):
        compiled_hash(kernel)


def test_values_and_options_are_told_apart() -> None:
    def hash_of(value: object, **options: bool) -> str:
        @njit(**options)
        def kernel(x: float) -> float:
            return value  # pyright: ignore[reportReturnType]

        return compiled_hash(kernel)

    values = [1, 1.0, 1.0000000000000002, True, "1", (1,), (1, 1), np.ones(2), np.ones(2, np.float32), None]
    hashes = [hash_of(value) for value in values] + [hash_of(1, fastmath=True)]
    assert len(set(hashes)) == len(hashes)
    assert hash_of(np.ones(2)) == hash_of(np.ones(2))


def test_a_call_from_python_of_what_has_no_entry_is_refused() -> None:
    """Also once compiled code has called it, where numba alone would jump to nowhere."""

    @njit(inner=True)
    def called(x: float) -> float:
        return x + 1

    @njit()
    def caller(x: float) -> float:
        return 2 * called(x)

    assert caller(1.0) == 4.0
    with pytest.raises(TypeError, match="called is for compiled functions"):
        called(1.0)


def test_every_kernel_of_the_package_has_a_hash() -> None:
    kernels = 0
    for package in ("thermal", "envs"):
        root = importlib.import_module(f"thermograsp.{package}")
        for module in pkgutil.walk_packages(root.__path__, f"{root.__name__}."):
            if module.name.endswith("sb3"):
                continue
            for value in vars(importlib.import_module(module.name)).values():
                if isinstance(value, Dispatcher):
                    assert len(compiled_hash(value)) == 64
                    kernels += 1
    assert kernels > 50


@pytest.mark.slow
def test_what_an_inner_function_raises_arrives(tmp_path: Path) -> None:
    """From several callers, compiled or found compiled, also where only one of them was edited in between."""
    lines = """
        from thermograsp.compiled import njit
        @njit(cache=True, inner=True)
        def deepest(x, y):
            if x < 0:
                raise ValueError("negative", 3)
            return x / y
        @njit(cache=True, inner=True, forceinline=True)
        def between(x, y):
            return deepest(x, y) + 1
        @njit(cache=True)
        def one(x, y):
            return between(x, y)
        @njit(cache=True)
        def other(x, y):
            return 2 * between(x, y) + deepest(x, y)
    """
    (tmp_path / "inner.py").write_text(textwrap.dedent(lines))
    code = """
import pytest
from inner import one, other, between
for function in (one, other, one):
    with pytest.raises(ValueError) as raised:
        function(-1.0, 1.0)
    assert raised.value.args == ("negative", 3)
    with pytest.raises(ZeroDivisionError):
        function(1.0, 0.0)
with pytest.raises(TypeError, match="for compiled functions"):
    between(1.0, 1.0)
print(one(3.0, 2.0), other(3.0, 2.0))
"""
    for factor, expected in ("2", "2.5 6.5"), ("2", "2.5 6.5"), ("3", "2.5 9.0"):
        edit(tmp_path, "inner.py", "return 2 * between", f"return {factor} * between")
        run = subprocess.run([sys.executable, "-B", "-c", code], cwd=tmp_path, capture_output=True, text=True)
        assert (run.returncode, run.stdout.strip()) == (0, expected), run.stderr


def test_a_function_s_arithmetic_does_not_depend_on_who_calls_it_first() -> None:
    """A caller that may reassociate sums leaves the functions that it calls their own order."""

    @njit(inner=True)
    def summed(x):
        total = 0.0
        for i in range(len(x)):
            total += x[i]
        return total

    @njit(fastmath={"reassoc", "nsz"}, error_model="numpy", forceinline=True)
    def quick(x):
        return summed(x) + x[0] + x[1]

    @njit()
    def plain(x):
        return summed(x)

    x = np.ones(3)
    assert quick(x) == 5.0 and plain(x) == 3.0
    code = {
        kernel: kernel.overloads[kernel.signatures[0]].library.get_llvm_str() for kernel in (quick, plain)
    }
    assert "reassoc" in code[quick] and "reassoc" not in code[plain]


def test_short_loops_use_no_vectors_and_have_the_same_bits() -> None:
    def total(rows, out):
        for i in range(rows.shape[0]):
            for c in range(rows.shape[1]):
                out[i, c] += 2.5 * rows[i, c] + 0.1

    plain, short = njit()(total), njit(short_loops=True)(total)
    assert compiled_hash(plain) != compiled_hash(short)
    results = []
    for function in (plain, short):
        rows, out = np.random.default_rng(0).standard_normal((2, 7, 33))
        function(rows, out)
        results.append(out)
        code = "".join(function.inspect_llvm().values())
        assert ("x double>" in code) == (function is plain)
    assert np.array_equal(*results)


def test_loaded_code_is_old_at_once_but_what_somebody_froze_stays_frozen() -> None:
    def age(one: object) -> int | None:
        found = (n for n in range(3) if any(other is one for other in gc.get_objects(n)))
        return next(found, None)

    gc.disable()
    collected = gc.get_freeze_count() > 0  # by conftest.py, what pytest has collected
    gc.unfreeze()
    try:
        loaded: list[object] = [[]]
        assert age(loaded) == 0
        let_age()
        assert age(loaded) == 2
        gc.freeze()
        young: list[object] = [[]]
        let_age()
        assert age(young) == 0 and gc.get_freeze_count() > 0
    finally:
        gc.unfreeze()
        if collected:
            gc.freeze()
        gc.enable()
