"""Several objects under one sensor beside finite volumes in three dimensions.

A fingertip with the usual skin lies on blocks that stand side by side, each under a part of its face by a patch of even
conductance. Nothing flows between the blocks. ThermalTouch's heat takes the patches as its columns tell them; the
volumes are those of placed_patches.py. Compared is the temperature drop after placed_patches.TIMES s. `apart` is what
the same heat says if the contacts did not know of one another: of the sum of the drops of each alone.

    python studies/scenes/shared_faces.py               every case, some minutes
    python studies/scenes/shared_faces.py halves --json
"""

# pyright: reportAttributeAccessIssue=false

from __future__ import annotations

import argparse
import json
import sys
from collections.abc import Sequence
from dataclasses import dataclass

import mujoco
import numpy as np
from placed_patches import COOL, SIDE, TIMES, WARM, Patch, extrapolated, volumes_of

from thermograsp import Fingertip, ThermalTouch
from thermograsp.thermal.contact import patch_ends, patch_offset
from thermograsp.touch.contacts import AREA, ASIDE, CLOSED, COLUMNS, CONDUCTANCE, ENDS, LENGTH, NORMAL, PLACE
from thermograsp.touch.heat import JoinedHeat

_H = 0.0045
_DT, _BETWEEN = 0.01, 0.2
"""s, and m of blocks that would overlap if they were not each in a world of its own."""


def strips(*edges: float, of: Sequence[str], gap: float = 0.0, conductance: float = 2.5e4) -> list[Patch]:
    """Blocks that meet, or leave gaps, at those edges m of the face's middle, each under all of the face beside it."""
    places = (-_H, *edges, _H)
    found = []
    for n, (left, right, made_of) in enumerate(zip(places[:-1], places[1:], of, strict=True)):
        left, right = left + gap / 2 * (n > 0), right - gap / 2 * (n < len(edges))
        broad = right - left if 0 < n < len(edges) else SIDE
        middle = right - broad / 2 if n == 0 else left + broad / 2
        found.append(Patch((left, right), middle, conductance, made_of, breadth=broad))
    return found


@dataclass(frozen=True, slots=True)
class Case:
    """Patches, in order along y, and the z m from the face's middle to where they end."""

    patches: list[Patch]
    half_z: float = _H


def spots(broad: float, middle: float, *of: str) -> list[Patch]:
    """Two patches so broad in the middle of blocks, so many m to either side of the face's."""
    return [
        Patch((y - broad / 2, y + broad / 2), y, 2.5e4, made_of, breadth=_BETWEEN)
        for y, made_of in zip((-middle, middle), of, strict=True)
    ]


CASES = {
    "halves of aluminium": Case(strips(0.0, of=("aluminium", "aluminium"))),
    "halves of glass": Case(strips(0.0, of=("glass", "glass"))),
    "halves, aluminium and wood": Case(strips(0.0, of=("aluminium", "wood"))),
    "halves, aluminium and glass": Case(strips(0.0, of=("aluminium", "glass"))),
    "halves, glass and wood": Case(strips(0.0, of=("glass", "wood"))),
    "a quarter of aluminium, wood": Case(strips(-_H / 2, of=("aluminium", "wood"))),
    "a quarter of wood, aluminium": Case(strips(-_H / 2, of=("wood", "aluminium"))),
    "aluminium, 3 mm apart": Case(strips(0.0, of=("aluminium", "aluminium"), gap=0.003)),
    "steel, 3 mm apart": Case(strips(0.0, of=("steel", "steel"), gap=0.003)),
    "thirds of aluminium": Case(strips(-_H / 3, _H / 3, of=("aluminium",) * 3)),
    "thirds, glass between aluminium": Case(strips(-_H / 3, _H / 3, of=("aluminium", "glass", "aluminium"))),
    "two rods of aluminium": Case(spots(0.0016, 0.0025, "aluminium", "aluminium")),
    "a rod of aluminium, one of glass": Case(spots(0.0016, 0.0025, "aluminium", "glass")),
    "two balls of aluminium": Case(spots(0.0028, 0.0025, "aluminium", "aluminium"), 0.0014),
    "two balls of glass": Case(spots(0.0028, 0.0025, "glass", "glass"), 0.0014),
    "two balls of aluminium, nearer": Case(spots(0.002, 0.0012, "aluminium", "aluminium"), 0.001),
    "corners of aluminium": Case(strips(0.0, of=("aluminium", "aluminium"), gap=0.003), 0.0015),
}


