"""One quick run of all benchmarks, for every test of them."""

import contextlib
import io
import json
from pathlib import Path

import pytest

from thermograsp import cli


@pytest.fixture(scope="session")
def written(tmp_path_factory: pytest.TempPathFactory) -> tuple[Path, dict]:
    """`thermograsp bench --quick --json` with seed 3: its folder and its document."""
    folder = tmp_path_factory.mktemp("bench")
    out = io.StringIO()
    with contextlib.redirect_stdout(out):
        assert cli.main(["bench", "--quick", "--json", "--seed", "3", "--out", str(folder)]) == 0
    return folder, json.loads(out.getvalue())
