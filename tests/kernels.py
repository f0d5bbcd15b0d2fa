"""Which compiled code a process uses, on disk before or not."""

import os
import subprocess
import sys

from thermograsp.beside import ALONE

_TELL = """
import gc
from numba.core.dispatcher import Dispatcher
for one in gc.get_objects():
    if isinstance(one, Dispatcher) and one.py_func.__module__.startswith("thermograsp."):
        kind = "inner" if "Inner" in one._compiler.pipeline_class.__name__ else "entry"
        for arguments in {*one.stats.cache_hits, *one.stats.cache_misses}:
            print("kernel:", kind, one.py_func.__module__, one.py_func.__name__, *arguments)
"""


def kernels(code: str, **environment: str) -> set[str]:
    """What a new process asks for that runs `code`: "inner" or "entry", module, function and types of arguments. What
    one finds on disk it does not compile, and asks for nothing that is inside."""
    done = subprocess.run(
        [sys.executable, "-W", "ignore", "-c", code + _TELL],
        env={**os.environ, ALONE: "1", **environment},
        check=True,
        capture_output=True,
        text=True,
    )
    return {line for line in done.stdout.splitlines() if line.startswith("kernel:")}


def names(found: set[str]) -> set[str]:
    """The functions' names alone."""
    return {line.split()[3] for line in found}
