# mujoco ships no type stubs for its compiled names
# pyright: reportAttributeAccessIssue=false

from typing import Any

import mujoco
import numpy as np
import pytest

from thermograsp.envs import (
    Mechanics,
    ObjectSpec,
    SolverSettings,
    build_scene,
)
from thermograsp.errors import InvalidValueError, UnknownNameError


def test_settings_reach_the_model() -> None:
    settings = SolverSettings(
        0.0005, "implicitfast", "pyramidal", 7.0, "CG", 33, 4, (0.01, 0.9), (0.8, 0.9, 0.002), refsafe=False
    )
    model = build_scene((ObjectSpec(elements=(0.009, 0.003)),), settings=settings)
    option = model.opt
    assert (option.timestep, option.impratio) == (0.0005, 7.0)
    assert option.integrator == mujoco.mjtIntegrator.mjINT_IMPLICITFAST
    assert option.cone == mujoco.mjtCone.mjCONE_PYRAMIDAL and option.solver == mujoco.mjtSolver.mjSOL_CG
    assert (option.iterations, option.noslip_iterations) == (33, 4)
    assert option.disableflags == mujoco.mjtDisableBit.mjDSBL_REFSAFE
    for geom in ("object_0", "object_element_left", "object_element_right"):
        np.testing.assert_array_equal(model.geom(geom).solref, (0.01, 0.9))
        np.testing.assert_array_equal(model.geom(geom).solimp[:3], (0.8, 0.9, 0.002))


def test_a_batch_takes_the_settings_for_later_objects_too() -> None:
    mechanics = Mechanics(settings=SolverSettings(timestep=0.001, solref=(0.02, 1.0)))
    mechanics.reset(objects=[(ObjectSpec(shape="sphere"),)])
    model = mechanics.env_model(0)
    assert model.opt.timestep == 0.001
    np.testing.assert_array_equal(model.geom("object_0").solref, (0.02, 1.0))
    assert model.geom("object_0").type == mujoco.mjtGeom.mjGEOM_SPHERE


def test_the_lift_covers_its_way_in_the_time_that_its_rate_says() -> None:
    for settings in (SolverSettings(), SolverSettings(timestep=0.0005)):
        mechanics = Mechanics(settings=settings)
        substeps = round(0.02 / settings.timestep)
        for _ in range(30):
            mechanics.step(np.full(1, 0.08), np.zeros(1), np.full(1, 0.05), substeps)
        assert mechanics.height[0] == pytest.approx(0.03, abs=0.002)


@pytest.mark.parametrize(
    ("wrong", "error", "message"),
    [
        ({"timestep": 0.0}, InvalidValueError, "timestep"),
        ({"integrator": "euler"}, UnknownNameError, "did you mean 'Euler'"),
        ({"cone": "round"}, UnknownNameError, "cone"),
        ({"solver": "QP"}, UnknownNameError, "solver"),
        ({"impratio": -1.0}, InvalidValueError, "impratio"),
        ({"iterations": 0}, InvalidValueError, "a whole number, 1 or above"),
        ({"noslip_iterations": 1.5}, InvalidValueError, "a whole number, 0 or above"),
        ({"solref": (0.005, -1.0)}, InvalidValueError, "solref"),
        ({"solimp": (0.99, 0.9, 0.001)}, InvalidValueError, "d0 <= d1"),
        ({"solimp": (0.9, 1.0, 0.001)}, InvalidValueError, "below 1"),
    ],
)
def test_what_cannot_be_is_refused(wrong: dict[str, Any], error: type[Exception], message: str) -> None:
    with pytest.raises(error, match=message):
        SolverSettings(**wrong)
