"""Measurements that need a fresh process: memory of an environment, time to import and to the first step."""

from __future__ import annotations

import json
import subprocess
import sys
from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import numpy as np

from thermograsp.bench.speed.measure import ID
from thermograsp.errors import ThermograspError

_MEMORY = """
import json, pathlib, resource, sys
import gymnasium, numpy, thermograsp
n = int(sys.argv[1])
env = gymnasium.make_vec({id!r}, num_envs=n, vectorization_mode="vector_entry_point")
env.reset(seed=0)
rng = numpy.random.default_rng(0)
for _ in range(20):
    env.step(rng.uniform(-1, 1, (n, 3)).astype(numpy.float32))
status = pathlib.Path("/proc/self/status")
if status.is_file():  # Linux: getrusage would begin with the parent's peak
    peak = 1024 * int(status.read_text().partition("VmHWM:")[2].split()[0])
else:
    peak = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss
print(json.dumps(peak))
"""
_IMPORTS = """
import json, sys, time
begun = time.perf_counter()
import gymnasium
middle = time.perf_counter()
import thermograsp
end = time.perf_counter()
heavy = [name for name in ("mujoco", "scipy", "numba", "matplotlib") if name in sys.modules]
print(json.dumps([middle - begun, end - middle, heavy]))
"""
_FIRST_STEP = """
import json, time
import gymnasium, thermograsp
begun = time.perf_counter()
env = gymnasium.make({id!r})
made = time.perf_counter()
env.reset(seed=0)
reset = time.perf_counter()
env.step(env.action_space.sample())
end = time.perf_counter()
print(json.dumps([made - begun, reset - made, end - reset]))
"""


@dataclass(frozen=True, slots=True)
class Memory:
    """Memory of processes with more and more environments. num_envs: of each process. peak: bytes, the most each held.
    per_env: bytes that an environment adds, by least squares."""

    num_envs: tuple[int, ...]
    peak: tuple[int, ...]
    per_env: float


@dataclass(frozen=True, slots=True)
class StartUp:
    """Medians, s. gymnasium: `import gymnasium`. thermograsp: `import thermograsp` after it. heavy: large packages that
    both loaded. make, reset, step: the first of each, networks and compiled code on disk, so that they add up to the
    time from make to the first observation after an action."""

    gymnasium: float
    thermograsp: float
    heavy: tuple[str, ...]
    make: float
    reset: float
    step: float

    @property
    def to_first_step(self) -> float:
        """s."""
        return self.make + self.reset + self.step


def memory(counts: tuple[int, ...], shown: Callable[[str], None]) -> Memory:
    """Peak memory of fresh processes with that many environments each, after 20 steps. shown: called with what is
    done."""
    _fresh(_MEMORY.format(id=ID), "64")  # every material is met and every kernel compiled: caches are full
    peaks = []
    for count in counts:
        shown(f"memory of {count} environments")
        peaks.append(int(_fresh(_MEMORY.format(id=ID), str(count))))
    slope = float(np.polyfit(counts, peaks, 1)[0])
    return Memory(counts, tuple(peaks), slope)


def start_up(repeats: int, shown: Callable[[str], None]) -> StartUp:
    """Times of `repeats` fresh processes, after one that fills caches. shown: called with what is done."""
    shown("start-up")
    first_step = _FIRST_STEP.format(id=ID)
    _fresh(first_step)
    imports = [_fresh(_IMPORTS) for _ in range(repeats)]
    steps = [_fresh(first_step) for _ in range(repeats)]
    gymnasium, thermograsp = np.median([each[:2] for each in imports], axis=0)
    make, reset, step = np.median(steps, axis=0)
    return StartUp(
        float(gymnasium), float(thermograsp), tuple(imports[0][2]), float(make), float(reset), float(step)
    )


def _fresh(program: str, *arguments: str) -> Any:
    """What a program printed as JSON in a process of its own."""
    done = subprocess.run([sys.executable, "-c", program, *arguments], capture_output=True, text=True)
    if done.returncode:
        last = (done.stderr.strip().splitlines() or ["no message"])[-1]
        raise ThermograspError(f"a process of the benchmark ended with status {done.returncode}: {last}")
    return json.loads(done.stdout)
