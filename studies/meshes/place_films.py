"""Places of mugs with contents, beside grids that are finer still, whose states are fields with their film."""

from __future__ import annotations

from place_drops import STACK, TIP, held, largest, on_grid
from place_rows import Row
from place_shapes import MATERIALS, ONE, whole

from thermograsp.thermal.anywhere.placed import placed_network
from thermograsp.thermal.anywhere.ports import face_patterns
from thermograsp.thermal.meshes.film import Film, film_of
from thermograsp.thermal.meshes.grid import MeshGridding
from thermograsp.thermal.meshes.network import patch_fields

FILMS = 50.0, 500.0, 3000.0  # W/(m2 K), of air, of still water, of water that boils
FILLED = [
    name for name, (body, _) in ONE.items() if body in ("mug", "pot of 1 mm", "cup of .6 mm", "tube of .2 mm")
]
"""Places of ONE, with contents."""
FINEST = MeshGridding(growth=0.3, largest=1e-3, relief=24)


def with_contents(name: str, material: str) -> list[Row]:
    """A place of FILLED, the largest error behind each of FILMS."""
    kind, patch = ONE[name]
    body = whole(kind, material)
    one = film_of(body, 1.0)
    assert one is not None
    found = []
    for film in FILMS:
        inside = Film(film * one.area, one.walls)
        fast = held(placed_network(body, [patch], STACK, inside.conductance).network, inside.conductance)
        fine = on_grid(patch_fields(body, [patch], face_patterns(TIP), FINEST, inside))
        case = f"{name}, {film:g} W/(m2 K) to contents"
        found.append(Row(case, material, *largest(fast, 0, fine)))
    return found


def filled_rows(chosen: str) -> list[Row]:
    """The same with contents."""
    names = [name for name in FILLED if chosen in name]
    return [row for name in names for material in MATERIALS for row in with_contents(name, material)]
