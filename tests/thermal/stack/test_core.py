"""Heated sensors in presses, identification and fits, beside the chain that `touch_curves` steps and shares no code
with."""

from dataclasses import replace
from typing import Any

import numpy as np
import pytest

from thermograsp import thermal
from thermograsp.errors import InvalidValueError
from thermograsp.thermal.curves import UnitCurves
from thermograsp.thermal.matter import Layer
from thermograsp.thermal.stack import (
    Backing,
    ConstantPower,
    CutAtContact,
    HeatedStack,
    Held,
    Off,
    Pid,
    Place,
    Recorder,
    Sample,
    Touches,
    heated_core,
    heated_stack,
    touch_curves,
)

SHIPPED = heated_stack("heated_thermistor")
PLAIN = replace(SHIPPED, recorder=Recorder())
LEAKY = Backing(capacity=3e3, loss=100.0)
WARM, COLD = 32.0, 22.0
ONE_DIMENSION: dict[str, Any] = {"object_size": (0.009, 0.009, 0.01)}  # as wide as the sensor


def pressed(sensor: HeatedStack, material: str = "wood", **keywords: Any) -> thermal.Press:
    keywords = {"sensor_temperature": WARM, "object_temperature": COLD, "seconds": 4.0, **keywords}
    return thermal.press(material, sensor=sensor, tolerance=0.01, cache=False, **keywords)


def marched(sensor: HeatedStack, material: str = "wood", force: float = 4.0) -> np.ndarray:
    """The same touch in one dimension. The power before is what its loss takes."""
    what, t = thermal.material(material), np.arange(0.0, 4.001, 0.02)
    sample = Sample(what.conductivity, what.volumetric_heat_capacity, 0.01)
    one = np.ones(1)
    forces = np.full((1, len(t)), force)
    touches = Touches(t, forces, WARM * one, 0 * one, COLD * one, COLD * one)
    return touch_curves(sensor, [sample], touches).recorded[0]


@pytest.mark.parametrize(
    "sensor",
    [
        PLAIN,
        replace(PLAIN, law=Held()),
        replace(PLAIN, backing=Backing(capacity=500.0, effusivity=400.0), law=Off()),
        replace(PLAIN, backing=Backing(capacity=2e3), law=ConstantPower(800.0)),
        replace(PLAIN, backing=Backing(capacity=2e3), law=Pid(WARM, 2e3, 500.0, 3e3)),
        replace(PLAIN, backing=Backing(capacity=2e3), readout=Place(0, 0.5)),
        replace(PLAIN, backing=Backing(), law=ConstantPower(800.0)),
    ],
    ids=["cut", "held", "half-space", "constant", "pid", "read inside the film", "nothing behind"],
)
def test_a_press_of_one_dimension_is_the_chain(sensor: HeatedStack) -> None:
    assert pressed(sensor, **ONE_DIMENSION).reading == pytest.approx(marched(sensor), abs=0.03)


def test_a_heater_inside_the_stack_and_a_readout_behind_it() -> None:
    layers = (Layer("core", 3e-3, 0.3, 1500.0, 1200.0), *PLAIN.layers)
    inside = replace(
        PLAIN, layers=layers, heater=Place(0, 0.6), readout=Place(0, 0.2), law=ConstantPower(500.0)
    )
    assert pressed(inside, **ONE_DIMENSION).reading == pytest.approx(marched(inside), abs=0.03)


def test_a_constant_power_keeps_a_leaking_sensor_where_it_is_until_it_touches() -> None:
    leaky = replace(PLAIN, backing=LEAKY, law=ConstantPower())
    untouched = pressed(leaky, conductance=0.0).reading
    assert untouched is not None
    assert untouched == pytest.approx(WARM, abs=1e-6)
    off = replace(leaky, law=Off())
    assert pressed(off, **ONE_DIMENSION).reading == pytest.approx(marched(off), abs=0.03)


def test_the_heater_is_cut_when_the_force_says_so() -> None:
    leaky = replace(PLAIN, backing=LEAKY, law=CutAtContact(2.0))
    light = pressed(leaky, force=1.5).reading
    late = pressed(leaky, force=lambda time: 1.5 if time < 2 else 2.5, conductance=300.0).reading
    on = pressed(replace(leaky, law=ConstantPower()), force=1.5, conductance=300.0).reading
    assert light is not None and late is not None and on is not None
    assert late[:101] == pytest.approx(on[:101], abs=1e-6)
    assert late[-1] < on[-1] - 0.02


def test_voltage_and_record_are_the_sensors_own() -> None:
    found = pressed(SHIPPED)
    assert found.reading is not None
    assert found.voltage == pytest.approx(SHIPPED.divider.voltage(found.reading))
    bare = pressed(PLAIN).reading
    assert bare is not None
    assert 0.001 < np.abs(found.reading - bare).max() < 0.1
    assert thermal.press("wood", sensor="seed", seconds=1.0, rung="layered").reading is None


