"""The simulated plant: MuJoCo mechanics, contact heat and the fingertips' electronics for a batch of environments."""

from __future__ import annotations

import copy
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from thermograsp.errors import InvalidValueError
from thermograsp.plant import Command, Reading

from ..thermal import sensor
from .electronics import Electronics, ElectronicsState
from .heat import GraspHeat, HeatState, HeatStep
from .mechanics import Mechanics, MechanicsState
from .randomization import CAUSES, checked, draw
from .scene import ObjectSpec
from .simulation_config import SAMPLE_PERIOD, SimulationConfig
from .thermostats import Thermostats
from .things import Thing
from .truth import TOLD, Episodes, Truth


@dataclass(frozen=True, slots=True)
class PlantState:
    """Everything that decides the future of some environments of a simulated plant; picklable."""

    mechanics: MechanicsState
    heat: HeatState
    electronics: ElectronicsState
    thermostats: tuple[np.ndarray, ...]
    rest: np.ndarray
    generators: tuple[np.random.Generator, ...]
    drawn: tuple[dict[str, float], ...]


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
        self.mechanics = Mechanics(
            (first.spec,),
            num_envs,
            threads=config.threads,
            library=[thing.spec for thing in possible if thing.spec.mesh],
            settings=config.solver,
            gripper=config.gripper_for(possible),
            contacts=config.taxels is not None,
        )
        self._taxels = config.tactile
        self.dt = config.substeps * config.solver.timestep
        self.sample_rate = 1 / SAMPLE_PERIOD
        self.heat = GraspHeat(num_envs, **config.heat)
        self.things: list[Thing] = [first] * num_envs
        self._rngs: list[np.random.Generator] = [np.random.default_rng(0)] * num_envs
        self._electronics = Electronics(
            num_envs, config.chain, self._stack.seebeck, SAMPLE_PERIOD, config.samples, config.most_delay
        )
        self._drawn = [plain] * num_envs
        self._thermostats = Thermostats(num_envs, config.heater, config.sensor_temperatures, self.dt)
        self._rest = np.zeros(num_envs)
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
        things = [self.things[row] for row in rows]
        self.mechanics.reset(rows, [(thing.spec,) for thing in things])
        self.heat.reset(
            rows,
            [
                replace(thing, spec=replace(thing.spec, position=shape.position, yaw=shape.yaw))
                for thing, shape in zip(things, own, strict=True)
            ],
            self._thermostats.setpoints[list(rows)]
            + np.array([[self._drawn[row]["thermostat_error"]] for row in rows]),
        )
        chosen = list(rows)
        self._thermostats.reset(chosen)
        self._rest[chosen] = self.mechanics.object_pose[chosen, 0, 2]
        self._relabel(chosen)
        return self._still()

    def step(self, command: Command) -> Reading:
        """One control step of all environments."""
        motion = self.mechanics.advance(
            command.opening, command.force_limit, command.lift_rate, self.config.substeps
        )
        step = self.heat.advance(motion.normal, motion.place)
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
            truth=self._truth(motion.object_height, step, error),
            error=error,
            told=TOLD,
            pressure=None if self._taxels is None else self._taxels.pressure(self.mechanics),
        )

    def temperatures(self, row: int) -> tuple[float, ...]:
        """°C between which the row's heat stays: of its thermostats, object, room and reservoir."""
        return (*self.heat.sensor_temperatures[row], *self.things[row].extremes)

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
        )

    def set_state(self, rows: Sequence[int], state: PlantState) -> tuple[np.random.Generator, ...]:
        """Puts the rows into a state; what follows is bit-identical to what followed it first. Returns the generators
        the rows now draw from."""
        chosen = list(rows)
        self.mechanics.set_state(state.mechanics, np.array(chosen))
        self.heat.set_state(chosen, state.heat)
        self._electronics.set_state(chosen, state.electronics)
        rngs = tuple(copy.deepcopy(rng) for rng in state.generators)
        for k, row in enumerate(chosen):
            self.things[row] = replace(state.heat.things[k], spec=state.mechanics.objects[k][0])
            self._rngs[row] = rngs[k]
            self._drawn[row] = state.drawn[k]
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
            material[row], rung[row] = thing.material.name, self.heat.rung(row)
            crushing_force[row] = thing.crushing_force
        names = [CAUSES[type(cause)][0] for cause in self._causes]
        randomized = {name: np.array([drawn[name] for drawn in self._drawn]) for name in names}
        self._episodes = Episodes(self.config.mode, material, rung, crushing_force, randomized)

    def _truth(self, object_height: np.ndarray, step: HeatStep, error: tuple[str, ...]) -> Truth:
        return Truth(step, self._episodes, object_height - self._rest, error)

    def _still(self) -> Reading:
        """The reading before anything moves: nothing is touched, no voltage."""
        rows, error = self.num_envs, tuple(self.mechanics.failure)
        return Reading(
            opening=self.mechanics.opening,
            opening_rate=np.zeros(rows),
            height=self.mechanics.height,
            force=np.zeros((rows, 2, 3)),
            voltage=np.zeros((rows, self.config.samples, 2)),
            thermostat=self._thermostats.measured,
            truth=self._truth(self.mechanics.object_pose[:, 0, 2], self.heat.rest(), error),
            error=error,
            told=TOLD,
            pressure=None if self._taxels is None else self._taxels.nothing(rows),
        )


def simulated_plant(url: str, num_envs: int, **config: Any) -> SimulatedPlant:
    """The plant behind plant="simulated". Keywords as in SimulationConfig. Raises InvalidValueError for others."""
    try:
        settings = SimulationConfig(**config)
    except TypeError as error:
        raise InvalidValueError(f"plant {url!r}: {error}") from None
    return SimulatedPlant(num_envs, settings)
