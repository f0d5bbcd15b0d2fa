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
    run = subprocess.run(
        [sys.executable, EXAMPLES / f"{name}.py"], capture_output=True, text=True, timeout=600
    )
    assert run.returncode == 0, run.stderr
    rows = [line.split() for line in run.stdout.splitlines() if line.endswith(" K")]
    drops = {material: float(drop) for material, drop, _ in rows}
    assert drops["aluminium:"] > 1.3 * drops["wood:"] > 0
