"""A mesh's network from its modes, wherever it is touched, beside grids that are fine there and closed forms."""

from __future__ import annotations

import numpy as np
import pytest
import trimesh

from thermograsp import thermal
from thermograsp.errors import MeshError
from thermograsp.thermal.anywhere import PLACED_SHARE, placed_body
from thermograsp.thermal.anywhere import place as place_module
from thermograsp.thermal.anywhere.beneath import beneath
from thermograsp.thermal.anywhere.placed import placed_network
from thermograsp.thermal.anywhere.ports import centred_tip, face_patterns
from thermograsp.thermal.meshes import MeshGridding, body_modes, body_network, field_carried
from thermograsp.thermal.surfaces import Solid, SolidPart, SurfacePatch

STACK = thermal.sensor("seed")
AREA = STACK.width**2
TIP = centred_tip(STACK, AREA)
TIMES = 0.02 * np.arange(3, 200)
CUBE = (0.03, 0.03, 0.03)  # of one size, whose modes are made once
DIFFERENCE = 12.0


def part(mesh: trimesh.Trimesh, material: str) -> SolidPart:
    return SolidPart(np.array(mesh.vertices), np.array(mesh.faces), thermal.material(material))


def of(mesh: trimesh.Trimesh, material: str = "glass") -> Solid:
    return Solid((part(mesh, material),))


def at(*centre: float, normal: tuple[float, float, float]) -> SurfacePatch:
    x, y, z = centre
    return SurfacePatch((x, y, z), normal, AREA)


def cup() -> trimesh.Trimesh:
    return trimesh.creation.revolve(
        [(0, -0.02), (0.02, -0.02), (0.02, 0.02), (0.017, 0.02), (0.017, -0.017), (0, -0.017)], sections=64
    )


def rod(radius: float) -> trimesh.Trimesh:
    return trimesh.creation.cylinder(radius, 0.05, sections=64)


def tube(radius: float, wall: float) -> trimesh.Trimesh:
    return trimesh.creation.annulus(radius - wall, radius, 0.05, segments=96)


def slab(upper: str, lower: str) -> Solid:
    meshes = trimesh.creation.box((0.03, 0.03, 0.003)), trimesh.creation.box((0.03, 0.03, 0.02))
    meshes[0].apply_translation((0, 0, 0.0115))
    return Solid(tuple(part(mesh, name) for mesh, name in zip(meshes, (upper, lower), strict=True)))


def drops(network, conductance: float, tip: int = 0) -> np.ndarray:
    """K at TIMES on one of the patches, with a fingertip on each from time 0 on."""
    side, patterns = TIP.side, TIP.side.ports.shape[1]
    fingertips, order = network.ports.shape[1] // patterns, len(network.rates)
    rates = np.concatenate([network.rates, *[side.rates] * fingertips])
    ports = np.zeros((len(rates), network.ports.shape[1]))
    ports[:order] = network.ports
    for n in range(fingertips):
        own = slice(order + n * len(side.rates), order + (n + 1) * len(side.rates))
        ports[own, n * patterns : (n + 1) * patterns] = -side.ports
    row = np.zeros(len(rates))
    row[order + tip * len(side.rates) : order + (tip + 1) * len(side.rates)] = side.outputs["drop"]
    fades, turn = np.linalg.eigh(np.diag(rates) + conductance * AREA * ports @ ports.T)
    fades = np.maximum(fades, 1e-14)
    drive = turn.T @ (conductance * AREA * DIFFERENCE * ports[:, ::patterns].sum(axis=1))
    return -np.expm1(-np.outer(TIMES, fades)) / fades * drive @ (row @ turn)


def worst(
    body: Solid, *patches: SurfacePatch, mirrored: bool = False, gridding: MeshGridding | None = None
) -> float:
    """K, the largest error of any fingertip's drop beside the grid that is aligned with its patch. mirrored: the
    patches are each other's images on a body that is its own, so that one tells of all. gridding: of the grid, None for
    the usual."""
    network = placed_network(body, patches, STACK).network
    found = 0.0
    for n, patch in enumerate(patches[:1] if mirrored else patches):
        ordered = [*(other for other in patches if other is not patch), patch]
        fine = body_network(body, ordered, patterns=face_patterns(TIP), gridding=gridding)
        for conductance in (1e3, 1e5):
            error = drops(network, conductance, n) - drops(fine, conductance, len(patches) - 1)
            found = max(found, float(np.abs(error).max()))
    return found


