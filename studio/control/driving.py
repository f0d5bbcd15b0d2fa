"""Who moves the gripper: a policy, or the visitor's sliders."""

from __future__ import annotations

import numpy as np

from thermograsp.agents import Policy, ScriptedGrasp, policy
from thermograsp.envs import GraspVectorEnv, action_of
from thermograsp.envs.limits import MAX_LIFT_RATE
from thermograsp.envs.spaces import Observation
from thermograsp.plant import Reading
from thermograsp.studio.control.choices import Controls

_APPROACH = 0.1  # s, time constant of the arm on its way to the slider's height


class Driving:
    """Acts in `env`'s rows. network: a file for the driver "trained", None for the package's. A driver that is chosen
    in the middle of an episode goes on from what it finds."""

    def __init__(self, env: GraspVectorEnv, network: str | None) -> None:
        self._env, self._network = env, network
        self.restart(0)

    def restart(self, seed: int) -> None:
        """Another episode begins, of that seed."""
        self._seed = seed
        self._chosen: tuple[str, float] | None = None
        self._policy: Policy | ScriptedGrasp | None = None

    def action(self, controls: Controls, seen: Observation, reading: Reading) -> np.ndarray:
        """(B, 3). Raises InvalidValueError for a driver that cannot act here."""
        rows = self._env.num_envs
        if controls.driver == "sliders":
            self._chosen = None
            way = controls.height - reading.height
            rate = np.clip(way / _APPROACH, -MAX_LIFT_RATE, MAX_LIFT_RATE)
            opening, force = np.full(rows, controls.opening), np.full(rows, controls.force)
            return action_of(opening, force, rate).T.copy()
        wanted = (controls.driver, controls.force if controls.driver == "scripted" else 0.0)
        if self._policy is None or wanted != self._chosen:
            self._chosen, self._policy = wanted, self._made(controls)
        return self._policy.action(seen)

    def _made(self, controls: Controls) -> Policy | ScriptedGrasp:
        if controls.driver == "scripted":
            return ScriptedGrasp(self._env.num_envs, self._env.dt, controls.force)
        trained = controls.driver == "trained" and self._network
        made = policy(self._env, trained or controls.driver)
        made.restart(range(self._env.num_envs), [self._seed] * self._env.num_envs)
        return made
