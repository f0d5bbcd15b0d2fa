"""Boxes by heat kernels: any size, any place, any part of the sensor's face, without a search."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from thermograsp import thermal
from thermograsp.envs import EVERYTHING, GraspBatch, GraspBody, GraspTask, ObjectSpec
from thermograsp.envs.sensing import boxes as boxes_module
from thermograsp.envs.sensing.heat import GraspHeat
from thermograsp.envs.sensing.places import MOST_PLACES, Place, Touched
from thermograsp.thermal.kernels import Detail, Patches, touch_sides
from thermograsp.thermal.network.coupling import propagator, step

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
CUBE = ObjectSpec(mass=0.1, friction=0.8)
MIDDLES = CUBE.element_places


def grasp_body(spec: ObjectSpec = CUBE, name: str = "glass", **more) -> GraspBody:
    return GraspBody(spec, thermal.material(name), 24.0, "T", STACK, anywhere=True, **more)


def heat_of(*bodies: GraspBody, **settings: float) -> GraspHeat:
    heat = GraspHeat(len(bodies), **{**SETTINGS, **settings})
    heat.reset(range(len(bodies)), bodies, np.full((len(bodies), 2), 36.0))
    return heat


def press(heat: GraspHeat, seconds: float, *places: np.ndarray | None, newton: float = 10.0):
    """Both fingertips on each row's object at places (2, 3) m, apart where None. Returns what each step told."""
    force, place = np.zeros((len(places), 10, 2)), np.zeros((len(places), 2, 3))
    for row, at in enumerate(places):
        if at is not None:
            force[row], place[row] = newton, at
    return [heat.advance(force, place) for _ in range(round(seconds / STEP))]


@pytest.mark.parametrize("name", ["cotton", "wood", "glass", "stainless_steel", "aluminium"])
def test_drops_are_those_of_the_searched_network_within_the_tolerance(name):
    """A cube that is pressed in the middle of its faces, one fingertip earlier than the other, and let go."""
    heat = heat_of(grasp_body(name=name))
    geometry = thermal.Geometry(STACK, thermal.material(name), "T", 81e-6, "square", (0.04, 0.04, 0.04), 2)
    demand = thermal.Demand(0.005, 12.0)
    searched = thermal.network_for(geometry, demand).system
    other = propagator(searched.rates, searched.ports, STEP / 2)
    x, drops, expected = np.zeros((1, len(searched.rates))), [], []
    difference = np.zeros((1, searched.ports.shape[1]))
    difference[0, :: searched.modes] = 12.0
    for k in range(400):
        force = np.zeros((1, 10, 2))
        force[0, :, 0], force[0, :, 1] = 10.0 * (k < 300), 10.0 * (20 <= k < 300)
        reply = heat.advance(force, MIDDLES[None])
        conductance = np.repeat(reply.info["conductance"] * reply.info["area"], searched.modes, axis=1)
        for _ in range(2):
            x, _ = step(other, x, conductance, difference)
            expected.append(searched.drop @ x[0])
        drops.append(reply.drop[0])
    drops, expected = np.concatenate(drops), np.array(expected)
    # tolerances are promised from .05 s after a touch on
    late = np.ones(len(drops), bool)
    late[[*range(5), *range(40, 45)]] = False
    assert np.abs(drops - expected)[late].max() < 0.05
    assert np.abs(drops).max() > 0.2


@pytest.mark.parametrize("name", ["glass", "stainless_steel", "gold", "aluminium"])
@pytest.mark.parametrize("size", [(0.04, 0.05, 0.06), (0.003, 0.07, 0.03)])
def test_few_places_stand_for_those_under_fingertips(monkeypatch: pytest.MonkeyPatch, name: str, size):
    """What flows under a fingertip there is what flows at its own place, within a fourth of the tolerance."""
    place = np.array([[-size[0] / 2, 0.0048, 0.0061], [size[0] / 2, 0.0052, 0.0064]])
    grasped = grasp_body(ObjectSpec(size=size, mass=0.1, friction=0.8), name)
    heat = heat_of(grasped, air=5.0)
    found = [step.drop for step in press(heat, 3.0, place)]
    (prints,) = heat._boxes._prints.values()
    exact = tuple((each.place.face, each.foot.centre, each.foot.half, each.tip) for each in prints)
    monkeypatch.setattr(boxes_module, "_stand_ins", lambda *_: exact)
    expected = [step.drop for step in press(heat_of(grasped, air=5.0), 3.0, place)]
    assert 0 < np.abs(np.subtract(found, expected)).max() < 0.0012 * 12


