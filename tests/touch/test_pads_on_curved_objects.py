"""The pad around a sensor (surround) on round objects and meshes: what its rings touch, the drop beside elements,
heat balance, and what of it is alike for a mesh and the shape that it stands for."""

# mujoco ships no type stubs for its compiled names
# pyright: reportAttributeAccessIssue=false

import copy
import math
from functools import lru_cache
from itertools import pairwise, product

import mujoco
import numpy as np
import pytest
import trimesh

from thermograsp.thermal import SKINS, Pad, Surround, material
from thermograsp.thermal.contact import FORCES, curved_contact
from thermograsp.thermal.padded import RINGS, ring_shares, ring_sides
from thermograsp.thermal.pressed import PressedMesh, Ring, RoundRing
from thermograsp.thermal.pressed.mesh_table import pressed_view
from thermograsp.touch import Fingertip, ThermalTouch, prepare
from thermograsp.touch.contacts import (
    AREA,
    BESIDE,
    CLOSED,
    COLUMNS,
    CONDUCTANCE,
    CURVED,
    LENGTH,
    NORMAL,
    PLACE,
)
from thermograsp.touch.heat import JoinedHeat
from thermograsp.touch.heat.narrow import STEPS
from thermograsp.touch.scene import bodies, pads

FACE, DT = 0.009, 0.01
TIMES = (0.5, 1.0, 2.0, 5.0, 10.0)  # s
BLOCK = (0.04, 0.04, 0.01)

SIDES = (FACE, *ring_sides(FACE, Surround()))
PARTS = tuple(Ring(material("silicone"), *each) for each in pairwise(SIDES))
WHOLE = Ring(material("silicone"), FACE, Pad().width)
SHAPES = {
    "ball": (trimesh.creation.icosphere(5, radius=0.02), 0.02, None),
    "rod": (trimesh.creation.cylinder(0.02, 0.06, sections=256), 0.02, 0.06),
}


def pressed(mesh: trimesh.Trimesh, ring: Ring | None, skin: str | None = "filled_silicone") -> PressedMesh:
    vertices = np.ascontiguousarray(mesh.vertices, float).tobytes()
    faces = np.ascontiguousarray(mesh.faces, np.int64).tobytes()
    axes = np.array([[-1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]]).tobytes()
    worn = None if skin is None else SKINS[skin]
    return PressedMesh(Pad(), worn, material("glass"), vertices, faces, axes, ring)


@lru_cache
def table(pressed: PressedMesh | RoundRing) -> np.ndarray:
    return pressed.table()


@pytest.mark.parametrize("shape", SHAPES)
def test_face_and_rings_bear_the_force(shape: str) -> None:
    one = pressed(SHAPES[shape][0], None)
    view = pressed_view(Pad(), one.vertices, one.faces, one.axes)
    every = [view.touched(ring)[:, 1:-1, 1:-1] for ring in (None, *PARTS)]
    share = np.sum([part[..., 1] for part in every], axis=0)
    np.testing.assert_allclose(share[-2:], 1.0, atol=0.03)
    whole = view.touched(WHOLE)[:, 1:-1, 1:-1]
    np.testing.assert_allclose(sum(part[-1] for part in every[1:]), whole[-1], rtol=2e-3, atol=1e-9)


@pytest.mark.parametrize("shape", SHAPES)
@pytest.mark.parametrize("force", [1.0, 10.0, 30.0])
@pytest.mark.parametrize("aside", [0.0, 0.003])
def test_a_ring_touches_of_a_mesh_what_it_does_of_the_round_body(
    shape: str, force: float, aside: float
) -> None:
    mesh, radius, length = SHAPES[shape]
    middle = (mesh.bounds[1] - mesh.bounds[0])[1:] / 2 + FACE / 2
    for ring in PARTS:
        rounded = RoundRing(Pad(), SKINS["filled_silicone"], material("glass"), radius, length, ring)
        of_round, of_mesh = table(rounded), table(pressed(mesh, ring))
        conducts, area, _ = curved_contact(of_round, force, aside, 0.0)
        meshed, touched, _ = curved_contact(of_mesh, force, middle[0] + aside, middle[1])
        assert meshed == pytest.approx(conducts, rel=0.1, abs=0.025)
        assert touched == pytest.approx(area, rel=0.1, abs=1.2e-6)


