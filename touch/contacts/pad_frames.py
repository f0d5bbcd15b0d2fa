"""Where pads are in the world, and whether what presses is on them.

F: fingertips, N: what a pad may meet.
"""

from __future__ import annotations

from thermograsp.compiled import njit

from ...thermal.padded import RINGS
from .sensors import FORCE_AT, PLACE_AT

DEPTH = (
    0.004  # m off the pad's plane, up to which a contact is on it, beside half of what the two have sunk in
)
RIM = 0.0005  # m beyond the pad's sides
LOOKING = 0.6  # least cosine between the pad's normal and the contact's

AXES, HALF, WIDTH, AROUND, PAD = 3, 12, 14, 15, 15 + RINGS
"""Where a pad's axes, half sides m, its sensor's width m and half the outer sides m of its rings, 0 where it has no
heat, stand behind its position m in the frame of its body; and how many numbers these are."""
KNOWN, PLACED = 12, 13
"""Of a pad in the world: its middle m, normal, y and z, and behind them whether these are of this substep; and how many
numbers these are."""


@njit(cache=True, error_model="numpy", inline="always")
def begin(pushed, frames):
    """Forces, moments and frames of a substep start anew."""
    for f in range(len(frames)):
        frames[f, KNOWN] = 0.0
        for g in range(pushed.shape[1]):
            pushed[f, g, 0] = 0.0
            pushed[f, g, 1] = 0.0
            pushed[f, g, 2] = 0.0


@njit(cache=True, inner=True, borrows=True, error_model="numpy", forceinline=True)
def place_pad(pads, parts, xpos, xmat, frames, f):
    """Fills frames[f] with where pad f is in the world, unless it is known in this substep."""
    if frames[f, KNOWN] > 0.0:
        return
    frames[f, KNOWN] = 1.0
    body = parts[len(parts) - len(pads) + f, 2]
    for k in range(3):
        x, y, z = xmat[body, 3 * k], xmat[body, 3 * k + 1], xmat[body, 3 * k + 2]
        frames[f, k] = xpos[body, k] + (x * pads[f, 0] + y * pads[f, 1] + z * pads[f, 2])
        for i in range(3):
            at = AXES + i
            frames[f, 3 + 3 * i + k] = x * pads[f, at] + y * pads[f, at + 3] + z * pads[f, at + 6]


@njit(cache=True, error_model="numpy", inline="always")
def press(data, at, pads, frames, f, part, part_count, pushed, beside):
    """A net force on a pad or beside it; of another fingertip only where it is on that one's pad too."""
    tips = len(pads)
    on, y, z, force = _bears(data, at, pads[f], frames[f], 1.0)
    if part >= part_count - tips:
        other = part - (part_count - tips)
        on_other, _, _, back = _bears(data, at, pads[other], frames[other], -1.0)
        if not on_other and back > 0:
            beside[other] += back
        on = on and on_other
    if force > 0:
        if on:
            pushed[f, part, 0] += force
            pushed[f, part, 1] += force * y
            pushed[f, part, 2] += force * z
        else:
            beside[f] += force


@njit(cache=True, error_model="numpy", inline="always")
def _bears(data, at, pad, frame, sign):
    """Whether a net force is on a pad, where (m, along its y and z), and its part along the normal, N."""
    place, vector = data[at + PLACE_AT : at + PLACE_AT + 3], data[at + FORCE_AT : at + FORCE_AT + 3]
    x, y, z, force = _from_pad(frame, place, vector, sign)
    return force > 0 and _within(pad, x, y, z, 0.0), y, z, force


@njit(cache=True, error_model="numpy", inline="always")
def lies(pad, frame, place, vector, sign, sunk):
    """Whether a contact is on a pad and looks at it, and where (m, along its y and z). sunk: m below both faces."""
    x, y, z, cosine = _from_pad(frame, place, vector, sign)
    return cosine >= LOOKING and _within(pad, x, y, z, sunk), y, z


@njit(cache=True, error_model="numpy", inline="always")
def _from_pad(frame, place, vector, sign):
    """Where a place is from a pad's middle, m along its normal, y and z, and the vector's part along the normal."""
    x, y, z, along = 0.0, 0.0, 0.0, 0.0
    for k in range(3):
        away = place[k] - frame[k]
        along += sign * frame[3 + k] * vector[k]
        x += away * frame[3 + k]
        y += away * frame[6 + k]
        z += away * frame[9 + k]
    return x, y, z, along


@njit(cache=True, error_model="numpy", inline="always")
def _within(pad, x, y, z, sunk):
    return abs(x) <= DEPTH + sunk and abs(y) <= pad[HALF] + RIM and abs(z) <= pad[HALF + 1] + RIM
