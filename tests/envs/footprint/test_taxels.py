"""Pressure maps balance force and moments exactly and are those of an elastic foundation under the object's shape."""

import math
import subprocess
import sys

import numpy as np
import pytest
from gymnasium.utils.env_checker import check_env

from thermograsp.envs import (
    GraspBatch,
    GraspEnv,
    GraspVectorEnv,
    ObjectSpec,
    SortEnv,
    objects,
)
from thermograsp.envs.footprint.grasp_body import PAD
from thermograsp.envs.footprint.surface_height import (
    BOX,
    CYLINDER,
    SPHERE,
    shape_heights,
)
from thermograsp.envs.footprint.taxels import MOST_PRESSURE, Taxels
from thermograsp.envs.mechanics.batch import Mechanics
from thermograsp.errors import InvalidValueError
from thermograsp.thermal import cylinder_contact, sphere_contact
from thermograsp.thermal.pressed import pressure_map

STIFFNESS = PAD.foundation_modulus / PAD.thickness
SIDE = PAD.width


def points(count: int) -> tuple[np.ndarray, float]:
    """Middles (n, 2) m of little squares over the pad and their area m2."""
    middles = (np.arange(count) + 0.5) * SIDE / count - SIDE / 2
    y, z = np.meshgrid(middles, middles)
    return np.stack([y.ravel(), z.ravel()], axis=1), (SIDE / count) ** 2


def pressed(height, force, centre=(0.0, 0.0), cover=None, count=100, deepest=PAD.thickness):
    places, area = points(count)
    out = np.zeros(len(places))
    cover = np.ones(len(places)) if cover is None else cover
    pressure_map(height, cover, places, area, STIFFNESS, deepest, force, np.array(centre, float), out)
    return out


def balance(pressure, count):
    """The map's force and its centre."""
    places, area = points(count)
    force = pressure.sum() * area
    return force, (pressure[:, None] * places).sum(axis=0) * area / force


def test_under_a_sphere_the_pressure_is_hertz_s_paraboloid_s_of_a_foundation() -> None:
    """p = K (a^2 - r^2)/(2 R d) with a from thermal/contact/area.py's closed form."""
    radius, force = 0.05, 10.0
    square = (points(100)[0] ** 2).sum(axis=1)
    found = pressed(square / (2 * radius), force)
    area = float(sphere_contact(PAD, force, radius).pad)
    expected = STIFFNESS * np.maximum(area / math.pi - square, 0.0) / (2 * radius)
    assert found == pytest.approx(expected, abs=0.004 * expected.max())


@pytest.mark.parametrize("force", [1.0, 10.0, 40.0])
def test_under_a_cylinder_it_is_a_parabola_across(force: float) -> None:
    radius = 0.03
    across = points(200)[0][:, 0]
    found = pressed(across**2 / (2 * radius), force, count=200).reshape(200, 200)
    assert np.ptp(found, axis=0).max() < 1e-6 * found.max()  # the same along the axis
    half = float(cylinder_contact(PAD, force, radius).pad) / (2 * SIDE)
    expected = STIFFNESS * np.maximum(half**2 - across[:200] ** 2, 0.0) / (2 * radius)
    assert found[0] == pytest.approx(expected, abs=0.003 * expected.max())


def test_under_a_flat_face_it_is_even_or_leans_or_lifts_off() -> None:
    """An eccentric force on a rigid footing: p = F/A (1 + 12 e y/L^2) up to e = L/6, beyond that over 3 (L/2 - e)."""
    force, count = 10.0, 80
    flat, y = np.zeros(count**2), points(count)[0][:, 0]
    assert pressed(flat, force, count=count) == pytest.approx(force / SIDE**2, rel=1e-12)
    leaning = pressed(flat, force, (0.002, 0.0), count=count)
    # the sum over little squares in place of the second moment's integral
    second = (y**2).mean()
    assert leaning == pytest.approx(force / SIDE**2 * (1 + 0.002 * y / second), rel=1e-9)
    off = pressed(flat, force, (0.006, 0.0), count=count)
    reach = 3 * (SIDE / 2 - 0.006)
    expected = 2 * force / (SIDE * reach) * np.maximum(1 - (SIDE / 2 - y) / reach, 0.0)
    assert off == pytest.approx(expected, abs=0.01 * expected.max())


