"""Objects that are touched anywhere: meshes, second touches, touches beside each other, both fingers on one block."""

from __future__ import annotations

from dataclasses import replace
from typing import Literal

import numpy as np
import pytest
import trimesh
from scipy.linalg import expm

from thermograsp import thermal
from thermograsp.envs import (
    GraspBatch,
    GraspBody,
    GraspTask,
    ObjectSpec,
    SimulationConfig,
    action_of,
    ice,
    water,
)
from thermograsp.envs.bodies.object_solids import object_solid
from thermograsp.envs.sensing import touches
from thermograsp.envs.sensing.heat import GraspHeat
from thermograsp.envs.sensing.touches import first_touches
from thermograsp.thermal import Demand
from thermograsp.thermal.anywhere.placed import FILLED_SHARE
from thermograsp.thermal.batch import FIXED_LEVEL
from thermograsp.thermal.kernels import Patches, box_side, tip
from thermograsp.thermal.meshes.touched import field_carried, surface_normal

from ..scripted import grasp_action

ENDLESS = GraspTask(hold_seconds=1e3, seconds=1e3)
STACK = thermal.sensor("seed")
STEP = 0.02  # s
SETTINGS = {
    "tolerance": 0.05,
    "air": 0.0,
    "dt": STEP / 2,
    "samples": 2,
    "sensor_temperature": 36.0,
}
FACTORS: dict[str, float] = {
    "object_temperature_shift": 0.0,
    **dict.fromkeys(("size_factor", "mass_factor", "friction_factor", "roughness_factor"), 1.0),
}
BAR = ObjectSpec(size=(0.01, 0.07, 0.024), mass=0.1, friction=0.8)
LEFT = np.array([-0.005, 0.0, 0.0])


def grasp_body(
    spec: ObjectSpec = BAR, name: str = "glass", *, fingertips: Literal[1, 2] = 1, anywhere: bool = True
) -> GraspBody:
    return GraspBody(spec, thermal.material(name), 24.0, "T", STACK, fingertips, anywhere=anywhere)


def heat_of(*grasp_bodies: GraspBody, **settings: float) -> GraspHeat:
    heat = GraspHeat(len(grasp_bodies), **{**SETTINGS, **settings})
    heat.reset(range(len(grasp_bodies)), grasp_bodies, np.full((len(grasp_bodies), 2), 36.0))
    return heat


def press(heat: GraspHeat, seconds: float, *places: np.ndarray | None, newton: float = 10.0):
    """The left fingertip on each row's object at a place, apart where None. Returns what each step told."""
    force, place = np.zeros((len(places), 10, 2)), np.zeros((len(places), 2, 3))
    for row, at in enumerate(places):
        if at is not None:
            force[row, :, 0], place[row, 0], place[row, 1] = newton, at, at * [-1.0, -1.0, 1.0]
    return [heat.advance(force, place) for _ in range(round(seconds / STEP))]


@pytest.fixture(scope="module")
def meshes(tmp_path_factory) -> dict[str, str]:
    folder = tmp_path_factory.mktemp("meshes")
    cup, thin = (
        trimesh.creation.revolve(
            [[0, 0], [0.02, 0], [0.02, 0.04], [r, 0.04], [r, 0.003], [0, 0.003]], sections=64
        )
        for r in (0.0175, 0.0194)
    )
    full = trimesh.creation.cylinder(0.02, 0.04, sections=64)
    cube = trimesh.creation.box((0.04, 0.04, 0.04))
    paths = {}
    for name, mesh in {"cup": cup, "thin": thin, "full": full, "cube": cube}.items():
        paths[name] = str(folder / f"{name}.stl")
        mesh.export(paths[name])
    return paths


@pytest.mark.parametrize("name", ["plastic", pytest.param("glass", marks=pytest.mark.slow), "aluminium"])
def test_a_cube_s_mesh_is_felt_as_the_box_is(name, meshes):
    """To the shipped tolerance of .05 K."""
    box = ObjectSpec(mass=0.1, friction=0.8)
    mesh = ObjectSpec(shape="mesh", mesh=meshes["cube"], mass=0.1, friction=0.8)
    report = []
    for each in (grasp_body(box, name, fingertips=2, anywhere=False), grasp_body(mesh, name, fingertips=2)):
        heat = heat_of(each, tolerance=0.05)
        place, force = box.element_places[None], np.full((1, 10, 2), 10.0)
        report.append(np.array([heat.advance(force, place).drop[0, -1] for _ in range(400)]))
        report[-1] = report[-1][2:]
    assert np.abs(report[0] - report[1]).max() < 0.05
    assert heat.rung(0).startswith("body:")