def test_the_more_force_the_more_of_a_ring_touches() -> None:
    forces = np.geomspace(0.1, 40.0, 30)
    for length in (None, 0.06):
        for ring in PARTS:
            numbers = RoundRing(Pad(), None, material("steel"), 0.01, length, ring).table()
            for aside in (0.0, 0.004, 0.008):
                found = [curved_contact(numbers, force, aside, 0.0)[0] for force in forces.tolist()]
                assert (np.diff(found) >= -0.02 * np.array(found[1:])).all()


def test_shares_under_a_ring_are_means_over_a_half_space() -> None:
    """By lot: pairs of places on the strip's part of the face and of the first ring."""
    rng, n = np.random.default_rng(5), 200_000
    width, outer = SIDES[0], SIDES[1]

    def places(broad: float, inner: float, outer: float) -> np.ndarray:
        along = rng.uniform(inner / 2, outer / 2, n) * rng.choice([-1, 1], n)
        return np.array([rng.uniform(-broad / 2, broad / 2, n), along])

    def mean(one: np.ndarray, other: np.ndarray) -> float:
        return float((1 / np.hypot(*(one - other))).mean())

    def square_ring() -> np.ndarray:
        found = rng.uniform(-outer / 2, outer / 2, (2, 8 * n))
        return found[:, np.abs(found).max(axis=0) > width / 2][:, :n]

    broad = width / 2
    face, strip = [places(side, 0.0, width) for side in (width, broad)]
    more = mean(strip, places(broad, 0.0, width)) - mean(face, places(width, 0.0, width))
    own = mean(places(broad, width, outer), places(broad, width, outer)) - mean(square_ring(), square_ring())
    across = mean(strip, places(broad, width, outer)) - mean(face, square_ring())
    np.testing.assert_allclose(
        ring_shares(FACE, SIDES[1:], STEPS)[0, 2], (own / more, across / more), rtol=0.05
    )


def drops(name: str, touches: np.ndarray, surround: str | None = "silicone") -> np.ndarray:
    """K at TIMES, of a skinned fingertip on a block."""
    heat, found = heat_of(name, "filled_silicone", surround), []
    for _ in range(round(TIMES[-1] / DT)):
        heat.advance(touches, 1)
        found.append(heat.drop[0, 0])
    return np.array(found)[np.round(np.array(TIMES) / DT).astype(int) - 1]


def heat_of(name: str, skin: str | None, surround: str | None) -> JoinedHeat:
    x, y, z = (side / 2 for side in BLOCK)
    geom = f'<geom type="box" size="{x} {y} {z}" mass="1"/>'
    model = mujoco.MjModel.from_xml_string(scene(geom, z))
    shapes = bodies(model, {"thing": name}, 24.0)
    found = pads(model, {"tip": Fingertip("flat", skin=skin, surround=surround)}, shapes)
    return JoinedHeat(found, (), shapes, worlds=1, dt=DT, tolerance=0.05, film=0.0, ambient=24.0)


def spot(sides: tuple[float, float], conducts: float = 2e4) -> np.ndarray:
    """What a reader tells of a curved object that touches a rectangle of these sides m in the pad's middle."""
    touches = np.zeros((1, 1, 2, COLUMNS))
    row, within = touches[0, 0, 0], 0.0
    row[PLACE : PLACE + 3], row[NORMAL + 2] = (0.0, 0.0, -BLOCK[2] / 2), 1.0
    for ring, side in enumerate(SIDES, -1):
        first, second = (min(side, each) for each in sides)
        area, within = first * second - within, first * second
        if ring < 0:
            row[CONDUCTANCE], row[AREA], row[LENGTH], row[CLOSED] = conducts * area, area, area * second, 1
        elif area > 1e-12:
            row[BESIDE + 3 * ring : BESIDE + 3 * ring + 3], row[CURVED] = (conducts * area, area, 1.0), 1.0
    return touches


