"""What a touch costs that is new in all: ms of processor time a place of a sensor on a box, in a warm process.

Episodes that start with new boxes touch them at new places: boxes of drawn sizes, conductivities and heat capacities
between two fingertips, with 16 rows starting at once, or one alone. Nothing is read from disk, and whatever is kept of
earlier boxes and places is forgotten before each start: what belongs to the sensor alone stays. On one thread.

    whole     the whole face touches in the middle of wide boxes, 20 to 60 mm
    anywhere  on boxes of 4 to 60 mm, each fingertip anywhere, a part of the face covered
    known     anywhere, but the elements under the contacts are known from earlier boxes; only the box is new

    python studies/new_places.py             the table in docs/benchmarks.md
    python studies/new_places.py --json
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
from thermograsp.thermal.kernels.alone import each_alone
from thermograsp.thermal.kernels.contact import tip_at
from thermograsp.thermal.kernels.coverage import _patterns_of
from thermograsp.thermal.kernels.element import seen_side
from thermograsp.thermal.kernels.excited import shown_element
from thermograsp.thermal.kernels.samples import element_rule, grasp_rule, rough_rule
from thermograsp.thermal.kernels.touched import _free, _jumps, _weight

STACK, GLASS = thermal.sensor("seed"), thermal.material("glass")
FILM = 5.0  # W/(m2 K)
OF_BOXES: tuple[Any, ...] = (_free, boxes._under, grasp_rule)
"""What is kept of boxes whose places are known."""
OF_PLACES: tuple[Any, ...] = (
    *OF_BOXES,
    each_alone,
    boxes._element,
    boxes._tip,
    tip_at,
    _patterns_of,
    seen_side,
    shown_element,
    element_rule,
    rough_rule,
    _jumps,
    _weight,
)
"""What is kept of places."""
CASES = ("whole", "anywhere", "known")


class Start(NamedTuple):
    """bodies: of the rows. middles: (rows, 2, 3) m of both fingertips in their frames."""

    bodies: list[GraspBody]
    middles: np.ndarray


def drawn(rng: np.random.Generator, rows: int, wide: bool) -> Start:
    """wide: the whole face touches, in the middle."""
    bodies, middles = [], np.zeros((rows, 2, 3))
    for row in range(rows):
        size = np.exp(rng.uniform(*np.log((0.02, 0.06) if wide else (0.004, 0.06)), 3))
        conductivity, capacity = np.exp(rng.uniform(*np.log([(0.1, 1e6), (300.0, 4e6)]))).tolist()
        made = replace(GLASS, conductivity=conductivity, specific_heat=capacity / GLASS.density)
        bodies.append(
            GraspBody(ObjectSpec(size=tuple(size.tolist()), mass=0.1, friction=0.8), made, 24.0, "T", STACK, anywhere=True)
        )
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


def cost(start: Start, known: bool, again: int) -> float:
    """ms of processor time a place, the least of so many equal starts. known: the elements under the contacts are."""
    best = np.inf
    for _ in range(again):
        for each in OF_PLACES:
            each.cache_clear()
        if known:
            touches(start)[0]()
            for each in OF_BOXES:
                each.cache_clear()
        run, _ = touches(start)
        begun = time.process_time()
        places = run()
        best = min(best, 1e3 * (time.process_time() - begun) / places)
    return best


def measured(rows: int, starts: int, again: int, seed: int) -> dict[str, float]:
    """ms a place by case, the median of so many starts."""
    found = {}
    for case in CASES:
        rng = np.random.default_rng(seed)
        each = [cost(drawn(rng, rows, case == "whole"), case == "known", again) for _ in range(starts)]
        found[case] = float(np.median(each))
    return found


def main(arguments: Sequence[str] | None = None) -> None:
    """Prints the table."""
    parser = argparse.ArgumentParser(description="ms of processor time a new place on a new box.")
    parser.add_argument("--rows", type=int, nargs="+", default=[16, 1], help="rows that start at once (16 1)")
    parser.add_argument("--starts", type=int, default=12, help="drawn starts, of which the median counts (12)")
    parser.add_argument("--again", type=int, default=8, help="times that each is made, of which the least counts (8)")
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--json", action="store_true", help="one JSON object")
    options = parser.parse_args(arguments)
    found = {
        str(rows): measured(rows, options.starts if rows > 1 else 2 * options.starts, options.again, options.seed)
        for rows in options.rows
    }
    if options.json:
        print(json.dumps(found))
        return
    print("rows at once  " + "  ".join(f"{case:>8}" for case in CASES) + "   ms a place")
    for rows, costs in found.items():
        print(f"{rows:>12}  " + "  ".join(f"{costs[case]:8.3f}" for case in CASES))


if __name__ == "__main__":
    main()
