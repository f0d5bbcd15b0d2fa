"""Fingertips that touch each other exchange heat."""

# mujoco ships no type stubs for its compiled names
# pyright: reportAttributeAccessIssue=false

import mujoco
import numpy as np
import pytest

from thermograsp.touch import Fingertip, ThermalTouch
from thermograsp.touch.contacts import COLUMNS, CONDUCTANCE, NORMAL, PLACE
from thermograsp.touch.heat.joined import JoinedHeat

TWO_TIPS = """
<mujoco>
  <option timestep=".002" gravity="0 0 0"/>
  <worldbody>
    <body name="block" pos=".1 0 0"><geom name="block" type="box" size=".02 .02 .02"/></body>
    <body name="a"><geom name="a" type="box" size=".01 .01 .004"/></body>
    <body name="b" pos="{offset} 0 .0081">
      <joint type="slide" axis="0 0 -1" damping="20"/>
      <geom name="b" type="box" size=".01 .01 .004" mass=".1"/>
    </body>
  </worldbody>
</mujoco>"""


def test_a_fingertip_warms_another() -> None:
    model = mujoco.MjModel.from_xml_string(TWO_TIPS.format(offset=0.0))
    data = mujoco.MjData(model)
    tips = {"a": "a", "b": Fingertip("b", temperature=46.0)}
    touch = ThermalTouch(model, fingertips=tips, objects={"block": "glass"}, chain="ideal")
    for _ in range(1500):
        data.qfrc_applied[0] = 5.0
        mujoco.mj_step(model, data)
        touch.update(data)
    reading, balance = touch.reading, touch.balance
    assert reading.touching == ("b", "a")
    assert reading.force == pytest.approx([5.0, 5.0], rel=1e-3)
    # the two halves of one path: what one loses the other gains
    assert reading.temperature_drop[1] > 1.0
    assert reading.temperature_drop[0] == pytest.approx(-reading.temperature_drop[1], rel=1e-6)
    assert isinstance(balance.passed, np.ndarray) and balance.passed[0, 1] < -0.1 and not balance.given.any()


SHAPES = {
    "box": '<geom name="{0}" type="box" size=".01 .01 .008" mass=".1"/>',
    "small box": '<geom name="{0}" type="box" size=".003 .006 .008" mass=".1"/>',
    "ball": '<geom name="{0}" type="sphere" size=".008" mass=".1"/>',
    "capsule": '<geom name="{0}" type="capsule" size=".008 .012" euler="0 90 0" mass=".1"/>',
    "turned capsule": '<geom name="{0}" type="capsule" size=".008 .012" euler="0 90 30" mass=".1"/>',
}


def pinched(
    low: str,
    high: str,
    names: tuple[str, str],
    skins: tuple[str | None, str | None] = (None, None),
    sensors: tuple[str, str] = ("seed", "seed"),
    aside: tuple[float, float] = (0.001, 0.001),
    turn: float = 0.0,
) -> list[float]:
    """K that the low and the high fingertip feel of one another, named in that order, .5 s after they were pressed.
    aside: m, turn: degrees, of the high one."""
    model = mujoco.MjModel.from_xml_string(f"""
    <mujoco><option timestep=".002" gravity="0 0 0"/><worldbody>
      <body name="block" pos=".1 0 0"><geom name="block" type="box" size=".02 .02 .02"/></body>
      <body name="low"> {SHAPES[low].format("low")} </body>
      <body name="high" pos="{aside[0]} {aside[1]} .0165" euler="0 0 {turn}">
        <joint type="slide" axis="0 0 -1" damping="20"/>
        {SHAPES[high].format("high")} </body>
    </worldbody></mujoco>""")
    tips = {
        "low": Fingertip("low", temperature=46.0, skin=skins[0], sensor=sensors[0]),
        "high": Fingertip("high", skin=skins[1], sensor=sensors[1]),
    }
    touch = ThermalTouch(
        model, fingertips={name: tips[name] for name in names}, objects={"block": "glass"}, chain="ideal"
    )
    data = mujoco.MjData(model)
    for _ in range(250):
        data.qfrc_applied[0] = 5.0
        mujoco.mj_step(model, data)
        touch.update(data)
    drops = dict(zip(names, touch.reading.temperature_drop.tolist(), strict=True))
    return [drops["low"], drops["high"]]