@pytest.mark.slow
def test_an_empty_cup_and_a_full_one_are_told_apart_by_touch(meshes):
    """A wall of .6 mm warms through at once and one of 2.5 mm within seconds, and gives way; what is full goes on
    taking heat."""
    drops = {}
    for name in ("thin", "cup", "full"):
        spec = ObjectSpec(shape="mesh", mesh=meshes[name], mass=0.05, friction=0.8)
        batch = GraspBatch(
            1, objects=spec, material="ceramic", task=ENDLESS, signal="ideal", placement=(0.0, 0.0)
        )
        batch.reset([0], [np.random.default_rng(0)])
        steps = [batch.step(grasp_action(batch)) for _ in range(700)]
        info = steps[-1].info(0)
        drops[name] = info["temperature_drop"], steps[-1].reading.voltage[0, -1]
        truth = steps[-1].reading.truth
        assert np.all(abs(truth["heat_imbalance"]) < 1e-9 * truth["heat_exchanged"])
    for fuller, emptier, less in (("full", "cup", 0.1), ("cup", "thin", 0.9)):
        assert np.all(drops[fuller][0] - drops[emptier][0] > less)
        assert np.all(drops[fuller][1] - drops[emptier][1] > less * 1e-3)


@pytest.mark.slow
@pytest.mark.parametrize("moves", [False, True])
def test_a_mug_s_contents_feed_the_place_under_the_finger(moves, meshes):
    """Through a wall of .6 mm, so that a finger draws more than the wall alone has; the books hold, also when the
    finger goes on to another place and while ice melts."""
    flows = {}
    for inside in (None, water(0.03, 3.0), ice(2e-4, 3.0)):
        celsius = 0.0 if inside and inside.latent_heat else 60.0
        spec = ObjectSpec(shape="mesh", mesh=meshes["thin"], mass=0.05, friction=0.8, reservoir=inside)
        heat = heat_of(replace(grasp_body(spec, "plastic"), temperature=celsius, ambient=celsius), air=5.0)
        places = [np.array([-0.02, 0.0, 0.0])] + [np.array([0.0, -0.02, 0.004])] * moves
        taken = supplied = lost = gained = 0.0
        for place in places:
            for step in press(heat, 4.0, place):
                report = step.info[0]
                taken += STEP * report["flow"].sum()
                supplied += STEP * report["reservoir_flow"]
                lost += STEP * report["air_loss"]
                assert abs(report["imbalance"]) < 1e-8 * (1 + report["exchanged"])
                if inside and inside.latent_heat:
                    assert report["reservoir_temperature"] == pytest.approx(0.0, abs=1e-3)
                gained = report["heat"][2]
        assert gained == pytest.approx(taken + supplied - lost, abs=1e-7)
        flows[celsius, inside is not None] = taken
    assert flows[60.0, True] < 1.1 * flows[60.0, False] < 0 < flows[0.0, True]


@pytest.mark.parametrize(
    "film", [pytest.param(2.0, marks=pytest.mark.slow), 60.0]
)  # W/K, of still water and of what boils
def test_hot_contents_need_no_grid_of_the_whole_at_the_usual_tolerance(film, meshes, monkeypatch):
    """Nor for a place that is new; what the network's error may be is told."""

    def refused(*_, **__):
        raise AssertionError("a grid of the whole mug, fine at each of its places")

    monkeypatch.setattr(touches, "touched_body", refused)
    spec = ObjectSpec(shape="mesh", mesh=meshes["cup"], mass=0.05, friction=0.8, reservoir=water(0.03, film))
    demand = Demand(0.05, 29.3, (1e2, 1e3, 1e4, 1e5), 20.0)
    first = first_touches(replace(grasp_body(spec, "ceramic"), temperature=60.0, ambient=24.0), demand, False)
    assert first is not None and first.fed
    assert len(first.moved(0, np.array([0.0, -0.02, 0.004])).body.patches) == 2
    assert first.body.error == pytest.approx(FILLED_SHARE * 29.3)


