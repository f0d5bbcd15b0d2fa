"""Where pads and objects are found in a scene."""

# mujoco ships no type stubs for its compiled names
# pyright: reportAttributeAccessIssue=false

import math
from contextlib import nullcontext
from typing import Any

import mujoco
import numpy as np
import pytest
import trimesh

from thermograsp.errors import InvalidValueError
from thermograsp.touch import Fingertip, ThermalTouch

SCENE = """
<mujoco>
  <option gravity="0 0 0"/>
  <worldbody>
    <geom name="table" type="box" size=".25 .25 .02" pos="0 0 -.02"/>
    <body name="cup" pos="0 0 .3">
      <geom name="seen" type="box" size=".02 .02 .02" contype="0" conaffinity="0"/>
      <geom name="solid" type="box" size=".02 .02 .02" {masks}/>
    </body>
    <body name="tip" pos="{x} 0 .0041">
      <joint type="slide" axis="0 0 -1" damping="20"/>
      <geom name="cover" type="box" size=".012 .012 .005" contype="0" conaffinity="0" mass="0"/>
      <geom name="pad" type="{kind}" size="{size}" mass=".1" {masks}/>
    </body>
  </worldbody>
  <contact>{pairs}</contact>
  <actuator><motor joint="{joint}"/></actuator>
</mujoco>"""
HIDDEN = 'contype="0" conaffinity="0"'


def scene_text(
    x: float = 0.0, kind: str = "box", size: str = ".01 .01 .004", masks: str = "", pairs: str = ""
) -> str:
    text = SCENE.format(x=x, kind=kind, size=size, masks=masks, pairs=pairs, joint="down")
    return text.replace('<joint type="slide"', '<joint name="down" type="slide"')


def scene(*words: Any, **others: Any) -> mujoco.MjModel:
    return mujoco.MjModel.from_xml_string(scene_text(*words, **others))


def felt(model: mujoco.MjModel, objects: dict, tip: str = "pad") -> tuple[float, float]:
    """K, and N beside the pad, after half a second of 10 N."""
    touch, data = ThermalTouch(model, fingertips={"tip": tip}, objects=objects), mujoco.MjData(model)
    data.ctrl[0] = 10.0
    for _ in range(250):
        mujoco.mj_step(model, data)
        touch.update(data)
    reading = touch.reading
    return float(reading.temperature_drop[0]), float(reading.beside[0])


@pytest.mark.parametrize(("kind", "size"), [("box", ".01 .01 .004"), ("sphere", ".004")])
def test_a_fingertip_feels_a_table_wherever_it_is_on_it(kind: str, size: str) -> None:
    """Its pad looks down, although the table's middle lies aside."""
    drop, beside = felt(scene(0.0, kind, size), {"table": "glass"})
    aside, beside_aside = felt(scene(0.2, kind, size), {"table": "glass"})
    assert drop > 0.3 and beside == beside_aside == 0.0
    assert aside == pytest.approx(drop, rel=1e-3)


def test_a_fingertip_that_only_is_seen_is_refused() -> None:
    with pytest.raises(InvalidValueError, match="'cover' is only seen"):
        ThermalTouch(scene(), fingertips={"tip": "cover"}, objects={"table": "glass"})


def test_an_object_that_only_is_seen_is_told() -> None:
    with pytest.warns(RuntimeWarning, match="object 'seen': 'seen' is only seen") as told:
        ThermalTouch(scene(), fingertips={"tip": "pad"}, objects={"table": "glass", "seen": "steel"})
    assert told[0].filename == __file__


def test_geoms_that_touch_by_pairs_alone_are_felt() -> None:
    pairs = '<pair geom1="pad" geom2="table"/>'
    drop, _ = felt(scene(masks=HIDDEN, pairs=pairs), {"table": "glass"}, "tip")
    np.testing.assert_allclose(drop, felt(scene(), {"table": "glass"})[0], rtol=1e-3)


