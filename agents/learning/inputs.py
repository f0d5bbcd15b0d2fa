"""What an agent perceives: the last five seconds of an observation as one scaled vector, with NumPy alone.

Every .1 s the observation becomes a frame; the vector holds a choice of the last frames, the voltages since the fingers
began to close, the time, and what is asked. All tasks and grippers share this. B: environments.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np

STEP = 0.02  # s, the control step of all tasks
REPEAT = 5
"""Control steps that a frame and an action last."""
AGES = (*range(10), *range(10, 50, 2))
"""Of the frames in the vector: 0 is the newest."""
FRAME = 4 + 6 + 4 + 1
"""Numbers in a frame: gripper, load cells, voltages of two fingertips in the older and the newer half, arm sideways."""
CLOSING = 20
"""Frames from the last one with open fingers on, of which the vector has how much the voltages change."""
SAMPLES = 10
"""Newest samples of which the vector has how much each differs from the one before: those since the last frame."""

_OPEN = 0.08  # m, from which on fingers are open: an 85 mm gripper that closes is below it a frame later
_VOLTAGES = slice(10, 14)  # of a frame
_HALF = 5  # samples at 100 Hz; two halves are the time since the last frame
_VOLTAGE = 3e-4  # V, up to which the scale is even; above it is logarithmic
_GAIN = 3.0  # of that scale, so that like materials lie apart
# Middle and half range of what a grasp meets, so that numbers are about -1 .. 1.
_GRIPPER = (np.array([0.0425, 0.0, 0.025, 20.0]), np.array([0.0425, 0.1, 0.025, 20.0]))  # m, m/s, m, N
_FORCE = 20.0  # N
_LATERAL = 0.05  # m
_THERMOSTAT = (36.0, 10.0)  # °C
_LONG = 10.0  # s


@dataclass(frozen=True, slots=True)
class Inputs:
    """heat: voltages and thermostats. load: the load cells. What is left out reads 0, so that agents with and without
    it have the same network. goals: numbers that say what is asked; 0 where the task never varies. closing: what the
    voltages have done since the fingers began to close. samples: how much each of the newest samples differs from the
    one before, which says when a touch began. Agents trained by earlier versions are without one or both."""

    heat: bool = True
    load: bool = True
    goals: int = 0
    closing: bool = False
    samples: bool = False

    @property
    def size(self) -> int:
        """Numbers in the vector."""
        changes = 4 * CLOSING * self.closing + 2 * SAMPLES * self.samples
        return FRAME * len(AGES) + changes + 2 + 1 + self.goals

    def frame(self, observation: Mapping[str, np.ndarray]) -> np.ndarray:
        """(B, FRAME) float32 of observations (B, ...)."""
        rows = len(observation["gripper"])
        volts = observation["voltage"][:, :, -2 * _HALF :].reshape(rows, 2, 2, _HALF).mean(axis=3)
        parts = (
            (observation["gripper"] - _GRIPPER[0]) / _GRIPPER[1],
            observation["force"] / _FORCE * self.load,
            _scaled(volts) * self.heat,
            observation["lateral"] / _LATERAL if "lateral" in observation else np.zeros((rows, 1)),
        )
        return np.concatenate([part.reshape(rows, -1) for part in parts], axis=1).astype(np.float32)

    def differences(self, observation: Mapping[str, np.ndarray]) -> np.ndarray:
        """(B, 2 SAMPLES) float32 of observations (B, ...), oldest first; (B, 0) without `samples`."""
        newest = _scaled(observation["voltage"][:, :, -SAMPLES - 1 :]) * self.heat
        count = 2 * SAMPLES * self.samples
        return np.diff(newest, axis=2).reshape(len(newest), -1)[:, :count].astype(np.float32)


class Memory:
    """The frames of `num_envs` environments. An episode begins with its first frame in place of all earlier ones, in
    which voltages count as 0. So they are in a simulation, whose fingertips the air has not begun to cool; real ones
    have been in the air for long, and agents would meet first frames that they have never seen.

    A touch moves through the last frames while it lasts, and an agent would have to learn each of its places anew. In
    what the voltages have done since the fingers began to close, a touch is always at about the same place."""

    def __init__(self, inputs: Inputs, num_envs: int) -> None:
        self.inputs = inputs
        self._frames = np.zeros((num_envs, AGES[-1] + 1, FRAME), np.float32)  # newest first
        self._count = np.zeros(num_envs, int)
        self._closing = np.zeros((num_envs, CLOSING, 4), np.float32)  # oldest first
        self._closed = np.zeros(num_envs, int)  # frames since the last with open fingers

    def restart(self, rows: np.ndarray) -> None:
        """The rows begin an episode with the next observation."""
        self._count[rows] = 0

    def vector(self, observation: Mapping[str, np.ndarray], rows: np.ndarray | None = None) -> np.ndarray:
        """Remembers the observations (B, ...) of rows (n,), all by default, REPEAT control steps after their last ones,
        and returns (n, size) float32. A row's result does not depend on the others."""
        if rows is not None:
            observation = {name: values[rows] for name, values in observation.items()}
        at = np.arange(len(self._count)) if rows is None else rows
        frame = self.inputs.frame(observation)
        frames, count = np.roll(self._frames[at], 1, axis=1), self._count[at]
        frames[:, 0] = frame
        begins = count == 0
        frame[begins, _VOLTAGES] = 0.0
        frames[begins] = frame[begins, None]
        opening = observation["gripper"][:, 0]
        self._closed[at] = closed = np.where(begins | (opening > _OPEN), 0, self._closed[at] + 1)
        self._closing[at[closed == 0]] = 0.0
        lasting = closed < CLOSING
        self._closing[at[lasting], closed[lasting]] = _changes(frames, closed == 0)[lasting]
        self._frames[at], self._count[at] = frames, count + 1
        thermostat = (observation["thermostat"] - _THERMOSTAT[0]) / _THERMOSTAT[1] * self.inputs.heat
        clock = count[:, None] * STEP * REPEAT / _LONG
        goal = observation["goal"] if self.inputs.goals else np.zeros((len(at), 0))
        recent = frames[:, AGES].reshape(len(at), -1)
        closing = self._closing[at].reshape(len(at), -1)[:, : 4 * CLOSING * self.inputs.closing]
        samples = self.inputs.differences(observation)
        return np.concatenate([recent, closing, samples, thermostat, clock, goal], axis=1).astype(np.float32)


def _scaled(volts: np.ndarray) -> np.ndarray:
    """As agents perceive them: even near 0 and logarithmic from _VOLTAGE on."""
    return _GAIN * np.arcsinh(volts / _VOLTAGE)


def _changes(frames: np.ndarray, first: np.ndarray) -> np.ndarray:
    """(B, 4) of two fingertips each the older half of the newest frame less the newer one of the frame before, and the
    newer half less the older one. first: (B,) where the older half counts from 0."""
    new, before = (frames[:, age, _VOLTAGES].reshape(-1, 2, 2) for age in (0, 1))
    start = np.where(first[:, None], 0.0, before[:, :, 1])
    return np.stack([new[:, :, 0] - start, new[:, :, 1] - new[:, :, 0]], axis=2).reshape(-1, 4)
