"""Contacts that would be missed without a word: of bodies that are fixed to others, of bodies asleep, and of what
MuJoCo keeps apart."""

# mujoco ships no type stubs for its compiled names
# pyright: reportAttributeAccessIssue=false

import warnings

import mujoco
import pytest

from thermograsp.errors import InvalidValueError
from thermograsp.touch import Fingertip, ThermalTouch

BLOCK = '<geom name="block" type="box" size=".02 .02 .02"/>'
PAD = '<geom name="pad" type="box" size=".01 .01 .004" mass=".1"/>'
BEHIND = '<geom name="link" type="box" size=".005 .005 .01" pos="0 0 .02" mass=".1"/>'


def scene(
    block: str = BLOCK, tip: str = PAD, head: str = "", motor: bool = True, sleep: str = ""
) -> mujoco.MjModel:
    actuator = '<actuator><motor joint="slide"/></actuator>' if motor else ""
    return mujoco.MjModel.from_xml_string(
        f"""<mujoco>{head}<worldbody><body name="block" {sleep}><freejoint/>{block}</body>
        <body name="tip" pos="0 0 .0241"><joint name="slide" type="slide" axis="0 0 1"/>{tip}</body>
        </worldbody>{actuator}</mujoco>"""
    )


def touch(model: mujoco.MjModel, tip: str = "pad", **objects: str) -> ThermalTouch:
    return ThermalTouch(model, fingertips={"tip": tip}, objects=objects or {"block": "glass"})


def fixed(inner: str) -> str:
    return f'<body name="fixed">{inner}</body>'


def test_geoms_that_are_fixed_to_an_object_are_named_or_told_of() -> None:
    upper = '<geom name="upper" type="box" size=".02 .02 .01" pos="0 0 .01"/>'
    whole = BLOCK.replace("block", "lower") + fixed(upper)
    with pytest.warns(
        RuntimeWarning, match="object 'block': contacts with geom 'upper' are not felt.*fusestatic"
    ):
        touch(scene(whole))
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        touch(scene(whole), block="glass", fixed="wood")
        touch(scene(whole), lower="glass")  # somebody chose a geom
        fused = scene(whole, head='<compiler fusestatic="true"/>')
        if fused.nbody == 3:  # MuJoCo 3.3.0 leaves them apart beside actuators
            touch(fused)
        touch(scene(BLOCK + fixed('<geom size=".1" contype="0" conaffinity="0"/>')))
        touch(scene(BLOCK + fixed(BLOCK.replace("block", "lid")).replace(">", "><joint/>", 1)))


def test_a_fingertip_whose_face_is_on_a_fixed_body_is_told_of() -> None:
    model = scene(tip=BEHIND + fixed(PAD))
    with pytest.warns(RuntimeWarning, match="fingertip 'tip': contacts with geom 'pad' are not felt"):
        touch(model, "tip")
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        touch(model, "pad")
        touch(model, "fixed")


@pytest.mark.skipif(not hasattr(mujoco.mjtEnableBit, "mjENBL_SLEEP"), reason="this MuJoCo never sleeps")
def test_what_may_fall_asleep_on_a_fingertip_is_refused() -> None:
    """A sleeping pair has no contacts: a block on a passive sensor of glass was felt as 0.2 K in place of 4.3 K."""
    sleepy = '<option><flag sleep="enable"/></option>'
    with pytest.raises(InvalidValueError, match="may fall asleep on each other.*at body 'tip' or 'block'"):
        touch(scene(head=sleepy, motor=False))
    touch(scene(head=sleepy))  # what has actuators stays awake, and wakes what it touches
    touch(scene(head=sleepy, motor=False, sleep='sleep="never"'))
    touch(scene(motor=False))


JOINT = '<joint name="slide" type="slide" axis="0 0 1"/>'
APART = "<contact><exclude body1='block' body2='tip'/></contact>"
PAIR = '<contact><pair geom1="pad" geom2="block"/></contact>'


def apart(
    *,
    tip: str = JOINT,
    mocap: str = "",
    block: str = "<freejoint/>",
    masks: str = "",
    head: str = "",
    tail: str = "",
    child: bool = False,
) -> mujoco.MjModel:
    """A pad that is on a block already, and that MuJoCo may keep from it."""
    pad = PAD.replace("/>", f" {masks}/>")
    inner = f'<body name="tip" pos="0 0 .0239" {mocap}>{tip}{pad}</body>'
    outer = f'<body name="block">{block}{BLOCK}{inner if child else ""}</body>{"" if child else inner}'
    return mujoco.MjModel.from_xml_string(f"<mujoco>{head}<worldbody>{outer}</worldbody>{tail}</mujoco>")