@pytest.mark.parametrize("name", ["glass", pytest.param("aluminium", marks=pytest.mark.slow)])
def test_heat_taken_is_the_rise_times_the_heat_capacity(name, meshes):
    """Also after a touch elsewhere; the capacity is that of the mesh's own volume, as its grid has it."""
    spec = ObjectSpec(shape="mesh", mesh=meshes["cup"], mass=0.05, friction=0.8)
    heat = heat_of(grasp_body(spec, name))
    solid = trimesh.load_mesh(meshes["cup"])
    capacity = heat._touches[0].body.geometry.whole_capacity
    assert capacity == pytest.approx(solid.volume * thermal.material(name).volumetric_heat_capacity, rel=1e-4)
    places = [np.array([-0.02, 0.0, 0.0]), None, np.array([0.0, -0.02, 0.004]), None]
    taken = 0.0
    for place in places:
        for step in press(heat, 2.0, place):
            taken += STEP * step.info["flow"][0].sum()
            rise = step.info["object_temperature"][0] - 24.0
            assert capacity * rise == pytest.approx(taken, rel=1e-6, abs=1e-12)
    assert taken > 1.0 and len(heat._touches[0].body.patches) == 2


def test_a_second_touch_finds_the_warm_spot_and_one_well_away_does_not():
    first, away = LEFT, LEFT + [0, 0.024, 0]  # the whole pad on the bar
    heat = heat_of(*(grasp_body() for _ in range(4)))
    press(heat, 5.0, first, first, first, first)
    press(heat, 5.0, None, None, None, None)
    # The last one's object is fresh once more, its fingertip as it is.
    heat._state[3, : heat._of_tip(3, 0).start] = 0.0
    near = first + [0, 0.0084, 0]
    report = press(heat, 1.0, first, away, near, first)
    drop = np.array([step.drop[:, -1, 0] for step in report])[10:]
    warm, elsewhere, beside, fresh = drop.T
    assert np.all(fresh - warm > 0.1)
    assert np.abs(elsewhere - fresh).max() < 0.01
    assert np.all(fresh - beside > 0.02) and np.all(beside - warm > 0.05)
    kinds = [[kind for step in report for kind, _ in step.events[row]] for row in range(3)]
    assert kinds == [["touch"], ["touch", "new patch"], ["touch", "new patch"]]


def test_what_an_added_patch_changes_is_within_tolerance_of_having_had_it_from_the_start():
    """The field that a touch left, told at another place through the carried states, is what the network of both places
    from the start has there."""
    alone = first_touches(grasp_body(), thermal.Demand(0.1, 12.0), cache=False)
    assert alone is not None
    both = alone.moved(0, LEFT + [0, 0.0084, 0])
    assert len(both.body.patches) == 2
    state = [body.object.outputs["heat"] * 0.0 for body in (alone.body, both.body)]
    for body, x in zip((alone.body, both.body), state, strict=True):
        ports = body.object.ports[:, 0]  # a watt, evenly over the first place
        for _ in range(500):
            x += -body.object.rates * x * 0.01 / (1 + body.object.rates * 0.01)
            x += ports * 0.01 / (1 + body.object.rates * 0.01)
    carried = field_carried(alone.body, both.body) @ state[0]
    rows = both.body.object.ports[:, :: both.body.modes]
    expected, found = rows.T @ state[1], rows.T @ carried
    assert np.abs(found - expected).max() < 0.01 * np.abs(expected).max()
    assert both.body.object.outputs["heat"] @ carried == pytest.approx(5.0, rel=1e-9)


