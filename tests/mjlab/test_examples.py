"""The example of mujoco-warp without mjlab."""

import subprocess
import sys
from pathlib import Path

import pytest

pytest.importorskip("mujoco_warp", reason="mujoco-warp is not installed: make test-mjlab installs it")

EXAMPLE = Path(__file__).parents[2] / "examples" / "mujoco_warp_feels.py"


def test_grippers_press_with_their_motors_and_feel_aluminium_colder_than_wood() -> None:
    run = subprocess.run([sys.executable, EXAMPLE], capture_output=True, text=True, timeout=1800)
    assert run.returncode == 0, run.stderr
    rows = [line.split() for line in run.stdout.splitlines() if line.endswith(" N")]
    printed = {words[0]: (float(words[1]), float(words[4])) for words in rows}
    assert printed["aluminium:"][0] > 2 * printed["wood:"][0] > 0
    assert all(force == pytest.approx(8.0, rel=0.02) for _, force in printed.values())