def test_a_block_s_modes_are_cosines() -> None:
    sides = np.array([0.04, 0.03, 0.02])
    modes = body_modes(of(trimesh.creation.box(sides)))
    waves = np.indices((8, 8, 8)).reshape(3, -1)
    expected = np.sort(np.sum((np.pi * waves / sides[:, None]) ** 2, axis=0))[:40]
    assert modes.rates[0] == 0.0
    assert modes.rates[1:40] == pytest.approx(expected[1:], rel=0.02)  # of 8,000 cells
    capacity = modes.grid.capacity
    gram = modes.fields.T @ (capacity[:, None] * modes.fields)
    np.testing.assert_allclose(gram, np.eye(len(gram)), atol=1e-6)
    assert capacity.sum() == pytest.approx(sides.prod())


def test_a_material_only_scales_the_modes() -> None:
    mesh = trimesh.creation.box(CUBE)
    glass, wood = body_modes(of(mesh, "glass")), body_modes(of(mesh, "wood"))
    assert glass.fields is wood.fields
    assert glass.diffusivity == thermal.material("glass").diffusivity != wood.diffusivity


PLACES = {
    "wall": (cup, at(0.02, 0.0, 0.0, normal=(1, 0, 0)), True),
    "foot": (cup, at(0.0, 0.0, -0.02, normal=(0, 0, -1)), True),
    "rim": (cup, at(0.02, 0.0, 0.0175, normal=(1, 0, 0)), False),
    "beyond the rim": (cup, at(0.02, 0.0, 0.0207, normal=(1, 0, 0)), False),
    "foot's edge": (cup, at(0.02, 0.0, -0.0175, normal=(1, 0, 0)), False),
    "handle": (lambda: rod(0.0097), at(0.0097, 0.0, 0.0, normal=(1, 0, 0)), False),
    "end of a handle": (lambda: rod(0.0097), at(0.0097, 0.0, 0.0235, normal=(1, 0, 0)), False),
    "rod": (lambda: rod(0.006), at(0.006, 0.0, 0.0, normal=(1, 0, 0)), False),
    "corner": (lambda: trimesh.creation.box(CUBE), at(0.015, 0.0103, 0.0, normal=(1, 0, 0)), True),
    "edge": (lambda: trimesh.creation.box(CUBE), at(0.015, 0.015, 0.0, normal=(1, 0, 0)), False),
    "ball": (lambda: trimesh.creation.icosphere(5, 0.02), at(0.02, 0.0, 0.0, normal=(1, 0, 0)), True),
}
"""Mesh, patch, and whether it is plain there."""
QUICK = ("wall", "ceramic"), ("rim", "aluminium"), ("ball", "wood")


@pytest.mark.parametrize(
    ("place", "material"),
    [
        pytest.param(place, material, marks=() if (place, material) in QUICK else pytest.mark.slow)
        for place in PLACES
        for material in ("wood", "ceramic", "aluminium")
    ],
)
def test_a_touch_is_within_the_stated_share(place: str, material: str) -> None:
    mesh, patch, plain = PLACES[place]
    body = of(mesh(), material)
    assert beneath(body.outside, patch).plain is plain
    assert worst(body, patch) < PLACED_SHARE * DIFFERENCE


@pytest.mark.slow
@pytest.mark.parametrize("material", ["wood", "ceramic", "stainless_steel", "aluminium"])
@pytest.mark.parametrize(("radius", "wall"), [(0.0095, 0.001), (0.011, 0.002)])
def test_a_narrow_tube_is_felt_within_the_stated_share(radius: float, wall: float, material: str) -> None:
    """Beside a grid with steps half as high as usual, whose own error is 0.01 K of the 0.04 K to the usual one."""
    patch = at(radius, 0.0, 0.002, normal=(1, 0, 0))
    error = worst(of(tube(radius, wall), material), patch, gridding=MeshGridding(relief=24))
    assert error < PLACED_SHARE * DIFFERENCE


