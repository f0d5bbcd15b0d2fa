"""How far networks from heat kernels are off: over drawn boxes, beside networks of full order.

Run with `python -m thermograsp.bench.kernels [scenes] [seed]`; a scene takes some seconds. One line a scene: material,
size m, area mm2, fingertips, and the largest error of the drop for each level, as a share of the first difference, from
0.05 to 20 s after touches of 1e2 .. 1e5 W/(m2 K), one and all fingertips. The last line is the largest of all.
"""

from __future__ import annotations

import sys

import numpy as np

from thermograsp.thermal import Geometry, material, materials, sensor
from thermograsp.thermal.network import (
    LEVELS,
    MOST_MODES,
    Demand,
    assemble,
    box_system,
    responses,
    sample_geometry,
)


def drawn(rng: np.random.Generator) -> Geometry:
    """A box of any material with one or two fingertips in the middle of its faces."""
    names = list(materials())
    low, high = np.log((0.0095, 0.0095, 0.001)), np.log((0.1, 0.1, 0.05))
    width, depth, thickness = np.exp(rng.uniform(low, high)).tolist()
    stack = sensor("seed")
    area = stack.face_area * float(rng.choice([1.0, 0.6, 0.3, 0.1]))
    made = material(names[rng.integers(len(names))])
    return Geometry(
        stack, made, "T", area, "square", (width, depth, thickness), 1 if rng.random() < 0.5 else 2
    )


def errors(geometry: Geometry) -> list[float]:
    """The error of each level, a share of the first difference."""
    demand = Demand(1.0, 1.0)
    full = responses(assemble(geometry, sample_geometry(geometry).networks(MOST_MODES)), demand)
    return [
        float(np.abs(responses(box_system(geometry, level, 0.0), demand) - full).max()) for level, _ in LEVELS
    ]


def main(scenes: int = 40, seed: int = 1) -> None:
    """Prints a line a scene and the largest error of each level."""
    rng, worst = np.random.default_rng(seed), np.zeros(len(LEVELS))
    for _ in range(scenes):
        geometry = drawn(rng)
        found = errors(geometry)
        worst = np.maximum(worst, found)
        size = " x ".join(f"{side:.4f}" for side in geometry.object_size)
        shares = " ".join(f"{share:.5f}" for share in found)
        print(f"{geometry.material.name} {size} {geometry.area * 1e6:.0f} {geometry.fingertips} {shares}")
    print("largest", " ".join(f"{share:.5f}" for share in worst))


if __name__ == "__main__":
    main(*map(int, sys.argv[1:]))
