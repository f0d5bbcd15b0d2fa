"""What a reading tells, and the order in which noise is drawn."""

# mujoco ships no type stubs for its compiled names
# pyright: reportAttributeAccessIssue=false

import copy
import importlib.util
import pickle
from pathlib import Path

import mujoco
import numpy as np
import pytest

from thermograsp.touch import ThermalTouch
from thermograsp.touch.readings import NOISE_BLOCK, Noise

_spec = importlib.util.spec_from_file_location("hand", Path(__file__).with_name("hand.py"))
assert _spec and _spec.loader
hand = importlib.util.module_from_spec(_spec)
_spec.loader.exec_module(hand)

PADS = {name: f"{name}_pad" for name in hand.FINGERS}


def used(noise: Noise, samples: int) -> np.ndarray:
    """(samples, W, S) of the next samples, as the compiled code takes them."""
    found = []
    for _ in range(samples):
        found.append([noise.ahead[w, at].copy() for w, at in enumerate(noise.at.tolist())])
        noise.at += 1
        for w in np.flatnonzero(noise.at == NOISE_BLOCK).tolist():
            noise.draw(w)
    return np.array(found)


def test_noise_is_what_the_generators_give_sample_by_sample() -> None:
    noise, alone = Noise([3, 4], 5), [np.random.default_rng(3), np.random.default_rng(4)]
    for count in (7, NOISE_BLOCK, 2 * NOISE_BLOCK - 7, 1):
        for got in used(noise, count):
            np.testing.assert_array_equal(got, [rng.standard_normal(5) for rng in alone])
        np.testing.assert_array_equal(noise.take(0, 3), alone[0].standard_normal((3, 5)))
        for w, rng in enumerate(alone):
            assert noise.state(w) == rng.bit_generator.state


def test_a_state_in_the_middle_of_a_block_goes_on_alike() -> None:
    noise, other = Noise([1], 2), Noise([9], 2)
    used(noise, 11)
    other.set_state(0, noise.state(0))
    np.testing.assert_array_equal(used(noise, 50), used(other, 50))


def test_a_reading_and_a_copied_touch() -> None:
    model, data = hand.hand()
    touch = ThermalTouch(model, fingertips=PADS, objects={"can": "aluminium"}, seed=0)
    hand.press(data, 8.0)
    for _ in range(102):
        mujoco.mj_step(model, data)
        touch.update(data)
    first, pickled = touch.reading, pickle.dumps(touch.reading)
    for _ in range(103):
        mujoco.mj_step(model, data)
        touch.update(data)
    assert first.time < touch.reading.time
    again = pickle.loads(pickled)
    for name in ("voltage", "temperature_drop", "force", "beside", "element_voltage", "element_drop"):
        np.testing.assert_array_equal(getattr(first, name), getattr(again, name))
    assert (again.touching, again.object_temperature) == (first.touching, first.object_temperature)
    assert repr(again) == repr(first) and "touching=('can'" in repr(first)
    with pytest.raises(AttributeError, match="does not change"):
        first.time = 0.0  # pyright: ignore[reportAttributeAccessIssue]
    other, later = copy.deepcopy(touch), copy.copy(data)
    for _ in range(50):
        mujoco.mj_step(model, data)
        mujoco.mj_step(model, later)
        np.testing.assert_array_equal(touch.update(data).voltage, other.update(later).voltage)
