"""How many threads a machine gives to BLAS decides no bit of a result."""

import os
import subprocess
import sys

import pytest

BUILT = """
import numpy as np
from thermograsp.files import cached_arrays

a = np.random.default_rng(0).normal(size=(600, 500))
found = cached_arrays({}, lambda: {"product": a.T @ a}, enabled=False)["product"]
"""
PRESSED = """
from thermograsp.thermal import press

found = press("wood", rung="semi_analytic", seconds=3.0, dt=0.1).temperature_drop
"""
SAY = """
import hashlib
print(hashlib.sha256(found.tobytes()).hexdigest())
"""


@pytest.mark.parametrize("code", [BUILT, PRESSED], ids=["what is cached", "the semi-analytic rung"])
def test_the_number_of_threads_decides_no_bits(code: str) -> None:
    """Each has products whose last bits differ in two threads."""
    hashes = [
        subprocess.run(
            [sys.executable, "-c", code + SAY],
            env=os.environ | {"OPENBLAS_NUM_THREADS": threads},
            capture_output=True,
            text=True,
            check=True,
        ).stdout
        for threads in ("1", "2")
    ]
    assert hashes[0] == hashes[1] != ""
