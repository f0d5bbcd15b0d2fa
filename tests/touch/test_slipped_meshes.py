"""Meshes on a pad touch what of them lies on it: beside closed forms, sums over springs, and in all three forms."""

# mujoco ships no type stubs for its compiled names
# pyright: reportAttributeAccessIssue=false

from __future__ import annotations

import copy
import math
from collections.abc import Callable
from functools import lru_cache

import mujoco
import numpy as np
import pytest
import trimesh

from thermograsp.errors import MissingDependencyError
from thermograsp.thermal import IDEAL, Pad, material
from thermograsp.thermal.contact import curved_contact, curved_table, skinned
from thermograsp.thermal.matter import skin as named_skin
from thermograsp.thermal.pressed import PressedMesh, height_map, map_heights
from thermograsp.thermal.pressed.springs import depth_under, springs
from thermograsp.touch import Fingertip, ThermalTouch, install, prepare
from thermograsp.touch.contacts import AREA, BESIDE, CLOSED, FORCE, pair_laws
from thermograsp.touch.contacts.laws import PairLaws
from thermograsp.touch.contacts.views import array_viewed, mesh_views, viewed
from thermograsp.touch.scene import bodies, pads

from .engine_scene import keep_boxes

Mesh = tuple[np.ndarray, np.ndarray]
PAD = Pad(width=0.020, face=0.009)


def swept(radius: Callable[[np.ndarray, np.ndarray], np.ndarray], length: float = 0.04) -> Mesh:
    """A body along y whose radius m is a function of angle and height."""
    around, up = 120, 160
    angle, heights = np.arange(around) * (2 * np.pi / around), np.linspace(-length / 2, length / 2, up)
    reach = np.array([radius(angle, height) for height in heights])
    level = np.broadcast_to(heights[:, None], reach.shape)
    loops = np.stack([reach * np.cos(angle), level, reach * np.sin(angle)], axis=-1)
    ring, faces = np.arange(around), []
    for k in range(up - 1):
        a, b = ring + around * k, ring + around * (k + 1)
        a1, b1 = np.roll(a, -1), np.roll(b, -1)
        faces += [np.stack([a, b, a1], 1), np.stack([a1, b, b1], 1)]
    first, last = up * around, up * around + 1
    faces += [np.stack([0 * ring + first, ring, np.roll(ring, -1)], 1)]
    top = ring + around * (up - 1)
    faces += [np.stack([0 * ring + last, np.roll(top, -1), top], 1)]
    ends = np.array([[0, -length / 2, 0], [0, length / 2, 0]])
    return np.concatenate([*loops, ends]), np.concatenate(faces)


def smooth(angle: np.ndarray, height: np.ndarray) -> np.ndarray:
    return 0.01 + 0 * angle


def thread(angle: np.ndarray, height: np.ndarray) -> np.ndarray:
    """M20: crests of 1/8 of a pitch of 2.5 mm, flanks of 60 degrees."""
    turn = (height / 0.0025 - angle / (2 * np.pi)) % 1
    return 0.01 - 0.00217 * np.maximum(abs(turn - 0.5) - 1 / 16, 0)


def made(solid: trimesh.Trimesh) -> Mesh:
    return np.array(solid.vertices), np.array(solid.faces)


MESHES: dict[str, tuple[Mesh, float]] = {
    "box": (made(trimesh.creation.box((0.04, 0.03, 0.02))), 0.02),
    "rod": (swept(smooth), 0.02),
    "thread": (swept(thread), 0.02),
    "ball": (made(trimesh.creation.icosphere(4, 0.02)), 0.04),
    "nut": (made(trimesh.creation.cylinder(0.012, 0.03, sections=6)), 0.03),
}
"""And their height m along z."""


def spec(name: str) -> mujoco.MjSpec:
    (vertices, faces), height = MESHES[name]
    vertex, face = (" ".join(f"{x:.9g}" for x in part.ravel()) for part in (vertices, faces))
    return mujoco.MjSpec.from_string(f"""
      <mujoco><option timestep=".002" gravity="0 0 0"/>
      <asset><mesh name="thing" vertex="{vertex}" face="{face}"/></asset><worldbody>
        <body name="thing"><geom name="thing" type="mesh" mesh="thing" friction="0"/></body>
        <body name="tip" pos="0 0 {height / 2 + 0.0045}">
          <joint name="tip" type="slide" axis="0 0 -1" damping="20"/>
          <joint name="aside" type="slide" axis="1 0 0" damping="20"/>
          <geom name="tip" type="box" size=".01 .01 .004" mass=".05" friction="0"/></body>
      </worldbody><actuator><motor joint="tip"/><position joint="aside" kp="500"/></actuator></mujoco>""")


