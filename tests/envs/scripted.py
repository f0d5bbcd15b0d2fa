"""What tests of environments share: a scripted grasp, and what each heat sample felt of it."""

from __future__ import annotations

from typing import Any

import numpy as np

from thermograsp.envs import GraspBody, action_of
from thermograsp.envs.sensing.heat import GraspHeat

SAMPLE = 0.01  # s, of heat


def grasp_action(batch: Any, force: float = 10.0) -> np.ndarray:
    """Actions (B, 3) for a GraspBatch: close, lift by 5 cm once both fingertips press, hold."""
    reading = batch.reading
    pressing = np.all(reading.force[:, :, 0] > 0.8 * force, axis=1)
    rate = np.where(pressing & (reading.truth["lift"] < 0.052), 0.05, 0.0)
    return np.stack([action_of(0.0, force, float(value)) for value in rate])


def watched_contacts(heat: Any) -> list[tuple[np.ndarray, np.ndarray]]:
    """Fills, step by step from now on, with the forces and places that a GraspHeat or SceneHeat is given."""
    seen, advance = [], heat.advance

    def watched(force: np.ndarray, place: np.ndarray):
        seen.append((force.copy(), place.copy()))
        return advance(force, place)

    heat.advance = watched
    return seen


def sampled_conductance(contacts: list[tuple[np.ndarray, np.ndarray]], body: GraspBody) -> np.ndarray:
    """W/(m2 K) (samples, F) of the first environment's first object, the mean over each heat sample's substeps, two to
    a step."""
    one = GraspHeat(1, tolerance=0.05, air=0.0, dt=SAMPLE, samples=1, sensor_temperature=36.0)
    one.reset([0], [body])
    conductances = []
    for force, place in contacts:
        first = force[:1] if force.ndim == 3 else force[:1, 0]
        at = place[:1] if force.ndim == 3 else place[:1, 0]
        conductances += [one.advance(half, at).info["conductance"][0] for half in np.split(first, 2, axis=1)]
    return np.array(conductances)
