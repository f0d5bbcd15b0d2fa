"""What it costs that an object remembers few places: journeys of fingertips over a box beside networks of every place,
and beside finite volumes over which the sensor's face moves.

Each journey holds, lets go, slides and comes back. `all places` is the same network made of every place of the journey
before it begins, so that nothing is carried or forgotten. The finite volumes of touch_volumes.py share no heat model
with the package; their grids are uniform along the slide, and the face moves by whole cells.

    python studies/scenes/remembered_places.py                                 every journey on three materials
    python studies/scenes/remembered_places.py slow fast --materials glass --most 2 4 6 8 12
    python studies/scenes/remembered_places.py --volumes                       slides beside finite volumes
    python studies/scenes/remembered_places.py --cost [--mesh] [--padded]      us an update, ms of a new place
"""

from __future__ import annotations

import argparse
import time
from collections.abc import Sequence
from dataclasses import dataclass
from unittest import mock

import numpy as np
import trimesh
from scipy import sparse
from scipy.sparse.linalg import splu
from touch_volumes import GAMMA, HALF, STACK, Body, Grid, block, body, element, face, lines

from thermograsp.thermal import Material, Surround, material
from thermograsp.thermal.padded import RINGS
from thermograsp.thermal.surfaces import Solid, SolidPart
from thermograsp.touch.contacts import AREA, BESIDE, CLOSED, COLUMNS, CONDUCTANCE, LENGTH, NORMAL, PLACE
from thermograsp.touch.heat import JoinedHeat
from thermograsp.touch.heat.places import BodyField, Place
from thermograsp.touch.scene import BodyShape, PadPlace

STEP = 0.01  # s
SIZE = (0.02, 0.04, 0.04)
"""m, of the box, touched on the faces across its first axis."""
WARM, COOL = 36.0, 24.0  # °C
MATERIALS = "glass", "wood", "stainless_steel"
MOST = 2, 4, 6, 8, 12
RING_AREA = 1e-4  # m2, of each ring of a pad that touches
MANY = 1000
MM = 1e-3


@dataclass(frozen=True, slots=True)
class Leg:
    """Of a journey: seconds, from m along the face's axes to m; pressed or not."""

    seconds: float
    begin: tuple[float, float]
    end: tuple[float, float]
    pressed: bool = True


def held(y: float, seconds: float, z: float = 0.0) -> Leg:
    """Held at mm."""
    return Leg(seconds, (y * MM, z * MM), (y * MM, z * MM))


def apart(seconds: float) -> Leg:
    """Let go."""
    return Leg(seconds, (0.0, 0.0), (0.0, 0.0), pressed=False)


def slid(y: float, end: float, speed: float) -> Leg:
    """From mm to mm at mm/s."""
    return Leg(abs(end - y) / speed, (y * MM, 0.0), (end * MM, 0.0))


def _grid(seed: int = 0, grasps: int = 24) -> list[Leg]:
    rng, legs = np.random.default_rng(seed), []
    for _ in range(grasps):
        y, z = (4.5 * rng.integers(-1, 2, 2)).tolist()
        legs += [held(y, 0.4, z), apart(0.2)]
    return legs


JOURNEYS: dict[str, list[Leg]] = {
    "aside": [held(0, 1.2), apart(0.4), held(6, 0.8), slid(6, 10, 5), held(0, 0.4)],
    "slow": [held(0, 1), slid(0, 8, 1), apart(0.2), held(0, 0.5), apart(0.2), held(8, 0.5)],
    "fast": [held(-10, 1), slid(-10, 10, 10), apart(0.2), held(-10, 0.5)],
    "to and fro": [held(0, 1), slid(0, 10, 10), slid(10, 0, 10), slid(0, 10, 10), held(10, 0.5)],
    "regrasps": _grid(),
}
"""regrasps: at random on nine places, 4.5 mm apart."""


def steps(legs: Sequence[Leg]) -> list[tuple[bool, float, float]]:
    """Whether pressed, and m along the face's axes, of every step."""
    found = []
    for leg in legs:
        count = round(leg.seconds / STEP)
        for n in range(count):
            share = n / count
            y, z = (a + (b - a) * share for a, b in zip(leg.begin, leg.end, strict=True))
            found.append((leg.pressed, y, z))
    return found


