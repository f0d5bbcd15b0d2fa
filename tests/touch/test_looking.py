"""Where pads look: at the others of their hand, or the way in which fingers close."""

# mujoco ships no type stubs for its compiled names
# pyright: reportAttributeAccessIssue=false

from typing import Any

import mujoco
import numpy as np
import pytest

from thermograsp.errors import InvalidValueError
from thermograsp.touch import Fingertip, ThermalTouch
from thermograsp.touch.scene import PadPlace, bodies, pads

PALMAR = (0.0, -1.0, 0.0)  # the way in which the fingers of `hand` close; they are along z, side by side in x
SHAPES = {"capsule": 'size=".007" fromto="0 0 0 0 0 .024"', "box": 'size=".007 .007 .014" pos="0 0 .014"'}


def hand(
    shape: str = "capsule", ranges: str = "0 90", axis: str = "1 0 0", further: str = ""
) -> mujoco.MjModel:
    """A hand stretched along z: three fingers of two links and a thumb before the palm, at their side."""
    fingers = "".join(
        f"""<body name="knuckle{n}" pos="{x} 0 .05"><joint type="hinge" axis="0 1 0" range="-20 20"/>
        <geom size=".007" fromto="0 0 0 0 0 .03"/>
        <body name="finger{n}" pos="0 0 {0.04 + 0.01 * n}">
          <joint type="hinge" axis="{axis}" range="{ranges}"/>{further}
          <geom type="{shape}" {SHAPES[shape]}/></body></body>"""
        for n, x in enumerate((-0.022, 0.0, 0.022))
    )
    return mujoco.MjModel.from_xml_string(f"""<mujoco><compiler autolimits="true"/>
        <default><geom type="capsule" mass=".01"/></default><worldbody><body name="palm">
        <joint type="hinge" axis="0 0 1" range="-90 90"/><geom type="box" size=".04 .01 .05"/>{fingers}
        <body name="thumb" pos="-.05 0 .03"><joint type="hinge" axis="1 1 0" range="-90 0"/>
        <geom type="{shape}" {SHAPES[shape]}/></body></body></worldbody></mujoco>""")


def looks(model: mujoco.MjModel, *bodies: str) -> np.ndarray:
    """(F, 3) where the pads look, in the world."""
    data = mujoco.MjData(model)
    mujoco.mj_kinematics(model, data)
    found = pads(model, {body: Fingertip(body) for body in bodies}, ())
    return np.array([data.xmat[pad.body].reshape(3, 3) @ pad.axes[:, 0] for pad in found])


TWO = {"a": "tip0", "b": "tip1"}
FINGERS = ("finger0", "finger1", "finger2")


@pytest.mark.parametrize("shape", SHAPES)
@pytest.mark.parametrize(
    ("ranges", "axis"),
    [("0 90", "1 0 0"), ("-90 0", "-1 0 0"), ("-20 90", "1 0 0")],
    ids=["", "turned", "both"],
)
def test_parallel_fingers_look_where_they_bend(shape: str, ranges: str, axis: str) -> None:
    """They looked at one another: none of them felt what the hand closed round."""
    model = hand(shape, ranges, axis)
    np.testing.assert_allclose(looks(model, *FINGERS, "thumb")[:3], [PALMAR] * 3, atol=1e-6)
    np.testing.assert_allclose(looks(model, *FINGERS), [PALMAR] * 3, atol=1e-6)


def test_a_thumb_that_bends_towards_the_fingers_looks_at_them() -> None:
    direction = looks(hand(), *FINGERS, "thumb")[3]
    assert direction @ (0.5**0.5, -(0.5**0.5), 0) > 0.7


@pytest.mark.parametrize("further", ["", '<joint type="hinge" axis="0 1 0" range="-40 40"/>'])
def test_fingers_of_whose_joints_nothing_is_known_look_at_each_other(further: str) -> None:
    """They bend both ways alike, or as far as they spread."""
    model = hand("box", ranges="0 80" if further else "-90 90", further=further)
    assert looks(model, *FINGERS[:2])[0][0] > 0.9


@pytest.mark.parametrize("further", ["0 0 1", "0 1 0"])
def test_joints_that_roll_or_spread_a_finger_tell_nothing(further: str) -> None:
    model = hand("box", further=f'<joint type="hinge" axis="{further}" range="-20 20"/>')
    np.testing.assert_allclose(looks(model, *FINGERS), [PALMAR] * 3, atol=1e-6)