@lru_cache
def scene(name: str, skin: str | None) -> tuple[mujoco.MjModel, PairLaws]:
    model = spec(name).compile()
    shapes = bodies(model, {"thing": "steel"}, 24.0)
    return model, pair_laws(model, pads(model, {"tip": Fingertip("tip", skin=skin)}, shapes), shapes)


@lru_cache
def table(name: str, skin: str | None, view: int) -> np.ndarray:
    _, laws = scene(name, skin)
    return laws.pressed[laws.curved[0, 0, view] - len(laws.tables)].table()


def found(name: str, skin: str | None, force: float, aside: float = 0.0) -> tuple[float, float, float]:
    """W/K, m2 and m of steel from above, the pad's middle that far m from the mesh's along x."""
    model, laws = scene(name, skin)
    rotation = np.zeros(9)  # the mesh's geom may have other axes than its body
    mujoco.mju_quat2Mat(rotation, model.geom_quat[0])
    turned = rotation.reshape(3, 3).T
    place = turned @ (np.array([aside, 0.0, MESHES[name][1] / 2]) - model.geom_pos[0])
    k, u, v = viewed(laws.views[0], laws.viewed[0], turned @ [0.0, 0.0, -1.0], place, PAD.face / 2)
    return curved_contact(table(name, skin, int(k)), force, u, v)


@pytest.mark.parametrize("skin", [None, "filled_silicone"])
@pytest.mark.parametrize("aside", [0.0, 0.002, 0.004, 0.006, 0.008])
def test_rods_and_balls_are_those_of_the_closed_forms(aside: float, skin: str | None) -> None:
    """What they conduct, contact and gas, in parts of what they do in the middle: to a quarter where a contact ends,
    which it does within half a millimetre."""
    worn = named_skin(skin) if skin else None
    for name, size, place in (("rod", (0.01, 0.04), (aside, 0.0)), ("ball", (0.02, None), (0.0, aside))):
        known = curved_table(PAD, worn, material("steel"), *size)
        for force in (3.0, 10.0):
            whole, there = (curved_contact(known, force, *each)[0] for each in ((0.0, 0.0), place))
            assert found(name, skin, force, aside)[0] == pytest.approx(
                there, abs=(0.12 if aside < 0.004 else 0.25) * whole
            )


def felt(shape: str, meshed: bool, skin: str | None, aside: float) -> float:
    """K that a fingertip feels of aluminium of 20 mm radius at 8 N after 2 s, its crown that far m from the pad's."""
    radius, kinds, ball = 0.02, mujoco.mjtGeom, shape == "ball"
    spec = mujoco.MjSpec()
    spec.option.gravity = [0, 0, 0]
    thing = spec.worldbody.add_body(
        name="thing", quat=[1, 0, 0, 0] if ball else [math.sqrt(0.5), 0, math.sqrt(0.5), 0]
    )
    if meshed:
        cylinder = trimesh.creation.cylinder(radius, 0.06, sections=96)
        solid = trimesh.creation.icosphere(5, radius) if ball else cylinder
        mesh = spec.add_mesh(name="solid")
        mesh.uservert, mesh.userface = solid.vertices.ravel(), solid.faces.ravel()
        thing.add_geom(type=kinds.mjGEOM_MESH, meshname="solid")
    else:
        thing.add_geom(type=kinds.mjGEOM_SPHERE if ball else kinds.mjGEOM_CYLINDER, size=[radius, 0.03, 0])
    tip = spec.worldbody.add_body(name="tip", pos=[0, aside, radius + 0.0045])
    tip.add_joint(name="tip", type=mujoco.mjtJoint.mjJNT_SLIDE, axis=[0, 0, -1], damping=20)
    tip.add_geom(name="tip", type=kinds.mjGEOM_BOX, size=[0.01, 0.01, 0.004], mass=0.05, friction=[0, 0, 0])
    spec.add_actuator(target="tip", trntype=mujoco.mjtTrn.mjTRN_JOINT)
    model = spec.compile()
    data, words = mujoco.MjData(model), {"objects": {"thing": "aluminium"}, "chain": IDEAL}
    touch = ThermalTouch(model, fingertips={"tip": Fingertip("tip", skin=skin)}, **words)
    data.ctrl[0] = 8.0
    while data.time < 2.3:
        mujoco.mj_step(model, data)
        touch.update(data)
    return float(touch.reading.temperature_drop[0])


