"""The code of docs/backends.md and the example run."""

from __future__ import annotations

import re
import runpy
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[2]
BLOCKS = re.findall(
    r"```python\n(.*?)```", (ROOT / "docs" / "backends.md").read_text(encoding="utf-8"), re.DOTALL
)


@pytest.mark.parametrize("block", BLOCKS, ids=range(len(BLOCKS)))
def test_the_code_runs(block: str, capsys: pytest.CaptureFixture[str]) -> None:
    for extra in re.findall(r"^import (torch|jax)$", block, re.MULTILINE):
        pytest.importorskip(extra, reason=f"the extra {extra} is not installed")
    exec(compile(block, "backends.md", "exec"), {})
    assert capsys.readouterr().out


def test_example(capsys: pytest.CaptureFixture[str]) -> None:
    pytest.importorskip("torch", reason="the extra torch is not installed")
    volts = runpy.run_path(str(ROOT / "examples" / "fingertip_in_torch.py"))["main"]()
    assert (
        volts["cotton"]
        < volts["wood"]
        < volts["glass"]
        < volts["stainless_steel"]
        < volts["aluminium"]
        < 12e-3
    )
    assert "mean voltage" in capsys.readouterr().out