ELEMENTS = (
    ("aluminium", (0.004, 0.02), (3.065, 4.607, 6.124, 7.227, 7.388)),
    ("glass", (0.004, 0.02), (1.165, 1.608, 2.04, 2.356, 2.311)),
    ("wood", (0.004, 0.02), (0.412, 0.548, 0.676, 0.747, 0.689)),
    ("aluminium", (0.002, 0.02), (1.715, 2.761, 4.006, 5.291, 5.636)),
    ("glass", (0.002, 0.02), (0.646, 0.935, 1.257, 1.581, 1.637)),
    ("wood", (0.002, 0.02), (0.221, 0.304, 0.388, 0.456, 0.447)),
    ("aluminium", (0.004, 0.004), (1.498, 2.406, 3.505, 4.69, 5.04)),
    ("glass", (0.004, 0.004), (0.555, 0.787, 1.031, 1.248, 1.26)),
)
"""Drops K of a difference of 12 K at TIMES by studies/surround/pad_square.py: drops(Touch(material, "filled_silicone",
conductances=(2e4, 2e4), spot=sides))."""


@pytest.mark.parametrize(("name", "sides", "elements"), ELEMENTS)
def test_drops_are_those_of_three_dimensional_finite_elements(
    name: str, sides: tuple[float, float], elements: tuple[float, ...]
) -> None:
    found = drops(name, spot(sides))
    np.testing.assert_allclose(found, elements, atol=0.16)
    alone = drops(name, spot(sides), surround=None)
    assert np.abs(found - elements).max() < max(np.abs(alone - elements).max(), 0.16)


def test_whatever_curved_contacts_do_nothing_grows_and_no_heat_is_lost() -> None:
    """Strips of any breadth and conductance, at every sample another, also such as no reader tells."""
    rng, heat = np.random.default_rng(11), heat_of("glass", None, "silicone")
    for _ in range(2000):
        touches = spot((10.0 ** rng.uniform(-4, -2), 0.02))
        row = touches[0, 0, 0]
        for column in (CONDUCTANCE, *range(BESIDE, CURVED, 3)):
            row[column] *= 10.0 ** rng.uniform(-6, 3) * (rng.random() < 0.8)
        heat.advance(touches, 1)
        assert 0 <= heat.drop[0, 0] <= 12
    balance = heat.balance(0)
    assert balance.objects.sum() == pytest.approx(balance.given.sum(), rel=1e-10)
    assert np.isfinite(heat.state().narrow).all()


def scene(geom: str, high: float, assets: str = "") -> str:
    """Something that rises along z, over a pad."""
    return f"""
<mujoco><option timestep=".002" gravity="0 0 0"/><asset>{assets}</asset><worldbody>
  <body name="thing" pos="0 0 {high}">
    <joint name="up" type="slide" axis="0 0 1" damping="50"/>{geom}
  </body>
  <body name="tip" pos="0 0 -.0101"><geom name="flat" type="box" size=".01 .01 .01" mass="1"/></body>
</worldbody></mujoco>"""


def mesh(made: trimesh.Trimesh) -> str:
    vertices = " ".join(f"{value:.9g}" for value in made.vertices.ravel())
    faces = " ".join(map(str, made.faces.ravel()))
    return f'<mesh name="made" vertex="{vertices}" face="{faces}"/>'


GEOMS = {
    "box": ('<geom type="box" size=".02 .02 .02" mass="1"/>', ""),
    "cube": ('<geom type="mesh" mesh="made" mass="1"/>', mesh(trimesh.creation.box((0.04, 0.04, 0.04)))),
    "ball": ('<geom type="sphere" size=".02" mass="1"/>', ""),
    "ball mesh": (
        '<geom type="mesh" mesh="made" mass="1"/>',
        mesh(trimesh.creation.icosphere(4, radius=0.02)),
    ),
    "rod": ('<geom type="cylinder" size=".02 .04" euler="0 90 0" mass="1"/>', ""),
    "standing": ('<geom type="cylinder" size=".02 .02" mass="1"/>', ""),
}


def touched(
    shape: str, name: str, skin: str | None, surround: str | None = "silicone", seconds: float = 2.0
) -> tuple[ThermalTouch, mujoco.MjData]:
    """Under 10 N."""
    geom, assets = GEOMS[shape]
    model = mujoco.MjModel.from_xml_string(scene(geom, 0.02, assets))
    touch = ThermalTouch(
        model,
        fingertips={"tip": Fingertip("flat", skin=skin, surround=surround)},
        objects={"thing": name},
        air=0.0,
        chain="ideal",
        dt=DT,
    )
    data = mujoco.MjData(model)
    data.qfrc_applied[0] = -10.0
    for _ in range(round(seconds / 0.002)):
        mujoco.mj_step(model, data)
        touch.update(data)
    return touch, data