@pytest.mark.parametrize(
    ("shape", "skin"),
    [
        ("rod", None),
        ("rod", "filled_silicone"),
        pytest.param("ball", None, marks=pytest.mark.slow),
        ("ball", "filled_silicone"),
    ],
)
def test_a_mesh_is_felt_as_the_round_body_that_it_is(shape: str, skin: str | None) -> None:
    """Over the face's edge and beyond it. As docs/physics.md states: a bare rod on the edge alone has more, and under a
    skin a ball that is about to leave the face."""
    for aside in (0.003, 0.005, 0.007, 0.009):
        edge = shape == "rod" and skin is None and aside == 0.005
        leaves = shape == "ball" and skin is not None and aside == 0.007
        most = 0.3 if edge else 0.2 if leaves else 0.1
        assert felt(shape, True, skin, aside) == pytest.approx(felt(shape, False, skin, aside), abs=most)


@pytest.mark.parametrize("name", ["aluminium", "steel", "glass", "wood"])
@pytest.mark.parametrize("length", [None, 0.06])
@pytest.mark.parametrize("radius", [0.005, 0.02])
def test_a_bare_face_meets_a_mesh_as_it_does_the_round_body(
    name: str, length: float | None, radius: float
) -> None:
    """Rigid, with Hertz's contact and the gas around it: in the middle and near an edge."""
    made_of = material(name)
    known = curved_table(PAD, None, made_of, radius, length)
    solid = (
        trimesh.creation.icosphere(3, radius)
        if length is None
        else trimesh.creation.cylinder(radius, length, sections=32)
    )
    table, middle = bare_table(solid, name), np.ptp(solid.vertices, axis=0)[1:] / 2 + PAD.face / 2
    for force in (1.0, 10.0, 30.0):
        for aside in (0.0, 0.65 * PAD.face / 2):
            conducts, patch, _ = curved_contact(known, force, aside, 0.0)
            meshed, like, _ = curved_contact(table, force, middle[0] + aside, middle[1])
            assert meshed == pytest.approx(conducts, rel=0.25)
            assert like == pytest.approx(patch, rel=0.4)


def bare_table(solid: trimesh.Trimesh, name: str) -> np.ndarray:
    vertices, faces = np.ascontiguousarray(solid.vertices, float), np.asarray(solid.faces, np.int64)
    axes = np.array([[-1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]])
    return PressedMesh(PAD, None, material(name), vertices.tobytes(), faces.tobytes(), axes.tobytes()).table()


def test_how_fine_a_mesh_is_does_not_matter() -> None:
    """Triangles of 5.5 and of 1.4 mm: by the first one's flat ones a ball would be felt as twice as cold."""
    coarse, fine = (trimesh.creation.icosphere(level, 0.02) for level in (3, 5))
    for force in (1.0, 10.0, 30.0):
        found = [
            curved_contact(
                bare_table(solid, "steel"), force, *(np.ptp(solid.vertices, axis=0)[1:] / 2 + PAD.face / 2)
            )
            for solid in (coarse, fine)
        ]
        np.testing.assert_allclose(found[0], found[1], rtol=0.03)


@pytest.mark.parametrize("skin", [None, "filled_silicone"])
def test_a_rod_is_a_strip_and_a_ball_a_square_to_the_heat(skin: str | None) -> None:
    """The lengths of their patches: a rod is touched along the whole face."""
    for force in (3.0, 10.0):
        _, area, long = found("rod", skin, force)
        assert max(long, area / long) == pytest.approx(PAD.face, rel=0.05)
    _, area, long = found("ball", skin, 10.0)
    assert area < 0.5 * PAD.face**2 and long == pytest.approx(math.sqrt(area), rel=0.05)


def test_a_narrow_contact_is_not_counted_in_whole_points() -> None:
    """In the middle, where a table has a place, at forces between which a strip is ever broader."""
    known = curved_table(PAD, named_skin("filled_silicone"), material("steel"), 0.01, 0.04)
    for force in np.geomspace(1.0, 30.0, 8):
        strip = curved_contact(known, force, 0.0, 0.0)[1]
        assert found("rod", "filled_silicone", force)[1] == pytest.approx(strip, rel=0.03)


@pytest.mark.parametrize("aside", np.linspace(0.0, 0.024, 9).tolist())
def test_a_face_counts_up_to_its_edge(aside: float) -> None:
    _, area, _ = found("box", None, 10.0, aside)
    assert area == pytest.approx(0.009 * min(max(0.0245 - aside, 0.0), 0.009), abs=0.02 * PAD.face**2)


