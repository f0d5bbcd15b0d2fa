"""The examples for other packages' environments tell aluminium from wood."""

import subprocess
import sys
from pathlib import Path

import pytest

EXAMPLES = Path(__file__).parents[2] / "examples"
NEEDED = {"fetch_feels": "gymnasium_robotics", "lift_feels": "robosuite", "finger_feels": "dm_control"}


@pytest.mark.parametrize("name", NEEDED)
def test_an_example_feels_aluminium_colder_than_wood(name: str) -> None:
    pytest.importorskip(NEEDED[name])
    path = EXAMPLES / f"{name}.py"
    code = path.read_text().partition("import thermograsp\n")[2].splitlines()
    assert sum(bool(line) and not line.startswith(("from ", "import ")) for line in code) <= 13
    run = subprocess.run([sys.executable, path], capture_output=True, text=True, timeout=600)
    assert run.returncode == 0, run.stderr
    felt = {words[0]: float(words[1]) for words in map(str.split, run.stdout.splitlines()) if len(words) == 3}
    assert felt["aluminium:"] > 1.3 * felt["wood:"] > 0
