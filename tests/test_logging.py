"""The logger "thermograsp" tells what goes on beside the results, to those who ask."""

import logging
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest

from thermograsp.files import cached_arrays


def test_a_build_is_logged(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, caplog: pytest.LogCaptureFixture
) -> None:
    monkeypatch.setenv("THERMOGRASP_CACHE", str(tmp_path))
    with caplog.at_level(logging.INFO, "thermograsp"):
        for _ in range(2):
            cached_arrays({}, lambda: {"a": np.zeros(1)})
    (record,) = caplog.records
    assert record.name == "thermograsp.files" and "built in" in record.getMessage()


def test_it_is_quiet_unless_asked() -> None:
    code = """
import logging, thermograsp
logging.getLogger("thermograsp.files").error("heard by nobody")
"""
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    assert done.stdout == done.stderr == ""


@pytest.mark.parametrize("verbose", [False, True])
def test_a_command_shows_it_where_it_is_verbose(verbose: bool, tmp_path: Path) -> None:
    """The log goes to stderr: what a command prints for machines stays as it is."""
    code = """
import sys
from thermograsp import cli
from thermograsp.cli import materials

def run(args):
    import logging
    logging.getLogger("thermograsp.files").info("built")
    print("{}")
    return 0

materials.run = run
sys.exit(cli.main(sys.argv[1:]))
"""
    flags = ["--verbose"] if verbose else []
    done = subprocess.run(
        [sys.executable, "-c", code, "materials", "--json", *flags], capture_output=True, text=True
    )
    assert (done.returncode, done.stdout) == (0, "{}\n")
    assert done.stderr == ("thermograsp.files: built\n" if verbose else "")
