"""O mode: sensor elements that are glued on objects, touched by bare thermostats."""

# mujoco ships no type stubs for its compiled names
# pyright: reportAttributeAccessIssue=false

import pickle
from typing import Any

import mujoco
import numpy as np
import pytest

from thermograsp.errors import InvalidValueError
from thermograsp.thermal import LAPPED_ALUMINA, THERMOSTAT_FACE, contact_conductance, joint, press
from thermograsp.touch import Fingertip, SensorElement, ThermalBody, ThermalTouch

SCENE = """
<mujoco>
  <option timestep=".002" gravity="0 0 0"/>
  <worldbody>
    <body name="block"><geom name="block" type="box" size=".02 .02 .005"/></body>
    <body name="ball" pos=".2 0 0"><geom type="sphere" size=".02"/></body>
    <body name="tip" pos="{x} 0 .0091">
      <joint name="tip" type="slide" axis="0 0 -1" damping="20"/>
      <geom name="tip" type="box" size=".01 .01 .004" mass=".1"/>
    </body>
  </worldbody>
  <actuator><motor joint="tip"/></actuator>
</mujoco>"""
TOP = SensorElement((0, 0, 0.005), (0, 0, 1))
BARE = {"tip": Fingertip("tip", sensor=None)}


def touching(body: ThermalBody, fingertips: dict = BARE, x: float = 0.0, **words: object) -> ThermalTouch:
    model = mujoco.MjModel.from_xml_string(SCENE.format(x=x))
    words = {"air": 0.0, "chain": "ideal", **words}
    return ThermalTouch(model, fingertips=fingertips, objects={"block": body}, **words)  # pyright: ignore


def run(touch: ThermalTouch, seconds: float, force: float = 10.0) -> tuple[np.ndarray, np.ndarray]:
    """Times since the touch, s, and drops of the elements, K."""
    data = mujoco.MjData(touch.model)
    data.ctrl[0] = force
    times, drops, begun = [], [], None
    for _ in range(round(seconds / 0.002)):
        mujoco.mj_step(touch.model, data)
        reading = touch.update(data)
        if begun is None and reading.touching[0]:
            begun = reading.time
        if begun is not None and (not times or reading.time - begun + 0.02 > times[-1] + 1e-9):
            times.append(reading.time - begun + 0.02)
            drops.append(reading.element_drop)
    return np.array(times), np.array(drops)


@pytest.mark.parametrize("name", ["wood", "glass", "stainless_steel", "aluminium"])
def test_a_glued_element_reads_what_it_does_in_a_press(name: str) -> None:
    touch = touching(ThermalBody(name, elements=[TOP]))
    times, drops = run(touch, 4.0)
    # a pad of 20 mm lies on the element of 9 mm alone
    h = float(contact_conductance(joint(LAPPED_ALUMINA, THERMOSTAT_FACE), 10.0 / 0.009**2))
    size = (0.04, 0.04, 0.01)
    curves = press(name, mode="O", conductance=h, object_size=size, seconds=4.0, tolerance=0.01)
    expected = np.interp(times, curves.t, curves.temperature_drop)
    # the touch began within the first reading, at a force that is still rising
    assert np.abs(drops[:, 0] - expected)[times > 0.3].max() < 0.02
    assert touch.elements == ("block:0",) and touch.reading.touching == ("block",)
    # the bare thermostat has no element of its own
    assert not touch.reading.temperature_drop.any()
    balance = touch.balance
    assert isinstance(balance.given, np.ndarray) and balance.given[0, 0] > 0.1
    error = balance.objects.sum() + balance.air - balance.given.sum()
    assert abs(error) < 1e-10 * balance.given.sum()


def test_an_element_is_read_where_a_pad_reaches_it_and_nowhere_else() -> None:
    aside = SensorElement((0.014, 0.014, 0.005), (0, 0, 1))
    pad = Fingertip("tip", position=(0, 0, -0.004), normal=(0, 0, -1), size=(0.02, 0.02), sensor=None)
    below = SensorElement((0, 0, -0.005), (0, 0, -1))
    touch = touching(ThermalBody("aluminium", elements=[aside, below]), {"tip": pad}, x=-0.01, air=5.0)
    _, drops = run(touch, 2.0)
    # the pad is beside the first and over the second's back: the bare metal warms the block, which warms both
    assert touch.balance.given[0, 0] > 1.0  # pyright: ignore[reportAttributeAccessIssue]
    assert (drops[-1] < -0.1).all() and drops.max() < 0.01
    balance = touch.balance
    error = balance.objects.sum() + balance.air - balance.given.sum()  # pyright: ignore[reportAttributeAccessIssue]
    assert abs(error) < 1e-10 * balance.given.sum()  # pyright: ignore[reportAttributeAccessIssue]


def test_elements_start_as_warm_as_their_object_and_are_remembered() -> None:
    hot = ThermalBody("glass", temperature=60.0, elements=[TOP])
    one, two = touching(hot, seed=1), touching(hot, seed=2)
    run(one, 1.0)
    assert one.reading.element_drop[0] < -5.0
    two.set_state(pickle.loads(pickle.dumps(one.state())))
    np.testing.assert_array_equal(one.reading.element_voltage, two.reading.element_voltage)
    one.reset(temperatures={"block": 36.0})
    run(one, 0.5)
    assert np.abs(one.reading.element_drop).max() < 1e-9
    plain = touching(ThermalBody("glass"))
    with pytest.raises(InvalidValueError, match="another ThermalTouch, whose elements"):
        plain.set_state(two.state())


def test_a_fingertip_with_a_sensor_of_its_own_is_in_series_with_an_element() -> None:
    touch = touching(ThermalBody("aluminium", elements=[TOP]), {"tip": "tip"})
    run(touch, 8.0)
    drop, glued = float(touch.reading.temperature_drop[0]), float(touch.reading.element_drop[0])
    # by then as much heat goes through either, and the two share what one would have
    assert glued == pytest.approx(drop, rel=0.15) and 3.0 < glued < 6.0


WRONG: list[tuple[dict[str, Any], str]] = [
    ({"position": (0, 0, 0.003), "normal": (0, 0, 1)}, "mm off the face"),
    ({"position": (0, 0, 0.005), "normal": (0, 0, -1)}, "mm off the face"),
    ({"position": (0, 0, 0.005), "normal": (0, 1, 1)}, "not that of a face"),
    ({"position": (0.018, 0, 0.005), "normal": (0, 0, 1)}, "over the edge"),
    ({"position": (0.001, 0, 0.005), "normal": (0, 0, 1)}, "lie over each other"),
]


@pytest.mark.parametrize(("words", "said"), WRONG)
def test_a_place_that_is_none_is_refused(words: dict[str, Any], said: str) -> None:
    with pytest.raises(InvalidValueError, match=said):
        touching(ThermalBody("glass", elements=[TOP, SensorElement(**words)]))


def test_what_elements_cannot_be_on_is_refused() -> None:
    model = mujoco.MjModel.from_xml_string(SCENE.format(x=0))
    objects = {"ball": ThermalBody("glass", elements=[SensorElement((0, 0, 0.02), (0, 0, 1))])}
    with pytest.raises(InvalidValueError, match=r"one box, and 'ball' is .*sphere"):
        ThermalTouch(model, fingertips=BARE, objects=objects)
    for position, normal in (((0, 0), (0, 0, 1)), ((0, 0, 0), (0, 0, 0))):
        with pytest.raises(InvalidValueError, match="SensorElement"):
            SensorElement(position, normal)  # pyright: ignore[reportArgumentType]