def contacts(model: mujoco.MjModel) -> int:
    data = mujoco.MjData(model)
    mujoco.mj_forward(model, data)
    return int(data.nefc > 0)


@pytest.mark.parametrize(
    ("words", "why"),
    [
        ({"tail": APART}, "the model excludes contacts"),
        ({"masks": 'contype="2" conaffinity="2"'}, "contype and conaffinity of their geoms do not meet"),
        ({"tip": "", "mocap": 'mocap="true"', "block": ""}, "neither of the two has a joint"),
        ({"tip": "", "mocap": 'mocap="true"', "block": "", "tail": PAIR}, "neither of the two has a joint"),
        ({"tip": "", "block": ""}, "neither of the two has a joint"),
        ({"child": True, "tip": ""}, "fixed to each other"),
        ({"child": True}, "the joints of one are on the other"),
        ({"head": '<option><flag contact="disable"/></option>'}, "disables its flag contact"),
        ({"head": '<option><flag constraint="disable"/></option>'}, "disables its flag constraint"),
    ],
    ids=lambda value: "",
)
def test_contacts_that_the_model_filters_out_are_warned_of(words: dict, why: str) -> None:
    """A finger moved as a mocap body over a fixed block, for one, felt nothing, and nothing said so."""
    model = apart(**words)
    assert not contacts(model)
    with pytest.warns(
        RuntimeWarning, match=f"object 'block' is never touched by a fingertip: .*{why}"
    ) as told:
        touch(model)
    assert len(told) == 1 and told[0].filename == __file__


@pytest.mark.parametrize(
    "words",
    [
        {},
        {"masks": 'contype="2" conaffinity="1"'},
        {"tip": "", "mocap": 'mocap="true"'},
        {"tip": ""},
        {"block": ""},
        {"child": True, "block": ""},
        {"child": True, "head": '<option><flag filterparent="disable"/></option>'},
        {"tail": PAIR + APART},
        {"masks": 'contype="0" conaffinity="0"', "tail": PAIR},
    ],
    ids=lambda value: "",
)
def test_what_can_touch_is_not_told_of(words: dict) -> None:
    model = apart(**words)
    assert contacts(model)
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        touch(model)


def test_a_fingertip_that_cannot_touch_is_told_of_beside_one_that_can() -> None:
    other = PAD.replace("pad", "other").replace("/>", ' contype="4" conaffinity="4"/>')
    model = mujoco.MjModel.from_xml_string(
        f"""<mujoco><worldbody><body name="block"><freejoint/>{BLOCK}</body><body pos="0 0 .03">{PAD}</body>
        <body pos="0 0 -.03">{other}</body></worldbody></mujoco>"""
    )
    with pytest.warns(RuntimeWarning, match="fingertip 'b' never touches anything: contype") as told:
        ThermalTouch(model, fingertips={"a": "pad", "b": "other"}, objects={"block": "glass"})
    assert len(told) == 1


WIDE = (
    '<geom name="pad" type="box" size=".03 .03 .004" mass=".1"/>'
    '<site name="sensor" pos="0 0 -.004" xyaxes="0 0 -1 1 0 0"/>'
)


@pytest.mark.parametrize("tip", ["sensor", Fingertip("pad", position=(0, 0, -0.004), normal=(0, 0, -1))])
def test_a_pad_on_a_wider_face_is_told_of(tip: str | Fingertip) -> None:
    """On a plate as wide as that face it felt nothing: all contacts are at the corners."""
    wide = BLOCK.replace(".02 .02 .02", ".04 .04 .02")
    model = scene(wide, WIDE)
    with pytest.warns(RuntimeWarning, match="its pad of 20 x 20 mm is part of a face of 60 x 60 mm") as told:
        ThermalTouch(model, fingertips={"tip": tip}, objects={"block": "glass"})
    assert len(told) == 1 and told[0].filename == __file__


def test_a_pad_as_wide_as_its_face_is_not_told_of() -> None:
    place = {"position": (0, 0, -0.004), "normal": (0, 0, -1)}
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        for tip in (
            Fingertip("pad", size=(0.06, 0.06), **place),
            Fingertip("pad"),
            # on no face
            Fingertip("pad", position=(0, 0, 0), normal=(0, 0, -1)),
        ):
            ThermalTouch(scene(tip=WIDE), fingertips={"tip": tip}, objects={"block": "glass"})


