"""What a fingertip of somebody else's scene feels is what it does in a press of the same conductance."""

# mujoco ships no type stubs for its compiled names
# pyright: reportAttributeAccessIssue=false

import math
from typing import Literal

import mujoco
import numpy as np
import pytest

from thermograsp.thermal import (
    LAPPED_ALUMINA,
    SKINS,
    THERMOSTAT_FACE,
    Surface,
    Thermostat,
    contact_conductance,
    joint,
    material,
    press,
)
from thermograsp.thermal.contact import Pad, face_joint, flat_contact, skinned
from thermograsp.thermal.stack import heated_core, heated_stack
from thermograsp.touch import Fingertip, SensorElement, ThermalBody, ThermalTouch
from thermograsp.touch.contacts import COLUMNS, CONDUCTANCE, NORMAL, PLACE

from .hand import ONE_PRESS


@pytest.mark.parametrize(
    ("name", "cone", "skin"),
    [
        ("wood", "elliptic", None),
        ("glass", "elliptic", None),
        ("glass", "pyramidal", None),
        ("stainless_steel", "elliptic", None),
        ("aluminium", "elliptic", None),
        ("aluminium", "elliptic", "filled_silicone"),
    ],
)
def test_one_fingertip_on_a_box_feels_what_a_press_does(name: str, cone: str, skin: str | None) -> None:
    model = mujoco.MjModel.from_xml_string(ONE_PRESS.format(cone=cone))
    data = mujoco.MjData(model)
    tips = {"tip": Fingertip("tip", skin=skin)}
    touch = ThermalTouch(model, fingertips=tips, objects={"block": name}, air=0.0, chain="ideal")
    data.ctrl[0] = 10.0
    drops, times, reading = [], [], touch.reading
    for _ in range(2000):
        mujoco.mj_step(model, data)
        reading = touch.update(data)
        if not times and not reading.touching[0]:
            continue
        if reading.time not in times:
            times.append(reading.time)
            drops.append(reading.temperature_drop[0])
    assert reading.force[0] == pytest.approx(10.0, rel=1e-3)
    worn = None if skin is None else SKINS[skin]
    pressure = float(flat_contact(skinned(Pad(), worn), 10.0).face_pressure)
    h = float(contact_conductance(face_joint(worn, Surface.of(material(name))), pressure))
    size = (0.04, 0.04, 0.04)
    curves = press(name, skin=skin, conductance=h, object_size=size, seconds=4.0, dt=0.02, tolerance=0.01)
    # the touch began within the first reading, at some force that is still rising
    late = np.array(times) - times[0] > 0.3
    expected = np.interp(np.array(times) - times[0] + 0.02, curves.t, curves.temperature_drop)
    assert np.abs(np.array(drops) - expected)[late].max() < 0.05 + 0.02


@pytest.mark.parametrize("name", ["glass", "aluminium"])
def test_a_pad_that_is_narrower_than_the_sensor_touches_with_what_it_bears_of_it(name: str) -> None:
    """A bar of 4 mm bears 4 x 9 mm of the sensor's face, which a press takes as a square: finite volumes of aluminium
    at 1e4 W/(m2 K) are 0.2 K below that, and 2.5 K below the whole face."""
    model = mujoco.MjModel.from_xml_string(
        ONE_PRESS.format(cone="elliptic").replace('size=".01 .01 .004"', 'size=".002 .01 .004"')
    )
    assert model.geom("tip").size[0] == 0.002
    data = mujoco.MjData(model)
    touch = ThermalTouch(
        model, fingertips={"tip": "tip"}, objects={"block": name}, air=0.0, chain="ideal", tolerance=0.02
    )
    data.ctrl[0] = 10.0
    drops, times = [], []
    for _ in range(2000):
        mujoco.mj_step(model, data)
        reading = touch.update(data)
        if reading.touching[0] and reading.time not in times:
            times.append(reading.time)
            drops.append(reading.temperature_drop[0])
    area = 0.004 * 0.009
    sheet = Pad(width=math.sqrt(0.004 * 0.02), face=math.sqrt(area))
    pressure = float(flat_contact(sheet, 10.0).face_pressure)
    h = float(contact_conductance(face_joint(None, Surface.of(material(name))), pressure))
    size = (0.04, 0.04, 0.04)
    curves = press(name, conductance=h, area=area, object_size=size, seconds=4.0, dt=0.02, tolerance=0.02)
    late = np.array(times) - times[0] > 0.3
    expected = np.interp(np.array(times) - times[0] + 0.02, curves.t, curves.temperature_drop)
    assert np.abs(np.array(drops) - expected)[late].max() < 0.1


