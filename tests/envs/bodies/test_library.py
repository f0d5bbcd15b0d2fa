"""The library's objects are closed solids of the right volume and weight that fit the gripper and stay in it."""

import math
from dataclasses import replace

import numpy as np
import pytest
import trimesh

from thermograsp.envs import (
    GraspEnv,
    GraspVectorEnv,
    ObjectSpec,
    SimulationConfig,
)
from thermograsp.envs.bodies.library import (
    ObjectPreset,
    library_object,
    load_objects,
    objects,
)
from thermograsp.envs.bodies.recipes import RECIPES, make
from thermograsp.envs.limits import MAX_OPENING
from thermograsp.envs.mechanics.batch import Mechanics
from thermograsp.errors import InvalidValueError, UnknownNameError
from thermograsp.files import cache_dir
from thermograsp.thermal import material, sensor
from thermograsp.thermal.pressed import height_map, map_heights

NAMES = tuple(objects())
MESHES = tuple(name for name in NAMES if objects()[name].solid.surface is not None)
HEAVIEST = 3.0  # kg, of a brick


def surface(name: str) -> trimesh.Trimesh:
    made = objects()[name].solid.surface
    assert made is not None
    return trimesh.Trimesh(*made, process=False)


def test_there_are_enough_of_every_kind() -> None:
    assert len(NAMES) >= 30
    assert {preset.recipe for preset in objects().values()} == set(RECIPES)
    assert min(preset.temperature for preset in objects().values()) < 0
    assert max(preset.temperature for preset in objects().values()) > 50


@pytest.mark.parametrize("name", MESHES)
def test_a_mesh_is_closed_and_looks_outwards(name: str) -> None:
    mesh = surface(name)
    assert mesh.is_watertight and mesh.is_winding_consistent
    assert mesh.volume > 0
    assert (mesh.area_faces > 0).all()
    assert len(mesh.faces) < 30_000


@pytest.mark.parametrize("name", NAMES)
def test_an_object_fits_the_gripper_and_weighs_what_its_parts_do(name: str) -> None:
    preset = objects()[name]
    spec = preset.spec()
    assert 0.002 < spec.width < MAX_OPENING
    turned = math.radians(SimulationConfig().placement[1])
    assert replace(spec, yaw=turned).width < MAX_OPENING  # wherever an environment lays it
    assert 0.001 < spec.weight < HEAVIEST
    if preset.mass is None and preset.contents is None and not preset.parts:
        assert spec.weight == pytest.approx(material(preset.material).density * spec.volume)


def test_the_file_holds_what_was_made_and_is_made_once() -> None:
    spec = objects()["egg"].spec()
    assert spec.mesh is not None and spec.mesh.startswith(str(cache_dir()))
    assert objects()["egg"].spec() == spec
    assert spec.volume == pytest.approx(surface("egg").volume, rel=1e-6)
    assert objects()["mug"].spec().mesh == objects()["mug_of_coffee"].spec().mesh


def test_volumes_of_what_is_turned_are_the_closed_forms() -> None:
    def volume(recipe: str, **parameters: object) -> float:
        made = make(recipe, parameters).surface
        assert made is not None
        return made.volume

    r, h, wall, base = 0.03, 0.09, 0.002, 0.004
    whole, hollow = math.pi * r**2 * h, math.pi * (r - wall) ** 2 * (h - base)
    straight = [[r, 0.0], [r, h]]
    assert volume("turned", profile=straight) == pytest.approx(whole, rel=1e-12)
    assert volume("vessel", profile=straight, wall=wall, base=base) == pytest.approx(
        whole - hollow, rel=1e-12
    )
    inside = math.pi * (r - wall) ** 2 * (h - 2 * wall)
    assert volume("shell", profile=straight, wall=wall) == pytest.approx(whole - inside, rel=1e-12)
    ring = math.pi / 4 * (0.05**2 - 0.04**2) * 0.1
    assert volume("tube", outer=0.05, inner=0.04, length=0.1) == pytest.approx(ring, rel=1e-12)
    nut = (math.sqrt(3) / 2 * 0.05**2 - math.pi / 4 * 0.03**2) * 0.02
    assert volume("tube", outer=0.05, inner=0.03, length=0.02, sides=6) == pytest.approx(nut, rel=1e-12)
    size = (0.05, 0.06, 0.07)
    assert volume("ellipsoid", size=size) == pytest.approx(math.pi / 6 * np.prod(size), rel=1e-12)
    ball = math.pi / 6 * (0.04**3 - 0.039**3)
    assert volume("hollow_ball", diameter=0.04, wall=0.0005) == pytest.approx(ball, rel=1e-9)
    a, b, k = 0.03, 0.022, 0.12
    egg = math.pi * a * b**2 * (4 / 3 + 4 / 15 * k**2)  # integral of (1 - u^2)(1 - k u)^2
    assert volume("egg", length=2 * a, width=2 * b, taper=k) == pytest.approx(egg, rel=3e-3)
    bar = [[-0.05, 0.02, 0.03, 0.0], [0.05, 0.02, 0.03, 0.0]]
    assert volume("lofted", sections=bar) == pytest.approx(math.pi / 4 * 6e-4 * 0.1, rel=1e-12)
    plate = [[-0.05, -0.01, 0.01], [0.0, -0.02, 0.02], [0.05, -0.01, 0.01]]
    assert volume("cut", outline=plate, thickness=0.004) == pytest.approx(0.004 * 0.003, rel=1e-12)