def test_half_covered_only_the_half_is_pressed() -> None:
    force, count = 10.0, 40
    y = points(count)[0][:, 0]
    found = pressed(np.zeros(count**2), force, (SIDE / 4, 0.0), cover=(y > 0) * 1.0, count=count)
    assert found == pytest.approx(np.where(y > 0, 2 * force / SIDE**2, 0.0), rel=1e-9)


@pytest.mark.parametrize("seed", range(60))
def test_force_and_moments_balance_under_any_surface(seed: int) -> None:
    """Bumps, edges and tilts drawn at random; the map has the force and its centre to rounding and is not negative."""
    rng = np.random.default_rng(seed)
    count = 40
    places, _ = points(count)
    radius, middle = rng.uniform(0.005, 0.1), rng.uniform(-0.005, 0.005, 2)
    height = ((places - middle) ** 2).sum(axis=1) / (2 * radius) + places @ rng.normal(0, 0.1, 2)
    height += rng.uniform(0, 1e-4) * np.sin(2000 * places[:, 0]) + rng.normal()
    cover = np.clip((places @ rng.normal(0, 1, 2) + 0.008) / 5e-4, 0.0, 1.0)
    force = 10 ** rng.uniform(-1, 1.5)
    untilted = pressed(height, force, middle, cover, count)  # a centre that the surface can bear
    centre = balance(untilted, count)[1] + rng.uniform(-3e-4, 3e-4, 2)
    found = pressed(height, force, centre, cover, count)
    reading, at = balance(found, count)
    assert reading == pytest.approx(force, rel=1e-13)
    assert at == pytest.approx(centre, abs=1e-9)
    assert (found >= 0).all() and not found[cover == 0].any()


def test_a_constant_and_a_slope_change_nothing() -> None:
    places = points(40)[0]
    height = (places**2).sum(axis=1) / 0.06
    tilted = height + 0.3 + places @ (0.2, -0.1)
    plain, moved = (pressed(each, 10.0, (0.001, 0.002), count=40) for each in (height, tilted))
    assert moved == pytest.approx(plain, abs=1e-6 * plain.max())


def test_what_cannot_be_balanced_keeps_the_force() -> None:
    """A centre off the surface moves to it; with no surface at all the nearest point takes the force."""
    places = points(40)[0]
    found = pressed(np.zeros(1600), 10.0, (0.0, 0.0), cover=(places[:, 0] > 0.002) * 1.0, count=40)
    reading, at = balance(found, 40)
    assert reading == pytest.approx(10.0, rel=1e-13) and 0.002 < at[0] < 0.004 and abs(at[1]) < 1e-9
    assert found.max() <= PAD.foundation_modulus
    nothing = pressed(np.zeros(1600), 10.0, (0.003, 0.0), cover=np.zeros(1600), count=40)
    assert balance(nothing, 40)[0] == pytest.approx(10.0) and (nothing > 0).sum() == 1
    assert not pressed(np.zeros(1600), 0.0, count=40).any()


def seen(shape: int, half: tuple[float, float, float], turn: float, y: float = 0.0):
    """Heights and coverage of a shape before a pad at x = -1 m that looks along x, turned about z."""
    places = points(40)[0]
    cos, sin = math.cos(turn), math.sin(turn)
    pad = np.array([[-cos, -sin, 0.0], [cos, sin, 0.0], [-sin, cos, 0.0], [0.0, 0.0, 1.0]])
    pad[0] += y * pad[2]
    height, cover = np.zeros(len(places)), np.zeros(len(places))
    shape_heights(shape, np.array(half), pad, places, SIDE / 40, height, cover)
    return places, height, cover


