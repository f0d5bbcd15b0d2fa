"""The heat kernel of a sensor's face on a body, until its heat has gone far: of cells beneath, unrolled.

What cells are too coarse for, a box that is cut into the same cells is, too (box.py): so few serve.

M: patterns, T: times.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np

from ..kernels import Tip
from ..surfaces import Solid
from .box import BoxBeside, box_beside, functions, means
from .cells import Cells, cells_beneath
from .columns import Columns, Fineness, Piece, Place, columns
from .fading import fading


class LocalKernel(NamedTuple):
    """At some times. kernel: (T, M, M) K/J. turn: (T, M, M), of what cells are too coarse for: where k on these is
    between this patch and another, turn k turn_of_the_other^T is without their error."""

    kernel: np.ndarray
    turn: np.ndarray


class LocalCells(NamedTuple):
    """Beneath a patch. along: its columns. ports: (N, M) of the patterns' flows into the cells. beside: the box that
    tells what these are too coarse for. diffusivity: m2/s of what is touched."""

    place: Place
    along: tuple[Columns, Columns]
    cells: Cells
    ports: np.ndarray
    beside: BoxBeside
    diffusivity: float

    def kernel(self, times: np.ndarray) -> LocalKernel:
        """times: s, the last the longest."""
        cells = self.cells
        known = fading(
            cells.capacity, cells.neighbours, cells.links, cells.sink, self.ports, float(times[-1])
        )
        turn = self.beside.turn(self.diffusivity * times)
        return LocalKernel(turn @ known.kernel(times) @ turn.transpose(0, 2, 1), turn)


def local_cells(
    body: Solid, wet: Sequence[np.ndarray], film: float, place: Place, tip: Tip, fine: Fineness
) -> LocalCells | None:
    """wet: (F,) of each part, whether contents wet its triangles, behind a film of W/(m2 K). None where what is touched
    does not lie on the place's face, or the body's parts cross."""
    if body.hosts is None:
        return None
    pieces = [
        Piece(
            place.face.local(part.triangles),
            under,
            part.material.conductivity,
            part.material.volumetric_heat_capacity,
            host,
        )
        for part, under, host in zip(body.parts, wet, body.hosts, strict=True)
    ]
    u, v = (columns(place, pieces, axis, fine) for axis in range(2))
    if u is None or v is None:
        return None
    found = cells_beneath(place, pieces, (u.edges, v.edges), film, fine)
    if found is None:
        return None
    outer = pieces[0]
    through = film / outer.conductivity if found.wet and len(pieces) == 1 else 0.0
    beside = box_beside(place.face, place.half, (u, v), found.w, tip, place.depth, through)
    ports = flow_into(place, found, (u, v), functions(tip))
    return LocalCells(place, (u, v), found, ports, beside, outer.conductivity / outer.capacity)


def flow_into(
    place: Place,
    cells: Cells,
    along: tuple[Columns, Columns],
    values: np.ndarray,
    middle: tuple[float, float] = (0.0, 0.0),
) -> np.ndarray:
    """(N, M) of each pattern's flow into the cells through a square like the place's, that of the even one in all 1: no
    other lets heat in, also where the face ends within the square. All 0 where nothing of it is on the face. values:
    (2, M, strips), functions' along u and v. middle: m along the face, where the square is."""
    edges = [
        np.clip(place.face.seen(each.edges - at, axis) / place.half, -1.0, 1.0)
        for axis, (each, at) in enumerate(zip(along, middle, strict=True))
    ]
    weight = cells.cover * np.diff(edges[0])[:, None] * np.diff(edges[1])
    weight /= weight.sum() or 1.0
    x, y = (means(each, at) for each, at in zip(values, edges, strict=True))
    flows = x[:, :, None] + y[:, None, :]
    flows[0] = 1.0
    flows[1:] -= np.tensordot(flows[1:], weight, axes=2)[:, None, None]
    ports = np.zeros((len(cells.capacity), len(flows)))
    touched = weight > 0
    ports[cells.top[touched]] = (weight * flows)[:, touched].T
    return ports