def side_by_side(
    apart: float, rail: str = '<joint type="slide" axis="1 0 0" stiffness="1e4"/>'
) -> mujoco.MjModel:
    """Two fingers that press on one plate, and so do not look at each other. rail: a joint beside the one that
    presses."""
    tips = "".join(
        f"""<body name="tip{n}" pos="{side * apart} 0 .0065">{rail}
        <joint name="down{n}" type="slide" axis="0 0 -1" damping="20"/>
        <geom name="tip{n}" type="box" size=".01 .01 .004" mass=".05"/></body>"""
        for n, side in enumerate((-1, 1))
    )
    return mujoco.MjModel.from_xml_string(f"""<mujoco><option timestep=".002" gravity="0 0 0"/><worldbody>
        <body name="plate"><geom type="box" size=".1 .03 .002"/></body>{tips}</worldbody></mujoco>""")


def told(model: mujoco.MjModel, steps: int, **tips: str | Fingertip) -> list[str]:
    """The warnings of so many steps under 8 N."""
    data = mujoco.MjData(model)
    touching = ThermalTouch(model, fingertips=tips, objects={"plate": "glass"})
    with warnings.catch_warnings(record=True) as found:
        warnings.simplefilter("always")
        for _ in range(steps):
            for finger in range(2):
                data.joint(f"down{finger}").qfrc_applied[:] = 8.0
            mujoco.mj_step(model, data)
            touching.update(data)
    return [str(each.message) for each in found]


def test_fingertips_whose_pads_look_elsewhere_are_told_of_once() -> None:
    model = side_by_side(0.011)
    found = told(model, 1000, a="tip0", b="tip1")
    assert len(found) == 2
    assert (
        "fingertip 'a' is pressed by 8 N beside its pad" in found[0] and "looks along (1, 0, 0)" in found[0]
    )
    below = {"position": (0, 0, -0.004), "normal": (0, 0, -1), "size": (0.02, 0.02)}
    assert told(model, 500, a=Fingertip("tip0", **below), b=Fingertip("tip1", **below)) == []


def test_a_short_push_beside_a_pad_is_not_told_of() -> None:
    assert told(side_by_side(0.011), 200, a="tip0", b="tip1") == []


def on_pad(text: str, objects: dict, tip: Fingertip) -> list[str]:
    """The warnings of two seconds under 8 N."""
    model = mujoco.MjModel.from_xml_string(text)
    touching, data = ThermalTouch(model, fingertips={"tip": tip}, objects=objects), mujoco.MjData(model)
    with warnings.catch_warnings(record=True) as found:
        warnings.simplefilter("always")
        for _ in range(1000):
            data.qfrc_applied[0] = 8.0
            mujoco.mj_step(model, data)
            touching.update(data)
    return [str(each.message) for each in found]


LONG = """<mujoco><option gravity="0 0 0"/><worldbody><body name="block"><geom type="box" size=".01 .02 .02"/></body>
    <body name="tip" pos="{x} 0 .0241"><joint type="slide" axis="0 0 -1" damping="20"/>
    <geom name="pad" type="box" size=".03 .01 .004" mass=".1"/></body></worldbody></mujoco>"""


def test_a_fingertip_whose_sensor_is_beside_what_its_pad_is_on_is_told_of_once() -> None:
    """The end of a pad 60 mm long was pressed by 8 N, and its sensor in the middle felt 0 K, without a word."""
    found = on_pad(LONG.format(x=0.025), {"block": "aluminium"}, Fingertip("pad"))
    assert len(found) == 1
    assert "pressed by 8 N on its pad, and its sensor has felt no heat" in found[0]
    assert "9 mm wide in the pad's middle at (0, 0, -0.004) m" in found[0]
    assert on_pad(LONG.format(x=0.0), {"block": "aluminium"}, Fingertip("pad")) == []
    assert on_pad(LONG.format(x=0.025), {"block": "aluminium"}, Fingertip("pad", sensor=None)) == []


def test_fingertips_that_close_on_each_other_alone_are_not_told_of() -> None:
    """They are as warm as one another, and feel no heat."""
    model = mujoco.MjModel.from_xml_string("""<mujoco><option gravity="0 0 0"/><worldbody>
        <body name="far" pos="1 0 0"><geom size=".01"/></body>
        <body name="a" pos="0 0 .0041"><joint type="slide" axis="0 0 -1" damping="20"/>
        <geom type="box" size=".01 .01 .004" mass=".1"/></body>
        <body name="b" pos="0 0 -.0041"><joint type="slide" axis="0 0 1" damping="20"/>
        <geom type="box" size=".01 .01 .004" mass=".1"/></body>
        </worldbody></mujoco>""")
    touching = ThermalTouch(model, fingertips={"a": "a", "b": "b"}, objects={"far": "glass"})
    data = mujoco.MjData(model)
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        for _ in range(500):
            data.qfrc_applied[:] = 8.0
            mujoco.mj_step(model, data)
            touching.update(data)
    assert (touching.reading.force > 4).all() and touching.reading.touching == ("b", "a")