def test_a_joint_of_all_fingertips_is_no_fingers_own() -> None:
    """The palm's hinge, which would sweep them in y."""
    model = mujoco.MjModel.from_xml_string("""<mujoco><compiler autolimits="true"/><worldbody><body>
        <joint type="hinge" axis="0 0 1" pos="-.1 0 0" range="0 90"/><geom size=".01" mass="1"/>
        <body name="left" pos="-.02 0 0"><geom type="box" size=".004 .01 .02"/></body>
        <body name="right" pos=".02 0 0"><geom type="box" size=".004 .01 .02"/></body></body></worldbody></mujoco>""")
    np.testing.assert_allclose(looks(model, "left", "right"), [[1, 0, 0], [-1, 0, 0]], atol=1e-9)


@pytest.mark.parametrize("side", [1, -1])
def test_an_object_tells_which_of_two_ways_closes(side: int) -> None:
    """Fingertips side by side on rails looked at each other, and felt nothing of the plate that they were on."""
    tips = "".join(
        f"""<body name="tip{n}" pos="{x} 0 {side * 0.0065}"><joint name="{n}" type="slide" axis="0 0 1" damping="20"/>
        <geom type="box" size=".01 .01 .004" mass=".05"/></body>"""
        for n, x in enumerate((-0.011, 0.011))
    )
    model = mujoco.MjModel.from_xml_string(f"""<mujoco><option timestep=".002" gravity="0 0 0"/><worldbody>
        <body name="plate"><geom type="box" size=".1 .03 .002"/></body>{tips}</worldbody></mujoco>""")
    touch, data = ThermalTouch(model, fingertips=TWO, objects={"plate": "glass"}), mujoco.MjData(model)
    for _ in range(200):
        data.qfrc_applied[:] = -8.0 * side
        mujoco.mj_step(model, data)
        touch.update(data)
    assert (touch.reading.temperature_drop > 1.0).all() and not touch.reading.beside.any()


def gripper(axis: str, ranges: str, gap: float) -> mujoco.MjModel:
    fingers = "".join(
        f"""<body name="{name}" pos="{side * gap} 0 0"><joint type="slide" axis="{axis}" range="{ranges}"/>
        <geom type="box" size=".004 .01 .02"/></body>"""
        for name, side in (("left", 1), ("right", -1))
    )
    return mujoco.MjModel.from_xml_string(
        f'<mujoco><compiler autolimits="true"/><worldbody><body><freejoint/><geom size=".01"/>{fingers}</body>'
        "</worldbody></mujoco>"
    )


@pytest.mark.parametrize("ranges", ["0 .04", "-.04 0", "-.04 .04"])
def test_fingers_that_slide_look_at_each_other_whichever_way_opens(ranges: str) -> None:
    np.testing.assert_allclose(
        looks(gripper("1 0 0", ranges, 0.03), "left", "right"), [[-1, 0, 0], [1, 0, 0]], atol=1e-9
    )


@pytest.mark.parametrize("apart", [0.1, 1.0])
def test_two_grippers_look_at_their_own_fingers(apart: float) -> None:
    """In one model: each pad looked at the mean of the others, which is the other arm."""
    arms = "".join(
        f"""<body name="{arm}" pos="0 {y} 0"><joint type="hinge" axis="1 0 0"/><geom size=".01" mass="1"/>"""
        + "".join(
            f"""<body name="{arm}{n}" pos="{x} 0 .1"><joint type="slide" axis="1 0 0"/>
            <geom type="box" size=".004 .01 .02"/></body>"""
            for n, x in enumerate((-0.03, 0.03))
        )
        + "</body>"
        for arm, y in (("a", -apart), ("b", apart))
    )
    model = mujoco.MjModel.from_xml_string(f"<mujoco><worldbody>{arms}</worldbody></mujoco>")
    np.testing.assert_allclose(looks(model, "a0", "a1", "b0", "b1")[:, 0], [1, -1, 1, -1], atol=1e-9)