def test_heights_of_shapes_are_the_closed_forms() -> None:
    radius = 0.02
    for turn in (0.0, 0.7, 3.0):
        places, height, cover = seen(SPHERE, (radius, radius, radius), turn)
        assert height == pytest.approx(1 - np.sqrt(radius**2 - (places**2).sum(axis=1)), rel=1e-12)
        places, height, cover = seen(CYLINDER, (radius, radius, 0.05), turn)
        assert height == pytest.approx(1 - np.sqrt(radius**2 - places[:, 0] ** 2), rel=1e-12)
        assert (cover == 1).all()
    turn = 0.05
    places, height, cover = seen(BOX, (0.02, 0.03, 0.004), turn)
    assert height == pytest.approx(1 - 0.02 / math.cos(turn) + math.tan(turn) * places[:, 0], abs=1e-12)
    high = cover.reshape(40, 40).sum(axis=0) * SIDE / 40
    assert high == pytest.approx(0.008, rel=1e-9)  # edges run through little squares
    # edge on: a ridge, sloping away on both sides
    places, height, cover = seen(BOX, (0.02, 0.02, 0.05), math.pi / 4)
    assert height == pytest.approx(1 - 0.02 * math.sqrt(2) + np.abs(places[:, 0]), abs=1e-12)
    assert (cover == 1).all()
    # a cylinder seen from its end
    pad = np.array([[0.0, 0.0, 1.0], [0.0, 0.0, -1.0], [1.0, 0.0, 0.0], [0.0, -1.0, 0.0]])
    shape_heights(CYLINDER, np.array([0.006, 0.006, 0.02]), pad, places, SIDE / 40, height, cover)
    assert cover.sum() * (SIDE / 40) ** 2 == pytest.approx(math.pi * 0.006**2, rel=5e-3)
    assert height[cover > 0] == pytest.approx(0.98, rel=1e-12)


def grasped(spec: ObjectSpec, force: float = 10.0, seconds: float = 1.4):
    mechanics = Mechanics((spec,), contacts=True)
    for _ in range(round(seconds / 0.02)):
        mechanics.advance(np.zeros(1), np.full(1, force), np.zeros(1))
    return mechanics


def weighed(taxels: Taxels, pressure: np.ndarray):
    """Force (F,) and centre (F, 2) of maps (F, n, m)."""
    area = SIDE**2 / np.prod(taxels.shape)
    force = pressure.sum(axis=(1, 2)) * area
    centre = (pressure[..., None] * taxels.places).sum(axis=(1, 2)) * area / force[:, None]
    return force, centre


@pytest.mark.parametrize(
    "spec",
    [
        ObjectSpec(),
        ObjectSpec(shape="cylinder"),
        ObjectSpec(shape="sphere"),
        ObjectSpec(position=(0.0, 0.017)),
        ObjectSpec(size=(0.03, 0.012, 0.05), yaw=0.06),
        ObjectSpec(elements=(0.009, 0.003)),
        *(
            objects()[name].spec()
            for name in ("mug", "apple", "hex_nut", "wrench", "hammer_head", "egg", "cold_can")
        ),
    ],
    ids=lambda spec: spec.material or spec.shape,
)
def test_the_map_has_mujoco_s_force_and_centre(spec: ObjectSpec) -> None:
    taxels = Taxels((40, 40))
    mechanics = grasped(spec)
    before = mechanics.state()
    closed, still = np.zeros(1), np.zeros(1)
    mechanics.advance(closed, np.full(1, 10.0), still)
    (contact,) = mechanics.pad_contacts()
    force, centre = weighed(taxels, taxels.pressure(mechanics)[0])
    assert force == pytest.approx(contact.force[0], rel=1e-12)
    assert centre == pytest.approx(contact.centre[0], abs=1e-8)
    # and these are the means of what the slow path tells of every substep of this step
    mechanics.set_state(before)
    record = mechanics.step(closed, np.full(1, 10.0), still)
    normal = record.force[0, :, :, 0, 0]
    assert contact.force[0] == pytest.approx(normal.mean(axis=0), rel=1e-12)
    weighted = (record.centroid[0, :, :, 0] * normal[..., None]).sum(axis=0) / normal.sum(axis=0)[:, None]
    assert contact.centre[0] == pytest.approx(weighted, abs=1e-12)