def shape_of(name: str, mesh: bool) -> BodyShape:
    """The box, of that material, or a mesh of it."""
    size, solid = np.array(SIZE), None
    if mesh:
        made = trimesh.creation.box(SIZE)
        part = SolidPart(np.asarray(made.vertices), np.asarray(made.faces), material(name))
        solid = Solid((part,))
    a, b, c = SIZE
    surface = 2 * (a * b + b * c + c * a)
    middle, turn = np.zeros(3), np.eye(3)
    return BodyShape(name, 0, (), material(name), COOL, size, middle, turn, size, surface, solid=solid)


def heat_of(shape: BodyShape, fingertips: int, film: float = 0.0, padded: bool = False) -> JoinedHeat:
    """Of so many fingertips, on the faces in turn. padded: with silicone around their sensors."""
    around = Surround().around(STACK) if padded else None
    pads = tuple(
        PadPlace(
            *(f"tip{f}", 0, (), np.zeros(3), np.eye(3), np.full(2, 0.02), STACK, WARM),
            surround=around,
        )
        for f in range(fingertips)
    )
    return JoinedHeat(pads, (), (shape,), worlds=1, dt=STEP, tolerance=0.05, film=film, ambient=COOL)


def touching(fingertips: int, pressed: bool, y: float, z: float, conductance: float) -> np.ndarray:
    """A step's touches of whole faces that conduct W/(m2 K)."""
    touches, area = np.zeros((1, fingertips, 1 + fingertips, COLUMNS)), STACK.face_area
    for f in range(fingertips):
        touch = touches[0, f, 0]
        if pressed:
            touch[[CONDUCTANCE, AREA, LENGTH]] = conductance * area, area, area * STACK.width
            touch[CLOSED] = 1.0
        touch[NORMAL] = 1.0 if f == 0 else -1.0
        touch[PLACE : PLACE + 3] = (-SIZE[0] / 2 if f == 0 else SIZE[0] / 2), y, z
    return touches


def felt(heat: JoinedHeat, legs: Sequence[Leg], fingertips: int, conductance: float) -> np.ndarray:
    """(steps, F) K of drop."""
    found = []
    for pressed, y, z in steps(legs):
        heat.advance(touching(fingertips, pressed, y, z, conductance), 1)
        found.append(heat.drop[0].copy())
    return np.array(found)


def remembering(most: int) -> mock._patch:
    """While it lasts, objects remember so many places besides those in use."""
    return mock.patch("thermograsp.touch.heat.joined.MOST_PLACES", most)


def by_all(
    shape: BodyShape, legs: Sequence[Leg], fingertips: int, conductance: float, film: float = 0.0
) -> tuple[np.ndarray, int]:
    """(steps, F) K where every place is known before the journey begins, wholly; and how many these are."""
    with remembering(MANY):
        heat = heat_of(shape, fingertips, film)
        felt(heat, legs, fingertips, conductance)
        places = heat._fields[0][0].places
        heat = heat_of(shape, fingertips, film)
        field = heat._known.field

        def wholly(
            o: int, material: Material, places: tuple[Place, ...], whole: tuple[bool, ...]
        ) -> BodyField:
            return field(o, material, places, (True,) * len(whole))

        heat._known.field = wholly
        heat._fields[0][0] = wholly(0, shape.material, places, (True,) * len(places))
        heat._renumber(0)
        return felt(heat, legs, fingertips, conductance), len(places)


def row(
    journey: str,
    name: str,
    most: Sequence[int] = MOST,
    *,
    mesh: bool = False,
    fingertips: int = 2,
    conductance: float = 3e3,
    film: float = 0.0,
) -> dict[str, object]:
    """K, the largest error of a journey by how many places are remembered."""
    legs, shape = JOURNEYS[journey], shape_of(name, mesh)
    expected, places = by_all(shape, legs, fingertips, conductance, film)
    errors = {}
    for each in most:
        with remembering(each):
            found = felt(heat_of(shape, fingertips, film), legs, fingertips, conductance)
        errors[each] = round(float(np.abs(found - expected).max()), 3)
    return {
        "journey": journey,
        "material": name,
        "shape": "mesh" if mesh else "box",
        "places": places,
        "largest_K": round(float(expected.max()), 2),
        "error_K": errors,
    }


SLIDES = {
    "1 mm/s": [held(-2, 1), slid(-2, 2, 1), apart(0.2), held(-2, 0.5)],
    "10 mm/s": [held(-5, 1), slid(-5, 5, 10), apart(0.2), held(-5, 0.5)],
}
"""Of one fingertip: held, slid, let go, and back where it began."""


