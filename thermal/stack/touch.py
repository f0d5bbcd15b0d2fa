"""Touches of a heated stack: from force, sample and first state to what is read and what is recorded.

B: touches, n: samples.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from thermograsp.errors import InvalidValueError, positive

from .cells import Chain, Sample, sample_chain, stack_chain
from .design import HeatedStack
from .march import march

_HELD = (
    1e12  # J/(m2 K) at a place that keeps its temperature: 1e6 W/m2 for a minute change it by less than a mK
)
_WARM_STEPS = 200


@dataclass(frozen=True, slots=True)
class Touches:
    """What belongs to touches, before anything is predicted. t: (n,) s, evenly spaced. force: (B, n) N. start: (B,) °C,
    the reading at t[0]. warming: (B,) K/s, how fast it rises there. sample: (B,) °C, of what is touched, uniform.
    surroundings: (B,) °C, to which the backing loses heat."""

    t: np.ndarray
    force: np.ndarray
    start: np.ndarray
    warming: np.ndarray
    sample: np.ndarray
    surroundings: np.ndarray

    def __post_init__(self) -> None:
        count = len(self.start)
        if self.t.ndim != 1 or len(self.t) < 2 or self.force.shape != (count, len(self.t)):
            raise InvalidValueError(
                f"force must be (touches, times) = {(count, len(self.t))}, got {self.force.shape}"
            )
        for name in ("warming", "sample", "surroundings"):
            if getattr(self, name).shape != (count,):
                raise InvalidValueError(f"{name} must be ({count},), got {getattr(self, name).shape}")
        steps = np.diff(self.t)
        if not (steps > 0).all() or np.ptp(steps) > 1e-3 * steps.mean():
            raise InvalidValueError("t must rise in equal steps")
        for name in ("force", "start", "warming", "sample", "surroundings"):
            if not np.isfinite(getattr(self, name)).all():
                raise InvalidValueError(f"{name} must be finite")

    @property
    def dt(self) -> float:
        """s."""
        return float((self.t[-1] - self.t[0]) / (len(self.t) - 1))


@dataclass(frozen=True, slots=True)
class StackCurves:
    """Curves of a heated sensor that touches a sample. reading: (B, n) °C at the readout. recorded: (B, n) °C, as the
    recorder leaves it. flow: (B, n - 1) W/m2 into what is touched, means of steps. power: (B, n - 1) W/m2 of the
    heater. gained: (B, 2) J/m2 in all by the stack and by the sample."""

    reading: np.ndarray
    recorded: np.ndarray
    flow: np.ndarray
    power: np.ndarray
    gained: np.ndarray


def touch_curves(
    stack: HeatedStack, samples: Sequence[Sample], touches: Touches, *, warm_up: float = 30.0
) -> StackCurves:
    """The touches of samples (B of them, or one for all).

    Before t[0] the stack was uniform and then warmed for `warm_up` s with the power that lets the reading rise as it
    does there; that power is what a law without one of its own goes on with.
    """
    positive("warm_up (s)", warm_up)
    count = len(touches.start)
    if len(samples) not in (1, count):
        raise InvalidValueError(f"give 1 or {count} samples, got {len(samples)}")
    chain = stack_chain(stack)
    each = {sample: sample_chain(sample) for sample in set(samples)}
    chosen = [each[sample] for sample in samples] * (count if len(samples) == 1 else 1)
    profile, rate = warmed(chain, warm_up)
    before = touches.warming / rate[chain.readout]
    drive = stack.law.drive(touches.force, np.maximum(before, 0.0))
    chain_capacity = chain.capacity.copy()
    if drive.held:
        chain_capacity[chain.heater] = _HELD
    capacity = np.array([np.concatenate((chain_capacity, heat)) for heat, _ in chosen])
    links = np.array([np.concatenate((chain.links, [0.0], inside)) for _, inside in chosen])
    state = np.repeat(touches.sample[:, None], capacity.shape[1], axis=1)
    state[:, : chain.face + 1] = touches.start[:, None] + before[:, None] * (profile - profile[chain.readout])
    first = state.copy()
    conductance = stack.contact.at(touches.force)
    reading, heat, power = march(
        capacity,
        links,
        chain.face,
        (conductance[:, 1:] + conductance[:, :-1]) / 2,
        state,
        chain.heater,
        drive.power,
        drive.controller,
        drive.until,
        chain.back,
        chain.loss,
        touches.surroundings,
        chain.readout,
        touches.dt,
    )
    gains = capacity * (state - first)
    parts = np.stack((gains[:, : chain.face + 1].sum(1), gains[:, chain.face + 1 :].sum(1)), axis=1)
    return StackCurves(reading, stack.recorder.record(reading, touches.dt), heat / touches.dt, power, parts)


def warmed(chain: Chain, seconds: float) -> tuple[np.ndarray, np.ndarray]:
    """(N,) K and K/s after 1 W/m2 into the heater's node for so long, nothing touched or lost; backward Euler."""
    from scipy.linalg import solveh_banded  # nothing that it needs is loaded without it

    dt = seconds / _WARM_STEPS
    banded = np.zeros((2, len(chain.capacity)))
    banded[1] = chain.capacity
    banded[1, :-1] += dt * chain.links
    banded[1, 1:] += dt * chain.links
    banded[0, 1:] = -dt * chain.links
    heat = np.zeros(len(chain.capacity))
    heat[chain.heater] = dt
    now = before = np.zeros(len(chain.capacity))
    for _ in range(_WARM_STEPS):
        before, now = now, np.asarray(solveh_banded(banded, chain.capacity * now + heat))
    return now, (now - before) / dt
