"""docs/learning.md prints its own table."""

import re
from pathlib import Path

import pytest

PAGE = (Path(__file__).parents[2] / "docs" / "learning.md").read_text(encoding="utf-8")


def test_the_table_is_what_its_code_prints(capsys: pytest.CaptureFixture[str]) -> None:
    (block,) = re.findall(r"```python\n(.*?)```", PAGE, re.DOTALL)
    exec(compile(block, "learning.md", "exec"), {})
    printed = capsys.readouterr().out
    assert printed.count("\n") == 8 and printed in PAGE
