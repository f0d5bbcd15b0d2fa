"""docs/howto.md: RLlib trains as it is written there."""

import math
import os
import re
import subprocess
import sys
from pathlib import Path

import pytest

pytest.importorskip("ray.rllib", reason="needs RLlib: make test-rl")

PAGE = Path(__file__).parents[2] / "docs" / "howto.md"


def test_the_block_trains_in_rllib() -> None:
    """In a process of its own: what Ray starts ends with it."""
    (block,) = re.findall(r"```python rllib\n(.*?)```", PAGE.read_text("utf-8"), re.DOTALL)
    block += '\nprint(results["env_runners"]["episode_return_mean"], len(results["learners"]))\n'
    run = subprocess.run(
        [sys.executable, "-c", block],
        capture_output=True,
        text=True,
        timeout=500,
        env={**os.environ, "RAY_USAGE_STATS_ENABLED": "0"},
    )
    assert run.returncode == 0, run.stderr[-3000:]
    sampled, figures = run.stdout.splitlines()[-2:]
    mean, learners = figures.split()
    assert int(sampled) >= 256 and math.isfinite(float(mean)) and int(learners) > 0
