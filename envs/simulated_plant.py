"""The simulated plant: MuJoCo mechanics, contact heat and the fingertips' electronics for a batch of environments."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import replace
from typing import TYPE_CHECKING, Any

import numpy as np

from thermograsp.errors import InvalidValueError
from thermograsp.plant import Command, Reading

from ..thermal import Material, material, sensor
from .heat import GraspHeat, HeatStep
from .simulated_batch import SimulatedBatch
from .simulation_config import SimulationConfig
from .things import Thing
from .truth import TOLD, Episodes, Truth

if TYPE_CHECKING:
    from .scene_heat import SceneHeat, SceneHeatStep


class SimulatedPlant(SimulatedBatch):
    """A batch of simulated grippers, each over an object that it grasps and maybe others; see thermograsp.plant.Plant.
    B: environments."""

    def __init__(self, num_envs: int, config: SimulationConfig) -> None:
        possible = config.possible_things(sensor(config.sensor))
        self._other_specs = config.others
        specs = (possible[0].spec, *self._other_specs)
        super().__init__(num_envs, config, specs, possible, self._heat_of(num_envs, config))
        self._rest = np.zeros(num_envs)
        told = TOLD if self._thermostats.ideal else (*TOLD, "over_temperature")
        self._told = (*told, "touched", "object_temperatures") if self._other_specs else told

    @property
    def things(self) -> list[Thing]:
        """What each environment is to grasp."""
        return [scene[0] for scene in self.scenes]

    def reset(
        self, rows: Sequence[int], rngs: Sequence[np.random.Generator], options: Mapping[str, Any]
    ) -> Reading:
        """Starts the rows anew: draws material and placement, opens the gripper. options: material, for this
        episode."""
        unknown = set(options) - {"material"}
        if unknown:
            raise InvalidValueError(f"unknown reset options {sorted(unknown)}: material is known")
        config, choices = self.config, self._choices
        if "material" in options:
            config = replace(config, material=options["material"])
            choices = config.choices
        chosen, reach, turn = list(rows), *self.config.placement
        centred: list[Thing] = []
        for row, rng in zip(chosen, rngs, strict=True):
            one = choices[int(rng.integers(len(choices)))]
            x, y, angle = rng.uniform(-1.0, 1.0, 3)
            shape = self._shapes[int(rng.integers(len(self._shapes))) if len(self._shapes) > 1 else 0]
            middle = shape.position
            spec = replace(
                shape,
                position=(middle[0] + x * reach, middle[1] + y * reach),
                yaw=shape.yaw + np.deg2rad(angle * turn),
            )
            drawn = self._begin(row, rng)
            thing = config.thing(self._stack, one, spec, drawn)
            self.scenes[row] = (thing, *self._draw_others(config, choices, drawn, rng))
            centred.append(replace(thing, spec=replace(thing.spec, position=middle, yaw=shape.yaw)))
        if isinstance(self.heat, GraspHeat):
            self._place(chosen, centred)
        else:
            scenes = [(thing, *self.scenes[row][1:]) for row, thing in zip(chosen, centred, strict=True)]
            self._place(chosen, scenes, waiting=True)
        self._rest[chosen] = self.mechanics.object_pose[chosen, 0, 2]
        self._relabel(chosen)
        rest, scene = self.heat.rest(), None
        if not isinstance(rest, HeatStep):
            rest, scene = rest.fingertips, rest
        return self._still(rest, self._truth(self.mechanics.object_pose[:, 0, 2], rest, scene), self._told)

    def step(self, command: Command) -> Reading:
        """One control step of all environments."""
        substeps, scene, owner = self.config.substeps, None, None
        if isinstance(self.heat, GraspHeat):
            motion = self.mechanics.advance(command.opening, command.force_limit, command.lift_rate, substeps)
            step = self.heat.advance(motion.normal, motion.place)
        else:
            from .other_objects import advance_scene

            motion, scene = advance_scene(self.mechanics, self.heat, command, substeps)
            step, owner = scene.fingertips, scene.owner
        if not self._thermostats.ideal:
            self._regulate(step)
        return self._reading(motion, step, self._truth(motion.object_height, step, scene), self._told, owner)

    @property
    def _own(self) -> tuple[np.ndarray, ...]:
        return (self._rest,)

    def _relabel(self, rows: Sequence[int]) -> None:
        last = self._episodes
        material, rung, crushing_force = last.material.copy(), last.rung.copy(), last.crushing_force.copy()
        for row in rows:
            thing = self.scenes[row][0]
            label = self.heat.rung(row)
            material[row], rung[row] = thing.material.name, label if isinstance(label, str) else label[0]
            crushing_force[row] = thing.crushing_force
        heaters = not self._thermostats.ideal
        self._episodes = Episodes(self.config.mode, material, rung, crushing_force, self._randomized, heaters)

    def _heat_of(self, num_envs: int, config: SimulationConfig) -> GraspHeat | SceneHeat:
        if not self._other_specs:
            return GraspHeat(num_envs, **config.heat)
        from .scene_heat import SceneHeat

        return SceneHeat(num_envs, 1 + len(self._other_specs), **config.heat)

    def _draw_others(
        self,
        config: SimulationConfig,
        choices: tuple[Material, ...],
        drawn: dict[str, float],
        rng: np.random.Generator,
    ) -> tuple[Thing, ...]:
        """The objects beside the first, where they were put and of their own size; else of the first's draws."""
        things, drawn = [], {**drawn, "size_factor": 1.0}
        for spec in self._other_specs:
            chosen = choices[int(rng.integers(len(choices)))]
            if spec.material is not None:
                chosen = material(spec.material)
            things.append(config.thing(self._stack, chosen, spec, drawn))
        return tuple(things)

    def _truth(self, object_height: np.ndarray, step: HeatStep, scene: SceneHeatStep | None) -> Truth:
        lift, error = object_height - self._rest, tuple(self.mechanics.failure)
        if scene is None:
            return Truth(step, self._episodes, lift, error)
        from .scene_truth import SceneTruth

        own = {"object_temperatures": scene.objects["object_temperature"].copy(), "touched": scene.owner}
        return SceneTruth(step, self._episodes, lift, error, own)


def simulated_plant(url: str, num_envs: int, **config: Any) -> SimulatedPlant:
    """The plant behind plant="simulated". Keywords as in SimulationConfig. Raises InvalidValueError for others."""
    try:
        settings = SimulationConfig(**config)
    except TypeError as error:
        raise InvalidValueError(f"plant {url!r}: {error}") from None
    return SimulatedPlant(num_envs, settings)