@pytest.mark.parametrize("skin", [None, "filled_silicone"])
def test_a_thread_touches_less_than_a_rod_and_more_force_touches_more(skin: str | None) -> None:
    for force in (0.3, 3.0, 10.0, 30.0):
        rough, plain = found("thread", skin, force), found("rod", skin, force)
        assert 0 < rough[0] < 0.8 * plain[0]
        if skin is not None:  # on a bare face the patch is as wide as the gas
            assert 0 < rough[1] < 0.8 * plain[1]
    for name in MESHES:
        through = [found(name, skin, force)[0] for force in np.geomspace(0.05, 60.0, 25)]
        assert (np.diff(through) > -1e-9).all()


@pytest.mark.parametrize("name", MESHES)
def test_nothing_jumps_over_the_face_s_edge_and_beyond_it_nothing_is_left(name: str) -> None:
    """Steps that are ever finer make changes that are as much smaller."""
    changes = []
    for steps in (1041, 8321):
        through = np.array([found(name, None, 10.0, aside)[0] for aside in np.linspace(0.0, 0.026, steps)])
        changes.append(abs(np.diff(through)).max() / through.max())
    assert changes[1] < 0.25 * changes[0]
    assert through[-1] < 1e-2 * through.max()  # gas across some millimetres


def test_a_nut_lies_on_each_of_its_faces() -> None:
    model = spec("nut").compile()
    views = mesh_views(model, 0)
    assert len(views) == 8
    normals = sorted(
        round(math.degrees(math.acos(np.clip(a @ b, -1, 1)))) for a in views[:, :3] for b in views[:, :3]
    )
    assert set(normals) == {0, 60, 90, 120, 180}


def test_arrays_see_the_same_views() -> None:
    model, rng = spec("ball").compile(), np.random.default_rng(0)
    views = np.stack([mesh_views(model, 0), np.zeros_like(mesh_views(model, 0))])
    normals = rng.normal(size=(50, 2, 3))
    normals /= np.linalg.norm(normals, axis=-1)[..., None]
    places = rng.uniform(-0.03, 0.03, (50, 2, 3))
    which, first, second = array_viewed(views, normals, places, np.full((50, 2), 0.0045))
    for n in range(50):
        k, u, v = viewed(views[0], len(views[0]), normals[n, 0], places[n, 0], 0.0045)
        assert (which[n, 0], first[n, 0], second[n, 0]) == pytest.approx((k, u, v), abs=1e-12)


def test_what_springs_bear_is_the_force() -> None:
    """Over the footprint, to 1e-6, wherever the mesh is and however light the force."""
    sheet, rng = skinned(PAD, named_skin("filled_silicone")), np.random.default_rng(1)
    points, areas, stiffness, on_face = springs(sheet)
    assert areas.sum() == pytest.approx(PAD.width**2) and areas[:on_face].sum() == pytest.approx(PAD.face**2)
    for name in ("box", "thread", "ball"):
        vertices, faces = MESHES[name][0]
        axes = np.array([[0.0, 0.0, -1.0], [1.0, 0.0, 0.0], [0.0, -1.0, 0.0]])
        seen = height_map(vertices, faces, axes)
        for force in (0.02, 1.0, 100.0):
            heights, cover = np.zeros((2, len(points)))
            middle = np.array([*rng.uniform(-0.015, 0.015, 2), 0.0])
            map_heights(*seen, np.stack([middle, *axes]), points, heights, cover)
            heights -= heights[cover > 0].min()
            load = force * sheet.thickness / sheet.foundation_modulus
            depth = depth_under(heights, cover * areas * stiffness, np.full(len(points), 1e-15), load, np.inf)
            held = (cover * areas * stiffness * np.maximum(depth - heights, 0.0)).sum()
            assert held == pytest.approx(load, rel=1e-6)


