"""Each heat sample of a control step sees its own substeps: nothing is felt before it happens."""

from __future__ import annotations

from typing import Any, Literal

import numpy as np
import pytest

from thermograsp import thermal
from thermograsp.envs import GraspBody, ObjectSpec
from thermograsp.envs.sensing.heat import GraspHeat
from thermograsp.envs.sensing.scene_heat import SceneHeat

STACK = thermal.sensor("seed")
SETTINGS: dict[str, Any] = {"tolerance": 0.1, "air": 0.0, "sensor_temperature": 36.0}
BAR = ObjectSpec(size=(0.01, 0.07, 0.024), mass=0.1, friction=0.8)
PLACES = np.array(BAR.element_places)
BESIDE = PLACES + [0.0, 0.024, 0.0]


def grasp_body(name: str = "glass", mode: Literal["T", "O"] = "T", *, anywhere: bool = False) -> GraspBody:
    return GraspBody(BAR, thermal.material(name), 24.0, mode, STACK, 2, anywhere=anywhere)


def heat_of(*bodies: GraspBody, samples: int = 2) -> GraspHeat:
    heat = GraspHeat(len(bodies), **SETTINGS, dt=0.01, samples=samples)
    heat.reset(range(len(bodies)), bodies)
    return heat


def pressed(*parts: tuple[slice, int], substeps: int = 10) -> np.ndarray:
    """(1, S, F) N: 10 N of a fingertip in the substeps of a slice."""
    force = np.zeros((1, substeps, 2))
    for when, tip in parts:
        force[0, when, tip] = 10.0
    return force


HALF, FULL = slice(5, None), slice(None)


@pytest.mark.parametrize("mode", ["T", "O"])
def test_a_touch_in_the_second_half_leaves_the_first_sample_untouched(mode):
    heat = heat_of(grasp_body(mode=mode))
    drop = heat.advance(pressed((HALF, 0)), PLACES[None]).drop[0]
    assert np.array_equal(drop[0], [0.0, 0.0])
    assert drop[1, 0] > 0.05 and abs(drop[1, 1]) < 1e-3


@pytest.mark.parametrize(("anywhere", "place"), [(False, PLACES), (False, BESIDE), (True, BESIDE)])
def test_a_second_touch_in_the_second_half_changes_no_first_sample(anywhere, place):
    """Also where it is a new patch, for which the network changes or the object's field is forgotten."""
    first = []
    for late in ((), ((HALF, 1),)):
        heat = heat_of(grasp_body(anywhere=anywhere))
        for _ in range(20):
            heat.advance(pressed((FULL, 0), (FULL, 1)), PLACES[None])
        heat.advance(pressed((FULL, 0)), PLACES[None])
        at = np.array([[PLACES[0], place[1]]])
        report = heat.advance(pressed((FULL, 0), *late), at)
        first.append(report.drop[0, 0])
    assert np.array_equal(*first)


@pytest.mark.parametrize("anywhere", [False, pytest.param(True, marks=pytest.mark.slow)])
def test_two_samples_in_one_step_are_those_of_two_steps(anywhere):
    """Bit for bit, with contacts that come and go, for one environment and for several."""
    rng = np.random.default_rng(3)
    halves, wholes = (
        heat_of(*[grasp_body(anywhere=anywhere)] * 3, samples=1),
        heat_of(*[grasp_body(anywhere=anywhere)] * 3),
    )
    alone = heat_of(grasp_body(anywhere=anywhere))
    for step in range(30):
        force = np.repeat(rng.choice([0.0, 3.0, 10.0], (3, 2, 2)), 5, axis=1)
        place = np.where(step % 10 < 5, PLACES, BESIDE) * np.ones((3, 1, 1))
        report = wholes.advance(force, place)
        assert np.array_equal(report.drop[1], alone.advance(force[1:2], place[1:2]).drop[0])
        for half in range(2):
            one = halves.advance(force[:, 5 * half : 5 * half + 5], place)
            assert np.array_equal(report.drop[:, half], one.drop[:, 0])
            assert np.array_equal(one.info["heat"], report.info["heat"]) == (half == 1) or step == 0


def test_a_substep_that_two_samples_share_counts_for_both_by_its_parts():
    """Of five substeps the third lies half in each sample."""
    shared = heat_of(grasp_body())
    drop = shared.advance(pressed((slice(2, 3), 0), substeps=5), PLACES[None]).drop[0]
    fine = heat_of(grasp_body()).advance(pressed((slice(4, 6), 0)), PLACES[None]).drop[0]
    assert drop == pytest.approx(fine, rel=1e-12) and drop[0, 0] > 0


def test_a_fingertip_goes_over_to_another_object_between_two_samples():
    """Its first sample is that of the object which it leaves, and the books of heat hold."""
    heats = [SceneHeat(1, 2, **SETTINGS, dt=0.01, samples=2) for _ in range(2)]
    for heat in heats:
        heat.reset([0], [[grasp_body("copper"), grasp_body("wood")]], np.full((1, 2), 36.0))
    place = np.tile(PLACES, (1, 2, 1, 1))
    stay = np.stack([pressed((FULL, 0)), pressed()], axis=1)
    drawn = 0.0
    for _ in range(10):
        report = [heat.advance(stay, place) for heat in heats][0].fingertips.info[0]
        drawn += report["drawn"].sum() * 0.02
    over = np.stack([pressed((slice(0, 5), 0)), pressed((HALF, 0))], axis=1)
    going, staying = (heat.advance(each, place) for heat, each in zip(heats, (over, stay), strict=True))
    assert np.array_equal(going.fingertips.drop[0, 0], staying.fingertips.drop[0, 0])
    assert going.fingertips.drop[0, 1, 0] < staying.fingertips.drop[0, 1, 0] - 0.01
    assert going.owner[0].tolist() == [1, 0]
    assert going.fingertips.events[0] == (("touch", "left"), ("release", "left"))
    for step in (going, *(heats[0].advance(stay[:, ::-1], place) for _ in range(5))):
        report = step.fingertips.info[0]
        drawn += report["drawn"].sum() * 0.02
        assert report["heat"].sum() == pytest.approx(drawn, rel=1e-9)
        assert abs(report["imbalance"]) <= 1e-9 * report["exchanged"]