@pytest.mark.parametrize(
    ("preset", "name"),
    [("heated_thermistor", "wood"), ("heated_thermistor", "aluminium"), ("biotac_like", "aluminium")],
)
def test_a_heated_sensor_reads_what_it_does_in_a_press(preset: str, name: str) -> None:
    """Its heater cut or kept at constant power, its core cooling: the reading, not only the drop."""
    model = mujoco.MjModel.from_xml_string(ONE_PRESS.format(cone="elliptic"))
    data = mujoco.MjData(model)
    sensor = heated_stack(preset)
    touch = ThermalTouch(
        model,
        fingertips={"tip": Fingertip("tip", sensor=preset)},
        objects={"block": name},
        air=0.0,
        chain="ideal",
    )
    assert sensor.divider.temperature(touch.reading.voltage) == pytest.approx(36.0, abs=0.01)
    data.ctrl[0] = 10.0
    found, times = [], []
    for _ in range(3000):
        mujoco.mj_step(model, data)
        reading = touch.update(data)
        if (times or reading.touching[0]) and reading.time not in times:
            times.append(reading.time)
            found.append(float(sensor.divider.temperature(reading.voltage[0, -1])))
    faces = joint(LAPPED_ALUMINA, Surface.of(material(name)))
    h = float(contact_conductance(faces, 10.0 / 0.02**2))
    curves = press(
        name,
        sensor=preset,
        conductance=h,
        force=10.0,
        area=heated_core(sensor, 0.01).element.face_area,
        object_size=(0.04, 0.04, 0.04),
        seconds=6.0,
        tolerance=0.01,
    )
    assert curves.reading is not None
    since = np.array(times) - times[0] + 0.02
    expected = np.interp(since, curves.t, curves.reading)
    assert expected[-1] < 35.0
    # the recorder's smoothing looks ahead
    assert np.abs(found - expected)[since > 0.5].max() < 0.05


def test_two_fingers_on_thin_glass_feel_each_other_as_in_a_press() -> None:
    tips = "".join(
        f"""<body name="tip{n}" pos="0 0 {0.0057 * side}">
              <joint type="slide" axis="0 0 {-side}" damping="20"/>
              <geom type="box" size=".0045 .0045 .004" mass=".1"/></body>"""
        for n, side in enumerate((1, -1))
    )
    model = mujoco.MjModel.from_xml_string(f"""<mujoco><option timestep=".002" gravity="0 0 0"/><worldbody>
        <body name="sheet"><geom type="box" size=".02 .02 .0015"/></body>{tips}</worldbody></mujoco>""")
    data = mujoco.MjData(model)
    touch = ThermalTouch(
        model, fingertips={"a": "tip0", "b": "tip1"}, objects={"sheet": "glass"}, air=0.0, chain="ideal"
    )
    for _ in range(3000):
        data.qfrc_applied[:] = 5.0
        mujoco.mj_step(model, data)
        touch.update(data)
    assert touch.reading.force == pytest.approx([5.0, 5.0], rel=1e-3)
    faces = joint(LAPPED_ALUMINA, Surface.of(material("glass")))
    h = float(contact_conductance(faces, 5.0 / 0.009**2))
    alone, both = (
        press(
            "glass",
            conductance=h,
            opposite=opposite,
            object_size=(0.04, 0.04, 0.003),
            seconds=6.0,
            tolerance=0.02,
        )
        for opposite in (None, h)
    )
    assert touch.reading.temperature_drop == pytest.approx([both.temperature_drop[-1]] * 2, abs=0.05)
    assert alone.temperature_drop[-1] > both.temperature_drop[-1] + 0.2


