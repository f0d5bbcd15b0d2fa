"""A fingertip on a body of anybody's spec, and the flat faces that it is put on."""

# mujoco ships no type stubs for its compiled names
# pyright: reportAttributeAccessIssue=false

from __future__ import annotations

from typing import Any

import mujoco
import numpy as np
import pytest

from thermograsp.assets import asset
from thermograsp.envs import fit_fingertip
from thermograsp.errors import GripperError, UnknownNameError
from thermograsp.touch import flat_faces, largest_face, triangles

from ..synthetic_grippers import LONE_JAW, ROUND, slides


def spec_of(text: str) -> mujoco.MjSpec:
    return mujoco.MjSpec.from_string(text)


def body_with(geom: str) -> mujoco.MjModel:
    text = (
        f"<mujoco><worldbody><body name='b' pos='1 2 3' euler='10 20 30'>{geom}</body></worldbody></mujoco>"
    )
    return mujoco.MjModel.from_xml_string(text)


def test_triangles_of_a_box_enclose_its_volume():
    """The divergence theorem: the sum of the tetrahedra to any point is the volume, if all triangles look outwards."""
    shape = triangles(body_with("<geom type='box' size='.01 .02 .03' pos='.1 0 0' euler='9 5 40'/>"), 0)
    enclosed = np.einsum("ij,ij->i", shape[:, 0], np.cross(shape[:, 1], shape[:, 2])).sum() / 6
    assert enclosed == pytest.approx(8 * 0.01 * 0.02 * 0.03, rel=1e-12)


@pytest.mark.parametrize(
    ("geom", "area"),
    [
        ("<geom type='box' size='.01 .02 .03' pos='.1 0 0' euler='0 0 40'/>", 4 * 0.01 * 0.02),
        ("<geom type='cylinder' size='.01 .02' pos='.1 0 0'/>", np.pi * 1e-4),
    ],
)
@pytest.mark.parametrize("sign", [1, -1])
def test_faces_of_primitives(geom: str, area: float, sign: int):
    shape, up = triangles(body_with(geom), 0), np.array([0.0, 0.0, float(sign)])
    face = largest_face(flat_faces([("g", shape)], up), up)
    assert face is not None
    assert face.area == pytest.approx(area, rel=0.01)
    assert face.normal == pytest.approx(up, abs=1e-9)


@pytest.mark.parametrize(
    "geom", ["<geom type='sphere' size='.01'/>", "<geom type='capsule' size='.01 .02'/>"]
)
def test_what_is_round_has_no_face(geom: str):
    assert not len(triangles(body_with(geom), 0))


def test_the_face_of_a_rough_mesh_is_found_among_others():
    """A block as a mesh of 2 x 300 random triangles a side, its front uneven by a hundredth of a millimetre."""
    rng = np.random.default_rng(3)
    n = 12
    y, z = np.meshgrid(np.linspace(-0.01, 0.01, n), np.linspace(-0.02, 0.02, n))
    front = np.stack([0.005 + rng.uniform(-1e-5, 1e-5, y.size), y.ravel(), z.ravel()], axis=1)
    a = np.arange(n * n).reshape(n, n)
    quads = [(a[i, j], a[i, j + 1], a[i + 1, j + 1], a[i + 1, j]) for i in range(n - 1) for j in range(n - 1)]
    shape = np.array([front[[p, q, r]] for p, q, r, s in quads] + [front[[p, r, s]] for p, q, r, s in quads])
    side = np.array([[[0, 0.01, -0.02], [0.005, 0.01, 0.02], [0.005, 0.01, -0.02]]])
    way = np.array([1.0, 0.0, 0.0])
    face = largest_face(flat_faces([("mesh", np.concatenate([shape, side]))], way), way)
    assert face is not None
    assert face.area == pytest.approx(0.02 * 0.04, rel=1e-2)
    assert face.centre == pytest.approx((0.005, 0.0, 0.0), abs=1e-4)
    assert face.normal == pytest.approx(way, abs=1e-2)
    assert largest_face(flat_faces([("mesh", shape)], -way), -way) is None