def test_a_palm_that_feels_turns_no_finger_from_the_other() -> None:
    model = mujoco.MjModel.from_xml_string("""<mujoco><worldbody><body>
        <geom name="palm" type="box" size=".03 .05 .005" pos="0 0 .08"/>
        <body name="left" pos="0 .03 0"><joint type="slide" axis="0 -1 0"/><geom type="box" size=".01 .004 .02"/></body>
        <body name="right" pos="0 -.03 0"><joint type="slide" axis="0 1 0"/><geom type="box" size=".01 .004 .02"/>
        </body></body></worldbody></mujoco>""")
    data = mujoco.MjData(model)
    mujoco.mj_kinematics(model, data)
    found = pads(model, {name: Fingertip(name) for name in ("left", "right", "palm")}, ())
    np.testing.assert_allclose(
        [pad.axes[:, 0] for pad in found], [[0, -1, 0], [0, 1, 0], [0, 0, -1]], atol=1e-9
    )


@pytest.mark.parametrize("first", [True, False])
@pytest.mark.parametrize("aside", [0.0, 0.01, 0.018])
def test_one_fingertip_looks_at_the_nearest_place_of_the_nearest_object(aside: float, first: bool) -> None:
    """In whatever order they are named. It looked at the middle of a block, askew, and at the first object."""
    model = mujoco.MjModel.from_xml_string(f"""<mujoco><worldbody>
        <body name="block"><geom type="box" size=".02 .02 .02"/></body>
        <body name="mug" pos=".2 0 .02"><geom type="cylinder" size=".03 .04"/></body>
        <body name="tip" pos="{aside} 0 .0291"><joint type="slide" axis="0 0 -1"/><geom size=".008"/></body>
        </worldbody></mujoco>""")
    named = {"block": "glass", "mug": "wood"}
    shapes = bodies(model, named if first else dict(reversed(named.items())), 24.0)
    (pad,) = pads(model, {"tip": Fingertip("tip")}, shapes)
    np.testing.assert_allclose(pad.axes[:, 0], [0, 0, -1], atol=1e-6)


def test_a_pad_is_on_the_hull_that_touches() -> None:
    """A finger whose mesh is hollowed out where it looks: MuJoCo has contacts with its convex hull."""
    outline = [(-10, -10), (-6, -10), (-6, -2), (6, -2), (6, -10), (10, -10), (10, 10), (-10, 10)]
    points = np.array([(x, y, z) for z in (-20, 20) for x, y in outline]) / 1e3
    top = np.array([(0, 1, 2), (0, 2, 7), (2, 3, 6), (2, 6, 7), (3, 4, 5), (3, 5, 6)])
    ends = [(n, (n + 1) % 8) for n in range(8)]
    sides = [(i, j, j + 8) for i, j in ends] + [(i, j + 8, i + 8) for i, j in ends]
    faces = np.concatenate((top + 8, top[:, ::-1], sides))
    spec = mujoco.MjSpec()
    spec.add_mesh(name="m", uservert=points.ravel(), userface=faces.ravel())
    body = spec.worldbody.add_body(name="tip")
    body.add_geom(type=mujoco.mjtGeom.mjGEOM_MESH, meshname="m")
    (pad,) = pads(spec.compile(), {"tip": Fingertip("tip", normal=(0, -1, 0))}, ())
    np.testing.assert_allclose(pad.position, [0, -0.01, 0], atol=1e-6)
    np.testing.assert_allclose(sorted(pad.size), [0.02, 0.04], atol=1e-6)


def test_a_pad_of_two_boxes_in_one_plane_is_both() -> None:
    """As on Robotiq's 2F-85 in several models; of boxes that leave a gap it is one."""
    box = '<geom type="box" size=".011 .004 .009" pos="0 0 {}"/>'
    for z, size in ((0.009, 0.036), (0.02, 0.018)):
        text = (
            f'<mujoco><worldbody><body name="tip">{box.format(z)}{box.format(-z)}</body></worldbody></mujoco>'
        )
        tip = Fingertip("tip", normal=(0, 1, 0))
        (pad,) = pads(mujoco.MjModel.from_xml_string(text), {"tip": tip}, ())
        np.testing.assert_allclose(sorted(pad.size), sorted([0.022, size]), atol=1e-9)
        np.testing.assert_allclose(
            pad.position, [0, 0.004, 0 if z < 0.01 else abs(pad.position[2])], atol=1e-9
        )


