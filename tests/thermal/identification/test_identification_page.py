"""What docs/identification.md promises: its code runs, its commands parse."""

import re
import shlex
from pathlib import Path

import pytest

from thermograsp.cli import main

DOCS = Path(__file__).parents[3] / "docs"
PAGE = (DOCS / "identification.md").read_text(encoding="utf-8")


@pytest.mark.slow
def test_the_code_runs(capsys: pytest.CaptureFixture[str]) -> None:
    blocks = re.findall(r"```python\n(.*?)```", PAGE, re.DOTALL)
    assert blocks
    for block in blocks:
        exec(compile(block, "identification.md", "exec"), {})
    lines = capsys.readouterr().out.splitlines()
    assert lines[0].startswith("material it is glass (")
    assert lines[-1].startswith("glass ")


def test_the_commands_parse(capsys: pytest.CaptureFixture[str]) -> None:
    lines = re.findall(r"^    thermograsp (.*)$", PAGE, re.MULTILINE)
    assert lines
    for line in lines:
        assert main([*shlex.split(line), "--help"]) == 0


def test_its_pictures_are_there_and_small() -> None:
    for link in re.findall(r"!\[[^]]*\]\(([^)]+)\)", PAGE):
        assert (DOCS / link).stat().st_size < 300_000
