"""Heated stacks against closed forms, balances and themselves on finer grids."""

from dataclasses import replace

import numpy as np
import pytest
from scipy.special import erfcx

from thermograsp.thermal.matter import Layer
from thermograsp.thermal.stack import (
    Backing,
    ConstantPower,
    CutAtContact,
    ForceContact,
    HeatedStack,
    Held,
    Pid,
    Place,
    Sample,
    Touches,
    stack_network,
    touch_curves,
)
from thermograsp.thermal.stack.cells import stack_chain

WOOD = Sample(0.15, 600 * 1700)
METAL = Sample(237.0, 2700 * 897)
T = np.arange(0.0, 4.001, 0.02)


def touches(force: float = 4.0, start: float = 30.0, warming: float = 0.0, sample: float = 20.0) -> Touches:
    one = np.ones(1)
    return Touches(T, np.full((1, len(T)), force), start * one, warming * one, sample * one, sample * one)


def pad(conductance: float = 2000.0, **others: object) -> HeatedStack:
    layers = (
        Layer("foam", 1e-3, 0.05, 100.0, 1400.0),
        Layer("cover", 1e-3, 0.5, 1500.0, 1400.0),
    )
    contact = ForceContact(conductance, exponent=1.0)
    return replace(HeatedStack("pad", layers, Place(1, 0.0), Place(0, 0.0), contact), **others)


def block(conductance: float) -> HeatedStack:
    """A half-space of 600 W s^0.5/(m2 K), read at its face."""
    layer = Layer("block", 1e-4, 0.3, 1200.0, 1000.0)
    contact = ForceContact(conductance)
    backing = Backing(effusivity=600.0)
    return HeatedStack("block", (layer,), Place(0, 1.0), Place(0, 0.0), contact, backing=backing)


def test_two_half_spaces_meet_between_their_temperatures() -> None:
    reading = touch_curves(block(1e9), [WOOD], touches()).reading[0]
    meeting = (600 * 30 + WOOD.effusivity * 20) / (600 + WOOD.effusivity)
    assert np.abs(reading[T > 0.5] - meeting).max() < 0.02


def test_two_half_spaces_with_a_resistance_between_them() -> None:
    """Carslaw & Jaeger, section 2.8: the face falls by 10 K e2/(e1+e2) (1 - exp(z^2) erfc z)."""
    h = 500.0
    reading = touch_curves(block(h), [WOOD], touches()).reading[0]
    z = h * np.sqrt(T) * (1 / 600 + 1 / WOOD.effusivity)
    exact = 30 - 10 * WOOD.effusivity / (600 + WOOD.effusivity) * (1 - erfcx(z))
    assert np.abs(reading - exact)[T > 0.1].max() < 0.02


def test_a_held_back_and_a_metal_divide_the_difference_by_resistances() -> None:
    stack = pad(law=Held())
    long = replace(touches(), t=100 * T)
    reading = touch_curves(stack, [Sample(1e6, 1e8)], long).reading[0, -1]
    foam, rest = 1e-3 / 0.05, 1e-3 / 0.5 + 1 / 2000
    assert reading == pytest.approx(20 + 10 * rest / (foam + rest), abs=0.05)


@pytest.mark.parametrize(
    "law", [ConstantPower(200.0), CutAtContact(2.0, 200.0), Pid(30.0, 300.0, 50.0, 2000.0)]
)
def test_heat_is_conserved(law: ConstantPower | CutAtContact | Pid) -> None:
    found = touch_curves(pad(law=law), [WOOD], touches())
    given, passed = found.power.sum() * 0.02, found.flow.sum() * 0.02
    assert found.gained[0, 1] == pytest.approx(passed, abs=1e-6)
    assert found.gained.sum() == pytest.approx(given, abs=1e-6)