def touch_on(patches: Sequence[Patch]) -> ThermalTouch:
    """Of a fingertip above the blocks that looks down."""
    boxes = "".join(
        f'<body name="{n}" pos="0 {each.block} 0">'
        f'<geom type="box" size="{SIDE / 2} {each.breadth / 2} {each.thick / 2}"/></body>'
        for n, each in enumerate(patches)
    )
    model = mujoco.MjModel.from_xml_string(f"""
      <mujoco><worldbody>{boxes}
        <body name="tip" pos="0 0 .1"><geom name="tip" type="box" size=".01 .01 .004"/></body>
      </worldbody></mujoco>""")
    tip = Fingertip("tip", (0, 0, -0.004), (0, 0, -1), (0.02, 0.02), temperature=WARM)
    objects = {str(n): each.made_of for n, each in enumerate(patches)}
    return ThermalTouch(model, fingertips={"tip": tip}, objects=objects, air=0.0, ambient=COOL, chain="ideal")


def by_network(case: Case, only: int | None = None) -> np.ndarray:
    """K of drop after TIMES; of one of the patches alone where it is told which."""
    patches = case.patches
    touch = touch_on(patches)
    width = touch._pads[0].stack.width
    heat = JoinedHeat(
        touch._pads, (), touch._shapes, worlds=1, dt=_DT, tolerance=0.05, film=0.0, ambient=COOL
    )
    touches = np.zeros((1, 1, len(patches) + 1, COLUMNS))
    for n, patch in enumerate(patches):
        if only not in (None, n):
            continue
        broad, long, middle = patch.y[1] - patch.y[0], 2 * case.half_z, sum(patch.y) / 2
        area, row = broad * long, touches[0, 0, n]
        row[[CONDUCTANCE, CLOSED, AREA, LENGTH]] = (
            patch.conductance * area,
            1.0,
            area,
            area * long,
        )
        row[ASIDE] = area * patch_offset(abs(middle), broad, width)
        row[ENDS] = area * patch_ends(middle - patch.block, patch.block, broad, patch.breadth, width)
        row[PLACE : PLACE + 3] = 0.0, -patch.block, patch.thick / 2
        row[NORMAL : NORMAL + 3] = 0.0, 0.0, -1.0
    found = []
    for n in range(1, round(TIMES[-1] / _DT) + 1):
        heat.advance(touches, 1)
        if any(abs(n * _DT - time) < 1e-9 for time in TIMES):
            found.append(float(heat.drop[0, 0]))
    return np.array(found)


def by_volumes(case: Case, refine: float) -> tuple[float, ...]:
    """K of drop after TIMES in half of all bodies."""
    return volumes_of(touch_on(case.patches)._pads[0].stack, case.patches, case.half_z, refine)


def main(arguments: Sequence[str] | None = None) -> int:
    """Print the table."""
    parser = argparse.ArgumentParser(description="Objects side by side under a sensor beside finite volumes.")
    parser.add_argument("case", nargs="?", default="", help="part of a case's name")
    parser.add_argument("--json", action="store_true", help="one JSON object a line")
    options = parser.parse_args(arguments)
    for name in (name for name in CASES if options.case in name):
        case = CASES[name]
        coarse, fine = (np.array(by_volumes(case, refine)) for refine in (1.0, 1.5))
        found = {
            "network": by_network(case),
            "volumes": extrapolated(coarse, fine),
            "grid": fine - coarse,
            "apart": np.sum([by_network(case, n) for n in range(len(case.patches))], axis=0),
        }
        record = {"case": name} | {key: [round(float(x), 3) for x in each] for key, each in found.items()}
        print(json.dumps(record) if options.json else record, flush=True)
    return 0


if __name__ == "__main__":
    sys.exit(main())
