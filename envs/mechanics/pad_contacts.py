"""Where on its pads a gripper presses, and how pads and objects lie to each other.

B: environments, S: substeps, T = 2 fingertips.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from thermograsp.compiled import njit

from .kernel import into_frame


class PadContacts(NamedTuple):
    """Where the pads pressed on one object in one control step. force (B, T) N: mean normal force over the substeps.
    centre (B, T, 2) m: its centre, MuJoCo's contact centroids weighted by the substeps' normal forces, along the pad's
    two tangential axes. pad (B, T, 4, 3): the pad in the object's frame when the last substep began: its middle, m, its
    normal, out of the pad, and the two tangential axes."""

    force: np.ndarray
    centre: np.ndarray
    pad: np.ndarray


@njit(cache=True, error_model="numpy")
def pad_contacts(layout, sensors, positions, axes, bodies, quaternions, force, centre, pad):
    """Fills a PadContacts' arrays from what MuJoCo recorded: sensors (B, S, n), the pads' positions (B, S, T, 3) and
    axes (B, S, T, 9), and from all bodies' positions (B, bodies, 3) and quaternions (B, bodies, 4). layout: mechanics'
    ADDRESSES."""
    at = layout[0]
    rows, substeps = sensors.shape[0], sensors.shape[1]
    tips = force.shape[1]
    objects = sensors.shape[2] // (tips * at.sensor)
    turned, nowhere = np.zeros(3), np.zeros(3)
    for b in range(rows):
        for t in range(tips):
            first = (t * objects + at.object) * at.sensor
            total, pushed, y, z = 0.0, 0.0, 0.0, 0.0
            for s in range(substeps):
                record, frame, place = sensors[b, s, first : first + 7], axes[b, s, t], positions[b, s, t]
                normal = frame[0] * record[1] + frame[3] * record[2] + frame[6] * record[3]
                total += normal
                if record[0] > 0 and normal > 0:
                    pushed += normal
                    for k in range(3):
                        y += normal * frame[3 * k + 1] * (record[4 + k] - place[k])
                        z += normal * frame[3 * k + 2] * (record[4 + k] - place[k])
            force[b, t] = max(total / substeps, 0.0) if pushed > 0 else 0.0
            centre[b, t, 0] = y / pushed if pushed > 0 else 0.0
            centre[b, t, 1] = z / pushed if pushed > 0 else 0.0
            frame, place = axes[b, substeps - 1, t], positions[b, substeps - 1, t]
            into_frame(place, bodies[b, at.body], quaternions[b, at.body], pad[b, t, 0])
            for axis in range(3):
                for k in range(3):
                    turned[k] = frame[3 * k + axis]
                into_frame(turned, nowhere, quaternions[b, at.body], pad[b, t, 1 + axis])
