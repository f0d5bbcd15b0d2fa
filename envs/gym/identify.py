"""thermograsp/Identify-v0: squeeze an object and say what it is made of."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

from thermograsp.errors import InvalidValueError

from ...thermal import SEED_MATERIALS, Material
from ..plant import SimulationConfig
from ..spaces import Observation
from ..tasks import IdentifyTask, Task
from .batch import reset_options
from .keywords import simulates
from .single import TouchEnv
from .vector import TouchVectorEnv

Materials = Sequence[str | Material] | None


class IdentifyEnv(TouchEnv):
    """Identify the object's material by touch and declare it.

    Action, Box(-1, 1, (2 + K,)), clipped, K the number of materials: force (above 0: the fingers close with that share
    of 40 N; else they open), declare (above .5: the episode ends), and a distribution over the materials in their
    order, softmax of 5 times these.

    Observation: as GraspEnv's.

    Reward: -cost_per_second for each second, and at the end 1 + log p / log K, where p is the share of the true
    material and K the number of materials: 1 for certainty, 0 for an even distribution. An episode ends with a
    declaration. It is truncated after `seconds`; then the last distribution counts in the same way.

    info: as GraspEnv's, without dropped and crushed; success (declared, and right), prediction (K,), the declared
    shares, and loss, -log p. The materials' order: env.unwrapped.batch.task.classes.

    Keywords: material (a list of at least two names or Materials, None = the ten seed materials), seconds (s),
    cost_per_second, and others as GraspEnv's. Two thermostats at different temperatures, sensor_temperature=(36.0,
    30.0), distinguish materials even if an object has the temperature of one of them.
    """

    def __init__(
        self,
        render_mode: str | None = None,
        *,
        material: Materials = None,
        seconds: float = 4.0,
        cost_per_second: float = 0.1,
        **config: Any,
    ) -> None:
        task, config = _prepare(material, seconds, cost_per_second, config)
        super().__init__(task, render_mode, **config)

    def reset(
        self, *, seed: int | None = None, options: dict[str, Any] | None = None
    ) -> tuple[Observation, dict[str, Any]]:
        """As GraspEnv's. Raises InvalidValueError also for a material that is none of those to tell apart."""
        _check_options(self.batch.task, options)
        return super().reset(seed=seed, options=options)


class IdentifyVectorEnv(TouchVectorEnv):
    """`num_envs` identify environments in one array step; keywords as IdentifyEnv's."""

    def __init__(
        self,
        num_envs: int = 1,
        *,
        material: Materials = None,
        seconds: float = 4.0,
        cost_per_second: float = 0.1,
        **config: Any,
    ) -> None:
        task, config = _prepare(material, seconds, cost_per_second, config)
        super().__init__(task, num_envs, **config)

    def reset(
        self, *, seed: int | list[int | None] | None = None, options: dict[str, Any] | None = None
    ) -> tuple[Observation, dict[str, Any]]:
        """As GraspVectorEnv's. Raises InvalidValueError also for a material that is none of those to tell apart."""
        _check_options(self.batch.task, options)
        return super().reset(seed=seed, options=options)


def _prepare(
    material: Materials, seconds: float, cost: float, config: dict[str, Any]
) -> tuple[IdentifyTask, dict[str, Any]]:
    """The task, and the plant's keywords: for real objects there are none."""
    chosen = SimulationConfig(material=SEED_MATERIALS if material is None else material).choices
    task = IdentifyTask(tuple(each.name for each in chosen), seconds, cost)
    drawn = {"material": list(chosen)} if simulates(config.get("plant", "simulated")) else {}
    return task, {**config, **drawn}


def _check_options(task: Task, options: object) -> None:
    """Raises InvalidValueError for a reset's material without a class: no declaration of it would be judged."""
    assert isinstance(task, IdentifyTask)
    given = reset_options(options)
    if "material" not in given:
        return
    for each in SimulationConfig(material=given["material"]).choices:
        if each.name not in task.classes:
            raise InvalidValueError(
                f"reset option material {each.name!r} is none of those to tell apart, {', '.join(task.classes)}: give "
                "one of them, or make the environment with material=[...]"
            )
