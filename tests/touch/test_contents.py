"""What is in a vessel of anyone's scene: beside lumped bodies in closed form, an empty vessel, books of heat, states,
worlds, and what is refused."""

# mujoco ships no type stubs for its compiled names
# pyright: reportAttributeAccessIssue=false

from __future__ import annotations

import copy
import pickle
from typing import Any

import mujoco
import numpy as np
import pytest
from scipy.linalg import expm

from thermograsp.errors import InvalidValueError
from thermograsp.thermal import Reservoir, ice, water
from thermograsp.touch import Fingertip, ThermalBody, ThermalTouch, install, prepare

from .engine_scene import NEEDS_RECORDS, NEEDS_SPECS
from .test_own_shapes import felt, mesh, spec, touch_of

ROOM = 24.0  # °C
AIR = 10.0  # W/(m2 K)


def vessel() -> mujoco.MjModel:
    """A closed box with walls of 1 mm, and a fingertip above it."""
    return spec(mesh("tray"), 0.015).compile()


def filled(inside: Reservoir | None, name: str = "ceramic", celsius: float = ROOM, **words: Any) -> Any:
    """A ThermalTouch of the vessel, and its data."""
    model = vessel()
    touch = touch_of(model, ThermalBody(name, celsius, contents=inside), **words)
    return touch, mujoco.MjData(model)


def residue(touch: ThermalTouch) -> float:
    """J that have come from nowhere, as a share of what has flowed."""
    balance = touch.balance
    gained = balance.objects.sum() + balance.air - balance.given.sum() - balance.contents.sum()
    return abs(gained) / (np.abs(balance.contents).sum() + np.abs(balance.given).sum())


def test_a_thin_metal_vessel_and_its_water_are_two_lumped_bodies() -> None:
    """Between which, and to the room, heat flows by films; nothing touches it."""
    inside = water(0.02, 0.8, 80.0)
    touch, data = filled(inside, "aluminium", air=AIR)
    felt(touch, data, 8.0, 0.0, 0.0)
    (shape,) = touch._shapes
    capacities, to_room = np.array([shape.heat_capacity, inside.heat_capacity]), AIR * shape.surface
    film = inside.conductance
    rates = np.array([[-film - to_room, film], [film, -film]]) / capacities[:, None]
    wall, held = ROOM + expm(8.0 * rates) @ np.array([0.0, 80.0 - ROOM])
    assert wall > ROOM + 10.0
    reading = touch.reading
    assert reading.object_temperature["thing"] == pytest.approx(wall, abs=0.01)
    assert reading.contents_temperature["thing"] == pytest.approx(held, abs=0.01)
    assert residue(touch) < 1e-10


def test_contents_behind_no_film_to_speak_of_are_not_felt() -> None:
    """An empty vessel's network has other modes and local kernels."""
    drops = []
    for inside in (None, Reservoir(100.0, 1e-4)):
        touch, data = filled(inside)
        drops.append(felt(touch, data, 1.5, 10.0, 0.0)[:, 0])
    assert drops[0][-1] > 2.0
    np.testing.assert_allclose(drops[0], drops[1], atol=0.05)


@pytest.mark.parametrize(
    "inside",
    [
        water(0.02, 4.0, 80.0),
        ice(2e-3, 4.0),
        Reservoir(np.inf, 4.0, 70.0),
        Reservoir(30.0, 4.0, 30.0, power=20.0, setpoint=60.0),
    ],
    ids=["water", "ice", "held", "heater"],
)
def test_heat_goes_from_fingertip_to_walls_contents_and_room_to_round_off(inside: Reservoir) -> None:
    """Also while the fingertip slides to another place and lets go."""
    touch, data = filled(inside, "plastic", air=AIR)
    empty, alone = filled(None, "plastic", air=AIR)
    last, bare = 0.0, 0.0
    for move in ((1.0, 10.0, 0.0), (0.4, 10.0, 0.006), (0.3, -3.0, 0.006)):
        drops = felt(touch, data, *move)[:, 0], felt(empty, alone, *move)[:, 0]
        last, bare = (each[10] if move[1] > 0 else now for each, now in zip(drops, (last, bare), strict=True))
        assert residue(touch) < 1e-10
    celsius = touch.reading.contents_temperature["thing"]
    assert (last - bare) * (celsius - ROOM) < -0.05  # of hot contents less is felt
    if inside.latent_heat or np.isinf(inside.heat_capacity):
        assert celsius == inside.temperature
    else:
        supplied = 1.7 * inside.power - touch.balance.contents[0]
        assert inside.temperature is not None
        assert celsius == pytest.approx(inside.temperature + supplied / inside.heat_capacity, abs=1e-9)


def test_half_the_step_changes_little() -> None:
    """Contents and walls take turns, half a step each."""
    inside, found = Reservoir(60.0, 40.0, 80.0), []
    for dt in (0.02, 0.002):
        touch, data = filled(inside, dt=dt)
        found.append((*felt(touch, data, 1.0, 10.0, 0.0)[-1], *touch.reading.contents_temperature.values()))
    np.testing.assert_allclose(*found, atol=0.05)