@pytest.mark.parametrize("name", ["box", pytest.param("thread", marks=pytest.mark.slow), "nut"])
def test_three_forms_agree_while_a_mesh_slips(name: str, monkeypatch: pytest.MonkeyPatch) -> None:
    keep_boxes(monkeypatch)
    words = {"fingertips": {"tip": Fingertip("tip", skin="filled_silicone")}, "objects": {"thing": "steel"}}
    try:
        model = install(spec(name), **words)
    except MissingDependencyError:
        pytest.skip("needs a C compiler and specs that take plugins")
    data, touch = mujoco.MjData(model), ThermalTouch(model, **words, chain=IDEAL)
    seebeck, seen = touch._pads[0].stack.seebeck, set()
    pressed = 0.0
    data.ctrl[0] = 10.0
    for n in range(600):
        data.ctrl[1] = 0.03 * n / 600
        mujoco.mj_step(model, data)
        reading = touch.update(data)
        if n % 10 == 8:
            touches = touch._reader.touches[0, :, :, :BESIDE]  # the plugin has no pads that exchange heat
            plugin = data.plugin_state[1 : 1 + touches.size].reshape(touches.shape)
            np.testing.assert_allclose(plugin, touches, rtol=1e-9, atol=1e-12)
            pressed += touches[0, 0, FORCE]
            seen.add(round(float(touches[0, 0, AREA] / max(touches[0, 0, CLOSED], 1)) * 1e6, 1))
        if n % 10 == 9:
            mujoco.mj_forward(model, data)
            assert data.sensor("heat").data[0] / seebeck == pytest.approx(
                reading.temperature_drop[0], abs=1e-9
            )
    assert len(seen) > 5 and pressed > 0


def test_a_copy_of_a_touch_makes_its_own_tables() -> None:
    model = spec("nut").compile()
    data = mujoco.MjData(model)
    touch = ThermalTouch(model, fingertips={"tip": "tip"}, objects={"thing": "steel"}, chain=IDEAL)
    data.ctrl[0] = 10.0
    both = copy.deepcopy({"data": data, "touch": touch})
    for each in ({"data": data, "touch": touch}, both):
        for _ in range(100):
            mujoco.mj_step(model, each["data"])
            each["touch"].update(each["data"])
    assert both["touch"].reading.temperature_drop == touch.reading.temperature_drop
    assert touch.reading.temperature_drop[0] > 1.0


def test_a_mesh_in_the_wrong_unit_takes_no_more_room_than_another() -> None:
    cube = trimesh.creation.box((40.0, 40.0, 40.0))
    seen = height_map(np.asarray(cube.vertices), np.asarray(cube.faces), np.eye(3))
    assert seen.height.size < 2010**2 and seen.pitch == pytest.approx(0.02)


@pytest.mark.parametrize("heard", [1, 10])
@pytest.mark.parametrize("error", [MemoryError("no room"), KeyboardInterrupt()])
def test_what_stops_a_table_is_raised_and_the_next_touch_makes_it(
    heard: int, error: BaseException, monkeypatch: pytest.MonkeyPatch
) -> None:
    """By an update after every step, which one call hears, and after ten."""
    model = spec("nut").compile()
    data = mujoco.MjData(model)
    touch = ThermalTouch(model, fingertips={"tip": "tip"}, objects={"thing": "steel"}, chain=IDEAL)
    for _ in range(5):  # in the air
        mujoco.mj_step(model, data)
        touch.update(data)

    def failing(mesh: PressedMesh) -> np.ndarray:
        raise error

    data.ctrl[0] = 10.0
    with monkeypatch.context() as patched, pytest.raises(type(error)):
        patched.setattr(PressedMesh, "table", failing)
        for _ in range(100):
            for _ in range(heard):
                mujoco.mj_step(model, data)
            touch.update(data)
    for _ in range(100):
        mujoco.mj_step(model, data)
        touch.update(data)
    assert touch.reading.temperature_drop[0] > 1.0


@pytest.mark.skipif(
    not hasattr(mujoco.mjtSensor, "mjSENS_CONTACT"), reason="this MuJoCo has no contact sensors"
)
def test_of_many_worlds_it_is_raised_too(monkeypatch: pytest.MonkeyPatch) -> None:
    made = prepare(spec("nut"), fingertips={"tip": "tip"}, objects={"thing": "steel"})
    data, record = mujoco.MjData(made), []
    touch = ThermalTouch(made, fingertips={"tip": "tip"}, objects={"thing": "steel"}, worlds=2)
    data.ctrl[0] = 10.0
    for _ in range(50):
        mujoco.mj_step(made, data)
        record.append(data.sensordata.copy())

    def failing(mesh: PressedMesh) -> np.ndarray:
        raise MemoryError("no room")

    with monkeypatch.context() as patched, pytest.raises(MemoryError, match="no room"):
        patched.setattr(PressedMesh, "table", failing)
        touch.update(np.array([record, record]))
    touch.reset()
    touch.update(np.array([record, record]))
    assert (touch.reading.temperature_drop > 0.1).all()
