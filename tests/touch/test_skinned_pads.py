"""Fingertips of ThermalTouch with a skin press with its springs: the laws of pairs beside those of the foundation."""

# mujoco ships no type stubs for its compiled names
# pyright: reportAttributeAccessIssue=false

import mujoco
import numpy as np
import pytest

from thermograsp.thermal import SKINS, Pad, cylinder_contact, flat_contact, sphere_contact
from thermograsp.thermal.contact import contact, skinned
from thermograsp.touch import Fingertip
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


@pytest.mark.parametrize("force", [0.1, 1.0, 10.0, 40.0])
def test_contacts_in_the_middle_are_those_of_the_foundation(force: float) -> None:
    model, found, shapes = scene("filled_silicone")
    sheet = skinned(Pad(), SKIN)
    laws = pair_laws(model, found, shapes)[0]
    place = np.zeros(3)
    expected = (
        (laws[0, 0], sphere_contact(sheet, force, 0.02)),
        (laws[1, 0], cylinder_contact(sheet, force, 0.02, 0.06)),
        (laws[2, 0], flat_contact(sheet, force, (0.04, 0.04))),
    )
    for law, known in expected:
        area, load = contact(law, force, place)
        assert area == pytest.approx(float(known.face), rel=1e-6)
        assert load == pytest.approx(float(known.face_force), rel=1e-6)


def test_a_skin_is_touched_on_less_than_a_pad_and_bears_more_of_a_flat_face_s_force() -> None:
    bare, worn = (pair_laws(*scene(skin))[0] for skin in (None, "filled_silicone"))
    place = np.zeros(3)
    for thing in (0, 1):
        assert 2 * contact(worn[thing, 0], 10.0, place)[0] < contact(bare[thing, 0], 10.0, place)[0]
    assert contact(bare[2, 0], 10.0, place)[1] == pytest.approx(10.0 * (9 / 20) ** 2)
    assert contact(worn[2, 0], 10.0, place)[1] > 8.0