def test_a_wall_is_as_thick_as_asked_on_a_slope() -> None:
    """A cone's wall, measured across it."""
    low, high, tall, wall = 0.02, 0.03, 0.08, 0.002
    hollow = make("vessel", {"profile": [[low, 0.0], [high, tall]], "wall": wall}).hollow
    assert hollow is not None
    slope = (high - low) / tall
    outside = low + slope * hollow[1:, 1]
    assert (outside - hollow[1:, 0]) / math.hypot(1, slope) == pytest.approx(wall, rel=1e-9)


def test_contents_weigh_what_the_hollow_holds() -> None:
    r, h, wall, level = 0.03, 0.09, 0.002, 0.5
    solid = make("vessel", {"profile": [[r, 0.0], [r, h]], "wall": wall})
    assert solid.room(level) == pytest.approx(math.pi * (r - wall) ** 2 * (h - wall) * level, rel=1e-12)
    can = objects()["drinks_can"]
    assert objects()["empty_can"].spec().weight < 0.015  # a real one: 13 g
    assert 0.3 < can.spec().weight < 0.4  # 330 ml
    filled = math.pi * ((r - wall) ** 2 + 2 * (r - wall) * (h - wall) * level)
    assert solid.wetted(level) == pytest.approx(filled, rel=1e-12)
    inside = can.spec().reservoir
    assert inside is not None and 1300 < inside.heat_capacity < 1500  # 330 ml of water: 1380 J/K
    with pytest.raises(InvalidValueError, match="not hollow"):
        make("box", {"size": [0.1, 0.1, 0.1]}).room(0.5)


def test_a_handle_has_one_hole_and_does_not_change_the_cup() -> None:
    mug = objects()["mug"]
    plain = make("vessel", {key: value for key, value in mug.parameters.items() if key != "handle"})
    assert surface("mug").euler_number == 0  # a torus
    assert plain.surface is not None
    grip = mug.parameters["handle"]
    bow = math.pi * (grip["reach"] + (grip["high"] - grip["low"]) / 2) / 2 * grip["thickness"] * 0.0105
    assert surface("mug").volume - plain.surface.volume == pytest.approx(bow, rel=0.3)
    # the fingers close on the cup, not on the middle of cup and handle
    assert mug.spec().position[1] == pytest.approx((surface("mug").bounds[:, 1].sum()) / 2, abs=1e-6)


@pytest.mark.parametrize("name", MESHES)
def test_what_collides_is_the_surface_where_the_pads_meet_it(name: str) -> None:
    """The convex hull sticks out nowhere beyond the mesh under either pad."""
    spec = objects()[name].spec()
    (hull,) = spec.geometry.hulls
    middle = np.array([*spec.position, spec.size[2] / 2 - spec.grasp_height])  # the object's from the grasp's
    for side in (-1.0, 1.0):
        pad = np.array([[0.1 * side, 0.0, 0.0], [-side, 0.0, 0.0], [0.0, side, 0.0], [0.0, 0.0, 1.0]])
        pad[0] -= middle
        nearest = []
        for vertices, faces in (spec.geometry.surface, hull):
            axes = np.stack([pad[1], *pad[2:]])
            seen = height_map(vertices, faces, axes)  # of flat triangles, which are what collides
            y, z = np.meshgrid(*2 * [np.linspace(-0.0095, 0.0095, 39)])
            places = np.stack([y.ravel(), z.ravel()], axis=1)
            height, cover = np.zeros(len(places)), np.zeros(len(places))
            map_heights(*seen, pad, places, height, cover)
            nearest.append(height[cover > 0].min())
        assert nearest[0] == pytest.approx(nearest[1], abs=1e-4)


