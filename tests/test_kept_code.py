"""Compiled code on disk that is damaged, of another numba, or that can be kept nowhere: it is compiled again."""

from collections.abc import Callable
from pathlib import Path

import pytest
from numba.core.caching import FunctionCache

from thermograsp import compiled
from thermograsp.compiled import _CacheFile, compile_beside, njit

KEY, CODE = ("float64",), {"code": b"0123456789" * 100}
DAMAGES: dict[str, Callable[[bytes], bytes]] = {
    "empty": lambda content: b"",
    "cut off": lambda content: content[: len(content) // 2],
    "zeros": lambda content: bytes(len(content)),
    "one bit": lambda content: content[:-9] + bytes([content[-9] ^ 1]) + content[-8:],
}


@pytest.fixture
def kept(tmp_path: Path) -> _CacheFile:
    file = _CacheFile(str(tmp_path), "kernel", "stamp")
    file.save(KEY, CODE)
    return file


def test_what_is_kept_is_found_by_who_compiles_the_same(kept: _CacheFile, tmp_path: Path) -> None:
    assert kept.load(KEY) == CODE and kept.load(("int64",)) is None
    assert _CacheFile(str(tmp_path), "kernel", "stamp").load(KEY) == CODE
    assert _CacheFile(str(tmp_path), "kernel", "another stamp").load(KEY) is None


@pytest.mark.parametrize("suffix", [".nbi", ".nbc"])
@pytest.mark.parametrize("damage", DAMAGES.values(), ids=DAMAGES)
def test_a_damaged_file_is_as_good_as_none(
    kept: _CacheFile, tmp_path: Path, suffix: str, damage: Callable[[bytes], bytes]
) -> None:
    (path,) = tmp_path.glob(f"*{suffix}")
    path.write_bytes(damage(path.read_bytes()))
    assert kept.load(KEY) is None
    kept.save(KEY, CODE)
    assert kept.load(KEY) == CODE


def test_an_index_of_another_numba_is_not_read(kept: _CacheFile, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(kept, "_version", "0.0")
    assert kept.load(KEY) is None


def test_where_no_folder_can_be_written_each_process_compiles(monkeypatch: pytest.MonkeyPatch) -> None:
    def nowhere(*_: object) -> None:
        raise RuntimeError("cannot cache function 'doubled': no locator available")

    started: list[str] = []
    monkeypatch.setattr(FunctionCache, "__init__", nowhere)
    compiled._warn_of_no_folder.cache_clear()
    monkeypatch.setattr(compiled, "start_beside", lambda module, folder: started.append(module))
    with pytest.warns(RuntimeWarning, match="set NUMBA_CACHE_DIR to a writable folder"):

        @njit(cache=True)
        def doubled(x: float) -> float:
            return 2.0 * x

        compile_beside("none", doubled)
    assert doubled(1.5) == 3.0 and not started
