"""The simulated plant: MuJoCo mechanics, contact heat and the fingertips' electronics for a batch of environments."""

from __future__ import annotations

import copy
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, Any

import numpy as np

from thermograsp.errors import InvalidValueError
from thermograsp.plant import Command, Reading

from ..thermal import Material, material, sensor
from .electronics import Electronics, ElectronicsState
from .heat import GraspHeat, HeatState, HeatStep
from .mechanics import Mechanics, MechanicsState
from .randomization import CAUSES, checked, draw
from .scene import ObjectSpec
from .simulation_config import SAMPLE_PERIOD, SimulationConfig
from .thermostats import Thermostats
from .things import Thing
from .truth import TOLD, Episodes, Truth

if TYPE_CHECKING:
    from .face_temperature import FaceTemperatureState
    from .scene_heat import SceneHeat, SceneHeatState, SceneHeatStep


@dataclass(frozen=True, slots=True)
class PlantState:
    """Everything that decides the future of some environments of a simulated plant; picklable."""

    mechanics: MechanicsState
    heat: HeatState | SceneHeatState
    electronics: ElectronicsState
    thermostats: tuple[np.ndarray, ...]
    rest: np.ndarray
    generators: tuple[np.random.Generator, ...]
    drawn: tuple[dict[str, float], ...]
    faces: FaceTemperatureState | None