@pytest.mark.parametrize("seconds", [3.0, pytest.param(10.0, marks=pytest.mark.slow)])
@pytest.mark.parametrize("name", NAMES)
def test_a_held_object_stays_held(name: str, seconds: float) -> None:
    """At its grip force: less than .5 mm in 10 s of holding, at any time of it."""
    spec, force = objects()[name].spec(), objects()[name].grip_force
    assert force <= 40
    mechanics = Mechanics((spec,))

    def run(seconds: float, rate: float = 0.0) -> np.ndarray:
        for _ in range(round(seconds / 0.02)):
            mechanics.advance(np.zeros(1), np.full(1, force), np.full(1, rate))
        assert not any(mechanics.failure)
        return mechanics.object_pose[0, 0, :3]

    run(1.4)
    run(0.5, 0.05)
    before = run(0.4)
    assert before[2] - spec.size[2] / 2 == pytest.approx(0.025, abs=2e-3)
    assert np.linalg.norm(run(seconds) - before) < 5e-5 * seconds


def test_names_and_tables_are_checked(tmp_path) -> None:
    with pytest.raises(UnknownNameError, match="did you mean 'mug'"):
        library_object("mugg")
    file = tmp_path / "objects.toml"

    def load(text: str) -> dict[str, ObjectPreset]:
        file.write_text(text)
        return dict(load_objects(file))

    good = '[objects.cube]\nabout = "a cube"\nrecipe = "box"\nsize = [0.03, 0.03, 0.03]\nmaterial = "glass"\n'
    cube = load(good)["cube"]
    assert cube.spec().size == (0.03,) * 3
    assert replace(cube, material="steel").spec().weight > cube.spec().weight
    for wrong, message in (
        (good.replace("glass", "glas"), "cube: unknown material 'glas'"),
        (good.replace("recipe", "recip"), "cube: recipe is missing"),
        (good + 'contents = { material = "ice", level = 2.0 }', "level must be from 0 to 1"),
        (good + "contents = { level = 0.5 }", "material"),
        (good + '[objects.other]\nlike = "cub"', "'cub', which does not exist"),
        (good + '[objects.other]\nlike = "other"', "which does not exist or is like itself"),
        ("[objects", "not valid TOML"),
    ):
        with pytest.raises(InvalidValueError, match=message):
            load(wrong)
    for wrong, message in (
        (good.replace('"box"', '"bux"'), "did you mean 'box'"),
        (good.replace("size", "sise"), "unexpected keyword argument 'sise'"),
        (good.replace("0.03]", "-0.03]"), "above 0"),
    ):
        with pytest.raises((UnknownNameError, InvalidValueError), match=message):
            load(wrong)["cube"].spec()


def test_environments_take_names() -> None:
    env = GraspEnv(objects="butter", tolerance=0.5)
    _, info = env.reset(seed=0)
    body = env.batch.plant.bodies[0]  # pyright: ignore[reportAttributeAccessIssue]
    butter = objects()["butter"]
    assert info["material"] == "butter" and body.temperature == 6.0
    assert body.spec.weight == pytest.approx(butter.spec().weight)
    _, info = env.reset(seed=0, options={"material": "steel"})
    body = env.batch.plant.bodies[0]  # pyright: ignore[reportAttributeAccessIssue]
    assert info["material"] == "steel" and body.spec.weight > 5 * butter.spec().weight
    env.close()
    with pytest.raises(UnknownNameError, match="did you mean 'cold_can'"):
        GraspEnv(objects="cold_cann")
    both = GraspVectorEnv(4, objects=["dice", "toy_block"], tolerance=0.5)
    _, infos = both.reset(seed=1)
    assert set(infos["material"]) == {"abs", "maple"}
    both.close()


def test_contents_keep_an_object_hot() -> None:
    """The environment's heat takes the preset's reservoir and temperature."""
    config = SimulationConfig(objects="mug_of_coffee")
    body = config.possible_bodies(sensor("seed"))[0]
    assert body.temperature == 60.0 and body.material.name == "ceramic"
    assert body.spec.reservoir == objects()["mug_of_coffee"].spec().reservoir
    assert body.spec.weight == pytest.approx(objects()["mug_of_coffee"].spec().weight)


def test_an_object_lies_where_it_says() -> None:
    """As a cup does whose handle is not to lie between the fingers."""
    env = GraspEnv(objects=ObjectSpec(position=(0.0, 0.006)), placement=(0.001, 0.0), tolerance=0.5)
    for seed in range(3):
        env.reset(seed=seed)
        place = env.batch.plant.mechanics.object_pose[0, 0]  # pyright: ignore[reportAttributeAccessIssue]
        assert 0.005 <= place[1] <= 0.007 and abs(place[0]) <= 0.001
    env.close()