def test_a_contact_with_a_cloth_is_not_one_with_the_last_geom() -> None:
    """A cloth lies on the block, and the fingertip, whose geom is the last, hangs above."""
    model = mujoco.MjModel.from_xml_string("""
<mujoco>
  <option timestep=".0005" solver="CG" integrator="implicitfast"/>
  <worldbody>
    <flexcomp name="cloth" type="grid" count="4 4 1" spacing=".008 .008 .008" pos="0 0 .023" radius=".002" mass=".02"
              dim="2"><contact selfcollide="none"/><edge equality="true"/></flexcomp>
    <body name="block"><geom name="block" type="box" size=".02 .02 .02"/></body>
    <body name="tip" pos="0 0 .16"><geom name="pad" type="box" size=".01 .01 .004"/></body>
  </worldbody>
</mujoco>""")
    touch, data = (
        ThermalTouch(model, fingertips={"tip": "pad"}, objects={"block": "aluminium"}),
        mujoco.MjData(model),
    )
    for _ in range(200):
        mujoco.mj_step(model, data)
        touch.update(data)
    reading = touch.reading
    assert (data.contact.geom == -1).any() and data.efc_force.max() > 0
    assert reading.touching == ("",) and reading.beside[0] == reading.temperature_drop[0] == 0


@pytest.mark.parametrize("inwards", [False, True])
def test_a_mesh_whose_faces_look_inwards_is_refused(inwards: bool) -> None:
    cube = trimesh.creation.box((0.04, 0.04, 0.04))
    if inwards:
        cube.invert()
    spec = mujoco.MjSpec()
    spec.add_mesh(name="cube", uservert=cube.vertices.ravel(), userface=cube.faces.ravel())
    spec.worldbody.add_geom(name="cube", type=mujoco.mjtGeom.mjGEOM_MESH, meshname="cube")
    tip = spec.worldbody.add_body(pos=(0, 0, 0.1))
    tip.add_geom(name="pad", type=mujoco.mjtGeom.mjGEOM_BOX, size=(0.01, 0.01, 0.004))
    with pytest.raises(InvalidValueError, match="of mesh 'cube' look inwards") if inwards else nullcontext():
        ThermalTouch(spec.compile(), fingertips={"tip": "pad"}, objects={"cube": "glass"})


def test_a_timestep_that_has_changed_is_told() -> None:
    model = scene()
    touch, data = (
        ThermalTouch(model, fingertips={"tip": "pad"}, objects={"table": "glass"}),
        mujoco.MjData(model),
    )
    mujoco.mj_step(model, data)
    touch.update(data)
    model.opt.timestep = 0.0033
    mujoco.mj_step(model, data)
    with pytest.raises(InvalidValueError, match="timestep is 0.0033 s, and was 0.002 s"):
        touch.update(data)


def test_the_dt_that_a_message_gives_can_be_given() -> None:
    model = scene()
    model.opt.timestep = 0.00333333
    tips: dict = {"fingertips": {"tip": "pad"}, "objects": {"table": "glass"}}
    with pytest.raises(InvalidValueError, match=r"steps of 0.00333333 s: give 0.01999998$"):
        ThermalTouch(model, **tips)
    ThermalTouch(model, **tips, dt=0.01999998)


def test_a_bare_thermostat_touches_with_its_whole_pad_however_long_that_is() -> None:
    long: dict = {"position": (0, 0, -0.004), "normal": (0, 0, -1), "size": np.array((0.004, 0.02))}
    for sensor, face in ((None, math.sqrt(0.004 * 0.02)), ("seed", math.sqrt(0.004 * 0.009))):
        tip = Fingertip("pad", sensor=sensor, **long)
        touch = ThermalTouch(scene(), fingertips={"tip": tip}, objects={"table": "glass"})
        assert touch._pads[0].silicone.face == pytest.approx(face)
        assert touch._pads[0].silicone.width == pytest.approx(math.sqrt(0.004 * 0.02))


def test_geoms_in_one_place_are_told() -> None:
    """A mesh to be seen that collides as well as the box that stands for it."""
    spec = mujoco.MjSpec.from_string(scene_text())
    cup = spec.body("cup")
    cup.add_geom(name="half", type=mujoco.mjtGeom.mjGEOM_BOX, size=(0.02, 0.02, 0.01), pos=(0, 0, 0.01))
    tips: dict = {"fingertips": {"tip": "pad"}, "objects": {"cup": "glass"}}
    ThermalTouch(spec.compile(), **tips)
    cup.add_geom(name="twice", type=mujoco.mjtGeom.mjGEOM_BOX, size=(0.0201, 0.02, 0.02))
    with pytest.warns(RuntimeWarning, match="'solid' and 'twice' fill the same place"):
        ThermalTouch(spec.compile(), **tips)
