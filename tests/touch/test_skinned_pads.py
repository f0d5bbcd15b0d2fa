"""Fingertips of ThermalTouch with a skin press with its springs: the laws of pairs beside those of the foundation."""

# mujoco ships no type stubs for its compiled names
# pyright: reportAttributeAccessIssue=false

import mujoco
import numpy as np
import pytest

from thermograsp.thermal import SKINS, Pad, Surface, flat_contact, material
from thermograsp.thermal.contact import (
    conduction,
    contact,
    curved_contact,
    round_footprint,
    skinned,
)
from thermograsp.touch import Fingertip, ThermalTouch
from thermograsp.touch.contacts import pair_laws
from thermograsp.touch.scene import bodies, pads

SKIN = SKINS["filled_silicone"]
SCENE = """
<mujoco>
  <worldbody>
    <body name="ball"><freejoint/><geom type="sphere" size=".02"/></body>
    <body name="can" pos=".1 0 0"><freejoint/><geom type="cylinder" size=".02 .03"/></body>
    <body name="box" pos=".2 0 0"><freejoint/><geom type="box" size=".02 .02 .02"/></body>
    <body name="tip" pos="0 .1 0"><freejoint/><geom name="flat" type="box" size=".01 .004 .01"/></body>
  </worldbody>
</mujoco>"""


def scene(skin: str | None):
    model = mujoco.MjModel.from_xml_string(SCENE)
    shapes = bodies(model, {"ball": "steel", "can": "steel", "box": "steel"}, 24.0)
    return model, pads(model, {"tip": Fingertip("flat", skin=skin)}, shapes), shapes


@pytest.mark.parametrize("skin", [None, "filled_silicone"])
@pytest.mark.parametrize("force", [0.1, 1.0, 10.0, 40.0])
def test_contacts_in_the_middle_are_those_of_the_environments_laws(force: float, skin: str | None) -> None:
    model, found, shapes = scene(skin)
    skin_worn = SKINS[skin] if skin else None
    pairs = pair_laws(model, found, shapes)
    laws, curved, tables = pairs.laws, pairs.curved, pairs.tables
    steel, sheet, middle = Surface.of(material("steel")), skinned(Pad(), skin_worn), np.zeros(3)
    ball, can = (round_footprint(Pad(), skin_worn, steel, 0.02, length) for length in (None, 0.06))
    for target, law in ((0, ball), (1, can)):
        conducts = curved_contact(tables[curved[0, target, 0]], force, 0.0, 0.0)[0]
        assert conducts == pytest.approx(conduction(law, force, middle)[1], rel=0.02)
    area, load = contact(laws[0, 2, 0], force, middle)
    known = flat_contact(sheet, force, (0.04, 0.04))
    assert area == pytest.approx(float(known.face), rel=1e-6)
    assert load == pytest.approx(float(known.face_force), rel=1e-6)


def test_a_bare_face_conducts_less_and_bears_less_of_a_flat_face_s_force_than_a_skin() -> None:
    bare, worn = (pair_laws(*scene(skin)) for skin in (None, "filled_silicone"))
    for target in (0, 1):
        through = [
            curved_contact(each.tables[each.curved[0, target, 0]], 10.0, 0.0, 0.0)[0] for each in (bare, worn)
        ]
        assert 2 * through[0] < through[1]  # under a skin with what constricts it there
    assert contact(bare.laws[0, 2, 0], 10.0, np.zeros(3))[1] == pytest.approx(10.0 * (9 / 20) ** 2)
    assert contact(worn.laws[0, 2, 0], 10.0, np.zeros(3))[1] > 8.0


def test_what_is_alike_shares_a_table_and_flat_things_have_none() -> None:
    pairs = pair_laws(*scene(None))
    curved, tables = pairs.curved, pairs.tables
    assert (curved[0, 2:] == -1).all()
    assert len(tables) == 2
    assert set(curved[0, 0]) == {0}
    assert curved[0, 1].tolist() == [1, 1, -1]  # a can's end is flat


def pressed(skin: str | None, shape: str, seconds: float = 2.0) -> float:
    """K of drop under 10 N of a steel body after that time."""
    model = mujoco.MjModel.from_xml_string(f"""
      <mujoco><option timestep=".002" gravity="0 0 0"/><worldbody>
        <body name="thing"><joint type="slide" axis="0 0 1" damping="50"/>{shape}</body>
        <body name="tip" pos="0 0 -.0302"><geom name="flat" type="box" size=".01 .01 .01" mass="1"/></body>
      </worldbody></mujoco>""")
    touch = ThermalTouch(
        model,
        fingertips={"tip": Fingertip("flat", skin=skin)},
        objects={"thing": "steel"},
        air=0.0,
        chain="ideal",
    )
    data = mujoco.MjData(model)
    data.qfrc_applied[0] = -10.0
    for _ in range(round(seconds / 0.002)):
        mujoco.mj_step(model, data)
        touch.update(data)
    return float(touch.reading.temperature_drop[0])


@pytest.mark.parametrize("skin", [None, "filled_silicone"])
def test_a_ball_is_felt_less_than_a_rod_and_a_rod_less_than_a_box(skin: str | None) -> None:
    ball = pressed(skin, '<geom type="sphere" size=".02" mass="1"/>')
    rod = pressed(skin, '<geom type="cylinder" size=".02 .03" euler="90 0 0" mass="1"/>')
    box = pressed(skin, '<geom type="box" size=".02 .03 .02" mass="1"/>')
    assert 0.2 < ball < rod < box
    if skin is None:
        assert ball < 0.2 * box  # a rigid face touches 0.03 mm2 of it


@pytest.mark.parametrize("skin", [None, "filled_silicone"])
@pytest.mark.parametrize(
    ("geom", "name"),
    [
        ('type="sphere" size=".02"', "aluminium"),
        ('type="cylinder" size=".02 .03" euler="0 90 0"', "aluminium"),
    ],
)
def test_the_further_the_crown_the_less_is_felt(geom: str, name: str, skin: str | None) -> None:
    """Over the sensor's edge and off the pad, to .1 K of 12: where it leaves the face, gas conducts through all of it,
    and a table must not take that width for the contact's."""
    drops = []
    for aside in np.arange(0.0, 0.0099, 0.0005).tolist():
        model = mujoco.MjModel.from_xml_string(f"""
<mujoco><option timestep=".002" gravity="0 0 0"/><worldbody>
  <body name="thing" pos="0 {aside} .0202">
    <joint type="slide" axis="0 0 -1" damping="50"/><geom {geom} mass="1"/></body>
  <body name="tip" pos="0 0 -.01"><geom name="tip" type="box" size=".01 .01 .01"/></body>
</worldbody></mujoco>""")
        touch = ThermalTouch(
            model, fingertips={"tip": Fingertip("tip", skin=skin)}, objects={"thing": name}, chain="ideal"
        )
        data = mujoco.MjData(model)
        data.qfrc_applied[0] = 8.0
        for _ in range(500):
            mujoco.mj_step(model, data)
            touch.update(data)
        drops.append(float(touch.reading.temperature_drop[0]))
    assert np.diff(drops).max() < 0.1 and 0 < drops[-1] < 0.1 < 0.5 < drops[0]