def test_shapes_show() -> None:
    taxels = Taxels((20, 20))

    def left(spec: ObjectSpec) -> np.ndarray:
        return taxels.pressure(grasped(spec))[0, 0]

    flat, line, spot = (left(ObjectSpec(shape=shape)) for shape in ("box", "cylinder", "sphere"))
    assert (flat > 0).all()
    # bare alumina gives way by micrometres to a rod, and the silicone around it is pressed no deeper
    assert (line[:, 9:11] > 0).all() and not np.delete(line, np.s_[9:11], axis=1).any()
    assert line[6:14, 9:11].min() > 1e4 * line[[*range(5), *range(15, 20)]].max()
    assert spot[9:11, 9:11].min() > 5 * flat.max() and not spot[:5].any()
    narrow = left(ObjectSpec(size=(0.04, 0.010, 0.04)))
    assert (narrow[:, 5:15] > 1.0).all() and np.delete(narrow, np.s_[5:15], axis=1).max() < 1e-6
    # a wrench's hull covers the pad, its shaft of 18 mm does not
    wrench = left(objects()["wrench"].spec())
    assert not wrench[[0, -1]].any() and (wrench[1:-1] > 0).all()


def test_a_mesh_feels_as_the_shape_that_it_is(tmp_path) -> None:
    trimesh = pytest.importorskip("trimesh")
    path = str(tmp_path / "box.stl")
    trimesh.creation.box((0.03, 0.013, 0.04)).export(path)
    taxels = Taxels((8, 8))
    plain = taxels.pressure(grasped(ObjectSpec(size=(0.03, 0.013, 0.04), mass=0.1)))
    meshed = taxels.pressure(grasped(ObjectSpec(shape="mesh", mesh=path, mass=0.1)))
    assert meshed == pytest.approx(plain, abs=0.03 * plain.max())


def test_the_sum_s_share_of_each_taxel_does_not_depend_on_how_many_there_are() -> None:
    mechanics = grasped(ObjectSpec(shape="sphere"))
    coarse, fine = (Taxels((side, side)).pressure(mechanics)[0] for side in (4, 40))
    assert fine.reshape(2, 4, 10, 4, 10).mean(axis=(2, 4)) == pytest.approx(coarse, rel=1e-12)
    oblong = Taxels((3, 7)).pressure(mechanics)[0]
    assert oblong.shape == (2, 3, 7)
    assert oblong.mean(axis=(1, 2)) == pytest.approx(coarse.mean(axis=(1, 2)), rel=1e-12)


ACTIONS = [np.array([-1.0, -0.5, 0.0])] * 60 + [np.array([-1.0, -0.5, 1.0])] * 20


def test_environments_feel_it_and_one_is_a_batch_of_one() -> None:
    shapes = [ObjectSpec(), ObjectSpec(shape="sphere")]
    config = {"material": "glass", "objects": shapes, "taxels": (6, 5), "tolerance": 0.5}
    single, vector = GraspEnv(**config), GraspVectorEnv(3, **config)
    check_env(GraspEnv(**config), skip_render_check=True)
    box = single.observation_space["pressure"]
    assert box.shape == (2, 6, 5) and box.high.max() == np.float32(MOST_PRESSURE)  # pyright: ignore
    seen, _ = single.reset(seed=5)
    all_seen, _ = vector.reset(seed=4)
    assert not seen["pressure"].any()
    total = np.zeros(2)
    for action in ACTIONS:
        seen, *_ = single.step(action)
        all_seen, *_ = vector.step(np.tile(action, (3, 1)))
        assert single.observation_space.contains(seen)
        assert np.array_equal(seen["pressure"], all_seen["pressure"][1])
        total = seen["pressure"].sum(axis=(1, 2)) * SIDE**2 / 30
        assert total == pytest.approx(np.maximum(seen["force"][:, 0], 0.0), rel=1e-5, abs=1e-5)
    assert total.min() > 5.0
    state = single.state()
    first = [single.step(action)[0]["pressure"] for action in ACTIONS[-5:]]
    single.set_state(state)
    again = [single.step(action)[0]["pressure"] for action in ACTIONS[-5:]]
    assert np.array_equal(first, again)