def test_objects_without_a_hollow_meet_their_contents_at_the_mean() -> None:
    """Such as a block with a heater in it."""
    model = spec('type="box" size=".02 .02 .01"', 0.01).compile()
    inside = Reservoir(50.0, 3.0, 70.0)
    touch, data = touch_of(model, ThermalBody("steel", contents=inside)), mujoco.MjData(model)
    felt(touch, data, 4.0, 0.0, 0.0)
    block = touch._shapes[0].heat_capacity
    mixed = (block * ROOM + 50.0 * 70.0) / (block + 50.0)
    left = np.exp(-4.0 * 3.0 * (1 / block + 1 / 50.0))
    reading = touch.reading
    assert reading.object_temperature["thing"] == pytest.approx(mixed + (ROOM - mixed) * left, abs=0.02)
    assert reading.contents_temperature["thing"] == pytest.approx(mixed + (70.0 - mixed) * left, abs=0.02)


def told(touch: ThermalTouch) -> tuple[Any, ...]:
    reading = touch.reading
    return reading.temperature_drop.tolist(), reading.object_temperature, reading.contents_temperature


def test_states_copies_and_resets_keep_it() -> None:
    touch, data = filled(water(0.02, 4.0), celsius=60.0)
    assert touch.reading.contents_temperature == {"thing": 60.0}
    felt(touch, data, 0.6, 10.0, 0.0)
    before = copy.copy(data)
    saved, copied = pickle.loads(pickle.dumps(touch.state())), copy.deepcopy(touch)
    felt(touch, data, 0.4, 10.0, 0.0)
    expected = told(touch)
    other, _ = filled(water(0.02, 4.0), celsius=60.0)
    other.set_state(saved)
    for each in (copied, other):
        felt(each, copy.copy(before), 0.4, 10.0, 0.0)
        assert told(each) == expected
    assert told(touch) == expected and residue(other) < 1e-10
    reading = touch.reset(data, temperatures={"thing": 5.0})
    assert reading.contents_temperature == {"thing": 5.0} == reading.object_temperature
    own, _ = filled(water(0.02, 4.0, 80.0))
    assert own.reset(temperatures={"thing": 5.0}).contents_temperature == {"thing": 80.0}
    with pytest.raises(InvalidValueError, match="contents differ|whose contents are"):
        own.set_state(saved)


@NEEDS_RECORDS
def test_worlds_are_as_each_alone() -> None:
    model = prepare(spec(mesh("tray"), 0.015), {"tip": "tip"}, {"thing": "steel"})
    made_of = [ThermalBody(name, contents=water(0.02, 4.0, 80.0)) for name in ("ceramic", "wood")]
    every = touch_of(model, made_of, worlds=2)
    single = [touch_of(model, each, worlds=1) for each in made_of]
    data = mujoco.MjData(model)
    data.ctrl[:] = 10.0, 0.0
    for _ in range(40):
        record = np.empty((1, 10, model.nsensordata))
        for n in range(10):
            mujoco.mj_step(model, data)
            record[0, n] = data.sensordata
        for touch, times in ((every, 2), *((each, 1) for each in single)):
            touch.update(np.repeat(record, times, axis=0))
    warm = inside(every)
    np.testing.assert_array_equal(warm, [inside(each)[0] for each in single])
    drops = [each.reading.temperature_drop[0] for each in single]
    np.testing.assert_array_equal(every.reading.temperature_drop, drops)
    assert np.ptp(warm) > 0.01
    every.reset(worlds=[1])
    assert inside(every)[1] == 80.0 > inside(every)[0] == warm[0]
    with pytest.raises(InvalidValueError, match="the same in every world"):
        every.reset(worlds=[1], objects={"thing": ThermalBody("wood", contents=water(0.02, 5.0))})


def inside(touch: ThermalTouch) -> np.ndarray:
    """(W,) °C of the contents."""
    return np.asarray(touch.reading.contents_temperature["thing"])


def test_what_cannot_be_is_refused() -> None:
    inside = ThermalBody("ceramic", contents=water(0.02, 4.0))
    touch, data = touch_of(vessel(), inside), mujoco.MjData(vessel())
    felt(touch, data, 0.1, 10.0, 0.0)
    for ask in (touch.fixed_places, touch.fixed_touch):
        with pytest.raises(InvalidValueError, match="leave contents= of the objects out"):
            ask(np.zeros(0))
    with pytest.raises(InvalidValueError, match="leave surround= of the fingertips out"):
        touch_of(vessel(), inside, fingertips={"tip": Fingertip("tip", surround="silicone")})
    with pytest.raises(InvalidValueError, match="A box has no hollow"):
        both = {"tip": Fingertip("tip", skin="filled_silicone"), "other": Fingertip("other")}
        ThermalTouch(spec(mesh("tray"), 0.015, 2).compile(), fingertips=both, objects={"thing": inside})
    with pytest.raises(InvalidValueError, match=r"contents must be a thermal\.Reservoir"):
        ThermalBody("ceramic", contents=80.0)  # pyright: ignore[reportArgumentType]


@NEEDS_SPECS
def test_the_plugin_knows_no_contents() -> None:
    inside = ThermalBody("ceramic", contents=water(0.02, 4.0))
    with pytest.raises(InvalidValueError, match="knows no contents"):
        install(spec(mesh("tray"), 0.015), fingertips={"tip": "tip"}, objects={"thing": inside})
