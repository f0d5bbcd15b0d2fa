"""A pure step of fingertips on fixed places, beside ThermalTouch.update."""

# mujoco ships no type stubs for its compiled names
# pyright: reportAttributeAccessIssue=false

import importlib.util
from pathlib import Path

import mujoco
import numpy as np
import pytest

from thermograsp.errors import InvalidValueError
from thermograsp.thermal import Thermostat
from thermograsp.touch import Fingertip, ThermalTouch
from thermograsp.touch.contacts import AREA, CONDUCTANCE

_spec = importlib.util.spec_from_file_location("hand", Path(__file__).with_name("hand.py"))
assert _spec and _spec.loader
hand = importlib.util.module_from_spec(_spec)
_spec.loader.exec_module(hand)

PADS = {name: f"{name}_pad" for name in hand.FINGERS}


def grasped() -> tuple[mujoco.MjModel, mujoco.MjData, ThermalTouch]:
    """Three fingers on a can since half a second."""
    model, data = hand.hand()
    touch = ThermalTouch(model, fingertips=PADS, objects={"can": "aluminium"}, chain="ideal")
    hand.press(data, 10.0)
    for _ in range(250):
        mujoco.mj_step(model, data)
        touch.update(data)
    return model, data, touch


def test_it_gives_the_numbers_of_update() -> None:
    model, data, touch = grasped()
    for _ in range(2):  # of the five of a sample: where the pads are is known, and no heat has flowed
        mujoco.mj_step(model, data)
        touch.update(data)
    heat, fixed = touch._heat, touch.fixed_places(np.zeros(0))
    assert fixed.pairs == tuple((name, "can") for name in hand.FINGERS)
    assert fixed.fingertips == hand.FINGERS
    state, rng = fixed.start(2), np.random.default_rng(0)
    touches, drop, cold = touch._reader.touches.copy(), np.zeros((2, 3)), touch.reading.temperature_drop
    touches[..., AREA] = 0.0  # over the whole faces, which are what fixed places know
    for step in range(200):
        # all in touch for a second: to round-off. Then some are apart, whose fields fade by the step's rational
        # function here, within 3e-6 of the exponential, and by the exponential there.
        conducting = rng.uniform(0.1, 1.5, 3) * (rng.random(3) < 0.8 if step >= 100 else 1.0)
        touches[0, :, 0, CONDUCTANCE] = conducting
        heat.advance(touches, 1)
        state, drop = fixed.advance(state, np.stack((conducting, 0 * conducting)))
        np.testing.assert_allclose(drop[0], heat.drop[0], rtol=0, atol=1e-10 if step < 100 else 1e-5)
    # the second row's fingertips are apart and warm up again
    assert (0 < drop[1]).all() and (drop[1] < 0.6 * cold).all()


def test_what_cannot_stay_is_refused() -> None:
    model, _, touch = grasped()
    fixed = touch.fixed_places(np.zeros(0))
    with pytest.raises(InvalidValueError, match="3 pairs"):
        fixed.advance(fixed.start(1), np.zeros((1, 2)))
    with pytest.raises(InvalidValueError, match="worlds"):
        touch.fixed_places(np.zeros(0), world=1)
    with pytest.raises(InvalidValueError, match="floating point"):
        touch.fixed_places(np.zeros(0, int))
    touch.reset()
    with pytest.raises(InvalidValueError, match="has touched anything"):
        touch.fixed_places(np.zeros(0))
    weak = {"thumb": Fingertip("thumb_pad", thermostat=Thermostat())}
    with pytest.raises(InvalidValueError, match="ideal thermostats alone"):
        ThermalTouch(model, fingertips=weak, objects={"can": "glass"}).fixed_places(np.zeros(0))
