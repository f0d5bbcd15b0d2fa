"""Heat of two objects and the fingertips that go from one to the other: books, owners, states."""

from __future__ import annotations

import numpy as np
import pytest

from thermograsp import thermal
from thermograsp.envs import GraspBody, ObjectSpec
from thermograsp.envs.sensing.heat import GraspHeat
from thermograsp.envs.sensing.scene_heat import SceneHeat

STACK = thermal.sensor("seed")
SETTINGS = {"tolerance": 0.05, "air": 0.0, "dt": 0.01, "samples": 2, "sensor_temperature": 36.0}


def grasp_body(name: str, celsius: float = 24.0) -> GraspBody:
    return GraspBody(ObjectSpec(mass=0.1, friction=0.8), thermal.material(name), celsius, "T", STACK)


def pair_heat(*bodies: GraspBody) -> SceneHeat:
    heat = SceneHeat(1, 2, **SETTINGS)
    heat.reset([0], [bodies], np.full((1, 2), 36.0))
    return heat


def step(heat: SceneHeat, left: int | None, right: int | None, newton: float = 10.0):
    """Each fingertip on one of the objects, or on none."""
    force = np.zeros((1, 2, 10, 2))
    for tip, number in enumerate((left, right)):
        if number is not None:
            force[0, number, :, tip] = newton
    return heat.advance(force, np.tile(grasp_body("glass").spec.element_places, (1, 2, 1, 1)))


COURSES = {
    "one after the other": [(0, 0)] * 60
    + [(None, None)] * 20
    + [(1, 1)] * 60
    + [(None, None)] * 5
    + [(0, 0)] * 30,
    "one each": [(0, 1)] * 80 + [(1, 0)] * 40,
    "straight over": [(0, 0)] * 40 + [(1, 1)] * 40 + [(0, 0)] * 1 + [(1, 1)] * 1 + [(0, None)] * 20,
}


@pytest.mark.parametrize("course", COURSES)
@pytest.mark.parametrize("names", [("copper", "glass"), ("cotton", "aluminium")])
def test_what_leaves_the_thermostats_is_what_elements_and_objects_gain(names, course):
    heat = pair_heat(grasp_body(names[0]), grasp_body(names[1], 20.0))
    drawn = exchanged = 0.0
    for left, right in COURSES[course]:
        report = step(heat, left, right).fingertips.info[0]
        drawn += report["drawn"].sum() * 0.02
        exchanged += np.abs(report["drawn"]).sum() * 0.02
        assert report["heat"].sum() == pytest.approx(drawn, abs=1e-9 * exchanged)
        assert abs(report["imbalance"]) <= 1e-9 * report["exchanged"]
        for name in ("sensor_surface", "object_surface"):
            assert np.all((report[name] > 20 - 0.05) & (report[name] < 36 + 0.05))
    assert exchanged > 0.1


def test_thermostats_that_drift_are_in_the_books():
    heat = pair_heat(grasp_body("copper"), grasp_body("glass"))
    drawn, celsius = 0.0, 36.0
    for k, (left, right) in enumerate(COURSES["one after the other"]):
        report = step(heat, left, right).fingertips.info[0]
        drawn += report["drawn"].sum() * 0.02
        assert report["heat"].sum() == pytest.approx(drawn, rel=1e-9)
        celsius -= 0.02 if k < 80 else -0.01
        heat.set_thermostats(np.full((1, 2), celsius))


def test_until_it_goes_over_it_is_the_heat_of_one_object():
    alone = GraspHeat(1, **SETTINGS)
    alone.reset([0], [grasp_body("glass")])
    for number in (0, 1):
        heat = pair_heat(grasp_body("glass"), grasp_body("glass"))
        alone.reset([0], [grasp_body("glass")])
        for pressed in [False] * 3 + [True] * 60 + [False] * 20 + [True] * 10:
            on = number if pressed else None
            report = step(heat, on, on)
            one = alone.advance(
                np.full((1, 10, 2), 10.0 * pressed), grasp_body("glass").spec.element_places[None]
            )
            assert np.array_equal(report.fingertips.drop, one.drop)
            assert np.array_equal(report.fingertips.info["heat"], one.info["heat"])
            assert report.objects["object_temperature"][0, 1 - number] == 24.0


def test_a_second_object_of_the_same_kind_meets_the_fingertip_as_it_was_left():
    """The same field on the fingertip and a fresh object: what one network gives whose object is put back."""
    heat, alone = pair_heat(grasp_body("glass"), grasp_body("glass")), GraspHeat(1, **SETTINGS)
    alone.reset([0], [grasp_body("glass")])
    place = grasp_body("glass").spec.element_places[None]
    for on in [0] * 50 + [None] * 10:
        step(heat, on, on)
        alone.advance(np.full((1, 10, 2), 0.0 if on is None else 10.0), place)
    orders = thermal.Orders.parse(alone.rung(0).removeprefix("network:"))
    alone._state[0, : orders.even + (orders.odd or 0)] = 0.0
    for _ in range(60):
        report = step(heat, 1, 1)
        one = alone.advance(np.full((1, 10, 2), 10.0), place)
        assert np.allclose(report.fingertips.drop, one.drop, rtol=0, atol=1e-12)


def test_a_fingertip_on_both_belongs_to_the_one_it_presses_harder():
    heat = pair_heat(grasp_body("copper"), grasp_body("glass"))
    force = np.zeros((1, 2, 10, 2))
    force[0, 0], force[0, 1] = 3.0, 8.0
    report = heat.advance(force, np.tile(grasp_body("glass").spec.element_places, (1, 2, 1, 1)))
    assert report.objects["object_temperature"][0, 0] == 24.0
    assert report.objects["object_temperature"][0, 1] > 24.0
    assert not report.objects["conductance"][0, 0].any() and report.objects["conductance"][0, 1].all()