def test_two_fingers_warm_a_small_block_as_the_two_port_network_says():
    """Against the matrix exponential of all bodies' equations, joined by the contacts' conductances."""
    spec = ObjectSpec(size=(0.02, 0.02, 0.02), mass=0.1, friction=0.8)
    rise = {}
    tips: Literal[1, 2]
    for tips in (1, 2):
        heat = heat_of(grasp_body(spec, "aluminium", fingertips=tips))
        place, force = spec.element_places[None], np.full((1, 10, 2), 10.0)
        report = [heat.advance(force, place).info[0] for _ in range(250)][-1]
        rise[tips] = report["object_temperature"] - 24.0
        level = FIXED_LEVEL
        sensor = tip(STACK, ((0.0, 0.009), (0.0, 0.009)), level)
        patches = Patches(np.arange(tips), np.full((tips, 2), 0.01), np.full((tips, 2), 0.0045))
        size = (0.02, 0.02, 0.02)
        body = box_side(thermal.material("aluminium"), size, 0.0, patches, (sensor,) * tips, level)
        film = report["conductance"] * report["area"]
        blocks = [(body.rates, body.ports)] + [(sensor.side.rates, -sensor.side.ports)] * tips
        rates = np.concatenate([block[0] for block in blocks])
        ports = np.zeros((len(rates), tips * level.patterns))
        count, order = len(body.rates), len(sensor.side.rates)
        ports[:count] = body.ports
        for number in range(tips):
            tip_states = slice(count + number * order, count + (number + 1) * order)
            ports[tip_states, number * level.patterns : (number + 1) * level.patterns] = -sensor.side.ports
        weights = np.repeat(film[:tips], level.patterns)
        matrix = np.diag(rates) + (ports * weights) @ ports.T
        drive = (ports * weights)[:, :: level.patterns].sum(axis=1) * 12.0
        steady = np.linalg.lstsq(matrix, drive, rcond=None)[0]
        state = steady - expm(-5.0 * matrix) @ steady
        capacity = thermal.material("aluminium").volumetric_heat_capacity * np.prod(size)
        expected = body.outputs["object"] @ state[:count] / capacity
        assert rise[tips] == pytest.approx(expected, rel=1e-3)
    assert 1.3 * rise[1] < rise[2] < 2.0 * rise[1]


def test_a_row_does_not_depend_on_the_others_and_a_state_goes_on_bit_for_bit():
    course = [LEFT, None, beside := LEFT + [0, 0.0084, 0], None, beside, LEFT]
    together = heat_of(
        grasp_body(),
        grasp_body(BAR, "aluminium"),
        grasp_body(ObjectSpec(mass=0.1, friction=0.8), anywhere=False),
    )
    alone = heat_of(grasp_body())
    seen = []
    for k, place in enumerate(course):
        one = press(alone, 0.1, place)
        all_of_them = press(together, 0.1, place, course[-1 - k], 4 * LEFT)
        for a, b in zip(one, all_of_them, strict=True):
            assert np.array_equal(a.drop[0], b.drop[0]) and a.info[0].tobytes() == b.info[0].tobytes()
        seen.append(alone.state([0]))
    other = heat_of(grasp_body(BAR, "cork"))
    other.set_state([0], seen[3])
    alone.set_state([0], seen[3])
    for place in course[4:]:
        for a, b in zip(press(alone, 0.1, place), press(other, 0.1, place), strict=True):
            assert a.info[0].tobytes() == b.info[0].tobytes()


@pytest.mark.slow
def test_vector_and_single_environments_agree_on_meshes_bit_for_bit(meshes):
    spec = ObjectSpec(shape="mesh", mesh=meshes["cup"], mass=0.05, friction=0.8, temperature=50.0)
    config = {"objects": spec, "material": ["ceramic", "glass"], "task": ENDLESS, "ambient_temperature": 22.0}
    many = GraspBatch(3, **config)
    many.reset(range(3), [np.random.default_rng(i) for i in range(3)])
    singles = [GraspBatch(1, **config) for _ in range(3)]
    for i, single in enumerate(singles):
        single.reset([0], [np.random.default_rng(i)])
    for _ in range(80):
        together = many.step(grasp_action(many))
        for row, single in enumerate(singles):
            alone = single.step(grasp_action(single))
            for key, value in alone.observation.items():
                assert np.array_equal(value[0], together.observation[key][row])


def test_the_nearest_surface_is_found_at_faces_edges_and_inside_a_cup(meshes):
    box = object_solid(ObjectSpec(), thermal.material("glass"))
    for place, normal in [
        ((0.021, 0.01, 0.0), (1, 0, 0)),
        ((0.0, 0.004, 0.05), (0, 0, 1)),
        ((0, -0.019, 0), (0, -1, 0)),
    ]:
        assert surface_normal(box, np.array(place)) == pytest.approx(normal, abs=1e-9)
    cup = object_solid(ObjectSpec(shape="mesh", mesh=meshes["cup"]), thermal.material("glass"))
    assert surface_normal(cup, np.array([0.0202, 0.0, 0.0]))[0] > 0.99
    assert surface_normal(cup, np.array([0.0170, 0.0, 0.0]))[0] < -0.99


def test_solids_of_the_plain_shapes_have_their_volume():
    for spec in (
        ObjectSpec(),
        ObjectSpec(shape="sphere"),
        ObjectSpec(shape="cylinder", size=(0.03, 0.03, 0.05)),
    ):
        solid = object_solid(spec, thermal.material("glass"))
        assert solid.parts[0].volume == pytest.approx(spec.volume, rel=1e-6)
        assert solid.bounds == pytest.approx(np.outer([-0.5, 0.5], spec.size), rel=2e-3)


