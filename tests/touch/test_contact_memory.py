"""Contacts are read where MuJoCo keeps them: those of its bindings, of copies, and where the bindings say less."""

# mujoco ships no type stubs for its compiled names
# pyright: reportAttributeAccessIssue=false

import copy
import ctypes
import importlib.util
from pathlib import Path

import mujoco
import numpy as np
import pytest

from thermograsp.touch import ThermalTouch
from thermograsp.touch.contacts import memory

_spec = importlib.util.spec_from_file_location("hand", Path(__file__).with_name("hand.py"))
assert _spec and _spec.loader
hand = importlib.util.module_from_spec(_spec)
_spec.loader.exec_module(hand)

PADS = {name: f"{name}_pad" for name in hand.FINGERS}


def pressed(steps: int) -> tuple[mujoco.MjModel, mujoco.MjData, ThermalTouch]:
    model, data = hand.hand()
    touch = ThermalTouch(model, fingertips=PADS, objects={"can": "aluminium"}, seed=0)
    hand.press(data, 8.0)
    go(model, data, touch, steps)
    return model, data, touch


def go(model: mujoco.MjModel, data: mujoco.MjData, touch: ThermalTouch, steps: int) -> None:
    for _ in range(steps):
        mujoco.mj_step(model, data)
        touch.update(data)


def test_addresses_are_those_of_the_bindings_arrays() -> None:
    _, data, _ = pressed(200)
    assert data.ncon > 3
    table, found = memory.ContactMemory(data).table, data.contact
    first, force, kind = (
        np.ctypeslib.as_array((ctypes.c_int64 * 1).from_address(int(at)))[0] for at in table[:3]
    )
    assert (force, kind) == (data.efc_force.ctypes.data, data.efc_type.ctypes.data)
    for name, column in (
        ("pos", memory.POS),
        ("frame", memory.FRAME),
        ("geom", memory.GEOM),
        ("dim", memory.DIM),
    ):
        array = getattr(found, name)
        assert first + table[column] * array.itemsize == array.ctypes.data
        assert array.strides[0] == table[memory.STRIDE]


def test_friction_cones_may_change_at_any_time() -> None:
    """A normal force of pyramids is the sum of their edges, of an elliptic cone its first number; with the
    cones that the model began with, fingers of 8 N were read as 2 N."""
    model, data, touch = pressed(200)
    for cone in (mujoco.mjtCone.mjCONE_PYRAMIDAL, mujoco.mjtCone.mjCONE_ELLIPTIC):
        model.opt.cone = cone
        go(model, data, touch, 100)
        np.testing.assert_allclose(touch.reading.force + touch.reading.beside, 8.0, rtol=0.01)


def test_a_copy_reads_its_own_contacts() -> None:
    model, data, touch = pressed(200)
    both = copy.deepcopy({"data": data, "touch": touch})
    go(model, data, touch, 100)
    expected = touch.reading
    hand.press(data, -5.0)
    go(model, data, touch, 100)  # the first lets go; the copy must not hear it
    go(model, both["data"], both["touch"], 100)
    np.testing.assert_array_equal(both["touch"].reading.voltage, expected.voltage)
    np.testing.assert_array_equal(both["touch"].reading.force, expected.force)
    assert (expected.force > 1).all()


def test_the_clock_is_the_datas_time_and_number_of_contacts() -> None:
    for steps in (1, 200):
        _, data, _ = pressed(steps)
        clock = memory.ContactMemory(data).clock
        assert clock is not None
        assert ctypes.c_double.from_address(clock[0]).value == data.time
        assert ctypes.c_int32.from_address(clock[1]).value == data.ncon


@pytest.mark.parametrize("unknown", ["_places", "_clock"])
def test_bindings_that_do_not_say_where_an_mjdata_is_serve_too(
    unknown: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    _, _, touch = pressed(200)
    monkeypatch.setattr(memory, unknown, lambda: None)
    _, _, other = pressed(200)
    np.testing.assert_array_equal(other.reading.voltage, touch.reading.voltage)
    np.testing.assert_array_equal(other.reading.force, touch.reading.force)
    assert (other.reading.force > 1).all()
