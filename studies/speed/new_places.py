"""What a touch costs that is new in all: ms of processor time a place of a sensor on a box, in a warm process.

Episodes that start with new boxes touch them at new places: boxes of drawn sizes, conductivities and heat capacities
between two fingertips, with 16 rows starting at once, or one alone, one start after the other. Nothing is read from
disk, and all runs on one thread. What is kept of boxes, places and their patterns of flow is forgotten before each
start; what is kept of the sensor's face is as the starts before have left it. The median of the starts counts, and of
each start the least of several equal runs.

    whole     the whole face touches in the middle of wide boxes, 20 to 60 mm
    anywhere  on boxes of 4 to 60 mm, each fingertip anywhere, a part of the face covered
    known     the same, but the elements under the contacts are known; only the boxes are new

    python studies/speed/new_places.py             the figures in docs/benchmarks.md, a minute
    python studies/speed/new_places.py --rows 16 --json
"""

from __future__ import annotations

import argparse
import json
import time
from collections.abc import Callable, Sequence
from dataclasses import replace
from typing import Any, NamedTuple

import numpy as np

from thermograsp import thermal
from thermograsp.envs import GraspBody, ObjectSpec
from thermograsp.envs.sensing import boxes
from thermograsp.envs.sensing.boxes import BoxHeat
from thermograsp.thermal.kernels.contact import tip_at
from thermograsp.thermal.kernels.coverage import _patterns_of_both, spot_patterns
from thermograsp.thermal.kernels.element import seen_side
from thermograsp.thermal.kernels.excited import _along, shown_element
from thermograsp.thermal.kernels.samples import grasp_rule

STACK, GLASS = thermal.sensor("seed"), thermal.material("glass")
FILM = 5.0  # W/(m2 K)
OF_BOXES: tuple[Any, ...] = (boxes._UNDER, grasp_rule)
"""What is kept of boxes whose places are known."""
OF_PLACES: tuple[Any, ...] = (
    *OF_BOXES,
    boxes._element,
    tip_at,
    spot_patterns,
    _patterns_of_both,
)
"""What is kept of places, and of patterns of flow there."""
OF_FACES: tuple[Any, ...] = (seen_side, shown_element, _along)
"""What is kept of the sensor's face and of faces of boxes in steps."""
CASES = ("whole", "anywhere", "known")
WARM = 12
"""Starts with other boxes, after which a process is warm."""


class Start(NamedTuple):
    """bodies: of the rows. middles: (rows, 2, 3) m of both fingertips in their frames."""

    bodies: list[GraspBody]
    middles: np.ndarray


def drawn(rng: np.random.Generator, rows: int, wide: bool) -> Start:
    """wide: the whole face touches, in the middle."""
    bodies, middles = [], np.zeros((rows, 2, 3))
    for row in range(rows):
        least = 0.02 if wide else 0.004
        size = np.exp(rng.uniform(np.log(least), np.log(0.06), 3))
        conductivity, capacity = np.exp(rng.uniform(*np.log([(0.1, 1e6), (300.0, 4e6)]))).tolist()
        made = replace(GLASS, conductivity=conductivity, specific_heat=capacity / GLASS.density)
        spec = ObjectSpec(size=tuple(size.tolist()), mass=0.1, friction=0.8)
        bodies.append(GraspBody(spec, made, 24.0, "T", STACK, anywhere=True))
        middles[row, :, 0] = -size[0] / 2, size[0] / 2
        reach = np.full(2, 1e-3) if wide else size[1:] / 2 + 0.4 * STACK.width
        middles[row, :, 1:] = rng.uniform(-reach, reach, (2, 2))
    return Start(bodies, middles)


def touches(start: Start) -> tuple[Callable[[], int], BoxHeat]:
    """A function that makes the networks of a start's rows and tells of how many places, and what it fills."""
    rows, heat = len(start.bodies), BoxHeat(len(start.bodies), 0.05, 0.01)
    for row, body in enumerate(start.bodies):
        heat.start(row, body, FILM)
    state = np.zeros((rows, heat.tables.states))

    def run() -> int:
        heat.settle([(row, range(2)) for row in range(rows)], start.middles, state)
        return sum(len(heat.touched(row).places) for row in range(rows))

    return run, heat


def measured(case: str, rows: int, starts: int, again: int, seed: int) -> float:
    """ms a place: the median of so many starts after WARM others, each the least of so many equal runs."""
    least = np.full(WARM + starts, np.inf)
    for _ in range(again):
        rng = np.random.default_rng(seed)
        forget((*OF_PLACES, *OF_FACES))
        for number in range(WARM + starts):
            least[number] = min(least[number], cost(case, drawn(rng, rows, case == "whole")))
    return float(np.median(least[WARM:]))


def cost(case: str, start: Start) -> float:
    """ms a place of one start."""
    forget(OF_PLACES)
    if case == "known":
        touches(start)[0]()
        forget(OF_BOXES)
    run, _ = touches(start)
    begun = time.process_time()
    places = run()
    return 1e3 * (time.process_time() - begun) / places


def forget(kept: tuple[Any, ...]) -> None:
    """Empties these."""
    for each in kept:
        each.cache_clear()


def main(arguments: Sequence[str] | None = None) -> None:
    """Prints the table."""
    parser = argparse.ArgumentParser(description="ms of processor time a new place on a new box.")
    parser.add_argument("--rows", type=int, nargs="+", default=[16, 1], help="rows that start at once (16 1)")
    parser.add_argument("--starts", type=int, default=60, help="of which the median counts (60)")
    parser.add_argument("--again", type=int, default=6, help="times, of which the least counts (6)")
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--json", action="store_true", help="one JSON object")
    options = parser.parse_args(arguments)
    limits = options.starts, options.again, options.seed
    found = {rows: {case: measured(case, rows, *limits) for case in CASES} for rows in options.rows}
    if options.json:
        print(json.dumps(found))
        return
    print("rows at once  " + "  ".join(f"{case:>8}" for case in CASES) + "   ms a place")
    for rows, costs in found.items():
        print(f"{rows:>12}  " + "  ".join(f"{costs[case]:8.3f}" for case in CASES))


if __name__ == "__main__":
    main()