@pytest.mark.parametrize(
    ("keywords", "message"),
    [
        ({"mode": "O"}, "heater of its own"),
        ({"thermostat": thermal.Thermostat()}, "heater of its own"),
        ({"rung": "layered"}, "heater's own law"),
        ({"force": -1.0}, r"force \(N\) must be a finite number, 0 or above"),
    ],
)
def test_what_a_heated_press_refuses(keywords: dict[str, Any], message: str) -> None:
    with pytest.raises(InvalidValueError, match=message):
        pressed(SHIPPED, **keywords)


def test_a_force_is_of_heated_sensors() -> None:
    with pytest.raises(InvalidValueError, match="takes a conductance"):
        thermal.press("wood", force=3.0)


@pytest.mark.parametrize(
    ("changes", "message"),
    [
        ({"heater": Place(1, 1.0)}, "heater is at its face"),
        ({"readout": Place(1, 0.5)}, r"2 layers \(film, cover\) lie between"),
    ],
)
def test_what_no_core_can_stand_for_is_refused_with_the_reason(changes: dict[str, Any], message: str) -> None:
    with pytest.raises(InvalidValueError, match=message):
        heated_core(replace(PLAIN, **changes), 0.01)


@pytest.mark.parametrize("loss", [0.0, 200.0])
def test_identification_expects_what_a_press_steps(loss: float) -> None:
    """The one by impedances of network and core, the other by turns."""
    sensor = replace(PLAIN, backing=replace(PLAIN.backing, loss=loss))
    setup = thermal.TouchSetup(stack=sensor, sensor_temperature=(WARM, 0.1), object_temperature=(COLD, 1.0))
    wood = thermal.material("wood")
    found = pressed(sensor, conductance=1500.0)
    assert found.reading is not None
    unit = UnitCurves(setup.geometry(wood), found.t, core=setup.core).on(wood)
    expected = (WARM - COLD) * unit(np.array([1500.0]))[0]
    assert WARM - found.reading == pytest.approx(expected, abs=0.03)


@pytest.mark.slow
def test_what_was_pressed_is_identified() -> None:
    """From voltages of the converter that a thermistor's divider has, of 4 s."""
    setup = thermal.TouchSetup(
        stack=PLAIN, sensor_temperature=(WARM, 0.05), object_temperature=(COLD, 0.5), conductance=(5e2, 5e3)
    )
    among = ("cork", "wood", "glass", "stainless_steel", "aluminium")
    rng = np.random.default_rng(0)
    for name in ("wood", "glass"):
        found = pressed(PLAIN, name)
        volts = found.voltage + setup.noise * rng.standard_normal(len(found.t))
        verdict = thermal.identify(found.t, volts, setup=setup, candidates=among, touch=0.0, cache=False)
        assert verdict.best == name
        assert verdict.difference[0] == pytest.approx(WARM - COLD, abs=1.0)


def test_a_film_is_fitted_to_touches_of_known_objects() -> None:
    t = np.arange(-0.5, 4.0, 0.02)
    touches = []
    for name in ("wood", "aluminium"):
        found = pressed(PLAIN, name, object_size=(0.04, 0.04, 0.01), seconds=5.0)
        volts = np.interp(t, found.t, found.voltage)
        touches.append(thermal.KnownTouch(name, t, volts, thermal.material(name), WARM - COLD))
    film, cover = PLAIN.layers
    start = replace(PLAIN, layers=(replace(film, conductivity=1.4 * film.conductivity), cover))
    fit = thermal.fit_sensor(touches, start=start, hold=("heat_capacity", "delay"))
    assert isinstance(fit.stack, HeatedStack)
    assert fit.stack.layers[0].conductivity == pytest.approx(film.conductivity, rel=0.03)
    assert fit.stack.layers[1] == cover
    contact = PLAIN.contact.at(np.array(PLAIN.contact.force))
    assert [h.value for h in fit.conductances] == pytest.approx([contact, contact], rel=0.1)


def test_identification_and_fit_name_what_they_cannot_serve() -> None:
    controlled = replace(PLAIN, law=Pid(WARM, 2e3, 500.0, 3e3))
    with pytest.raises(InvalidValueError, match="a controller that cannot cool"):
        thermal.TouchSetup(stack=controlled)
    touch = thermal.KnownTouch(
        "a", np.linspace(-1, 2, 50), np.linspace(1.7, 1.6, 50), thermal.material("wood"), WARM - COLD
    )
    for sensor, message in (
        (controlled, "a controller that cannot cool"),
        (replace(PLAIN, backing=LEAKY), "loses heat behind"),
        (replace(PLAIN, readout=Place(0, 0.0)), "read at its heater"),
        (replace(PLAIN, readout=Place(0, 0.5)), "inside a layer"),
    ):
        with pytest.raises(InvalidValueError, match=message):
            thermal.fit_sensor([touch], start=sensor)
    with pytest.raises(InvalidValueError, match="5.1 V is not between 0 and the 0.33 V"):
        thermal.fit_sensor([replace(touch, voltage=touch.voltage + 3.4)], start=PLAIN)
