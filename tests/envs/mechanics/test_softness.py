"""How far pads sink into an object says nothing of its mass."""

from typing import Literal

import numpy as np
import pytest

from thermograsp.envs import ObjectSpec, SolverSettings
from thermograsp.envs.mechanics.batch import Mechanics

DENSITIES = (2.0, 16.0, 944.0, 8530.0, 19300.0)  # kg/m3: foam, polystyrene, butter, brass, gold
SIDE = 0.06  # m, along x


def held(force: float) -> np.ndarray:
    """(B,) m by which the pads' distance falls short of the boxes' width, one box a density, held in its middle."""
    specs = [ObjectSpec(size=(SIDE, 0.07, 0.07), density=density) for density in DENSITIES]
    mechanics = Mechanics((specs[0],), len(specs))
    mechanics.reset(objects=[(spec,) for spec in specs])
    command = np.zeros(len(specs)), np.full(len(specs), force), np.zeros(len(specs))
    for _ in range(60):
        mechanics.step(*command)
    return SIDE - mechanics.opening


@pytest.mark.parametrize("force", [2.0, 10.0, 30.0])
def test_depth_is_that_of_a_cube_of_a_tenth_of_a_kilogram(force: float) -> None:
    """At rest R f = k d r at each of a pad's four corners, with R = (1 - d)/d (w1 + w2) and k = 1/(d1 T)^2 (MuJoCo's
    documentation, "Computation: Constraint model"). It holds as it stands for the lightest. The discrete integrator
    lets heavier ones sink less, by up to a third of this depth, some micrometres. Before contacts were equally soft the
    depth went with 1/mass: 10 N came .7 mm into polystyrene and 7 um into brass."""
    settings = SolverSettings()
    weakest, strongest, width = settings.solimp
    mechanics = Mechanics((ObjectSpec(),))
    tip = mechanics.model.body("tip_left").id
    compliance = 1 / ObjectSpec().weight + mechanics.model.body_invweight0[tip, 0]
    depth = 0.0
    for _ in range(50):
        d = weakest + (strongest - weakest) * 2 * (depth / width) ** 2
        stiffness = d / (1 - d) / compliance * d / (strongest * settings.solref[0]) ** 2
        depth = force / 4 / stiffness
    found = held(force) / 2
    assert found[0] == pytest.approx(depth, rel=0.02)
    assert (found > 0.6 * depth).all() and (found < 1.02 * depth).all()


@pytest.mark.parametrize("shape", ["box", "cylinder", "sphere"])
def test_heavy_and_light_rest_on_the_table(shape: Literal["box", "cylinder", "sphere"]) -> None:
    """Gold sinks less than .2 mm into the table, and moves by less than 20 um in a second."""
    specs = [ObjectSpec(shape=shape, size=(SIDE, SIDE, SIDE), density=density) for density in DENSITIES]
    mechanics = Mechanics((specs[0],), len(specs))
    mechanics.reset(objects=[(spec,) for spec in specs])
    command = np.full(len(specs), 0.085), np.full(len(specs), 10.0), np.zeros(len(specs))
    for _ in range(50):
        mechanics.step(*command)
    before = mechanics.object_pose
    assert not any(mechanics.failure)
    assert (np.abs(before[:, 0, 2] - SIDE / 2) < 0.0002).all()
    for _ in range(50):
        mechanics.step(*command)
    assert np.abs(mechanics.object_pose - before)[:, 0, :3].max() < 2e-5


def test_row_by_row_contacts_stay_equally_soft() -> None:
    """Also where sizes and masses are put into a compiled scene, and where scenes are compiled."""
    first = ObjectSpec()
    for elements in (None, (0.009, 0.0035)):
        specs = [
            ObjectSpec(size=(0.03 + 0.01 * k, 0.04, 0.04), density=density, elements=elements)
            for k, density in enumerate(DENSITIES)
        ]
        mechanics = Mechanics((specs[0],), len(specs))
        mechanics.reset(objects=[(spec,) for spec in specs])
        reference = 1 / first.weight
        for row in range(len(specs)):
            model = mechanics.env_model(row)
            assert model.body_invweight0[model.body("object").id, 0] == pytest.approx(reference)