def test_books_hold_whatever_a_fingertip_does():
    """It slides over faces and edges, leaves and comes back, in air, with more places than are remembered."""
    rng = np.random.default_rng(1)
    spec = ObjectSpec(size=(0.02, 0.03, 0.024), mass=0.1, friction=0.8)
    warm = replace(grasp_body(spec, "aluminium"), ambient=22.0)
    heat = heat_of(warm, air=15.0)
    gone = exchanged = 0.0
    for k in range(60):
        place = np.array([[-0.01, 0, 0], [0.01, 0, 0]]) + [0, *rng.uniform(-0.018, 0.018, 2)] * np.array(
            [[1], [1]]
        )
        if k % 3:
            place[:, 1] += 0.001 * k % 0.004
        for reply in press(heat, 0.1, place if rng.random() < 0.8 else None):
            row = reply.info[0]
            gone += STEP * (row["drawn"].sum() - row["air_loss"])
            assert abs(row["imbalance"]) < 1e-10 * max(row["exchanged"], 1.0)
            assert row["heat"].sum() == pytest.approx(gone, abs=1e-9)
            assert 22 - 0.05 < row["object_temperature"] < 36
            exchanged = row["exchanged"]
    assert len(heat._boxes.touched(0).places) == MOST_PLACES
    assert exchanged > 1.0


def test_a_field_that_slides_away_is_found_where_it_was():
    bar = ObjectSpec(size=(0.01, 0.07, 0.024), mass=0.1, friction=0.8)
    heat = heat_of(*[grasp_body(bar) for _ in range(4)])
    left = np.array([[-0.005, 0.0, 0.0], [0.005, 0.0, 0.0]])
    press(heat, 5.0, left, left, left, left)
    press(heat, 1.0, None, left + [0, 0.02, 0], None, left + [0, 0.02, 0])
    press(heat, 2.0, None, None, None, None)
    for row in (2, 3):  # the last ones' objects are fresh once more, their fingertips as they are
        heat._state[row, : heat._of_tip(row, 0).start] = 0.0
    reply = press(heat, 0.5, left, left, left, left)
    warm, slid, fresh, other = (reply[-1].drop[row, -1, 0] for row in range(4))
    assert fresh - warm > 0.1 and other - slid > 0.1


def networks_of(name: str, size: tuple[float, float, float], along: list[float], plan, conductance: float):
    """Drops (n,) K of one fingertip every STEP / 2 while it is at one of the places (or None) for so many seconds, by a
    network that is exact at ten moments and has states of its own for just these places. along: m, of the places on the
    first face, from its first edge, in the middle of its height."""
    count, p = len(along), 3
    middles = np.array([[each, size[2] / 2] for each in along])
    patches = Patches(np.zeros(count, int), middles, np.full((count, 2), STACK.width / 2))
    face = (0.0, STACK.width), (0.0, STACK.width)
    tips, box = touch_sides(
        thermal.material(name),
        size,
        0.0,
        patches,
        [(STACK, face)] * count,
        Detail(10, p, 1 / 60),
        shared=True,
    )
    element = tips[0].side
    rates, inner = np.concatenate((box.rates, element.rates)), len(box.rates)
    drop = np.concatenate((np.zeros(inner), element.outputs["drop"]))
    x, found = np.zeros((1, len(rates))), []
    for seconds, place in plan:
        ports, through = np.zeros((len(rates), p)), np.zeros((1, p))
        ports[inner:] = -element.ports
        if place is not None:
            ports[:inner] = box.ports[:, place * p : (place + 1) * p]
            through[:] = conductance * STACK.face_area
        of_step = propagator(rates, ports, STEP / 2)
        for _ in range(round(2 * seconds / STEP)):
            x, _flow = step(of_step, x, through, np.array([[12.0, 0.0, 0.0]]))
            found.append(drop @ x[0])
    return np.array(found)