INSIDE = -1.0, 0.0, 0.0
PAIRS = {
    "pinched at the rim": (
        at(0.02, 0.0, 0.0172, normal=(1, 0, 0)),
        at(0.017, 0.0, 0.0165, normal=INSIDE),
    ),
    "pinched below it": (at(0.02, 0.0, 0.004, normal=(1, 0, 0)), at(0.017, 0.0, 0.003, normal=INSIDE)),
    "side by side": (
        at(0.02, 0.0, 0.0172, normal=(1, 0, 0)),
        at(0.0169, 0.0107, 0.0165, normal=(0.0169, 0.0107, 0)),
    ),
    "beside and on the rim": (
        at(0.02, 0.0, 0.0145, normal=(1, 0, 0)),
        at(0.0185, 0.0, 0.02, normal=(0, 0, 1)),
    ),
    "at the foot's edge": (
        at(0.02, 0.0, -0.0172, normal=(1, 0, 0)),
        at(0.0142, 0.0, -0.02, normal=(0, 0, -1)),
    ),
    "slid along the rim": (
        at(0.02, 0.0, 0.0172, normal=(1, 0, 0)),
        at(0.01975, 0.00314, 0.0167, normal=(0.01975, 0.00314, 0)),
    ),
    "slid on over the rim": (
        at(0.02, 0.0, 0.0192, normal=(1, 0, 0)),
        at(0.01892, 0.00649, 0.0188, normal=(0.01892, 0.00649, 0)),
    ),
    "slid down from the rim": (
        at(0.02, 0.0, 0.0175, normal=(1, 0, 0)),
        at(0.01999, 0.00063, 0.0128, normal=(0.01999, 0.00063, 0)),
    ),
    "slid along the foot": (
        at(0.02, 0.0, -0.0172, normal=(1, 0, 0)),
        at(0.01963, 0.00382, -0.0165, normal=(0.01963, 0.00382, 0)),
    ),
}
"""Fingertips near each other on a cup, or overlapping, as where one has slid on."""


@pytest.mark.slow
@pytest.mark.parametrize("material", ["wood", "ceramic", "aluminium"])
@pytest.mark.parametrize("places", PAIRS)
def test_fingertips_near_each_other_at_a_rim_or_a_foot(places: str, material: str) -> None:
    assert worst(of(cup(), material), *PAIRS[places]) < PLACED_SHARE * DIFFERENCE


@pytest.mark.slow
@pytest.mark.parametrize("turn", [0.0, 0.17, 1.1])  # rad: along it, slid round it, beside on it
def test_fingertips_near_each_other_on_a_handle(turn: float) -> None:
    x, y = float(np.cos(turn)), float(np.sin(turn))
    one = at(0.0097, 0.0, 0.002, normal=(1, 0, 0))
    other = at(0.0097 * x, 0.0097 * y, 0.007 if turn == 0 else 0.003, normal=(x, y, 0))
    assert worst(of(rod(0.0097), "ceramic"), one, other) < PLACED_SHARE * DIFFERENCE


@pytest.mark.slow
@pytest.mark.parametrize("material", ["aluminium", "wood"])
def test_fingertips_on_both_sides_of_a_ring_at_its_hole(material: str) -> None:
    """Neither lies among the cells beneath the other."""
    ring = trimesh.creation.annulus(0.015, 0.03, 0.01, segments=64)
    above, below = (at(0.0165, 0.001 * way, 0.005 * way, normal=(0, 0, way)) for way in (1, -1))
    assert worst(of(ring, material), above, below) < PLACED_SHARE * DIFFERENCE


@pytest.mark.slow
def test_places_that_overlap_at_their_corners_on_a_narrow_face() -> None:
    bar = trimesh.creation.box((0.06, 0.01, 0.012))
    one, other = at(-0.0007, 0.005, -0.0054, normal=(0, 1, 0)), at(0.0028, 0.005, 0.0034, normal=(0, 1, 0))
    assert worst(of(bar, "ceramic"), one, other) < PLACED_SHARE * DIFFERENCE


@pytest.fixture
def no_grid(monkeypatch: pytest.MonkeyPatch) -> None:
    """Networks that need a grid of their own beneath a place raise AssertionError."""

    def refused(*_: object) -> None:
        raise AssertionError

    monkeypatch.setattr(place_module, "patch_fields", refused)


@pytest.mark.usefixtures("no_grid")
@pytest.mark.parametrize(
    "places",
    [pytest.param(each, marks=() if each == "pinched at the rim" else pytest.mark.slow) for each in PAIRS],
)
def test_places_near_each_other_need_no_grid(places: str) -> None:
    network = placed_network(of(cup(), "limestone"), PAIRS[places], STACK).network
    impedance = network.impedance(np.array([0.1, 10.0]))
    np.testing.assert_allclose(impedance, impedance.transpose(0, 2, 1), rtol=1e-9)
    assert (np.linalg.eigvalsh(impedance) > 0).all()