@pytest.mark.parametrize("capsule_first", [True, False])
def test_a_round_pad_is_on_the_geom_that_reaches_furthest(capsule_first: bool) -> None:
    """In whatever order the MJCF has them."""
    geoms = ['<geom type="capsule" size=".007" fromto="0 0 0 0 0 .03"/>', '<geom size=".0068"/>']
    text = "".join(geoms if capsule_first else geoms[::-1])
    model = mujoco.MjModel.from_xml_string(
        f'<mujoco><worldbody><body name="tip">{text}</body></worldbody></mujoco>'
    )
    (pad,) = pads(model, {"tip": Fingertip("tip", normal=(0, -1, 0))}, ())
    np.testing.assert_allclose(pad.position, [0, -0.007, 0.015], atol=1e-9)


def test_a_pad_on_a_lopsided_face_is_in_the_middle_of_its_sides() -> None:
    """Of a mesh that is wider at one end: the pad was about its area's centroid, and stood over an end."""
    outline = [(0, 0), (0.03, 0), (0.03, 0.004), (0.01, 0.008), (0, 0.008)]
    points = np.array([[x, y, z] for z in (0.0, 0.005) for x, y in outline])
    spec = mujoco.MjSpec()
    spec.add_mesh(name="m", uservert=points.ravel())
    spec.worldbody.add_body(name="tip").add_geom(type=mujoco.mjtGeom.mjGEOM_MESH, meshname="m")
    model = spec.compile()
    (pad,) = pads(model, {"tip": Fingertip("tip", normal=(0, 0, 1))}, ())
    data = mujoco.MjData(model)
    mujoco.mj_kinematics(model, data)
    np.testing.assert_allclose(pad.position, [0.015, 0.004, 0.005], atol=1e-6)


@pytest.mark.parametrize("arms", [1, 2])
@pytest.mark.parametrize("ranges", ["0 100", "-10 100"])
def test_a_jaw_that_moves_on_another_and_that_one_look_at_each_other(arms: int, ranges: str) -> None:
    """The hinge's positive way opens the jaw; the wrist below, which moves both, tells nothing."""
    bodies = "".join(
        f"""<body pos="0 {y} 0"><joint type="hinge" axis="1 0 0" range="-90 90"/><geom size=".01" mass="1"/>
        <body name="fixed{y}" pos="0 0 .05"><joint type="hinge" axis="0 0 1" range="-150 150"/>
        <geom type="box" size=".01 .004 .03" pos="0 -.01 .05"/><geom type="box" size=".02 .02 .01"/>
        <body name="moving{y}" pos="0 .02 .02"><joint type="hinge" axis="-1 0 0" range="{ranges}"/>
        <geom type="box" size=".01 .004 .03" pos="0 0 .03"/></body></body></body>"""
        for y in range(arms)
    )
    model = mujoco.MjModel.from_xml_string(
        f'<mujoco><compiler autolimits="true"/><worldbody>{bodies}</worldbody></mujoco>'
    )
    names = [f"{jaw}{y}" for y in range(arms) for jaw in ("fixed", "moving")]
    np.testing.assert_allclose(looks(model, *names)[:, 1], [1, -1] * arms, atol=1e-6)


@pytest.mark.parametrize("fingers", [("", "index"), ("", "index", "middle"), ("",)])
def test_phalanges_of_a_finger_look_where_it_bends(fingers: tuple[str, ...]) -> None:
    """Both of a finger's links feel; the nearer one looked along the finger."""
    chains = "".join(
        f"""<body name="near{name}" pos="{0.022 * n} 0 .05"><joint type="hinge" axis="1 0 0" range="0 90"/>
        <geom type="box" size=".007 .007 .014" pos="0 0 .014"/>
        <body name="far{name}" pos="0 0 .03"><joint type="hinge" axis="1 0 0" range="0 90"/>
        <geom type="box" size=".007 .007 .014" pos="0 0 .014"/></body></body>"""
        for n, name in enumerate(fingers)
    )
    model = mujoco.MjModel.from_xml_string(
        f'<mujoco><compiler autolimits="true"/><worldbody><body><geom size=".01"/>{chains}</body></worldbody></mujoco>'
    )
    names = [f"{link}{name}" for name in fingers for link in ("near", "far")]
    np.testing.assert_allclose(looks(model, *names), [PALMAR] * len(names), atol=1e-6)


