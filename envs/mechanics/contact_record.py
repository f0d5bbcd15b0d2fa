"""Forces and poses at every substep of a control step, to examine single contacts; environments need less (Motion).

Shapes: B environments, S substeps, T = 2 fingertips (left, right), O objects.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np

FULL_RECORD: tuple = ("sensordata", "site_xmat", "site_xpos", "qpos", "qvel")
"""What mujoco.batch is to record of every substep."""


@dataclass(frozen=True, slots=True)
class ContactRecord:
    """What happened at each substep of one control step; arrays of their own, never overwritten later.

    force (B, S, T, O, 3) N: net force of the fingertip on the object in the pad's frame: normal (out of the
    pad, > 0 when pressing), horizontal, and towards the wrist (a held object's weight shows as > 0).
    touching (B, S, T, O) bool: whether there was any contact.
    centroid (B, S, T, O, 2) m: force-weighted centre of the contact from the pad's middle, along the pad's two
    tangential axes; 0 where nothing touches.
    place (B, 1, T, O, 3) m: the pad's middle in the object's frame at the last substep, touching or not.
    opening (B, S) m, opening_rate (B, S) m/s, height (B, S) m over the lowest position.
    object_pose (B, S, O, 7): position m and quaternion (w, x, y, z), world frame.
    failed (B,) bool: the simulation broke down (see Mechanics.failure); ignore that environment's other rows.

    Forces act during a substep; opening, height and pose are those at its end.
    """

    force: np.ndarray
    touching: np.ndarray
    centroid: np.ndarray
    place: np.ndarray
    opening: np.ndarray
    opening_rate: np.ndarray
    height: np.ndarray
    object_pose: np.ndarray
    failed: np.ndarray


def contact_record(
    out: dict[str, np.ndarray], contacts: tuple[int, int, int], poses: slice, at: Any, failed: np.ndarray
) -> ContactRecord:
    """The ContactRecord of a rollout's FULL_RECORD. contacts: fingertips, objects and numbers of a contact sensor.
    poses: the objects' in qpos. at: ADDRESSES. failed: (B,)."""
    qpos, qvel, positions = out["qpos"], out["qvel"], out["site_xpos"]
    # (B, S, T, O, found force position), in the world's frame
    sensed = out["sensordata"].reshape(*qpos.shape[:2], *contacts)
    vectors = sensed[..., 1:].reshape(*sensed.shape[:-1], 2, 3).copy()
    vectors[..., 1, :] -= positions[:, :, :, None]
    axes = out["site_xmat"].reshape(*sensed.shape[:3], 1, 1, 3, 3)
    # Written out: a matmul's rounding may depend on the number of environments.
    x, y, z = (axes[..., i, :] * vectors[..., i : i + 1] for i in range(3))
    local = x + y + z
    touching = sensed[..., 0] > 0
    objects = qpos[..., poses].reshape(*qpos.shape[:2], -1, 7).copy()
    before = max(qpos.shape[1] - 2, 0)  # the pads are where they were before the last substep
    return ContactRecord(
        force=local[..., 0, :].copy(),
        touching=touching,
        centroid=np.where(touching[..., None], local[..., 1, 1:], 0.0),
        place=_in_frame(positions[:, -1:, :, None], objects[:, before : before + 1, None]),
        opening=qpos[..., at.left] + qpos[..., at.right],
        opening_rate=qvel[..., at.left_dof] + qvel[..., at.right_dof],
        height=qpos[..., at.height].copy(),
        object_pose=objects,
        failed=failed,
    )


def _in_frame(point: np.ndarray, pose: np.ndarray) -> np.ndarray:
    """Points (..., 3) of the world in the frames of poses (..., 7), written out so that rounding is each row's own."""
    x, y, z = (point[..., i] - pose[..., i] for i in range(3))
    w, a, b, c = pose[..., 3], -pose[..., 4], -pose[..., 5], -pose[..., 6]
    p, q, r = 2 * (b * z - c * y), 2 * (c * x - a * z), 2 * (a * y - b * x)
    return np.stack(
        (x + w * p + (b * r - c * q), y + w * q + (c * p - a * r), z + w * r + (a * q - b * p)), axis=-1
    )