def test_cubes_are_touched_anywhere_where_that_is_asked_and_cylinders_unless_it_is_refused():
    round_one = ObjectSpec(shape="cylinder", size=(0.03, 0.03, 0.05))
    box = GraspBatch(1, material="glass", task=ENDLESS)
    plain = GraspBatch(1, material="glass", task=ENDLESS, objects=round_one)
    words = {"material": "glass", "task": ENDLESS, "objects": round_one, "tolerance": 0.1}
    middle = GraspBatch(1, **words, anywhere=False)
    mapped = GraspBatch(1, **words, anywhere=True, face_temperature=(3, 3))
    cube = GraspBatch(1, material="glass", task=ENDLESS, anywhere=True, tolerance=0.05)
    every = (
        (box, "network:"),
        (cube, "kernels:"),
        (plain, "fields:"),
        (middle, "network:"),
        (mapped, "fields:"),
    )
    for batch, rung in every:
        batch.reset([0], [np.random.default_rng(0)])
        step = batch.step(action_of(0.085, 10.0, 0.0)[None])
        assert step.info(0)["rung"].startswith(rung)


@pytest.mark.parametrize(
    ("spec", "placement", "places"),
    [
        (ObjectSpec(), (0.002, 2.0), False),
        (ObjectSpec(size=(0.04, 0.014, 0.04)), (0.002, 2.0), True),
        (ObjectSpec(size=(0.04, 0.018, 0.04)), (0.002, 2.0), False),
        (ObjectSpec(size=(0.04, 0.018, 0.04)), (0.006, 2.0), True),
        (ObjectSpec(size=(0.04, 0.005, 0.04)), (0.0, 0.0), True),
        (ObjectSpec(size=(0.04, 0.04, 0.012)), (0.0, 0.0), True),
        (ObjectSpec(size=(0.005, 0.04, 0.04), yaw=np.pi / 2), (0.0, 0.0), True),
        (ObjectSpec(shape="cylinder", size=(0.014, 0.014, 0.04)), (0.002, 2.0), False),
    ],
)
def test_heat_knows_where_it_enters_a_box_whose_edge_may_be_near(spec, placement, places):
    for tolerance in (0.05, 0.02):
        config = SimulationConfig(objects=spec, placement=placement, tolerance=tolerance)
        body = config.body(config.stack, thermal.material("glass"), spec, FACTORS)
        assert body.anywhere is places
    if spec.size == ObjectSpec().size:
        config = SimulationConfig(objects=spec, placement=placement, mode="O", material="glass")
        assert not config.body(config.stack, thermal.material("glass"), spec, FACTORS).anywhere


@pytest.mark.parametrize(("size", "off"), [((0.04, 0.005, 0.04), 0.2), ((0.04, 0.04, 0.012), 1.5)])
def test_what_a_face_reaches_beyond_is_felt_by_default(size, off):
    """A bar narrower than the sensor's face, and an object lower than where the faces end."""
    drops = []
    for anywhere in ("auto", True, False):
        words = {"objects": ObjectSpec(size=size), "placement": (0.0, 0.0), "anywhere": anywhere}
        batch = GraspBatch(1, material="glass", task=ENDLESS, **words)
        batch.reset([0], [np.random.default_rng(0)])
        steps = [batch.step(action_of(0.0, 8.0, 0.0)[None]) for _ in range(100)]
        drops.append(steps[-1].info(0)["temperature_drop"][0])
    assert drops[0] == drops[1] and drops[2] - drops[0] > off


def test_a_fingertip_may_go_anywhere_on_a_mesh_as_often_as_it_likes(meshes):
    """Each new place tells the field anew, and it must not grow by that. Where the line between the pads is tilted far,
    the cube's edge touches the pad beside the sensor."""
    spec = ObjectSpec(shape="mesh", mesh=meshes["cube"], mass=0.05, friction=0.8)
    heat, rng = heat_of(grasp_body(spec, "plastic"), tolerance=0.05), np.random.default_rng(7)
    told = []
    for _ in range(60):
        place = np.array([-0.02, *rng.uniform(-0.012, 0.012, 2)])
        told += [step.drop[0, -1, 0] for step in press(heat, 0.1, place)]
    assert min(told) >= 0 and 0.5 < max(told) < 6
    assert len(heat._touches[0].body.patches) == 5
