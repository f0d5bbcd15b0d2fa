"""The notebooks run from an empty folder, each by itself, and hold no results."""

import json
import os
import subprocess
import sys
from pathlib import Path
from typing import Any

import pytest

from .pages import ROOT

NOTEBOOKS = sorted((ROOT / "examples" / "notebooks").glob("*.ipynb"))
NEEDS = {"train": "stable_baselines3"}
"""What a notebook's install cell brings beyond what tests have: `make test-rl` runs these."""


def code(notebook: Path) -> list[dict[str, Any]]:
    cells = json.loads(notebook.read_text(encoding="utf-8"))["cells"]
    return [cell for cell in cells if cell["cell_type"] == "code"]


@pytest.mark.parametrize("notebook", NOTEBOOKS, ids=lambda path: path.stem)
def test_it_installs_first_and_holds_no_results(notebook: Path) -> None:
    first, *rest = ("".join(cell["source"]) for cell in code(notebook))
    assert first.startswith("%pip install -q ") and "thermograsp" in first and "\n" not in first
    assert not any(line.startswith(("%", "!")) for cell in rest for line in cell.splitlines())
    assert all(cell["outputs"] == [] and cell["execution_count"] is None for cell in code(notebook))


@pytest.mark.slow
@pytest.mark.parametrize("notebook", NOTEBOOKS, ids=lambda path: path.stem)
def test_its_cells_run_one_after_another(notebook: Path, tmp_path: Path) -> None:
    if notebook.stem in NEEDS:
        pytest.importorskip(NEEDS[notebook.stem], reason="needs stable-baselines3: make test-rl")
    script = "\n".join("".join(cell["source"]) for cell in code(notebook)[1:])
    (tmp_path / "cells.py").write_text(script.replace("STEPS = 4096", "STEPS = 512"), encoding="utf-8")
    run = subprocess.run(
        [sys.executable, "cells.py"],
        cwd=tmp_path,
        env={**os.environ, "MPLBACKEND": "agg"},
        capture_output=True,
        text=True,
        timeout=600,
    )
    assert run.returncode == 0, run.stdout + run.stderr
