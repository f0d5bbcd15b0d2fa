"""A scripted grasp that tests share: close, lift by 5 cm once both fingertips press, hold."""

from __future__ import annotations

from typing import Any

import numpy as np

from thermograsp.envs import action_of


def grasp_action(batch: Any, force: float = 10.0) -> np.ndarray:
    """Actions (B, 3) for a GraspBatch."""
    reading = batch.reading
    pressing = np.all(reading.force[:, :, 0] > 0.8 * force, axis=1)
    rate = np.where(pressing & (reading.truth["lift"] < 0.052), 0.05, 0.0)
    return np.stack([action_of(0.0, force, float(value)) for value in rate])
