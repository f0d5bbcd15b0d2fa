"""Observations of readings with any number of voltage samples."""

import numpy as np
import pytest

from thermograsp.envs.spaces import Observer
from thermograsp.plant import Reading

HISTORY = 16


def reading(voltage: np.ndarray) -> Reading:
    """Of two environments; voltage: (S,) V of both fingertips of the first, half of it of the second's."""
    samples = np.stack([voltage, voltage / 2])[:, :, None].repeat(2, axis=2)
    still = np.zeros(2)
    return Reading(
        opening=still,
        opening_rate=still,
        height=still,
        force=np.zeros((2, 2, 3)),
        voltage=samples,
        thermostat=np.full((2, 2), 36.0),
        truth={},
        error=("", ""),
    )


@pytest.mark.parametrize("count", [0, 1, 2, HISTORY - 1, HISTORY, HISTORY + 3])
def test_the_newest_voltages_are_kept_however_many_come_in_a_step(count: int) -> None:
    observer, limit, both = Observer(2), np.zeros(2), np.ones(2, bool)
    first = observer.observe(reading(np.full(1, 0.001)), limit, both)["voltage"]
    assert np.all(first[0] == np.float32(0.001)) and np.all(first[1] == np.float32(0.0005))
    newer = 0.002 + 1e-4 * np.arange(count)
    wanted = np.concatenate((np.full(HISTORY, 0.001), newer))[-HISTORY:].astype(np.float32)
    shown = observer.observe(reading(newer), limit, np.array([True, False]))["voltage"]
    assert np.array_equal(shown[0], np.stack([wanted] * 2))
    assert np.array_equal(shown[1], first[1])  # not seen
    observer.restart(np.array([0]))
    begun = observer.observe(reading(np.full(2, 0.003)), limit, both)["voltage"]
    assert np.all(begun[0] == np.float32(0.003))