@pytest.mark.usefixtures("no_grid")
@pytest.mark.parametrize("place", ["rim", "beyond the rim", "foot's edge", "edge", "handle"])
def test_edges_and_handles_need_no_grid(place: str) -> None:
    mesh, patch, _ = PLACES[place]
    placed_network(of(mesh(), "limestone"), [patch], STACK)


@pytest.mark.slow
@pytest.mark.usefixtures("no_grid")
def test_only_what_is_strongly_curved_or_conducts_far_needs_a_grid() -> None:
    layered = at(0.003, 0.002, 0.013, normal=(0, 0, 1))
    placed_network(slab("neoprene", "stainless_steel"), [layered], STACK)
    mesh, patch, _ = PLACES["rod"]
    for body, where in ((of(mesh(), "limestone"), patch), (slab("neoprene", "aluminium"), layered)):
        with pytest.raises(AssertionError):
            placed_network(body, [where], STACK)


def test_on_a_ball_heat_begins_as_on_a_plane_of_the_touched_surface() -> None:
    """In wood after 0.06 s it has gone 0.1 mm of a radius of 20 mm. A square of half side b has 1 + (b/r)^2 / 3 of the
    area that it has seen along its normal; the grid, whose cells are stairs there, is 7 % off."""
    round_, flat = (
        drops(placed_network(of(mesh, "wood"), [at(x, 0.0, 0.0, normal=(1, 0, 0))], STACK).network, 1e5)[0]
        for mesh, x in ((trimesh.creation.icosphere(5, 0.02), 0.02), (trimesh.creation.box(CUBE), 0.015))
    )
    assert round_ / flat == pytest.approx(1 + (0.0045 / 0.02) ** 2 / 3, abs=0.01)


@pytest.mark.parametrize(
    ("first", "second"),
    [
        pytest.param(
            at(0.015, 0.0, 0.0, normal=(1, 0, 0)),
            at(-0.015, 0.002, 0.0, normal=(-1, 0, 0)),
            marks=pytest.mark.slow,
            id="opposite",
        ),
        pytest.param(
            at(0.015, 0.0, 0.0, normal=(1, 0, 0)),
            at(0.015, 0.006, 0.002, normal=(1, 0, 0)),
            marks=pytest.mark.slow,
            id="overlapping",
        ),
        pytest.param(
            at(0.015, 0.009, 0.0, normal=(1, 0, 0)),
            at(0.009, 0.015, 0.0, normal=(0, 1, 0)),
            id="across an edge",
        ),
    ],
)
def test_two_fingertips_share_a_body(first: SurfacePatch, second: SurfacePatch) -> None:
    body = of(trimesh.creation.box(CUBE), "ceramic")
    mirrored = first.centre == (*second.centre[1::-1], second.centre[2])
    assert worst(body, first, second, mirrored=mirrored) < PLACED_SHARE * DIFFERENCE


@pytest.mark.slow
@pytest.mark.parametrize("material", ["ceramic", "aluminium"])
def test_a_rim_and_the_wall_beside_it_feel_each_other(material: str) -> None:
    """Where no box stands for the body, a place's own grid tells how it is felt beside it."""
    rim, wall = at(0.02, 0.0, 0.0175, normal=(1, 0, 0)), at(0.02, 0.0, 0.0105, normal=(1, 0, 0))
    assert worst(of(cup(), material), rim, wall) < PLACED_SHARE * DIFFERENCE


@pytest.mark.slow
def test_round_a_thin_wall_a_face_is_unrolled() -> None:
    wall = trimesh.creation.revolve(
        [(0, -0.03), (0.03, -0.03), (0.03, 0.03), (0.0294, 0.03), (0.0294, -0.0294), (0, -0.0294)],
        sections=128,
    )
    first, second = (
        at(0.03, 0.0, 0.0, normal=(1, 0, 0)),
        at(0.0276, 0.0117, 0.002, normal=(0.0276, 0.0117, 0.0)),
    )
    assert worst(of(wall, "stainless_steel"), first, second) < PLACED_SHARE * DIFFERENCE


