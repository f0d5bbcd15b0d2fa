"""Recorded steps, felt by a ThermalTouch and by its arrays."""

# mujoco ships no type stubs for its compiled names
# pyright: reportAttributeAccessIssue=false

from collections.abc import Iterable
from typing import Any

import mujoco
import numpy as np

from thermograsp.touch import ThermalTouch


def felt_alike(
    touch: ThermalTouch, model: mujoco.MjModel, controls: Iterable[Any], samples: int, within: float
) -> np.ndarray:
    """(F,) K at last, which arrays have within so many K after each of so many samples of each control."""
    fixed = touch.fixed_touch(like=np.zeros(0))
    state, data, drop = fixed.start(), mujoco.MjData(model), np.zeros(0)
    for control in controls:
        data.ctrl[:] = control
        for _ in range(samples):
            record = np.empty((1, fixed.substeps, model.nsensordata))
            for k in range(fixed.substeps):
                mujoco.mj_step(model, data)
                record[:, k] = data.sensordata
            drop = touch.update(record).temperature_drop
            state, reading = fixed.advance(state, fixed.contacts(record))
            np.testing.assert_allclose(reading.temperature_drop, drop, rtol=0, atol=within)
    return drop