def test_a_pad_s_map_does_not_depend_on_how_many_there_are() -> None:
    specs = [objects()[name].spec() for name in ("egg", "hex_nut", "wrench")]
    several = Mechanics((specs[0],), 3, library=specs, contacts=True)
    several.reset(objects=[(spec,) for spec in specs])
    alone = Mechanics((specs[0],), 1, library=specs, contacts=True)
    alone.reset(objects=[(specs[1],)])
    for mechanics in (several, alone):
        rows = np.ones(mechanics.num_envs)
        for _ in range(60):
            mechanics.advance(0 * rows, 10 * rows, 0 * rows)
    taxels = Taxels((5, 5))
    together = taxels.pressure(several)
    assert together.all(axis=(2, 3)).any() and np.array_equal(together[1], taxels.pressure(alone)[0])


def test_of_two_objects_each_presses_its_own() -> None:
    env = SortEnv(taxels=(4, 4), material=["glass", "iron"], tolerance=0.5)
    seen, _ = env.reset(seed=0)
    assert seen["pressure"].shape == (2, 4, 4)
    for _ in range(60):
        seen, *_ = env.step(np.array([-1.0, -0.5, 0.0, 0.0]))
        assert env.observation_space.contains(seen)
    env.close()


def test_a_scene_s_objects_press_together() -> None:
    """Two cubes beside each other under one pad, each with its half."""
    halves = [
        ObjectSpec(name=name, size=(0.04, 0.02, 0.04), position=(0.0, side * 0.0105), material="glass")
        for name, side in (("left", -1), ("right", 1))
    ]
    env = GraspEnv(scene=halves, taxels=(1, 20), placement=(0.0, 0.0), tolerance=0.5, skin=None)
    env.reset(seed=0)
    seen: dict[str, np.ndarray] = {}
    for action in ACTIONS[:60]:
        seen, *_ = env.step(action)
    across = seen["pressure"][0, 0]
    assert across.mean() * SIDE**2 == pytest.approx(seen["force"][0, 0], rel=1e-5)
    assert (
        across[9] == across[10] == pytest.approx(across[:9].mean() / 2, rel=0.1)
    )  # the gap of 1 mm, a taxel's half
    env.close()


@pytest.mark.parametrize("wrong", [(0, 4), (4, 101), (4,), 4, (2.5, 2), "44", (True, 2)])
def test_taxels_are_checked(wrong: object) -> None:
    with pytest.raises(InvalidValueError, match="two whole numbers"):
        GraspBatch(1, taxels=wrong)


def test_a_real_gripper_has_none() -> None:
    with pytest.raises(InvalidValueError, match="a real fingertip has one load cell"):
        GraspEnv(plant="serial:///dev/null?gripper=robotiq:///dev/null", taxels=(4, 4))


def test_without_them_nothing_of_theirs_is_loaded_or_recorded() -> None:
    code = (
        "import sys, numpy as np\n"
        "from thermograsp.envs import GraspEnv\n"
        "env = GraspEnv(material='glass', tolerance=0.5)\n"
        "seen, _ = env.reset(seed=0)\n"
        "env.step(np.zeros(3))\n"
        "names = ['footprint.taxels', 'spaces.map_observation', 'footprint.surface_height']\n"
        "names += ['mechanics.pad_contacts', 'readout.face_temperature']\n"
        "keys = {'pressure', 'face_temperature'} & set(seen)\n"
        "names = [f'thermograsp.envs.{name}' for name in names]\n"
        "names += [f'thermograsp.thermal.{name}' for name in ('batch.face', 'pressed')]\n"
        "print([name for name in names if name in sys.modules], bool(keys))\n"
        "print('site_xpos' in env.batch.plant.mechanics._latest)\n"
    )
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    assert done.stdout.split("\n")[:2] == ["[] False", "False"]