def test_the_grid_converges_at_second_order(monkeypatch: pytest.MonkeyPatch) -> None:
    from thermograsp.thermal.stack import touch

    ends = {}
    for intervals in (2, 4, 8, 32):
        monkeypatch.setattr(touch, "stack_chain", lambda stack, n=intervals: stack_chain(stack, n))
        ends[intervals] = touch_curves(pad(), [METAL], touches()).reading[0, 50:]
    errors = [np.abs(ends[n] - ends[32]).max() for n in (2, 4, 8)]
    rate = -np.polyfit(np.log([2, 4, 8]), np.log(errors), 1)[0]
    assert rate == pytest.approx(2.0, abs=0.2)
    assert errors[1] < 0.02


def test_a_sensor_that_warms_goes_on_as_before_until_the_cut() -> None:
    stack = pad(law=CutAtContact(2.0), backing=Backing(capacity=1e4))
    untouched = replace(touches(warming=0.1), force=np.zeros((1, len(T))))
    rise = touch_curves(stack, [WOOD], untouched, warm_up=60.0).reading[0]
    assert rise[-1] - rise[0] == pytest.approx(0.1 * T[-1], rel=0.02)
    force = np.where(T < 1.0, 0.0, 4.0)[None]
    found = touch_curves(stack, [WOOD], replace(untouched, force=force), warm_up=60.0)
    assert (found.power[0, T[:-1] < 1.0] > 0).all()
    assert (found.power[0, T[:-1] >= 1.0] == 0).all()


def test_a_controller_holds_its_setpoint_and_is_cut_with_contact() -> None:
    law = Pid(setpoint=32.0, proportional=300.0, integral=100.0, limit=3000.0)
    long = replace(touches(force=0.0), t=20 * T)
    leaky = pad(law=law, backing=Backing(loss=50.0))
    found = touch_curves(leaky, [WOOD], long)
    assert found.reading[0, -1] == pytest.approx(32.0, abs=0.05)
    assert found.power.max() <= 3000.0
    cut = touch_curves(pad(law=replace(law, cut=2.0)), [WOOD], replace(long, force=np.full((1, len(T)), 3.0)))
    assert (cut.power == 0).all()


def test_contact_follows_force_above_the_preload() -> None:
    contact = ForceContact(1000.0, force=4.0, exponent=0.95, preload=1.0, gap=8.0)
    h = contact.at(np.array([0.0, 1.0, 2.5, 4.0]))
    assert h == pytest.approx([8.0, 8.0, 8 + 1000 * 0.5**0.95, 1008.0])
    slow, fast = (touch_curves(pad(), [METAL], touches(force)).reading[0, -1] for force in (1.0, 4.0))
    assert fast < slow


def test_the_place_of_the_readout_orders_what_is_read() -> None:
    ends = [
        touch_curves(pad(readout=p), [METAL], touches()).reading[0, 10]
        for p in (Place(0, 0.5), Place(1, 0.5))
    ]
    assert ends[0] > ends[1]


def test_the_network_is_passive_and_steps_as_the_stack_does() -> None:
    stack, area = pad(law=ConstantPower(500.0), backing=Backing(capacity=2e3)), 1e-4
    untouched = replace(touches(), force=np.zeros((1, len(T))))
    fine = touch_curves(stack, [WOOD], untouched).reading[0] - 30
    network = stack_network(stack, area)
    assert (network.rates >= 0).all() and network.rates[0] == 0
    for used, tolerance in ((network, 2e-3), (stack_network(stack, area, order=5), 0.02)):
        grown = np.where(
            used.rates > 0, -np.expm1(-np.outer(T, used.rates)) / np.maximum(used.rates, 1e-300), T[:, None]
        )
        assert (grown * used.outputs["reading"]) @ used.ports[:, 1] * 500 * area == pytest.approx(
            fine, abs=tolerance
        )
    stored = 1 / network.ports[0, 0] ** 2
    assert stored == pytest.approx(stack_chain(stack).capacity.sum() * area)


def test_a_plate_that_insulates_behind_warms_more_than_a_half_space() -> None:
    thin = replace(WOOD, thickness=5e-4)
    ends = [touch_curves(pad(), [sample], touches()).reading[0, -1] for sample in (thin, WOOD)]
    assert ends[0] > ends[1] + 0.5
