"""Networks of one place and of two, beside those of a grid that is fine there."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from place_drops import STACK, TIP, largest
from place_shapes import MATERIALS, ONE, PARTS, TWO, parted, whole

from thermograsp.thermal import Solid, SurfacePatch
from thermograsp.thermal.anywhere.placed import placed_network
from thermograsp.thermal.anywhere.ports import face_patterns
from thermograsp.thermal.meshes import body_network


@dataclass(frozen=True, slots=True)
class Row:
    """As Worst has it."""

    case: str
    material: str
    error: float
    drop: float
    time: float
    conductance: float


def compared(case: str, material: str, body: Solid, patches: Sequence[SurfacePatch]) -> Row:
    """The network that environments use beside the fine grid's, for each patch with one whose axes are along it."""
    fast = placed_network(body, patches, STACK).network
    found = []
    for n, patch in enumerate(patches):
        others = [other for other in patches if other is not patch]
        fine = body_network(body, [*others, patch], patterns=face_patterns(TIP))
        found.append(largest(fast, n, fine))
    return Row(case, material, *max(found, key=lambda worst: abs(worst.error)))


def rows(chosen: str) -> list[Row]:
    """Of the cases with this in their name."""
    found = []
    for name, (body, *patches) in (ONE | TWO).items():
        if chosen in name:
            found += [compared(name, material, whole(body, material), patches) for material in MATERIALS]
    for name, (body, materials, *patches) in PARTS.items():
        if chosen in name:
            found.append(compared(name, " and ".join(materials), parted(body, materials), patches))
    return found


def print_rows(found: Sequence[Row]) -> None:
    """A line each, and what all are within."""
    for row in found:
        print(
            f"{row.case:52}{row.material:22}{row.error:+.3f} K of {row.drop:.2f} K at {row.time:.2f} s, "
            f"{row.conductance:.0e} W/(m2 K)"
        )
    worst = max(found, key=lambda row: abs(row.error))
    middle, ninth = np.quantile([abs(row.error) for row in found], [0.5, 0.9])
    print(f"{len(found)} touches, half within {middle:.3f} K and nine of ten within {ninth:.3f} K")
    print(f"at most {abs(worst.error):.3f} K: {worst.case}, {worst.material}")
