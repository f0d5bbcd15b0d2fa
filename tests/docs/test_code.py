"""Every block of Python in the documentation runs, each by itself, and every command parses."""

import shlex
import subprocess
import sys
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

import pytest

from thermograsp.cli import COMMANDS, main

from .pages import PAGES, ROOT, blocks, commands, kinds

JUDGED_ELSEWHERE = {
    "README.md": ("tests/cli/test_readme.py",),
    "docs/backends.md": ("tests/backends/test_docs.py",),
    "docs/datasets.md": ("tests/dataset/test_reading.py", "tests/ray/test_minari.py"),
    "docs/identification.md": ("tests/thermal/identification/test_identification_page.py",),
    "docs/learning.md": ("tests/cli/test_learning_page.py",),
}
"""Pages whose code is run by tests that also judge what it prints."""

CODE = [
    (page, kind, i)
    for page in PAGES
    if page not in JUDGED_ELSEWHERE
    for kind in ("python", "python hardware")
    for i in range(len(blocks(page, kind)))
]
LINES = [(page, line) for page in PAGES for line in commands(page)]
KNOWN = {"toml", "python", "python hardware", "sh", "math", "golden", "bibtex", "{toctree}", "{eval-rst}"}
ELSEWHERE = {
    "docs/datasets.md": {"python torch", "python minari", "python lerobot"},
    "docs/engines.md": {"python mjlab"},
    "docs/hardware.md": {"python lerobot"},
    "docs/learning.md": {"python policy"},
    "docs/howto.md": {"python rl", "python rllib", "python tensorboard", "python torchrl"},
}
"""Kinds of blocks that tests of other folders run, by page."""
PORTS = {"/dev/ttyACM0": "tips", "/dev/ttyUSB0": "gripper"}
"""What stands in a page for a real gripper's ports, and the emulated ones' names here."""


@contextmanager
def emulated_hand(folder: Path) -> Iterator[None]:
    """A gripper with fingertips over a block of glass, on PORTS' names in the folder."""
    pytest.importorskip("serial", reason="the extra hardware is not installed")
    links = ["--link", str(folder / "tips"), "--gripper-link", str(folder / "gripper")]
    command = [sys.executable, "-m", "thermograsp", "device", "emulate-hand", *links, "--seconds", "60"]
    with subprocess.Popen(command, stdout=subprocess.PIPE, text=True) as process:
        assert process.stdout is not None and "robotiq://" in process.stdout.readline()
        yield
        process.terminate()


@pytest.mark.parametrize(("page", "kind", "i"), CODE, ids=[f"{page} {kind} {i}" for page, kind, i in CODE])
def test_the_code_runs(page: str, kind: str, i: int, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)
    block = blocks(page, kind)[i]
    if kind == "python":
        exec(compile(block, page, "exec"), {"__name__": "__main__"})
        return
    for port, name in PORTS.items():
        block = block.replace(port, str(tmp_path / name))
    with emulated_hand(tmp_path):
        exec(compile(block, page, "exec"), {"__name__": "__main__"})


@pytest.mark.parametrize(("page", "line"), LINES, ids=[f"{page} {line}" for page, line in LINES])
def test_a_command_parses(page: str, line: str) -> None:
    words = shlex.split(line.rstrip(" &"), comments=True)
    assert words[0] in COMMANDS or words == ["--version"]
    assert main([*words, "--help"]) == 0  # every option before --help is parsed


@pytest.mark.parametrize("page", PAGES)
def test_no_block_is_of_a_kind_that_nothing_runs(page: str) -> None:
    known = KNOWN | ELSEWHERE.get(page, set())
    assert kinds(page) <= known


@pytest.mark.parametrize("page", JUDGED_ELSEWHERE)
def test_the_tests_that_judge_a_page_are_there(page: str) -> None:
    for test in JUDGED_ELSEWHERE[page]:
        source = (ROOT / test).read_text(encoding="utf-8")
        assert Path(page).name in source and "exec(compile(" in source
