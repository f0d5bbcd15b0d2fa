"""What the very first use costs while nothing is compiled or kept: seconds of processor time in a fresh process.

Each case runs in processes of its own, whose caches are an empty temporary folder, and compiles in that process alone:
another one would share the work and hide it. Imports are not counted. "Again" is the same in a next process, which
finds on disk what the first one has kept.

    default      Grasp-v0: made, reset, and its fingers closed for 60 control steps
    anywhere     the same with anywhere=True
    ball         the same with a ball of glass
    touch        ThermalTouch: a fingertip that is pressed on a box of steel for 100 steps
    touch ball   the same with a ball of steel

    python studies/speed/first_use.py             a table, some three minutes
    python studies/speed/first_use.py --cases default anywhere --json
"""

from __future__ import annotations

import argparse
import json
import os
import subprocess
import sys
import tempfile
from collections.abc import Sequence
from pathlib import Path

_GRASP = """
import time
import gymnasium, numpy as np
import thermograsp
from thermograsp.envs import ObjectSpec
begun = time.process_time()
env = gymnasium.make("thermograsp/Grasp-v0", **{given})
env.reset(seed=0)
action = np.zeros(env.action_space.shape, np.float32)
action[0] = -1.0  # closes the fingers
for _ in range(60):
    if any(env.step(action)[2:4]):
        break
print(time.process_time() - begun)
"""
_TOUCH = """
import time
import mujoco
from thermograsp.touch import ThermalTouch
begun = time.process_time()
model = mujoco.MjModel.from_xml_string('''
<mujoco><option gravity="0 0 0"/><worldbody>
  <body name="object"><geom type="{geom}" size=".02 .02 .02"/></body>
  <body pos="0 0 .0245"><joint type="slide" axis="0 0 -1" damping="20"/>
    <geom name="pad" type="box" size=".01 .01 .004"/></body>
</worldbody></mujoco>''')
data = mujoco.MjData(model)
touch = ThermalTouch(model, fingertips={{"tip": "pad"}}, objects={{"object": "steel"}})
data.qfrc_applied[0] = 5.0
for _ in range(100):
    mujoco.mj_step(model, data)
    reading = touch.update(data)
assert reading.temperature_drop[0] > 0.1
print(time.process_time() - begun)
"""
_BALL = 'dict(anywhere=True, objects=ObjectSpec(shape="sphere", size=(0.04, 0.04, 0.04), material="glass"))'
CASES = {
    "default": _GRASP.format(given="{}"),
    "anywhere": _GRASP.format(given="dict(anywhere=True)"),
    "ball": _GRASP.format(given=_BALL),
    "touch": _TOUCH.format(geom="box"),
    "touch ball": _TOUCH.format(geom="sphere"),
}


def measured(case: str) -> dict[str, float]:
    """s of processor time of the first process and of the next one."""
    with tempfile.TemporaryDirectory() as folder:
        return {which: _seconds(case, Path(folder)) for which in ("first", "again")}


def _seconds(case: str, folder: Path) -> float:
    """s in a fresh process whose caches are in that folder."""
    caches = {name: str(folder / name) for name in ("NUMBA_CACHE_DIR", "THERMOGRASP_CACHE", "XDG_CACHE_HOME")}
    done = subprocess.run(
        [sys.executable, "-W", "ignore", "-c", CASES[case]],
        env={**os.environ, **caches, "THERMOGRASP_COMPILE_ALONE": "1"},
        stdout=subprocess.PIPE,
        text=True,
        check=True,
    )
    return float(done.stdout.split()[-1])


def main(arguments: Sequence[str] | None = None) -> None:
    """Prints the table."""
    parser = argparse.ArgumentParser(
        description="Seconds of processor time of a first use, with nothing compiled."
    )
    parser.add_argument("--cases", nargs="+", choices=CASES, default=list(CASES), help="which (all)")
    parser.add_argument("--again", type=int, default=1, help="times, of which the least counts (1)")
    parser.add_argument("--json", action="store_true", help="one JSON object")
    options = parser.parse_args(arguments)
    if options.again < 1:
        parser.error(f"--again must be 1 or more, got {options.again}")
    found = {}
    for case in options.cases:
        runs = [measured(case) for _ in range(options.again)]
        found[case] = {which: min(run[which] for run in runs) for which in runs[0]}
    if options.json:
        print(json.dumps(found))
        return
    print(f"{'s of processor time':20}   first   again")
    for case, seconds in found.items():
        print(f"{case:20}{seconds['first']:8.1f}{seconds['again']:8.2f}")


if __name__ == "__main__":
    main()