def test_the_fingertip_is_the_shipped_one():
    """Dimensions, inertia and compliance are those of assets/gripper.xml."""
    spec = spec_of(slides())
    fit_fingertip(spec, "one", name="left")
    built, shipped = spec.compile(), mujoco.MjModel.from_xml_path(str(asset("gripper.xml")))
    for name in ("pad_left", "sensor_left", "thermostat_left"):
        for field in ("size", "pos", "contype", "conaffinity", "group"):
            assert getattr(built.geom(name), field) == pytest.approx(getattr(shipped.geom(name), field)), (
                name,
                field,
            )
    for name in ("tip_left_pitch", "tip_left_yaw"):
        for field in ("type", "axis", "range", "stiffness", "damping", "armature", "frictionloss"):
            assert getattr(built.joint(name), field) == pytest.approx(getattr(shipped.joint(name), field)), (
                field
            )
    assert built.body_gravcomp[built.body("tip_left").id] == 1
    for field in ("mass", "inertia"):
        assert getattr(built.body("tip_left"), field) == pytest.approx(
            getattr(shipped.body("tip_left"), field)
        )
    assert built.site("pad_left").pos == pytest.approx(shipped.site("pad_left").pos)


@pytest.mark.parametrize(
    "options",
    [
        {},
        {"towards": "two"},
        {"towards": (1, 0, 0)},
        {"pad": "face_one"},
        {"pad": ((0.004, 0.0, 0.0), (1.0, 0.0, 0.0))},
    ],
)
def test_it_feels_what_presses_on_it(options: dict[str, Any]):
    """A weight of 2 kg on the pad, which looks up: the sensor reads its force, centred on the pad."""
    text = slides(pose='pos="0 0 .2" euler="0 -90 0"').replace(
        "</worldbody>",
        """
        <body name="weight" pos="-.06 0 .2"><freejoint/><geom type="box" size=".02 .02 .02" mass="2"/></body>
        </worldbody>""",
    )
    spec = spec_of(text)
    report = fit_fingertip(spec, "one", **options)
    assert report.place == pytest.approx((0.004, 0.0, 0.0), abs=1e-6)
    assert report.normal == pytest.approx((1.0, 0.0, 0.0), abs=1e-6)
    assert "tip_one" in report.added and "contact_one" in report.added
    assert "fingertip on 'one'" in str(report) and "contact_one" in str(report)
    spec.option.integrator = mujoco.mjtIntegrator.mjINT_IMPLICITFAST
    model = spec.compile()
    data = mujoco.MjData(model)
    mujoco.mj_forward(model, data)
    site = data.site("pad_one")
    assert site.xmat.reshape(3, 3)[:, 0] == pytest.approx((0.0, 0.0, 1.0), abs=1e-6)
    pad = site.xpos.copy()
    free = int(model.body("weight").jntadr[0])
    data.qpos[model.jnt_qposadr[free] : model.jnt_qposadr[free] + 3] = pad + (0, 0, 0.0201)
    data.ctrl[:] = 0.0
    for _ in range(1500):
        mujoco.mj_step(model, data)
    found, *vector = data.sensor("contact_one").data
    assert found > 0
    assert vector[2] == pytest.approx(2 * 9.81, rel=0.02)
    assert vector[3:5] == pytest.approx(data.site("pad_one").xpos[:2], abs=2e-3)


def test_a_rigid_one_has_no_hinges():
    spec = spec_of(slides())
    report = fit_fingertip(spec, "one", compliant=False)
    assert not [name for name in report.added if name.endswith(("pitch", "yaw"))]
    assert spec.compile().njnt == 2


def test_the_palm_of_a_lone_jaw_can_carry_one():
    report = fit_fingertip(spec_of(LONE_JAW), "base", pad="fixed_jaw", towards=(-1, 0, 0))
    assert report.area == pytest.approx(0.024 * 0.06)
    assert report.place == pytest.approx((0.046, 0.0, -0.06))


@pytest.mark.parametrize(
    ("text", "body", "options", "message"),
    [
        (slides(), "three", {}, "unknown body 'three'"),
        (slides(), "one", {"towards": "three"}, "unknown body 'three'"),
        (slides(), "one", {"towards": (0, 0, 0)}, "direction"),
        (slides(), "one", {"pad": "face_two"}, "unknown geom"),
        (slides().replace("face_two", "pad_one"), "one", {}, "name=.*'pad_one'"),
        (slides(), "one", {"pad": ((0, 0, 0), (0, 0, 0))}, "normal"),
        (slides(""), "one", {}, "no actuator"),
        (ROUND, "one", {}, "no flat face"),
        (ROUND, "one", {"towards": (1, 0, 0)}, "no flat face"),
        (slides("<actuator><motor joint='gone'/></actuator>"), "one", {}, "does not compile"),
    ],
)
def test_what_cannot_be_fitted_is_refused(text: str, body: str, options: dict[str, Any], message: str):
    with pytest.raises((GripperError, UnknownNameError), match=message):
        fit_fingertip(spec_of(text), body, **options)