def placed(model: mujoco.MjModel, **words: Any) -> PadPlace:
    return pads(model, {"tip": Fingertip("finger0", **words)}, ())[0]


@pytest.mark.parametrize("shape", SHAPES)
def test_a_pad_looks_where_its_normal_says(shape: str) -> None:
    """Of the box and of the capsule's side in the middle; as curved as that is."""
    pad = placed(hand(shape), normal=(0, 3, 0.5))
    np.testing.assert_allclose(pad.axes[:, 0], [0, 1, 0], atol=1e-9)
    at = {"box": [0, 0.007, 0.014], "capsule": [0, 0.007, 0.012]}[shape]
    np.testing.assert_allclose(pad.position, at, atol=1e-9)
    assert max(pad.curvature) == pytest.approx({"box": 0, "capsule": 1 / 0.007}[shape])


def test_a_normal_puts_a_pad_on_a_capsules_round_end() -> None:
    """As of a finger that touches with its tip: 45 degrees off its side."""
    pad = placed(hand(), normal=(0, -1, 1))
    np.testing.assert_allclose(pad.axes[:, 0], np.array([0, -1, 1]) / 2**0.5, atol=1e-9)
    np.testing.assert_allclose(pad.position, [0, -0.007 / 2**0.5, 0.024 + 0.007 / 2**0.5], atol=1e-9)
    assert pad.curvature == pytest.approx((1 / 0.007, 1 / 0.007))
    np.testing.assert_allclose(placed(hand(), normal=(0, -1, 1), size=(0.004, 0.005)).size, [0.004, 0.005])


def test_a_finger_that_touches_with_its_tip_feels_there() -> None:
    """A capsule that leans by 45 degrees, on aluminium; its side is told to touch beside its pad."""
    model = mujoco.MjModel.from_xml_string("""<mujoco><option timestep=".002" gravity="0 0 0"/><worldbody>
        <body name="plate"><geom type="box" size=".1 .03 .02"/></body><body name="tip" pos="0 0 .0272">
        <joint type="slide" axis="0 0 -1" damping="20"/>
        <geom type="capsule" size=".007" fromto="0 0 0 .02 0 .02" mass=".05"/></body></worldbody></mujoco>""")
    drops = []
    for normal in ((-0.1, 0, -1), (1, 0, -1)):
        tip = Fingertip("tip", normal=normal)
        touch, data = (
            ThermalTouch(model, fingertips={"tip": tip}, objects={"plate": "aluminium"}),
            mujoco.MjData(model),
        )
        for _ in range(200):
            data.qfrc_applied[:] = 5.0
            mujoco.mj_step(model, data)
            touch.update(data)
        drops.append(float(touch.reading.temperature_drop[0]))
    assert drops[0] > 2.0 and drops[1] == 0.0


def test_a_normal_that_says_nothing_is_refused() -> None:
    with pytest.raises(InvalidValueError, match="points towards where its normal does"):
        placed(hand("box"), normal=(1, 1, 1))
    with pytest.raises(InvalidValueError, match="a position needs the pad's normal"):
        Fingertip("finger0", position=(0, 0, 0))
    text = (
        """<mujoco><worldbody><body name="a"><geom size=".01"/><site name="s"/></body></worldbody></mujoco>"""
    )
    with pytest.raises(InvalidValueError, match="is a site, which looks along its x axis"):
        pads(mujoco.MjModel.from_xml_string(text), {"tip": Fingertip("s", normal=(0, 0, 1))}, ())


@pytest.mark.parametrize("tip", ["sphere", "capsule", "cylinder", "box"])
@pytest.mark.parametrize("kind", ["sphere", "capsule", "ellipsoid", "cylinder", "box"])
def test_one_fingertip_looks_at_what_is_near_whatever_both_are(kind: str, tip: str) -> None:
    """MuJoCo 3.3.0 tells the nearest points of a box and a cylinder the other way round."""
    model = mujoco.MjModel.from_xml_string(f"""<mujoco><worldbody>
        <body name="thing"><geom type="{kind}" size=".02 .02 .02"/></body>
        <body name="tip" pos="0 0 -.0702"><geom type="{tip}" size=".01 .01 .01"/></body></worldbody></mujoco>""")
    (pad,) = pads(model, {"tip": Fingertip("tip")}, bodies(model, {"thing": "steel"}, 24.0))
    assert pad.axes[2, 0] > 0.99