@pytest.mark.parametrize(("name", "mode"), [("glass", "T"), ("aluminium", "T"), ("aluminium", "O")])
def test_a_thermostat_of_finite_power_cools_as_in_a_press(name: str, mode: Literal["T", "O"]) -> None:
    model = mujoco.MjModel.from_xml_string(ONE_PRESS.format(cone="elliptic"))
    data = mujoco.MjData(model)
    weak = Thermostat(power_limit=0.3, heat_capacity=1.0)
    glued = [SensorElement((0, 0, 0.02), (0, 0, 1))] if mode == "O" else []
    tip = Fingertip("tip", sensor=None if mode == "O" else "seed", thermostat=weak)
    objects = {"block": ThermalBody(name, elements=glued)}
    touch = ThermalTouch(model, fingertips={"tip": tip}, objects=objects, air=0.0, chain="ideal")
    data.ctrl[0] = 10.0
    drops, times = [], []
    for _ in range(3000):
        mujoco.mj_step(model, data)
        reading = touch.update(data)
        if (times or reading.touching[0]) and reading.time not in times:
            times.append(reading.time)
            drops.append(reading.element_drop[0] if mode == "O" else reading.temperature_drop[0])
    if mode == "O":
        h = float(contact_conductance(joint(LAPPED_ALUMINA, THERMOSTAT_FACE), 10.0 / 0.009**2))
    else:
        h = float(contact_conductance(joint(LAPPED_ALUMINA, Surface.of(material(name))), 10.0 / 0.02**2))
    size = (0.04, 0.04, 0.04)
    curves, ideal = (
        press(
            name,
            mode=mode,
            conductance=h,
            thermostat=kind,
            object_size=size,
            seconds=6.0,
            tolerance=0.01,
            rung="network",
        )
        for kind in (weak, None)
    )
    since = np.array(times) - times[0] + 0.02
    expected = np.interp(since, curves.t, curves.temperature_drop)
    difference = np.abs(np.array(drops) - expected)[since > 0.3].max()
    # the ideal one would be far off, and what is left is that of the networks
    assert ideal.temperature_drop[-1] - expected[-1] > 0.3
    assert difference < 0.07
    first = touch.reset()
    assert first.temperature_drop[0] == 0.0


@pytest.mark.parametrize("name", ["wood", "aluminium"])
def test_a_smaller_tolerance_is_nearer_to_a_press(name: str) -> None:
    model = mujoco.MjModel.from_xml_string(ONE_PRESS.format(cone="elliptic"))
    conductance = 3e4  # W/(m2 K), from the start on
    curves = press(
        name, conductance=conductance, object_size=(0.04, 0.04, 0.04), seconds=5.0, dt=0.01, tolerance=0.003
    )
    for tolerance in (0.05, 0.02):
        touch = ThermalTouch(
            model, fingertips={"tip": "tip"}, objects={"block": name}, air=0.0, tolerance=tolerance
        )
        touches, drops = np.zeros((1, 1, 2, COLUMNS)), []
        touches[0, 0, 0, CONDUCTANCE] = conductance * 81e-6
        touches[0, 0, 0, PLACE : PLACE + 3], touches[0, 0, 0, NORMAL : NORMAL + 3] = (0, 0, 0.02), (0, 0, -1)
        for _ in range(500):
            touch._heat.advance(touches, 1)
            drops.append(touch._heat.drop[0, 0])
        error = np.abs(np.array(drops) - curves.temperature_drop[1:])[4:].max()
        assert error < tolerance / 3


@pytest.mark.slow
@pytest.mark.parametrize("name", ["stainless_steel", "polypropylene"])
def test_the_air_cools_a_sheet_where_it_is_warm(name: str) -> None:
    """A grid in three dimensions has the film at every place. Where the air took heat by the sheet's mean temperature
    alone, steel was .13 K below it."""
    size, film = (0.06, 0.06, 0.0001), 10.0
    text = ONE_PRESS.format(cone="elliptic").replace('size=".02 .02 .02"', 'size=".03 .03 .00005"')
    text = text.replace('<body name="tip" pos="0 0 .0241">', '<body name="tip" pos="0 0 .00395">')
    model = mujoco.MjModel.from_xml_string(text)
    assert np.allclose(2 * model.geom("block").size, size)
    data = mujoco.MjData(model)
    touch = ThermalTouch(model, fingertips={"tip": "tip"}, objects={"block": name}, air=film, chain="ideal")
    data.ctrl[0] = 10.0
    drops = []
    for n in range(2500):
        mujoco.mj_step(model, data)
        reading = touch.update(data)
        if n % 50 == 49:
            drops.append(reading.temperature_drop[0])
    pressure = float(flat_contact(Pad(), 10.0).face_pressure)
    h = float(contact_conductance(face_joint(None, Surface.of(material(name))), pressure))
    curves = press(name, conductance=h, object_size=size, air=film, seconds=5.0, dt=0.1, rung="grid_3d")
    assert np.abs(np.array(drops) - curves.temperature_drop[1:])[5:].max() < 0.05