@lru_cache
def drop(shape: str, name: str, skin: str | None, surround: str | None = "silicone") -> float:
    return float(touched(shape, name, skin, surround)[0].reading.temperature_drop[0])


@pytest.mark.parametrize("skin", [None, "filled_silicone"])
def test_a_cube_s_mesh_is_felt_as_the_box(skin: str | None) -> None:
    for surround in (None, "silicone"):
        assert drop("cube", "glass", skin, surround) == pytest.approx(
            drop("box", "glass", skin, surround), abs=0.005
        )


@pytest.mark.slow
def test_a_ball_s_mesh_is_felt_as_the_ball_under_a_skin() -> None:
    for name in ("aluminium", "glass"):
        assert drop("ball mesh", name, "filled_silicone") == pytest.approx(
            drop("ball", name, "filled_silicone"), abs=0.06
        )


@pytest.mark.parametrize("skin", [None, "filled_silicone"])
@pytest.mark.parametrize("name", ["aluminium", "glass", "wood"])
def test_a_ball_is_felt_less_than_a_rod_and_a_rod_less_than_a_flat_face(name: str, skin: str | None) -> None:
    ball, rod, standing = (drop(shape, name, skin) for shape in ("ball", "rod", "standing"))
    assert ball < rod < standing


@pytest.mark.parametrize(
    ("shape", "skin"),
    [
        *product(("ball", "rod"), (None, "filled_silicone")),
        ("ball mesh", None),
        pytest.param("ball mesh", "filled_silicone", marks=pytest.mark.slow),
    ],
)
def test_no_heat_is_lost_and_a_pad_cools_its_sensor_s_sides(shape: str, skin: str | None) -> None:
    touch, _ = touched(shape, "aluminium", skin)
    alone, _ = touched(shape, "aluminium", skin, surround=None)
    balance = touch.balance
    given = balance.given.sum()  # pyright: ignore
    assert balance.objects.sum() == pytest.approx(given, rel=1e-10)  # pyright: ignore
    assert given > alone.balance.given.sum()  # pyright: ignore
    assert touch.reading.temperature_drop[0] < alone.reading.temperature_drop[0] - 0.05


def test_it_goes_on_from_a_state_and_as_a_copy_with_the_same_bits() -> None:
    touch, data = touched("rod", "glass", "filled_silicone", seconds=0.5)
    kept, twin, places = touch.state(), copy.deepcopy(touch), copy.deepcopy(data)
    found = []
    for each, at in ((touch, data), (twin, places)):
        for _ in range(100):
            mujoco.mj_step(at.model, at)
            each.update(at)
        found.append(each.reading.temperature_drop[0])
    touch.set_state(kept)
    assert found[0] == found[1] and math.isfinite(found[0])


def test_recorded_sensors_tell_of_rings_what_the_simulation_does() -> None:
    if not hasattr(mujoco.mjtSensor, "mjSENS_CONTACT"):
        pytest.skip("this MuJoCo has no contact sensors")
    fingertips = {"tip": Fingertip("flat", skin="filled_silicone", surround="silicone")}
    for shape in ("rod", "ball mesh"):
        model = prepare(
            mujoco.MjSpec.from_string(scene(GEOMS[shape][0], 0.02, GEOMS[shape][1])),
            fingertips,
            {"thing": "glass"},
        )
        words = {"fingertips": fingertips, "objects": {"thing": "glass"}, "chain": "ideal"}
        alone, many = ThermalTouch(model, **words), ThermalTouch(model, worlds=2, **words)
        data = mujoco.MjData(model)
        data.qfrc_applied[0] = -10.0
        for _ in range(300):
            mujoco.mj_step(model, data)
            alone.update(data)
            many.update(np.tile(data.sensordata, (2, 1)))
        found = many.reading.temperature_drop
        assert found[0] == found[1] > 0.1
        np.testing.assert_allclose(found[0], alone.reading.temperature_drop, rtol=1e-3)


def test_tables_have_every_force() -> None:
    one = pressed(SHAPES["rod"][0], None)
    view = pressed_view(Pad(), one.vertices, one.faces, one.axes)
    assert view.touched(ring=PARTS[0]).shape[0] == FORCES and len(PARTS) == RINGS