class SimulatedPlant:
    """A batch of simulated grippers; see thermograsp.plant.Plant. B: environments."""

    def __init__(self, num_envs: int, config: SimulationConfig) -> None:
        self.config = config
        self.num_envs = num_envs
        self._choices, self._stack = config.choices, sensor(config.sensor)
        self._causes = checked(config.randomize)
        plain = draw((), np.random.default_rng(0))
        self._shapes = config.shapes
        possible = config.possible_things(self._stack)
        first = possible[0]
        self._other_specs = config.others
        self.mechanics = Mechanics(
            (first.spec, *self._other_specs),
            num_envs,
            threads=config.threads,
            library=[thing.spec for thing in possible if thing.spec.mesh],
            settings=config.solver,
            gripper=config.gripper_for(possible),
            contacts=config.taxels is not None or config.face_temperature is not None,
        )
        self._taxels, self._faces = config.tactile, config.face_maps(num_envs, self._stack)
        self.dt = config.substeps * config.solver.timestep
        self.sample_rate = 1 / SAMPLE_PERIOD
        self.heat = self._heat_of(num_envs)
        self.things: list[Thing] = [first] * num_envs
        self.others: list[tuple[Thing, ...]] = [()] * num_envs
        self._rngs: list[np.random.Generator] = [np.random.default_rng(0)] * num_envs
        self._electronics = Electronics(
            num_envs, config.chain, self._stack.seebeck, SAMPLE_PERIOD, config.samples, config.most_delay
        )
        self._drawn = [plain] * num_envs
        self._thermostats = Thermostats(num_envs, config.heater, config.sensor_temperatures, self.dt)
        self._rest = np.zeros(num_envs)
        told = TOLD if self._thermostats.ideal else (*TOLD, "over_temperature")
        self._told = (*told, "touched", "object_temperatures") if self._other_specs else told
        # Replaced, never written to: readings keep it.
        self._episodes = Episodes(
            config.mode,
            np.full(num_envs, "", object),
            np.full(num_envs, "", object),
            np.full(num_envs, np.inf),
            {},
        )

    @property
    def model(self) -> Any:
        """The mujoco.MjModel of the first environment's scene."""
        return self.mechanics.model

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
        reach, turn = self.config.placement
        own: list[ObjectSpec] = []
        for row, rng in zip(rows, rngs, strict=True):
            chosen = choices[int(rng.integers(len(choices)))]
            x, y, angle = rng.uniform(-1.0, 1.0, 3)
            shape = self._shapes[int(rng.integers(len(self._shapes))) if len(self._shapes) > 1 else 0]
            own.append(shape)
            turned = shape.yaw + np.deg2rad(angle * turn)
            middle = shape.position
            spec = replace(shape, position=(middle[0] + x * reach, middle[1] + y * reach), yaw=turned)
            self._drawn[row] = drawn = draw(self._causes, rng)
            self.things[row] = config.thing(self._stack, chosen, spec, drawn)
            self._rngs[row] = rng
            self._electronics.reset(row, drawn)
            if self._other_specs:
                self.others[row] = self._draw_others(config, choices, drawn, rng)
        self.mechanics.reset(
            rows, [(self.things[row].spec, *(other.spec for other in self.others[row])) for row in rows]
        )
        things = [
            replace(
                self.things[row], spec=replace(self.things[row].spec, position=shape.position, yaw=shape.yaw)
            )
            for row, shape in zip(rows, own, strict=True)
        ]
        errors = np.array([[self._drawn[row]["thermostat_error"]] for row in rows])
        celsius = self._thermostats.setpoints[list(rows)] + errors
        if isinstance(self.heat, GraspHeat):
            self.heat.reset(rows, things, celsius)
        else:
            scenes = [(thing, *self.others[row]) for row, thing in zip(rows, things, strict=True)]
            self.heat.reset(rows, scenes, celsius, waiting=True)
        chosen = list(rows)
        if self._faces is not None:
            self._faces.reset(chosen, [(self.things[row], *self.others[row]) for row in chosen])
        self._thermostats.reset(chosen)
        self._rest[chosen] = self.mechanics.object_pose[chosen, 0, 2]
        self._relabel(chosen)
        return self._still()

    def step(self, command: Command) -> Reading:
        """One control step of all environments."""
        substeps, scene = self.config.substeps, None
        if isinstance(self.heat, GraspHeat):
            motion = self.mechanics.advance(command.opening, command.force_limit, command.lift_rate, substeps)
            step = self.heat.advance(motion.normal, motion.place)
        else:
            from .other_objects import advance_scene

            motion, scene = advance_scene(self.mechanics, self.heat, command, substeps)
            step = scene.fingertips
        if not self._thermostats.ideal:
            first = self.heat.sensor_temperatures
            self.heat.set_thermostats(self._thermostats.step(step.told["drawn"], first))
            self._thermostats.tell(step.told)
        error = tuple(self.mechanics.failure)
        return Reading(
            opening=motion.opening,
            opening_rate=motion.opening_rate,
            height=motion.height,
            force=motion.force,
            voltage=self._electronics.measure(step.drop, self._rngs),
            thermostat=self._thermostats.measured,
            truth=self._truth(motion.object_height, step, scene, error),
            error=error,
            told=self._told,
            pressure=None if self._taxels is None else self._taxels.pressure(self.mechanics),
            face_temperature=None
            if self._faces is None
            else self._faces.step(self.mechanics, step, None if scene is None else scene.owner),
        )

    def temperatures(self, row: int) -> tuple[float, ...]:
        """°C between which the row's heat stays: of its thermostats, object, room and reservoir."""
        objects = (self.things[row], *self.others[row])
        return (
            *self.heat.sensor_temperatures[row],
            *(celsius for thing in objects for celsius in thing.extremes),
        )

    def close(self) -> None:
        """Nothing is held."""

    def state(self, rows: Sequence[int]) -> PlantState:
        """A copy of the rows' state."""
        chosen = list(rows)
        return PlantState(
            self.mechanics.state(np.array(chosen)),
            self.heat.state(chosen),
            self._electronics.state(chosen),
            self._thermostats.state(chosen),
            self._rest[chosen],
            tuple(copy.deepcopy(self._rngs[row]) for row in chosen),
            tuple(self._drawn[row] for row in chosen),
            None if self._faces is None else self._faces.state(chosen),
        )

    def set_state(self, rows: Sequence[int], state: PlantState) -> tuple[np.random.Generator, ...]:
        """Puts the rows into a state; what follows is bit-identical to what followed it first. Returns the generators
        the rows now draw from."""
        chosen = list(rows)
        self.mechanics.set_state(state.mechanics, np.array(chosen))
        heat: Any = self.heat  # of the state's kind
        heat.set_state(chosen, state.heat)
        self._electronics.set_state(chosen, state.electronics)
        rngs = tuple(copy.deepcopy(rng) for rng in state.generators)
        for k, row in enumerate(chosen):
            kept = state.heat.things if isinstance(state.heat, HeatState) else state.heat.rows.things
            specs = state.mechanics.objects[k]
            first, *others = (
                replace(thing, spec=spec)
                for thing, spec in zip(kept[k * len(specs) : (k + 1) * len(specs)], specs, strict=True)
            )
            self.things[row], self.others[row] = first, tuple(others)
            self._rngs[row] = rngs[k]
            self._drawn[row] = state.drawn[k]
        if self._faces is not None and state.faces is not None:
            scenes = [(self.things[row], *self.others[row]) for row in chosen]
            self._faces.set_state(chosen, state.faces, scenes)
        self._thermostats.set_state(chosen, state.thermostats)
        self._rest[chosen] = state.rest
        self._relabel(chosen)
        return rngs

    def _relabel(self, rows: Sequence[int]) -> None:
        """Names what the rows hold now."""
        last = self._episodes
        material, rung, crushing_force = last.material.copy(), last.rung.copy(), last.crushing_force.copy()
        for row in rows:
            thing = self.things[row]
            label = self.heat.rung(row)
            material[row], rung[row] = thing.material.name, label if isinstance(label, str) else label[0]
            crushing_force[row] = thing.crushing_force
        names = [CAUSES[type(cause)][0] for cause in self._causes]
        randomized = {name: np.array([drawn[name] for drawn in self._drawn]) for name in names}
        heaters = not self._thermostats.ideal
        self._episodes = Episodes(self.config.mode, material, rung, crushing_force, randomized, heaters)

    def _heat_of(self, num_envs: int) -> GraspHeat | SceneHeat:
        if not self._other_specs:
            return GraspHeat(num_envs, **self.config.heat)
        from .scene_heat import SceneHeat

        return SceneHeat(num_envs, 1 + len(self._other_specs), **self.config.heat)

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

    def _truth(
        self, object_height: np.ndarray, step: HeatStep, scene: SceneHeatStep | None, error: tuple[str, ...]
    ) -> Truth:
        lift = object_height - self._rest
        if scene is None:
            return Truth(step, self._episodes, lift, error)
        from .scene_truth import SceneTruth

        own = {"object_temperatures": scene.objects["object_temperature"].copy(), "touched": scene.owner}
        return SceneTruth(step, self._episodes, lift, error, own)

    def _still(self) -> Reading:
        """The reading before anything moves: nothing is touched, no voltage."""
        rows, error = self.num_envs, tuple(self.mechanics.failure)
        rest, scene = self.heat.rest(), None
        if not isinstance(rest, HeatStep):
            rest, scene = rest.fingertips, rest
        return Reading(
            opening=self.mechanics.opening,
            opening_rate=np.zeros(rows),
            height=self.mechanics.height,
            force=np.zeros((rows, 2, 3)),
            voltage=np.zeros((rows, self.config.samples, 2)),
            thermostat=self._thermostats.measured,
            truth=self._truth(self.mechanics.object_pose[:, 0, 2], rest, scene, error),
            error=error,
            told=self._told,
            pressure=None if self._taxels is None else self._taxels.nothing(rows),
            face_temperature=None if self._faces is None else self._faces.rest(rest),
        )


def simulated_plant(url: str, num_envs: int, **config: Any) -> SimulatedPlant:
    """The plant behind plant="simulated". Keywords as in SimulationConfig. Raises InvalidValueError for others."""
    try:
        settings = SimulationConfig(**config)
    except TypeError as error:
        raise InvalidValueError(f"plant {url!r}: {error}") from None
    return SimulatedPlant(num_envs, settings)
