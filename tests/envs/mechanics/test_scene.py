# mujoco ships no type stubs for its compiled names
# pyright: reportAttributeAccessIssue=false

import mujoco
import numpy as np
import pytest

from thermograsp.envs.bodies.object_spec import ObjectSpec
from thermograsp.envs.limits import TIPS
from thermograsp.envs.mechanics.scene import build_scene, contact_sensor
from thermograsp.errors import InvalidValueError, UnknownNameError


def test_every_element_has_a_name_and_two_cameras_see_the_scene():
    model = build_scene((ObjectSpec(), ObjectSpec("other", "sphere", position=(0.0, 0.08))))
    kinds = {
        "body": model.nbody, "joint": model.njnt, "geom": model.ngeom, "site": model.nsite, "camera": model.ncam,
        "light": model.nlight, "actuator": model.nu, "sensor": model.nsensor, "tendon": model.ntendon,
        "equality": model.neq, "material": model.nmat, "texture": model.ntex,
    }  # fmt: skip
    nameless = [(kind, i) for kind, n in kinds.items() for i in range(n) if not getattr(model, kind)(i).name]
    assert not nameless
    assert model.ncam >= 2


def test_sensors_are_one_per_fingertip_and_object():
    names = ("object", "other")
    model = build_scene(tuple(ObjectSpec(name) for name in names))
    assert model.nsensor == len(TIPS) * len(names)
    for tip in TIPS:
        for name in names:
            assert model.sensor(contact_sensor(tip, name)).dim[0] == 7


@pytest.mark.parametrize("shape", ["box", "cylinder", "sphere"])
def test_mass_and_inertia_are_those_of_the_uniform_solid(shape):
    size = {"box": (0.03, 0.04, 0.06), "cylinder": (0.03, 0.03, 0.07), "sphere": (0.04, 0.04, 0.04)}[shape]
    spec = ObjectSpec(shape=shape, size=size, density=2500.0)
    body = build_scene((spec,)).body("object")
    half = np.array(size) / 2
    reference = mujoco.MjSpec()
    geom = reference.worldbody.add_body(name="b").add_geom(density=2500.0)
    geom.type, geom.size = {
        "box": (mujoco.mjtGeom.mjGEOM_BOX, half),
        "cylinder": (mujoco.mjtGeom.mjGEOM_CYLINDER, (half[0], half[2], 0)),
        "sphere": (mujoco.mjtGeom.mjGEOM_SPHERE, (half[0], 0, 0)),
    }[shape]
    expected = reference.compile().body("b")
    assert body.mass[0] == pytest.approx(expected.mass[0], rel=1e-12)
    assert sorted(body.inertia) == pytest.approx(sorted(expected.inertia), rel=1e-12)


def test_turned_inertia_axes_are_the_right_ones():
    spec = ObjectSpec(size=(0.02, 0.04, 0.08))
    model = build_scene((spec,))
    data = mujoco.MjData(model)
    mujoco.mj_forward(model, data)
    axes = data.body("object").ximat.reshape(3, 3)
    matrix = axes @ np.diag(model.body("object").inertia) @ axes.T
    assert matrix == pytest.approx(spec.inertia[1], rel=1e-9, abs=1e-15)


def test_the_pads_meet_the_middle_of_the_side_faces():
    for height in (0.03, 0.04, 0.12):
        model = build_scene((ObjectSpec(size=(0.04, 0.04, height)),))
        assert model.body("wrist").pos[2] == pytest.approx(height / 2)
    assert ObjectSpec(size=(0.04, 0.04, 0.01)).grasp_height == pytest.approx(
        0.012
    )  # the pads stay off the table
    assert ObjectSpec(size=(0.04, 0.04, 0.3)).grasp_height == pytest.approx(
        0.207
    )  # the palm stays off the top


@pytest.mark.parametrize(
    ("wrong", "message"),
    [
        ({"size": (0.084, 0.04, 0.04)}, "84.0 mm wide"),
        ({"size": (0.08302, 0.04, 0.04)}, "83.02 mm wide .* at most 83 mm"),
        ({"size": (0.08, 0.08, 0.04), "yaw": 0.3}, "turn it"),
        ({"size": (0.04, -0.04, 0.04)}, "size"),
        ({"elements": (0.009, 0.003), "yaw": 1.5}, "which no pad meets"),
        ({"mass": 0.0}, "mass"),
        ({"mass": 1.0, "density": 1.0}, "one of them"),
        ({"friction": float("nan")}, "friction"),
        ({"shape": "sphere", "size": (0.04, 0.04, 0.05)}, "equal"),
        ({"shape": "mesh"}, "file"),
        ({"mesh": "a.stl"}, "file"),
    ],
)
def test_impossible_objects_are_refused(wrong, message):
    with pytest.raises(InvalidValueError, match=message):
        ObjectSpec(**wrong)


def test_unknown_shape_suggests_the_near_one():
    with pytest.raises(UnknownNameError, match="cylinder"):
        ObjectSpec(shape="cylindr")  # pyright: ignore[reportArgumentType]


@pytest.mark.parametrize("name", ["", "world", "wrist"])
def test_a_name_that_is_none_or_the_gripper_s_is_refused(name):
    with pytest.raises(InvalidValueError, match="a name of its own"):
        build_scene((ObjectSpec(name),))


def test_a_name_given_twice_is_refused():
    with pytest.raises(InvalidValueError, match="every name once"):
        build_scene((ObjectSpec(), ObjectSpec()))