@pytest.mark.slow
@pytest.mark.parametrize("pair", [("glass", "aluminium"), ("aluminium", "wood")])
def test_two_materials_have_modes_of_their_own(pair: tuple[str, str]) -> None:
    top, body = at(0.0, 0.0, 0.013, normal=(0, 0, 1)), slab(*pair)
    assert worst(body, top, at(0.006, 0.003, 0.013, normal=(0, 0, 1))) < PLACED_SHARE * DIFFERENCE
    assert worst(body, at(0.0, 0.0, -0.01, normal=(0, 0, -1)), top) < PLACED_SHARE * DIFFERENCE


def test_the_mean_holds_all_heat_and_nothing_grows() -> None:
    body = of(cup(), "ceramic")
    network = placed_network(body, [at(0.02, 0.0, 0.0, normal=(1, 0, 0))], STACK).network
    assert network.rates[0] == 0.0 and np.all(network.rates[1:] > 0)
    capacity = thermal.material("ceramic").volumetric_heat_capacity * body.parts[0].volume
    assert network.ports[0, 0] == pytest.approx(capacity**-0.5, rel=1e-3)
    assert network.outputs["heat"] @ network.ports[:, 0] == pytest.approx(1.0)
    assert network.outputs["heat"] @ network.ports[:, 1:] == pytest.approx(0.0, abs=1e-9)


def test_a_field_goes_from_network_to_network_and_back() -> None:
    """A place more changes nothing of what the slow modes hold, and nothing of how a known place answers."""
    body = of(cup(), "ceramic")
    one, two = at(0.02, 0.0, 0.0, normal=(1, 0, 0)), at(0.0, 0.02, 0.0, normal=(0, 1, 0))
    alone, both = (placed_body(body, patches, STACK, DIFFERENCE) for patches in ((one,), (one, two)))
    carried, back = field_carried(alone, both), field_carried(both, alone)
    shared = alone.shared
    assert shared == both.shared > 1
    np.testing.assert_allclose((back @ carried)[:shared, :shared], np.eye(shared), rtol=1e-6, atol=1e-12)
    late = np.array([0.05, 0.2, 1.0, 5.0])
    heated = alone.object.ports[:, 0]
    for seconds in late:
        field = np.exp(-alone.object.rates * seconds) * heated
        before = alone.object.ports[:, 0] @ field
        assert both.object.ports[:, 0] @ (carried @ field) == pytest.approx(before, rel=0.01)


def test_the_same_places_give_the_same_bits() -> None:
    patches = at(0.02, 0.0, 0.0, normal=(1, 0, 0)), at(0.02, 0.0, 0.0175, normal=(1, 0, 0))
    first, again = (placed_network(of(cup(), "ceramic"), patches, STACK).network for _ in range(2))
    assert np.array_equal(first.ports, again.ports) and np.array_equal(first.rates, again.rates)


def test_triangles_without_area_warn_of_nothing() -> None:
    """As where many geoms are fused."""
    cut = trimesh.creation.box(CUBE).subdivide()
    a, b, c = cut.faces[np.argmax(cut.triangles_center[:, 2])].tolist()
    halved = len(cut.vertices)
    corners = np.concatenate((cut.vertices, [(cut.vertices[a] + cut.vertices[b]) / 2]))
    faces = [face for face in cut.faces.tolist() if face != [a, b, c]]
    faces += [[a, halved, c], [halved, b, c], [a, b, halved]]
    body = Solid((SolidPart(corners, np.array(faces), thermal.material("glass")),))
    with np.errstate(invalid="raise"):
        assert beneath(body.outside, at(0.0, 0.0, CUBE[2] / 2, normal=(0, 0, 1))).plain


def test_what_is_no_solid_or_meets_no_surface_is_refused() -> None:
    one, other = (part(trimesh.creation.box((0.01, 0.01, 0.01)), "glass") for _ in range(2))
    vertices = np.concatenate([one.vertices, other.vertices + [0.05, 0.0, 0.0]])
    pieces = SolidPart(vertices, np.concatenate([one.faces, other.faces + len(one.vertices)]), one.material)
    with pytest.raises(MeshError, match="piece"):
        placed_network(Solid((pieces,)), [at(0.005, 0.0, 0.0, normal=(1, 0, 0))], STACK)
    with pytest.raises(MeshError, match="surface"):
        placed_network(of(cup()), [at(0.1, 0.0, 0.2, normal=(1, 0, 0))], STACK)
