"""A ThermalTouch beside an environment that takes its own steps: it hears every substep, and follows new models."""

# mujoco ships no type stubs for its compiled names
# pyright: reportAttributeAccessIssue=false

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import mujoco

from ..thermal_touch import ThermalTouch
from .clock import heard_steps

_RK4 = mujoco.mjtIntegrator.mjINT_RK4
Simulation = Callable[[Any], tuple[mujoco.MjModel, mujoco.MjData]]


class SteppedTouch:
    """To be entered while the environment steps. simulation: gives an environment's present model and data. It is a
    function of a module, so that a copy of both asks the copied environment. words: those of ThermalTouch."""

    def __init__(self, simulation: Simulation, env: Any, words: dict[str, Any]) -> None:
        self._simulation, self._env, self._words = simulation, env, words
        model, _ = simulation(env)
        self.touch = ThermalTouch(model, **words)

    def restart(self, seed: int | None = None) -> None:
        """After the environment's reset, which may have made another model, or changed its geoms."""
        model, data = self._simulation(self._env)
        if model is not self.touch.model or not self.touch.fits(model):
            self.touch = ThermalTouch(model, **self._words)
        self.touch.reset(data, seed=seed)

    def __enter__(self) -> None:
        """From here on the touch hears every step that mujoco.mj_step and mj_step2 take of the environment's data.

        Both are replaced in the module for that time, so environments that step in several threads of one process are
        not served. Of steps that were taken otherwise, by a function imported by name or in a rollout, the last
        contacts stand for all. While MuJoCo takes several steps in one call, they are heard by its clock (clock.py);
        what goes wrong with one is raised at the end of the call."""
        _, data = self._simulation(self._env)
        step, second, touch = self._wrapped = mujoco.mj_step, mujoco.mj_step2, self.touch
        self._data, self._heard = data, None
        update, model = touch.update, touch.model
        options = model.opt

        def each_step(m: mujoco.MjModel, d: mujoco.MjData, nstep: int = 1) -> None:
            if d is not data:
                step(m, d, nstep)
                return
            at_once = nstep > 1 and m is model and options.integrator != _RK4
            if not (at_once and heard_steps(touch, step, m, d, nstep)):
                for _ in range(nstep):
                    step(m, d)
                    update(d)
            self._heard = d.time

        def each_second(m: mujoco.MjModel, d: mujoco.MjData) -> None:
            second(m, d)
            if d is data:
                update(d)

        mujoco.mj_step, mujoco.mj_step2 = each_step, each_second

    def __exit__(self, kind: type[BaseException] | None, *_: object) -> None:
        mujoco.mj_step, mujoco.mj_step2, touch = self._wrapped
        data, heard = self._data, self._heard
        del self._wrapped, self._data, self._heard  # MuJoCo's functions cannot be pickled
        if kind is None and data.time != heard:  # else a call that would find nothing
            touch.update(data)