def boxes_of(name: str, size: tuple[float, float, float], along: list[float], plan):
    """(the same by the environments' network, W/(m2 K) of the contact)."""
    heat = heat_of(grasp_body(ObjectSpec(size=size, mass=0.1, friction=0.8), name, fingertips=1))
    found, largest = [], 0.0
    for seconds, place in plan:
        at = None if place is None else np.array([[-size[0] / 2, along[place] - size[1] / 2, 0.0], [9.0] * 3])
        for reply in press(heat, seconds, at):
            found += reply.drop[0, :, 0].tolist()
            largest = max(largest, float(reply.info["conductance"][0, 0]))
    return np.array(found), largest


@pytest.mark.parametrize("name", ["glass", "wood"])
@pytest.mark.parametrize("distance", [0.0011, 0.0043, 0.0091])
def test_a_second_touch_beside_a_warm_place_is_right(name, distance):
    """Neither place is on the lattice of fresh ones. A model that knew the mean temperature alone would be .08 K off at
    the least."""
    size, along = (0.01, 0.06, 0.024), [0.0282, 0.0282 + distance]
    plan = [(4.0, 0), (1.0, None), (1.5, 1)]
    found, conductance = boxes_of(name, size, along, plan)
    expected = networks_of(name, size, along, plan, conductance)
    fresh = boxes_of(name, size, along[1:], [(1.5, 0)])[0]
    again = slice(-140, None)
    assert np.abs(found - expected)[again].max() < 0.03
    assert np.abs(fresh[-140:] - expected[again]).max() > 0.08


def test_heat_stays_where_a_fingertip_slides_over_more_places_than_are_remembered():
    size, along = (0.01, 0.06, 0.024), (0.0255 + 0.00101 * np.arange(8)).tolist()
    plan = [(2.0, 0), *((0.1, place) for place in range(1, 8)), (1.0, None), (1.0, 0)]
    found, conductance = boxes_of("glass", size, along, plan)
    expected = networks_of("glass", size, along, plan, conductance)
    back = slice(-90, None)
    assert np.abs(found - expected)[back].max() < 0.05
    fresh = boxes_of("glass", size, along[:1], [(1.0, 0)])[0]
    assert np.abs(fresh[-90:] - expected[back]).max() > 0.5


def test_the_place_given_up_is_the_one_nearest_to_its_heir_by_warmth():
    size, width = (0.01, 0.07, 0.024), STACK.width
    places = [Place(0, (y, 0.012)) for y in (0.02, 0.03, 0.0312, 0.05)]
    touched = Touched(tuple(places), (3, -1))
    new = Place(0, (0.06, 0.012))
    moved, given_up = touched.moved(0, new, (5.0, 2.0, 1.0, 3.0), size, width)
    assert given_up == (2, 1) and moved.contacts == (2, -1)
    assert moved.places[2].middle == pytest.approx(new.middle)
    _, alone = touched.moved(0, new, (1e-3, 2.0, 50.0, 3.0), size, width)
    assert alone == (0, -1)  # so little that it does not matter that nothing is near
    _, near = touched.moved(0, Place(0, (0.0216, 0.012)), (0.1, 2.0, 50.0, 3.0), size, width)
    assert near == (0, 0)


def test_a_row_does_not_depend_on_the_others_and_a_state_goes_on_bit_for_bit():
    spec = ObjectSpec(size=(0.03, 0.024, 0.018), mass=0.1, friction=0.8)
    course = [MIDDLES, MIDDLES + [0, 0.011, 0], None, MIDDLES + [0, 0.011, 0.008], MIDDLES]
    together = heat_of(grasp_body(spec), grasp_body(spec, "aluminium"), grasp_body(), air=5.0)
    alone, states, seen = heat_of(grasp_body(spec), air=5.0), [], []
    for k, place in enumerate(course):
        states.append(alone.state([0]))
        seen.append([])
        many = press(together, 0.2, place, course[-1 - k], MIDDLES)
        for a, b in zip(press(alone, 0.2, place), many, strict=True):
            assert np.array_equal(a.drop[0], b.drop[0]) and a.info[0].tobytes() == b.info[0].tobytes()
            seen[-1].append(a.info[0].tobytes())
    other = heat_of(grasp_body(name="cork"), air=5.0)
    for heat in (other, alone):
        heat.set_state([0], states[2])
        for place, reply in zip(course[2:], seen[2:], strict=True):
            assert [step.info[0].tobytes() for step in press(heat, 0.2, place)] == reply


