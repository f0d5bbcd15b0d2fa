"""What mechanics does around MuJoCo's own steps, compiled row by row: set points before, forces and poses after.

B: environments, O: objects, S: substeps, T = 2 fingertips, W: kinds of MuJoCo's warnings.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from thermograsp.compiled import njit

from ..limits import LIFT_ACCELERATION, MAX_FORCE, MAX_LIFT_RATE, MAX_OPENING, OPENING_SPEED

_WINDUP = 0.002  # m, how far the set point runs beyond where the force limit is reached
_STILL, _SHORT = (
    0.005,
    0.0002,
)  # m/s, m: slower than this, and this far from the target, the fingers are blocked


_NAMES = (
    *("left", "right", "left_dof", "right_dof", "height"),
    *("grip", "lift", "grip_act", "lift_act", "poses", "body", "sensor", "object"),
)
ADDRESSES = np.dtype([(name, "i8") for name in _NAMES])
"""Where things are in a model: the fingers' and the lift's joints in qpos, the fingers' in qvel, the actuators in ctrl,
their set points in act, an object's pose in qpos, its body, numbers of a contact sensor, and which object it is.
Kernels take it as an array of one record, which costs less to hand over than a tuple."""


class Motion(NamedTuple):
    """One control step of every gripper and its objects. normal (B, O, S, T) N on the pads at each substep, 0 where
    nothing touches. force (B, O, T, 3) N, the mean over the substeps of the fingertip's force on the object in the
    pad's frame. place (B, O, T, 3) m: the pads' middles in the object's frame at the end. opening m, opening_rate m/s
    and height m of the arm, all (B,), and object_height (B, O) m at the end."""

    normal: np.ndarray
    force: np.ndarray
    place: np.ndarray
    opening: np.ndarray
    opening_rate: np.ndarray
    height: np.ndarray
    object_height: np.ndarray

    def of(self, number: int) -> Motion:
        """That of one object, without the axis O."""
        return self._replace(
            normal=self.normal[:, number],
            force=self.force[:, number],
            place=self.place[:, number],
            object_height=self.object_height[:, number],
        )


@njit(cache=True, short_loops=True, error_model="numpy")
def set_points(
    layout, opening, force, lift_rate, duration, stiffness,
    qpos, qvel, act, ctrl, force_range, warnings, warned,
):  # fmt: skip
    """Writes rates of the two servos' set points over the coming control step into ctrl, and the force limits.

    The grip's set point moves to the target. Where something blocks the fingers short of it, it goes on until the
    force saturates, and little further, so that it does not wind up.

    Notes the counts in warnings (B, W, 2) in warned (B, W). Returns whether all commands (B,), m, N and m/s, are what a
    gripper can be told; writes nothing where not.
    """
    at = layout[0]
    for b in range(len(opening)):
        fits = (
            0 <= opening[b] <= MAX_OPENING
            and 0 <= force[b] <= MAX_FORCE
            and abs(lift_rate[b]) <= MAX_LIFT_RATE
        )
        if not fits:
            return False
    for b in range(len(opening)):
        force_range[b, at.grip, 0] = -force[b]
        width, setpoint = qpos[b, at.left] + qpos[b, at.right], act[b, at.grip_act]
        still = abs(qvel[b, at.left_dof] + qvel[b, at.right_dof]) < _STILL
        lowest = width - force[b] / stiffness - _WINDUP
        goal = max(opening[b], lowest)
        if still and width > opening[b] + _SHORT and setpoint < opening[b] + _SHORT:
            goal = lowest
        ctrl[b, at.grip] = min(max((goal - setpoint) / duration, -OPENING_SPEED), OPENING_SPEED)
        last, change = ctrl[b, at.lift], LIFT_ACCELERATION * duration
        ctrl[b, at.lift] = min(max(lift_rate[b], last - change), last + change)
        for kind in range(warned.shape[1]):
            warned[b, kind] = warnings[b, kind, 1]
    return True


@njit(cache=True, error_model="numpy")
def any_risen(warnings, warned):
    """Whether any of the counts (B, W, 2) has risen above those noted (B, W)."""
    for b in range(len(warned)):
        for kind in range(warned.shape[1]):
            if warnings[b, kind, 1] > warned[b, kind]:
                return True
    return False


@njit(cache=True, short_loops=True, error_model="numpy")
def summarise(
    layout, sensors, axes, pads, bodies, turns, qpos, qvel, warnings, warned,
    normal_force, force, place, opening, rate, height, lifted,
):  # fmt: skip
    """Fills a Motion's arrays from what MuJoCo recorded, sensors (B, S, n) and the pads' axes (B, S, T, 9), from where
    everything was before the last substep, the pads (B, T, 3), bodies (B, n, 3) and their quaternions (B, n, 4), and
    from qpos and qvel (B, n) at the end. layout: (O,) ADDRESSES. Returns any_risen of the warnings."""
    rows, objects, substeps, tips = normal_force.shape
    for b in range(rows):
        for o in range(objects):
            at = layout[o]
            for t in range(tips):
                first = (t * objects + o) * at.sensor
                mean = force[b, o, t]
                for i in range(3):
                    mean[i] = 0.0
                for s in range(substeps):
                    x, y, z = sensors[b, s, first + 1], sensors[b, s, first + 2], sensors[b, s, first + 3]
                    frame = axes[b, s, t]
                    normal = frame[0] * x + frame[3] * y + frame[6] * z
                    mean[0] += normal
                    mean[1] += frame[1] * x + frame[4] * y + frame[7] * z
                    mean[2] += frame[2] * x + frame[5] * y + frame[8] * z
                    normal_force[b, o, s, t] = max(normal, 0.0) if sensors[b, s, first] > 0 else 0.0
                for i in range(3):
                    mean[i] /= substeps
                into_frame(pads[b, t], bodies[b, at.body], turns[b, at.body], place[b, o, t])
            lifted[b, o] = qpos[b, at.poses + 2]
        at = layout[0]
        opening[b] = qpos[b, at.left] + qpos[b, at.right]
        rate[b] = qvel[b, at.left_dof] + qvel[b, at.right_dof]
        height[b] = qpos[b, at.height]
    return any_risen(warnings, warned)


@njit(cache=True, error_model="numpy", inline="always")
def into_frame(point, origin, turn, out):
    """Writes a point of the world in the frame at an origin, turned by a quaternion (w, x, y, z)."""
    x, y, z = point[0] - origin[0], point[1] - origin[1], point[2] - origin[2]
    w, a, b, c = turn[0], -turn[1], -turn[2], -turn[3]
    p, q, r = 2 * (b * z - c * y), 2 * (c * x - a * z), 2 * (a * y - b * x)
    out[0] = x + w * p + (b * r - c * q)
    out[1] = y + w * q + (c * p - a * r)
    out[2] = z + w * r + (a * q - b * p)
