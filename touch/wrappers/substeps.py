"""A ThermalTouch beside an environment that takes its own steps: it hears every substep, and follows new models."""

# mujoco ships no type stubs for its compiled names
# pyright: reportAttributeAccessIssue=false

from __future__ import annotations

from collections.abc import Callable, Iterator
from contextlib import contextmanager
from typing import Any

import mujoco

from ..thermal_touch import ThermalTouch

Simulation = Callable[[], tuple[mujoco.MjModel, mujoco.MjData]]


class SteppedTouch:
    """simulation: gives the environment's present model and data. words: those of ThermalTouch."""

    def __init__(self, simulation: Simulation, words: dict[str, Any]) -> None:
        self._simulation, self._words = simulation, words
        model, _ = simulation()
        self.touch = ThermalTouch(model, **words)

    def restart(self, seed: int | None = None) -> None:
        """After the environment's reset, which may have made another model."""
        model, data = self._simulation()
        if model is not self.touch.model:
            self.touch = ThermalTouch(model, **self._words)
        self.touch.reset(data, seed=seed)

    @contextmanager
    def hearing(self) -> Iterator[None]:
        """While it lasts, the touch hears every step that mujoco.mj_step and mj_step2 take of the environment's data.

        Both are replaced in the module for that time, so environments that step in several threads of one process are
        not served. Of steps that were taken otherwise, by a function imported by name or in a rollout, the last
        contacts stand for all."""
        _, data = self._simulation()
        with heard(data, self.touch):
            yield
        self.touch.update(data)


@contextmanager
def heard(data: mujoco.MjData, touch: ThermalTouch) -> Iterator[None]:
    """While it lasts, the touch hears every step that MuJoCo takes of these data."""
    step, second, update = mujoco.mj_step, mujoco.mj_step2, touch.update

    def heard_step(model: mujoco.MjModel, stepped: mujoco.MjData, nstep: int = 1) -> None:
        if stepped is not data:
            step(model, stepped, nstep)
            return
        for _ in range(nstep):
            step(model, stepped)
            update(stepped)

    def heard_second(model: mujoco.MjModel, stepped: mujoco.MjData) -> None:
        second(model, stepped)
        if stepped is data:
            update(stepped)

    mujoco.mj_step, mujoco.mj_step2 = heard_step, heard_second
    try:
        yield
    finally:
        mujoco.mj_step, mujoco.mj_step2 = step, second
