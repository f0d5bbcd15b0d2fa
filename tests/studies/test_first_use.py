"""What a first use costs: the study runs in caches of its own."""

from __future__ import annotations

import importlib
import json
import sys
from collections.abc import Iterator
from pathlib import Path
from types import ModuleType

import pytest

ROOT = Path(__file__).parents[2]
CACHES = ("NUMBA_CACHE_DIR", "THERMOGRASP_CACHE", "XDG_CACHE_HOME")


@pytest.fixture(scope="module")
def study() -> Iterator[ModuleType]:
    sys.path.insert(0, str(ROOT / "studies" / "speed"))
    yield importlib.import_module("first_use")
    sys.path.remove(str(ROOT / "studies" / "speed"))
    del sys.modules["first_use"]


def test_both_processes_have_the_same_empty_caches(study: ModuleType, monkeypatch, capsys) -> None:
    """The second one finds what the first one has kept, and nothing else is looked at."""
    monkeypatch.setitem(
        study.CASES,
        "default",
        "import os, pathlib\n"
        f"folders = [pathlib.Path(os.environ[name]) for name in {CACHES}]\n"
        "assert os.environ['THERMOGRASP_COMPILE_ALONE'] == '1'\n"
        "print(sum(folder.exists() for folder in folders))\n"
        "[folder.mkdir(exist_ok=True) for folder in folders]\n",
    )
    study.main(["--cases", "default", "--again", "2", "--json"])
    assert json.loads(capsys.readouterr().out) == {"default": {"first": 0.0, "again": 3.0}}


@pytest.mark.parametrize("case", ["default", "anywhere", "ball", "touch", "touch ball"])
def test_its_cases_are_python(study: ModuleType, case: str) -> None:
    compile(study.CASES[case], case, "exec")