def by_volumes(name: str, legs: Sequence[Leg], conductance: float, refine: float) -> np.ndarray:
    """(steps,) K, of half the box and half the element, whose face moves over cells that are as long as its own."""
    count = 2 * round(4 * refine)
    side = 2 * HALF / count
    along = np.arange(-count // 2, count // 2 + 1) * side
    reach = max(max(abs(leg.begin[0]), abs(leg.end[0])) for leg in legs)
    beyond = int(np.ceil(reach / side)) + 2
    inner = np.arange(-count // 2 - beyond, count // 2 + beyond + 1) * side
    outer = lines(inner[-1], SIZE[1] / 2, round(5 * refine), side)[1:]
    quarter = block(name, SIZE, refine, 8)
    near = lines(0.0, SIZE[0], round(10 * refine), 1e-4 / refine)
    across = quarter.edges[2]
    k, c = (np.full(len(near) - 1, each[0]) for each in (quarter.k, quarter.c))
    box = body(Grid((near, np.concatenate((-outer[::-1], inner, outer)), across), k, c))
    tip = body(element(along, face(refine), refine))
    return _moved(tip, box, len(outer) + beyond, side, legs, conductance)


def _moved(
    tip: Body, box: Body, first: int, side: float, legs: Sequence[Leg], conductance: float
) -> np.ndarray:
    """first: of the box's cells along the slide, the one under the face's first where it is at 0."""
    offset, total = len(tip.capacity), len(tip.capacity) + len(box.capacity)
    capacity = np.concatenate((tip.capacity, box.capacity))
    conduction = sparse.block_diag([tip.conduction, box.conduction], format="csr")
    source = np.concatenate((tip.source, np.zeros(len(box.capacity))))
    weight, mix = GAMMA / 2 * STEP, 1 / (GAMMA * (2 - GAMMA))
    solver = splu(
        (sparse.diags(capacity) + weight * conduction).tocsc(),
        permc_spec="MMD_AT_PLUS_A",
        diag_pivot_thresh=0.0,
        options={"SymmetricMode": True},
    )
    cells = tip.grid.shape[1:]
    above = np.arange(np.prod(cells))
    below = offset + np.arange(np.prod(box.grid.shape[1:])).reshape(box.grid.shape[1:])
    area = (np.diff(tip.grid.edges[1])[:, None] * np.diff(tip.grid.edges[2])[None]).ravel()
    resist = sum(np.diff(each.grid.edges[0])[0] / (2 * each.grid.k[0]) for each in (tip, box))
    through = area / (1 / conductance + resist)
    reached: dict[int, np.ndarray] = {}

    def answer(cell: int) -> np.ndarray:
        if cell not in reached:
            unit = np.zeros(total)
            unit[cell] = 1.0
            reached[cell] = solver.solve(unit)
        return reached[cell]

    known: dict[int, tuple[np.ndarray, np.ndarray, np.ndarray]] = {}

    def joined(at: int) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        if at not in known:
            under = below[first + at : first + at + cells[0], : cells[1]].ravel()
            flows = np.array([answer(int(a)) - answer(int(b)) for a, b in zip(above, under, strict=True)])
            known[at] = under, flows, weight * (flows[:, above] - flows[:, under]) + np.diag(1 / through)
        return known[at]

    state = np.where(np.arange(total) < offset, WARM - COOL, 0.0)
    row, behind, drops = _row(tip), _behind(tip), []
    for pressed, y, _ in steps(legs):
        contact = joined(round(y / side)) if pressed else None

        def solved(load: np.ndarray) -> np.ndarray:
            alone = solver.solve(load)
            if contact is None:  # noqa: B023  (it is called in this step)
                return alone
            under, flows, matrix = contact  # noqa: B023
            return alone - weight * flows.T @ np.linalg.solve(matrix, alone[above] - alone[under])

        flow = conduction @ state
        if contact is not None:
            met = through * (state[above] - state[contact[0]])
            flow[above] += met
            flow[contact[0]] -= met
        middle = solved(capacity * state - weight * (flow - 2 * source))
        state = solved(capacity * (mix * middle + (1 - mix) * state) + weight * source)
        drops.append(row @ state[:offset] + behind)
    return np.array(drops)


def _row(tip: Body) -> np.ndarray:
    from touch_volumes import _drop

    return _drop(tip.grid)


def _behind(tip: Body) -> float:
    from touch_volumes import _behind

    return _behind(tip.grid) * (WARM - COOL)


@dataclass(frozen=True, slots=True)
class Beside:
    """Beside finite volumes. sliding, back: K, the largest error while the face slides, and once it is back. grid_K: K,
    the largest that was taken off the finer volumes."""

    sliding_K: float
    back_K: float
    grid_K: float
    largest_K: float


def beside_volumes(
    slide: str, name: str, *, mesh: bool = False, conductance: float = 3e3, refine: float = 1.5
) -> Beside:
    """The error after the first 50 ms of a contact."""
    legs = SLIDES[slide]
    coarse, fine = (by_volumes(name, legs, conductance, each) for each in (1.0, refine))
    expected = fine + (fine - coarse) / (refine**2 - 1)
    found = felt(heat_of(shape_of(name, mesh), 1), legs, 1, conductance)[:, 0]
    error, ends = np.abs(found - expected), np.cumsum([round(leg.seconds / STEP) for leg in legs])
    return Beside(
        float(error[ends[0] : ends[1]].max()),
        float(error[ends[2] + 5 :].max()),
        float(np.abs(fine - expected)[5:].max()),
        float(expected.max()),
    )


def cost(most: int, fingertips: int, mesh: bool, padded: bool = False) -> dict[str, object]:
    """us of an update under a held contact, states, and ms of a step in which every fingertip has a new place."""
    shape, places = shape_of("glass", mesh), [(4.5 * y, 4.5 * z) for y in range(-3, 4) for z in range(-3, 4)]
    with remembering(most):
        heat, spent, touches = heat_of(shape, fingertips, padded=padded), [], np.zeros(0)
        for y, z in places[: most + 12]:
            touches = touching(fingertips, True, y * MM, z * MM, 3e3)
            if padded:  # W/K, m2 and steps of each ring
                touches[0, :, 0, BESIDE : BESIDE + 3 * RINGS] = [300.0 * RING_AREA, RING_AREA, 1.0] * RINGS
            begun = time.process_time()
            heat.advance(touches, 1)
            spent.append(time.process_time() - begun)
        shortest = np.inf
        for _ in range(7):
            begun = time.process_time()
            for _ in range(2000):
                heat.advance(touches, 1)
            shortest = min(shortest, (time.process_time() - begun) / 2000)
    return {
        "shape": ("mesh" if mesh else "box") + (", padded" if padded else ""),
        "fingertips": fingertips,
        "most": most,
        "update_us": round(1e6 * shortest, 2),
        "states": len(heat._fields[0][0].rates),
        "new_places_ms": round(1e3 * float(np.median(spent[-8:])), 1),
    }


def main() -> None:
    """Measures and prints."""
    parser = argparse.ArgumentParser(description="What it costs to remember few places of an object.")
    parser.add_argument("journeys", nargs="*", default=list(JOURNEYS), help=", ".join(JOURNEYS))
    parser.add_argument("--materials", nargs="+", default=MATERIALS)
    parser.add_argument("--most", nargs="+", type=int, default=MOST, help="places besides those in use")
    parser.add_argument("--mesh", action="store_true", help="a mesh of the box")
    parser.add_argument("--conductance", type=float, default=3e3, help="W/(m2 K)")
    parser.add_argument("--film", type=float, default=0.0, help="W/(m2 K) of the air")
    parser.add_argument("--volumes", action="store_true", help="beside finite volumes")
    parser.add_argument("--cost", action="store_true", help="what it costs")
    parser.add_argument("--padded", action="store_true", help="with silicone around the sensors, for --cost")
    options = parser.parse_args()
    if options.cost:
        cost(2, 1, options.mesh, options.padded)  # which compiles
        for fingertips in (1, 2):
            for most in options.most:
                print(cost(most, fingertips, options.mesh, options.padded), flush=True)
        return
    for name in options.materials:
        if options.volumes:
            for slide in SLIDES:
                print(name, slide, beside_volumes(slide, name, mesh=options.mesh), flush=True)
            continue
        for journey in options.journeys:
            words = {"mesh": options.mesh, "conductance": options.conductance, "film": options.film}
            print(row(journey, name, options.most, **words), flush=True)


if __name__ == "__main__":
    main()