def test_drawn_sizes_vector_and_single_agree_bit_for_bit():
    config = {"randomize": EVERYTHING, "task": ENDLESS, "anywhere": True, "tolerance": 0.05}
    many = GraspBatch(2, **config)
    many.reset(range(2), [np.random.default_rng(i) for i in range(2)])
    singles = [GraspBatch(1, **config) for _ in range(2)]
    for i, single in enumerate(singles):
        single.reset([0], [np.random.default_rng(i)])
    for _ in range(80):
        together = many.step(grasp_action(many))
        for row, single in enumerate(singles):
            for key, value in single.step(grasp_action(single)).observation.items():
                assert np.array_equal(value[0], together.observation[key][row])


@pytest.mark.parametrize("name", ["cotton", "glass", "stainless_steel", "aluminium"])
def test_a_box_of_any_size_is_touched_in_the_middle_as_one_whose_network_is_searched(name):
    """Pressed, let go and pressed beside the first place, where only the object's mean is remembered."""
    spec = ObjectSpec(size=(0.0331, 0.0417, 0.038), mass=0.1, friction=0.8)
    searched = GraspBody(spec, thermal.material(name), 24.0, "T", STACK, ambient=20.0)
    heat = heat_of(replace(searched, any_size=True), searched, tolerance=0.05, air=5.0)
    assert heat.rung(0).startswith("kernels") and heat.rung(1).startswith("network")
    middles, found, events = spec.element_places, [], []
    for seconds, at in ((2.0, middles), (0.5, None), (2.0, middles + [0, 0.008, 0])):
        reply = press(heat, seconds, at, at)
        found += [each.drop for each in reply]
        events.append([row["events"].tolist() for row in reply[0].info])
        for each in reply:
            kernels = each.info[0]
            assert abs(kernels["imbalance"]) < 1e-10 * max(kernels["exchanged"], 1.0)
    assert all(kernels == network for kernels, network in events)
    drops = np.concatenate(found, axis=1)
    # tolerances are promised from .05 s after a touch on
    late = np.ones(drops.shape[1], bool)
    for begun in (0, 200, 250):
        late[begun : begun + 5] = False
    assert np.abs(drops[0] - drops[1])[late].max() < 0.05
    assert np.abs(drops).max() > 0.2 and len(heat._boxes.touched(0).places) == 2


def test_everything_drawn_searches_nothing_and_keeps_nothing(monkeypatch: pytest.MonkeyPatch):
    """As shipped but for what is drawn."""
    monkeypatch.setattr("thermograsp.envs.sensing.networks.network_for", None)
    batch = GraspBatch(3, randomize=EVERYTHING)
    for episode in range(3):
        batch.reset(range(3), [np.random.default_rng(3 * episode + i) for i in range(3)])
        for _ in range(70):
            batch.step(grasp_action(batch))
        assert batch.reading is not None
        truth = batch.reading.truth
        assert all(rung.startswith("kernels") for rung in truth["rung"])
        assert np.abs(truth["temperature_drop"]).min() > 0


def test_however_many_sizes_and_places_are_drawn_what_is_kept_stays_the_same():
    heat, rng, kept = heat_of(grasp_body(), grasp_body()), np.random.default_rng(0), []
    for episode in range(40):
        size = tuple(rng.uniform(0.01, 0.05, 3))
        spec = ObjectSpec(size=size, mass=0.1, friction=0.8)
        heat.reset([episode % 2], [grasp_body(spec)], np.full((1, 2), 36.0))
        places = spec.element_places + [0, *rng.uniform(-0.5, 0.5, 2) * size[1:]]
        press(heat, 0.04, *([places] * 2))
        kept.append([array.nbytes for array in heat._boxes.tables if isinstance(array, np.ndarray)])
        assert kept[0] == kept[-1] and len(heat._boxes._bodies) == 2
        assert not heat._networks.systems
    assert boxes_module._UNDER.most == boxes_module._KEPT


def test_a_face_that_covers_a_part_of_the_sensor_s_is_taken_by_its_rectangle():
    """Half on the face is not the same as a contact of half the area in the middle."""
    heat = heat_of(grasp_body(name="aluminium"))
    press(heat, 0.02, MIDDLES + [0, 0, 0.0195])
    touched = heat._boxes.touched(0)
    covered = touched.places[touched.contacts[0]].covered(CUBE.size, STACK.width)
    assert covered[0] == (0.0, 0.009) and covered[1] == (0.0, pytest.approx(0.005, abs=1e-4))
