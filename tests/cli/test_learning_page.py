"""docs/learning.md prints its own table, and its policy acts."""

import re
from pathlib import Path

import pytest

from thermograsp.agents.learning import learning_task, score

PAGE = (Path(__file__).parents[2] / "docs" / "learning.md").read_text(encoding="utf-8")


def test_the_table_is_what_its_code_prints(capsys: pytest.CaptureFixture[str]) -> None:
    (block,) = re.findall(r"```python\n(.*?)```", PAGE, re.DOTALL)
    exec(compile(block, "learning.md", "exec"), {})
    printed = capsys.readouterr().out
    assert printed.count("\n") == 8 and printed in PAGE


def test_its_policy_can_be_scored(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    (block,) = re.findall(r"```python policy\n(.*?)```", PAGE, re.DOTALL)
    (tmp_path / "policy_of_the_page.py").write_text(block)
    monkeypatch.chdir(tmp_path)
    monkeypatch.syspath_prepend(tmp_path)
    assert score(learning_task("grasp"), "policy_of_the_page:act", 2).successes == 0