@pytest.mark.parametrize("skins", [(None, None), ("filled_silicone", None), (None, "filled_silicone")])
@pytest.mark.parametrize(
    ("low", "high"),
    [("box", "box"), ("box", "small box"), ("ball", "box"), ("box", "turned capsule"), ("capsule", "ball"),
     ("capsule", "turned capsule"), ("ball", "ball")],
)  # fmt: skip
def test_the_order_in_which_two_fingertips_are_named_changes_nothing(
    low: str, high: str, skins: tuple[str | None, str | None]
) -> None:
    drops = pinched(low, high, ("low", "high"), skins)
    assert drops[0] > 0.1
    assert drops == pytest.approx(pinched(low, high, ("high", "low"), skins), rel=5e-3)


@pytest.mark.parametrize(
    ("low", "high", "where"),
    [
        ("box", "box", {"sensors": ("seed", "biotac_like")}),
        ("ball", "capsule", {"sensors": ("seed", "biotac_like")}),
        ("small box", "capsule", {"aside": (0.005, 0.0)}),
        ("small box", "ball", {"aside": (0.0, 0.0), "turn": 45.0}),
        ("box", "box", {"aside": (0.005, 0.0), "turn": 30.0}),
        ("box", "small box", {"aside": (0.003, 0.002), "turn": 20.0}),
    ],
)
def test_nor_does_it_where_they_are_aside_turned_or_of_other_sensors(
    low: str, high: str, where: dict
) -> None:
    drops = pinched(low, high, ("low", "high"), **where)
    assert drops[0] > 0.05
    assert drops == pytest.approx(pinched(low, high, ("high", "low"), **where), rel=5e-3)


def test_a_fingertip_between_another_and_an_object_hands_heat_on() -> None:
    model = mujoco.MjModel.from_xml_string(TWO_TIPS.format(offset=0.0))
    tips = {"a": "a", "b": Fingertip("b", temperature=46.0)}
    touch = ThermalTouch(model, fingertips=tips, objects={"block": "aluminium"})
    heat = JoinedHeat(
        touch._pads, (), touch._shapes, worlds=1, dt=0.01, tolerance=0.05, film=0.0, ambient=24.0
    )
    touches = np.zeros((1, 2, 3, COLUMNS))
    touches[0, 0, :, CONDUCTANCE] = 1.0, 0.0, 1.0  # on the block and on the other
    touches[0, 0, 0, PLACE : PLACE + 3], touches[0, 0, 0, NORMAL : NORMAL + 3] = (0, 0, 0.02), (0, 0, -1)
    for _ in range(3000):
        heat.advance(touches, 1)
    # it is warmed by the other and cooled by the block: its element hands on what both conduct at its face
    balance, element = heat.balance(0), touch._pads[0].stack
    resists = sum(layer.thickness / layer.conductivity for layer in element.layers) / element.face_area
    sensed = element.layers[element.sensed]
    sensed = sensed.thickness / sensed.conductivity / element.face_area
    kelvin = heat.object_temperature[0, 0] - 36.0
    # of the faces' temperatures in a steady state: both elements from their thermostats, and the block
    ends, links = np.array([0.0, 10.0]), 1 / resists
    matrix = np.array([[links + 2.0, -1.0], [-1.0, links + 1.0]])
    faces = np.linalg.solve(matrix, links * ends + np.array([kelvin, 0.0]))
    np.testing.assert_allclose(heat.drop[0], (ends - faces) * links * sensed, rtol=0.05)
    error = balance.objects.sum() - balance.given.sum()
    assert abs(error) < 1e-10 * np.abs(balance.given).sum()
