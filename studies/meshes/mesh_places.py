"""Networks of meshes from their modes beside grids that are fine at the patch.

A sensor of the paper touches a body at one place, or at two at once. The drop of its temperature follows from the
network that environments use (thermal/anywhere), and from one whose states are fields of a grid that is fine at the
patches (body_network), which has another grid, other states and no local kernel. Compared are the drops at
CONDUCTANCES over TIMES. Mugs with contents that are held at its first temperature behind a film of FILMS are compared
with a grid that is finer still, whose states are fields with that film. So are drawn places of the
library's vessels, at FELT over LONG.

    python studies/meshes/mesh_places.py                  every case, some minutes
    python studies/meshes/mesh_places.py rim --json       those with "rim" in their name
    python studies/meshes/mesh_places.py --filled         places of mugs with contents instead
    python studies/meshes/mesh_places.py --vessels        drawn places of the library's vessels with contents instead
    python studies/meshes/mesh_places.py --pairs          drawn pairs of fingertips at vessels' rims and feet
    python studies/meshes/mesh_places.py --pairs slid     of these, a fingertip before and after it has slid on
    python studies/meshes/mesh_places.py --times          how long modes and networks take instead
"""

from __future__ import annotations

import argparse
import json
import sys
from collections.abc import Callable
from dataclasses import asdict
from typing import Any

from place_films import filled_rows
from place_pairs import pair_rows, print_pairs
from place_rows import print_rows, rows
from place_shapes import ONE, PARTS, TWO
from place_times import ROUND, print_times, timed
from place_vessels import print_vessels, vessel_rows


def main() -> int:
    parser = argparse.ArgumentParser(description=str(__doc__).split("\n", 1)[0])
    parser.add_argument("case", nargs="?", default="", help="part of a case's name")
    parser.add_argument("--json", action="store_true")
    parser.add_argument("--times", action="store_true", help="how long modes and networks take")
    parser.add_argument("--filled", action="store_true", help="places of mugs with contents")
    parser.add_argument("--vessels", action="store_true", help="drawn places of vessels with contents")
    parser.add_argument("--pairs", action="store_true", help="drawn pairs of fingertips near each other")
    chosen = parser.parse_args()
    if chosen.pairs:
        shown(pair_rows(chosen.case), print_pairs, chosen.json)
    elif chosen.vessels:
        shown(vessel_rows(chosen.case), print_vessels, chosen.json)
    elif chosen.times:
        shown([timed(name) for name in ROUND if chosen.case in name], print_times, chosen.json)
    else:
        found = (filled_rows if chosen.filled else rows)(chosen.case)
        if not found:
            parser.error(f"no case has {chosen.case!r} in its name: {', '.join(ONE | TWO | PARTS)}")
        shown(found, print_rows, chosen.json)
    return 0


def shown(found: list[Any], printed: Callable[[list[Any]], None], as_json: bool) -> None:
    """Rows as JSON, or printed."""
    if as_json:
        print(json.dumps([asdict(row) for row in found], indent=2))
    else:
        printed(found)


if __name__ == "__main__":
    sys.exit(main())
