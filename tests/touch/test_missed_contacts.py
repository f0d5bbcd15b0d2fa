"""Contacts that would be missed without a word: of bodies that are fixed to others, and of bodies asleep."""

# mujoco ships no type stubs for its compiled names
# pyright: reportAttributeAccessIssue=false

import warnings

import mujoco
import pytest

from thermograsp.errors import InvalidValueError
from thermograsp.touch import ThermalTouch

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
